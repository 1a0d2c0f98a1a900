"""Bodies of revolution that are cut away from a part: chamfers, undercuts, grooves, drill points.

Of the outline in the half plane (r, z), counter-clockwise, Green's theorem gives the integrals that
a turned body needs (Pappus, and the moments of its rings)::

    S_ab = integral of r^a z^b dA = contour integral of r^(a+1) z^b / (a+1) dz
    V = 2 pi S_10      z_c = S_11/S_10      I_zz = 2 pi S_30      I_xx = pi S_30 + 2 pi S_12

Integrands are polynomials along lines, and trigonometric ones along arcs: Gauss points integrate
the first exactly and the second to rounding.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from cqdd_design.geometry.contours import gauss_rule
from cqdd_design.results import MassProperties
from cqdd_design.solids.features.holes import Centre
from cqdd_design.solids.features.kinds import ON_AXIS

Point: TypeAlias = tuple[float, float]

_LINE_POINTS, _ARC_POINTS = 3, 14
_CHORD = math.radians(24.0)


@dataclass(frozen=True)
class Revolved:
    """Equal bodies of revolution, each about its own axis parallel to the part's.

    Attributes
    ----------
    outline : tuple of (float, float)
        Corners (r, z), counter-clockwise, m.
    centres : tuple of (float, float)
        Axes, m.
    bulges : tuple of float
        Of the segments from corner to corner, as of `ArcContour`; empty where all are straight.
    """

    outline: tuple[Point, ...]
    centres: tuple[Centre, ...] = (ON_AXIS,)
    bulges: tuple[float, ...] = ()

    @cached_property
    def sections(self) -> tuple[float, float, float, float]:
        """S_10, S_11, S_12 and S_30, m^3 to m^5."""
        return _sections(self.outline, self.bulges)

    @property
    def volume(self) -> float:
        """Of all of them, m^3."""
        return 2.0 * math.pi * self.sections[0] * len(self.centres)

    @property
    def chorded(self) -> Revolved:
        """The same with chords for arcs, for meshes: kernels make thousands of facets a torus."""
        if not any(self.bulges):
            return self
        corners: list[Point] = []
        ends = pairwise((*self.outline, self.outline[0]))
        for (start, end), bulge in zip(ends, self.bulges, strict=True):
            corners.append(start)
            if bulge:
                corners += _chords(complex(*start), complex(*end), bulge)
        return Revolved(tuple(corners), self.centres)

    def mass_properties(self, density: float) -> MassProperties:
        """Exact mass, centre of mass and inertia of all at `density` (kg/m^3)."""
        s10, s11, s12, s30 = self.sections
        mass, height = 2.0 * math.pi * density * s10, s11 / s10
        around = math.pi * density * s30
        across = around + 2.0 * math.pi * density * (s12 - s10 * height * height)
        own = np.diag([across, across, 2.0 * around])
        at = np.array(self.centres)
        x, y = at.mean(axis=0)
        off = at - (x, y)
        xx, yy = (off * off).sum(axis=0)
        xy = float((off[:, 0] * off[:, 1]).sum())
        count = len(at)
        spread = mass * np.array([[yy, -xy, 0.0], [-xy, xx, 0.0], [0.0, 0.0, xx + yy]])
        return MassProperties(count * mass, np.array([x, y, height]), count * own + spread)


@lru_cache(maxsize=4096)
def _sections(
    outline: tuple[Point, ...], bulges: tuple[float, ...]
) -> tuple[float, float, float, float]:
    s10 = s11 = s12 = s30 = 0.0
    for r, z, dz in _samples(outline, bulges):
        ring = 0.5 * r * r * dz
        s10 += ring
        s11 += ring * z
        s12 += ring * z * z
        s30 += 0.25 * r**4 * dz
    return s10, s11, s12, s30


def _samples(
    outline: tuple[Point, ...], bulges: tuple[float, ...]
) -> Iterator[tuple[float, float, float]]:
    """Points of the contour with the weighted dz of each."""
    ends = pairwise((*outline, outline[0]))
    for (start, end), bulge in zip(ends, bulges or (0.0,) * len(outline), strict=True):
        if bulge == 0.0:
            dr, dz = end[0] - start[0], end[1] - start[1]
            for t, w in _rule(_LINE_POINTS):
                yield start[0] + t * dr, start[1] + t * dz, w * dz
        else:
            yield from _arc(complex(*start), complex(*end), bulge)


def _arc(start: complex, end: complex, bulge: float) -> Iterator[tuple[float, float, float]]:
    centre, sweep = _circle(start, end, bulge)
    for t, w in _rule(_ARC_POINTS):
        turned = (start - centre) * cmath.rect(1.0, t * sweep)
        at = centre + turned
        yield at.real, at.imag, w * sweep * turned.real


def _chords(start: complex, end: complex, bulge: float) -> Iterator[Point]:
    """Corners between the ends of an arc, off it by as much as keeps the area of its sector."""
    centre, sweep = _circle(start, end, bulge)
    count = max(2, math.ceil(abs(sweep) / _CHORD))
    # Triangles of the centre with chords: two of sides 1 and k, the others of k and k.
    whole, others = abs(sweep) / math.sin(abs(sweep) / count), count - 2
    out = (math.sqrt(1.0 + others * whole) - 1.0) / others if others else 0.5 * whole
    for i in range(1, count):
        at = centre + (start - centre) * cmath.rect(out, sweep * i / count)
        yield at.real, at.imag


def _circle(start: complex, end: complex, bulge: float) -> tuple[complex, float]:
    """Centre and sweep (rad) of an arc."""
    sweep = 4.0 * math.atan(bulge)
    # From the middle of the chord to the centre: half the chord, turned, over tan(sweep/2).
    return 0.5 * (start + end) + 0.5j * (end - start) / math.tan(0.5 * sweep), sweep


@lru_cache(maxsize=4)
def _rule(count: int) -> tuple[tuple[float, float], ...]:
    nodes, weights = gauss_rule(count)
    return tuple(zip(nodes.tolist(), weights.tolist(), strict=True))
