"""Quadratic triangles with curved sides in plane stress, their edges, and their factors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.gearbox.bodies.mesh import IntArray, Mesh
from cqdd_design.gearbox.bodies.point_load import Plate
from cqdd_design.geometry.contours import ComplexArray, FloatArray, gauss_rule

_EDGE_POINTS = 5
_SOLVED_AT_ONCE = 4
"""Right-hand sides SuperLU takes together: more and its threads wait for each other tenfold."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Quadrature along all loops.

    Attributes
    ----------
    loop : array (Q,)
        Which loop a point lies on.
    point, normal : complex array (Q,)
        m, and the unit normal out of the body's own material.
    weight : array (Q,)
        Length, m.
    trace : sparse matrix (2 Q, unknowns)
        Displacements x and y at the points from the unknowns; x first.
    """

    loop: IntArray
    point: ComplexArray
    normal: ComplexArray
    weight: FloatArray
    trace: Any


@dataclass(frozen=True, eq=False)
class Elements:
    """A plane body in finite elements.

    Attributes
    ----------
    basis : skfem.Basis
    stiffness : sparse matrix
        N/m; free of supports.
    edges : Edges
    sides : tuple of array (S + 1,)
        Of every loop: parameters of its sides' ends.
    unknowns : tuple of array (3, 2, S)
        Of every loop: unknowns x and y at the begin, end and middle of its sides.
    """

    basis: Any
    stiffness: Any
    edges: Edges
    sides: tuple[FloatArray, ...]
    unknowns: tuple[IntArray, ...]

    def solver(self, fixed: IntArray, springs: FloatArray | None = None) -> Any:
        """One factorisation: from loads (R, N) on some unknowns (R,) to their displacements.

        Parameters
        ----------
        fixed : array
            Unknowns at zero.
        springs : array (Q,), optional
            To the ground at the edges' quadrature points, in both directions, N/m.
        """
        from scipy.sparse import diags
        from scipy.sparse.linalg import splu

        matrix = self.stiffness
        if springs is not None:
            trace = self.edges.trace
            matrix = matrix + trace.T @ diags(np.tile(springs, 2)) @ trace
        free = np.setdiff1d(np.arange(matrix.shape[0]), fixed)
        factors = splu(
            matrix[free][:, free].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

        place = np.full(matrix.shape[0], -1)
        place[free] = np.arange(len(free))

        def solve(loads: FloatArray, rows: IntArray) -> FloatArray:
            loose = np.flatnonzero(place[rows] >= 0)
            at = place[rows[loose]]
            found = np.zeros(loads.shape)
            for first in range(0, loads.shape[1], _SOLVED_AT_ONCE):
                some = loads[loose, first : first + _SOLVED_AT_ONCE]
                given = np.zeros((some.shape[1], len(free)))
                given[:, at] = some.T
                found[loose, first : first + some.shape[1]] = factors.solve(given.T)[at]
            return found

        return solve

    def strain(self, loops: tuple[Loop, ...], loop: IntArray, u: FloatArray) -> Any:
        """Sparse matrix (P, unknowns) of strains along the edges at parameters `u` of loops.

        A quadratic side's slope is right at the two Gauss points of each side; between them it is
        drawn through four.
        """
        from scipy.sparse import csr_matrix, vstack

        rows, order = [], []
        for index in np.unique(loop):
            own = np.flatnonzero(loop == index)
            at, slopes = self._slopes(loops[index], index)
            around = at[0] + np.mod(u[own] - at[0], 1.0)
            near = np.searchsorted(at, around, side="right")[:, None] + np.arange(-2, 2)
            knots = at[near % len(at)] + near // len(at)
            share = np.ones(near.shape)
            for k, m in ((k, m) for k in range(4) for m in range(4) if k != m):
                share[:, k] *= (around - knots[:, m]) / (knots[:, k] - knots[:, m])
            line = np.repeat(np.arange(len(own)), 4)
            between = csr_matrix(
                (share.ravel(), (line, (near % len(at)).ravel())), shape=(len(own), len(at))
            )
            rows.append(between @ slopes)
            order.append(own)
        return vstack(rows).tocsr()[np.argsort(np.concatenate(order))]

    def _slopes(self, loop: Loop, index: int) -> tuple[FloatArray, Any]:
        """Parameters of the Gauss points of a loop's sides, rising, and strains along them."""
        from scipy.sparse import csr_matrix

        ends = self.sides[index]
        part = np.tile(gauss_rule(2)[0], len(ends) - 1)
        side = np.repeat(np.arange(len(ends) - 1), 2)
        step = ends[side + 1] - ends[side]
        at = ends[side] + part * step
        slope = loop.curve(at)[1]
        along = slope / np.abs(slope) / (np.abs(slope) * step)
        shapes = np.stack([4.0 * part - 3.0, 4.0 * part - 1.0, 4.0 - 8.0 * part])
        columns = self.unknowns[index][:, :, side]
        values = np.stack([shapes * along.real, shapes * along.imag], axis=1)
        rows = np.broadcast_to(np.arange(len(at)), columns.shape)
        triples = (values.ravel(), (rows.ravel(), columns.ravel()))
        return at, csr_matrix(triples, shape=(len(at), self.basis.N))

    def rigid(self) -> IntArray:
        """Three unknowns that hold the body against moving as a whole."""
        x = self.basis.doflocs[0, self.basis.nodal_dofs[0]]
        left, right = int(x.argmin()), int(x.argmax())
        nodal = self.basis.nodal_dofs
        return np.array([nodal[0, left], nodal[1, left], nodal[1, right]])


