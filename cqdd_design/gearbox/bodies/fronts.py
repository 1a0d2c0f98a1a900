"""Cholesky's factors of a plane body, in dense blocks: wedges about its axis, merged by twos.

Loads stand on the edges alone, and alone there displacements are read. Inside a wedge what lies off
the edges is eliminated first, and never met again; then the wedge's edges; then, pair by pair up to
the whole body, what two wedges share (nested dissection, George 1973, with the frontal matrices of
Duff and Reid 1983). Every step is a product of matrices that fit a processor's cache, where a
general sparse solver takes its columns one by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.mesh import IntArray
from cqdd_design.geometry.contours import ComplexArray, FloatArray

_PER_WEDGE = 40
"""Fewest triangles a wedge: fewer make more shares, more make larger blocks."""


@dataclass(frozen=True, eq=False)
class Front:
    """Unknowns that are eliminated together.

    Attributes
    ----------
    own : array (O,)
        They, as rows of the unknowns that are kept.
    border : array (B,)
        Those kept till later that they are joined to.
    inverse : array (O, O)
        Of their stiffness with all others held, m/N.
    across : array (B, O)
        Share of their loads that is carried on to the border.
    """

    own: IntArray
    border: IntArray
    inverse: FloatArray
    across: FloatArray


@dataclass(frozen=True, eq=False)
class Factors:
    """Factors of a stiffness matrix.

    Attributes
    ----------
    kept : array (N,)
        Row of an unknown among those that are kept; -1 inside a wedge and where it is held.
    fronts : tuple of Front
        In the order of their elimination.
    """

    kept: IntArray
    fronts: tuple[Front, ...]

    def solve(self, loads: FloatArray, unknowns: IntArray) -> FloatArray:
        """Displacements (U, M) of some unknowns under loads (U, M) on them.

        Those that are held stay at zero, whatever loads them.
        """
        rows = self.kept[unknowns]
        free = rows >= 0
        moved = np.zeros((int(self.kept.max()) + 1, loads.shape[1]))
        moved[rows[free]] = loads[free]
        for front in self.fronts:
            moved[front.border] -= front.across @ moved[front.own]
        for front in reversed(self.fronts):
            own = front.inverse @ moved[front.own]
            moved[front.own] = own - front.across.T @ moved[front.border]
        found = np.zeros(loads.shape)
        found[free] = moved[rows[free]]
        return found


class _Share(NamedTuple):
    """What eliminated unknowns leave of stiffness between those that are left."""

    border: IntArray
    stiffness: FloatArray


def factors(
    stiffness: Any, place: ComplexArray, triangles: IntArray, read: IntArray, held: IntArray
) -> Factors:
    """Factorise the stiffness of a body.

    Parameters
    ----------
    stiffness : sparse matrix
        Of unknowns x and y at node 0, at node 1, and so on; positive definite without `held`.
    place : complex array (nodes,)
    triangles : array (6, K)
        Nodes of every triangle.
    read : array
        Unknowns that are loaded and read.
    held : array
        Unknowns at zero.
    """
    wedges = 2 ** max(int(np.log2(triangles.shape[1] / _PER_WEDGE)), 0)
    level, index = _shared(place, triangles, wedges)
    loud = np.zeros(stiffness.shape[0], dtype=bool)
    loud[read] = True
    todo = _Elimination(stiffness.tocsr(), held)
    inside = (level == 0) & ~loud
    shares = [todo.step(inside & (index == k), [], False) for k in range(wedges)]
    at_edge = (level == 0) & loud
    shares = [todo.step(at_edge & (index == k), shares[k : k + 1]) for k in range(wedges)]
    for merged in range(1, wedges.bit_length()):
        own = level == merged
        shares = [
            todo.step(own & (index == k), shares[2 * k : 2 * k + 2])
            for k in range(wedges >> merged)
        ]
    return todo.factors()


def _shared(place: ComplexArray, triangles: IntArray, wedges: int) -> tuple[IntArray, IntArray]:
    """Of every unknown: after how many merges by twos one piece has all its triangles, and which.

    Wedges have as many triangles each, so that a disc's thin and its massive parts take as long.
    """
    turn = np.angle(place[triangles[:3]].mean(axis=0))
    wedge = np.empty(len(turn), dtype=np.int64)
    wedge[np.argsort(turn, kind="stable")] = np.arange(len(turn)) * wedges // len(turn)
    low, high = np.full(len(place), wedges), np.full(len(place), -1)
    for corner in triangles:
        np.minimum.at(low, corner, wedge)
        np.maximum.at(high, corner, wedge)
    level = np.frexp(low ^ high)[1].astype(np.int64)
    return np.repeat(level, 2), np.repeat(low >> level, 2)


class _Elimination:
    """Eliminates unknowns group by group."""

    def __init__(self, matrix: Any, held: IntArray) -> None:
        self._matrix = matrix
        self._done = np.zeros(matrix.shape[0], dtype=bool)
        self._done[held] = True
        self._at = np.full(matrix.shape[0], -1)
        self._fronts: list[tuple[IntArray, IntArray, FloatArray, FloatArray]] = []

    def step(self, group: NDArray[np.bool_], shares: list[_Share], kept: bool = True) -> _Share:
        """Eliminate a group; what it and the shares of those before it leave for later ones."""
        from scipy.linalg.lapack import dtrtri

        own = np.flatnonzero(group & ~self._done)
        rows = self._matrix[own]
        self._done[own] = True
        met = np.unique(np.concatenate([rows.indices, *(share.border for share in shares)]))
        border = met[~self._done[met]]
        count = len(own)
        self._at[own] = np.arange(count)
        self._at[border] = count + np.arange(len(border))
        front = np.zeros((count + len(border),) * 2)
        line, column = np.repeat(np.arange(count), np.diff(rows.indptr)), self._at[rows.indices]
        joined = column >= 0
        front[column[joined], line[joined]] = rows.data[joined]
        for share in shares:
            where = self._at[share.border]
            front[np.ix_(where, where)] += share.stiffness
        self._at[own] = self._at[border] = -1
        if count == 0:
            return _Share(border, front)
        root = dtrtri(np.linalg.cholesky(front[:count, :count]), lower=1)[0]
        coupling = front[count:, :count] @ root.T
        if kept:
            self._fronts.append((own, border, root.T @ root, coupling @ root))
        return _Share(border, front[count:, count:] - coupling @ coupling.T)

    def factors(self) -> Factors:
        """What has been eliminated and kept."""
        kept = np.full(len(self._at), -1)
        order = np.concatenate([own for own, *_ in self._fronts])
        kept[order] = np.arange(len(order))
        fronts = [Front(kept[own], kept[b], *blocks) for own, b, *blocks in self._fronts]
        return Factors(kept, tuple(fronts))
