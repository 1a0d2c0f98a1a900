"""The exception family. Every error a user can cause is one of these and carries its exit code.

The exit codes are part of the public interface (docs/cli.md):
0 done, 1 bug, 2 wrong usage, 3 invalid or infeasible design, 4 a check or a read-back failed,
5 missing dependency, 130 interrupted.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable


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
