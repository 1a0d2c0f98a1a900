"""Callouts of a sheet: lines of text, boxed sizes, tolerance frames and surface signs in a block.

Blocks stand on a stair beside a view, so that no leader runs through another block::

      _________________
     | third |  ______ |______
     |         | second       |  _______
     |         |                | first |
     |         |                |
    =====================================   the view

Each leader rises straight from what it points to, and a block begins at its leader. A block stands
above every block that its own width reaches over, whose leaders end below it therefore.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from cqdd_design.exporting.sheets.drawing import CELL, SMALL, TEXT, SheetDrawing
from cqdd_design.exporting.sheets.lettering import text_width

_GAP, _INDENT = 1.6, 1.5
_BETWEEN = 2.0
"""Between blocks, mm."""
_APART = 2.4
"""Least distance between two leaders, mm."""
_SIGN = 8.6
"""Width of a surface sign without its value, mm."""


@dataclass(frozen=True)
class Words:
    """A piece of text."""

    text: str
    height: float = SMALL

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        return text_width(self.text, self.height), self.height + 1.8

    def draw(self, sheet: SheetDrawing, corner: complex) -> None:
        """Write it above its lower left corner."""
        sheet.text(corner + 0.9j, self.text, self.height)


@dataclass(frozen=True)
class Boxed:
    """A theoretically exact dimension (ISO 1101)."""

    text: str

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        return text_width(self.text, SMALL) + 1.6, SMALL + 2.4

    def draw(self, sheet: SheetDrawing, corner: complex) -> None:
        """Write it in its box."""
        width, height = self.size
        sheet.box(corner + 0.2j, width, height - 0.4)
        sheet.text(corner + 0.8 + 1.2j, self.text, SMALL)


@dataclass(frozen=True)
class Frame:
    """A tolerance frame (ISO 1101)."""

    symbol: str
    value: str
    datums: tuple[str, ...] = ()

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        cells = (self.value, *self.datums)
        wide = sum(max(text_width(words, TEXT) + 2.4, CELL) for words in cells)
        return CELL + wide, CELL + 0.8

    def draw(self, sheet: SheetDrawing, corner: complex) -> None:
        """Draw it."""
        sheet.tolerance(corner + 0.4j, self.symbol, self.value, self.datums)


@dataclass(frozen=True)
class Surface:
    """The sign for a surface from which material is removed, with its roughness (ISO 21920)."""

    value: str

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        return 1.7 + 3.9 + text_width(self.value, SMALL) + 1.0, 6.8

    def draw(self, sheet: SheetDrawing, corner: complex) -> None:
        """Draw it."""
        sheet.finish(corner + 1.8, self.value)


@dataclass(frozen=True)
class DatumMark:
    """A letter in a box with its triangle, to the right of a line it stands on."""

    letter: str

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        return 5.0 + CELL, CELL + 0.8

    def draw(self, sheet: SheetDrawing, corner: complex) -> None:
        """Draw it."""
        sheet.datum(corner + 0.5j * self.size[1], 1.0 + 0j, self.letter)


Cell: TypeAlias = Words | Boxed | Frame | Surface | DatumMark
Row: TypeAlias = tuple[Cell, ...]
Box: TypeAlias = tuple[float, float, float, float]
"""Left, bottom, right, top, mm."""
Tip: TypeAlias = Literal["arrow", "dot", "face"]


@dataclass(frozen=True)
class Block:
    """Rows of a callout from the top down, and what it points to, mm of paper.

    Attributes
    ----------
    target : complex
    tip : {"arrow", "dot", "face"}
        How the leader ends: with an arrow on an edge, a dot within an outline, or as an extension
        of a face that is seen edge on.
    """

    target: complex
    rows: tuple[Row, ...]
    tip: Tip = "arrow"

    @property
    def width(self) -> float:
        """In mm."""
        widths = (sum(c.size[0] for c in row) + _GAP * (len(row) - 1) for row in self.rows)
        return _INDENT + max(widths)

    @property
    def height(self) -> float:
        """In mm."""
        return sum(max(cell.size[1] for cell in row) for row in self.rows)


@dataclass(frozen=True)
class Placed:
    """A block on the sheet: its leader's x, its y nearest to the view, and where it goes."""

    block: Block
    x: float
    y: float
    right: bool
    up: bool

    @property
    def box(self) -> Box:
        """Left, bottom, right, top, mm."""
        width, height = self.block.width, self.block.height
        left = self.x if self.right else self.x - width
        bottom = self.y if self.up else self.y - height
        return left, bottom, left + width, bottom + height

    def draw(self, sheet: SheetDrawing, shift: complex) -> None:
        """Draw block and leader, moved."""
        left, bottom, right, top = self.box
        corner = complex(left, bottom) + shift
        block, target = self.block, self.block.target + shift
        foot = complex(self.x + shift.real, corner.imag)
        self._leader(sheet, target, foot)
        sheet.line(corner, corner + (right - left))
        level = top + shift.imag
        for row in block.rows:
            level -= max(cell.size[1] for cell in row)
            x = corner.real + (_INDENT if self.right else 0.2)
            for cell in row:
                cell.draw(sheet, complex(x, level))
                x += cell.size[0] + _GAP

    def _leader(self, sheet: SheetDrawing, target: complex, foot: complex) -> None:
        sheet.line(target, foot)
        if self.block.tip == "arrow":
            sheet.triangle(target, target - foot)
        elif self.block.tip == "dot":
            sheet.dot(target)


