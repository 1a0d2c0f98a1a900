"""A machine's thermal network, cooled as stated, and the two nodes that it is reduced to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

from cqdd_design.catalog.motors import WINDING_MOST
from cqdd_design.gearbox.heat.network import Heat, ThermalNetwork
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.heat_nodes import NODES, node_values
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.thermal_parts import machine_network, scaled

_MOST_FACTOR = 1e3
_HALVINGS, _STILL = 6, 1e-12
"""Of the logarithm of what is sought, before its root is closed in on, and how closely."""
_WATTS = 1e-3, 1e5
"""Between which the heat lies that takes a winding to its limit."""


class TwoNodes(NamedTuple):
    """The network reduced to winding and housing, K/W and J/K."""

    winding_to_housing: float
    housing_to_ambient: float
    winding_capacity: float
    housing_capacity: float


@lru_cache(maxsize=2)
def cooled_network(machine: Machine) -> ThermalNetwork:
    """The machine's network; a stated resistance, winding to ambient, holds in it.

    A stated resistance holds with the winding at its limit by its own heat alone. All actuators
    that are drawn of a machine ask for it, so the last are kept.

    Raises
    ------
    GeometryError, DesignError
        As :func:`.thermal_parts.machine_network`.
    """
    network = machine_network(machine)
    stated, most = machine.cooling.value, machine.motor.winding_most
    if stated == 0.0:
        return network
    watts = (most - network.ambient) / stated
    heat = Heat.constant(node_values({"winding": watts}))
    w = NODES.index("winding")

    def room(one: ThermalNetwork) -> float:
        return float(most - one.steady(heat)[w])

    best = scaled(network, _MOST_FACTOR)
    if room(best) >= 0.0:
        enough = _enough(lambda x: room(scaled(network, x)), 1.0 / _MOST_FACTOR, _MOST_FACTOR)
        return scaled(network, enough)

    # Colder than its own copper and iron allow: everything conducts better.
    def all_better(factor: float) -> ThermalNetwork:
        conducts = factor * best.conductance
        return replace(best, conductance=conducts, cooling=factor * best.cooling)

    return all_better(_enough(lambda x: room(all_better(x)), 1.0, _MOST_FACTOR))


def _enough(surplus: Callable[[float], float], least: float, most: float) -> float:
    """Where a surplus that grows with a number is nothing, or the end that is nearest to that.

    Near first: far from there networks run away and have no temperatures.
    """
    from scipy.optimize import brentq

    for _ in range(_HALVINGS):
        middle = math.sqrt(least * most)
        least, most = (middle, most) if surplus(middle) <= 0.0 else (least, middle)
    low, high = math.log(least), math.log(most)
    # Where an end is the answer, the logarithm's rounding must not turn its sign.
    ends = {low: surplus(least), high: surplus(most)}
    if ends[high] <= 0.0:
        return most
    if ends[low] >= 0.0:
        return least
    found = brentq(lambda x: ends[x] if x in ends else surplus(math.exp(x)), low, high, xtol=_STILL)
    return math.exp(found)


@lru_cache(maxsize=2)
def two_nodes(network: ThermalNetwork, most: float = WINDING_MOST) -> TwoNodes:
    """Winding and housing alone, surfaces as they are with the winding at its limit (deg C).

    The heat of the winding takes both to the same steady temperatures as in the whole network, and
    leaves as much heat in either form: the housing's capacity stands for all other parts, each by
    how warm it gets over the housing.
    """
    w, h = NODES.index("winding"), NODES.index("housing")
    one = Heat.constant(node_values({"winding": 1.0}))

    def at(watts: float) -> FloatArray:
        return network.steady(one._replace(fixed=watts * one.fixed))

    watts = _enough(lambda watts: float(at(watts)[w] - most), *_WATTS)
    found = network.resistances(w, at(watts))
    rest = network.capacity * found
    return TwoNodes(
        winding_to_housing=float(found[w] - found[h]),
        housing_to_ambient=float(found[h]),
        winding_capacity=float(network.capacity[w]),
        housing_capacity=float((rest.sum() - rest[w]) / found[h]),
    )
