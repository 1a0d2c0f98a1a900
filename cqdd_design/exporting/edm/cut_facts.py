"""What a shop must know of a flat part, once for its sheet and for the README: one value.

Zones follow from the standard deviations of the design's [tolerances], as those of the features.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog import find_material
from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.printing import made_how
from cqdd_design.exporting.edm.dxf import contour_fit
from cqdd_design.exporting.edm.flat_parts import seats_of
from cqdd_design.exporting.edm.loops import LoopFit
from cqdd_design.exporting.edm.passes import WirePass, blank_side, contour_times, wire_passes
from cqdd_design.exporting.edm.seats import Seat
from cqdd_design.exporting.edm.wire_path import WirePath, wire_paths
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.solids.features.flat import cut_zone, thickness_limits, tooth_deviation
from cqdd_design.solids.features.housing import RING_CORNER
from cqdd_design.solids.features.making import BEARING_FACE

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.exporting.edm.flat_parts import FlatPart
    from cqdd_design.machine import Machine

GROUND_FLATNESS = 5e-6
"""Faces of a plate from an everyday surface grinder, m."""
GROUND_PARALLELISM = 10e-6
"""Both faces of a plate from an everyday surface grinder, m."""
_RING_EDGE = "0.3 to 0.5"
"""mm: above the corner of its seat, and what leads it into an interference fit."""
_WALL_SQUARENESS = 5e-6
"""Of the cut walls to the lower face, m: what is left of taper after skim cuts."""
CUT_FINISH, FACE_FINISH = "Ra 0.4", "Ra 0.8"
"""After skim cuts, and ground, um."""

_MM = 1e3


@dataclass(frozen=True)
class Zones:
    """Geometric tolerances of a part, m.

    Attributes
    ----------
    profile : float
        Width of the zone about the exact curve, half to either side.
    hole_position : float
        Diameter of the zone about the place of each hole beside the bore.
    hole_diameter : float
        To either side of nominal.
    """

    profile: float
    hole_position: float
    hole_diameter: float


def said(remarks: Iterable[str]) -> tuple[str, ...]:
    """Remarks, which are in capitals, as running text; axes and zones of holes keep theirs.

    DIA before a size becomes its sign.

    Examples
    --------
    >>> said(["TURNED OVER ABOUT THE X AXIS", "HALF GROOVES DIA 1.5 D8"])
    ('turned over about the X axis', 'half grooves \u00d81.5 D8')
    """
    return tuple(
        re.sub(
            r"\b[dh]\d+\b|\bx(?= axis)",
            lambda found: found[0].upper(),
            re.sub(r"\bdia (?=\d)", "\u00d8", one.lower()),
        )
        for one in remarks
    )


@dataclass(frozen=True, eq=False)
class CutFacts:
    """A flat part and everything that is said about it.

    Attributes
    ----------
    fit : LoopFit
        Of its fitted contour, measured.
    paths : tuple of WirePath
        One a contour, the outer one first.
    passes : tuple of WirePass
        Along every contour, the rough cut first.
    seats : tuple of Seat
        Contours with an ISO 286 zone.
    fitting : tuple of str
        Sentences on edges, marks and what is pressed in.
    """

    flat: FlatPart
    design: Design
    fit: LoopFit
    paths: tuple[WirePath, ...]
    passes: tuple[WirePass, ...]
    zones: Zones
    seats: tuple[Seat, ...]
    fitting: tuple[str, ...]

    @property
    def mass(self) -> float:
        """Of one piece as cut, kg: the area of its contours times thickness and density."""
        area = self.flat.shape.area()
        return area * self.flat.thickness * find_material(self.flat.material).density

    @property
    def times(self) -> tuple[float, ...]:
        """Estimate for every contour of one piece, the outer one first, s."""
        return contour_times(self.flat, len(self.passes))

    @property
    def blank(self) -> float:
        """Side of the square blank, m."""
        return blank_side(self.paths[0])

    @property
    def hardness(self) -> str:
        """As a drawing asks for it."""
        return find_material(self.flat.material).drawn_hardness

    @property
    def heat_treatment(self) -> str:
        """As the catalogue has it for drawings."""
        return find_material(self.flat.material).drawing_note or "as delivered"

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks of the part as sentences."""
        return tuple(f"{one[0].upper()}{one[1:]}." for one in said(self.flat.remarks))

    @property
    def seat_by_contour(self) -> dict[int, Seat]:
        """Seats by the number of their contour."""
        return {seat.contour: seat for seat in self.seats}

    @property
    def pockets(self) -> Seat | None:
        """The seats of pins that the fitted contour of a ring is made of, if it is."""
        fitted = self.flat.fitted
        number = next(i for i, one in enumerate(self.flat.contours) if one is fitted)
        return None if number == 0 else self.seat_by_contour.get(number)

    @property
    def profile_text(self) -> str:
        """The zone of the contour, about where the wire puts it."""
        told = f"zone {zone_text(self.zones.profile)} mm wide, half to either side of the contour"
        if self.pockets is None or self.moulded:
            return told
        return f"{told} as it is shifted for its pockets, \u00d8{_MM * self.pockets.middle:.4f}"

    @property
    def moulded(self) -> str:
        """How it is printed or moulded; empty of what a wire cuts."""
        return made_how(self.flat.material, "")

    @property
    def squareness(self) -> float:
        """Of the walls to the lower face, m; of a plastic no less than the zone of its contour."""
        return self.zones.profile if self.moulded else _WALL_SQUARENESS

    @property
    def thickness_text(self) -> str:
        """Limits of the thickness behind it, as ``+0/-0.02`` or ``±0.13``."""
        lower, upper = thickness_limits(self.flat.material, self.flat.thickness)
        if upper == -lower:
            return f"\u00b1{zone_text(upper)}"
        return f"+{zone_text(upper)}/-{zone_text(-lower)}"

    @property
    def quantity_text(self) -> str:
        """Such as ``2, 1 turned over``."""
        over = self.flat.turned_over
        return f"{self.flat.quantity}" + (f", {over} turned over" if over else "")

    @property
    def fit_text(self) -> tuple[str, ...]:
        """What was measured of the contour as written."""
        fit = self.fit
        return (
            f"{fit.segments} arcs; largest deviation from the exact curve "
            f"{1e6 * fit.largest_deviation:.3f} \u00b5m, rms {1e6 * fit.rms_deviation:.3f} \u00b5m",
            f"perimeter {_MM * fit.perimeter:.4f} mm, area {_MM**2 * fit.area:.4f} mm\u00b2, "
            f"least concave radius {_MM * fit.least_concave_radius:.4f} mm",
        )


