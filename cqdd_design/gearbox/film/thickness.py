"""Thickness of an elastohydrodynamic film in a line contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray


def minimum_film(
    line_load: ArrayLike,
    entrainment: ArrayLike,
    radius: ArrayLike,
    *,
    viscosity: float,
    pressure_coefficient: float,
    modulus: float,
) -> FloatArray:
    """Least thickness of the film between two cylinders by Dowson and Higginson.

    h/R = 2.65 G^0.54 U^0.7/W^0.13 with G = alpha E', U = eta u/(E' R) and W = w/(E' R), E' = 2 E*
    (Dowson 1968, Proc. Inst. Mech. Eng. 182 (3A), 151-167, eq. for line contacts; Dowson and
    Higginson 1977, Elasto-hydrodynamic Lubrication). Isothermal, smooth, fully flooded: starved
    grease, a rough flank and shear that warms the inlet leave less.

    Parameters
    ----------
    line_load : array_like
        Load over length w, N/m, positive.
    entrainment : array_like
        Mean u of both surfaces' speeds past the contact, m/s, not negative.
    radius : array_like
        R of the equivalent cylinder on a flat, m, positive.
    viscosity : float
        eta of the oil at the inlet, Pa s.
    pressure_coefficient : float
        alpha of Barus' law, 1/Pa.
    modulus : float
        E*, as :func:`..hertz.effective_modulus` gives it, Pa.

    Returns
    -------
    array
        m.

    Examples
    --------
    R 20 mm, 1 m/s, 0.1 Pa s, 20 1/GPa and 100 N/mm on steel:

    >>> h = minimum_film(1e5, 1.0, 0.02, viscosity=0.1, pressure_coefficient=2e-8, modulus=115.4e9)
    >>> print(round(1e6 * float(h), 3))
    0.699
    """
    load, speed, bend = (np.asarray(one, dtype=float) for one in (line_load, entrainment, radius))
    stiff = 2.0 * modulus
    material = pressure_coefficient * stiff
    rate = viscosity * speed / (stiff * bend)
    pressing = load / (stiff * bend)
    return np.asarray(2.65 * bend * material**0.54 * rate**0.7 / pressing**0.13)
