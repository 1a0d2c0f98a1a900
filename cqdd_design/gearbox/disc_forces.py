"""Rigid-law forces on one disc at one crank angle, with the places where they act."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry.contours import FloatArray


@dataclass(frozen=True, eq=False)
class DiscForces:
    """Forces on one disc in the ring's frame, N, and their places, m.

    Attributes
    ----------
    ring_force, ring_normal, ring_point : arrays (n+1,), (n+1, 2), (n+1, 2)
    pin_force, pin_point : arrays (N_w,), (N_w, 2)
    pin_direction : array (2,)
        Of every pin's force.
    cam_force : array (2,)
        Of the cam bearing, which balances the others.
    centre : array (2,)
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


def disc_forces(stages: Stages, torque: float, crank_angle: float, disc: int = 0) -> DiscForces:
    """Forces on one disc.

    Parameters
    ----------
    torque : float
        Output torque, N m, shared equally by the discs.
    crank_angle : float
        Of the machine, rad.
    disc : int
        From 0.
    """
    share, phase = torque / stages.disc_count, float(stages.phases[disc])
    own = np.array([crank_angle + phase])
    ring = rigid.ring_stage(
        stages.lobe_count,
        stages.ring_pitch_radius,
        stages.eccentricity,
        stages.tooth_radius,
        share,
        own,
    )
    pins = rigid.output_stage(
        stages.lobe_count,
        stages.pin_count,
        stages.pin_circle_radius,
        stages.pin_contact_radius,
        share,
        own,
        stages.disc_clocking(phase),
    )
    direction = pins.normal[0]
    return DiscForces(
        ring_force=ring.force[0],
        ring_normal=ring.normal[0],
        ring_point=ring.point[0],
        pin_force=pins.force[0],
        pin_point=pins.point[0],
        pin_direction=direction,
        cam_force=-(ring.force[0] @ ring.normal[0] + pins.force[0].sum() * direction),
        centre=-stages.eccentricity * direction,
    )
