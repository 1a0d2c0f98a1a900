"""Rolling bearings: deep-groove balls, crossed rollers, needles."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Literal

from cqdd_design.catalog.needles import NeedleSet, needle_set
from cqdd_design.catalog.reader import column, find, read_records

BearingKind = Literal["ball", "crossed roller", "needle", "needle cage"]

AUTO = "auto"
"""Designation of a bearing that is left to the catalogue."""

FRICTION_COEFFICIENT: dict[BearingKind, float] = {
    "ball": 0.0015,
    "needle": 0.0025,
    "needle cage": 0.0025,
    "crossed roller": 0.0025,
}
"""mu on the bore. JTEKT (Koyo), Ball & Roller Bearings, friction coefficients: deep groove ball
0.0010 to 0.0015 (the upper end; SKF prints 0.0015), needle roller with cage 0.0020 to 0.0030 (the
middle). Crossed rollers are not in the table: the upper end of tapered rollers, which slide on
their ends too."""

BEARING_MATERIAL = "AISI 52100 / 100Cr6 hardened"
"""Rings and rolling elements."""
SHAFT_MATERIAL = "AISI 4140 Q&T 540C"
RACEWAY_MATERIAL = "SCM415/16MnCr5 case hardened"
"""Shaft whose lobes are raceways of a needle cage: they must be hard."""


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
    raceway_diameter : float or None
        Of a drawn cup sold with an inner ring, outside diameter of that ring, m; None where
        needles run on the shaft, and of other kinds.
    source : str
        Where the row comes from; computed ratings say so.
    chamfer : float or None
        Least chamfer of its rings, r_s min, m; None where the source does not give it. Of 6700 to
        6710 by diameter series 7 of ISO 15, and of the inner ring of an HK1522: handbook values
        not re-read.
    """

    designation: str = column("designation")
    kind: BearingKind = column("kind")  # noqa: RUF009 (a field, as the others)
    bore_diameter: float = column("d_mm", 1e-3)
    outer_diameter: float = column("D_mm", 1e-3)
    width: float = column("B_mm", 1e-3)
    dynamic_rating: float | None = column("C_kN", 1e3)
    static_rating: float | None = column("C0_kN", 1e3)
    mass: float | None = column("mass_kg")
    source: str = column("source")
    raceway_diameter: float | None = column("raceway_mm", 1e-3)
    chamfer: float | None = column("r_min_mm", 1e-3)

    @property
    def largest_fillet(self) -> float:
        """Of a corner into which a ring goes, m: the least chamfer that the ring may have."""
        return self.chamfer or least_chamfer(self.bore_diameter)

    @property
    def largest_chamfer(self) -> float:
        """Beyond which a shoulder has to reach to meet the face of a ring, m."""
        unknown = _CROSSED if self.kind == "crossed roller" else least_chamfer(self.bore_diameter)
        return largest_chamfer(self.chamfer or unknown, self.bore_diameter)

    @property
    def needles(self) -> NeedleSet:
        """The needles of a drawn cup or a cage, on the inner ring where there is one."""
        return needle_set(
            self.raceway_diameter or self.bore_diameter,
            self.outer_diameter,
            self.width,
            drawn_cup=self.kind == "needle",
        )


def shaft_material(cam: Bearing) -> str:
    """Catalogue name of what shaft and loose cams are made of, for a cam bearing on them."""
    return RACEWAY_MATERIAL if cam.kind == "needle cage" else SHAFT_MATERIAL


@functools.lru_cache(maxsize=1)
def bearings() -> dict[str, Bearing]:
    """All bearings by designation, in file order."""
    return {one.designation: one for one in read_records("bearings.csv", Bearing)}


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


_CHAMFERS = ((8e-3, 0.15e-3), (10e-3, 0.2e-3))
_CHAMFER = 0.3e-3


_CROSSED = 1e-3
"""Least chamfer of crossed rollers whose source gives none, at most: of the widest section, m."""


def least_chamfer(bore: float) -> float:
    """Least chamfer of ball bearings of a bore, m: of diameter series 8 (ISO 15).

    For bearings whose own is not known.

    Examples
    --------
    >>> [round(1e3 * least_chamfer(bore), 2) for bore in (6e-3, 8e-3, 15e-3)]
    [0.15, 0.2, 0.3]
    """
    return next((chamfer for below, chamfer in _CHAMFERS if bore < below - 1e-9), _CHAMFER)


_LARGEST = (
    (0.05, ((math.inf, 0.1),)), (0.08, ((math.inf, 0.16),)), (0.1, ((math.inf, 0.2),)),
    (0.15, ((math.inf, 0.3),)), (0.2, ((math.inf, 0.5),)), (0.3, ((40, 0.6), (math.inf, 0.8))),
    (0.6, ((40, 1.0), (math.inf, 1.3))), (1.0, ((50, 1.5), (math.inf, 1.9))),
    (1.1, ((120, 2.0), (math.inf, 2.5))), (1.5, ((120, 2.3), (math.inf, 3.0))),
    (2.0, ((80, 3.0), (220, 3.5), (math.inf, 3.8))), (2.1, ((280, 4.0), (math.inf, 4.5))),
    (3.0, ((280, 5.0), (math.inf, 5.5))), (4.0, ((math.inf, 6.5),)), (5.0, ((math.inf, 8.0),)),
)  # fmt: skip
"""Least chamfer, and for bores up to so much the largest in the radial direction; all in mm."""


def largest_chamfer(least: float, bore: float) -> float:
    """Largest chamfer, along the radius, of a radial bearing whose least chamfer is given, m.

    ISO 582:1995, table 1, as the ISB catalogue prints it.

    Examples
    --------
    >>> [round(1e3 * largest_chamfer(one, 30e-3), 2) for one in (0.1e-3, 0.3e-3, 0.6e-3)]
    [0.2, 0.6, 1.0]
    """
    limits = next(row for upper, row in _LARGEST if 1e3 * least <= upper + 1e-9)
    return 1e-3 * next(most for up_to, most in limits if 1e3 * bore <= up_to + 1e-9)


def width_tolerance(bore: float) -> float:
    """By how much a ring may be narrower than nominal, m; it is never wider.

    ISO 492:2014, table 2: deviation of a single inner ring width, class Normal; the outer ring's is
    the same. Crossed-roller bearings are held to less.

    Examples
    --------
    >>> [round(1e6 * width_tolerance(one)) for one in (10e-3, 60e-3, 0.1)]
    [120, 150, 200]
    """
    return next(most for up_to, most in _WIDTHS if bore <= up_to + 1e-12)


_WIDTHS = (
    (2.5e-3, 40e-6), (50e-3, 120e-6), (80e-3, 150e-6), (120e-3, 200e-6), (180e-3, 250e-6),
    (250e-3, 300e-6), (315e-3, 350e-6), (400e-3, 400e-6), (500e-3, 450e-6), (math.inf, 500e-6),
)  # fmt: skip
"""Bores up to which a width tolerance holds, both in m."""
