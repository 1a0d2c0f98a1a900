"""Tangent-continuous arcs through a smooth curve, with a bound on how far they leave it.

A *biarc* joins two points with given tangents by two arcs that share a tangent at their joint.
Spans are grown until the bound is used up, so there are few of them, and the arcs meet each other
exactly tangent wherever the curve's own tangents are exact.

Source: K. M. Bolton, "Biarc curves", Computer-Aided Design 7 (1975) 89-92.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import ArcContour, ComplexArray, FloatArray, as_points

# Below this, rounding of the coordinates themselves is no longer small beside the tolerance.
SMALLEST_TOLERANCE = 1e-9
_SAMPLES = 32
_UNIT = np.linspace(0.0, 1.0, _SAMPLES + 1)
# Curvatures this close, relatively, are one arc; it costs less than 1e-7 rad of tangency.
_SAME_BEND = 1e-8
# A span is long enough once it uses this share of the tolerance.
_ENOUGH = 0.97

PlaneCurve = Callable[[FloatArray], ComplexArray]


@dataclass(frozen=True, eq=False)
class ArcChain:
    """An open chain of arcs.

    Attributes
    ----------
    points : complex array (k+1,)
        Joints, m.
    bulges : array (k,)
        Tangent of a quarter of each sweep.
    deviation : float
        Proven bound on the distance between chain and curve, m.
    """

    points: ComplexArray
    bulges: FloatArray
    deviation: float


@dataclass(frozen=True)
class _Biarc:
    joint: complex
    bulges: tuple[float, float]
    bends: tuple[float, float]
    deviation: float

    @property
    def is_one_arc(self) -> bool:
        """Whether both arcs lie on one circle."""
        one, two = self.bends
        return abs(one - two) <= _SAME_BEND * max(abs(one), abs(two))


def _quarter_tangent(chord: complex, tangent: complex) -> float:
    """Bulge of the arc along `chord` that starts along the unit `tangent`."""
    turned = chord * tangent.conjugate()
    # Half the sweep is the angle from tangent to chord; its half-angle tangent is the bulge.
    return turned.imag / (abs(turned) + turned.real)


def _bend(bulge: float, chord: complex) -> float:
    """Signed curvature of an arc."""
    return 4.0 * bulge / ((1.0 + bulge * bulge) * abs(chord))


def _fit_one(points: ComplexArray, tangents: ComplexArray) -> _Biarc:
    """Biarc over a sampled span, and how far the samples and all between them can be from it."""
    start, end = complex(points[0]), complex(points[-1])
    first, last = complex(tangents[0]), complex(tangents[-1])
    chord = end - start
    both = first + last
    along = (chord * both.conjugate()).real
    opening = 2.0 * (1.0 - (first * last.conjugate()).real)
    square = abs(chord) ** 2
    # Equal tangent lengths at both ends; this form of the root has no cancellation.
    root = along + math.sqrt(along * along + opening * square)
    if root <= 0.0:
        return _Biarc(start, (0.0, 0.0), (0.0, 0.0), math.inf)
    reach = square / root
    joint = 0.5 * (start + reach * first + end - reach * last)
    direction = end - reach * last - (start + reach * first)
    direction /= abs(direction)
    one = _quarter_tangent(joint - start, first)
    two = _quarter_tangent(end - joint, direction)
    # The normal through the joint parts the samples between the two arcs.
    before = ((points - joint) * direction.conjugate()).real <= 0.0
    origin = np.where(before, start, joint)
    tangent = np.where(before, first, direction)
    bends = (_bend(one, joint - start), _bend(two, end - joint))
    bend = np.where(before, *bends)
    # Distance to a circle of curvature k through `origin` along `tangent`, exact also as k -> 0:
    # with w = k (p - origin) in the tangent's frame, |p - centre| - |radius| = (|w - i| - 1) / k.
    local = (points - origin) * np.conj(tangent)
    inner = 1j * bend * local + 1.0
    size = np.abs(inner)
    off = (bend * np.abs(local) ** 2 - 2.0 * local.imag) / (1.0 + size)
    # Angle between the curve and the arc beside it: the slope of that distance along the curve.
    slope = (tangents * np.conj(tangent * inner / size)).imag
    # Between two samples the distance exceeds both only where its slope changes sign, and then by
    # at most half a step at the larger slope.
    steps = np.abs(np.diff(points))
    turning = slope[:-1] * slope[1:] <= 0.0
    steepest = np.maximum(np.abs(slope[:-1]), np.abs(slope[1:]))
    excess = np.where(turning, 0.5 * steps * steepest, 0.0)
    size_off = np.abs(off)
    bound = float(np.max(np.maximum(size_off[:-1], size_off[1:]) + excess))
    return _Biarc(joint, (one, two), bends, bound)


def fit_biarcs(
    curve: PlaneCurve, tangent: PlaneCurve, breaks: Sequence[float], tolerance: float
) -> ArcChain:
    """Fit a chain of biarcs to a curve, each span as long as the tolerance allows.

    Parameters
    ----------
    curve, tangent : callable
        Points (m) and unit tangents as complex arrays over an array of parameters. The tangent
        must be continuous over the whole range.
    breaks : sequence of float
        Ascending parameters: first the start, last the end; joints are put at all of them, so the
        curvature may jump there.
    tolerance : float
        Most distance between chain and curve, m, 1e-9 or more.

    Returns
    -------
    ArcChain
        Its `deviation` is at most `tolerance`: the exact distance at 33 samples of every span plus
        a bound for the stretches between, which holds while the angle between curve and arc has
        at most one zero between two samples.

    Raises
    ------
    GeometryError
        When the tolerance is too small to mean anything in double precision.
    """
    if not (math.isfinite(tolerance) and tolerance >= SMALLEST_TOLERANCE):
        raise GeometryError(
            f"edm.profile_tolerance {tolerance * 1e6:.6g} um is below "
            f"{SMALLEST_TOLERANCE * 1e6:g} um, the finest this fit can promise; raise it."
        )
    points: list[complex] = [complex(curve(np.asarray(breaks[:1], dtype=float))[0])]
    bulges: list[float] = []
    worst = 0.0
    for begin, end in pairwise(breaks):
        at, guess = begin, end - begin
        while at < end:
            reach, biarc, stop = _longest_span(curve, tangent, at, end, guess, tolerance)
            if biarc.is_one_arc:
                first, second = (math.atan(b) for b in biarc.bulges)
                bulges.append(math.tan(first + second))
            else:
                points.append(biarc.joint)
                bulges += biarc.bulges
            points.append(stop)
            worst = max(worst, biarc.deviation)
            guess, at = reach - at, reach
    return ArcChain(np.array(points), np.array(bulges), worst)


def _longest_span(
    curve: PlaneCurve,
    tangent: PlaneCurve,
    start: float,
    end: float,
    guess: float,
    tolerance: float,
) -> tuple[float, _Biarc, complex]:
    """Longest span from `start` within the tolerance: its end, its biarc and its last point."""
    left = end - start
    length, low, high = min(guess, left), 0.0, math.inf
    best: tuple[float, _Biarc, complex] | None = None
    for _ in range(60):
        stop = end if length == left else start + length
        at = start + (stop - start) * _UNIT
        points = curve(at)
        biarc = _fit_one(points, tangent(at))
        if biarc.deviation <= tolerance:
            best, low = (stop, biarc, complex(points[-1])), length
            if length == left or biarc.deviation >= _ENOUGH * tolerance:
                return best
        else:
            high = length
        if best is not None and high - low <= 1e-3 * low:
            return best
        # The deviation of a biarc grows with the cube of its length.
        ratio = (0.985 * tolerance / biarc.deviation) ** (1.0 / 3.0) if biarc.deviation else 4.0
        aim = length * min(max(ratio, 0.1), 4.0)
        if not low < aim < high:
            aim = 0.5 * (low + high)
        length = min(aim, left)
    if best is None:
        raise GeometryError(
            "the profile is too sharp for arcs within edm.profile_tolerance; raise it."
        )
    return best


def mirrored_contour(chain: ArcChain, count: int) -> ArcContour:
    """Close a chain over one half of a sector to a contour with `count` equal mirrored sectors.

    Parameters
    ----------
    chain : ArcChain
        From the +x axis to the axis at angle pi/count, perpendicular to both where it meets them.
    count : int
        Sectors in a full turn.

    Returns
    -------
    ArcContour
        Starts on +x, counter-clockwise. The arcs on both sides of the axis at pi/count lie on one
        circle and become one.
    """
    axis = np.exp(2j * math.pi / count)
    points, bulges = chain.points, chain.bulges
    tip = bulges[-1]
    mirrored = axis * np.conj(points[-2:0:-1])
    sector = np.concatenate([points[:-1], mirrored])
    merged = [2.0 * tip / (1.0 - tip * tip)]
    sector_bulges = np.concatenate([bulges[:-1], merged, bulges[-2::-1]])
    turns = np.exp(2j * math.pi * np.arange(count) / count)
    return ArcContour(as_points((turns[:, None] * sector).ravel()), np.tile(sector_bulges, count))
