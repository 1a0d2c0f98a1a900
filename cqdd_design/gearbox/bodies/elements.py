"""Quadratic triangles with curved sides in plane stress, their edges, and their factors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.gearbox.bodies.fronts import Factors, factors
from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.gearbox.bodies.mesh import IntArray, Mesh
from cqdd_design.gearbox.bodies.point_load import Plate
from cqdd_design.geometry.contours import ComplexArray, FloatArray, gauss_rule

EDGE_POINTS = 10
"""Of quadrature, on a side; with 5 the two halves of an influence matrix differ by 1e-6."""
_SMOOTH_POINTS = 6
"""On a side of a loop without point loads, whose fields are smooth there."""


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
    unknowns : array
        Those along the loops, where alone there are loads and anything is read.
    """

    loop: IntArray
    point: ComplexArray
    normal: ComplexArray
    weight: FloatArray
    trace: Any
    unknowns: IntArray


@dataclass(frozen=True, eq=False)
class Elements:
    """A plane body in finite elements.

    Attributes
    ----------
    place : complex array (nodes,)
        m. Node k has the unknowns 2 k along x and 2 k + 1 along y.
    triangles : array (6, K)
        Nodes of every triangle: corners, then middles of its sides.
    stiffness : sparse matrix
        N/m; free of supports.
    edges : Edges
    sides : tuple of array (S + 1,)
        Of every loop: parameters of its sides' ends.
    nodes : tuple of array (3, S)
        Of every loop: nodes at the begin, end and middle of its sides.
    """

    place: ComplexArray
    triangles: IntArray
    stiffness: Any
    edges: Edges
    sides: tuple[FloatArray, ...]
    nodes: tuple[IntArray, ...]

    def factors(self, held: IntArray, springs: FloatArray | None = None) -> Factors:
        """Factors of the stiffness, for loads along the edges.

        Parameters
        ----------
        held : array
            Unknowns at zero.
        springs : array (Q,), optional
            To the ground at the edges' quadrature points, in both directions, N/m.
        """
        from scipy.sparse import diags

        matrix, trace = self.stiffness, self.edges.trace
        if springs is not None:
            matrix = matrix + trace.T @ diags(np.tile(springs, 2)) @ trace
        return factors(matrix, self.place, self.triangles, self.edges.unknowns, held)

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
        columns = 2 * self.nodes[index][:, None, side] + np.arange(2)[:, None]
        values = np.stack([shapes * along.real, shapes * along.imag], axis=1)
        rows = np.broadcast_to(np.arange(len(at)), columns.shape)
        triples = (values.ravel(), (rows.ravel(), columns.ravel()))
        return at, csr_matrix(triples, shape=(len(at), self.stiffness.shape[0]))

    def rigid(self) -> IntArray:
        """Three unknowns that hold the body against moving as a whole."""
        left, right = int(self.place.real.argmin()), int(self.place.real.argmax())
        return np.array([2 * left, 2 * left + 1, 2 * right + 1])

    def rigid_motions(self) -> FloatArray:
        """Unknowns (unknowns, 3) of a motion along x, along y, and of a turn about the origin."""
        one, none = np.ones(len(self.place)), np.zeros(len(self.place))
        x = np.stack([one, none, -self.place.imag], axis=-1)
        y = np.stack([none, one, self.place.real], axis=-1)
        return np.stack([x, y], axis=1).reshape(-1, 3)


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
    from skfem import Basis, ElementTriP2, MeshTri, MeshTri2

    corners = np.stack([mesh.vertices.real, mesh.vertices.imag])
    curved = MeshTri2.from_mesh(MeshTri(corners, mesh.triangles))
    locations, count = curved.doflocs.copy(), corners.shape[1]
    number = np.sort(curved.facets, axis=0).T @ [count, 1]
    order = np.argsort(number)
    nodes = []
    for loop, u, sides in zip(loops, mesh.parameters, mesh.sides, strict=True):
        wanted = np.sort(sides, axis=1) @ [count, 1]
        middles = count + order[np.searchsorted(number, wanted, sorter=order)]
        middle = loop.curve(0.5 * (u[1:] + u[:-1]))[0]
        locations[:, middles] = np.stack([middle.real, middle.imag])
        nodes.append(np.stack([*sides.T, middles]))
    basis = Basis(MeshTri2(locations, curved.t), ElementTriP2(), intorder=4)
    triangles = np.asarray(basis.element_dofs)
    stiff = np.ones(triangles.shape[1]) if factor is None else factor
    matrix = _stiffness(basis, plate, stiff)
    edges = _edges(mesh, loops, tuple(nodes), matrix.shape[0])
    place = basis.doflocs[0] + 1j * basis.doflocs[1]
    return Elements(place, triangles, matrix, edges, mesh.parameters, tuple(nodes))


