"""Rolling bearings: ISO 281 basic rating life, static safety, and the choice of a cam bearing."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray

RollingElement = Literal["ball", "roller"]

LIFE_EXPONENT_BALL = 3.0
"""ISO 281:2007, 5.1: p = 3 for ball bearings."""
LIFE_EXPONENT_ROLLER = 10.0 / 3.0
"""ISO 281:2007, 5.1: p = 10/3 for roller bearings, needles included."""


def life_exponent(rolling_element: RollingElement) -> float:
    """Exponent p of the life equation, 3 for balls and 10/3 for rollers (ISO 281:2007)."""
    return LIFE_EXPONENT_BALL if rolling_element == "ball" else LIFE_EXPONENT_ROLLER


def basic_rating_life_hours(
    dynamic_rating: ArrayLike,
    load: ArrayLike,
    speed: ArrayLike,
    exponent: ArrayLike = LIFE_EXPONENT_BALL,
) -> FloatArray:
    """Return the basic rating life L10h = 1e6 (C/P)^p/(60 rpm) of a bearing under pure radial load.

    Parameters
    ----------
    dynamic_rating, load : array_like
        C and P in N, positive.
    speed : array_like
        Relative speed of the rings in rad/s, positive.
    exponent : array_like
        p.

    Returns
    -------
    array
        Hours that 90 % of such bearings reach (ISO 281:2007, eq. 6).

    Examples
    --------
    C/P = 10 at 1000 rpm with balls:

    >>> print(round(float(basic_rating_life_hours(10e3, 1e3, 1000.0 * 2 * np.pi / 60)), 1))
    16666.7
    """
    turns_per_hour = np.asarray(speed, dtype=float) * 3600.0 / (2.0 * np.pi)
    load_ratio = np.asarray(dynamic_rating, dtype=float) / np.asarray(load, dtype=float)
    return np.asarray(1e6 * load_ratio ** np.asarray(exponent, dtype=float) / turns_per_hour)


def load_for_life(
    dynamic_rating: ArrayLike,
    life_hours: ArrayLike,
    speed: ArrayLike,
    exponent: ArrayLike = LIFE_EXPONENT_BALL,
) -> FloatArray:
    """Radial load P in N at which a bearing just reaches `life_hours`, inverse of the above."""
    turns = np.asarray(life_hours, dtype=float) * np.asarray(speed, dtype=float) * 1800.0 / np.pi
    power = 1.0 / np.asarray(exponent, dtype=float)
    return np.asarray(np.asarray(dynamic_rating, dtype=float) * (1e6 / turns) ** power)


def static_safety(static_rating: ArrayLike, load: ArrayLike) -> FloatArray:
    """Return the static safety factor s0 = C0/P0 under pure radial load (ISO 76:2006)."""
    return np.asarray(np.asarray(static_rating, dtype=float) / np.asarray(load, dtype=float))
