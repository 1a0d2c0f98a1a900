"""Reading of the catalogue files, shared by the typed readers."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from importlib import resources
from typing import TypeVar

from cqdd_design.errors import CatalogError, nearest_names

Row = TypeVar("Row")


def read_rows(file_name: str, room: str = "cqdd_design.catalog") -> list[dict[str, str]]:
    """All rows of a data file of a room as dictionaries of stripped strings."""
    source = resources.files(room) / "data" / file_name
    lines = source.read_text(encoding="utf-8").splitlines()
    return [
        {key: (value or "").strip() for key, value in row.items() if key is not None}
        for row in csv.DictReader(lines)
    ]


def number(row: Mapping[str, str], key: str, factor: float = 1.0) -> float:
    """A required number, times the factor to SI."""
    return float(row[key]) * factor


def optional_number(row: Mapping[str, str], key: str, factor: float = 1.0) -> float | None:
    """A number that a row may leave empty."""
    text = row.get(key, "")
    return float(text) * factor if text else None


def find(name: str, table: Mapping[str, Row], kind: str) -> Row:
    """The row called `name`, ignoring case and runs of blanks.

    Raises
    ------
    CatalogError
        With the nearest names, when there is no such row.
    """
    if name in table:
        return table[name]
    wanted = " ".join(name.lower().split())
    for key, row in table.items():
        if " ".join(key.lower().split()) == wanted:
            return row
    near = nearest_names(name, table)
    hint = "; the nearest are " + ", ".join(f"'{n}'" for n in near) if near else ""
    raise CatalogError(
        f"the catalogue has no {kind} '{name}'{hint}; `cqdd-design catalog` lists all {len(table)}."
    )
