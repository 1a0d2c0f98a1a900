"""How much a disc gives under a tooth that carries: what would be in series with its contact."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox.bodies.compliance import ElasticBodies, disc_compliance, under_disc
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states

LOADED = 0.3
"""Share of the greatest tooth force of an angle from which a tooth counts as loaded."""
_FREE, _ROUND = 1e-2, 1e13
"""Stiffness of springs all round a raceway that hold it evenly, and that keep it round, N/m."""
_STEP = 4
"""Crank angles from one at which the give is taken to the next."""


@dataclass(frozen=True)
class ToothGive:
    """How much a disc gives under one unit force at a tooth that carries, m/N.

    Without what the contact law counts, without the ring, and less the rigid disc on its bearing.

    Attributes
    ----------
    mean : float
        Over discs, angles and teeth, weighed with the squares of their forces.
    least, greatest : float
        At any tooth with at least `LOADED` of the greatest force of its angle.
    """

    mean: float
    least: float
    greatest: float

    def to_dict(self) -> dict[str, float]:
        """The JSON form, nm/N."""
        return {f"{name}_nm_per_N": 1e9 * value for name, value in vars(self).items()}


def tooth_gives(
    bodies: ElasticBodies, states: NominalStates, sweeps: Sequence[ContactSweep]
) -> list[ToothGive]:
    """Give of the discs on their bearings, with the bore free, and with it held round.

    Parameters
    ----------
    bodies : ElasticBodies
    states : NominalStates
    sweeps : sequence of ContactSweep
        Equilibria at them, which tell the forces of teeth and cam.
    """
    states = nominal_states(sweeps[0].model, states.crank_angle[::_STEP])
    total, weights = np.zeros(3), 0.0
    least, greatest = np.full(3, np.inf), np.full(3, -np.inf)
    for sweep, (index, (shape, body)) in itertools.product(sweeps, enumerate(bodies.discs)):
        model, teeth = sweep.model, sweep.model.tooth_count
        force = sweep.ring_force[::_STEP, index]
        counted = force > LOADED * force.max(axis=1, keepdims=True)
        under = under_disc(shape, model, states, index, sweep.cam_force[::_STEP, index])
        weights += float(np.sum(force**2))
        for k, stiffness in enumerate((under, *(np.full_like(under, s) for s in (_FREE, _ROUND)))):
            matrix = disc_compliance(shape, body, model, states, index, stiffness)
            own = np.diagonal(matrix, axis1=1, axis2=2)[:, :teeth]
            total[k] += np.sum(own * force**2)
            least[k] = min(least[k], own[counted].min(initial=np.inf))
            greatest[k] = max(greatest[k], own[counted].max(initial=-np.inf))
    mean = total / weights
    return [ToothGive(*map(float, one)) for one in zip(mean, least, greatest, strict=True)]
