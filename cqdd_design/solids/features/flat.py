"""Features of the parts that wire cuts: discs and ring."""

from __future__ import annotations

import math

from cqdd_design.design import Design
from cqdd_design.geometry.disc import hole_centres, hole_diameter
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import BoltCircle, CutHole
from cqdd_design.solids.features.housing import ring_dowel_holes
from cqdd_design.solids.features.kinds import CutProfile, Feature
from cqdd_design.solids.features.making import seat
from cqdd_design.solids.layout import DowelLayout, PackLayout

SIGMAS = 6.0
"""Diameter of the zone of an axis over the standard deviation of its place."""
THICKNESS_TOLERANCE = 20e-6
"""Of discs and ring below nominal, m: they must not grow into the gaps beside them."""


def disc_features(design: Design, pack: PackLayout, disc: int) -> tuple[Feature, ...]:
    """Of a disc: bore, holes of the output pins, lobes, all of one setting of the wire."""
    top, tolerances = pack.disc_thickness, design.tolerances
    bore = seat(
        "bore for the cam bearing", pack.cam.bearing.outer_diameter, 0.0, top, zones.DISC_BORE,
        inside=True, datum="A",
    )  # fmt: skip
    centres = [complex(x, y) for x, y in hole_centres(design, disc).tolist()]
    angles = tuple(math.atan2(one.imag, one.real) for one in centres)
    circle = BoltCircle("output pins", design.reducer.output_pins.circle_radius, angles)
    return (
        bore,
        CutHole("holes of the output pins", hole_diameter(design), 0.0, top, circle,
                position=SIGMAS * tolerances.hole_position, datum="C", refers="A"),
        CutProfile("lobes", 0.0, top, zone=SIGMAS * tolerances.disc_profile, refers="AC"),
    )  # fmt: skip


def ring_features(design: Design, pack: PackLayout, dowels: DowelLayout) -> tuple[Feature, ...]:
    """Of the ring: outside, teeth, and its halves of the dowels' holes."""
    tolerances = design.tolerances
    outside = seat("outside", 2.0 * pack.ring_radius, 0.0, pack.top, zones.RING_OUTSIDE, datum="A")
    zone = SIGMAS * max(tolerances.tooth_position, tolerances.tooth_radius)
    return (
        outside,
        CutProfile("teeth", 0.0, pack.top, zone=zone, refers="A"),
        *ring_dowel_holes(pack, dowels, 0.0, pack.top, refers="A"),
    )
