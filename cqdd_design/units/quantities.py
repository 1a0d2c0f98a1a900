"""Reading and writing unit strings. The only module that knows pint."""

from __future__ import annotations

import functools
import math
import re
import sys
from typing import TYPE_CHECKING, Any, TypeAlias

from cqdd_design.errors import DesignError, did_you_mean, shown
from cqdd_design.units.dimensions import Dimension
from cqdd_design.units.expression import LONGEST, parse_expression
from cqdd_design.units.plain import real_number

if TYPE_CHECKING:
    import pint
    from pint import UnitRegistry

Quantity: TypeAlias = "str | pint.Quantity[Any]"
"""A number with its unit, as calls take it: a unit string, or a quantity of any pint registry."""

_NUMBER = re.compile(r"[+-]?(?:\d+(?:_\d+)*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(?!\d{3}\b)(\d+)")
#: The longest number and unit that is read; a float has 17 digits that count.
_LONGEST_TEXT = 100

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
    "°C": "degC",
    "°F": "degF",
    "'": "arcmin",
    "RPM": "rpm",
    "rev/min": "rpm",
    "rev/s": "turn/s",
    "Ω": "ohm",
    "inch": "in",
    '"': "in",
}


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
    if unit.endswith(("revolutions_per_minute", "revolutions_per_second")):
        return "rotational_speed"
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
    written = f"a {dimension.name} is written like {dimension.example()}"
    try:
        powers = parse_expression(unit)
    except ValueError as error:
        raise DesignError(f"'{unit}' cannot be read as a unit: {error}; {written}") from None
    registry = _registry()
    import pint

    # Only names and whole powers reach pint, so that none of its own arithmetic does.
    product = " * ".join(f"{name} ** {power}" for name, power in powers.items())
    try:
        parsed = registry.parse_units(product, as_delta=True)
    except pint.UndefinedUnitError:
        names = [spelling for spelling, _ in dimension.common]
        hint = did_you_mean(unit, names)
        raise DesignError(f"'{unit}' is not a unit{hint}; {written}") from None
    except Exception:
        raise DesignError(f"'{unit}' cannot be read as a unit; {written}") from None
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
        Finite, in SI base units (angles in rad, speeds in rad/s), temperatures in deg C.

    Raises
    ------
    DesignError
        When there is no number, no unit, a unit of another kind or one that does not follow the
        grammar of `expression`, or a value that is not finite.

    Examples
    --------
    >>> from cqdd_design.units import SPEED, TORQUE
    >>> parse_quantity("120 N*m", TORQUE)
    120.0
    >>> round(parse_quantity("1286 rpm", SPEED), 3)
    134.67
    """
    text = text.strip()
    match = _NUMBER.match(text)
    if match is None:
        raise DesignError(
            f"'{text[:60]}' has no number; a {dimension.name} is written like {dimension.example()}"
        )
    unit = text[match.end() :].strip()
    if not unit:
        raise DesignError(
            f"'{text[:60]}' has no unit; write it like \"{text[:20]} {dimension.unit}\""
        )
    if len(text) > _LONGEST_TEXT or len(unit) > LONGEST:
        kept, what = (text[:20], "quantity") if len(unit) <= LONGEST else (unit[:LONGEST], "unit")
        raise DesignError(
            f"'{kept}...' is too long for a {what}; a {dimension.name} is written like "
            f"{dimension.example()}"
        )
    if comma := _DECIMAL_COMMA.match(text):
        raise DesignError(f"'{text[:60]}' has a decimal comma; write {comma[1]}.{comma[2]}")
    number = float(match[0])
    unit = _SPELLINGS.get(unit, unit)
    factor = dict(dimension.common).get(unit)
    if factor is None:
        if dimension.zeros:
            raise DesignError(
                f"'{unit}' is not a unit of {dimension.name}; {dimension.refuses}, like "
                f"{dimension.example()}"
            )
        factor = _factor_by_pint(unit, dimension)
    value = _scaled(number, factor) + dict(dimension.zeros).get(unit, 0.0)
    if not math.isfinite(value):
        raise DesignError(f"'{text}' is not a finite {dimension.name}")
    return value


def read_quantity(value: object, dimension: Dimension) -> float:
    """The SI value of a unit string, or of a quantity of pint.

    A quantity of pint is read by its unit like a string: a joule is no torque.

    Raises
    ------
    DesignError
        As `parse_quantity`; for a bare number, with the right form; and for anything else.

    Examples
    --------
    >>> import pint
    >>> from cqdd_design.units import TEMPERATURE, TORQUE
    >>> registry = pint.UnitRegistry()
    >>> read_quantity(registry.Quantity(0.04, "kN*m"), TORQUE)
    40.0
    >>> read_quantity(registry.Quantity(300.0, "kelvin"), TEMPERATURE)
    26.85
    """
    if isinstance(value, str):
        return parse_quantity(value, dimension)
    # Who has a quantity has imported pint; nobody else pays for it.
    known = sys.modules.get("pint")
    if known is not None and isinstance(value, known.Quantity):
        return parse_quantity(_unit_string(value, dimension), dimension)
    if real_number(value) is not None:
        text = shown(value)
        raise DesignError(f'{text} has no unit; write it like "{text} {dimension.unit}"')
    raise DesignError(
        f"a {dimension.name} is written like {dimension.example()}, not as a {type(value).__name__}"
    )


def _unit_string(quantity: pint.Quantity[Any], dimension: Dimension) -> str:
    """A quantity of pint as text; of a scale with a zero of its own, in its usual unit."""
    if dimension.zeros and str(quantity.units).startswith("delta_"):
        raise DesignError(
            f"'{quantity}' is a difference; a {dimension.name} is written like "
            f'{dimension.example()}, or in pint as Quantity(40, "{dimension.unit}")'
        )
    if dimension.zeros and quantity.is_compatible_with(dimension.unit):
        quantity = quantity.to(dimension.unit)
        return f"{float(quantity.magnitude):.15g} {dimension.unit}"
    try:
        number = float(quantity.magnitude)
    except (TypeError, ValueError):
        raise DesignError(
            f"a {dimension.name} is one number, like {dimension.example()}, not "
            f"{shown(quantity.magnitude)}"
        ) from None
    return f"{number!r} {quantity.units:C}"


def unit_string(given: object) -> str:
    """A quantity as a unit string: a string is one already, a bare number stays without a unit.

    Examples
    --------
    >>> import pint
    >>> unit_string(pint.UnitRegistry().Quantity(0.5, "kg*m^2")), unit_string("2 kg")
    ('0.5 kilogram*meter**2', '2 kg')
    """
    if isinstance(given, str):
        return given
    known = sys.modules.get("pint")
    if known is not None and isinstance(given, known.Quantity):
        number = real_number(given.magnitude)
        return shown(given) if number is None else f"{number!r} {given.units:C}"
    return shown(given)


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
    >>> from cqdd_design.units import LENGTH
    >>> format_quantity(0.032, LENGTH)
    '32 mm'
    """
    return f"{value / dimension.si_factor:.12g} {dimension.unit}"
