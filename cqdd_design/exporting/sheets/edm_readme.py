"""README.txt of the EDM package, in the words of a shop; plain ASCII, lines of at most 78."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from cqdd_design.exporting.edm.cut_facts import (
    CUT_FINISH,
    FACE_FINISH,
    GROUND_FLATNESS,
    GROUND_PARALLELISM,
    zone_text,
)
from cqdd_design.exporting.edm.passes import (
    BORDER,
    ROUGH_RATE,
    SKIM_SPEED,
    THREADING_TIME,
    minutes,
)
from cqdd_design.exporting.edm.wire_path import contour_name, contour_size
from cqdd_design.files import ascii_text
from cqdd_design.geometry.columns import has_columns
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.cut_facts import CutFacts
    from cqdd_design.exporting.options import ExportOptions

_MM = 1e3
_WIDTH = 78


def readme_text(parts: Sequence[CutFacts], options: ExportOptions) -> str:
    """Return the README of a package.

    Parameters
    ----------
    parts : sequence of CutFacts
        Of one design.
    options : ExportOptions
        How its files are written.
    """
    design = parts[0].design
    edm = design.edm
    lines = [
        f"{design.file_name}: parts for wire EDM",
        "=" * (len(design.file_name) + 20),
        "",
        *_paragraph(
            "All files are in millimetres, the origin on the axis of the part, seen from above "
            "with the lower face on the table. Cut the parts below; each has one DXF, one cut "
            "sheet (PDF, and the same as SVG) and, where it was asked for, one program (.nc)."
        ),
        *_uncut(parts),
        "",
        *_part_lines(parts),
        *_section(
            "Layers of the DXF",
            [
                f"Dialect {options.dxf_version}, contours as "
                + (
                    "one closed polyline of arcs each."
                    if options.dxf_style == "polyline"
                    else "lines and arcs end to end."
                ),
                "CUT_OUTER, CUT_INNER: nominal finished contours, no kerf offset; use these with "
                "the offset of your control.",
                f"WIRE_PATH: centre of the wire on the finishing cut, {_MM * edm.wire_offset:g} "
                "mm from the contour, in the waste; use it without an offset, or for a check. "
                "LEAD_IN: from each start hole square onto that path.",
                "START_HOLE: where the wire is threaded; REF: centre lines; NOTES: text.",
            ],
        ),
        *_section(
            "Wire and gap",
            [
                f"Wire of diameter {_MM * edm.wire_diameter:g} mm, spark gap "
                f"{_MM * edm.spark_gap:g} mm on the finishing cut. A thinner wire is welcome; a "
                "thicker one only where its radius and gap stay below the least concave radius "
                "given with each part.",
            ],
        ),
        *_section("Order of cuts", _order(parts)),
        *_section("Blank and time", _blanks(parts)),
        *_section("Tolerances", _tolerances(parts)),
        *_section("Discs", _discs(parts)),
        *_section(
            "In the programs (.nc)",
            [
                "G90 G21, arcs as G02 and G03 with I and J from the start of each arc. "
                f"{_passes(parts[0], options)} Each contour stops at M01 before its last "
                f"{_MM * options.tab_length:g} mm at most, the tab: hold the slug, then go on; the "
                "tab takes the same passes, the last a little further over the finished wall.",
                "What a contour runs along is a subprogram, forward and backward; passes run to "
                "and fro. G41 and G42 take the offset of each pass from a register of its own, "
                "contours with a seat from 11 on; the values are in the program. They are wire "
                "radius, gap and what later passes take: the last is right for this wire and gap, "
                "replace the others by those of your technology.",
                "Each contour begins so that its tab lies where no tooth comes, in a valley of the "
                "disc or between two teeth of the ring, or outward in an output hole, where a pin "
                "pushes least.",
                "Threading and cutting of the wire differ between controls: M60 and M50 are "
                "comments beside an M00.",
            ],
        ),
        *_paragraph(f"Design {design.sha256[:16]}, cqdd-design {__version__}."),
    ]
    return ascii_text("\n".join(lines)) + "\n"


def _uncut(parts: Sequence[CutFacts]) -> list[str]:
    """Of plastics, which do not conduct."""
    plastic = [f"{one.flat.label} ({one.flat.material})" for one in parts if one.moulded]
    if not plastic:
        return []
    return [
        "",
        *_paragraph(
            f"NO WIRE CUTS {' AND '.join(plastic)}: they do not conduct, and come from the files "
            "of `export --to print`. What is said of them here is for a contour to compare with."
        ),
    ]


def _paragraph(words: str, indent: str = "") -> list[str]:
    plain = words.replace("\u00b5", "u").replace("\u00b0C", "deg C").replace("\u00d8", "dia ")
    plain = plain.replace("\u00b1", "+-").replace("\u00b0", " deg")
    plain = plain.replace("\u00b2", "2")
    return textwrap.wrap(plain, _WIDTH, initial_indent=indent, subsequent_indent=" " * len(indent))


def _section(title: str, items: Sequence[str]) -> list[str]:
    if not items:
        return []
    lines = [title, "-" * len(title)]
    for item in items:
        lines += _paragraph(item, "- ")
    return [*lines, ""]


def _part_lines(parts: Sequence[CutFacts]) -> list[str]:
    lines: list[str] = []
    for facts in parts:
        flat = facts.flat
        lines += _section(
            f"{facts.design.file_name}-{flat.label}.dxf",
            [
                f"Quantity {flat.quantity}, plate {_MM * flat.thickness:g} mm thick "
                f"({facts.thickness_text.replace(chr(0xB1), '+-')}), "
                f"{1e3 * facts.mass:.1f} g each.",
                f"Material {flat.material}: {facts.heat_treatment}; hardness {facts.hardness}.",
                *facts.remarks,
                *facts.fitting,
                f"Contour as written, read back and measured: {facts.fit_text[0]}; "
                f"{facts.fit_text[1]}.",
            ],
        )
    return lines


def _order(parts: Sequence[CutFacts]) -> list[str]:
    said = ["One clamping a part: holes first, the outer contour last, the tab of each at its end."]
    for facts in parts:
        names = [
            f"{contour_name(number)} ({contour_size(facts.flat.contours[number])})"
            for number in facts.flat.cut_order
        ]
        if len(names) > 12:
            names = [*names[:3], "...", *names[-2:]]
        said.append(f"{facts.flat.label}: {', '.join(names)}.")
    return said


def _passes(facts: CutFacts, options: ExportOptions) -> str:
    told = ", ".join(
        f"{one.name.lower()} {_MM * one.offset:.4f}" + (f" (leaves {_MM * one.left:.4f})")
        for one in facts.passes
    )
    kind = "H, set in the program" if options.gcode_dialect == "sodick" else "D, set on the control"
    many = "pass" if len(facts.passes) == 1 else "passes"
    return f"{len(facts.passes)} {many} of {facts.flat.label}, offsets {kind}, mm: {told}."


def _blanks(parts: Sequence[CutFacts]) -> list[str]:
    said = []
    for facts in parts:
        side, hours = math.ceil(_MM * facts.blank), minutes(sum(facts.times)).lower()
        said.append(
            f"{facts.flat.label}: square blank of {side} mm at least about the axis of the "
            f"part, {_MM * BORDER:g} mm of it outside the cuts to clamp on; about {hours} a piece."
        )
    return [
        *said,
        f"Times are an estimate: rough cut {ROUGH_RATE * 60e6:g} mm2 a minute, skim cuts "
        f"{_MM * SKIM_SPEED * 60.0:g} mm a minute, {THREADING_TIME / 60.0:g} minute for each start "
        "hole.",
    ]


def _tolerances(parts: Sequence[CutFacts]) -> list[str]:
    said = []
    for facts in parts:
        zones, label = facts.zones, facts.flat.label
        said.append(
            f"{label}: profile of the fitted contour within a {facts.profile_text}"
            + (
                f"; {_holes(facts)} +-{zone_text(zones.hole_diameter)} mm, each within a zone of "
                f"dia {zone_text(zones.hole_position)} mm about its place, to the axis of the bore."
                if label != "ring"
                else ", to the axis of the outside."
            )
        )
        said += [
            f"{label}, {contour_name(seat.contour)}: dia {seat}; the file is nominal, cut to dia "
            f"{_MM * seat.middle:.4f}, wire shifted {_MM * seat.shift:+.4f} mm into the waste."
            for seat in facts.seats
        ]
    square = zone_text(max(facts.squareness for facts in parts))
    return [
        *said,
        f"Walls square to the lower face within {square}; faces flat within "
        f"{zone_text(GROUND_FLATNESS)} and parallel within {zone_text(GROUND_PARALLELISM)}.",
        f"Walls {CUT_FINISH}, faces {FACE_FINISH}; no recast layer after the last skim cut.",
    ]


def _holes(facts: CutFacts) -> str:
    columns = has_columns(facts.design.reducer)
    return "output holes and those for columns" if columns else "output holes"


def _discs(parts: Sequence[CutFacts]) -> list[str]:
    said = []
    for flat in (facts.flat for facts in parts if facts.flat.turned_over):
        said += [
            f"{flat.quantity} discs are one program, cut {flat.quantity} times without change; "
            f"{flat.turned_over} of them goes in turned over about the X axis, which brings lobes "
            "onto lobes and every hole to where that disc needs it.",
            "Mark the upper face of every disc, the one seen in the drawing, with a dot between "
            "two output holes before it leaves the machine: by engraver or ink, without a burr. "
            "Assembly tells by it which way a disc goes in.",
        ]
    return said
