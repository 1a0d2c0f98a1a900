"""The section of the whole machine: a face for every part that is cut, and the lines behind."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.sheets.blocks import spread
from cqdd_design.exporting.sheets.drawing import AXIS, FINE, SheetDrawing
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.profile import cut_face
from cqdd_design.solids.apart import posed_layers
from cqdd_design.solids.axial_view import Line, Rectangle, cut_rectangles, lines_behind
from cqdd_design.solids.cut_plane import cut_angles, is_hatched
from cqdd_design.solids.slabs import slabs
from cqdd_design.solids.stations import Station, stations

if TYPE_CHECKING:
    from cqdd_design.geometry.contours import FloatArray
    from cqdd_design.machine import Machine

_MM = 1e3
_BALLOON, _APART = 3.6, 8.6
"""Radius of a balloon, and how far balloons of one row stand from each other, mm."""
_CLEAR = 14.0
"""From the machine to the balloons, mm."""


@dataclass(frozen=True, eq=False)
class CutPiece:
    """What the section cuts of one piece.

    Attributes
    ----------
    upper, lower : tuple of Rectangle
        In the two half planes.
    """

    station: Station
    upper: tuple[Rectangle, ...]
    lower: tuple[Rectangle, ...]

    @cached_property
    def face(self) -> list[FloatArray]:
        """Outlines (k, 2), mm."""
        return cut_face(self.upper, self.lower, (), (0.0, math.pi))

    def spots(self) -> list[tuple[float, complex]]:
        """Area (m^2) and middle (m) of the largest rectangle in either half, the larger first."""
        found = []
        for half, side in ((self.upper, 1.0), (self.lower, -1.0)):
            if half:
                best = max(half, key=lambda one: round(_area(one), 12))
                middle = side * 0.5 * (best.inner + best.outer)
                found.append((_area(best), complex(0.5 * (best.bottom + best.top), middle)))
        return sorted(found, key=lambda pair: -round(pair[0], 12))


def _area(one: Rectangle) -> float:
    return (one.top - one.bottom) * (one.outer - one.inner)


class AssemblyView:
    """The aligned section of a machine; lengths in m, z + 1j r."""

    def __init__(self, machine: Machine) -> None:
        self.design, self.parts = machine.design, machine.parts
        found = stations(self.parts)
        self._upper, self._lower = cut_angles(self.design, found)
        pieces, layers = [], []
        for station in found:
            for piece in station.pieces:
                standing = posed_layers(station.part, piece.pose(self.design, self._upper))
                layers += standing
                cut = slabs(standing)
                halves = [cut_rectangles(cut, a) for a in (self._upper, self._lower)]
                if any(halves):
                    pieces.append(CutPiece(station, halves[0], halves[1]))
        self.pieces = pieces
        self._layers = layers

    @cached_property
    def behind(self) -> tuple[Line, ...]:
        """Visible edges behind the section."""
        return (
            *lines_behind(self._layers, self._upper, upper=True),
            *lines_behind(self._layers, self._lower, upper=False),
        )

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and greatest height."""
        return (
            min(layer.bottom for layer in self._layers),
            max(layer.top for layer in self._layers),
        )

    @cached_property
    def reach(self) -> float:
        """Farthest from the axis."""
        return max(
            float(np.hypot(*layer.shape.outer.sample(1e-5).T).max()) for layer in self._layers
        )

    def spots(self) -> dict[int, complex]:
        """Where the number of a part points to: in the half that has fewer numbers, if it can."""
        found: dict[int, list[tuple[float, complex]]] = {}
        for piece in self.pieces:
            found.setdefault(piece.station.number, []).extend(piece.spots())
        taken: dict[int, complex] = {}
        for number, places in sorted(found.items()):
            most = max(area for area, _ in places)
            fair = [spot for area, spot in places if area > 0.4 * most]
            above = sum(1 if spot.imag > 0.0 else -1 for spot in taken.values())
            taken[number] = max(fair, key=lambda s: (s.imag < 0.0) == (above > 0))
        return taken

    def draw(self, sheet: SheetDrawing, place: complex) -> None:
        """Draw it with its middle on the axis at a place of the sheet."""
        factor = _MM * sheet.scale
        middle = 0.5 * sum(self.ends)

        def at(point: complex) -> complex:
            return place + factor * (point - middle)

        for piece in self.pieces:
            self._draw_piece(sheet, place, middle, piece)
        for one, two in self.behind:
            sheet.line(at(one), at(two), FINE)
        half = 0.5 * factor * (self.ends[1] - self.ends[0])
        sheet.line(place - half - 6.0, place + half + 6.0, AXIS)
        self._draw_balloons(sheet, place, {n: at(spot) for n, spot in self.spots().items()})

    def _draw_piece(
        self, sheet: SheetDrawing, place: complex, middle: float, piece: CutPiece
    ) -> None:
        loops = [
            [place + complex(sheet.scale * (x - _MM * middle), sheet.scale * y) for x, y in loop]
            for loop in piece.face
        ]
        if is_hatched(piece.station):
            number = piece.station.number
            sheet.hatch_face(loops, (1.2, 1.2, 1.8, 1.8)[number % 4], falling=number % 2 == 1)
        for loop in loops:
            sheet.chain(loop, FINE, close=True)
        if piece.station.part.inner_body is not None:
            for loop in loops:
                _bearing_sign(sheet, loop)

    def _draw_balloons(self, sheet: SheetDrawing, place: complex, tips: dict[int, complex]) -> None:
        level = sheet.scale * _MM * self.reach + _CLEAR
        for side in (1.0, -1.0):
            row = {n: tip for n, tip in tips.items() if (tip.imag >= place.imag) == (side > 0.0)}
            wanted = [tip.real for tip in row.values()]
            for (number, tip), x in zip(row.items(), spread(wanted, _APART), strict=True):
                centre = complex(x, place.imag + side * level)
                along = (tip - centre) / abs(tip - centre)
                sheet.circle(centre, _BALLOON)
                sheet.line(centre + _BALLOON * along, tip)
                sheet.dot(tip)
                words = str(number)
                sheet.text(centre - 0.5 * text_width(words, 2.5) - 1.25j, words, 2.5)


def _bearing_sign(sheet: SheetDrawing, loop: list[complex]) -> None:
    """The upright cross of a bearing drawn in the simplified manner (ISO 8826-1)."""
    x, y = [p.real for p in loop], [p.imag for p in loop]
    centre = complex(0.5 * (min(x) + max(x)), 0.5 * (min(y) + max(y)))
    half = 0.28 * min(max(x) - min(x), max(y) - min(y))
    sheet.line(centre - half, centre + half)
    sheet.line(centre - 1j * half, centre + 1j * half)
