"""Features of the parts that wire cuts: discs and ring."""

from __future__ import annotations

import math

from cqdd_design.catalog.fits import general_tolerance
from cqdd_design.catalog.printing import printed_materials
from cqdd_design.design import Design
from cqdd_design.design.actuator import Tolerances
from cqdd_design.geometry.disc import hole_centres, hole_diameter
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import BoltCircle, CutHole
from cqdd_design.solids.features.housing import ring_dowel_holes
from cqdd_design.solids.features.kinds import CutProfile, Feature
from cqdd_design.solids.features.making import seat
from cqdd_design.solids.layout import DowelLayout, PackLayout

SIGMAS = 6.0
"""Diameter of the zone of an axis over the standard deviation of its place."""
_NORMAL_HALF, _EVEN_HALF = 2.0, math.sqrt(3.0)
"""Standard deviations to either side that a zone of what wire cuts holds."""
THICKNESS_TOLERANCE = 20e-6
"""Of ground discs and rings below nominal, m: they must not grow into the gaps beside them."""


def thickness_limits(material: str, thickness: float) -> tuple[float, float]:
    """Lower and upper deviation of the thickness of a disc or ring, m.

    Plates are ground. Plastics stay as the machine leaves them to either side, or within general
    tolerances where they are moulded.

    Examples
    --------
    >>> thickness_limits("7075-T6", 8e-3)
    (-2e-05, 0.0)
    >>> [round(1e3 * off, 9) for off in thickness_limits("PLA", 8e-3)]
    [-0.13, 0.13]
    """
    plastic = printed_materials().get(material)
    if plastic is None:
        return -THICKNESS_TOLERANCE, 0.0
    off = plastic.accuracy(thickness) or general_tolerance(thickness)
    return -off, off


def cut_zone(tolerances: Tolerances, deviation: float) -> float:
    """Width of the zone of what wire cuts, m, whose error has a standard deviation (m).

    A normal error is held to two of them, an even one to the whole of its zone.
    """
    return 2.0 * deviation * (_NORMAL_HALF if tolerances.distribution == "normal" else _EVEN_HALF)


def tooth_deviation(tolerances: Tolerances) -> float:
    """Standard deviation of the ring's flanks about the exact curve, m: of place and of radius."""
    return math.hypot(tolerances.tooth_position, tolerances.tooth_radius)


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
                position=cut_zone(tolerances, tolerances.hole_position), datum="C", refers="A"),
        CutProfile("lobes", 0.0, top, zone=cut_zone(tolerances, tolerances.disc_profile),
                   refers="AC"),
    )  # fmt: skip


def ring_features(design: Design, pack: PackLayout, dowels: DowelLayout) -> tuple[Feature, ...]:
    """Of the ring: outside, teeth, and its halves of the dowels' holes."""
    tolerances = design.tolerances
    outside = seat("outside", 2.0 * pack.ring_radius, 0.0, pack.top, zones.RING_OUTSIDE, datum="A")
    zone = cut_zone(tolerances, tooth_deviation(tolerances))
    return (
        outside,
        CutProfile("teeth", 0.0, pack.top, zone=zone, refers="A", inside=True),
        *ring_dowel_holes(pack, dowels, 0.0, pack.top, refers="A"),
    )
