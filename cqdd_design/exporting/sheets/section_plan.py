"""The section of a made part with its sizes, laid out at a scale about the middle of the view."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from cqdd_design.catalog.fits import general_tolerance
from cqdd_design.exporting.sheets.blocks import Block, Box, Placed, Row, Words, stairs
from cqdd_design.exporting.sheets.drawing import AXIS, OUTLINE, SheetDrawing
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.profile import (
    Cylinder,
    cut_face,
    cylinders,
    levels,
    spoken_for,
)
from cqdd_design.exporting.sheets.section_way import section_directions
from cqdd_design.exporting.sheets.sizes import Diameter, Lengths, Sizes, columns_of
from cqdd_design.exporting.sheets.wording import (
    DIA,
    chamfer_text,
    free_mm,
    groove_text,
    grouped,
    seat_rows,
    seat_text,
    shoulder_rows,
    thread_text,
    undercut_groups,
    undercut_text,
)
from cqdd_design.solids.axial_view import Line, Rectangle, cut_rectangles, lines_behind
from cqdd_design.solids.features.holes import TappedHole
from cqdd_design.solids.features.kinds import (
    AxialThread,
    Chamfer,
    Groove,
    Seat,
    Shoulder,
    TrueFace,
    Undercut,
)
from cqdd_design.solids.slabs import SAME, stack_slabs

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.part_facts import PartFacts
    from cqdd_design.geometry.contours import FloatArray

_MM = 1e3
_TITLE = 3.5


@dataclass(frozen=True, eq=False)
class SectionShape:
    """What the section shows, m; the same at every scale."""

    facts: PartFacts

    @cached_property
    def directions(self) -> tuple[float, float]:
        """Of the upper and the lower half plane, rad."""
        return section_directions(self.facts)

    @cached_property
    def bodies(self) -> tuple[Cylinder, ...]:
        """Cylinders of the body."""
        return cylinders(self.facts.part.shape)

    @cached_property
    def rectangles(self) -> tuple[tuple[Rectangle, ...], tuple[Rectangle, ...]]:
        """What either half plane cuts, without broken edges and the like."""
        found = stack_slabs(self.facts.part.shape)
        upper, lower = self.directions
        return cut_rectangles(found, upper), cut_rectangles(found, lower)

    @cached_property
    def face(self) -> list[FloatArray]:
        """Outlines of the cut face, mm."""
        return cut_face(*self.rectangles, self.facts.part.cuts, self.directions)

    @cached_property
    def behind(self) -> tuple[Line, ...]:
        """Visible edges behind the cut, m; those of the lower half have negative radii."""
        layers = self.facts.seen.layers
        upper, lower = self.directions
        return (
            *lines_behind(layers, upper, upper=True),
            *lines_behind(layers, lower, upper=False),
        )

    @cached_property
    def heights(self) -> tuple[tuple[float, float], ...]:
        """Heights of faces, and the radius at which each is reached from below the section, m."""
        features = self.facts.part.features
        ends = [*levels(self.facts.part.shape)]
        for feature in features:
            if isinstance(feature, Seat | AxialThread):
                ends += [feature.bottom, feature.top]
        found: list[tuple[float, float]] = []
        for end in sorted(ends):
            if found and end - found[-1][0] < 1e-7:
                continue
            found.append((end, self._reach(end)))
        return tuple(found)

    def _reach(self, height: float) -> float:
        ending = [
            self._below(one)
            for one in self.bodies
            if min(abs(one.bottom - height), abs(one.top - height)) < 1e-7
        ]
        if ending:
            return max(ending)
        across = [
            f.core / 2.0 if isinstance(f, AxialThread) else f.diameter / 2.0
            for f in self.facts.part.features
            if isinstance(f, Seat | AxialThread)
            and min(abs(f.bottom - height), abs(f.top - height)) < 1e-7
        ]
        return max(across, default=self.facts.outside)

    def _below(self, body: Cylinder) -> float:
        """How far a cylinder reaches below the axis in the lower half plane, m."""
        centre = body.centre * cmath.exp(-1j * self.directions[1])
        return centre.real + math.sqrt(max(body.radius**2 - centre.imag**2, 0.0))


@dataclass(frozen=True, eq=False)
class SectionPlan:
    """The section at a scale; places are mm of paper from its middle on the axis."""

    shape: SectionShape
    scale: float

    @property
    def factor(self) -> float:
        """Paper millimetres in a metre of the part."""
        return _MM * self.scale

    @property
    def middle(self) -> float:
        """Height of the part in the middle of the view, m."""
        stack = self.shape.facts.part.shape
        return 0.5 * (stack.bottom + stack.top)

    @property
    def half(self) -> float:
        """Half of the section's length, mm."""
        stack = self.shape.facts.part.shape
        return 0.5 * self.factor * (stack.top - stack.bottom)

    @property
    def reach(self) -> float:
        """Its greatest radius, mm."""
        return self.factor * self.shape.facts.outside

    def at(self, height: float, radius: float) -> complex:
        """A place on the paper from height and radius, m."""
        return complex(self.factor * (height - self.middle), self.factor * radius)

    @cached_property
    def sizes(self) -> Sizes:
        """Diameters to either side."""
        left: list[Diameter] = []
        right: list[Diameter] = []
        for size, (low, high) in self._diameters():
            (left if self._leaves_left(size, low, high, len(left) - len(right)) else right).append(
                size
            )
        half = max(self.half, 0.5 * self.lengths.width - 6.0)
        return columns_of(left, right, half, self.reach)

    def _diameters(self) -> list[tuple[Diameter, tuple[float, float]]]:
        features = self.shape.facts.part.features
        found: list[tuple[Diameter, tuple[float, float]]] = []

        def add(radius: float, centre: complex, span: tuple[float, float], text: str,
                seat: Seat | None = None, datum: str = "") -> None:  # fmt: skip
            low, high = (self.factor * (end - self.middle) for end in span)
            off = (centre * cmath.exp(-1j * self.shape.directions[0])).real
            rows = self._rows(seat) if seat and not _is_reached(seat) else ()
            size = Diameter(self.factor * radius, self.factor * off, low, high, text, rows, datum)
            found.append((size, span))

        for feature in features:
            span = (
                (feature.bottom, feature.top) if isinstance(feature, Seat | AxialThread) else None
            )
            if isinstance(feature, Seat) and span:
                centre = complex(*feature.centre)
                add(
                    0.5 * feature.diameter, centre, span, seat_text(feature), feature, feature.datum
                )
            elif isinstance(feature, AxialThread) and span:
                add(0.5 * feature.thread, 0j, span, thread_text(feature), datum=feature.datum)
        for body in self.shape.bodies:
            if not spoken_for(body, features):
                words = f"{DIA}{free_mm(2.0 * body.radius)}{self._way(body)}"
                add(body.radius, body.centre, (body.bottom, body.top), words)
        return found

    def _way(self, body: Cylinder) -> str:
        """Limits of a shoulder's edge, or of a bore that would else be less than is asked for."""
        for face in self.shape.facts.part.features:
            if body.inside or not isinstance(face, Shoulder) or not face.rim:
                continue
            if abs(face.outer - body.radius) < SAME:
                return f" (0/-{free_mm(face.rim)})"
        asked, size = self.shape.facts.design.requirements.bore, 2.0 * body.radius
        if asked is None or not body.inside or body.centre:
            return ""
        either = general_tolerance(size)
        missed = size - either < asked <= size + SAME
        return f" (+{free_mm(either)}/0)" if missed else ""

    def _rows(self, seat: Seat) -> tuple[Row, ...]:
        return seat_rows(seat, together=self.shape.facts.together)

    def _leaves_left(self, size: Diameter, low: float, high: float, more: int) -> bool:
        """Whether a diameter's extension lines run less through material to the left."""
        radius = size.reach / self.factor
        pieces = [p for p in self.shape.rectangles[0] if p.inner < radius - 1e-6 < p.outer]
        pieces += [p for p in self.shape.rectangles[0] if abs(p.inner - radius) < 2e-6]
        before = sum(min(p.top, low) - p.bottom for p in pieces if p.bottom < low - 1e-7)
        after = sum(p.top - max(p.bottom, high) for p in pieces if p.top > high + 1e-7)
        if abs(before - after) > 1e-6:
            return before < after
        to_left, to_right = size.begin + self.half, self.half - size.end
        if abs(to_left - to_right) > 1e-6:
            return to_left < to_right
        return more <= 0

    @cached_property
    def lengths(self) -> Lengths:
        """Lengths from the datum face."""
        part = self.shape.facts.part
        start = part.length_origin
        faces = [f for f in part.features if isinstance(f, Shoulder) and f.along]

        def limits(height: float) -> float:
            return next((_MM * f.along for f in faces if abs(f.height - height) < 1e-7), 0.0)

        marks = tuple(
            (self.factor * (h - self.middle), _MM * (h - start), limits(h))
            for h, _ in self.shape.heights
        )
        origin = self.factor * (start - self.middle)
        return Lengths(marks, origin, -self.reach - 9.0)

    @cached_property
    def blocks(self) -> list[Placed]:
        """Callouts above the section."""
        facts = self.shape.facts
        blocks: list[Block] = []
        chamfers = [f for f in facts.part.features if isinstance(f, Chamfer)]
        for count, edge in grouped(chamfers):
            side = -1.0 if edge.facing == "up" else 1.0
            shift = edge.depth * (0.5 if edge.inside else -0.5)
            off = (complex(*edge.centres[0]) * cmath.exp(-1j * self.shape.directions[0])).real
            target = self.at(edge.height + 0.5 * side * edge.width, off + edge.radius + shift)
            blocks.append(Block(target, ((Words(chamfer_text(count, edge)),),)))
        for count, relief in undercut_groups(
            f for f in facts.part.features if isinstance(f, Undercut)
        ):
            side = 1.0 if relief.facing == "up" else -1.0
            off = (complex(*relief.centre) * cmath.exp(-1j * self.shape.directions[0])).real
            target = self.at(
                relief.height + 0.5 * side * relief.width, off + relief.cylinder - relief.depth
            )
            blocks.append(Block(target, ((Words(undercut_text(count, relief)),),)))
        for feature in facts.part.features:
            if isinstance(feature, Groove):
                height = 0.5 * (feature.bottom + feature.top)
                target = self.at(height, 0.5 * feature.diameter)
                blocks.append(Block(target, ((Words(groove_text(feature)),),)))
            elif isinstance(feature, Shoulder):
                target = self.at(feature.height, feature.outer)
                blocks.append(Block(target, shoulder_rows(feature), "face"))
            elif isinstance(feature, Seat) and _is_reached(feature):
                target = self.at(0.5 * (feature.bottom + feature.top), 0.5 * feature.diameter)
                blocks.append(Block(target, self._rows(feature), "face"))
        level = max(self.reach + 5.0, self.sizes.top + 3.0)
        return stairs(blocks, level, up=True)

    @cached_property
    def title_level(self) -> float:
        """Where the name of the section stands, mm above the axis."""
        tops = [one.box[3] for one in self.blocks]
        return max([self.sizes.top, self.reach + 3.0, *tops]) + 3.0

    @cached_property
    def boxes(self) -> list[Box]:
        """The rooms that the section, its sizes and its callouts take, mm."""
        sizes, wide = self.sizes, 0.5 * self.lengths.width
        return [
            (sizes.left, -self.reach - 3.0, sizes.right, sizes.top),
            (-wide, self.lengths.level - self.lengths.depth, wide, -self.reach),
            (-8.0, self.title_level, 8.0, self.title_level + _TITLE),
            *sizes.boxes,
            *(one.box for one in self.blocks),
        ]

    def draw(self, sheet: SheetDrawing, place: complex, name: str) -> None:
        """Draw the section with its middle at a place of the sheet."""
        self._draw_faces(sheet, place)
        self._draw_threads(sheet, place)
        sheet.line(place - self.half - 4.0, place + self.half + 4.0, AXIS)
        for centre in {f.centre for f in self._lobes()}:
            along = (complex(*centre) * cmath.exp(-1j * self.shape.directions[0])).real
            level = 1j * self.factor * along
            sheet.line(place + level - self.half - 2.0, place + level + self.half + 2.0, AXIS)
        self._draw_hole_axes(sheet, place)
        self.sizes.draw(sheet, place)
        bottoms = [-self.factor * reach for _, reach in self.shape.heights]
        self.lengths.draw(sheet, place, bottoms)
        for one in self.blocks:
            one.draw(sheet, place)
        corner = place - 0.5 * text_width(name, _TITLE) + 1j * self.title_level
        sheet.text(corner, name, _TITLE)

    def _lobes(self) -> list[Seat]:
        features = self.shape.facts.part.features
        return [f for f in features if isinstance(f, Seat) and any(f.centre)]

    def _draw_faces(self, sheet: SheetDrawing, place: complex) -> None:
        loops = [
            [
                place + complex(self.scale * (x - _MM * self.middle), self.scale * y)
                for x, y in loop.tolist()
            ]
            for loop in self.shape.face
        ]
        sheet.hatch_face(loops)
        for loop in loops:
            sheet.chain(loop, OUTLINE, close=True)
        for one, two in self.shape.behind:
            ends = (place + self.at(one.real, one.imag), place + self.at(two.real, two.imag))
            sheet.line(*ends, OUTLINE)

    def _draw_threads(self, sheet: SheetDrawing, place: complex) -> None:
        """Crests or roots that the outlines do not show, as thin lines (ISO 6410-1)."""
        for feature in self.shape.facts.part.features:
            if isinstance(feature, AxialThread):
                inner = feature.thread - 1.0825 * feature.pitch
                radius = 0.5 * (feature.thread if feature.inside else inner)
                for side in (1.0, -1.0):
                    begin = self.at(feature.bottom, side * radius)
                    sheet.line(place + begin, place + self.at(feature.top, side * radius))
            elif isinstance(feature, TappedHole):
                self._draw_tapped(sheet, place, feature)

    def _draw_tapped(self, sheet: SheetDrawing, place: complex, hole: TappedHole) -> None:
        way = -1.0 if hole.facing == "up" else 1.0
        ends = (hole.mouth, hole.mouth + way * hole.thread_depth)
        for middle in self._in_plane(hole.circle.centres):
            for side in (1.0, -1.0):
                level = middle + side * 0.5 * hole.thread
                sheet.line(place + self.at(ends[0], level), place + self.at(ends[1], level))
            if not hole.through:
                for side in (1.0, -1.0):
                    inner, outer = 0.5 * side * hole.drill, 0.5 * side * hole.thread
                    sheet.line(
                        place + self.at(ends[1], middle + inner),
                        place + self.at(ends[1], middle + outer),
                    )

    def _in_plane(self, centres: Sequence[tuple[float, float]]) -> list[float]:
        """Heights above the axis at which holes are cut, m; negative in the lower half."""
        found = []
        for direction, side in zip(self.shape.directions, (1.0, -1.0), strict=True):
            for centre in centres:
                along = complex(*centre) * cmath.exp(-1j * direction)
                if abs(along.imag) < 1e-6 and along.real > 0.0:
                    found.append(side * along.real)
        return found

    def _draw_hole_axes(self, sheet: SheetDrawing, place: complex) -> None:
        stack = self.shape.facts.part.shape
        for group in self.shape.facts.holes:
            for middle in self._in_plane(group[0].circle.centres):
                begin, end = self.at(stack.bottom, middle), self.at(stack.top, middle)
                sheet.line(place + begin - 2.0, place + end + 2.0, AXIS)


def _is_reached(seat: Seat) -> bool:
    """Whether what is said of a cylinder points at its surface: there is more room above it."""
    return isinstance(seat, TrueFace) and not seat.inside
