"""Temperatures over a cycle of heat that comes again and again, once they have settled to it."""

from __future__ import annotations

import numpy as np

from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.network import Heat, ThermalNetwork, modes_of
from cqdd_design.geometry.contours import FloatArray

_ROUNDS, _STILL = 200, 1e-6
"""Of the search for the temperatures that repeat, and K by which they may still move."""
_WHOLE, _DAMPED = 3, 0.5
"""Rounds that follow the mean at once, and the share of its move in those after them: surfaces far
hotter than any machine may be conduct so much more that whole steps go to and fro."""


def settled_cycle(network: ThermalNetwork, steps: FloatArray, heats: Heat) -> FloatArray:
    """Temperatures that repeat themselves from cycle to cycle.

    Over a step heat that no temperature changes is constant, and the rest follows the temperature
    at the step's end. Surfaces conduct as at the mean temperatures of the cycle: they are far
    slower than it.

    Parameters
    ----------
    network : ThermalNetwork
        Of N nodes.
    steps : array (K,)
        s, above zero.
    heats : Heat
        Its `fixed` and `slope` (K, N), in every step; `most` (N,).

    Returns
    -------
    array (K, N)
        At the end of every step, deg C.

    Raises
    ------
    DesignError
        Where they do not settle.
    """
    whole = float(steps.sum())
    mean_heat = Heat(
        np.asarray(steps @ heats.fixed / whole), np.asarray(steps @ heats.slope / whole), heats.most
    )
    mean = network.steady(mean_heat)
    found = np.broadcast_to(mean, heats.fixed.shape)
    for turn in range(_ROUNDS):
        growing = np.where(mean < heats.most, mean_heat.slope, 0.0)
        kept = network.matrix(network.outward(mean)) - np.diag(growing)
        own = heats.fixed + heats.slope * np.minimum(found, heats.most)
        fixed = own - growing * (found - network.ambient)
        now = network.ambient + _repeating(kept, network.capacity, steps, fixed)
        moved = float(np.abs(now - found).max())
        # The mean over a step is taken by its ends, which is what the next round's heat follows.
        found, before = now, np.roll(now, 1, axis=0)
        share = 1.0 if turn < _WHOLE else _DAMPED
        mean = mean + share * (steps @ (0.5 * (now + before)) / whole - mean)
        if moved <= _STILL:
            return found
    raise DesignError("the temperatures of the duty's cycle do not settle.")


def _repeating(
    kept: FloatArray, capacity: FloatArray, steps: FloatArray, heat: FloatArray
) -> FloatArray:
    """Rises (K, N) at the ends of steps under constant heat (K, N) in each, from cycle to cycle."""
    rates, modes = modes_of(kept, capacity)
    root = np.sqrt(capacity)
    fed = (heat / root) @ modes
    exponent = np.outer(steps, rates)
    fading = np.exp(-exponent)
    safe = np.where(rates == 0.0, 1.0, rates)
    gained = np.where(rates == 0.0, steps[:, None], -np.expm1(-exponent) / safe) * fed
    own, reached = np.zeros(len(rates)), np.empty(gained.shape)
    # Once from nothing; what is left of a start after one cycle then tells the start that repeats.
    for k in range(len(steps)):
        own = fading[k] * own + gained[k]
    own = own / -np.expm1(-rates * steps.sum())
    for k in range(len(steps)):
        own = fading[k] * own + gained[k]
        reached[k] = own
    return np.asarray(reached @ modes.T / root)
