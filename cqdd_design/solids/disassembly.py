"""In which order the machine comes apart along its axis.

Nothing here knows a part by name. Every station has a key, the height of its widest place, and
stations that are nested one in the other must leave in the order in which their material lets
them: a cup lets its contents out on its open side. The order is that of the keys as far as the
nesting allows.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from cqdd_design.solids.stations import Station

_SLACK = 1e-5
"""Lengths closer than this count as equal, m."""
_STEP = 1e-6
"""By which a key passes another, m."""


def disassembly_order(stations: Sequence[Station]) -> list[int]:
    """Indices of the stations from the lowest to the highest.

    Keys decide. A container's key gives way to those of its contents, a fastener's to those of
    what it holds; rules that contradict each other, which odd machines may have, stop after as
    many rounds as there are stations.
    """
    count = len(stations)
    middle = _middle(stations)
    keys = [station.middle for station in stations]
    rules = [
        (mover, other, upward)
        for mover, other in itertools.permutations(range(count), 2)
        if (upward := _goes_above(stations[mover], stations[other], middle)) is not None
    ]
    for _ in range(count):
        before = list(keys)
        for mover, other, upward in rules:
            if stations[mover].off_axis:
                continue
            if upward:
                keys[mover] = max(keys[mover], keys[other] + _STEP)
            else:
                keys[mover] = min(keys[mover], keys[other] - _STEP)
        for mover in range(count):
            over = [keys[other] for m, other, upward in rules if m == mover and upward]
            under = [keys[other] for m, other, upward in rules if m == mover and not upward]
            # A fastener lies next to what it holds, on the side of its head.
            if stations[mover].off_axis and bool(over) != bool(under):
                keys[mover] = max(over) + _STEP if over else min(under) - _STEP
        if keys == before:
            break
    # Of two at one height the slender one stays nearer to the middle.
    return sorted(
        range(count),
        key=lambda i: (
            round(keys[i], 9),
            stations[i].outer if keys[i] > middle else -stations[i].outer,
            i,
        ),
    )


def _middle(stations: Sequence[Station]) -> float:
    """Height of the middle of the discs, from which the machine comes apart, m."""
    among = [s for s in stations if s.body.kind == "disc"] or stations
    return 0.5 * (min(s.bottom for s in among) + max(s.top for s in among))


def _goes_above(mover: Station, other: Station, middle: float) -> bool | None:
    """Whether a container or fastener goes above another station; None where nothing binds it."""
    if mover.off_axis:
        return None if other.off_axis else _held_from_above(mover, other)
    upward = _leaves_upward(other, mover, middle)
    if upward is not None:
        return not upward
    return None if other.off_axis else _blocked(mover, other)


def _blocked(mover: Station, other: Station) -> bool | None:
    """Whether a collar of another station lets one out upward only; None if nothing binds it."""
    core = mover.widest
    if other.bottom > core.top - _SLACK or other.top < core.bottom + _SLACK:
        return None
    if _nested(mover, other):
        return None
    across = [
        span
        for span in other.spans
        if span.inner < core.outer - _SLACK and span.outer > core.inner + _SLACK
    ]
    over = any(span.bottom >= core.top - _SLACK for span in across)
    under = any(span.top <= core.bottom + _SLACK for span in across)
    return None if over == under else under


def _held_from_above(fastener: Station, held: Station) -> bool | None:
    """Whether a fastener's head lies above what its shank runs through; None if it does not."""
    head, radius = fastener.widest, fastener.axis_distance
    pierced = [
        span
        for span in held.spans
        if span.inner < radius < span.outer
        and span.bottom < fastener.top - _SLACK
        and span.top > fastener.bottom + _SLACK
    ]
    if not pierced:
        return None
    if held.bottom <= fastener.bottom + _SLACK and held.top >= fastener.top - _SLACK:
        # A pin within what it sits in comes out beside it.
        return True
    over = any(span.top <= head.bottom + _SLACK for span in pierced)
    under = any(span.bottom >= head.top - _SLACK for span in pierced)
    return None if over == under else over


def _leaves_upward(inside: Station, outside: Station, middle: float) -> bool | None:
    """Whether the inner of two nested stations leaves the outer upward; None if not nested."""
    if outside.off_axis or not _nested(inside, outside):
        return None
    core = inside.widest
    under = _blocks(outside, core.outer, -math.inf, core.bottom)
    over = _blocks(outside, core.outer, core.top, math.inf)
    if under != over:
        return under
    collar = _blocked(outside, inside)
    return outside.middle < middle - _SLACK if collar is None else not collar


def _nested(inside: Station, outside: Station) -> bool:
    """Whether one station's widest place lies within the other, at a common height."""
    core = inside.widest
    return any(
        span.bottom < core.top - _SLACK
        and span.top > core.bottom + _SLACK
        and core.inner <= span.inner + _SLACK
        and core.outer < span.outer - _SLACK
        and core.inner < span.inner
        for span in outside.spans
    )


def _blocks(outside: Station, radius: float, low: float, high: float) -> bool:
    """Whether the outer station has material in the way between two heights."""
    return any(
        span.bottom >= low - _SLACK and span.top <= high + _SLACK and span.inner < radius - _SLACK
        for span in outside.spans
    )
