"""The exception family. Every error a user can cause is one of these and carries its exit code.

The exit codes are part of the public interface (docs/cli.md):
0 done, 1 bug, 2 wrong usage, 3 invalid or infeasible design, 4 a check or a read-back failed,
5 missing dependency, 130 interrupted.
"""

from __future__ import annotations

import difflib
import math
import unicodedata
from collections.abc import Iterable, Mapping

#: Nothing has a longer name, and comparing long texts takes long.
_LONGEST_NAME = 100


class CqddError(Exception):
    """Base of every error this package raises on purpose.

    The message is one or more complete sentences for a designer: what, where, the value, the
    allowed range and the nearest fix.
    """

    exit_code = 1

    @property
    def message(self) -> str:
        """The sentence to print."""
        return str(self)


class UsageError(CqddError):
    """The command line (or a call) asks for something that does not exist. Exit code 2."""

    exit_code = 2


class DesignError(CqddError):
    """A design or requirements file is invalid: syntax, keys, units or bounds. Exit code 3."""

    exit_code = 3


class GeometryError(DesignError):
    """The numbers are legal one by one, but no part can have this shape. Exit code 3."""


class ContactError(DesignError):
    """No contact equilibrium: the parts cannot touch, or the load leaves the model. Exit code 3."""


class InfeasibleError(DesignError):
    """No design meets the requirements; the message names the limits that bind. Exit code 3."""


class CatalogError(UsageError):
    """A catalogue has no row of this name; the message suggests the nearest. Exit code 2."""


class ReadBackError(CqddError):
    """A file just written did not read back as the design it came from. Exit code 4."""

    exit_code = 4


class DependencyError(CqddError):
    """A Python package or a system library is missing; the message says what to install. Exit 5."""

    exit_code = 5


def nearest_names(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Names in `known` most like `name`, best first, ignoring case.

    Parameters
    ----------
    name : str
        What the user typed.
    known : iterable of str
        The names that exist.
    count : int
        The most to return.

    Returns
    -------
    list of str
        Possibly empty.

    Examples
    --------
    >>> nearest_names("eccentricty", ["eccentricity", "ratio"])
    ['eccentricity']
    """
    if len(name) > _LONGEST_NAME:
        return []
    by_lower = {candidate.lower(): candidate for candidate in known}
    wanted = name.lower()
    containing = [key for key in by_lower if len(wanted) > 2 and wanted in key]
    close = difflib.get_close_matches(wanted, by_lower, n=count, cutoff=0.5)
    ordered = list(dict.fromkeys([*containing, *close]))
    return [by_lower[key] for key in ordered[:count]]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A sentence tail such as ``; did you mean 'eccentricity'?``, or an empty string."""
    names = nearest_names(name, known, count=2)
    if not names:
        return ""
    return "; did you mean " + " or ".join(f"'{n}'" for n in names) + "?"


def shown(value: object, longest: int = 60) -> str:
    """A value from a file as it may stand in a sentence: short, and without control characters.

    Examples
    --------
    >>> shown("7 mm"), shown(1.5), shown(10**400)
    ("'7 mm'", '1.5', 'a whole number of 401 digits')
    """
    if isinstance(value, int) and value.bit_length() > 200:
        return f"a whole number of {math.floor(value.bit_length() * math.log10(2.0)) + 1} digits"
    if isinstance(value, (Mapping, list, tuple)):
        return f"a {'table' if isinstance(value, Mapping) else 'list'} of {len(value)}"
    text = repr(value) if isinstance(value, str) else printable(str(value))
    return text if len(text) <= longest else text[: longest - 3] + "..."


def printable(text: str) -> str:
    r"""Text for a terminal: line breaks stay, other control and direction characters are named.

    Examples
    --------
    >>> print(printable("a\x1b[2Jb"))
    a\x1b[2Jb
    """
    return "".join(
        c if c in "\n\t" or not is_unprintable(c) else c.encode("unicode_escape").decode()
        for c in text
    )


def is_unprintable(character: str) -> bool:
    """Whether a character shows nothing of itself, or turns what is beside it about.

    These are controls (C0, C1), marks of direction and of joining, surrogates, and the
    separators of lines and paragraphs.
    """
    return unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"}
