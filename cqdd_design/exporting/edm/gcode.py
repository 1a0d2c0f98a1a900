"""G-code for wire EDM: one program a part, on the nominal contour, the control offsets.

Every contour is cut by several passes, a rough cut and skim cuts, each with an offset of its own;
what it runs along is a subprogram that they call. Here a hole, three passes::

    G00 X.. Y..           rapid, wire cut, to the centre of the start hole
    (M60)                 thread; controls differ, so M50 and M60 are comments beside an M00
    G41 D01 G01 X.. Y..   rough: lead-in, square onto the contour, offset on
    M98 P0011             round to where the tab begins
    G40 G01 X.. Y..       off the wall into the middle of the kerf, offset off
    G42 D02 G01 X.. Y..   skim 1: back onto the wall, the other way round
    M98 P0012             the same backwards
    ...
    M01                   stop: all is cut but the tab; hold the slug
    G41 D01 ... M98 P0013 ... M00   the tab, rough; the slug comes out
    ...                   the tab, skim cuts; the last two run on over the finished wall
    G01 G40 X.. Y..       off the wall, back along the kerf to where the cut began
    G03 X.. Y.. I.. J..
    G40 G01 X.. Y..       to the start hole

The last pass of a tab begins and ends on the finished wall, so that it overlaps at both joints.
Passes run to and fro, since the way from the tab's edge to the start hole is through the slug.
Seats with a tolerance zone take registers from 11 on, whose values bring them to the middle of it.
Holes first, so that the part stays in the plate to the last; the outer contour last. Forward is
counter-clockwise: the waste of a hole is to the left of the wire (G41), that of the outer contour
to the right (G42); backward it is the other way round.

Source of passes that run to and fro, and of contour, tab and subprograms: Autodesk, FeatureCAM
help, "Offset page" of wire EDM; BobCAD-CAM help, "Wire EDM 4 axis skim cut parameters".
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog.printing import printed_materials
from cqdd_design.exporting.edm.begin import OVERLAP_SHARE, begun, tab_on
from cqdd_design.exporting.edm.dxf import contour_fit
from cqdd_design.exporting.edm.flat_parts import FlatPart, flat_parts, seats_of
from cqdd_design.exporting.edm.gcode_check import check_program
from cqdd_design.exporting.edm.passes import (
    WirePass,
    blank_side,
    contour_times,
    cut_radius,
    minutes,
    wire_passes,
)
from cqdd_design.exporting.edm.seats import Seat
from cqdd_design.exporting.edm.wire_path import (
    OpenChain,
    WirePath,
    contour_name,
    contour_size,
    split_for_tab,
    wire_paths,
)
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.files import WrittenFile, ascii_text, write_with
from cqdd_design.geometry.contours import Circle
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.design import Design
    from cqdd_design.exporting.job import ExportJob

FOLDER = "edm"
"""Programs lie beside the EDM package."""
DECIMALS = 4
"""Of a millimetre: 0.1 um."""
_FORWARD, _BACK = ("G42", "G41"), ("G41", "G42")
"""Offset to the side of the waste of an outer and of an inner contour, by direction."""

_MM = 1e3
_COMMENT = 98
"""Most characters of a comment: controls cut longer blocks off, or refuse them."""


@dataclass(frozen=True)
class Dialect:
    """What controls write differently.

    Attributes
    ----------
    offset : str
        Format of an offset register.
    subprogram : str
        Format of a subprogram's first block.
    assigned : bool
        Whether the program sets its registers; else they are set on the control, and a comment
        says to what.
    """

    offset: str
    subprogram: str
    assigned: bool


DIALECTS = {
    "iso": Dialect("D{:02d}", "O{:04d}", assigned=False),
    "sodick": Dialect("H{:03d}", "N{:04d}", assigned=True),
}


@dataclass(frozen=True, eq=False)
class _Cut:
    """One contour, with what its subprograms run along: all but the tab, and the tab."""

    step: int
    outer: bool
    start: complex
    wall: OpenChain
    tab: OpenChain
    circle: complex | None
    into_waste: float
    """From the contour to the middle of the kerf, to the left of its forward way, m."""


@dataclass(frozen=True, eq=False)
class _Run:
    """What one pass runs along."""

    one: WirePass
    on_tab: bool
    forward: bool
    chain: OpenChain
    subprogram: int
    turn: complex
    """Where it leaves the wall for, in the middle of the kerf, m."""


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
    paths = wire_paths(flat, design.edm, options.tab_length)
    passes = wire_passes(flat.contours, design.edm, options.passes)
    dialect, seats = DIALECTS[options.gcode_dialect], seats_of(flat)
    bases = {seat.contour: 10 * place for place, seat in enumerate(seats, start=1)}
    shifts = {seat.contour: seat.shift for seat in seats}
    registers = {
        base + one.number: one.offset + shift
        for base, shift in ((0, 0.0), *((bases[k], shifts[k]) for k in bases))
        for one in passes
    }
    heading = _heading(flat, design, options, seats, passes, paths[0])
    lines = ["%", "O0001", *_comments(heading)]
    lines += _register_lines(dialect, registers, passes)
    lines += ["G90 G21 G17", "G40"]
    subprograms: list[str] = []
    for step, number in enumerate(flat.cut_order, start=1):
        size = contour_size(flat.contours[number])
        title = f"CUT {step} OF {len(flat.contours)}: {contour_name(number)}, {size}"
        kerf = passes[0].offset + shifts.get(number, 0.0)
        cut = _cut(flat, number, step, paths[number].start, kerf, options)
        runs = _runs(cut, passes)
        lines += _main(cut, runs, title, dialect, bases.get(number, 0))
        subprograms += _subprograms(cut, runs, dialect)
        if number:
            lines += ["(M50 CUT WIRE)", "M00"]
    lines += ["(M50 CUT WIRE, TAKE THE PART)", "M02", *subprograms, "%"]
    return "\n".join(lines) + "\n"


def _heading(
    flat: FlatPart,
    design: Design,
    options: ExportOptions,
    seats: Sequence[Seat],
    passes: Sequence[WirePass],
    path: WirePath,
) -> list[str]:
    edm, fit = design.edm, contour_fit(flat)
    whole = sum(contour_times(flat, len(passes)))
    over = "BEGINS AND ENDS" if len(passes) > 1 else "ENDS"
    side, free = (math.ceil(_MM * one) for one in (blank_side(path), 2.0 * cut_radius(path)))
    return [
        f"PART {design.file_name}-{flat.label}, CUT {flat.quantity}",
        *flat.remarks,
        f"MATERIAL {flat.material}, THICKNESS {_MM * flat.thickness:g} MM",
        *(["IT DOES NOT CONDUCT: NO WIRE CUTS IT"] if flat.material in printed_materials() else []),
        f"BLANK {side} X {side} MM ABOUT THE PART AXIS AT LEAST, CLAMPED OUTSIDE DIA {free}",
        "UNITS MM, ABSOLUTE, ORIGIN ON THE PART AXIS, ARC CENTRES I J FROM EACH ARC START",
        f"WIRE DIA {_MM * edm.wire_diameter:g}, SPARK GAP {_MM * edm.spark_gap:g} ON THE LAST PASS",
        "OFFSETS BELOW ARE WIRE RADIUS, THAT GAP AND WHAT LATER PASSES TAKE: REPLACE THEM BY THOSE",
        "OF YOUR TECHNOLOGY, THE LAST AS IT IS",
        *(
            f"{place}1 AND ON FOR {contour_name(seat.contour)}, SEAT DIA {seat}: "
            f"{_MM * seat.shift:+.4f} MORE, TO CUT DIA {_MM * seat.middle:.4f}"
            for place, seat in enumerate(seats, start=1)
        ),
        f"CONTOUR OF {fit.segments} ARCS WITHIN {1e6 * fit.largest_deviation:.3f} UM OF THE EXACT "
        "CURVE, COORDINATES TO 0.1 UM",
        f"{len(flat.contours)} CONTOURS, HOLES FIRST, OUTER CONTOUR LAST; PASSES RUN TO AND FRO",
        f"EACH STOPS AT M01 BEFORE A TAB OF UP TO {_MM * options.tab_length:g} MM: HOLD THE SLUG",
        "TABS ARE WHERE NO TOOTH COMES, IN HOLES WHERE A PIN PUSHES LEAST; THE LAST PASS OF A TAB",
        f"{over} {OVERLAP_SHARE:.0%} OF ITS LENGTH BEYOND IT, ON THE FINISHED WALL",
        f"ABOUT {minutes(whole)} A PIECE, AN ESTIMATE",
        "M60 THREADS AND M50 CUTS THE WIRE ON MANY CONTROLS; HERE THEY ARE COMMENTS AT AN M00,",
        "REPLACE BOTH BY YOUR OWN CODES FOR AUTOMATIC THREADING",
        f"DESIGN {design.sha256[:16]}, CQDD-DESIGN {__version__}",
    ]


def _register_lines(
    dialect: Dialect, registers: dict[int, float], passes: Sequence[WirePass]
) -> list[str]:
    """What the registers hold: in a comment each, or set."""
    names = {one.number: one.name for one in passes}
    lines = []
    for number, value in registers.items():
        told = f"{dialect.offset.format(number)} = {_number(value * _MM)}"
        name = names[number % 10]
        lines.append(f"{told} ({name})" if dialect.assigned else f"({told}, {name})")
    return lines


def _comments(lines: list[str]) -> list[str]:
    """Comments without inner brackets, which would end them; a long one is several."""
    cleaned = (ascii_text(line).upper() for line in lines)
    bare = (line.replace(" (", ", ").replace("(", "").replace(")", "") for line in cleaned)
    return [f"({part})" for line in bare for part in textwrap.wrap(line, _COMMENT)]


def _cut(
    flat: FlatPart,
    number: int,
    step: int,
    start: complex,
    kerf: float,
    options: ExportOptions,
) -> _Cut:
    nominal = flat.contours[number]
    contour = begun(flat, number, options.tab_length)
    wall, tab = split_for_tab(contour, tab_on(flat, number, options.tab_length))
    circle = None
    if isinstance(nominal, Circle):
        # On the grid of the coordinates, its joints with it, so that the radii of its arcs agree.
        exact = complex(*nominal.centre)
        circle = complex(*(_rounded(v * _MM) / _MM for v in nominal.centre))
        wall, tab = (OpenChain(one.points + circle - exact, one.bulges) for one in (wall, tab))
    return _Cut(step, number == 0, start, wall, tab, circle, kerf if number else -kerf)


def _behind(cut: _Cut) -> OpenChain:
    """The first of the wall, forward: what the last pass of the tab runs on over."""
    return cut.wall.divided(OVERLAP_SHARE * cut.tab.length)[0]


def _before(cut: _Cut) -> OpenChain:
    """The last of the wall, forward: what the last pass of the tab begins on."""
    return cut.wall.divided(cut.wall.length - OVERLAP_SHARE * cut.tab.length)[1]


def _runs(cut: _Cut, passes: Sequence[WirePass]) -> list[_Run]:
    """All passes, those of the wall first; each begins where the one before it ended."""
    count = len(passes)
    wall, tab = [cut.wall] * count, [cut.tab] * count
    if count > 1:
        # The last begins on the wall, so the one before it, which runs back, ends there.
        tab[-2:] = [_before(cut).joined(cut.tab)] * 2
    tab[-1] = tab[-1].joined(_behind(cut))
    runs: list[_Run] = []
    for on_tab, chains, first in ((False, wall, 1), (True, tab, 3)):
        numbers: dict[tuple[int, bool], int] = {}
        for one, chain in zip(passes, chains, strict=True):
            # The wall from its first joint, to and fro; the tab so that it ends there.
            forward = (count - one.number if on_tab else one.number - 1) % 2 == 0
            run = chain if forward else chain.reversed()
            into_waste = cut.into_waste if forward else -cut.into_waste
            number = numbers.setdefault((id(chain), forward), first + len(numbers))
            runs.append(_Run(one, on_tab, forward, run, number, run.reversed().beside(-into_waste)))
    return runs


def _main(cut: _Cut, runs: Sequence[_Run], title: str, dialect: Dialect, base: int) -> list[str]:
    """Blocks of the main program for one contour."""
    held = "PART" if cut.outer else "SLUG"
    lines = [*_comments([title]), f"G00 {_xy(cut.start)}", "(M60 THREAD WIRE)", "M00"]
    for run in runs:
        first_on_tab = run.on_tab and run.one.number == 1
        if first_on_tab:
            length = _MM * cut.tab.length
            lines += [*_comments([f"TAB OF {length:.3f} MM LEFT: HOLD THE {held}"]), "M01"]
        side = (_FORWARD if run.forward else _BACK)[0 if cut.outer else 1]
        register = dialect.offset.format(base + run.one.number)
        lines += [
            *_comments([f"{run.one.name}{' OF THE TAB' if run.on_tab else ''}"]),
            f"{side} {register} G01 {_xy(complex(run.chain.points[0]))}",
            f"M98 P{10 * cut.step + run.subprogram:04d}",
            # Off the wall; after the last pass the block to the start hole says G40 once more.
            f"{'G01 G40' if run is runs[-1] else 'G40 G01'} {_xy(run.turn)}",
        ]
        if first_on_tab:
            told = "THE PART IS FREE: HELD BY MAGNETS" if cut.outer else "TAKE THE SLUG OUT"
            lines += [f"({told})", "M00"]
    along_kerf = _behind(cut).moved(cut.into_waste).reversed()
    return [*lines, *_moves(along_kerf, cut.circle), f"G40 G01 {_xy(cut.start)}"]


def _subprograms(cut: _Cut, runs: Sequence[_Run], dialect: Dialect) -> list[str]:
    """What the passes run along: wall and tab, forward and, where it is run, backward."""
    lines = []
    for number, chain in sorted({run.subprogram: run.chain for run in runs}.items()):
        lines += [
            dialect.subprogram.format(10 * cut.step + number),
            *_moves(chain, cut.circle),
            "M99",
        ]
    return lines


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
