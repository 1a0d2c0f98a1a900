"""Motor and drive in the steady state: constants in every convention, envelope, limits.

The one convention inside is the power-equivalent DC machine of :mod:`.parameters`. With sinusoidal
EMF and field-oriented currents the DC voltage is the peak of the line-to-line voltage and the DC
current is sqrt(3)/2 of the peak of the phase current, so that v i is the whole electrical power,
3/2 v_phase i_phase, and R i^2 with R line to line the whole copper loss (wye)::

    K = K_line,peak = sqrt(3) K_phase,peak        emf over speed
    tau = sqrt(3)/2 K i_peak = sqrt(3/2) K i_rms  per ampere of phase current
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.parameters import DriveParameters, FloatArray, MotorParameters
from cqdd_design.catalog.motors import CONVENTIONS, COPPER_COEFFICIENT, MAGNET_COEFFICIENT

_SLACK = 0.005
"""Of a peak torque that is met and not exceeded, as a share."""


def motor_constants(torque_constant: float) -> dict[str, float]:
    """K of the DC machine, N m/A, in each of `CONVENTIONS`, N m/A or V s/rad.

    Examples
    --------
    >>> constants = motor_constants(9.549 / 55.0)
    >>> round(constants["torque_per_peak"], 4), round(constants["torque_per_rms"], 4)
    (0.1504, 0.2126)
    """
    return {name: share * torque_constant for name, share in CONVENTIONS.items()}


def beyond_peak(motor: MotorParameters, currents: ArrayLike) -> str:
    """A sentence where currents (A) give more than the motor's own peak torque; else empty.

    A drive keeps its own limit, whatever the motor bears.
    """
    share = float(np.mean(np.abs(currents) > (1.0 + _SLACK) * motor.peak_current))
    if share == 0.0:
        return ""
    return (
        f"the motor gives more than its own peak torque of {motor.peak_torque:g} N*m in "
        f"{share:.2%} of the records, which its catalogue does not allow; lower "
        f"motor.current_limit to {motor.peak_current:.3g} A, or ask for less."
    )


def resistance_at(motor: MotorParameters, temperature: ArrayLike) -> FloatArray:
    """Line-to-line resistance at winding temperatures (deg C), ohm."""
    rise = np.asarray(temperature, dtype=float) - motor.reference_temperature
    return np.asarray(motor.resistance * (1.0 + COPPER_COEFFICIENT * rise))


def torque_constant_at(motor: MotorParameters, temperature: ArrayLike) -> FloatArray:
    """K at magnet temperatures (deg C), N m/A."""
    rise = np.asarray(temperature, dtype=float) - motor.reference_temperature
    return np.asarray(motor.torque_constant * (1.0 - MAGNET_COEFFICIENT * rise))


def iron_drag(motor: MotorParameters, speed: ArrayLike) -> FloatArray:
    """The motor's own drag torque at motor speeds (rad/s), with their sign, N m; no cogging."""
    w = np.asarray(speed, dtype=float)
    return np.asarray(motor.drag_slope * w + motor.dry_drag * np.sign(w))


def no_load_speed(
    motor: MotorParameters,
    voltage: float,
    *,
    temperature: float = 25.0,
    drag: float = 0.0,
    viscous: float = 0.0,
) -> float:
    """Speed at which the motor's torque just overcomes its own drag and what else is given, rad/s.

    0 where the drag holds the motor. The sign of the voltage (V) is that of the speed; winding and
    magnets are at one temperature (deg C); further drag torque and drag torque over speed count at
    the motor, N m and N m s/rad.
    """
    resistance = float(resistance_at(motor, temperature))
    constant = float(torque_constant_at(motor, temperature))
    driving = constant * abs(voltage) / resistance - motor.dry_drag - drag
    speed = driving / (constant**2 / resistance + motor.drag_slope + viscous)
    return math.copysign(max(speed, 0.0), voltage)


def greatest_torque(
    motor: MotorParameters, drive: DriveParameters, speed: ArrayLike, temperature: float
) -> FloatArray:
    """Greatest shaft torque (S,) at motor speeds (S,), rad/s, N m; its own drag is taken off.

    Winding and magnets are equally warm (deg C). The current lies within the driver's limit and
    what the supply drives against the EMF. Where the EMF drives more than the limit through the
    winding whatever the drive does, it is what the circuit gives.
    """
    w, limit = np.atleast_1d(np.asarray(speed, dtype=float)), drive.current_limit
    resistance = float(resistance_at(motor, temperature))
    constant = float(torque_constant_at(motor, temperature))
    upper = (drive.supply_voltage - constant * w) / resistance
    lower = (-drive.supply_voltage - constant * w) / resistance
    current = np.where(lower > limit, lower, np.minimum(upper, limit))
    return np.asarray(constant * current - iron_drag(motor, w))
