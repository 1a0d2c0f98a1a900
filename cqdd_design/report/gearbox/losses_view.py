"""Losses in the report: where the power goes, efficiency over speed and torque, backdriving."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.heat import labelled_map
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.svg import Figure

if TYPE_CHECKING:
    from cqdd_design.machine.contact_analysis import ContactAnalysis

_RPM = 30.0 / math.pi


@dataclass(frozen=True)
class LossesView:
    """What the section shows: figures, and rows of (name, value, remark)."""

    figures: tuple[Figure, ...]
    rows: tuple[tuple[str, str, str], ...]


def losses_view(analysis: ContactAnalysis) -> LossesView:
    """Values of the section."""
    found = analysis.losses
    torque = with_unit(found.torque, "N*m")
    speed = with_unit(found.input_speed * _RPM, "rpm")
    sources = found.by_source
    bars = bar_chart(
        "loss-bars",
        "Where the power goes",
        f"Losses by source at {torque} and {speed}, {significant(found.total, 3)} W in all.",
        names=[name.replace("_", " ") for name in sources],
        values=list(sources.values()),
        shown=[f"{significant(value, 3)} W" for value in sources.values()],
        caption=f"{significant(found.total, 3)} W in all at {torque} and {speed} of the input: "
        "Coulomb friction, bearings and the shear of the grease; no Stribeck curve.",
    )
    grid = analysis.map
    order = slice(None, None, -1)
    chart = labelled_map(
        "efficiency-map",
        "Forward efficiency",
        "Forward efficiency of the gearbox over input speed and output torque, in per cent.",
        values=grid.forward.T[order],
        rows=[significant(float(t), 3) for t in grid.torque[order]],
        columns=[significant(float(w) * _RPM, 3) for w in grid.input_speed],
        row_label="output torque, N\u00b7m",
        column_label="input speed, rpm",
        caption="Per cent, the motor driving; the gearbox alone.",
    )
    return LossesView((bars, chart), _rows(analysis))


def _rows(analysis: ContactAnalysis) -> tuple[tuple[str, str, str], ...]:
    found = analysis.losses
    back = found.backdrive
    turns = "the output turns the gearbox" if found.backdrives else "the gearbox holds itself"
    rows = [
        ("forward efficiency", _share(found.efficiency_forward), "the motor drives"),
        ("backward efficiency", _share(found.efficiency_backward), f"the output drives; {turns}"),
    ]
    for name, value in (
        ("backdrive torque, breakaway", back.static_torque),
        ("backdrive torque, running", back.dynamic_torque),
    ):
        shown = "does not turn" if value is None else with_unit(value, "N*m", 3)
        rows.append((name, shown, "at the output; without motor cogging, seals and preloads"))
    rows.append(
        (
            "friction's own effect on the tooth forces",
            _share(found.tooth_force_change),
            "left out of every other figure",
        )
    )
    return tuple(rows)


def _share(value: float | None) -> str:
    return "\u2013" if value is None else f"{significant(100.0 * value, 3)}\u202f%"
