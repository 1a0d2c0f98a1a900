"""Figure of measured.md: loops of a motor against a locked output, measured and predicted.

What is drawn of the records is read off them: both loaded branches as straight lines, where they
were read, and where the loop crosses zero torque, the middle of its play at zero.
"""

from __future__ import annotations

import math

import numpy as np
from measured import LARGE, PLACES, SPECIMENS, largest, loops, predicted

from cqdd_design.actuator.bench.readings import LOADED_FROM
from cqdd_design.report.ink.axes import Legend, Panel, linear_axis
from cqdd_design.report.ink.svg import Figure, Words

_WIDTH = 720.0


def loaded() -> Figure:
    """The PC-CF baseline: branches of the records, and the loop predicted before any fit."""
    one = SPECIMENS[1]
    found = predicted(one.material)
    torque, angle = found.cycle(largest(found))
    panel = Panel(
        "locked",
        linear_axis(-25.0, 25.0, "torque of the motor at the output, N·m", most=6),
        linear_axis(-3.6, 3.6, "angle of the motor at the output, deg", most=8),
        62.0,
        60.0,
        636.0,
        330.0,
    )
    body = [*panel.frame(), panel.across(0.0, "grid")]
    cycles = loops(one.record, tuple(LARGE))
    each = len(cycles) // len(PLACES)
    for place in range(len(PLACES)):
        own = cycles[place * each : (place + 1) * each]
        half = 0.5 * math.degrees(float(np.mean([cycle.play for cycle in own])))
        slope, reach, peak = (
            float(np.mean([getattr(cycle, what) for cycle in own]))
            for what in ("compliance", "reach", "peak")
        )
        ends = peak * np.array([LOADED_FROM, 1.0])
        for sense in (1.0, -1.0):
            branch = sense * np.degrees(reach - slope * (peak - ends))
            body.append(panel.curve(sense * ends, branch, "series-2"))
            body.append(panel.dot(0.0, sense * half, "other-dot"))
    body.append(panel.curve(torque, np.degrees(angle), "series-1"))
    entries = [
        (f"predicted, no fit, up to {largest(found):.0f} N·m", "series-1"),
        (f"{one.title}: loaded branches and play read at {len(PLACES)} places", "series-2"),
    ]
    body.append(Legend(entries, right=_WIDTH).render())
    words = Words(
        "measured-loops",
        "A motor against a locked output, measured and predicted",
        "Angle over torque: the loop that the toolkit predicts for the printed actuator without "
        "any fit, and the loaded branches and the play read off the thesis' records.",
    )
    return words.figure(_WIDTH, panel.bottom + 43.0, body)
