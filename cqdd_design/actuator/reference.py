"""A command over time from a CSV file."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cqdd_design.actuator.parameters import FloatArray
from cqdd_design.actuator.recording import STEPS_PER_PERIOD, unit_of
from cqdd_design.actuator.scenario import Sampled
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.files import read_text_file
from cqdd_design.units import TIME, Dimension, parse_quantity

_MOST_BYTES = 64_000_000
_UNIFORM, _GAP = 0.9, 5.0
"""Share of equal intervals from which a reference counts as evenly sampled; a gap, over those."""


def read_reference(path: Path, dimension: Dimension) -> Sampled:
    """Read a signal from a CSV file with the columns ``time [s]`` and one of `dimension`.

    Units are in the header; they may be any of time and of the dimension. Lines that begin with
    ``#`` and empty lines are left out.

    Raises
    ------
    UsageError
        When the file is no such table: wrong columns or units, a cell missing or not finite, a
        time that does not rise, a gap in even sampling, fewer than two rows.
    """
    lines = _reference_lines(path)
    wanted = f"time [s],{dimension.name} [{dimension.unit}]"
    if not lines:
        raise UsageError(f"{path} is empty; a reference begins with the line {wanted}")
    number, header = lines[0]
    if len(header) != 2 or not header[0].strip().lower().startswith("time"):
        raise UsageError(
            f"{path} line {number} has the columns {', '.join(header)!r}; a reference has two, "
            f"such as {wanted}"
        )
    factors = [
        _header_factor(path, cell, kind, wanted)
        for cell, kind in zip(header, (TIME, dimension), strict=True)
    ]
    numbers = [number for number, _ in lines[1:]]
    rows = [_numbers(path, number, cells, header) for number, cells in lines[1:]]
    if len(rows) < 2:
        raise UsageError(
            f"{path} has {len(rows)} rows; a reference needs two or more. For one value use "
            "--signal constant with --amplitude."
        )
    times, samples = (np.array(rows) * factors).T
    for k in np.flatnonzero(np.diff(times) <= 0.0):
        raise UsageError(
            f"{path} line {numbers[k + 1]}: the time {rows[k + 1][0]:g} does not rise above "
            f"{rows[k][0]:g} in the line before; sort the rows and keep one for each time."
        )
    _refuse_gap(path, times, numbers)
    return Sampled(times, samples)


def _reference_lines(path: Path) -> list[tuple[int, list[str]]]:
    """Numbered lines that say something, as cells."""
    text = read_text_file(path, _MOST_BYTES)
    try:
        table = list(csv.reader(text.splitlines()))
    except csv.Error as error:
        raise UsageError(f"{path} cannot be read as CSV: {error}.") from error
    numbered = [(i + 1, cells) for i, cells in enumerate(table)]
    return [(i, c) for i, c in numbered if any(map(str.strip, c)) and not c[0].startswith("#")]


def _header_factor(path: Path, cell: str, dimension: Dimension, wanted: str) -> float:
    unit = unit_of(cell.strip())
    if not unit:
        raise UsageError(f"{path}: the column '{cell.strip()}' has no unit; write {wanted}")
    try:
        return parse_quantity(f"1 {unit}", dimension)
    except DesignError as error:
        raise UsageError(
            f"{path}: the column '{cell.strip()}' must be a {dimension.name}: "
            f"{error.message.rstrip('.')}."
        ) from None


def _numbers(path: Path, number: int, cells: list[str], header: list[str]) -> FloatArray:
    if len(cells) != len(header):
        raise UsageError(f"{path} line {number} has {len(cells)} cells instead of {len(header)}.")
    found = []
    for name, cell in zip(header, cells, strict=True):
        if not cell.strip():
            raise UsageError(
                f"{path} line {number}: a gap, '{name.strip()}' is empty; fill it or leave the "
                "line out."
            )
        try:
            value = float(cell)
        except ValueError:
            raise UsageError(
                f"{path} line {number}: '{cell.strip()[:40]}' in '{name.strip()}' is no number; "
                "write it with a decimal point and without a unit."
            ) from None
        if not math.isfinite(value):
            raise UsageError(
                f"{path} line {number}: '{name.strip()}' is {cell.strip()}; leave the line out or "
                "give a finite number."
            )
        found.append(value)
    return np.array(found)


def _refuse_gap(path: Path, times: FloatArray, numbers: Sequence[int]) -> None:
    """Refuse rows missing from an even sampling; corner points far apart are no gap."""
    between = np.diff(times)
    usual = float(np.median(between))
    even = np.mean(np.abs(between - usual) <= 0.05 * usual) >= _UNIFORM
    longest = int(np.argmax(between))
    if len(between) >= STEPS_PER_PERIOD and even and between[longest] > _GAP * usual:
        raise UsageError(
            f"{path}: a gap of {between[longest]:g} s before line {numbers[longest + 1]}, where "
            f"rows are {usual:g} s apart; fill it, also with straight lines between the two rows."
        )
