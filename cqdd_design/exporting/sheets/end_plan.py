"""The view of a made part along its axis, with its holes, laid out at a scale."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from cqdd_design.exporting.sheets.blocks import (
    Block,
    Box,
    Boxed,
    Placed,
    Row,
    Words,
    stairs,
)
from cqdd_design.exporting.sheets.drawing import AXIS, HIDDEN, OUTLINE, SMALL, SheetDrawing
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.profile import sector, slots
from cqdd_design.exporting.sheets.wording import (
    DIA,
    circle_row,
    degrees,
    evenly,
    free_mm,
    hole_rows,
    mm,
    round_row,
)
from cqdd_design.geometry.contours import ArcContour, as_complex
from cqdd_design.solids.end_view import Arc, visible_edges
from cqdd_design.solids.features.holes import (
    BoltCircle,
    ClearanceHole,
    Counterbore,
    FittedHole,
    Hole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import Seat

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.part_facts import PartFacts

_MM = 1e3
_TOWARD = (60.0, -60.0, 120.0, -120.0, 35.0, -35.0, 145.0, -145.0)
"""Directions in which holes are picked to be pointed at, deg."""
_MARKS = 14.0
"""Room for the marks of the section round a view, mm."""


def drilled_size(hole: Hole) -> float:
    """Diameter of a hole as it is drilled, m."""
    return hole.drill if isinstance(hole, TappedHole) else hole.diameter


def is_seam(hole: Hole) -> bool:
    """Whether a hole lies half in another part: the outline has it."""
    return isinstance(hole, FittedHole) and hole.seam


def _is_below(hole: Hole, others: Sequence[FittedHole | Counterbore]) -> bool:
    """Whether the depths of a tapped hole run from the floor of another one on its circle."""
    return isinstance(hole, TappedHole) and any(
        abs(hole.mouth - end) < 1e-7 for one in others for end in _floors(one)
    )


def _floors(hole: FittedHole | Counterbore) -> tuple[float, ...]:
    """Height of a blind hole's floor, m."""
    if isinstance(hole, Counterbore):
        return (hole.mouth - hole.depth if hole.facing == "up" else hole.mouth + hole.depth,)
    if hole.through:
        return ()
    return (hole.bottom if hole.facing == "up" else hole.top,)


def _round_row(first: complex, places: Sequence[complex]) -> Row:
    """Where the first of several arcs stands, and how far apart they are, if evenly."""
    start = cmath.phase(first)
    turns = sorted((cmath.phase(one) - start) % (2.0 * math.pi) for one in places)
    if len(places) > 1 and not evenly(BoltCircle("arcs", abs(first), tuple(turns))):
        return (Words("from"), Boxed(degrees(start)))
    return round_row(start, len(places))


@dataclass(frozen=True, eq=False)
class EndShape:
    """What is seen along the axis; the same at every scale."""

    facts: PartFacts

    @property
    def needed(self) -> bool:
        """Whether there is anything that the section does not say."""
        layers = self.facts.part.shape.layers
        odd = any(isinstance(layer.shape.outer, ArcContour) for layer in layers)
        return bool(self.facts.holes) or odd or bool(self.lobes)

    @cached_property
    def lobes(self) -> list[Seat]:
        """Seats beside the axis."""
        return [f for f in self.facts.part.features if isinstance(f, Seat) and any(f.centre)]

    @cached_property
    def from_above(self) -> bool:
        """From which end more holes are entered."""
        votes = 0
        for group in self.facts.holes:
            for hole in group:
                if isinstance(hole, TappedHole | Counterbore | FittedHole):
                    votes += 1 if hole.facing == "up" else -1
        return votes >= 0

    @cached_property
    def edges(self) -> tuple[Arc, ...]:
        """Visible edges, m."""
        return visible_edges(self.facts.seen.layers, from_above=self.from_above)

    def seen(self, hole: Hole) -> bool:
        """Whether the mouth of a hole is seen."""
        size, centre = drilled_size(hole), complex(*hole.circle.centres[0])
        return any(
            abs(edge.sweep) > 3.0
            and abs(edge.centre - centre) < 1e-7
            and abs(edge.radius - 0.5 * size) < 1e-7
            for edge in self.edges
        )


