"""Numbers of long searches on disk: a design judged before needs no search anew."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence

from cqdd_design.environment import cache_folder
from cqdd_design.files.kept import entry_path, read_entry, write_entry
from cqdd_design.files.package_state import package_state
from cqdd_design.machine import Machine

_MOST_KEPT = 5_000_000
"""Bytes of all numbers together: some thousand of them."""


def remembered(
    what: str, machine: Machine, given: Sequence[float], find: Callable[[], float]
) -> float:
    """A number as the disk has it, or found and put there.

    Parameters
    ----------
    what : str
        Of which search.
    given : sequence of float
        What the search starts from, beside the design and its motor.
    find : callable
        The search. Nothing is kept of one that raises.
    """
    text = json.dumps(
        [
            *(what, package_state(), sys.version, machine.given.sha256, machine.design.sha256),
            *(repr(machine.motor), list(map(float, given))),
        ]
    )
    path = entry_path(cache_folder() / "numbers", text, "number")
    kept = read_entry(path, text)
    if kept is not None and isinstance(kept[1], float):
        return kept[1]
    found = float(find())
    write_entry(path, text, (), found, _MOST_KEPT)
    return found
