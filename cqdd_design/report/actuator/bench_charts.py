"""Figures of the test bench: efficiency cells, Bode plots, loops, traces and spectra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cqdd_design.actuator.bench.bandwidth import COHERENT
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.axes import NARROW, Axis, Panel, linear_axis, log_axis, thinned
from cqdd_design.report.ink.heat import cell, shade
from cqdd_design.report.ink.numbers import NONE, significant
from cqdd_design.report.ink.svg import Figure, Words, line, rectangle, text

_BAR_STEP = 0.5
"""Between bars of a spectrum, px; they are two wide."""
_DOWN = -20.0 * math.log10(math.sqrt(2.0))
"""Half of the power, dB."""


class Mark(NamedTuple):
    """A point of a figure: place, label and style (``dot``, ``dot inside``, ``dot outside``)."""

    x: float
    y: float
    label: str
    class_: str = "dot"


def efficiency_cells(
    words: Words,
    speed: FloatArray,
    torque: FloatArray,
    efficiency: FloatArray,
    scale: tuple[float, float],
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
    highest = max(float(edges[-1]) for edges in up)
    panel = Panel.beside(
        words.id,
        linear_axis(0.0, float(across[-1]), "output speed, rpm", tight=True),
        linear_axis(0.0, highest, "output torque, N·m", tight=True),
        240.0,
        top=16.0,
    )
    best = int(efficiency.argmax())
    body, peak = panel.frame(), ""
    for k, index in enumerate(rows):
        for j, point in enumerate(index):
            x0, y1 = panel.place(float(across[k]), float(up[k][j]))
            x1, y0 = panel.place(float(across[k + 1]), float(up[k][j + 1]))
            value, wide, high = float(efficiency[point]), x1 - x0, y1 - y0
            grade, shown = 0, NONE
            if value > 0.0:
                grade = max(shade(value - scale[0], scale[1] - scale[0]), 1)
                shown = f"{100.0 * value:.1f}"
            roomy = high >= 13.0 and wide >= 28.0
            body += cell((x0, y0, wide, high), grade, shown if roomy else "")
            if point == best and value > 0.0:
                inside = (max(wide - 2.0, 0.5), max(high - 2.0, 0.5))
                peak = rectangle(x0 + 1.0, y0 + 1.0, *inside, "peak-cell")
    return words.figure(NARROW, 300.0, [*body, peak])


def _edges(places: FloatArray) -> FloatArray:
    """Half ways between rising places, beyond the ends by as much, never below zero."""
    if len(places) == 1:
        return np.array([0.0, 2.0 * float(places[0])])
    middle = 0.5 * (places[:-1] + places[1:])
    first = max(float(1.5 * places[0] - 0.5 * places[1]), 0.0)
    return np.asarray(np.r_[first, middle, 1.5 * places[-1] - 0.5 * places[-2]])


class Response(NamedTuple):
    """A measured frequency response.

    Attributes
    ----------
    frequency : array (F,)
        Hz, rising.
    gain : array (F,)
        Relative to that of low frequencies.
    phase : array (F,)
        rad, unwrapped.
    edge, quarter : float or None
        Frequencies of -3 dB and of -90 degrees, to be marked.
    coherence : array (F,) or None
        Curves are drawn faint from where it first falls below `COHERENT`.
    """

    frequency: FloatArray
    gain: FloatArray
    phase: FloatArray
    edge: float | None
    quarter: float | None
    coherence: FloatArray | None = None

    @property
    def sure(self) -> int:
        """How many of the frequencies can be trusted."""
        if self.coherence is None or not np.any(self.coherence < COHERENT):
            return len(self.frequency)
        return max(int(np.argmax(self.coherence < COHERENT)), 2)


class _Track(NamedTuple):
    """One panel of a Bode plot: its values, and the level it is judged at with its crossing."""

    panel: Panel
    values: FloatArray
    level: float
    name: str
    crossed: float | None


def bode(words: Words, found: Response, limits: Sequence[tuple[str, float]] = ()) -> Figure:
    """Gain, phase and, where it is known, coherence over frequency.

    Parameters
    ----------
    limits : sequence of (name, Hz)
        Drawn as vertical lines, those outside the range left out.
    """
    frequency, sure, id_ = found.frequency, found.sure, words.id
    decibel, degrees = 20.0 * np.log10(np.maximum(found.gain, 1e-12)), np.degrees(found.phase)
    x = log_axis(float(frequency[0]), float(frequency[-1]), "frequency, Hz")
    top = 32.0 if limits else 14.0
    low = max(min(float(decibel[:sure].min()), -12.0), -40.0)
    high = min(max(float(decibel[:sure].max()), 3.0), 30.0)
    gain = Panel.beside(f"{id_}-gain", x, linear_axis(low, high, "gain, dB", most=5), 132.0, top)
    phase = Panel.beside(f"{id_}-phase", x, _angles(degrees[:sure]), 104.0, top + 148.0)
    tracks = [
        _Track(gain, decibel, _DOWN, "\u22123 dB", found.edge),
        _Track(phase, degrees, -90.0, "\u221290°", found.quarter),
    ]
    if found.coherence is not None:
        share = linear_axis(0.0, 1.0, "coherence", most=2)
        below = Panel.beside(f"{id_}-coherence", x, share, 62.0, top + 268.0)
        tracks.append(_Track(below, found.coherence, COHERENT, "", None))
    body = []
    for track in tracks:
        panel = track.panel
        body += panel.frame(names=track is tracks[-1])
        x_drawn, y_drawn = _through(frequency, track)
        last = int(np.searchsorted(x_drawn, frequency[sure - 1]))
        body.append(panel.curve(x_drawn[last:], y_drawn[last:], "weak"))
        body.append(panel.curve(x_drawn[: last + 1], y_drawn[: last + 1], "series-1"))
    bounds = [(name, at) for name, at in limits if frequency[0] <= at <= frequency[-1]]
    body += _bounds(gain, phase, bounds)
    for track in tracks[:2]:
        body += _crossing(track, frequency[:sure], bounds)
    if found.coherence is not None:
        body.append(tracks[2].panel.across(COHERENT, "reference"))
    return tracks[-1].panel.figure(words, body)


def _through(x: FloatArray, track: _Track) -> tuple[FloatArray, FloatArray]:
    """A curve with its crossing of a level put in between its samples."""
    if track.crossed is None or track.crossed in x:
        return x, track.values
    k = int(np.searchsorted(x, track.crossed))
    return np.insert(x, k, track.crossed), np.insert(track.values, k, track.level)


def _angles(degrees: FloatArray) -> Axis:
    """An axis of phase on multiples of 45 degrees, with -90 on it."""
    low = min(math.floor(float(degrees.min()) / 45.0), -3)
    high = max(math.ceil(float(degrees.max()) / 45.0), 0)
    step = 1 if high - low <= 5 else 2
    low, high = (max(low, -10) // step) * step, min(high, 4)
    ticks = tuple(45.0 * k for k in range(low, high + 1, step))
    return Axis(45.0 * low, 45.0 * high, ticks, "phase, °")


def _bounds(gain: Panel, phase: Panel, bounds: Sequence[tuple[str, float]]) -> list[str]:
    """Vertical lines through gain and phase, named above them on two levels."""
    body = []
    for k, (name, at) in enumerate(sorted(bounds, key=lambda item: item[1])):
        body += [panel.upright(at, "bound") for panel in (gain, phase)]
        room = 6.3 * len(name)
        begin = min(max(gain.place(at, 0.0)[0] - 0.5 * room, 0.0), NARROW - room)
        level = gain.top - 6.0 - (13.0 if k % 2 else 0.0)
        body.append(text((begin, level), name, "tick bound-label"))
    return body


def _crossing(
    track: _Track, frequency: FloatArray, bounds: Sequence[tuple[str, float]]
) -> list[str]:
    """A level and where the curve crosses it, with a label that keeps clear."""
    panel, level = track.panel, track.level
    if not panel.y.low <= level <= panel.y.high:
        return []
    labels = panel.labels()
    seen = np.clip(track.values[: len(frequency)], panel.y.low, panel.y.high)
    labels.avoid_curve(panel, frequency, seen)
    y = panel.place(panel.x.low, level)[1]
    labels.avoid([panel.left, panel.right], [y, y])
    for _, bound in bounds:
        x = panel.place(bound, 0.0)[0]
        labels.avoid([x, x], [panel.top, panel.bottom])
    body = [panel.across(level, "reference")]
    if track.crossed is None or not panel.holds(track.crossed, level):
        return [*body, labels.place((panel.left, y), track.name)]
    shown = f"{track.name} at {significant(track.crossed, 3)} Hz"
    dot = panel.dot(track.crossed, level, "dot")
    return [*body, dot, labels.place(panel.place(track.crossed, level), shown)]


def hysteresis(
    words: Words,
    motor: FloatArray,
    output: FloatArray,
    dead: tuple[float, float, float] | None,
    label: str,
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
    panel = Panel.beside(
        words.id,
        linear_axis(-reach, reach, "motor angle over ratio, arcmin", tight=True),
        linear_axis(least, most, "output angle, arcmin", tight=True),
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
    return panel.figure(words, body)


def _sparse(x: FloatArray, y: FloatArray, points: int = 500) -> tuple[FloatArray, FloatArray]:
    """A path with points evenly along it instead of evenly in time."""
    wide, high = float(np.ptp(x)) or 1.0, float(np.ptp(y)) or 1.0
    run = np.r_[0.0, np.cumsum(np.hypot(np.diff(x) / wide, np.diff(y) / high))]
    chosen = np.unique(np.searchsorted(run, np.linspace(0.0, run[-1], points)))
    chosen = np.minimum(chosen, len(x) - 1)
    return x[chosen], y[chosen]


def trace(
    words: Words,
    x: tuple[str, FloatArray],
    y: tuple[str, FloatArray],
    *,
    level: tuple[str, float] | None = None,
    marks: Sequence[Mark] = (),
) -> Figure:
    """One measured curve over zero, names and values of x and y, with a level and marked points."""
    low, high = min(float(y[1].min()), 0.0), max(float(y[1].max()), 0.0)
    high = high if high - low > 1e-9 else 1.0
    panel = Panel.beside(
        words.id,
        linear_axis(float(x[1].min()), float(x[1].max()), x[0], tight=True),
        linear_axis(low, high + 0.08 * max(high - low, 1e-12), y[0], most=5),
        210.0,
    )
    labels = panel.labels()
    drawn = thinned(x[1], y[1])
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
    return panel.figure(words, body)


def spectrum(
    words: Words, order: FloatArray, amplitude: FloatArray, named: Sequence[int], y_label: str
) -> Figure:
    """Amplitudes over order as thin bars, the strongest with their numbers.

    Of bars that hide each other, four within the width of one, the tallest is drawn.

    Parameters
    ----------
    order, amplitude : array (O,)
    named : sequence of int
        Orders to number, strongest first.
    y_label : str
        With the unit.
    """
    most = max(float(amplitude.max()), 1e-30)
    loud = order[amplitude > 0.004 * most]
    last = 1.06 * max(float(loud.max()), 10.0)
    panel = Panel.beside(
        words.id,
        linear_axis(0.0, last, "order, periods in an output turn", most=8, tight=True),
        linear_axis(0.0, 1.1 * most, y_label, most=5),
        232.0,
    )
    labels = panel.labels()
    labels.right += 10.0
    body = panel.frame()
    tallest: dict[int, tuple[float, float]] = {}
    for k, height in zip(order, amplitude, strict=True):
        if float(k) > panel.x.high or height < 0.002 * most:
            continue
        x, y = panel.place(float(k), float(height))
        place = round(x / _BAR_STEP)
        # Down the page is up the amplitude.
        tallest[place] = min(tallest.get(place, (x, y)), (x, y), key=lambda one: one[1])
    for x, y in tallest.values():
        body.append(line((x, panel.bottom), (x, y), "order-bar"))
        labels.avoid([x, x], [panel.bottom, y])
    values = dict(zip(order.astype(int).tolist(), amplitude.tolist(), strict=True))
    for k in named:
        if k in values and k <= panel.x.high:
            body.append(labels.place(panel.place(float(k), values[k]), str(k)))
    return panel.figure(words, body)
