"""Axial play in the report: the stacks of lengths, the shims that set them, and what heat does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.errors import DesignError
from cqdd_design.machine.centring import centring
from cqdd_design.machine.motor_standing import motor_standing
from cqdd_design.machine.sealing import sealing
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.page import Values
from cqdd_design.verdict.retention_lines import axial_growth

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.machine.temperatures import MachineTemperatures
    from cqdd_design.solids.axial import AxialStack


def axial_view(machine: Machine, warm: MachineTemperatures | None) -> Values | None:
    """Rows of the plays, and a table of lengths for each; None where nothing can be laid out."""
    try:
        stacks = machine.told_stacks
    except DesignError:
        return None
    return {
        "standing": motor_standing(machine),
        "centring": centring(machine),
        "sealing": sealing(machine),
        "plays": [_play(one, warm) for one in stacks],
        "stacks": [
            {
                "name": one.name,
                "rows": [
                    (
                        length.part,
                        length.what,
                        significant(1e3 * length.nominal, 4),
                        f"{1e3 * length.upper:+.2f} / {1e3 * length.lower:+.2f}",
                    )
                    for length in one.lengths
                ],
            }
            for one in stacks
        ],
    }


def _play(stack: AxialStack, warm: MachineTemperatures | None) -> tuple[str, ...]:
    shims = "none: lengths alone"
    if stack.shims is not None and stack.kit is not None:
        shims = f"{stack.shims.designation}, {stack.kit.told}"
    packs = "" if stack.packs is None else _span(stack.packs)
    return (
        stack.name,
        _span(stack.worst),
        _span(stack.likely),
        shims,
        packs,
        _span(stack.play),
        _heat(stack, warm),
    )


def _heat(stack: AxialStack, warm: MachineTemperatures | None) -> str:
    if warm is None:
        return "not known"
    try:
        cold, settled = axial_growth(stack, warm)
    except DesignError:
        return "not known"
    return f"{1e3 * cold:+.3f} / {1e3 * settled:+.3f}"


def _span(pair: tuple[float, float]) -> str:
    return " to ".join(f"{1e3 * value:.2f}" for value in pair)