def elements(
    mesh: Mesh, loops: tuple[Loop, ...], plate: Plate, factor: FloatArray | None = None
) -> Elements:
    """Assemble a meshed body.

    Parameters
    ----------
    mesh : Mesh
    loops : tuple of Loop
        Those it was made from.
    plate : Plate
        Of the body's own material.
    factor : array (K,), optional
        Stiffness of every triangle over the plate's.
    """
    from skfem import (
        Basis,
        BilinearForm,
        ElementTriP0,
        ElementTriP2,
        ElementVector,
        MeshTri,
        MeshTri2,
    )
    from skfem.helpers import ddot, sym_grad, trace

    corners = np.stack([mesh.vertices.real, mesh.vertices.imag])
    curved = MeshTri2.from_mesh(MeshTri(corners, mesh.triangles))
    facets = {tuple(pair): k for k, pair in enumerate(np.sort(curved.facets, axis=0).T.tolist())}
    own = [
        np.array([facets[tuple(pair)] for pair in np.sort(sides, axis=1).tolist()])
        for sides in mesh.sides
    ]
    locations = curved.doflocs.copy()
    count = corners.shape[1]
    for loop, u, facet in zip(loops, mesh.parameters, own, strict=True):
        middle = loop.curve(0.5 * (u[1:] + u[:-1]))[0]
        locations[:, count + facet] = np.stack([middle.real, middle.imag])
    curved = MeshTri2(locations, curved.t)
    basis = Basis(curved, ElementVector(ElementTriP2()), intorder=4)
    shear = plate.shear
    lame = plate.modulus * plate.thickness * plate.poisson / (1.0 - plate.poisson**2)
    stiff = np.ones(mesh.triangles.shape[1]) if factor is None else factor
    per_triangle = basis.with_element(ElementTriP0()).interpolate(stiff)

    def strain_energy(u: Any, v: Any, w: Any) -> Any:
        e, d = sym_grad(u), sym_grad(v)
        return w.factor * (shear * ddot(e, d) + lame * trace(e) * trace(d))

    matrix = BilinearForm(strain_energy).assemble(basis, factor=per_triangle)
    unknowns = tuple(
        np.stack(
            [
                basis.nodal_dofs[:, sides[:, 0]],
                basis.nodal_dofs[:, sides[:, 1]],
                basis.facet_dofs[:, facet],
            ]
        )
        for sides, facet in zip(mesh.sides, own, strict=True)
    )
    edges = _edges(mesh, loops, unknowns, basis.N)
    return Elements(basis, 0.5 * (matrix + matrix.T), edges, mesh.parameters, unknowns)


def _edges(mesh: Mesh, loops: tuple[Loop, ...], unknowns: tuple[IntArray, ...], size: int) -> Edges:
    from scipy.sparse import csr_matrix

    nodes, weights = gauss_rule(_EDGE_POINTS)
    shapes = np.stack(
        [(1 - nodes) * (1 - 2 * nodes), nodes * (2 * nodes - 1), 4 * nodes * (1 - nodes)]
    )
    which, points, normals, lengths, columns = [], [], [], [], []
    for index, (loop, u, own) in enumerate(zip(loops, mesh.parameters, unknowns, strict=True)):
        step = np.diff(u)[:, None]
        at = (u[:-1, None] + step * nodes).ravel()
        point, slope = loop.curve(at)
        points.append(point)
        normals.append(loop.normal(at))
        lengths.append((np.abs(slope).reshape(step.shape[0], -1) * step * weights).ravel())
        which.append(np.full(len(at), index))
        columns.append(np.repeat(own, len(nodes), axis=2))
    dofs = np.concatenate(columns, axis=2)
    total = dofs.shape[2]
    values = np.tile(shapes, (1, total // len(nodes)))
    rows = np.arange(total)
    trace = csr_matrix(
        (
            np.concatenate([values.ravel(), values.ravel()]),
            (
                np.concatenate([np.tile(rows, 3), np.tile(rows, 3) + total]),
                np.concatenate([dofs[:, 0].ravel(), dofs[:, 1].ravel()]),
            ),
        ),
        shape=(2 * total, size),
    )
    return Edges(
        np.concatenate(which),
        np.concatenate(points),
        np.concatenate(normals),
        np.concatenate(lengths),
        trace,
    )
