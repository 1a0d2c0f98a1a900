"""Dimension lines, leaders and label columns of the drawings, in px of the figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from cqdd_design.report.ink.svg import Point, arrow_head, group, line, polyline, text

_CHARACTER = 6.6  # px of one character of a dimension's text, a little generous
_GAP, _OVERSHOOT = 3.0, 6.0
_PITCH = 46.0  # px between two leaders
_OUTSIDE = 26.0  # px: shorter dimensions have their arrows outside


def _label_width(*lines: str) -> float:
    return _CHARACTER * max(len(one.replace("_", "").strip("{}")) for one in lines)


def horizontal_dimension(
    start: Point, end: Point, y: float, value: str, name: str, *, side: Literal[-1, 1] = 1
) -> str:
    """A horizontal dimension between the verticals through two points, start left of end.

    Parameters
    ----------
    start, end : (float, float)
        The measured places; extension lines run from them to the height `y`.
    y : float
        Height of the dimension line.
    value, name : str
        Symbol and value stand on the line, the name beneath it (``_`` lowers as in
        :func:`.svg.text`).
    side : {-1, 1}
        Where a text that does not fit between the lines goes: left or right of them.
    """
    parts = [_extension(start, y), _extension(end, y)]
    left, right = (start[0], y), (end[0], y)
    narrow, gap = end[0] - start[0] < _OUTSIDE, 6.0
    if narrow:
        reach, gap = 26.0, 31.0
        parts.append(line((left[0] - reach, y), (right[0] + reach, y), "dimension"))
        parts += [arrow_head(left, (1.0, 0.0)), arrow_head(right, (-1.0, 0.0))]
    else:
        parts.append(line(left, right, "dimension"))
        parts += [arrow_head(left, (-1.0, 0.0)), arrow_head(right, (1.0, 0.0))]
    if not narrow and _label_width(value, name) < right[0] - left[0] - 8.0:
        middle = 0.5 * (left[0] + right[0])
        parts.append(text((middle, y + 14.0), name, "name", "middle"))
        parts.append(text((middle, y - 5.0), value, "value", "middle"))
    else:
        at = right[0] + gap if side > 0 else left[0] - gap
        anchor = "start" if side > 0 else "end"
        parts.append(text((at, y + 13.0), name, "name", anchor))
        parts.append(text((at, y - 1.0), value, "value", anchor))
    return group(parts, class_="dim")


def _extension(place: Point, y: float) -> str:
    way = 1.0 if y > place[1] else -1.0
    return line((place[0], place[1] + way * _GAP), (place[0], y + way * _OVERSHOOT), "extension")


def vertical_dimension(start: Point, end: Point, x: float, value: str, name: str) -> str:
    """A vertical dimension at `x`, `start` above `end`, its text turned along the line."""
    way = 1.0 if x > start[0] else -1.0
    parts = [
        line((place[0] + way * _GAP, place[1]), (x + way * _OVERSHOOT, place[1]), "extension")
        for place in (start, end)
    ]
    top, bottom = (x, start[1]), (x, end[1])
    middle = 0.5 * (top[1] + bottom[1])
    if end[1] - start[1] < _OUTSIDE:
        parts.append(line((x, top[1] - 24.0), (x, bottom[1] + 24.0), "dimension"))
        parts += [arrow_head(top, (0.0, 1.0)), arrow_head(bottom, (0.0, -1.0))]
        parts.append(text((x + 5.0, top[1] - 15.0), value, "value"))
        parts.append(text((x + 5.0, top[1] - 3.0), name, "name"))
        return group(parts, class_="dim")
    parts.append(line(top, bottom, "dimension"))
    parts += [arrow_head(top, (0.0, -1.0)), arrow_head(bottom, (0.0, 1.0))]
    parts.append(text((x - 5.0, middle), value, "value", "middle", turn=-90.0))
    parts.append(text((x + 13.0, middle), name, "name", "middle", turn=-90.0))
    return group(parts, class_="dim")


@dataclass(frozen=True)
class Leader:
    """A label with an arrow to what it names.

    Attributes
    ----------
    target : (float, float)
        The place pointed at, px.
    value, name : str
        Symbol with value, and words.
    """

    target: Point
    value: str
    name: str


def leader_column(
    leaders: Sequence[Leader],
    x: float,
    side: Literal["left", "right"],
    top: float,
    bottom: float,
) -> str:
    """Labels one above the other at the edge of a drawing, each with its leader.

    They keep the order of their targets, so leaders do not cross, and at least `_PITCH` between
    each other inside ``top..bottom``.

    Parameters
    ----------
    x : float
        Edge of the column towards the drawing.
    side : {"left", "right"}
        On which side of the drawing the column stands.
    top, bottom : float
        px.
    """
    ordered = sorted(leaders, key=lambda one: one.target[1])
    heights = _spread([one.target[1] for one in ordered], top, bottom)
    sign, anchor = (1.0, "end") if side == "left" else (-1.0, "start")
    parts = []
    for one, y in zip(ordered, heights, strict=True):
        knee = (x + sign * 16.0, y)
        parts.append(polyline([(x + sign * 4.0, y), knee, one.target], "leader"))
        direction = (one.target[0] - knee[0], one.target[1] - knee[1])
        parts.append(arrow_head(one.target, direction))
        parts.append(text((x, y + 14.0), one.name, "name", anchor))
        parts.append(text((x, y), one.value, "value", anchor))
    return group(parts, class_="dim")


def _spread(wanted: Sequence[float], top: float, bottom: float) -> list[float]:
    """Heights near the wanted ones, in order, at least `_PITCH` apart where there is room."""
    if not wanted:
        return []
    pitch = min(_PITCH, (bottom - top) / max(len(wanted) - 1, 1))
    heights: list[float] = []
    for height in wanted:
        least = heights[-1] + pitch if heights else top
        heights.append(max(height, least))
    ceiling = bottom
    for index in range(len(heights) - 1, -1, -1):
        heights[index] = min(heights[index], ceiling)
        ceiling = heights[index] - pitch
    return heights
