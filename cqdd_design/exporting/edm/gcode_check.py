"""A program read as a control reads it, block by block, and compared with the part it cuts."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.begin import NO_PIECE, OVERLAP_SHARE
from cqdd_design.exporting.edm.flat_parts import seats_of
from cqdd_design.exporting.edm.loops import ComplexArray, FloatArray, Loop, fit_of
from cqdd_design.exporting.edm.passes import wire_passes
from cqdd_design.exporting.edm.readback import refuse_misfit
from cqdd_design.exporting.edm.wire_check import nearest_distances
from cqdd_design.geometry.contours import Circle, Contour

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.edm.flat_parts import FlatPart

_BENDS = 1e-3
"""Bulges of an arc forward and backward agree within this."""
ROUNDING = 0.2e-6
"""What coordinates to 0.1 um can move a contour by, m."""
RADII = 0.15e-6
"""Radii to start and end of an arc agree within this, m."""
_FOLLOWS = 1e-6
"""The wire keeps its offset within this, m: rounded joints turn short arcs, and with them the way
to the wire."""

_MM = 1e-3
_WORD = re.compile(r"([A-Z])([-+]?\d*\.?\d+)")
_REGISTER = re.compile(r"\b[DH]0*(\d+) = (\d+\.\d+)")
_NESTED = 1
"""Depth of subprograms."""


@dataclass(frozen=True, eq=False)
class Pass:
    """What is cut from one offset on to offset off.

    Attributes
    ----------
    segments : Loop
        Of the contour, in the order they are run; lead-in and lead-out apart. Not closed.
    side : int
        41: the wire is left of the path; 42: right of it.
    register : int
        Of its offset.
    lead_in, lead_out : (complex, complex)
        Start and end, m.
    """

    segments: Loop
    side: int
    register: int
    lead_in: tuple[complex, complex]
    lead_out: tuple[complex, complex]


@dataclass(frozen=True, eq=False)
class Cut:
    """One contour of a program.

    Attributes
    ----------
    start : complex
        Where the wire is threaded, m.
    wall, tab : tuple of Pass
        Before and after the stop.
    stops : int
        M01 along the contour.
    way_out : Loop
        From the last pass to the start hole, without an offset. Not closed.
    """

    start: complex
    wall: tuple[Pass, ...]
    tab: tuple[Pass, ...]
    stops: int
    way_out: Loop

    @property
    def loop(self) -> Loop:
        """The closed contour: the first pass of the wall, and the tab the same way round."""
        wall, tab = self.wall[0].segments, self.bare_tab
        return Loop(
            *(np.concatenate(both) for both in zip(_arrays(wall), _arrays(tab), strict=True))
        )

    @property
    def bare_tab(self) -> Loop:
        """Of a pass of the tab, what the wall's first leaves, the same way round."""
        wall, tab = self.wall[0].segments, self.tab[0].segments
        if tab.start[0] != wall.end[-1]:
            tab = tab.backward()
        return _part(tab, wall.end[-1], wall.start[0])


def _part(loop: Loop, begin: complex, end: complex) -> Loop:
    """What of a chain lies between two of its joints; all of it where they are none."""
    first, last = np.flatnonzero(loop.start == begin), np.flatnonzero(loop.end == end)
    if not (first.size and last.size):
        return loop
    chosen = slice(int(first[0]), int(last[-1]) + 1)
    return loop.part(chosen)


def _arrays(loop: Loop) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    return loop.start, loop.end, loop.bulge


@dataclass
class _Control:
    """The modal state of a control while it reads."""

    subprograms: dict[int, list[str]]
    place: complex = 0j
    side: int = 40
    register: int = 0
    segments: list[tuple[complex, complex, float]] = field(default_factory=list)
    lead_in: tuple[complex, complex] = (0j, 0j)
    start: complex = 0j
    wall: list[Pass] = field(default_factory=list)
    tab: list[Pass] = field(default_factory=list)
    way_out: list[tuple[complex, complex, float]] = field(default_factory=list)
    stops: int = 0
    cuts: list[Cut] = field(default_factory=list)

    def finish_cut(self) -> None:
        """What was cut from one start hole is a cut."""
        if self.wall or self.tab:
            wall, tab, out = tuple(self.wall), tuple(self.tab), _chain(self.way_out)
            self.cuts.append(Cut(self.start, wall, tab, self.stops, out))
        self.wall, self.tab, self.way_out, self.stops = [], [], [], 0


