"""The curve a ring tooth traces on the disc, and the flank it generates, in closed form.

Frame of the disc: origin at its centre, a valley between two lobes on +x. The tooth centres of
the ring run, seen from the disc, along the *locus* (a shortened epitrochoid-like curve)::

    L(t) = R e^{it} - e e^{i(n+1)t},     K1 = e (n+1) / R < 1

with n lobes, ring pitch radius R and eccentricity e, and the flank is its inner parallel at the
tooth radius r. Along L the outward normal is N = e^{it} (1 - K1 e^{int}) / D with
D = |1 - K1 e^{int}|, so that flank = L - r N. (The form with an angle psi needs
psi = -atan2(sin nt, 1/K1 - cos nt); with a plus sign the profile is wrong by millimetres.)

Curvature is positive where the material is convex.

Sources: F. L. Litvin and P.-H. Feng, "Computerized design and generation of cycloidal gearings",
Mechanism and Machine Theory 31 (1996) 891-911; J. W. Sensinger, "Unified approach to cycloid
drive profile, stress, and efficiency optimization", ASME J. Mech. Des. 132 (2010) 024503; limit
of undercutting in the two branches of CN105404737A (2016).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import ComplexArray, FloatArray


def shortening_coefficient(
    lobe_count: ArrayLike, ring_pitch_radius: ArrayLike, eccentricity: ArrayLike
) -> FloatArray:
    """K1 = e (n + 1) / R; the profile exists for values below one.

    Parameters
    ----------
    lobe_count, ring_pitch_radius, eccentricity : array_like
        n, and R and e in one unit of length; broadcast together.
    """
    n, R, e = (np.asarray(v, dtype=float) for v in (lobe_count, ring_pitch_radius, eccentricity))
    return np.asarray(e * (n + 1.0) / R)


def locus_curvature(
    lobe_count: ArrayLike, ring_pitch_radius: ArrayLike, eccentricity: ArrayLike, t: ArrayLike
) -> FloatArray:
    """Signed curvature of the path of the tooth centres in the disc's frame, 1/m.

    kappa = (1 + z K1^2 - (z + 1) K1 cos nt) / (R D^3) with z = n + 1.

    Parameters
    ----------
    lobe_count, ring_pitch_radius, eccentricity, t : array_like
        n, R and e (m), parameter (rad); broadcast together.
    """
    n, R, t = (np.asarray(v, dtype=float) for v in (lobe_count, ring_pitch_radius, t))
    K = shortening_coefficient(n, R, eccentricity)
    z, c = n + 1.0, np.cos(n * t)
    return np.asarray(
        (1.0 + z * K * K - (z + 1.0) * K * c) / (R * (1.0 + K * K - 2.0 * K * c) ** 1.5)
    )


def undercut_radius_limit(
    lobe_count: ArrayLike, ring_pitch_radius: ArrayLike, eccentricity: ArrayLike
) -> FloatArray:
    """Least convex radius of the locus: a larger tooth undercuts the disc.

    With z = n + 1: R sqrt(27 (1 - K1^2) (z - 1) / (z + 1)^3) when K1 > (z - 2) / (2 z - 1), else
    R (1 + K1)^2 / (1 + z K1). One paper prints (1 - K1)^2 in the second branch; it is a misprint.

    Parameters
    ----------
    lobe_count, ring_pitch_radius, eccentricity : array_like
        n, R and e (m); broadcast together. K1 >= 1 gives 0: no profile exists.

    Returns
    -------
    array
        m.

    Examples
    --------
    >>> round(1e3 * float(undercut_radius_limit(11, 0.050, 0.0015)), 6)
    17.383459
    """
    R = np.asarray(ring_pitch_radius, dtype=float)
    z = np.asarray(lobe_count, dtype=float) + 1.0
    K = shortening_coefficient(z - 1.0, R, eccentricity)
    sharpest_beside_tip = K * (2.0 * z - 1.0) > z - 2.0
    inside = 27.0 * np.maximum(1.0 - K * K, 0.0) * (z - 1.0) / (z + 1.0) ** 3
    return np.asarray(
        np.where(
            sharpest_beside_tip,
            R * np.sqrt(inside),
            R * (1.0 + K) ** 2 / (1.0 + z * K),
        )
    )


def locus_valley_radius(
    lobe_count: ArrayLike, ring_pitch_radius: ArrayLike, eccentricity: ArrayLike
) -> FloatArray:
    """Concave radius of the locus at a valley, R (1 - K1)^2 / (z K1 - 1); the disc's is r more.

    Parameters
    ----------
    lobe_count, ring_pitch_radius, eccentricity : array_like
        n, R and e (m); broadcast together.

    Returns
    -------
    array
        m; infinite where z K1 <= 1 and the valley is not concave.

    Examples
    --------
    >>> round(1e3 * float(locus_valley_radius(10, 0.045, 0.002)), 6)
    2.685279
    """
    R = np.asarray(ring_pitch_radius, dtype=float)
    z = np.asarray(lobe_count, dtype=float) + 1.0
    K = shortening_coefficient(z - 1.0, R, eccentricity)
    bend = z * K - 1.0
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(bend > 0.0, R * (1.0 - K) ** 2 / bend, np.inf))


@dataclass(frozen=True)
class GeneratedFlank:
    """The flank a tooth of radius r generates, before any turning of flanks, as complex functions.

    Attributes
    ----------
    lobe_count : int
        n.
    pitch_radius, eccentricity, tooth_radius : float
        R, e and r used for generation, m.
    """

    lobe_count: int
    pitch_radius: float
    eccentricity: float
    tooth_radius: float

    @property
    def shortening(self) -> float:
        """K1 of the generation."""
        return self.eccentricity * (self.lobe_count + 1) / self.pitch_radius

    def locus(self, t: FloatArray) -> ComplexArray:
        """Path of the tooth centre, m."""
        z = self.lobe_count + 1
        return np.asarray(
            self.pitch_radius * np.exp(1j * t) - self.eccentricity * np.exp(1j * z * t)
        )

    def normal(self, t: FloatArray) -> ComplexArray:
        """Outward unit normal, from the material to the tooth centre."""
        factor = 1.0 - self.shortening * np.exp(1j * self.lobe_count * t)
        return np.asarray(np.exp(1j * t) * factor / np.abs(factor))

    def point(self, t: FloatArray) -> ComplexArray:
        """Flank, m."""
        return np.asarray(self.locus(t) - self.tooth_radius * self.normal(t))

    def locus_speed(self, t: FloatArray) -> FloatArray:
        """|dL/dt|, m/rad."""
        K = self.shortening
        return np.asarray(
            self.pitch_radius * np.sqrt(1.0 + K * K - 2.0 * K * np.cos(self.lobe_count * t))
        )

    def locus_bend(self, t: FloatArray) -> FloatArray:
        """Signed curvature of the locus, 1/m."""
        return locus_curvature(self.lobe_count, self.pitch_radius, self.eccentricity, t)

    def speed(self, t: FloatArray) -> FloatArray:
        """|d flank/dt|, m/rad; positive as long as nothing is undercut."""
        return np.asarray(self.locus_speed(t) * (1.0 - self.tooth_radius * self.locus_bend(t)))

    def curvature(self, t: FloatArray) -> FloatArray:
        """Signed curvature of the flank, 1/m."""
        bend = self.locus_bend(t)
        return np.asarray(bend / (1.0 - self.tooth_radius * bend))

    def sharpest_parameter(self) -> float:
        """Parameter in [0, pi/n] at which the locus is most convex."""
        z, K = self.lobe_count + 1, self.shortening
        # Zero of d(kappa)/d(cos nt); at or below -1 the tip itself is the sharpest.
        cosine = (2.0 - z + (2.0 * z - 1.0) * K * K) / ((z + 1.0) * K)
        return math.acos(min(max(cosine, -1.0), 1.0)) / self.lobe_count
