"""What a cut sheet is drawn with: lines, text, callouts and geometric tolerances, mm of paper.

Symbols of ISO 1101 are drawn, not written: no font need have them.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from cqdd_design.exporting.edm.dxf import reproducible
from cqdd_design.exporting.sheets.formats import A3, Paper
from cqdd_design.exporting.sheets.lettering import fitting_height, printable, text_width
from cqdd_design.geometry.contours import Circle, Contour

if TYPE_CHECKING:
    from ezdxf.document import Drawing

OUTLINE, FINE, THIN, AXIS, HIDDEN = "OUTLINE", "FINE", "THIN", "AXIS", "HIDDEN"
_PENS = {OUTLINE: 50, FINE: 25, THIN: 18, AXIS: 18, HIDDEN: 18}
"""Layers and their pens, hundredths of a millimetre."""
TEXT, SMALL = 2.5, 2.2
"""Cap heights, mm."""
STYLE = "SHEET"
FONT = "arial.ttf"
"""Of the DXF: as wide as the Helvetica of PDF and SVG, and there where drawings are opened."""
_STYLED: dict[str, Any] = {"dimstyle": STYLE, "dxfattribs": {"layer": THIN}}
"""How every dimension is drawn."""
CELL = 5.6
"""Height of a tolerance frame, mm."""
STEM = 5.0
"""Of a datum, from its foot to the letter's box, mm."""

_HATCH, _FACE_HATCH = 4.0, 2.2
"""Between hatching lines, mm: along an edge, and across the lines."""
_EIGHTH = cmath.exp(-0.25j * math.pi)
_CENTRE_LINE = [10.0, 6.0, -1.5, 1.0, -1.5]
_DASHED = [3.0, 2.0, -1.0]
_LINETYPES = {AXIS: "CENTRE", HIDDEN: "DASHED"}


def new_sheet(scale: float, paper: Paper = A3) -> SheetDrawing:
    """Start a sheet whose dimensions measure `scale` millimetres of paper as one."""
    from ezdxf.filemanagement import new

    with reproducible():
        drawing = new("R2010", setup=False, units=4)
    drawing.linetypes.add("CENTRE", pattern=_CENTRE_LINE, description="centre line")
    drawing.linetypes.add("DASHED", pattern=_DASHED, description="hidden line")
    # No font of the machine yet: dimensions reckon with a cap height a character.
    drawing.styles.add(STYLE, font="*monospace")
    for name, pen in _PENS.items():
        drawing.layers.add(name, lineweight=pen, linetype=_LINETYPES.get(name, "CONTINUOUS"))
    style = drawing.dimstyles.add(STYLE)
    settings = {
        **{"dimtxt": TEXT, "dimtxsty": STYLE, "dimtad": 1, "dimtih": 0, "dimtoh": 0},
        **{"dimasz": 2.5, "dimexe": 1.2, "dimexo": 0.8, "dimgap": 0.8, "dimlwd": 18, "dimlwe": 18},
        **{"dimdec": 3, "dimadec": 3, "dimdsep": ord("."), "dimzin": 8, "dimazin": 2},
        "dimlfac": 1.0 / scale,
    }
    for name, value in settings.items():
        style.dxf.set(name, value)
    return SheetDrawing(drawing, scale, paper)


