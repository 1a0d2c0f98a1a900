"""What simulators want of an actuator: the same numbers on both sides of the gear.

Reflection through a gear of n = abs(ratio): torques times n, speeds and angles over n, inertia and
damping times n^2. Everything here has the drive's sense of rotation: a positive command moves the
joint in the positive sense. A gearbox with a fixed ring reverses (ratio = -n), so the crank then
turns in the negative sense; in hardware two motor phases are swapped or the driver inverts. No
client gets a negative ratio: one that multiplies the command by it would run backwards.

Friction of both sides is independent of load here; what depends on load is in `load_forward` and
`load_backward`, which few clients can express.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cqdd_design.actuator.load_friction import carried_torque
from cqdd_design.actuator.motor import no_load_speed, resistance_at, torque_constant_at
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray, FrictionParameters
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.errors import DesignError

_NEGLIGIBLE = 1e-4
"""Harmonics of ripple below this share of the largest are not told."""
_POINTS_PER_PERIOD, _NEWTON_STEPS = 16, 30
_LEAST_SLOPE = 0.05
"""Of carried torque over the motor's: below it the crank as good as turns alone."""


@dataclass(frozen=True)
class JointSide:
    """An actuator seen from its joint, motor as warm as what is around it.

    Attributes
    ----------
    reduction : float
        n, positive.
    crank_sense : int
        +1 or -1: sense of the crank for a positive command.
    motor_constant, resistance : float
        K of the motor, N m/A, and its resistance from line to line, ohm.
    torque_constant : float
        Torque at the joint over current, without losses, N m/A.
    stall_torque : float
        At full voltage if the drive did not limit current, without losses, N m.
    peak_torque : float
        The same with the drive's limit, and no more than the motor's own peak torque, N m.
    continuous_torque : float
        Held for ever at standstill by the thermal model and the drive, winding and magnets at the
        winding's limit, without losses, N m; what other parts stand is not in it.
    ideal_speed : float
        Full voltage over back-EMF constant, no friction, rad/s.
    no_load_speed : float
        With the friction of both sides, at full voltage, rad/s; 0 where friction holds the motor.
    corner_speed : float
        Up to here the peak torque is available at full voltage, no friction, rad/s.
    motor_inertia, output_inertia, reflected_inertia : float
        Motor side as it appears at the joint, output side, and both together, kg m^2.
    coulomb, breakaway : float
        Friction of both sides in motion and at rest, no load, N m.
    viscous : float
        Of both sides, the motor's own drag included, N m s/rad.
    stribeck_speed : float
        Of the joint, rad/s.
    """

    reduction: float
    crank_sense: int
    motor_constant: float
    resistance: float
    torque_constant: float
    stall_torque: float
    peak_torque: float
    continuous_torque: float
    ideal_speed: float
    no_load_speed: float
    corner_speed: float
    motor_inertia: float
    output_inertia: float
    reflected_inertia: float
    coulomb: float
    breakaway: float
    viscous: float
    stribeck_speed: float


def joint_side(parameters: ActuatorParameters) -> JointSide:
    """Reflect an actuator to its joint."""
    motor, drive, friction = parameters.motor, parameters.drive, parameters.friction
    thermal, volts = parameters.thermal, drive.supply_voltage
    n, at = abs(parameters.gear.ratio), thermal.ambient
    # As the bench runs it: cold, at the temperature of the place.
    motor_constant = float(torque_constant_at(motor, at))
    resistance = float(resistance_at(motor, at))
    constant = n * motor_constant
    stall_current = volts / resistance
    peak_current = min(stall_current, parameters.peak_current)
    held = min(continuous_current(motor, thermal), peak_current)
    held *= float(torque_constant_at(motor, thermal.most))
    return JointSide(
        reduction=n,
        crank_sense=int(math.copysign(1.0, parameters.gear.ratio)),
        motor_constant=motor_constant,
        resistance=resistance,
        torque_constant=constant,
        stall_torque=constant * stall_current,
        peak_torque=constant * peak_current,
        continuous_torque=n * held,
        ideal_speed=volts / constant,
        no_load_speed=idle_speed(parameters, at),
        corner_speed=(volts - peak_current * resistance) / constant,
        motor_inertia=n**2 * parameters.motor_side_inertia,
        output_inertia=parameters.gear.output_inertia,
        reflected_inertia=parameters.reflected_inertia,
        coulomb=n * motor_coulomb(parameters) + friction.output_coulomb,
        breakaway=n * motor_breakaway(parameters)
        + friction.output_coulomb * (1.0 + friction.stribeck_extra),
        viscous=n**2 * motor_viscous(parameters) + friction.output_viscous,
        stribeck_speed=friction.stribeck_speed / n,
    )


