"""Sizing to the verdict: closed forms search, the closest models judge, and what they find counts.

A search by closed forms takes a third of a second, the verdict on one design some seconds. So the
search is repeated, each time asking closed forms for as much reserve as the contact equilibrium,
solved at the design just found, says that they lack near by; then toleranced gearboxes and
temperatures choose the clearances; and the whole verdict decides.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design, Requirements
from cqdd_design.errors import ContactError, DesignError, InfeasibleError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.temperatures import judged_temperatures
from cqdd_design.results import Check
from cqdd_design.sizing.able import CONTINUOUS, PEAK, first_guess, weaker, what_it_can
from cqdd_design.sizing.exact import exact_checks, shortfalls
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.frame import USUAL_FIT, Fit, Frame, search_frame
from cqdd_design.sizing.infeasible import SizingInfeasibleError, no_design
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.result import SizedDesign, SizingResult
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.stage_tables import StageTables, stage_tables
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.drawn import Allowed, Drawn, drawn_gearboxes, good_gearboxes, used

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
DISC_COUNTS = (2, 3)
"""Likewise of discs: those that balance."""
_ROUNDS, _UNDAMPED = 8, 3
_SETTLED = 2e-3
"""Change of every need, as a share, at which closed forms and equilibrium agree."""
_LEAST_STEP = 1e-6
"""Clearance that has to grow at all, m: to the next fit."""
_TRIAL_SAMPLES = 32
_TRIALS = 10
_LESS, _WEAKER = 0.9, 16
"""Share of a torque that is tried next where no gearbox carries it, and how often."""
_SPARE = 1.02
"""Reserve over what 95 % of the gearboxes need, so that the next design's are not just short."""
_RING, _PINS, _CAM = "CONTACT-RING-PEAK", "CONTACT-PIN-PEAK", "BEARING-STATIC"