def _chain(segments: list[tuple[complex, complex, float]]) -> Loop:
    start, end, bulge = np.array(segments, complex).reshape(-1, 3).T
    return Loop(start, end, bulge.real)


def registers_of(text: str) -> dict[int, float]:
    """Offsets that a program sets or asks for, by register, m."""
    return {int(number): float(value) * _MM for number, value in _REGISTER.findall(text)}


def read_program(text: str) -> list[Cut]:
    """Return the contours of a program in the order they are cut.

    Raises
    ------
    ReadBackError
        When a block is not understood, an arc has no circle, or a cut does not close.
    """
    lines = text.split("\n")
    if lines[0] != "%" or lines[-2:] != ["%", ""]:
        raise ReadBackError("the program does not begin and end with %.")
    bare = (re.sub(r"\(.*?\)", "", line).strip() for line in lines[1:-2])
    blocks = [block for block in bare if block and not _REGISTER.match(block)]
    modal = {word for block in blocks[:4] for word in block.split()}
    if not {"G90", "G21"} <= modal:
        raise ReadBackError("the program does not say G90 G21, absolute millimetres.")
    if "M02" not in blocks:
        raise ReadBackError("the program does not end at an M02.")
    end = blocks.index("M02")
    control = _Control(_subprograms(blocks[end + 1 :]))
    _run(control, blocks[:end], 0)
    control.finish_cut()
    return control.cuts


def _subprograms(blocks: list[str]) -> dict[int, list[str]]:
    """Blocks of every subprogram by its number."""
    found: dict[int, list[str]] = {}
    own: list[str] | None = None
    for block in blocks:
        if own is None:
            if not re.fullmatch(r"[ON]\d+", block):
                raise ReadBackError(f"the block '{block}' stands in no subprogram.")
            own = found.setdefault(int(block[1:]), [])
        elif block == "M99":
            own = None
        else:
            own.append(block)
    if own is not None:
        raise ReadBackError("a subprogram does not end at an M99.")
    return found


def _run(control: _Control, blocks: list[str], depth: int) -> None:
    for block in blocks:
        found = _WORD.findall(block)
        if "".join(block.split()) != "".join(letter + value for letter, value in found):
            raise ReadBackError(f"the block '{block}' is not understood.")
        words = [(letter, float(value)) for letter, value in found]
        if ("M", 98.0) in words:
            called = int(dict(words).get("P", 0))
            if depth >= _NESTED or called not in control.subprograms:
                raise ReadBackError(f"the block '{block}' calls no subprogram.")
            _run(control, control.subprograms[called], depth + 1)
            continue
        _obey(control, words, block)


def _obey(control: _Control, words: list[tuple[str, float]], block: str) -> None:
    codes = [int(value) for letter, value in words if letter == "G"]
    given = {letter: value for letter, value in words if letter not in "GM"}
    control.stops += ("M", 1.0) in words
    if "X" not in given:
        return
    target = complex(given["X"], given["Y"]) * _MM
    begin, control.place = control.place, target
    motion = next((code for code in codes if code in (0, 1, 2, 3)), None)
    if motion is None:
        raise ReadBackError(f"the block '{block}' does not say how to move.")
    turned = next((code for code in codes if code in (40, 41, 42)), None)
    if turned in (41, 42):
        if control.way_out:
            raise ReadBackError(f"the block '{block}' cuts again on the way out.")
        control.side, control.lead_in = turned, (begin, target)
        control.register = int(given.get("D", given.get("H", 0)))
        control.segments = []
        return
    if turned == 40 and control.side != 40:
        _finish(control, (begin, target))
        return
    if motion == 0:
        control.finish_cut()
        control.start = target
        return
    if control.side == 40 and not (control.wall or control.tab):
        raise ReadBackError(f"the block '{block}' cuts without an offset.")
    bulge = 0.0
    if motion in (2, 3):
        bulge = _bulge(begin, target, complex(given["I"], given["J"]) * _MM, motion == 3, block)
    along = control.way_out if control.side == 40 else control.segments
    along.append((begin, target, bulge))


