"""The flat parts a wire-EDM shop cuts from a design, and how many of each.

Discs that are one part, perhaps some of them turned over, need one program (`solids.clocking`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog.printing import printed_materials
from cqdd_design.errors import DesignError
from cqdd_design.exporting.edm.exact_curves import disc_curve, grooved_curve, ring_curve
from cqdd_design.exporting.edm.loops import ExactCurve
from cqdd_design.exporting.edm.seats import Seat, seat
from cqdd_design.geometry.contours import ArcContour, Contour, PlanarPart
from cqdd_design.geometry.disc import disc_contour
from cqdd_design.geometry.grooves import grooved_circle
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.geometry.ring import pocket_radius, ring_contour
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.solids.clocking import DiscGroup, disc_groups
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.housing import SEAM_POSITION

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.machine import Machine
    from cqdd_design.solids.layout import DowelLayout


@dataclass(frozen=True, eq=False)
class FlatPart:
    """One program: a flat part as it is cut, with the exact curve of its one fitted contour.

    Attributes
    ----------
    label : str
        Ends the file name: ``disc``, ``disc-2``, ``ring``.
    shape : PlanarPart
        Contours as they are written, m. One of them, the fitted one, stands for a curve; the rest
        are circles, but for the outside of a ring with grooves.
    exact : ExactCurve
        What the fitted contour stands for.
    thickness : float
        m.
    material : str
        Catalogue name.
    quantity : int
        How many to cut.
    reference_radius : float
        Circle drawn for reference, m: through the output holes, or through the teeth.
    remarks : tuple of str
        What the shop must know of this part.
    quiet_angle : float
        Polar angle of a place of the fitted contour that carries least, rad: a valley of the disc,
        between two teeth of the ring.
    turned_over : int
        How many of them are put in turned over.
    seat_zones : tuple of (int, float, str)
        Contour, diameter (m) and zone of every seat (see `seats`).
    outside : ExactCurve or None
        The outer contour, where it is not the fitted one and no circle.
    quiet_outside : float
        Polar angle of a place of that contour away from its grooves, rad.
    """

    label: str
    shape: PlanarPart
    exact: ExactCurve
    thickness: float
    material: str
    quantity: int
    reference_radius: float
    remarks: tuple[str, ...]
    quiet_angle: float = 0.0
    turned_over: int = 0
    seat_zones: tuple[tuple[int, float, str], ...] = ()
    outside: ExactCurve | None = None
    quiet_outside: float = 0.0

    @property
    def contours(self) -> tuple[Contour, ...]:
        """By number: 0 is the outer one, then the inner ones."""
        return (self.shape.outer, *self.shape.holes)

    @property
    def cut_order(self) -> tuple[int, ...]:
        """Numbers of the contours: the outer one last, so that the part stays in the plate."""
        return (*range(1, len(self.contours)), 0)

    @property
    def fitted(self) -> ArcContour:
        """The contour that stands for a curve."""
        arcs = (one for one in self.contours if isinstance(one, ArcContour))
        return next(one for one in arcs if self.outside is None or one is not self.shape.outer)

    def exact_of(self, contour: Contour) -> ExactCurve:
        """What a contour that is no circle stands for."""
        if self.outside is not None and contour is self.shape.outer:
            return self.outside
        return self.exact

    def quiet_at(self, contour: Contour) -> float:
        """Polar angle at which the tab of a contour that is no circle lies, rad."""
        return self.quiet_angle if contour is self.fitted else self.quiet_outside


def flat_parts(machine: Machine) -> tuple[FlatPart, ...]:
    """Every flat part of a machine that is cut by wire, discs first.

    Raises
    ------
    GeometryError
        When a part cannot have its shape.
    """
    design = machine.design
    validate_geometry(design, bore_diameter=machine.cam.outer_diameter)
    groups = disc_groups(design)
    discs = tuple(_disc(machine, group, alone=len(groups) == 1) for group in groups)
    return (*discs, _ring(machine))


def pin_diameter(design: Design) -> float:
    """Mean diameter of the output pins as made, m."""
    return mean_pin_diameter(design.reducer.output_pins)


def reach_of(contour: Contour) -> float:
    """Farthest the contour comes from the origin, m, to 10 um."""
    return float(np.hypot(*contour.sample(1e-5).T).max())


def disc_shape(machine: Machine, disc_index: int) -> PlanarPart:
    """Return a disc in its own lobes' frame."""
    return disc_contour(machine.design, disc_index, bore_diameter=machine.cam.outer_diameter)


