"""Radial internal clearance of deep-groove ball bearings, and the group to order (ISO 5753-1)."""

from __future__ import annotations

import math
from typing import NamedTuple

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
)
"""Bores up to which they hold, m, and CN, C3 and C4, um (ISO 5753-1:2009, table 1; handbook values,
not re-read)."""
_OUTSIDES = (
    (18e-3, 8e-6), (30e-3, 9e-6), (50e-3, 11e-6), (80e-3, 13e-6), (120e-3, 15e-6), (150e-3, 18e-6),
)  # fmt: skip
_BORES = ((18e-3, 8e-6), (30e-3, 10e-6), (50e-3, 12e-6), (80e-3, 15e-6), (120e-3, 20e-6))
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
    outer = next((off for most, off in _OUTSIDES if outside <= most + 1e-12), None)
    inner = next((off for most, off in _BORES if bore <= most + 1e-12), None)
    if not rows or outer is None or inner is None:
        return None
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
