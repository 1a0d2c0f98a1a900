"""Radial internal clearance of ball bearings and crossed rollers, and what of it to order."""

from __future__ import annotations

import math
from typing import NamedTuple

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.errors import CatalogError

_GROUPS = ("CN", "C3", "C4")
_CLEARANCES = (
    (10e-3, (2, 13), (8, 23), (14, 29)),
    (18e-3, (3, 18), (11, 25), (18, 33)),
    (24e-3, (5, 20), (13, 28), (20, 36)),
    (30e-3, (5, 20), (13, 28), (23, 41)),
    (40e-3, (6, 20), (15, 33), (28, 46)),
    (50e-3, (6, 23), (18, 36), (30, 51)),
    (65e-3, (8, 28), (23, 43), (38, 61)),
    (80e-3, (10, 30), (25, 51), (46, 71)),
    (100e-3, (12, 36), (30, 58), (53, 84)),
    (120e-3, (15, 41), (36, 66), (61, 97)),
    (140e-3, (18, 48), (41, 81), (71, 114)),
    (160e-3, (18, 53), (46, 91), (81, 130)),
    (180e-3, (20, 61), (53, 102), (91, 147)),
    (200e-3, (25, 71), (63, 117), (107, 163)),
    (225e-3, (25, 85), (75, 140), (125, 195)),
    (250e-3, (25, 95), (85, 160), (145, 225)),
)
"""Bores up to which they hold, m, and CN, C3 and C4, um (ISO 5753-1:2009, table 1; handbook values,
not re-read)."""


class _Crossed(NamedTuple):
    """Of crossed rollers with pitch circles up to one, m: preload of CC0, and C0 and C1, um."""

    pitch: float
    preload: int
    sold: tuple[tuple[int, int], ...]


_CROSSED = (
    _Crossed(30e-3, 8, ((0, 15), (15, 35))),
    _Crossed(50e-3, 8, ((0, 25), (25, 50))),
    _Crossed(80e-3, 10, ((0, 30), (30, 60))),
    _Crossed(120e-3, 10, ((0, 40), (40, 70))),
    _Crossed(140e-3, 10, ((0, 40), (40, 80))),
    _Crossed(160e-3, 10, ((0, 40), (40, 90))),
)
_THIN = (_Crossed(160e-3, 8, ((0, 15),)),)
"""Of the models RB, and of the thin RA, which has no C1 (THK, General Catalog, Cross-Roller Ring:
radial clearance; handbook values, not re-read)."""
BALL_PRELOAD = 5e-6
"""That balls bear without running hard, m: our own measure, half of what crossed rollers do."""
_OUTSIDES = (
    (18e-3, 8e-6), (30e-3, 9e-6), (50e-3, 11e-6), (80e-3, 13e-6), (120e-3, 15e-6), (150e-3, 18e-6),
    (180e-3, 25e-6), (250e-3, 30e-6), (315e-3, 35e-6),
)  # fmt: skip
_BORES = (
    (18e-3, 8e-6), (30e-3, 10e-6), (50e-3, 12e-6), (80e-3, 15e-6), (120e-3, 20e-6), (180e-3, 25e-6),
    (250e-3, 30e-6),
)  # fmt: skip
"""How much smaller outside and bore of a Normal ring may be, by the diameter, m (ISO 492:2014)."""
_TAKEN = 0.8
"""Of an interference, what the raceway gives way (NSK, Rolling Bearings: 70 to 90 %)."""


class ClearanceGroup(NamedTuple):
    """A group, and what its seats leave of its clearance.

    Attributes
    ----------
    least, most : float
        Of the group before it is fitted, m.
    left, spread : float
        Mean when fitted, m, and to either side of it what limits taken as 3 sigma make likely.
    """

    name: str
    least: float
    most: float
    left: float
    spread: float


class Clearance(NamedTuple):
    """A class of radial clearance that a maker sells.

    Attributes
    ----------
    least, most : float
        Before it is fitted, m.
    """

    name: str
    least: float
    most: float


