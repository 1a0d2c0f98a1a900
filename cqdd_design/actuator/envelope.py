"""Torque over speed at the output: the curves within which an actuator works."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.actuator.operating import (
    envelope_torque,
    held_torque,
    output_torque,
    torque_from_current,
)
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray

OVERLOADS = (10.0, 60.0)
"""Times of the overload curves, s."""


@dataclass(frozen=True)
class LimitCurve:
    """One limit at the output, up to where it meets zero.

    Attributes
    ----------
    speed, torque : array (S,)
        rad/s and N m.
    temperature : float
        Of the winding where drive and voltage limit, deg C; nan where heat does.
    seconds : float
        From cold until the winding is at its limit; inf where that is for ever.
    """

    speed: FloatArray
    torque: FloatArray
    temperature: float = math.nan
    seconds: float = math.nan


def driver_torque(parameters: ActuatorParameters, speed: float) -> float:
    """Torque of the driver's current at an output speed (rad/s), the winding at ambient, N m."""
    limit, ambient = parameters.drive.current_limit, parameters.thermal.ambient
    return float(torque_from_current(parameters, limit, speed, ambient)[0])


def limit_curves(parameters: ActuatorParameters, top: float) -> tuple[LimitCurve, ...]:
    """Cold and warm limit of drive and voltage, and limits of heat, up to a speed (rad/s).

    Curves of heat follow voltage, driver or motor where these bind first, and are left out where
    they always do.
    """
    thermal = parameters.thermal
    slow = parameters.friction.stribeck_speed / abs(parameters.gear.ratio)
    speed = np.unique(np.r_[np.linspace(0.0, top, 180), slow * np.linspace(0.0, 3.0, 16)])
    cold = envelope_torque(parameters, speed, thermal.ambient)
    hot = envelope_torque(parameters, speed, thermal.most)
    found = [
        LimitCurve(*_kept(speed, cold), temperature=thermal.ambient),
        LimitCurve(*_kept(speed, hot), temperature=thermal.most),
    ]
    bound = np.maximum(cold, hot)
    if math.isfinite(parameters.motor.peak_torque):
        bound = np.minimum(bound, output_torque(parameters, parameters.motor.peak_torque, speed))
    coarse = np.unique(np.r_[0.0, slow * np.array([0.5, 1.0, 1.5, 2.0]), np.linspace(0.0, top, 40)])
    for seconds in (math.inf, *OVERLOADS[::-1]):
        torque = held_torque(parameters, coarse, seconds)
        # A heat limit at the driver's own limit says nothing.
        if not np.any(torque < 0.999 * np.interp(coarse, speed, bound)):
            continue
        torque = np.minimum(np.interp(speed, coarse, torque), bound)
        found.append(LimitCurve(*_kept(speed, torque), seconds=seconds))
    return tuple(found)


def _kept(speed: FloatArray, torque: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A curve up to where it meets zero."""
    below = np.flatnonzero(torque <= 0.0)
    if not below.size or below[0] == 0:
        return speed, np.maximum(torque, 0.0)
    k = int(below[0])
    share = float(torque[k - 1] / (torque[k - 1] - torque[k]))
    at = float(speed[k - 1] + share * (speed[k] - speed[k - 1]))
    return np.r_[speed[:k], at], np.r_[torque[:k], 0.0]
