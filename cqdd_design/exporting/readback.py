"""Reading a written DXF back and refusing it unless it is the part it stands for.

The file is read from disk as plain group codes and values, not by the library that wrote it. What
is on the cut layers is turned into loops by `loops` and compared with the exact curve and with the
circles of the design.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.loops import Loop, LoopFit, fit_of
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.flat_parts import FlatPart

CUT_OUTER, CUT_INNER, START_HOLE = "CUT_OUTER", "CUT_INNER", "START_HOLE"
MILLIMETRES, METRIC = 4, 1
"""Values of $INSUNITS and $MEASUREMENT."""

SMOOTH = 1e-6
"""Largest change of direction at a joint that still counts as tangent, rad."""
SAME_PLACE = 1e-9
"""Circles stand and measure as designed within this, m."""
PERIMETER_SLACK = 0.05
"""Share of the perimeter by which only a stretch run twice or left out can miss it: the coarsest
fit that a design may ask for, 50 um on a 6 mm gearbox, is within 0.01."""

_MM = 1e-3


@dataclass(frozen=True)
class ReadBack:
    """What a file holds, measured.

    Attributes
    ----------
    fit : LoopFit
        The fitted contour against its exact curve.
    loops : int
        Closed loops on the cut layers.
    start_holes : int
        Circles on the layer of start holes.
    least_concave_radius : float
        Over all loops, m; infinite when nothing is concave.
    """

    fit: LoopFit
    loops: int
    start_holes: int
    least_concave_radius: float


@dataclass(frozen=True)
class Entity:
    """A graphic entity of a file: its type, and its group codes and values in order."""

    kind: str
    tags: tuple[tuple[int, str], ...]

    def numbers(self, code: int) -> list[float]:
        """Every value of a group code."""
        return [float(value) for key, value in self.tags if key == code]

    def first(self, code: int, default: str = "") -> str:
        """First value of a group code."""
        return next((value for key, value in self.tags if key == code), default)


@dataclass(frozen=True)
class DxfContents:
    """What this package needs of a DXF: header variables and the entities of the model space."""

    header: dict[str, str]
    entities: tuple[Entity, ...]

    def on_layer(self, layer: str) -> list[Entity]:
        """Entities of one layer, in file order."""
        return [entity for entity in self.entities if entity.first(8) == layer]


def read_dxf(path: Path) -> DxfContents:
    """Read an ASCII DXF as group codes and values.

    Raises
    ------
    ReadBackError
        When it is not an ASCII DXF, or stops half-way.
    """
    lines = path.read_text(encoding="cp1252", errors="replace").splitlines()
    try:
        tags = [
            (int(code), value.strip()) for code, value in zip(lines[::2], lines[1::2], strict=True)
        ]
    except ValueError as error:
        raise ReadBackError(
            f"{path.name}: this is not an ASCII DXF, or only half of one."
        ) from error
    if not tags or tags[-1] != (0, "EOF"):
        raise ReadBackError(f"{path.name}: the DXF stops before its end.")
    header = {
        name: value for (code, name), (_, value) in pairwise(_section(tags, "HEADER")) if code == 9
    }
    drawn = _section(tags, "ENTITIES")
    starts = [index for index, (code, _) in enumerate(drawn) if code == 0]
    entities = tuple(
        Entity(drawn[begin][1], tuple(drawn[begin + 1 : end]))
        for begin, end in pairwise([*starts, len(drawn)])
    )
    return DxfContents(header, entities)


def _section(tags: list[tuple[int, str]], name: str) -> list[tuple[int, str]]:
    if (2, name) not in tags:
        return []
    begin = tags.index((2, name)) + 1
    return tags[begin : tags.index((0, "ENDSEC"), begin)]


def read_back(path: Path, flat: FlatPart, edm: Edm) -> ReadBack:
    """Read a DXF from disk and compare it with the part it stands for.

    Parameters
    ----------
    path : Path
        The file.
    flat : FlatPart
        What should be in it.
    edm : Edm
        The design's table: profile tolerance, wire and gap.

    Raises
    ------
    ReadBackError
        When the file is not a whole DXF in millimetres, or is not the part.
    """
    label, contents = flat.label, read_dxf(path)
    units = tuple(contents.header.get(name) for name in ("$INSUNITS", "$MEASUREMENT"))
    if units != (str(MILLIMETRES), str(METRIC)):
        raise ReadBackError(
            f"{label}: $INSUNITS and $MEASUREMENT are {units}, not "
            f"{(MILLIMETRES, METRIC)}, millimetres."
        )
    outer = _cut_layer(contents, CUT_OUTER, label)
    inner = _cut_layer(contents, CUT_INNER, label)
    _same_circles(label, CUT_OUTER, outer.circles, [flat.shape.outer])
    _same_circles(label, CUT_INNER, inner.circles, flat.shape.holes)
    loops = outer.loops + inner.loops
    lobed = not isinstance(flat.shape.outer, Circle)
    if (len(outer.loops), len(inner.loops)) != ((1, 0) if lobed else (0, 1)):
        raise ReadBackError(
            f"{label}: {len(outer.loops)} polylines on {CUT_OUTER} and {len(inner.loops)} on "
            f"{CUT_INNER}; the part has one, on {CUT_OUTER if lobed else CUT_INNER}."
        )
    fit = fit_of(loops[0], flat.exact, outer=lobed)
    _refuse_misfit(label, fit, edm.profile_tolerance)
    starts = [_circle(entity) for entity in contents.on_layer(START_HOLE)]
    _refuse_bad_starts(label, starts, outer, inner)
    concave = min([fit.least_concave_radius, *(circle.radius for circle in inner.circles)])
    _refuse_thick_wire(label, concave, edm)
    count = len(loops) + len(outer.circles) + len(inner.circles)
    return ReadBack(fit, count, len(starts), concave)


@dataclass(frozen=True, eq=False)
class _CutLayer:
    loops: list[Loop]
    circles: list[Circle]

    def clearances(self, point: complex) -> list[float]:
        """Distance from `point` to each contour, m; negative inside it."""
        to_circles = [abs(point - complex(*c.centre)) - c.radius for c in self.circles]
        return to_circles + [loop.clearance(point) for loop in self.loops]


def _cut_layer(contents: DxfContents, layer: str, label: str) -> _CutLayer:
    """Everything on one cut layer: closed polylines and circles, and nothing else."""
    loops, circles = [], []
    for entity in contents.on_layer(layer):
        if entity.kind == "CIRCLE":
            circles.append(_circle(entity))
        elif entity.kind == "LWPOLYLINE":
            loops.append(_loop(entity, label))
        else:
            raise ReadBackError(f"{label}: a stray {entity.kind} is on layer {layer}.")
    return _CutLayer(loops, circles)


def _circle(entity: Entity) -> Circle:
    centre = np.array([entity.numbers(10)[0], entity.numbers(20)[0]])
    return Circle(centre * _MM, entity.numbers(40)[0] * _MM)


def _loop(entity: Entity, label: str) -> Loop:
    """Read a closed polyline; a joint without a bulge of its own starts a line."""
    if not int(entity.first(70, "0")) & 1:
        raise ReadBackError(f"{label}: a contour is not closed.")
    rows: list[list[float]] = []
    for code, value in entity.tags:
        if code == 10:
            rows.append([float(value), 0.0, 0.0])
        elif code in (20, 42) and rows:
            rows[-1][1 if code == 20 else 2] = float(value)
    x, y, bulges = np.array(rows).T
    joints = (x + 1j * y) * _MM
    following = np.roll(joints, -1)
    if (joints == following).any():
        raise ReadBackError(f"{label}: a contour has a joint twice in the same place.")
    loop = Loop(joints, following, bulges)
    if loop.area <= 0.0:
        raise ReadBackError(f"{label}: a contour runs clockwise.")
    return loop


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


def _refuse_misfit(label: str, fit: LoopFit, tolerance: float) -> None:
    if not fit.largest_deviation <= tolerance:
        raise ReadBackError(
            f"{label}: the contour leaves the exact curve by {fit.largest_deviation * 1e6:.4g} um, "
            f"more than edm.profile_tolerance {tolerance * 1e6:g} um."
        )
    if not fit.tangent_break <= SMOOTH:
        raise ReadBackError(
            f"{label}: the contour turns by {fit.tangent_break:.2g} rad at a joint; a wire path "
            f"is tangent within {SMOOTH:g} rad."
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
    if concave < edm.wire_diameter / 2.0 + edm.spark_gap:
        most = max(2.0 * (concave - edm.spark_gap), 0.0)
        raise ReadBackError(
            f"{label}: the least concave radius is {concave * 1e3:.4f} mm, but edm.wire_diameter "
            f"{edm.wire_diameter * 1e3:g} mm with a gap of {edm.spark_gap * 1e6:g} um cuts none "
            f"below {(edm.wire_diameter / 2.0 + edm.spark_gap) * 1e3:.4f} mm; choose a wire of at "
            f"most {most * 1e3:.3f} mm."
        )
