"""Line charts and margin bars as inline SVG, drawn to be read on paper as well."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    circle,
    element,
    group,
    line,
    points_of,
    polyline,
    rectangle,
    text,
)
from cqdd_design.results import Check

FloatArray = NDArray[np.float64]

_WIDTH, _HEIGHT = 430.0, 268.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 58.0, 14.0, 46.0, 44.0
_LEGEND_PITCH = 7.1  # px per character of legend text, a little generous


@dataclass(frozen=True)
class Curve:
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


@dataclass(frozen=True)
class Level:
    """A limit drawn as a dashed horizontal line and named at its right end."""

    label: str
    value: float


def nice_step(span: float, most: int) -> float:
    """A tick distance of 1, 2, 2.5 or 5 times a power of ten that gives at most `most` steps.

    Examples
    --------
    >>> nice_step(1527.0, 5)
    500.0
    """
    if span <= 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(span / most))
    for factor in (1.0, 2.0, 2.5, 5.0, 10.0):
        if factor * power * most >= span * (1.0 - 1e-12):
            return factor * power
    return 20.0 * power


def line_chart(
    id_: str,
    title: str,
    description: str,
    *,
    x: FloatArray,
    x_label: str,
    y_label: str,
    curves: Sequence[Curve],
    levels: Sequence[Level] = (),
    caption: str = "",
    x_ticks: Sequence[float],
) -> Figure:
    """A line chart over one abscissa, its y axis from zero.

    Parameters
    ----------
    id_, title, description : str
        Of the figure.
    x : array (A,)
        Abscissae of all curves.
    x_label, y_label : str
        With units.
    curves, levels : sequences
        Drawn in order, so the last curve lies on top; levels are limits.
    caption : str
        Text under the figure.
    x_ticks : sequence of float
        The x axis runs from the first to the last.

    Returns
    -------
    Figure
    """
    top = max([float(c.y.max()) for c in curves] + [v.value for v in levels])
    step_y = nice_step(1.04 * top, 5)
    high = step_y * math.ceil(1.04 * top / step_y)
    plot_w, plot_h = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    reach = x_ticks[-1] - x_ticks[0]

    def place_y(value: float) -> float:
        return _TOP + plot_h * (1.0 - value / high)

    body = []
    for k in range(round(high / step_y) + 1):
        y = place_y(k * step_y)
        body.append(line((_LEFT, y), (_WIDTH - _RIGHT, y), "axis" if k == 0 else "grid"))
        body.append(text((_LEFT - 7.0, y + 4.0), significant(k * step_y), "tick", "end"))
    for tick in x_ticks:
        at = _LEFT + plot_w * (tick - x_ticks[0]) / reach
        body.append(line((at, _TOP + plot_h), (at, _TOP + plot_h + 4.0), "axis"))
        body.append(text((at, _TOP + plot_h + 17.0), significant(tick), "tick", "middle"))
    body.append(text((_LEFT + plot_w / 2.0, _HEIGHT - 8.0), x_label, "label", "middle"))
    body.append(text((14.0, _TOP + plot_h / 2.0), y_label, "label", "middle", turn=-90.0))
    xs = _LEFT + plot_w * (x - x_ticks[0]) / reach
    drawn = [_TOP + plot_h * (1.0 - curve.y / high) for curve in curves]
    for curve, ys in zip(curves, drawn, strict=True):
        body.append(polyline(points_of(xs, ys), f"curve {curve.class_}"))
    # Labels of limits stand at the right; what runs there decides above or below.
    right = np.concatenate([ys[xs > _LEFT + 0.6 * plot_w] for ys in drawn])
    for level in levels:
        body.append(_level(level.label, place_y(level.value), right))
    body.append(_legend([c for c in curves if c.label]))
    return Figure(id_, title, description, _WIDTH, _HEIGHT, "".join(body), caption)


def _level(label: str, y: float, curves: FloatArray) -> str:
    """A limit and its label, on the side of the line where fewer points of curves run."""
    above = int(np.sum((curves > y - 17.0) & (curves < y)))
    below = int(np.sum((curves > y) & (curves < y + 17.0)))
    base = y - 4.0 if above <= below else y + 12.0
    return line((_LEFT, y), (_WIDTH - _RIGHT, y), "limit") + text(
        (_WIDTH - _RIGHT - 3.0, base), label, "limit-label", "end"
    )


def _legend(curves: Sequence[Curve]) -> str:
    pieces, x, y = [], _LEFT, 14.0
    for curve in curves:
        needed = 24.0 + _LEGEND_PITCH * len(curve.label)
        if x + needed > _WIDTH and x > _LEFT:
            x, y = _LEFT, y + 17.0
        pieces.append(line((x, y - 4.0), (x + 18.0, y - 4.0), f"curve {curve.class_}"))
        pieces.append(text((x + 24.0, y), curve.label, "legend"))
        x += needed + 14.0
    return group(pieces, class_="legend-row")


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

    margin = check.margin
    clipped = min(max(margin, _MARGIN_LEAST), _MARGIN_MOST)
    one, end = place(1.0), place(clipped)
    middle = _BAR_HEIGHT / 2.0
    body = [
        line((6.0, middle), (_BAR_WIDTH - 6.0, middle), "bar-track"),
        rectangle(
            min(one, end), middle - 3.5, max(abs(end - one), 1.0), 7.0, f"bar {check.status}"
        ),
    ]
    if clipped != margin:
        sign = 1.0 if margin > 1.0 else -1.0
        tip: list[Point] = [(end + 6.0 * sign, middle), (end, middle - 5.0), (end, middle + 5.0)]
        body.append(polyline(tip, f"bar {check.status}", closed=True))
    else:
        body.append(circle((end, middle), 4.0, f"bar {check.status}"))
    body.append(line((one, 1.0), (one, _BAR_HEIGHT - 1.0), "bar-one"))
    return element(
        "svg",
        "".join(body),
        viewBox=f"0 0 {_BAR_WIDTH:g} {_BAR_HEIGHT:g}",
        class_="margin-bar",
        role="img",
        aria_label=f"margin {significant(margin, 3)}, limit at 1",
    )