class Space(NamedTuple):
    """What a search by closed forms does not vary."""

    disc_count: int
    disc_material: str
    ring_material: str
    fit: Fit

    def of(self, requirements: Requirements) -> Requirements:
        """The requirements with these discs and materials, which are tried and not asked for."""
        tried = requirements.model_copy(
            update={
                "disc_count": self.disc_count,
                "disc_material": self.disc_material,
                "ring_material": self.ring_material,
            }
        )
        tried.model_fields_set.intersection_update(requirements.model_fields_set)
        return tried


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
    """

    space: Space
    search: Search
    needs: Mapping[str, float]
    sized: SizedDesign
    point: Points


@dataclass(frozen=True)
class VerifiedDesign:
    """A design with its verdict, and how it was found.

    Attributes
    ----------
    sizing : SizingResult
        The design, and alternatives that closed forms alone have judged.
    verdict : Verdict
        On the design: yes.
    derived : frozenset of str
        Requirements that were not stated and are what the motor can do.
    judged : int
        Designs that were judged by the whole verdict.
    """

    sizing: SizingResult
    verdict: Verdict
    derived: frozenset[str]
    judged: int


@dataclass
class _Hunt:
    """One search to the verdict: what is learnt on the way."""

    requirements: Requirements
    motor: Motor | None
    ambient: float | None
    say: Progress
    tables: StageTables
    extra: dict[str, float] = field(default_factory=dict)
    """Reserve for part errors, by check."""
    judged: int = 0

    def frame(self, space: Space, needs: Mapping[str, float]) -> Frame:
        """The frame of a space; needs of part errors count on top."""
        asked = space.of(self.requirements)
        frame = search_frame(asked, self.motor, self.ambient, space.fit)
        every = {*needs, *self.extra}
        both = {one: needs.get(one, 1.0) * self.extra.get(one, 1.0) for one in every}
        # The loop settles with rings of one diameter; smaller ones make it swing.
        return replace(frame, needs=both, smaller_rings=False)


def size_to_verdict(
    requirements: Requirements,
    progress: Progress = lambda _: None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
) -> VerifiedDesign:
    """Find the lightest design, by the search's objective, whose verdict is yes.

    Parameters
    ----------
    requirements : Requirements
        What of `disc_count`, `disc_material` and `ring_material` they state is kept.
    progress : callable
        Called with a sentence at every stage.
    motor : Motor, optional
        Default the catalogue's row of the motor that the requirements name.
    ambient : float, optional
        Of the air, deg C.

    Raises
    ------
    SizingInfeasibleError
        When no design was found whose verdict is yes; it names the lines that bind.
    """
    began = time.perf_counter()
    guess = first_guess(requirements, motor)
    hunt = _Hunt(guess, motor, ambient, progress, stage_tables(requirements.ratio))
    progress("searching by closed forms, held against the contact equilibrium")
    found = _or_weaker(hunt, lambda: _lightest(hunt))
    last: Verdict | None = None
    for _ in range(_TRIALS):
        if found is None:
            break
        machine = resolve(found.sized.design, motor)
        fit: Fit | None = found.space.fit
        can = what_it_can(machine, hunt.requirements) if hunt.requirements.derived else None
        if can is not None:
            hunt.requirements = can
        else:
            step = _closer_look(hunt, found, machine)
            if step is None:
                progress(f"judging {found.sized.design.name} by the whole verdict")
                hunt.judged += 1
                last = judge(machine)
                if last.meets == "yes":
                    return _verified(hunt, found, last, requirements, began)
                step = _next_step(hunt, last)
            if step is None:
                break
            fit = _wider(found.space.fit, step)
        if fit is None:
            break
        found = _again(hunt, found, fit)
    raise _refused(last) if last is not None else _nothing(hunt)


def _again(hunt: _Hunt, found: Found, fit: Fit) -> Found | None:
    """The search repeated near a design, with what has been learnt since."""
    space = found.space._replace(fit=fit)
    return _or_weaker(hunt, lambda: _agreed(hunt, space, None, found.needs))


def _or_weaker(hunt: _Hunt, search: Callable[[], Found | None]) -> Found | None:
    """A search, repeated for less torque where none was stated and none is carried."""
    for _ in range(_WEAKER):
        found = search()
        less = None if found is not None else weaker(hunt.requirements, _LESS)
        if less is None:
            return found
        hunt.requirements = less
    return None


def _verified(
    hunt: _Hunt, found: Found, verdict: Verdict, asked: Requirements, began: float
) -> VerifiedDesign:
    added = hunt.requirements.model_fields_set - asked.model_fields_set
    sizing = _result(found, time.perf_counter() - began)
    return VerifiedDesign(sizing, verdict, asked.derived | added, hunt.judged)


def _result(found: Found, seconds: float) -> SizingResult:
    """With alternatives of the last search, whose closed forms are held against the equilibrium."""
    search, screen = found.search, found.search.found
    most = search.most_reserve()
    others = () if most is None else search.alternatives(found.sized, found.point, most)
    return SizingResult(
        **vars(found.sized),
        alternatives=others,
        candidates_screened=screen.screened,
        survivors=screen.survivors,
        rejected=screen.rejected,
        seconds=seconds,
    )


def _nothing(hunt: _Hunt) -> SizingInfeasibleError:
    """Why no design bears the loads, and about what is borne by the equilibrium in this space."""
    asked, space = hunt.requirements, next(_spaces(hunt.requirements, FITS[0]))
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve()
    closed = no_design(search) if most is None or float(most.reserve[0]) < 1.0 else None
    if closed is not None and closed.most_torque is None:
        return closed
    torque = asked.peak_torque if closed is None else closed.most_torque or 0.0
    share = asked.continuous_torque / asked.peak_torque
    for _ in range(_WEAKER):
        torque *= _LESS
        hunt.requirements = asked.model_copy(
            update={PEAK: torque, CONTINUOUS: min(asked.continuous_torque, share * torque)}
        )
        if _lightest(hunt) is not None:
            break
    carried = rounded_down(torque, 2)
    text = (
        f"{asked.peak_torque:g} N*m at ratio {asked.ratio} do not fit: by the contact equilibrium "
        f"about {carried:g} N*m are carried in this space. Lower peak_torque to {carried:g} N*m"
    )
    ring = None if closed is None else closed.outer_diameter_needed
    length = None if closed is None else closed.length_needed
    if ring is not None:
        text += f", or raise outer_diameter, to more than the {1e3 * ring:g} mm of closed forms"
    if length is not None:
        text += f", or raise length, to more than the {1e3 * length:g} mm of closed forms"
    return SizingInfeasibleError(
        f"{text}.",
        binding=(_RING,) if closed is None else closed.binding,
        most_torque=carried,
        outer_diameter_needed=ring,
        length_needed=length,
    )


def _wider(fit: Fit, step: float) -> Fit | None:
    """The closest fit with so much more clearance of the holes, m; None beyond the widest.

    The same where the step is 0.
    """
    least = fit.hole_clearance + step
    return next((one for one in FITS if one.hole_clearance >= least), None)


def _spaces(requirements: Requirements, fit: Fit) -> Iterator[Space]:
    """Materials and disc counts that are tried: those that are stated, or all."""
    stated = requirements.model_fields_set
    counts = (requirements.disc_count,) if "disc_count" in stated else DISC_COUNTS
    for count in counts:
        tried = [
            Space(
                count,
                requirements.disc_material if "disc_material" in stated else material,
                requirements.ring_material if "ring_material" in stated else material,
                fit,
            )
            for material in MATERIALS
        ]
        yield from dict.fromkeys(tried)


def _lightest(hunt: _Hunt) -> Found | None:
    """The best of all spaces at the closest fit that the equilibrium bears out."""
    best: Found | None = None
    for space in _spaces(hunt.requirements, FITS[0]):
        try:
            found = _agreed(hunt, space, best)
        except InfeasibleError:
            continue
        if found is not None and (best is None or _score(found) < _score(best)):
            best = found
    return best


def _score(found: Found) -> float:
    return found.sized.objective.score


def _agreed(
    hunt: _Hunt, space: Space, rival: Found | None, known: Mapping[str, float] | None = None
) -> Found | None:
    """Search again and again until closed forms ask for what the equilibrium takes.

    Parameters
    ----------
    rival : Found or None
        A design of another space, which this one has to beat.
    known : mapping, optional
        Needs from a space near by.
    """
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve()
    if most is None:
        return None
    needs: dict[str, float] = dict(known or {})
    starts, best = most, None
    for turn in range(_ROUNDS):
        frame = hunt.frame(space, needs)
        evaluator = Evaluator.of(frame, hunt.tables, search.space.pin_counts)
        now = replace(search, evaluator=evaluator)
        sized = now.lightest(starts)
        if sized is None:
            # What was needed at the last design may be too much: half way back.
            if not needs or turn >= _ROUNDS - 1:
                break
            needs = {one: math.sqrt(value) for one, value in needs.items()}
            continue
        design, point = sized
        if rival is not None and turn == 0 and design.objective.score > _score(rival):
            # Closed forms alone make it heavier than one that is borne out.
            return None
        machine = resolve(design.design, hunt.motor)
        try:
            short, holds = (
                shortfalls(machine),
                _holds(exact_checks(machine), machine.design, hunt.extra),
            )
        except (ContactError, DesignError):
            needs = {one: 1.5 * needs.get(one, 1.0) for one in (_RING, _PINS, _CAM)}
            continue
        if holds and (best is None or design.objective.score < best.sized.objective.score):
            best = Found(space, now, needs, design, point)
        damping = 1.0 if turn < _UNDAMPED else 0.5
        after = {
            one: needs.get(one, 1.0) * (value / needs.get(one, 1.0)) ** damping
            for one, value in short.items()
        }
        settled = all(abs(after[one] / needs.get(one, 1.0) - 1.0) < _SETTLED for one in after)
        needs, starts = after, point.joined(most)
        if settled and best is not None:
            break
    return best


def _holds(checks: tuple[Check, ...], design: Design, extra: Mapping[str, float]) -> bool:
    """Whether every line has the reserve that is needed, a rounding's worth aside."""
    return all(
        one.known and torque_reserve(one, design) >= extra.get(one.id, 1.0) * (1.0 - 2e-4)
        for one in checks
    )


