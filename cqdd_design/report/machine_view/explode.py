"""The machine taken apart along its axis: how far each station moves in the picture."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

from cqdd_design.solids.disassembly import disassembly_order
from cqdd_design.solids.stations import Station


def take_apart(stations: Sequence[Station], tilt: float) -> tuple[list[int], list[float]]:
    """Order and shifts of the stations.

    Parameters
    ----------
    tilt : float
        Angle between the axis and the line of sight of the picture, rad: the flatter the look,
        the more room a plate needs so as not to hide the piece behind it.

    Returns
    -------
    order : list of int
        Indices of the stations from the lowest to the highest.
    shifts : list of float
        How far each station has moved along the axis, m, in the stations' own order.
    """
    order = disassembly_order(stations)
    gaps = [_gap(stations[a], stations[b], tilt) for a, b in itertools.pairwise(order)]
    place = 0.0
    shifts = dict.fromkeys(order, 0.0)
    for position, index in enumerate(order):
        station = stations[index]
        if position:
            place += gaps[position - 1]
        shifts[index] = place - station.bottom
        place += station.top - station.bottom
    centre = _rest(stations, shifts)
    return order, [shifts[i] - centre for i in range(len(stations))]


def _rest(stations: Sequence[Station], shifts: Mapping[int, float]) -> float:
    """The shift taken off all: the heaviest fixed station near the middle stays in place."""
    middle = 0.5 * (min(shifts.values()) + max(shifts.values()))
    fixed = [i for i, s in enumerate(stations) if s.body.kind == "housing" and not s.off_axis]
    among = fixed or list(shifts)
    return shifts[min(among, key=lambda i: (abs(shifts[i] - middle), i))]


def _gap(lower: Station, upper: Station, tilt: float) -> float:
    """Free length between two neighbours, m."""
    # The near edge of the upper one reaches down the page by its radius times cot(tilt).
    wanted = (upper.outer - 0.35 * lower.outer) / math.tan(tilt)
    return max(wanted, 0.14 * max(lower.outer, upper.outer))
