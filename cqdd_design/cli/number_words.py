"""What to say of a number on the command line that an option does not take."""

from __future__ import annotations

import math

_WORDS = ("int_", "float_", "greater_than", "less_than", "finite_number")
"""How kinds of errors begin that are about numbers."""


def number_refused(error: Exception) -> str:
    """The option, the range it takes, what was given and the nearest that it takes.

    Parameters
    ----------
    error : Exception
        Of the option parser, which keeps what it found as its cause.

    Returns
    -------
    str
        Nothing where it is not about a number.
    """
    option, found = getattr(error, "param", None), getattr(error.__cause__, "errors", None)
    if option is None or found is None:
        return ""
    first = found()[0]
    kind, given = str(first["type"]), str(first["input"])
    if not kind.startswith(_WORDS):
        return ""
    least, most = getattr(option, "min", None), getattr(option, "max", None)
    bounds = (least, most, *first.get("ctx", {}).values())
    whole = kind.startswith("int_") or any(isinstance(one, int) for one in bounds)
    words = f"a {'whole ' if whole else ''}number{_range(least, most)}"
    near = _nearest(given, least, most, whole=whole)
    told = f"; the nearest is {near}" if near else ""
    return f"{option.opts[0]} takes {words}, not '{given}'{told}"


def _range(least: float | None, most: float | None) -> str:
    if least is not None and most is not None:
        return f" from {least} to {most}"
    if least is not None:
        return f" of at least {least}"
    return "" if most is None else f" of at most {most}"


def _nearest(given: str, least: float | None, most: float | None, *, whole: bool) -> str:
    """The number nearest to what was given; nothing where that is no number."""
    try:
        value = float(given)
    except ValueError:
        return ""
    if not math.isfinite(value):
        return ""
    near: float = round(value) if whole else value
    if least is not None and near < least:
        near = least
    if most is not None and near > most:
        near = most
    return f"{near}"
