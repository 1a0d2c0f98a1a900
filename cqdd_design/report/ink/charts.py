"""Line charts and margin bars as inline SVG, drawn to be read on paper as well."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.axes import (
    LEFT,
    NARROW,
    Axis,
    Legend,
    Panel,
    axis_names,
    nice_step,
    tick_below,
)
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    Words,
    circle,
    element,
    line,
    points_of,
    polyline,
    rectangle,
    text,
    thinned,
)
from cqdd_design.results import Check

_HEIGHT, _RIGHT, _TOP, _BOTTOM = 268.0, 14.0, 46.0, 44.0
_FINE = 0.05
"""Points of a curve this near to the line without them are left out, px."""


class Curve(NamedTuple):
    """One line of a chart.

    Attributes
    ----------
    label : str
        Legend text; empty for a line without an entry.
    y : array (A,)
        In the unit of the chart's y axis.
    class_ : str
        Style: ``series-1``, ``series-2``, ``series-3``, or ``faint``.
    """

    label: str
    y: FloatArray
    class_: str


class Level(NamedTuple):
    """A limit drawn as a dashed horizontal line and named at its right end."""

    label: str
    value: float


def line_chart(
    words: Words,
    x: FloatArray,
    curves: Sequence[Curve],
    levels: Sequence[Level] = (),
    *,
    x_label: str,
    y_label: str,
    x_ticks: Sequence[float],
) -> Figure:
    """A line chart over one abscissa, its y axis from zero.

    Parameters
    ----------
    x : array (A,)
        Abscissae of all curves.
    curves, levels : sequences
        Drawn in order, so the last curve lies on top; levels are limits.
    x_label, y_label : str
        With units.
    x_ticks : sequence of float
        The x axis runs from the first to the last.
    """
    top = max([float(c.y.max()) for c in curves] + [v.value for v in levels])
    step = nice_step(1.04 * top, 5)
    steps = math.ceil(1.04 * top / step)
    panel = Panel(
        words.id,
        Axis(x_ticks[0], x_ticks[-1], tuple(x_ticks), x_label),
        Axis(0.0, step * steps, tuple(step * k for k in range(steps + 1)), y_label),
        LEFT,
        _TOP,
        NARROW - LEFT - _RIGHT,
        _HEIGHT - _TOP - _BOTTOM,
    )
    body = []
    for tick in panel.y.ticks:
        body.append(panel.across(tick, "grid" if tick else "axis"))
        y = panel.place(panel.x.low, tick)[1]
        body.append(text((panel.left - 7.0, y + 4.0), significant(tick), "tick", "end"))
    for tick in x_ticks:
        body += tick_below(panel.place(tick, 0.0)[0], panel.bottom, tick)
    middle = (panel.left + panel.width / 2.0, panel.top + panel.height / 2.0)
    body += axis_names((middle[0], _HEIGHT - 8.0, x_label), (middle[1], y_label))
    drawn = [panel.places(x, curve.y) for curve in curves]
    for curve, places in zip(curves, drawn, strict=True):
        shown = thinned(np.column_stack(places), _FINE)
        body.append(polyline(points_of(*shown.T), f"curve {curve.class_}"))
    # Labels of limits stand at the right; what runs there decides above or below.
    right = np.concatenate([ys[xs > panel.left + 0.6 * panel.width] for xs, ys in drawn])
    for level in levels:
        body += _level(panel, level, right)
    entries = [(curve.label, curve.class_) for curve in curves if curve.label]
    body.append(Legend(entries, pitch=7.1, apart=14.0).render())
    return words.figure(NARROW, _HEIGHT, body)


def _level(panel: Panel, level: Level, curves: FloatArray) -> list[str]:
    """A limit and its label, on the side of the line where fewer points of curves run."""
    y = panel.place(panel.x.low, level.value)[1]
    above = int(np.sum((curves > y - 17.0) & (curves < y)))
    below = int(np.sum((curves > y) & (curves < y + 17.0)))
    base = y - 4.0 if above <= below else y + 12.0
    label = text((panel.right - 3.0, base), level.label, "limit-label", "end")
    return [panel.across(level.value), label]


_BAR_WIDTH, _BAR_HEIGHT = 150.0, 16.0
_MARGIN_LEAST, _MARGIN_MOST = 0.25, 4.0


def margin_bar(check: Check) -> str:
    """A small bar of the margin on a logarithmic scale from 1/4 to 4, with the limit marked at 1.

    A bar to the right of the mark is reserve, one to the left is shortfall; margins off the scale
    end in an arrow.
    """

    def place(margin: float) -> float:
        share = math.log(margin / _MARGIN_LEAST) / math.log(_MARGIN_MOST / _MARGIN_LEAST)
        return 6.0 + (_BAR_WIDTH - 12.0) * share

    margin, class_ = check.margin, f"bar {check.status}"
    clipped = min(max(margin, _MARGIN_LEAST), _MARGIN_MOST)
    one, end = place(1.0), place(clipped)
    middle = _BAR_HEIGHT / 2.0
    body = [
        line((6.0, middle), (_BAR_WIDTH - 6.0, middle), "bar-track"),
        rectangle(min(one, end), middle - 3.5, max(abs(end - one), 1.0), 7.0, class_),
    ]
    if clipped != margin:
        sign = 1.0 if margin > 1.0 else -1.0
        tip: list[Point] = [(end + 6.0 * sign, middle), (end, middle - 5.0), (end, middle + 5.0)]
        body.append(polyline(tip, class_, closed=True))
    else:
        body.append(circle((end, middle), 4.0, class_))
    body.append(line((one, 1.0), (one, _BAR_HEIGHT - 1.0), "bar-one"))
    return element(
        "svg",
        "".join(body),
        viewBox=f"0 0 {_BAR_WIDTH:g} {_BAR_HEIGHT:g}",
        class_="margin-bar",
        role="img",
        aria_label=f"margin {significant(margin, 3)}, limit at 1",
    )
