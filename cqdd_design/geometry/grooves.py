r"""A round part with half grooves along its outside, for dowels in the seam with its seat.

::

          ___ fillet                    every joint is tangent: a wire runs round it, and no
      .--'   \      /'--.               burr is left for the seat
     /        \_  _/     \
    |  R        \/ groove  |            the groove's centre lies on the outside circle
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ArcContour, as_points

_EDGE, _EDGE_SHARE = 0.2e-3, 0.25
"""Radius of the rounded edges, m, and at most this share of the groove's."""


def edge_radius(groove: float) -> float:
    """Radius at the edges of a groove of a radius, m.

    Examples
    --------
    >>> edge_radius(1.5e-3), edge_radius(0.4e-3)
    (0.0002, 0.0001)
    """
    return min(_EDGE, _EDGE_SHARE * groove)


def groove_half_angle(radius: float, groove: float) -> float:
    """Half of the angle that a groove with its rounded edges takes of a circle (radii, m), rad."""
    edge = edge_radius(groove)
    inner, reach = radius - edge, groove + edge
    return math.acos((inner**2 + radius**2 - reach**2) / (2.0 * radius * inner))


def grooved_circle(radius: float, angles: Sequence[float], groove: float) -> ArcContour:
    """The circle with its half grooves, counter-clockwise; it begins before the first groove.

    Parameters
    ----------
    radius, groove : float
        Of the circle and of the grooves, m.
    angles : sequence of float
        Directions of the grooves, rising, rad.

    Raises
    ------
    GeometryError
        When neighbouring grooves run into each other.
    """
    at, edge = np.asarray(angles, dtype=float), edge_radius(groove)
    half = groove_half_angle(radius, groove)
    lands = np.diff(np.append(at, at[0] + 2.0 * math.pi)) - 2.0 * half
    if lands.min() <= 0.0:
        raise GeometryError(
            f"{len(at)} grooves of {2e3 * groove:g} mm do not go round a ring of "
            f"{2e3 * radius:g} mm; raise ring.outer_diameter."
        )
    # About a groove on +x: centre of the fillet beside it, and where fillet and groove meet.
    centre = (radius - edge) * np.exp(-1j * half)
    meeting = radius + groove * (centre - radius) / abs(centre - radius)
    fillet = float(np.angle((meeting - centre) / np.exp(-1j * half)))
    inside = -2.0 * (math.pi - abs(float(np.angle(centre - radius))))
    own = np.array([radius * np.exp(-1j * half), meeting, meeting.conjugate(),
                    radius * np.exp(1j * half)])  # fmt: skip
    points = np.exp(1j * at)[:, None] * own
    sweeps = np.stack([np.full(len(at), one) for one in (fillet, inside, fillet)] + [lands], axis=1)
    return ArcContour(as_points(points.ravel()), np.tan(0.25 * sweeps.ravel()))
