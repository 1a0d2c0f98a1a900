"""The line of the output bearing's seats: whether fits and heat leave it its clearance."""

from __future__ import annotations

from cqdd_design.catalog.bearings import SHAFT_MATERIAL
from cqdd_design.catalog.internal_clearance import most_preload
from cqdd_design.errors import CatalogError, GeometryError
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.heat.expansion import REFERENCE
from cqdd_design.machine import Machine
from cqdd_design.machine.output_seat import (
    SeatedState,
    grows_more,
    ordered_clearance,
    seated_states,
)
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check

OUTPUT_PRELOAD = "OUTPUT-PRELOAD"
_UM = 1e6


def output_seat_line(machine: Machine, warm: MachineTemperatures | None = None) -> Check:
    """Preload of the output bearing in the worst state, on its diameter.

    Parameters
    ----------
    warm : MachineTemperatures or None
        Where they are not known, only what is too much cold or as fitted is known.
    """
    row = machine.seats[1].bearing
    limit = most_preload(row)
    try:
        states = seated_states(machine, warm)
        ordered = ordered_clearance(row, machine.design.carrier_material)
    except (CatalogError, GeometryError) as error:
        return build_check(
            OUTPUT_PRELOAD, None, None if limit is None else _UM * limit, error.message,
            "see why it is not known",
        )  # fmt: skip
    worst = min(states, key=lambda one: one.seated.least)
    preload = max(-worst.seated.least, 0.0)
    told = (
        f"{row.designation} {ordered.name}, {_UM * ordered.least:.0f} to {_UM * ordered.most:.0f} "
        f"um: {_UM * worst.seated.mean:.1f} \u00b1{_UM * worst.seated.spread:.1f} um are left with "
        f"its rings at {worst.carrier:.0f} degC (carrier plate) and {worst.housing:.0f} "
        "degC (cover)"
    )
    missing = "temperatures are not known" if warm is None else warm.cold
    over = limit is not None and preload > limit
    known = over or not missing
    cure = _cure(machine, warm, worst) if over else "see THERMAL-RISE, which says what is not known"
    return build_check(
        OUTPUT_PRELOAD,
        _UM * preload if known else None,
        None if limit is None else _UM * limit,
        told if known else f"{told}; {missing}",
        cure,
    )


def steel_helps(machine: Machine, warm: MachineTemperatures | None) -> bool:
    """Whether a carrier of steel leaves the bearing what it needs.

    Raises
    ------
    CatalogError, GeometryError
        Where that is not known.
    """
    limit = most_preload(machine.seats[1].bearing)
    states = seated_states(machine, warm, SHAFT_MATERIAL)
    return limit is not None and all(-one.seated.least <= limit for one in states)


def _cure(machine: Machine, warm: MachineTemperatures | None, worst: SeatedState) -> str:
    if grows_more(machine.design.carrier_material) and steel_helps(machine, warm):
        return f"set carrier.material to '{SHAFT_MATERIAL}', which grows as the bearing does"
    cold = worst.housing < REFERENCE
    air = machine.design.environment
    start = "coldest" if air.coldest < air.ambient else "ambient"
    less = f"a warmer environment.{start}" if cold else "less heat"
    return f"take a housing.material that grows as steel does, or {less}"
