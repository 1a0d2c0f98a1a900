"""The flat parts a wire-EDM shop cuts from a design, and how many of each.

Discs that are one part, perhaps some of them turned over, need one program (`solids.clocking`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.edm.exact_curves import disc_curve, ring_curve
from cqdd_design.exporting.edm.loops import ExactCurve
from cqdd_design.geometry.contours import ArcContour, Contour, PlanarPart
from cqdd_design.geometry.disc import disc_contour
from cqdd_design.geometry.ring import ring_contour
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.solids.clocking import DiscGroup, disc_groups
from cqdd_design.solids.selection import output_pin

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.machine import Machine


@dataclass(frozen=True, eq=False)
class FlatPart:
    """One program: a flat part as it is cut, with the exact curve of its one fitted contour.

    Attributes
    ----------
    label : str
        Ends the file name: ``disc``, ``disc-2``, ``ring``.
    shape : PlanarPart
        Contours as they are written, m. One of them is an `ArcContour`, the rest are circles.
    exact : ExactCurve
        What the `ArcContour` stands for.
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
        """The one contour that is no circle."""
        return next(one for one in self.contours if isinstance(one, ArcContour))


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
    return (*discs, _ring(design))


def pin_diameter(design: Design) -> float:
    """Mean diameter of the output pins as made, m."""
    return output_pin(design.reducer.output_pins.diameter).mean_diameter


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


def _ring(design: Design) -> FlatPart:
    reducer = design.reducer
    pieces = "ROLLERS" if reducer.ring.roller_diameter else "PINS"
    kinds = {
        "solid": "TEETH ARE PART OF THE RING",
        "conjugate": "TEETH ARE PART OF THE RING",
        "pinwheel": f"POCKETS FOR {reducer.ring_tooth_count} {pieces} OF DIA "
        f"{1e3 * reducer.tooth_diameter:g}",
    }
    return FlatPart(
        label="ring",
        shape=ring_contour(design),
        exact=ring_curve(design),
        thickness=reducer.pack_length,
        material=reducer.ring_material,
        quantity=1,
        reference_radius=reducer.ring_pitch_radius,
        remarks=(f"{reducer.ring_tooth_count} TEETH; {kinds[reducer.ring_type]}",),
        quiet_angle=math.pi / reducer.ring_tooth_count,
    )
