"""The machine cut through its axis, as a drawing would show it.

The cut is an aligned one: two half planes meet on the axis. The right one runs along the crank and
through the first pin of the carrier, at the crank angle at which the two are in line; the left one
through the fastener of the housing nearest to the opposite side. What lies behind the cut is drawn
by its visible lines. Bearings, shafts, pins and screws are cut but not hatched (ISO 128).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.svg import Figure, Words, element, fixed, text
from cqdd_design.report.machine_view.balloons import spread
from cqdd_design.report.machine_view.camera import Camera, tinted
from cqdd_design.report.machine_view.paint import (
    INK,
    SCALED,
    UNSCALED,
    Sheet,
    bounds,
    path_data,
    solid_of,
    stroked,
    titled,
)
from cqdd_design.solids.cad import MM, import_cadquery, within
from cqdd_design.solids.cut_plane import cut_angles, is_hatched
from cqdd_design.solids.hidden_lines import VisibleLines
from cqdd_design.solids.part import Part
from cqdd_design.solids.poses import transform
from cqdd_design.solids.stations import Station, posed

if TYPE_CHECKING:
    from manifold3d import CrossSection

_WIDTH = 964.0
_MARGIN = 16.0
_SIDE = 216.0
"""Room for names on either side, px."""
_LINE = 21.0
_ENDS = np.s_[:-1], np.s_[1:]
"""Of a chain's segments."""
_SPECK = 0.02
"""Cut faces below this are grazed, not cut, mm^2."""
_FRONT = Camera(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0]))


@dataclass(frozen=True, eq=False)
class CutFace:
    """What the plane cuts of one piece.

    Attributes
    ----------
    loops : tuple of array (k, 2)
        Outlines, mm: across the axis and along it; inner loops are holes.
    area : float
        mm^2.
    """

    station: Station
    loops: tuple[FloatArray, ...]
    area: float


def cut_faces(
    design: Design, found: Sequence[Station], crank_angle: float, direction: float
) -> tuple[CutFace, ...]:
    """Faces in which the half plane of a direction (rad) cuts the pieces, the axis on the left."""
    from manifold3d import CrossSection, FillRule

    faces = []
    half = CrossSection.square((1e4, 2e4)).translate((0.0, -1e4))
    for station in found:
        for piece in posed(station, design, crank_angle):
            turned = piece.moved(transform(-direction))
            depth = turned.vertices[:, 1]
            if depth.min() > 0.0 or depth.max() < 0.0:
                continue
            cut = (
                CrossSection(
                    solid_of(turned, _FRONT.matrix).slice(0.0).to_polygons(), FillRule.Positive
                )
                ^ half
            )
            if cut.area() > _SPECK:
                loops = tuple(np.asarray(loop) for loop in cut.simplify(1e-3).to_polygons())
                faces.append(CutFace(station, loops, cut.area()))
    return tuple(faces)


def lines_behind(
    design: Design, found: Sequence[Station], crank_angle: float, direction: float
) -> VisibleLines:
    """Visible lines of what is left behind the half plane of a direction (rad)."""
    cadquery = import_cadquery()
    reach = 2.0 * MM * max(max(s.outer, abs(s.bottom), abs(s.top)) for s in found)
    quarter = cadquery.Solid.makeBox(reach, reach, 2.0 * reach, cadquery.Vector(0.0, 0.0, -reach))
    shapes = []
    for station in found:
        for piece in posed(station, design, crank_angle):
            turned = piece.moved(transform(-direction))
            box = turned.vertices[:, :2]
            if (box.max(axis=0) < 0.0).any():
                continue
            cut = (box.min(axis=0) < 0.0).any()
            shapes += (within(turned.solid, quarter) if cut else turned.solid).Solids()
    lines = _FRONT.lines(shapes)
    return VisibleLines(
        tuple(line for line in lines.edges if not _on_axis(line)),
        lines.outlines,
    )


def _on_axis(line: FloatArray) -> bool:
    """Whether a line lies on the axis, where the quarter was cut off."""
    return bool(np.abs(line[:, 0]).max() < 1e-3)


