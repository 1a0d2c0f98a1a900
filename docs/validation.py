"""The page of published numbers: what each row is worth, and its tables."""

from __future__ import annotations

import csv
import math
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HEAD = """\
# Validation

Numbers of the literature beside ours. This page is written by `python docs/build.py` from the
tests in `tests/published`: each row is one comparison of one test, and outside its tolerance the
test would fail. A tolerance is half of the last printed digit, or what the note below its table
says. The last column names the functions that a row validates: in the same test each of them in
turn gives 1.5 times its result, and the row must then fail. Inputs and full sources stand in
`tests/published/data/published_examples.csv`.
"""

BASES = {
    "printed": (
        "Printed in a source",
        "printed",
        "The number stands in the source; what is computed here uses only inputs that stand there.",
    ),
    "trend": (
        "Printed, with coefficients chosen here",
        "printed",
        "The source prints the result but not every coefficient: that ours agree shows a trend, "
        "not a value.",
    ),
    "not met": (
        "Printed, and not met",
        "printed",
        "The source contradicts itself: from its own inputs ours differs by more than its rounding "
        "(see errata and claims in [theory](theory.md)).",
    ),
    "second": (
        "Second evaluations, not published",
        "second evaluation",
        "No source prints these numbers: another program's output, or a published formula "
        "evaluated apart from the code. They show that the code does what the formula says.",
    ),
}
"""Heading of each kind of row, name of its column, and what it is worth."""


def page(found: list[tuple[Any, ...]], table: Path) -> str:
    """The page, from what tests recorded: (row, ours, functions) of every comparison.

    `table` is the file of published numbers; a row of it that no test compares ends the build.
    """
    with table.open(encoding="utf-8", newline="") as file:
        wanted = list(csv.DictReader(file))
    compared = [row for row, _, _ in found]
    if unused := [row for row in wanted if row not in compared]:
        raise SystemExit(f"rows that no test compares: {unused}")
    found = sorted(found, key=lambda one: wanted.index(one[0]))
    parts = [HEAD]
    for basis, (title, column, worth) in BASES.items():
        rows = [one for one in found if one[0]["basis"] == basis]
        parts.append(f"\n## {title}\n\n{textwrap.fill(worth, 100)}\n")
        for group in dict.fromkeys(row["group"] for row in wanted if row["basis"] == basis):
            parts += _table([one for one in rows if one[0]["group"] == group], column)
    return "".join(parts)


def _dotted(text: str) -> str:
    """Newton metres as the other pages write them."""
    return re.sub(r"N m\b", "N·m", text)


def _table(found: list[tuple[Any, ...]], column: str) -> Iterator[str]:
    """The rows of a group, in the order of the file."""
    yield f"\n### {found[0][0]['group'].capitalize()}\n\n"
    yield f"| case | quantity | {column} | ours | difference | tolerance | validates |\n"
    yield "|---|---|---|---|---|---|---|\n"
    for row, ours, exercised in found:
        tolerance = float(row["tol"])
        case = _dotted(row["case"])
        unit = "" if row["unit"] == "-" else f" {_dotted(row['unit'])}"
        digits = 1 - math.floor(math.log10(tolerance))
        shown = f"{ours:.{max(digits, len(row['evaluated'].partition('.')[2]))}f}"
        # What rounding leaves of an exact agreement differs from machine to machine.
        off = ours - float(row["value"])
        difference = "0" if abs(off) < 1e-3 * tolerance else f"{float(f'{off:.2g}'):+g}"
        names = ", ".join(f"`{'.'.join(name.split('.')[-2:])}`" for name in exercised)
        yield (
            f"| {case} | {row['quantity']} | {row['value']}{unit} "
            f"| {shown.rstrip('0').rstrip('.') if '.' in shown else shown} | {difference} "
            f"| ±{tolerance:g} | {names} |\n"
        )
    for key, word in (("source", "Source"), ("note", "Note")):
        for told in dict.fromkeys(row[key] for row, _, _ in found if row[key]):
            yield "\n" + textwrap.fill(f"{word}: {told.removesuffix('.')}.", 100) + "\n"
