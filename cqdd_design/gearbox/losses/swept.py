"""The losses of a gearbox from contact sweeps at a few torques, with films and without."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.losses.film_work import FilmWork, lowered_friction
from cqdd_design.gearbox.losses.machine import SOURCES, FrictionMachine
from cqdd_design.gearbox.losses.model import SENSES, LossModel
from cqdd_design.geometry.contours import FloatArray

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.model import ContactModel
    from cqdd_design.gearbox.contact.rubbing import PowerSense
    from cqdd_design.gearbox.contact.solved import ContactSweep

TORQUE_SHARES = (0.0, *(10.0 ** (0.125 * k) for k in range(-24, 1)))
"""Torques of the sweeps of :func:`loss_model`, as shares of the largest: zero, then eight to a
decade over three decades. Straight lines between them are then good to 0.3 %."""
_SPARED = 0.05
"""Share up to which a sweep without an equilibrium is left out."""
SWEEP_ANGLES = 41
"""Crank angles of each of its sweeps over a period, a prime that no count of teeth or pins shares:
losses are within 0.02 % of those at 240."""
_EVERY = 6
"""Torques between those at which friction without films is solved too: its ratio to that with them
hardly changes."""


def loss_model(
    model: ContactModel,
    machine: FrictionMachine,
    peak_torque: float,
    shares: Sequence[float] = TORQUE_SHARES,
) -> LossModel:
    """Sweep a gearbox at a few torques up to its peak torque and read the friction of each.

    Parameters
    ----------
    machine : FrictionMachine
        Of the same design.
    peak_torque : float
        N m.
    shares : sequence of float
        Of the peak torque, rising: where it is swept.

    Raises
    ------
    ContactError
        When a sweep has no equilibrium, friction that jams the gearbox included. At small torques
        alone, where clearances are nearly used up, that sweep is left out.
    """
    from cqdd_design.gearbox.contact.rubbing import ContactFriction
    from cqdd_design.gearbox.contact.states import nominal_states
    from cqdd_design.gearbox.contact.sweep import contact_sweep, idle_sweep, perfect_angles

    states = nominal_states(model, perfect_angles(model, SWEEP_ANGLES))

    def solve(share: float, sense: PowerSense, speed: float) -> ContactSweep:
        friction, torque = ContactFriction.of(model, sense, speed), share * peak_torque
        if torque == 0.0:
            return idle_sweep(model, peak_torque, states, friction)
        return contact_sweep(model, torque, states=states, friction=friction)

    def swept(shares: Sequence[float], speed: float) -> dict[float, list[ContactSweep]]:
        """In both senses, by share, but for small ones without an equilibrium beside others."""
        found, unsolved = {}, None
        for share in shares:
            try:
                found[share] = [solve(share, sense, speed) for sense in SENSES]
            except ContactError as error:
                if share > _SPARED:
                    raise
                unsolved = error
        if unsolved is not None and not found:
            raise unsolved
        return found

    def lossy(solved: dict[float, list[ContactSweep]]) -> LossModel:
        driving, driven = zip(*solved.values(), strict=True)
        return LossModel.from_sweeps(machine, driving, driven)

    running = swept(shares, model.film_speed)
    found = lossy(running)
    if not any(model.by_film):
        return found
    given = list(running)
    every = _EVERY if len(given) > _EVERY else 1
    # The largest among them: small ones may have no equilibrium without films.
    resting = swept(list(dict.fromkeys([given[0], *given[1:-1:every], given[-1]])), 0.0)
    rest = lossy(resting)
    # Where nothing is solved without load the least load stands for it.
    few = ([] if 0.0 in resting else [min(resting)]) + list(resting)
    films = FilmWork(
        reference=model.film_speed,
        at_rest=_spread(found, rest),
        torque=rest.torque,
        lowered=lowered_friction(
            model, states, [running[share][0] for share in few], model.film_speed
        ),
    )
    return replace(found, film=films)


def _spread(found: LossModel, rest: LossModel) -> FloatArray:
    """Work of `rest`, which knows fewer torques, at those of `found`: by its ratio to that."""
    at = np.isin(found.torque, rest.torque)
    there = found.work[:, at]
    ratio = np.where(there > 0.0, rest.work / np.where(there > 0.0, there, 1.0), 1.0)
    # Over the logarithm of the torque, of which both have three decades; none at zero.
    logs = [np.log(one.torque[1:]) for one in (found, rest)]
    spread = np.empty_like(found.work)
    for sense in range(len(SENSES)):
        spread[sense, 0] = rest.work[sense, 0]
        for column in range(len(SOURCES)):
            along = np.interp(logs[0], logs[1], ratio[sense, 1:, column])
            spread[sense, 1:, column] = along * found.work[sense, 1:, column]
    return spread