def clearances(bearing: Bearing) -> tuple[Clearance, ...]:
    """Those that a ball or crossed-roller bearing is sold with, tightest first; none where unknown.

    Without crossed rollers that are preloaded before they are fitted (CC0).

    Examples
    --------
    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> [one.name for one in clearances(find_bearing("THK RA5008"))]
    ['C0']
    >>> [one.name for one in clearances(find_bearing("THK RB5013"))]
    ['C0', 'C1']
    """
    rows: list[tuple[tuple[int, int], ...]]
    if bearing.kind == "ball":
        names: tuple[str, ...] = _GROUPS
        rows = [(*row[1:],) for row in _CLEARANCES if bearing.bore_diameter <= row[0] + 1e-12]
    else:
        names, rows = ("C0", "C1"), [row.sold for row in _crossed_rows(bearing)]
    return tuple(
        Clearance(name, 1e-6 * least, 1e-6 * most)
        for name, (least, most) in zip(names, rows[0] if rows else (), strict=False)
    )


def most_preload(bearing: Bearing) -> float | None:
    """What a bearing bears, on its diameter, m; of crossed rollers that of the class CC0."""
    if bearing.kind == "ball":
        return BALL_PRELOAD
    return next((1e-6 * row.preload for row in _crossed_rows(bearing)), None)


def _crossed_rows(bearing: Bearing) -> list[_Crossed]:
    if bearing.kind != "crossed roller":
        return []
    thin = bearing.designation.startswith("THK RA")
    pitch = 0.5 * (bearing.bore_diameter + bearing.outer_diameter)
    return [row for row in (_THIN if thin else _CROSSED) if pitch <= row.pitch + 1e-12]


def ring_limits(bore: float, outside: float) -> tuple[float, float] | None:
    """By how much bore and outside of a bearing may be smaller, m (Normal); None where unknown."""
    inner = next((off for most, off in _BORES if bore <= most + 1e-12), None)
    outer = next((off for most, off in _OUTSIDES if outside <= most + 1e-12), None)
    return None if inner is None or outer is None else (inner, outer)


def clearance_group(
    bore: float, outside: float, shaft_zone: str, hole_zone: str, wanted: float = 0.0
) -> ClearanceGroup | None:
    """The smallest group of which seats leave more than is wanted, in the mean.

    None where no clearance or limit is known. A fit that is loose at its mean takes nothing.

    Parameters
    ----------
    bore, outside : float
        Of the bearing, m.
    shaft_zone, hole_zone : str
        ISO 286 zones of what it sits on and in.
    wanted : float
        When fitted, m.

    Examples
    --------
    A 6902 on 15 h6 in 28 N7, of whose 3 to 18 um CN leaves next to nothing:

    >>> found = clearance_group(15e-3, 28e-3, "h6", "N7", 5e-6)
    >>> found.name, round(1e6 * found.left), round(1e6 * found.spread)
    ('C3', 8, 12)
    """
    rows = [row for row in _CLEARANCES if bore <= row[0] + 1e-12]
    limits = ring_limits(bore, outside)
    if not rows or limits is None:
        return None
    inner, outer = limits
    try:
        shaft, hole = fit_limits(shaft_zone, bore), fit_limits(hole_zone, outside)
    except CatalogError:
        return None
    taken, varied = 0.0, 0.0
    for least, most, ranges in (
        (shaft.lower, shaft.upper + inner, (shaft.upper - shaft.lower, inner)),
        (-outer - hole.upper, -hole.lower, (hole.upper - hole.lower, outer)),
    ):
        if least + most > 0.0:
            taken += _TAKEN * 0.5 * (least + most)
            varied = math.hypot(varied, *(_TAKEN * 0.5 * one for one in ranges))
    found = [
        ClearanceGroup(
            name,
            1e-6 * low,
            1e-6 * high,
            0.5e-6 * (low + high) - taken,
            math.hypot(0.5e-6 * (high - low), varied),
        )
        for name, (low, high) in zip(_GROUPS, rows[0][1:], strict=True)
    ]
    return next((one for one in found if one.left > wanted), found[-1])
