"""Numbers with leaders round a picture, and the list of parts they point to."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cqdd_design.exporting.bill.substitutes import ordered
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.svg import element, text
from cqdd_design.report.machine_view.paint import INK, Sheet
from cqdd_design.solids.part import Part

_RADIUS = 11.0
_APART = 27.0
"""Least distance of two balloons in a row, px."""
_ROW = 19.0
_LETTER = 6.4
"""Mean width of a letter of the list, px."""


def ballooned(
    marks: Sequence[tuple[int, tuple[FloatArray, ...]]],
    outlines: Sequence[tuple[FloatArray, ...]],
    sheet: Sheet,
    width: float,
    height: float,
) -> str:
    """Balloons in a row above and one below the picture, turn and turn about.

    Parameters
    ----------
    marks : sequence of (number, loops)
        What is visible of the stations, in the order along the axis; mm on the page.
    outlines : sequence of loops
        What the balloons must keep off, mm on the page.
    width, height : float
        Of the picture, px.
    """
    hull = [sheet.px(np.concatenate(loops)) for loops in outlines]
    rows: tuple[list[tuple[int, FloatArray]], list[tuple[int, FloatArray]]] = ([], [])
    upper = True
    for number, loops in marks:
        if not loops:
            continue
        points = sheet.px(np.concatenate(loops))
        edge = points[:, 1].argmin() if upper else points[:, 1].argmax()
        rows[0 if upper else 1].append((number, points[edge]))
        upper = not upper
    drawn = []
    for row, inward in zip(rows, (1.0, -1.0), strict=True):
        row.sort(key=lambda entry: float(entry[1][0]))
        wanted = [float(tip[0]) for _, tip in row]
        places = spread(wanted, _APART, _RADIUS + 2.0, width - _RADIUS - 2.0)
        for (number, tip), x in zip(row, places, strict=True):
            free = _free(hull, x, float(tip[1]), inward) - inward * 27.0
            y = min(max(free, _RADIUS + 2.0), height - _RADIUS - 2.0)
            drawn.append(balloon(number, (x, y), (float(tip[0]), float(tip[1]))))
    return element("g", *drawn, class_="balloons")


def _free(hull: Sequence[FloatArray], x: float, y: float, inward: float) -> float:
    """Height on the page beyond which nothing stands within a balloon's width of `x`, px."""
    for points in hull:
        near = points[np.abs(points[:, 0] - x) < _RADIUS + 8.0, 1]
        if len(near):
            y = min(y, float(near.min())) if inward > 0.0 else max(y, float(near.max()))
    return y


def balloon(number: int, place: tuple[float, float], tip: tuple[float, float]) -> str:
    """A number in a circle with a leader to a dot."""
    dx, dy = tip[0] - place[0], tip[1] - place[1]
    distance = math.hypot(dx, dy)
    start = (place[0] + _RADIUS * dx / distance, place[1] + _RADIUS * dy / distance)
    return (
        element(
            "line", x1=start[0], y1=start[1], x2=tip[0], y2=tip[1], stroke=INK, stroke_width="0.8"
        )
        + element("circle", cx=tip[0], cy=tip[1], r=1.8, fill=INK)
        + element(
            "circle",
            cx=place[0],
            cy=place[1],
            r=_RADIUS,
            fill="#ffffff",
            stroke=INK,
            stroke_width="1.1",
        )
        + text((place[0], place[1] + 4.2), str(number), "balloon-number", "middle")
    )


def spread(wanted: Sequence[float], apart: float, low: float, high: float) -> list[float]:
    """Rising places near the wanted ones, at least `apart` from each other where there is room."""
    count = len(wanted)
    if count == 0:
        return []
    apart = min(apart, (high - low) / max(1, count - 1))
    # Blocks of neighbours that touch share the mean of what they want.
    blocks: list[list[float]] = []
    for index, value in enumerate(wanted):
        blocks.append([value - index * apart, 1.0])
        while len(blocks) > 1 and blocks[-1][0] < blocks[-2][0]:
            mean, size = blocks.pop()
            other, others = blocks.pop()
            blocks.append([(mean * size + other * others) / (size + others), size + others])
    levels = [mean for mean, size in blocks for _ in range(int(size))]
    most = high - (count - 1) * apart
    return [min(max(level, low), most) + index * apart for index, level in enumerate(levels)]


def legend(parts: Sequence[Part], width: float, top: float) -> tuple[str, float]:
    """The numbered list of parts in columns, and its height, px."""
    columns = 3
    rows = math.ceil(len(parts) / columns)
    column = width / columns
    most = int((column - 40.0) / _LETTER)
    drawn = []
    for index, part in enumerate(parts):
        x, y = column * (index // rows), top + 26.0 + _ROW * (index % rows)
        label = part.name if part.count == 1 else f"{part.count} \u00d7 {part.name}"
        room = most - len(label) - 2
        what = ordered(part.designation)
        detail = what if len(what) <= room else ""
        drawn.append(text((x + 18.0, y), str(index + 1), "label", "end"))
        drawn.append(text((x + 28.0, y), label, "name-dark"))
        if detail:
            drawn.append(text((x + 28.0 + _LETTER * (len(label) + 2), y), detail, "label"))
    return element("g", *drawn, class_="legend-list"), 26.0 + _ROW * rows
