r"""What the half-plane fields of point loads do to a body's edges, from afar by series.

Between its places and its edges' points a body has some ten million tractions, of which most are of
loads far away. On a piece of an edge those are power series about the piece's middle c, for with
d = z - z_0 and w = z - c a force f at z_0 leaves on an edge of normal n (:mod:`.point_load`)

    -1/(2 pi) (n f/d + (n conj(f) + conj(n) f)/conj(d) + conj(n f) d/conj(d)^2)

and 1/d is a series in w: the local expansions of Greengard and Rokhlin (1987), for Kolosov's two
functions of plane stress. What they meet is then found once for all places, by a matrix a piece.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from cqdd_design.gearbox.bodies.mesh import IntArray
from cqdd_design.gearbox.bodies.point_load import Places, Plate, displacement, traction
from cqdd_design.geometry.contours import ComplexArray, FloatArray

_TERMS = 24
"""Of either series."""
_AFAR = 2.5
"""Distance of a load from the middle of a piece, over the piece's radius, from which it is far.
What the series leave out is 2.5^-24 of a traction, and of either sign along the edge."""
_POINTS = 240
"""Of an edge's quadrature in a piece, about: more make series do for fewer loads."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of an edge with R points of quadrature.

    Attributes
    ----------
    points : slice
        They, among all edges' points.
    near : array (N,)
        Places that are not far, rising.
    by_near : array (2 R, 2 N)
        Tractions by their loads along x, then along y, N/m.
    shapes : array (2 R, 4 terms)
        Tractions of which those by all others are made, alike.
    """

    points: slice
    near: IntArray
    by_near: FloatArray
    shapes: FloatArray


@dataclass(frozen=True, eq=False)
class EdgeTractions:
    """Tractions at all edges' points by the loads of all places.

    Attributes
    ----------
    pieces : tuple of Piece
    series : array (pieces times 4 terms, loads)
        Share of every load in the shapes, piece by piece; 0 where it is near.
    """

    pieces: tuple[Piece, ...]
    series: FloatArray

    @classmethod
    def of(
        cls,
        point: ComplexArray,
        normal: ComplexArray,
        loop: IntArray,
        places: Places,
        plate: Plate,
        foundation: FloatArray | None = None,
    ) -> EdgeTractions:
        """Tractions by places on edges.

        Parameters
        ----------
        point, normal : complex array (Q,)
            Outward normals, of any length.
        loop : array (Q,)
            Which loop a point lies on, rising.
        foundation : array (Q,), optional
            Springs to the ground in both directions, N/m^2, whose forces count as tractions.
        """
        cuts = _cuts(loop)
        series = np.zeros((len(cuts) * 4 * _TERMS, 2 * len(places)))
        pieces = []
        for points, share in zip(cuts, _by_piece(series), strict=True):
            z, n = point[points], normal[points]
            springs = None if foundation is None else foundation[points]
            middle = 0.5 * (z.real.min() + z.real.max() + 1j * (z.imag.min() + z.imag.max()))
            radius = float(np.abs(z - middle).max())
            near = _nearest(places, middle) < _AFAR * radius
            if springs is not None and springs.any():
                near[:] = True
            close, far = places.some(np.flatnonzero(near)), places.some(np.flatnonzero(~near))
            by_near = traction(z, n, close)
            if springs is not None and springs.any():
                by_near -= springs[:, None] * displacement(z, close, plate)
            share[:, np.repeat(~near, 2)] = _series(far, middle, radius)
            shapes = _shapes((z - middle) / radius, n)
            by_near = by_near.reshape(len(shapes), 2 * len(close))
            pieces.append(Piece(points, np.flatnonzero(near), by_near, shapes))
        return cls(tuple(pieces), series)

    def work(self, moved: FloatArray, begin: int, end: int) -> FloatArray:
        """Work of the loads from `begin` to `end`, of whole places, on motions (2 Q, M).

        Returns
        -------
        array (end - begin, M)
        """
        each = moved.shape[1]
        both = moved.reshape(2, len(moved) // 2, each)
        found = np.zeros((end - begin, each))
        met = np.empty((len(self.series), each))
        for piece, shared in zip(self.pieces, _by_piece(met), strict=True):
            own = both[:, piece.points].reshape(len(piece.shapes), each)
            np.matmul(piece.shapes.T, own, out=shared)
            first, last = np.searchsorted(piece.near, (begin // 2, end // 2))
            close = _loads(piece.near[first:last]) - begin
            found[close] += piece.by_near[:, 2 * first : 2 * last].T @ own
        found += self.series[:, begin:end].T @ met
        return found

    def add_forces(self, found: FloatArray, weighed: Any, loads: IntArray) -> None:
        """Add the forces at unknowns by some loads, rising, of whole places, to `found` (U, M).

        Parameters
        ----------
        weighed : sparse matrix (2 Q, U)
            Motions at the edges' points by unknowns, times the points' weights.
        """
        rows = np.arange(weighed.shape[0]).reshape(2, -1)
        asked = loads if len(loads) < self.series.shape[1] else slice(None)
        for piece, share in zip(self.pieces, _by_piece(self.series), strict=True):
            own = weighed[rows[:, piece.points].ravel()]
            unknowns = np.unique(own.indices)
            motions = own[:, unknowns].toarray().T
            force = (motions @ piece.shapes) @ share[:, asked]
            close = _loads(piece.near)
            there = np.isin(close, loads)
            where = np.searchsorted(loads, close[there])
            force[:, where] += motions @ piece.by_near[:, there]
            found[unknowns] += force


def _cuts(loop: IntArray) -> list[slice]:
    """Pieces of edges, each of one loop."""
    cuts: list[slice] = []
    for start, stop in pairwise([0, *(np.flatnonzero(np.diff(loop)) + 1).tolist(), len(loop)]):
        parts = max(round((stop - start) / _POINTS), 1)
        ends = np.linspace(start, stop, parts + 1).astype(int).tolist()
        cuts += [slice(begin, end) for begin, end in pairwise(ends)]
    return cuts


def _by_piece(rows: FloatArray) -> FloatArray:
    """Rows of all pieces' shapes, (pieces, 4 terms, ...)."""
    return rows.reshape(len(rows) // (4 * _TERMS), 4 * _TERMS, rows.shape[1])


def _loads(places: IntArray) -> IntArray:
    """The two loads of each place."""
    return (2 * places[:, None] + np.arange(2)).ravel()


def _nearest(places: Places, middle: complex) -> FloatArray:
    """Distance of what is singular in the fields of places, (N,), m."""
    void = np.where(np.isnan(places.void), places.point, places.void)
    return np.minimum(np.abs(places.point - middle), np.abs(void - middle))


def _series(places: Places, middle: complex, radius: float) -> FloatArray:
    """Share of every load in the shapes, (4 terms, 2 N)."""
    force, k = places.directions, np.arange(_TERMS)[:, None]

    def about(point: ComplexArray) -> ComplexArray:
        away = (np.repeat(point, 2) - middle) / radius
        inverse = -np.cumprod(np.broadcast_to(1.0 / away, (_TERMS, len(away))), axis=0)
        slope = -(k + 1.0) * inverse / away
        return np.stack([force * inverse, np.conj(force) * inverse - force * np.conj(away) * slope])

    both = about(places.point)
    ended = np.repeat(~np.isnan(places.void), 2)
    back = about(np.where(np.isnan(places.void), places.point, places.void))
    both -= np.where(ended, back, 0.0)
    both *= -1.0 / (2.0 * np.pi * radius)
    return np.stack([both.real, both.imag], axis=1).reshape(4 * _TERMS, -1)


def _shapes(w: ComplexArray, normal: ComplexArray) -> FloatArray:
    """Tractions of the terms, whose shares are real, (2 R, 4 terms)."""
    k, n = np.arange(_TERMS), normal[:, None]
    power = w[:, None] ** k
    turned = np.conj(n) * np.conj(power)
    drawn = np.zeros_like(turned)
    drawn[:, 1:] = k[1:] * w[:, None] * turned[:, :-1]
    terms = np.stack(
        [2.0 * n * power.real - drawn, -2.0 * n * power.imag + 1j * drawn, turned, -1j * turned],
        axis=1,
    ).reshape(len(w), -1)
    return np.concatenate([terms.real, terms.imag])
