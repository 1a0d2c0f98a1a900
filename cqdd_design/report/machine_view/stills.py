"""The three still pictures of the machine: assembled, taken apart, cut through the axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.svg import Figure, Words, element
from cqdd_design.report.machine_view.balloons import ballooned, legend
from cqdd_design.report.machine_view.camera import Camera
from cqdd_design.report.machine_view.explode import take_apart
from cqdd_design.report.machine_view.paint import (
    SCALED,
    Sheet,
    bounds,
    drawn,
    painted,
    path_data,
    silhouette,
    stroked,
    titled,
    visible_parts,
)
from cqdd_design.report.machine_view.surfaces import Patch, patches
from cqdd_design.solids.cad import MM
from cqdd_design.solids.hidden_lines import VisibleLines
from cqdd_design.solids.part import Part
from cqdd_design.solids.poses import transform
from cqdd_design.solids.stations import Station, posed, stations

WIDTH = 964.0
"""Of a figure that fills the page, px."""
_MARGIN = 14.0
EXPLODED_TILT = math.radians(62.0)


@dataclass(frozen=True)
class MachineViews:
    """Pictures of the machine."""

    assembled: Figure
    exploded: Figure
    section: Figure


def hidden_line_views(design: Design, parts: Sequence[Part]) -> MachineViews:
    """Assembled, exploded and cut views of a machine as vector pictures.

    Parameters
    ----------
    parts : sequence of Part
        From `build_parts`.

    Returns
    -------
    MachineViews
        The same parts give the same bytes.

    Raises
    ------
    DependencyError
        When CadQuery is not usable.
    """
    from cqdd_design.report.machine_view.aligned_section import section_figure

    found = stations(parts)
    return MachineViews(
        assembled_figure(design, found),
        exploded_figure(design, parts, found),
        section_figure(design, parts, found),
    )


def assembled_figure(design: Design, found: Sequence[Station]) -> Figure:
    """The whole machine from its output side."""
    camera = Camera.oblique(math.radians(52.0), math.radians(20.0))
    pieces = [piece for station in found for piece in posed(station, design, 0.0)]
    faces = patches(pieces, camera)
    seen = [pieces[index] for index in sorted({face.piece for face in faces})]
    lines = camera.lines([piece.solid for piece in seen])
    outline = silhouette(seen, camera)
    low, high = bounds(outline)
    scale = min(560.0 / (high[1] - low[1]), 640.0 / (high[0] - low[0]))
    sheet = Sheet(scale, low[0] - _MARGIN / scale, high[1] + _MARGIN / scale)
    width, height = (scale * (high - low) + 2.0 * _MARGIN).tolist()
    # Surfaces are those of prisms: what chamfers take off them lies outside the outline.
    edge = element("path", d=path_data(outline, sheet, closed=True), transform=SCALED)
    clip = element("clipPath", edge, id="assembled-outline")
    inside = element("g", painted(faces, sheet), clip_path="url(#assembled-outline)")
    body = clip + inside + drawn(lines, sheet) + stroked(outline, sheet, 1.9, closed=True)
    names = ", ".join(dict.fromkeys(piece.part.name for piece in seen))
    words = Words(
        "machine-assembled",
        "The assembled machine",
        f"Outside view from the output side. Visible: {names}.",
        "Output side to the front, hidden lines removed.",
    )
    return words.figure(width, height, [body])


def exploded_figure(design: Design, parts: Sequence[Part], found: Sequence[Station]) -> Figure:
    """The machine taken apart along its axis, with numbers and the list they point to."""
    camera = Camera.oblique(EXPLODED_TILT, math.radians(9.0))
    order, shifts = take_apart(found, EXPLODED_TILT)
    looks = [_looks(found[index], shifts[index], design, camera) for index in order]
    outlines = [tuple(loop for look in group for loop in look.outline) for group in looks]
    in_order = [found[index] for index in order]
    low, high = bounds(loop for loops in outlines for loop in loops)
    scale = (WIDTH - 2.0 * _MARGIN) / (high[0] - low[0])
    room = 62.0
    sheet = Sheet(scale, low[0] - _MARGIN / scale, high[1] + room / scale)
    height = scale * float(high[1] - low[1]) + 2.0 * room
    groups = []
    for station, group in zip(in_order, looks, strict=True):
        title = station.name if len(group) == 1 else f"{station.name}, {len(group)} pieces"
        inside = (
            painted(look.patches, sheet)
            + drawn(look.lines, sheet)
            + stroked(look.outline, sheet, 1.5, closed=True)
            for look in group
        )
        groups.append(titled(title, *inside))
    axis = _axis(found, shifts, camera, sheet)
    numbers = [station.number for station in in_order]
    seen = list(zip(numbers, visible_parts(outlines), strict=True))
    marks = ballooned(seen, outlines, sheet, WIDTH, height)
    table, table_height = legend(parts, WIDTH, height)
    names = ", ".join(station.name for station in in_order)
    words = Words(
        "machine-exploded",
        "The machine taken apart",
        f"Exploded view along the axis, in the order of assembly: {names}.",
        "Every piece in the order in which it goes together, output side to the right.",
    )
    return words.figure(WIDTH, height + table_height, [axis, *groups, marks, table])


@dataclass(frozen=True, eq=False)
class _Look:
    """One piece as it is drawn in the exploded view."""

    patches: tuple[Patch, ...]
    lines: VisibleLines
    outline: tuple[FloatArray, ...]

    def moved(self, shift: FloatArray) -> _Look:
        return _Look(
            tuple(patch.moved(shift) for patch in self.patches),
            self.lines.moved(shift),
            tuple(loop + shift for loop in self.outline),
        )


def _looks(station: Station, lift: float, design: Design, camera: Camera) -> list[_Look]:
    """The pieces of a lifted station, the far ones first."""
    pieces = [piece.moved(transform(z=lift)) for piece in posed(station, design, 0.0)]
    pieces.sort(key=lambda piece: round(float(camera.towards @ piece.pose[:3, 3]), 9))
    drawn_once: list[tuple[FloatArray, _Look]] = []
    found = []
    for piece in pieces:
        pose = piece.pose
        # Pieces that are only moved look alike.
        for other, look in drawn_once:
            if np.abs(other[:3, :3] - pose[:3, :3]).max() < 1e-9:
                found.append(look.moved(camera.page(pose[:3, 3] - other[:3, 3]) * MM))
                break
        else:
            lines = camera.lines([piece.solid])
            look = _Look(tuple(patches([piece], camera)), lines, silhouette([piece], camera))
            drawn_once.append((pose, look))
            found.append(look)
    return found


def _axis(found: Sequence[Station], shifts: Sequence[float], camera: Camera, sheet: Sheet) -> str:
    """The thin centre line behind the pieces."""
    low = min(s.bottom + shift for s, shift in zip(found, shifts, strict=True)) - 0.012
    high = max(s.top + shift for s, shift in zip(found, shifts, strict=True)) + 0.012
    ends = sheet.px(camera.page(np.array([[0.0, 0.0, low], [0.0, 0.0, high]])) * MM)
    (x1, y1), (x2, y2) = ends.tolist()
    return element("line", x1=x1, y1=y1, x2=x2, y2=y2, class_="centre-line")
