"""Compliance between the contacts of the nominal states, from the bodies' influence matrices.

Order and senses are those of :class:`.kernel_values.Contacts`: ring teeth first, then output pins;
a force is positive along the contact's normal, which pushes the disc, and so is a displacement of
the disc (at its places) or of the ring (at its own, along what pushes the ring). Compliance times
forces is therefore what elasticity takes from a contact's closing, beside its law; disc and ring
add up.

A disc's part leaves out how it moves as a whole: translation is the cam spring's (:mod:`.bore`),
and rotation is that of tractions spread evenly round the raceway, which forces in balance call up
none of.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from cqdd_design.gearbox.bodies import bore
from cqdd_design.gearbox.bodies.depths import pin_depth, ring_depths
from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.model import Body
from cqdd_design.gearbox.bodies.point_load import DEPTH, Plate
from cqdd_design.gearbox.bodies.ring import RingShape
from cqdd_design.gearbox.bodies.spots import Spots, disc_spots, ring_spots
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.disc_forces import disc_forces
from cqdd_design.geometry.contours import FloatArray

_LEAST_CAM_FORCE = 1.0
"""Below it the bearing's springs are taken at this load, N."""
_KEPT = 1_000_000
"""Numbers of a compliance without friction that is kept, at most: 8 MB."""
_LEAST_EIGENVALUE = 1e-9
"""Least eigenvalue of a compliance over its largest entry."""


@dataclass(frozen=True, eq=False)
class ElasticBodies:
    """Shapes of a gearbox's discs and ring, and what unit loads do to them."""

    discs: tuple[tuple[DiscShape, Body], ...]
    ring: tuple[RingShape, Body]

    def compliance(
        self,
        model: ContactModel,
        states: NominalStates,
        torque: float,
        tangential: FloatArray | None = None,
    ) -> FloatArray:
        """Compliance between the contacts of every disc under a torque on the carrier, N m.

        Arguments and result as :func:`compliance`; the cam forces are those of the rigid law.
        """
        if tangential is None and states.gaps.size * states.gaps.shape[-1] <= _KEPT:
            return _smooth(self, model, states, torque)
        return compliance(self, model, states, rigid_cam_force(model, states, torque), tangential)


@lru_cache(maxsize=6)
def _smooth(
    bodies: ElasticBodies, model: ContactModel, states: NominalStates, torque: float
) -> FloatArray:
    """Without friction; gearboxes that are drawn of one machine share it, part errors or not."""
    found = compliance(bodies, model, states, rigid_cam_force(model, states, torque))
    found.flags.writeable = False
    return found


def compliance(
    bodies: ElasticBodies,
    model: ContactModel,
    states: NominalStates,
    cam_force: FloatArray,
    tangential: FloatArray | None = None,
) -> FloatArray:
    """Compliance between the contacts of every disc, of disc and ring together.

    Parameters
    ----------
    bodies : ElasticBodies
    model, states
        Of the perfect gearbox; A crank angles, D discs, C contacts.
    cam_force : array (A, D, 2)
        Force of the cam on every disc, N: under which of its rolling elements the bearing carries,
        and how stiffly. :func:`rigid_cam_force` is near enough.
    tangential : array (A, D, C), optional
        Force along the tangent over the normal force, signed; the matrix is symmetric without.

    Returns
    -------
    array (A, D, C, C)
        Displacement along each contact's normal by unit normal forces, m/N.
    """
    found = []
    for index, direct in enumerate(_direct(bodies, model, states)):
        shape, body = bodies.discs[index]
        stiffness = under_disc(shape, model, states, index, cam_force[:, index])
        slip = None if tangential is None else tangential[:, index]
        smooth, rubbing = direct.held((shape, body), stiffness, slip)
        found.append(without_gain(smooth if rubbing is None else rubbing, smooth))
    return np.stack(found, axis=1)


