"""A gearbox of one disc whose output pins are of no interest, under the rigid law."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox.disc_forces import DiscForces, disc_forces
from cqdd_design.gearbox.stages import Stages


def lone_disc(n: int, R: float, e: float, r: float, torque: float, angle: ArrayLike) -> DiscForces:
    """Forces on one disc of n lobes at crank angles (A,); lengths in m, torque in N m."""
    stages = Stages(
        lobe_count=n,
        disc_count=1,
        pin_count=4,
        ring_pitch_radius=R,
        eccentricity=e,
        tooth_radius=r,
        pin_circle_radius=0.6 * R,
        hole_clocking=0.0,
        pin_contact_radius=2e-3,
        hole_radius=2e-3 + e,
        contact_length=8e-3,
        ring_modulus=112e9,
        pin_modulus=112e9,
    )
    return disc_forces(stages, torque, np.asarray(angle, dtype=float))
