"""Shapes of the housing: tube with floor and flange, ring clamp, output cover.

The tube takes the ring from the output side; the clamp, held by the cover's screws, presses it on
a ledge and carries the output bearing::

        ___  _______________
       |   ||  cover        |__ lip
       |___||___[ bearing ]
       |__ ring clamp ___|          relieved over the discs
       |   |     ring    |
       |___|             |
        | |______________|          ledge, clear of the orbiting lobes
        | |
        | |__   __                  floor with the seat of the shaft's lower bearing
        |____|_|  |_ _ _ axis
"""

from __future__ import annotations

import math
from itertools import pairwise

from cqdd_design.solids.layers import Annulus, Drilling, Stack, on_circle, turned
from cqdd_design.solids.layout import HeldPins, HousingLayout, Layout

_CLEARANCE_SHARE = 1.1
"""Clearance hole over thread, the medium series of ISO 273 to a tenth of a millimetre."""


def _clearance_radius(thread: float) -> float:
    return 0.5 * round(_CLEARANCE_SHARE * thread, 4)


def _screw_angles(housing: HousingLayout) -> tuple[float, float]:
    """Angles of the first cover screw and of the first mounting hole, rad."""
    return 0.0, math.pi / housing.screw_count


def _flange_drillings(
    housing: HousingLayout, bottom: float, top: float, screw_radius: float
) -> list[Drilling]:
    """Screw holes of this radius, and mounting holes, through a part of the flange."""
    screw_at, mount_at = _screw_angles(housing)
    count, radius = housing.screw_count, housing.bolt_circle_radius
    mount = _clearance_radius(housing.mount_thread)
    return [
        Drilling(on_circle(count, radius, screw_at), screw_radius, bottom, top),
        Drilling(on_circle(count, radius, mount_at), mount, bottom, top),
    ]


def housing_body(layout: Layout) -> Stack:
    """The tube: stator register outside, ring seat inside, flange at the output end, floor."""
    housing, pack = layout.housing, layout.pack
    support = layout.shaft.support
    seat_top = layout.shaft.lower_seat_top
    seat_bottom = seat_top - support.bearing.width
    flange = housing.flange_bottom
    levels = sorted(
        {
            *(housing.bottom, housing.floor_top, seat_bottom, seat_top),
            *((-pack.relief,) if pack.held_pins is not None else ()),
            *(0.0, flange, pack.top),
        }
    )
    rings = []
    for bottom, top in pairwise(levels):
        middle = 0.5 * (bottom + top)
        outside = housing.flange_radius if middle > flange else housing.register_radius
        seat = 0.5 * support.bearing.outer_diameter
        bore = seat if middle > seat_bottom else support.lip_radius
        if middle < housing.floor_top:
            rings.append(Annulus(bottom, top, bore, outside))
            continue
        cavity = pack.ring_radius if middle > 0.0 else pack.ledge_radius
        if pack.held_pins is not None and middle < -pack.relief:
            cavity = pack.inner_radius
        rings.append(Annulus(bottom, top, cavity, outside))
        if middle < seat_top:
            rings.append(Annulus(bottom, top, bore, housing.boss_radius))
    holes = [
        *_flange_drillings(housing, flange, pack.top, 0.5 * housing.screw.thread),
        *_pin_seats(pack.held_pins, -pack.relief, downward=True),
    ]
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], holes)


def ring_clamp(layout: Layout) -> Stack:
    """The plate between flange and cover that clamps the ring and carries the output bearing."""
    housing, pack = layout.housing, layout.pack
    bottom, top = pack.top, layout.carrier.bearing_bottom
    relief = bottom + pack.relief
    rings = [
        Annulus(bottom, relief, max(pack.ledge_radius, housing.clamp_inner), housing.flange_radius),
        Annulus(relief, top, housing.clamp_inner, housing.flange_radius),
    ]
    clearance = _clearance_radius(housing.screw.thread)
    holes = [
        *_flange_drillings(housing, bottom, top, clearance),
        *_pin_seats(pack.held_pins, relief, downward=False),
    ]
    return turned(rings, holes)


def _pin_seats(pins: HeldPins | None, mouth: float, *, downward: bool) -> list[Drilling]:
    """Seats of the ends of ring pins that rollers leave free along the discs."""
    if pins is None:
        return []
    bottom, top = (mouth - pins.depth, mouth) if downward else (mouth, mouth + pins.depth)
    centres = on_circle(pins.count, pins.circle_radius, 0.0)
    return [Drilling(centres, 0.5 * pins.diameter, bottom, top)]


def output_cover(layout: Layout) -> Stack:
    """The cover: seat of the output bearing, open below, and a lip that holds its outer ring."""
    housing, carrier = layout.housing, layout.carrier
    seat = 0.5 * carrier.output.bearing.outer_diameter
    bottom = carrier.bearing_bottom
    flange = housing.cover_flange_top
    levels = sorted({bottom, flange, carrier.bearing_top, max(housing.cover_top, flange)})
    rings = []
    for low, high in pairwise(levels):
        middle = 0.5 * (low + high)
        outside = housing.flange_radius if middle < flange else housing.cover_hub_radius
        inside = seat if middle < carrier.bearing_top else carrier.output.lip_radius
        rings.append(Annulus(low, high, inside, outside))
    clearance = _clearance_radius(housing.screw.thread)
    holes = _flange_drillings(housing, bottom, flange, clearance)
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], holes)