@dataclass(frozen=True, eq=False)
class _Direct:
    """Compliance between the contacts of one disc with the bore's reactions spread evenly.

    Attributes
    ----------
    spots : Spots
        On the disc.
    pushed, rubbed : array (A, C, C)
        Displacement along a contact's normal by a unit force along the normal of another, and along
        its tangent, m/N; of the ring too where it is asked for.
    """

    spots: Spots
    pushed: FloatArray
    rubbed: FloatArray

    def held(
        self, disc: tuple[DiscShape, Body], stiffness: FloatArray, slip: FloatArray | None
    ) -> tuple[FloatArray, FloatArray | None]:
        """The same on the bearing's rolling elements, without friction and with it."""
        from cqdd_design.gearbox.bodies.compliance_kernel import add_bearing

        shape, matrix = disc[0], disc[1].matrix
        loads = len(matrix) - len(shape.stations)
        smooth, normal = self.pushed.copy(), self.spots.normal
        rubbing = np.empty((0, 0, 0)) if slip is None else smooth + self.rubbed * slip[:, None, :]
        hold: Any = add_bearing
        hold(
            self.spots.near,
            self.spots.share,
            np.ascontiguousarray(matrix[0:loads:2, loads:]),
            np.ascontiguousarray(matrix[1:loads:2, loads:]),
            np.ascontiguousarray(matrix[loads:, loads:]),
            np.stack([np.cos(shape.stations), np.sin(shape.stations)], axis=-1),
            np.ascontiguousarray(stiffness),
            np.stack([normal.real, normal.imag], axis=-1),
            np.zeros(normal.shape) if slip is None else np.ascontiguousarray(slip),
            smooth,
            rubbing,
        )
        return smooth, None if slip is None else rubbing


@lru_cache(maxsize=2)
def _direct(
    bodies: ElasticBodies, model: ContactModel, states: NominalStates
) -> tuple[_Direct, ...]:
    """Of every disc and the ring; many torques at the same angles share it."""
    found = []
    for index, (shape, body) in enumerate(bodies.discs):
        direct = _of_disc(shape, body, model, states, index)
        _add_ring(bodies.ring, model, states, index, direct.pushed, direct.rubbed)
        found.append(direct)
    return tuple(found)


def without_gain(matrix: FloatArray, plain: FloatArray) -> FloatArray:
    """A compliance whose own terms are raised until no forces draw energy out of the bodies.

    Where a law counts deeper than there is material, what is left would give energy back. Raised
    own terms are a lesser depth, by one factor at all contacts of an angle; the terms between
    contacts, and reciprocity, stay as they are.

    Parameters
    ----------
    matrix : array (A, C, C)
        With friction or without.
    plain : array (A, C, C)
        Without friction, whose energy counts.
    """
    try:
        np.linalg.cholesky(plain)
    except np.linalg.LinAlgError:
        least = np.linalg.eigvalsh(plain)[:, 0]
        floor = _LEAST_EIGENVALUE * np.abs(plain).max(axis=(1, 2))
        lift = np.clip(floor - least, 0.0, None)
        return np.asarray(matrix + lift[:, None, None] * np.eye(matrix.shape[1]))
    return matrix


def rigid_cam_force(model: ContactModel, states: NominalStates, torque: float) -> FloatArray:
    """Force (A, D, 2) of the cam on every disc by the rigid law, N; torque on the carrier, N m.

    It is in proportion to the torque, but which teeth and pins bear it hangs on the sense.
    """
    return np.asarray(abs(torque) * _unit_cam_force(model, states, math.copysign(1.0, torque)))


@lru_cache(maxsize=4)
def _unit_cam_force(model: ContactModel, states: NominalStates, torque: float) -> FloatArray:
    """By 1 N m of either sense: torques are tried by the dozen at the same angles."""
    # The rigid law's torque is that of the drive, which balances what the carrier is loaded with.
    discs = range(model.disc_count)
    found = [disc_forces(model, -torque, states.crank_angle, one).cam_force for one in discs]
    return np.stack(found, axis=1)


