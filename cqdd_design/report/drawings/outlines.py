"""The shapes that drawings and animation share, computed once from the exact geometry."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.design import Design
from cqdd_design.gearbox.stages import pin_mean_diameter
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import Circle, PlanarPart
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import disc_contour, hole_diameter
from cqdd_design.geometry.ring import ring_contour, ring_pins

#: Distance of a drawn outline from the exact one, m: a hundredth of a px at the largest scale.
DRAWING_TOLERANCE = 2e-6


@dataclass(frozen=True)
class Machine:
    """Contours and sizes of a gearbox, in m.

    Attributes
    ----------
    design : Design
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
    pin_diameter, hole_diameter : float
        Mean diameter of pin or sleeve as it runs in the hole, and the hole.
    """

    design: Design
    profile: CycloidDisc
    ring: PlanarPart
    ring_pins: tuple[Circle, ...]
    discs: tuple[PlanarPart, ...]
    bearing: Bearing
    pin_diameter: float
    hole_diameter: float

    @classmethod
    def from_design(cls, design: Design, bearing: Bearing) -> Machine:
        """Contours of a design whose cam bearing is `bearing`."""
        pins = design.reducer.output_pins
        mean = pin_mean_diameter(design)
        discs = tuple(
            disc_contour(
                design,
                index,
                bore_diameter=bearing.outer_diameter,
                pin_mean_diameter=mean,
                tolerance=DRAWING_TOLERANCE,
            )
            for index in range(design.reducer.disc_count)
        )
        return cls(
            design=design,
            profile=CycloidDisc.from_design(design),
            ring=ring_contour(design, DRAWING_TOLERANCE),
            ring_pins=ring_pins(design),
            discs=discs,
            bearing=bearing,
            pin_diameter=pins.sleeve_diameter if pins.sleeve_diameter > 0.0 else mean,
            hole_diameter=hole_diameter(design, mean),
        )

    def phase(self, disc: int) -> float:
        """Crank phase of a disc, rad."""
        return float(kinematics.crank_phases(self.design.reducer.disc_count)[disc])

    def posed_disc(self, disc: int, crank_angle: float) -> PlanarPart:
        """A disc in the fixed frame at a crank angle (rad)."""
        turned = crank_angle + self.phase(disc)
        e = self.design.reducer.eccentricity
        return self.discs[disc].transformed(
            float(kinematics.lobe_pattern_rotation(self.design.reducer.ratio, turned)),
            (e * math.cos(turned), e * math.sin(turned)),
        )

    def pin_angles(self, crank_angle: float) -> list[float]:
        """Angles of the output pins in the fixed frame, rad."""
        pins = self.design.reducer.output_pins
        first = -crank_angle / self.design.reducer.ratio + pins.hole_clocking
        return [first + 2.0 * math.pi * j / pins.count for j in range(pins.count)]
