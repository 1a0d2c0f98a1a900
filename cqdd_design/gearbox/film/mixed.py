"""Friction from boundary to film: what a thin film carries of a rough contact.

lambda = h/sqrt(Rq1^2 + Rq2^2)
mu = mu_film + (mu_boundary - mu_film)/(1 + lambda)^2
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.finishes import Finish
from cqdd_design.geometry.contours import FloatArray

BOUNDARY_FRICTION = 0.10
"""Coefficient of steel on steel through a boundary layer of greased or oiled surfaces: 0.08 to 0.12
(Bowden and Tabor 1950, The Friction and Lubrication of Solids; handbook value not re-read), the
middle."""


def composite_roughness(first: Finish, second: Finish) -> float:
    """Root of the squared Rq of both surfaces of a contact, m."""
    return math.hypot(first.rms_roughness, second.rms_roughness)


def asperity_share(ratio: ArrayLike) -> FloatArray:
    """Share of the load on asperities at a film ratio lambda, 1/(1 + lambda)^2.

    Olver and Spikes 1998, Prediction of traction in elastohydrodynamic lubrication, Proc. Inst.
    Mech. Eng. J 212, 321-332.

    Examples
    --------
    >>> asperity_share([0.0, 1.0, 3.0]).tolist()
    [1.0, 0.25, 0.0625]
    """
    return np.asarray(1.0 / (1.0 + np.asarray(ratio, dtype=float)) ** 2)


def mixed_friction(boundary: float, film: float, ratio: ArrayLike) -> FloatArray:
    """Coefficient of friction between that of the boundary layer and that of a full film.

    Parameters
    ----------
    boundary, film : float
        mu where asperities carry all of the load, and none.
    ratio : array_like
        lambda, not negative.

    Examples
    --------
    >>> mixed_friction(0.1, 0.04, [0.0, 1.0]).round(9).tolist()
    [0.1, 0.055]
    """
    return np.asarray(film + (boundary - film) * asperity_share(ratio))
