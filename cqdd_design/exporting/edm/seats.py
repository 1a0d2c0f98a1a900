"""Seats among the contours of flat parts: which carry an ISO 286 zone, and what it moves.

Files hold nominal contours. The wire is shifted to bring a seat to the middle of its zone::

    inner contour   shift = -(lower + upper) / 4     a smaller bore: farther into the waste
    outer contour   shift = +(lower + upper) / 4     a larger part: farther out, also into the waste
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.fits import FitLimits, fit_limits
from cqdd_design.errors import CatalogError

_MM = 1e3


@dataclass(frozen=True)
class Seat:
    """A contour of a flat part that is a seat.

    Attributes
    ----------
    contour : int
        0 is the outer contour, then the inner ones.
    diameter : float
        Nominal, as drawn, m.
    limits : FitLimits
        Zone and deviations.
    """

    contour: int
    diameter: float
    limits: FitLimits

    @property
    def shift(self) -> float:
        """Additional offset of the wire into the waste for the middle of the zone, m."""
        half = 0.25 * (self.limits.lower + self.limits.upper)
        return half if self.contour == 0 else -half

    @property
    def middle(self) -> float:
        """Diameter in the middle of the zone, m."""
        return self.diameter + 0.5 * (self.limits.lower + self.limits.upper)

    def __str__(self) -> str:
        """As on a drawing: ``28 N7 (-0.007/-0.028)``, in mm."""
        upper, lower = _MM * self.limits.upper, _MM * self.limits.lower
        return f"{_MM * self.diameter:.6g} {self.limits.zone} ({upper:+.4g}/{lower:+.4g})"


def seat(contour: int, diameter: float, zone: str) -> Seat | None:
    """A seat of a contour, None where the table of its zone does not know the size (m)."""
    try:
        return Seat(contour, diameter, fit_limits(zone, diameter))
    except CatalogError:
        return None
