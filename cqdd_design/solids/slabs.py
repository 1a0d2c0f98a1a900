"""Parts between neighbouring heights, and what a line of sight across the axis meets in them.

Every layer of a stack is a prism, so between two heights at which anything begins or ends a part
looks the same all the way: a *slab*. A line of sight across the axis meets the walls of a slab in
closed form: every contour is cut into *branches*, each a function y(x) that is a straight line or
one side of a circle.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cqdd_design.geometry.contours import Circle, Contour, FloatArray
from cqdd_design.solids.layers import Layer, Stack

SAME = 1e-9
"""Places closer than this are one, m."""
AIR, CUT = (), (0,)
"""Keys of sights that meet nothing, and that begin inside material."""
Key = tuple[float, ...]
"""Of a wall: equal where a wall of one layer continues in another."""


@dataclass(frozen=True, eq=False)
class Slab:
    """Contours of all material between two heights, m; inside an odd number of them is material."""

    bottom: float
    top: float
    contours: tuple[Contour, ...]


def slabs(layers: Iterable[Layer]) -> tuple[Slab, ...]:
    """Slabs of layers that touch but do not overlap, upward; those of no material are left out."""
    given = list(layers)
    heights = _apart(height for layer in given for height in (layer.bottom, layer.top))
    found = []
    for bottom, top in pairwise(heights):
        middle = 0.5 * (bottom + top)
        inside = [layer.shape for layer in given if layer.bottom < middle < layer.top]
        contours = tuple(c for shape in inside for c in (shape.outer, *shape.holes))
        if contours:
            found.append(Slab(bottom, top, contours))
    return tuple(found)


def _apart(values: Iterable[float]) -> list[float]:
    kept: list[float] = []
    for value in sorted(values):
        if not kept or value - kept[-1] > SAME:
            kept.append(value)
    return kept


@dataclass(frozen=True, eq=False)
class Walls:
    """Branches of the contours of a slab, all turned by the same angle; lengths in m.

    Attributes
    ----------
    begin, end : array (k,)
        Between which x a branch runs.
    curves : array (k, 5)
        Of a branch ``y = a + b x + s sqrt(r^2 - (x - c)^2)``: a, b, c, r, s; s is 0 of a line.
    """

    begin: FloatArray
    end: FloatArray
    curves: FloatArray

    @classmethod
    def of(cls, contours: Iterable[Contour], turned: float = 0.0) -> Walls:
        """Branches of contours that are first turned by an angle (rad)."""
        rows = [row for contour in contours for row in _branches(contour.transformed(turned))]
        table = np.array(rows, dtype=float).reshape(-1, 7)
        return cls(table[:, 0], table[:, 1], table[:, 2:])

    def breaks(self) -> FloatArray:
        """Every x between which the order of the walls, and what y = 0 meets, stay the same."""
        found = [self.begin, self.end, self._zeros()]
        return np.unique(np.round(np.concatenate(found), 10))

    def _zeros(self) -> FloatArray:
        """Where branches cross y = 0."""
        a, b, c, r, s = self.curves.T
        with np.errstate(divide="ignore", invalid="ignore"):
            straight = np.where(b != 0.0, -a / b, np.nan)
            half = np.sqrt(r * r - a * a)
        places = np.stack(
            [np.where(s == 0.0, straight, c - half), np.where(s == 0.0, np.nan, c + half)]
        )
        with np.errstate(invalid="ignore"):
            inside = (places > self.begin) & (places < self.end)
        return np.asarray(places[inside])

    def at(self, x: float) -> list[tuple[float, int]]:
        """Heights y of the walls at a place between breaks, falling, with their branches."""
        mask = np.nonzero((self.begin < x) & (x < self.end))[0]
        a, b, c, r, s = self.curves[mask].T
        y = a + b * x + s * np.sqrt(np.maximum(r * r - (x - c) ** 2, 0.0))
        order = np.argsort(-y, kind="stable")
        return [(float(y[i]), int(mask[i])) for i in order]

    def key(self, branch: int) -> Key:
        """The same for branches of one circle or line."""
        return tuple(float(v) for v in np.round(self.curves[branch], 8) + 0.0)

    def sight(self, x: float) -> tuple[Key, float]:
        """The wall that is met from y = 0 downward, and its y; `CUT` where that is in material."""
        walls = self.at(x)
        spans: list[list[tuple[float, int]]] = []
        for upper, lower in zip(walls[::2], walls[1::2], strict=False):
            if spans and spans[-1][1][0] - upper[0] < SAME:
                spans[-1][1] = lower
            elif upper[0] - lower[0] > SAME:
                spans.append([upper, lower])
        for (high, branch), (low, _) in spans:
            if low < 0.0 < high:
                return CUT, 0.0
            if high <= 0.0:
                return self.key(branch), high
        return AIR, -math.inf


def _branches(contour: Contour) -> list[list[float]]:
    if isinstance(contour, Circle):
        (x, y), r = contour.centre, contour.radius
        return [[x - r, x + r, y, 0.0, x, r, side] for side in (1.0, -1.0)]
    rows: list[list[float]] = []
    arcs = contour.arcs()
    ends = np.roll(contour.points, -1, axis=0)
    for i, (start, end) in enumerate(zip(contour.points.tolist(), ends.tolist(), strict=True)):
        sweep = float(arcs.sweeps[i])
        if sweep == 0.0:
            (x0, y0), (x1, y1) = sorted((start, end))
            if x1 - x0 > SAME:
                slope = (y1 - y0) / (x1 - x0)
                rows.append([x0, x1, y0 - slope * x0, slope, 0.0, 0.0, 0.0])
            continue
        (cx, cy), r = arcs.centres[i].tolist(), float(arcs.radii[i])
        first = float(arcs.start_angles[i])
        low, high = sorted((first, first + sweep))
        turns = range(math.ceil(low / math.pi - 1e-9), math.floor(high / math.pi + 1e-9) + 1)
        inner = [n * math.pi for n in turns if low + 1e-9 < n * math.pi < high - 1e-9]
        for one, two in pairwise([low, *inner, high]):
            x0, x1 = sorted((cx + r * math.cos(one), cx + r * math.cos(two)))
            side = 1.0 if math.sin(0.5 * (one + two)) > 0.0 else -1.0
            rows.append([x0, x1, cy, 0.0, cx, r, side])
    return rows


def spans_along(contours: Sequence[Contour], direction: float) -> list[tuple[float, float]]:
    """Radii between which a ray from the axis in a direction (rad) runs in material, m."""
    walls = Walls.of(contours, 0.5 * math.pi - direction)
    # A hair beside the ray: what only touches it is not cut.
    high = [y for y, _ in walls.at(1e-12) if y > SAME]
    ends = sorted(high)
    if len(ends) % 2:
        ends = [0.0, *ends]
    joined: list[tuple[float, float]] = []
    for low, top in zip(ends[::2], ends[1::2], strict=True):
        if joined and low - joined[-1][1] < SAME:
            joined[-1] = (joined[-1][0], top)
        elif top - low > SAME:
            joined.append((low, top))
    return joined


def stack_slabs(stack: Stack) -> tuple[Slab, ...]:
    """Slabs of one part."""
    return slabs(stack.layers)
