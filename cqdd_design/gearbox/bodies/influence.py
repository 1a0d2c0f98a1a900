r"""Influence matrices: displacement at every place along every unit load, reciprocal by form.

A unit load j is a point force with its half-plane field s_j (:mod:`.point_load`) and what smooth
tractions p_j it is given beside it (its reaction). The rest of its field, w_j, is found by finite
elements under L_j = p_j less the tractions R_j of s_j on the body's edges. Of the displacement
along load i, the form that is stationary in both fields is

    G_ij = p_i(s_j) + p_j(s_i) + s_i(j) - R_i(s_j) + L_i K^-1 L_j,

whose error is that of the energy. Its last term is symmetric because K is, and the first two are
one sum; s_i(j) - R_i(s_j) is by Betti's theorem, as far as the quadrature along the edges is exact.
By the rules below that is to 1e-10 to 5e-10 of the largest entry: sides end wherever a traction or
its slope jumps, and beside a place the logarithm in s_j is integrated as what it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.edge_tractions import EdgeTractions
from cqdd_design.gearbox.bodies.elements import EDGE_POINTS, Edges, Elements, side_points
from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.gearbox.bodies.point_load import (
    Places,
    Plate,
    displacement,
    displacement_of,
)
from cqdd_design.geometry.contours import ComplexArray, FloatArray, gauss_rule

_GRADED = 3
"""Power by which points of quadrature crowd towards a point load on a side or beside it."""
_GRADED_POINTS = 24
_BLOCKS = 8
"""In so many the point loads are taken. Where all are solved, what two blocks do to each other is
found once, and the other way is that by reciprocity; 1 finds both."""
_NEAR = 1.0
"""Distance of a point load from a side, over its length, up to which they do."""


@dataclass(frozen=True, eq=False)
class Loads:
    """Unit loads of a body and the smooth tractions with them.

    Attributes
    ----------
    places : Places
        N of them, of two point forces each.
    where : array (R,)
        The edges' quadrature points where there are any smooth tractions.
    smooth : complex array (R, K)
        They, of a few kinds, N/m.
    share : array (K, 2 N + B)
        How much of each kind is with each load: with the point forces their reactions, and B loads
        that are smooth themselves.
    with_reactions : bool
        Whether the first three kinds are what balances each load, along x, along y and round.
    """

    places: Places
    where: NDArray[np.int64]
    smooth: ComplexArray
    share: FloatArray
    with_reactions: bool = False


@dataclass(frozen=True, eq=False)
class Influence:
    """What unit loads do.

    Attributes
    ----------
    matrix : array (2 N + B, M)
        Displacement (m/N) along every load by the loads of the columns solved.
    fields : array (U, M)
        Their finite-element part, at the unknowns along the body's edges, m/N.
    """

    matrix: FloatArray
    fields: FloatArray


def self_balanced(edges: Edges, circle: int, places: Places, smooth: ComplexArray) -> Loads:
    """Loads with their reactions on a loop: shear and normal, evenly round it.

    Parameters
    ----------
    circle : int
        Loop that takes the reactions: a circle about the origin.
    places : Places
        Of point forces.
    smooth : complex array (R, B)
        Loads along that loop that are smooth themselves.
    """
    on = np.flatnonzero(edges.loop == circle)
    point, weight = edges.point[on], edges.weight[on]
    length = weight.sum()
    radius = length / (2.0 * np.pi)
    around = 1j * point / np.abs(point)
    even = np.ones(len(on)) / length
    kinds = np.stack([-even, -1j * even, -around / (length * radius)], axis=1)
    force = np.concatenate([places.directions, weight @ smooth])
    moment = np.concatenate(
        [
            (np.conj(np.repeat(places.point, 2)) * places.directions).imag,
            weight @ (np.conj(point)[:, None] * smooth).imag,
        ]
    )
    own = np.eye(smooth.shape[1], len(force), len(force) - smooth.shape[1])
    share = np.concatenate([[force.real, force.imag, moment], own])
    return Loads(places, on, np.concatenate([kinds, smooth], axis=1), share, with_reactions=True)


def influence(
    body: Elements,
    loops: tuple[Loop, ...],
    plate: Plate,
    loads: Loads,
    held: NDArray[np.int64],
    solved: NDArray[np.int64] | None = None,
    foundation: FloatArray | None = None,
) -> Influence:
    """Displacement along every load by unit loads.

    Parameters
    ----------
    body, loops, plate
        The elements and what they were made of.
    loads : Loads
        Each in balance with its reaction unless `held` supports the body.
    held : array
        Unknowns held at zero.
    solved : array (M,), optional
        Columns wanted, rising, of a place both or none; all where left out.
    foundation : array (Q,), optional
        Springs to the ground along the edges in both directions, N/m^2.
    """
    edges, places = body.edges, loads.places
    count, total = 2 * len(places), loads.share.shape[1]
    columns = np.arange(total) if solved is None else solved
    sharp = columns[: np.searchsorted(columns, count)]
    chosen = places.some(sharp[::2] // 2)
    # R_i with its sign, per length; then L_j as nodal forces.
    counted = -np.array([loop.weight for loop in loops])[edges.loop]
    left = EdgeTractions.of(
        edges.point, counted * edges.normal, edges.loop, places, plate, foundation
    )
    springs = None if foundation is None else edges.weight * foundation
    weight = np.tile(edges.weight, 2)
    weighed = edges.trace[:, edges.unknowns].multiply(weight[:, None]).tocsr()
    where = np.concatenate([loads.where, loads.where + len(edges.point)])
    smooth = np.concatenate([loads.smooth.real, loads.smooth.imag])
    shares = loads.share
    if loads.with_reactions:
        motions = body.rigid_motions()[edges.unknowns]
        moving = weighed @ motions
        sharp_work = np.pad(left.work(moving, 0, count).T, ((0, 0), (0, total - count)))
        shares = _evened(shares, moving[where].T @ smooth, sharp_work)
    share = shares[:, columns]
    forces = (weighed[where].T @ smooth) @ share
    left.add_forces(forces[:, : len(sharp)], weighed, sharp)
    # L_i (s_j + w_j)
    found = body.factors(held, springs).solve(forces, edges.unknowns)
    if loads.with_reactions:
        # How it turns as a whole hangs on what is held, and quadratic sides read a strain in it.
        for part in np.array_split(found, _BLOCKS, axis=1):
            part -= motions @ np.linalg.solve(motions.T @ motions, motions.T @ part)
    # Some places at a time: what all of them do at all edges would fill memory, not cache.
    blocks = list(pairwise((2 * np.linspace(0, len(chosen), _BLOCKS + 1).astype(int)).tolist()))
    matrix = np.empty((total, len(columns)))
    for begin, end in blocks:
        stop = len(columns) if end == len(sharp) else end
        moved = weighed @ found[:, begin:stop]
        some = chosen.some(np.arange(begin // 2, end // 2))
        moved[:, : end - begin] += _integrated(body, loops, some, plate)
        matrix[:, begin:stop] = shares.T @ (smooth.T @ moved[where])
        rows = end if len(sharp) == count else count
        matrix[:rows, begin:stop] += left.work(moved, 0, rows)
        matrix[rows:count, end:stop] += left.work(moved[:, end - begin :], rows, count)
    # p_j(s_i)
    met = displacement(edges.point[loads.where], places, plate).reshape(len(where), count)
    matrix[:count] += ((weight[where, None] * smooth).T @ met).T @ share
    # s_i(j)
    x, y = displacement(chosen.point, places, plate).repeat(2, axis=1)
    along = chosen.directions
    matrix[:count, : len(sharp)] += x.T * along.real + y.T * along.imag
    if len(sharp) == count:
        for begin, end in blocks:
            matrix[end:count, begin:end] = matrix[begin:end, end:count].T
    return Influence(matrix, found)


def _evened(share: FloatArray, work: FloatArray, left: FloatArray) -> FloatArray:
    """Shares with reactions, the first three kinds, for which finite elements find no moment left.

    Quadratic sides miss 1e-6 of it. Held unknowns would take that up, and they stand anywhere,
    where a turn that carries the mesh into itself does not carry them.

    Parameters
    ----------
    share : array (K, L)
    work : array (3, K)
        Of each kind on motions of the body as a whole.
    left : array (3, L)
        Of all else that a load has.
    """
    evened = share.copy()
    evened[:3] -= np.linalg.solve(work[:, :3], work @ share + left)
    return evened


def _integrated(
    body: Elements, loops: tuple[Loop, ...], places: Places, plate: Plate
) -> FloatArray:
    """Displacements by the loads of places at the edges' points, times these' weights.

    On sides that end at a place or near one, where the field has a logarithm, weights are those
    that integrate it right with whatever is smooth: by a graded rule, with polynomials through the
    side's points for the other factor.

    Returns
    -------
    array (2 Q, 2 N)
    """
    edges = body.edges
    total = displacement(edges.point, places, plate)
    total *= edges.weight[:, None]
    nodes = np.concatenate(body.nodes, axis=1)
    begin, end, middle = body.place[nodes]
    length = np.abs(middle - begin) + np.abs(end - middle)
    apart = np.abs(places.point[:, None, None] - np.stack([begin, end, middle])).min(axis=1)
    count = np.array([len(u) - 1 for u in body.sides])
    loaded = np.repeat([one.loaded for one in loops], count)
    place, side = np.nonzero((apart < _NEAR * length) & loaded)
    chord = (end - begin)[side]
    nearest = ((places.point[place] - begin[side]) * np.conj(chord)).real / np.abs(chord) ** 2
    nearest = np.clip(nearest, 0.0, 1.0)[:, None]
    fine, weight = gauss_rule(_GRADED_POINTS)
    crowded, share = fine**_GRADED, weight * _GRADED * fine ** (_GRADED - 1)
    part = np.concatenate([nearest * (1.0 - crowded), nearest + (1.0 - nearest) * crowded], axis=1)
    share = np.concatenate([nearest * share, (1.0 - nearest) * share], axis=1)
    first = np.concatenate([u[:-1] for u in body.sides])[side, None]
    step = np.concatenate([np.diff(u) for u in body.sides])[side, None]
    loop = np.repeat(np.arange(len(loops)), count)[side]
    z, speed = np.empty(part.shape, dtype=complex), np.empty(part.shape)
    for index in np.unique(loop):
        own = loop == index
        z[own], slope = loops[index].curve((first + part * step)[own])
        speed[own] = np.abs(slope) * step[own]
    at, _ = gauss_rule(EDGE_POINTS)
    each = np.repeat([side_points(one) for one in loops], count)
    rows = (np.cumsum(each) - each)[side, None] + np.arange(EDGE_POINTS)
    total = total.reshape(2, len(edges.point), len(places), 2)
    shapes = np.stack([_through(at, k, part) for k in range(EDGE_POINTS)], axis=1)
    fields = displacement_of(place[:, None], z.ravel(), places, plate)
    # (2, near, EDGE_POINTS, 2)
    found = np.matmul(shapes * (share * speed)[:, None], fields.reshape(2, *z.shape, 2))
    for k in range(2):
        total[:, rows, place[:, None], k] = found[..., k]
    return total.reshape(2 * len(edges.point), 2 * len(places))


def _through(points: FloatArray, which: int, at: FloatArray) -> FloatArray:
    """Lagrange's polynomial that is 1 at one of the points and 0 at the others."""
    others = np.delete(points, which)
    return np.asarray(np.prod((at[..., None] - others) / (points[which] - others), axis=-1))