class SheetDrawing:
    """A document in millimetres of paper, and the few things that are drawn into it.

    Attributes
    ----------
    scale : float
        Millimetres of paper for one of the part.
    paper : Paper
        What it is drawn on.
    """

    def __init__(self, drawing: Drawing, scale: float, paper: Paper) -> None:
        self.drawing = drawing
        self.scale = scale
        self.paper = paper
        self._space = drawing.modelspace()

    def name_font(self) -> None:
        """Name the font that a program which opens the DXF is to write with."""
        self.drawing.styles.get(STYLE).dxf.font = FONT

    def line(self, start: complex, end: complex, layer: str = THIN) -> None:
        """Draw a straight line."""
        self._space.add_line(_xy(start), _xy(end), dxfattribs={"layer": layer})

    def box(self, corner: complex, width: float, height: float, layer: str = THIN) -> None:
        """Draw a rectangle from its lower left corner."""
        x, y = _xy(corner)
        points = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
        self._space.add_lwpolyline(points, close=True, dxfattribs={"layer": layer})

    def polygon(self, corners: Sequence[complex]) -> None:
        """Draw thin lines from corner to corner, and back to the first."""
        for one, two in zip(corners, [*corners[1:], corners[0]], strict=True):
            self.line(one, two)

    def chain(self, points: Sequence[complex], layer: str = THIN, *, close: bool = False) -> None:
        """Draw straight lines from point to point, and back to the first where closed."""
        places = [_xy(point) for point in points]
        self._space.add_lwpolyline(places, close=close, dxfattribs={"layer": layer})

    def circle(self, centre: complex, radius: float, layer: str = THIN) -> None:
        """Draw a circle."""
        self._space.add_circle(_xy(centre), radius, dxfattribs={"layer": layer})

    def arc(
        self, centre: complex, radius: float, start: float, end: float, layer: str = THIN
    ) -> None:
        """Draw an arc between two angles, deg."""
        self._space.add_arc(_xy(centre), radius, start, end, dxfattribs={"layer": layer})

    def dot(self, centre: complex) -> None:
        """Draw a filled dot, the end of a leader within an outline."""
        half = 0.45
        corners = [centre + half * d for d in (-1 - 1j, 1 - 1j, -1 + 1j, 1 + 1j)]
        self._space.add_solid([_xy(c) for c in corners], dxfattribs={"layer": THIN})

    def contour(self, contour: Contour, centre: complex) -> None:
        """Draw a contour of the part (m) about `centre` (mm of paper)."""
        factor = 1e3 * self.scale
        moved = contour.scaled(factor).transformed(shift=(centre.real, centre.imag))
        if isinstance(moved, Circle):
            self.circle(complex(*moved.centre), moved.radius, OUTLINE)
            return
        rows = [(*p, b) for p, b in zip(moved.points.tolist(), moved.bulges.tolist(), strict=True)]
        self._space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": OUTLINE})

    def hatch(self, corner: complex, width: float, height: float) -> None:
        """Hatch a rectangle that is cut, at 45 degrees."""
        # Not a HATCH: ezdxf's lines of a pattern differ in the last digits from run to run.
        for step in range(1, math.ceil((width + height) / _HATCH)):
            along = step * _HATCH
            begin = complex(min(along, width), max(along - width, 0.0))
            end = complex(max(along - height, 0.0), min(along, height))
            begin, end = (corner + complex(width - p.real, p.imag) for p in (begin, end))
            self.line(begin, end)

    def hatch_face(
        self,
        loops: Sequence[Sequence[complex]],
        spacing: float = _FACE_HATCH,
        *,
        falling: bool = False,
    ) -> None:
        """Hatch what closed chains of lines bound, at 45 degrees, falling to the right if asked."""
        mirror = -1.0 if falling else 1.0
        turned = [[complex(p.real, mirror * p.imag) * _EIGHTH for p in loop] for loop in loops]
        levels = [point.imag for loop in turned for point in loop]
        first, last = math.ceil(min(levels) / spacing), math.floor(max(levels) / spacing)
        for step in range(first, last + 1):
            # A hair beside the grid: a corner on a hatching line is met once.
            level = step * spacing + 1e-7
            for one, two in _chords(turned, level):
                begin, end = (complex(x, level) / _EIGHTH for x in (one, two))
                self.line(
                    complex(begin.real, mirror * begin.imag), complex(end.real, mirror * end.imag)
                )

    def text(
        self,
        place: complex,
        words: str,
        height: float = TEXT,
        room: float = math.inf,
        turn: float = 0.0,
    ) -> float:
        """Write a line from its lower left corner, smaller where `room` asks; its width.

        `turn` is the angle of its direction, deg.
        """
        words = printable(words)
        if not words.strip():
            return 0.0
        size = fitting_height(words, height, room)
        where = {"layer": THIN, "insert": _xy(place), "style": STYLE, "rotation": turn}
        self._space.add_text(words, height=size, dxfattribs=where)
        return text_width(words, size)

    def triangle(self, tip: complex, toward: complex) -> None:
        """Draw a filled arrowhead that points along `toward`."""
        along = toward / abs(toward) * 2.5
        foot = tip - along
        corners = [tip, foot + 1j * along / 5.0, foot - 1j * along / 5.0]
        self._space.add_solid([_xy(c) for c in corners], dxfattribs={"layer": THIN})

    def linear(
        self, base: complex, one: complex, two: complex, angle: float, words: str = "<>"
    ) -> None:
        """Dimension a distance; `words` as in DXF, ``<>`` for the measured value."""
        self._space.add_linear_dim(
            base=_xy(base), p1=_xy(one), p2=_xy(two), angle=angle, text=words, **_STYLED
        ).render()

    def callout(self, target: complex, elbow: complex, words: str, width: float) -> None:
        """Point at something from a shelf of `width` (to the left where negative) under text."""
        self.triangle(target, target - elbow)
        self.line(target, elbow)
        self.line(elbow, elbow + width)
        self.text(elbow + min(width, 0.0) + 1.5 + 1.0j, words, room=abs(width) - 2.0)

    def tolerance(self, corner: complex, symbol: str, value: str, datums: Sequence[str]) -> float:
        """Draw a tolerance frame from its lower left corner; its width."""
        cells = [value, *datums]
        x = CELL
        self.line(corner + x, corner + x + 1j * CELL)
        _SYMBOLS[symbol](self, corner + 0.5 * CELL * (1.0 + 1.0j))
        for words in cells:
            wide = max(text_width(words, TEXT) + 2.4, CELL)
            self.text(
                corner + x + 0.5 * (wide - text_width(words, TEXT)) + 1j * 0.5 * (CELL - TEXT),
                words,
            )
            x += wide
            if words is not cells[-1]:
                self.line(corner + x, corner + x + 1j * CELL)
        self.box(corner, x, CELL)
        return x

    def datum(self, foot: complex, toward: complex, letter: str, stem: float = STEM) -> None:
        """Mark a datum: a triangle on its feature, a line to `stem` mm, the letter in a box."""
        along = toward / abs(toward)
        corners = [foot + 2.2 * along, foot + 1.3j * along, foot - 1.3j * along]
        self._space.add_solid([_xy(c) for c in corners], dxfattribs={"layer": THIN})
        middle = foot + (stem + 0.5 * CELL) * along
        self.line(foot + 2.2 * along, foot + stem * along)
        self.box(middle - 0.5 * CELL * (1.0 + 1.0j), CELL, CELL)
        self.text(middle - 0.5 * text_width(letter, TEXT) - 0.5j * TEXT, letter)

    def finish(self, place: complex, value: str) -> float:
        """Draw the sign for a surface from which material is removed; its width."""
        self.line(place, place + 1.7 + 3.0j)
        self.line(place, place - 1.7 + 3.0j)
        self.line(place - 1.7 + 3.0j, place + 1.7 + 3.0j)
        self.line(place + 1.7 + 3.0j, place + 3.4 + 6.0j)
        self.line(place + 3.4 + 6.0j, place + 3.4 + 6.0j + text_width(value, SMALL) + 1.0)
        return 3.9 + self.text(place + 3.9 + 2.8j, value, SMALL)


