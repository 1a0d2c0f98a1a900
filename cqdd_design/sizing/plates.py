"""A carrier of steel, where aluminium would press the output bearing too hard, or yield to pins."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from cqdd_design.catalog.bearings import SHAFT_MATERIAL
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.machine import Machine
from cqdd_design.machine.dowels import loaded_pin_seats
from cqdd_design.machine.temperatures import known_temperatures
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.output_seat_line import output_seat_line, steel_helps

_MATERIAL = "reducer.carrier.material"
_SURE = 1.1
"""Margin of a line by rigid discs and ring from which it passes by elastic ones too, whose
temperatures are within a kelvin or two, and forces within some per cent."""


def with_sound_plate(found: Found) -> Found:
    """The design, its carrier of steel where its bearing or its pins need that.

    Of the very same gearbox: steel is three times as heavy, so aluminium is searched for, and of
    what a steel carrier changes of loads and heat most is for the better.
    """
    if not needs_steel(found.sized.machine.rigid):
        return found
    return replace(found, sized=found.sized.remade({_MATERIAL: SHAFT_MATERIAL}))


def needs_steel(rigid: Machine) -> bool:
    """Whether a machine's carrier would press its bearing or yield to its pins, and steel less."""
    if rigid.design.carrier_material == SHAFT_MATERIAL:
        return False
    if pins_press(rigid) > 1.0 / _SURE:
        return True
    warm = known_temperatures(rigid)
    line = output_seat_line(rigid, warm)
    return line.known and line.margin < _SURE and steel_helps(rigid, warm)


def pins_press(machine: Machine) -> float:
    """Pressure of the output pins on their seats over what these bear; 0 where it is not known."""
    with suppress(ContactError, GeometryError):
        seats = loaded_pin_seats(machine)
        return max((one.stress.pressure / one.seat.value for one in seats), default=0.0)
    return 0.0
