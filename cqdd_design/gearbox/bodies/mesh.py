"""Triangles in a plane body, graded to its ligaments, with sides that follow its curves.

scipy's Delaunay triangulation with points of its own: netgen's wheel (6.2.2608) brings a second
OpenCASCADE, 100 MB, and loads its symbols for the whole process, where CadQuery has another version
of the same; gmsh and Triangle have licences that do not fit. Loads here are smooth (see
:mod:`.point_load`), so a mesh of a few thousand triangles does, and the same numbers give the same
mesh on every machine. What a turn carries into itself gets a mesh that it carries into itself too.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.geometry.contours import ComplexArray, FloatArray

IntArray = NDArray[np.int64]

_SAMPLES = 600
"""Samples of a loop from which its spacing is found."""
_GRADING = 0.3
"""Growth of the size of triangles per distance."""
_PER_LIGAMENT = 2.0
"""Sides over the thinnest material between two loops."""
_THINNEST = 5e-3
"""Least material between two loops, over the body's radius."""
_LEAST_ANGLE = np.radians(12.0)
_MOST_VERTICES = 60_000
_EVENED = 6
"""Times every vertex inside moves to the middle of the triangles round it."""
_FIRST = 0.0137
"""Angle where the first sector begins, rad: where no centre of a triangle is likely to stand."""
_MOVED = 1e-8
"""How far vertices stand aside while their neighbours are found, over the body's radius."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles and the sides of them that lie on loops.

    Attributes
    ----------
    vertices : complex array (V,)
        m.
    triangles : array (3, K)
        Counter-clockwise.
    sides : tuple of array (S, 2)
        Of every loop: vertices of its sides, in its sense.
    parameters : tuple of array (S + 1,)
        Of every loop: parameters of their ends, rising through one turn.
    """

    vertices: ComplexArray
    triangles: IntArray
    sides: tuple[IntArray, ...]
    parameters: tuple[FloatArray, ...]


def mesh(loops: tuple[Loop, ...], largest: float, what: str, turns: int = 1) -> Mesh:
    """Triangles between loops, of which the first bounds the body.

    Parameters
    ----------
    loops : tuple of Loop
    largest : float
        Longest side, m.
    what : str
        Names the body in messages.
    turns : int
        How often a full turn about the origin carries the loops and their joints into themselves,
        and the mesh with them.

    Raises
    ------
    GeometryError
        Where material is too thin for triangles.
    """
    parameters, sizes = _spacing(loops, largest, what, turns)
    starts = np.cumsum([0] + [len(one) - 1 for one in parameters])
    edge = np.concatenate(
        [loop.curve(u[:-1])[0] for loop, u in zip(loops, parameters, strict=True)]
    )
    sides = tuple(
        np.stack([first + np.arange(count), first + (np.arange(count) + 1) % count], axis=1)
        for first, count in zip(starts[:-1], np.diff(starts), strict=True)
    )
    bounds = np.concatenate([s for s, loop in zip(sides, loops, strict=True) if not loop.inner])
    size = _Size(edge, np.concatenate(sizes), largest)
    vertices, triangles = _fill(edge, bounds, size, turns)
    _refuse_broken(vertices, triangles, np.concatenate(sides), bounds, what)
    return Mesh(vertices, triangles, sides, parameters)


