"""Where the contacts of the nominal states stand between the places of a disc, and of the ring."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.disc import DiscShape, lobe_length
from cqdd_design.gearbox.bodies.ring import PER_TOOTH, RingShape
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.geometry.contours import ComplexArray, FloatArray


class Spots(NamedTuple):
    """Contacts of one disc (or of the ring) between its places.

    Attributes
    ----------
    near : array (..., C, 4)
        Places.
    share : array (..., C, 4)
        Of each, adding up to 1.
    normal : complex array (..., C)
        Direction of a unit force, in the frame of the body.
    """

    near: NDArray[np.int64]
    share: FloatArray
    normal: ComplexArray


def disc_spots(
    shape: DiscShape, model: ContactModel, states: NominalStates, disc_index: int
) -> Spots:
    """Contacts (A, C) of a disc in its own frame."""
    outline = shape.outline
    pitch = 2.0 * outline.half_pitch
    t = states.ring.parameter[:, disc_index]
    per_lobe, per_hole = shape.grid
    grid, length = lobe_length(outline)
    lobe = np.floor(t / pitch)
    along = np.interp(t - lobe * pitch, grid, length) / length[-1]
    lobes = outline.lobe_count
    near, share = _cubic(per_lobe * (lobe + along), per_lobe * lobes)
    own = states.crank_angle + model.phases[disc_index]
    wall = own * (1.0 + 1.0 / lobes) + np.pi
    holes = shape.holes
    turned = wall[:, None] - np.angle(holes)
    on_hole, hole_share = _cubic(per_hole * turned / (2.0 * np.pi), per_hole)
    first = per_lobe * lobes + per_hole * np.arange(len(holes))
    inward = np.broadcast_to(np.exp(1j * wall)[:, None], turned.shape)
    return Spots(
        np.concatenate([near, on_hole + first[:, None]], axis=1),
        np.concatenate([share, hole_share], axis=1),
        np.concatenate([-outline.profile(t)[1], inward], axis=1),
    )


def _cubic(place: FloatArray, count: int) -> tuple[NDArray[np.int64], FloatArray]:
    """Four places round `place` (in places, periodic by `count`) and Lagrange's weights."""
    base = np.floor(place)
    near = np.mod(base[..., None] + np.arange(-1, 3), count).astype(np.int64)
    return near, _lagrange(place - base)


def _lagrange(part: FloatArray) -> FloatArray:
    """Weights (..., 4) of values at -1, 0, 1 and 2 for one at `part`."""
    x = part[..., None]
    return np.concatenate(
        [
            -x * (x - 1.0) * (x - 2.0) / 6.0,
            (x * x - 1.0) * (x - 2.0) / 2.0,
            -x * (x + 1.0) * (x - 2.0) / 2.0,
            x * (x * x - 1.0) / 6.0,
        ],
        axis=-1,
    )


def ring_spots(shape: RingShape, states: NominalStates, disc_index: int) -> Spots:
    """Contacts (A, T) of the ring with one disc."""
    normal = -(
        states.rows[:, disc_index, : shape.tooth_count, 0]
        + 1j * states.rows[:, disc_index, : shape.tooth_count, 1]
    )
    turn = np.exp(2j * np.pi * np.arange(shape.tooth_count) / shape.tooth_count)
    angles = shape.angles
    step = angles[1] - angles[0]
    place = (np.clip(np.angle(normal / turn), angles[0], angles[-1]) - angles[0]) / step
    base = np.clip(np.floor(place), 1.0, PER_TOOTH - 3.0)
    share = _lagrange(place - base)
    first = base.astype(np.int64) + PER_TOOTH * np.arange(shape.tooth_count)
    return Spots(first[..., None] + np.arange(-1, 3), share, normal)
