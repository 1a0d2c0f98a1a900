"""The table of published numbers, and how a result is held to one of its rows.

`basis` says what a row is worth: `printed` in a source; `trend`, printed, but with coefficients
that a test chose; `not met`, printed, and contradicted by what else the source prints (`evaluated`
is then what a second evaluation gives); `second`, a second evaluation that no source prints.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

TABLE = Path(__file__).parents[1] / "published" / "data" / "published_examples.csv"
BASES = ("printed", "trend", "not met", "second")

Row = dict[str, str]


def published_rows(group: str, quantity: str = "") -> list[Row]:
    """Rows of a group, those whose quantity begins with some words; at least one."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    found = [row for row in table if row["group"] == group]
    found = [row for row in found if row["quantity"].startswith(quantity)]
    assert found, f"no row of {group}: {quantity}"
    return found


def inputs(row: Row) -> dict[str, float]:
    """`"zs=15;Mh=1550 Nmm"` as a mapping: the number after every name."""
    return {name: float(value) for name, value in re.findall(r"(\w+)=(-?[\d.]+)", row["inputs"])}


def label(row: Row) -> str:
    """Name of a row among a test's cases."""
    return f"{row['case']}-{row['quantity']}"


def holds(row: Row, found: float) -> bool:
    """Whether a result is within the row's tolerance; a row not met is off by more, as evaluated.

    >>> row = {"basis": "not met", "value": "10", "tol": "0.5", "evaluated": "10.545"}
    >>> holds(row, 10.5454), holds(row, 10.0), holds(row, 15.0)
    (True, False, False)
    """
    off = abs(found - float(row["value"]))
    if row["basis"] != "not met":
        return off <= float(row["tol"])
    last = len(row["evaluated"].partition(".")[2])
    return off > float(row["tol"]) and abs(found - float(row["evaluated"])) <= 0.5 * 10.0**-last
