"""A program read as a control reads it, block by block, and compared with the part it cuts."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.loops import Loop, fit_of
from cqdd_design.exporting.edm.readback import refuse_misfit
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.edm.flat_parts import FlatPart

ROUNDING = 0.2e-6
"""What coordinates to 0.1 um can move a contour by, m."""
RADII = 0.15e-6
"""Radii to start and end of an arc agree within this, m."""

_MM = 1e-3
_WORD = re.compile(r"([A-Z])([-+]?\d*\.?\d+)")


@dataclass(frozen=True, eq=False)
class Cut:
    """One contour of a program.

    Attributes
    ----------
    loop : Loop
        What is cut with the offset on, lead-in and lead-out apart.
    side : int
        41: the wire is left of the path; 42: right of it.
    lead_in, lead_out : (complex, complex)
        Start and end, m.
    stops : int
        M01 along the contour.
    """

    loop: Loop
    side: int
    lead_in: tuple[complex, complex]
    lead_out: tuple[complex, complex]
    stops: int


@dataclass
class _Control:
    """The modal state of a control while it reads."""

    place: complex = 0j
    side: int = 40
    segments: list[tuple[complex, complex, float]] = field(default_factory=list)
    stops: int = 0
    lead_in: tuple[complex, complex] = (0j, 0j)


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
    blocks = [block for line in lines[1:-2] if (block := re.sub(r"\(.*?\)", "", line).strip())]
    modal = {word for block in blocks[:4] for word in block.split()}
    if not {"G90", "G21"} <= modal:
        raise ReadBackError("the program does not say G90 G21, absolute millimetres.")
    control, cuts = _Control(), []
    for block in blocks:
        found = _WORD.findall(block)
        if "".join(block.split()) != "".join(letter + value for letter, value in found):
            raise ReadBackError(f"the block '{block}' is not understood.")
        cut = _obey(control, [(letter, float(value)) for letter, value in found], block)
        if cut is not None:
            cuts.append(cut)
    return cuts


def _obey(control: _Control, words: list[tuple[str, float]], block: str) -> Cut | None:
    codes = [int(value) for letter, value in words if letter == "G"]
    given = {letter: value for letter, value in words if letter not in "GM"}
    control.stops += ("M", 1.0) in words
    if "X" not in given:
        return None
    target = complex(given["X"], given["Y"]) * _MM
    begin, control.place = control.place, target
    motion = next((code for code in codes if code in (0, 1, 2, 3)), None)
    if motion is None:
        raise ReadBackError(f"the block '{block}' does not say how to move.")
    turned = next((code for code in codes if code in (40, 41, 42)), None)
    if turned in (41, 42):
        control.side, control.lead_in = turned, (begin, target)
        control.segments, control.stops = [], 0
        return None
    if turned == 40 and control.side != 40:
        return _finished(control, (begin, target))
    if control.side == 40:
        if motion != 0:
            raise ReadBackError(f"the block '{block}' cuts without an offset.")
        return None
    bulge = 0.0
    if motion in (2, 3):
        bulge = _bulge(begin, target, complex(given["I"], given["J"]) * _MM, motion == 3, block)
    control.segments.append((begin, target, bulge))
    return None


def _bulge(start: complex, end: complex, to_centre: complex, left: bool, block: str) -> float:
    centre = start + to_centre
    if abs(abs(start - centre) - abs(end - centre)) > RADII:
        raise ReadBackError(
            f"the radii of '{block}' differ by "
            f"{abs(abs(start - centre) - abs(end - centre)) * 1e6:.3g} um."
        )
    sweep = cmath.phase((end - centre) / (start - centre)) % (2.0 * math.pi)
    return math.tan(sweep / 4.0) if left else -math.tan((2.0 * math.pi - sweep) / 4.0)


def _finished(control: _Control, lead_out: tuple[complex, complex]) -> Cut:
    if not control.segments:
        raise ReadBackError("an offset is taken off before anything is cut.")
    start, end, bulge = (np.array(values) for values in zip(*control.segments, strict=True))
    if end[-1] != start[0] or (end[:-1] != start[1:]).any():
        raise ReadBackError("a contour of the program does not close.")
    cut = Cut(Loop(start, end, bulge), control.side, control.lead_in, lead_out, control.stops)
    control.side, control.stops = 40, 0
    return cut


def check_program(text: str, flat: FlatPart, edm: Edm) -> list[Cut]:
    """Read a program and refuse it unless it cuts the part and keeps its material.

    Raises
    ------
    ReadBackError
        Naming the cut that is wrong.
    """
    cuts = read_program(text)
    contours = [flat.contours[number] for number in flat.cut_order]
    if len(cuts) != len(contours):
        raise ReadBackError(f"{flat.label}: {len(cuts)} cuts for {len(contours)} contours.")
    for number, (cut, contour) in enumerate(zip(cuts, contours, strict=True), start=1):
        label, outer = f"{flat.label}, cut {number}", contour is flat.shape.outer
        if cut.loop.area <= 0.0:
            raise ReadBackError(f"{label}: it runs clockwise.")
        if cut.side != (42 if outer else 41):
            raise ReadBackError(f"{label}: G{cut.side} puts the wire into the material.")
        if (cut.loop.clearance(cut.lead_in[0]) > 0.0) != outer:
            raise ReadBackError(f"{label}: the wire is threaded in the material.")
        if cut.stops != 1 or cut.lead_out != cut.lead_in[::-1]:
            raise ReadBackError(f"{label}: it does not stop once and lead out as it led in.")
        _refuse_other_shape(label, cut.loop, contour, flat, edm, outer=outer)
    return cuts


def _refuse_other_shape(
    label: str, loop: Loop, contour: object, flat: FlatPart, edm: Edm, *, outer: bool
) -> None:
    if not isinstance(contour, Circle):
        fit = fit_of(loop, flat.exact, outer=outer)
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