def idle_speed(parameters: ActuatorParameters, temperature: float) -> float:
    """No-load speed of the output at a winding temperature (deg C), all friction on it, rad/s."""
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    motor_speed = no_load_speed(
        parameters.motor,
        parameters.drive.supply_voltage,
        temperature=temperature,
        drag=friction.motor_coulomb + friction.output_coulomb / n,
        viscous=friction.motor_viscous + friction.output_viscous / n**2,
    )
    return motor_speed / n


def motor_coulomb(parameters: ActuatorParameters) -> float:
    """Friction at the motor independent of speed and load, the motor's own included, N m."""
    return parameters.friction.motor_coulomb + parameters.motor.dry_drag


def motor_breakaway(parameters: ActuatorParameters) -> float:
    """Friction at the motor before it moves, N m; the motor's own drag has no Stribeck effect.

    Cogging holds the motor too, but gives back what it takes: `backdrive_static` counts it.
    """
    friction = parameters.friction
    return friction.motor_coulomb * (1.0 + friction.stribeck_extra) + parameters.motor.dry_drag


def motor_viscous(parameters: ActuatorParameters) -> float:
    """Drag over speed at the motor, its own included, N m s/rad."""
    return parameters.friction.motor_viscous + parameters.motor.drag_slope


def backdrive_static(parameters: ActuatorParameters) -> float:
    """Torque on the output that makes the resting actuator turn, phases open, N m.

    Friction of both sides at rest, the motor's drag, and the cogging that has to be climbed; inf
    where friction under load holds any torque.
    """
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    rise = 1.0 + friction.stribeck_extra
    at_motor = motor_breakaway(parameters) + parameters.motor.cogging_amplitude
    return _driven_back(friction, n * at_motor, rise) + friction.output_coulomb * rise


def backdrive_dynamic(parameters: ActuatorParameters, speed: float = 0.0) -> float:
    """Torque on the output that keeps the actuator turning at a speed (rad/s), phases open, N m.

    Cogging takes and gives; inf where friction under load holds any torque.
    """
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    at_motor = motor_coulomb(parameters) + motor_viscous(parameters) * n * abs(speed)
    carried = _driven_back(friction, n * at_motor, 1.0)
    return carried + friction.output_coulomb + friction.output_viscous * abs(speed)


def _driven_back(friction: FrictionParameters, left: float, rise: float) -> float:
    """Torque that the output carries while what is left of it turns the motor, N m.

    inf where friction holds any torque, or all above the knee.
    """
    below = 1.0 - friction.load_backward * rise
    beyond = 1.0 - friction.load_backward * rise * (1.0 + friction.load_growth)
    if below <= 0.0 or (beyond <= 0.0 and left > below * friction.load_knee):
        return math.inf
    return float(carried_torque(friction, left, rise, -1.0, least=1e-12))


def delivered_peak_torque(parameters: ActuatorParameters, side: JointSide) -> float:
    """Peak torque at the joint in slow motion, N m; 0 where friction holds the motor.

    Of the motor's peak torque its Coulomb friction is taken off; of the rest the gear passes on
    what friction under load leaves, and the output side's Coulomb friction takes the last part.
    """
    friction = parameters.friction
    given = max(side.peak_torque - side.reduction * motor_coulomb(parameters), 0.0)
    carried = float(carried_torque(friction, given, 1.0, 1.0))
    return max(carried - friction.output_coulomb, 0.0)


def held_back_torque(parameters: ActuatorParameters, side: JointSide) -> float:
    """Friction under load on a locked output at the peak torque, N m at the joint.

    That at rest exceeds that in motion by the Stribeck share.
    """
    rise = 1.0 + parameters.friction.stribeck_extra
    carried = carried_torque(parameters.friction, side.peak_torque, rise, 1.0)
    return side.peak_torque - float(carried)


@dataclass(frozen=True, eq=False)
class RippleHarmonic:
    """One harmonic of the torque ripple at the joint: amplitude sin(order q + phase).

    Attributes
    ----------
    order : int
        Periods in one turn of the joint.
    amplitude : float
        N m at the joint, not negative.
    phase : float
        rad, at joint angle 0.
    """

    order: int
    amplitude: float
    phase: float


