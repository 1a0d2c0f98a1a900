"""Rolling bearings: deep-groove balls, crossed rollers, needles."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Literal

from cqdd_design.catalog.reader import find, number, optional_number, read_rows

BearingKind = Literal["ball", "crossed roller", "needle", "needle cage"]


@dataclass(frozen=True)
class Bearing:
    """A rolling bearing.

    Attributes
    ----------
    designation : str
        Maker's or ISO designation.
    kind : {"ball", "crossed roller", "needle", "needle cage"}
        Decides the life exponent (3 for balls, 10/3 for rollers). A needle cage has no rings: it
        runs on hardened shaft and bore.
    bore_diameter, outer_diameter, width : float
        m.
    dynamic_rating, static_rating : float or None
        Radial basic ratings C and C0, N; None where the source gives only dimensions.
    mass : float or None
        kg.
    source : str
        Where the row comes from; computed ratings say so.
    """

    designation: str
    kind: BearingKind
    bore_diameter: float
    outer_diameter: float
    width: float
    dynamic_rating: float | None
    static_rating: float | None
    mass: float | None
    source: str


def _kind(designation: str) -> BearingKind:
    if designation.startswith("THK R"):
        return "crossed roller"
    if designation.startswith("needle cage"):
        return "needle cage"
    return "needle" if designation.startswith("needle") else "ball"


@functools.lru_cache(maxsize=1)
def bearings() -> dict[str, Bearing]:
    """All bearings by designation, in file order."""
    table = {}
    for row in read_rows("bearings.csv"):
        table[row["designation"]] = Bearing(
            designation=row["designation"],
            kind=_kind(row["designation"]),
            bore_diameter=number(row, "d_mm", 1e-3),
            outer_diameter=number(row, "D_mm", 1e-3),
            width=number(row, "B_mm", 1e-3),
            dynamic_rating=optional_number(row, "C_kN", 1e3),
            static_rating=optional_number(row, "C0_kN", 1e3),
            mass=optional_number(row, "mass_kg"),
            source=row["source"],
        )
    return table


def find_bearing(designation: str) -> Bearing:
    """The bearing called `designation`.

    Raises
    ------
    CatalogError
        With the nearest designations, when there is none.

    Examples
    --------
    >>> find_bearing("6902").static_rating
    2250.0
    """
    return find(designation, bearings(), "bearing")
