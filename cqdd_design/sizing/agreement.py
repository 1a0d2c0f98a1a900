"""Closed forms held against the contact equilibrium, until both say the same of a design.

A search by closed forms takes under a second. It is repeated, each time asking closed forms for as
much reserve as the equilibrium, solved at the design just found, says that they lack near by.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design, Requirements
from cqdd_design.errors import ContactError, DesignError, InfeasibleError
from cqdd_design.gearbox.checks import allowables
from cqdd_design.machine import Machine, resolve
from cqdd_design.results import Check
from cqdd_design.sizing.exact import exact_checks, shortfalls
from cqdd_design.sizing.finish import design_of, finish, torque_reserve
from cqdd_design.sizing.frame import USUAL_FIT, Fit, Frame, Goal, search_frame
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.refine import Starts
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.stage_tables import StageTables

Progress = Callable[[str], None]

FITS = (
    USUAL_FIT,
    Fit(9e-6, 28e-6),
    Fit(12e-6, 40e-6),
    Fit(16e-6, 56e-6),
    Fit(22e-6, 80e-6),
    Fit(30e-6, 110e-6),
)
"""Clearances that are tried, the closest first."""
MATERIALS = ("AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened")
"""Of discs and ring where none is asked for: the paper's, and a through-hardened bearing steel."""
NEEDLE_PINS = "AISI 52100 / 100Cr6 hardened"
"""Of output pins that needles run on, where none is asked for."""
DISC_COUNTS = (2, 3)
"""Likewise of discs: those that balance."""
_ROUNDS, _UNDAMPED, _STRONG_ROUNDS = 8, 3, 5
_SOLVED = 15
"""Designs that are kept with their equilibria, but for the last."""
_SETTLED = 2e-3
"""Change of every need, as a share, at which closed forms and equilibrium agree."""
_FAR = 1.1
"""Objective over a rival's beyond which no further needs make a design win."""
RING, _PINS, _CAM = "CONTACT-RING-PEAK", "CONTACT-PIN-PEAK", "BEARING-STATIC"


class Space(NamedTuple):
    """What a search by closed forms does not vary."""

    disc_count: int
    disc_material: str
    ring_material: str
    fit: Fit
    needles: bool = False
    ring_limit: float = math.inf

    @property
    def is_soft(self) -> bool:
        """Whether a part is of the weakest material that is tried."""
        return MATERIALS[0] in {self.disc_material, self.ring_material}

    def of(self, requirements: Requirements) -> Requirements:
        """The requirements with these discs and materials, which are tried and not asked for."""
        tried = requirements.model_copy(
            update={
                "disc_count": self.disc_count,
                "disc_material": self.disc_material,
                "ring_material": self.ring_material,
                "pin_material": self.pin_material(requirements),
            }
        )
        tried.model_fields_set.intersection_update(requirements.model_fields_set)
        return tried

    def pin_material(self, requirements: Requirements) -> str:
        """Of the output pins: under needles a hardened one, where none is stated."""
        if self.needles and "pin_material" not in requirements.model_fields_set:
            return NEEDLE_PINS
        return requirements.pin_material


@dataclass(frozen=True)
class Found:
    """A design of a space that the contact equilibrium bears out.

    Attributes
    ----------
    search : Search
    needs : mapping of str to float
        What closed forms had to show for it.
    sized : SizedDesign
    point : Points
        On the grid.
    rated : bool
        Whether the carrier's bearing has ratings: one that is made to order has none, and what it
        carries would stay unknown.
    """

    space: Space
    search: Search
    needs: Mapping[str, float]
    sized: SizedDesign
    point: Points
    rated: bool = True

    @property
    def worth(self) -> tuple[bool, float]:
        """What is better is less."""
        return not self.rated, self.sized.objective.score


