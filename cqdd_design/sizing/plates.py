"""A carrier of steel, where warm aluminium would press the output bearing too hard."""

from __future__ import annotations

from cqdd_design.catalog.bearings import SHAFT_MATERIAL
from cqdd_design.machine import Machine
from cqdd_design.machine.temperatures import judged_temperatures
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.spaces import FITS
from cqdd_design.verdict.output_seat_line import output_seat_line, steel_helps


def steel_carrier(hunt: Hunt, machine: Machine) -> bool:
    """Whether carriers of designs that are searched for are of steel from now on.

    It is three times as heavy, so aluminium is tried first.
    """
    if hunt.carrier_material:
        return False
    warm = judged_temperatures(machine)[0]
    if output_seat_line(machine, warm).status != "fail" or not steel_helps(machine, warm):
        return False
    hunt.carrier_material, hunt.fit = SHAFT_MATERIAL, FITS[0]
    # Its pins keep to their holes in heat, so clearance and torque may be what they were not.
    hunt.lowered, hunt.lowered_by, hunt.calm = False, "", None
    hunt.say("searching with a carrier of steel, for warm aluminium presses the output bearing")
    return True