def _bulge(start: complex, end: complex, to_centre: complex, left: bool, block: str) -> float:
    centre = start + to_centre
    if abs(abs(start - centre) - abs(end - centre)) > RADII:
        raise ReadBackError(
            f"the radii of '{block}' differ by "
            f"{abs(abs(start - centre) - abs(end - centre)) * 1e6:.3g} um."
        )
    sweep = cmath.phase((end - centre) / (start - centre)) % (2.0 * math.pi)
    return math.tan(sweep / 4.0) if left else -math.tan((2.0 * math.pi - sweep) / 4.0)


def _finish(control: _Control, lead_out: tuple[complex, complex]) -> None:
    if not control.segments:
        raise ReadBackError("an offset is taken off before anything is cut.")
    run = _chain(control.segments)
    if (run.end[:-1] != run.start[1:]).any() or run.start[0] != control.lead_in[1]:
        raise ReadBackError("a contour of the program does not close.")
    one = Pass(run, control.side, control.register, control.lead_in, lead_out)
    (control.tab if control.stops else control.wall).append(one)
    control.side = 40


def check_program(text: str, flat: FlatPart, edm: Edm) -> list[Cut]:
    """Read a program and refuse it unless every pass cuts the part and keeps its material.

    Raises
    ------
    ReadBackError
        Naming the cut that is wrong.
    """
    cuts, registers = read_program(text), registers_of(text)
    contours = [flat.contours[number] for number in flat.cut_order]
    if len(cuts) != len(contours):
        raise ReadBackError(f"{flat.label}: {len(cuts)} cuts for {len(contours)} contours.")
    shifts = {seat.contour: seat.shift for seat in seats_of(flat)}
    for number, (cut, contour) in enumerate(zip(cuts, contours, strict=True), start=1):
        label, outer = f"{flat.label}, cut {number}", contour is flat.shape.outer
        if cut.stops != 1 or len(cut.tab) != len(cut.wall):
            raise ReadBackError(f"{label}: it does not stop once, before the passes of its tab.")
        loop = cut.loop
        if loop.end[-1] != loop.start[0] or (loop.end[:-1] != loop.start[1:]).any():
            raise ReadBackError(f"{label}: the contour of the program does not close.")
        if loop.area <= 0.0:
            raise ReadBackError(f"{label}: it runs clockwise.")
        if (loop.clearance(cut.start) > 0.0) != outer:
            raise ReadBackError(f"{label}: the wire is threaded in the material.")
        passes = wire_passes(flat.contours, edm, len(cut.wall))
        shift = shifts.get(flat.cut_order[number - 1], 0.0)
        offsets = [one.offset + shift for one in passes]
        _refuse_other_passes(label, cut, registers, offsets, outer=outer)
        _refuse_other_way_out(label, cut, offsets[0])
        _refuse_other_shape(label, loop, contour, flat, edm, outer=outer)
    return cuts


