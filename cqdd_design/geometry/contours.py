"""Closed plane contours of lines and circular arcs, circles, and the flat parts they bound.

An arc is written as in DXF: a *bulge* per segment, the tangent of a quarter of its sweep. Zero is
a straight line, positive turns counter-clockwise, one is a half circle::

        __--P1
     _-   /         bulge = tan(sweep / 4) = 2 * sagitta / chord
    /   /           here negative: P0 to P1 runs clockwise
    | /
    P0

Everything is in metres and exact for the arcs themselves: a `Moments` of an `ArcContour` is that
of the arcs, not of a polygon.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cqdd_design.errors import GeometryError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Integrands of second moments are trigonometric polynomials of degree four in the arc's angle:
# 24 Gauss points integrate them to rounding over any sweep up to a full turn.
_GAUSS_POINTS = 24


def as_complex(points: ArrayLike) -> ComplexArray:
    """Points (..., 2) as complex numbers (...)."""
    array = np.asarray(points, dtype=float)
    return np.asarray(array[..., 0] + 1j * array[..., 1])


def as_points(values: ArrayLike) -> FloatArray:
    """Complex numbers (...) as points (..., 2)."""
    array = np.asarray(values, dtype=complex)
    return np.stack([array.real, array.imag], axis=-1)


@lru_cache(maxsize=8)
def gauss_rule(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights (count,) of the Gauss-Legendre rule on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1.0) / 2.0, weights / 2.0


@dataclass(frozen=True)
class Moments:
    """Area, first and second moments of a plane region about the origin of its frame.

    Attributes
    ----------
    area : float
        m^2.
    x, y : float
        First moments, the integrals of x and y, m^3.
    xx, yy, xy : float
        Second moments, the integrals of x^2, y^2 and xy, m^4.

    Two regions add with ``+``; a hole is taken away with ``-``.
    """

    area: float
    x: float
    y: float
    xx: float
    yy: float
    xy: float

    @property
    def _values(self) -> tuple[float, ...]:
        return self.area, self.x, self.y, self.xx, self.yy, self.xy

    def __add__(self, other: Moments) -> Moments:
        """Both regions together."""
        return Moments(*(a + b for a, b in zip(self._values, other._values, strict=True)))

    def __sub__(self, other: Moments) -> Moments:
        """Return the region without the other."""
        return Moments(*(a - b for a, b in zip(self._values, other._values, strict=True)))

    @property
    def centroid(self) -> FloatArray:
        """Centre of area (2,), m."""
        return np.array([self.x, self.y]) / self.area

    @property
    def polar(self) -> float:
        """Integral of x^2 + y^2 about the origin, m^4."""
        return self.xx + self.yy

    def about_centroid(self) -> Moments:
        """Return the same region seen from its own centre of area."""
        cx, cy = self.centroid
        return Moments(
            self.area,
            0.0,
            0.0,
            self.xx - self.area * cx * cx,
            self.yy - self.area * cy * cy,
            self.xy - self.area * cx * cy,
        )


@dataclass(frozen=True, eq=False)
class Arcs:
    """The segments of a contour as circles; a line has an infinite radius and no centre (nan).

    Attributes
    ----------
    centres : array (k, 2)
        m.
    radii : array (k,)
        Positive, m.
    start_angles, sweeps : array (k,)
        rad; a negative sweep runs clockwise.
    """

    centres: FloatArray
    radii: FloatArray
    start_angles: FloatArray
    sweeps: FloatArray


@dataclass(frozen=True, eq=False)
class ArcContour:
    """A closed counter-clockwise contour of lines and arcs.

    Attributes
    ----------
    points : array (k, 2)
        Joints in m; segment i runs from point i to point i+1, the last back to the first.
    bulges : array (k,)
        Tangent of a quarter of the sweep of each segment; 0 is a line.

    Raises
    ------
    GeometryError
        When there are fewer than two joints, a number is not finite, or two successive joints
        coincide.

    Examples
    --------
    >>> ArcContour(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.ones(2)).moments().area
    3.14159265358979...
    """

    points: FloatArray
    bulges: FloatArray

    def __post_init__(self) -> None:
        """Refuse what cannot be a contour."""
        points = np.array(self.points, dtype=float)
        bulges = np.array(self.bulges, dtype=float)
        if points.ndim != 2 or points.shape[1] != 2 or bulges.shape != points.shape[:1]:
            raise GeometryError("a contour needs points (k, 2) and one bulge for each.")
        if len(points) < 2 or not (np.isfinite(points).all() and np.isfinite(bulges).all()):
            raise GeometryError("a contour needs at least two joints, all of them finite.")
        if (np.roll(points, -1, axis=0) == points).all(axis=1).any():
            raise GeometryError("a contour has two successive joints at the same place.")
        points.flags.writeable = False
        bulges.flags.writeable = False
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "bulges", bulges)

    def __len__(self) -> int:
        """Return the number of segments."""
        return len(self.points)

    @property
    def sweeps(self) -> FloatArray:
        """Signed sweep of every segment (k,), rad."""
        return 4.0 * np.arctan(self.bulges)

    def _starts_and_chords(self) -> tuple[ComplexArray, ComplexArray]:
        start = as_complex(self.points)
        return start, np.roll(start, -1) - start

    def evaluate(self, fractions: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Points and derivatives at the same fractions of every segment.

        Parameters
        ----------
        fractions : array (m,)
            0 at a segment's start, 1 at its end.

        Returns
        -------
        points, derivatives : arrays (k, m, 2)
            m, and m per unit of fraction.
        """
        point, slope = self._evaluate(np.arange(len(self))[:, None], np.asarray(fractions))
        return as_points(point), as_points(slope)

    def _evaluate(
        self, rows: NDArray[np.int64], fractions: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        start, chord = self._starts_and_chords()
        start, chord, sweep = start[rows], chord[rows], self.sweeps[rows]
        # Chord and half angle, not centre and radius: stays exact as the bulge goes to zero.
        half = np.sinc(sweep / (2.0 * math.pi))
        part = fractions * np.sinc(fractions * sweep / (2.0 * math.pi)) / half
        point = start + chord * part * np.exp(0.5j * sweep * (fractions - 1.0))
        slope = chord / half * np.exp(1j * sweep * (fractions - 0.5))
        return point, slope

    def length(self) -> float:
        """Perimeter, m."""
        _, chord = self._starts_and_chords()
        return float(np.sum(np.abs(chord) / np.sinc(self.sweeps / (2.0 * math.pi))))

    def moments(self) -> Moments:
        """Area, first and second moments of the region inside, exact for the arcs."""
        nodes, weights = gauss_rule(_GAUSS_POINTS)
        point, slope = self._evaluate(np.arange(len(self))[:, None], nodes)
        # Green's theorem: positive, because the contour runs counter-clockwise.
        steps = slope * weights
        x, y, dx, dy = point.real, point.imag, steps.real, steps.imag
        turn = x * dy - y * dx
        return Moments(
            float(np.sum(turn)) / 2.0,
            float(np.sum(x * turn)) / 3.0,
            float(np.sum(y * turn)) / 3.0,
            float(np.sum(x * x * turn)) / 4.0,
            float(np.sum(y * y * turn)) / 4.0,
            float(np.sum(x * y * turn)) / 4.0,
        )

    def arcs(self) -> Arcs:
        """Centre, radius, start angle and sweep of every segment."""
        start, chord = self._starts_and_chords()
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = 0.5j * chord / np.tan(self.sweeps / 2.0)
            centre = np.where(self.bulges == 0.0, complex(math.nan, math.nan), 0.0) + (
                start + chord / 2.0 + offset
            )
            radius = np.where(
                self.bulges == 0.0, math.inf, np.abs(chord / (2.0 * np.sin(self.sweeps / 2.0)))
            )
        return Arcs(as_points(centre), radius, np.angle(start - centre), self.sweeps)

    def sample(self, tolerance: float) -> FloatArray:
        """Points (m, 2) of a polygon that leaves the contour by at most `tolerance` (m).

        Every joint is a vertex; the first is not repeated at the end.
        """
        radius = self.arcs().radii
        with np.errstate(invalid="ignore"):
            step = 2.0 * np.arccos(np.clip(1.0 - tolerance / radius, 0.0, 1.0))
            counts = np.where(self.bulges == 0.0, 1.0, np.ceil(np.abs(self.sweeps) / step))
        number = counts.astype(np.int64)
        rows = np.repeat(np.arange(len(self)), number)
        first = np.repeat(np.cumsum(number) - number, number)
        fractions = (np.arange(len(rows)) - first) / number[rows]
        return as_points(self._evaluate(rows, fractions)[0])

    def transformed(
        self, rotation: float = 0.0, shift: ArrayLike = (0.0, 0.0), mirror: bool = False
    ) -> ArcContour:
        """Return the contour mirrored in the x axis (if asked), then turned (rad), then moved (m).

        The result runs counter-clockwise again and starts at the image of the first joint.
        """
        points, bulges = as_complex(self.points), self.bulges
        if mirror:
            points = np.conj(np.roll(points[::-1], 1))
            bulges = bulges[::-1]
        moved = points * np.exp(1j * rotation) + as_complex(shift)
        return ArcContour(as_points(moved), bulges)

    def scaled(self, factor: float) -> ArcContour:
        """Return the contour enlarged `factor` times about the origin (1000 for mm)."""
        return ArcContour(self.points * factor, self.bulges)

    def distances(self, points: ArrayLike) -> FloatArray:
        """Distance (m,) from each of `points` (m, 2) to the nearest point of the contour, m."""
        wanted = as_complex(points)[:, None]
        start, chord = self._starts_and_chords()
        end = start + chord
        ends = np.minimum(np.abs(wanted - start), np.abs(wanted - end))
        arcs = self.arcs()
        centre = as_complex(arcs.centres)
        straight = self.bulges == 0.0
        with np.errstate(invalid="ignore"):
            turned = np.angle((wanted - centre) / (start - centre)) * np.sign(arcs.sweeps)
            inside = np.mod(turned, 2.0 * math.pi) <= np.abs(arcs.sweeps)
            to_arc = np.abs(np.abs(wanted - centre) - arcs.radii)
        along = ((wanted - start) / chord).real
        to_line = np.abs(((wanted - start) / chord).imag) * np.abs(chord)
        on_segment = np.where(straight, (along >= 0.0) & (along <= 1.0), inside)
        nearest = np.where(on_segment, np.where(straight, to_line, to_arc), ends)
        return np.asarray(nearest.min(axis=1))


@dataclass(frozen=True, eq=False)
class Circle:
    """A true circle.

    Attributes
    ----------
    centre : array (2,)
        m.
    radius : float
        Positive, m.
    """

    centre: FloatArray
    radius: float

    def __post_init__(self) -> None:
        """Refuse a circle without a size."""
        centre = np.array(self.centre, dtype=float)
        if centre.shape != (2,) or not np.isfinite(centre).all():
            raise GeometryError("a circle needs a finite centre (x, y).")
        if not (math.isfinite(self.radius) and self.radius > 0.0):
            raise GeometryError(
                f"a circle has a radius of {self.radius * 1e3:.6g} mm; it must be above 0 mm."
            )
        centre.flags.writeable = False
        object.__setattr__(self, "centre", centre)

    def length(self) -> float:
        """Circumference, m."""
        return 2.0 * math.pi * self.radius

    def moments(self) -> Moments:
        """Area, first and second moments of the disc inside about the origin."""
        area = math.pi * self.radius**2
        own = area * self.radius**2 / 4.0
        x, y = (float(c) for c in self.centre)
        return Moments(
            area, area * x, area * y, own + area * x * x, own + area * y * y, area * x * y
        )

    def sample(self, tolerance: float) -> FloatArray:
        """Points (m, 2) of an inscribed polygon within `tolerance` (m) of the circle."""
        step = 2.0 * math.acos(min(max(1.0 - tolerance / self.radius, 0.0), 1.0))
        count = max(3, math.ceil(2.0 * math.pi / step))
        turn = np.exp(2j * math.pi * np.arange(count) / count)
        return as_points(as_complex(self.centre) + self.radius * turn)

    def transformed(
        self, rotation: float = 0.0, shift: ArrayLike = (0.0, 0.0), mirror: bool = False
    ) -> Circle:
        """Return the circle mirrored in the x axis (if asked), then turned (rad), then moved."""
        centre = as_complex(self.centre)
        moved = (np.conj(centre) if mirror else centre) * np.exp(1j * rotation)
        return Circle(as_points(moved + as_complex(shift)), self.radius)

    def scaled(self, factor: float) -> Circle:
        """Return the circle enlarged `factor` times about the origin (1000 for mm)."""
        return Circle(self.centre * factor, self.radius * factor)


Contour = ArcContour | Circle


@dataclass(frozen=True, eq=False)
class PlanarPart:
    """A flat part: one outer contour and the holes in it.

    Attributes
    ----------
    name : str
        Such as ``disc 1`` or ``ring``.
    outer : ArcContour or Circle
    holes : tuple of ArcContour or Circle
        Each counter-clockwise by itself, inside `outer` and clear of the others.
    """

    name: str
    outer: Contour
    holes: tuple[Contour, ...] = ()

    def moments(self) -> Moments:
        """Area, first and second moments about the origin, holes taken away."""
        total = self.outer.moments()
        for hole in self.holes:
            total = total - hole.moments()
        return total

    def area(self) -> float:
        """Area of material, m^2."""
        return self.moments().area

    def transformed(
        self, rotation: float = 0.0, shift: ArrayLike = (0.0, 0.0), mirror: bool = False
    ) -> PlanarPart:
        """Return the part mirrored in the x axis (if asked), then turned (rad), then moved (m)."""
        return PlanarPart(
            self.name,
            self.outer.transformed(rotation, shift, mirror),
            tuple(hole.transformed(rotation, shift, mirror) for hole in self.holes),
        )