def ripple_harmonics(
    parameters: ActuatorParameters, torque: float | None = None
) -> tuple[RippleHarmonic, ...]:
    """Harmonics of the ripple torque at a steady current, slow motion, no friction.

    With the crank at ratio times q the gearbox stores ``s(q) E(c)``, ``c = q + eps(q) - output``:
    s is the stiffness over its mean, E the spring's energy at the closing c. It carries
    ``G = s dE/dc`` to the output, and a motor torque worth T at the joint holds it where

        T = G (1 + deps/dq) + E ds/dq,    E = |G| d/((p + 1) s),    d = (T0/k) (|G|/(s T0))^(1/p)

    with the windup d of a spring of stiffness k at the torque T0 and of exponent p. The ripple
    ``Q(q) = G - T`` is to first order ``-dW/dq`` at constant output torque, with
    ``W = T eps - p/(p + 1) |T| d``: the first part changes sign with the torque, the second does
    not. Harmonics are those of the whole of it, sums and differences of orders included.

    Parameters
    ----------
    torque : float, optional
        T, N m, of the sign of the joint; default the torque at which the error was solved.

    Returns
    -------
    tuple of RippleHarmonic
        In rising order, without those below a ten-thousandth of the largest.

    Raises
    ------
    DesignError
        When the kinematic error would turn the output back while the crank goes on.
    """
    gear = parameters.gear
    carried = gear.error_torque if torque is None else torque
    if len(gear.error_orders) == 0 or carried == 0.0:
        return ()
    ripple = _carried(parameters, carried) - carried
    spectrum = 2.0 * np.fft.rfft(ripple)[: len(ripple) // 4] / len(ripple)
    spectrum[0] = 0.0
    size = np.abs(spectrum)
    kept = np.flatnonzero(size > max(_NEGLIGIBLE * size.max(), 1e-12 * abs(carried)))
    # c cos(x) - s sin(x) of c + i s is |c + i s| sin(x + phase).
    return tuple(
        RippleHarmonic(int(k), float(size[k]), math.atan2(spectrum[k].real, -spectrum[k].imag))
        for k in kept
    )


def ripple_rms(harmonics: Iterable[RippleHarmonic]) -> float:
    """R.m.s. of some harmonics together, N m."""
    return math.sqrt(0.5 * sum(one.amplitude**2 for one in harmonics))


def _carried(parameters: ActuatorParameters, torque: float) -> FloatArray:
    """Torque carried to the output at even joint angles of a turn, N m, by Newton's method."""
    gear = parameters.gear
    most = int(np.max(gear.error_orders))
    count = 1 << math.ceil(math.log2(max(_POINTS_PER_PERIOD * most, 64)))
    _, error_slope = _series(parameters, gear.error_cosine, gear.error_sine, count)
    share, share_slope = _series(parameters, gear.stiffness_cosine, gear.stiffness_sine, count)
    share = 1.0 + share
    power, reference = gear.stiffening, gear.error_torque
    found = np.full(count, torque)
    for _ in range(_NEWTON_STEPS):
        size = np.abs(found)
        windup = reference / gear.stiffness * (size / (share * reference)) ** (1.0 / power)
        bend = windup * share_slope / ((power + 1.0) * share)
        tangent = 1.0 + error_slope + (1.0 + 1.0 / power) * np.sign(found) * bend
        missing = torque - found * (1.0 + error_slope) - size * bend
        if np.min(tangent) <= _LEAST_SLOPE or not np.all(np.isfinite(missing)):
            raise DesignError(
                f"gear.error_cosine and its kin turn the output back while the crank goes on at "
                f"{abs(torque):g} N*m, so it has no torque ripple to export; lower them, or the "
                "torque."
            )
        found = found + missing / tangent
        if np.max(np.abs(missing)) <= 1e-13 * abs(torque):
            break
    return found


def _series(
    parameters: ActuatorParameters, cosine: FloatArray, sine: FloatArray, count: int
) -> tuple[FloatArray, FloatArray]:
    """A series and its slope over the joint's angle, at `count` even places of a turn."""
    gear = parameters.gear
    orders = np.asarray(gear.error_orders, dtype=int)
    spectrum = np.zeros(count // 2 + 1, dtype=complex)
    # The crank's angle is the ratio times the joint's, whose sign turns the sines around.
    np.add.at(spectrum, orders, 0.5 * (cosine - 1j * math.copysign(1.0, gear.ratio) * sine))
    slope = 1j * np.arange(len(spectrum)) * spectrum
    return np.fft.irfft(spectrum, count) * count, np.fft.irfft(slope, count) * count
