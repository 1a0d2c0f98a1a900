"""Shapes of the rotating group: eccentric shaft, loose cam, bearings, sleeves.

Each is drawn in the frame of the body it belongs to, at crank angle 0, with heights as in
`layout`.
"""

from __future__ import annotations

from cqdd_design.geometry.contours import PlanarPart
from cqdd_design.solids.features.rotating import crank_offset
from cqdd_design.solids.layers import (
    Annulus,
    Layer,
    Stack,
    circle,
    cylinder,
    pierced,
    prism,
    turned,
)
from cqdd_design.solids.layout import PackLayout, ShaftLayout
from cqdd_design.solids.selection import RING_SHARE, ChosenBearing

_BAND_SHARE = 0.8
"""Width of balls and cage as a share of a bearing's width, for its envelope."""


def eccentric_shaft(pack: PackLayout, shaft: ShaftLayout) -> Stack:
    """The shaft: stub for the rotor, journals, lobes, and a collar between neighbouring lobes.

    The lobe of a third disc is a loose cam: its bearing, in the middle of the stack or beside it,
    could not pass over two lobes of other phases.
    """
    journal = 0.5 * shaft.support.bearing.bore_diameter
    lobes = min(pack.disc_count, 2)
    layers = [cylinder(journal, shaft.bottom, shaft.lower_seat_top)]
    level = shaft.lower_seat_top
    for disc in range(lobes):
        radius = shaft.web_radius if disc else shaft.shoulder_radius
        layers.append(cylinder(radius, level, pack.cam_bottom(disc)))
        layers.append(_lobe(pack, disc))
        level = pack.cam_top(disc)
    layers.append(cylinder(shaft.shoulder_radius, level, shaft.upper_seat_bottom))
    layers.append(cylinder(journal, shaft.upper_seat_bottom, shaft.top))
    return _bored(layers, shaft.bore_radius)


def loose_cam(pack: PackLayout, shaft: ShaftLayout) -> Stack:
    """The cam of the third disc, pressed on the shaft, with the collar below it in one piece."""
    collar = cylinder(shaft.web_radius, pack.cam_top(1), pack.cam_bottom(2))
    return _bored([collar, _lobe(pack, 2)], shaft.shoulder_radius)


def _lobe(pack: PackLayout, disc: int) -> Layer:
    radius = 0.5 * pack.cam.bearing.bore_diameter
    return cylinder(radius, pack.cam_bottom(disc), pack.cam_top(disc), crank_offset(pack, disc))


def _bored(layers: list[Layer], radius: float) -> Stack:
    solid = [layer for layer in layers if layer.height > 1e-9]
    if radius <= 0.0:
        return Stack(tuple(solid))
    return Stack(tuple(pierced(layer, [circle(radius)]) for layer in solid))


def bearing_envelope(chosen: ChosenBearing) -> Stack:
    """A bearing from its catalogue sizes, standing on z = 0.

    Bearings with rings have both rings at full width and a narrower band for rolling elements
    and cage, so that parts which touch one ring are clear of the other. Drawn cups, cages and
    bushes are plain rings.
    """
    row = chosen.bearing
    inner, outer = 0.5 * row.bore_diameter, 0.5 * row.outer_diameter
    if chosen.source == "bush" or row.kind in ("needle", "needle cage"):
        return turned([Annulus(0.0, row.width, inner, outer)])
    ring = RING_SHARE * chosen.section
    recess = 0.5 * (1.0 - _BAND_SHARE) * row.width
    return turned(
        [
            Annulus(0.0, row.width, inner, inner + ring),
            Annulus(recess, row.width - recess, inner + ring, outer - ring),
            Annulus(0.0, row.width, outer - ring, outer),
        ]
    )


def sleeve(inner_diameter: float, outer_diameter: float, length: float) -> Stack:
    """A roller sleeve on an output pin, standing on z = 0."""
    return turned([Annulus(0.0, length, 0.5 * inner_diameter, 0.5 * outer_diameter)])


def plain_pin(diameter: float, bottom: float, top: float) -> Stack:
    """A ground pin on the z axis."""
    return prism(PlanarPart("pin", circle(0.5 * diameter)), bottom, top)
