"""Elastic bodies with their influence matrices: one disc, and the ring in its seat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies import point_load
from cqdd_design.gearbox.bodies.disc import Carried, DiscShape
from cqdd_design.gearbox.bodies.elements import Elements, elements
from cqdd_design.gearbox.bodies.influence import Influence, Loads, influence, self_balanced
from cqdd_design.gearbox.bodies.loops import Loop
from cqdd_design.gearbox.bodies.mesh import mesh
from cqdd_design.gearbox.bodies.one_core import one_core
from cqdd_design.gearbox.bodies.point_load import Places, Plate
from cqdd_design.gearbox.bodies.ring import RingShape
from cqdd_design.geometry.contours import FloatArray


@dataclass(frozen=True, eq=False)
class Body:
    """What unit loads do to a body.

    Attributes
    ----------
    matrix : array (L, L)
        Displacement along every load by every unit load, m/N, symmetric. Two loads for each place:
        along the normal into the material, and along that turned a quarter turn counter-clockwise.
        On a disc, outward radial loads on stations of the raceway follow. The loads of a disc are
        in balance with tractions spread evenly round its raceway.
    told_stress : array (S, L)
        :attr:`stress`, or that of the body from which it is carried.
    reciprocity : float
        Largest difference between the two halves of the matrix as they were computed, over its
        largest entry; their mean is kept. It is 1e-10 to 5e-10, of quadrature: a turn that gives
        columns from others carries the mesh into itself too. Where every place is solved, only
        pairs of one quarter of the places have both ways computed.
    carried : Carried, optional
        Which load and place of that other body each one is.
    """

    matrix: FloatArray
    told_stress: FloatArray
    reciprocity: float
    carried: Carried | None = None

    @cached_property
    def stress(self) -> FloatArray:
        """Stress (S, L) along the edge by every unit load, Pa/N.

        At `seen()` of a disc and `roots()` of a ring. Meaningless where the load itself
        stands. Found when it is asked for: the equilibrium does without.
        """
        if self.carried is None:
            return self.told_stress.astype(float)
        index, sense, place = self.carried
        return self.told_stress[np.ix_(place, index)] * sense

    def widened(self) -> Body:
        """The same in double precision, from the single one in which the cache keeps it."""
        return replace(self, matrix=self.matrix.astype(float))


def to_standard(shape: DiscShape) -> Carried:
    """Which loads and places of the standard disc those of a disc are."""
    standard, turn, mirrored = shape.standard()
    return shape.carried(standard, turn, mirrored)


def of_standard(body: Body, carried: Carried) -> Body:
    """The body of a disc from that of the standard disc of its kind, as the cache keeps it."""
    index, sense, _ = carried
    if sense.min() > 0.0 and (index == np.arange(len(index))).all():
        return body.widened()
    matrix = body.matrix.take(index, axis=0).take(index, axis=1)
    if sense.min() < 0.0:
        signs = sense.astype(matrix.dtype)
        matrix *= signs[:, None]
        matrix *= signs
    return replace(body, matrix=matrix, carried=carried).widened()


@one_core()
def disc_body(shape: DiscShape) -> Body:
    """Compute a disc.

    Raises
    ------
    GeometryError
        Where its material is too thin to mesh.
    """
    loops = shape.loops()
    made = mesh(loops, shape.side, "the disc", shape.turns)
    radius = np.abs(made.vertices[made.triangles].mean(axis=0))
    factor = np.where(radius < shape.bearing.outer, shape.ring_factor, 1.0)
    body = elements(made, loops, shape.plate, factor)
    places, seen = shape.places(), shape.seen()
    raceway = len(loops) - 1
    tents = shape.tents(body.edges.point[body.edges.loop == raceway])
    loads = self_balanced(body.edges, raceway, places, tents)
    symmetries = shape.symmetries()
    # Of the places that turns carry into each other one, and its two loads, are solved.
    columns = np.unique(np.min([one.load for one in symmetries], axis=0))
    found = influence(body, loops, shape.plate, loads, body.rigid(), columns)
    where = np.concatenate(
        [
            np.zeros(shape.grid.per_lobe * shape.outline.lobe_count, dtype=np.int64),
            1 + np.repeat(np.arange(shape.hole_count + shape.column_count), shape.grid.per_hole),
        ]
    )
    stress = _edge_stress(body, loops, seen, where, places, shape.plate, found, columns)
    total = loads.share.shape[1]
    matrix, stresses = np.empty((total, total)), np.empty((len(seen), total))
    for index, _, place in symmetries:
        matrix[np.ix_(index, index[columns])] = found.matrix
        stresses[np.ix_(place, index[columns])] = stress
    return _body(matrix, stresses)


@one_core()
def ring_body(shape: RingShape) -> Body:
    """Compute a ring in its seat.

    Raises
    ------
    GeometryError
        Where its wall is too thin to mesh.
    """
    loops = shape.loops()
    made = mesh(loops, shape.side, "the ring", shape.tooth_count)
    body = elements(made, loops, shape.plate)
    places = shape.places()
    held = np.empty(0, dtype=np.int64)
    alone = Loads(places, held, np.empty((0, 0), dtype=complex), np.empty((0, 2 * len(places))))
    columns = np.arange(2 * len(shape.angles))
    seat = np.where(body.edges.loop == 0, shape.seat, 0.0)
    found = influence(body, loops, shape.plate, alone, held, columns, seat)
    total, each = 2 * len(places), len(columns)
    matrix = np.empty((total, total))
    for tooth in range(shape.tooth_count):
        turned = (np.arange(total) + each * tooth) % total
        matrix[np.ix_(turned, turned[columns])] = found.matrix
    roots = shape.roots()
    where = np.ones(len(roots), dtype=np.int64)
    stress = _edge_stress(body, loops, roots, where, places, shape.plate, found, columns)
    stresses, shift = np.empty((len(roots), total)), len(roots) // shape.tooth_count
    for tooth in range(shape.tooth_count):
        rows = (np.arange(len(roots)) + shift * tooth) % len(roots)
        stresses[np.ix_(rows, (columns + each * tooth) % total)] = stress
    return _body(matrix, stresses)


def _body(matrix: FloatArray, stress: FloatArray) -> Body:
    error = float(np.abs(matrix - matrix.T).max() / np.abs(matrix).max())
    return Body(0.5 * (matrix + matrix.T), stress, error)


def _edge_stress(
    body: Elements,
    loops: tuple[Loop, ...],
    seen: Places,
    where: NDArray[np.int64],
    places: Places,
    plate: Plate,
    found: Influence,
    columns: NDArray[np.int64],
) -> FloatArray:
    """Stress along a free edge, E times the strain along it; (S, M), Pa/N."""
    u = np.empty(len(seen))
    for index in np.unique(where):
        own = where == index
        u[own] = loops[index].parameter(seen.point[own])
    strain = body.strain(loops, where, u)[:, body.edges.unknowns]
    stress = plate.modulus * (strain @ found.fields)
    sharp = columns[columns < 2 * len(places)]
    chosen = places.some(sharp[::2] // 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        tangential = point_load.stress(seen.point, chosen, 1j * seen.inward)
        normal = point_load.stress(seen.point, chosen, seen.inward)
    own = ~(np.isfinite(tangential) & np.isfinite(normal))
    direct = np.where(own, 0.0, tangential - plate.poisson * normal) / plate.thickness
    stress[:, : len(sharp)] += direct
    return np.asarray(stress)
