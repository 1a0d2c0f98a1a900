"""Shaded surfaces of pieces, painted from the far side to the near one.

Every piece is a pile of prisms, and the viewer looks from above: what lies higher covers what
lies lower. So painting slab by slab upward, and in each slab the walls from the back to the front
and then the tops, shows every surface where it is seen, with nothing cut.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cqdd_design.geometry.contours import Contour, FloatArray
from cqdd_design.report.machine_view.camera import Camera, tinted
from cqdd_design.solids.cad import MM
from cqdd_design.solids.part import Colour
from cqdd_design.solids.stations import Posed

_SAG = 4e-5
"""Most distance of a drawn wall from the surface, m."""
_TONES = 12
"""Steps of brightness on a curved wall."""
_HIDDEN = 0.15
"""A patch of which less than this is visible is left out, mm^2."""
_TOP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Patch:
    """A flat patch of the picture in one colour.

    Attributes
    ----------
    loops : tuple of array (k, 2)
        Closed outlines, mm on the page, y up; inner loops are holes.
    fill : str
        ``#rrggbb``.
    piece : int
        Which of the pieces it belongs to.
    flat : bool
        A top, which others of its kind continue; walls overlap their neighbours by a hair.
    """

    loops: tuple[FloatArray, ...]
    fill: str
    piece: int
    flat: bool = False

    def moved(self, shift: FloatArray) -> Patch:
        """The same patch elsewhere on the page; `shift` (2,) in mm."""
        return Patch(tuple(loop + shift for loop in self.loops), self.fill, self.piece, self.flat)


def patches(pieces: Sequence[Posed], camera: Camera) -> list[Patch]:
    """Patches of some pieces, to be painted in order.

    Parameters
    ----------
    pieces : sequence of Posed
        Turned about z, turned over or moved, as all poses of the machine are.
    camera : Camera
        Looking from the output side, or at right angles to the axis.
    """
    levels = np.array(sorted({h for piece in pieces for h in _heights(piece)}))
    slabs: list[list[_Loop]] = [[] for _ in levels]
    tops: list[list[Patch]] = [[] for _ in levels]
    for index, piece in enumerate(pieces):
        known: dict[tuple[object, ...], _Loop] = {}
        for layer in piece.part.shape.layers:
            low, high = sorted(_height(piece.pose, h) for h in (layer.bottom, layer.top))
            first, last = (int(np.searchsorted(levels, round(h, 9))) for h in (low, high))
            loops = [
                _shared(known, _Loop(_placed(contour, piece.pose), hole, piece.part.colour, index))
                for contour, hole in (
                    (layer.shape.outer, False),
                    *((hole, True) for hole in layer.shape.holes),
                )
            ]
            for slab in range(first, last):
                slabs[slab] += loops
            face = tuple(_lifted(loop.points, high, camera) for loop in loops)
            fill = tinted(piece.part.colour, float(camera.brightness(_TOP)))
            tops[last - 1].append(Patch(face, fill, index, flat=True))
    orders = [_back_to_front(loops, camera) for loops in slabs]
    painted: list[Patch] = []
    for slab, order in enumerate(orders):
        for loop, alone in order:
            start, stop = slab, slab + 1
            if alone:
                # The skin of the machine: nothing passes before it, so it is painted in one go.
                if slab + 1 < len(orders) and (loop, True) in orders[slab + 1]:
                    continue
                while start > 0 and (loop, True) in orders[start - 1]:
                    start -= 1
            painted += _walls(loop, levels[start], levels[stop], camera)
        painted += tops[slab]
    return _uncovered(painted)


@dataclass(frozen=True, eq=False)
class _Loop:
    """A closed wall in a slab: counter-clockwise points (m, 2) in m, round material or a hole."""

    points: FloatArray
    hole: bool
    colour: Colour
    piece: int

    @cached_property
    def area(self) -> float:
        x, y = self.points.T
        return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())

    @cached_property
    def _box(self) -> tuple[FloatArray, FloatArray]:
        return self.points.min(axis=0), self.points.max(axis=0)

    @cached_property
    def centre(self) -> FloatArray:
        return np.asarray(0.5 * (self._box[0] + self._box[1]))

    @cached_property
    def _known(self) -> dict[object, Any]:
        """What has been worked out: a wall runs through many slabs."""
        return {}

    def strips(self, camera: Camera) -> list[_Strip]:
        """The facets that face the viewer, the far ones first."""
        if "strips" not in self._known:
            self._known["strips"] = _strips(self, camera)
        found: list[_Strip] = self._known["strips"]
        return found

    def surrounds(self, other: _Loop) -> bool:
        """Whether the middle of another loop lies inside."""
        if other not in self._known:
            self._known[other] = self._contains(other.centre)
        return bool(self._known[other])

    def _contains(self, place: FloatArray) -> bool:
        low, high = self._box
        if (place < low).any() or (place > high).any():
            return False
        here, there = self.points - place, np.roll(self.points, -1, axis=0) - place
        crosses = (here[:, 1] > 0.0) != (there[:, 1] > 0.0)
        side = here[:, 0] * there[:, 1] - there[:, 0] * here[:, 1]
        right = crosses & ((side > 0.0) == (there[:, 1] > here[:, 1]))
        return bool(np.count_nonzero(right) % 2)


def _shared(known: dict[tuple[object, ...], _Loop], loop: _Loop) -> _Loop:
    """The loop, or the same one of another layer of the piece: one wall runs through both."""
    span = (loop.points.min(axis=0), loop.points.max(axis=0))
    key = (loop.hole, len(loop.points), round(loop.area, 12), *np.round(span, 8).ravel().tolist())
    return known.setdefault(key, loop)


def _back_to_front(loops: Sequence[_Loop], camera: Camera) -> list[tuple[_Loop, bool]]:
    """Walls of one slab in the order of painting, and whether each surrounds all the others.

    The visible wall of a hole is its far one, behind all that stands in the hole; the visible wall
    round material is its near one, before all that is in it.
    """
    # Where a seat fits its bore the bore is the outer one.
    order = sorted(loops, key=lambda loop: (-round(loop.area, 10), not loop.hole))
    inside: dict[int, list[int]] = {}
    for index, loop in enumerate(order):
        parents = [i for i in range(index) if order[i].surrounds(loop)]
        inside.setdefault(parents[-1] if parents else -1, []).append(index)

    def sequence(parent: int) -> Iterable[_Loop]:
        children = inside.get(parent, [])
        for child in sorted(
            children, key=lambda i: round(float(order[i].centre @ camera.towards[:2]), 9)
        ):
            if order[child].hole:
                yield order[child]
            yield from sequence(child)
            if not order[child].hole:
                yield order[child]

    alone = order[0] if len(inside.get(-1, [])) == 1 else None
    return [(loop, loop is alone) for loop in sequence(-1)]


def _uncovered(painted: Sequence[Patch]) -> list[Patch]:
    """The patches of which something stays visible when all are painted in turn."""
    from manifold3d import CrossSection, FillRule, JoinType, OpType

    cover = CrossSection()
    fresh: list[CrossSection] = []
    kept = []
    for patch in reversed(painted):
        shape = CrossSection([*patch.loops], FillRule.EvenOdd)
        if len(fresh) > 15:
            cover = CrossSection.batch_boolean([cover, *fresh], OpType.Add)
            # Loose ends between neighbours, far below a pixel, would make the cover ever finer.
            cover = cover.offset(0.01, JoinType.Miter).simplify(0.01)
            fresh = []
        if not (shape - cover).area() > _HIDDEN:
            continue
        kept.append(patch)
        fresh.append(shape)
    return kept[::-1]


def _heights(piece: Posed) -> Iterable[float]:
    for layer in piece.part.shape.layers:
        for height in (layer.bottom, layer.top):
            yield round(_height(piece.pose, height), 9)


def _height(pose: FloatArray, height: float) -> float:
    return float(pose[2, 2] * height + pose[2, 3])


def _placed(contour: Contour, pose: FloatArray) -> FloatArray:
    """A contour as a counter-clockwise polygon (m, 2) in the machine, m."""
    points = contour.sample(_SAG) @ pose[:2, :2].T + pose[:2, 3]
    return points if pose[2, 2] > 0.0 else points[::-1]


def _lifted(points: FloatArray, height: float, camera: Camera) -> FloatArray:
    """Points (m, 2) at a height (m) on the page (m, 2), mm."""
    flat = np.column_stack([points, np.full(len(points), height)])
    return camera.page(flat) * MM


def _walls(loop: _Loop, low: float, high: float, camera: Camera) -> list[Patch]:
    """Patches of one wall that face the viewer, the far ones first."""
    rise = camera.page(_TOP) * MM
    return [
        Patch(
            (np.concatenate([strip.chain + high * rise, (strip.chain + low * rise)[::-1]]),),
            strip.fill,
            loop.piece,
        )
        for strip in loop.strips(camera)
    ]


@dataclass(frozen=True, eq=False)
class _Strip:
    """Neighbouring facets of one tone, as their trace at height 0 on the page, mm."""

    chain: FloatArray
    fill: str


def _strips(loop: _Loop, camera: Camera) -> list[_Strip]:
    points = loop.points
    edges = np.roll(points, -1, axis=0) - points
    outward = np.column_stack([edges[:, 1], -edges[:, 0]])
    outward *= (-1.0 if loop.hole else 1.0) / np.linalg.norm(outward, axis=1, keepdims=True)
    facing = outward @ camera.towards[:2] > 1e-9
    bright = camera.brightness(np.column_stack([outward, np.zeros(len(outward))]))
    tones = np.where(facing, np.round(bright * _TONES), -1).astype(int)
    found = []
    for start, count in _runs(tones):
        chain = points[(start + np.arange(count + 1)) % len(points)]
        nearness = round(float((chain @ camera.towards[:2]).mean()), 9)
        fill = tinted(loop.colour, tones[start] / _TONES)
        found.append((nearness, _Strip(_lifted(chain, 0.0, camera), fill)))
    return [strip for _, strip in sorted(found, key=lambda entry: entry[0])]


def _runs(tones: np.ndarray) -> list[tuple[int, int]]:
    """Start and length of every run of equal tones round a closed polygon, -1 left out."""
    count = len(tones)
    breaks = [i for i in range(count) if tones[i] != tones[i - 1]]
    if not breaks:
        return [(0, count)] if tones[0] >= 0 else []
    runs = []
    for here, there in zip(breaks, [*breaks[1:], breaks[0] + count], strict=True):
        if tones[here] >= 0:
            runs.append((here, there - here))
    return runs
