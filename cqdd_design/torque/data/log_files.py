"""Log files as columns of numbers: CSV, TSV and Parquet, and the map that names the columns."""

from __future__ import annotations

import csv
import io
import math
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from cqdd_design.errors import DesignError, UsageError, did_you_mean
from cqdd_design.files import parse_toml, read_regular_file, read_text_file
from cqdd_design.torque.data.episodes import FloatArray, read_parquet
from cqdd_design.units import ANGLE, CURRENT, LOAD_SPEED, TIME, TORQUE, Dimension, parse_quantity

QUANTITIES: Mapping[str, Dimension | None] = {
    "time": TIME,
    "position": ANGLE,
    "target": ANGLE,
    "velocity": LOAD_SPEED,
    "torque": TORQUE,
    "current": CURRENT,
    "wall": None,
    "saturated": None,
}
"""What a log's columns may hold; flags have no unit."""
NEEDED = ("position", "target", "velocity")
_DELIMITERS = ",;\t"
_MOST_BYTES, _MOST_OF_MAP = 256_000_000, 1_000_000
_PARTS = ("columns", "units", "constants", "group", "groups", "facts")


@dataclass(frozen=True)
class LogMap:
    """How to read logs.

    Attributes
    ----------
    columns : mapping of str to str
        Quantity (`QUANTITIES`) to the log's column.
    units : mapping of str to str
        Quantity to unit; SI (s, rad, rad/s, N*m, A) where left out.
    current_to_torque : float or None
        Joint torque over current, N m/A, signed, where there is no torque column.
    group : mapping
        Of every episode, such as mass and wall.
    groups : mapping of str to mapping
        Name of a log without its ending to what else belongs to its group.
    facts : mapping
        For the manifest; ``held_mass_kg`` and ``training_gearbox`` are what splits hold back.
    """

    columns: Mapping[str, str]
    units: Mapping[str, str] = field(default_factory=dict)
    current_to_torque: float | None = None
    group: Mapping[str, float | str] = field(default_factory=dict)
    groups: Mapping[str, Mapping[str, float | str]] = field(default_factory=dict)
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a map that cannot be followed."""
        for table in (self.columns, self.units):
            for name in table:
                if name not in QUANTITIES:
                    raise UsageError(
                        f"'{name}' is no quantity of a log{did_you_mean(name, QUANTITIES) or '.'} "
                        f"There are {', '.join(QUANTITIES)}."
                    )
        missing = [name for name in NEEDED if name not in self.columns]
        if "torque" not in self.columns and "current" not in self.columns:
            missing.append("torque (or current)")
        if missing:
            raise UsageError(
                f"the map names no column for {', '.join(missing)}; give --columns "
                '"position=q,target=q_des,velocity=dq,torque=tau" with the log\'s own names.'
            )
        if "torque" not in self.columns and self.current_to_torque is None:
            raise UsageError(
                "a log with current and without torque needs --current-to-torque, the joint's "
                "torque over the current in N*m/A (ratio times torque constant, signed)."
            )
        constant = self.current_to_torque
        if constant is not None and not (math.isfinite(constant) and constant != 0.0):
            raise UsageError(f"a torque over current of {constant:g} N*m/A must not be 0.")
        for name in self.units:
            if QUANTITIES[name] is None:
                raise UsageError(f"'{name}' is a flag, 0 or 1, without a unit.")
            if name not in self.columns:
                raise UsageError(f"a unit is given for '{name}', but no column; name its column.")

    def factor(self, quantity: str) -> float:
        """SI value of one unit of a quantity."""
        dimension = QUANTITIES[quantity]
        if dimension is None or quantity not in self.units:
            return 1.0
        try:
            return parse_quantity(f"1 {self.units[quantity]}", dimension)
        except DesignError as error:
            raise UsageError(f"the unit of {quantity}: {error.message.rstrip('.')}.") from None


def read_map(path: Path, over: Mapping[str, Mapping[str, Any]] | None = None) -> LogMap:
    """Read a map file: TOML with tables columns, units, constants, group, groups, facts.

    Parameters
    ----------
    over : mapping of tables, optional
        Entries that go before those of the file.

    Raises
    ------
    UsageError
        When it cannot be read, or holds anything else.
    """
    content = parse_toml(read_text_file(path, _MOST_OF_MAP), path)
    for name, table in content.items():
        if name not in _PARTS:
            raise UsageError(f"{path}: '{name}' is no table{did_you_mean(name, _PARTS) or '.'}")
        if not isinstance(table, dict):
            raise UsageError(f"{path}: {name} must be a table, [{name}].")
    for name, table in (over or {}).items():
        content[name] = {**content.get(name, {}), **table}
    constants = dict(content.get("constants", {}))
    constant = constants.pop("current_to_torque", None)
    if constants:
        raise UsageError(
            f"{path}: there is one constant, current_to_torque, no {', '.join(constants)}."
        )
    if constant is not None and (
        isinstance(constant, bool) or not isinstance(constant, int | float)
    ):
        raise UsageError(f"{path}: current_to_torque must be a number in N*m/A.")
    for table in ("columns", "units"):
        for name, value in content.get(table, {}).items():
            if not isinstance(value, str):
                raise UsageError(f'{path}: {table}.{name} must be text, such as "q".')
    groups = content.get("groups", {})
    for name, entry in [("group", content.get("group", {})), *groups.items()]:
        if not isinstance(entry, dict):
            raise UsageError(f'{path}: groups.{name} must be a table, [groups."{name}"].')
        for key, value in entry.items():
            if isinstance(value, bool) or not isinstance(value, int | float | str):
                raise UsageError(f"{path}: {name}.{key} must be a number or text.")
    return LogMap(
        columns=content.get("columns", {}),
        units=content.get("units", {}),
        current_to_torque=None if constant is None else float(constant),
        group=content.get("group", {}),
        groups=groups,
        facts=content.get("facts", {}),
    )


def read_columns(path: Path, wanted: Sequence[str]) -> dict[str, FloatArray]:
    """Columns of a log as they stand, each finite.

    Parameters
    ----------
    path : Path
        ``.csv``, ``.tsv``, ``.txt`` (the header tells the separator) or ``.parquet``.
    wanted : sequence of str
        The log's names.

    Raises
    ------
    UsageError
        When the file or a column is missing, a value is no number, naming its line, or it is of
        a kind that is not read; pickles never are.
    """
    kind = path.suffix.lower()
    if kind in (".pkl", ".pickle", ".pt", ".npy"):
        raise UsageError(
            f"{path} may hold code, which reading it would run, so it is not read; save the log as "
            "CSV or Parquet."
        )
    if kind not in (".csv", ".tsv", ".txt", ".parquet"):
        raise UsageError(f"{path} is no log that can be read; there are .csv, .tsv and .parquet.")
    if kind == ".parquet":
        found = read_parquet(path, lambda names: _present(path, wanted, names))
    else:
        found = _text(path, wanted)
    lengths = {len(values) for values in found.values()}
    if lengths == {0}:
        raise UsageError(f"{path} has no samples.")
    for name, values in found.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            place = int(bad[0])
            where = f"row {place}" if kind == ".parquet" else f"line {place + 2}"
            raise UsageError(
                f"{path}, {where}: {name} is {values[place]:g}; remove the lines that are not "
                "finite, the gap splits the record there."
            )
    return found


def _present(path: Path, wanted: Sequence[str], there: Sequence[str]) -> Sequence[str]:
    """The columns wanted, each there once."""
    for name in wanted:
        if name not in there:
            raise UsageError(
                f"{path} has no column '{name}'{did_you_mean(name, there) or '.'} "
                f"It has {', '.join(there)}."
            )
        if list(there).count(name) > 1:
            raise UsageError(f"{path} has two columns '{name}'; rename one.")
    return wanted


def _text(path: Path, wanted: Sequence[str]) -> dict[str, FloatArray]:
    content = read_regular_file(path, _MOST_BYTES)
    try:
        with io.TextIOWrapper(io.BytesIO(content), encoding="utf-8-sig", newline="") as stream:
            first = stream.readline()
            delimiter = max(_DELIMITERS, key=first.count)
            stream.seek(0)
            return _columns(path, csv.reader(stream, delimiter=delimiter), wanted)
    except (UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"cannot read {path}: it is not text in UTF-8 with columns.") from error


def _columns(path: Path, rows: Iterator[list[str]], wanted: Sequence[str]) -> dict[str, FloatArray]:
    """The wanted columns of rows, the first of which names them."""
    head = [name.strip() for name in next(rows, [])]
    if not head:
        raise UsageError(f"{path} is empty.")
    places = [head.index(name) for name in _present(path, wanted, head)]
    values = [array("d") for _ in wanted]
    blank = 0
    for line, row in enumerate(rows, start=2):
        if not row:
            blank = blank or line  # blank lines at the end are nothing
            continue
        for place, column in zip(places, values, strict=True):
            text = row[place].strip() if place < len(row) and not blank else ""
            try:
                column.append(float(text))
            except ValueError:
                told = f"'{text[:40]}' is no number" if text else "is missing"
                raise UsageError(
                    f"{path}, line {blank or line}: {head[place]} {told}; complete the line, or "
                    "remove it."
                ) from None
    return {name: np.array(column, np.float64) for name, column in zip(wanted, values, strict=True)}
