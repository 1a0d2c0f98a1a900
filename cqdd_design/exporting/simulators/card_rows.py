"""Rows of the actuator card: each parameter on both sides of the gear, its origin and its names."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.actuator.joint_side import (
    JointSide,
    motor_breakaway,
    motor_coulomb,
    motor_viscous,
    ripple_harmonics,
)
from cqdd_design.exporting.simulators.card_names import NAMES
from cqdd_design.exporting.simulators.stated import origin_of, value_of

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters


@dataclass(frozen=True, eq=False)
class Quantity:
    """One parameter of the card.

    Attributes
    ----------
    key, title : str
        For programs and for people.
    motor, joint : float or None
        Its value on either side; None on the side where it has no meaning.
    unit : str
        Of both.
    formula : str
        How one follows from the other, with numbers; empty where it does not.
    origin : str
        Where it comes from.
    names : mapping of str to str
        Client (see `card_clients.CLIENTS`) to what it calls it.
    """

    key: str
    title: str
    motor: float | None
    joint: float | None
    unit: str
    formula: str
    origin: str
    names: Mapping[str, str] = field(default_factory=dict)


_POWER = {"n": 1, "1/n": -1, "n^2": 2}
"""How a number goes from motor to joint, and the power of n that does it."""

_FRICTION = "friction.motor_coulomb motor.hysteresis"
_OUTER = "friction.output_coulomb"
_DRAG = "friction.motor_viscous motor.iron_loss"
_ERROR = "gear.error_cosine gear.error_sine"
_TURNING = "motor.rotor_inertia gear.input_inertia"
_NM, _DRAG_UNIT, _INERTIA = "N m", "N m s/rad", "kg m^2"

# Key, title, unit, side where the value stands, how it goes through the gear, where it comes from:
# dotted names, or "computed". Each list is one table of values, see `quantities`.
_TABLE = (
    ("reduction", "reduction n, positive", "1", "joint", "", "gear.ratio"),
    (
        "torque_constant",
        "torque constant K",
        "N m/A = V s/rad",
        "joint",
        "n",
        "motor.torque_constant",
    ),
    ("rated_torque", "rated torque by its catalogue", _NM, "motor", "n", "motor.rated_torque"),
    ("peak_motor", "peak torque by its catalogue", _NM, "motor", "n", "motor.peak_torque"),
    ("resistance", "resistance, line to line", "ohm", "motor", "", "motor.resistance"),
    ("inductance", "inductance, line to line", "H", "motor", "", "motor.inductance"),
    ("pole_pairs", "pole pairs", "1", "motor", "", "motor.pole_pairs"),
    ("supply_voltage", "supply voltage", "V", "motor", "", "drive.supply_voltage"),
    ("current_limit", "current limit of the drive", "A", "motor", "", "drive.current_limit"),
    (
        "stall_torque",
        "stall torque, no current limit, no losses",
        _NM,
        "joint",
        "n",
        "computed: n K V/R",
    ),
    (
        "peak_torque",
        "peak torque at the current limit, no losses",
        _NM,
        "joint",
        "n",
        "computed: n K min(I, V/R)",
    ),
    (
        "delivered_peak_torque",
        "peak torque at the joint in motion, friction under load taken off",
        _NM,
        "joint",
        "",
        "computed: (peak torque - motor's Coulomb)/(1 + friction over torque) - output's Coulomb",
    ),
    (
        "continuous_torque",
        "continuous torque at standstill, no losses",
        _NM,
        "joint",
        "n",
        "computed: winding at its limit, by the thermal rows",
    ),
    (
        "ideal_speed",
        "speed at full voltage, no friction",
        "rad/s",
        "joint",
        "1/n",
        "computed: V/(n K)",
    ),
    (
        "no_load_speed",
        "no-load speed with friction",
        "rad/s",
        "joint",
        "1/n",
        "computed: (n K V/R - Coulomb)/(n^2 K^2/R + viscous)",
    ),
    (
        "corner_speed",
        "speed up to which the peak torque holds",
        "rad/s",
        "joint",
        "1/n",
        "computed: (V - R I)/(n K)",
    ),
    ("cogging", "cogging", _NM, "motor", "n", "motor.cogging_amplitude"),
    (
        "cogging_order",
        "periods of cogging in a turn of the motor",
        "1",
        "motor",
        "n",
        "motor.cogging_order",
    ),
    ("rotor_inertia", "inertia of the rotor", _INERTIA, "motor", "n^2", "motor.rotor_inertia"),
    (
        "input_inertia",
        "inertia of crank, cams and discs",
        _INERTIA,
        "motor",
        "n^2",
        "gear.input_inertia",
    ),
    ("motor_side_inertia", "inertia of the motor's side", _INERTIA, "motor", "n^2", _TURNING),
    (
        "output_inertia",
        "inertia of the output side",
        _INERTIA,
        "joint",
        "n^2",
        "gear.output_inertia",
    ),
    (
        "reflected_inertia",
        "whole inertia at the joint",
        _INERTIA,
        "joint",
        "n^2",
        f"{_TURNING} gear.output_inertia",
    ),
    ("mass", "mass of the actuator", "kg", "joint", "", "mass"),
    (
        "motor_coulomb",
        "Coulomb friction of the motor's side, with hysteresis",
        _NM,
        "motor",
        "n",
        _FRICTION,
    ),
    (
        "motor_breakaway",
        "breakaway of the motor's side",
        _NM,
        "motor",
        "n",
        f"{_FRICTION} friction.stribeck_extra",
    ),
    ("output_coulomb", "Coulomb friction of the output side", _NM, "joint", "n", _OUTER),
    ("coulomb", "Coulomb friction of both sides", _NM, "joint", "n", f"{_FRICTION} {_OUTER}"),
    (
        "breakaway",
        "breakaway of both sides",
        _NM,
        "joint",
        "n",
        f"{_FRICTION} {_OUTER} friction.stribeck_extra",
    ),
    ("stribeck_speed", "Stribeck speed", "rad/s", "joint", "1/n", "friction.stribeck_speed"),
    (
        "bristle_deflection",
        "deflection of LuGre bristles at breakaway",
        "rad",
        "motor",
        "1/n",
        "friction.bristle_deflection",
    ),
    (
        "bristle_damping",
        "damping of LuGre bristles, 0: critical",
        _DRAG_UNIT,
        "motor",
        "n^2",
        "friction.bristle_damping",
    ),
    (
        "motor_viscous",
        "viscous drag of the motor's side, with eddy currents",
        _DRAG_UNIT,
        "motor",
        "n^2",
        _DRAG,
    ),
    (
        "output_viscous",
        "viscous drag of the output side",
        _DRAG_UNIT,
        "joint",
        "n^2",
        "friction.output_viscous",
    ),
    (
        "viscous",
        "viscous drag of both sides",
        _DRAG_UNIT,
        "joint",
        "n^2",
        f"{_DRAG} friction.output_viscous",
    ),
    (
        "load_forward",
        "friction over carried torque, motor drives",
        "1",
        "joint",
        "",
        "friction.load_forward",
    ),
    (
        "load_backward",
        "friction over carried torque, output drives",
        "1",
        "joint",
        "",
        "friction.load_backward",
    ),
    ("backlash", "backlash, whole", "rad", "joint", "1/n", "gear.backlash"),
    ("stiffness", "stiffness of the transmission", "N m/rad", "joint", "n^2", "gear.stiffness"),
    ("stiffening", "exponent of torque over deflection", "1", "joint", "", "gear.stiffening"),
    ("damping", "damping of the transmission", _DRAG_UNIT, "joint", "n^2", "gear.damping"),
    ("error_torque", "torque of the next two rows", _NM, "joint", "n", "gear.error_torque"),
    ("kinematic_error", "kinematic error, r.m.s.", "rad", "joint", "1/n", _ERROR),
    ("ripple", "torque ripple, r.m.s.", _NM, "joint", "n", "computed: steady current, no friction"),
    (
        "position_gain",
        "stiffness of the impedance control",
        "N m/rad",
        "joint",
        "n^2",
        "drive.position_gain",
    ),
    (
        "velocity_gain",
        "damping of the impedance control",
        _DRAG_UNIT,
        "joint",
        "n^2",
        "drive.velocity_gain",
    ),
    ("delay", "delay of the torque command", "s", "motor", "", "drive.delay"),
    (
        "current_bandwidth",
        "bandwidth of the current loop",
        "Hz",
        "motor",
        "",
        "drive.current_bandwidth",
    ),
    ("control_rate", "rate of the position loop", "Hz", "motor", "", "drive.control_rate"),
    ("encoder_step", "step of the encoder", "rad", "motor", "1/n", "drive.encoder_bits"),
    (
        "winding_to_housing",
        "thermal resistance, winding to housing",
        "K/W",
        "motor",
        "",
        "thermal.winding_to_housing",
    ),
    (
        "housing_to_ambient",
        "thermal resistance, housing to ambient",
        "K/W",
        "motor",
        "",
        "thermal.housing_to_ambient",
    ),
    (
        "winding_capacity",
        "heat capacity of the winding",
        "J/K",
        "motor",
        "",
        "thermal.winding_capacity",
    ),
    (
        "housing_capacity",
        "heat capacity of the housing",
        "J/K",
        "motor",
        "",
        "thermal.housing_capacity",
    ),
    (
        "reference_temperature",
        "temperature of resistance and K",
        "deg C",
        "motor",
        "",
        "motor.reference_temperature",
    ),
    ("ambient", "ambient temperature", "deg C", "motor", "", "thermal.ambient"),
    (
        "derating_begins",
        "winding temperature where derating begins",
        "deg C",
        "motor",
        "",
        "thermal.derating_begins",
    ),
    ("most", "most winding temperature", "deg C", "motor", "", "thermal.most"),
)


def quantities(parameters: ActuatorParameters, side: JointSide) -> tuple[Quantity, ...]:
    """Return every row of an actuator's card.

    An ideal encoder has none; what the catalogue does not give stays without value.
    """
    values: dict[str, float] = {**dataclasses.asdict(side), **_worked_out(parameters, side)}
    rows = []
    for key, title, unit, place, reflection, of in _TABLE:
        if key == "encoder_step" and parameters.drive.encoder_bits == 0:
            continue
        names = of.split()
        computed = of.startswith("computed")
        known = values[key] if key in values else value_of(parameters, names[0])
        value = known if math.isfinite(known) else None
        origin = of if computed else origin_of(parameters, *names)
        motor = value if place == "motor" else None
        joint = value if place == "joint" else None
        shown = ""
        if value is not None and reflection:
            factor = side.reduction ** _POWER[reflection]
            first = value if place == "motor" else value / factor
            motor, joint = first, first * factor if place == "motor" else value
            shown = f"{first:.4g} x {factor:.4g} = {joint:.4g} ({reflection})"
        rows.append(Quantity(key, title, motor, joint, unit, shown, origin, NAMES.get(key, {})))
    return tuple(rows)


def _worked_out(parameters: ActuatorParameters, side: JointSide) -> dict[str, float]:
    """Values of rows that are no attribute of anything."""
    gear = parameters.gear
    ripple = sum(one.amplitude**2 for one in ripple_harmonics(parameters))
    carried = side.peak_torque - side.reduction * motor_coulomb(parameters)
    carried /= 1.0 + parameters.friction.load_forward
    return {
        "motor_coulomb": motor_coulomb(parameters),
        "motor_breakaway": motor_breakaway(parameters),
        "motor_viscous": motor_viscous(parameters),
        "motor_side_inertia": parameters.motor_side_inertia,
        "kinematic_error": math.sqrt(
            0.5 * float(np.sum(gear.error_cosine**2 + gear.error_sine**2))
        ),
        "ripple": math.sqrt(0.5 * ripple),
        "delivered_peak_torque": max(carried - parameters.friction.output_coulomb, 0.0),
        "encoder_step": 2.0 * math.pi / 2.0**parameters.drive.encoder_bits,
    }
