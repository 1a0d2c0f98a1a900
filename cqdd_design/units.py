"""Unit strings at the border, SI floats inside. The only module that knows pint.

A design file says ``peak_torque = "120 N*m"``; the model holds ``120.0``. Every dimension lists
the *kinds* of unit it accepts, because dimensional analysis alone is too weak for machines: a
joule has the dimension of a torque, and a hertz that of a speed. So a torque is a force times a
length and refuses ``J``; a speed is ``rpm`` or an angle over a time and refuses ``Hz``.
"""

from __future__ import annotations

import functools
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cqdd_design.errors import DesignError, did_you_mean

if TYPE_CHECKING:
    from pint import UnitRegistry
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema

_NUMBER = re.compile(r"^\s*([+-]?(?:\d+(?:_\d+)*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")

#: Spellings people type that pint reads otherwise or not at all.
_SPELLINGS = {
    "Nm": "N*m",
    "N.m": "N*m",
    "N·m": "N*m",
    "N m": "N*m",
    "mNm": "mN*m",
    "Nmm": "N*mm",
    "N·mm": "N*mm",
    "Ncm": "N*cm",
    "N·cm": "N*cm",
    "kNm": "kN*m",
    "µm": "um",
    "μm": "um",
    "°": "deg",
    "'": "arcmin",
    "RPM": "rpm",
    "rev/min": "rpm",
    "rev/s": "turn/s",
    "Ω": "ohm",
    "inch": "in",
    '"': "in",
}


@dataclass(frozen=True)
class Dimension:
    """A physical dimension of the design file.

    Attributes
    ----------
    name : str
        As in error messages ("torque").
    unit : str
        The unit written to files and shown to people ("N*m").
    si_factor : float
        SI value of one `unit`.
    signatures : tuple of tuple
        Accepted products of unit kinds, each a sorted tuple of (kind, exponent).
    common : tuple of (str, float)
        Frequent spellings with their SI factors. They spare the import of pint on the everyday
        road; a test compares every row with pint.
    refuses : str
        What people type by mistake, and why it is refused; empty when there is nothing to say.
    """

    name: str
    unit: str
    si_factor: float
    signatures: tuple[tuple[tuple[str, int], ...], ...]
    common: tuple[tuple[str, float], ...]
    refuses: str = ""

    def example(self, value: float = 1.0) -> str:
        """A correct spelling, for messages: ``"1 mm"``."""
        return f'"{value:g} {self.unit}"'


_DEG = math.pi / 180.0
_TURN = 2.0 * math.pi

