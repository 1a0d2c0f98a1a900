"""Sizing to the verdict: searches that agree with the equilibrium, and the closest models to judge.

The verdict on one design takes some seconds. So toleranced gearboxes and temperatures are looked at
with few gearboxes first, and choose clearances and reserves; then the whole verdict decides.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.errors import ContactError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.temperatures import MachineTemperatures, judged_temperatures
from cqdd_design.results import Check
from cqdd_design.sizing.able import CONTINUOUS, PEAK, cooler, first_guess, what_it_can
from cqdd_design.sizing.agreement import (
    FITS,
    RING,
    Found,
    Hunt,
    Progress,
    agreed,
    in_smaller_rings,
    lightest,
    spaces,
)
from cqdd_design.sizing.bearable import or_weaker, weaker
from cqdd_design.sizing.costs import costs
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
_TRIALS = 14
_CLOSER, _CLOSER_PINS = 0.96, 6
"""Of a pin circle without a rated carrier bearing, and how often one is tried."""
_SMALLER = 3
"""Designs in smaller rings that are looked at."""
_LESS, _WEAKER = 0.9, 16
"""Share of both torques that is tried next where none of a refusal's is carried, and how often."""
_BY_FRICTION = {"EFFICIENCY", "MOTOR-PEAK", "MOTOR-CONTINUOUS", "THERMAL-RISE"}
_NEEDLES_BRING = 0.8
"""Least margin of these lines from which needles under the output pins are tried."""
_GOALS: Mapping[str, Goal] = {
    "BACKLASH": "backlash",
    "LOST-MOTION": "backlash",
    "REFLECTED-INERTIA": "inertia",
    "EFFICIENCY": "efficiency",
}
"""Lines that are asked for, and the goal of a search that meets them if any does."""
_HOT = "THERMAL-RISE"
_BOND = "BELL-JOINT"
_SHAFT = {"SHAFT-STRENGTH", "SHAFT-FATIGUE", "SUPPORT-STATIC", "SUPPORT-LIFE", _BOND}
"""Lines that a cam bearing with a wider bore helps."""
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
    if goal == "efficiency" and hunt.may_roll:
        hunt.pins = False, True
    progress("searching by closed forms, held against the contact equilibrium")
    found = or_weaker(hunt, lambda: lightest(hunt))
    last: Verdict | None = None
    for _ in range(_TRIALS):
        found = None if found is None else _with_rated_bearing(hunt, found)
        if found is None:
            break
        machine = resolve(found.sized.design, motor)
        wider = found, machine
        fit: Fit | None = found.space.fit
        can, step = _look(hunt, replace(machine, stiff=True))
        if can is None and step is None:
            step = _closer_look(hunt, found, machine)
            if step is None:
                found, machine = _smaller(hunt, found, machine)
                can, step = _look(hunt, machine)
                if (can, step) != (None, None) and found is not wider[0]:
                    found, machine = wider
                    can, step = _look(hunt, machine)
        if can is not None:
            hunt.lowered |= can.continuous_torque < hunt.requirements.continuous_torque
            hunt.requirements = can
        else:
            if step is None:
                progress(f"judging {found.sized.design.name} by the whole verdict")
                last = judge(machine)
                if last.meets != "yes" and found is not wider[0]:
                    # A smaller ring leaves shaft and joints less room, at which no look was taken.
                    found, machine = wider
                    last = judge(machine)
                if last.meets == "yes":
                    return _verified(hunt, found, last, requirements, began)
                if _turned(hunt, last):
                    found = or_weaker(hunt, lambda: lightest(hunt))
                    continue
                step = _next_step(hunt, last)
            if step is None:
                break
            fit = _wider(found.space.fit, step)
        if fit is None:
            break
        hunt.fit = fit
        found = _again(hunt, found)
    if last is not None:
        raise _refused(last)
    raise _nothing(hunt) if found is None else _unsettled(found)


def _again(hunt: Hunt, found: Found) -> Found | None:
    """The search repeated near a design, with what has been learnt since.

    Where that leaves nothing: for less torque if none was stated, else with other materials, discs
    and pins.
    """
    space = found.space._replace(fit=hunt.fit)

    def near() -> Found | None:
        return agreed(hunt, space, None, found.needs)

    if hunt.requirements.derived:
        return or_weaker(hunt, near, found)
    return near() or lightest(hunt)


