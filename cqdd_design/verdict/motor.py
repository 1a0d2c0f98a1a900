"""Lines of the motor: what it reaches through this gearbox, and what of it is not known."""

from __future__ import annotations

import math
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace

import numpy as np

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import Demand, demands
from cqdd_design.actuator.duty_points import ASKED, DutyPoints, duty_points
from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.operating import (
    DRIVER,
    PEAK,
    VOLTAGE,
    Judgement,
    envelope_torque,
    held_torque,
    judge,
    lasting_torque,
    output_torque,
)
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.checks.remedies import PEAK_KEY, lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.geometry.limits import rounded_down, rounded_up
from cqdd_design.machine import Machine
from cqdd_design.machine.lasting import lasting_speed
from cqdd_design.results import Check
from cqdd_design.solids.motor_rules import undrawn_sizes
from cqdd_design.verdict.remembered import remembered

MODEL = "operating points of the simulated actuator"
ALL_PARTS = f"{MODEL}, as far as all parts stand it"
_RPM = 30.0 / math.pi
_HALVINGS = 50
_RAISED = {
    VOLTAGE: "motor.voltage (and requirements.voltage where it is stated) to about {:g} V",
    DRIVER: "motor.current_limit (and requirements.current where it is stated) to about {:g} A",
}
"""What to raise where it binds."""
_LOWER_CONTINUOUS = "lower requirements.continuous_torque to about"
_MOST_RAISED = 10.0
"""Above so many times what there is it is no cure."""
_ZOOMS, _SPEEDS = 3, 33
"""Of the search for the speed up to which a torque is held, and speeds that are tried in each."""
_FIGURES = (
    ("peak_torque", "peak torque"),
    ("bore_diameter", "stator bore"),
    ("rotor_inertia", "rotor inertia"),
    ("line_resistance", "resistance"),
    ("torque_constant", "torque constant"),
)
DRAG_MISSING = "drag"
_OF_DRAG = {
    "MOTOR-CONTINUOUS",
    "MOTOR-SPEED",
    "DUTY-ENVELOPE",
    "THERMAL-RISE",
    "THERMAL-CLEARANCE",
    "SURFACE-TEMPERATURE",
}
"""Lines that a motor's own drag makes worse."""
GIVE = "give them in the design's [motor] table or with --motor-file, or name a motor that has them"


def missing_figures(motor: Motor) -> tuple[str, ...]:
    """What the catalogue, or a file instead, does not say of a motor.

    An inrunner stands behind the gearbox: nothing asks for the bore of its stator.
    """
    figures = [one for one in _FIGURES if not (motor.is_inrunner and one[0] == "bore_diameter")]
    missing = tuple(words for key, words in figures if getattr(motor, key) is None)
    return (*missing, DRAG_MISSING) if motor.lacks_drag else missing


def motor_lines(
    machine: Machine,
    actuator: ActuatorParameters | None,
    why: str,
    *,
    uncooled: str = "",
    lasting: float | None = None,
) -> tuple[Check, ...]:
    """All lines of this chapter.

    Parameters
    ----------
    actuator : ActuatorParameters or None
        None where it cannot be simulated.
    why : str
        Why not.
    uncooled : str
        Why the way of the heat is not known, where it is neither drawn nor stated.
    lasting : float, optional
        Torque that all parts stand for ever at that speed, N m; default not looked for.
    """
    asked, motor = machine.design.requirements, machine.motor
    lines = list(_data(motor))
    if actuator is None:
        return (*(_unknown(one, asked, why) for one in _LIMITS), *lines, *_bore(machine))
    peak, steady, *duty = demands(actuator, asked)
    lines += [
        _peak(peak, actuator, machine),
        # Under a duty its own heat decides, see THERMAL-RISE.
        *(() if duty else (_continuous(steady, actuator, machine, uncooled, lasting),)),
        _speed(actuator, asked),
        *_bore(machine),
    ]
    if asked.duty_log is not None:
        return (*lines, _logged(duty_points(actuator, asked.duty_log, asked.peak_torque)))
    return (*lines, _duty(duty)) if duty else tuple(lines)


_LOOKS = 3
"""At peak torques that are reached, each a little below the one before."""
_LIMITS = ("MOTOR-PEAK", "MOTOR-CONTINUOUS", "MOTOR-SPEED")