def _stiffness(basis: Any, plate: Plate, factor: FloatArray) -> Any:
    """Stiffness of all triangles (each `factor` times the plate's) between their unknowns, N/m."""
    from scipy.sparse import csr_matrix

    slopes = np.stack([one[0].grad for one in basis.basis])
    corners, axes, count, points = slopes.shape
    weighed = slopes * (basis.dx * factor[:, None])
    # Of slope i of shape a and slope j of shape b: (K, a, i, b, j).
    flat = (corners * axes, count, points)
    products = np.matmul(
        weighed.reshape(flat).transpose(1, 0, 2), slopes.reshape(flat).transpose(1, 2, 0)
    ).reshape(count, corners, axes, corners, axes)
    lame = plate.modulus * plate.thickness * plate.poisson / (1.0 - plate.poisson**2)
    each = lame * products + 0.5 * plate.shear * products.transpose(0, 1, 4, 3, 2)
    both = 0.5 * plate.shear * np.trace(products, axis1=2, axis2=4)
    for k in range(axes):
        each[:, :, k, :, k] += both
    size = axes * basis.N
    own = axes * basis.element_dofs.T[:, :, None] + np.arange(axes)
    own = own.reshape(count, corners * axes)
    rows, columns = np.repeat(own, corners * axes, axis=1), np.tile(own, corners * axes)
    return csr_matrix((each.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))


def side_points(loop: Loop) -> int:
    """Points of quadrature on each side of a loop."""
    return EDGE_POINTS if loop.loaded else _SMOOTH_POINTS


def _edges(mesh: Mesh, loops: tuple[Loop, ...], own: tuple[IntArray, ...], size: int) -> Edges:
    from scipy.sparse import csr_matrix

    which, points, normals, lengths, columns, shapes = [], [], [], [], [], []
    for index, (loop, u, nodes_of) in enumerate(zip(loops, mesh.parameters, own, strict=True)):
        nodes, weights = gauss_rule(side_points(loop))
        step = np.diff(u)[:, None]
        at = (u[:-1, None] + step * nodes).ravel()
        point, slope = loop.curve(at)
        points.append(point)
        normals.append(loop.normal(at))
        lengths.append((np.abs(slope).reshape(step.shape[0], -1) * step * weights).ravel())
        which.append(np.full(len(at), index))
        columns.append(np.repeat(nodes_of, len(nodes), axis=1))
        shape = [(1 - nodes) * (1 - 2 * nodes), nodes * (2 * nodes - 1), 4 * nodes * (1 - nodes)]
        shapes.append(np.tile(np.stack(shape), (1, len(step))))
    dofs = 2 * np.concatenate(columns, axis=1)
    total = dofs.shape[1]
    values = np.concatenate(shapes, axis=1)
    rows = np.arange(total)
    trace = csr_matrix(
        (
            np.concatenate([values.ravel(), values.ravel()]),
            (
                np.concatenate([np.tile(rows, 3), np.tile(rows, 3) + total]),
                np.concatenate([dofs.ravel(), dofs.ravel() + 1]),
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
        np.unique(trace.indices),
    )
