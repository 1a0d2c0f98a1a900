"""From frozen parameters and a scenario to the rows that are stepped; the largest step."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.actuator.columns import FRICTIONS, MODES, Constants
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray, GearParameters
from cqdd_design.actuator.scenario import Scenario
from cqdd_design.actuator.thermal import continuous_current, network, transition
from cqdd_design.errors import UsageError

_POINTS_PER_PERIOD, _LEAST_POINTS, _MOST_POINTS = 16, 256, 16384
"""Table entries per period of the highest order: the cubic between them is good to 1e-4 of it."""


def kinematic_error(gear: GearParameters, motor_angle: FloatArray) -> FloatArray:
    """Kinematic error at motor angles, rad at the output, from its harmonics."""
    return _series(gear, gear.error_cosine, gear.error_sine, motor_angle)[0]


def stiffness_share(gear: GearParameters, motor_angle: FloatArray) -> FloatArray:
    """Stiffness over its mean at motor angles, from its harmonics."""
    return 1.0 + _series(gear, gear.stiffness_cosine, gear.stiffness_sine, motor_angle)[0]


def _series(
    gear: GearParameters, cosine: FloatArray, sine: FloatArray, motor_angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """A series and its derivative over the motor angle."""
    orders = np.asarray(gear.error_orders, dtype=float) / abs(gear.ratio)
    turns = np.multiply.outer(np.asarray(motor_angle, dtype=float), orders)
    c, s = np.cos(turns), np.sin(turns)
    return c @ cosine + s @ sine, (c * orders) @ sine - (s * orders) @ cosine


def table_points(gear: GearParameters) -> int:
    """Entries of a gearbox's table over an output turn: a power of two."""
    most = int(np.max(gear.error_orders, initial=1))
    wanted = max(_LEAST_POINTS, _POINTS_PER_PERIOD * most)
    return min(1 << math.ceil(math.log2(wanted)), _MOST_POINTS)


def gear_table(gear: GearParameters, points: int) -> FloatArray:
    """Kinematic error and stiffness share with their slopes per interval, (points, 4)."""
    orders = np.asarray(gear.error_orders, dtype=np.int64)
    lines = np.stack(
        [
            gear.error_cosine - 1j * np.asarray(gear.error_sine),
            gear.stiffness_cosine - 1j * np.asarray(gear.stiffness_sine),
        ]
    )
    # Sums over evenly spaced points; an order beyond them falls on the one it looks like.
    spectrum = np.zeros((2, 2, points), dtype=complex)
    np.add.at(spectrum[:, 0].T, orders % points, lines.T)
    np.add.at(spectrum[:, 1].T, orders % points, (2j * np.pi / points * orders * lines).T)
    table = points * np.fft.ifft(spectrum).real.reshape(4, points)
    table[2] += 1.0
    return np.ascontiguousarray(table.T)


