"""Numbers for people: significant digits, real minus signs, grouped thousands, display units."""

from __future__ import annotations

import math

from cqdd_design.terms import hardly

MINUS = "\u2212"
THIN = "\u202f"
TIMES = "\u00d7"
NONE = "\u2013"
"""Printed where there is no value."""

RPM = 30.0 / math.pi
"""Turns a minute in 1 rad/s."""
ARCMIN = math.degrees(1.0) * 60.0
"""Minutes of arc in 1 rad."""


def significant(value: float, digits: int = 4) -> str:
    """A number to so many significant digits, without exponents between 1e-4 and 1e7.

    Examples
    --------
    >>> significant(963.06), significant(0.0015666), significant(2.0)
    ('963.1', '0.001567', '2')
    """
    if value == 0.0:
        return "0"
    if math.isinf(value):
        return "\u221e" if value > 0 else f"{MINUS}\u221e"
    exponent = math.floor(math.log10(abs(value)))
    rounded = float(f"{value:.{digits - 1}e}")
    if not -4 <= exponent < 7:
        mantissa, power = f"{value:.{digits - 1}e}".split("e")
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        return f"{_signed(mantissa)}{THIN}{TIMES}{THIN}10{superscript(int(power))}"
    decimals = max(digits - 1 - math.floor(math.log10(abs(rounded))), 0)
    shown = f"{rounded:.{decimals}f}"
    if "." in shown:
        shown = shown.rstrip("0").rstrip(".")
    return _signed(_grouped(shown))


def decimals(value: float, places: int) -> str:
    r"""A number with a fixed count of decimals, for columns that are read against each other.

    Examples
    --------
    >>> decimals(12345.678, 1)
    '12\u202f345.7'
    """
    shown = f"{value:.{places}f}"
    if float(shown) == 0.0:
        shown = shown.lstrip("-")
    return _signed(_grouped(shown))


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """A number and its unit with a thin space between, none before a degree sign."""
    shown = hardly(value, unit) or significant(value, digits)
    gap = "" if unit in ("", "deg") else THIN
    return f"{shown}{gap}{pretty_unit(unit)}"


def millimetres(metres: float, digits: int = 5) -> str:
    """A length as on a drawing: ``7 mm``."""
    return with_unit(1e3 * metres, "mm", digits)


def per_cent(share: float, digits: int = 4) -> str:
    """A share in per cent: ``38 %``."""
    return f"{significant(100.0 * share, digits)}{THIN}%"


def maybe(value: float | None, digits: int = 4) -> str:
    """A number, or a dash where there is none."""
    return NONE if value is None or not math.isfinite(value) else significant(value, digits)


def grouped(number: int) -> str:
    """A whole number with thin spaces between thousands.

    Examples
    --------
    >>> grouped(1234567)
    '1\u202f234\u202f567'
    """
    return f"{number:,}".replace(",", THIN)


_PRETTY = {"um": "\u00b5m", "N/um": "N/\u00b5m", "deg": "\u00b0", "degC": "\u00b0C"}


def pretty_unit(unit: str) -> str:
    """A unit as printed: ``N*m`` with a dot, ``um`` with a micro sign.

    Examples
    --------
    >>> pretty_unit("N*m"), pretty_unit("degC")
    ('N\u00b7m', '\u00b0C')
    """
    if unit in _PRETTY:
        return _PRETTY[unit]
    return unit.replace("*", "\u00b7").replace("^2", "\u00b2").replace("^3", "\u00b3")


def quantity_text(text: str) -> str:
    """A unit string of a design file as printed: ``"120 N*m"`` becomes ``120 N\u00b7m``."""
    number, _, unit = text.partition(" ")
    try:
        float(number)
    except ValueError:
        return text
    return with_unit(float(number), unit, 6) if unit else text


def _grouped(shown: str) -> str:
    whole, dot, rest = shown.partition(".")
    sign, digits = ("-", whole[1:]) if whole.startswith("-") else ("", whole)
    if len(digits) > 4:
        digits = grouped(int(digits))
    return f"{sign}{digits}{dot}{rest}"


def _signed(shown: str) -> str:
    return f"{MINUS}{shown[1:]}" if shown.startswith("-") else shown


def superscript(power: int) -> str:
    """A whole number as an exponent."""
    digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"
    raised = "".join(digits[int(d)] for d in str(abs(power)))
    return f"\u207b{raised}" if power < 0 else raised