def _with_rated_bearing(hunt: Hunt, found: Found) -> Found:
    """The design, or one near by on a pin circle round which a rated carrier bearing fits.

    What a bearing that is made to order carries would stay unknown.
    """
    before = hunt.most_pin_circle
    for _ in range(_CLOSER_PINS):
        if found.rated:
            return found
        hunt.most_pin_circle = _CLOSER * found.sized.design.reducer.output_pins.circle_radius
        near = _again(hunt, found)
        if near is None:
            break
        found = near
    if not found.rated:
        hunt.most_pin_circle = before
    return found


def _verified(
    hunt: Hunt, found: Found, verdict: Verdict, asked: Requirements, began: float
) -> VerifiedDesign:
    added = hunt.requirements.model_fields_set - asked.model_fields_set
    sizing = _result(hunt, found, began)
    return VerifiedDesign(sizing, verdict, asked.derived | added)


def _result(hunt: Hunt, found: Found, began: float) -> SizingResult:
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
        costs=costs(hunt, found),
        seconds=time.perf_counter() - began,
    )


def _nothing(hunt: Hunt) -> SizingInfeasibleError:
    """Why no design bears the loads, and about what is borne by the equilibrium in this space.

    With the clearance and the reserve that heat and part errors were found to ask for.
    """
    asked, space = hunt.requirements, next(spaces(hunt.requirements, hunt.fit))
    search = Search.of(hunt.frame(space, {}), hunt.tables)
    most = search.most_reserve()
    closed = no_design(search) if most is None or float(most.reserve[0]) < 1.0 else None
    if closed is not None and closed.most_torque is None:
        return closed
    torque = asked.peak_torque if closed is None else closed.most_torque or 0.0
    carried = _carried(hunt, torque)
    errors = "and with what part errors take, " if hunt.extra else ""
    text = (
        f"{asked.peak_torque:g} N*m at ratio {asked.ratio}, {asked.continuous_torque:g} N*m of it "
        f"for ever, do not fit: by the contact equilibrium, {errors}"
    )
    ways = ["state closer [tolerances] in a design"] if hunt.extra else []
    if carried is None:
        text += "far less is carried in this space"
        ways.insert(0, "lower both torques")
    else:
        lasting = rounded_down(carried * asked.continuous_torque / asked.peak_torque, 2)
        text += f"about {carried:g} and {lasting:g} N*m are carried in this space"
        ways.insert(0, f"lower peak_torque to {carried:g} and continuous_torque to {lasting:g} N*m")
    ring = None if closed is None else closed.outer_diameter_needed
    length = None if closed is None else closed.length_needed
    for key, need in (("outer_diameter", ring), ("length", length)):
        if need is not None:
            ways.append(f"raise {key}, to more than the {1e3 * need:g} mm of closed forms")
    remedy = ", or ".join(ways)
    return SizingInfeasibleError(
        f"{text}. {remedy[0].upper()}{remedy[1:]}.",
        binding=(*(("YIELD",) if hunt.extra else ()), *((RING,) if not closed else closed.binding)),
        most_torque=carried,
        outer_diameter_needed=ring,
        length_needed=length,
    )


def _carried(hunt: Hunt, torque: float) -> float | None:
    """The peak torque, N m, from some torque down, at which a design is borne out; None far below.

    The continuous torque falls with it.
    """
    asked = hunt.requirements
    share = asked.continuous_torque / asked.peak_torque
    for _ in range(_WEAKER):
        torque *= _LESS
        hunt.requirements = asked.model_copy(
            update={PEAK: torque, CONTINUOUS: min(asked.continuous_torque, share * torque)}
        )
        if lightest(hunt) is not None:
            return rounded_down(torque, 2)
    return None


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


def _look(hunt: Hunt, machine: Machine) -> tuple[Requirements | None, float | None]:
    """What the motor can do, where that was asked, and clearance that heat needs more, m.

    With rigid discs and ring first: their finite elements cost more than all else here, and change
    either by a per cent.
    """
    if hunt.requirements.derived:
        try:
            can = what_it_can(machine, hunt.requirements, may_rise=not hunt.lowered)
        except ContactError:
            # Beyond this gearbox at some angle or torque that the search did not look at.
            return weaker(hunt.requirements, _LESS, _LESS), None
        if can is not None:
            return can, None
    found, checks, _ = judged_temperatures(machine)
    step = clearance_needed(found, checks)
    if step > 0.0:
        return None, step
    # Parts that press on each other are hot for that; without that, less torque is cooler.
    hot = any(line.id == _HOT and line.known and not line.satisfied for line in checks)
    return (cooler(hunt.requirements) if hot else None), None


