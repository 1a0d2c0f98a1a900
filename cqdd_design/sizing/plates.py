"""A carrier of steel, where warm aluminium would press the output bearing too hard."""

from __future__ import annotations

from dataclasses import replace

from cqdd_design.catalog.bearings import SHAFT_MATERIAL
from cqdd_design.machine.temperatures import judged_temperatures
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.output_seat_line import output_seat_line, steel_helps

_MATERIAL = "reducer.carrier.material"
_SURE = 1.1
"""Margin of the line by rigid discs and ring from which it passes by elastic ones too, whose
temperatures are within a kelvin or two."""


def with_sound_plate(found: Found) -> Found:
    """The design, its carrier of steel where its bearing needs that.

    Of the very same gearbox: steel is three times as heavy, so aluminium is searched for, and of
    what a steel carrier changes of loads and heat most is for the better.
    """
    sized = found.sized
    if sized.design.carrier_material == SHAFT_MATERIAL:
        return found
    rigid = replace(sized.machine, stiff=True)
    warm = judged_temperatures(rigid)[0]
    line = output_seat_line(rigid, warm)
    if not line.known or line.margin >= _SURE or not steel_helps(rigid, warm):
        return found
    return replace(found, sized=sized.remade({_MATERIAL: SHAFT_MATERIAL}))
