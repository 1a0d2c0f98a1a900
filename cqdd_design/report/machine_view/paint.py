"""SVG of projected machines: path data, silhouettes, and one paint box for all pictures."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.svg import element, fixed, thinned
from cqdd_design.report.machine_view.camera import Camera
from cqdd_design.report.machine_view.surfaces import Patch
from cqdd_design.solids.cad import MM
from cqdd_design.solids.hidden_lines import VisibleLines
from cqdd_design.solids.mesh import closed_mesh, picture_quality
from cqdd_design.solids.part import Part
from cqdd_design.solids.stations import Posed

if TYPE_CHECKING:
    from manifold3d import Manifold

_TENTH = 0.1
"""Of a px, the grid of drawn points: half of it is finer than any screen shows."""
_SMALL = 0.02
"""Outlines simpler than the drawing can show, mm."""

_FINE = 0.16
"""Points this near to the line without them are left out, px."""

INK = "#17212b"
SCALED = f"scale({_TENTH:g})"
"""Transform of what :func:`path_data` gives."""
UNSCALED = f"scale({1.0 / _TENTH:g})"
"""For patterns in it."""


@dataclass(frozen=True)
class Sheet:
    """The map from the camera's page (mm, y up) to a figure (px, y down).

    Attributes
    ----------
    scale : float
        px per mm.
    left, top : float
        What lies in the figure's upper left corner, mm.
    """

    scale: float
    left: float
    top: float

    def px(self, points: FloatArray) -> FloatArray:
        """Points (..., 2) in px."""
        return np.stack(
            [self.scale * (points[..., 0] - self.left), self.scale * (self.top - points[..., 1])],
            axis=-1,
        )


def path_data(lines: Iterable[FloatArray], sheet: Sheet, *, closed: bool) -> str:
    """Path data of chains (k, 2) in mm, with relative steps and no more points than show.

    In whole tenths of a px: whoever draws it scales it by :data:`_TENTH`.
    """
    pieces = []
    for line in lines:
        grid = np.round(thinned(sheet.px(line), _FINE) / _TENTH).astype(np.int64)
        keep = np.ones(len(grid), dtype=bool)
        keep[1:] = (np.diff(grid, axis=0) != 0).any(axis=1)
        grid = grid[keep]
        if len(grid) < 2:
            continue
        steps = " ".join(map(str, np.diff(grid, axis=0).ravel().tolist())).replace(" -", "-")
        first = " ".join(map(str, grid[0].tolist())).replace(" -", "-")
        pieces.append(f"M{first}l{steps}{'Z' if closed else ''}")
    return "".join(pieces)


def painted(patches: Sequence[Patch], sheet: Sheet) -> str:
    """Patches as filled paths; walls have a hair of their own colour round them against seams."""
    found = []
    for patch in patches:
        data = path_data(patch.loops, sheet, closed=True)
        if data:
            found.append(
                element("path", d=data, color=patch.fill, stroke="none" if patch.flat else None)
            )
    if not found:
        return ""
    return element(
        "g",
        *found,
        fill="currentColor",
        stroke="currentColor",
        stroke_width=fixed(0.5 / _TENTH),
        fill_rule="evenodd",
        transform=SCALED,
    )


def drawn(lines: VisibleLines, sheet: Sheet) -> str:
    """Visible lines: sharp edges thin, the limbs of round surfaces a little stronger."""
    return stroked(lines.edges, sheet, 0.7) + stroked(lines.outlines, sheet, 0.9)


def stroked(
    lines: Iterable[FloatArray], sheet: Sheet, width: float, *, closed: bool = False
) -> str:
    """Chains as one unfilled path."""
    data = path_data(lines, sheet, closed=closed)
    if not data:
        return ""
    return element(
        "path",
        d=data,
        fill="none",
        stroke=INK,
        stroke_width=fixed(width / _TENTH),
        stroke_linejoin="round",
        stroke_linecap="round",
        transform=SCALED,
    )


def silhouette(pieces: Sequence[Posed], camera: Camera) -> tuple[FloatArray, ...]:
    """Closed outlines (k, 2) of what some pieces cover together on the page, mm."""
    from manifold3d import CrossSection, FillRule, OpType

    shadows = []
    for piece in pieces:
        solid = solid_of(piece, camera.matrix)
        shadows.append(CrossSection(solid.project().to_polygons(), FillRule.Positive))
    joined = CrossSection.batch_boolean(shadows, OpType.Add).simplify(_SMALL)
    return tuple(np.asarray(loop) for loop in joined.to_polygons())


def solid_of(piece: Posed, frame: FloatArray) -> Manifold:
    """A piece, mm, seen in another frame for cuts and shadows.

    Parameters
    ----------
    frame : array (3, 3)
        Its unit vectors, in rows.
    """
    place = np.column_stack([piece.pose[:3, :3], piece.pose[:3, 3] * MM])
    return _solid(piece.part).transform(frame @ place)


@lru_cache(maxsize=512)
def _solid(part: Part) -> Manifold:
    """A part's mesh for pictures, in its own frame: ten screws are one solid that is moved."""
    from manifold3d import Manifold, Mesh

    mesh = closed_mesh(part, picture_quality(part))
    return Manifold(Mesh(mesh.vertices.astype(np.float32), mesh.triangles.astype(np.uint32)))


def bounds(loops: Iterable[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinates (2,) of some chains."""
    points = np.concatenate(list(loops))
    return points.min(axis=0), points.max(axis=0)


def titled(name: str, *children: str) -> str:
    """A group that shows a name under the pointer."""
    return element("g", element("title", html.escape(name)), *children)


def visible_parts(
    outlines: Sequence[tuple[FloatArray, ...]],
) -> list[tuple[FloatArray, ...]]:
    """What stays visible of outlines that are painted one over the other, in order."""
    from manifold3d import CrossSection, FillRule

    cover = CrossSection()
    found: list[tuple[FloatArray, ...]] = []
    for loops in reversed(outlines):
        own = CrossSection([*loops], FillRule.Positive)
        rest = (own - cover).offset(-0.4).simplify(_SMALL)
        found.append(tuple(np.asarray(loop) for loop in rest.to_polygons()))
        cover = cover + own
    return found[::-1]
