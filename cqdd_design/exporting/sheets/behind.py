r"""Edges behind the cut of a flat part, which its section shows too.

::

        seen from +Y, the cut is the X axis
     ====#####======#######====    what is cut
             \      /   |
              \____/    |  an edge is seen where a wall turns away from the eye, or has a corner,
                        *  and nothing stands before it
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cqdd_design.exporting.edm.wire_path import directions, segmented
from cqdd_design.geometry.contours import ArcContour, ComplexArray, Contour, FloatArray, as_complex

_SAMPLED = 1e-7
"""Deviation of the straight pieces that stand for a contour, m."""
_CORNER = 0.1
"""Least turn at a joint that is seen as an edge, rad."""
_BEFORE = 1e-6
"""An edge does not hide itself: what is nearer to it than this does not stand before it, m."""


def edges_behind(contours: Sequence[Contour]) -> list[float]:
    """Ascending places along the horizontal axis of what is seen behind it, looking down, m.

    Parameters
    ----------
    contours : sequence of Contour
        Counter-clockwise, the outer one first. A round wall that the axis cuts square may give an
        edge where it is cut.
    """
    every = [as_complex(segmented(one).sample(_SAMPLED)) for one in contours]
    starts = np.concatenate(every)
    ends = np.concatenate([np.roll(one, -1) for one in every])
    # Turned, so that the line of sight becomes the axis that walls cross.
    starts, ends = starts * -1j, ends * -1j
    found = []
    for number, contour in enumerate(contours):
        for edge in (*_turning(every[number], outer=number == 0), *_corners(segmented(contour))):
            if edge.imag >= -_BEFORE:
                continue
            shift = 1j * edge.real
            before = _crossed(starts + shift, ends + shift)
            if not ((before > edge.imag + _BEFORE) & (before <= 0.0)).any():
                found.append(float(edge.real))
    return sorted(found)


def _crossed(starts: ComplexArray, ends: ComplexArray) -> FloatArray:
    """Where lines cross the horizontal axis, m."""
    crossing = (starts.imag >= 0.0) != (ends.imag >= 0.0)
    one, two = starts[crossing], ends[crossing]
    return np.asarray(one.real - one.imag * (two - one).real / (two - one).imag)


def _turning(points: ComplexArray, *, outer: bool) -> list[complex]:
    """Where a wall turns away from one who looks along the upright axis."""
    before, after = points - np.roll(points, 1), np.roll(points, -1) - points
    farthest, nearest = (before.real >= 0) & (after.real < 0), (before.real <= 0) & (after.real > 0)
    # Material lies left of the outer contour, right of a hole: inside of the turn.
    up = (before + after).imag > 0.0
    return list(points[(farthest & (up == outer)) | (nearest & (up != outer))])


def _corners(contour: ArcContour) -> list[complex]:
    leaving, arriving = directions(contour)
    turns = np.abs(np.angle(leaving / arriving)) > _CORNER
    return list(as_complex(contour.points)[turns])