def _spacing(
    loops: tuple[Loop, ...], largest: float, what: str, turns: int
) -> tuple[tuple[FloatArray, ...], list[FloatArray]]:
    """Parameters of the vertices on every loop, and the size wanted at each."""
    from scipy.spatial import cKDTree

    u = np.arange(_SAMPLES) / _SAMPLES
    points = [loop.curve(u)[0] for loop in loops]
    reach = float(np.abs(points[0]).max())
    wanted = []
    for index, (loop, own) in enumerate(zip(loops, points, strict=True)):
        slope = loop.curve(u)[1]
        length = np.abs(slope).mean()
        turn = np.abs(np.angle(np.roll(slope, -1) / slope)) * _SAMPLES
        # A kink is a joint, not a bend: it would ask for sides of no length.
        bend = np.where(turn < 0.05 * _SAMPLES, turn / np.abs(slope), 0.0)
        size = np.minimum(largest, 0.45 / np.maximum(bend, 0.45 / largest))
        size = np.minimum(size, length / 24.0)
        others = [p for other, p in enumerate(points) if other != index]
        if others:
            gap = cKDTree(_plane(np.concatenate(others))).query(_plane(own))[0]
            if gap.min() < _THINNEST * reach:
                raise GeometryError(
                    f"{what} has {1e3 * gap.min():.3g} mm of material at its thinnest place, "
                    "which is too thin for an elastic body; widen the ligament."
                )
            size = np.minimum(size, gap / _PER_LIGAMENT)
        wanted.append(size)
    everywhere = cKDTree(_plane(np.concatenate(points)))
    flat = np.concatenate(wanted)
    # The least of the neighbours' sizes, grown with distance: a few sweeps carry it all round.
    apart, near = everywhere.query(_plane(np.concatenate(points)), k=24)
    for _ in range(6):
        flat = np.minimum(flat, (flat[near] + _GRADING * apart).min(axis=1))
    parameters: list[FloatArray] = []
    sizes: list[FloatArray] = []
    for index, loop in enumerate(loops):
        same, times = _like(points, index, turns)
        if times:
            parameters.append(parameters[same] + times / turns)
            sizes.append(sizes[same])
            continue
        size = flat[index * _SAMPLES : (index + 1) * _SAMPLES]
        parts = turns if _central(points[index], reach) else 1
        placed = _placed(loop, size, parts)
        chord = np.abs(np.diff(loop.curve(placed)[0]))
        there = np.interp(placed[: len(chord) // parts], u, size, period=1.0)
        parameters.append(placed)
        sizes.append(np.minimum(np.tile(there, parts), np.maximum(chord, np.roll(chord, 1))))
    if sum(map(len, parameters)) > _MOST_VERTICES // 6:
        raise GeometryError(
            f"{what} has material too thin beside its size to be meshed; widen its thinnest "
            "ligament."
        )
    return tuple(parameters), sizes


def _central(points: ComplexArray, reach: float) -> bool:
    """Whether a loop goes round the origin: a hole beside it has its middle elsewhere."""
    return bool(abs(points.mean()) < 1e-3 * reach)


def _like(points: list[ComplexArray], index: int, turns: int) -> tuple[int, int]:
    """The first loop that a turn carries into this one, and how many such turns."""
    reach = float(np.abs(points[0]).max())
    if not _central(points[index], reach):
        back = points[index].mean() * np.exp(-2j * np.pi * np.arange(turns) / turns)
        for first in range(index):
            same = np.flatnonzero(np.abs(points[first].mean() - back) < 1e-3 * reach)
            if len(same):
                return first, int(same[0])
    return index, 0


def _placed(loop: Loop, size: FloatArray, parts: int) -> FloatArray:
    """Parameters at equal counts of the wanted size, with a vertex on every joint.

    The same on each of `parts` equal parts of the loop.
    """
    u = np.arange(_SAMPLES + 1) / _SAMPLES
    speed = np.abs(loop.curve(0.5 * (u[1:] + u[:-1]))[1])
    steps = speed / _SAMPLES / (0.5 * (size + np.roll(size, -1)))
    grown = np.concatenate([[0.0], np.cumsum(steps)])
    joints = np.array([0.0]) if loop.joints is None else loop.joints
    last = joints[0] + 1.0 / parts
    ends = np.append(joints[joints < last - 1e-9], last)
    twice = np.concatenate([grown, grown[1:] + grown[-1]])
    around = np.concatenate([u, u[1:] + 1.0])
    at = np.interp(ends, around, twice)
    placed = []
    for (begin, end), first in zip(pairwise(at), ends, strict=False):
        count = max(int(np.ceil(end - begin - 1e-6)), 1)
        inside = np.interp(begin + (end - begin) * np.arange(1, count) / count, twice, around)
        placed.append(np.concatenate([[first], inside]))
    part = np.concatenate(placed)
    whole = part + np.arange(parts)[:, None] / parts
    return np.append(whole, joints[0] + 1.0)


class _Size:
    """Side wanted at a point: that of the nearest edge, grown with distance."""

    def __init__(self, edge: ComplexArray, size: FloatArray, largest: float) -> None:
        from scipy.spatial import cKDTree

        self._tree, self._size, self._largest = cKDTree(_plane(edge)), size, largest

    def __call__(self, z: ComplexArray) -> tuple[FloatArray, FloatArray]:
        """Side, and distance to the nearest vertex on an edge."""
        apart, near = self._tree.query(_plane(z))
        return np.minimum(self._size[near] + _GRADING * apart, self._largest), apart


def _fill(
    edge: ComplexArray, bounds: IntArray, size: _Size, turns: int
) -> tuple[ComplexArray, IntArray]:
    """Vertices: the edge's, and centres of circumcircles that are too large, evened out.

    Those inside are found in the first sector and stand in all.
    """
    sectors = np.exp(2j * np.pi * np.arange(turns) / turns)[:, None]
    inner = np.empty(0, dtype=complex)
    vertices, triangles = edge, _inside(edge, edge, bounds, turns)
    for _ in range(40):
        centre, radius = _circumcircles(vertices[triangles])
        side, to_edge = size(centre)
        excess = radius / (0.62 * side)
        own = np.mod(np.angle(centre) - _FIRST, 2.0 * np.pi) < 2.0 * np.pi / turns
        large = np.flatnonzero((excess > 1.0) & (to_edge > 0.7 * side) & own)
        good = large[_within(centre[large], edge, bounds)]
        order = good[np.argsort(-excess[good], kind="stable")]
        taken = _apart(centre[order], 0.85 * side[order], sectors)
        if not len(taken) or len(vertices) > _MOST_VERTICES:
            break
        inner = np.concatenate([inner, taken])
        vertices = np.concatenate([edge, (sectors * inner).ravel()])
        triangles = _inside(vertices, edge, bounds, turns)
    first = slice(len(edge), len(edge) + len(inner))
    for _ in range(_EVENED):
        corner = vertices[triangles]
        middle = corner.mean(axis=0)
        area = _area(corner)
        about = triangles.ravel()
        weight, along, up = (
            np.bincount(about, np.tile(each, 3), len(vertices))
            for each in (area, area * middle.real, area * middle.imag)
        )
        total = along + 1j * up
        there = weight[first] > 0.0
        inner = np.where(there, total[first] / np.where(there, weight[first], 1.0), inner)
        vertices = np.concatenate([edge, (sectors * inner).ravel()])
        triangles = _inside(vertices, edge, bounds, turns)
    return np.asarray(vertices), triangles


def _apart(candidates: ComplexArray, distance: FloatArray, sectors: ComplexArray) -> ComplexArray:
    """Those candidates, in their order, that keep their distance from the ones taken before.

    And from those in the sectors beside their own.
    """
    from scipy.spatial import cKDTree

    if not len(candidates):
        return candidates
    tree, beside = cKDTree(_plane(candidates)), sectors[[0, 1 % len(sectors), -1], 0]
    near = [tree.query_ball_point(_plane(turn * candidates), distance) for turn in beside]
    taken = np.zeros(len(candidates), dtype=bool)
    barred = np.zeros(len(candidates), dtype=bool)
    for index in range(len(candidates)):
        if not barred[index]:
            taken[index] = True
            for one in near:
                barred[one[index]] = True
    return candidates[taken]


def _inside(vertices: ComplexArray, edge: ComplexArray, bounds: IntArray, turns: int) -> IntArray:
    """Delaunay triangles in the material, (3, K), counter-clockwise."""
    from scipy.spatial import Delaunay

    triangles = Delaunay(_plane(_aside(vertices, turns))).simplices.T.astype(np.int64)
    area = _area(vertices[triangles])
    triangles = np.where(area < 0.0, triangles[[0, 2, 1]], triangles)
    # A triangle with a vertex off the edges lies in the material, where alone such vertices are.
    kept = (triangles >= len(edge)).any(axis=0)
    doubtful = np.flatnonzero(~kept)
    kept[doubtful] = _within(vertices[triangles[:, doubtful]].mean(axis=0), edge, bounds)
    return np.ascontiguousarray(triangles[:, kept])


def _aside(vertices: ComplexArray, turns: int) -> ComplexArray:
    """Vertices a little out of place, in no order, but alike in all sectors.

    Four on a circle have two triangulations, of which rounding would choose in every sector anew.
    """
    size = np.abs(vertices)
    ray, reach = vertices / size, size.max()
    turned = ray**turns
    phase = 1e3 * (turned.real + 1.3 * turned.imag + 1.7 * size / reach)
    return np.asarray(vertices + _MOVED * reach * ray * np.exp(1j * phase))


def _within(z: ComplexArray, edge: ComplexArray, bounds: IntArray) -> NDArray[np.bool_]:
    """Whether points lie in the material, by the number of edges to their right."""
    begin, end = edge[bounds[:, 0]], edge[bounds[:, 1]]
    order = np.argsort(z.imag)
    height = z.imag[order]
    # Every edge with the points between its ends' heights: few of all pairs.
    first, last = (
        np.searchsorted(height, at(begin.imag, end.imag)) for at in (np.minimum, np.maximum)
    )
    count = last - first
    side = np.repeat(np.arange(len(begin)), count)
    point = np.arange(len(side)) + np.repeat(first - np.cumsum(count) + count, count)
    rise = (end - begin)[side]
    part = (height[point] - begin.imag[side]) / rise.imag
    hit = z.real[order[point]] < begin.real[side] + part * rise.real
    inside = np.empty(len(z), dtype=bool)
    inside[order] = np.bincount(point[hit], minlength=len(z)) % 2 == 1
    return inside


def _circumcircles(corner: ComplexArray) -> tuple[ComplexArray, FloatArray]:
    b, c = corner[1] - corner[0], corner[2] - corner[0]
    twice = 2.0 * (np.conj(b) * c).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        centre = 1j * (b * np.abs(c) ** 2 - c * np.abs(b) ** 2) / twice
    centre = np.where(np.isfinite(centre), centre, 0.0)
    return corner[0] + centre, np.abs(centre)


def _area(corner: ComplexArray) -> FloatArray:
    return np.asarray(0.5 * (np.conj(corner[1] - corner[0]) * (corner[2] - corner[0])).imag)


def _plane(z: ComplexArray) -> FloatArray:
    return np.stack([z.real, z.imag], axis=-1)


def _refuse_broken(
    vertices: ComplexArray, triangles: IntArray, sides: IntArray, bounds: IntArray, what: str
) -> None:
    """Raise where the triangles do not end on the loops, or are slivers."""
    corner = vertices[triangles]
    least = (
        min(
            float(
                np.abs(
                    np.angle((corner[(k + 1) % 3] - corner[k]) / (corner[(k + 2) % 3] - corner[k]))
                ).min()
            )
            for k in range(3)
        )
        if triangles.size
        else 0.0
    )
    number = np.array([len(vertices), 1])
    pairs = np.concatenate([triangles[[k, (k + 1) % 3]].T for k in range(3)])
    there, count = np.unique(np.sort(pairs, axis=1) @ number, return_counts=True)
    around, complete = (np.sort(one, axis=1) @ number for one in (bounds, sides))
    closed = np.array_equal(there[count == 1], np.sort(around)) and np.isin(complete, there).all()
    if least < _LEAST_ANGLE or not closed:
        raise GeometryError(
            f"{what} cannot be meshed as an elastic body: its thinnest material is too thin beside "
            "what is round it; widen the ligament between its edges."
        )
