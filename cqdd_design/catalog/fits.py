"""ISO 286 tolerance grades and zones."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import optional_number, read_rows
from cqdd_design.errors import CatalogError, did_you_mean


@dataclass(frozen=True)
class FitLimits:
    """Deviations of a tolerance zone at one nominal size.

    Attributes
    ----------
    zone : str
        Such as ``H7`` (hole) or ``f9`` (shaft).
    over, up_to : float
        Range of nominal sizes, m.
    lower, upper : float
        Deviations from nominal, m.
    source : str
        Where the row comes from.
    """

    zone: str
    over: float
    up_to: float
    lower: float
    upper: float
    source: str


@functools.lru_cache(maxsize=1)
def _grades() -> dict[str, tuple[tuple[float, float], ...]]:
    """Largest size (m) and width (m) of every row of the standard tolerances, by grade."""
    table: dict[str, tuple[tuple[float, float], ...]] = {}
    for row in read_rows("iso286.csv"):
        if row["row"] == "grade":
            one = float(row["up_to_mm"]) * 1e-3, float(row["width_um"]) * 1e-6
            table[row["code"]] = (*table.get(row["code"], ()), one)
    return table


# Standard tolerances in units of i (ISO 286-1, table 1).
_GRADE_UNITS = {"IT5": 7.0, "IT6": 10.0, "IT7": 16.0, "IT8": 25.0, "IT9": 40.0, "IT10": 64.0}


def standard_tolerance(grade: int, size: float) -> float:
    """Width of a tolerance grade at a nominal size (m), m.

    Beyond the table, and from IT5 to IT10, by its formula i = 0.45 D^(1/3) + 0.001 D (um, mm) at
    the size itself; it holds to 500 mm.

    Raises
    ------
    CatalogError
        When the grade has neither.

    Examples
    --------
    >>> round(standard_tolerance(5, 10e-3) * 1e6), round(standard_tolerance(7, 0.45) * 1e6)
    (6, 62)
    """
    name, mm = f"IT{grade}", size * 1e3
    table = _grades().get(name, ())
    found = next((width for most, width in table if size <= most + 1e-12), None)
    if found is not None:
        return found
    if name not in _GRADE_UNITS:
        known = ", ".join(_grades())
        raise CatalogError(f"no standard tolerance {name} for {mm:g} mm; there are {known}.")
    unit = 0.45 * math.cbrt(mm) + 0.001 * mm
    return round(_GRADE_UNITS[name] * unit) * 1e-6


@functools.lru_cache(maxsize=1)
def fit_zones() -> dict[str, tuple[FitLimits, ...]]:
    """All tolerance zones, each with its rows by size."""
    table: dict[str, tuple[FitLimits, ...]] = {}
    for row in read_rows("iso286.csv"):
        lower = optional_number(row, "lower_um", 1e-6)
        upper = optional_number(row, "upper_um", 1e-6)
        if row["row"] != "limits" or lower is None or upper is None:
            continue
        limits = FitLimits(
            row["code"],
            float(row["over_mm"]) * 1e-3,
            float(row["up_to_mm"]) * 1e-3,
            lower,
            upper,
            row["source"],
        )
        table[limits.zone] = (*table.get(limits.zone, ()), limits)
    return table


def fit_limits(zone: str, diameter: float) -> FitLimits:
    """The limits of a zone such as ``H7`` at a nominal diameter (m).

    Raises
    ------
    CatalogError
        When the zone is unknown, or the size outside its table.

    Examples
    --------
    >>> round(fit_limits("f9", 0.004).lower * 1e6)
    -40
    """
    table = fit_zones()
    if zone not in table:
        raise CatalogError(f"no ISO 286 zone '{zone}'{did_you_mean(zone, table) or '.'}")
    for limits in table[zone]:
        if limits.over < diameter <= limits.up_to + 1e-12:
            return limits
    most = table[zone][-1].up_to * 1e3
    raise CatalogError(
        f"zone {zone} is tabulated for diameters up to {most:g} mm, not {diameter * 1e3:g} mm."
    )


def general_tolerance(length: float) -> float:
    """To either side of a length without a tolerance of its own, m: class m of ISO 2768-1.

    Examples
    --------
    >>> [round(1e3 * general_tolerance(one), 1) for one in (2e-3, 8e-3, 40e-3, 0.2)]
    [0.1, 0.2, 0.3, 0.5]
    """
    return next(width for up_to, width in _GENERAL if abs(length) <= up_to + 1e-12)


_GENERAL = (
    (6e-3, 0.1e-3),
    (30e-3, 0.2e-3),
    (120e-3, 0.3e-3),
    (0.4, 0.5e-3),
    (float("inf"), 0.8e-3),
)
"""Lengths up to which a general tolerance holds, both in m."""