def _position(sheet: SheetDrawing, at: complex) -> None:
    sheet.circle(at, 1.1)
    sheet.line(at - 1.9, at + 1.9)
    sheet.line(at - 1.9j, at + 1.9j)


def _profile_of_a_line(sheet: SheetDrawing, at: complex) -> None:
    sheet.arc(at - 0.9j, 1.9, 0.0, 180.0)


def _flatness(sheet: SheetDrawing, at: complex) -> None:
    corners = [at - 2.0 - 0.9j, at + 1.0 - 0.9j, at + 2.0 + 0.9j, at - 1.0 + 0.9j]
    sheet.polygon(corners)


def _parallelism(sheet: SheetDrawing, at: complex) -> None:
    for shift in (-0.6, 0.6):
        sheet.line(at + shift - 0.8 - 1.7j, at + shift + 0.8 + 1.7j)


def _perpendicularity(sheet: SheetDrawing, at: complex) -> None:
    sheet.line(at - 1.9 - 1.6j, at + 1.9 - 1.6j)
    sheet.line(at - 1.6j, at + 1.8j)


def _cylindricity(sheet: SheetDrawing, at: complex) -> None:
    sheet.circle(at, 1.0)
    for side in (-1.0, 1.0):
        sheet.line(at + side * 1.25 - 0.7 - 1.9j, at + side * 1.25 + 0.7 + 1.9j)


def _circular_run_out(sheet: SheetDrawing, at: complex) -> None:
    _slanted_arrow(sheet, at)


def _total_run_out(sheet: SheetDrawing, at: complex) -> None:
    _slanted_arrow(sheet, at - 1.0)
    _slanted_arrow(sheet, at + 1.0)
    sheet.line(at - 2.3 - 1.8j, at - 0.3 - 1.8j)


def _slanted_arrow(sheet: SheetDrawing, at: complex) -> None:
    tip, foot = at + 1.3 + 1.8j, at - 1.3 - 1.8j
    sheet.line(foot, tip)
    along = (tip - foot) / abs(tip - foot)
    for side in (1.0, -1.0):
        sheet.line(tip, tip - 1.3 * along + 0.45j * side * along)


_SYMBOLS: dict[str, Any] = {
    "position": _position,
    "profile of a line": _profile_of_a_line,
    "flatness": _flatness,
    "parallelism": _parallelism,
    "perpendicularity": _perpendicularity,
    "cylindricity": _cylindricity,
    "run-out": _circular_run_out,
    "total run-out": _total_run_out,
}


def _chords(loops: Sequence[Sequence[complex]], level: float) -> list[tuple[float, float]]:
    """Where a level line runs inside closed chains, between pairs of x."""
    crossings = []
    for loop in loops:
        for one, two in zip(loop, [*loop[1:], loop[0]], strict=True):
            if (one.imag > level) != (two.imag > level):
                share = (level - one.imag) / (two.imag - one.imag)
                crossings.append(one.real + share * (two.real - one.real))
    crossings.sort()
    return list(zip(crossings[::2], crossings[1::2], strict=True))


def _xy(place: complex) -> tuple[float, float]:
    return float(place.real), float(place.imag)