def section_figure(design: Design, parts: Sequence[Part], found: Sequence[Station]) -> Figure:
    """Cut faces with hatching, lines behind them, and the names of the parts."""
    right, left = cut_angles(design, found)
    mirror = np.array([-1.0, 1.0])
    faces: list[CutFace] = []
    lines: list[FloatArray] = []
    for direction, side in ((right, np.array([1.0, 1.0])), (left, mirror)):
        cut = cut_faces(design, found, right, direction)
        faces += [
            CutFace(face.station, tuple(loop * side for loop in face.loops), face.area)
            for face in cut
        ]
        behind = lines_behind(design, found, right, direction)
        lines += [line * side for line in (*behind.edges, *behind.outlines)]
    low, high = bounds([*lines, *(loop for face in faces for loop in face.loops)])
    scale = min((_WIDTH - 2.0 * _SIDE) / (high[0] - low[0]), 640.0 / (high[1] - low[1]))
    left_edge = 0.5 * (low[0] + high[0]) - 0.5 * _WIDTH / scale
    sheet = Sheet(scale, left_edge, high[1] + (_MARGIN + 6.0) / scale)
    names, tall = _names(parts, faces, sheet, 0.0)
    height = max(scale * float(high[1] - low[1]) + 2.0 * _MARGIN + 12.0, tall)
    names, _ = _names(parts, faces, sheet, height)
    order = sorted(faces, key=lambda face: (face.station.number, face.area))
    cuts = "".join(titled(face.station.name, _face(face, sheet)) for face in order)
    ends = sheet.px(np.array([[0.0, low[1] - 3.0], [0.0, high[1] + 3.0]]))
    axis = element(
        "line", x1=ends[0, 0], y1=ends[0, 1], x2=ends[1, 0], y2=ends[1, 1], class_="centre-line"
    )
    cut_through = ", ".join(dict.fromkeys(face.station.part.name for face in order))
    words = Words(
        "machine-section",
        "Section through the axis",
        f"Aligned section, output side up. Cut: {cut_through}.",
        "Right half through the crank and an output pin, left half through a screw of the "
        "housing. Bearings, shafts, pins and screws are not hatched.",
    )
    drawing = element("g", _ground(lines, faces, sheet), cuts, stroked(lines, sheet, 0.6))
    return words.figure(_WIDTH, height, [_patterns(parts, order), drawing, axis, names])


def _ground(lines: Sequence[FloatArray], faces: Sequence[CutFace], sheet: Sheet) -> str:
    """A pale ground under everything that has material in front of it or behind it."""
    from manifold3d import CrossSection, FillRule, OpType

    chains = [*lines, *(loop for face in faces for loop in face.loops)]
    below, above = (np.concatenate([chain[ends] for chain in chains]) for ends in _ENDS)
    farthest = {side: np.maximum(side * below[:, 0], side * above[:, 0]) for side in (-1.0, 1.0)}
    strips = []
    levels = np.unique(np.round(np.concatenate(chains)[:, 1], 2))
    for low, high in pairwise(levels.tolist()):
        middle = 0.5 * (low + high)
        crossing = (below[:, 1] - middle) * (above[:, 1] - middle) <= 0.0
        for side, far in farthest.items():
            reach = float(far[crossing].max(initial=0.0))
            if reach > 0.0:
                strip = np.array([[0.0, low], [side * reach, low], [side * reach, high], [0, high]])
                strips.append(CrossSection([strip], FillRule.NonZero))
    ground = CrossSection.batch_boolean(strips, OpType.Add)
    data = path_data([np.asarray(loop) for loop in ground.to_polygons()], sheet, closed=True)
    return element("path", d=data, fill="#eef1f4", fill_rule="evenodd", transform=SCALED)


def _face(face: CutFace, sheet: Sheet) -> str:
    data = path_data(face.loops, sheet, closed=True)
    station = face.station
    fill = tinted(station.part.colour, 0.74)
    drawn = [element("path", d=data, fill=fill, fill_rule="evenodd", transform=SCALED)]
    if is_hatched(station):
        drawn.append(
            element(
                "path",
                d=data,
                fill=f"url(#cut-{station.number})",
                fill_rule="evenodd",
                transform=SCALED,
            )
        )
    elif station.part.inner_body is not None:
        drawn.append(_bearing_mark(face, sheet))
    drawn.append(stroked(face.loops, sheet, 1.3, closed=True))
    return "".join(drawn)


