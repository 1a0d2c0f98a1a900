"""Seats among the contours of flat parts: which carry an ISO 286 zone, and what it moves.

Files hold nominal contours. The wire is shifted to bring a seat to the middle of its zone::

    inner contour   shift = -(lower + upper) / 4     a smaller bore: farther into the waste
    outer contour   shift = +(lower + upper) / 4     a larger part: farther out, also into the waste
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog.fits import FitLimits, fit_limits
from cqdd_design.errors import CatalogError
from cqdd_design.geometry.contours import Circle
from cqdd_design.solids.features import zones

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.flat_parts import FlatPart

_DISC_SEAT, _RING_SEAT = 1, 0
"""Contour of the seat of a disc, its bore for the cam bearing, and of the ring, its outside."""

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


def seats_of(flat: FlatPart) -> tuple[Seat, ...]:
    """Seats of a flat part, those whose size the table of its zone knows."""
    contour, zone = _DISC_SEAT, zones.DISC_BORE
    if flat.label == "ring":
        contour, zone = _RING_SEAT, zones.RING_OUTSIDE
    circle = flat.contours[contour]
    if not isinstance(circle, Circle):
        return ()
    diameter = 2.0 * circle.radius
    try:
        return (Seat(contour, diameter, fit_limits(zone, diameter)),)
    except CatalogError:
        return ()