def _unknown(check_id: str, asked: Requirements, why: str) -> Check:
    limit = {
        "MOTOR-PEAK": asked.peak_torque,
        "MOTOR-CONTINUOUS": asked.continuous_torque,
        "MOTOR-SPEED": asked.input_speed * _RPM,
    }[check_id]
    told = why.removesuffix(".")
    return build_check(check_id, None, limit, told, "see why it cannot be simulated", model=MODEL)


def _data(motor: Motor) -> tuple[Check, ...]:
    missing = missing_figures(motor)
    if not missing:
        return ()
    told = f"not known of '{motor.name}': {', '.join(missing)}"
    if DRAG_MISSING in missing:
        told += "; without its own drag (coulomb, viscous) lines of heat and speed are not known"
    count = float(len(_FIGURES) + 1)
    return (build_check("MOTOR-DATA", None, count, told, GIVE, model=MODEL),)


def with_drag(lines: Iterable[Check], motor: Motor) -> tuple[Check, ...]:
    """The lines, none of which passes that an own drag of the motor nobody knows would make worse.

    What fails without it fails.
    """
    if not motor.lacks_drag:
        return tuple(lines)
    return tuple(
        replace(
            one,
            value=None,
            substituted=f"without the motor's own drag, which is not known: {one.substituted}",
            remedy=GIVE,
        )
        if one.id in _OF_DRAG and one.status == "pass"
        else one
        for one in lines
    )


def _peak(demand: Demand, actuator: ActuatorParameters, machine: Machine) -> Check:
    motor, asked, most = machine.motor, machine.design.requirements, demand.found.most
    binding = ", ".join(demand.found.binding) or "nothing"
    hot = judge(actuator, asked.peak_torque, 0.0, lasting=False, hot=True)
    told = (
        f"{most:.4g} N*m at rest, {demand.found.need.current:.3g} A for the peak torque, motor "
        f"cold; {hot.most:.4g} N*m with magnets and winding at {actuator.thermal.most:g} degC; "
    )
    if motor.peak_torque is None and most >= asked.peak_torque:
        why = f"{told}the motor's own peak torque is not known"
        return build_check("MOTOR-PEAK", None, asked.peak_torque, why, GIVE, model=MODEL)
    lower = ""
    if 0.0 < most < asked.peak_torque:
        # Of a look in a search nobody reads it.
        held = most if machine.stiff else _reached_when_asked(machine, most)
        lower = f"{lower_peak(held, asked.continuous_torque, PEAK_KEY)}, "
    return build_check(
        "MOTOR-PEAK",
        most,
        asked.peak_torque,
        f"{told}binding: {binding}",
        f"{lower}{_raised([demand.found], actuator)}take a stronger motor or more ratio",
        model=MODEL,
    )


def _reached_when_asked(machine: Machine, most: float) -> float:
    """A peak torque that is reached where it is what is asked for, N m, about that reached now.

    Friction is put in numbers up to the peak torque, and so is another with another peak.
    """

    def reached(peak: float) -> float:
        other = machine.under(peak=peak)
        return demands(actuator_parameters(other), other.design.requirements)[0].found.most

    def find() -> float:
        now, told = reached(machine.design.requirements.peak_torque), most
        for _ in range(_LOOKS):
            there = most / now * reached(told)
            if there >= rounded_down(told):
                break
            told = there
        return told

    try:
        return remembered("peak that is reached", machine, (most,), find)
    except ContactError:
        # Of a gearbox that does not carry what is asked: its own lines say so.
        return most


