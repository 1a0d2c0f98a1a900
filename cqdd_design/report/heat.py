"""Heat maps, bars and histograms as inline SVG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cqdd_design.report.charts import nice_step
from cqdd_design.report.numbers import significant
from cqdd_design.report.svg import Figure, element, line, rectangle, text

FloatArray = NDArray[np.float64]

SHADES = 9
"""Classes of the colour scale, ``heat-0`` (nothing) to ``heat-9`` (the greatest)."""

_LEFT, _RIGHT, _TOP = 58.0, 16.0, 40.0


def shade(value: float, most: float) -> int:
    """Class of a value on the scale from 0 to `most`; 0 only for nothing.

    Examples
    --------
    >>> shade(0.0, 10.0), shade(0.1, 10.0), shade(10.0, 10.0)
    (0, 1, 9)
    """
    if value <= 0.0 or most <= 0.0:
        return 0
    return min(1 + int(SHADES * value / most), SHADES)


def heat_map(
    id_: str,
    title: str,
    description: str,
    *,
    values: FloatArray,
    rows: Sequence[str],
    row_label: str,
    x: tuple[float, float],
    x_ticks: Sequence[float],
    x_label: str,
    unit: str,
    caption: str,
    width: float = 430.0,
) -> Figure:
    """Values over an abscissa, one row of cells each, darker where greater.

    Parameters
    ----------
    id_, title, description, caption : str
        Of the figure.
    values : array (rows, columns)
        Not negative; neighbouring cells of one shade are drawn as one.
    rows : sequence of str
        Names of the rows, top first.
    row_label, x_label, unit : str
        Of the axes and of the values.
    x : (float, float)
        Abscissae of the first cell's left and the last cell's right edge.
    x_ticks : sequence of float
    width : float
        px.
    """
    most = float(values.max(initial=0.0))
    cell_h = 15.0
    plot_w, plot_h = width - _LEFT - _RIGHT, cell_h * len(rows)
    step = plot_w / values.shape[1]
    body = [*_scale(width, most, unit)]
    for row, name in enumerate(rows):
        y = _TOP + cell_h * row
        body.append(text((_LEFT - 7.0, y + 11.0), name, "tick", "end"))
        shades = [shade(float(v), most) for v in values[row]]
        begin = 0
        for column in range(1, len(shades) + 1):
            if column < len(shades) and shades[column] == shades[begin]:
                continue
            if shades[begin]:
                at, span = _LEFT + step * begin, step * (column - begin)
                body.append(rectangle(at, y, span, cell_h, f"heat-{shades[begin]}"))
            begin = column
    bottom = _TOP + plot_h
    body.append(element("rect", x=_LEFT, y=_TOP, width=plot_w, height=plot_h, class_="frame"))
    for tick in x_ticks:
        at = _LEFT + plot_w * (tick - x[0]) / (x[1] - x[0])
        body.append(line((at, bottom), (at, bottom + 4.0), "axis"))
        body.append(text((at, bottom + 17.0), significant(tick), "tick", "middle"))
    body.append(text((_LEFT + plot_w / 2.0, bottom + 35.0), x_label, "label", "middle"))
    middle = _TOP + plot_h / 2.0
    body.append(text((14.0, middle), row_label, "label", "middle", turn=-90.0))
    return Figure(id_, title, description, width, bottom + 43.0, "".join(body), caption)


def _scale(width: float, most: float, unit: str) -> list[str]:
    """The colour scale with its ends named."""
    size = 15.0
    begin = width - _RIGHT - size * SHADES
    parts = [text((begin - 6.0, 22.0), "0", "tick", "end")]
    parts += [
        rectangle(begin + size * (k - 1), 12.0, size, 12.0, f"heat-{k}")
        for k in range(1, SHADES + 1)
    ]
    parts.append(text((width - _RIGHT, 36.0), f"{significant(most)} {unit}", "tick", "end"))
    return parts


def labelled_map(
    id_: str,
    title: str,
    description: str,
    *,
    values: FloatArray,
    rows: Sequence[str],
    columns: Sequence[str],
    row_label: str,
    column_label: str,
    caption: str,
) -> Figure:
    """A small grid with its values written in, such as efficiency over speed and torque.

    Parameters
    ----------
    values : array (rows, columns)
        Shares from 0 to 1, written in per cent and shaded between their least and greatest.
    rows, columns : sequences of str
        Names, top row first.
    """
    width, cell_h = 430.0, 24.0
    plot_w = width - _LEFT - _RIGHT
    step = plot_w / len(columns)
    least, span = float(values.min()), float(np.ptp(values)) or 1.0
    body = []
    for row, name in enumerate(rows):
        y = 14.0 + cell_h * row
        body.append(text((_LEFT - 7.0, y + 16.0), name, "tick", "end"))
        for column in range(len(columns)):
            value = float(values[row, column])
            grade = max(shade(value - least, span), 1)
            at = _LEFT + step * column
            body.append(rectangle(at, y, step, cell_h, f"heat-{grade} cell"))
            tone = "on-dark" if grade > 5 else "on-light"
            shown = f"{100.0 * value:.1f}"
            body.append(text((at + step / 2.0, y + 16.0), shown, f"cell-text {tone}", "middle"))
    bottom = 14.0 + cell_h * len(rows)
    for column, name in enumerate(columns):
        at = _LEFT + step * (column + 0.5)
        body.append(text((at, bottom + 15.0), name, "tick", "middle"))
    body.append(text((_LEFT + plot_w / 2.0, bottom + 34.0), column_label, "label", "middle"))
    middle = 14.0 + cell_h * len(rows) / 2.0
    body.append(text((14.0, middle), row_label, "label", "middle", turn=-90.0))
    return Figure(id_, title, description, width, bottom + 42.0, "".join(body), caption)


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
    width, left, right, pitch = 430.0, 148.0, 82.0, 24.0
    reach = width - left - right
    most = max([*values, *(marks or ()), 1e-12])
    body = []
    for k, (name, value, label) in enumerate(zip(names, values, shown, strict=True)):
        y = 8.0 + pitch * k
        body.append(text((left - 8.0, y + 12.5), name, "name-dark", "end"))
        length = max(reach * value / most, 0.75)
        body.append(rectangle(left, y + 2.0, length, 14.0, "share-bar"))
        if marks is not None:
            at = left + reach * max(marks[k], 0.0) / most
            body.append(line((at, y), (at, y + 18.0), "bar-one"))
        body.append(text((left + length + 7.0, y + 13.0), label, "tick"))
    height = 12.0 + pitch * len(names)
    return Figure(id_, title, description, width, height, "".join(body), caption)


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
        Drawn as vertical lines with their names.
    bins : int
        At most this many.
    """
    width, height, bottom = 430.0, 240.0, 44.0
    low, high = float(values.min()), float(values.max())
    step = nice_step(max(high - low, 1e-9), bins)
    first, last = np.floor(low / step), np.ceil(high / step) + (high == low)
    edges = step * np.arange(first, max(last, first + 1.0) + 0.5)
    counts, edges = np.histogram(values, edges)
    plot_w, plot_h = width - _LEFT - _RIGHT, height - _TOP - bottom
    most = max(int(counts.max()), 1)
    reach = float(edges[-1] - edges[0])

    def place(value: float) -> float:
        return _LEFT + plot_w * (value - float(edges[0])) / reach

    base = _TOP + plot_h
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
        top = _TOP - 8.0 - 13.0 * (k % 2)
        body.append(line((at, top), (at, base), "limit"))
        body.append(text((at, top - 3.0), f"{name} {significant(value, 3)}", "tick", "middle"))
    body.append(text((_LEFT + plot_w / 2.0, height - 8.0), x_label, "label", "middle"))
    middle = _TOP + plot_h / 2.0
    body.append(text((14.0, middle), "gearboxes", "label", "middle", turn=-90.0))
    body.append(text((_LEFT - 7.0, _TOP + 4.0), str(most), "tick", "end"))
    return Figure(id_, title, description, width, height, "".join(body), caption)