def _disc(machine: Machine, group: DiscGroup, *, alone: bool) -> FlatPart:
    reducer = machine.design.reducer
    drawn = group.placements[0].disc
    return FlatPart(
        label="disc" if alone else f"disc-{drawn + 1}",
        shape=disc_shape(machine, drawn),
        exact=disc_curve(machine.design),
        thickness=reducer.disc_thickness,
        material=reducer.disc_material,
        quantity=len(group.placements),
        reference_radius=reducer.output_pins.circle_radius,
        remarks=_disc_remarks(group, reducer.disc_count),
        turned_over=sum(placed.turned_over for placed in group.placements),
        seat_zones=((1, machine.cam.outer_diameter, zones.DISC_BORE),),
    )


def _disc_remarks(group: DiscGroup, discs: int) -> tuple[str, ...]:
    def named(turned_over: bool) -> str:
        numbers = [str(p.disc + 1) for p in group.placements if p.turned_over == turned_over]
        return ("DISC " if len(numbers) == 1 else "DISCS ") + ", ".join(numbers)

    flipped = sum(placed.turned_over for placed in group.placements)
    if flipped == 0:
        return (f"{named(False)} OF {discs}, AS DRAWN",)
    return (
        f"CUT {len(group.placements)}, FLIP {flipped}: {named(False)} AS DRAWN, {named(True)} "
        "TURNED OVER ABOUT THE X AXIS",
        "MARK THE UPPER FACE OF EACH DISC",
    )


def _ring(machine: Machine) -> FlatPart:
    design = machine.design
    reducer = design.reducer
    pieces = "ROLLERS" if reducer.ring.roller_diameter else "PINS"
    kinds = {
        "solid": "TEETH ARE PART OF THE RING",
        "conjugate": "TEETH ARE PART OF THE RING",
        "pinwheel": f"POCKETS FOR {reducer.ring_tooth_count} {pieces} OF DIA "
        f"{1e3 * reducer.tooth_diameter:g}",
    }
    plain = ring_contour(design)
    outside = reducer.ring.outer_diameter
    seats = [(0, outside, zones.RING_OUTSIDE)]
    if reducer.ring_type == "pinwheel" and not reducer.ring.roller_diameter:
        seats.append((1, 2.0 * pocket_radius(design), zones.RING_PIN_SEAT))
    flat = FlatPart(
        label="ring",
        shape=plain,
        exact=ring_curve(design),
        thickness=reducer.pack_length,
        material=reducer.ring_material,
        quantity=1,
        reference_radius=reducer.ring_pitch_radius,
        remarks=(f"{reducer.ring_tooth_count} TEETH; {kinds[reducer.ring_type]}",),
        quiet_angle=math.pi / reducer.ring_tooth_count,
        seat_zones=tuple(seats),
    )
    try:
        dowels = machine.layout.dowels
    except DesignError:
        # No machine fits around this ring; it can still be cut and quoted.
        return flat
    return _grooved(flat, dowels, 0.5 * outside) if dowels.radius > 0.0 else flat


def seats_of(flat: FlatPart) -> tuple[Seat, ...]:
    """Seats of a flat part, those whose size the table of its zone knows."""
    found = (seat(contour, diameter, zone) for contour, diameter, zone in flat.seat_zones)
    return tuple(one for one in found if one is not None)


def _grooved(flat: FlatPart, dowels: DowelLayout, radius: float) -> FlatPart:
    """The ring with the half grooves of its dowels.

    They are drawn so large that the wire, shifted for the outside, cuts them to the middle of
    their own zone. What no wire cuts has them at their nominal size, as it has its outside.
    """
    angles, size = dowels.angles, 2.0 * dowels.radius
    outside, groove = seat(0, 2.0 * radius, zones.RING_OUTSIDE), seat(1, size, zones.SEAM_GROOVE)
    finished, drawn = size, dowels.radius
    wire = flat.material not in printed_materials()
    if wire:
        finished = size if groove is None else groove.middle
        drawn = 0.5 * finished + (0.0 if outside is None else outside.shift)
    shape = PlanarPart(flat.shape.name, grooved_circle(radius, angles, drawn), flat.shape.holes)
    places = ", ".join(f"{math.degrees(angle):.4f}".rstrip("0").rstrip(".") for angle in angles)
    told = (
        f"{len(angles)} HALF GROOVES DIA {1e3 * size:g} {zones.SEAM_GROOVE} FOR DOWELS, CENTRES ON "
        f"THE OUTSIDE AT {places} DEG, EACH WITHIN DIA {1e3 * SEAM_POSITION:g} OF ITS PLACE"
    )
    if wire:
        told += f", DRAWN DIA {2e3 * drawn:.4f}"
    if wire and outside is not None:
        told += f": THE SHIFT OF THE OUTSIDE CUTS THEM TO DIA {1e3 * finished:.4f}"
    return replace(
        flat,
        shape=shape,
        outside=grooved_curve(radius, angles, drawn),
        quiet_outside=0.5 * (angles[0] + angles[1]),
        remarks=(*flat.remarks, told),
    )
