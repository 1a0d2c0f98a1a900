"""What is asked of the next search where a design's shaft, or what it runs in, is too weak.

A cam bearing with a wider bore leaves a thicker shaft and room for larger bearings at its ends, and
takes material from the discs. Where the peak torque was not stated, less of it may cost less.
"""

from __future__ import annotations

import math
from dataclasses import replace

from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.agreement import Found, Hunt
from cqdd_design.sizing.bearable import JUST, bearable, weaker
from cqdd_design.verdict import Verdict

BOND = "BELL-JOINT"
AT_PEAK = frozenset({"SHAFT-STRENGTH", "SUPPORT-STATIC"})
"""Lines of the shaft in proportion to the peak torque."""
SHAFT = AT_PEAK | {"SHAFT-FATIGUE", "SUPPORT-LIFE", BOND}
"""Lines that a cam bearing with a wider bore helps."""
_WIDER, _SAME = 1.001, 0.999
"""Of a bore: the least of the next wider one, and one that is no narrower."""


def stronger_shaft(hunt: Hunt, found: Found, judged: Verdict) -> None:
    """Have the next search make a stronger shaft, or ask less of it where that leaves more torque.

    Parameters
    ----------
    judged : Verdict
        On the design, with lines of `SHAFT` that it does not meet.
    """
    bore = judged.evidence.machine.cam.bore_diameter
    wider = replace(hunt, least_bore=_WIDER * bore)
    short = [line for line in judged.lines if line.status in {"fail", "unknown"}]
    lines = [line for line in short if line.id in SHAFT]
    if PEAK in hunt.requirements.derived and all(
        line.known and line.id in AT_PEAK for line in lines
    ):
        share = JUST * min(line.margin for line in lines)
        left = hunt.frame(found.space, {}).bearings
        if (
            all(one.bore_diameter < wider.least_bore for one in left)
            or math.prod(bearable(wider, found)) < share
        ):
            hunt.requirements = weaker(hunt.requirements, share, 1.0)
            # What a shaft as thick as this bears is known.
            hunt.least_bore = _SAME * bore
            return
    hunt.least_bore = wider.least_bore
