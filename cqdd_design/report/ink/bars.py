"""Horizontal bars and histograms as inline SVG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cqdd_design.report.ink.charts import nice_step
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, line, rectangle, text

FloatArray = NDArray[np.float64]

_WIDTH = 430.0
_LEFT, _RIGHT = 58.0, 16.0
_NAME_PITCH, _TICK_PITCH = 6.7, 6.4  # px per character, a little generous


def bar_chart(
    id_: str,
    title: str,
    description: str,
    *,
    names: Sequence[str],
    values: Sequence[float],
    shown: Sequence[str],
    caption: str,
    marks: Sequence[float] | None = None,
    half_widths: Sequence[float] | None = None,
    full: float = 0.0,
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
    half_widths : sequence of float, optional
        Uncertainty of each value, drawn as a thin line about the bar's end.
    full : float
        Least value that the longest possible bar stands for, so that charts share a scale.
    """
    pitch = 24.0
    left = max(60.0, 12.0 + _NAME_PITCH * max(map(len, names)))
    right = 20.0 + _TICK_PITCH * max(map(len, shown))
    reach = _WIDTH - left - right
    ends = [v + w for v, w in zip(values, half_widths or [0.0] * len(values), strict=True)]
    most = max([*ends, *(marks or ()), full, 1e-12])
    body = []
    for k, (name, value, label) in enumerate(zip(names, values, shown, strict=True)):
        y = 8.0 + pitch * k
        body.append(text((left - 8.0, y + 12.5), name, "name-dark", "end"))
        length = max(reach * value / most, 0.75)
        body.append(rectangle(left, y + 2.0, length, 14.0, "share-bar"))
        furthest = length
        if half_widths is not None and half_widths[k] > 0.0:
            begin = left + reach * max(value - half_widths[k], 0.0) / most
            furthest = reach * ends[k] / most
            body.append(line((begin, y + 9.0), (left + furthest, y + 9.0), "whisker"))
        if marks is not None:
            at = reach * max(marks[k], 0.0) / most
            furthest = max(furthest, at)
            body.append(line((left + at, y), (left + at, y + 18.0), "bar-one"))
        body.append(text((left + furthest + 7.0, y + 13.0), label, "tick"))
    height = 12.0 + pitch * len(names)
    return Figure(id_, title, description, _WIDTH, height, "".join(body), caption)


def histogram(
    id_: str,
    title: str,
    description: str,
    *,
    values: FloatArray,
    marks: Sequence[tuple[str, float]],
    x_label: str,
    caption: str,
    bins: int = 30,
) -> Figure:
    """A histogram with named percentiles.

    Parameters
    ----------
    values : array (S,)
    marks : sequence of (str, float)
        Drawn as vertical lines with their names, in rising order.
    bins : int
        At most this many.
    """
    width, height, top_px, bottom = _WIDTH, 252.0, 52.0, 44.0
    low, high = float(values.min()), float(values.max())
    step = nice_step(max(high - low, 1e-9), bins)
    first, last = np.floor(low / step), np.ceil(high / step) + (high == low)
    edges = step * np.arange(first, max(last, first + 1.0) + 0.5)
    counts, edges = np.histogram(values, edges)
    plot_w, plot_h = width - _LEFT - _RIGHT, height - top_px - bottom
    most = max(int(counts.max()), 1)
    reach = float(edges[-1] - edges[0])

    def place(value: float) -> float:
        return _LEFT + plot_w * (value - float(edges[0])) / reach

    base = top_px + plot_h
    body = []
    for count, begin, end in zip(counts, edges[:-1], edges[1:], strict=True):
        tall = plot_h * float(count) / most
        x0, x1 = place(float(begin)), place(float(end))
        if count:
            body.append(rectangle(x0 + 0.5, base - tall, x1 - x0 - 1.0, tall, "share-bar"))
    body.append(line((_LEFT, base), (width - _RIGHT, base), "axis"))
    ticks = nice_step(reach, 6)
    tick = ticks * np.ceil(float(edges[0]) / ticks - 1e-9)
    while tick <= float(edges[-1]) + 1e-9 * ticks:
        body.append(line((place(tick), base), (place(tick), base + 4.0), "axis"))
        body.append(text((place(tick), base + 17.0), significant(float(tick)), "tick", "middle"))
        tick += ticks
    for k, (name, value) in enumerate(marks):
        at = place(value)
        # Each on a level of its own, so that close percentiles can be told apart.
        top = top_px - 6.0 - 13.0 * (k % 3)
        shown = f"{name} {significant(value, 3)}"
        room = 0.5 * _TICK_PITCH * len(shown)
        body.append(line((at, top), (at, base), "percentile"))
        place_x = min(max(at, room + 2.0), width - room - 2.0)
        body.append(text((place_x, top - 3.0), shown, "tick", "middle"))
    body.append(text((_LEFT + plot_w / 2.0, height - 8.0), x_label, "label", "middle"))
    middle = top_px + plot_h / 2.0
    body.append(text((14.0, middle), "gearboxes", "label", "middle", turn=-90.0))
    body.append(text((_LEFT - 7.0, top_px + 4.0), str(most), "tick", "end"))
    return Figure(id_, title, description, width, height, "".join(body), caption)