LENGTH = Dimension(
    "length",
    "mm",
    1e-3,
    ((("length", 1),),),
    (("mm", 1e-3), ("um", 1e-6), ("m", 1.0), ("cm", 1e-2), ("in", 0.0254)),
)
SMALL_LENGTH = Dimension("length", "um", 1e-6, LENGTH.signatures, LENGTH.common)
TORQUE = Dimension(
    "torque",
    "N*m",
    1.0,
    ((("force", 1), ("length", 1)),),
    (("N*m", 1.0), ("mN*m", 1e-3), ("N*mm", 1e-3), ("N*cm", 1e-2), ("kN*m", 1e3)),
    "J is a unit of energy; write a torque as N*m",
)
ANGLE = Dimension(
    "angle",
    "deg",
    _DEG,
    ((("angle", 1),),),
    (("deg", _DEG), ("rad", 1.0), ("mrad", 1e-3), ("arcmin", _DEG / 60.0)),
    "an angle needs its unit, deg, rad or arcmin",
)
SMALL_ANGLE = Dimension("angle", "arcmin", _DEG / 60.0, ANGLE.signatures, ANGLE.common)
SPEED = Dimension(
    "speed",
    "rpm",
    _TURN / 60.0,
    ((("rotational speed", 1),), (("angle", 1), ("time", -1))),
    (("rpm", _TURN / 60.0), ("rad/s", 1.0), ("deg/s", _DEG)),
    "Hz does not say turns or radians; write rpm or rad/s",
)
LOAD_SPEED = Dimension("speed", "rad/s", 1.0, SPEED.signatures, SPEED.common, SPEED.refuses)
FREQUENCY = Dimension(
    "frequency",
    "Hz",
    1.0,
    ((("frequency", 1),),),
    (("Hz", 1.0), ("kHz", 1e3), ("MHz", 1e6)),
    "a rate is in Hz here, not rpm or rad/s",
)
BANDWIDTH = Dimension(
    "frequency", "kHz", 1e3, FREQUENCY.signatures, FREQUENCY.common, FREQUENCY.refuses
)
VOLTAGE = Dimension("voltage", "V", 1.0, ((("voltage", 1),),), (("V", 1.0), ("mV", 1e-3)))
CURRENT = Dimension("current", "A", 1.0, ((("current", 1),),), (("A", 1.0), ("mA", 1e-3)))
RADIAL_STIFFNESS = Dimension(
    "stiffness",
    "N/um",
    1e6,
    ((("force", 1), ("length", -1)),),
    (("N/um", 1e6), ("N/mm", 1e3), ("N/m", 1.0), ("kN/mm", 1e6)),
)
STIFFNESS_GAIN = Dimension(
    "rotational stiffness",
    "N*m/rad",
    1.0,
    ((("angle", -1), ("force", 1), ("length", 1)),),
    (("N*m/rad", 1.0),),
    "a gain on an angle is torque per angle, N*m/rad",
)
DAMPING_GAIN = Dimension(
    "rotational damping",
    "N*m*s/rad",
    1.0,
    ((("angle", -1), ("force", 1), ("length", 1), ("time", 1)),),
    (("N*m*s/rad", 1.0),),
    "a gain on a speed is torque times time per angle, N*m*s/rad",
)
THERMAL_RESISTANCE = Dimension(
    "thermal resistance",
    "K/W",
    1.0,
    ((("power", -1), ("temperature", 1)),),
    (("K/W", 1.0),),
)
TIME = Dimension(
    "time", "s", 1.0, ((("time", 1),),), (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0))
)
MASS = Dimension("mass", "kg", 1.0, ((("mass", 1),),), (("kg", 1.0), ("g", 1e-3)))
INERTIA = Dimension(
    "moment of inertia",
    "kg*m^2",
    1.0,
    ((("length", 2), ("mass", 1)),),
    (("kg*m^2", 1.0), ("g*cm^2", 1e-7), ("kg*mm^2", 1e-6)),
)
POWER = Dimension("power", "W", 1.0, ((("power", 1),),), (("W", 1.0), ("kW", 1e3)))
TORQUE_CONSTANT = Dimension(
    "torque constant",
    "N*m/A",
    1.0,
    ((("current", -1), ("force", 1), ("length", 1)),),
    (("N*m/A", 1.0), ("mN*m/A", 1e-3)),
    "volts over speed are the same number as N*m/A in SI",
)
SPEED_CONSTANT = Dimension(
    "speed constant",
    "rpm/V",
    _TURN / 60.0,
    ((("rotational speed", 1), ("voltage", -1)), (("angle", 1), ("time", -1), ("voltage", -1))),
    (("rpm/V", _TURN / 60.0), ("rad/s/V", 1.0)),
)
RESISTANCE = Dimension(
    "resistance", "ohm", 1.0, ((("resistance", 1),),), (("ohm", 1.0), ("mohm", 1e-3))
)
INDUCTANCE = Dimension(
    "inductance", "uH", 1e-6, ((("inductance", 1),),), (("uH", 1e-6), ("mH", 1e-3), ("H", 1.0))
)
TORQUE_DENSITY = Dimension(
    "torque density",
    "N*m/kg",
    1.0,
    ((("force", 1), ("length", 1), ("mass", -1)),),
    (("N*m/kg", 1.0),),
)


@functools.lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Any]:
    import pint

    try:
        return pint.UnitRegistry(cache_folder=":auto:")
    except Exception:  # an unwritable cache folder must not stop the reading of a number
        return pint.UnitRegistry()


def _kind(unit: str, registry: UnitRegistry[Any]) -> str:
    quantity = registry.Quantity(1.0, unit)
    angles = {"radian", "degree", "arcminute", "arcsecond", "turn", "milliradian", "microradian"}
    if quantity.dimensionless:
        return "angle" if unit in angles or unit in {"revolution", "grade"} else "number"
    if unit in {"revolutions_per_minute", "revolutions_per_second"}:
        return "rotational speed"
    kinds = {
        "[length]": "length",
        "[time]": "time",
        "[force]": "force",
        "[energy]": "energy",
        "[power]": "power",
        "[temperature]": "temperature",
        "[current]": "current",
        "[mass]": "mass",
        "[frequency]": "frequency",
    }
    for dimension, kind in kinds.items():
        if quantity.check(dimension):
            return kind
    for example, kind in (("volt", "voltage"), ("ohm", "resistance"), ("henry", "inductance")):
        if quantity.is_compatible_with(example):
            return kind
    return str(quantity.dimensionality)


@functools.lru_cache(maxsize=256)
def _factor_by_pint(unit: str, dimension: Dimension) -> float:
    """SI value of one `unit`, by pint, after the kinds of its factors have been checked."""
    registry = _registry()
    import pint

    try:
        parsed = registry.parse_units(unit)
    except pint.UndefinedUnitError as error:
        names = [spelling for spelling, _ in dimension.common]
        raise DesignError(
            f"'{unit}' is not a unit{did_you_mean(unit, names)}; a {dimension.name} is written "
            f"like {dimension.example()}"
        ) from error
    except Exception as error:
        raise DesignError(
            f"'{unit}' cannot be read as a unit; a {dimension.name} is written like "
            f"{dimension.example()}"
        ) from error
    kinds: dict[str, int] = {}
    for name, exponent in parsed._units.items():
        kind = _kind(name, registry)
        kinds[kind] = kinds.get(kind, 0) + round(float(exponent))  # type: ignore[arg-type]
    signature = tuple(sorted((kind, power) for kind, power in kinds.items() if power))
    if signature not in dimension.signatures:
        reason = f" ({dimension.refuses})" if dimension.refuses else ""
        raise DesignError(
            f"'{unit}' is not a unit of {dimension.name}; write it like "
            f"{dimension.example()}{reason}"
        )
    if signature == (("temperature", 1), ("power", -1)) or "temperature" in kinds:
        parsed = registry.parse_units(unit, as_delta=True)
    return float(registry.Quantity(1.0, parsed).to_base_units().magnitude)


