"""Wear of what slides: depth over time by Archard, as a band, and the limit of plastics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.errors import UsageError
from cqdd_design.geometry.contours import FloatArray

WEAR_BAND = (1e-18, 1e-17)
"""Specific wear rates of lubricated steel on steel, m^2/N: 1e-9 and 1e-8 mm^3/(N m), the mild end
of 1e-9 to 1e-6 (Kato and Adachi 2001, Wear mechanisms, in Modern Tribology Handbook; handbook value
not re-read). Worn-out grease, dirt or scuffing wear far more."""


def wear_depth(coefficient: ArrayLike, rubbed: ArrayLike, area: ArrayLike) -> FloatArray:
    """Mean depth by Archard 1953, J. Appl. Phys. 24, 981-988: V = k F s, spread over an area.

    Parameters
    ----------
    coefficient : array_like
        k, volume worn per force and path, m^2/N.
    rubbed : array_like
        Normal force times sliding path, N m.
    area : array_like
        m^2.

    Returns
    -------
    array
        m.

    Raises
    ------
    UsageError
        Where a wear rate or path is negative, or an area is none.

    Examples
    --------
    1e-9 mm^3/(N m), 1 MN km on 1 cm^2:

    >>> print(round(1e6 * float(wear_depth(1e-18, 1e9, 1e-4)), 6))
    10.0
    """
    k, path, over = (np.asarray(one, dtype=float) for one in (coefficient, rubbed, area))
    if not (np.all(k >= 0.0) and np.all(path >= 0.0) and np.all(over > 0.0)):
        raise UsageError("wear needs a rate and a path that are not negative, and an area.")
    return np.asarray(k * path / over)


@dataclass(frozen=True)
class Wear:
    """Depths of wear over a time, as bands from the least to the greatest wear rate, m.

    Attributes
    ----------
    hours : float
        Of running.
    disc_flank, ring_tooth, hole, pin : tuple of float, or None
        Mean over the whole flank of a disc; over the way that contacts travel on a tooth; over the
        walls of hole and pin. None where something rolls between the two, and of plastics.
    clearance : float
        Gap between flank and tooth as drawn, m.
    """

    hours: float
    disc_flank: tuple[float, float] | None
    ring_tooth: tuple[float, float] | None
    hole: tuple[float, float] | None
    pin: tuple[float, float] | None
    clearance: float

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``wear``); the depth without a name is that of the flanks."""
        found: dict[str, object] = {
            "hours": self.hours,
            "wear_rate_low_mm3_per_Nm": WEAR_BAND[0] * 1e9,
            "wear_rate_high_mm3_per_Nm": WEAR_BAND[1] * 1e9,
            "clearance_um": self.clearance * 1e6,
        }
        places = {
            "depth": self.disc_flank,
            "ring_tooth": self.ring_tooth,
            "hole": self.hole,
            "output_pin": self.pin,
        }
        for name, band in places.items():
            key = name if name == "depth" else f"{name}_depth"
            for word, at in (("low", 0), ("high", 1)):
                found[f"{key}_um_{word}"] = None if band is None else band[at] * 1e6
        return found
