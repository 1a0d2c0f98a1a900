"""Closed forms held against the contact equilibrium, until both say the same of a design.

A search by closed forms takes under a second. It is repeated, each time asking closed forms for as
much reserve as the equilibrium, solved at the design just found, says that they lack near by.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from cqdd_design.design import Design
from cqdd_design.errors import ContactError, DesignError, InfeasibleError
from cqdd_design.machine import Machine, resolve
from cqdd_design.results import Check
from cqdd_design.sizing.exact import shortfalls
from cqdd_design.sizing.finish import design_of, finish, torque_reserve
from cqdd_design.sizing.hunt import CAM, Hunt
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.refine import Starts, best_rows
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import Found, Space, spaces

_ROUNDS, _UNDAMPED, _STRONG_ROUNDS = 8, 3, 5
_BACK = 2
"""How often needs that leave no design are halved."""
_GO_ON = 4
"""Points of one round from which the next goes on."""
_SETTLED = 2e-3
"""Change of every need, as a share, at which closed forms and equilibrium agree."""
_FAR = 1.1
"""Objective over a rival's beyond which no further needs make a design win."""
_HOPELESS = 0.4
"""Reserve of what closed forms take for the strongest, by the equilibrium, below which nothing near
it is strong enough: where something was, it was 0.47 at least."""
RING, _PINS = "CONTACT-RING-PEAK", "CONTACT-PIN-PEAK"


def tightest(hunt: Hunt) -> Found | None:
    """The best in the largest ring, of all spaces at the hunt's fit, that is borne out.

    Whichever cam bearing it takes; where a space is so tight that only its strongest point will do,
    that one.
    """
    best: Found | None = None
    every = list(spaces(hunt.requirements, hunt.fit, hunt.pins))
    for space in every:
        try:
            found = agreed(hunt, space, None if best is None else best.worth)
        except InfeasibleError:
            continue
        if found is not None:
            both = (found,) if best is None else (best, found)
            best = min(both, key=lambda one: (one.worth, every.index(one.space)))
    return best


class Strongest(NamedTuple):
    """The point with the most torque reserve by closed forms, and what the equilibrium says."""

    search: Search
    point: Points
    machine: Machine
    checks: tuple[Check, ...]

    def reserve(self, hunt: Hunt) -> float:
        """The least of its torque reserves, over what part errors take."""
        design = self.machine.design
        extra = hunt.extra_for(design.reducer.cam_bearing.designation)
        return min(
            torque_reserve(one, design) / extra.get(one.id, 1.0) if one.known else 0.0
            for one in self.checks
        )

    def found(self, hunt: Hunt, space: Space) -> Found | None:
        """It as a design that is borne out; None where it is not."""
        if not _holds(hunt, self.checks, self.machine.design):
            return None
        sized = finish(self.search.evaluator, self.point, 0)
        if sized is None:
            return None
        needs = shortfalls(self.machine, self.checks)
        return Found(space, self.search, needs, sized, self.point, _rated(self.machine))


def strongest(hunt: Hunt, space: Space, needs: Mapping[str, float]) -> Strongest | None:
    """The strongest design of a space; None where no shape or no equilibrium is.

    What closed forms take for the strongest is weak in the lines that they think too well of: they
    are asked again, with what they lacked there as needs, while that gives a stronger one.

    Parameters
    ----------
    needs : mapping of str to float
        To begin with.
    """
    best: Strongest | None = None
    # Torques that nobody stated are lowered instead.
    rounds = (
        1 if "peak_torque" in hunt.requirements.derived and not hunt.has_extra else _STRONG_ROUNDS
    )
    for _ in range(rounds):
        now = _strongest(hunt, space, needs)
        if now is None or (best is not None and now.reserve(hunt) <= best.reserve(hunt)):
            break
        best = now
        if now.reserve(hunt) >= 1.0:
            break
        needs = shortfalls(now.machine, now.checks)
    return best


def _strongest(hunt: Hunt, space: Space, needs: Mapping[str, float]) -> Strongest | None:
    search = Search.of(hunt.frame(space, needs), hunt.tables)
    point = search.most_reserve()
    return None if point is None else _held_against(hunt, search, point)


def _held_against(hunt: Hunt, search: Search, point: Points) -> Strongest | None:
    try:
        machine, checks = hunt.held_against(
            resolve(design_of(search.evaluator, point, 0), search.frame.motor)
        )
        return Strongest(search, point, machine, checks)
    except (ContactError, DesignError):
        return None


