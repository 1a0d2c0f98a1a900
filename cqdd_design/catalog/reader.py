"""Reading of the catalogue files, shared by the typed readers."""

from __future__ import annotations

import csv
import dataclasses
from collections.abc import Mapping
from importlib import resources
from typing import Any, TypeVar

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


def column(name: str, factor: float = 1.0) -> Any:
    """A field of a record that is read from one column, times the factor to SI."""
    return dataclasses.field(metadata={"column": name, "factor": factor})


def read_records(file_name: str, record: type[Row]) -> list[Row]:
    """All rows of a data file as records, whose fields are made by :func:`column`.

    What the row leaves empty is None where the field's type has None, and "" in a text; fields
    without a column keep their defaults.
    """
    every = dataclasses.fields(record)  # type: ignore[arg-type]
    fields = [field for field in every if "column" in field.metadata]
    return [
        record(**{field.name: _value(row[field.metadata["column"]], field) for field in fields})
        for row in read_rows(file_name)
    ]


def _value(text: str, field: dataclasses.Field[Any]) -> object:
    kind = str(field.type)
    if not kind.startswith(("float", "int")):
        return text
    if not text and kind.endswith("None"):
        return None
    value = float(text) * field.metadata["factor"]
    return round(value) if kind.startswith("int") else value


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
