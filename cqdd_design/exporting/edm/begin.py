r"""Where the cut of a contour begins: so that its tab, the last that is cut, lies where least is.

::

      valley of the disc         between two teeth of the ring       an output hole
        \            /                ____                          .-^-.  outward: a pin
         \__________/                /    \   the tab               |   |  pushes along
          ^ the tab                 /      \                        '---'  the circle there

A tab is cut last, from a wall that is finished on both sides of it, and shows: its last passes run
over that wall a little, so that no ridge is left where cuts meet. Its middle is put
where a tooth has no lever about the disc's centre, or where no tooth comes; in a round contour off
the axis, where a pin's push has no lever about the axis. The bore and the outside of the ring are
seats all round: they begin at the right, or halfway between two grooves.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    Contour,
    FloatArray,
    as_complex,
    as_points,
)

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.flat_parts import FlatPart

TABS_PER_CONTOUR = 8.0
"""A tab takes no more than this fraction of a contour."""
_CORNER, _TO_CORNER = 0.1, 0.8
"""Turn at a joint that is a corner, rad, and share of the way to it that a tab may take: the wire
comes straight off the wall where the tab ends."""
_PER_SEGMENT = 256
NO_PIECE = 10e-6
"""Shorter pieces of an arc are none, m: coordinates to 0.1 um would turn them, and with them the
way to the wire. A cut begins or ends at the joint instead."""


OVERLAP_SHARE = 0.1
"""Of a tab's length: how far its last passes run over the finished wall on either side. With
3 mm of tab that is 0.3 mm; where the tab ends before a corner, so does the overlap."""


def tab_of(contour: Contour, wanted: float = DEFAULTS.tab_length) -> float:
    """Length of the tab of a contour, m."""
    return min(wanted, contour.length() / TABS_PER_CONTOUR)


def tab_on(flat: FlatPart, number: int, wanted: float = DEFAULTS.tab_length) -> float:
    """Length of the tab of a contour of a part, m: it ends before the next corner on either side.

    In a ring that is where the pockets of its pins begin.
    """
    contour = flat.contours[number]
    tab = tab_of(contour, wanted)
    if isinstance(contour, Circle):
        return tab
    whole, place = contour.length(), _place_at(contour, flat.quiet_at(contour))
    away = np.abs((_corners(contour) - place + 0.5 * whole) % whole - 0.5 * whole)
    return min(tab, 2.0 * _TO_CORNER * float(away.min(initial=whole)))


def _corners(contour: ArcContour) -> FloatArray:
    """Ways along a contour to where it turns at a joint, m."""
    first, last = (as_complex(contour.evaluate(np.array([at]))[1])[:, 0] for at in (0.0, 1.0))
    turns = np.abs(np.angle(np.roll(first, -1) * last.conj())) > _CORNER
    return np.asarray(np.cumsum(_lengths(contour))[turns])


def begun(flat: FlatPart, number: int, tab: float = DEFAULTS.tab_length) -> ArcContour:
    """A contour of a part as arcs, from the end of its tab round to there.

    Parameters
    ----------
    number : int
        Of the contour: 0 is the outer one.
    tab : float
        Length of the tab where the contour is long enough, m.
    """
    contour = flat.contours[number]
    half = 0.5 * tab_on(flat, number, tab)
    if isinstance(contour, Circle):
        place = complex(*contour.centre)
        outward = cmath.phase(place) if abs(place) > contour.radius else 0.0
        return _half_circles(contour, outward + half / contour.radius)
    return _from_place(contour, _place_at(contour, flat.quiet_at(contour)) + half)


def _half_circles(circle: Circle, angle: float) -> ArcContour:
    reach = circle.radius * np.array([math.cos(angle), math.sin(angle)])
    return ArcContour(np.stack([circle.centre + reach, circle.centre - reach]), np.ones(2))


def _lengths(contour: ArcContour) -> FloatArray:
    start = as_complex(contour.points)
    chord = np.abs(np.roll(start, -1) - start)
    return np.asarray(chord / np.sinc(contour.sweeps / (2.0 * math.pi)))


def _place_at(contour: ArcContour, angle: float) -> float:
    """Way along a contour about the axis to where it has a polar angle, m."""
    share = np.arange(_PER_SEGMENT) / _PER_SEGMENT
    seen = np.angle(as_complex(contour.evaluate(share)[0]) * cmath.exp(-1j * angle))
    segment, step = np.unravel_index(np.abs(seen).argmin(), seen.shape)
    lengths = _lengths(contour)
    return float(lengths[:segment].sum() + share[step] * lengths[segment])


def _from_place(contour: ArcContour, place: float) -> ArcContour:
    """The same contour from a place along it, m: one segment is cut in two."""
    lengths = _lengths(contour)
    ends = np.cumsum(lengths)
    place %= float(ends[-1])
    segment = int(np.searchsorted(ends, place, side="right"))
    left = float(ends[segment]) - place
    if min(left, float(lengths[segment]) - left) < NO_PIECE:
        first = -segment - (2.0 * left < float(lengths[segment]))
        return ArcContour(np.roll(contour.points, first, axis=0), np.roll(contour.bulges, first))
    share = 1.0 - left / float(lengths[segment])
    at = as_complex(contour.evaluate(np.array([share]))[0])[segment]
    quarter = math.atan(float(contour.bulges[segment]))
    joints = as_complex(contour.points)
    after = np.arange(segment + 1, segment + len(joints)) % len(joints)
    points = np.concatenate([at, joints[after], joints[segment : segment + 1]])
    bulges = np.concatenate(
        [
            [math.tan((1.0 - share) * quarter)],
            contour.bulges[after],
            [math.tan(share * quarter)],
        ]
    )
    return ArcContour(as_points(points), bulges)
