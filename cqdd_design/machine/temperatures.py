"""How warm a machine's parts get at a duty, and what that does to its clearances."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.motors import WINDING_MOST
from cqdd_design.errors import ContactError, DesignError, GeometryError
from cqdd_design.gearbox.checks.allowables import GREASE_MOST, HOUSING_MOST
from cqdd_design.gearbox.checks.heat import Tightness, WarmPart, clearance_check, rise_check
from cqdd_design.gearbox.heat.cycle import settled_cycle
from cqdd_design.gearbox.heat.expansion import AS_DRAWN, COLDEST, HOTTEST, PartTemperatures
from cqdd_design.gearbox.heat.network import Heat, ThermalNetwork
from cqdd_design.gearbox.precision.backlash import Backlash, backlash
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.duty_heat import DutyHeat, duty_cases, duty_heat, logged_heat
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.thermal_parts import (
    NODES,
    Node,
    by_node,
    machine_network,
    node_values,
    scaled,
)
from cqdd_design.results import Check

_MOST_FACTOR = 1e3
_HALVINGS = 60
_WATTS = 1e-3, 1e5
"""Between which the heat lies that takes a winding to its limit."""
_GAP_ANGLES = 90
_TIMES = 48
_EDGE = 1e-6
"""Kept off the end of the range of temperatures, K, for rounding."""
_LEAST_TIME, _SETTLED = 5.0, 6.0
"""First time of a history, s, and its last over the slowest time constant."""
_SHOWN = 200
"""Times of a duty's cycle in JSON."""
_LOOKS = 6
"""States on the way from the coldest start at which clearances are looked at."""


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

    def warm(one: ThermalNetwork) -> bool:
        return bool(one.steady(heat)[w] > most)

    best = scaled(network, _MOST_FACTOR)
    if not warm(best):
        enough = _halved(lambda x: warm(scaled(network, x)), 1.0 / _MOST_FACTOR, _MOST_FACTOR)
        return scaled(network, enough)

    # Colder than its own copper and iron allow: everything conducts better.
    def all_better(factor: float) -> ThermalNetwork:
        conducts = factor * best.conductance
        return replace(best, conductance=conducts, cooling=factor * best.cooling)

    return all_better(_halved(lambda x: warm(all_better(x)), 1.0, _MOST_FACTOR))


def _halved(too_small: Callable[[float], bool], least: float, most: float) -> float:
    """Where a number is enough, by halving its logarithm."""
    for _ in range(_HALVINGS):
        middle = math.sqrt(least * most)
        least, most = (middle, most) if too_small(middle) else (least, middle)
    return math.sqrt(least * most)


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

    watts = _halved(lambda watts: bool(at(watts)[w] <= most), *_WATTS)
    found = network.resistances(w, at(watts))
    rest = network.capacity * found
    return TwoNodes(
        winding_to_housing=float(found[w] - found[h]),
        housing_to_ambient=float(found[h]),
        winding_capacity=float(network.capacity[w]),
        housing_capacity=float((rest.sum() - rest[w]) / found[h]),
    )


@dataclass(frozen=True, eq=False)
class WarmClearance:
    """Rigid parts at some temperatures.

    Attributes
    ----------
    temperatures : PartTemperatures
    free : Backlash
    least_gap : float
        In the nominal pose, m; negative where parts have to move out of each other's way.
    """

    temperatures: PartTemperatures
    free: Backlash
    least_gap: float

    @property
    def overlap(self) -> float:
        """That no motion removes, m; 0 where parts are free."""
        return float(self.free.overlap.max()) if self.free.preloaded else 0.0


def warm_clearance(machine: Machine, temperatures: PartTemperatures) -> WarmClearance:
    """Backlash, gap and overlap of rigid parts at some temperatures.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    """
    from cqdd_design.gearbox.contact.states import nominal_states
    from cqdd_design.gearbox.contact.sweep import perfect_angles

    model = machine.at(temperatures).contact
    states = nominal_states(model, perfect_angles(model, _GAP_ANGLES))
    found = backlash(model, states=states)
    return WarmClearance(temperatures, found, float(states.gaps.min()))


