"""Border, title block, notes and table of cuts of a cut sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.exporting.edm.cut_facts import CUT_FINISH, zone_text
from cqdd_design.exporting.edm.wire_path import contour_name, contour_size
from cqdd_design.exporting.sheets.canvas import sheet_date
from cqdd_design.exporting.sheets.drawing import OUTLINE, SMALL, SheetDrawing
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.geometry.columns import has_columns
from cqdd_design.geometry.contours import Circle
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.cut_facts import CutFacts

WIDTH, HEIGHT = 420.0, 297.0
"""A3 lying, mm."""
LEFT, BOTTOM, RIGHT, TOP = 20.0, 10.0, 410.0, 287.0
"""Border by ISO 5457."""

_MM = 1e3
_TITLE = complex(230.0, BOTTOM)
_TITLE_WIDTH, _ROW = 180.0, 8.0
_NOTES = complex(308.0, 280.0)
_NOTE_WIDTH, _NOTE_PITCH, _INDENT = 99.0, 3.9, 5.0
_TABLE = complex(LEFT + 4.0, 78.0)
_MOST_ROWS = 12
_CUT_COLUMNS = {
    **{"cut": 0.0, "contour": 10.0, "size": 42.0, "centre X": 74.0, "centre Y": 96.0},
    **{"start X": 118.0, "start Y": 140.0, "start \u00d8": 162.0},
}
"""Columns of the table of cuts, and where they begin, mm."""
_CUTS_WIDTH = 182.0


def draw_frame(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Draw everything on a sheet but the views."""
    sheet.box(complex(LEFT, BOTTOM), RIGHT - LEFT, TOP - BOTTOM, OUTLINE)
    _title_block(sheet, facts)
    _notes(sheet, facts)
    _cuts(sheet, facts)


def _title_block(sheet: SheetDrawing, facts: CutFacts) -> None:
    flat, design = facts.flat, facts.design
    scale = sheet.scale
    ratio = f"{scale:g} : 1" if scale >= 1.0 else f"1 : {1.0 / scale:g}"
    rows: list[list[tuple[str, str, float]]] = [
        [
            ("made by", f"cqdd-design {__version__}", 40.0),
            ("design", design.sha256[:16], 44.0),
            ("date", sheet_date() or "-", 30.0),
            ("scale", ratio, 22.0),
            ("sheet", "1 / 1, A3", 22.0),
            ("projection", "", 22.0),
        ],
        [
            (
                "general tolerances",
                "ISO 2768-fH, sizes in mm, edges broken 0.1 \u00d7 45\u00b0",
                92.0,
            ),
            ("surfaces", f"cut {CUT_FINISH}, ground where marked", 88.0),
        ],
        [
            ("thickness", f"{_MM * flat.thickness:g} mm", 40.0),
            ("quantity", facts.quantity_text, 52.0),
            ("mass of one", f"{_MM * facts.mass:.1f} g", 44.0),
            ("hardness", facts.hardness, 44.0),
        ],
        [
            ("material", flat.material, 92.0),
            ("heat treatment", facts.heat_treatment, 88.0),
        ],
    ]
    for number, row in enumerate(rows):
        x, y = _TITLE.real, _TITLE.imag + number * _ROW
        for heading, words, width in row:
            corner = complex(x, y)
            sheet.box(corner, width, _ROW)
            sheet.text(corner + 1.0 + 5.6j, heading, 1.5)
            sheet.text(corner + 1.2 + 1.6j, words, 2.5, width - 2.4)
            x += width
    _projection_sign(sheet, complex(_TITLE.real + 169.0, _TITLE.imag + 2.9))
    corner = _TITLE + 1j * len(rows) * _ROW
    sheet.box(corner, _TITLE_WIDTH, 15.0)
    sheet.text(corner + 2.0 + 8.6j, f"{design.name}-{flat.label}", 4.5, 176.0)
    sheet.text(corner + 2.0 + 2.4j, f"{_title(facts)}; cut by wire EDM", 2.8, 176.0)
    sheet.box(_TITLE, _TITLE_WIDTH, len(rows) * _ROW + 15.0, OUTLINE)


def _title(facts: CutFacts) -> str:
    reducer = facts.design.reducer
    if facts.flat.label == "ring":
        return f"ring of {reducer.ring_tooth_count} teeth"
    columns = f", {reducer.carrier.column_count} for columns" if has_columns(reducer) else ""
    pins = reducer.output_pins.count
    return f"cycloidal disc of {reducer.ratio} lobes, {pins} output holes{columns}"


def _projection_sign(sheet: SheetDrawing, centre: complex) -> None:
    """First angle: the cone beside its view from the left."""
    sheet.circle(centre + 5.0, 2.0)
    sheet.circle(centre + 5.0, 1.1)
    corners = [centre - 1.0 - 2.0j, centre - 1.0 + 2.0j, centre - 5.0 + 1.1j, centre - 5.0 - 1.1j]
    sheet.polygon(corners)


