"""How a call reads what it is given, and how its errors speak: of arguments, not of options."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from cqdd_design.errors import CqddError, DesignError, UsageError, did_you_mean, shown

if TYPE_CHECKING:
    from cqdd_design.units import Dimension, Quantity

Arguments = ParamSpec("Arguments")
Returned = TypeVar("Returned")

_OPTION = re.compile(r"--([a-z]+(?:-[a-z]+)*)")
_FLAGS = {"force": "force=True", "quick": "quick=True"}


def road(function: Callable[Arguments, Returned]) -> Callable[Arguments, Returned]:
    """Of a function that goes a road: its errors name arguments where roads name options.

    Arguments that it does not take are refused as `UsageError` too, with those that it takes.
    """
    signature = inspect.signature(function)

    @functools.wraps(function)
    def call(*given: Arguments.args, **named: Arguments.kwargs) -> Returned:
        _refuse_misnamed(function.__name__, signature, given, named)
        try:
            return function(*given, **named)
        except CqddError as error:
            if error.args and isinstance(error.args[0], str):
                error.args = (of_arguments(error.args[0]), *error.args[1:])
            raise

    return call


def _refuse_misnamed(
    name: str,
    signature: inspect.Signature,
    given: Sequence[object],
    named: Mapping[str, object],
) -> None:
    """Refuse arguments that a function does not take, and the lack of one that it needs."""
    try:
        signature.bind(*given, **named)
    except TypeError as error:
        own = [
            one.name
            for one in signature.parameters.values()
            if one.kind is not inspect.Parameter.VAR_KEYWORD
        ]
        unknown = next((key for key in named if key not in own), None)
        takes = f"it takes {', '.join(own)}"
        if unknown is None or str(error).startswith("too many"):
            raise UsageError(f"{name}: {error}; {takes}, and all but the first by name.") from None
        hint = did_you_mean(unknown, own) or "."
        head = f"{name} has no argument {unknown}{hint}"
        raise UsageError(f"{head} {takes[0].upper()}{takes[1:]}.") from None


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
        from cqdd_design.units import format_quantity

        there = format_quantity(-value, dimension) if value else f"1 {dimension.unit}"
        raise UsageError(f'{name} {given} is not above zero; use "{there}", for example.')
    return value


def one_of(name: str, given: object, choices: Sequence[str]) -> str:
    """A word that was given, where it is one of those that there are.

    Raises
    ------
    UsageError
        Naming the argument or option, the choices and the nearest of them.
    """
    if isinstance(given, str) and given in choices:
        return given
    hint = did_you_mean(given, choices) if isinstance(given, str) else ""
    raise UsageError(f"{name} {shown(given)} is none of {', '.join(choices)}{hint or '.'}")


def text(name: str, given: object, example: str) -> str:
    """A text that was given.

    Raises
    ------
    UsageError
        Naming the argument and an example, for anything else.
    """
    if isinstance(given, str):
        return given
    raise UsageError(f'{name} {shown(given)} is not a text, such as "{example}".')


def whole(name: str, given: object, least: int, most: int | None = None) -> int:
    """A whole number that was given, from `least` to `most`: an int, or a float that is whole.

    Raises
    ------
    UsageError
        Naming the argument, its range and the nearest that is in it.
    """
    from cqdd_design.units import whole_number

    allowed = f"at least {least}" if most is None else f"from {least} to {most}"
    number = whole_number(given)
    if number is None:
        raise UsageError(f"{name} {shown(given)} is not a whole number; it must be {allowed}.")
    if number < least or (most is not None and number > most):
        nearest = least if number < least else most
        raise UsageError(f"{name} {shown(number)} must be {allowed}; the nearest is {nearest}.")
    return number


def names(name: str, given: object, example: str) -> tuple[str, ...]:
    """Names in a sequence, or in one text between commas.

    Raises
    ------
    UsageError
        Naming the argument and an example, for anything else.
    """
    parts = given.split(",") if isinstance(given, str) else given
    if not isinstance(parts, Iterable) or isinstance(parts, Mapping):
        parts = (given,)
    found = tuple(parts)
    wrong = [part for part in found if not isinstance(part, str)]
    if wrong:
        raise UsageError(
            f'{name} {shown(wrong[0])} is not a name; give names, such as ("{example}",).'
        )
    return tuple(part.strip() for part in found if part.strip())
