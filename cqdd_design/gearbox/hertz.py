"""Hertz line contact: pressures, equivalent radii and approach. Every function broadcasts."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.materials import Material
from cqdd_design.geometry.contours import FloatArray


def effective_modulus(
    youngs_modulus_1: ArrayLike,
    poisson_ratio_1: ArrayLike,
    youngs_modulus_2: ArrayLike,
    poisson_ratio_2: ArrayLike,
) -> FloatArray:
    """E* with 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, in the unit of E (Johnson 1985, ch. 4).

    Examples
    --------
    >>> print(round(float(effective_modulus(210e9, 0.3, 210e9, 0.3)) / 1e6, 1))
    115384.6
    """
    e1, e2 = np.asarray(youngs_modulus_1, dtype=float), np.asarray(youngs_modulus_2, dtype=float)
    nu1, nu2 = np.asarray(poisson_ratio_1, dtype=float), np.asarray(poisson_ratio_2, dtype=float)
    return np.asarray(1.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2))


def pair_modulus(first: Material, second: Material) -> float:
    """E* of two materials in contact, Pa."""
    moduli = (first.youngs_modulus, first.poisson_ratio)
    return float(effective_modulus(*moduli, second.youngs_modulus, second.poisson_ratio))


def line_contact_pressure(
    force: ArrayLike, length: ArrayLike, equivalent_radius: ArrayLike, modulus: ArrayLike
) -> FloatArray:
    """Peak pressure p0 = sqrt(F E*/(pi b R_eq)) of a line contact (Johnson 1985, eq. 4.45).

    Parameters
    ----------
    force : array_like
        N, not negative.
    length, equivalent_radius : array_like
        b and R_eq in m, positive.
    modulus : array_like
        E* in Pa.

    Returns
    -------
    array
        Pa.

    Examples
    --------
    1000 N on 10 mm of a steel cylinder of 10 mm radius on a flat:

    >>> p = line_contact_pressure(1000.0, 0.01, 0.01, effective_modulus(210e9, 0.3, 210e9, 0.3))
    >>> print(round(float(p) / 1e6, 2))
    606.04
    """
    load = np.asarray(force, dtype=float) * np.asarray(modulus, dtype=float)
    width = np.asarray(length, dtype=float) * np.asarray(equivalent_radius, dtype=float)
    return np.asarray(np.sqrt(load / (np.pi * width)))


def ring_equivalent_radius(tooth_radius: ArrayLike, curvature_of_locus: ArrayLike) -> FloatArray:
    """Equivalent radius of ring tooth and disc flank, m.

    1/R_eq = 1/r + kappa_disc with kappa_disc = kappa/(1 - r kappa) signed, which reduces to
    R_eq = r (1 - r kappa): below r at a lobe tip, above it in a valley. Positive as long as the
    disc is not undercut.

    Parameters
    ----------
    tooth_radius : array_like
        r in m.
    curvature_of_locus : array_like
        kappa of the tooth-centre locus, 1/m, convex positive.
    """
    r = np.asarray(tooth_radius, dtype=float)
    return np.asarray(r * (1.0 - r * np.asarray(curvature_of_locus, dtype=float)))


def conformal_equivalent_radius(pin_radius: ArrayLike, hole_radius: ArrayLike) -> FloatArray:
    """Equivalent radius of a pin in a larger hole: 1/R_eq = 1/r_pin - 1/r_hole, m."""
    pin, hole = np.asarray(pin_radius, dtype=float), np.asarray(hole_radius, dtype=float)
    return np.asarray(pin * hole / (hole - pin))
