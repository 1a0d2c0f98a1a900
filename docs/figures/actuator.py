"""Figures of actuator-model.md: the equations as blocks, and what saturation leaves of a loop."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

from cqdd_design.actuator.bench.bandwidth import DOWN, position_bandwidth
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog import paper
from cqdd_design.design import load_design
from cqdd_design.machine import resolve
from cqdd_design.report.ink.axes import Legend, Panel, linear_axis, log_axis
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    Words,
    arrow_head,
    polyline,
    rectangle,
    text,
)

_DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
_WIDTH = 900.0


@cache
def _paper() -> ActuatorParameters:
    return actuator_parameters(resolve(load_design(_DESIGN)))


def scheme() -> Figure:
    """Every state of the model in its block, with the values of the paper's design."""
    body: list[str] = []
    for name, lines in _blocks(_paper()).items():
        body += _block(name, *lines)
    x1, x2, x3 = (_COLUMNS[k] for k in range(3))
    y1, y2, y3 = (_ROWS[k] for k in range(3))
    upper, lower = 24.0, 64.0  # px from a block's top to its two wires
    body += [
        *_wire([(120.0, 14.0), (120.0, y1)], "command: voltage, current, torque, position", 1.0),
        *_wire([(x1 + _WIDE, y1 + upper), (x2, y1 + upper)], "V"),
        *_wire([(x2, y1 + lower), (x1 + _WIDE, y1 + lower)], "I"),
        *_wire([(x2 + _WIDE, y1 + upper), (x3, y1 + upper)], "K I"),
        *_wire([(x3, y1 + lower), (x2 + _WIDE, y1 + lower)], "ω"),
        *_wire([(x3 + 60.0, y1 + _HIGH), (x3 + 60.0, y2)], "φ, ω", -1.0),
        *_wire(
            [(x3 + 140.0, y2), (x3 + 140.0, y1 + _HIGH)], "T_g (1/Z_R + ε\u2032) + κ\u2032 W", 1.0
        ),
        *_wire([(x3 + 60.0, y2 + _HIGH), (x3 + 60.0, y3)], "T_g", -1.0),
        *_wire([(x3 + 140.0, y3), (x3 + 140.0, y2 + _HIGH)], "q, dq/dt", 1.0),
        *_wire([(x3, y3 + upper), (x2 + _WIDE, y3 + upper)], "q, dq/dt"),
        *_wire([(x2 + _WIDE, y3 + lower), (x3, y3 + lower)], "torque"),
        *_wire([(x2 + 100.0, y1 + _HIGH), (x2 + 100.0, y2)], "R_m I²", 1.0, "heat"),
        *_wire([(x2, y2 + 44.0), (x1 + _WIDE, y2 + 44.0)], "heat", 0.0, "heat"),
    ]
    under = y2 + _HIGH + 24.0
    way = [(x3, y2 + lower), (x3 - 34.0, y2 + lower), (x3 - 34.0, under), (x1 + 100.0, under)]
    body += _wire([*way, (x1 + 100.0, y2 + _HIGH)], "", 0.0, "heat")
    body.append(text((x1 + 116.0, under - 6.0), "friction, iron loss", "wire-name"))
    words = Words(
        "actuator-scheme",
        "The equations as blocks",
        "Drive, winding, crank side, gearbox, output side and load with what they hand each other, "
        "and the two thermal nodes, with the values of the paper's design.",
    )
    return words.figure(_WIDTH, y3 + _HIGH + 14.0, body)


_COLUMNS, _ROWS = (20.0, 324.0, 628.0), (44.0, 184.0, 332.0)
_WIDE, _HIGH = 200.0, 88.0


