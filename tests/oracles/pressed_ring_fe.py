"""An eccentric ring on a round core by finite elements: nothing of the series of the package."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, FacetBasis, MeshQuad
from skfem.helpers import ddot, eye, sym_grad, trace


def _polar(rows, around, place):
    angles = 2.0 * np.pi * np.arange(around) / around
    points = np.concatenate([place(share, angles) for share in np.linspace(0.0, 1.0, rows + 1)], 1)
    cells = [
        [i * around + j, (i + 1) * around + j, (i + 1) * around + (j + 1) % around,
         i * around + (j + 1) % around]
        for i in range(rows)
        for j in range(around)
    ]  # fmt: skip
    return MeshQuad(points, np.array(cells).T)


def pressed_ring_fe(core, outside, throw, interference, modulus, ratio, rows=20, around=120):
    """Greatest von Mises stress at the bore, Pa, and growth of the outside's diameter, m."""
    shear = 0.5 * modulus / (1.0 + ratio)
    lame = modulus * ratio / (1.0 - ratio**2)

    def stress(strain):
        return 2.0 * shear * strain + lame * eye(trace(strain), 2)

    @BilinearForm
    def stiffness(u, v, _):
        return ddot(stress(sym_grad(u)), sym_grad(v))

    def ring_place(share, at):
        x = (1.0 - share) * core * np.cos(at) + share * (throw + outside * np.cos(at))
        return np.array([x, ((1.0 - share) * core + share * outside) * np.sin(at)])

    def core_place(share, at):
        return (0.01 + 0.99 * share) * core * np.array([np.cos(at), np.sin(at)])

    meshes = [_polar(rows, around, ring_place), _polar(rows, around, core_place)]
    bases = [Basis(mesh, ElementVector(ElementQuad2()), intorder=4) for mesh in meshes]
    whole = sp.block_diag([stiffness.assemble(one) for one in bases]).tocsr()
    sag = 1.5 * core * (1.0 - np.cos(np.pi / around))
    joint: list[dict[tuple[int, int], list[int]]] = []
    for basis in bases:
        found: dict[tuple[int, int], list[int]] = {}
        for k in np.flatnonzero(np.abs(np.hypot(*basis.doflocs) - core) < sag):
            key = tuple(np.round(basis.doflocs[:, k] * 1e7).astype(int))
            found.setdefault(key, []).append(int(k))
        joint.append(found)
    assert joint[0].keys() == joint[1].keys()
    shift = bases[0].N
    entries = []
    for row, key in enumerate(joint[0]):
        normal = np.array(key) / np.hypot(*key)
        for axis in range(2):
            entries.append((row, sorted(joint[0][key])[axis], normal[axis]))
            entries.append((row, shift + sorted(joint[1][key])[axis], -normal[axis]))
    rows_at, columns, values = zip(*entries, strict=True)
    tied = sp.csr_matrix((values, (rows_at, columns)), shape=(len(joint[0]), whole.shape[0]))
    # Soft springs, a thousand millionth of the bodies, keep them from turning freely.
    soft = whole + 1e-9 * whole.diagonal().mean() * sp.eye(whole.shape[0])
    system = sp.bmat([[soft, tied.T], [tied, None]]).tocsc()
    asked = np.concatenate([np.zeros(whole.shape[0]), np.full(len(joint[0]), 0.5 * interference)])
    moved = spsolve(system, asked)[:shift]

    def edge(inside):
        def there(x):
            off = np.hypot(*x) if inside else np.hypot(x[0] - throw, x[1])
            return np.abs(off - (core if inside else outside)) < 2.0 * sag

        facets = meshes[0].facets_satisfying(there, boundaries_only=True)
        return FacetBasis(meshes[0], ElementVector(ElementQuad2()), facets=facets, intorder=3)

    slope = edge(inside=True).interpolate(moved).grad
    strain = 0.5 * (slope + slope.swapaxes(0, 1))
    volume = strain[0, 0] + strain[1, 1]
    xx, yy = (2.0 * shear * strain[i, i] + lame * volume for i in range(2))
    xy = 2.0 * shear * strain[0, 1]
    mises = np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2)
    out = edge(inside=False)
    at = out.global_coordinates()
    angle = np.arctan2(at[1], at[0] - throw)
    shifted = out.interpolate(moved)
    outward = shifted[0] * np.cos(angle) + shifted[1] * np.sin(angle)
    # Of each facet the mean, which evens out what chords do to stresses beside their corners.
    return float(mises.mean(axis=1).max()), 2.0 * float(outward.mean())
