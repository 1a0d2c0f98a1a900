"""Where a disc undercuts, and lengths as sentences quote them: rounded to the allowed side."""

from __future__ import annotations

import math
from collections.abc import Callable

from cqdd_design.geometry.trochoid import undercut_radius_limit

# Limits are not allowed values themselves: a round one is told as the next number inside.
_STRICT = 1e-9


def rounded_down(value: float, digits: int = 3) -> float:
    """Return `value` > 0 rounded down to `digits` significant digits.

    Examples
    --------
    >>> rounded_down(1.9387)
    1.93
    """
    return _rounded(value * (1.0 - _STRICT), digits, math.floor)


def rounded_up(value: float, digits: int = 3) -> float:
    """Return `value` > 0 rounded up to `digits` significant digits."""
    return _rounded(value * (1.0 + _STRICT), digits, math.ceil)


def _rounded(value: float, digits: int, how: Callable[[float], int]) -> float:
    places = digits - 1 - math.floor(math.log10(value))
    scale = 10.0 ** abs(places)
    return how(value * scale) / scale if places >= 0 else how(value / scale) * scale


def millimetres(value: float) -> str:
    """Return a length in m as it is shown to people, such as ``2.4 mm``."""
    return f"{value * 1e3:.6g} mm"


def at_most(limit: float) -> str:
    """A limit in m as the next length in mm below it."""
    return f"{rounded_down(limit * 1e3):.6g} mm"


def at_least(limit: float) -> str:
    """A limit in m as the next length in mm above it."""
    return f"{rounded_up(limit * 1e3):.6g} mm"


def _bisect(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Boundary between `low`, where `holds` is true, and `high`, where it is not."""
    for _ in range(80):
        middle = 0.5 * (low + high)
        if holds(middle):
            low = middle
        else:
            high = middle
    return low


def largest_eccentricity(lobe_count: int, ring_pitch_radius: float, tooth_radius: float) -> float:
    """Eccentricity (m) below which a tooth of this radius does not undercut the disc.

    The undercut limit falls steadily from R to 0 as K1 goes from 0 to 1, so the boundary is one.
    """
    return _bisect(
        lambda e: float(undercut_radius_limit(lobe_count, ring_pitch_radius, e)) > tooth_radius,
        0.0,
        ring_pitch_radius / (lobe_count + 1),
    )


def smallest_pitch_radius(lobe_count: int, eccentricity: float, tooth_radius: float) -> float:
    """Ring pitch radius (m) above which a tooth of this radius does not undercut the disc."""
    low = eccentricity * (lobe_count + 1)
    high = 2.0 * max(low, tooth_radius)
    while float(undercut_radius_limit(lobe_count, high, eccentricity)) <= tooth_radius:
        high *= 2.0
    return _bisect(
        lambda R: float(undercut_radius_limit(lobe_count, R, eccentricity)) > tooth_radius,
        high,
        low,
    )
