"""Axes, panels and labels of charts whose curves have abscissae of their own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    Words,
    circle,
    element,
    group,
    line,
    points_of,
    polyline,
    rectangle,
    text,
)

NARROW = 430.0
"""Width of a figure beside another, px."""
LEFT, RIGHT, BELOW = 58.0, 16.0, 43.0
"""Room beside and below a panel for its labels, px."""
_PITCH, _HIGH = 6.3, 13.0
"""px per character and line of a label, a little generous."""


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


def tick_below(x: float, base: float, value: float, centre: float | None = None) -> list[str]:
    """A tick under a horizontal axis at the height `base`, with its number about `centre`."""
    number = text(
        (x if centre is None else centre, base + 17.0), significant(value), "tick", "middle"
    )
    return [line((x, base), (x, base + 4.0), "axis"), number]


def axis_names(x: tuple[float, float, str], y: tuple[float, str]) -> list[str]:
    """Labels of both axes: place and text of the lower one, height and text of the left one."""
    return [
        text(x[:2], x[2], "label", "middle"),
        text((14.0, y[0]), y[1], "label", "middle", turn=-90.0),
    ]


@dataclass(frozen=True)
class Axis:
    """One axis: its range, ticks and label.

    Attributes
    ----------
    label : str
        With the unit.
    """

    low: float
    high: float
    ticks: tuple[float, ...]
    label: str
    log: bool = False

    def share(self, value: ArrayLike) -> FloatArray:
        """Where values lie between both ends, 0 to 1."""
        values = np.asarray(value, dtype=float)
        if self.log:
            span = math.log(self.high / self.low)
            return np.asarray(np.log(np.maximum(values, 1e-300) / self.low) / span)
        return np.asarray((values - self.low) / (self.high - self.low))


def linear_axis(low: float, high: float, label: str, *, most: int = 6, tight: bool = False) -> Axis:
    """An axis on round numbers around a range; `tight` keeps the range's own ends.

    Examples
    --------
    >>> linear_axis(0.0, 87.0, "x").ticks
    (0.0, 20.0, 40.0, 60.0, 80.0, 100.0)
    """
    step = nice_step(high - low, most)
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    ticks = tuple(step * k for k in range(first, last + 1))
    if tight:
        kept = tuple(t for t in ticks if low - 1e-9 * step <= t <= high + 1e-9 * step)
        return Axis(low, high, kept, label)
    return Axis(ticks[0], ticks[-1], ticks, label)


def log_axis(low: float, high: float, label: str) -> Axis:
    """A logarithmic axis with ticks at 1, 2 and 5 of every decade, or at 1 where there are many.

    Examples
    --------
    >>> log_axis(0.5, 12.0, "x").ticks
    (0.5, 1.0, 2.0, 5.0, 10.0)
    """
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    wide = math.log10(high / low) > 3.0
    all_ = [f * 10.0**d for d in decades for f in ((1.0,) if wide else (1.0, 2.0, 5.0))]
    kept = tuple(t for t in all_ if low * (1.0 - 1e-9) <= t <= high * (1.0 + 1e-9))
    return Axis(low, high, kept, label, log=True)


@dataclass(frozen=True)
class Panel:
    """A rectangle of a figure with two axes, px.

    Attributes
    ----------
    id : str
        Unique in the page, for clipping.
    """

    id: str
    x: Axis
    y: Axis
    left: float
    top: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Right edge."""
        return self.left + self.width

    @property
    def bottom(self) -> float:
        """Lower edge."""
        return self.top + self.height

    def place(self, x: float, y: float) -> Point:
        """A point in px."""
        return (
            self.left + self.width * float(self.x.share(x)),
            self.bottom - self.height * float(self.y.share(y)),
        )

    def places(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points in px."""
        return (
            self.left + self.width * self.x.share(x),
            self.bottom - self.height * self.y.share(y),
        )

    @classmethod
    def beside(cls, id_: str, x: Axis, y: Axis, height: float, top: float = 14.0) -> Panel:
        """The one panel of a figure of the width `NARROW`."""
        return cls(id_, x, y, LEFT, top, NARROW - LEFT - RIGHT, height)

    def figure(self, words: Words, body: Sequence[str]) -> Figure:
        """The figure of the width `NARROW` whose lowest panel this is."""
        return words.figure(NARROW, self.bottom + BELOW, body)

    def frame(self, *, names: bool = True) -> list[str]:
        """Grid, ticks and labels; the abscissa's only with `names`."""
        area = element("rect", x=self.left, y=self.top, width=self.width, height=self.height)
        body = [element("clipPath", area, id=f"{self.id}-clip")]
        for tick in self.y.ticks:
            y = self.place(self.x.low, tick)[1]
            body.append(line((self.left, y), (self.right, y), "grid"))
            body.append(text((self.left - 7.0, y + 4.0), significant(tick), "tick", "end"))
        for tick in self.x.ticks:
            x = self.place(tick, self.y.low)[0]
            if self.x.log:
                body.append(line((x, self.top), (x, self.bottom), "grid"))
            # The last number ends where the picture does.
            room = 0.5 * _PITCH * len(significant(tick))
            centre = min(x, NARROW - room) if self.right < NARROW else x
            body += tick_below(x, self.bottom, tick, centre)[: 2 if names else 1]
        body.append(line((self.left, self.bottom), (self.right, self.bottom), "axis"))
        middle = (self.left + 0.5 * self.width, self.top + 0.5 * self.height)
        below = (middle[0], self.bottom + 35.0, self.x.label)
        return body + axis_names(below, (middle[1], self.y.label))[0 if names else 1 :]

    def clipped(self, children: Sequence[str]) -> str:
        """Elements cut off at the panel's edges."""
        return group(children, clip_path=f"url(#{self.id}-clip)")

    def curve(self, x: FloatArray, y: FloatArray, class_: str) -> str:
        """A curve, cut off at the panel's edges."""
        if len(x) < 2:
            return ""
        return self.clipped([polyline(points_of(*self.places(x, y)), f"curve {class_}")])

    def across(self, y: float, class_: str = "limit") -> str:
        """A horizontal line."""
        at = self.place(self.x.low, y)[1]
        return line((self.left, at), (self.right, at), class_)

    def upright(self, x: float, class_: str = "limit") -> str:
        """A vertical line."""
        at = self.place(x, self.y.low)[0]
        return line((at, self.top), (at, self.bottom), class_)

    def band(self, begin: float, end: float, class_: str) -> str:
        """A shaded range of abscissae."""
        at, to = (self.place(value, self.y.low)[0] for value in sorted((begin, end)))
        return rectangle(at, self.top, to - at, self.height, class_)

    def dot(self, x: float, y: float, class_: str) -> str:
        """A marked point."""
        return circle(self.place(x, y), 4.2, class_)

    def labels(self) -> Labels:
        """Labels that stay within the panel."""
        return Labels(self.left + 2.0, self.top, self.right, self.bottom)

    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies in the panel."""
        return 0.0 <= float(self.x.share(x)) <= 1.0 and 0.0 <= float(self.y.share(y)) <= 1.0


@dataclass
class Labels:
    """Labels that keep clear of each other, and of curves where they can.

    Attributes
    ----------
    left, top, right, bottom : float
        Where labels may stand, px.
    """

    left: float
    top: float
    right: float
    bottom: float
    _taken: list[tuple[float, float, float, float]] = field(default_factory=list)
    _xs: list[FloatArray] = field(default_factory=list)
    _ys: list[FloatArray] = field(default_factory=list)

    def avoid(self, xs: ArrayLike, ys: ArrayLike) -> None:
        """Keep clear of the straight lines between these points, px."""
        x, y = np.asarray(xs, dtype=float), np.asarray(ys, dtype=float)
        if len(x) > 1:
            run = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
            at = np.linspace(0.0, run[-1], min(int(run[-1] / 4.0) + 2, 2000))
            x, y = np.interp(at, run, x), np.interp(at, run, y)
        self._xs.append(x)
        self._ys.append(y)

    def avoid_curve(self, panel: Panel, x: FloatArray, y: FloatArray) -> None:
        """Keep clear of a panel's curve."""
        self.avoid(*panel.places(x, y))

    def place(self, at: Point, content: str, class_: str = "tick") -> str:
        """A label beside a point, where it is clearest."""
        wide = _PITCH * len(content)
        best, least = (at[0] + 8.0, at[1] - 6.0), math.inf
        for reach in (1.0, 2.2, 4.0, 6.5):
            for begin, base in _around(at, wide, reach):
                cost = self._cost(begin, base, wide) + 0.3 * reach
                if cost < least:
                    best, least = (begin, base), cost
            if least < 2.0:
                break
        begin, base = best
        self._taken.append((begin, base - _HIGH + 2.0, begin + wide, base + 3.0))
        return text((begin, base), content, class_)

    def _cost(self, begin: float, base: float, wide: float) -> float:
        box = (begin, base - _HIGH + 2.0, begin + wide, base + 3.0)
        cost = 1e4 * max(0.0, self.left - box[0], box[2] - self.right)
        cost += 1e4 * max(0.0, self.top - box[1], box[3] - self.bottom)
        for other in self._taken:
            wide_ = min(box[2], other[2]) - max(box[0], other[0])
            high_ = min(box[3], other[3]) - max(box[1], other[1])
            if wide_ > 0.0 and high_ > 0.0:
                cost += 200.0 + wide_ * high_
        for xs, ys in zip(self._xs, self._ys, strict=True):
            inside = (xs > box[0] - 2.0) & (xs < box[2] + 2.0) & (ys > box[1]) & (ys < box[3])
            cost += 2.0 * float(np.sum(inside))
        return cost


def _around(at: Point, wide: float, reach: float) -> tuple[Point, ...]:
    """Beginnings of the base line of a label around a point: beside, above, below."""
    x, y, gap = at[0], at[1], 4.0 + 4.0 * reach
    return (
        (x + gap, y - 0.5 * gap),
        (x + gap, y + 4.0),
        (x + gap, y + 8.0 + 0.5 * gap),
        (x - 0.5 * wide, y - gap),
        (x - 0.5 * wide, y + 8.0 + gap),
        (x - gap - wide, y - 0.5 * gap),
        (x - gap - wide, y + 4.0),
        (x - gap - wide, y + 8.0 + 0.5 * gap),
    )


@dataclass(frozen=True)
class Legend:
    """Rows of (label, class), each label with a short line before it.

    Attributes
    ----------
    entries : sequence of (str, str)
    left, right : float
        Where rows begin, and what they do not pass, px.
    pitch, apart : float
        px per character, a little generous, and px between two entries.
    """

    entries: Sequence[tuple[str, str]]
    left: float = LEFT
    right: float = NARROW
    pitch: float = 6.9
    apart: float = 10.0

    def _places(self) -> list[tuple[float, int]]:
        """Beginning and row of every entry."""
        found, x, row = [], self.left, 0
        for label, _ in self.entries:
            needed = 24.0 + self.pitch * len(label)
            if x + needed > self.right and x > self.left:
                x, row = self.left, row + 1
            found.append((x, row))
            x += needed + self.apart
        return found

    @property
    def height(self) -> float:
        """Of all rows, px."""
        return 17.0 * max((row + 1 for _, row in self._places()), default=1)

    def render(self) -> str:
        """The legend at the top of a figure."""
        pieces = []
        for (label, class_), (x, row) in zip(self.entries, self._places(), strict=True):
            y = 14.0 + 17.0 * row
            pieces.append(line((x, y - 4.0), (x + 18.0, y - 4.0), f"curve {class_}"))
            pieces.append(text((x + 24.0, y), label, "legend"))
        return group(pieces, class_="legend-row")


def thinned(x: FloatArray, y: FloatArray, bins: int = 240) -> tuple[FloatArray, FloatArray]:
    """Least and greatest of every bin of neighbours, in their order: the same picture, lighter."""
    each = math.ceil(len(x) / bins)
    if each <= 2:
        return x, y
    kept: list[int] = [0]
    for begin in range(0, len(x), each):
        part = y[begin : begin + each]
        kept += sorted({begin + int(part.argmin()), begin + int(part.argmax())})
    kept.append(len(x) - 1)
    chosen = np.array(sorted(set(kept)))
    return x[chosen], y[chosen]