@dataclass(frozen=True, eq=False)
class WarmCycle:
    """Temperatures over one cycle of a duty, the same in every one.

    Attributes
    ----------
    time : array (K,)
        From the beginning of the cycle, s.
    temperature : array (K, N)
        At these times, deg C.
    """

    time: FloatArray
    temperature: FloatArray

    @property
    def winding(self) -> tuple[float, float]:
        """Greatest temperature of the winding, deg C, and when it has it, s."""
        values = self.temperature[:, NODES.index("winding")]
        hottest = int(values.argmax())
        return float(values[hottest]), float(self.time[hottest])

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form, some hundred times of the cycle and the hottest."""
        most, when = self.winding
        some = np.unique(np.linspace(0, len(self.time) - 1, _SHOWN).round().astype(int))
        return {
            "winding_peak_degC": most,
            "winding_peak_at_s": when,
            "winding_least_degC": float(self.temperature[:, NODES.index("winding")].min()),
            "time_s": self.time[some].tolist(),
            "cycle_degC": {n: self.temperature[some, i].tolist() for i, n in enumerate(NODES)},
        }


@dataclass(frozen=True, eq=False)
class MachineTemperatures:
    """Temperatures of a machine's parts at a duty, in the air of its surroundings.

    Attributes
    ----------
    machine : Machine
    network : ThermalNetwork
    duty : DutyHeat
    steady : array (N,)
        Of :data:`.thermal_parts.NODES`, deg C, under the mean heat of the duty.
    cycle : WarmCycle or None
        Of a duty over time, once its cycles repeat.
    """

    machine: Machine
    network: ThermalNetwork
    duty: DutyHeat
    steady: FloatArray
    cycle: WarmCycle | None = None

    def hottest(self, node: Node) -> float:
        """Greatest temperature of a node, over a duty's cycle where there is one, deg C."""
        k = NODES.index(node)
        settled = float(self.steady[k])
        if self.cycle is None:
            return settled
        return max(settled, float(self.cycle.temperature[:, k].max()))

    @cached_property
    def times(self) -> FloatArray:
        """Of `history`, s: from seconds until all parts have settled."""
        return np.asarray(np.geomspace(_LEAST_TIME, _SETTLED * self.settling_time, _TIMES))

    @cached_property
    def history(self) -> FloatArray:
        """Temperatures (T, N) at `times` after a start at the air's temperature, deg C."""
        return self.network.history(self.duty.heat, self.times)

    def parts(self, values: FloatArray) -> PartTemperatures:
        """The gearbox's parts at temperatures of the nodes; pins are as warm as the carrier."""
        told = by_node(values)
        told["pin"] = told["carrier"]
        return PartTemperatures(**{one.name: told[one.name] for one in fields(PartTemperatures)})

    @cached_property
    def reached(self) -> FloatArray:
        """`steady`, or where parts would get warmer than is worked with, the way there up to it."""
        ambient, most = self.network.ambient, float(self._of_gearbox(self.steady).max())
        if most <= HOTTEST:
            return self.steady
        share = (HOTTEST - _EDGE - ambient) / (most - ambient)
        return np.asarray(ambient + share * (self.steady - ambient))

    @staticmethod
    def _of_gearbox(values: FloatArray) -> FloatArray:
        return np.asarray(values[[NODES.index(n) for n in ("ring", "disc", "shaft", "carrier")]])

    @cached_property
    def hot(self) -> WarmClearance:
        """Clearances at `reached`."""
        return warm_clearance(self.machine, self.parts(self.reached))

    @cached_property
    def on_the_way(self) -> tuple[WarmClearance, ...]:
        """Clearances at the coldest start, on the way from there, and at `reached`."""
        coldest = self.machine.design.environment.coldest
        times = self.times[:: max(_TIMES // _LOOKS, 1)]
        warming = self.network.history(self.duty.heat, times, coldest)
        inside = np.clip(warming, COLDEST, HOTTEST)
        return (
            warm_clearance(self.machine, PartTemperatures.even(coldest)),
            *(warm_clearance(self.machine, self.parts(one)) for one in inside),
            self.hot,
        )

    @property
    def settling_time(self) -> float:
        """After which the slowest part has done 63 % of its way, s."""
        return float(1.0 / self.network.rates(self.steady).min())

    @property
    def warnings(self) -> tuple[str, ...]:
        """Parts beyond what is worked with."""
        if np.array_equal(self.reached, self.steady):
            return ()
        hottest = float(self._of_gearbox(self.steady).max())
        return (
            f"parts of the gearbox would settle at {hottest:.4g} degC; clearances are told on the "
            f"way there, where the warmest has {HOTTEST:g} degC.",
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON form: ``temperatures_degC`` by part, and ``heat``, what goes with them."""
        return {
            "temperatures_degC": by_node(self.steady) | {"ambient": self.network.ambient},
            "heat": self._heat(),
        }

    def _heat(self) -> dict[str, object]:
        hot = self.hot
        return {
            "gearbox_losses_W": self.duty.gearbox,
            "winding_losses_W": float(self.duty.heat.at(self.steady)[NODES.index("winding")]),
            "winding_to_ambient_K_per_W": sum(two_nodes(self.network)[:2]),
            "settling_time_min": self.settling_time / 60.0,
            "backlash_arcmin": math.degrees(hot.free.mean) * 60.0,
            "least_gap_um": hot.least_gap * 1e6,
            "preload_overlap_um": hot.overlap * 1e6,
            "cycle": None if self.cycle is None else self.cycle.to_dict(),
            "history_s": self.times.tolist(),
            "history_degC": {n: self.history[:, i].tolist() for i, n in enumerate(NODES)},
        }


def machine_temperatures(machine: Machine, *, duty: bool = True) -> MachineTemperatures:
    """Steady temperatures at the duty of the requirements, or at the continuous torque.

    Parameters
    ----------
    duty : bool
        Whether the duty of the requirements counts, where there is one.

    Raises
    ------
    GeometryError, DesignError, ContactError
        When the network or the losses are not known.
    """
    network = cooled_network(machine)
    log = machine.design.requirements.duty_log if duty else None
    if log is None:
        found = duty_heat(machine, duty_cases(machine, duty=duty))
        return MachineTemperatures(machine, network, found, network.steady(found.heat))
    steps, heats, found = logged_heat(machine, log)
    cycle = WarmCycle(np.cumsum(steps), settled_cycle(network, steps, heats))
    return MachineTemperatures(machine, network, found, network.steady(found.heat), cycle)


def heat_checks(found: MachineTemperatures) -> tuple[Check, ...]:
    """Checks of temperatures and of warm clearances.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    """
    at = by_node(found.steady)
    housing = find_material(found.machine.design.housing.material).service_limit
    greased = max(("ring", "disc", "shaft", "carrier"), key=at.__getitem__)
    parts = (
        WarmPart("winding", found.hottest("winding"), found.machine.motor.winding_most),
        WarmPart(f"grease at the {greased}", at[greased], GREASE_MOST),
        WarmPart("housing", at["housing"], HOUSING_MOST if housing is None else housing),
    )
    drawn = warm_clearance(found.machine, AS_DRAWN).overlap
    heat = float(found.duty.heat.at(found.steady).sum())
    states = tuple(
        Tightness(max(one.overlap - drawn, 0.0), _in_words(one.temperatures))
        for one in found.on_the_way
    )
    return rise_check(parts, found.network.ambient, heat), clearance_check(states)


def _in_words(parts: PartTemperatures) -> str:
    told = ", ".join(f"{name} {value:.0f}" for name, value in vars(parts).items())
    return f"{told} degC"


@lru_cache(maxsize=2)
def judged_temperatures(
    machine: Machine,
) -> tuple[MachineTemperatures | None, tuple[Check, ...], tuple[str, ...]]:
    """Temperatures at the duty with their checks, or a sentence on why there are none."""
    try:
        found = machine_temperatures(machine)
        return found, heat_checks(found), found.warnings
    except (ContactError, DesignError, GeometryError) as error:
        why = error.message.removeprefix("no temperatures: ").removeprefix("no thermal network: ")
        return None, (), (f"no temperatures of parts: {why}",)
