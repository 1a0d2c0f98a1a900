"""Figures of an evaluation of torque estimators."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cqdd_design.report.ink.axes import (
    FloatArray,
    Panel,
    legend,
    legend_rows,
    linear_axis,
    thinned,
)
from cqdd_design.report.ink.charts import nice_step
from cqdd_design.report.ink.numbers import significant
from cqdd_design.report.ink.svg import Figure, line, points_of, polyline, rectangle, text

WIDE, NARROW = 900.0, 430.0
LEFT, RIGHT = 58.0, 16.0
LABEL = "t-label"
_NAME_PITCH, _TICK_PITCH = 6.9, 6.4

Named = Sequence[tuple[str, str, FloatArray]]
"""Name, class and values of each curve."""


def long_trace(
    id_: str,
    title: str,
    description: str,
    *,
    time: FloatArray,
    label: FloatArray,
    estimates: Named,
    caption: str,
) -> Figure:
    """Label and estimates over time, their errors below."""
    width = WIDE - LEFT - RIGHT
    entries = [("label", LABEL), *((name, class_) for name, class_, _ in estimates)]
    top = 8.0 + 17.0 * legend_rows(entries, LEFT, WIDE)
    every = np.concatenate([label, *(values for _, _, values in estimates)])
    errors = [values - label for _, _, values in estimates]
    off = np.concatenate(errors) if errors else np.zeros(1)
    x = linear_axis(float(time[0]), float(time[-1]), "time, s", most=10, tight=True)
    upper = Panel(
        f"{id_}-torque",
        x,
        linear_axis(float(every.min()), float(every.max()), "torque, N·m"),
        LEFT,
        top,
        width,
        210.0,
    )
    lower = Panel(
        f"{id_}-error",
        x,
        linear_axis(float(off.min()), float(off.max()), "error, N·m", most=4),
        LEFT,
        upper.bottom + 16.0,
        width,
        110.0,
    )
    body = [legend(entries, LEFT, WIDE, 14.0), *upper.frame(names=False), *lower.frame()]
    body.append(upper.curve(*thinned(time, label, 450), f"{LABEL} fine"))
    for (_, class_, values), error in zip(estimates, errors, strict=True):
        body.append(upper.curve(*thinned(time, values, 450), f"{class_} thin"))
        body.append(lower.curve(*thinned(time, error, 450), f"{class_} thin"))
    body.append(lower.across(0.0, "reference"))
    return Figure(id_, title, description, WIDE, lower.bottom + 43.0, "".join(body), caption)


def zoomed(
    id_: str,
    title: str,
    description: str,
    *,
    time: FloatArray,
    label: FloatArray,
    estimates: Named,
    caption: str,
) -> Figure:
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
        last = k + columns >= len(estimates)
        panel = Panel(
            f"{id_}-{k}",
            x,
            y,
            LEFT + column * (width + gap),
            22.0 + row * pitch,
            width,
            height,
        )
        body += panel.frame(names=last)
        body.append(text((panel.left, panel.top - 8.0), name, "legend"))
        body.append(panel.curve(time, label, LABEL))
        body.append(panel.curve(time, values - motion, class_))
        if column == 0:
            place = (14.0, panel.top + 0.5 * height)
            body.append(text(place, "torque, N·m", "label", "middle", turn=-90.0))
    total = 22.0 + (rows - 1) * pitch + height + 43.0
    return Figure(id_, title, description, WIDE, total, "".join(body), caption)


def distributions(
    id_: str,
    title: str,
    description: str,
    *,
    edges: FloatArray,
    counts: Sequence[tuple[str, str, FloatArray]],
    marks: Sequence[tuple[float, float]],
    caption: str,
) -> Figure:
    """A violin of the errors of each model.

    Parameters
    ----------
    edges : array (K + 1,)
        N m.
    counts : sequence of (name, class, array (K,))
    marks : sequence of (bias, r.m.s. error about it)
        N m; a dot and a line of one standard deviation to either side.
    """
    left = max(70.0, 14.0 + _NAME_PITCH * max(len(name) for name, _, _ in counts))
    pitch, top = 44.0, 10.0
    panel = Panel(
        id_,
        linear_axis(float(edges[0]), float(edges[-1]), "error, N·m", most=8, tight=True),
        linear_axis(0.0, 1.0, "", most=1),
        left,
        top,
        NARROW - left - RIGHT,
        pitch * len(counts),
    )
    centres = 0.5 * (edges[1:] + edges[:-1])
    body = [line((panel.left, panel.bottom), (panel.right, panel.bottom), "axis")]
    for tick in panel.x.ticks:
        x = panel.place(tick, 0.0)[0]
        body.append(line((x, panel.top), (x, panel.bottom), "grid"))
        body.append(text((x, panel.bottom + 17.0), significant(tick), "tick", "middle"))
    middle = panel.left + 0.5 * panel.width
    body.append(text((middle, panel.bottom + 35.0), panel.x.label, "label", "middle"))
    most = max(float((found / max(found.sum(), 1.0)).max()) for _, _, found in counts)
    for k, ((name, class_, found), (bias, spread)) in enumerate(zip(counts, marks, strict=True)):
        at = top + pitch * (k + 0.5)
        # By the root, so that a narrow distribution leaves the shape of a wide one to be seen.
        half = 0.46 * pitch * np.sqrt(found / max(found.sum(), 1.0) / most)
        xs, _ = panel.places(centres, np.zeros(len(centres)))
        outline = [*points_of(xs, at - half), *reversed(points_of(xs, at + half))]
        body.append(polyline(outline, f"violin {class_}", closed=True))
        ends = [min(max(bias + s * spread, edges[0]), edges[-1]) for s in (-1.0, 1.0)]
        (x0, _), (x1, _) = (panel.place(float(end), 0.0) for end in ends)
        body.append(line((x0, at), (x1, at), "violin-spread"))
        inside = min(max(bias, float(edges[0])), float(edges[-1]))
        dot = panel.place(inside, 0.0)[0]
        body.append(rectangle(dot - 1.5, at - 5.0, 3.0, 10.0, "violin-mean"))
        body.append(text((left - 8.0, at + 4.0), name, "name-dark", "end"))
    return Figure(id_, title, description, NARROW, panel.bottom + 43.0, "".join(body), caption)


def interval_bars(
    id_: str,
    title: str,
    description: str,
    *,
    names: Sequence[str],
    values: Sequence[float],
    ends: Sequence[tuple[float, float] | None],
    classes: Sequence[str],
    caption: str,
    most: float,
) -> Figure:
    """Horizontal bars from zero with their intervals; what is longer than `most` is cut and told.

    Parameters
    ----------
    most : float
        What the longest bar stands for.
    """
    pitch = 22.0
    labels = [significant(value, 3) for value in values]
    left = max(60.0, 12.0 + _NAME_PITCH * max(map(len, names)))
    right = 22.0 + _TICK_PITCH * max(map(len, labels))
    reach = NARROW - left - right
    base = 8.0 + pitch * len(names)
    body = []
    step = nice_step(most, 4)
    for k in range(int(most / step + 1e-9) + 1):
        x = left + reach * k * step / most
        body.append(line((x, 6.0), (x, base), "grid"))
        body.append(text((x, base + 14.0), significant(k * step), "tick", "middle"))
    body.append(text((left + 0.5 * reach, base + 31.0), "RMSE, N·m", "label", "middle"))
    for k, (name, value, bounds, class_) in enumerate(
        zip(names, values, ends, classes, strict=True)
    ):
        y = 8.0 + pitch * k
        body.append(text((left - 8.0, y + 12.5), name, "name-dark", "end"))
        cut = min(value, most)
        length = max(reach * cut / most, 0.75)
        body.append(rectangle(left, y + 3.0, length, 12.0, f"t-bar {class_}"))
        furthest = length
        if bounds is not None and value <= most:
            low, high = (reach * min(max(bound, 0.0), most) / most for bound in bounds)
            furthest = max(furthest, high)
            body.append(line((left + low, y + 9.0), (left + high, y + 9.0), "t-whisker"))
            for end in (low, high):
                body.append(line((left + end, y + 5.0), (left + end, y + 13.0), "t-whisker"))
        if value > most:
            # A break in the bar, so that nobody measures it.
            at = left + length - 14.0
            for shift in (0.0, 4.0):
                start, end_ = (at + shift, y + 17.0), (at + shift + 5.0, y + 1.0)
                body.append(line(start, end_, "t-break"))
        body.append(text((left + furthest + 6.0, y + 13.0), labels[k], "tick"))
    return Figure(id_, title, description, NARROW, base + 38.0, "".join(body), caption)


def over(
    id_: str,
    title: str,
    description: str,
    *,
    x: FloatArray,
    label: FloatArray,
    estimates: Named,
    x_label: str,
    y_label: str,
    band: tuple[float, float] | None,
    caption: str,
) -> Figure:
    """Amplitudes of label and estimates over frequency or order."""
    entries = [("label", LABEL), *((name, class_) for name, class_, _ in estimates)]
    top = 8.0 + 17.0 * legend_rows(entries, LEFT, NARROW)
    shown = x if band is None else x[(x >= 0.7 * band[0]) & (x <= 1.6 * band[1])]
    inside = (x >= shown[0]) & (x <= shown[-1])
    # Below the band lies the motion itself, and an estimate may be far off: both leave the figure.
    scale = inside if band is None else (x >= band[0]) & (x <= band[1])
    most = max(float(values[scale].max()) for values in (label, *(v for _, _, v in estimates)))
    high = min(1.1 * most, 4.0 * float(label[scale].max()))
    panel = Panel(
        id_,
        linear_axis(float(shown[0]), float(shown[-1]), x_label, most=8, tight=True),
        linear_axis(0.0, high if high > 0.0 else 1.0, y_label, most=5),
        LEFT,
        top,
        NARROW - LEFT - RIGHT,
        232.0,
    )
    body = [legend(entries, LEFT, NARROW, 14.0)]
    if band is not None:
        body.append(panel.band(*band, "t-band"))
    body += panel.frame()
    body.append(panel.curve(x[inside], label[inside], LABEL))
    body += [panel.curve(x[inside], values[inside], class_) for _, class_, values in estimates]
    return Figure(id_, title, description, NARROW, panel.bottom + 43.0, "".join(body), caption)