def _bearing_mark(face: CutFace, sheet: Sheet) -> str:
    """The upright cross of a bearing drawn in the simplified manner (ISO 8826-1)."""
    low, high = bounds(face.loops)
    centre, half = 0.5 * (low + high), 0.28 * float((high - low).min())
    cross = [
        np.array([centre - offset, centre + offset])
        for offset in (np.array([half, 0.0]), np.array([0.0, half]))
    ]
    return stroked(cross, sheet, 1.0)


def _patterns(parts: Sequence[Part], faces: Sequence[CutFace]) -> str:
    """One hatching a part: neighbours in the list differ in direction and spacing."""
    used = sorted({face.station.number for face in faces if is_hatched(face.station)})
    found = []
    for position, number in enumerate(used):
        spacing = (6.0, 6.0, 8.5, 8.5, 4.6, 4.6)[position % 6]
        angle = 45 if position % 2 == 0 else -45
        shade = tinted(parts[number - 1].colour, 0.05)
        found.append(
            element(
                "pattern",
                element(
                    "line", x1=0.0, y1=0.0, x2=0.0, y2=spacing, stroke=shade, stroke_width="1.1"
                ),
                id=f"cut-{number}",
                width=spacing,
                height=spacing,
                patternUnits="userSpaceOnUse",
                patternTransform=f"rotate({angle}) {UNSCALED}",
            )
        )
    return element("defs", *found) if found else ""


def _names(
    parts: Sequence[Part], faces: Sequence[CutFace], sheet: Sheet, height: float
) -> tuple[str, float]:
    """Names in two columns with leaders to the cut faces, and the height the longer one wants."""
    spots: tuple[dict[int, FloatArray], dict[int, FloatArray]] = ({}, {})
    for face in sorted(faces, key=lambda face: -face.area):
        spot = _inside(face)
        spots[0 if spot[0] < 0.0 else 1].setdefault(face.station.number, spot)
    columns = [
        [(number, spot) for number, spot in own.items() if number not in other]
        for own, other in (spots, spots[::-1])
    ]
    for number in sorted(set(spots[0]) & set(spots[1])):
        shorter = 0 if len(columns[0]) <= len(columns[1]) else 1
        columns[shorter].append((number, spots[shorter][number]))
    drawn = []
    for column, side in zip(columns, (-1.0, 1.0), strict=True):
        ranked = sorted(column, key=lambda entry: -float(entry[1][1]))
        tips = [sheet.px(spot) for _, spot in ranked]
        places = spread([float(tip[1]) for tip in tips], _LINE, 16.0, max(height, 32.0) - 14.0)
        x = _SIDE - 34.0 if side < 0.0 else _WIDTH - _SIDE + 34.0
        for (number, _), tip, y in zip(ranked, tips, places, strict=True):
            part = parts[number - 1]
            label = part.name if part.count == 1 else f"{part.count} \u00d7 {part.name}"
            anchor = "end" if side < 0.0 else "start"
            drawn.append(text((x + side * 6.0, y + 4.0), label, "name-dark", anchor))
            elbow = x - side * 14.0
            data = (
                f"M{fixed(x)} {fixed(y)}L{fixed(elbow)} {fixed(y)}L{fixed(tip[0])} {fixed(tip[1])}"
            )
            drawn.append(element("path", d=data, fill="none", stroke=INK, stroke_width="0.8"))
            drawn.append(element("circle", cx=float(tip[0]), cy=float(tip[1]), r=2.0, fill=INK))
    return element("g", *drawn), _LINE * max(map(len, columns)) + 32.0


def _inside(face: CutFace) -> FloatArray:
    """A point well inside a cut face: where it withstands shrinking longest."""
    from manifold3d import CrossSection, FillRule

    shape: CrossSection = CrossSection([*face.loops], FillRule.EvenOdd)
    step = 0.5 * math.sqrt(face.area)
    for _ in range(12):
        smaller = shape.offset(-step)
        if smaller.area() > 0.0:
            shape = smaller
        step *= 0.6
    loops = [np.asarray(loop) for loop in shape.to_polygons()]
    low, high = bounds(loops[:1])
    return np.asarray(0.5 * (low + high))
