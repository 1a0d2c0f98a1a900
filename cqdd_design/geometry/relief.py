r"""The relief of a solid ring: root circle and fillets between teeth that are arcs of radius r.

::

      tooth circle          root circle R + 2 e - r + clearance
        .---.   ___________/
       /     \ /  f  fillet, tangent to both
      |   Q   B
       \     /
        A---A   active arc, asin(K1) to both sides of the inward radial

The fillet is the largest that keeps the clearance from everything the disc sweeps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.conjugate import SecondEnvelope, swept_radius
from cqdd_design.geometry.contours import ComplexArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.limits import millimetres, rounded_down

_ENVELOPE_POINTS = 1025
_STEPS = 48
# A tooth on a neck thinner than this share of its diameter is a fin, not a tooth.
_SLIMMEST_NECK = 0.5


@dataclass(frozen=True)
class Relief:
    """Half of the gap between two teeth, from tooth 0 on +x to midway at pi/(n+1).

    Attributes
    ----------
    root_radius : float
        Of the circle about the ring's centre that forms the root, m.
    fillet_radius : float
        m; the least concave radius of the ring.
    fillet_centre : complex
        m.
    tooth_angle : float
        Where the tooth's arc ends, from its inward radial, rad.
    root_angle : float
        Where the fillet meets the root circle, rad; at most pi/(n+1).
    """

    root_radius: float
    fillet_radius: float
    fillet_centre: complex
    tooth_angle: float
    root_angle: float

    @property
    def neck_half_width(self) -> float:
        """Half of the thinnest place of the tooth outside its arc; infinite where it widens."""
        start = -self.tooth_angle
        # The fillet comes nearest to the tooth's axis straight below its centre, if it gets there.
        if start >= -0.5 * math.pi:
            return math.inf
        return self.fillet_centre.imag - self.fillet_radius


@lru_cache(maxsize=64)
def solid_relief(disc: CycloidDisc, clearance: float) -> Relief:
    """Relief with the largest fillets that clear the swept disc by `clearance` everywhere.

    Parameters
    ----------
    disc : CycloidDisc
        Its unmodified form is swept.
    clearance : float
        Least distance of root and fillets from the disc at any crank angle, m, above 0.

    Raises
    ------
    GeometryError
        When no fillet of any size does; the message names the largest clearance that works.
    """
    found = _largest_fillet(disc, clearance)
    if found is not None:
        return found
    low, high = 0.0, clearance
    for _ in range(20):
        middle = 0.5 * (low + high)
        if _largest_fillet(disc, middle) is None:
            high = middle
        else:
            low = middle
    if low <= 0.0:
        raise GeometryError(
            f"eccentricity {millimetres(disc.eccentricity)} leaves a solid ring no root between "
            f"its teeth at ring_pin_diameter {millimetres(2.0 * disc.tooth_radius)}; lower it, "
            'or use ring_type = "conjugate".'
        )
    raise GeometryError(
        f"ring.relief_clearance {millimetres(clearance)} is above "
        f"{rounded_down(low * 1e3):.6g} mm, beyond which no fillet that clears the disc leaves "
        "a tooth half its width where it stands on the root; lower it, or use "
        'ring_type = "conjugate".'
    )


def _largest_fillet(disc: CycloidDisc, clearance: float) -> Relief | None:
    R, r = disc.ring_pitch_radius, disc.tooth_radius
    half = math.pi / disc.ring_tooth_count
    root = swept_radius(disc) + clearance
    envelope = _sampled_envelope(disc.unmodified)
    # One circle through the whole gap, tangent to both teeth and to the root circle.
    across = R * math.cos(half)
    groove = (root * root + R * R - 2.0 * root * across - r * r) / (2.0 * (root + r - across))
    if groove <= 0.0:
        return None
    smallest = max(0.0, 0.5 * (root - R - r))

    def works(fillet: float) -> Relief | None:
        relief = _relief(disc, root, fillet)
        clear = _clearance(relief, envelope) >= clearance
        return relief if clear and not _too_slim(disc, relief) else None

    best = works(groove)
    if best is not None:
        return best
    low, high = smallest, groove
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        relief = works(middle)
        if relief is None and _too_slim(disc, _relief(disc, root, middle)):
            low = middle
        elif relief is None:
            high = middle
        else:
            best, low = relief, middle
    return best


def _too_slim(disc: CycloidDisc, relief: Relief) -> bool:
    """Whether a wider fillet, not a finer one, is needed because the tooth has hardly a neck."""
    return relief.neck_half_width < _SLIMMEST_NECK * disc.tooth_radius


def _relief(disc: CycloidDisc, root: float, fillet: float) -> Relief:
    R, r = disc.ring_pitch_radius, disc.tooth_radius
    reach = root - fillet
    cosine = (reach * reach + R * R - (r + fillet) ** 2) / (2.0 * R * reach)
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    centre = complex(reach * math.cos(angle), reach * math.sin(angle))
    toward = math.atan2(centre.imag, centre.real - R)
    return Relief(root, fillet, centre, math.pi - toward, angle)


@dataclass(frozen=True, eq=False)
class _Envelope:
    """Samples of the second envelope, their spacing (m) and the most it bends (1/m)."""

    points: ComplexArray
    spacing: float
    bend: float


@lru_cache(maxsize=64)
def _sampled_envelope(disc: CycloidDisc) -> _Envelope:
    envelope = SecondEnvelope.of(disc)
    t = np.linspace(envelope.start, envelope.end, _ENVELOPE_POINTS)
    points = envelope.point(t)
    return _Envelope(
        points, float(np.abs(np.diff(points)).max()), float(np.abs(envelope.curvature(t)).max())
    )


def _clearance(relief: Relief, envelope: _Envelope) -> float:
    """Least distance from the second envelope to the fillet, m, proven between the samples.

    The root circle itself stands outside the farthest reach by the clearance, and the active arc
    is farther from the fillet than its end, which is the envelope's first point.
    """
    centre, radius = relief.fillet_centre, relief.fillet_radius
    away = envelope.points - centre
    start, end = -relief.tooth_angle, relief.root_angle
    angle = np.angle(away)
    beside = (angle >= start) & (angle <= end)
    ends = centre + radius * np.exp(1j * np.array([start, end]))
    to_ends = np.abs(envelope.points[:, None] - ends).min(axis=1)
    # Inside the fillet's circle the distance is what is left of its radius; outside, interference.
    least = float(np.where(beside, radius - np.abs(away), to_ends).min())
    if least <= 0.0:
        return least
    # Between two samples a distance dips by at most spacing^2 / 8 times its second derivative:
    # the bend of the envelope, and one over the distance from the arc's centre or end.
    from_centre = radius - least if radius > least else radius
    bend = envelope.bend + max(1.0 / least, 1.0 / from_centre)
    return least - envelope.spacing**2 / 8.0 * bend
