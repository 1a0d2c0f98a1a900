"""Circlips of shafts (DIN 471) and bores (DIN 472), and what a groove for one takes."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records

_SHAFT = "DIN 471"
_WALL_DEPTHS = 3.0
"""Wall beyond a groove, in depths of it, for which the standard rates grooves."""


@dataclass(frozen=True)
class Circlip:
    """A size of the normal kind, m.

    Attributes
    ----------
    standard : str
        ``DIN 471`` on a shaft, ``DIN 472`` in a bore.
    nominal_diameter : float
        Of shaft or bore.
    axial_width : float
        s, its thickness.
    free_diameter : float
        d3, before it is fitted.
    lug_height : float
        a, of the lugs, at most.
    beam_width : float
        b, across the ring opposite its gap.
    groove_diameter : float
        d2.
    source : str
        Where the row comes from.
    """

    standard: str = column("standard")
    nominal_diameter: float = column("d_mm", 1e-3)
    axial_width: float = column("s_mm", 1e-3)
    free_diameter: float = column("d3_mm", 1e-3)
    lug_height: float = column("a_mm", 1e-3)
    beam_width: float = column("b_mm", 1e-3)
    groove_diameter: float = column("d2_mm", 1e-3)
    source: str = column("source")

    @property
    def designation(self) -> str:
        """Such as ``DIN 471 - 50 x 2``."""
        return f"{self.standard} - {1e3 * self.nominal_diameter:g} x {1e3 * self.axial_width:g}"

    @property
    def groove_depth(self) -> float:
        """t, on the radius, m."""
        return 0.5 * abs(self.nominal_diameter - self.groove_diameter)

    @property
    def groove_width(self) -> float:
        """M of the standard (H13), m: 0.1 mm more than the ring, 0.15 mm from 2 mm on."""
        return self.axial_width + (0.15e-3 if self.axial_width > 1.99e-3 else 0.1e-3)

    @property
    def length(self) -> float:
        """Of the shaft or bore that groove and wall beyond it take, m."""
        return self.groove_width + _WALL_DEPTHS * self.groove_depth

    @property
    def swept_diameter(self) -> float:
        """What its lugs need round a shaft or leave in a bore while it is fitted, m."""
        sign = 1.0 if self.standard == _SHAFT else -1.0
        return self.nominal_diameter + sign * 2.0 * self.lug_height

    @property
    def seated_diameter(self) -> float:
        """To which its beam stands off the groove's floor, m."""
        sign = 1.0 if self.standard == _SHAFT else -1.0
        return self.groove_diameter + sign * 2.0 * self.beam_width


@functools.lru_cache(maxsize=1)
def circlips() -> dict[str, Circlip]:
    """All sizes by designation, those of shafts first, by rising diameter."""
    return {one.designation: one for one in read_records("circlips.csv", Circlip)}


def circlip_for(standard: str, diameter: float) -> Circlip | None:
    """The circlip of a shaft or bore of a diameter (m); None where the standard has none.

    Examples
    --------
    >>> circlip_for("DIN 472", 65e-3).groove_diameter
    0.068
    >>> circlip_for("DIN 472", 66e-3) is None
    True
    """
    for one in circlips().values():
        if one.standard == standard and abs(one.nominal_diameter - diameter) < 1e-9:
            return one
    return None
