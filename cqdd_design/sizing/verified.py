"""Sizing to the verdict: searches that agree with the equilibrium, and the closest models to judge.

The verdict on one design takes some seconds. So toleranced gearboxes and temperatures are looked at
with few gearboxes first, and choose clearances and reserves; then the whole verdict decides.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.errors import ContactError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
from cqdd_design.results import Check
from cqdd_design.sizing.able import CONTINUOUS, PEAK, first_guess, weaker, what_it_can
from cqdd_design.sizing.agreement import (
    FITS,
    RING,
    Found,
    Hunt,
    Progress,
    agreed,
    lightest,
    spaces,
)
from cqdd_design.sizing.exact import exact_checks
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.frame import Fit, Goal
from cqdd_design.sizing.infeasible import SizingInfeasibleError, no_design
from cqdd_design.sizing.result import SizingResult
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.drawn import Allowed, Drawn, drawn_gearboxes, good_gearboxes, used

_LEAST_STEP = 1e-6
"""Clearance that has to grow at all, m: to the next fit."""
_TRIAL_SAMPLES = 32
_TRIALS = 10
_LESS, _LESS_OF_BOTH, _WEAKER, _PEAK_ALONE = 0.9, 0.8, 16, 3
"""Share of the peak torque that is tried next where no gearbox carries it, and of both torques,
how often in all, and how often of the peak torque alone before."""
_SPARE = 1.02
"""Reserve over what 95 % of the gearboxes need, so that the next design's are not just short."""


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
    """

    sizing: SizingResult
    verdict: Verdict
    derived: frozenset[str]


def size_to_verdict(
    requirements: Requirements,
    progress: Progress = lambda _: None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
    goal: Goal = "mass",
) -> VerifiedDesign:
    """Find the best design by a goal, among those tried, whose verdict is yes.

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
    goal : Goal
        What to make small: see :mod:`cqdd_design.sizing.goals`.

    Raises
    ------
    SizingInfeasibleError
        When no design was found whose verdict is yes; it names the lines that bind.
    """
    began = time.perf_counter()
    guess = first_guess(requirements, motor)
    hunt = Hunt(guess, motor, ambient, progress, stage_tables(requirements.ratio), goal)
    progress("searching by closed forms, held against the contact equilibrium")
    found = _or_weaker(hunt, lambda: lightest(hunt))
    last: Verdict | None = None
    for _ in range(_TRIALS):
        if found is None:
            break
        machine = resolve(found.sized.design, motor)
        fit: Fit | None = found.space.fit
        can, step = _first_look(hunt, machine)
        if can is not None:
            hunt.lowered |= can.continuous_torque < hunt.requirements.continuous_torque
            hunt.requirements = can
        else:
            if step is None:
                step = _closer_look(hunt, found, machine)
            if step is None:
                progress(f"judging {found.sized.design.name} by the whole verdict")
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
    if last is not None:
        raise _refused(last)
    raise _nothing(hunt) if found is None else _unsettled(found)


def _again(hunt: Hunt, found: Found, fit: Fit) -> Found | None:
    """The search repeated near a design, with what has been learnt since."""
    space = found.space._replace(fit=fit)
    return _or_weaker(hunt, lambda: agreed(hunt, space, None, found.needs))


def _or_weaker(hunt: Hunt, search: Callable[[], Found | None]) -> Found | None:
    """A search, repeated for less torque where none was stated and none is carried."""
    for turn in range(_WEAKER):
        found = search()
        both = turn >= _PEAK_ALONE
        share = _LESS_OF_BOTH if both else _LESS
        less = None if found is not None else weaker(hunt.requirements, share, both=both)
        if less is None:
            return found
        # What was lowered for part errors is not raised to what the motor holds.
        hunt.lowered |= both and bool(hunt.extra)
        hunt.requirements = less
    return None


def _verified(
    hunt: Hunt, found: Found, verdict: Verdict, asked: Requirements, began: float
) -> VerifiedDesign:
    added = hunt.requirements.model_fields_set - asked.model_fields_set
    sizing = _result(found, time.perf_counter() - began)
    return VerifiedDesign(sizing, verdict, asked.derived | added)


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


def _nothing(hunt: Hunt) -> SizingInfeasibleError:
    """Why no design bears the loads, and about what is borne by the equilibrium in this space."""
    asked, space = hunt.requirements, next(spaces(hunt.requirements, FITS[0]))
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
        if lightest(hunt) is not None:
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
        binding=(RING,) if closed is None else closed.binding,
        most_torque=carried,
        outer_diameter_needed=ring,
        length_needed=length,
    )


def _unsettled(found: Found) -> SizingInfeasibleError:
    """Loads are borne, but the trials ended before a design was worth the whole verdict."""
    widest = 1e6 * FITS[-1].hole_clearance
    if found.space.fit == FITS[-1]:
        why = (
            f"heat or part errors ask for more clearance than the {widest:g} um at the output pins "
            "that are tried; lower input_speed or continuous_torque, or state closer [tolerances] "
            "in a design"
        )
    else:
        asked = found.sized.design.requirements
        why = (
            f"in {_TRIALS} trials what is asked, heat and part errors went on moving the design, "
            f"last for {asked.peak_torque:g} N*m and {asked.continuous_torque:g} N*m for ever; "
            "state peak_torque and continuous_torque, somewhat less"
        )
    return SizingInfeasibleError(
        f"no design was found that meets everything: {why}.",
        binding=("THERMAL-CLEARANCE", "YIELD"),
        most_torque=None,
    )


def _wider(fit: Fit, step: float) -> Fit | None:
    """The closest fit with so much more clearance of the holes, m; None beyond the widest.

    The same where the step is 0.
    """
    least = fit.hole_clearance + step
    return next((one for one in FITS if one.hole_clearance >= least), None)


def _first_look(hunt: Hunt, machine: Machine) -> tuple[Requirements | None, float | None]:
    """What the motor can do, where that was asked, and clearance that heat needs more, m.

    With rigid discs and ring first, whose finite elements cost more than all else here and change
    either by a per cent; where that finds nothing, with elastic ones.
    """
    stiff = replace(machine, stiff=True)
    for one in (stiff, machine):
        can = None
        if hunt.requirements.derived:
            can = what_it_can(one, hunt.requirements, may_rise=not hunt.lowered)
        if can is not None:
            return can, None
        found, checks, _ = judged_temperatures(one)
        step = clearance_needed(found, checks)
        if step > 0.0:
            return None, step
    return None, None


def _closer_look(hunt: Hunt, found: Found, machine: Machine) -> float | None:
    """What a few gearboxes ask for: see `read_spread`."""
    hunt.say(f"looking at toleranced gearboxes of {found.sized.design.name}")
    try:
        drawn = drawn_gearboxes(machine, _TRIAL_SAMPLES, sensitivity=False)
    except ContactError:
        return _LEAST_STEP
    return read_spread(hunt, machine, drawn, exact_checks(machine))


def clearance_needed(found: MachineTemperatures | None, checks: Iterable[Check]) -> float:
    """Clearance that holes need more, or the least step, where warm parts overlap, m; else 0."""
    for one in checks:
        if one.id == "THERMAL-CLEARANCE" and not one.satisfied:
            return max(2.0 * (found.lacking_clearance if found else 0.0), _LEAST_STEP)
    return 0.0


def read_spread(
    hunt: Hunt, machine: Machine, drawn: Drawn, lines: tuple[Check, ...]
) -> float | None:
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


def _next_step(hunt: Hunt, judged: Verdict) -> float | None:
    """What could bring a design that was judged nearer to a yes; see `read_spread`."""
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    if not failing <= {"YIELD", "THERMAL-CLEARANCE", "SUPPORT-STATIC"}:
        return None
    if "SUPPORT-STATIC" in failing:
        hunt.least_bore = 1.001 * judged.evidence.machine.cam.bore_diameter
        return 0.0
    step = clearance_needed(judged.evidence.temperatures, judged.lines)
    if step > 0.0:
        return step
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    return None if drawn is None else read_spread(hunt, machine, drawn, judged.lines)


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