@dataclass
class Hunt:
    """One search to the verdict: what is learnt on the way.

    Attributes
    ----------
    requirements : Requirements
        With the torques that are tried where none were stated.
    extra : dict of str to float
        Reserve for part errors, by check.
    lowered : bool
        Whether the motor did not hold a continuous torque that was tried.
    fit : Fit
        The closest that heat and part errors leave.
    least_bore : float
        Of the cam bearings that are tried, m: smaller ones leave the shaft's ends no bearing.
    most_pin_circle : float
        Radius of the largest pin circle that is tried, m: round wider ones no carrier bearing of
        the catalogue fits.
    pins : tuple of bool
        Whether output pins that are tried are on needles.
    tried : set of Goal
        Goals that were taken to meet something that is asked for.
    solved : list
        The last designs that were held against the equilibrium, for searches that come back.
    """

    requirements: Requirements
    motor: Motor | None
    ambient: float | None
    say: Progress
    tables: StageTables
    goal: Goal
    extra: dict[str, float] = field(default_factory=dict)
    lowered: bool = False
    fit: Fit = FITS[0]
    least_bore: float = 0.0
    most_pin_circle: float = math.inf
    pins: tuple[bool, ...] = (False,)
    tried: set[Goal] = field(default_factory=set)
    solved: list[tuple[Machine, tuple[Check, ...]]] = field(default_factory=list)

    def held_against(self, machine: Machine) -> tuple[Machine, tuple[Check, ...]]:
        """The machine of its design that is known, and its load lines by the equilibrium.

        Raises
        ------
        ContactError, DesignError
            When it has none.
        """
        for one in self.solved:
            if one[0].given == machine.given:
                return one
        found = machine, exact_checks(machine)
        self.solved[_SOLVED:] = []
        self.solved.insert(0, found)
        return found

    @property
    def may_roll(self) -> bool:
        """Whether needles can run on the output pins that are asked for."""
        asked = self.requirements
        return "pin_material" not in asked.model_fields_set or allowables.is_hardened(
            find_material(asked.pin_material)
        )

    def frame(self, space: Space, needs: Mapping[str, float]) -> Frame:
        """The frame of a space; needs of part errors count on top."""
        asked = space.of(self.requirements)
        frame = search_frame(
            asked, self.motor, self.ambient, space.fit, self.goal, needles=space.needles
        )
        every = {*needs, *self.extra}
        both = {one: needs.get(one, 1.0) * self.extra.get(one, 1.0) for one in every}
        bearings = tuple(one for one in frame.bearings if one.bore_diameter >= self.least_bore)
        # The loop settles with rings of one diameter; smaller ones make it swing.
        return replace(
            frame,
            needs=both,
            bearings=bearings,
            smaller_rings=False,
            ring_limit=space.ring_limit,
            pin_circle_limit=self.most_pin_circle,
        )


def spaces(
    requirements: Requirements, fit: Fit, pins: tuple[bool, ...] = (False,)
) -> Iterator[Space]:
    """Materials and disc counts that are tried: those that are stated, or all.

    And output pins bare and on needles, as `pins` says.
    """
    stated = requirements.model_fields_set
    counts = (requirements.disc_count,) if "disc_count" in stated else DISC_COUNTS
    for count in counts:
        tried = [
            Space(
                count,
                requirements.disc_material if "disc_material" in stated else material,
                requirements.ring_material if "ring_material" in stated else material,
                fit,
                needles,
            )
            for needles in pins
            for material in MATERIALS
        ]
        yield from dict.fromkeys(tried)


def lightest(hunt: Hunt) -> Found | None:
    """The best of all spaces at the hunt's fit that the equilibrium bears out."""
    best: Found | None = None
    every = list(spaces(hunt.requirements, hunt.fit, hunt.pins))
    # The stronger material first: where it makes a light design, the other is soon given up.
    for space in sorted(every, key=lambda one: (one.disc_count, one.needles, one.is_soft)):
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
        return min(
            torque_reserve(one, self.machine.design) / hunt.extra.get(one.id, 1.0)
            if one.known
            else 0.0
            for one in self.checks
        )

    def found(self, hunt: Hunt, space: Space) -> Found | None:
        """It as a design that is borne out; None where it is not."""
        if not _holds(self.checks, self.machine.design, hunt.extra):
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
    rounds = 1 if "peak_torque" in hunt.requirements.derived and not hunt.extra else _STRONG_ROUNDS
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
    if point is None:
        return None
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
) -> tuple[Found | None, bool]:
    """The loop of `agreed`, and whether it was left to a rival that is lighter.

    Parameters
    ----------
    near : Points or None
        Where to begin instead of at the strongest point, which then is begun at too where that
        leads to nothing.
    rounds : int
        At most.
    """
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve() if near is None else near
    strongest = near is None
    if most is None:
        return None, False
    needs: dict[str, float] = dict(known or {})
    begin, best = search.beginning(most), None
    seen: list[Machine] = []
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
            sized, reached = now.lightest_from(search.beginning(reached.different()))
        # The next turn's needs are others: it goes on from where this one has come.
        begin = Starts.at(reached.different(), 1.0)
        if sized is None:
            # What was needed at the last design may be too much: half way back.
            if not needs or turn >= rounds - 1:
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
            needs = {one: 1.5 * needs.get(one, 1.0) for one in (RING, _PINS, _CAM)}
            continue
        short, holds = shortfalls(machine, exact), _holds(exact, machine.design, hunt.extra)
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


def _holds(checks: tuple[Check, ...], design: Design, extra: Mapping[str, float]) -> bool:
    """Whether every line has the reserve that is needed, a rounding's worth aside."""
    return all(
        one.known and torque_reserve(one, design) >= extra.get(one.id, 1.0) * (1.0 - 2e-4)
        for one in checks
    )