@dataclass(frozen=True, eq=False)
class EndPlan:
    """The view at a scale; places are mm of paper from the axis."""

    shape: EndShape
    scale: float
    cut: tuple[float, float]

    @property
    def factor(self) -> float:
        """Paper millimetres in a metre of the part."""
        return _MM * self.scale

    def at(self, point: complex) -> complex:
        """A place of the paper: +x is up, as in the section."""
        turned = point if self.shape.from_above else point.conjugate()
        return 1j * turned * self.factor

    @property
    def reach(self) -> float:
        """Farthest from the axis, mm."""
        return self.factor * self.shape.facts.outside

    @cached_property
    def blocks(self) -> list[Placed]:
        """Callouts above and below the view."""
        blocks = [*self._hole_blocks(), *self._lobe_blocks(), *self._contour_blocks()]
        blocks += [*self._slot_blocks(), *self._sector_blocks()]
        level = self.reach + _MARKS
        above = [block for block in blocks if block.target.imag >= 0.0]
        below = [block for block in blocks if block.target.imag < 0.0]
        return [*stairs(above, level, up=True), *stairs(below, -level, up=False)]

    def _hole_blocks(self) -> list[Block]:
        blocks = []
        for number, group in enumerate(self.shape.facts.holes, start=1):
            toward = cmath.rect(1.0, math.radians(_TOWARD[(number - 1) % len(_TOWARD)]))
            centres = [self.at(complex(*c)) for c in group[0].circle.centres]
            centre = max(centres, key=lambda c: round((c * toward.conjugate()).real, 6))
            size = max(drilled_size(hole) for hole in group)
            up = 1j if centre.imag >= 0.0 else -1j
            floors = [h for h in group if isinstance(h, FittedHole | Counterbore)]
            rows = [
                row
                for hole in group
                for row in hole_rows(
                    hole, together=self.shape.facts.together, below=_is_below(hole, floors)
                )
            ]
            first = (Words(f"H{number}"), *rows[0])
            hidden = [hole for hole in group if not self.shape.seen(hole) and not is_seam(hole)]
            rows = [first, *rows[1:], circle_row(group[0].circle)]
            if len(hidden) == len(group):
                # A plain hole goes through its wall, which the view does not show either.
                how = "through, " if all(isinstance(one, PlainHole) for one in group) else ""
                rows.append((Words(f"{how}from the far side"),))
            elif any(isinstance(one, Counterbore) for one in hidden):
                rows.append((Words("counterbore from the far side"),))
            elif any(isinstance(one, FittedHole) for one in hidden):
                rows.append((Words("fitted bore from the far side"),))
            target = centre + 0.5 * self.factor * size * up
            blocks.append(Block(target, tuple(rows)))
        return blocks

    def _lobe_blocks(self) -> list[Block]:
        blocks = []
        for seat in self.shape.lobes:
            centre = complex(*seat.centre)
            words = (Words(f"axis of {seat.name}"), Boxed(mm(abs(centre))), Words("at"),
                     Boxed(degrees(cmath.phase(centre))))  # fmt: skip
            blocks.append(Block(self.at(centre), (words,), "dot"))
        return blocks

    def _contour_blocks(self) -> list[Block]:
        """Arcs of outlines that are no circle about the axis: ears, scallops."""
        found: dict[tuple[float, float], list[complex]] = {}
        for layer in self.shape.facts.part.shape.layers:
            for contour in (layer.shape.outer, *layer.shape.holes):
                if not isinstance(contour, ArcContour):
                    continue
                arcs = contour.arcs()
                for centre, radius in zip(as_complex(arcs.centres), arcs.radii, strict=True):
                    if math.isfinite(radius) and abs(centre) > 1e-6:
                        key = (round(float(radius), 8), round(float(abs(centre)), 8))
                        places = found.setdefault(key, [])
                        if all(abs(centre - other) > 1e-7 for other in places):
                            places.append(complex(centre))
        seams = {
            round(0.5 * drilled_size(hole), 8)
            for group in self.shape.facts.holes
            for hole in group
            if is_seam(hole)
        }
        blocks = []
        for (radius, distance), places in found.items():
            if radius in seams:
                continue
            first = min(places, key=lambda c: round(cmath.phase(c) % (2.0 * math.pi), 6))
            toward = cmath.rect(1.0, math.radians(-120.0))
            spot = max(places, key=lambda c: round((self.at(c) * toward.conjugate()).real, 6))
            out = self.at(spot) / abs(self.at(spot))
            lead = f"{len(places)} \u00d7 " if len(places) > 1 else ""
            # In two rows: a housing's views are as wide as A3 at the least scale has room for.
            on = (Words(f"{lead}R{free_mm(radius)} on"), Boxed(f"{DIA}{mm(2.0 * distance)}"))
            rows: tuple[Row, ...] = (on, _round_row(first, places))
            blocks.append(Block(self.at(spot) + self.factor * radius * out, rows))
        return blocks

    def _slot_blocks(self) -> list[Block]:
        found = slots(self.shape.facts.part.shape)
        if found is None:
            return []
        width, depth = free_mm(found.width), free_mm(found.depth)
        words = f"{found.count} \u00d7 slot {width} wide, {depth} deep"
        rows = ((Words(words), *round_row(cmath.phase(found.floor), found.count)),)
        return [Block(self.at(found.floor), rows)]

    def _sector_blocks(self) -> list[Block]:
        """What the section does not say of a piece of a ring: its inner radius, and its ends."""
        found = sector(self.shape.facts.part.shape)
        if found is None:
            return []
        words = Words(f"R{free_mm(found.inner)} inside, ends radial, {degrees(found.angle)} apart")
        return [Block(self.at(found.spot), ((words,),))]

    @property
    def has_exact(self) -> bool:
        """Whether it says any theoretically exact dimension."""
        rows = [row for one in self.blocks for row in one.block.rows]
        return any(isinstance(cell, Boxed) for row in rows for cell in row)

    @cached_property
    def boxes(self) -> list[Box]:
        """The rooms that the view and its callouts take, mm."""
        side = self.reach + _MARKS
        return [(-side, -side, side, side), *(one.box for one in self.blocks)]

    def draw(self, sheet: SheetDrawing, place: complex, letter: str) -> None:
        """Draw the view with its axis at a place of the sheet."""
        for edge in self.shape.edges:
            self._draw_edge(sheet, place, edge)
        self._draw_holes(sheet, place)
        arm = self.reach + 4.0
        sheet.line(place - arm, place + arm, AXIS)
        sheet.line(place - 1j * arm, place + 1j * arm, AXIS)
        side = -1.0 if self.shape.from_above else 1.0
        # Beside the axis, clear of leaders, which rise from near it too.
        wide = text_width("X", SMALL)
        beside = (0.8, -0.8 - wide, 3.0, -3.0 - wide)
        spot = next((x for x in beside if self._is_free(x, x + wide)), 0.8)
        sheet.text(place + spot + 1j * (self.reach + 1.4), "X", SMALL)
        sheet.text(place + complex(side * (self.reach + 2.4) - 0.8, 0.8), "Y", SMALL)
        for seat in self.shape.lobes:
            centre = place + self.at(complex(*seat.centre))
            sheet.line(centre - 3.0, centre + 3.0, AXIS)
        self._draw_cut(sheet, place, letter)
        for one in self.blocks:
            one.draw(sheet, place)

    def _draw_edge(self, sheet: SheetDrawing, place: complex, edge: Arc) -> None:
        if edge.sweep == 0.0:
            sheet.line(place + self.at(edge.start), place + self.at(edge.end), OUTLINE)
            return
        centre, radius = place + self.at(edge.centre), self.factor * edge.radius
        if abs(edge.sweep) > 2.0 * math.pi - 1e-6:
            sheet.circle(centre, radius, OUTLINE)
            return
        ends = [
            self.at(edge.start) - self.at(edge.centre),
            self.at(edge.end) - self.at(edge.centre),
        ]
        if (edge.sweep < 0.0) == self.shape.from_above:
            ends.reverse()
        first, last = (math.degrees(cmath.phase(end)) for end in ends)
        sheet.arc(centre, radius, first, last, OUTLINE)

    def _draw_holes(self, sheet: SheetDrawing, place: complex) -> None:
        """Axes, the circles they stand on, threads, and holes that are hidden."""
        radii = set()
        for group in self.shape.facts.holes:
            circle = group[0].circle
            radii.add(round(self.factor * circle.radius, 6))
            big = 0.5 * self.factor * max(drilled_size(hole) for hole in group) + 1.5
            for c in circle.centres:
                centre = self.at(complex(*c))
                along = centre / abs(centre)
                sheet.line(place + centre - big * along, place + centre + big * along, AXIS)
            for hole in group:
                hidden = not self.shape.seen(hole)
                if is_seam(hole):
                    continue
                for c in circle.centres:
                    centre = place + self.at(complex(*c))
                    radius = 0.5 * self.factor * drilled_size(hole)
                    if hidden and not isinstance(hole, ClearanceHole | PlainHole):
                        sheet.circle(centre, radius, HIDDEN)
                    elif isinstance(hole, TappedHole):
                        # Three quarters of a circle (ISO 6410-1).
                        sheet.arc(centre, 0.5 * self.factor * hole.thread, 100.0, 10.0)
        for radius in sorted(radii):
            sheet.circle(place, radius, AXIS)

    def _is_free(self, left: float, right: float) -> bool:
        """Whether no leader runs between two places just above the view."""
        level = self.reach + 2.5
        for one in self.blocks:
            if not one.up:
                continue
            target, foot = one.block.target, complex(one.x, one.y)
            share = (level - target.imag) / (foot.imag - target.imag)
            if left - 0.3 < target.real + share * (foot.real - target.real) < right + 0.3:
                return False
        return True

    def _leaders(self, *, up: bool) -> list[float]:
        """Where leaders above or below the view run, mm from the axis."""
        return [one.x for one in self.blocks if one.up == up]

    def _draw_cut(self, sheet: SheetDrawing, place: complex, letter: str) -> None:
        """Where the section runs, and which way it looks."""
        for direction, look in zip(self.cut, (-1j, 1j), strict=True):
            out = self.at(cmath.rect(1.0, direction)) / self.factor
            begin = place + (self.reach + 5.0) * out
            end = begin + 4.0 * out
            sheet.line(begin, end, OUTLINE)
            toward = self.at(look * cmath.rect(1.0, direction)) / self.factor
            sheet.line(end, end + 5.0 * toward)
            sheet.triangle(end + 5.0 * toward, toward)
            spot = end - 3.2 * toward
            # Past leaders that run there.
            beside = self._leaders(up=out.imag > 0.0) if abs(out.imag) > 0.5 else []
            while any(abs(x - (spot - place).real) < 2.0 for x in beside):
                spot -= 0.5 * toward
            sheet.text(spot - 1.2 - 1.75j, letter, 3.5)
