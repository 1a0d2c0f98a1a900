"""What the shell offers after TAB: design files, folders and files, names, and choices.

A shell waits for it, so names are read from the package's files, without numpy or the catalogue's
readers. A test holds them against what those give.
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from cqdd_design.cli.check_names import CHECKS
from cqdd_design.cli.known_names import ESTIMATED, LOADS_BY_PLANETS, MEASUREMENTS, SETS, UNKNOWNS
from cqdd_design.exporting.estimators.kinds import KINDS as ESTIMATORS
from cqdd_design.exporting.kinds import KINDS

_ASKED_BY = "_CQDD_DESIGN_COMPLETE"
"""Variable in which Typer's scripts say which shell asks."""
_PACKAGE = Path(__file__).parents[1]
_SPECIAL = re.compile(r"[^\w@%+=:,./-]")
"""Signs that bash reads as more than themselves."""
TEMPLATES = ("design", "duty", "motor", "requirements")
"""Kinds of template that `new` writes."""
_CATALOGUES = {
    "materials": "materials.csv",
    "motors": "motors.csv",
    "bearings": "bearings.csv",
    "screws": "shoulder_screws.csv",
    "lubricants": "lubricants.csv",
    "finishes": "finishes.csv",
}


class _Offered(str):
    """A name that begins as typed, but for its case and its escaped blanks.

    Typer leaves out whatever does not begin with the very letters typed.
    """

    __slots__ = ()

    def startswith(self, *_: Any) -> bool:
        """What is offered was chosen already."""
        return True


def designs(incomplete: str) -> list[str]:
    """Design files and folders that begin so."""
    head, slash, begun = incomplete.rpartition("/")
    folder = Path(head + slash) if slash else Path()
    if not folder.is_dir():
        return []
    found = []
    for one in sorted(folder.iterdir()):
        if not one.name.startswith(begun) or (one.name.startswith(".") and not begun):
            continue
        if one.is_dir():
            found.append(f"{head}{slash}{one.name}/")
        elif one.suffix == ".toml":
            found.append(f"{head}{slash}{one.name}")
    return found


def _starting(names: Callable[[], Iterable[str]]) -> Callable[[str], list[str]]:
    def complete(incomplete: str) -> list[str]:
        begun = incomplete.casefold()
        found = [name for name in names() if name.casefold().startswith(begun)]
        # zsh and fish quote what they insert; bash puts it on the line as it is.
        bare = os.environ.get(_ASKED_BY, "").endswith("_bash") and not _within_quotes()
        return [_Offered(_SPECIAL.sub(r"\\\g<0>", name) if bare else name) for name in found]

    return complete


def _within_quotes() -> bool:
    """Whether the word that is typed began with a quotation mark which is still open."""
    open_mark, escaped = "", False
    for sign in os.environ.get("COMP_WORDS", ""):
        if escaped:
            escaped = False
        elif sign == "\\" and open_mark != "'":
            escaped = True
        elif sign == open_mark:
            open_mark = ""
        elif sign in "\"'" and not open_mark:
            open_mark = sign
    return bool(open_mark)


def _rows(catalogue: str, only: str = "") -> list[str]:
    """First cells of a catalogue's rows, of those alone that have a cell `only`."""
    path = _PACKAGE / "catalog" / "data" / _CATALOGUES[catalogue]
    with path.open(newline="", encoding="utf-8") as file:
        kept = (line for line in file if not line.startswith("#"))
        return [row[0] for row in list(csv.reader(kept))[1:] if row and (not only or only in row)]


def _listed(names: Iterable[str], after: str = ",") -> Callable[[str], list[str]]:
    """Names that begin as the last of a list does, and are not on it yet."""

    def complete(incomplete: str) -> list[str]:
        before, comma, begun = incomplete.rpartition(after)
        had = [name.strip() for name in before.split(after)]
        found = [name for name in names if name not in had]
        return [_Offered(f"{before}{comma}{name}") for name in _starting(lambda: found)(begun)]

    return complete


def choices(metavar: str) -> Callable[[str], list[str]] | None:
    """Completion of an option whose help names all it can be, as ``iso|sodick`` does."""
    names = metavar.split("|")
    return _starting(lambda: names) if len(names) > 1 else None


export_kinds = _listed(KINDS)
estimator_kinds = _listed(ESTIMATORS)
measurements = _listed(MEASUREMENTS)
unknowns = _listed(UNKNOWNS)
test_sets = _listed(SETS)
held_out = _starting(lambda: SETS)
networks = _starting(lambda: ESTIMATED)
mesh_load_tables = _starting(lambda: LOADS_BY_PLANETS)
motors = _starting(lambda: _rows("motors"))
sized_motors = _starting(lambda: ["any", *_rows("motors")])
geared_actuators = _starting(lambda: _rows("motors", only="output"))
materials = _starting(lambda: _rows("materials"))
checks = _starting(lambda: CHECKS)
catalogued = _starting(
    lambda: [
        "list",
        "show",
        *_CATALOGUES,
        "fits",
        "rubbing",
        "circlips",
        "nuts",
        *_rows("materials"),
        *_rows("motors"),
    ]
)
"""Catalogues, and the rows of those that designs name most."""
templates = _starting(lambda: TEMPLATES)
examples = _starting(
    lambda: sorted(one.stem for one in (_PACKAGE / "design" / "examples").glob("*.toml"))
)
