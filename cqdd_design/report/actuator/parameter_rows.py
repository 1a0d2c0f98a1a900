"""Parameters of the simulated actuator in rows: words, value with its unit, and where from."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.report.ink.numbers import ARCMIN, significant, with_unit
from cqdd_design.report.judgement.check_rows import printed


@dataclass(frozen=True)
class ParameterRow:
    """One parameter by its dotted name; `note` is what its origin says past the first word."""

    key: str
    words: str
    shown: str
    origin: str
    note: str


# Dotted name, words, unit shown, factor from SI.
_SCALARS: dict[str, tuple[tuple[str, str, str, float], ...]] = {
    "Motor": (
        ("motor.torque_constant", "torque constant, power-equivalent DC", "N*m/A", 1.0),
        ("motor.resistance", "resistance, line to line", "Ω", 1.0),
        ("motor.inductance", "inductance, line to line", "mH", 1e3),
        ("motor.pole_pairs", "pole pairs", "", 1.0),
        ("motor.rotor_inertia", "inertia of the rotor with its bell", "kg·cm²", 1e4),
        ("motor.rated_torque", "rated torque by the catalogue", "N*m", 1.0),
        ("motor.peak_torque", "peak torque by the catalogue", "N*m", 1.0),
        ("motor.cogging_amplitude", "cogging, amplitude", "N*m", 1.0),
        ("motor.cogging_order", "cogging, periods in a turn of the motor", "", 1.0),
        ("motor.coulomb", "drag of the motor alone", "mN·m", 1e3),
        ("motor.viscous", "drag of the motor alone over speed", "mN·m·s/rad", 1e3),
        ("motor.hysteresis", "drag from hysteresis, known apart", "N*m", 1.0),
        ("motor.iron_loss", "drag from eddy currents over speed, apart", "N*m*s/rad", 1.0),
        ("motor.reference_temperature", "temperature of these values", "°C", 1.0),
    ),
    "Drive": (
        ("drive.supply_voltage", "supply voltage", "V", 1.0),
        ("drive.current_limit", "current limit", "A", 1.0),
        ("drive.current_bandwidth", "bandwidth of the current loop", "Hz", 1.0),
        ("drive.delay", "delay of the command", "ms", 1e3),
        ("drive.control_rate", "rate of the position loop", "Hz", 1.0),
        ("drive.encoder_bits", "encoder on the motor's shaft", "bit", 1.0),
        ("drive.position_gain", "position gain at the output", "N*m/rad", 1.0),
        ("drive.velocity_gain", "velocity gain at the output", "N*m*s/rad", 1.0),
    ),
    "Heat": (
        ("thermal.winding_to_housing", "winding to housing", "K/W", 1.0),
        ("thermal.housing_to_ambient", "housing to ambient", "K/W", 1.0),
        ("thermal.winding_capacity", "heat capacity of the winding", "J/K", 1.0),
        ("thermal.housing_capacity", "heat capacity of the housing", "J/K", 1.0),
        ("thermal.ambient", "ambient", "°C", 1.0),
        ("thermal.derating_begins", "derating begins", "°C", 1.0),
        ("thermal.most", "limit of the winding", "°C", 1.0),
    ),
    "Friction": (
        ("friction.motor_coulomb", "gearbox: Coulomb friction, motor side", "mN·m", 1e3),
        ("friction.output_coulomb", "gearbox: Coulomb friction, output side", "mN·m", 1e3),
        ("friction.motor_viscous", "gearbox: viscous friction, motor side", "mN·m·s/rad", 1e3),
        ("friction.output_viscous", "gearbox: viscous friction, output side", "mN·m·s/rad", 1e3),
        ("friction.load_forward", "friction over torque, motor driving", "%", 1e2),
        ("friction.load_backward", "friction over torque, output driving", "%", 1e2),
        ("friction.load_knee", "these hold up to a torque at the output of", "N·m", 1.0),
        ("friction.load_growth", "friction of what is carried above it is more by", "%", 1e2),
        ("friction.stribeck_extra", "breakaway above Coulomb friction", "%", 1e2),
        ("friction.stribeck_speed", "Stribeck speed of the motor", "rad/s", 1.0),
        ("friction.bristle_deflection", "LuGre: breakaway at a motor angle of", "mrad", 1e3),
        ("friction.bristle_damping", "LuGre: damping of the bristles", "N*m*s/rad", 1.0),
    ),
    "Gearbox": (
        ("gear.ratio", "ratio, motor over output", "", 1.0),
        ("gear.input_inertia", "inertia that turns with the crank", "kg·cm²", 1e4),
        ("gear.output_inertia", "inertia at the output", "kg·cm²", 1e4),
        ("gear.stiffness", "stiffness, secant", "N*m/rad", 1.0),
        ("gear.stiffening", "exponent of torque over deflection", "", 1.0),
        ("gear.damping", "damping", "N*m*s/rad", 1.0),
        ("gear.backlash", "backlash", "arcmin", ARCMIN),
        ("gear.error_torque", "torque of the kinematic error", "N*m", 1.0),
    ),
}


def parameter_rows(
    parameters: ActuatorParameters,
) -> tuple[tuple[str, tuple[ParameterRow, ...]], ...]:
    """All parameters by group, in the order of the dataclasses."""
    found = []
    for group, entries in _SCALARS.items():
        rows = [_row(parameters, *entry) for entry in entries]
        if group == "Gearbox":
            rows += _series(parameters)
        found.append((group, tuple(rows)))
    mass = _made(parameters, "mass", "mass", with_unit(parameters.mass, "kg"))
    found.append(("Whole", (mass,)))
    return tuple(found)


def _row(
    parameters: ActuatorParameters, key: str, words: str, unit: str, factor: float
) -> ParameterRow:
    part, _, name = key.partition(".")
    value = float(getattr(getattr(parameters, part), name))
    shown = with_unit(factor * value, unit) if math.isfinite(value) else "not given"
    return _made(parameters, key, words, shown)


def _series(parameters: ActuatorParameters) -> list[ParameterRow]:
    gear = parameters.gear
    count = f"{len(gear.error_orders)} orders"
    error = np.hypot(gear.error_cosine, gear.error_sine)
    swing = np.hypot(gear.stiffness_cosine, gear.stiffness_sine)
    rows = []
    for key, words, sizes, factor, unit in (
        ("gear.error_cosine", "kinematic error", error, ARCMIN, "arcmin"),
        ("gear.stiffness_cosine", "variation of the stiffness", swing, 100.0, "%"),
    ):
        shown = "none"
        if sizes.size and float(sizes.max()) > 0.0:
            best = int(sizes.argmax())
            largest = with_unit(factor * float(sizes[best]), unit, 3)
            shown = f"{count}, {largest} at order {int(gear.error_orders[best])}"
        rows.append(_made(parameters, key, words, shown))
    return rows


def _made(parameters: ActuatorParameters, key: str, words: str, shown: str) -> ParameterRow:
    origin, _, note = parameters.origins.get(key, "default").partition(":")
    return ParameterRow(key, words, shown, origin.strip(), prose(note.strip()))


def prose(text: str) -> str:
    r"""A sentence with print signs for its units and powers of ten.

    Examples
    --------
    >>> prose("at 2.19e+04 N*m/rad and -3 dB, 120 degC")
    'at 21\u202f900 N·m/rad and \u22123 dB, 120 °C'
    """
    text = re.sub(r"\b\d+(?:\.\d+)?e[+-]\d+\b", lambda found: significant(float(found[0]), 3), text)
    return printed(text)


def counted(parameters: ActuatorParameters) -> str:
    """How many parameters come from where, in words."""
    tally = Counter(row.origin for _, rows in parameter_rows(parameters) for row in rows)
    return ", ".join(f"{significant(float(n))} {origin}" for origin, n in tally.most_common())
