"""Plane stress a second time: straight six-node triangles on a lattice, loads on real patches.

Nothing of the package's own mesher, elements or half-plane fields: points of a triangular lattice,
finer in rings round the loads, joined by Delaunay's rule; stiffness by three-point quadrature; a
Hertzian pressure on nodes of the edge.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay, cKDTree


def _plane(z: np.ndarray) -> np.ndarray:
    return np.stack([z.real, z.imag], axis=-1)


@dataclass
class Domain:
    """Closed curves of 0 to 1, the first outside, and whether a point is in the material."""

    curves: Sequence[Callable[[np.ndarray], np.ndarray]]
    inside: Callable[[np.ndarray], np.ndarray]


@dataclass
class Lattice:
    """Six-node triangles: nodes (complex), triangles (6, K), and each curve's nodes in order."""

    nodes: np.ndarray
    triangles: np.ndarray
    edges: list[np.ndarray]


def lattice(domain: Domain, coarse: float, foci: Sequence[complex], fine: float) -> Lattice:
    """Triangles of side `coarse`, halving toward the foci down to `fine`."""

    def size(z: np.ndarray) -> np.ndarray:
        away = np.min(np.abs(z[..., None] - np.asarray(foci)), axis=-1)
        return np.clip(fine + 0.25 * away, fine, coarse)

    rims, loops = [], []
    for curve in domain.curves:
        u = np.linspace(0.0, 1.0, 200_001)
        z = curve(u)
        count = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(z)) / size(z[:-1]))])
        number = int(np.ceil(count[-1]))
        at = np.interp(count[-1] * np.arange(number) / number, count, u)
        loops.append(np.arange(number) + sum(len(one) for one in rims))
        rims.append(curve(at))
    rim = np.concatenate(rims)
    reach = np.abs(rim).max()
    level = coarse
    taken = np.empty(0, dtype=complex)
    while True:
        count = int(reach / level) + 2
        i, j = np.meshgrid(np.arange(-count, count + 1), np.arange(-count, count + 1))
        grid = (level * (i + 0.5 * j) + 1j * level * np.sqrt(0.75) * j).ravel()
        wanted = size(grid)
        own = (wanted >= level) & (wanted < 2.0 * level) if level < coarse else wanted >= level
        if level <= fine:
            own = wanted < 2.0 * level
        grid = grid[own & (np.abs(grid) < reach)]
        grid = grid[domain.inside(grid)]
        if len(grid):
            clear = cKDTree(_plane(rim)).query(_plane(grid))[0] > 0.6 * size(grid)
            grid = grid[clear]
        if len(grid) and len(taken):
            apart = cKDTree(_plane(taken)).query(_plane(grid))[0]
            grid = grid[apart > 0.8 * level]
        taken = np.concatenate([taken, grid])
        if level <= fine:
            break
        level *= 0.5
    corners = np.concatenate([rim, taken])
    triangles = Delaunay(_plane(corners)).simplices
    corner = corners[triangles]
    area = 0.5 * (np.conj(corner[:, 1] - corner[:, 0]) * (corner[:, 2] - corner[:, 0])).imag
    triangles = np.where((area < 0.0)[:, None], triangles[:, [0, 2, 1]], triangles)
    kept = domain.inside(corners[triangles].mean(axis=1)) & (np.abs(area) > 1e-6 * fine**2)
    triangles = triangles[kept]
    pairs = np.sort(np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    unique, which = np.unique(pairs, axis=0, return_inverse=True)
    middles = corners[unique].mean(axis=1)
    six = np.concatenate([triangles.T, len(corners) + which.reshape(3, -1)])
    index = {tuple(pair): len(corners) + k for k, pair in enumerate(unique.tolist())}
    edges = []
    for loop in loops:
        ring = []
        for a, b in zip(loop, np.roll(loop, -1), strict=True):
            ring += [a, index[(min(a, b), max(a, b))]]
        edges.append(np.array(ring))
    return Lattice(np.concatenate([corners, middles]), six, edges)


def stiffness(mesh: Lattice, modulus: float, poisson: float, thickness: float):
    """Stiffness of unknowns x0, y0, x1, y1, ... in plane stress, N/m."""
    law = modulus * thickness / (1.0 - poisson**2)
    D = law * np.array([[1.0, poisson, 0.0], [poisson, 1.0, 0.0], [0.0, 0.0, 0.5 * (1 - poisson)]])
    x, y = mesh.nodes.real[mesh.triangles[:3]], mesh.nodes.imag[mesh.triangles[:3]]
    b = np.stack([y[1] - y[2], y[2] - y[0], y[0] - y[1]])
    c = np.stack([x[2] - x[1], x[0] - x[2], x[1] - x[0]])
    double = b[0] * c[1] - b[1] * c[0]
    total = np.zeros((mesh.triangles.shape[1], 12, 12))
    for L in ((2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6), (1 / 6, 1 / 6, 2 / 3)):
        slopes = [[4 * L[k] - 1 if m == k else 0.0 for m in range(3)] for k in range(3)]
        for p, q in ((0, 1), (1, 2), (2, 0)):
            slopes.append([4 * L[q] if m == p else 4 * L[p] if m == q else 0.0 for m in range(3)])
        S = np.array(slopes)
        dx, dy = (S @ b) / double, (S @ c) / double
        B = np.zeros((mesh.triangles.shape[1], 3, 12))
        B[:, 0, 0::2], B[:, 1, 1::2] = dx.T, dy.T
        B[:, 2, 0::2], B[:, 2, 1::2] = dy.T, dx.T
        total += np.einsum("kai,ab,kbj,k->kij", B, D, B, double / 6.0, optimize=True)
    own = np.stack([2 * mesh.triangles, 2 * mesh.triangles + 1], axis=1).reshape(12, -1).T
    rows = np.repeat(own, 12, axis=1).ravel()
    columns = np.tile(own, (1, 12)).ravel()
    size = 2 * len(mesh.nodes)
    return coo_matrix((total.ravel(), (rows, columns)), shape=(size, size)).tocsc()


def nodal(mesh: Lattice, curve: int, pressure: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Nodal forces of a traction (complex, N/m) given at points of a curve, by Gauss."""
    ring = mesh.edges[curve]
    z = mesh.nodes[ring]
    forces = np.zeros(2 * len(mesh.nodes))
    begin, end = z[0::2], np.roll(z[0::2], -1)
    length = np.abs(end - begin)
    for k in range(4):
        s = 0.5 + 0.5 * np.polynomial.legendre.leggauss(4)[0][k]
        w = 0.5 * np.polynomial.legendre.leggauss(4)[1][k]
        at = begin + s * (end - begin)
        t = pressure(at) * length * w
        for nodes, shape in (
            (ring[0::2], (1 - s) * (1 - 2 * s)),
            (ring[1::2], 4 * s * (1 - s)),
            (np.roll(ring[0::2], -1), s * (2 * s - 1)),
        ):
            np.add.at(forces, 2 * nodes, shape * t.real)
            np.add.at(forces, 2 * nodes + 1, shape * t.imag)
    return forces


def solve(matrix, forces: np.ndarray, fixed: Sequence[int]) -> np.ndarray:
    """Displacements by columns of forces, with unknowns `fixed` at zero."""
    free = np.setdiff1d(np.arange(matrix.shape[0]), np.asarray(fixed))
    found = np.zeros_like(forces)
    factors = splu(
        matrix[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
    )
    found[free] = factors.solve(forces[free])
    return found
