"""Shapes of the housing: tube with floor and flange, ring clamp, output cover.

The tube takes the ring from the output side; the clamp, held by the cover's screws, presses it on
a ledge and carries the output bearing::

        ___  _______________
       |   ||  cover        |_____ lip   about the bearing's nut
       |___||___[ bearing ]
       |__ ring clamp ___|          spigots on both sides; relieved over the discs
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
    seal = housing.shaft_seal
    levels = sorted(
        {
            *(housing.bottom, seal.top, housing.floor_top, seat_bottom, seat_top),
            *((-pack.relief,) if pack.held_pins is not None else ()),
            *(0.0, flange, housing.face),
        }
    )
    rings = []
    for bottom, top in pairwise(levels):
        middle = 0.5 * (bottom + top)
        outside = housing.flange_radius if middle > flange else housing.register_radius
        seat = 0.5 * support.bearing.outer_diameter
        lip = support.lip_radius if middle > seal.top else seal.outer
        bore = seat if middle > seat_bottom else lip
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
    """The plate between flange and cover that clamps the ring and carries the output bearing.

    Its spigots centre it in the housing, and the cover on it. It rests on the housing, and leaves
    the ring its play.
    """
    housing, pack, carrier = layout.housing, layout.pack, layout.carrier
    bottom, top = pack.top + pack.ring_play, carrier.bearing_bottom
    relief = max(pack.top + pack.relief, bottom)
    rings = []
    for low, high in pairwise(sorted({bottom, relief, housing.face, housing.cover_bottom, top})):
        middle = 0.5 * (low + high)
        outside = housing.flange_radius
        if middle < housing.face:
            outside = pack.ring_radius
        elif middle > housing.cover_bottom:
            outside = 0.5 * carrier.output.bearing.outer_diameter
        relieved = max(pack.ledge_radius, housing.clamp_inner)
        rings.append(Annulus(low, high, relieved if middle < relief else housing.clamp_inner,
                             outside))  # fmt: skip
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))


def output_cover(layout: Layout, features: Sequence[Feature]) -> Stack:
    """The cover: seat of the output bearing, open below, and a lip that holds its outer ring.

    Within, the lip reaches in to the bearing's nut.
    """
    housing, carrier = layout.housing, layout.carrier
    seat = 0.5 * carrier.output.bearing.outer_diameter
    bottom, seal = housing.cover_bottom, housing.output_seal
    flange = housing.cover_flange_top
    top = carrier.output_seat_top
    levels = sorted({bottom, flange, top, seal.bottom, seal.top})
    rings = []
    for low, high in pairwise(levels):
        middle = 0.5 * (low + high)
        outside = housing.flange_radius if middle < flange else housing.cover_hub_radius
        lip = carrier.output.lip_radius if middle < seal.bottom else seal.outer
        inside = seat if middle < top else lip
        rings.append(Annulus(low, high, inside, outside))
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))
