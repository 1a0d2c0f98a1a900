"""Border, title block, notes and table of cuts of a cut sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.exporting.edm.cut_facts import CUT_FINISH
from cqdd_design.exporting.edm.wire_path import contour_name, contour_size
from cqdd_design.exporting.sheets.drawing import SMALL, SheetDrawing
from cqdd_design.exporting.sheets.formats import A3, LEFT, PAPERS, Paper
from cqdd_design.exporting.sheets.title_block import (
    INNER_EDGE,
    OUTER_EDGE,
    Field,
    draw_border,
    draw_notes,
    draw_title_block,
    title_top,
)
from cqdd_design.exporting.sheets.wording import SIMULTANEOUS
from cqdd_design.geometry.columns import has_columns
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.cut_facts import CutFacts

_MM = 1e3
_NOTES = complex(308.0, 280.0)
_NOTE_WIDTH = 99.0
_ROWS = 4
"""Of the title block."""
_TABLE = complex(LEFT + 4.0, 78.0)
_GAP = 2.0
"""Between the blocks of a long table, mm."""
_BESIDE, _HEAD = 411.0, 12.0
"""Where blocks begin on larger paper, right of what stands on A3, and below the border, mm."""


class _Table(NamedTuple):
    """How the table of cuts is drawn: rows of a block at most, columns and where they begin, mm."""

    blocks: int
    most: int
    pitch: float
    width: float
    columns: dict[str, float]


_SHORT = _Table(
    1,
    12,
    4.6,
    182.0,
    {
        **{"cut": 0.0, "contour": 10.0, "size": 42.0, "centre X": 74.0, "centre Y": 96.0},
        **{"start X": 118.0, "start Y": 140.0, "start \u00d8": 162.0},
    },
)
_LONG = _Table(
    2,
    15,
    4.0,
    101.0,
    {
        **{"cut": 0.0, "no.": 6.0, "size": 14.5, "centre X": 30.0, "centre Y": 45.0},
        **{"start X": 60.0, "start Y": 75.0, "start \u00d8": 90.0},
    },
)


def paper_for(facts: CutFacts) -> Paper:
    """The smallest paper on which the table of cuts is complete."""
    count = 0 if facts.moulded else len(facts.flat.cut_order)
    return next((one for one in PAPERS if count <= _room(one)), PAPERS[-1])


def _room(paper: Paper) -> int:
    """Rows of cuts that a paper has room for."""
    table = _table(paper, _LONG.most + 1)
    return table.blocks * table.most


def _table(paper: Paper, count: int) -> _Table:
    """How so many rows are drawn on a paper: on a larger one in blocks beside all else."""
    if paper == A3:
        return _SHORT if count <= _SHORT.most else _LONG
    blocks = int((paper.right - _BESIDE + _GAP) // (_LONG.width + _GAP))
    most = int((paper.top - _HEAD - title_top(_ROWS) - _GAP) // _LONG.pitch) - 1
    return _LONG._replace(blocks=blocks, most=most)


def draw_frame(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Draw everything on a sheet but the views."""
    draw_border(sheet)
    _title_block(sheet, facts)
    # All must stay above the title block.
    room = _NOTES.imag - title_top(_ROWS) - 6.0
    draw_notes(sheet, _NOTES, notes(facts), width=_NOTE_WIDTH, height=room + 5.5)
    if not facts.moulded:
        _cuts(sheet, facts)