def _closer_look(hunt: Hunt, found: Found, machine: Machine) -> float | None:
    """What a few gearboxes ask for: see `read_spread`."""
    hunt.say(f"looking at toleranced gearboxes of {found.sized.design.name}")
    try:
        drawn = drawn_gearboxes(machine, _TRIAL_SAMPLES, sensitivity=False)
    except ContactError:
        return _LEAST_STEP
    return read_spread(hunt, machine, drawn, exact_checks(machine))


def _smaller(hunt: Hunt, found: Found, machine: Machine) -> tuple[Found, Machine]:
    """The design, or the best in a smaller ring of which the looks say as much."""
    extra = dict(hunt.extra)
    for other in in_smaller_rings(hunt, found)[:_SMALLER]:
        small = resolve(other.sized.design, hunt.motor)
        rigid = _look(hunt, replace(small, stiff=True))
        if rigid == (None, None) and _closer_look(hunt, other, small) is None:
            return other, small
        hunt.extra = extra
    return found, machine


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
    # No clearance makes a gearbox tighter or stiffer.
    loose = any(fails.get(name, 0) > (1.0 - share) * count for name in ("backlash", "stiffness"))
    jams = max(one.lost for one in drawn)
    # Half of what may fail, all of it where a backlash is asked for: clearance would cost that.
    may = (0.5 if machine.design.requirements.backlash is None else 1.0) * (1.0 - share) * count
    if not loose and fails["bind"] + jams > may:
        return _LEAST_STEP
    allowed = Allowed.of(machine, lines)
    assert allowed is not None
    by_id = {line.id: line for line in lines}
    # What may fail is shared among the lines that do.
    quantile = 1.0 - (1.0 - share) / max(sum(1 for number in fails.values() if number), 1)
    over = {
        check: float(np.quantile(ratio, quantile)) for check, ratio in used(allowed, drawn).items()
    }
    short = {check: ratio for check, ratio in over.items() if ratio > 1.0}
    for check, ratio in short.items():
        # So much more than the perfect parts of this design have; pressure is a root of torque.
        more = _SPARE * ratio
        reserve = torque_reserve(by_id[check], machine.design)
        hunt.extra[check] = reserve * (more**2 if check.startswith("CONTACT-") else more)
    if loose:
        return 0.0 if short else None
    return 0.0 if short else _LEAST_STEP


def _next_step(hunt: Hunt, judged: Verdict) -> float | None:
    """What could bring a design that was judged nearer to a yes; see `read_spread`."""
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    less = cooler(hunt.requirements) if failing & {_HOT, "MOTOR-CONTINUOUS"} else None
    if less is not None:
        hunt.requirements, hunt.lowered = less, True
        # What is cooler is bonded better.
        failing -= {_HOT, "MOTOR-CONTINUOUS", _BOND}
        if not failing:
            return 0.0
    if not failing <= {"YIELD", "THERMAL-CLEARANCE", *_SHAFT}:
        return None
    if failing & _SHAFT:
        hunt.least_bore = _wider_bore(judged)
        return 0.0
    step = clearance_needed(judged.evidence.temperatures, judged.lines)
    if step > 0.0:
        return step
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    return None if drawn is None else read_spread(hunt, machine, drawn, judged.lines)


def _wider_bore(judged: Verdict) -> float:
    """Least bore of the next cam bearing, m, where the shaft's ends have no bearing that lasts."""
    return 1.001 * judged.evidence.machine.cam.bore_diameter


def _needles_help(hunt: Hunt, judged: Verdict) -> bool:
    """Whether a design with bare pins falls short of what friction takes, and not by far."""
    short = [line for line in judged.lines if line.status in {"fail", "unknown"}]
    return (
        True not in hunt.pins
        and hunt.may_roll
        # Where less torque may be asked for, that comes first.
        and not hunt.requirements.derived
        and all(
            line.known and line.id in _BY_FRICTION and line.margin >= _NEEDLES_BRING
            for line in short
        )
    )


def _turned(hunt: Hunt, judged: Verdict) -> bool:
    """Whether the hunt now goes for other pins, or for what a design falls short of."""
    if _needles_help(hunt, judged):
        hunt.pins = (True,)
        hunt.say("searching with the output pins on needles")
        return True
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    goals = [goal for name, goal in _GOALS.items() if name in failing and goal not in hunt.tried]
    if not goals or not failing <= {*_GOALS, "YIELD", *_SHAFT} or goals[0] == hunt.goal:
        return False
    if failing & _SHAFT:
        hunt.least_bore = _wider_bore(judged)
    hunt.goal, hunt.fit = goals[0], FITS[0]
    hunt.tried.add(goals[0])
    hunt.say(f"searching with {goals[0]} as the objective, which is asked for")
    return True


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
