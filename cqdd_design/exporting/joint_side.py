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
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.actuator.motor import no_load_speed, torque_constant_at
from cqdd_design.actuator.thermal import continuous_current

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters, ThermalParameters

DEAD_MASS = 1e-3
"""kg for the output body of a model, as clients refuse zero; its mass is in the housing's. Without
effect, since its centre lies on the axis."""


@dataclass(frozen=True)
class JointSide:
    """An actuator seen from its joint.

    Attributes
    ----------
    reduction : float
        n, positive.
    crank_sense : int
        +1 or -1: sense of the crank for a positive command.
    torque_constant : float
        Torque at the joint over current, without losses, N m/A.
    stall_torque : float
        At full voltage if the drive did not limit current, without losses, N m.
    peak_torque : float
        The same with the drive's limit, N m.
    continuous_torque : float
        Held for ever at standstill by the thermal model, winding and magnets at the winding's
        limit, without losses, N m.
    ideal_speed : float
        Full voltage over back-EMF constant, no friction, rad/s.
    no_load_speed : float
        With the friction of both sides, at full voltage and reference temperature, rad/s; 0 where
        friction holds the motor.
    corner_speed : float
        Up to here the peak torque is available at full voltage, no friction, rad/s.
    motor_inertia, output_inertia, reflected_inertia : float
        Motor side as it appears at the joint, output side, and both together, kg m^2.
    coulomb, breakaway : float
        Friction of both sides in motion and at rest, no load, N m.
    viscous : float
        Of both sides, iron loss included, N m s/rad.
    stribeck_speed : float
        Of the joint, rad/s.
    """

    reduction: float
    crank_sense: int
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
    n = abs(parameters.gear.ratio)
    constant = n * motor.torque_constant
    stall_current = volts / motor.resistance
    peak_current = min(stall_current, drive.current_limit)
    held = float(torque_constant_at(motor, thermal.most)) * continuous_current(motor, thermal)
    idle = no_load_speed(
        motor,
        volts,
        temperature=motor.reference_temperature,
        drag=friction.motor_coulomb + friction.output_coulomb / n,
        viscous=friction.motor_viscous + friction.output_viscous / n**2,
    )
    return JointSide(
        reduction=n,
        crank_sense=int(math.copysign(1.0, parameters.gear.ratio)),
        torque_constant=constant,
        stall_torque=constant * stall_current,
        peak_torque=constant * peak_current,
        continuous_torque=n * held,
        ideal_speed=volts / constant,
        no_load_speed=idle / n,
        corner_speed=(volts - peak_current * motor.resistance) / constant,
        motor_inertia=n**2 * parameters.motor_side_inertia,
        output_inertia=parameters.gear.output_inertia,
        reflected_inertia=parameters.reflected_inertia,
        coulomb=n * motor_coulomb(parameters) + friction.output_coulomb,
        breakaway=n * motor_breakaway(parameters)
        + friction.output_coulomb * (1.0 + friction.stribeck_extra),
        viscous=n**2 * motor_viscous(parameters) + friction.output_viscous,
        stribeck_speed=friction.stribeck_speed / n,
    )


def motor_coulomb(parameters: ActuatorParameters) -> float:
    """Friction at the motor independent of speed and load, magnetic hysteresis included, N m."""
    return parameters.friction.motor_coulomb + parameters.motor.hysteresis


def motor_breakaway(parameters: ActuatorParameters) -> float:
    """Friction at the motor before it moves, N m; hysteresis has no Stribeck effect."""
    friction = parameters.friction
    return friction.motor_coulomb * (1.0 + friction.stribeck_extra) + parameters.motor.hysteresis


def motor_viscous(parameters: ActuatorParameters) -> float:
    """Drag over speed at the motor, eddy currents included, N m s/rad."""
    return parameters.friction.motor_viscous + parameters.motor.iron_loss


def single_node(thermal: ThermalParameters) -> tuple[float, float]:
    """Resistance, K/W, and time constant, s, of one node for the two.

    It has the same steady temperature of the winding and the slower of the two time constants;
    what it lacks is the quick first rise of the winding over the housing.
    """
    within, outward = thermal.winding_to_housing, thermal.housing_to_ambient
    winding, housing = thermal.winding_capacity, thermal.housing_capacity
    rates = -np.linalg.eigvals(
        np.array(
            [
                [-1.0 / (within * winding), 1.0 / (within * winding)],
                [1.0 / (within * housing), -(1.0 / within + 1.0 / outward) / housing],
            ]
        )
    ).real
    return within + outward, float(1.0 / rates.min())


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
    """Harmonics of the ripple torque that the kinematic error makes, by virtual work.

    The output stands at q + eps(q) when the crank stands at ratio times q. A torque T carried to
    the output does work T d(eps) besides T dq, so the joint feels Q(q) = -T d(eps)/dq on top.

    Parameters
    ----------
    parameters : ActuatorParameters
    torque : float, optional
        T, N m, of the sign of the joint; default the torque at which the error was solved.

    Returns
    -------
    tuple of RippleHarmonic
        In rising order, those of no amplitude left out.
    """
    gear = parameters.gear
    carried = gear.error_torque if torque is None else torque
    sense = math.copysign(1.0, gear.ratio)
    found = []
    for order, cosine, sine in sorted(
        zip(gear.error_orders, gear.error_cosine, gear.error_sine, strict=True)
    ):
        in_sine = carried * int(order) * float(cosine)
        in_cosine = -sense * carried * int(order) * float(sine)
        amplitude = math.hypot(in_sine, in_cosine)
        if amplitude > 0.0:
            found.append(RippleHarmonic(int(order), amplitude, math.atan2(in_cosine, in_sine)))
    return tuple(found)


def value_of(parameters: ActuatorParameters, name: str) -> float:
    """Value of a dotted name such as ``motor.resistance``."""
    found: object = parameters
    for part in name.split("."):
        found = getattr(found, part)
    return float(found)  # type: ignore[arg-type]


def origin_of(parameters: ActuatorParameters, *names: str) -> str:
    """Where the named values come from, each with its name when there are several."""
    told = [(name, parameters.origins.get(name, "not stated")) for name in names]
    if len({origin for _, origin in told}) == 1:
        return told[0][1]
    return "; ".join(f"{name}: {origin}" for name, origin in told)


def provenance(design_sha256: str) -> str:
    """Which version of this package wrote a file, and for which design."""
    from cqdd_design import __version__

    return f"cqdd-design {__version__}, design sha256 {design_sha256}"