def _continuous(
    demand: Demand,
    actuator: ActuatorParameters,
    machine: Machine,
    uncooled: str,
    lasting: float | None,
) -> Check:
    asked = machine.design.requirements
    if uncooled:
        cure = "state what cooling reaches as drive.thermal_resistance"
        limit = asked.continuous_torque
        return build_check("MOTOR-CONTINUOUS", None, limit, uncooled, cure, model=MODEL)
    alone, still = demand.found.most, lasting_torque(actuator, 0.0)
    most = alone if lasting is None else min(alone, lasting)
    slower = ""
    if most < asked.continuous_torque:
        slower = _slower(actuator, machine, parts=lasting is not None)
    winding = f", {alone:.4g} N*m by winding and drive alone" if most < alone else ""
    unjudged = ""
    if lasting is None and not machine.stiff:
        unjudged = "; what other parts stand is not known"
    model = ALL_PARTS if most < alone else MODEL
    # What friction alone overheats holds nothing while it turns. Friction is put in numbers at the
    # torque that is asked for: at a lower one a little more may be held.
    lower = f"{_LOWER_CONTINUOUS} {rounded_down(most):g} N*m, " if most > 0.0 else ""
    return build_check(
        "MOTOR-CONTINUOUS",
        most,
        asked.continuous_torque,
        f"{most:.4g} N*m at {asked.held_speed * _RPM:.0f} rpm of the motor{winding}; {still:.4g} "
        f"N*m standing still by winding and drive alone{unjudged}",
        f"{lower}{slower}lower friction, or cool it (drive.thermal_resistance states how well)",
        model=model,
    )


def lasting_speed_of(asked: Requirements) -> float:
    """Speed of the motor that a torque held for ever is told at, rad/s.

    Under a duty its mean, unless a continuous speed is stated.
    """
    return asked.equal_speed if asked.continuous_speed is None else asked.continuous_speed


def held_up_to(actuator: ActuatorParameters, asked: Requirements) -> float:
    """Input speed up to which a continuous torque is held for ever, rpm; 0 where it never is.

    Rounded down, and no more than what is asked for.
    """
    fast, slow = asked.held_speed, 0.0
    for _ in range(_ZOOMS):
        speeds = np.linspace(slow, fast, _SPEEDS)
        held = held_torque(actuator, speeds / abs(actuator.gear.ratio)) >= asked.continuous_torque
        if not held.any():
            return 0.0
        last = int(np.flatnonzero(held)[-1])
        slow, fast = speeds[last], speeds[min(last + 1, _SPEEDS - 1)]
    told = rounded_down(slow * _RPM) if slow > 0.0 else 0.0
    slower = asked.unchecked_copy({"continuous_speed": told / _RPM})
    # Driver and supply do not come to more by that.
    if told <= 0.0 or demands(actuator, slower)[1].found.most < asked.continuous_torque:
        return 0.0
    return told


def _slower(actuator: ActuatorParameters, machine: Machine, *, parts: bool) -> str:
    """The speed up to which a continuous torque is held, in words; nothing where there is none.

    By the winding, or by all parts.
    """
    asked = machine.design.requirements
    told = held_up_to(actuator, asked)
    if told and parts:
        found = (lasting_speed(machine, told / _RPM, free=free) for free in (True, False))
        lasting = next((speed for speed in found if speed > 0.0), 0.0)
        told = rounded_down(lasting * _RPM) if lasting else 0.0
    if not told:
        return ""
    if asked.continuous_speed is None:
        return f"state continuous_speed, as it is held up to {told:g} rpm, "
    return f"lower requirements.continuous_speed to {told:g} rpm, "


def _speed(actuator: ActuatorParameters, asked: Requirements) -> Check:
    # Where the continuous torque has a speed of its own, it is judged there.
    torque = asked.continuous_torque if asked.continuous_speed is None else 0.0
    ways = {hot: _fastest(actuator, torque, hot=hot) for hot in (True, False)}
    # Cold magnets ask for more voltage, hot ones for more current.
    hot = ways[True] <= ways[False]
    fastest, drive = ways[hot], actuator.drive
    # What is not even driven at a standstill has to get there first.
    speeds = (asked.input_speed,) if fastest > 0.0 else (0.0, asked.input_speed)
    at = [speed / abs(actuator.gear.ratio) for speed in speeds]
    points = [judge(actuator, torque, speed, lasting=False, hot=hot) for speed in at]
    binding = list(dict.fromkeys(name for point in points for name in point.binding))
    raised = _raised(points, actuator).removesuffix(", or ")
    cures = [raised] if raised else []
    if fastest > 0.0:
        cures.append(f"lower requirements.input_speed to {rounded_down(fastest * _RPM):g} rpm")
    if PEAK in binding or not cures:
        cures.append("take a stronger motor or more ratio")
    return build_check(
        "MOTOR-SPEED",
        fastest * _RPM,
        asked.input_speed * _RPM,
        f"{torque:g} N*m up to {fastest * _RPM:.0f} rpm on {drive.supply_voltage:g} V and "
        f"{drive.current_limit:g} A, motor {'hot' if hot else 'cold'}; binding: "
        f"{', '.join(binding) or 'nothing'}",
        ", or ".join(cures),
        model=MODEL,
    )


