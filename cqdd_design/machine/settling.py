"""Temperatures at which a machine loses what keeps it so warm: losses and heat, one of the other.

Warm parts lose another amount than as drawn: clearances and with them the shares of the teeth, the
lubricant's viscosity and film, the winding's resistance and the magnets' flux follow the
temperature. Steady is where the network, under the losses of parts at its temperatures, has these
temperatures. It is come to as the machine does, from the air's temperature on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields

import numpy as np

from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.expansion import HOTTEST, PartTemperatures
from cqdd_design.gearbox.heat.network import ThermalNetwork
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.duty_heat import DutyHeat
from cqdd_design.machine.heat_nodes import NODES, Node, by_node
from cqdd_design.machine.machine import Machine

_GEARBOX: tuple[Node, ...] = ("ring", "disc", "shaft", "carrier")
_ROUNDS = 60
"""Of the search."""
STILL, SEARCHED_STILL, _NEARLY_STILL = 1e-6, 1e-2, 5e-2
"""K by which temperatures may still move: of what is judged; where a torque or a resistance is
looked for that leaves parts as cool as they have to be; with rigid bodies, whose losses are good to
a per cent."""
_MOST_GAIN = 0.8
"""Of temperature by temperature that the search counts on."""
_EDGE = 1e-6
"""Kept off the end of the range of temperatures, K, for rounding."""

Losing = Callable[[Machine, float], DutyHeat]
"""Losses of a machine with parts at its temperatures and magnets at one, deg C."""


def gearbox_parts(values: FloatArray) -> PartTemperatures:
    """The gearbox's parts at temperatures of the nodes; pins are as warm as the carrier."""
    told = by_node(values)
    told["pin"] = told["carrier"]
    return PartTemperatures(**{one.name: told[one.name] for one in fields(PartTemperatures)})


def hottest_part(values: FloatArray) -> float:
    """Of the gearbox, deg C."""
    return float(max(values[NODES.index(name)] for name in _GEARBOX))


def within_reach(values: FloatArray, ambient: float) -> FloatArray:
    """The same, or where parts are warmer than is worked with, the way there from the air's."""
    most = hottest_part(values)
    if most <= HOTTEST:
        return values
    share = (HOTTEST - _EDGE - ambient) / (most - ambient)
    return np.asarray(ambient + share * (values - ambient))


def magnets_at(machine: Machine, values: FloatArray) -> float:
    """Temperature of the rotor's magnets, deg C, which keep to what the winding bears."""
    return min(float(values[NODES.index("rotor")]), machine.motor.winding_most)


def settle(
    machine: Machine, network: ThermalNetwork, lost: Losing, still: float = STILL
) -> tuple[DutyHeat, FloatArray]:
    """Losses and temperatures (N,), deg C, that are each other's.

    Parameters
    ----------
    machine : Machine
        As drawn.
    lost : callable
        Losses of it at temperatures. Parts beyond 200 deg C, where nothing is worked with, lose
        what they do on the way there, the warmest at 200; so do magnets beyond what the winding
        bears.
    still : float
        K by which temperatures may still move; those of rigid bodies may by more.

    Raises
    ------
    ContactError
        Where warm parts have no equilibrium.
    DesignError
        Where no such temperatures are found.
    """
    now = np.full(len(NODES), network.ambient)
    still = max(still, _NEARLY_STILL) if machine.stiff else still
    step, before, gain = np.zeros(now.shape), now, 0.0
    for _ in range(_ROUNDS):
        warm = machine.at(gearbox_parts(within_reach(now, network.ambient)))
        found = lost(warm, magnets_at(machine, now))
        then = network.steady(found.heat)
        if np.abs(then - now).max() <= still:
            return found, then
        if machine.stiff and min(hottest_part(now), hottest_part(then)) > HOTTEST:
            # How hot it gets that is too hot no look of a search asks.
            return found, then
        # What a kelvin more comes back as; beyond the most, heat runs away and is let go.
        if np.any(step):
            gain = min(float((then - before) @ step / (step @ step)), _MOST_GAIN)
        step, before = (then - now) / (1.0 - gain), then
        # Nothing is colder than the air: only the search would be.
        now = np.maximum(now + step, network.ambient)
    raise DesignError(
        "losses of warm parts and their temperatures find no state in which both stay."
    )
