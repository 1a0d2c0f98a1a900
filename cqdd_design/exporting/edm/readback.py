"""Reading a written DXF back and refusing it unless it is the part it stands for.

What `dxf_reader` finds on the cut layers is compared with the exact curve and with the circles of
the design; what is on the layers of the wire, with the contours of the same file.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.dxf_reader import DxfContents, circles_of, loops_of, read_dxf
from cqdd_design.exporting.edm.loops import Loop, LoopFit, fit_of
from cqdd_design.exporting.edm.wire_check import measure_paths
from cqdd_design.exporting.options import DEFAULTS, ExportOptions
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.edm.flat_parts import FlatPart

CUT_OUTER, CUT_INNER, START_HOLE = "CUT_OUTER", "CUT_INNER", "START_HOLE"
WIRE_PATH, LEAD_IN, NOTES = "WIRE_PATH", "LEAD_IN", "NOTES"
UNITS_NOTE = "UNITS mm"
R12 = "AC1009"
"""Value of $ACADVER in the dialect whose header knows no units."""
MILLIMETRES, METRIC = 4, 1
"""Values of $INSUNITS and $MEASUREMENT."""

SMOOTH = 1e-6
"""Largest change of direction at a joint that still counts as tangent, rad."""
SAME_PLACE = 1e-9
"""Circles stand and measure as designed within this, m."""
PERIMETER_SLACK = 0.05
"""Share of the perimeter by which only a stretch run twice or left out can miss it: the coarsest
fit that a design may ask for, 50 um on a 6 mm gearbox, is within 0.01."""


def read_back(
    path: Path,
    flat: FlatPart,
    edm: Edm,
    options: ExportOptions = DEFAULTS,
    *,
    wire_paths: bool = False,
) -> LoopFit:
    """Read a DXF from disk, compare it with the part it stands for, and measure its contour.

    Parameters
    ----------
    path : Path
        The file.
    flat : FlatPart
        What should be in it.
    edm : Edm
        The design's table: profile tolerance, wire and gap.
    options : ExportOptions, optional
        In which style it should be.
    wire_paths : bool
        Whether it should hold the paths of the wire.

    Raises
    ------
    ReadBackError
        When the file is not a whole DXF in millimetres, or is not the part.
    """
    label, contents = flat.label, read_dxf(path)
    _refuse_other_units(label, contents)
    outer = _cut_layer(contents, CUT_OUTER, label, options)
    inner = _cut_layer(contents, CUT_INNER, label, options)
    _same_circles(label, CUT_OUTER, outer.circles, [flat.shape.outer])
    _same_circles(label, CUT_INNER, inner.circles, flat.shape.holes)
    arcs = [contour for contour in flat.contours if not isinstance(contour, Circle)]
    outside = arcs[0] is flat.shape.outer
    expected = (int(outside), len(arcs) - int(outside))
    if (len(outer.loops), len(inner.loops)) != expected:
        raise ReadBackError(
            f"{label}: {len(outer.loops)} polylines on {CUT_OUTER} and {len(inner.loops)} on "
            f"{CUT_INNER}; the part has {expected[0]} and {expected[1]}."
        )
    loops = zip(arcs, outer.loops + inner.loops, strict=True)
    fits = {
        contour is flat.fitted: fit_of(
            loop, flat.exact_of(contour), outer=contour is flat.shape.outer
        )
        for contour, loop in loops
    }
    for one in fits.values():
        refuse_misfit(label, one, edm.profile_tolerance)
    fit = fits[True]
    starts = circles_of(contents, START_HOLE)
    _refuse_bad_starts(label, starts, outer, inner)
    concave = min(
        [
            *(one.least_concave_radius for one in fits.values()),
            *(circle.radius for circle in inner.circles),
        ]
    )
    _refuse_thick_wire(label, concave, edm)
    if wire_paths:
        measure_paths(
            label,
            loops_of(contents, WIRE_PATH, label, options),
            [entity.ends for entity in contents.on_layer(LEAD_IN)],
            starts,
            (outer.all_loops, inner.all_loops),
            edm,
        )
    return fit


def _refuse_other_units(label: str, contents: DxfContents) -> None:
    notes = [entity.first(1) for entity in contents.on_layer(NOTES)]
    if UNITS_NOTE not in notes:
        raise ReadBackError(f"{label}: no note says '{UNITS_NOTE}'.")
    units = tuple(contents.header.get(name) for name in ("$INSUNITS", "$MEASUREMENT"))
    absent = (None, None) if contents.header.get("$ACADVER") == R12 else None
    if units not in ((str(MILLIMETRES), str(METRIC)), absent):
        raise ReadBackError(
            f"{label}: $INSUNITS and $MEASUREMENT are {units}, not "
            f"{(MILLIMETRES, METRIC)}, millimetres."
        )


@dataclass(frozen=True, eq=False)
class _CutLayer:
    loops: list[Loop]
    circles: list[Circle]

    def clearances(self, point: complex) -> list[float]:
        """Distance from `point` to each contour, m; negative inside it."""
        to_circles = [abs(point - complex(*c.centre)) - c.radius for c in self.circles]
        return to_circles + [loop.clearance(point) for loop in self.loops]

    @property
    def all_loops(self) -> list[Loop]:
        """Every contour as a loop of arcs, circles as two half circles."""
        halves = [
            (complex(*c.centre) + c.radius, complex(*c.centre) - c.radius) for c in self.circles
        ]
        rounds = [Loop(np.array(h), np.array(h[::-1]), np.ones(2)) for h in halves]
        return rounds + self.loops


def _cut_layer(contents: DxfContents, layer: str, label: str, options: ExportOptions) -> _CutLayer:
    """Everything on one cut layer: closed contours and circles, and nothing else."""
    return _CutLayer(loops_of(contents, layer, label, options), circles_of(contents, layer))


def _same_circles(
    label: str, layer: str, found: Sequence[Circle], contours: Sequence[object]
) -> None:
    """Refuse circles that are missing, too many, doubled or out of place."""
    left = list(found)
    wanted = [contour for contour in contours if isinstance(contour, Circle)]
    for circle in wanted:
        near = [c for c in left if math.dist(c.centre, circle.centre) < SAME_PLACE]
        exact = [c for c in near if abs(c.radius - circle.radius) < SAME_PLACE]
        if not exact:
            x, y = (float(v) * 1e3 for v in circle.centre)
            raise ReadBackError(
                f"{label}: no circle of {2e3 * circle.radius:.6f} mm stands at "
                f"({x:.6f}, {y:.6f}) mm on {layer}."
            )
        left.remove(exact[0])
    if left:
        raise ReadBackError(
            f"{label}: {len(found)} circles are on {layer}; the part has {len(wanted)}."
        )


def refuse_misfit(label: str, fit: LoopFit, tolerance: float, smooth: float = SMOOTH) -> None:
    """Refuse a contour that leaves the exact curve, has kinks, or another area or length.

    Raises
    ------
    ReadBackError
    """
    if not fit.largest_deviation <= tolerance:
        raise ReadBackError(
            f"{label}: the contour leaves the exact curve by {fit.largest_deviation * 1e6:.4g} um, "
            f"more than edm.profile_tolerance {tolerance * 1e6:g} um."
        )
    if not fit.tangent_break <= smooth:
        raise ReadBackError(
            f"{label}: the contour turns by {fit.tangent_break:.2g} rad at a joint; a wire path "
            f"is tangent within {smooth:g} rad."
        )
    # A contour that stays within the tolerance cannot differ by more area than a band of it.
    if not abs(fit.area_error) <= tolerance * fit.perimeter:
        raise ReadBackError(
            f"{label}: the contour holds {fit.area * 1e6:.6f} mm^2, "
            f"{fit.area_error * 1e6:+.3g} mm^2 off the exact curve."
        )
    if not abs(fit.perimeter_error) <= PERIMETER_SLACK * fit.perimeter:
        raise ReadBackError(
            f"{label}: the contour is {fit.perimeter * 1e3:.4f} mm long, "
            f"{fit.perimeter_error * 1e3:+.3g} mm off the exact curve."
        )


def _refuse_bad_starts(
    label: str, starts: Sequence[Circle], outer: _CutLayer, inner: _CutLayer
) -> None:
    """One start hole outside the outer contour, one inside each inner one, all clear of walls."""
    served = []
    for start in starts:
        place = complex(*start.centre)
        (from_outer,) = outer.clearances(place)
        from_inner = inner.clearances(place)
        holds = [index for index, distance in enumerate(from_inner) if distance < 0.0]
        walls = [abs(distance) for distance in [from_outer, *from_inner]]
        if min(walls) <= start.radius:
            raise ReadBackError(
                f"{label}: the start hole at ({place.real * 1e3:.4f}, {place.imag * 1e3:.4f}) mm "
                "cuts into a contour."
            )
        served.append(-1 if from_outer > 0.0 else holds[0] if len(holds) == 1 else None)
    expected = [-1, *range(len(inner.circles) + len(inner.loops))]
    if None in served or sorted(s for s in served if s is not None) != expected:
        raise ReadBackError(
            f"{label}: {len(starts)} start holes do not serve {len(expected)} contours one each."
        )


def _refuse_thick_wire(label: str, concave: float, edm: Edm) -> None:
    if concave < edm.wire_offset:
        most = max(math.floor(2e6 * (concave - edm.spark_gap)) * 1e-6, 0.0)
        raise ReadBackError(
            f"{label}: the least concave radius is {concave * 1e3:.4f} mm, but edm.wire_diameter "
            f"{edm.wire_diameter * 1e3:g} mm with a gap of {edm.spark_gap * 1e6:g} um cuts none "
            f"below {edm.wire_offset * 1e3:.4f} mm; choose a wire of at "
            f"most {most * 1e3:.3f} mm."
        )
