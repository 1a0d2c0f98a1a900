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
_PITCH = 4.0


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
    torques = [("screwed joint", "screws", "torque, N m"), *facts.torques()]
    plays = [PLAY_HEAD, *facts.plays()]
    lower = block.title_top(_ROWS) + 42.0
    lines = len(rows) + len(torques) + len(plays) + 6
    pitch = min(_PITCH, (corner.imag - lower - 10.0) / lines)
    corner = table(sheet, corner, "PARTS", _PARTS, rows, pitch)
    corner = table(sheet, corner - 3.0j, "SCREWS", _TORQUES, torques, pitch)
    corner = table(sheet, corner - 3.0j, "AXIAL PLAY", _PLAYS, plays, pitch)
    room = corner.imag - 5.0 - block.title_top(_ROWS) - 2.0
    said = [*facts.notes(), *_unnumbered(facts, view)]
    block.draw_notes(
        sheet, corner - 5.0j, said, width=A3.right - corner.real - 2.0, height=room, columns=2
    )
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
    top = corner - 3.4j
    whole = sum(widths)
    sheet.line(top, top + whole)
    level = top
    for row in rows:
        cells = [
            block.wrapped(words, width - 1.6, size)
            for words, width in zip(row, widths, strict=True)
        ]
        x = 0.0
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
