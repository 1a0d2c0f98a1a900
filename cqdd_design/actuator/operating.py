"""Operating points at the output: what they ask of motor and drive, and which limit binds.

Everything stands at the output and counts with friction, as in the simulation: on the motor side
the motor's own drag, the gearbox's Coulomb and viscous friction and a share of the torque carried,
on the output side Coulomb and viscous friction, breakaway of the gearbox by Stribeck's law near
standstill. All friction heats the housing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.load_friction import carried_torque, load_friction
from cqdd_design.actuator.motor import greatest_torque, iron_drag, resistance_at, torque_constant_at
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.thermal import response

DRIVER, VOLTAGE, PEAK, HEAT = "driver", "voltage", "motor", "heat"
"""Names of the limits."""
_HALVINGS = 40
_SLACK = 1e-9
_LONGEST = 4.0 * 3600.0
"""Of overloads told as such, s."""


@dataclass(frozen=True)
class Need:
    """What a point asks of motor and drive.

    Attributes
    ----------
    motor_torque : float
        At the motor's shaft, N m; positive in the sense of its motion.
    current, voltage : float
        A and V, steady.
    heat : float
        Into the housing, W.
    """

    motor_torque: float
    current: float
    voltage: float
    heat: float


@dataclass(frozen=True)
class Judgement:
    """Whether a point is inside, and what binds where it is not.

    Attributes
    ----------
    binding : tuple of str
        Of `DRIVER`, `VOLTAGE`, `PEAK` and `HEAT`; empty inside.
    most : float
        Greatest torque at this speed, N m.
    lasts : float
        Time from cold until the winding is at its limit, s; inf where it never is, 0 where the
        point cannot be reached at all.
    """

    need: Need
    binding: tuple[str, ...]
    most: float
    lasts: float

    @property
    def inside(self) -> bool:
        """Whether no limit is exceeded."""
        return not self.binding


def _rise(parameters: ActuatorParameters, motor_speed: FloatArray) -> FloatArray:
    """Friction over its Coulomb value, by Stribeck's law."""
    friction = parameters.friction
    share = np.minimum(np.abs(motor_speed) / friction.stribeck_speed, 6.0)
    return np.asarray(1.0 + friction.stribeck_extra * np.exp(-(share**2)))


def _own_drag(parameters: ActuatorParameters, motor_speed: FloatArray) -> FloatArray:
    """Drag of the motor alone about to turn or turning forwards, rad/s, N m."""
    motor = parameters.motor
    return np.asarray(motor.dry_drag + motor.drag_slope * motor_speed)


def holds_itself(parameters: ActuatorParameters) -> bool:
    """Whether friction holds any torque on the output, so that it turns nothing."""
    return parameters.friction.load_backward >= 1.0


def motor_torque(parameters: ActuatorParameters, torque: ArrayLike, speed: ArrayLike) -> FloatArray:
    """Shaft torque of the motor, N m, its own drag still to be added, for one at the output.

    That is positive where the motor drives and negative where the output does, N m; the output's
    speed is zero or more, rad/s.
    """
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    turning = np.asarray(speed, dtype=float)
    rise = _rise(parameters, n * turning)
    carried = (
        np.asarray(torque, dtype=float)
        + friction.output_coulomb * rise
        + friction.output_viscous * turning
    )
    carried = (carried + rise * load_friction(friction, carried)) / n
    return np.asarray(
        carried + friction.motor_coulomb * rise + friction.motor_viscous * n * turning
    )


def output_torque(
    parameters: ActuatorParameters, torque: ArrayLike, speed: ArrayLike
) -> FloatArray:
    """Torque at the output for a shaft torque of a driving motor: `motor_torque` backwards."""
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    turning = np.asarray(speed, dtype=float)
    rise = _rise(parameters, n * turning)
    given = n * (
        np.asarray(torque, dtype=float)
        - friction.motor_coulomb * rise
        - friction.motor_viscous * n * turning
    )
    way = np.where(given >= 0.0, 1.0, -1.0)
    carried = way * carried_torque(friction, np.abs(given), rise, way)
    rubbed = friction.output_coulomb * rise + friction.output_viscous * turning
    return np.asarray(carried - rubbed)


class Needs(NamedTuple):
    """As `Need`, of many points."""

    motor_torque: FloatArray
    current: FloatArray
    voltage: FloatArray
    heat: FloatArray


def needs(
    parameters: ActuatorParameters, torque: ArrayLike, speed: ArrayLike, temperature: float
) -> Needs:
    """What steady points ask, winding and magnets at a temperature (deg C).

    Torques at the output are positive where the motor drives, N m; speeds zero or more, rad/s.
    """
    motor, n = parameters.motor, abs(parameters.gear.ratio)
    constant = float(torque_constant_at(motor, temperature))
    turning = n * np.asarray(speed, dtype=float)
    drag = _own_drag(parameters, turning)
    shaft = motor_torque(parameters, torque, speed)
    current = (shaft + drag) / constant
    voltage = float(resistance_at(motor, temperature)) * current + constant * turning
    given = np.asarray(torque, dtype=float) * np.asarray(speed, dtype=float)
    return Needs(shaft, current, voltage, (shaft + drag) * turning - given)


def needed(parameters: ActuatorParameters, torque: float, speed: float, temperature: float) -> Need:
    """What one steady point asks; see `needs`."""
    return Need(*(float(one) for one in needs(parameters, torque, speed, temperature)))


