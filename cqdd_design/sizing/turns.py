"""What a search to the verdict goes for next, where a design or its motor is short of a line."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cqdd_design.machine import Machine
from cqdd_design.results import Check
from cqdd_design.sizing.able import CONTINUOUS, PEAK, cooler
from cqdd_design.sizing.bearable import JUST, weaker
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.foreseen import Foreseen
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.kinds import lightest, promising
from cqdd_design.sizing.looks import BY_HEAT, HOT, clearance_needed, motor_far_short, read_spread
from cqdd_design.sizing.plates import pins_press
from cqdd_design.sizing.refusals import short_of
from cqdd_design.sizing.shafts import BONDS, SHAFT, stronger_shaft
from cqdd_design.sizing.spaces import FITS, Found
from cqdd_design.verdict import Verdict

_BY_FRICTION = {"EFFICIENCY", "MOTOR-PEAK", "MOTOR-CONTINUOUS", "THERMAL-RISE"}
_NEEDLES_BRING = 0.8
"""Least margin of these lines from which needles under the output pins are tried."""
_MOST_BEARINGS = 2
"""That lose too much, after which another goal is searched for."""
_LEAST_SHARE = 0.5
"""Of a peak torque that was not stated, below which no line's shortfall is met by lowering it."""
_MASS = "MASS"
_LIGHTER, _LITTLE_LIGHTER, _SAME = 2.0, 0.95, 1e-3
"""Power of the share of mass that is too much by which torques are lowered, as a gearbox is but a
part of the whole; the most that is left of them; and the share of a mass that counts as none."""
_SMALLER_BRINGS = 0.95
"""Least margin of the mass from which small gearboxes are tried: the housing round one is lighter,
though the gearbox itself may not be."""
_GOALS: Mapping[str, Goal] = {
    "BACKLASH": "backlash",
    "LOST-MOTION": "backlash",
    "REFLECTED-INERTIA": "inertia",
    "EFFICIENCY": "efficiency",
    "MOTOR-CONTINUOUS": "efficiency",
    HOT: "efficiency",
}
"""Lines that are asked for, and the goal of a search that meets them if any does."""
_COOL: Goal = "efficiency"
_NEARLY_HELD = 0.85
"""Margin of what a motor holds with a gearbox that loses little, from which the search goes on."""
_SEATS, _BENDING, _STIFFER = "DOWEL-BEARING", "PIN-BENDING-PEAK", 1.05
"""The line of the seats of output pins, that of their bending, and how much less of it is searched
for than their pressure asks for: the force across a pin presses too."""
_BY_STRENGTH = {"STIFFNESS", "SHOCK-STOP"}
"""Lines that are asked for and that a stronger gearbox meets."""
_STURDIER = 1.3
"""Of its reserve at the peak, from one search to the next."""


def cooler_gearbox(hunt: Hunt, far: tuple[Check, ...], machine: Machine) -> Found:
    """A gearbox that loses less than a machine's, whose motor is far from holding a stated torque.

    Near the speed at which its own drag warms a motor to its limit, what it holds hangs on little.

    Raises
    ------
    SizingInfeasibleError
        When the motor is as far from it with that one, or it is a peak torque.
    """
    if hunt.goal == _COOL or not {line.id for line in far} <= BY_HEAT:
        raise short_of(far, machine, hunt.held_up_to)
    hunt.say("searching with efficiency as the objective, for what the motor has to hold")
    hunt.goal, hunt.pins = _COOL, (False, True) if hunt.may_roll else hunt.pins
    hunt.tried.add(_COOL)
    found = promising(hunt)
    if found is None or motor_far_short(hunt, found.sized.machine, _NEARLY_HELD):
        cooler = machine if found is None else found.sized.machine
        raise short_of(far, cooler, hunt.held_up_to)
    return found


def next_step(hunt: Hunt, found: Found, judged: Verdict) -> float | None:
    """What could bring a design that was judged nearer to a yes; see `read_spread`."""
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    less = cooler(hunt.requirements) if failing & {HOT, "MOTOR-CONTINUOUS"} else None
    if less is not None:
        hunt.requirements, hunt.lowered, hunt.lowered_by = less, True, found.cam
        # What is cooler is bonded better.
        failing -= {HOT, "MOTOR-CONTINUOUS", *BONDS}
        if not failing:
            return 0.0
    others = failing - {"YIELD", "THERMAL-CLEARANCE", *SHAFT}
    if _SEATS in others and PEAK not in hunt.requirements.derived:
        if not _stronger_pins(hunt, found, judged):
            return None
        others.discard(_SEATS)
        if not others:
            return 0.0
    if others:
        share = _bearing_all(hunt, judged, others)
        if share is None:
            return None
        lasting = share if _MASS in others and _as_heavy(hunt, judged) else 1.0
        hunt.requirements = weaker(hunt.requirements, share, lasting)
        if lasting < 1.0:
            # What a lighter one's motor holds is not to make it heavy again.
            hunt.lowered, hunt.lowered_by = True, ""
        return 0.0
    if failing & SHAFT:
        stronger_shaft(hunt, found, judged.lines)
        return 0.0
    step = clearance_needed(judged.evidence.temperatures, judged.lines)
    if step > 0.0:
        return step
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    return None if drawn is None else read_spread(hunt, machine, drawn, judged.lines)


