"""A made part and everything that its sheet says about it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.exporting.sheets.profile import outside
from cqdd_design.exporting.sheets.wording import holes_by_circle
from cqdd_design.files import file_label
from cqdd_design.geometry.contours import Circle, Contour
from cqdd_design.solids.features.holes import (
    ClearanceHole,
    Counterbore,
    FittedHole,
    Hole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import Chamfer, Joint, Seat
from cqdd_design.solids.layers import Stack, reshaped

if TYPE_CHECKING:
    from collections.abc import Callable

    from cqdd_design.design import Design
    from cqdd_design.geometry.contours import PlanarPart
    from cqdd_design.solids.part import Part

GENERAL_TOLERANCES = "ISO 8015, ISO 2768-mK, sizes in mm"
GENERAL_SURFACE = "turned and drilled Ra 3.2 where not marked"


@dataclass(frozen=True, eq=False)
class PartFacts:
    """A turned part on its sheet."""

    part: Part
    design: Design

    @property
    def number(self) -> str:
        """Of the drawing, and the stem of its files."""
        return f"{self.design.file_name}-{file_label(self.part.name)}"

    @cached_property
    def outside(self) -> float:
        """Farthest from the axis, m."""
        return outside(self.part.shape)

    @cached_property
    def material(self) -> Material:
        """The catalogue's row."""
        return find_material(self.part.material)

    @cached_property
    def holes(self) -> list[list[Hole]]:
        """Holes, those together that share a circle."""
        kinds = TappedHole | ClearanceHole | Counterbore | FittedHole | PlainHole
        return holes_by_circle([f for f in self.part.features if isinstance(f, kinds)])

    @cached_property
    def together(self) -> bool:
        """Whether it has several positions, of circles of holes or of lobes, that hold at once."""
        placed = FittedHole | ClearanceHole | TappedHole | Seat
        return sum(isinstance(f, placed) and f.position > 0.0 for f in self.part.features) > 1

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """What is held on it."""
        return tuple(f for f in self.part.features if isinstance(f, Joint))

    @cached_property
    def broken_edges(self) -> tuple[Chamfer, ...]:
        """Chamfers, and the countersinks of threads."""
        return (
            *(f for f in self.part.features if isinstance(f, Chamfer)),
            *(
                _countersink(f)
                for f in self.part.features
                if isinstance(f, TappedHole)
                if f.countersink
            ),
        )

    @cached_property
    def seen(self) -> Stack:
        """The shape with its broken edges as steps, of which the edges are where they are seen."""
        shape = self.part.shape
        for edge in self.broken_edges:
            shape = _stepped(shape, edge)
        return shape


def _countersink(hole: TappedHole) -> Chamfer:
    return Chamfer(
        f"countersink of {hole.name}",
        0.5 * hole.drill,
        hole.mouth,
        inside=True,
        facing=hole.facing,
        width=0.5 * (hole.countersink - hole.drill),
        centres=hole.circle.centres,
    )


def _stepped(shape: Stack, edge: Chamfer) -> Stack:
    up = edge.facing == "up"
    bottom, top = (
        (edge.height - edge.width, edge.height) if up else (edge.height, edge.height + edge.width)
    )
    radius = edge.radius + (edge.depth if edge.inside else -edge.depth)
    if radius <= 0.0 or bottom < shape.bottom - 1e-9 or top > shape.top + 1e-9:
        return shape
    return reshaped(shape, bottom, top, _changed(edge, radius))


def _changed(edge: Chamfer, radius: float) -> Callable[[PlanarPart], PlanarPart]:
    centres = [complex(*centre) for centre in edge.centres]

    def one(contour: Contour) -> Contour:
        if not isinstance(contour, Circle) or abs(contour.radius - edge.radius) > 1e-9:
            return contour
        off = min(abs(complex(*contour.centre) - centre) for centre in centres)
        return Circle(contour.centre, radius) if off < 1e-9 else contour

    def change(flat: PlanarPart) -> PlanarPart:
        from cqdd_design.geometry.contours import PlanarPart

        if edge.inside:
            return PlanarPart(flat.name, flat.outer, tuple(one(hole) for hole in flat.holes))
        return PlanarPart(flat.name, one(flat.outer), flat.holes)

    return change
