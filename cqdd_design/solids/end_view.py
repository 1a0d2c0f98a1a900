"""A part seen along its axis: which edges nothing hides, in closed form.

At a point of the page the highest material under it is seen. An edge of a layer is seen where that
height jumps across it, and hidden or no edge at all where it does not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cqdd_design.geometry.contours import (
    Circle,
    ComplexArray,
    Contour,
    FloatArray,
    PlanarPart,
    as_complex,
)
from cqdd_design.solids.layers import Layer
from cqdd_design.solids.slabs import Walls

_BESIDE = 2e-6
"""How far from an edge heights are looked at, m."""
_STEPS, _HALVINGS = 90, 20
"""Places along a full turn at which an edge is looked at; halvings between two that differ."""


@dataclass(frozen=True)
class Arc:
    """A piece of an edge, m: from `start` it turns by `sweep` about `centre`; no sweep is a line.

    Attributes
    ----------
    sweep : float
        rad; a full turn is a circle.
    """

    centre: complex
    start: complex
    sweep: float
    end: complex

    @property
    def radius(self) -> float:
        """In m."""
        return abs(self.start - self.centre)

    def at(self, share: FloatArray) -> ComplexArray:
        """Points at shares of its length."""
        if self.sweep == 0.0:
            return np.asarray(self.start + share * (self.end - self.start))
        return np.asarray(
            self.centre + (self.start - self.centre) * np.exp(1j * self.sweep * share)
        )

    def across(self, share: FloatArray) -> ComplexArray:
        """Unit normals there."""
        if self.sweep == 0.0:
            along = (self.end - self.start) / abs(self.end - self.start)
            return np.full(len(share), 1j * along)
        return np.asarray((self.at(share) - self.centre) / self.radius)

    def piece(self, low: float, high: float) -> Arc:
        """Between two shares of its length."""
        one, two = (complex(p) for p in self.at(np.array([low, high])))
        return Arc(self.centre, one, self.sweep * (high - low), two)


def visible_edges(layers: Iterable[Layer], *, from_above: bool) -> tuple[Arc, ...]:
    """Edges that are seen along the axis, in the part's frame.

    Parameters
    ----------
    layers : iterable of Layer
        Touching, never overlapping.
    from_above : bool
        Whether the viewer is at +z.
    """
    given = list(layers)
    scene = _Scene(given, from_above)
    arcs: dict[tuple[float, ...], Arc] = {}
    for layer in given:
        for contour in (layer.shape.outer, *layer.shape.holes):
            for arc in _arcs(contour):
                ends = sorted(((arc.start.real, arc.start.imag), (arc.end.real, arc.end.imag)))
                middle = complex(arc.at(np.array([0.5]))[0])
                if arc.centre == arc.centre and abs(arc.sweep) > 6.28:
                    ends, middle = [], complex(arc.centre) + arc.radius
                flat = [v for end in ends for v in end]
                key = tuple(round(v, 9) + 0.0 for v in (*flat, middle.real, middle.imag))
                arcs.setdefault(key, arc)
    return tuple(piece for arc in arcs.values() for piece in scene.seen(arc))


def _arcs(contour: Contour) -> list[Arc]:
    if isinstance(contour, Circle):
        centre = complex(*contour.centre)
        start = centre + contour.radius
        return [Arc(centre, start, 2.0 * math.pi, start)]
    arcs = contour.arcs()
    starts = as_complex(contour.points)
    ends = np.roll(starts, -1)
    centres = as_complex(np.nan_to_num(arcs.centres))
    return [
        Arc(complex(c), complex(s), float(w), complex(e))
        for c, s, w, e in zip(centres, starts, arcs.sweeps, ends, strict=True)
    ]


class _Scene:
    """Layers seen from one end."""

    def __init__(self, layers: list[Layer], from_above: bool) -> None:
        def face(layer: Layer) -> float:
            return layer.top if from_above else -layer.bottom

        ordered = sorted(layers, key=face)
        self._layers = [(face(layer), _Inside(layer.shape)) for layer in ordered]

    def height(self, points: ComplexArray) -> FloatArray:
        """Of what is seen at points, m; minus infinity of nothing."""
        found = np.full(len(points), -math.inf)
        for face, inside in self._layers:
            found[inside(points)] = face
        return found

    def shown(self, arc: Arc, share: FloatArray) -> np.ndarray:
        """Whether an edge is seen at shares of its length."""
        points, beside = arc.at(share), _BESIDE * arc.across(share)
        return np.asarray(self.height(points + beside) != self.height(points - beside))

    def seen(self, arc: Arc) -> list[Arc]:
        """The pieces of an edge that are seen."""
        length = abs(arc.sweep) / (2.0 * math.pi) if arc.sweep else 0.1
        count = max(4, math.ceil(_STEPS * length))
        shares = (np.arange(count) + 0.5) / count
        shown = self.shown(arc, shares)
        if shown.all():
            return [arc]
        last = np.nonzero(shown[1:] != shown[:-1])[0]
        changes = self._changes(arc, shares[last], shares[last + 1])
        ends = [0.0, *changes.tolist(), 1.0]
        first = bool(shown[0])
        return [
            arc.piece(low, high)
            for place, (low, high) in enumerate(pairwise(ends))
            if first == (place % 2 == 0)
        ]

    def _changes(self, arc: Arc, low: FloatArray, high: FloatArray) -> FloatArray:
        """Shares between pairs of which the edge appears or disappears."""
        before = self.shown(arc, low)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            same = self.shown(arc, middle) == before
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.asarray(0.5 * (low + high))


class _Inside:
    """Whether points are in the material of a flat shape."""

    def __init__(self, shape: PlanarPart) -> None:
        contours = (shape.outer, *shape.holes)
        self._round = [c for c in contours if isinstance(c, Circle)]
        self._walls = Walls.of([c for c in contours if not isinstance(c, Circle)])

    def __call__(self, points: ComplexArray) -> np.ndarray:
        odd = np.zeros(len(points), dtype=bool)
        for circle in self._round:
            odd ^= np.abs(points - complex(*circle.centre)) < circle.radius
        walls = self._walls
        if len(walls.begin):
            x, y = points.real[:, None], points.imag[:, None]
            a, b, c, r, s = walls.curves.T
            within = (walls.begin < x) & (x <= walls.end)
            over = a + b * x + s * np.sqrt(np.maximum(r * r - (x - c) ** 2, 0.0)) > y
            odd ^= (within & over).sum(axis=1) % 2 == 1
        return odd
