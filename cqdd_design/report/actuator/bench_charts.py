"""Figures of the test bench: efficiency cells, Bode plots, loops, traces and spectra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.report.ink.axes import (
    Axis,
    FloatArray,
    Labels,
    Panel,
    linear_axis,
    log_axis,
    thinned,
)
from cqdd_design.report.ink.heat import shade
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, line, rectangle, text

WIDTH = 430.0
LEFT, RIGHT = 58.0, 16.0
DOWN = -20.0 * math.log10(math.sqrt(2.0))
"""Half of the power, dB."""
COHERENT = 0.8
"""Below it a transfer function is not to be trusted."""


@dataclass(frozen=True)
class Mark:
    """A point of a figure: place, label and style (``dot``, ``dot inside``, ``dot outside``)."""

    x: float
    y: float
    label: str
    class_: str = "dot"


def efficiency_cells(
    id_: str,
    title: str,
    description: str,
    *,
    speed: FloatArray,
    torque: FloatArray,
    efficiency: FloatArray,
    scale: tuple[float, float],
    caption: str,
) -> Figure:
    """Measured efficiencies over speed and torque, each in a cell reaching half way to the next.

    Parameters
    ----------
    speed, torque, efficiency : array (P,)
        rpm, N m (sizes) and shares; every speed is a column, an efficiency of 0 is none.
    scale : (float, float)
        Efficiencies of the lightest and the darkest shade.
    """
    columns = np.unique(speed)
    across = _edges(columns)
    rows = [np.flatnonzero(speed == value) for value in columns]
    rows = [index[np.argsort(torque[index])] for index in rows]
    up = [_edges(torque[index]) for index in rows]
    height, top, bottom = 300.0, 16.0, 44.0
    panel = Panel(
        id_,
        linear_axis(0.0, float(across[-1]), "output speed, rpm", tight=True),
        linear_axis(0.0, max(float(edges[-1]) for edges in up), "output torque, N·m", tight=True),
        LEFT,
        top,
        WIDTH - LEFT - RIGHT,
        height - top - bottom,
    )
    best = int(efficiency.argmax())
    body, peak = panel.frame(), ""
    for k, index in enumerate(rows):
        for j, point in enumerate(index):
            x0, y1 = panel.place(float(across[k]), float(up[k][j]))
            x1, y0 = panel.place(float(across[k + 1]), float(up[k][j + 1]))
            value = float(efficiency[point])
            if value > 0.0:
                grade = max(shade(value - scale[0], scale[1] - scale[0]), 1)
                body.append(rectangle(x0, y0, x1 - x0, y1 - y0, f"heat-{grade} cell"))
            if y1 - y0 >= 13.0 and x1 - x0 >= 28.0:
                tone = "on-dark" if value > 0.0 and grade > 5 else "on-light"
                shown = f"{100.0 * value:.1f}" if value > 0.0 else "\u2013"
                place = (0.5 * (x0 + x1), 0.5 * (y0 + y1) + 4.0)
                body.append(text(place, shown, f"cell-text {tone}", "middle"))
            if point == best and value > 0.0:
                wide, high = max(x1 - x0 - 2.0, 0.5), max(y1 - y0 - 2.0, 0.5)
                peak = rectangle(x0 + 1.0, y0 + 1.0, wide, high, "peak-cell")
    return Figure(id_, title, description, WIDTH, height, "".join([*body, peak]), caption)


def _edges(places: FloatArray) -> FloatArray:
    """Half ways between rising places, beyond the ends by as much, never below zero."""
    if len(places) == 1:
        return np.array([0.0, 2.0 * float(places[0])])
    middle = 0.5 * (places[:-1] + places[1:])
    first = max(float(1.5 * places[0] - 0.5 * places[1]), 0.0)
    return np.asarray(np.r_[first, middle, 1.5 * places[-1] - 0.5 * places[-2]])


def bode(
    id_: str,
    title: str,
    description: str,
    *,
    frequency: FloatArray,
    gain: FloatArray,
    phase: FloatArray,
    coherence: FloatArray | None = None,
    edge: float | None,
    quarter: float | None,
    limits: Sequence[tuple[str, float]] = (),
    caption: str,
) -> Figure:
    """Gain, phase and, where it is known, coherence over frequency.

    Parameters
    ----------
    frequency : array (F,)
        Hz, rising.
    gain : array (F,)
        Relative to that of low frequencies.
    phase : array (F,)
        rad, unwrapped.
    coherence : array (F,), optional
        Curves are drawn faint from where it first falls below `COHERENT`.
    edge, quarter : float or None
        Frequencies of -3 dB and of -90 degrees, to be marked.
    limits : sequence of (name, Hz)
        Drawn as vertical lines, those outside the range left out.
    """
    decibel = 20.0 * np.log10(np.maximum(gain, 1e-12))
    degrees = np.degrees(phase)
    sure = len(frequency)
    if coherence is not None and np.any(coherence < COHERENT):
        sure = max(int(np.argmax(coherence < COHERENT)), 2)
    x = log_axis(float(frequency[0]), float(frequency[-1]), "frequency, Hz")
    top = 32.0 if limits else 14.0
    shape = {"left": LEFT, "width": WIDTH - LEFT - RIGHT}
    gain_y = linear_axis(
        max(min(float(decibel[:sure].min()), -12.0), -40.0),
        min(max(float(decibel[:sure].max()), 3.0), 30.0),
        "gain, dB",
        most=5,
    )
    phase_y = _angles(degrees[:sure])
    panels = [Panel(f"{id_}-gain", x, gain_y, top=top, height=132.0, **shape)]
    panels.append(Panel(f"{id_}-phase", x, phase_y, top=top + 148.0, height=104.0, **shape))
    curves = [decibel, degrees]
    if coherence is not None:
        share = linear_axis(0.0, 1.0, "coherence", most=2)
        panels.append(Panel(f"{id_}-coherence", x, share, top=top + 268.0, height=62.0, **shape))
        curves.append(coherence)
    crossings = {panels[0].id: (edge, DOWN), panels[1].id: (quarter, -90.0)}
    body = []
    for panel, values in zip(panels, curves, strict=True):
        body += panel.frame(names=panel is panels[-1])
        x_drawn, y_drawn = _through(frequency, values, crossings.get(panel.id))
        last = int(np.searchsorted(x_drawn, frequency[sure - 1]))
        body.append(panel.curve(x_drawn[last:], y_drawn[last:], "weak"))
        body.append(panel.curve(x_drawn[: last + 1], y_drawn[: last + 1], "series-1"))
    body += _bode_marks(panels, curves, frequency, sure, edge, quarter, limits)
    height = panels[-1].bottom + 43.0
    return Figure(id_, title, description, WIDTH, height, "".join(body), caption)


def _through(
    x: FloatArray, y: FloatArray, crossing: tuple[float | None, float] | None
) -> tuple[FloatArray, FloatArray]:
    """A curve with its crossing of a level put in between its samples."""
    if crossing is None or crossing[0] is None or crossing[0] in x:
        return x, y
    k = int(np.searchsorted(x, crossing[0]))
    return np.insert(x, k, crossing[0]), np.insert(y, k, crossing[1])


def _angles(degrees: FloatArray) -> Axis:
    """An axis of phase on multiples of 45 degrees, with -90 on it."""
    low = min(math.floor(float(degrees.min()) / 45.0), -3)
    high = max(math.ceil(float(degrees.max()) / 45.0), 0)
    step = 1 if high - low <= 5 else 2
    low, high = (max(low, -10) // step) * step, min(high, 4)
    ticks = tuple(45.0 * k for k in range(low, high + 1, step))
    return Axis(45.0 * low, 45.0 * high, ticks, "phase, °")


def _bode_marks(
    panels: Sequence[Panel],
    curves: Sequence[FloatArray],
    frequency: FloatArray,
    sure: int,
    edge: float | None,
    quarter: float | None,
    limits: Sequence[tuple[str, float]],
) -> list[str]:
    """Levels, crossings and limits, with labels that keep clear."""
    body = []
    bounds = [(name, at) for name, at in limits if frequency[0] <= at <= frequency[-1]]
    for k, (name, at) in enumerate(sorted(bounds, key=lambda item: item[1])):
        x = panels[0].place(at, 0.0)[0]
        body += [panel.upright(at, "bound") for panel in panels[:2]]
        room = 6.3 * len(name)
        begin = min(max(x - 0.5 * room, 0.0), WIDTH - room)
        level = panels[0].top - 6.0 - (13.0 if k % 2 else 0.0)
        body.append(text((begin, level), name, "tick bound-label"))
    wanted = (
        (panels[0], curves[0], DOWN, edge, "\u22123 dB"),
        (panels[1], curves[1], -90.0, quarter, "\u221290°"),
    )
    for panel, values, level, crossed, name in wanted:
        if not panel.y.low <= level <= panel.y.high:
            continue
        body.append(panel.across(level, "reference"))
        labels = Labels(panel.left + 2.0, panel.top, panel.right, panel.bottom)
        labels.avoid_curve(
            panel, frequency[:sure], np.clip(values[:sure], panel.y.low, panel.y.high)
        )
        y = panel.place(panel.x.low, level)[1]
        labels.avoid([panel.left, panel.right], [y, y])
        for _, bound in bounds:
            x = panel.place(bound, 0.0)[0]
            labels.avoid([x, x], [panel.top, panel.bottom])
        if crossed is not None and panel.holds(crossed, level):
            body.append(panel.dot(crossed, level, "dot"))
            shown = f"{name} at {significant(crossed, 3)} Hz"
            body.append(labels.place(panel.place(crossed, level), shown))
        else:
            body.append(labels.place((panel.left, y), name))
    if len(panels) > 2:
        body.append(panels[2].across(COHERENT, "reference"))
    return body


def hysteresis(
    id_: str,
    title: str,
    description: str,
    *,
    motor: FloatArray,
    output: FloatArray,
    dead: tuple[float, float, float] | None,
    label: str,
    caption: str,
) -> Figure:
    """Output angle over motor angle through the ratio.

    Parameters
    ----------
    motor, output : array (T,)
        arcmin, in the order of time.
    dead : (begin, end, output angle) or None
        Motor angles between which the output stands, to be marked with `label`.
    """
    reach = 1.06 * max(float(np.abs(motor).max()), 1e-9)
    least, most = float(output.min()), float(output.max())
    span = max(most - least, 1e-9)
    # The dimension stands beyond the flank on which the output rests.
    above = dead is None or dead[2] >= 0.5 * (least + most)
    least, most = least - (0.05 if above else 0.24) * span, most + (0.24 if above else 0.05) * span
    panel = Panel(
        id_,
        linear_axis(-reach, reach, "motor angle over ratio, arcmin", tight=True),
        linear_axis(least, most, "output angle, arcmin", tight=True),
        LEFT,
        14.0,
        WIDTH - LEFT - RIGHT,
        250.0,
    )
    body = panel.frame()
    if dead is not None:
        body.append(panel.band(dead[0], dead[1], "dead-zone"))
    body.append(panel.curve(*_sparse(motor, output), "series-1"))
    if dead is not None:
        begin, end = panel.place(dead[0], dead[2]), panel.place(dead[1], dead[2])
        level = begin[1] + (-16.0 if above else 16.0)
        body.append(line((begin[0], level), (end[0], level), "whisker"))
        for side in (begin[0], end[0]):
            body.append(line((side, level - 5.0), (side, level + 5.0), "whisker"))
        room = 0.5 * 6.5 * len(label) + 2.0
        middle = 0.5 * (begin[0] + end[0])
        middle = min(max(middle, panel.left + room), panel.right - room)
        body.append(text((middle, level + (-7.0 if above else 16.0)), label, "legend", "middle"))
    height = panel.bottom + 43.0
    return Figure(id_, title, description, WIDTH, height, "".join(body), caption)


def _sparse(x: FloatArray, y: FloatArray, points: int = 500) -> tuple[FloatArray, FloatArray]:
    """A path with points evenly along it instead of evenly in time."""
    wide, high = float(np.ptp(x)) or 1.0, float(np.ptp(y)) or 1.0
    run = np.r_[0.0, np.cumsum(np.hypot(np.diff(x) / wide, np.diff(y) / high))]
    chosen = np.unique(np.searchsorted(run, np.linspace(0.0, run[-1], points)))
    chosen = np.minimum(chosen, len(x) - 1)
    return x[chosen], y[chosen]


def trace(
    id_: str,
    title: str,
    description: str,
    *,
    x: FloatArray,
    y: FloatArray,
    x_label: str,
    y_label: str,
    level: tuple[str, float] | None = None,
    marks: Sequence[Mark] = (),
    caption: str,
) -> Figure:
    """One measured curve over zero, with a level across it and marked points."""
    low, high = float(y.min()), float(y.max())
    low, high = min(low, 0.0), max(high, 0.0)
    high = high if high - low > 1e-9 else 1.0
    panel = Panel(
        id_,
        linear_axis(float(x.min()), float(x.max()), x_label, tight=True),
        linear_axis(low, high + 0.08 * max(high - low, 1e-12), y_label, most=5),
        LEFT,
        14.0,
        WIDTH - LEFT - RIGHT,
        210.0,
    )
    labels = Labels(panel.left + 2.0, panel.top, panel.right, panel.bottom)
    drawn = thinned(x, y)
    labels.avoid_curve(panel, *drawn)
    body = [*panel.frame(), panel.curve(*drawn, "series-1 fine")]
    if level is not None:
        body.append(panel.across(level[1], "mean"))
        labels.avoid_curve(panel, np.array([panel.x.low, panel.x.high]), np.full(2, level[1]))
        place = panel.place(panel.x.low + 0.5 * (panel.x.high - panel.x.low), level[1])
        body.append(labels.place(place, level[0]))
    for mark in marks:
        body.append(panel.dot(mark.x, mark.y, mark.class_))
        body.append(labels.place(panel.place(mark.x, mark.y), mark.label))
    height = panel.bottom + 43.0
    return Figure(id_, title, description, WIDTH, height, "".join(body), caption)


def spectrum(
    id_: str,
    title: str,
    description: str,
    *,
    order: FloatArray,
    amplitude: FloatArray,
    named: Sequence[int],
    y_label: str,
    caption: str,
) -> Figure:
    """Amplitudes over order as thin bars, the strongest with their numbers.

    Parameters
    ----------
    order, amplitude : array (O,)
    named : sequence of int
        Orders to number, strongest first.
    """
    most = max(float(amplitude.max()), 1e-30)
    loud = order[amplitude > 0.004 * most]
    last = 1.06 * max(float(loud.max()), 10.0)
    panel = Panel(
        id_,
        linear_axis(0.0, last, "order, periods in an output turn", most=8, tight=True),
        linear_axis(0.0, 1.1 * most, y_label, most=5),
        LEFT,
        14.0,
        WIDTH - LEFT - RIGHT,
        232.0,
    )
    labels = Labels(panel.left + 2.0, panel.top, panel.right + 10.0, panel.bottom)
    body = panel.frame()
    for k, height in zip(order, amplitude, strict=True):
        if float(k) > panel.x.high or height < 0.002 * most:
            continue
        x, y = panel.place(float(k), float(height))
        body.append(line((x, panel.bottom), (x, y), "order-bar"))
        labels.avoid([x, x], [panel.bottom, y])
    values = dict(zip(order.astype(int).tolist(), amplitude.tolist(), strict=True))
    for k in named:
        if k in values and k <= panel.x.high:
            body.append(labels.place(panel.place(float(k), values[k]), str(k)))
    height = panel.bottom + 43.0
    return Figure(id_, title, description, WIDTH, height, "".join(body), caption)
