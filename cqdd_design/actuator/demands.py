"""What requirements ask of an actuator: their operating points, and the heat of a duty cycle."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.actuator.operating import Judgement, judge
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.thermal import runaway_current, steady_state
from cqdd_design.design import Requirements
from cqdd_design.design.requirements import DutyPoint


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
    """Peak torque at standstill, continuous torque at its speed, every step of the duty."""
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
    for k, step in enumerate(requirements.duty, 1):
        size, speed = abs(step.torque), abs(step.speed)
        judged = _judged(parameters, step)
        found.append(
            Demand(f"duty {k}", size, speed, _generates(step), lasting=False, found=judged)
        )
    return tuple(found)


def _generates(step: DutyPoint) -> bool:
    """Whether the output drives the motor."""
    return step.torque * step.speed < 0.0


def _judged(parameters: ActuatorParameters, step: DutyPoint) -> Judgement:
    torque = abs(step.torque) * (-1.0 if _generates(step) else 1.0)
    return judge(parameters, torque, abs(step.speed), lasting=False, hot=True)


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
    if not requirements.duty:
        return None
    squares = heat = 0.0
    for step in requirements.duty:
        need = _judged(parameters, step).need
        squares += step.share * need.current**2
        heat += step.share * need.heat
    current = math.sqrt(squares)
    motor, thermal = parameters.motor, parameters.thermal
    if current >= runaway_current(motor, thermal):
        return DutyHeat(current, math.inf)
    return DutyHeat(current, steady_state(motor, thermal, current, heat)[0])