def _notes(sheet: SheetDrawing, facts: CutFacts) -> None:
    lines: list[tuple[str, str]] = []
    for place, note in enumerate(notes(facts), start=1):
        first, *others = _wrapped(note, _NOTE_WIDTH - _INDENT)
        lines += [(f"{place}", first), *(("", line) for line in others)]
    sheet.text(_NOTES, "NOTES", 3.0)
    # All must stay above the title block.
    room = _NOTES.imag - (_TITLE.imag + 4.0 * _ROW + 15.0) - 6.0
    pitch = min(_NOTE_PITCH, room / max(len(lines), 1))
    size = min(SMALL, pitch * SMALL / _NOTE_PITCH)
    for row, (number, line) in enumerate(lines):
        at = _NOTES - 1j * (5.5 + row * pitch)
        if number:
            sheet.text(at, number, size)
        sheet.text(at + _INDENT, line, size)


def notes(facts: CutFacts) -> list[str]:
    """Notes of a sheet, each a sentence or two."""
    flat, edm = facts.flat, facts.design.edm
    offset = _MM * edm.wire_offset
    said = [
        *facts.remarks,
        _curve(facts),
        f"Cut from the file {facts.design.name}-{flat.label}.dxf, layers CUT_OUTER and CUT_INNER: "
        "nominal finished contour without kerf offset. WIRE_PATH is the centre of the wire on the "
        f"finishing cut, {offset:g} mm into the waste.",
        f"Wire \u00d8{_MM * edm.wire_diameter:g} mm, gap {_MM * edm.spark_gap:g} mm.",
        f"Contour as written, read back and measured: {facts.fit_text[0]}.",
        f"{facts.fit_text[1].capitalize()}.",
        f"Profile: zone {zone_text(facts.zones.profile)} mm wide, half to either side of the "
        "contour, after the last skim cut.",
    ]
    said += [
        f"Seat \u00d8{seat}, {contour_name(seat.contour)}: the file is nominal; cut to "
        f"\u00d8{_MM * seat.middle:.4f}, the middle of its zone: shift the wire "
        f"{_MM * seat.shift:+.4f} mm into the waste."
        for seat in facts.seats
    ]
    said += [
        f"Datum A: axis of {'the outside' if flat.label == 'ring' else 'the bore'}. Datum B: lower "
        "face, on the table of the machine.",
        "Cut all contours in one clamping, holes first, the outer contour last.",
        "Stress relieve before cutting. No recast layer on the contour after the last skim cut.",
        "Sizes in brackets are auxiliary.",
    ]
    return said


def _curve(facts: CutFacts) -> str:
    """The shape in the numbers of the design, for whoever wants to check it."""
    reducer = facts.design.reducer
    teeth = (
        f"{reducer.ring_tooth_count} teeth \u00d8{_MM * reducer.tooth_diameter:g} mm on "
        f"\u00d8{2.0 * _MM * reducer.ring_pitch_radius:g} mm"
    )
    if facts.flat.label == "ring":
        return f"Contour: {teeth}; the file rules."
    taken = _MM * reducer.modification.equidistant
    return (
        f"Contour: {reducer.ratio} lobes for {teeth}, eccentricity "
        f"{_MM * reducer.eccentricity:g} mm, {taken:g} mm taken off along the normal; the file "
        "rules."
    )


def _wrapped(text: str, width: float) -> list[str]:
    lines, line = [], ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and text_width(longer, SMALL) > width:
            lines.append(line)
            line = word
        else:
            line = longer
    return [*lines, line]


def _cuts(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Table of contours in the order they are cut."""
    rows = [tuple(_CUT_COLUMNS), *cut_rows(facts)]
    pitch = 4.6
    sheet.text(_TABLE + 2.0j, "CUTS IN ORDER, mm FROM THE AXIS OF THE PART", 3.0)
    for number, row in enumerate(rows):
        y = _TABLE - 1j * (number + 1) * pitch
        for x, words in zip(_CUT_COLUMNS.values(), row, strict=True):
            sheet.text(y + x + 1.0 + 1.2j, words, SMALL)
        sheet.line(y, y + _CUTS_WIDTH)
    sheet.line(_TABLE, _TABLE + _CUTS_WIDTH)
    for x in (0.0, _CUTS_WIDTH):
        sheet.line(_TABLE + x, _TABLE + x - 1j * len(rows) * pitch)


def cut_rows(facts: CutFacts) -> list[tuple[str, ...]]:
    """Rows of the table of cuts; of very many holes the first and the last."""
    flat = facts.flat
    rows = []
    for step, number in enumerate(flat.cut_order, start=1):
        contour, path = flat.contours[number], facts.paths[number]
        size = contour_size(contour, "\u00d8")
        centre = complex(*contour.centre) if isinstance(contour, Circle) else 0j
        places = [_place(v) for at in (centre, path.start) for v in (at.real, at.imag)]
        hole = f"{_MM * path.start_diameter:.2f}"
        rows.append((str(step), contour_name(number), size, *places, hole))
    if len(rows) > _MOST_ROWS:
        skipped = ("...", f"{len(rows) - _MOST_ROWS + 1} more: see the DXF", "", "", "", "", "", "")
        rows = [*rows[: _MOST_ROWS - 2], skipped, rows[-1]]
    return rows


def _place(value: float) -> str:
    """A coordinate in mm to 0.1 um; never ``-0``."""
    return f"{round(_MM * value, 4) + 0.0:.4f}"
