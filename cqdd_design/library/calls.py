"""How a call reads what it is given, and how its errors speak: of arguments, not of options."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from cqdd_design.errors import CqddError, DesignError, UsageError

if TYPE_CHECKING:
    from cqdd_design.units import Dimension, Quantity

Arguments = ParamSpec("Arguments")
Returned = TypeVar("Returned")

_OPTION = re.compile(r"--([a-z]+(?:-[a-z]+)*)")
_FLAGS = {"force": "force=True", "quick": "quick=True"}


def road(function: Callable[Arguments, Returned]) -> Callable[Arguments, Returned]:
    """Of a function that goes a road: its errors name arguments where roads name options."""

    @functools.wraps(function)
    def call(*given: Arguments.args, **named: Arguments.kwargs) -> Returned:
        try:
            return function(*given, **named)
        except CqddError as error:
            if error.args and isinstance(error.args[0], str):
                error.args = (of_arguments(error.args[0]), *error.args[1:])
            raise

    return call


def of_arguments(sentence: str) -> str:
    """A sentence that names options, naming arguments; commands between backticks stay.

    Examples
    --------
    >>> of_arguments("--motor-file exists; add --force, or run `cqdd-design doctor --json`.")
    'motor_file exists; add force=True, or run `cqdd-design doctor --json`.'
    """
    pieces = sentence.split("`")
    pieces[::2] = [_OPTION.sub(_argument, piece) for piece in pieces[::2]]
    return "`".join(pieces)


def _argument(found: re.Match[str]) -> str:
    name = found[1].replace("-", "_")
    return _FLAGS.get(name, name)


def si_value(
    name: str, given: Quantity | None, dimension: Dimension, *, positive: bool = False
) -> float | None:
    """The SI value of a quantity that was given, or None when it was not.

    Parameters
    ----------
    name : str
        Of the argument or option, for messages.
    given : str or quantity of pint, optional
        With its unit.
    dimension : Dimension
        What it is.
    positive : bool
        Refuse zero and less.

    Raises
    ------
    UsageError
        Naming the argument and the right form.
    """
    if given is None:
        return None
    from cqdd_design.units import read_quantity

    try:
        value = read_quantity(given, dimension)
    except DesignError as error:
        raise UsageError(f"{name}: {error.message.rstrip('.')}.") from None
    if positive and value <= 0.0:
        raise UsageError(f"{name} {given} is not above zero.")
    return value


def whole(name: str, given: int, least: int, most: int | None = None) -> int:
    """A whole number that was given, from `least` to `most`.

    Raises
    ------
    UsageError
        Naming the argument, its range and the nearest that is in it.
    """
    if isinstance(given, bool) or not isinstance(given, int):
        raise UsageError(f"{name} {given!r} is not a whole number.")
    if given < least or (most is not None and given > most):
        allowed = f"at least {least}" if most is None else f"from {least} to {most}"
        nearest = least if given < least else most
        raise UsageError(f"{name} {given} must be {allowed}; the nearest is {nearest}.")
    return given


def names(given: str | Sequence[str]) -> tuple[str, ...]:
    """Names in a sequence, or in one text between commas."""
    parts = given.split(",") if isinstance(given, str) else given
    return tuple(part.strip() for part in parts if part.strip())