def pack(parameters: ActuatorParameters, scenario: Scenario, step: float) -> Constants:
    """What stays the same over a run, with the state at its beginning.

    Raises
    ------
    UsageError
        For a command or friction model that there is not, and for numbers that are not finite.
    """
    for what, name, known in (
        ("command.mode", scenario.command.mode, MODES),
        ("friction", scenario.friction, FRICTIONS),
    ):
        if name not in known:
            raise UsageError(f"scenario.{what} {name!r} is none of {', '.join(known)}.")
    motor, drive, thermal = parameters.motor, parameters.drive, parameters.thermal
    friction, gear = parameters.friction, parameters.gear
    command, load, start = scenario.command, scenario.load, scenario.start
    n = abs(gear.ratio)
    wall = load.wall
    stepping, adding = transition(network(thermal), np.array([step]))
    stepping, adding = stepping[0], adding[0]
    motor_angle = start.motor_angle
    if motor_angle is None:
        motor_angle = start.output_angle * gear.ratio
        for _ in range(20):
            off = float(kinematic_error(gear, np.array([motor_angle]))[0])
            before, motor_angle = motor_angle, gear.ratio * (start.output_angle - off)
            if motor_angle == before:
                break
    first_speed = start.output_speed
    if load.speed is not None:
        first_speed = float(load.speed.values(np.zeros(1))[0])
    dry = friction.motor_coulomb + motor.dry_drag + friction.load_forward * gear.error_torque / n
    rise = 1.0 + friction.stribeck_extra
    gains = command.gains(drive)
    # What has the same name here and there is taken as it is.
    taken: dict[str, Any] = {
        name: getattr(part, name)
        for part in (motor, drive, thermal, friction, gear, load)
        for name in set(Constants._fields) & set(vars(part))
    }
    found = Constants(
        **taken
        | {
            "motor_inertia": parameters.motor_side_inertia,
            "iron_viscous": motor.iron_loss,
            "motor_dry": motor.coulomb,
            "motor_viscous": friction.motor_viscous + motor.viscous,
            "current_decay": math.exp(-2.0 * math.pi * drive.current_bandwidth * step),
            "control_step": 1.0 / drive.control_rate,
            "encoder_count": 2.0**drive.encoder_bits if drive.encoder_bits else 0.0,
            "position_gain": gains[0],
            "velocity_gain": gains[1],
            "integral_gain": command.integral_gain,
            "held_current": continuous_current(motor, thermal),
            "derating_span": max(thermal.most - thermal.derating_begins, 1e-9),
            "motor_bristle": rise * dry / friction.bristle_deflection,
            "motor_bristle_damping": friction.bristle_damping,
            "output_bristle": rise * friction.output_coulomb * n / friction.bristle_deflection,
            "carried_inertia": gear.output_inertia + load.inertia,
            "load_viscous": load.viscous,
            "wall_angle": wall.angle if wall else 0.0,
            "wall_stiffness": wall.stiffness if wall else 0.0,
            "wall_exponent": wall.exponent if wall else 1.0,
            "wall_damping": wall.damping if wall else 0.0,
            "wall_side": float(wall.side) if wall else 1.0,
            "gear_damping": gear.damping,
            "half_backlash": 0.5 * gear.backlash,
            "per_turn": 1.0 / (2.0 * math.pi * n),
            "winding_kept": stepping[0, 0],
            "winding_from_housing": stepping[0, 1],
            "housing_from_winding": stepping[1, 0],
            "housing_kept": stepping[1, 1],
            "winding_heated": adding[0, 0] / thermal.winding_capacity,
            "winding_by_housing_heat": adding[0, 1] / thermal.housing_capacity,
            "housing_by_winding_heat": adding[1, 0] / thermal.winding_capacity,
            "housing_heated": adding[1, 1] / thermal.housing_capacity,
            "cooling": thermal.ambient / thermal.housing_to_ambient,
            "delay_steps": float(round(drive.delay / step)),
            "mode": float(MODES.index(command.mode)),
            "lugre": float(FRICTIONS.index(scenario.friction)),
            "driven": float(load.speed is not None),
            "motor_angle": motor_angle,
            "motor_speed": _or(start.motor_speed, gear.ratio * first_speed),
            "output_angle": start.output_angle,
            "output_speed": first_speed,
            "current": start.current,
            "winding_temperature": _or(start.winding_temperature, thermal.ambient),
            "housing_temperature": _or(start.housing_temperature, thermal.ambient),
        }
    )
    wrong = [
        f"{name} {value:g}" for name, value in found._asdict().items() if not math.isfinite(value)
    ]
    if wrong:
        raise UsageError(f"a simulation needs finite numbers; look at {', '.join(wrong)}.")
    return found


def _or(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


def largest_step(parameters: ActuatorParameters, scenario: Scenario) -> tuple[float, str]:
    """Largest step that resolves an actuator in a scenario, s, and what sets it.

    One radian of the fastest spring-mass mode, two electrical time constants, one period of the
    position control. The steps are stable beyond that, but no longer say what the machine does.
    """
    gear, motor, load = parameters.gear, parameters.motor, scenario.load
    swing = float(np.sum(np.hypot(gear.stiffness_cosine, gear.stiffness_sine)))
    mesh = gear.stiffness * gear.stiffening * (1.0 + swing)
    inertia = gear.output_inertia + load.inertia
    on_output = 0.0 if load.speed is not None else (mesh + load.sensor_stiffness) / inertia
    on_motor = mesh / (gear.ratio**2 * parameters.motor_side_inertia)
    limits = [(1.0 / math.sqrt(on_output + on_motor), "the stiffness of gearbox and load")]
    if motor.inductance > 0.0 and scenario.command.mode != "open":
        limits.append((2.0 * motor.inductance / motor.resistance, "the winding's L/R"))
    if scenario.command.mode in ("impedance", "position"):
        limits.append((1.0 / parameters.drive.control_rate, "drive.control_rate"))
    return min(limits)


def safe_step(parameters: ActuatorParameters, *scenarios: Scenario, most: float = 1e-4) -> float:
    """Half the largest step that every scenario stands, s, and no more than `most`."""
    return min(most, *(0.5 * largest_step(parameters, scene)[0] for scene in scenarios))


def rounded_down(step: float) -> float:
    """The nearest 1, 2 or 5 times a power of ten that is not above a step.

    Examples
    --------
    >>> rounded_down(3.7e-05)
    2e-05
    """
    power = 10.0 ** math.floor(math.log10(step))
    digit = max(d for d in (1, 2, 5) if d * power <= step * (1.0 + 1e-12))
    return float(f"{digit * power:.0e}")
