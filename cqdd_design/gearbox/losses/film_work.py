"""How the work of friction changes with speed where films lower it.

Forces depend on friction and friction on films: exact work is had from equilibria at one speed,
that of the requirements, and at rest. Between them and beyond it goes the way that the coefficients
go under the forces of the first: the work W of a source is ``W_rest + s (W - W_rest)`` with s the
share of the way from the coefficient at rest to that at the speed, 0 and 1 at both ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cqdd_design.gearbox.losses.machine import SOURCES
from cqdd_design.geometry.contours import FloatArray

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.model import ContactModel
    from cqdd_design.gearbox.contact.solved import ContactSweep
    from cqdd_design.gearbox.contact.states import NominalStates

SPEED_SHARES = (0.0, 0.003, 0.01, 0.03, 0.1, 0.2, 0.35, 0.6, 1.0, 1.5, 2.5, 5.0)
"""Speeds of the table, of that of the equilibria; films grow no more beyond the last."""
_POWER = 0.7
"""Of speed in the thickness of a film: over it the shares lie nearly on lines."""


@dataclass(frozen=True, eq=False)
class FilmWork:
    """Work of friction at rest, and the way to that of films.

    Attributes
    ----------
    reference : float
        Speed of the crank at which the work with films is exact, rad/s.
    at_rest : array (2, K, 6)
        Work per radian of crank without films, as :attr:`.LossModel.work` has that with them, N m.
    torque : array (M,)
        N m, rising.
    lowered : array (M, S, 2)
        Share of the way from friction at rest to that at `reference`, of teeth and of pins, over
        :data:`SPEED_SHARES`.
    """

    reference: float
    at_rest: FloatArray
    torque: FloatArray
    lowered: FloatArray

    def share(self, torque: ArrayLike, crank_speed: ArrayLike) -> FloatArray:
        """Shares of the way at torques and speeds (rad/s), both (...), by source, (..., 6)."""
        size, turning = np.broadcast_arrays(np.abs(torque), np.abs(crank_speed))
        grid = np.array(SPEED_SHARES) ** _POWER
        low, up = _between(grid, (turning / self.reference) ** _POWER)
        below, over = _between(self.torque, size)
        up, over = up[..., None], over[..., None]

        def along(row: NDArray[np.int64]) -> FloatArray:
            steps = self.lowered[row, low], self.lowered[row, low + 1]
            return np.asarray((1.0 - up) * steps[0] + up * steps[1])

        pair = (1.0 - over) * along(below) + over * along(below + 1)
        teeth, pins = pair[..., 0], pair[..., 1]
        both = 0.5 * (teeth + pins)
        named = {"ring_teeth": teeth, "output_pins": pins}
        return np.stack([named.get(source, both) for source in SOURCES], axis=-1)


def _between(grid: FloatArray, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
    """The step of a rising grid in which values lie, and how far along it; at an end beyond it."""
    step = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, len(grid) - 2)
    along = (values - grid[step]) / (grid[step + 1] - grid[step])
    return step, np.clip(along, 0.0, 1.0)


def lowered_friction(
    model: ContactModel, states: NominalStates, sweeps: Sequence[ContactSweep], reference: float
) -> FloatArray:
    """The shares (M, S, 2) of :class:`FilmWork` under the forces of sweeps of the model.

    A sweep that loads nothing has those of the next.
    """
    from cqdd_design.gearbox.contact.rubbing import ContactFriction, slip

    teeth, path = model.tooth_count, np.abs(slip(model, states))
    bare = (model.tooth_friction, model.hole_friction)
    found = np.ones((len(sweeps), len(SPEED_SHARES), 2))
    for m, sweep in enumerate(sweeps):
        force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
        weight = force * path
        parts = (np.s_[..., :teeth], np.s_[..., teeth:])
        drop = np.zeros((len(SPEED_SHARES), 2))
        for s, share in enumerate(SPEED_SHARES):
            some = ContactFriction("drive", *bare, share * reference)
            felt = some.under(model, states, force).felt
            for k, part in enumerate(parts):
                total = float(weight[part].sum())
                if felt is not None and total > 0.0:
                    mean = float((felt.coefficient[part] * weight[part]).sum()) / total
                    drop[s, k] = bare[k] - mean
        whole = drop[SPEED_SHARES.index(1.0)]
        found[m] = np.where(whole > 0.0, drop / np.where(whole > 0.0, whole, 1.0), 1.0)
    for m in range(len(sweeps) - 2, -1, -1):
        if not np.any(sweeps[m].ring_force > 0.0):
            found[m] = found[m + 1]
    return found
