"""Horizontal bars and histograms as inline SVG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.axes import (
    LEFT,
    NARROW,
    RIGHT,
    axis_names,
    linear_axis,
    nice_step,
    tick_below,
)
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, Words, line, rectangle, text

NAME_PITCH, TICK_PITCH = 6.7, 6.4
"""px per character of names and numbers, a little generous."""
_MOST_BINS = 30


def bar_chart(
    words: Words,
    names: Sequence[str],
    values: Sequence[float],
    shown: Sequence[str],
    marks: Sequence[float] | None = None,
) -> Figure:
    """Horizontal bars from a common zero, each with its name and value.

    Parameters
    ----------
    names, shown : sequences of str
        Left of each bar and right of it.
    values : sequence of float
        Not negative; lengths are in proportion.
    marks : sequence of float, optional
        A second value of each bar, drawn as a tick across it.
    """
    pitch = 24.0
    left = max(60.0, 12.0 + NAME_PITCH * max(map(len, names)))
    reach = NARROW - left - 20.0 - TICK_PITCH * max(map(len, shown))
    most = max([*values, *(marks or ()), 1e-12])
    body = []
    for k, (name, value, label) in enumerate(zip(names, values, shown, strict=True)):
        y = 8.0 + pitch * k
        body.append(text((left - 8.0, y + 12.5), name, "name-dark", "end"))
        furthest = max(reach * value / most, 0.75)
        body.append(rectangle(left, y + 2.0, furthest, 14.0, "share-bar"))
        if marks is not None:
            at = reach * max(marks[k], 0.0) / most
            furthest = max(furthest, at)
            body.append(line((left + at, y), (left + at, y + 18.0), "bar-one"))
        body.append(text((left + furthest + 7.0, y + 13.0), label, "tick"))
    return words.figure(NARROW, 12.0 + pitch * len(names), body)


def histogram(
    words: Words,
    values: FloatArray,
    marks: Sequence[tuple[str, float]],
    x_label: str,
) -> Figure:
    """A histogram of gearboxes with named percentiles.

    Parameters
    ----------
    values : array (S,)
    marks : sequence of (str, float)
        Drawn as vertical lines with their names, in rising order.
    x_label : str
        With the unit.
    """
    height, top, base = 252.0, 52.0, 208.0
    low, high = float(values.min()), float(values.max())
    step = nice_step(max(high - low, 1e-9), _MOST_BINS)
    first, last = np.floor(low / step), np.ceil(high / step) + (high == low)
    edges = step * np.arange(first, max(last, first + 1.0) + 0.5)
    counts, edges = np.histogram(values, edges)
    width = NARROW - LEFT - RIGHT
    begin, reach = float(edges[0]), float(edges[-1] - edges[0])
    most = max(int(counts.max()), 1)

    def place(value: float) -> float:
        return LEFT + width * (value - begin) / reach

    body = []
    for count, x0, x1 in zip(counts, map(place, edges[:-1]), map(place, edges[1:]), strict=True):
        tall = (base - top) * float(count) / most
        if count:
            body.append(rectangle(x0 + 0.5, base - tall, x1 - x0 - 1.0, tall, "share-bar"))
    body.append(line((LEFT, base), (NARROW - RIGHT, base), "axis"))
    for tick in linear_axis(begin, float(edges[-1]), "", tight=True).ticks:
        body += tick_below(place(tick), base, tick)
    for k, (name, value) in enumerate(marks):
        at = place(value)
        # Each on a level of its own, so that close percentiles can be told apart.
        level = top - 6.0 - 13.0 * (k % 3)
        shown = f"{name} {significant(value, 3)}"
        room = 0.5 * TICK_PITCH * len(shown) + 2.0
        body.append(line((at, level), (at, base), "percentile"))
        beside = (min(max(at, room), NARROW - room), level - 3.0)
        body.append(text(beside, shown, "tick", "middle"))
    middle = (LEFT + width / 2.0, top + (base - top) / 2.0)
    body += axis_names((middle[0], height - 8.0, x_label), (middle[1], "gearboxes"))
    body.append(text((LEFT - 7.0, top + 4.0), str(most), "tick", "end"))
    return words.figure(NARROW, height, body)
