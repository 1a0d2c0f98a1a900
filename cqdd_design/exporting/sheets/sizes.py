"""Sizes of a turned part beside its section: diameters in columns, lengths from one face.

Diameters stand to either side, the smallest nearest to the part, so that no extension line runs
through a number; lengths run from the datum face under the section (ISO 129-1, running
dimensioning)::

        o|   o|   ________________   |o
        ||   ||  |   section      |  ||
    Ø30 || Ø8||  |                |  ||Ø20
        ||   ||  |________________|  ||
        o|   o|  0    5     12   20  |o
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from cqdd_design.exporting.sheets.blocks import Block, Box, Placed, Row, spread, stair
from cqdd_design.exporting.sheets.drawing import CELL, SMALL, STEM, TEXT, SheetDrawing
from cqdd_design.exporting.sheets.lettering import short_number, text_width
from cqdd_design.exporting.sheets.wording import FREE_DECIMALS

_FIRST, _PITCH = 11.0, 8.0
"""From the part to the first column of diameters, and from column to column, mm."""
_ROW = 4.4
"""Least distance of two lengths, mm."""
_ARROWS = 7.0
"""Below this a dimension's arrows point at it from outside, mm."""
_CLOSE = 5.0
"""Lengths nearer to each other have strokes instead of arrows, mm."""
_ZERO = 5e-5
"""Lengths below this are written as 0, mm."""
_CLEAR = 1.0
"""From a datum's box to extension lines above and below it, mm."""
_DATUM = 12.0
"""Room that a datum takes below its dimension, mm."""


@dataclass(frozen=True)
class Diameter:
    """A diameter to write beside the section.

    Attributes
    ----------
    radius, middle : float
        Half of it, and how far its axis stands above the part's, mm of paper.
    begin, end : float
        Of its cylinder along the axis, mm of paper from the middle of the section.
    text : str
    rows : tuple of Row
        Surface and tolerance frames of the cylinder.
    datum : str
        Letter of the datum that its axis is, or nothing.
    """

    radius: float
    middle: float
    begin: float
    end: float
    text: str
    rows: tuple[Row, ...] = ()
    datum: str = ""

    @property
    def top(self) -> float:
        """Height of its upper generatrix, mm."""
        return self.middle + self.radius

    @property
    def reach(self) -> float:
        """Farthest from the part's axis, mm."""
        return abs(self.middle) + self.radius

    @property
    def low(self) -> float:
        """Height of its lower generatrix, mm."""
        return self.middle - self.radius

    @property
    def foot(self) -> float:
        """Height at which its datum begins, mm."""
        return self.low if 2.0 * self.radius >= _ARROWS else self.low - 5.0


@dataclass(frozen=True)
class Column:
    """A diameter where it is written, mm.

    Attributes
    ----------
    x, text_at : float
        Of its dimension line, and where its text begins.
    edge : float
        Of its cylinder, from which its extension lines come.
    stem : float
        From its datum's foot to the letter's box.
    """

    size: Diameter
    x: float
    text_at: float
    edge: float
    stem: float = STEM

    def draw(self, sheet: SheetDrawing, shift: complex) -> None:
        """Draw extension lines, dimension line, text and datum."""
        size, out = self.size, math.copysign(1.0, self.x)
        low, high = size.middle - size.radius, size.middle + size.radius
        for level in (low, high):
            begin = complex(self.edge + out * 0.8, level)
            sheet.line(shift + begin, shift + complex(self.x + out * 1.2, level))
        upper = max(high, self.text_at + self.length)
        if 2.0 * size.radius < _ARROWS:
            sheet.line(
                shift + complex(self.x, low - 5.0), shift + complex(self.x, max(upper, high + 5.0))
            )
            ends = ((low, 1j), (high, -1j))
        else:
            over = upper if self.text_at >= high else high
            sheet.line(shift + complex(self.x, low), shift + complex(self.x, over))
            ends = ((low, -1j), (high, 1j))
        for level, toward in ends:
            sheet.triangle(shift + complex(self.x, level), toward)
        place = complex(self.x - 0.9, self.text_at)
        sheet.text(shift + place, size.text, TEXT, turn=90.0)
        if size.datum:
            sheet.datum(shift + complex(self.x, size.foot), -1j, size.datum, self.stem)

    @property
    def length(self) -> float:
        """Of the text, mm."""
        return text_width(self.size.text, TEXT)


@dataclass(frozen=True)
class Sizes:
    """All columns and the blocks that hang below them, and how much room they take, mm."""

    columns: tuple[Column, ...]
    placed: tuple[Placed, ...]
    left: float
    right: float
    top: float

    @property
    def boxes(self) -> list[Box]:
        """Of the blocks below the columns, and of the datums over them."""
        datums = [
            (c.x - 3.0, min(c.size.low - _DATUM, c.size.foot - c.stem - CELL) - 2.0, c.x + 3.0, 0.0)
            for c in self.columns
            if c.size.datum
        ]
        return [*datums, *(one.box for one in self.placed)]

    def draw(self, sheet: SheetDrawing, shift: complex) -> None:
        """Draw all of them about the middle of the section."""
        for column in self.columns:
            column.draw(sheet, shift)
        for one in self.placed:
            one.draw(sheet, shift)


