"""Figure of the tutorial from gait to knee: the table of the page itself, drawn."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from cqdd_design.report.ink.axes import Panel, linear_axis
from cqdd_design.report.ink.svg import Figure, Words

_PAGE = Path(__file__).resolve().parents[1] / "tutorial-gait-to-knee.md"
_WIDTH, _LEFT, _TOP, _HEIGHT, _BETWEEN = 720.0, 62.0, 30.0, 170.0, 62.0


def gait() -> Figure:
    """Torque and speed over a step, one above the other."""
    found = re.search(r"^```csv\n(.*?)^```$", _PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    assert found is not None
    rows = [line.split(",") for line in found[1].splitlines()[2:]]
    time, torque, speed = np.array(rows, dtype=float).T
    across = linear_axis(0.0, float(time[-1]), "time, s", most=8)
    body = []
    bottom = _TOP
    for name, values in (("torque, N·m", torque), ("speed, rad/s", speed)):
        axis = linear_axis(float(values.min()), float(values.max()), name, most=6)
        panel = Panel(
            f"gait-{name[:5]}", across, axis, _LEFT, bottom, _WIDTH - _LEFT - 22.0, _HEIGHT
        )
        body += [*panel.frame(), panel.across(0.0, "grid"), panel.curve(time, values, "series-1")]
        bottom = panel.bottom + _BETWEEN
    words = Words(
        "tutorial-gait",
        "A step of the knee",
        "Torque and speed of the joint over a step of 0.8 s: a shock and the load of stance, then "
        "a fast swing with little torque.",
    )
    return words.figure(_WIDTH, bottom - _BETWEEN + 43.0, body)
