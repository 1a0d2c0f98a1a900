"""The bearing between carrier and housing: equivalent loads of force and tilting moment together.

Crossed rollers, with the pitch circle d_p = (d + D)/2 (THK, General Catalog, Cross-Roller Ring)::

    P0 = (F_r + 2 M/d_p) + 0.44 F_a
    P  = X (F_r + 2 M/d_p) + Y F_a,   X = 1, Y = 0.45 while F_a <= 1.5 (F_r + 2 M/d_p), else 0.67

Deep-groove balls hold a moment by pushing against the sides of their grooves, as under an axial
force F_a + 4.37 M/d_p (Harris and Kotzalas 2006: greatest load of a row of balls
under a moment). Then ISO 76 (P0 = 0.6 F_r + 0.5 F_a, at least F_r) and ISO 281 with the usual
clearance (P = F_r, or 0.56 F_r + Y F_a). Along the axis balls climb out of their grooves before P0
says so: F_a + 4.37 M/d_p <= 0.25 C0, or 0.5 C0 of the sturdier diameter series 2 to 4 (SKF, Rolling
bearings, deep groove ball bearings, loads).
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.geometry.contours import FloatArray

_ROLLER_STATIC, _ROLLER_SHARES, _ROLLER_SWITCH = 0.44, ((1.0, 0.45), (0.67, 0.67)), 1.5
_BALL_MOMENT = 4.37
_BALL_RADIAL = 0.56
_THIN_SHARE, _STURDY_SHARE = 0.25, 0.5
_SMALL = 12e-3
"""Bore up to which balls of any series count as thin, m."""
_STURDY = re.compile(r"\b6[2-4]\d")
"""Designations of deep-groove balls of the diameter series 2 to 4."""
_BALL_SHARES = (
    (0.025, 0.04, 0.07, 0.13, 0.25, 0.5),
    (0.22, 0.24, 0.27, 0.31, 0.37, 0.44),
    (2.0, 1.8, 1.6, 1.4, 1.2, 1.0),
)
"""F_a/C0, and the e and Y that go with it (ISO 281, single-row radial ball bearings)."""


class OutputLoad(NamedTuple):
    """What a bearing holds; arrays of one shape, SI."""

    radial: FloatArray
    axial: FloatArray
    moment: FloatArray


def static_load(bearing: Bearing, load: OutputLoad) -> FloatArray:
    """Equivalent static load P0, N.

    Examples
    --------
    A crossed roller of 50 x 66 mm under 10 N m alone: 2 M/d_p.

    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> none = np.zeros(1)
    >>> print(static_load(find_bearing("THK RA5008"), OutputLoad(none, none, none + 10.0)).round(1))
    [344.8]
    """
    tilted = load.moment / _pitch(bearing)
    if bearing.kind == "ball":
        axial = load.axial + _BALL_MOMENT * tilted
        return np.maximum(0.6 * load.radial + 0.5 * axial, load.radial)
    return np.asarray(load.radial + 2.0 * tilted + _ROLLER_STATIC * load.axial)


def static_safety(bearing: Bearing, load: OutputLoad) -> float:
    """Static rating over what the loads ask of it; 0 where the rating is not known.

    Examples
    --------
    Of 8100 N balls as thin as these take a quarter along the axis:

    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> none = np.zeros(1)
    >>> round(static_safety(find_bearing("6811"), OutputLoad(none, none + 5000.0, none)), 3)
    0.405
    """
    rating = bearing.static_rating or 0.0
    most = float(static_load(bearing, load).max())
    if bearing.kind == "ball":
        along = load.axial + _BALL_MOMENT * load.moment / _pitch(bearing)
        most = max(most, float(along.max()) / axial_share(bearing))
    return rating / most


def axial_share(bearing: Bearing) -> float:
    """Share of a ball bearing's static rating that it takes along the axis."""
    sturdy = _STURDY.search(bearing.designation) and bearing.bore_diameter > _SMALL
    return _STURDY_SHARE if sturdy else _THIN_SHARE


def dynamic_load(bearing: Bearing, load: OutputLoad) -> FloatArray:
    """Equivalent dynamic load P, N; the static rating of balls has to be known."""
    tilted = load.moment / _pitch(bearing)
    if bearing.kind == "ball":
        axial = load.axial + _BALL_MOMENT * tilted
        share = axial / (bearing.static_rating or np.inf)
        pushes = axial > np.interp(share, *_BALL_SHARES[:2]) * load.radial
        factor = np.interp(share, _BALL_SHARES[0], _BALL_SHARES[2])
        both = _BALL_RADIAL * load.radial + factor * axial
        return np.where(pushes, np.maximum(both, load.radial), load.radial)
    across = load.radial + 2.0 * tilted
    (x, y), (x_axial, y_axial) = _ROLLER_SHARES
    return np.where(
        load.axial <= _ROLLER_SWITCH * across,
        x * across + y * load.axial,
        x_axial * across + y_axial * load.axial,
    )


def _pitch(bearing: Bearing) -> float:
    return 0.5 * (bearing.bore_diameter + bearing.outer_diameter)