def _refuse_other_passes(
    label: str, cut: Cut, registers: dict[int, float], offsets: list[float], *, outer: bool
) -> None:
    """Every pass replayed: the wire at its offset from the contour, in the waste, to and fro."""
    loop, kerf = cut.loop, offsets[0]
    turn = cut.wall[0].segments.start[0]
    for passes in (cut.wall, cut.tab):
        for number, (one, offset) in enumerate(zip(passes, offsets, strict=True), start=1):
            name = f"{label}, pass {number}{' of the tab' if passes is cut.tab else ''}"
            if abs(registers.get(one.register, 0.0) - offset) > 2.0 * ROUNDING:
                raise ReadBackError(
                    f"{name}: its register {one.register} holds "
                    f"{registers.get(one.register, 0.0) * 1e3:.4f} mm, not {offset * 1e3:.4f} mm."
                )
            if passes is cut.tab:
                _refuse_other_overlap(name, one, cut.bare_tab, len(passes) - number, number)
            elif not _is_same(one.segments, _ways(passes[0].segments)[(number - 1) % 2]):
                raise ReadBackError(f"{name}: it does not run along the pass before it.")
            if one.segments.start[0] != turn:
                raise ReadBackError(f"{name}: it does not begin where the wire is.")
            turn = one.segments.end[-1]
            path = _offset(one.segments, registers[one.register], left=one.side == 41)
            away = nearest_distances(path, loop)
            if np.abs(away - offset).max() > _FOLLOWS:
                raise ReadBackError(
                    f"{name}: the wire runs {away.min() * 1e3:.4f} to {away.max() * 1e3:.4f} mm "
                    f"from the contour, not {offset * 1e3:.4f} mm."
                )
            middle = path.start[len(path.start) // 2]
            if (loop.clearance(middle) > 0.0) != outer:
                raise ReadBackError(f"{name}: G{one.side} puts the wire into the material.")
            if abs(loop.clearance(one.lead_out[1]) - (kerf if outer else -kerf)) > _FOLLOWS:
                raise ReadBackError(f"{name}: it does not turn in the middle of the kerf.")


def _refuse_other_overlap(name: str, one: Pass, tab: Loop, later: int, number: int) -> None:
    """The tab whole, and what the last passes run over of the finished wall on either side."""
    same = _ways(tab)[later % 2]
    inner = _part(one.segments, same.start[0], same.end[-1])
    if not _is_same(inner, same):
        raise ReadBackError(f"{name}: it does not run along the tab.")
    over = OVERLAP_SHARE * tab.perimeter
    first = int(np.flatnonzero(one.segments.start == same.start[0])[0])
    lengths = one.segments.lengths
    found = lengths[:first].sum(), lengths[first + len(inner.start) :].sum()
    wanted = over * (later == 0 and number > 1), over * (later < 2)
    if not np.allclose(found, wanted, rtol=0.0, atol=1.1 * NO_PIECE):
        raise ReadBackError(
            f"{name}: it runs {found[0] * 1e3:.4f} and {found[1] * 1e3:.4f} mm over the wall, "
            f"not {wanted[0] * 1e3:.4f} and {wanted[1] * 1e3:.4f} mm."
        )


def _refuse_other_way_out(label: str, cut: Cut, kerf: float) -> None:
    """Along the kerf to where the cut began, then as it came."""
    came, out = cut.wall[0].lead_in, cut.way_out
    if came[0] != cut.start or not len(out.end) or out.end[-1] != cut.start or out.bulge[-1]:
        raise ReadBackError(f"{label}: it does not lead out as it led in.")
    lead = Loop(np.array(came[:1]), np.array(came[1:]), np.zeros(1))
    if lead.distances(out.start[-1:], np.zeros(1, int))[0] > _FOLLOWS:
        raise ReadBackError(f"{label}: it does not lead out as it led in.")
    along = out.part(slice(-1))
    if len(along.end) and np.abs(nearest_distances(along, cut.loop) - kerf).max() > _FOLLOWS:
        raise ReadBackError(f"{label}: its way out leaves the kerf beside the contour.")


def _ways(loop: Loop) -> tuple[Loop, Loop]:
    """A chain forward and backward."""
    return loop, loop.backward()


def _is_same(one: Loop, other: Loop) -> bool:
    """Joint by joint; the rounded centre of an arc bends it a little less or more backwards."""
    return (
        np.array_equal(one.start, other.start)
        and np.array_equal(one.end, other.end)
        and bool(np.abs(one.bulge - other.bulge).max() < _BENDS)
    )


def _offset(loop: Loop, distance: float, *, left: bool) -> Loop:
    """Segments moved sideways as a control moves them: arcs about their own centres."""
    side = distance if left else -distance
    along = (loop.end - loop.start) / np.abs(loop.end - loop.start)
    half = np.exp(0.5j * loop.sweep)
    return Loop(
        loop.start + 1j * side * along / half, loop.end + 1j * side * along * half, loop.bulge
    )


def _refuse_other_shape(
    label: str, loop: Loop, contour: Contour, flat: FlatPart, edm: Edm, *, outer: bool
) -> None:
    if not isinstance(contour, Circle):
        fit = fit_of(loop, flat.exact_of(contour), outer=outer)
        # Ends that are moved by the rounding turn the shortest arc most.
        kink = 2.0 * ROUNDING / float(loop.lengths.min())
        refuse_misfit(label, fit, edm.profile_tolerance + ROUNDING, kink)
        return
    points, _ = loop.sampled()
    off = np.abs(np.abs(points - complex(*contour.centre)) - contour.radius).max()
    if off > ROUNDING:
        raise ReadBackError(
            f"{label}: it leaves the hole of {contour.radius * 2e3:.4f} mm by {off * 1e6:.3g} um."
        )
