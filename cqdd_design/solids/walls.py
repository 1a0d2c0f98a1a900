"""The thinnest walls between the holes of made parts, and from these to their rims."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.printing import printed_materials
from cqdd_design.geometry.contours import Circle, PlanarPart
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
    least : float or None
        That the part's plastic can have as it is printed or moulded, m; None of other materials.
    """

    part: str
    between: str
    thickness: float
    least: float | None


def least_walls(parts: Sequence[Part]) -> tuple[Wall, ...]:
    """The thinnest wall of every made part that has round holes, but for discs and ring."""
    rows = []
    for part in parts:
        if part.source != "make" or part.name.partition(" ")[0] in _CUT:
            continue
        every = [wall for layer in part.shape.layers for wall in _walls(layer.shape)]
        if every:
            thickness, between = min(every)
            plastic = printed_materials().get(part.material)
            least = None if plastic is None else plastic.least_wall
            rows.append(Wall(part.name, between, thickness, least))
    return tuple(rows)


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