def _raised(points: list[Judgement], actuator: ActuatorParameters) -> str:
    """What to raise to which values so that points are reached, in words; nothing where none do."""
    drive, binding = actuator.drive, {name for point in points for name in point.binding}
    needs = {
        VOLTAGE: (max(point.need.voltage for point in points), drive.supply_voltage),
        DRIVER: (max(point.need.current for point in points), drive.current_limit),
    }
    short = {name: needs[name] for name in _RAISED if name in binding}
    if not short or PEAK in binding or any(a > _MOST_RAISED * b for a, b in short.values()):
        return ""
    words = (_RAISED[name].format(rounded_up(needed)) for name, (needed, _) in short.items())
    return f"raise {' and '.join(words)}, or "


def _fastest(actuator: ActuatorParameters, torque: float, *, hot: bool) -> float:
    """Fastest motor speed at which a torque at the output (N m) is driven, rad/s; 0 if at none."""
    n, thermal = abs(actuator.gear.ratio), actuator.thermal
    temperature = thermal.most if hot else thermal.ambient
    strongest = actuator.motor.peak_torque

    def driven(speed: float) -> bool:
        most = float(envelope_torque(actuator, speed / n, temperature)[0])
        if math.isfinite(strongest):
            most = min(most, float(output_torque(actuator, strongest, speed / n)))
        return most >= torque

    # The speed at which the EMF is the whole supply.
    constant = float(torque_constant_at(actuator.motor, temperature))
    low, high = 0.0, actuator.drive.supply_voltage / constant
    if not driven(0.0):
        return 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if driven(middle) else (low, middle)
    return low


def _bore(machine: Machine) -> tuple[Check, ...]:
    """The ring inside the stator; no line for a motor that stands behind the gearbox."""
    outer, motor = machine.design.reducer.ring.outer_diameter, machine.motor
    if motor.is_inrunner:
        return _behind(machine, outer)
    if motor.bore_diameter is None:
        told = f"ring {outer * 1e3:.4g} mm; the stator bore of '{motor.name}' is not known"
        return (build_check("MOTOR-BORE", outer * 1e3, None, told, GIVE),)
    with suppress(DesignError):
        drawn = machine.layout.motor
        if (drawn is None and not undrawn_sizes(motor)) or (drawn is not None and drawn.behind):
            return _behind(machine, outer)
    screened = next(check for check in machine.analysis.checks if check.id == "MOTOR-BORE")
    return (replace(screened, severity="fail"),)


def _behind(machine: Machine, ring: float) -> tuple[Check, ...]:
    """Why a motor is not drawn behind the gearbox, of a ring (outside, m); none where it is."""
    try:
        if machine.layout.motor_end is not None:
            return ()
        why = machine.layout.motor_missing
    except DesignError as error:
        why = error.message
    return (build_check("MOTOR-BORE", 1e3 * ring, None, why, GIVE),)


def _logged(found: DutyPoints) -> Check:
    """Rows of a duty over time."""
    above = any(ASKED in row.binding for row in found.named if found.outside)
    return _envelope(found.outside, found.told, above=above)


def _duty(steps: list[Demand]) -> Check:
    outside = [step for step in steps if not step.found.inside]
    told = "; ".join(
        f"{step.name}: {step.torque:g} N*m at {step.speed:g} rad/s, {' and '.join(b)}"
        for step in outside[:3]
        for b in [step.found.binding]
    )
    more = f" and {len(outside) - 3} more" if len(outside) > 3 else ""
    told = f"{told}{more}" or f"all {len(steps)} steps are inside"
    above = any(ASKED in step.found.binding for step in outside)
    return _envelope(len(outside), told, above=above)


def _envelope(outside: int, told: str, *, above: bool) -> Check:
    """The line; `above` is whether the duty asks for more than parts are judged for at the peak."""
    peak = f"raise {PEAK_KEY}, for which parts are judged, " if above else ""
    return build_check(
        "DUTY-ENVELOPE",
        float(outside),
        0.0,
        told,
        f"{peak}lower torque or speed of these steps, raise motor.voltage or motor.current_limit, "
        "or take a stronger motor",
        model=MODEL,
    )
