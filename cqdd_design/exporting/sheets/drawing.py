"""What a cut sheet is drawn with: lines, text, callouts and geometric tolerances, mm of paper.

Symbols of ISO 1101 are drawn, not written: no font need have them.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from cqdd_design.exporting.sheets.lettering import fitting_height, printable, text_width
from cqdd_design.geometry.contours import Circle, Contour

if TYPE_CHECKING:
    from ezdxf.document import Drawing

OUTLINE, THIN, AXIS = "OUTLINE", "THIN", "AXIS"
_PENS = {OUTLINE: 50, THIN: 18, AXIS: 18}
"""Layers and their pens, hundredths of a millimetre."""
TEXT, SMALL = 2.5, 2.2
"""Cap heights, mm."""
STYLE = "SHEET"
_STYLED: dict[str, Any] = {"dimstyle": STYLE, "dxfattribs": {"layer": THIN}}
"""How every dimension is drawn."""
CELL = 5.6
"""Height of a tolerance frame, mm."""

_HATCH = 4.0
"""Between hatching lines, mm along an edge."""
_CENTRE_LINE = [10.0, 6.0, -1.5, 1.0, -1.5]


def new_sheet(scale: float) -> SheetDrawing:
    """Start a sheet whose dimensions measure `scale` millimetres of paper as one."""
    from ezdxf.filemanagement import new

    drawing = new("R2010", setup=False, units=4)
    drawing.linetypes.add("CENTRE", pattern=_CENTRE_LINE, description="centre line")
    # No font of the machine: dimensions reckon with a cap height a character.
    drawing.styles.add(STYLE, font="*monospace")
    for name, pen in _PENS.items():
        drawing.layers.add(
            name, lineweight=pen, linetype="CENTRE" if name == AXIS else "CONTINUOUS"
        )
    style = drawing.dimstyles.add(STYLE)
    settings = {
        **{"dimtxt": TEXT, "dimtxsty": STYLE, "dimtad": 1, "dimtih": 0, "dimtoh": 0},
        **{"dimasz": 2.5, "dimexe": 1.2, "dimexo": 0.8, "dimgap": 0.8, "dimlwd": 18, "dimlwe": 18},
        **{"dimdec": 3, "dimadec": 3, "dimdsep": ord("."), "dimzin": 8, "dimazin": 2},
        "dimlfac": 1.0 / scale,
    }
    for name, value in settings.items():
        style.dxf.set(name, value)
    return SheetDrawing(drawing, scale)


class SheetDrawing:
    """A document in millimetres of paper, and the few things that are drawn into it.

    Attributes
    ----------
    scale : float
        Millimetres of paper for one of the part.
    """

    def __init__(self, drawing: Drawing, scale: float) -> None:
        self.drawing = drawing
        self.scale = scale
        self._space = drawing.modelspace()

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

    def circle(self, centre: complex, radius: float, layer: str = THIN) -> None:
        """Draw a circle."""
        self._space.add_circle(_xy(centre), radius, dxfattribs={"layer": layer})

    def arc(self, centre: complex, radius: float, start: float, end: float) -> None:
        """Draw a thin arc between two angles, deg."""
        self._space.add_arc(_xy(centre), radius, start, end, dxfattribs={"layer": THIN})

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

    def text(
        self, place: complex, words: str, height: float = TEXT, room: float = math.inf
    ) -> float:
        """Write a line from its lower left corner, smaller where `room` asks; its width."""
        words = printable(words)
        size = fitting_height(words, height, room)
        self._space.add_text(
            words, height=size, dxfattribs={"layer": THIN, "insert": _xy(place), "style": STYLE}
        )
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

    def diameter(self, centre: complex, radius: float, angle: float, share: float) -> None:
        """Dimension a circle across at `angle` (deg), the text at `share` of the radius."""
        place = centre + cmath.rect(share * radius, math.radians(angle))
        self._space.add_diameter_dim(
            center=_xy(centre), radius=radius, angle=angle, location=_xy(place), **_STYLED
        ).render()

    def radius(self, centre: complex, radius: float, angle: float, place: complex) -> None:
        """Dimension an arc at `angle` (deg) of it, the text at `place`, with a leader there."""
        self._space.add_radius_dim(
            center=_xy(centre), radius=radius, angle=angle, location=_xy(place), **_STYLED
        ).render()

    def angle(self, centre: complex, radius: float, start: float, end: float, out: float) -> None:
        """Dimension the angle between two directions (deg) at `radius`, the text farther `out`."""
        middle = math.radians(0.5 * (start + end))
        self._space.add_angular_dim_cra(
            center=_xy(centre),
            radius=radius,
            start_angle=start,
            end_angle=end,
            distance=0.0,
            location=_xy(centre + cmath.rect(radius + out, middle)),
            **_STYLED,
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

    def datum(self, foot: complex, toward: complex, letter: str) -> None:
        """Mark a datum: a triangle on its feature, a line, the letter in a box."""
        along = toward / abs(toward)
        corners = [foot + 2.2 * along, foot + 1.3j * along, foot - 1.3j * along]
        self._space.add_solid([_xy(c) for c in corners], dxfattribs={"layer": THIN})
        middle = foot + (5.0 + 0.5 * CELL) * along
        self.line(foot + 2.2 * along, foot + 5.0 * along)
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


_SYMBOLS: dict[str, Any] = {
    "position": _position,
    "profile of a line": _profile_of_a_line,
    "flatness": _flatness,
    "parallelism": _parallelism,
    "perpendicularity": _perpendicularity,
}


def _xy(place: complex) -> tuple[float, float]:
    return float(place.real), float(place.imag)
