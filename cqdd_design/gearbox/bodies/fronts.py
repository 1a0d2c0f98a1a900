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
_AT_ONCE = 256
"""Loads that are solved together: all of a large body would want memory anew, and no cache."""
_QUIET = 1
"""Merges before edges are eliminated: what lies off them is best gone in smaller pieces."""


@dataclass(frozen=True, eq=False)
class Front:
    """Unknowns that are eliminated together.

    Attributes
    ----------
    own : slice
        They, as O rows of the unknowns that are kept.
    border : array (B,)
        Those kept till later that they are joined to.
    inverse : array (O, O)
        Of their stiffness with all others held, m/N.
    across : array (B, O)
        Share of their loads that is carried on to the border.
    """

    own: slice
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
        free = np.flatnonzero(rows >= 0)
        rows = rows[free]
        found = np.zeros(loads.shape)
        for first in range(0, loads.shape[1], _AT_ONCE):
            some = slice(first, first + _AT_ONCE)
            moved = np.zeros((int(self.kept.max()) + 1, loads[:, some].shape[1]))
            moved[rows] = loads[free, some]
            for front in self.fronts:
                moved[front.border] -= front.across @ moved[front.own]
            for front in reversed(self.fronts):
                own = front.inverse @ moved[front.own]
                own -= front.across.T @ moved[front.border]
                moved[front.own] = own
            found[free, some] = moved[rows]
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
    loud, free = np.zeros(stiffness.shape[0], dtype=bool), np.ones(stiffness.shape[0], dtype=bool)
    loud[read], free[held] = True, False
    level, low = _shared(place, triangles, wedges)
    quiet = min(_QUIET, wedges.bit_length() - 1)
    level = np.where(loud, np.maximum(level, quiet), level)
    index = low >> level
    # By merges, then by pieces, and of a piece first what is never met again.
    loud |= level > quiet
    order = np.lexsort((loud, index, level))
    order = order[free[order]]
    todo = _Elimination(stiffness.tocsr()[order], order, loud)
    shares: list[_Share] = [_Share(np.empty(0, dtype=np.int64), np.empty((0, 0)))] * (2 * wedges)
    for merged in range(wedges.bit_length()):
        own = order[level[order] == merged]
        counts = np.bincount(index[own], minlength=wedges >> merged)
        shares = [todo.step(int(n), shares[2 * k : 2 * k + 2]) for k, n in enumerate(counts)]
    return todo.factors()


def _shared(place: ComplexArray, triangles: IntArray, wedges: int) -> tuple[IntArray, IntArray]:
    """Of every unknown: after how many merges by twos one piece has its triangles; its first wedge.

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
    return np.repeat(level, 2), np.repeat(low, 2)


class _Elimination:
    """Eliminates unknowns in their order, some at a time.

    Parameters
    ----------
    rows : sparse matrix
        Of the stiffness, in that order.
    order : array
        Unknowns of the rows.
    loud : array of bool
        Which of all unknowns are loaded or read, or take loads on from others.
    """

    def __init__(self, rows: Any, order: IntArray, loud: NDArray[np.bool_]) -> None:
        self._rows, self._order, self._loud = rows, order, loud
        self._first = 0
        self._kept = np.full(len(loud), -1)
        self._kept[order[loud[order]]] = np.arange(np.count_nonzero(loud[order]))
        self._left = np.zeros(len(loud), dtype=bool)
        self._left[order] = True
        self._at = np.full(len(loud), -1)
        self._fronts: list[Front] = []

    def step(self, count: int, shares: list[_Share]) -> _Share:
        """Eliminate the next; what they and the shares of earlier ones leave for later ones."""
        from scipy.linalg import cholesky
        from scipy.linalg.lapack import dtrtri

        some = slice(self._first, self._first + count)
        self._first = some.stop
        own, ends = self._order[some], self._rows.indptr[some.start : some.stop + 1]
        joined, values = (one[ends[0] : ends[-1]] for one in (self._rows.indices, self._rows.data))
        self._left[own] = False
        met = np.zeros(len(self._left), dtype=bool)
        for near in (joined, *(share.border for share in shares)):
            met[near] = True
        border = np.flatnonzero(met & self._left)
        self._at[own] = np.arange(count)
        self._at[border] = count + np.arange(len(border))
        front = np.zeros((count + len(border),) * 2)
        line, column = np.repeat(np.arange(count), np.diff(ends)), self._at[joined]
        here = column >= 0
        front[column[here], line[here]] = values[here]
        for share in shares:
            where = self._at[share.border]
            front[where[:, None], where] += share.stiffness
        self._at[own] = self._at[border] = -1
        left = front[count:, count:]
        if count:
            factor = cholesky(front[:count, :count], lower=True, check_finite=False)
            root = dtrtri(factor, lower=1, overwrite_c=1)[0]
            coupling = front[count:, :count] @ root.T
            left -= coupling @ coupling.T
            self._keep(own, border, root, coupling)
        return _Share(border, left)

    def _keep(
        self, own: IntArray, border: IntArray, root: FloatArray, coupling: FloatArray
    ) -> None:
        """Of a step what its loud unknowns, its last, take part in."""
        silent = int(np.count_nonzero(~self._loud[own]))
        root, coupling = root[silent:, silent:], coupling[:, silent:]
        if silent < len(own):
            rows = slice(int(self._kept[own[silent]]), int(self._kept[own[-1]]) + 1)
            across = coupling @ root
            self._fronts.append(Front(rows, self._kept[border], root.T @ root, across))

    def factors(self) -> Factors:
        """What has been eliminated and kept."""
        return Factors(self._kept, tuple(self._fronts))