def torque_from_current(
    parameters: ActuatorParameters, current: ArrayLike, speed: ArrayLike, temperature: float
) -> tuple[FloatArray, FloatArray]:
    """Torque at the output, N m, and heat in the housing, W, of a current while driving."""
    motor, n = parameters.motor, abs(parameters.gear.ratio)
    turning = n * np.asarray(speed, dtype=float)
    air_gap = float(torque_constant_at(motor, temperature)) * np.asarray(current, dtype=float)
    torque = output_torque(parameters, air_gap - _own_drag(parameters, turning), speed)
    return torque, np.asarray(air_gap * turning - torque * np.asarray(speed))


def envelope_torque(
    parameters: ActuatorParameters, speed: ArrayLike, temperature: float
) -> FloatArray:
    """Greatest torque that drive and voltage give at output speeds, rad/s, one warm winding."""
    turning = np.asarray(speed, dtype=float)
    motor_speed = abs(parameters.gear.ratio) * turning
    most = greatest_torque(parameters.motor, parameters.drive, motor_speed, temperature)
    # At rest there is no drag yet, but what is about to move has to overcome it.
    resting = iron_drag(parameters.motor, motor_speed) - _own_drag(parameters, motor_speed)
    return output_torque(parameters, most + resting, turning)


def held_torque(
    parameters: ActuatorParameters, speed: ArrayLike, seconds: float = math.inf
) -> FloatArray:
    """Torque (S,), N m, whose heat the winding stands for a time from cold, s; default for ever.

    At output speeds (S,), rad/s; 0 where friction alone is too much. Copper is as warm as the
    winding, friction and iron losses go to the housing, and the magnets are taken to be as warm as
    the winding's limit. No other limit counts here.
    """
    turning = np.atleast_1d(np.asarray(speed, dtype=float))
    motor, thermal = parameters.motor, parameters.thermal
    total = thermal.winding_to_housing + thermal.housing_to_ambient
    hot = float(resistance_at(motor, thermal.most))
    room = thermal.most - thermal.ambient

    def too_much(current: FloatArray) -> FloatArray:
        _, heat = torque_from_current(parameters, current, turning, thermal.most)
        if math.isinf(seconds):
            rise = current**2 * hot * total + heat * thermal.housing_to_ambient
            return np.asarray(rise > room)
        ends = [
            float(response(motor, thermal, float(i), [seconds], housing_heat=float(h))[0, 0])
            for i, h in zip(current, heat, strict=True)
        ]
        return np.asarray(np.array(ends) > thermal.most)

    low = np.zeros_like(turning)
    # Above this current the winding is too hot even beside a housing at ambient.
    least_time = min(seconds, _LONGEST)
    cold = float(resistance_at(motor, thermal.ambient))
    adiabatic = thermal.winding_capacity * room / least_time
    high = np.full_like(turning, math.sqrt((adiabatic + room / thermal.winding_to_housing) / cold))
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        above = too_much(middle)
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    torque, _ = torque_from_current(parameters, low, turning, thermal.most)
    return np.asarray(np.maximum(torque, 0.0))


def lasting_torque(parameters: ActuatorParameters, speed: float) -> float:
    """Torque that winding and drive hold for ever at an output speed (rad/s), N m."""
    return judge(parameters, 0.0, speed, lasting=True, hot=True).most


def time_to_limit(parameters: ActuatorParameters, current: float, heat: float) -> float:
    """Time under a current until a cold winding is at its limit, s; inf where it never is."""
    motor, thermal = parameters.motor, parameters.thermal

    def ends(seconds: float) -> float:
        found = response(motor, thermal, current, [seconds], housing_heat=heat)
        return float(found[0, 0])

    low, high = 0.0, 1.0
    while ends(high) <= thermal.most:
        if high >= _LONGEST:
            return math.inf
        low, high = high, 2.0 * high
    while high - low > 1e-6 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if ends(middle) > thermal.most else (middle, high)
    return high


def judge(
    parameters: ActuatorParameters, torque: float, speed: float, *, lasting: bool, hot: bool
) -> Judgement:
    """Judge one point at the output against voltage, driver, motor and heat.

    Its torque (N m) is positive where the motor drives, its speed (rad/s) zero or more. Heat counts
    where it is `lasting`: held for ever. `hot` is with winding and magnets at the winding's limit
    instead of at ambient.
    """
    motor, drive, thermal = parameters.motor, parameters.drive, parameters.thermal
    temperature = thermal.most if hot else thermal.ambient
    need = needed(parameters, torque, speed, temperature)
    binding = []
    if abs(need.current) > drive.current_limit * (1.0 + _SLACK):
        binding.append(DRIVER)
    if abs(need.voltage) > drive.supply_voltage * (1.0 + _SLACK):
        binding.append(VOLTAGE)
    most = float(envelope_torque(parameters, speed, temperature)[0])
    if math.isfinite(motor.peak_torque):
        if abs(need.motor_torque) > motor.peak_torque * (1.0 + _SLACK):
            binding.append(PEAK)
        most = min(most, float(output_torque(parameters, motor.peak_torque, speed)))
    lasts = time_to_limit(parameters, need.current, need.heat)
    if lasting:
        if math.isfinite(lasts):
            binding.append(HEAT)
        most = min(most, float(held_torque(parameters, speed)[0]))
    reached = set(binding) <= {HEAT}
    return Judgement(need, tuple(binding), max(most, 0.0), lasts if reached else 0.0)