def _title_block(sheet: SheetDrawing, facts: CutFacts) -> None:
    flat, design = facts.flat, facts.design
    rows: list[list[Field]] = [
        [
            ("tolerances", "ISO 8015, ISO 2768-fH, sizes in mm", 64.0),
            ("edges ISO 13715", f"outside {OUTER_EDGE}, inside {INNER_EDGE}", 44.0),
            ("surfaces", _surfaces(facts), 72.0),
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
    words = f"{_title(facts)}; {facts.moulded or 'cut by wire EDM'}"
    draw_title_block(sheet, design, f"{design.file_name}-{flat.label}", words, rows)


def _surfaces(facts: CutFacts) -> str:
    if facts.moulded:
        return f"as {facts.moulded}, seats finished to their zones"
    return f"cut {CUT_FINISH}, ground where marked"


def _title(facts: CutFacts) -> str:
    reducer = facts.design.reducer
    if facts.flat.label == "ring":
        return f"ring of {reducer.ring_tooth_count} teeth"
    columns = f", {reducer.carrier.column_count} for columns" if has_columns(reducer) else ""
    pins = reducer.output_pins.count
    return f"cycloidal disc of {reducer.ratio} lobes, {pins} output holes{columns}"


def notes(facts: CutFacts) -> list[str]:
    """Notes of a sheet, each a sentence or two."""
    return _moulded_notes(facts) if facts.moulded else _cut_notes(facts)


def _moulded_notes(facts: CutFacts) -> list[str]:
    """Of a plastic, which no wire cuts."""
    name = facts.design.file_name
    return [
        *facts.remarks,
        *facts.fitting,
        f"{facts.moulded.capitalize().replace('fdm', 'FDM')}: from the files of "
        f"`export --to print`, which are larger by what it shrinks; contours of {name}-"
        f"{facts.flat.label}.dxf are those of the finished part.",
        _curve(facts),
        f"{facts.fit_text[1].capitalize()}.",
        f"Profile: {facts.profile_text}.",
        *(
            f"Seat \u00d8{seat}, {contour_name(seat.contour)}: bored or turned to its zone."
            for seat in facts.seats
        ),
        _datums(facts),
        *_clocking(facts),
        "Sizes in brackets are auxiliary.",
    ]


def _datums(facts: CutFacts) -> str:
    face = "lower face" if facts.moulded else "lower face, on the table of the machine"
    axis = "the outside" if facts.flat.label == "ring" else "the bore"
    return f"Datum A: axis of {axis}. Datum B: {face}."


def _cut_notes(facts: CutFacts) -> list[str]:
    flat, edm = facts.flat, facts.design.edm
    offset = _MM * edm.wire_offset
    said = [
        *facts.remarks,
        *facts.fitting,
        _curve(facts),
        f"Cut from the file {facts.design.file_name}-{flat.label}.dxf, layers CUT_OUTER and "
        "CUT_INNER: nominal finished contour without kerf offset. WIRE_PATH is the centre of the "
        f"wire on the finishing cut, {offset:g} mm into the waste.",
        f"Wire \u00d8{_MM * edm.wire_diameter:g} mm, gap {_MM * edm.spark_gap:g} mm.",
        f"Contour as written, read back and measured: {facts.fit_text[0]}.",
        f"{facts.fit_text[1].capitalize()}.",
        f"Profile: {facts.profile_text}, after the last skim cut.",
    ]
    said += [
        f"Seat \u00d8{seat}, {contour_name(seat.contour)}: the file is nominal; cut to "
        f"\u00d8{_MM * seat.middle:.4f}, the middle of its zone: shift the wire "
        f"{_MM * seat.shift:+.4f} mm into the waste."
        for seat in facts.seats
    ]
    said += [
        _datums(facts),
        *_clocking(facts),
        "Cut all contours in one clamping, holes first, the outer contour last.",
        "Stress relieve before cutting. No recast layer on the contour after the last skim cut.",
        "Sizes in brackets are auxiliary.",
    ]
    return said


def _clocking(facts: CutFacts) -> list[str]:
    """What holds the holes in place round the axis, seen from the lobes."""
    if facts.flat.label == "ring":
        return []
    return [
        f"{SIMULTANEOUS}: zones of contour and holes hold at once (ISO 5458), so the holes are "
        "clocked to the lobes.",
    ]


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


def _cuts(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Table of contours in the order they are cut, a long one in blocks."""
    rows = cut_rows(facts)
    table, first = _table(sheet.paper, len(rows)), _TABLE
    if sheet.paper != A3:
        first = complex(_BESIDE, sheet.paper.top - _HEAD)
    sheet.text(first + 2.0j, "CUTS IN ORDER, mm FROM THE AXIS OF THE PART", 3.0)
    each = -(-len(rows) // table.blocks)
    for block in range(table.blocks):
        corner = first + block * (table.width + _GAP)
        _cuts_block(sheet, table, corner, rows[block * each : (block + 1) * each])


def _cuts_block(
    sheet: SheetDrawing, table: _Table, corner: complex, rows: list[tuple[str, ...]]
) -> None:
    """Rows under their headings, below a corner of the page."""
    for number, row in enumerate([tuple(table.columns), *rows], start=1):
        y = corner - 1j * number * table.pitch
        for x, words in zip(table.columns.values(), row, strict=True):
            sheet.text(y + x + 1.0 + 1.2j, words, SMALL)
        sheet.line(y, y + table.width)
    sheet.line(corner, corner + table.width)
    for x in (0.0, table.width):
        sheet.line(corner + x, corner + x - 1j * (len(rows) + 1) * table.pitch)


def cut_rows(facts: CutFacts) -> list[tuple[str, ...]]:
    """Rows of the table of cuts."""
    flat, rows = facts.flat, []
    for step, number in enumerate(flat.cut_order, start=1):
        contour, path = flat.contours[number], facts.paths[number]
        size = contour_size(contour, "\u00d8")
        centre = complex(*contour.centre) if isinstance(contour, Circle) else 0j
        places = [_place(v) for at in (centre, path.start) for v in (at.real, at.imag)]
        hole = f"{_MM * path.start_diameter:.2f}"
        rows.append((str(step), contour_name(number), size, *places, hole))
    if len(rows) > _SHORT.most:
        short = (row[1].removeprefix("inner contour ").removesuffix(" contour") for row in rows)
        rows = [(row[0], name, *row[2:]) for row, name in zip(rows, short, strict=True)]
    return rows


def _place(value: float) -> str:
    """A coordinate in mm to 0.1 um; never ``-0``."""
    return f"{round(_MM * value, 4) + 0.0:.4f}"
