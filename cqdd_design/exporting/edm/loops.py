"""Closed loops of lines and arcs as a reader of the file sees them, measured against exact curves.

Nothing here is shared with the writer: bulges become arcs by the definition of the DXF reference,
and areas come from chords and circular segments::

        ..--``--..          b = tan(sweep / 4)
      .'    |s    '.        sagitta s = b c / 2
     A------+-------B       radius    = c (1 + b^2) / (4 |b|)
            c

Deviations are taken both ways, from the file to the curve and from the curve to the file, so a
missing stretch is found as well as a stray one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_ARC = 24
_PER_STRETCH = 96
_STEPS = 5


@dataclass(frozen=True, eq=False)
class Loop:
    """A closed loop of lines and arcs as read from a file.

    Attributes
    ----------
    start, end : complex arrays (k,)
        Ends of every segment, m.
    bulge : array (k,)
        As in the file.
    """

    start: ComplexArray
    end: ComplexArray
    bulge: FloatArray

    def backward(self) -> Loop:
        """The other way round."""
        return Loop(self.end[::-1], self.start[::-1], -self.bulge[::-1])

    def part(self, chosen: slice) -> Loop:
        """Some of its segments, one after the other; not closed."""
        return Loop(self.start[chosen], self.end[chosen], self.bulge[chosen])

    @property
    def sweep(self) -> FloatArray:
        """Signed sweep of every segment (k,), rad."""
        return 4.0 * np.arctan(self.bulge)

    @property
    def radius(self) -> FloatArray:
        """Radius of every segment (k,), m; infinite for lines."""
        chord = np.abs(self.end - self.start)
        with np.errstate(divide="ignore"):
            return np.asarray(chord * (1.0 + self.bulge**2) / (4.0 * np.abs(self.bulge)))

    @property
    def centre(self) -> ComplexArray:
        """Centre of every arc (k,), m; not finite for lines."""
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = (1.0 - self.bulge**2) / (4.0 * self.bulge)
            return np.asarray(0.5 * (self.start + self.end) + 1j * (self.end - self.start) * offset)

    @property
    def lengths(self) -> FloatArray:
        """Length of every segment (k,), m."""
        chord = np.abs(self.end - self.start)
        bent = self.bulge != 0.0
        return np.where(bent, np.where(bent, self.radius, 0.0) * np.abs(self.sweep), chord)

    @property
    def perimeter(self) -> float:
        """Length, m."""
        return float(self.lengths.sum())

    @property
    def area(self) -> float:
        """Signed area, m^2: the polygon of chords plus the circular segments on them."""
        chords = 0.5 * float(np.sum((np.conj(self.start) * self.end).imag))
        bent = self.bulge != 0.0
        radius = np.where(bent, self.radius, 0.0)
        return chords + 0.5 * float(np.sum(radius**2 * (self.sweep - np.sin(self.sweep))))

    @property
    def tangent_breaks(self) -> FloatArray:
        """Change of direction at every joint (k,), rad, largest first."""
        along = (self.end - self.start) / np.abs(self.end - self.start)
        leaving = along * np.exp(-0.5j * self.sweep)
        arriving = np.roll(along * np.exp(0.5j * self.sweep), 1)
        return np.sort(np.abs(np.angle(leaving / arriving)))[::-1]

    def least_radius(self, *, left_turning: bool) -> float:
        """Least radius of the arcs that turn left (or right) along the loop, m."""
        chosen = self.bulge > 0.0 if left_turning else self.bulge < 0.0
        return float(self.radius[chosen].min()) if chosen.any() else math.inf

    def sampled(self) -> tuple[ComplexArray, FloatArray]:
        """Points (k, m) on every segment, and their share of the perimeter (k, m)."""
        fraction = np.linspace(0.0, 1.0, _PER_ARC, endpoint=False)
        chord = (self.end - self.start)[:, None]
        straight = self.start[:, None] + chord * fraction
        bent = self.bulge != 0.0
        centre = np.where(bent, self.centre, 0.0)[:, None]
        turned = centre + (self.start[:, None] - centre) * np.exp(
            1j * self.sweep[:, None] * fraction
        )
        weight = np.repeat(self.lengths[:, None], _PER_ARC, axis=1) / (_PER_ARC * self.perimeter)
        return np.where(bent[:, None], turned, straight), weight

    def distances(self, points: ComplexArray, segments: NDArray[np.int64]) -> FloatArray:
        """Distance of each point (m,) to the segment (m,) named beside it, m."""
        start, end = self.start[segments], self.end[segments]
        bent = self.bulge[segments] != 0.0
        centre = np.where(bent, self.centre[segments], 0.0)
        radius = np.where(bent, self.radius[segments], 0.0)
        sweep = self.sweep[segments]
        turned = np.angle((points - centre) / (start - centre)) * np.sign(sweep)
        on_arc = np.mod(turned, 2.0 * math.pi) <= np.abs(sweep)
        local = (points - start) / (end - start)
        on_line = (local.real >= 0.0) & (local.real <= 1.0)
        to_ends = np.minimum(np.abs(points - start), np.abs(points - end))
        beside = np.where(
            bent, np.abs(np.abs(points - centre) - radius), np.abs(local.imag * (end - start))
        )
        return np.where(np.where(bent, on_arc, on_line), beside, to_ends)

    def clearance(self, point: complex) -> float:
        """Distance from `point` to the loop, m; negative inside."""
        every = np.arange(len(self.bulge))
        distance = float(self.distances(np.full(len(every), point), every).min())
        seen = self.sampled()[0].ravel() - point
        turns = np.angle(np.roll(seen, -1) / seen).sum() / (2.0 * math.pi)
        return -distance if abs(turns) > 0.5 else distance


@dataclass(frozen=True, eq=False)
class ExactCurve:
    """A closed counter-clockwise curve over a parameter from 0 to 2 pi.

    Attributes
    ----------
    point, tangent : callable
        Points (m) and unit tangents as complex arrays over an array of parameters (rad).
    breaks : array (b,)
        Ascending parameters from 0 to 2 pi between which the curve is smooth.
    corners : int
        Places where its direction jumps.
    perimeter, area : float
        Exact, m and m^2.
    """

    point: Callable[[FloatArray], ComplexArray]
    tangent: Callable[[FloatArray], ComplexArray]
    breaks: FloatArray
    corners: int
    perimeter: float
    area: float


@dataclass(frozen=True)
class LoopFit:
    """How a loop of arcs agrees with its exact curve.

    Attributes
    ----------
    segments : int
        Arcs and lines in the loop.
    largest_deviation, rms_deviation : float
        Distance between loop and curve, m; the largest of both directions, and the root mean
        square along the loop.
    perimeter, area : float
        Of the loop, m and m^2.
    perimeter_error, area_error : float
        Loop less exact, m and m^2.
    tangent_break : float
        Largest change of direction at a joint where the exact curve has no corner, rad.
    least_concave_radius : float
        Least radius the wire must follow from the inside of a corner, m; infinite if none.
    """

    segments: int
    largest_deviation: float
    rms_deviation: float
    perimeter: float
    area: float
    perimeter_error: float
    area_error: float
    tangent_break: float
    least_concave_radius: float


def fit_of(loop: Loop, exact: ExactCurve, *, outer: bool) -> LoopFit:
    """Measure a loop against the exact curve.

    Parameters
    ----------
    loop : Loop
        Counter-clockwise.
    exact : ExactCurve
        What it stands for.
    outer : bool
        Whether material lies inside (an outer cut) or outside (an inner cut).
    """
    ruler = _Ruler.of(exact)
    # Both run once round, so equal shares of the perimeter are nearly the same place, once the
    # place of the loop's first joint on the curve is known.
    first = ruler.foot(loop.start[:1], ruler.nearest_mark(loop.start[0]))[0]
    samples, weight = loop.sampled()
    before = np.cumsum(loop.lengths) - loop.lengths
    along = before[:, None] + loop.lengths[:, None] * np.arange(_PER_ARC) / _PER_ARC
    points = samples.ravel()
    guess = first + along.ravel() / loop.perimeter * ruler.total
    to_curve = np.abs(points - ruler.point(ruler.foot(points, guess)))

    checked = np.linspace(0.0, ruler.total, len(points), endpoint=False)
    wanted = ruler.point(checked)
    ends = np.cumsum(loop.lengths) / loop.perimeter * ruler.total
    segment = np.searchsorted(ends, np.mod(checked - first, ruler.total))
    to_file = np.minimum.reduce(
        [loop.distances(wanted, (segment + beside) % len(ends)) for beside in (-1, 0, 1)]
    )

    return LoopFit(
        segments=len(loop.bulge),
        largest_deviation=float(max(to_curve.max(), to_file.max())),
        rms_deviation=float(np.sqrt(np.sum(weight.ravel() * to_curve**2))),
        perimeter=loop.perimeter,
        area=loop.area,
        perimeter_error=loop.perimeter - exact.perimeter,
        area_error=loop.area - exact.area,
        tangent_break=float(loop.tangent_breaks[exact.corners :].max(initial=0.0)),
        least_concave_radius=loop.least_radius(left_turning=not outer),
    )


@dataclass(frozen=True, eq=False)
class _Ruler:
    """Arc length along an exact curve, tabulated: places are lengths from its start, m."""

    exact: ExactCurve
    parameters: FloatArray
    marks: FloatArray
    coarse: ComplexArray

    @classmethod
    def of(cls, exact: ExactCurve) -> _Ruler:
        # Every break is a mark, so that the length is a smooth function between two marks.
        fractions = np.linspace(0.0, 1.0, _PER_STRETCH, endpoint=False)
        stretches = np.diff(exact.breaks)
        inner = exact.breaks[:-1, None] + stretches[:, None] * fractions
        parameters = np.append(inner.ravel(), exact.breaks[-1])
        coarse = exact.point(parameters)
        marks = np.append(0.0, np.cumsum(np.abs(np.diff(coarse))))
        return cls(exact, parameters, marks, coarse)

    @property
    def total(self) -> float:
        return float(self.marks[-1])

    def parameter(self, place: FloatArray) -> FloatArray:
        """Parameters of places any whole number of turns away."""
        return np.interp(np.mod(place, self.total), self.marks, self.parameters)

    def point(self, place: FloatArray) -> ComplexArray:
        return self.exact.point(self.parameter(place))

    def nearest_mark(self, point: complex) -> FloatArray:
        return self.marks[[np.abs(self.coarse - point).argmin()]]

    def foot(self, points: ComplexArray, place: FloatArray) -> FloatArray:
        """Places of the feet of the perpendiculars; an error here only adds distance."""
        for _ in range(_STEPS):
            at = self.parameter(place)
            ahead = points - self.exact.point(at)
            place = place + (ahead * np.conj(self.exact.tangent(at))).real
        return place