def facts_of(flat: FlatPart, machine: Machine, options: ExportOptions = DEFAULTS) -> CutFacts:
    """Gather everything about a part.

    Raises
    ------
    GeometryError
        When a contour is too small for a start hole.
    ReadBackError
        When the wire is too thick for a contour.
    """
    # As it was written, so that sheets carry the hash that every other output has.
    design = machine.given
    return CutFacts(
        flat=flat,
        design=design,
        fit=contour_fit(flat),
        paths=wire_paths(flat, design.edm, options.tab_length),
        passes=wire_passes(flat.contours, design.edm, options.passes),
        zones=zones_of(flat, design),
        seats=seats_of(flat),
        fitting=tuple(_fitting(flat, machine)),
    )


def _fitting(flat: FlatPart, machine: Machine) -> Iterator[str]:
    """Sentences on what the next who takes the part in hand has to know of it."""
    if flat.label == "ring":
        first = "" if made_how(flat.material, "") else " before the teeth are cut"
        yield (
            f"Outer edges of both faces broken {_RING_EDGE} mm at 45\u00b0{first}: the corner of "
            f"its seat has a radius of {_MM * RING_CORNER:g} mm."
        )
        return
    reducer = machine.design.reducer
    below = 0.5 * (reducer.disc_thickness - find_bearing(reducer.cam_bearing.designation).width)
    yield (
        f"The cam bearing is pressed in to the middle of the thickness, {_MM * below:.2f} "
        f"\u00b1{_MM * BEARING_FACE:g} mm below either face."
    )
    if flat.label != "disc":
        yield (
            f"Engrave '{flat.label.replace('-', ' ')}' on the upper face: discs of this design "
            "differ in nothing but in where their holes stand."
        )


def zones_of(flat: FlatPart, design: Design) -> Zones:
    """Zones of a part from the design's standard deviations."""
    tolerances = design.tolerances
    profile = tolerances.disc_profile
    if flat.label == "ring":
        profile = tooth_deviation(tolerances)
    return Zones(
        profile=cut_zone(tolerances, profile),
        hole_position=cut_zone(tolerances, tolerances.hole_position),
        hole_diameter=0.5 * cut_zone(tolerances, tolerances.hole_diameter),
    )


def zone_text(value: float) -> str:
    """A width of a zone in mm, to 0.1 um.

    Examples
    --------
    >>> zone_text(4e-6)
    '0.004'
    """
    return f"{_MM * value:.4f}".rstrip("0").rstrip(".") or "0"
