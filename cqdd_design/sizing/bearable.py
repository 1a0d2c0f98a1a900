"""Less torque where none was stated and no gearbox bears what the motor could do."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.agreement import Found, Hunt, Space, spaces, strongest
from cqdd_design.sizing.finish import torque_reserve

_LESS, _TURNS = 0.9, 12
"""Share of both torques that is tried next where the strongest design would bear them, and how
often."""
JUST = 0.98
"""Of what the strongest design bears."""
_LEAST = 0.1
"""Share of a torque that is tried at least."""
_DIGITS = 2
_LASTING = ("-CONTINUOUS", "-LIFE")
"""Ends of the lines at the continuous torque."""


def or_weaker(
    hunt: Hunt, search: Callable[[], Found | None], near: Found | None = None
) -> Found | None:
    """A search, repeated for less torque where none was stated and none is carried.

    Parameters
    ----------
    near : Found, optional
        A design near by, whose space and needs count.
    """
    lowered: tuple[bool, bool] = (False, False)
    for turn in range(_TURNS):
        found = search()
        if found is not None or PEAK not in hunt.requirements.derived:
            return found
        peak, lasting = bearable(hunt, near)
        if min(peak, lasting) < 1.0:
            lowered = lowered[0] or peak < 1.0, lowered[1] or lasting < 1.0
            peak, lasting = (JUST * one if one < 1.0 else one for one in (peak, lasting))
        else:
            # Of what has been too much so far, and in the end of both.
            both = not any(lowered) or turn >= _TURNS // 2
            peak, lasting = (_LESS if both or one else 1.0 for one in lowered)
        # What was lowered for part errors is not raised to what the motor holds.
        hunt.lowered |= bool(hunt.extra) and lasting < 1.0
        hunt.requirements = weaker(hunt.requirements, peak, lasting)
    return None


def weaker(requirements: Requirements, peak: float, lasting: float) -> Requirements:
    """The requirements with shares of the torques that were not stated.

    Parameters
    ----------
    peak, lasting : float
        Of the peak and of the continuous torque; this is never left above that.
    """
    most = requirements.peak_torque
    if PEAK in requirements.derived and peak < 1.0:
        most = rounded_down(peak * most, _DIGITS)
    least = requirements.continuous_torque
    if CONTINUOUS in requirements.derived:
        least = min(rounded_down(lasting * least, _DIGITS) if lasting < 1.0 else least, most)
    return requirements.model_copy(update={PEAK: most, CONTINUOUS: least})


def bearable(hunt: Hunt, near: Found | None) -> tuple[float, float]:
    """Shares, up to 1, of the peak and of the continuous torque that the strongest design bears.

    The strongest is no stronger at one torque than it has to be for the other; where it is short
    of both, one that has to bear less of what it is shortest of may bear more of the other.
    """
    asked, first = hunt.requirements, _strongest(hunt, near)
    if max(first) == 1.0:
        return first
    short = 0 if first[0] < first[1] else 1
    shares = [JUST * one if place == short else 1.0 for place, one in enumerate(first)]
    second = _strongest(replace(hunt, requirements=weaker(asked, *shares)), near)
    other = shares[0] * second[0], shares[1] * second[1]
    return max(first, other, key=math.prod)


def _strongest(hunt: Hunt, near: Found | None) -> tuple[float, float]:
    if near is not None:
        return _in_space(hunt, near.space._replace(fit=hunt.fit), near.needs)
    every = spaces(hunt.requirements, hunt.fit, hunt.pins)
    return max((_in_space(hunt, space, {}) for space in every), key=min)


def _in_space(hunt: Hunt, space: Space, needs: Mapping[str, float]) -> tuple[float, float]:
    try:
        strong = strongest(hunt, space, needs)
    except InfeasibleError:
        strong = None
    if strong is None:
        return _LESS, _LESS
    design = strong.machine.design
    reserves = {
        line.id: torque_reserve(line, design) / hunt.extra.get(line.id, 1.0)
        for line in strong.checks
        if line.known
    }
    lasting = [one for name, one in reserves.items() if name.endswith(_LASTING)]
    peak = [one for name, one in reserves.items() if not name.endswith(_LASTING)]
    return _within(min(peak, default=1.0)), _within(min(lasting, default=1.0))


def _within(share: float) -> float:
    return min(max(share, _LEAST), 1.0)
