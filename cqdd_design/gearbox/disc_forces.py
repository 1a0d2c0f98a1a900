"""Rigid-law forces on one disc, with the places where they act."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.trochoid import shortening_coefficient


@dataclass(frozen=True, eq=False)
class DiscForces:
    """Forces on one disc in the ring's frame, N, and their places, m.

    Attributes
    ----------
    ring_force, ring_normal, ring_point : arrays (..., n+1), (..., n+1, 2), (..., n+1, 2)
        The normal is the direction of the force on the disc.
    pin_force, pin_point : arrays (..., N_w), (..., N_w, 2)
    pin_direction : array (..., 2)
        Of every pin's force, against the disc's crank.
    cam_force : array (..., 2)
        Of the cam bearing, which balances the others.
    centre : array (..., 2)
        Of the disc.
    """

    ring_force: FloatArray
    ring_normal: FloatArray
    ring_point: FloatArray
    pin_force: FloatArray
    pin_point: FloatArray
    pin_direction: FloatArray
    cam_force: FloatArray
    centre: FloatArray


def disc_forces(stages: Stages, torque: float, crank_angle: ArrayLike, disc: int = 0) -> DiscForces:
    """Forces on one disc.

    Parameters
    ----------
    torque : float
        Output torque, N m, shared equally by the discs.
    crank_angle : array_like (A,) or scalar
        Of the machine, rad; a scalar leaves the leading axis A out of the result.
    disc : int
        From 0.
    """
    n, e, phase = stages.lobe_count, stages.eccentricity, float(stages.phases[disc])
    share, clocking = torque / stages.disc_count, stages.disc_clocking(phase)
    own = np.atleast_1d(np.asarray(crank_angle, dtype=float)) + phase
    along = kinematics.crank_direction(own)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    shortening = shortening_coefficient(n, stages.ring_pitch_radius, e)
    radial, tangential = rigid.ring_directions(n, shortening, own)
    normal = radial[..., None] * along[:, None] + tangential[..., None] * across[:, None]
    tooth = stages.ring_pitch_radius * kinematics.crank_direction(rigid.ring_tooth_angles(n))
    angle = kinematics.output_pin_angles(n, stages.pin_count, clocking, own)
    pin = stages.pin_circle_radius * kinematics.crank_direction(angle)
    ring_force, pin_force = stages.ring_forces(share, own), stages.pin_forces(share, own, clocking)
    on_ring = np.stack([force @ push for force, push in zip(ring_force, normal, strict=True)])
    found = DiscForces(
        ring_force=ring_force,
        ring_normal=normal,
        ring_point=tooth + stages.tooth_radius * normal,
        pin_force=pin_force,
        pin_point=pin - stages.pin_contact_radius * along[:, None],
        pin_direction=-along,
        cam_force=-(on_ring - pin_force.sum(axis=1)[:, None] * along),
        centre=e * along,
    )
    if np.ndim(crank_angle):
        return found
    return DiscForces(**{name: value[0] for name, value in vars(found).items()})