def columns_of(
    left: Sequence[Diameter], right: Sequence[Diameter], half: float, reach: float
) -> Sizes:
    """Columns to the left and to the right of a section, and their frames below.

    Parameters
    ----------
    half : float
        Half of the section's length, mm.
    reach : float
        Its greatest radius, mm.
    """
    columns: list[Column] = []
    placed: list[Placed] = []
    for given, out in ((left, -1.0), (right, 1.0)):
        ordered = sorted(given, key=lambda d: (d.reach, d.begin))
        most = max((d.reach for d in ordered), default=0.0)
        rows: list[tuple[Block, float]] = []
        for place, size in enumerate(ordered):
            x = out * (half + _FIRST + _PITCH * place)
            wide = text_width(size.text, TEXT)
            fits = wide + 2.0 * 3.5 <= 2.0 * size.radius
            at = size.middle - 0.5 * wide if fits else most + 4.0
            edge = size.begin if out < 0.0 else size.end
            passing = [other.low for other in ordered[place + 1 :]]
            columns.append(Column(size, x, at, edge, clear_stem(size.foot, passing)))
            if size.rows:
                foot = complex(x - out * 2.6, size.middle - size.radius)
                rows.append((Block(foot, size.rows), foot.real))
        level = -max(reach, most) - (_DATUM if any(d.datum for d in ordered) else 3.0) - 2.0
        placed += stair(rows, level, right=out > 0.0, up=False)
    return Sizes(
        tuple(columns),
        tuple(placed),
        left=min([-half - 6.0, *(c.x - 4.0 for c in columns)]),
        right=max([half + 6.0, *(c.x + 2.0 for c in columns)]),
        top=max([reach, *(c.text_at + c.length for c in columns)]),
    )


def clear_stem(foot: float, levels: Sequence[float]) -> float:
    """Length of a datum's stem at which no line at one of the levels runs through its box, mm."""
    stem = STEM
    for level in sorted(levels, reverse=True):
        if foot - stem - CELL - _CLEAR < level < foot - stem + _CLEAR:
            stem = foot - level + _CLEAR
    return stem


@dataclass(frozen=True)
class Lengths:
    """Running lengths under a section: places along it (mm of paper), values and tolerances (mm).

    A tolerance of 0 is the general one.
    """

    marks: tuple[tuple[float, float, float], ...]
    origin: float
    level: float

    @property
    def depth(self) -> float:
        """Of the room they take below their line, mm."""
        widest = max((text_width(self._words(v, t), SMALL) for _, v, t in self.marks), default=0.0)
        return 9.0 + widest

    @property
    def width(self) -> float:
        """Of the row of values, mm."""
        places = spread([x for x, _, _ in self.marks], _ROW)
        return 2.0 * max(map(abs, places), default=0.0) + _ROW

    @staticmethod
    def _words(value: float, either: float) -> str:
        if not either:
            return short_number(value, FREE_DECIMALS)
        return f"{short_number(value, 4)} \u00b1{short_number(either, 4)}"

    def draw(self, sheet: SheetDrawing, shift: complex, bottoms: Sequence[float]) -> None:
        """Draw extension lines from the part, the line with its origin, and the values."""
        y = self.level
        rising = sorted(x for x, _, _ in self.marks)
        places = spread([x for x, _, _ in self.marks], _ROW)
        at = sorted(zip(self.marks, places, bottoms, strict=True))
        for (x, value, either), place, bottom in at:
            sheet.line(shift + complex(x, bottom - 0.8), shift + complex(x, y - 1.2))
            if abs(value) < _ZERO:
                sheet.circle(shift + complex(x, y), 1.2)
            elif min((abs(x - other) for other in rising if other != x), default=9.0) < _CLOSE:
                # No room for an arrow: an oblique stroke (ISO 129-1).
                sheet.line(shift + complex(x - 0.9, y - 0.9), shift + complex(x + 0.9, y + 0.9))
            else:
                sheet.triangle(shift + complex(x, y), complex(x - self.origin, 0.0))
            sheet.line(shift + complex(x, y - 1.2), shift + complex(place, y - 4.5))
            words = self._words(value, either)
            wide = text_width(words, SMALL)
            sheet.text(
                shift + complex(place + 0.5 * SMALL, y - 5.4 - wide), words, SMALL, turn=90.0
            )
        ends = [x for x, _, _ in self.marks]
        for end in (min(ends), max(ends)):
            if abs(end - self.origin) > _ZERO:
                sheet.line(shift + complex(self.origin, y), shift + complex(end, y))
