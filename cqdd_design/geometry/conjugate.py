r"""The second envelope: what the lobes of the moving disc sweep between the ring teeth.

Every point of the disc's flank touches the region the disc sweeps twice in a cycle. The normal
through it must pass the pitch point, which runs round a circle of radius n e in the disc's frame
(the centrode); a line meets that circle twice. The first meeting, exp(i (n+1) t), is the contact
with a ring tooth. The second gives another crank angle, at which the same point lies on the
*second envelope*, and that one is the boundary of the swept region between the active arcs of the
teeth::

        tooth          tooth         A: end of the active arc, asin(K1) from the inward radial,
        /   \          /   \             where both meetings coincide: cos nt = K1
       A     A  _____  A     A       T: lobe tip at its farthest, R + 2 e - r
              \/  T  \/
            second envelope

Sources: F. L. Litvin and A. Fuentes, Gear Geometry and Applied Theory, 2nd ed. (2004), chapter 13
(cycloidal gearing); C.-F. Hsieh, "Dynamics analysis of cycloidal speed reducers with pinwheel and
nonpinwheel designs", ASME J. Mech. Des. 136 (2014) 091008 (rings without pins).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.trochoid import GeneratedFlank


@dataclass(frozen=True)
class SecondEnvelope:
    """Boundary of the swept disc from a tooth's active arc to midway to the next tooth.

    In the ring's frame with tooth 0 on +x, for parameters from `start` to `end`.

    Attributes
    ----------
    flank : GeneratedFlank
        Of the unmodified disc.
    """

    flank: GeneratedFlank

    @classmethod
    def of(cls, disc: CycloidDisc) -> SecondEnvelope:
        """Return the envelope of the disc without its modification."""
        return cls(disc.unmodified.generated)

    @property
    def start(self) -> float:
        """Disc parameter where the envelope leaves the tooth's active arc, rad."""
        return math.acos(self.flank.shortening) / self.flank.lobe_count

    @property
    def end(self) -> float:
        """Disc parameter of the lobe tip, rad."""
        return math.pi / self.flank.lobe_count

    def crank_angle(self, t: FloatArray) -> FloatArray:
        """Crank angle at which the disc's point t lies on the second envelope, rad."""
        n = self.flank.lobe_count
        normal = self.flank.normal(t)
        # The pitch point mirrored in the diameter across the normal is the line's second meeting.
        second = -np.exp(-1j * (n + 1) * t) * normal**2
        # Counted from the tip's own angle, so that no branch cut lies between start and end.
        turned = np.angle(second * np.exp(-1j * self.end)) + self.end
        return np.asarray(turned * n / (n + 1.0))

    def normal(self, t: FloatArray) -> ComplexArray:
        """Outward unit normal of the swept region, into the ring."""
        turn = np.exp(-1j * self.crank_angle(t) / self.flank.lobe_count)
        return np.asarray(turn * self.flank.normal(t))

    def point(self, t: FloatArray) -> ComplexArray:
        """Point of the envelope, m."""
        phi = self.crank_angle(t)
        turn = np.exp(-1j * phi / self.flank.lobe_count)
        return np.asarray(self.flank.eccentricity * np.exp(1j * phi) + turn * self.flank.point(t))

    def _crank_rate(self, t: FloatArray) -> FloatArray:
        """Return the derivative of `crank_angle`."""
        z = self.flank.lobe_count + 1
        bend = self.flank.locus_bend(t) * self.flank.locus_speed(t)
        return np.asarray((z - 1.0) / z * (2.0 * bend - z))

    def speed(self, t: FloatArray) -> FloatArray:
        """Length of envelope per parameter, m/rad; positive, so the curve has no cusp."""
        flank, n = self.flank, self.flank.lobe_count
        pitch_point = n * flank.eccentricity * np.exp(1j * (n + 1) * t)
        across = (pitch_point * np.conj(flank.normal(t))).real
        # Distance along the normal from the pitch point of the second contact to the flank.
        lever = flank.locus_speed(t) - flank.tooth_radius + 2.0 * across
        return np.asarray(flank.speed(t) - self._crank_rate(t) * lever / n)

    def curvature(self, t: FloatArray) -> FloatArray:
        """Signed curvature, 1/m; positive where the swept region is convex, the ring concave."""
        bend = self.flank.locus_bend(t) * self.flank.locus_speed(t)
        return np.asarray((bend - self._crank_rate(t) / self.flank.lobe_count) / self.speed(t))


def active_angle(disc: CycloidDisc) -> float:
    """Half of the arc of a tooth that the disc touches: asin(K1) from the inward radial, rad."""
    return math.asin(disc.shortening_coefficient)


def swept_radius(disc: CycloidDisc) -> float:
    """Farthest the unmodified disc reaches from the ring's centre: R + 2 e - r, m."""
    return disc.ring_pitch_radius + 2.0 * disc.eccentricity - disc.tooth_radius
