"""How well a machine has to be cooled for no part of it to get too warm."""

from __future__ import annotations

from cqdd_design.machine.cooling import two_nodes
from cqdd_design.machine.cures import torques_that_hold
from cqdd_design.machine.settling import SEARCHED_STILL
from cqdd_design.machine.temperatures import MachineTemperatures, machine_temperatures, rise_line
from cqdd_design.results import Check

_NEAR_ENOUGH = 2e-2
"""Of a limit of temperature, how much may be left of it where cooling is looked for."""


def enough_cooling(found: MachineTemperatures) -> float:
    """The stated resistance (K/W) up to which no part gets too warm; 0 where there is none."""
    machine, now = found.machine, sum(two_nodes(found.network)[:2])

    def at(resistance: float) -> tuple[Check, ...]:
        stated = machine.changed({"drive.thermal_resistance": resistance})
        vars(stated).update(contact=machine.contact, bodies=machine.bodies)
        stated.loses_as(machine)
        cooled = machine_temperatures(stated, still=SEARCHED_STILL)
        return () if cooled.cold else (rise_line(cooled),)

    (enough,) = torques_that_hold(
        at, now, (rise_line(found),), every=True, near=_NEAR_ENOUGH
    ).values()
    return enough