def under_disc(
    shape: DiscShape,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    cam_force: FloatArray,
) -> FloatArray:
    """Stiffness (A, B) of the rolling elements at the raceway's stations under a cam force."""
    own = states.crank_angle + model.phases[disc_index]
    direction = np.arctan2(cam_force[:, 1], cam_force[:, 0]) + own / model.lobe_count
    force = np.maximum(np.hypot(cam_force[:, 0], cam_force[:, 1]), _LEAST_CAM_FORCE)
    return bore.element_stiffness(model.cam, force, shape.stations, direction)


def _add_contacts(
    matrix: FloatArray,
    plate: Plate,
    spots: Spots,
    depth: FloatArray,
    pushed: FloatArray,
    rubbed: FloatArray,
) -> None:
    """Add a body's compliance, by the loads of its matrix that stand at places."""
    from cqdd_design.gearbox.bodies.compliance_kernel import add_contacts

    to_normals = matrix[0::2]
    deeper = np.log(depth / DEPTH) * 2.0 / (np.pi * plate.modulus * plate.thickness)
    fill: Any = add_contacts
    fill(
        spots.near,
        spots.share,
        np.ascontiguousarray(to_normals[:, 0::2]),
        np.ascontiguousarray(to_normals[:, 1::2]),
        deeper,
        pushed,
        rubbed,
    )


def _of_disc(
    shape: DiscShape, body: Body, model: ContactModel, states: NominalStates, disc_index: int
) -> _Direct:
    spots = disc_spots(shape, model, states, disc_index)
    depth = np.concatenate(
        [
            ring_depths(model, states.ring.equivalent_radius[:, disc_index])[1],
            np.full((len(states.crank_angle), shape.hole_count), pin_depth(model)),
        ],
        axis=1,
    )
    loads, contacts = len(body.matrix) - len(shape.stations), depth.shape[1]
    pushed, rubbed = np.zeros((2, len(depth), contacts, contacts))
    _add_contacts(body.matrix[:loads, :loads], shape.plate, spots, depth, pushed, rubbed)
    return _Direct(spots, pushed, rubbed)


def disc_compliance(
    shape: DiscShape,
    body: Body,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    stiffness: FloatArray,
    tangential: FloatArray | None = None,
) -> FloatArray:
    """Compliance between the contacts of one disc.

    Parameters
    ----------
    shape, body
        Of the disc.
    model, states
        Of the perfect gearbox.
    disc_index : int
    stiffness : array (A, B)
        Of the rolling elements under the raceway's stations, from :func:`.bore.element_stiffness`.
    tangential : array (A, C), optional
        Force along the tangent over the normal force, signed; the matrix is symmetric without.

    Returns
    -------
    array (A, C, C)
        Displacement along each contact's normal by unit normal forces, m/N.
    """
    direct = _of_disc(shape, body, model, states, disc_index)
    smooth, rubbing = direct.held((shape, body), stiffness, tangential)
    return smooth if rubbing is None else rubbing


def _add_ring(
    ring: tuple[RingShape, Body],
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    pushed: FloatArray,
    rubbed: FloatArray,
) -> None:
    """Add the ring between the teeth that a disc works on."""
    shape, body = ring
    spots = ring_spots(shape, states, disc_index)
    if shape.pockets:
        # The pocket is no contact of the law's: a pin of radius r spreads its force over it.
        depth = np.full(spots.normal.shape, shape.tooth_radius)
    else:
        depth = ring_depths(model, states.ring.equivalent_radius[:, disc_index])[0]
    _add_contacts(body.matrix, shape.plate, spots, depth, pushed, rubbed)


def ring_compliance(
    shape: RingShape,
    body: Body,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    tangential: FloatArray | None = None,
) -> FloatArray:
    """Compliance (A, T, T) of the ring between the teeth that one disc works on, m/N.

    The teeth of other discs' planes are left out: each disc has its own slice of the ring.
    """
    pushed, rubbed = np.zeros((2, len(states.crank_angle), shape.tooth_count, shape.tooth_count))
    _add_ring((shape, body), model, states, disc_index, pushed, rubbed)
    return pushed if tangential is None else pushed + rubbed * tangential[:, None, :]