def _closer_look(hunt: _Hunt, found: Found, machine: Machine) -> float | None:
    """What heat and a few gearboxes ask for: see `_spread`."""
    hunt.say(f"looking at clearances and toleranced gearboxes of {found.sized.design.name}")
    _, warm, _ = judged_temperatures(machine)
    step = _overlap(warm)
    if step > 0.0:
        return step
    try:
        drawn = drawn_gearboxes(machine, _TRIAL_SAMPLES, sensitivity=False)
    except ContactError:
        return _LEAST_STEP
    return _spread(hunt, machine, drawn, exact_checks(machine))


def _overlap(checks: Iterable[Check]) -> float:
    """Clearance that holes need more, or the least step, where warm parts overlap, m; else 0."""
    for one in checks:
        if one.id == "THERMAL-CLEARANCE" and not one.satisfied:
            return max(2e-6 * (one.value or 0.0), _LEAST_STEP)
    return 0.0


def _spread(hunt: _Hunt, machine: Machine, drawn: Drawn, lines: tuple[Check, ...]) -> float | None:
    """More clearance of the holes that part errors ask for, m; None where they ask for nothing.

    0 where they ask for reserve instead, which is noted.
    """
    good = good_gearboxes(machine, drawn, lines)
    if good is None:
        return None
    numbers, fails = good
    count = len(drawn.continuous.values) + drawn.continuous.lost
    share = machine.design.requirements.yield_share
    if len(numbers) >= share * count:
        return None
    jams = max(one.lost for one in drawn)
    if fails["bind"] + jams > 0.5 * (1.0 - share) * count:
        return _LEAST_STEP
    allowed = Allowed.of(machine, lines)
    assert allowed is not None
    by_id = {line.id: line for line in lines}
    quantile = 1.0 - (1.0 - share) / len(fails)
    over = {
        check: float(np.quantile(ratio, quantile)) for check, ratio in used(allowed, drawn).items()
    }
    short = {check: ratio for check, ratio in over.items() if ratio > 1.0}
    for check, ratio in short.items():
        # So much more than the perfect parts of this design have; pressure is a root of torque.
        more = _SPARE * ratio
        reserve = torque_reserve(by_id[check], machine.design)
        hunt.extra[check] = reserve * (more**2 if check.startswith("CONTACT-") else more)
    return 0.0 if short else _LEAST_STEP


def _next_step(hunt: _Hunt, judged: Verdict) -> float | None:
    """What could bring a design that was judged nearer to a yes: see `_spread`; None is nothing."""
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    if not failing <= {"YIELD", "THERMAL-CLEARANCE"}:
        return None
    step = _overlap(judged.lines)
    if step > 0.0:
        return step
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    return None if drawn is None else _spread(hunt, machine, drawn, judged.lines)


def _refused(judged: Verdict) -> SizingInfeasibleError:
    """What stands in the way of the design that came nearest."""
    short = [line for line in judged.limits if line.status in {"fail", "unknown"}]
    told = "; ".join(
        f"{line.title.lower()}: {line.substituted} ({line.remedy})" for line in short[:4]
    )
    motor = [one for one in short if one.id == "MOTOR-PEAK" and one.value]
    return SizingInfeasibleError(
        f"no design was found that meets everything; the nearest falls short of {told}.",
        binding=tuple(line.id for line in short),
        most_torque=rounded_down(motor[0].value) if motor and motor[0].value else None,
    )
