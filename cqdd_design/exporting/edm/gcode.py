"""G-code for wire EDM: one ISO program a part, on the nominal contour, the control offsets.

One contour, here a hole cut counter-clockwise::

    G00 X.. Y..          rapid, wire cut, to the centre of the start hole
    (M60)                thread; controls differ, so M50 and M60 are comments beside an M00
    G41 D01 G01 X.. Y..  lead-in, perpendicular onto the contour, offset on
    G03 X.. Y.. I.. J..  contour, centres incremental from the start of each arc
    M01                  stop: all is cut but the tab; hold the slug
    G03 ...              tab
    G40 G01 X.. Y..      lead-out to the start hole, offset off

Seats with a tolerance zone take D02 and on, whose values bring them to the middle of it. Holes
first, so that the part stays in the plate to the last; the outer contour last. Contours run
counter-clockwise: the waste of a hole is to the left of the wire (G41), that of the outer contour
to the right (G42).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.edm.dxf import contour_fit
from cqdd_design.exporting.edm.flat_parts import FlatPart, flat_parts
from cqdd_design.exporting.edm.gcode_check import check_program
from cqdd_design.exporting.edm.seats import Seat, seats_of
from cqdd_design.exporting.edm.wire_path import (
    OpenChain,
    WirePath,
    contour_name,
    contour_size,
    segmented,
    split_for_tab,
    wire_paths,
)
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.files import WrittenFile, write_with
from cqdd_design.geometry.contours import ArcContour, Circle, Contour
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.design import Design
    from cqdd_design.exporting.job import ExportJob

FOLDER = "edm"
"""Programs lie beside the EDM package."""
DECIMALS = 4
"""Of a millimetre: 0.1 um."""
TABS_PER_CONTOUR = 8.0
"""A tab takes no more than this fraction of a contour."""

_MM = 1e3


def export_gcode(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``edm/<name>-<part>.nc`` for every flat part of a design."""
    return tuple(
        write_program(flat, job.design, job.path(f"-{flat.label}.nc", FOLDER), job.options)
        for flat in flat_parts(job.machine)
    )


def write_program(
    flat: FlatPart, design: Design, path: Path, options: ExportOptions = DEFAULTS
) -> WrittenFile:
    """Write the program of a part; put it in place only if it reads back as the part.

    Raises
    ------
    GeometryError
        When a contour is too small for a start hole.
    ReadBackError
        When the wire is too thick for a contour, or the written program does not cut the part; no
        file is left then.
    """
    text = program(flat, design, options)

    def write(temporary: Path) -> None:
        temporary.write_text(text, encoding="ascii", newline="\n")
        check_program(temporary.read_text(encoding="ascii"), flat, design.edm)

    return write_with(path, "gcode", write)


def program(flat: FlatPart, design: Design, options: ExportOptions = DEFAULTS) -> str:
    """Return the program of a part as text."""
    # The paths prove that the wire can follow; the program itself stays on the contour.
    paths = wire_paths(flat, design.edm)
    contours = [_on_grid(contour) for contour in flat.contours]
    seats = seats_of(flat)
    heading = _heading(flat, design, options, len(contours), seats)
    lines = ["%", "O0001", *_comments(heading)]
    registers = {seat.contour: 2 + place for place, seat in enumerate(seats)}
    lines += ["G90 G21 G17", "G40"]
    for step, number in enumerate(flat.cut_order, start=1):
        size = contour_size(flat.contours[number])
        title = f"CUT {step} OF {len(contours)}: {contour_name(number)}, {size}"
        register = registers.get(number, 1)
        lines += _cut(contours[number], paths[number], title, options.tab_length, register)
        if number:
            lines.append("(M50 CUT WIRE, REMOVE SLUG)")
            lines.append("M00")
    lines += ["(M50 CUT WIRE, TAKE THE PART)", "M02", "%"]
    return "\n".join(lines) + "\n"


def tab_of(contour: ArcContour, wanted: float) -> float:
    """Length of the tab of a contour, m."""
    return min(wanted, contour.length() / TABS_PER_CONTOUR)


