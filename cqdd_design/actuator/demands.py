"""What requirements ask of an actuator: their operating points, and the heat of a duty cycle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from cqdd_design.actuator.duty_points import ASKED, SLACK, duty_points
from cqdd_design.actuator.operating import Judgement, Need, judge, needed
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.thermal import runaway_current, steady_state
from cqdd_design.design import Requirements


@dataclass(frozen=True)
class Demand:
    """An operating point of the requirements, judged.

    Attributes
    ----------
    torque, speed : float
        At the output, sizes, N m and rad/s.
    generating : bool
        Whether the output drives the motor there.
    lasting : bool
        Whether the point has to be held for ever.
    """

    name: str
    torque: float
    speed: float
    generating: bool
    lasting: bool
    found: Judgement


def demands(parameters: ActuatorParameters, requirements: Requirements) -> tuple[Demand, ...]:
    """Peak torque at standstill, continuous torque at its speed, every step of the duty.

    Of a duty over time the rows that :func:`.duty_points` names.
    """
    turning = requirements.held_speed / abs(parameters.gear.ratio)
    peak, steady = requirements.peak_torque, requirements.continuous_torque
    found = [
        Demand(
            "peak torque",
            abs(peak),
            0.0,
            peak < 0.0,
            lasting=False,
            found=judge(parameters, peak, 0.0, lasting=False, hot=False),
        ),
        Demand(
            "continuous torque",
            abs(steady),
            turning,
            steady < 0.0,
            lasting=True,
            found=judge(parameters, steady, turning, lasting=True, hot=True),
        ),
    ]
    log = requirements.duty_log
    steps = [(f"duty {k}", one.torque, one.speed) for k, one in enumerate(requirements.duty, 1)]
    if log is not None:
        rows = duty_points(parameters, log, peak).named
        steps = [(f"duty, line {row.line}", row.torque, row.speed) for row in rows]
    return (*found, *(_step(parameters, peak, *step) for step in steps))


PEAK_AT_SPEED = "peak torque at its speed"


def asked_points(parameters: ActuatorParameters, requirements: Requirements) -> tuple[Demand, ...]:
    """Points of :func:`demands` that are asked for, the peak torque at its speed beside them.

    Under a duty nothing is asked of the continuous torque.
    """
    peak, steady, *duty = demands(parameters, requirements)
    found = [peak]
    speed = requirements.speed_at_peak
    if speed is not None:
        judged = judge(parameters, requirements.peak_torque, speed, lasting=False, hot=False)
        found.append(replace(peak, name=PEAK_AT_SPEED, speed=speed, found=judged))
    if not requirements.load_cases:
        found.append(steady)
    return (*found, *duty)


def _step(
    parameters: ActuatorParameters, peak: float, name: str, torque: float, speed: float
) -> Demand:
    """A step of the duty, with its signs: hot, or cold where that alone is outside.

    Above the peak torque, N m, up to which parts are judged, it is outside as well.

    Cold magnets ask for more voltage at a speed, hot ones for more current at a torque.
    """
    size, turning, generates = abs(torque), abs(speed), torque * speed < 0.0
    asked = -size if generates else size
    hot, cold = (
        judge(parameters, asked, turning, lasting=False, hot=warm) for warm in (True, False)
    )
    judged = cold if hot.inside and not cold.inside else hot
    if size > peak * SLACK:
        judged = replace(judged, binding=(*judged.binding, ASKED))
    return Demand(name, size, turning, generates, lasting=False, found=judged)


def _hot_need(parameters: ActuatorParameters, torque: float, speed: float) -> Need:
    """What a point with its signs asks for, winding and magnets at the winding's limit."""
    size = math.copysign(abs(torque), -1.0 if torque * speed < 0.0 else 1.0)
    return needed(parameters, size, abs(speed), parameters.thermal.most)


@dataclass(frozen=True)
class DutyHeat:
    """Where a duty cycle drives the winding, by its mean losses.

    Attributes
    ----------
    current : float
        r.m.s., A.
    winding : float
        Temperature at which the winding settles, deg C; inf where it heats without end.
    """

    current: float
    winding: float


def duty_heat(parameters: ActuatorParameters, requirements: Requirements) -> DutyHeat | None:
    """Where the winding settles over the duty cycle; None without one."""
    log = requirements.duty_log
    if log is not None:
        points = duty_points(parameters, log, requirements.peak_torque)
        current, heat = points.current_rms, points.heat
    elif requirements.duty:
        squares = heat = 0.0
        for step in requirements.duty:
            need = _hot_need(parameters, step.torque, step.speed)
            squares += step.share * need.current**2
            heat += step.share * need.heat
        current = math.sqrt(squares)
    else:
        return None
    motor, thermal = parameters.motor, parameters.thermal
    if current >= runaway_current(motor, thermal):
        return DutyHeat(current, math.inf)
    return DutyHeat(current, steady_state(motor, thermal, current, heat)[0])
