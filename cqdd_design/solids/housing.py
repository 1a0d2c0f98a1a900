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

from collections.abc import Sequence
from itertools import pairwise

from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.removal import drillings
from cqdd_design.solids.layers import Annulus, Stack, turned
from cqdd_design.solids.layout import Layout


def housing_body(layout: Layout, features: Sequence[Feature]) -> Stack:
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
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))


def ring_clamp(layout: Layout, features: Sequence[Feature]) -> Stack:
    """The plate between flange and cover that clamps the ring and carries the output bearing."""
    housing, pack = layout.housing, layout.pack
    bottom, top = pack.top, layout.carrier.bearing_bottom
    relief = bottom + pack.relief
    rings = [
        Annulus(bottom, relief, max(pack.ledge_radius, housing.clamp_inner), housing.flange_radius),
        Annulus(relief, top, housing.clamp_inner, housing.flange_radius),
    ]
    return turned(rings, drillings(features))


def output_cover(layout: Layout, features: Sequence[Feature]) -> Stack:
    """The cover: seat of the output bearing, open below, and a lip that holds its outer ring."""
    housing, carrier = layout.housing, layout.carrier
    seat = 0.5 * carrier.output.bearing.outer_diameter
    bottom = carrier.bearing_bottom
    flange = housing.cover_flange_top
    top = carrier.output_seat_top
    levels = sorted({bottom, flange, top, max(housing.cover_top, flange)})
    rings = []
    for low, high in pairwise(levels):
        middle = 0.5 * (low + high)
        outside = housing.flange_radius if middle < flange else housing.cover_hub_radius
        inside = seat if middle < top else carrier.output.lip_radius
        rings.append(Annulus(low, high, inside, outside))
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))
