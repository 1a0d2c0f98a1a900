r"""Influence matrices: displacement at every place along every unit load, reciprocal by form.

A unit load j is a point force with its half-plane field s_j (:mod:`.point_load`) and what smooth
tractions p_j it is given beside it (its reaction). The rest of its field, w_j, is found by finite
elements under L_j = p_j less the tractions R_j of s_j on the body's edges. Of the displacement
along load i, the form that is stationary in both fields is

    G_ij = p_i(s_j) + p_j(s_i) + s_i(j) - R_i(s_j) + L_i K^-1 L_j,

whose error is that of the energy. Its last term is symmetric because K is; the others are by
Betti's theorem, and as far as the quadrature along the edges is exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.elements import Edges, Elements
from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.gearbox.bodies.point_load import Places, Plate, displacement, traction
from cqdd_design.geometry.contours import ComplexArray, FloatArray


@dataclass(frozen=True, eq=False)
class Loads:
    """Unit loads of a body and the smooth tractions with them.

    Attributes
    ----------
    points : Places
        Of the point forces, two for each place.
    force : complex array (N,)
        Direction of every point force.
    smooth : complex array (Q, N + B)
        Tractions at the edges' quadrature points, N/m: reactions of the point forces, then B loads
        that are smooth themselves.
    """

    points: Places
    force: ComplexArray
    smooth: ComplexArray

    def some(self, which: NDArray[np.int64]) -> tuple[Places, ComplexArray]:
        """The point forces `which`: their places and directions."""
        points = self.points
        chosen = Places(points.point[which], points.inward[which], points.void[which])
        return chosen, self.force[which]


@dataclass(frozen=True, eq=False)
class Influence:
    """What unit loads do.

    Attributes
    ----------
    matrix : array (N + B, M)
        Displacement (m/N) along every load by the loads of the columns solved.
    fields : array (unknowns, M)
        Their finite-element part on the body's edges; zero inside it.
    """

    matrix: FloatArray
    fields: FloatArray


def self_balanced(
    edges: Edges, circle: int, points: Places, force: ComplexArray, smooth: ComplexArray
) -> ComplexArray:
    """Smooth tractions of loads with their reactions on a loop: shear and normal, evenly round it.

    Parameters
    ----------
    circle : int
        Loop that takes the reactions: a circle about the origin.
    points, force
        Point forces (N,).
    smooth : complex array (Q, B)
        Loads that are smooth themselves.

    Returns
    -------
    complex array (Q, N + B)
    """
    on = edges.loop == circle
    length = edges.weight[on].sum()
    radius = length / (2.0 * np.pi)
    given = edges.weight @ smooth
    moment = edges.weight @ (np.conj(edges.point)[:, None] * smooth).imag
    total = np.concatenate([force, given])
    turning = np.concatenate([(np.conj(points.point) * force).imag, moment])
    around = 1j * edges.point / np.abs(edges.point)
    loads = np.zeros((len(edges.point), len(total)), dtype=complex)
    loads[:, len(force) :] = smooth
    loads[on] -= total / length + around[on, None] * turning / (length * radius)
    return loads


def influence(
    body: Elements,
    loops: tuple[Loop, ...],
    plate: Plate,
    loads: Loads,
    fixed: NDArray[np.int64],
    solved: NDArray[np.int64] | None = None,
    foundation: FloatArray | None = None,
) -> Influence:
    """Displacement along every load by unit loads.

    Parameters
    ----------
    body, loops, plate
        The elements and what they were made of.
    loads : Loads
        Each in balance with its reaction unless `fixed` supports the body.
    fixed : array
        Unknowns held at zero.
    solved : array (M,), optional
        Columns wanted, rising; all where left out.
    foundation : array (Q,), optional
        Springs to the ground along the edges in both directions, N/m^2.
    """
    edges = body.edges
    count, total = len(loads.force), loads.smooth.shape[1]
    columns = np.arange(total) if solved is None else solved
    sharp = columns[columns < count]
    weight = np.array([loop.weight for loop in loops])[edges.loop] * edges.weight
    field = weight[:, None] * traction(edges.point, edges.normal, loads.points, loads.force)
    springs = None
    if foundation is not None:
        on = np.flatnonzero(foundation)
        springs = edges.weight * foundation
        ground = displacement(edges.point[on], loads.points, loads.force, plate)
        field[on] += springs[on, None] * ground
    smooth = edges.weight[:, None] * loads.smooth
    given = np.flatnonzero(np.abs(smooth).max(axis=1) > 0.0)
    # p_i(s_j) for all i and the columns j, then p_j(s_i) for all i.
    of_columns = displacement(edges.point, *loads.some(sharp), plate)
    on_given = displacement(edges.point[given], loads.points, loads.force, plate)
    matrix = np.zeros((total, len(columns)))
    matrix[:count] += _work(on_given, smooth[np.ix_(given, columns)])
    matrix[:, : len(sharp)] += _work(smooth[given], of_columns[given])
    # s_i(j) - R_i(s_j)
    at_columns = displacement(loads.points.point[sharp], loads.points, loads.force, plate)
    matrix[:count, : len(sharp)] += (np.conj(loads.force[sharp])[:, None] * at_columns).real.T
    matrix[:count, : len(sharp)] -= _work(field, of_columns)
    smooth[:, :count] -= field
    # Along the edges alone there are loads, and alone there anything is read.
    rows = np.unique(edges.trace.indices)
    forces = edges.trace[:, rows].T @ np.concatenate([smooth.real, smooth.imag])
    found = body.solver(fixed, springs)(forces[:, columns], rows)
    fields = np.zeros((edges.trace.shape[1], len(columns)))
    fields[rows] = found
    return Influence(matrix + forces.T @ found, fields)


def _work(tractions: ComplexArray, displacements: ComplexArray) -> FloatArray:
    """Work of every traction on every displacement, (N, M)."""
    # Side by side, since parts of complex numbers are no operands of a fast product.
    left = np.concatenate([tractions.real, tractions.imag])
    right = np.concatenate([displacements.real, displacements.imag])
    return np.asarray(left.T @ right)
