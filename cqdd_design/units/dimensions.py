"""The dimensions of the design file: their own units, and the kinds of unit each accepts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.units.expression import parse_expression


@dataclass(frozen=True)
class Dimension:
    """A physical dimension of the design file.

    Attributes
    ----------
    name : str
        As in error messages ("torque").
    unit : str
        The unit written to files and shown to people ("N*m").
    kinds : str
        Accepted products of unit kinds, such as ``force*length``, with ``or`` between.
    common : tuple of (str, float)
        Frequent spellings with their SI factors, that of `unit` among them. They spare the import
        of pint on the everyday road; a test compares every row with pint.
    refuses : str
        What people type by mistake, and why it is refused; empty when there is nothing to say.
    zeros : tuple of (str, float)
        Of a scale whose units start elsewhere, where each starts: then only these are read.
    """

    name: str
    unit: str
    kinds: str
    common: tuple[tuple[str, float], ...]
    refuses: str = ""
    zeros: tuple[tuple[str, float], ...] = ()

    @property
    def si_factor(self) -> float:
        """SI value of one `unit`."""
        return dict(self.common)[self.unit]

    @property
    def signatures(self) -> tuple[tuple[tuple[str, int], ...], ...]:
        """Accepted products of unit kinds, each a sorted tuple of (kind, exponent)."""
        products = map(parse_expression, self.kinds.split(" or "))
        return tuple(tuple(sorted(powers.items())) for powers in products)

    def example(self, value: float = 1.0) -> str:
        """A correct spelling, for messages: ``"1 mm"``."""
        return f'"{value:g} {self.unit}"'


_DEG = math.pi / 180.0
_TURN = 2.0 * math.pi

LENGTH = Dimension(
    "length", "mm", "length", (("mm", 1e-3), ("um", 1e-6), ("m", 1.0), ("cm", 1e-2), ("in", 0.0254))
)
SMALL_LENGTH = Dimension("length", "um", LENGTH.kinds, LENGTH.common)
TORQUE = Dimension(
    "torque",
    "N*m",
    "force*length",
    (("N*m", 1.0), ("mN*m", 1e-3), ("N*mm", 1e-3), ("N*cm", 1e-2), ("kN*m", 1e3)),
    "J is a unit of energy; write a torque as N*m",
)
FORCE = Dimension("force", "N", "force", (("N", 1.0), ("kN", 1e3)))
ANGLE = Dimension(
    "angle",
    "deg",
    "angle",
    (("deg", _DEG), ("rad", 1.0), ("mrad", 1e-3), ("arcmin", _DEG / 60.0)),
    "an angle needs its unit, deg, rad or arcmin",
)
SMALL_ANGLE = Dimension("angle", "arcmin", ANGLE.kinds, ANGLE.common)
SPEED = Dimension(
    "speed",
    "rpm",
    "rotational_speed or angle/time",
    (("rpm", _TURN / 60.0), ("rad/s", 1.0), ("deg/s", _DEG)),
    "Hz does not say turns or radians; write rpm or rad/s",
)
LOAD_SPEED = Dimension("speed", "rad/s", SPEED.kinds, SPEED.common, SPEED.refuses)
FREQUENCY = Dimension(
    "frequency",
    "Hz",
    "frequency",
    (("Hz", 1.0), ("kHz", 1e3), ("MHz", 1e6)),
    "a rate is in Hz here, not rpm or rad/s",
)
BANDWIDTH = Dimension("frequency", "kHz", FREQUENCY.kinds, FREQUENCY.common, FREQUENCY.refuses)
VOLTAGE = Dimension("voltage", "V", "voltage", (("V", 1.0), ("mV", 1e-3)))
CURRENT = Dimension("current", "A", "current", (("A", 1.0), ("mA", 1e-3)))
RADIAL_STIFFNESS = Dimension(
    "stiffness",
    "N/um",
    "force/length",
    (("N/um", 1e6), ("N/mm", 1e3), ("N/m", 1.0), ("kN/mm", 1e6)),
)
STIFFNESS_GAIN = Dimension(
    "rotational stiffness",
    "N*m/rad",
    "force*length/angle",
    (("N*m/rad", 1.0),),
    "a gain on an angle is torque per angle, N*m/rad",
)
STIFFNESS = Dimension(
    "stiffness",
    "N*m/rad",
    STIFFNESS_GAIN.kinds,
    (("N*m/rad", 1.0), ("N*m/arcmin", 60.0 / _DEG), ("N*m/deg", 1.0 / _DEG)),
    "a stiffness is torque per angle, N*m/rad or N*m/arcmin",
)
DAMPING_GAIN = Dimension(
    "rotational damping",
    "N*m*s/rad",
    "force*length*time/angle",
    (("N*m*s/rad", 1.0),),
    "a gain on a speed is torque times time per angle, N*m*s/rad",
)
THERMAL_RESISTANCE = Dimension("thermal resistance", "K/W", "temperature/power", (("K/W", 1.0),))
TEMPERATURE = Dimension(
    "temperature",
    "degC",
    "temperature",
    (("degC", 1.0), ("K", 1.0), ("degF", 5.0 / 9.0)),
    "a temperature is read in degC, K or degF",
    zeros=(("degC", 0.0), ("K", -273.15), ("degF", -160.0 / 9.0)),
)
"""Inside, temperatures are in degrees Celsius: those of parts, and of data sheets."""
TIME = Dimension("time", "s", "time", (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0)))
DURATION = Dimension(
    "duration", "h", TIME.kinds, (("h", 3600.0), ("min", 60.0), ("s", 1.0), ("day", 86400.0))
)
VISCOSITY = Dimension(
    "kinematic viscosity", "mm^2/s", "length^2/time", (("mm^2/s", 1e-6), ("m^2/s", 1.0))
)
MASS = Dimension("mass", "kg", "mass", (("kg", 1.0), ("g", 1e-3)))
INERTIA = Dimension(
    "moment of inertia",
    "kg*m^2",
    "length^2*mass",
    (("kg*m^2", 1.0), ("g*cm^2", 1e-7), ("kg*mm^2", 1e-6)),
)
POWER = Dimension("power", "W", "power", (("W", 1.0), ("kW", 1e3)))
TORQUE_CONSTANT = Dimension(
    "torque constant",
    "N*m/A",
    "force*length/current or voltage*time/angle or voltage/rotational_speed",
    (("N*m/A", 1.0), ("mN*m/A", 1e-3), ("V*s/rad", 1.0), ("V/krpm", 1e-3 / (_TURN / 60.0))),
    "it is a torque over a current, or a voltage over a speed",
)
SPEED_CONSTANT = Dimension(
    "speed constant",
    "rpm/V",
    "rotational_speed/voltage or angle/time/voltage",
    (("rpm/V", _TURN / 60.0), ("rad/s/V", 1.0)),
)
RESISTANCE = Dimension("resistance", "ohm", "resistance", (("ohm", 1.0), ("mohm", 1e-3)))
INDUCTANCE = Dimension("inductance", "uH", "inductance", (("uH", 1e-6), ("mH", 1e-3), ("H", 1.0)))
TORQUE_DENSITY = Dimension("torque density", "N*m/kg", "force*length/mass", (("N*m/kg", 1.0),))