def _heading(
    flat: FlatPart,
    design: Design,
    options: ExportOptions,
    contours: int,
    seats: Sequence[Seat],
) -> list[str]:
    edm, fit = design.edm, contour_fit(flat)
    return [
        f"PART {design.name}-{flat.label}, CUT {flat.quantity}",
        *flat.remarks,
        f"MATERIAL {flat.material}, THICKNESS {_MM * flat.thickness:g} MM",
        "UNITS MM, ABSOLUTE, ORIGIN ON THE PART AXIS, ARC CENTRES I J FROM EACH ARC START",
        f"WIRE DIA {_MM * edm.wire_diameter:g}, SPARK GAP {_MM * edm.spark_gap:g}",
        f"D01 IS WIRE OFFSET, {_MM * edm.wire_offset:.4f} ON THE FINISHING CUT: SET IT AND THE",
        "OFFSETS OF ROUGH AND SKIM CUTS BY YOUR TECHNOLOGY",
        *(
            f"D{place:02d} FOR {contour_name(seat.contour)}, SEAT DIA {seat}: D01 AND "
            f"{_MM * seat.shift:+.4f} MORE, TO CUT DIA {_MM * seat.middle:.4f}"
            for place, seat in enumerate(seats, start=2)
        ),
        f"CONTOUR OF {fit.segments} ARCS WITHIN {1e6 * fit.largest_deviation:.3f} UM OF THE EXACT "
        "CURVE, COORDINATES TO 0.1 UM",
        f"{contours} CONTOURS, HOLES FIRST, OUTER CONTOUR LAST; ALL RUN COUNTER-CLOCKWISE",
        f"EACH STOPS AT M01 BEFORE A TAB OF UP TO {_MM * options.tab_length:g} MM: HOLD THE SLUG",
        "M60 THREADS AND M50 CUTS THE WIRE ON MANY CONTROLS; HERE THEY ARE COMMENTS AT AN M00,",
        "REPLACE BOTH BY YOUR OWN CODES FOR AUTOMATIC THREADING",
        f"DESIGN {design.sha256[:16]}, CQDD-DESIGN {__version__}",
    ]


def _comments(lines: list[str]) -> list[str]:
    """Comments without inner brackets, which would end them."""
    cleaned = (line.upper().replace("(", "- ").replace(")", "") for line in lines)
    return [f"({line.encode('ascii', 'replace').decode('ascii')})" for line in cleaned]


def _on_grid(contour: Contour) -> Contour:
    """Put centre and radius of a circle on the grid of the coordinates; all its arcs agree then."""
    if isinstance(contour, ArcContour):
        return contour
    centre = [_rounded(v * _MM) / _MM for v in contour.centre]
    return Circle(np.array(centre), _rounded(contour.radius * _MM) / _MM)


def _cut(
    nominal: Contour, path: WirePath, title: str, tab_length: float, register: int
) -> list[str]:
    contour = segmented(nominal)
    centre = complex(*nominal.centre) if isinstance(nominal, Circle) else None
    tab = tab_of(contour, tab_length)
    first, last = split_for_tab(contour, tab)
    start = _xy(path.start)
    side = "G42" if path.outer else "G41"
    return [
        *_comments([title]),
        f"G00 {start}",
        "(M60 THREAD WIRE)",
        "M00",
        f"{side} D{register:02d} G01 {_xy(complex(*contour.points[0]))}",
        *_moves(first, centre),
        *_comments(
            [f"TAB OF {_MM * tab:.3f} MM LEFT: HOLD THE {'PART' if path.outer else 'SLUG'}"]
        ),
        "M01",
        *_moves(last, centre),
        f"G40 G01 {start}",
    ]


def _moves(chain: OpenChain, circle: complex | None) -> list[str]:
    """Blocks along a chain; `circle` is the centre of all its arcs, m, where they have one.

    Other centres are those of the rounded ends, so that the radii to both agree.
    """
    lines = []
    rounded = [complex(_rounded(p.real), _rounded(p.imag)) for p in chain.points * _MM]
    for start, end, bulge in zip(rounded[:-1], rounded[1:], chain.bulges, strict=True):
        if start == end:
            continue
        if bulge == 0.0:
            lines.append(f"G01 {_xy(end / _MM)}")
            continue
        centre = (end - start) * (0.5 + 1j * (1.0 - bulge**2) / (4.0 * bulge))
        if circle is not None:
            centre = circle * _MM - start
        code = "G03" if bulge > 0.0 else "G02"
        lines.append(f"{code} {_xy(end / _MM)} I{_number(centre.real)} J{_number(centre.imag)}")
    return lines


def _rounded(value: float) -> float:
    return round(float(value), DECIMALS) + 0.0


def _number(value: float) -> str:
    """Millimetres with a point, which some controls need to tell them from micrometres."""
    return f"{_rounded(value):.{DECIMALS}f}"


def _xy(place: complex) -> str:
    return f"X{_number(place.real * _MM)} Y{_number(place.imag * _MM)}"
