"""Plain numpy twins of the compliance kernels: a disc on its rolling elements, a ring."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.bodies import bore
from cqdd_design.gearbox.bodies.bore import Reactions
from cqdd_design.gearbox.bodies.depths import pin_depth, ring_depths
from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.model import Body
from cqdd_design.gearbox.bodies.point_load import DEPTH, Plate
from cqdd_design.gearbox.bodies.ring import RingShape
from cqdd_design.gearbox.bodies.spots import Spots, disc_spots, ring_spots
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates


def held(
    contacts: np.ndarray,
    to_stations: np.ndarray,
    read: np.ndarray,
    load: np.ndarray,
    radial: np.ndarray,
    stiffness: np.ndarray,
    found: Reactions,
) -> np.ndarray:
    """Compliance (..., C, C) between loads of a disc on its elements, less that of a rigid disc.

    `contacts` (..., C, C) and `to_stations` (..., C, B) have their reactions spread evenly round
    the raceway; displacements are read along `read` (..., C, 2), unit loads act along `load`.
    """
    elastic = contacts + to_stations @ found.stations + read @ found.drift
    seat = np.swapaxes(radial, -1, -2) @ (stiffness[..., None] * radial)
    return elastic - read @ np.linalg.solve(seat, np.swapaxes(load, -1, -2))


def plain_disc_compliance(
    shape: DiscShape,
    body: Body,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    stiffness: np.ndarray,
    slip: np.ndarray,
) -> np.ndarray:
    """Twin of :func:`.compliance.disc_compliance`, by the bore's own solution of its stations."""
    matrix, spots = body.matrix, disc_spots(shape, model, states, disc_index)
    near, share = spots.near, spots.share
    depth = np.concatenate(
        [
            ring_depths(model, states.ring.equivalent_radius[:, disc_index])[1],
            np.full((len(states.crank_angle), shape.hole_count), pin_depth(model)),
        ],
        axis=1,
    )
    loads = len(matrix) - len(shape.stations)
    contacts = _between(matrix[:loads, :loads], shape.plate, spots, depth, slip)
    normal, shear = matrix[0:loads:2, loads:], matrix[1:loads:2, loads:]
    reading = np.einsum("ackb,ack->acb", normal[near], share)
    acting = reading + slip[..., None] * np.einsum("ackb,ack->acb", shear[near], share)
    pushed = spots.normal * (1.0 + 1j * slip)
    radial = np.stack([np.cos(shape.stations), np.sin(shape.stations)], axis=-1)
    load = np.stack([pushed.real, pushed.imag], axis=-1)
    read = np.stack([spots.normal.real, spots.normal.imag], axis=-1)
    found = bore.reactions(acting, matrix[loads:, loads:], load, radial, stiffness)
    return held(contacts, reading, read, load, radial, stiffness, found)


def plain_ring_compliance(
    shape: RingShape,
    body: Body,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    slip: np.ndarray,
) -> np.ndarray:
    """Twin of :func:`.compliance.ring_compliance` for a ring without pockets."""
    spots = ring_spots(shape, states, disc_index)
    depth = ring_depths(model, states.ring.equivalent_radius[:, disc_index])[0]
    return _between(body.matrix, shape.plate, spots, depth, slip)


def _between(
    matrix: np.ndarray, plate: Plate, spots: Spots, depth: np.ndarray, slip: np.ndarray
) -> np.ndarray:
    normal, shear = matrix[0::2, 0::2], matrix[0::2, 1::2]
    rows, columns = spots.near[:, :, None, :, None], spots.near[:, None, :, None, :]
    weights = np.einsum("aik,ajm->aijkm", spots.share, spots.share)
    path = np.sum(normal[rows, columns] * weights, axis=(3, 4))
    path += np.sum(shear[rows, columns] * weights, axis=(3, 4)) * slip[:, None, :]
    own = np.sum(np.diag(normal)[spots.near] * spots.share, axis=2)
    own += slip * np.sum(np.diag(shear)[spots.near] * spots.share, axis=2)
    own -= np.log(depth / DEPTH) * 2.0 / (np.pi * plate.modulus * plate.thickness)
    each = np.arange(own.shape[1])
    path[:, each, each] = own
    return path
