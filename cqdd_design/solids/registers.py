"""How deep parts of the housing centre each other, and how narrow gaps about what turns are.

The ring clamp is the register: below, a spigot of the ring's diameter reaches into the ring's seat
of the housing, and above, one of the output bearing's diameter into that bearing's seat of the
cover. So neither housing nor cover has a bore that is not a seat already.
"""

from __future__ import annotations

from cqdd_design.solids.layout import CarrierLayout, GapSeal
from cqdd_design.solids.selection import ChosenBearing

LEAD_IN = 0.2e-3
"""Chamfer of a bore that a spigot goes into, m: no wider, or nothing would be left to centre."""
_SPIGOT, _LEAST_SPIGOT, _MOST_SPIGOT = 0.8, 0.6e-3, 1.5e-3
"""Depth of a spigot in units, and its limits, m."""
_GAPS = ((50e-3, 0.25e-3), (float("inf"), 0.5e-3))
"""Radial gap up to a diameter, m. NTN, Needle roller bearings, table 9.3: 0.2 to 0.4 mm of shafts
up to 50 mm, 0.5 to 1 mm up to 200 mm."""
_BESIDE_RING = 0.3
"""From a bearing's inner ring to what stands beside it, units, and no less than as many tenths of
a millimetre."""
NUT_SLOTS = 0.3
"""Of the bearing nut's height that its slots take, from above; below it is round."""


def spigot_depth(unit: float) -> float:
    """How deep a spigot reaches into its bore, m, by a millimetre at the machine's scale (m).

    Examples
    --------
    >>> [round(1e3 * spigot_depth(one * 1e-3), 2) for one in (0.5, 1.0, 3.0)]
    [0.6, 0.8, 1.5]
    """
    return min(max(_SPIGOT * unit, _LEAST_SPIGOT), _MOST_SPIGOT)


def output_seal(carrier: CarrierLayout, cover_top: float, unit: float) -> GapSeal:
    """Between the nut, below its slots, and the cover, whose lip reaches in to it.

    Parameters
    ----------
    cover_top : float
        Height of the lip's upper face, m.
    """
    bottom = carrier.output_seat_top + _beside_ring(unit)
    inner, free = carrier.output.shoulder_radius, carrier.output.lip_radius
    facing = min(cover_top, carrier.nut_slots_bottom) - bottom
    return _seal(inner, free, bottom, cover_top, facing)


def shaft_seal(support: ChosenBearing, bottom: float, seat_bottom: float, unit: float) -> GapSeal:
    """Between the shaft and the floor below its lower bearing.

    Parameters
    ----------
    bottom, seat_bottom : float
        Heights of the floor's underside and of the face under the bearing, m.
    """
    top = seat_bottom - _beside_ring(unit)
    inner = 0.5 * support.bearing.bore_diameter
    return _seal(inner, support.lip_radius, bottom, top, top - bottom)


def _beside_ring(unit: float) -> float:
    return _BESIDE_RING * max(unit, 1e-3)


def _seal(inner: float, free: float, bottom: float, top: float, length: float) -> GapSeal:
    """A seal in a lip whose bore need not be wider than a radius (m)."""
    gap = next(gap for most, gap in _GAPS if 2.0 * inner <= most)
    return GapSeal(inner, min(inner + gap, free), bottom, top, length)