def _stronger_pins(hunt: Hunt, found: Found, judged: Verdict) -> bool:
    """Whether seats of the output pins yield; then pins that bend less are searched for."""
    over = pins_press(judged.evidence.machine)
    if over <= 1.0:
        return False
    # What presses a seat most is the bending of its pin.
    line = next(one for one in judged.lines if one.id == _BENDING)
    had = torque_reserve(line, found.sized.design)
    hunt.ask_extra(found.cam, {_BENDING: _STIFFER * over * had}, {_BENDING: had})
    return True


def _bearing_all(hunt: Hunt, judged: Verdict, short: set[str]) -> float | None:
    """Share of a peak torque that was not stated which some lines bear; None where that helps none.

    Of lines in proportion to it, and of the mass; others that do not come right by it end the
    trials.
    """
    lines = [line for line in judged.lines if line.id in short]
    if PEAK not in hunt.requirements.derived or not all(line.known for line in lines):
        return None
    share = min(_borne(line) for line in lines)
    return share if _LEAST_SHARE <= share < 1.0 else None


def _as_heavy(hunt: Hunt, judged: Verdict) -> bool:
    """Whether less peak torque has left the actuator as heavy as it was; what it is, is noted.

    Then it is the other torque that decides.
    """
    before, hunt.heavy = hunt.heavy, _mass(judged).value or 0.0
    return math.isclose(hunt.heavy, before, rel_tol=_SAME)


def _mass(judged: Verdict | Foreseen) -> Check:
    return next(line for line in judged.lines if line.id == _MASS)


def _borne(line: Check) -> float:
    """Share of a peak torque with which a line may come right; 0 of a mass that is far too much."""
    if line.id != _MASS:
        return JUST * line.margin
    if line.margin < _LEAST_SHARE:
        return 0.0
    return float(max(min(line.margin**_LIGHTER, _LITTLE_LIGHTER), _LEAST_SHARE))


def _loses_little_too_much(hunt: Hunt, judged: Verdict | Foreseen) -> bool:
    """Whether a design falls short of what friction takes alone, and not by far."""
    short = [line for line in judged.lines if line.status in {"fail", "unknown"}]
    if any(line.id == HOT for line in short):
        # What parts at their limit hold hangs on little; how warm they are says how near it is.
        short = [line for line in short if line.id != "MOTOR-CONTINUOUS"]
    # Where less torque may be asked for, that comes first.
    return not hunt.requirements.derived and all(
        line.known and line.id in _BY_FRICTION and line.margin >= _NEEDLES_BRING for line in short
    )


def _needles_help(hunt: Hunt, judged: Verdict | Foreseen) -> bool:
    """Whether a design with bare pins loses a little too much."""
    return True not in hunt.pins and hunt.may_roll and _loses_little_too_much(hunt, judged)


def with_another_bearing(hunt: Hunt, found: Found, judged: Verdict | Foreseen) -> Found | None:
    """The best design with other cam bearings than those that lose a little too much; or None.

    What one with another bearing loses differs by more than a tenth, while the search knows masses
    alone; each search for another goal, or with needles, makes it heavier by far.
    """
    if hunt.goal == _COOL or not _loses_little_too_much(hunt, judged):
        return None
    hunt.too_warm.add(found.cam)
    other = None if len(hunt.too_warm) > _MOST_BEARINGS else lightest(hunt)
    if other is None or other.weak:
        hunt.too_warm.clear()
        return None
    hunt.say("searching with other cam bearings, for a gearbox that loses less")
    return other


def turned(hunt: Hunt, found: Found, judged: Verdict | Foreseen) -> bool:
    """Whether the hunt now goes for other pins, or for what a design falls short of."""
    if _needles_help(hunt, judged):
        hunt.pins = (True,)
        hunt.say("searching with the output pins on needles")
        return True
    failing = {line.id for line in judged.lines if line.status in {"fail", "unknown"}}
    if failing & _BY_STRENGTH and failing <= {*_BY_STRENGTH, "YIELD", *SHAFT}:
        if not hunt.may_be_sturdier:
            return False
        if failing & SHAFT:
            stronger_shaft(hunt, found, judged.lines)
        hunt.sturdier *= _STURDIER
        hunt.say(f"searching for a gearbox with {hunt.sturdier:.3g} times the reserve at the peak")
        return True
    if failing & BY_HEAT and CONTINUOUS in hunt.requirements.derived:
        return False
    goals = [goal for goal in _goals(hunt, failing, judged) if goal not in hunt.tried]
    if not goals or goals[0] == hunt.goal:
        return False
    if failing & SHAFT:
        stronger_shaft(hunt, found, judged.lines)
    hunt.tried |= {hunt.goal, goals[0]}
    hunt.goal, hunt.fit = goals[0], FITS[0]
    hunt.say(f"searching with {goals[0]} as the objective, which is asked for")
    return True


def _goals(hunt: Hunt, failing: set[str], judged: Verdict | Foreseen) -> list[Goal]:
    """Goals of searches that may meet what fails, where they may meet all of it."""
    asked = failing - {"YIELD", *SHAFT}
    if asked == {_MASS}:
        mass = _mass(judged)
        if hunt.goal != "mass":
            return ["mass"] if mass.known else []
        return ["size"] if mass.known and mass.margin >= _SMALLER_BRINGS else []
    return [goal for name, goal in _GOALS.items() if name in failing and asked <= _GOALS.keys()]
