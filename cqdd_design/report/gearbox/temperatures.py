"""Temperatures in the report: where parts settle, how fast, and the clearances that leaves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.gearbox.heat.expansion import HOTTEST
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.report.ink.axes import nice_step
from cqdd_design.report.ink.charts import Curve, line_chart
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Words
from cqdd_design.report.judgement.duty import held_speed_text

if TYPE_CHECKING:
    from cqdd_design.machine.temperatures import MachineTemperatures

_DRAWN = {"winding": "series-1", "disc": "series-2", "housing": "series-3"}
"""Parts whose warming is drawn, by style."""
_TICKS = 6


def temperatures_view(found: MachineTemperatures) -> Values:
    """Rows of (part, temperature), rows of (name, value, remark), and a figure."""
    hot, heat = found.hot, float(found.duty.heat.at(found.steady).sum())
    asked = found.machine.design.requirements
    at = (
        "the duty"
        if asked.load_cases
        else f"{with_unit(asked.continuous_torque, 'N*m')} for ever at {held_speed_text(asked)}"
    )
    ambient, stated = found.network.ambient, found.machine.cooling.value
    air = f"still air of {significant(ambient)} °C"
    if stated:
        air = f"air of {significant(ambient)} °C, {stated:g} K/W from the winding as stated"
    clearance = "of rigid parts, at these temperatures"
    if not np.array_equal(found.reached, found.steady):
        clearance = (
            f"of rigid parts, on the way there, the warmest of the gearbox at {HOTTEST:g} °C"
        )
    return {
        "told": f"Where the parts settle under {at}, in {air}: {significant(heat, 3)} W in all, of "
        f"which {significant(found.duty.gearbox, 3)} W in the gearbox "
        f"({significant(found.as_drawn.gearbox, 3)} before parts are warm).",
        "parts": [
            (name, significant(float(value), 3))
            for name, value in zip(NODES, found.steady, strict=True)
        ],
        "rows": (
            (
                "backlash when warm",
                with_unit(math.degrees(hot.free.mean) * 60.0, "arcmin", 3),
                clearance,
            ),
            ("least gap", with_unit(hot.least_gap * 1e6, "um", 3), "in the nominal pose"),
            ("preload", with_unit(hot.overlap * 1e6, "um", 3), "overlap that no motion removes"),
            *_over_cycle(found),
            ("time constant", with_unit(found.settling_time / 60.0, "min", 3), "of the slowest"),
        ),
        "figures": (_warming(found),),
    }


def _over_cycle(found: MachineTemperatures) -> tuple[tuple[str, str, str], ...]:
    """The winding over a duty's cycle, where it has one."""
    if found.cycle is None:
        return ()
    most, when = found.cycle.winding
    return (
        (
            "hottest winding",
            f"{significant(most, 3)} °C",
            f"in every cycle after {significant(when, 3)} s",
        ),
    )


def _warming(found: MachineTemperatures) -> object:
    minutes = np.concatenate([[0.0], found.times / 60.0])
    start = np.full((1, len(NODES)), found.network.ambient)
    history = np.concatenate([start, found.history])
    step = nice_step(float(minutes[-1]), _TICKS)
    ticks = [step * k for k in range(math.ceil(minutes[-1] / step) + 1)]
    curves = [
        Curve(name, np.maximum(history[:, NODES.index(name)], 0.0), style)
        for name, style in _DRAWN.items()
    ]
    return line_chart(
        Words(
            "warming",
            "Warming up",
            "Temperatures of winding, discs and housing over time.",
            "From the temperature of the air on, losses as at its end.",
        ),
        minutes,
        curves,
        x_label="time, min",
        y_label="temperature, °C",
        x_ticks=ticks,
    )
