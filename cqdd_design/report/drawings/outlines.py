"""The shapes that drawings and animation share, computed once from the exact geometry."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.screws import column_screw
from cqdd_design.design import Design
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.columns import column_offsets
from cqdd_design.geometry.contours import Circle, PlanarPart
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import disc_contour
from cqdd_design.geometry.ring import ring_contour, ring_pins
from cqdd_design.report.ink.svg import View, circle, contour_shape, part_shape

DRAWING_TOLERANCE = 2e-6
"""Distance of a drawn outline from the exact one, m: a hundredth of a px at the largest scale."""


@dataclass(frozen=True)
class Outlines:
    """Contours and sizes of a gearbox, in m.

    Attributes
    ----------
    stages : Stages
        Its sizes as the rigid law reads them, fits included.
    profile : CycloidDisc
        The disc's lobed outline.
    ring : PlanarPart
        In the fixed frame, a tooth on +x.
    ring_pins : tuple of Circle
        The separate pins of a pinwheel ring, else empty.
    discs : tuple of PlanarPart
        Each in the frame of its own lobes.
    bearing : Bearing
        The cam bearing, "auto" resolved.
    """

    design: Design
    stages: Stages
    profile: CycloidDisc
    ring: PlanarPart
    ring_pins: tuple[Circle, ...]
    discs: tuple[PlanarPart, ...]
    bearing: Bearing

    @classmethod
    def from_design(cls, design: Design, bearing: Bearing) -> Outlines:
        """Contours of a design whose cam bearing is `bearing`."""
        discs = tuple(
            disc_contour(
                design,
                index,
                bore_diameter=bearing.outer_diameter,
                tolerance=DRAWING_TOLERANCE,
            )
            for index in range(design.reducer.disc_count)
        )
        return cls(
            design,
            Stages.from_design(design),
            CycloidDisc.from_design(design),
            ring_contour(design, DRAWING_TOLERANCE),
            ring_pins(design),
            discs,
            bearing,
        )

    def disc_pose(self, disc: int, crank_angle: float) -> tuple[float, tuple[float, float]]:
        """Turn of a disc's lobes (rad) and its centre (m) in the fixed frame."""
        phase = float(self.stages.phases[disc])
        turn = kinematics.lobe_pattern_rotation(self.stages.lobe_count, crank_angle, phase)
        x, y = kinematics.disc_centre(self.stages.eccentricity, crank_angle, phase).tolist()
        return float(turn), (x, y)

    def posed_disc(self, disc: int, crank_angle: float) -> PlanarPart:
        """A disc in the fixed frame at a crank angle (rad)."""
        return self.discs[disc].transformed(*self.disc_pose(disc, crank_angle))

    def pin_angles(self, crank_angle: float) -> list[float]:
        """Angles of the output pins in the fixed frame, rad."""
        angles = kinematics.output_pin_angles(
            self.stages.lobe_count,
            self.stages.pin_count,
            self.stages.hole_clocking,
            [crank_angle],
        )
        return [float(angle) for angle in angles[0]]

    def ring_shapes(self, view: View) -> list[str]:
        """The ring and its separate pins."""
        pins = [contour_shape(pin, view, "ring-pin") for pin in self.ring_pins]
        return [part_shape(self.ring, view, "ring"), *pins]

    def pin_shapes(self, view: View, crank_angle: float) -> list[str]:
        """The output pins, or their sleeves, and the columns between them."""
        radius = view.length(self.stages.pin_contact_radius)
        pins = [
            circle(view.polar(self.stages.pin_circle_radius, angle), radius, "pin")
            for angle in self.pin_angles(crank_angle)
        ]
        return pins + self.column_shapes(view, crank_angle)

    def column_angles(self, crank_angle: float) -> list[float]:
        """Angles of the columns in the fixed frame, rad; none without columns."""
        first = self.pin_angles(crank_angle)[0]
        return [first + float(offset) for offset in column_offsets(self.design.reducer)]

    def column_shapes(self, view: View, crank_angle: float) -> list[str]:
        """The columns over their screws."""
        places = [
            view.polar(self.stages.pin_circle_radius, angle)
            for angle in self.column_angles(crank_angle)
        ]
        if not places:
            return []
        diameter = self.design.reducer.carrier.column_diameter
        sizes = (("column", diameter), ("column-bore", column_screw(diameter).bore))
        return [
            circle(place, view.length(0.5 * size), class_)
            for place in places
            for class_, size in sizes
        ]
