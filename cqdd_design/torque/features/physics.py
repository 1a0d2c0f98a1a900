"""What the actuator's known parameters say of the output torque, nothing learned.

Two estimates: all of it, and for networks to correct, the part without dry friction, which has no
switch in it, with the sign of friction and the gearbox's ripple beside it.

Balance of the motor side in the joint's frame, speeds and torques at the motor (w = n v)::

    K i - J_m n a - (b_m + b_iron) w = s (c_m r + h) + (T + r s f(T))/n
    tau = T - s c_o r - b_o v - J_o a

with i the drive's answer to the impedance law within current limit and supply voltage, s a smooth
sign of the speed, r = 1 + extra exp(-(w/w_s)^2) of Stribeck, and f the friction under load of
the way that power flows (:mod:`cqdd_design.actuator.load_friction`).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from cqdd_design.actuator.joint_side import motor_coulomb, motor_viscous
from cqdd_design.actuator.load_friction import carried_torque
from cqdd_design.actuator.packing import gear_table, table_points
from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    FrictionParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode, FloatArray, asked_torque
from cqdd_design.torque.features.acceleration import Differentiator, acceleration

SMOOTHING = 0.25
"""Speed over the Stribeck speed at which the smooth sign of friction has reached tanh(1)."""


def driven_torque(parameters: ActuatorParameters, episode: Episode) -> FloatArray:
    """Torque of the motor times the ratio (N,), N m: impedance law, current and voltage limits."""
    motor, drive = parameters.motor, parameters.drive
    ratio = abs(parameters.gear.ratio)
    asked = asked_torque(episode.columns, drive.position_gain, drive.velocity_gain)
    current = asked / (ratio * motor.torque_constant)
    velocity = np.asarray(episode.columns["velocity"], np.float64)
    back = motor.torque_constant * ratio * velocity
    current = np.clip(
        current,
        (-drive.supply_voltage - back) / motor.resistance,
        (drive.supply_voltage - back) / motor.resistance,
    )
    current = np.clip(current, -drive.current_limit, drive.current_limit)
    return np.asarray(ratio * motor.torque_constant * current)


def motion_balance(
    parameters: ActuatorParameters, episode: Episode, differentiator: Differentiator
) -> FloatArray:
    """Output torque (N,), N m, without dry friction: n K i - J a - b v in the joint's frame.

    J is the reflected inertia and b all viscous drag. Dry friction is left out because it is not
    known at rest: whatever stands for its switch there, a network would have to take back.
    """
    velocity = np.asarray(episode.columns["velocity"], np.float64)
    rate = acceleration(velocity, differentiator)
    drag = parameters.gear.ratio**2 * motor_viscous(parameters) + parameters.friction.output_viscous
    return np.asarray(
        driven_torque(parameters, episode) - parameters.reflected_inertia * rate - drag * velocity
    )


def friction_sign(parameters: ActuatorParameters, velocity: FloatArray) -> FloatArray:
    """Smooth sign (N,) of dry friction: ``tanh(n v / (SMOOTHING w_s))`` of a velocity (N,), rad/s.

    At rest the friction is not known from the motion, and half of its range in either direction is
    the best guess.
    """
    speed = abs(parameters.gear.ratio) * np.asarray(velocity, np.float64)
    return np.asarray(np.tanh(speed / (SMOOTHING * parameters.friction.stribeck_speed)))


def dry_friction(parameters: ActuatorParameters) -> float:
    """Coulomb friction of the motor's side at the joint, the motor's own included, N m."""
    return abs(parameters.gear.ratio) * motor_coulomb(parameters)


@functools.lru_cache(maxsize=8)
def _table(gear: GearParameters) -> FloatArray:
    # A joint in a loop asks for its ripple sample by sample.
    return gear_table(gear, table_points(gear))


def gear_ripple(
    parameters: ActuatorParameters, position: FloatArray, torque: FloatArray
) -> FloatArray:
    """What the gearbox's own errors add to a torque of the motor, N m at the joint.

    From virtual work, T = G (1 + d eps/dq) + E ds/dq with the kinematic error eps, the stiffness s
    over its mean, and the energy E = |T| d/((p + 1) s) of the windup
    d = (T0/k) (|T|/(s T0))^(1/p); the ripple is G - T.

    Parameters
    ----------
    parameters : ActuatorParameters
        Of the gearbox that turns.
    position : array (N,)
        Of the joint, homed as in the gearbox's own record, rad.
    torque : array (N,)
        Of the motor after its dry friction, times the ratio: T, N m.
    """
    gear = parameters.gear
    table = _table(gear)
    points = len(table)
    # A turn of the joint is a turn of the table, against it where the ratio is negative.
    way = math.copysign(1.0, gear.ratio)
    turns = way * np.asarray(position, np.float64) / (2.0 * math.pi)
    grid = np.arange(points) / points
    slope, share, share_slope = (
        np.interp(turns, grid, table[:, column], period=1.0) for column in (1, 2, 3)
    )
    per_angle = way * points / (2.0 * math.pi)
    size = np.abs(torque)
    windup = (size / (share * gear.error_torque)) ** (1.0 / gear.stiffening)
    windup *= gear.error_torque / gear.stiffness
    energy = size * windup / ((gear.stiffening + 1.0) * share)
    given = (torque - energy * per_angle * share_slope) / (1.0 + per_angle * slope)
    return np.asarray(given - torque)


def physical_estimate(
    parameters: ActuatorParameters, episode: Episode, differentiator: Differentiator
) -> FloatArray:
    """Output torque (N,), N m, of one episode, from its motion and the actuator's card alone.

    The drive's gains are those of the impedance law. Windup, backlash, ripple and the winding's
    heat are left out.
    """
    friction, motor, gear = parameters.friction, parameters.motor, parameters.gear
    ratio = abs(gear.ratio)
    velocity = np.asarray(episode.columns["velocity"], np.float64)
    rate = acceleration(velocity, differentiator)
    speed = ratio * velocity
    sign = friction_sign(parameters, velocity)
    with np.errstate(under="ignore"):
        rise = 1.0 + friction.stribeck_extra * np.exp(-((speed / friction.stribeck_speed) ** 2))
    left = (
        driven_torque(parameters, episode)
        - ratio**2 * parameters.motor_side_inertia * rate
        - ratio * motor_viscous(parameters) * speed
        - ratio * sign * (friction.motor_coulomb * rise + motor.dry_drag)
    )
    way = np.sign(left) * sign
    # Back-driven beyond self-locking the estimate would change its sign.
    gear_torque = np.sign(left) * carried_torque(friction, np.abs(left), rise, way, least=0.1)
    return np.asarray(
        gear_torque
        - sign * friction.output_coulomb * rise
        - friction.output_viscous * velocity
        - gear.output_inertia * rate
    )


def with_gains_of(parameters: ActuatorParameters, data: DataSet) -> ActuatorParameters:
    """The actuator under the gains that the data were recorded with."""
    drive = replace(
        parameters.drive, position_gain=data.position_gain, velocity_gain=data.velocity_gain
    )
    return replace(parameters, drive=drive)


_PARTS: Mapping[str, type[Any]] = {
    "motor": MotorParameters,
    "drive": DriveParameters,
    "thermal": ThermalParameters,
    "friction": FrictionParameters,
    "gear": GearParameters,
}


def actuator_to_dict(parameters: ActuatorParameters) -> dict[str, Any]:
    """Parameters as plain numbers and lists, for JSON; nan becomes null."""

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return value.tolist()
        return None if isinstance(value, float) and np.isnan(value) else value

    own: dict[str, Any] = {
        part: {key: plain(value) for key, value in asdict(getattr(parameters, part)).items()}
        for part in _PARTS
    }
    return own | {"name": parameters.name, "mass": parameters.mass}


def actuator_from_dict(content: Mapping[str, Any]) -> ActuatorParameters:
    """Parameters from what `actuator_to_dict` made.

    Raises
    ------
    UsageError
        For something else.
    """
    try:
        parts = {part: _part(kind, content[part]) for part, kind in _PARTS.items()}
        name, mass = content["name"], content["mass"]
        if not isinstance(name, str) or not isinstance(mass, float | int):
            raise TypeError("name is no text, or mass no number")
        return ActuatorParameters(name=name, mass=math.nan if mass is None else mass, **parts)
    except (KeyError, TypeError, ValueError, AttributeError, DesignError) as error:
        raise UsageError(
            f"these are no actuator's parameters of this program ({error}); write them anew."
        ) from error


def _part(kind: type[Any], content: Mapping[str, Any]) -> Any:
    def value(key: str, given: Any) -> Any:
        if isinstance(given, bool) or not isinstance(given, int | float | list | None):
            raise TypeError(f"{key} is no number")
        if isinstance(given, list):
            return np.asarray(given, np.int64 if key == "error_orders" else np.float64)
        return np.nan if given is None else given

    return kind(**{key: value(key, given) for key, given in content.items()})
