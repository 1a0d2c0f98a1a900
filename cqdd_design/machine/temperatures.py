"""How warm a machine's parts get at a duty, and the checks of that."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from cqdd_design.catalog.lubricants import find_lubricant
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.motors import COPPER_REFERENCE
from cqdd_design.design.duty_log import DutyLog
from cqdd_design.errors import ContactError, DesignError, GeometryError
from cqdd_design.gearbox.checks.allowables import BINDING_OVERLAP, GREASE_MOST, HOUSING_MOST
from cqdd_design.gearbox.checks.heat import (
    Tightness,
    WarmPart,
    clearance_check,
    clearance_remedy,
    rise_check,
)
from cqdd_design.gearbox.heat.cycle import settled_cycle
from cqdd_design.gearbox.heat.expansion import (
    AS_DRAWN,
    COLDEST,
    HOTTEST,
    PartTemperatures,
    part_materials,
)
from cqdd_design.gearbox.heat.network import ThermalNetwork
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.limits import rounded_up
from cqdd_design.machine.cooling import cooled_network, two_nodes
from cqdd_design.machine.duty_heat import DutyHeat, duty_cases, duty_heat, logged_heat
from cqdd_design.machine.heat_nodes import NODES, Node, by_node
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.settling import (
    STILL,
    Losing,
    gearbox_parts,
    hottest_part,
    magnets_at,
    settle,
    within_reach,
)
from cqdd_design.machine.warm_clearance import WarmClearance, warm_clearance
from cqdd_design.machine.warm_cycle import WarmCycle
from cqdd_design.results import Check

_TIMES = 48
_LEAST_TIME, _SETTLED = 5.0, 6.0
"""First time of a history, s, and its last over the slowest time constant."""
_TRIED = (1.5, 3.0, 6.0)
"""Of what a clearance lacks at least, what is tried as a remedy."""
_LOOKS, _FEW_LOOKS = 6, 3
"""States on the way from the coldest start at which clearances are looked at; with rigid bodies."""
_GREASED: tuple[Node, ...] = ("ring", "disc", "shaft", "carrier")
_ALIKE = 0.5
"""K by which a state has to differ from another to be looked at."""
_SAME_BACKLASH = 0.99
"""Share of the backlash as drawn that warmth has to leave less of to be drawn with part errors."""


@dataclass(frozen=True, eq=False)
class MachineTemperatures:
    """Temperatures of a machine's parts at a duty, in the air of its surroundings.

    Attributes
    ----------
    machine : Machine
    network : ThermalNetwork
    duty : DutyHeat
    steady : array (N,)
        Of :data:`.thermal_parts.NODES`, deg C, under the mean heat of the duty, which is that of
        parts at these temperatures.
    as_drawn : DutyHeat
        What the duty loses with parts at 20 deg C and the lubricant at 40.
    cycle : WarmCycle or None
        Of a duty over time, once its cycles repeat; losses are those of parts at its mean.
    cold : str
        Why `duty` is `as_drawn`: warm parts have no losses; empty where they have.
    """

    machine: Machine
    network: ThermalNetwork
    duty: DutyHeat
    steady: FloatArray
    as_drawn: DutyHeat
    cycle: WarmCycle | None = None
    cold: str = ""

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

    @cached_property
    def reached(self) -> FloatArray:
        """`steady`, or where parts would get warmer than is worked with, the way there up to it."""
        return within_reach(self.steady, self.network.ambient)

    @cached_property
    def states(self) -> tuple[FloatArray, ...]:
        """`reached`, and the moments of a duty's cycle at which parts are hottest or most unlike.

        Moments within half a kelvin of one that is there already say nothing new.
        """
        found = [self.reached]
        for row in () if self.cycle is None else self.cycle.extremes:
            inside = np.clip(row, COLDEST, HOTTEST)
            if all(np.abs(inside - one).max() > _ALIKE for one in found):
                found.append(inside)
        return tuple(found)

    @cached_property
    def hot(self) -> WarmClearance:
        """Clearances at `reached`."""
        return warm_clearance(self.machine, gearbox_parts(self.reached))

    @cached_property
    def on_the_way(self) -> tuple[WarmClearance, ...]:
        """Clearances at the coldest start, on the way from there, over a cycle, and settled."""
        coldest = self.machine.design.environment.coldest
        times = self.times[:: _TIMES // (_FEW_LOOKS if self.machine.stiff else _LOOKS)]
        warming = self.network.history(self.duty.heat, times, coldest)
        inside = np.clip(warming, COLDEST, HOTTEST)
        return (
            warm_clearance(self.machine, PartTemperatures.even(coldest)),
            *(warm_clearance(self.machine, gearbox_parts(one)) for one in inside),
            *(warm_clearance(self.machine, gearbox_parts(one)) for one in self.states[1:]),
            self.hot,
        )

    @cached_property
    def undisturbed(self) -> MachineTemperatures:
        """Where parts would settle if they went on losing what they do as drawn."""
        steady = self.network.steady(self.as_drawn.heat)
        found = replace(self, duty=self.as_drawn, steady=steady)
        log = self.machine.design.requirements.duty_log
        if self.cycle is None or log is None:
            return found
        return replace(found, cycle=_cycle(self.machine, self.network, log, COPPER_REFERENCE))

    @cached_property
    def lacking_clearance(self) -> float:
        """Overlap that warmth adds to parts that lose no more for pressing on each other, m.

        Those that press lose more and get warmer still, which says nothing of what they lacked.
        """
        return self.undisturbed.tightest.overlap

    @cached_property
    def heat_share(self) -> float:
        """Greatest rise above the air of a part, over the most that it bears."""
        return max(one.share(self.network.ambient) for one in _parts(self))

    @cached_property
    def tightest(self) -> Tightness:
        """The greatest overlap that warmth adds, and where."""
        return max(_added_overlaps(self), key=lambda one: one.overlap)

    @cached_property
    def least_free(self) -> PartTemperatures:
        """The state of least backlash, in whole kelvins; as drawn where none has less than that."""
        tightest = min(self.on_the_way, key=lambda one: one.free.mean)
        if tightest.free.mean > _SAME_BACKLASH * warm_clearance(self.machine, AS_DRAWN).free.mean:
            return AS_DRAWN
        rounded = {name: float(round(value)) for name, value in vars(tightest.temperatures).items()}
        return PartTemperatures(**rounded)

    @property
    def settling_time(self) -> float:
        """After which the slowest part has done 63 % of its way, s."""
        return float(1.0 / self.network.rates(self.steady).min())

    @property
    def warnings(self) -> tuple[str, ...]:
        """Parts beyond what is worked with, and losses that warmth is not fed back to."""
        told = (self.cold,) if self.cold else ()
        if np.array_equal(self.reached, self.steady):
            return told
        drawn, away = hottest_part(self.undisturbed.steady), ""
        if drawn <= HOTTEST:
            away = (
                f"heat runs away: by the {self.as_drawn.gearbox:.3g} W that it loses as drawn the "
                f"gearbox would settle at {drawn:.4g} degC, but warm parts lose more; "
            )
        return (
            *told,
            f"{away}parts of the gearbox would settle at {hottest_part(self.steady):.4g} degC; "
            f"losses and clearances are told on the way there, where the warmest has {HOTTEST:g} "
            "degC.",
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
            "gearbox_losses_as_drawn_W": self.as_drawn.gearbox,
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


def machine_temperatures(
    machine: Machine,
    *,
    duty: bool = True,
    still: float = STILL,
    network: ThermalNetwork | None = None,
) -> MachineTemperatures:
    """Steady temperatures at the duty of the requirements, or at the continuous torque.

    Parameters
    ----------
    duty : bool
        Whether the duty of the requirements counts, where there is one.
    still : float
        K by which they may still move.
    network : ThermalNetwork, optional
        Of the same parts under other torques, which it does not hang on.

    Raises
    ------
    GeometryError, DesignError, ContactError
        When the network or the losses are not known.
    """
    log = machine.design.requirements.duty_log if duty else None
    lost = _losing(machine, duty=duty)
    found = _as_drawn(machine, duty=duty, network=network)
    network = found.network
    warm, magnets = machine, COPPER_REFERENCE
    try:
        heat, steady = settle(machine, network, lost, still)
        found = replace(found, duty=heat, steady=steady)
        warm, magnets = machine.at(gearbox_parts(found.reached)), magnets_at(machine, steady)
    except (ContactError, DesignError, GeometryError) as error:
        why = f"losses are those at 20 degC, as warm parts have none: {error.message}"
        found = replace(found, cold=why)
    if log is None:
        return found
    return replace(found, cycle=_cycle(warm, network, log, magnets))


@lru_cache(maxsize=6)
def undisturbed_temperatures(machine: Machine) -> MachineTemperatures | None:
    """`MachineTemperatures.undisturbed` alone; None where that is not known."""
    log = machine.design.requirements.duty_log
    try:
        found = _as_drawn(machine)
        if log is None:
            return found
        return replace(found, cycle=_cycle(machine, found.network, log, COPPER_REFERENCE))
    except (ContactError, DesignError, GeometryError):
        return None


def _as_drawn(
    machine: Machine, *, duty: bool = True, network: ThermalNetwork | None = None
) -> MachineTemperatures:
    """Where parts settle in the mean if they go on losing what they do as drawn."""
    network = network or cooled_network(machine)
    lost = _losing(machine, duty=duty)(machine, COPPER_REFERENCE)
    return MachineTemperatures(machine, network, lost, network.steady(lost.heat), lost)


def _losing(machine: Machine, *, duty: bool) -> Losing:
    """What a machine loses over its duty, by the temperatures of its parts."""
    log = machine.design.requirements.duty_log if duty else None
    cases = duty_cases(machine, duty=duty)

    def lost(warm: Machine, magnets: float) -> DutyHeat:
        if log is None:
            return duty_heat(warm, cases, magnets)
        return logged_heat(warm, log, magnets)[2]

    return lost


def _cycle(machine: Machine, network: ThermalNetwork, log: DutyLog, magnets: float) -> WarmCycle:
    """A duty over time once its cycles repeat, of parts that lose what they do in a state."""
    steps, heats, _ = logged_heat(machine, log, magnets)
    return WarmCycle(np.cumsum(steps), settled_cycle(network, steps, heats))


def heat_checks(found: MachineTemperatures) -> tuple[Check, ...]:
    """Checks of temperatures and of warm clearances.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    """
    checks = (
        rise_line(found),
        clearance_check(_added_overlaps(found), lambda: _remedy(found)),
    )
    if not found.cold:
        return checks
    # Parts get warmer than losses as drawn make them, or not: only what fails is known.
    return tuple(
        replace(one, value=None, substituted=found.cold) if one.satisfied else one for one in checks
    )


def rise_line(found: MachineTemperatures) -> Check:
    """The line of the part nearest to the temperature that it bears."""
    heat, as_drawn = (
        float(one.heat.at(found.steady).sum()) for one in (found.duty, found.as_drawn)
    )
    return rise_check(_parts(found), found.network.ambient, heat, as_drawn)


def _parts(found: MachineTemperatures) -> tuple[WarmPart, ...]:
    """Those that have a limit, at the temperatures that are found."""
    at = {node: found.hottest(node) for node in NODES}
    bears_at = at | {"pin": at["carrier"]}
    housing = find_material(found.machine.design.housing.material).service_limit
    greased = max(_GREASED, key=at.__getitem__)
    lubricant = find_lubricant(found.machine.design.reducer.friction.lubricant)
    grease = min(GREASE_MOST, lubricant.hottest)
    bears = {
        part: find_material(name).service_limit
        for part, name in part_materials(found.machine.design).items()
    }
    return (
        WarmPart("winding", found.hottest("winding"), found.machine.motor.winding_most),
        WarmPart(f"grease at the {greased}", at[greased], grease),
        WarmPart("housing", at["housing"], HOUSING_MOST if housing is None else housing),
        # Of the greased parts those that give way before their grease does.
        *(
            WarmPart(part, bears_at[part], most)
            for part, most in bears.items()
            if most is not None and most < grease
        ),
    )


def _remedy(found: MachineTemperatures) -> str:
    """What frees warm parts, as tried on them."""
    if found.machine.stiff:
        # Of a look in a search nobody reads it.
        return "give hole_clearance or modification.equidistant more, or cool the parts"
    if any(one.temperature > one.most for one in _parts(found.undisturbed)):
        return (
            "cool the parts first (see THERMAL-RISE): they are too warm by what they lose as "
            "drawn, and grow too far for a clearance to be told"
        )
    reducer, lacks = found.machine.design.reducer, found.lacking_clearance
    holes = "reducer.output_pins.hole_clearance", reducer.output_pins.hole_clearance, 2.0 * lacks
    more = _more(found, *holes)
    if more is not None:
        return clearance_remedy(f"give hole_clearance {rounded_up(1e6 * more):g} um more")
    more = _more(found, "reducer.modification.equidistant", reducer.modification.equidistant, lacks)
    if more is not None:
        return clearance_remedy(f"give modification.equidistant {rounded_up(1e6 * more):g} um more")
    return clearance_remedy("give both hole_clearance and modification.equidistant more")


def _more(found: MachineTemperatures, key: str, now: float, lacks: float) -> float | None:
    """By how much a clearance alone has to grow until parts settle free, m; None where none does.

    Parameters
    ----------
    now, lacks : float
        The clearance, and what it lacks at least, m.
    """
    for times in _TRIED:
        more = times * max(lacks, 1e-6 * BINDING_OVERLAP)
        try:
            settled = machine_temperatures(found.machine.changed({key: now + more}))
        except DesignError:
            return None
        if settled.tightest.overlap <= 1e-6 * BINDING_OVERLAP:
            return more
    return None


def _added_overlaps(found: MachineTemperatures) -> tuple[Tightness, ...]:
    """Overlap that warmth adds in every state on the way."""
    drawn = warm_clearance(found.machine, AS_DRAWN).overlap
    return tuple(
        Tightness(max(one.overlap - drawn, 0.0), _in_words(one.temperatures))
        for one in found.on_the_way
    )


def _in_words(parts: PartTemperatures) -> str:
    told = ", ".join(f"{name} {value:.0f}" for name, value in vars(parts).items())
    return f"{told} degC"


def known_temperatures(machine: Machine) -> MachineTemperatures | None:
    """Temperatures at the duty, where they are known."""
    return judged_temperatures(machine)[0]


@lru_cache(maxsize=6)
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
