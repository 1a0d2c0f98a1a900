"""Border and title block of every sheet (ISO 5457, ISO 7200), and signs that stand in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from cqdd_design.exporting.sheets.canvas import sheet_date
from cqdd_design.exporting.sheets.drawing import OUTLINE, SMALL, SheetDrawing
from cqdd_design.exporting.sheets.formats import BOTTOM, LEFT, TITLE_WIDTH, scale_words
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.solids.features.edges import BROKEN_EDGE
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.design import Design

ROW, HEAD = 8.0, 15.0
"""Heights in the title block, mm."""
SCALES = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02)
"""ISO 5455."""
OUTER_EDGE, INNER_EDGE = f"-{1e3 * BROKEN_EDGE:g}", "+0.3"
"""Edges without an indication of their own (ISO 13715): outside ones lose 0.3 mm at most and carry
no burr, inside ones keep 0.3 mm at most."""

Field = tuple[str, str, float]
"""Heading, words, width in mm."""


def draw_border(sheet: SheetDrawing) -> None:
    """Draw the border of the sheet."""
    paper = sheet.paper
    sheet.box(complex(LEFT, BOTTOM), paper.right - LEFT, paper.top - BOTTOM, OUTLINE)


def title_top(rows: int) -> float:
    """Upper edge of a title block of so many rows, mm."""
    return BOTTOM + rows * ROW + HEAD


def draw_title_block(
    sheet: SheetDrawing, design: Design, number: str, words: str, rows: Sequence[Sequence[Field]]
) -> None:
    """Draw the title block.

    Parameters
    ----------
    number : str
        Of the drawing: the stem of its files.
    words : str
        What it shows.
    rows : sequence of rows of Field
        From the bottom up, above the row of what every sheet says; each is 180 mm wide.
    """
    every, start = [_common(sheet, design), *rows], sheet.paper.title
    for place, row in enumerate(every):
        x, y = start.real, start.imag + place * ROW
        for heading, said, width in row:
            corner = complex(x, y)
            sheet.box(corner, width, ROW)
            sheet.text(corner + 1.0 + 5.6j, heading, 1.5)
            sheet.text(corner + 1.2 + 1.6j, said, 2.5, width - 2.4)
            x += width
    _projection_sign(sheet, start + 169.0 + 2.9j)
    corner = start + 1j * len(every) * ROW
    sheet.box(corner, TITLE_WIDTH, HEAD)
    sheet.text(corner + 2.0 + 8.6j, number, 4.5, 176.0)
    sheet.text(corner + 2.0 + 2.4j, words, 2.8, 176.0)
    sheet.box(start, TITLE_WIDTH, len(every) * ROW + HEAD, OUTLINE)


def _common(sheet: SheetDrawing, design: Design) -> list[Field]:
    return [
        ("made by", f"cqdd-design {__version__}", 40.0),
        ("revision (of the design)", design.sha256[:12], 44.0),
        ("date", sheet_date(), 30.0),
        ("scale", scale_words(sheet.scale), 22.0),
        ("sheet", f"1 / 1, {sheet.paper.name}", 22.0),
        ("projection", "", 22.0),
    ]


def _projection_sign(sheet: SheetDrawing, centre: complex) -> None:
    """First angle: the cone beside its view from the left."""
    sheet.circle(centre + 5.0, 2.0)
    sheet.circle(centre + 5.0, 1.1)
    corners = [centre - 1.0 - 2.0j, centre - 1.0 + 2.0j, centre - 5.0 + 1.1j, centre - 5.0 - 1.1j]
    sheet.polygon(corners)


_INDENT, _NOTE_HEAD, _NOTE_PITCH = 5.0, 5.5, 3.9
"""Of notes behind their numbers, below their title, and from line to line, mm."""


def draw_notes(
    sheet: SheetDrawing,
    corner: complex,
    notes: Sequence[str],
    *,
    width: float,
    height: float,
    columns: int = 1,
    title: str = "NOTES",
) -> None:
    """Write numbered notes from their upper left corner, smaller where there is little room."""
    size = SMALL
    while size > 1.5 and notes_height(notes, width, columns, size) > height:
        size *= 0.95
    lines = _lines(notes, _note_width(width, columns), size)
    pitch, rows = _NOTE_PITCH * size / SMALL, -(-len(lines) // columns)
    sheet.text(corner, title, 3.0)
    for place, (number, line) in enumerate(lines):
        column, row = divmod(place, rows)
        at = corner + column * width / columns - 1j * (_NOTE_HEAD + row * pitch)
        if number:
            sheet.text(at, number, size)
        sheet.text(at + _INDENT, line, size)


def notes_height(notes: Sequence[str], width: float, columns: int, size: float) -> float:
    """Height that notes take in columns at a size of text, their title's foot at 0, mm."""
    lines = len(_lines(notes, _note_width(width, columns), size))
    return _NOTE_HEAD + -(-lines // columns) * _NOTE_PITCH * size / SMALL


def _note_width(width: float, columns: int) -> float:
    """Of the lines of notes in columns, mm."""
    return width / columns - (4.0 if columns > 1 else 0.0) - _INDENT


def _lines(notes: Sequence[str], width: float, size: float) -> list[tuple[str, str]]:
    lines: list[tuple[str, str]] = []
    for place, note in enumerate(notes, start=1):
        first, *others = wrapped(note, width, size)
        lines += [(f"{place}", first), *(("", line) for line in others)]
    return lines


def wrapped(text: str, width: float, size: float = SMALL) -> list[str]:
    """Lines of a text that are no wider than `width`, mm."""
    lines, line = [], ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and text_width(longer, size) > width:
            lines.append(line)
            line = word
        else:
            line = longer
    return [*lines, line]