def stair(
    blocks: Sequence[tuple[Block, float]], level: float, *, right: bool, up: bool
) -> list[Placed]:
    """Place blocks on one stair.

    Parameters
    ----------
    blocks : sequence of (Block, float)
        In a frame of the view, each with the x of its leader, mm.
    level : float
        Where the stair begins, mm: above it where `up`, below it otherwise.
    right, up : bool
        Whether blocks reach to the right of their leaders, and whether the stair rises.
    """
    side, way = (1.0 if right else -1.0), (1.0 if up else -1.0)
    done: list[tuple[float, float]] = []
    placed = []
    for block, x in sorted(blocks, key=lambda pair: -side * pair[1]):
        reach = side * x + block.width + _BETWEEN
        low = max([way * level, *(top for start, top in done if start < reach)])
        done.append((side * x, low + block.height + _BETWEEN))
        placed.append(Placed(block, x, way * low, right, up))
    return placed


@dataclass(frozen=True)
class Extent:
    """A box on paper, mm."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        """In mm."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """In mm."""
        return self.top - self.bottom

    @classmethod
    def of(cls, boxes: Sequence[Box]) -> Extent:
        """Round several boxes."""
        left, bottom, right, top = zip(*boxes, strict=True)
        return cls(min(left), min(bottom), max(right), max(top))


def distance_beside(left: Sequence[Box], right: Sequence[Box], gap: float) -> float:
    """How far to the right of one group of boxes another must stand to keep a gap from it, mm."""
    return max(
        (
            one[2] - two[0] + gap
            for one in left
            for two in right
            if one[1] < two[3] + gap and two[1] < one[3] + gap
        ),
        default=0.0,
    )


def stairs(blocks: Sequence[Block], level: float, *, up: bool) -> list[Placed]:
    """Two stairs beside each other: the left half of the blocks goes to the left."""
    way = 1.0 if up else -1.0
    ordered = sorted(blocks, key=lambda block: (block.target.real, -way * block.target.imag))
    leaders = spread([block.target.real for block in ordered], _APART)
    pairs = list(zip(ordered, leaders, strict=True))
    half = len(pairs) // 2
    return [
        *stair(pairs[:half], level, right=False, up=up),
        *stair(pairs[half:], level, right=True, up=up),
    ]


def spread(wanted: Sequence[float], apart: float) -> list[float]:
    """Places near the wanted ones in their order, `apart` from each other."""
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    blocks: list[list[float]] = []
    for rank, i in enumerate(order):
        blocks.append([wanted[i] - rank * apart, 1.0])
        while len(blocks) > 1 and blocks[-1][0] < blocks[-2][0]:
            mean, size = blocks.pop()
            other, others = blocks.pop()
            blocks.append([(mean * size + other * others) / (size + others), size + others])
    level = [mean for mean, size in blocks for _ in range(int(size))]
    places = [0.0] * len(wanted)
    for rank, i in enumerate(order):
        places[i] = level[rank] + rank * apart
    return places