def agreed(
    hunt: Hunt,
    space: Space,
    rival: tuple[bool, float] | None,
    known: Mapping[str, float] | None = None,
) -> Found | None:
    """Search again and again until closed forms ask for what the equilibrium takes.

    Parameters
    ----------
    rival : tuple, optional
        What a design of another space is worth, which this one has to beat.
    known : mapping, optional
        Needs from a space near by.
    """
    best, beaten = settled(hunt, space, rival, known, None)
    if best is not None or beaten:
        return best
    # The search makes designs light before it makes them strong.
    strong = strongest(hunt, space, known or {})
    first = None if strong is None else strong.found(hunt, space)
    if first is None:
        return None
    better, _ = settled(hunt, space, None, first.needs, first.point)
    return first if better is None else min(first, better, key=lambda one: one.worth)


def settled(
    hunt: Hunt,
    space: Space,
    rival: tuple[bool, float] | None,
    known: Mapping[str, float] | None,
    near: Points | None,
    rounds: int = _ROUNDS,
    *,
    beside: bool = False,
) -> tuple[Found | None, bool]:
    """The loop of `agreed`, and whether it was left to a rival that is lighter.

    Parameters
    ----------
    near : Points or None
        Where to begin instead of at the strongest point, which then is begun at too where that
        leads to nothing.
    rounds : int
        At most.
    beside : bool
        Whether nothing is looked for that is not near `near`.
    """
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve() if near is None else search.evaluator.placed(near)
    strongest = near is None or beside
    if most is None:
        return None, False
    if near is None:
        strong = _held_against(hunt, search, most)
        if strong is not None and strong.reserve(hunt) < _HOPELESS:
            return None, False
    needs: dict[str, float] = dict(known or {})
    begin, best = search.beginning(most), None
    seen: list[Machine] = []
    back = 0
    for turn in range(rounds):
        frame = hunt.frame(space, needs)
        evaluator = Evaluator.of(frame, hunt.tables, search.space.pin_counts)
        now = replace(search, evaluator=evaluator)
        sized, reached = now.lightest_from(begin)
        if sized is None and not strongest:
            strongest = True
            more = search.most_reserve()
            if more is None:
                return best, False
            sized, others = now.lightest_from(Starts.at(more, 1.0))
            reached = reached.joined(others)
        elif sized is None and turn > 0:
            sized, reached = now.lightest_from(search.beginning(best_rows(reached, _GO_ON)))
        # The next turn's needs are others: it goes on from where this one has come.
        begin = Starts.at(best_rows(reached, _GO_ON), 1.0)
        if sized is None:
            # What was needed at the last design may be too much: half way back.
            back += 1
            if not needs or back > _BACK:
                break
            needs = {one: math.sqrt(value) for one, value in needs.items()}
            continue
        design, point = sized
        score = design.objective.score if turn == 0 else design.objective.score / _FAR
        if best is None and rival is not None and (False, score) > rival:
            # Closed forms alone make it heavier than one that is borne out, or, with what they
            # lacked, far heavier.
            return None, True
        try:
            machine, exact = hunt.held_against(design.machine)
        except (ContactError, DesignError):
            needs = {one: 1.5 * needs.get(one, 1.0) for one in (RING, _PINS, CAM)}
            continue
        short, holds = shortfalls(machine, exact), _holds(hunt, exact, machine.design)
        found = Found(space, now, needs, design, point, _rated(machine))
        if holds and (best is None or found.worth < best.worth):
            best = found
        damping = 1.0 if turn < _UNDAMPED else 0.5
        after = {
            one: needs.get(one, 1.0) * (value / needs.get(one, 1.0)) ** damping
            for one, value in short.items()
        }
        still = all(abs(after[one] / needs.get(one, 1.0) - 1.0) < _SETTLED for one in after)
        needs = after
        # Between designs that it has been at already the loop would go on for ever.
        again = any(one is machine for one in seen)
        seen.append(machine)
        if best is not None and (still or again):
            break
    return best, False


def _rated(machine: Machine) -> bool:
    return machine.seats[1].bearing.static_rating is not None


def _holds(hunt: Hunt, checks: tuple[Check, ...], design: Design) -> bool:
    """Whether every line has the reserve that is needed, a rounding's worth aside."""
    extra = hunt.extra_for(design.reducer.cam_bearing.designation)
    return all(
        one.known and torque_reserve(one, design) >= extra.get(one.id, 1.0) * (1.0 - 2e-4)
        for one in checks
    )
