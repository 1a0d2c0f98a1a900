"""A user's own measurements: a CSV of bench rows with their units."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from cqdd_design.actuator.bench.metric import METRICS, refuse_unmeasured
from cqdd_design.errors import CqddError, DesignError, UsageError, shown
from cqdd_design.files import read_text_file
from cqdd_design.units import (
    ANGLE,
    FREQUENCY,
    INERTIA,
    MASS,
    POWER,
    SMALL_ANGLE,
    SPEED,
    TORQUE,
    TORQUE_DENSITY,
    Dimension,
    parse_quantity,
    read_quantity,
    real_number,
)

_MOST_BYTES = 1_000_000
COLUMNS = ("name", "value", "unit")
DIMENSIONS: Mapping[str, Dimension] = MappingProxyType(
    {
        dimension.unit: dimension
        for dimension in (
            TORQUE,
            SPEED,
            POWER,
            ANGLE,
            TORQUE_DENSITY,
            INERTIA,
            MASS,
            SMALL_ANGLE,
            FREQUENCY,
        )
    }
)
"""Of the units of `METRICS`; efficiency has none."""
_EXAMPLE = "name,value,unit\nbackdrive_static,1.99,N*m"


def read_measured(path: Path) -> dict[str, float]:
    """Measured rows of a CSV with the columns ``name,value,unit``, in the units of the bench.

    Parameters
    ----------
    path : Path
        Names are those of `METRICS`; lines that begin with # and further columns are passed over.

    Raises
    ------
    UsageError
        For a file that cannot be read, other columns, a gap, a value that is not a finite number
        above zero, an unknown or repeated name, or a unit of something else, with the line; and
        for rows that no machine can have, alone or together.
    """
    lines = read_text_file(path, _MOST_BYTES).splitlines()
    numbered = [
        (number, line)
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not numbered:
        raise UsageError(f"{path} is empty; it needs lines such as\n{_EXAMPLE}")
    head = [cell.strip() for cell in next(csv.reader([numbered[0][1]]))]
    missing = [name for name in COLUMNS if name not in head]
    if missing:
        raise UsageError(
            f"{path} has no column {', '.join(missing)} (it has {', '.join(head)}); it needs "
            f"lines such as\n{_EXAMPLE}"
        )
    found: dict[str, float] = {}
    for number, line in numbered[1:]:
        cells = [cell.strip() for cell in next(csv.reader([line]))]
        if len(cells) != len(head):
            raise UsageError(
                f"{path}, line {number}: {len(cells)} cells where the head has {len(head)}."
            )
        row = dict(zip(head, cells, strict=True))
        name = row["name"]
        if name in found:
            raise UsageError(f"{path}, line {number}: {name} stands there twice; keep one.")
        found[name] = _value(row, f"{path}, line {number}")
    if not found:
        raise UsageError(f"{path} has a head and no rows; it needs lines such as\n{_EXAMPLE}")
    _refuse_impossible(found, path)
    return found


def in_bench_units(name: str, value: object) -> float:
    """A measured value in the unit of the bench: a number in that unit, or a quantity.

    Raises
    ------
    UsageError
        For a name that is no measurement, or a value that is neither, with the unit.
    """
    refuse_unmeasured(name)
    number = real_number(value)
    if number is not None:
        return number
    unit = METRICS[name]
    if not unit:
        raise UsageError(f"{name} = {shown(value)} is not a number, such as 0.8: a share.")
    dimension = DIMENSIONS[unit]
    try:
        return read_quantity(value, dimension) / dimension.si_factor
    except DesignError as error:
        raise UsageError(f"{name}: {error.message.rstrip('.')}; or a number in {unit}.") from None


_ORDERED = (
    ("continuous_torque", "peak_torque", "what is held for ever can be given for a moment"),
    ("continuous_torque", "stall_torque", "what is held for ever can be given for a moment"),
    ("torque_ripple", "peak_torque", "ripple is a part of the torque"),
)
"""Rows of which the first is never more than the second, and why."""
_DENSITY_WITHIN = 0.05
"""Of peak torque over mass, by which a measured torque density may be off: both are rounded."""


def _refuse_impossible(found: Mapping[str, float], path: Path) -> None:
    """Raise for measured rows that contradict a law or each other."""
    share = found.get("efficiency_peak", 0.0)
    if share > 1.0:
        raise UsageError(
            f"{path}: an efficiency_peak of {100.0 * share:.4g} % gives more power than it takes; "
            "a share lies from 0 to 1, a percentage needs the unit %."
        )
    for less, more, why in _ORDERED:
        if less in found and more in found and found[less] > found[more]:
            raise UsageError(
                f"{path}: {less} of {found[less]:g} {METRICS[less]} is more than {more} of "
                f"{found[more]:g}, and {why}; one of the two rows is not what its name says."
            )
    if {"torque_density", "peak_torque", "mass"} <= set(found):
        told, follows = found["torque_density"], found["peak_torque"] / found["mass"]
        if abs(told / follows - 1.0) > _DENSITY_WITHIN:
            raise UsageError(
                f"{path}: torque_density of {told:g} N*m/kg is not peak_torque over mass, "
                f"{found['peak_torque']:g} N*m/{found['mass']:g} kg = {follows:.4g}; leave it out, "
                "or correct the row that is wrong."
            )


def _value(row: dict[str, str], place: str) -> float:
    """The value of one row in the unit of the bench."""
    name, text, unit = row["name"], row["value"], row["unit"]
    refuse_unmeasured(name, f"{place}: ")
    wanted = METRICS[name]
    if not text:
        raise UsageError(f"{place}: {name} has no value; leave the line out, or fill it in.")
    try:
        value = float(text)
    except ValueError:
        raise UsageError(
            f"{place}: the value '{text}' of {name} is not a number; the unit has its own column."
        ) from None
    if not (math.isfinite(value) and value > 0.0):
        raise UsageError(f"{place}: {name} {text} must be a finite number above 0.")
    if not wanted:
        if unit not in ("", "%"):
            raise UsageError(f"{place}: {name} is a share; its unit is empty or %, not '{unit}'.")
        return value / 100.0 if unit else value
    if not unit:
        raise UsageError(f"{place}: {name} has no unit; write it in {wanted}.")
    dimension = DIMENSIONS[wanted]
    try:
        return parse_quantity(f"{text} {unit}", dimension) / dimension.si_factor
    except CqddError as error:
        raise UsageError(f"{place}: {name}: {error.message.rstrip('.')}.") from error