def parse_quantity(text: str, dimension: Dimension) -> float:
    """The SI value of a unit string.

    Parameters
    ----------
    text : str
        A number and a unit, such as ``"120 N*m"``.
    dimension : Dimension
        What the field holds.

    Returns
    -------
    float
        Finite, in SI base units (angles in rad, speeds in rad/s).

    Raises
    ------
    DesignError
        When there is no number, no unit, a unit of another kind, or a value that is not finite.

    Examples
    --------
    >>> parse_quantity("120 N*m", TORQUE)
    120.0
    >>> round(parse_quantity("1286 rpm", SPEED), 3)
    134.67
    """
    match = _NUMBER.match(text)
    if match is None:
        raise DesignError(
            f"'{text[:60]}' has no number; a {dimension.name} is written like {dimension.example()}"
        )
    number, unit = float(match.group(1)), match.group(2)
    if not unit:
        raise DesignError(
            f"'{text}' has no unit; write it like \"{match.group(1)} {dimension.unit}\""
        )
    if len(unit) > 40:
        raise DesignError(
            f"'{unit[:40]}...' is no unit; a {dimension.name} is written like {dimension.example()}"
        )
    unit = _SPELLINGS.get(unit, unit)
    factor = dict(dimension.common).get(unit)
    if factor is None:
        factor = _factor_by_pint(unit, dimension)
    value = _scaled(number, factor)
    if not math.isfinite(value):
        raise DesignError(f"'{text}' is not a finite {dimension.name}")
    return value


def _scaled(number: float, factor: float) -> float:
    """The product, without the last-digit noise of 72 * 0.001: divide by whole inverses."""
    inverse = round(1.0 / factor) if 1e-12 < factor < 1.0 else 0
    if inverse and math.isclose(inverse * factor, 1.0, rel_tol=1e-15):
        return number / inverse
    return number * factor


def format_quantity(value: float, dimension: Dimension) -> str:
    """The unit string of an SI value, in the dimension's own unit.

    Twelve significant digits: enough that reading it back gives the same machine, few enough that
    ``0.032`` is ``"32 mm"``.

    Examples
    --------
    >>> format_quantity(0.032, LENGTH)
    '32 mm'
    """
    return f"{value / dimension.si_factor:.12g} {dimension.unit}"


@dataclass(frozen=True)
class QuantityIn:
    """Pydantic annotation: a bounded quantity, read from a unit string and held as an SI float.

    A bare number is refused with the right form shown, unless the validation context says
    ``{"si": True}``, which is how the package's own code builds designs.

    Attributes
    ----------
    dimension : Dimension
        What the field holds.
    low, high : str
        Unit strings of the least and the most allowed, both included.
    reason : str
        Why these bounds; part of the error message.
    """

    dimension: Dimension
    low: str
    high: str
    reason: str

    def _validate(self, value: object, info: Any) -> float:
        if isinstance(value, str):
            try:
                return self._bounded(parse_quantity(value, self.dimension))
            except DesignError as error:
                raise ValueError(str(error)) from None
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if info.context is not None and info.context.get("si"):
                return self._bounded(float(value))
            raise ValueError(f'{value} has no unit; write it like "{value} {self.dimension.unit}"')
        raise ValueError(
            f"a {self.dimension.name} is written like {self.dimension.example()}, "
            f"not as a {type(value).__name__}"
        )

    def _bounded(self, value: float) -> float:
        least = parse_quantity(self.low, self.dimension)
        most = parse_quantity(self.high, self.dimension)
        slack = 1e-12 * max(abs(least), abs(most))
        if least - slack <= value <= most + slack:
            return value
        nearest = self.high if value > most else self.low
        shown = format_quantity(value, self.dimension) if math.isfinite(value) else str(value)
        raise ValueError(
            f"{shown} is outside {self.low} to {self.high} ({self.reason}); "
            f"the nearest allowed is {nearest}"
        )

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate strings before pydantic's own float checks (bounds come after)."""
        from pydantic_core import core_schema

        return core_schema.with_info_before_validator_function(
            self._validate,
            core_schema.float_schema(allow_inf_nan=False),
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda value: format_quantity(value, self.dimension), when_used="json"
            ),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """A string with a pattern and an example, for editors."""
        return {
            "type": "string",
            "pattern": r"^\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*\S.*$",
            "description": f"{self.dimension.name} from {self.low} to {self.high}: {self.reason}",
            "examples": [f"1 {self.dimension.unit}"],
        }
