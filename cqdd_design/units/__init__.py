"""Unit strings at the border, SI floats inside. The only room that knows pint.

A design file says ``peak_torque = "120 N*m"``; the model holds ``120.0``. Every dimension lists
the *kinds* of unit it accepts, because dimensional analysis alone is too weak for machines: a
joule has the dimension of a torque, and a hertz that of a speed. So a torque is a force times a
length and refuses ``J``; a speed is ``rpm`` or an angle over a time and refuses ``Hz``.
"""

from cqdd_design.units.annotation import QuantityIn
from cqdd_design.units.dimensions import (
    ANGLE,
    BANDWIDTH,
    CURRENT,
    DAMPING_GAIN,
    DURATION,
    FREQUENCY,
    INDUCTANCE,
    INERTIA,
    LENGTH,
    LOAD_SPEED,
    MASS,
    POWER,
    RADIAL_STIFFNESS,
    RESISTANCE,
    SMALL_ANGLE,
    SMALL_LENGTH,
    SPEED,
    SPEED_CONSTANT,
    STIFFNESS,
    STIFFNESS_GAIN,
    TEMPERATURE,
    THERMAL_RESISTANCE,
    TIME,
    TORQUE,
    TORQUE_CONSTANT,
    TORQUE_DENSITY,
    VISCOSITY,
    VOLTAGE,
    Dimension,
)
from cqdd_design.units.quantities import format_quantity, parse_quantity

__all__ = [
    "ANGLE",
    "BANDWIDTH",
    "CURRENT",
    "DAMPING_GAIN",
    "DURATION",
    "FREQUENCY",
    "INDUCTANCE",
    "INERTIA",
    "LENGTH",
    "LOAD_SPEED",
    "MASS",
    "POWER",
    "RADIAL_STIFFNESS",
    "RESISTANCE",
    "SMALL_ANGLE",
    "SMALL_LENGTH",
    "SPEED",
    "SPEED_CONSTANT",
    "STIFFNESS",
    "STIFFNESS_GAIN",
    "TEMPERATURE",
    "THERMAL_RESISTANCE",
    "TIME",
    "TORQUE",
    "TORQUE_CONSTANT",
    "TORQUE_DENSITY",
    "VISCOSITY",
    "VOLTAGE",
    "Dimension",
    "QuantityIn",
    "format_quantity",
    "parse_quantity",
]
