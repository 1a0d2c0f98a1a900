"""In which half planes the section of a made part is laid."""

from __future__ import annotations

import cmath
import math
from itertools import combinations
from typing import TYPE_CHECKING

from cqdd_design.exporting.edm.wire_path import segmented
from cqdd_design.exporting.sheets.end_plan import drilled_size
from cqdd_design.solids.axial_view import cut_rectangles
from cqdd_design.solids.slabs import stack_slabs

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.part_facts import PartFacts
    from cqdd_design.solids.layers import Stack


def section_directions(facts: PartFacts) -> tuple[float, float]:
    """Directions of the two halves of the section, rad: through as many kinds of holes as can be.

    One that cuts holes beside their axes, where they are narrower and their points flat, gives way
    to another; then a straight plane is preferred to a bent one, and one through +x to another.
    """
    circles = [group[0].circle for group in facts.holes]
    tried = sorted({round(math.remainder(a, 2.0 * math.pi), 9) for c in circles for a in c.angles})
    if not tried:
        return _through(facts.part.shape)

    def cut_by(direction: float) -> frozenset[int]:
        return frozenset(
            i
            for i, circle in enumerate(circles)
            if any(abs(math.remainder(a - direction, 2.0 * math.pi)) < 1e-6 for a in circle.angles)
        )

    def grazed_by(direction: float) -> int:
        sizes = [max(drilled_size(hole) for hole in group) for group in facts.holes]
        beside = [
            cmath.rect(circle.radius, a - direction)
            for circle, size in zip(circles, sizes, strict=True)
            for a in circle.angles
            if 1e-6 < circle.radius * abs(math.sin(a - direction)) < 0.5 * size
        ]
        return sum(place.real > 0.0 for place in beside)

    found = {direction: cut_by(direction) for direction in tried}
    grazed = {end: grazed_by(end) for one in tried for end in (one, one + math.pi)}
    pairs = [(one, one + math.pi) for one in tried]
    pairs += [
        pair
        for one, two in combinations(tried, 2)
        for pair in ((one, two), (two, one))
        if abs(math.remainder(two - one, 2.0 * math.pi)) > math.radians(60.0)
    ]

    def rank(pair: tuple[float, float]) -> tuple[float, ...]:
        other = math.remainder(pair[1], 2.0 * math.pi)
        near = next((found[d] for d in tried if abs(d - other) < 1e-6), cut_by(pair[1]))
        seen = len(found[pair[0]] | near)
        bend = abs(abs(math.remainder(pair[1] - pair[0], 2.0 * math.pi)) - math.pi)
        across = grazed[pair[0]] + grazed[pair[1]]
        return (-seen, across, round(bend, 6), round(abs(pair[0]), 6), pair[0], pair[1])

    return min(pairs, key=rank)


def _through(shape: Stack) -> tuple[float, float]:
    """Directions of a plane through +x, or through the middle of what stands beside that."""
    slabs = stack_slabs(shape)
    if cut_rectangles(slabs, 0.0) or cut_rectangles(slabs, math.pi):
        return 0.0, math.pi
    x, y = segmented(shape.layers[0].shape.outer).points.mean(axis=0)
    middle = math.atan2(y, x)
    return middle, middle + math.pi
