"""Heat maps as inline SVG: cells of one shade are merged, so that a page stays light."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.axes import BELOW, LEFT, NARROW, RIGHT, Axis, axis_names, tick_below
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, Words, element, line, rectangle, text

SHADES = 9
"""Classes of the colour scale, ``heat-0`` (nothing) to ``heat-9`` (the greatest)."""

MOST_COLUMNS, MOST_ROWS = 180, 120
"""Cells of a heat map; more are drawn as the greatest of their neighbours."""

_TOP, _CELL, _TALLEST, _LABEL = 40.0, 15.0, 420.0, 12.5


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


def cell(box: tuple[float, float, float, float], grade: int, shown: str = "") -> list[str]:
    """A shaded cell (x, y, width, height) with a value written in; no shade where it is 0."""
    x, y, width, height = box
    parts = [rectangle(*box, f"heat-{grade} cell")] if grade else []
    if shown:
        tone = "on-dark" if grade > 5 else "on-light"
        place = (x + 0.5 * width, y + 0.5 * height + 4.0)
        parts.append(text(place, shown, f"cell-text {tone}", "middle"))
    return parts


def heat_map(
    words: Words, values: FloatArray, rows: Sequence[str], row_label: str, x: Axis, unit: str
) -> Figure:
    """Values over an abscissa, one row of cells each, darker where greater.

    Parameters
    ----------
    values : array (rows, columns)
        Not negative; drawn at `MOST_ROWS` by `MOST_COLUMNS` or coarser.
    rows : sequence of str
        Names of the rows, top first.
    row_label, unit : str
        Of the rows and of the values.
    x : Axis
        From the first cell's left to the last cell's right edge.
    """
    most = float(values.max(initial=0.0))
    names = rows[:: math.ceil(len(rows) / MOST_ROWS)]
    values = greatest_of_neighbours(values, MOST_ROWS, 0)
    values = greatest_of_neighbours(values, MOST_COLUMNS, 1)
    high = min(_CELL, _TALLEST / len(names))
    every = math.ceil(_LABEL / high)
    size = (NARROW - LEFT - RIGHT, high * len(names))
    step = size[0] / values.shape[1]
    body = _scale(most, unit)
    for row, name in enumerate(names):
        y = _TOP + high * row
        if row % every == 0:
            body.append(text((LEFT - 7.0, y + 0.5 * high + 4.0), name, "tick", "end"))
        shades = [shade(float(v), most) for v in values[row]]
        begin = 0
        for column in range(1, len(shades) + 1):
            if column < len(shades) and shades[column] == shades[begin]:
                continue
            if shades[begin]:
                at, span = LEFT + step * begin, step * (column - begin)
                body.append(rectangle(at, y, span, high, f"heat-{shades[begin]}"))
            begin = column
    bottom = _TOP + size[1]
    body.append(element("rect", x=LEFT, y=_TOP, width=size[0], height=size[1], class_="frame"))
    for tick in x.ticks:
        body += tick_below(LEFT + size[0] * float(x.share(tick)), bottom, tick)
    middle = (LEFT + size[0] / 2.0, _TOP + size[1] / 2.0)
    body += axis_names((middle[0], bottom + 35.0, x.label), (middle[1], row_label))
    return words.figure(NARROW, bottom + BELOW, body)


def _scale(most: float, unit: str) -> list[str]:
    """The colour scale, named at its thirds."""
    size = 19.0
    begin = NARROW - RIGHT - size * SHADES
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
    words: Words,
    values: FloatArray,
    rows: Sequence[str],
    columns: Sequence[str],
    labels: tuple[str, str],
) -> Figure:
    """A small grid with its values written in, such as efficiency over speed and torque.

    Parameters
    ----------
    values : array (rows, columns)
        Shares from 0 to 1, written in per cent and shaded between their least and greatest.
    rows, columns : sequences of str
        Names, top row first.
    labels : (str, str)
        Of rows and columns.
    """
    high, width = 24.0, NARROW - LEFT - RIGHT
    step = width / len(columns)
    least, span = float(values.min()), float(np.ptp(values)) or 1.0
    body = []
    for row, name in enumerate(rows):
        y = 14.0 + high * row
        body.append(text((LEFT - 7.0, y + 16.0), name, "tick", "end"))
        for column, value in enumerate(values[row].tolist()):
            grade = max(shade(value - least, span), 1)
            box = (LEFT + step * column, y, step, high)
            body += cell(box, grade, f"{100.0 * value:.1f}")
    bottom = 14.0 + high * len(rows)
    for column, name in enumerate(columns):
        place = (LEFT + step * (column + 0.5), bottom + 15.0)
        body.append(text(place, name, "tick", "middle"))
    middle = (LEFT + width / 2.0, 14.0 + high * len(rows) / 2.0)
    below = (middle[0], bottom + 34.0, labels[1])
    body += axis_names(below, (middle[1], labels[0]))
    return words.figure(NARROW, bottom + 42.0, body)
