"""Stress along the edges of disc and ring under contact forces, away from the contacts.

An edge without load has one stress in the plane, along itself; its size is the greatest principal
stress and von Mises' too. Near a contact the stress is the contact's, which its pressure judges:
places within a few steps of the grid of a loaded contact are left out.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from cqdd_design.gearbox.bodies import bore
from cqdd_design.gearbox.bodies.compliance import under_disc
from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.model import Body
from cqdd_design.gearbox.bodies.point_load import Places
from cqdd_design.gearbox.bodies.ring import RingShape
from cqdd_design.gearbox.bodies.spots import Spots, disc_spots, ring_spots
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.geometry.contours import FloatArray

Region = Literal[
    "hole to profile",
    "hole to hole",
    "hole to bore",
    "column to profile",
    "column to hole",
    "column to bore",
    "root",
    "ring",
]
"""Of a disc by the nearest edge across the material, its lobes (root); the ring's teeth.

Where columns pass through a disc, ``column to hole`` is what stands between a column's hole and an
output pin's, on either edge of it.
"""

_BETWEEN: dict[bool, Region] = {False: "hole to hole", True: "column to hole"}
"""What parts an output pin's hole from the next, and from a column's that stands between."""
_THERE = 1e-6
"""Distance over the holes' circle within which a column's hole stands where one is looked for."""
_STEPS, _BESIDE = 2.5, 0.5
"""Steps of the grid round a loaded contact in which stress is the contact's."""


def disc_stress(
    shape: DiscShape,
    body: Body,
    model: ContactModel,
    states: NominalStates,
    disc_index: int,
    forces: FloatArray,
    cam_force: FloatArray,
    tangential: FloatArray | None = None,
) -> FloatArray:
    """Stress along the edges of a disc.

    Parameters
    ----------
    shape, body
        Of the disc.
    model, states
        Of the perfect gearbox.
    disc_index : int
    forces : array (A, C)
        Normal forces of its contacts, ring teeth first, N.
    cam_force : array (A, 2)
        Of the cam on it, N; says under which rolling elements the bearing carries.
    tangential : array (A, C), optional
        Forces along the tangents over the normal forces, signed.

    Returns
    -------
    array (A, S)
        Pa, tension positive, at the places of `shape.seen()`; nan near a loaded contact, but not
        round the holes for columns: they have none, and a contact across a ligament bends it.
    """
    spots = disc_spots(shape, model, states, disc_index)
    loads = _loads(spots, forces, tangential, len(body.matrix))
    count = len(shape.stations)
    first = len(body.matrix) - count
    radial = np.stack([np.cos(shape.stations), np.sin(shape.stations)], axis=-1)
    push = spots.normal * (1.0 + 1j * (0.0 if tangential is None else tangential))
    total = np.sum(forces * push, axis=1)
    direction = np.stack([total.real, total.imag], axis=-1)[:, None]
    onto = (loads @ body.matrix[:, first:])[:, None]
    stiffness = under_disc(shape, model, states, disc_index, cam_force)
    found = bore.reactions(onto, body.matrix[first:, first:], direction, radial, stiffness)
    loads[:, first:] = found.stations[..., 0]
    steps = np.full(spots.normal.shape, 2.0 * np.pi * shape.hole_radius / shape.grid.per_hole)
    lobe = 2.0 * np.pi / shape.outline.lobe_count * shape.outline.tip_distance
    steps[:, : model.tooth_count] = lobe / shape.grid.per_lobe
    stress, places = loads @ body.stress.T, shape.places()
    _clear(stress[:, : len(places)], places, places, spots, forces, steps)
    return stress


def disc_regions(shape: DiscShape) -> list[Region]:
    """What part of a disc each place belongs to: by the nearest edge across the material."""
    found: list[Region] = ["root"] * (shape.grid.per_lobe * shape.outline.lobe_count)
    count, half_pitch = shape.grid.per_hole, np.exp(1j * np.pi / shape.hole_count)
    for hole in shape.holes:
        beside = [
            bool((np.abs(shape.columns - at) < _THERE * shape.hole_circle).any())
            for at in (hole * half_pitch, hole / half_pitch)
        ]
        after, before = (_BETWEEN[one] for one in beside)
        found += _wall(count, "hole to profile", after, "hole to bore", before)
    across = _BETWEEN[True]
    column = _wall(count, "column to profile", across, "column to bore", across)
    return found + column * shape.column_count


def _wall(count: int, profile: Region, after: Region, bore: Region, before: Region) -> list[Region]:
    """Regions of a hole's places, from the direction outward, with the next and the one before."""
    angles = np.angle(np.exp(2j * np.pi * np.arange(count) / count))
    return [
        profile
        if abs(a) < 0.25 * np.pi
        else bore
        if abs(a) > 0.75 * np.pi
        else after
        if a > 0.0
        else before
        for a in angles
    ]


def ring_stress(
    shape: RingShape,
    body: Body,
    states: NominalStates,
    disc_index: int,
    forces: FloatArray,
    tangential: FloatArray | None = None,
) -> FloatArray:
    """Stress (A, S) along the toothed contour at `shape.roots()` under forces (A, T) of a disc.

    Parameters and result as those of :func:`disc_stress`.
    """
    spots = ring_spots(shape, states, disc_index)
    loads = _loads(spots, forces, tangential, len(body.matrix))
    step = np.full(spots.normal.shape, shape.tooth_radius * (shape.angles[1] - shape.angles[0]))
    # The contour's own places stand wider than the teeth's.
    step = np.maximum(step, 0.25 * shape.tooth_radius)
    return _clear(loads @ body.stress.T, shape.roots(), shape.places(), spots, forces, step)


def _loads(
    spots: Spots, forces: FloatArray, tangential: FloatArray | None, count: int
) -> FloatArray:
    """Unit loads (A, L) that stand for the forces at the contacts."""
    loads = np.zeros((len(forces), count))
    angle = np.broadcast_to(np.arange(len(forces))[:, None, None], spots.near.shape)
    shared = spots.share * forces[..., None]
    np.add.at(loads, (angle, 2 * spots.near), shared)
    if tangential is not None:
        np.add.at(loads, (angle, 2 * spots.near + 1), shared * tangential[..., None])
    return loads


def _clear(
    stress: FloatArray,
    seen: Places,
    loaded: Places,
    spots: Spots,
    forces: FloatArray,
    steps: FloatArray,
) -> FloatArray:
    """The same with nan where a loaded contact is near, or a place that stands for one.

    Four places stand for a contact, at the end of a tooth one three steps from it, and beside a
    unit load stress has no bound.
    """
    stands = loaded.point[spots.near]
    contact = np.sum(spots.share * stands, axis=-1)
    for k in range(contact.shape[1]):
        step = steps[:, k, None]
        near = np.abs(seen.point - contact[:, k, None]) < _STEPS * step
        for one in range(stands.shape[-1]):
            beside = np.abs(seen.point - stands[:, k, one, None]) < _BESIDE * step
            near |= beside & (spots.share[:, k, one, None] != 0.0)
        stress[near & (forces[:, k, None] > 0.0)] = np.nan
    return stress
