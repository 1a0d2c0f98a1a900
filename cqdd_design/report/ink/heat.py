"""Heat maps as inline SVG: cells of one shade are merged, so that a page stays light."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, element, line, rectangle, text

FloatArray = NDArray[np.float64]

SHADES = 9
"""Classes of the colour scale, ``heat-0`` (nothing) to ``heat-9`` (the greatest)."""

MOST_COLUMNS, MOST_ROWS = 180, 120
"""Cells of a heat map; more are drawn as the greatest of their neighbours."""

_LEFT, _RIGHT, _TOP = 58.0, 16.0, 40.0
_CELL, _TALLEST, _LABEL = 15.0, 420.0, 12.5


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


def greatest_of_neighbours(values: FloatArray, most: int, axis: int) -> FloatArray:
    """Values with neighbours along an axis merged into their greatest, `most` at the most.

    Examples
    --------
    >>> greatest_of_neighbours(np.array([[1.0, 5.0, 2.0, 3.0, 4.0]]), 3, 1)
    array([[5., 3., 4.]])
    """
    each = math.ceil(values.shape[axis] / most)
    starts = np.arange(0, values.shape[axis], each)
    return np.asarray(np.maximum.reduceat(values, starts, axis=axis))


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
    most: float | None = None,
    width: float = 430.0,
) -> Figure:
    """Values over an abscissa, one row of cells each, darker where greater.

    Parameters
    ----------
    id_, title, description, caption : str
        Of the figure.
    values : array (rows, columns)
        Not negative; drawn at `MOST_ROWS` by `MOST_COLUMNS` or coarser.
    rows : sequence of str
        Names of the rows, top first.
    row_label, x_label, unit : str
        Of the axes and of the values.
    x : (float, float)
        Abscissae of the first cell's left and the last cell's right edge.
    x_ticks : sequence of float
    most : float, optional
        Value of the darkest shade, where maps share a scale; default the greatest here.
    width : float
        px.
    """
    most = float(values.max(initial=0.0)) if most is None else most
    names = rows[:: math.ceil(len(rows) / MOST_ROWS)]
    values = greatest_of_neighbours(values, MOST_ROWS, 0)
    values = greatest_of_neighbours(values, MOST_COLUMNS, 1)
    cell_h = min(_CELL, _TALLEST / len(names))
    every = math.ceil(_LABEL / cell_h)
    plot_w, plot_h = width - _LEFT - _RIGHT, cell_h * len(names)
    step = plot_w / values.shape[1]
    body = [*_scale(width, most, unit)]
    for row, name in enumerate(names):
        y = _TOP + cell_h * row
        if row % every == 0:
            body.append(text((_LEFT - 7.0, y + 0.5 * cell_h + 4.0), name, "tick", "end"))
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
    """The colour scale, named at its thirds."""
    size = 19.0
    begin = width - _RIGHT - size * SHADES
    parts = [
        rectangle(begin + size * (k - 1), 4.0, size, 11.0, f"heat-{k}")
        for k in range(1, SHADES + 1)
    ]
    for third in range(4):
        at = begin + size * SHADES * third / 3.0
        shown = significant(most * third / 3.0, 3)
        parts.append(line((at, 15.0), (at, 19.0), "axis"))
        parts.append(text((at, 30.0), shown, "tick", "middle"))
    parts.append(text((begin - 8.0, 13.5), unit, "tick", "end"))
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
