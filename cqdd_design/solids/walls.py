"""The thinnest walls between the holes of made parts, and from these to their rims."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import Circle, FloatArray, PlanarPart
from cqdd_design.solids.features.removal import threads
from cqdd_design.solids.layers import Drilling, Layer
from cqdd_design.solids.part import Part

_CUT = ("disc", "ring")
"""Parts that checks of their own look at."""


@dataclass(frozen=True)
class Wall:
    """The thinnest wall of a part.

    Attributes
    ----------
    part, between : str
        Name of the part; what the wall is between, in words.
    thickness : float
        m; negative where one cuts into the other.
    """

    part: str
    between: str
    thickness: float


def least_walls(parts: Sequence[Part]) -> tuple[Wall, ...]:
    """The thinnest wall of every made part that has round holes, but for discs and ring."""
    rows = []
    for part in parts:
        if part.source != "make" or part.name.partition(" ")[0] in _CUT:
            continue
        cut = threads(part.features)
        every = [wall for layer in part.shape.layers for wall in _walls(_threaded(layer, cut))]
        if every:
            thickness, between = min(every)
            rows.append(Wall(part.name, between, thickness))
    return tuple(rows)


def _threaded(layer: Layer, cut: Sequence[Drilling]) -> PlanarPart:
    """A layer with its tapped holes as wide as their threads."""
    middle, shape = 0.5 * (layer.bottom + layer.top), layer.shape
    wide = {
        _place(centre): thread.radius
        for thread in cut
        if thread.bottom < middle < thread.top
        for centre in thread.centres
    }
    if not wide:
        return shape
    holes = tuple(
        Circle(hole.centre, max(hole.radius, wide.get(_place(hole.centre), 0.0)))
        if isinstance(hole, Circle)
        else hole
        for hole in shape.holes
    )
    return PlanarPart(shape.name, shape.outer, holes)


def _place(centre: FloatArray) -> tuple[float, float]:
    return round(float(centre[0]), 9), round(float(centre[1]), 9)


def _walls(shape: PlanarPart) -> Iterator[tuple[float, str]]:
    holes = [hole for hole in shape.holes if isinstance(hole, Circle)]
    outer = shape.outer
    for hole in holes:
        if isinstance(outer, Circle):
            beside = float(np.hypot(*(hole.centre - outer.centre)))
            yield outer.radius - beside - hole.radius, f"{_size(hole)} and the rim {_size(outer)}"
    for one, other in itertools.combinations(holes, 2):
        apart = float(np.hypot(*(one.centre - other.centre)))
        yield apart - one.radius - other.radius, f"{_size(one)} and {_size(other)}"


def _size(circle: Circle) -> str:
    return f"{2e3 * circle.radius:.4g} mm"
