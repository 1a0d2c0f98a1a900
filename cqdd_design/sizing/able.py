"""What is asked where nothing is said: what the motor can do through a gearbox of that ratio."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import demands
from cqdd_design.actuator.operating import held_torque
from cqdd_design.catalog.motors import Motor, find_motor
from cqdd_design.design import Requirements
from cqdd_design.design.motor import MotorTable
from cqdd_design.design.requirements import DEFAULT_CONTINUOUS_SHARE
from cqdd_design.errors import ContactError, DesignError, InfeasibleError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine

HELD_SPEED = 300.0 * math.pi / 30.0
"""Input speed of the continuous torque where neither it nor the input speed is stated, rad/s: half
a turn a second of an output at ratio 10. At its usual input speed a motor of this size is warmed to
its limit by its own drag in still air."""
PEAK, CONTINUOUS = "peak_torque", "continuous_torque"
EFFICIENCY = 0.72
"""Of motor, drag and gearbox at a first guess of the peak."""
_LASTING = 0.12
"""Continuous over peak torque at a first guess."""
_SPARE = 0.95
"""Of what the winding stands for ever: other parts may be at their limit before."""
_COOLER = 0.95
_DIGITS = 2
_SAME = 0.05
"""A torque is left as it is where what the motor can do is not more above it."""


class TooHotError(InfeasibleError):
    """A motor holds no torque for ever at the speed that is asked for."""


class NotSimulatedError(InfeasibleError):
    """Of a gearbox that bears the loads no actuator can be simulated, and so none judged."""


def first_guess(requirements: Requirements, motor: Motor | None) -> Requirements:
    """The requirements with guesses in place of torques that were not stated.

    Torques stay as they are where the motor's constant is not known.
    """
    free, row = requirements.derived, motor or find_motor(requirements.motor)
    if not free or row.torque_constant is None:
        return requirements
    usual = MotorTable()
    shaft = row.torque_constant * (requirements.current or usual.current_limit)
    shaft = min(shaft, row.peak_torque or math.inf)
    changed: dict[str, Any] = {}
    peak = requirements.peak_torque
    if PEAK in free:
        peak = rounded_down(EFFICIENCY * requirements.ratio * shaft, _DIGITS)
        changed[PEAK] = peak
    if CONTINUOUS in free:
        changed[CONTINUOUS] = rounded_down(_LASTING * peak, _DIGITS)
        stated = requirements.model_fields_set
        if not {"continuous_speed", "input_speed", "duty", "duty_file"} & stated:
            changed["continuous_speed"] = min(HELD_SPEED, requirements.input_speed)
    return _with(requirements, changed)


def what_it_can(
    machine: Machine, requirements: Requirements, *, may_rise: bool
) -> Requirements | None:
    """Torques that were not stated, as the motor reaches them in a gearbox; None where they stand.

    Parameters
    ----------
    may_rise : bool
        Whether a continuous torque that is well below what the motor holds is raised to it. A
        gearbox for more torque has more losses, so that what is raised may be too much again.

    Raises
    ------
    TooHotError
        When the motor holds no torque for ever at the speed that is asked for.
    ContactError
        When the gearbox has no equilibrium at some angle.
    NotSimulatedError
        When the actuator cannot be simulated.
    """
    free = requirements.derived
    try:
        actuator = actuator_parameters(machine)
    except ContactError:
        raise
    except DesignError as error:
        torques = (
            f"{requirements.peak_torque:g} and {requirements.continuous_torque:g} N*m for ever"
        )
        raise NotSimulatedError(
            f"no actuator can be simulated of what bears {torques}: {error.message}"
        ) from error
    changed: dict[str, Any] = {}
    if PEAK in free:
        most = demands(actuator, requirements)[0].found.most
        if most < requirements.peak_torque:
            changed[PEAK] = rounded_down(most, _DIGITS)
    if CONTINUOUS in free and not requirements.load_cases:
        speed = requirements.held_speed / requirements.ratio
        most = _SPARE * float(held_torque(actuator, speed)[0])
        if most <= 0.0:
            stated = requirements.continuous_speed is not None
            slower = "lower continuous_speed, state" if stated else "state continuous_speed,"
            raise TooHotError(
                f"motor '{machine.motor.name}' holds no torque for ever at "
                f"{requirements.held_speed * 30.0 / math.pi:.0f} rpm in still air of "
                f"{actuator.thermal.ambient:g} degC: its own drag and the gearbox's heat it to its "
                f"limit; {slower} a duty, or take another motor."
            )
        able = min(
            rounded_down(most, _DIGITS),
            _most_lasting(requirements),
            changed.get(PEAK, requirements.peak_torque),
        )
        asked = requirements.continuous_torque
        if asked > most or (may_rise and asked < able * (1.0 - _SAME)):
            changed[CONTINUOUS] = able
    return _with(requirements, changed) if changed else None


def cooler(requirements: Requirements) -> Requirements | None:
    """The requirements with a little less continuous torque; None where that was stated."""
    if CONTINUOUS not in requirements.derived or requirements.load_cases:
        return None
    less = rounded_down(_COOLER * requirements.continuous_torque, _DIGITS)
    return _with(requirements, {CONTINUOUS: less})


def _with(requirements: Requirements, changed: Mapping[str, Any]) -> Requirements:
    changes = dict(changed)
    return requirements.unchecked_copy(changes) if changes else requirements


def _most_lasting(requirements: Requirements) -> float:
    """The most continuous torque that is asked for where none is stated, N m.

    Of a peak torque that is stated the usual share: at a high ratio a motor may hold nearly all of
    it for ever, and a gearbox that lasts at that is several times as heavy.
    """
    if PEAK in requirements.derived:
        return math.inf
    return DEFAULT_CONTINUOUS_SHARE * requirements.peak_torque