def _blocks(one: ActuatorParameters) -> dict[tuple[int, int], tuple[str, str, str]]:
    """Name and two lines of every block, by column and row."""
    motor, gear, drive, thermal = one.motor, one.gear, one.drive, one.thermal
    return {
        (0, 0): (
            "drive",
            f"{drive.supply_voltage:g} V, {drive.current_limit:g} A",
            f"current loop {drive.current_bandwidth:g} Hz",
        ),
        (1, 0): (
            "winding",
            f"R_m {1e3 * motor.resistance:.3g} mΩ, L_m {1e6 * motor.inductance:.3g} µH",
            f"K {motor.torque_constant:.4g} N·m/A",
        ),
        (2, 0): (
            "motor side",
            f"{1e4 * one.motor_side_inertia:.3g} kg·cm²",
            "cogging, iron loss, friction",
        ),
        (0, 1): (
            "heat of the housing",
            f"{thermal.housing_capacity:.3g} J/K",
            f"{thermal.housing_to_ambient:.3g} K/W to the air",
        ),
        (1, 1): (
            "heat of the winding",
            f"{thermal.winding_capacity:.3g} J/K",
            f"{thermal.winding_to_housing:.3g} K/W to the housing",
        ),
        (2, 1): (
            "gearbox",
            f"k {1e-3 * gear.stiffness:.3g} kN·m/rad, p {gear.stiffening:.3g}",
            f"β {math.degrees(gear.backlash) * 60.0:.3g}\u2032, ε(φ), κ(φ)",
        ),
        (1, 2): ("load", "held, free, inertia, driven,", "pendulum, pendulum and wall"),
        (2, 2): (
            "output side",
            f"{1e4 * gear.output_inertia:.3g} kg·cm²",
            "friction",
        ),
    }


def _block(at: tuple[int, int], name: str, first: str, second: str) -> list[str]:
    x, y = _COLUMNS[at[0]], _ROWS[at[1]]
    middle = x + 0.5 * _WIDE
    return [
        rectangle(x, y, _WIDE, _HIGH, "block"),
        text((middle, y + 26.0), name, "block-name", "middle"),
        text((middle, y + 50.0), first, "block-text", "middle"),
        text((middle, y + 70.0), second, "block-text", "middle"),
    ]


def _wire(points: list[Point], name: str, side: float = 0.0, kind: str = "wire") -> list[str]:
    """A line with an arrow at its end, named above its middle or, upright, at one `side`."""
    (x0, y0), (x1, y1) = points[-2:]
    at = (0.5 * (x0 + x1) + 9.0 * side, 0.5 * (y0 + y1) + (4.0 if side else -6.0))
    anchor = {0.0: "middle", 1.0: "start", -1.0: "end"}[side]
    drawn, head = ("wire", "arrow") if kind == "wire" else ("heat-wire", "heat-arrow")
    return [
        polyline(points, drawn),
        arrow_head(points[-1], (x1 - x0, y1 - y0), head),
        text(at, name, "wire-name", anchor) if name else "",
    ]


def position() -> Figure:
    """Gain of the position loop at two amplitudes, and the frequencies beyond saturation."""
    one = _paper()
    panel = Panel(
        "position",
        log_axis(0.5, 60.0, "frequency, Hz"),
        linear_axis(-18.0, 6.0, "gain of the fundamental, dB", most=5),
        62.0,
        42.0,
        636.0,
        250.0,
    )
    down = 20.0 * math.log10(DOWN)
    body = [*panel.frame(), panel.across(down)]
    entries = []
    for amplitude, class_, measured in (
        (45.0, "series-1", "position_bandwidth_45deg"),
        (5.0, "series-2", "position_bandwidth_5deg"),
    ):
        found = position_bandwidth(one, amplitude, paper.SUPPLY_VOLTAGE)
        frequency, gain = found.trace["frequency [Hz]"], found.trace["gain"]
        level = 20.0 * np.log10(gain / gain[0])
        body.append(panel.curve(frequency, level, class_))
        limits = {
            "speed": found.details["limit_by_speed_Hz"],
            "torque": found.details["limit_by_torque_Hz"],
        }
        by = min(limits, key=limits.__getitem__)
        body.append(panel.upright(limits[by], f"stop {class_}"))
        end = panel.place(limits[by], panel.y.high)
        told = f"{amplitude:g}°, {by}: {limits[by]:.1f} Hz"
        body.append(text((end[0] + 5.0, end[1] + 12.0), told, "tick"))
        printed = paper.METRICS[measured].value
        at = panel.place(printed, down)
        body.append(panel.dot(printed, down, "other-dot"))
        body.append(text((at[0] - 7.0, at[1] - 6.0), f"paper {printed:g} Hz", "tick", "end"))
        entries.append((f"{amplitude:g}° amplitude: bench {found.value:.1f} Hz", class_))
    end = panel.place(panel.x.low, down)
    body.append(text((end[0] + 6.0, end[1] - 5.0), "\u22123 dB", "limit-label"))
    body.append(Legend(entries, right=720.0).render())
    words = Words(
        "actuator-position",
        "Position loop and saturation",
        "Gain of the position loop over frequency at 45 and 5 degrees, the frequency that a "
        "saturated drive cannot pass at either, and the bandwidths that the paper measured.",
    )
    return words.figure(720.0, panel.bottom + 43.0, body)
