"""Figures of an evaluation of torque estimators."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.axes import (
    BELOW,
    LEFT,
    NARROW,
    RIGHT,
    Legend,
    Panel,
    axis_names,
    linear_axis,
    nice_step,
    thinned,
)
from cqdd_design.report.ink.bars import TICK_PITCH
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, Words, line, points_of, polyline, rectangle, text

WIDE = 900.0
LABEL = "t-label"
_NAME_PITCH = 6.9

Named = Sequence[tuple[str, str, FloatArray]]
"""Name, class and values of each curve."""


def _legend(estimates: Named, right: float) -> Legend:
    """The label and every estimate."""
    return Legend(
        [("label", LABEL), *((name, class_) for name, class_, _ in estimates)], LEFT, right
    )


def long_trace(words: Words, time: FloatArray, label: FloatArray, estimates: Named) -> Figure:
    """Label and estimates over time, their errors below."""
    width = WIDE - LEFT - RIGHT
    legend = _legend(estimates, WIDE)
    every = np.concatenate([label, *(values for _, _, values in estimates)])
    errors = [values - label for _, _, values in estimates]
    off = np.concatenate(errors) if errors else np.zeros(1)
    x = linear_axis(float(time[0]), float(time[-1]), "time, s", most=10, tight=True)
    torque = linear_axis(float(every.min()), float(every.max()), "torque, N·m")
    error_y = linear_axis(float(off.min()), float(off.max()), "error, N·m", most=4)
    upper = Panel(f"{words.id}-torque", x, torque, LEFT, 8.0 + legend.height, width, 210.0)
    lower = Panel(f"{words.id}-error", x, error_y, LEFT, upper.bottom + 16.0, width, 110.0)
    body = [legend.render(), *upper.frame(names=False), *lower.frame()]
    body.append(upper.curve(*thinned(time, label, 450), f"{LABEL} fine"))
    for (_, class_, values), error in zip(estimates, errors, strict=True):
        body.append(upper.curve(*thinned(time, values, 450), f"{class_} thin"))
        body.append(lower.curve(*thinned(time, error, 450), f"{class_} thin"))
    body.append(lower.across(0.0, "reference"))
    return words.figure(WIDE, lower.bottom + BELOW, body)


def zoomed(words: Words, time: FloatArray, label: FloatArray, estimates: Named) -> Figure:
    """A short stretch, one panel a model, the label in each, less the label's own cubic."""
    columns, gap = 3, 50.0
    width = (WIDE - LEFT - RIGHT - (columns - 1) * gap) / columns
    height, pitch = 118.0, 158.0
    even = np.linspace(-1.0, 1.0, len(time))
    motion = np.polyval(np.polyfit(even, label, 3), even)
    label = label - motion
    # One bad model must not flatten the ripple in every panel.
    near = [float(np.abs(values - motion).max()) for _, _, values in estimates]
    reach = min(1.05 * max([*near, 1e-9]), 3.0 * float(np.abs(label).max()) + 1e-9)
    y = linear_axis(-reach, reach, "", most=4, tight=True)
    x = linear_axis(float(time[0]), float(time[-1]), "time, s", most=4, tight=True)
    rows = -(-len(estimates) // columns)
    body = []
    for k, (name, class_, values) in enumerate(estimates):
        row, column = divmod(k, columns)
        corner = (LEFT + column * (width + gap), 22.0 + row * pitch)
        panel = Panel(f"{words.id}-{k}", x, y, *corner, width, height)
        body += panel.frame(names=k + columns >= len(estimates))
        body.append(text((panel.left, panel.top - 8.0), name, "legend"))
        body.append(panel.curve(time, label, LABEL))
        body.append(panel.curve(time, values - motion, class_))
        if column == 0:
            body += axis_names((0.0, 0.0, ""), (panel.top + 0.5 * height, "torque, N·m"))[1:]
    return words.figure(WIDE, 22.0 + (rows - 1) * pitch + height + BELOW, body)


class Errors(NamedTuple):
    """Distribution of a model's errors.

    Attributes
    ----------
    counts : array (K,)
        In bins.
    bias, spread : float
        N m: mean, and r.m.s. about it.
    """

    name: str
    class_: str
    counts: FloatArray
    bias: float
    spread: float


def distributions(words: Words, edges: FloatArray, models: Sequence[Errors]) -> Figure:
    """A violin of the errors of each model over bins with these edges (K + 1,), N m."""
    left = max(70.0, 14.0 + _NAME_PITCH * max(len(one.name) for one in models))
    pitch, top = 44.0, 10.0
    low, high = float(edges[0]), float(edges[-1])
    panel = Panel(
        words.id,
        linear_axis(low, high, "error, N·m", most=8, tight=True),
        linear_axis(0.0, 1.0, "", most=1),
        left,
        top,
        NARROW - left - RIGHT,
        pitch * len(models),
    )
    body = [line((panel.left, panel.bottom), (panel.right, panel.bottom), "axis")]
    for tick in panel.x.ticks:
        x = panel.place(tick, 0.0)[0]
        body.append(line((x, panel.top), (x, panel.bottom), "grid"))
        body.append(text((x, panel.bottom + 17.0), significant(tick), "tick", "middle"))
    below = (panel.left + 0.5 * panel.width, panel.bottom + 35.0, panel.x.label)
    body += axis_names(below, (0.0, ""))[:1]
    shares = [one.counts / max(one.counts.sum(), 1.0) for one in models]
    most = max(float(share.max()) for share in shares)
    xs, _ = panel.places(0.5 * (edges[1:] + edges[:-1]), np.zeros(len(edges) - 1))

    def inside(value: float) -> float:
        return panel.place(min(max(value, low), high), 0.0)[0]

    for k, (one, share) in enumerate(zip(models, shares, strict=True)):
        at = top + pitch * (k + 0.5)
        # By the root, so that a narrow distribution leaves the shape of a wide one to be seen.
        half = 0.46 * pitch * np.sqrt(share / most)
        outline = [*points_of(xs, at - half), *reversed(points_of(xs, at + half))]
        body.append(polyline(outline, f"violin {one.class_}", closed=True))
        ends = [(inside(one.bias + sign * one.spread), at) for sign in (-1.0, 1.0)]
        body.append(line(ends[0], ends[1], "violin-spread"))
        body.append(rectangle(inside(one.bias) - 1.5, at - 5.0, 3.0, 10.0, "violin-mean"))
        body.append(text((left - 8.0, at + 4.0), one.name, "name-dark", "end"))
    return panel.figure(words, body)


class IntervalBar(NamedTuple):
    """One bar: name, value, ends of its interval where there is one, and style."""

    name: str
    value: float
    ends: tuple[float, float] | None
    class_: str


def interval_bars(words: Words, bars: Sequence[IntervalBar], most: float) -> Figure:
    """Horizontal bars from zero with their intervals.

    Parameters
    ----------
    most : float
        What the longest bar stands for; what is longer is cut and told.
    """
    pitch = 22.0
    labels = [significant(bar.value, 3) for bar in bars]
    left = max(60.0, 12.0 + _NAME_PITCH * max(len(bar.name) for bar in bars))
    reach = NARROW - left - 22.0 - TICK_PITCH * max(map(len, labels))
    base = 8.0 + pitch * len(bars)
    body = []
    step = nice_step(most, 4)
    for k in range(int(most / step + 1e-9) + 1):
        x = left + reach * k * step / most
        body.append(line((x, 6.0), (x, base), "grid"))
        body.append(text((x, base + 14.0), significant(k * step), "tick", "middle"))
    body.append(text((left + 0.5 * reach, base + 31.0), "RMSE, N·m", "label", "middle"))
    for k, (bar, label) in enumerate(zip(bars, labels, strict=True)):
        y = 8.0 + pitch * k
        body.append(text((left - 8.0, y + 12.5), bar.name, "name-dark", "end"))
        length = max(reach * min(bar.value, most) / most, 0.75)
        body.append(rectangle(left, y + 3.0, length, 12.0, f"t-bar {bar.class_}"))
        furthest = length
        if bar.ends is not None and bar.value <= most:
            low, high = (reach * min(max(bound, 0.0), most) / most for bound in bar.ends)
            furthest = max(furthest, high)
            body.append(line((left + low, y + 9.0), (left + high, y + 9.0), "t-whisker"))
            for end in (low, high):
                body.append(line((left + end, y + 5.0), (left + end, y + 13.0), "t-whisker"))
        if bar.value > most:
            # A break in the bar, so that nobody measures it.
            for at in (left + length - 14.0, left + length - 10.0):
                body.append(line((at, y + 17.0), (at + 5.0, y + 1.0), "t-break"))
        body.append(text((left + furthest + 6.0, y + 13.0), label, "tick"))
    return words.figure(NARROW, base + 38.0, body)


def over(
    words: Words,
    x: tuple[str, FloatArray],
    y_label: str,
    label: FloatArray,
    estimates: Named,
    band: tuple[float, float] | None = None,
) -> Figure:
    """Amplitudes of label and estimates over frequency or order.

    Parameters
    ----------
    x : (str, array (F,))
        Name with unit, and abscissae.
    label : array (F,)
    estimates : sequence of (name, class, array (F,))
    band : (float, float), optional
        Shaded; the figure shows what is near it.
    """
    legend, at = _legend(estimates, NARROW), x[1]
    shown = at if band is None else at[(at >= 0.7 * band[0]) & (at <= 1.6 * band[1])]
    inside = (at >= shown[0]) & (at <= shown[-1])
    # Below the band lies the motion itself, and an estimate may be far off: both leave the figure.
    scale = inside if band is None else (at >= band[0]) & (at <= band[1])
    most = max(float(values[scale].max()) for values in (label, *(v for _, _, v in estimates)))
    high = min(1.1 * most, 4.0 * float(label[scale].max()))
    panel = Panel.beside(
        words.id,
        linear_axis(float(shown[0]), float(shown[-1]), x[0], most=8, tight=True),
        linear_axis(0.0, high if high > 0.0 else 1.0, y_label, most=5),
        232.0,
        8.0 + legend.height,
    )
    body = [legend.render()]
    if band is not None:
        body.append(panel.band(*band, "t-band"))
    body += panel.frame()
    body.append(panel.curve(at[inside], label[inside], LABEL))
    body += [panel.curve(at[inside], values[inside], class_) for _, class_, values in estimates]
    return panel.figure(words, body)
