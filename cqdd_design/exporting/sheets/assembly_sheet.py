"""The assembly drawing: section with balloons, parts list, torques, notes, order of assembly.

::

    +----------------------------------------------+
    |    1 2 3 4                parts list         |
    |   section of              torques            |
    |   the machine             notes              |
    |   order of assembly    +---- title block ----|
    +------------------------+---------------------+
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from cqdd_design.exporting.sheets import title_block as block
from cqdd_design.exporting.sheets.assembly_facts import PARTS_HEAD, PLAY_HEAD
from cqdd_design.exporting.sheets.assembly_view import AssemblyView
from cqdd_design.exporting.sheets.drawing import SMALL, SheetDrawing, new_sheet
from cqdd_design.exporting.sheets.formats import A3, BOTTOM, LEFT

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts

_ROWS = 2
_ORDER = block.title_top(_ROWS) + 25.0
"""Upper edge of the order of assembly, mm."""
_ROOM = (LEFT + 4.0, _ORDER + 4.0, A3.title.real - 4.0, A3.top - 4.0)
"""Of the section with its balloons, mm."""
_AROUND = 18.0
"""Taken by balloons above and below, mm."""
_PARTS = (8.0, 7.0, 36.0, 67.0, 46.0, 12.5)
_TORQUES = (70.0, 84.0, 24.0)
_PLAYS = (64.0, 29.0, 29.0, 27.0, 29.0)
_PITCH, _LEAST_PITCH = 4.0, 2.8
_HEAD, _BETWEEN = 3.4, 3.0
"""From the upper edge of a table's title to the table, and between tables, mm."""


def draw_assembly(facts: AssemblyFacts) -> SheetDrawing:
    """Draw the assembly of a machine."""
    view = AssemblyView(facts.machine)
    left, bottom, right, top = _ROOM
    long, wide = 1e3 * (view.ends[1] - view.ends[0]), 2e3 * view.reach
    scale = next(
        (
            one
            for one in block.SCALES
            if one * long + 16.0 <= right - left and one * wide + 2.0 * _AROUND <= top - bottom
        ),
        block.SCALES[-1],
    )
    sheet = new_sheet(scale)
    block.draw_border(sheet)
    view.draw(sheet, complex(0.5 * (left + right), 0.5 * (bottom + top)))
    corner = complex(A3.title.real + 1.0, A3.top - 3.0)
    rows = [PARTS_HEAD, *facts.parts_list()]
    torques = [("screwed joint", "screws", "torque, N\u00b7m"), *facts.torques()]
    plays = [PLAY_HEAD, *facts.plays()]
    said = [*facts.notes(), *_unnumbered(facts, view)]
    wide, foot = A3.right - corner.real - 2.0, block.title_top(_ROWS) + 2.0
    tables = ((_PARTS, rows), (_TORQUES, torques), (_PLAYS, plays))

    def taken(pitch: float) -> float:
        """Height of all that stands above the title block, mm."""
        lines = sum(_row_lines(row, widths, pitch) for widths, many in tables for row in many)
        notes = block.notes_height(said, wide, 2, SMALL * pitch / _PITCH)
        return lines * pitch + len(tables) * (_HEAD + _BETWEEN) + 2.0 + notes

    pitch = _PITCH
    while pitch > _LEAST_PITCH and taken(pitch) > corner.imag - foot:
        pitch *= 0.97
    corner = table(sheet, corner, "PARTS", _PARTS, rows, pitch)
    corner = table(sheet, corner - 1j * _BETWEEN, "SCREWS", _TORQUES, torques, pitch)
    corner = table(sheet, corner - 1j * _BETWEEN, "AXIAL PLAY", _PLAYS, plays, pitch)
    corner -= 1j * (_BETWEEN + 2.0)
    block.draw_notes(sheet, corner, said, width=wide, height=corner.imag - foot, columns=2)
    _order(sheet, facts)
    _title(sheet, facts)
    return sheet


def _unnumbered(facts: AssemblyFacts, view: AssemblyView) -> list[str]:
    """A note on parts that the section does not cut."""
    numbered = view.spots()
    others = [str(n) for n in range(1, len(facts.parts) + 1) if n not in numbered]
    return [f"Not cut by the section: {', '.join(others)}."] if others else []


def table(
    sheet: SheetDrawing,
    corner: complex,
    title: str,
    widths: Sequence[float],
    rows: Sequence[Sequence[str]],
    pitch: float,
) -> complex:
    """Draw a table under its title from its upper left corner; its lower left corner."""
    size = min(SMALL, 0.55 * pitch)
    sheet.text(corner - 2.4j, title, 2.4)
    top = corner - 1j * _HEAD
    whole = sum(widths)
    sheet.line(top, top + whole)
    level = top
    for row in rows:
        cells, x = _cells(row, widths, size), 0.0
        for lines, width in zip(cells, widths, strict=True):
            for place, line in enumerate(lines, start=1):
                at = level + x + 0.8 + 1j * (0.24 - place) * pitch
                sheet.text(at, line, size, width - 1.4)
            x += width
        level -= 1j * max(map(len, cells)) * pitch
        sheet.line(level, level + whole)
    x, end = 0.0, top - level
    for width in (0.0, *widths):
        x += width
        sheet.line(top + x, top + x - end)
    return top - end


def _cells(row: Sequence[str], widths: Sequence[float], size: float) -> list[list[str]]:
    """Lines of every cell of a row."""
    return [
        block.wrapped(words, width - 1.6, size) for words, width in zip(row, widths, strict=True)
    ]


def _row_lines(row: Sequence[str], widths: Sequence[float], pitch: float) -> int:
    """Of a row of a table, the most of its cells."""
    return max(map(len, _cells(row, widths, min(SMALL, 0.55 * pitch))))


def _order(sheet: SheetDrawing, facts: AssemblyFacts) -> None:
    steps = facts.order()
    corner = complex(LEFT + 4.0, _ORDER)
    said = steps or ["no order was found in which every part reaches its place"]
    block.draw_notes(
        sheet,
        corner,
        said,
        width=A3.title.real - corner.real - 3.0,
        height=corner.imag - BOTTOM - 2.0,
        columns=3,
        title="ORDER OF ASSEMBLY",
    )


def _title(sheet: SheetDrawing, facts: AssemblyFacts) -> None:
    rows: list[list[block.Field]] = [
        [
            ("tolerances", "ISO 8015; those of the parts on their sheets", 92.0),
            ("mass", f"{facts.mass:.4g} kg, motor as drawn", 88.0),
        ],
    ]
    block.draw_title_block(sheet, facts.design, facts.number, "actuator, assembly", rows)
