"""Figures of the virtual test bench from the traces of its measurements."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.bench.bandwidth import COHERENT, DOWN, crossing
from cqdd_design.actuator.bench.gear import dead_zone
from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.operating import holds_itself
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.gearbox.precision.orders import order_name
from cqdd_design.report.actuator.bench_charts import (
    Mark,
    Response,
    bode,
    efficiency_cells,
    hysteresis,
    spectrum,
    trace,
)
from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.numbers import ARCMIN, maybe, significant, with_unit
from cqdd_design.report.ink.svg import Figure, Words

BACKDRIVEN = ("backdrive_static", "backdrive_dynamic")
"""Measurements in which the output turns the motor."""
_NAMED_ORDERS, _MARKED_ORDERS = 8, 5


def bench_figures(
    parameters: ActuatorParameters, bench: BenchResult, pin_count: int
) -> tuple[Figure, ...]:
    """Figures of all traces there are."""
    unturned = BACKDRIVEN if holds_itself(parameters) else ()
    found = {m.name: m for m in bench.metrics if m.trace and m.name not in unturned}
    n, motor = abs(parameters.gear.ratio), parameters.motor
    cogging = motor.cogging_order if motor.cogging_amplitude > 0.0 else 0
    drawing: dict[str, Callable[[Metric], list[Figure]]] = {
        "torque_bandwidth": _torque_bode,
        "position_bandwidth_45deg": _position_bode,
        "position_bandwidth_5deg": _position_bode,
        "backlash": _backlash,
        "backdrive_static": lambda metric: _breakaway(metric, n),
        "backdrive_dynamic": _backdrive,
        "torque_ripple": lambda metric: _ripple(metric, round(n), pin_count, cogging),
    }
    return tuple(
        figure for name, draw in drawing.items() if name in found for figure in draw(found[name])
    )


def finite(details: Mapping[str, float], key: str) -> float | None:
    """A detail of a measurement; None where it has none or no number."""
    value = details.get(key)
    return value if value is not None and math.isfinite(value) else None


def _torque_bode(metric: Metric) -> list[Figure]:
    columns = metric.trace
    low = finite(metric.details, "low_frequency_gain") or float(columns["gain"][0])
    found = _response(metric, low)
    edge = _hertz(found.edge)
    caption = (
        f"Of the locked output, gain relative to {significant(low, 3)} of the torque asked at low "
        f"frequencies; \u22123 dB at {edge}, \u221290° at {_hertz(found.quarter)}."
    )
    if found.coherence is not None:
        sure = _falls(found.frequency, found.coherence, COHERENT)
        if sure is not None:
            caption += (
                f" Beyond {_hertz(sure)} the coherence is below {COHERENT:g} and curves are faint."
            )
    words = Words(
        "torque-bode",
        "Torque bandwidth",
        f"Gain, phase and coherence of torque over the torque asked; minus 3 dB at {edge}.",
        caption,
    )
    return [bode(words, found)]


def _response(metric: Metric, low: float) -> Response:
    """The response of a trace over its gain at low frequencies, with its crossings."""
    columns = metric.trace
    frequency, gain = columns["frequency [Hz]"], columns["gain"] / low
    phase = np.unwrap(columns["phase [rad]"])
    reached = math.isfinite(metric.value) and _falls(frequency, gain, DOWN) is not None
    return Response(
        frequency,
        gain,
        phase,
        edge=metric.value if reached else None,
        quarter=_falls(frequency, phase, -0.5 * math.pi),
        coherence=columns.get("coherence"),
    )


def _falls(frequency: FloatArray, values: FloatArray, level: float) -> float | None:
    """Where values first fall through a level; None where they do not."""
    return crossing(frequency, values, level) if bool(np.any(values < level)) else None


def _hertz(frequency: float | None) -> str:
    return "no measured frequency" if frequency is None else with_unit(frequency, "Hz", 3)


def _position_bode(metric: Metric) -> list[Figure]:
    details = metric.details
    found = _response(metric, float(metric.trace["gain"][0]))
    edge = _hertz(found.edge)
    degrees = metric.name.removeprefix("position_bandwidth_").removesuffix("deg")
    limits, told = [], []
    for name in ("speed", "torque"):
        value = finite(details, f"limit_by_{name}_Hz")
        if value is not None:
            limits.append((f"{name} limit {significant(value, 3)} Hz", value))
            told.append(f"{name} at {with_unit(value, 'Hz', 3)}")
    settings = [
        with_unit(details[key], unit, 3)
        for key, unit in (
            ("position_gain_Nm_per_rad", "N*m/rad"),
            ("velocity_gain_Nms_per_rad", "N*m*s/rad"),
            ("voltage_V", "V"),
        )
        if key in details
    ]
    caption = (
        f"Stepped sine of ±{degrees}°, fundamental of the answer, with {', '.join(settings)}; "
        f"\u22123 dB at {edge}."
    )
    if told:
        caption += f" Dotted: where a saturated drive is 3 dB down, by {' and by '.join(told)}."
    words = Words(
        f"position-bode-{degrees}",
        f"Position bandwidth, ±{degrees}°",
        f"Gain and phase of the output's angle over the angle asked at {degrees} degrees; minus 3 "
        f"dB at {edge}.",
        caption,
    )
    return [bode(words, found, limits)]


def _backlash(metric: Metric) -> list[Figure]:
    motor, output = metric.trace["motor over ratio [rad]"], metric.trace["output [rad]"]
    dead, reading = None, ""
    caption = "First of the readings: onto one flank, rest, slowly back onto the other."
    if (found := dead_zone(motor, output)) is not None:
        dead = (ARCMIN * found[0], ARCMIN * found[1], ARCMIN * found[2])
        reading = f"{significant(abs(dead[1] - dead[0]), 3)} arcmin"
        caption += f" Shaded: {reading} in which the output stands, the dial's threshold taken off."
    closed = finite(metric.details, "dead_zone_arcmin")
    if closed is not None:
        whose = "perfect parts" if "perfect_parts_arcmin" in metric.details else "the gearbox"
        caption += f" The dead zone of {whose} is {significant(closed, 3)} arcmin."
    words = Words(
        "backlash-loop",
        "Backlash",
        f"Output angle over motor angle through the ratio; the output stands "
        f"for {reading or 'the whole reading'}.",
        caption,
    )
    return [hysteresis(words, motor * ARCMIN, output * ARCMIN, dead, reading)]


def _breakaway(metric: Metric, ratio: float) -> list[Figure]:
    columns = metric.trace
    if not {"output torque [N m]", "motor speed [rad/s]"} <= set(columns):
        return []
    torque = np.abs(columns["output torque [N m]"])
    speed = np.abs(columns["motor speed [rad/s]"]) / ratio
    marks = []
    if math.isfinite(metric.value) and torque.min() <= metric.value <= torque.max():
        at = float(np.interp(metric.value, torque, speed))
        marks = [Mark(metric.value, at, f"breaks away at {with_unit(metric.value, 'N*m', 3)}")]
    words = Words(
        "breakaway-trace",
        "Backdrive torque, breakaway",
        f"Output speed while the torque on the output rises; it breaks away at "
        f"{maybe(metric.value, 3)} N·m.",
        "Phases open, the first of the readings; marked: the mean of all.",
    )
    x, y = ("torque on the output, N·m", torque), ("output speed, rad/s", speed)
    return [trace(words, x, y, marks=marks)]


def _backdrive(metric: Metric) -> list[Figure]:
    angle, torque = metric.trace["output angle [rad]"], metric.trace["output torque [N m]"]
    resisting = torque if torque.mean() >= 0.0 else -torque
    turned = np.degrees(np.abs(angle - angle[0]))
    mean = float(resisting.mean())
    words = Words(
        "backdrive-trace",
        "Backdrive torque, running",
        f"Torque that turns the output slowly, over its angle; {maybe(mean, 3)} N·m on the mean.",
        "Phases open, the output turned at a steady speed.",
    )
    level = (f"mean {with_unit(mean, 'N*m', 3)}", mean)
    return [trace(words, ("output angle, °", turned), ("torque, N·m", resisting), level=level)]


def _ripple(metric: Metric, n: int, pin_count: int, cogging: int) -> list[Figure]:
    """The spectrum in orders, and its strongest by name."""
    order = metric.trace["order of the output"].astype(int)
    amplitude = metric.trace["amplitude [N m]"]
    strongest = np.argsort(-amplitude, kind="stable")[:_NAMED_ORDERS]
    strongest = strongest[amplitude[strongest] > 0.01 * float(amplitude.max())]
    if not strongest.size:
        return []
    scale, unit = (1e3, "mN\u00b7m") if float(amplitude.max()) < 0.1 else (1.0, "N\u00b7m")
    names = [f"{order[k]}: {order_name(int(order[k]), n, pin_count, cogging)}" for k in strongest]
    values = (scale * amplitude[strongest]).tolist()
    shown = [significant(value, 3) for value in values]
    whose = (
        "Of the first drawn gearbox" if "perfect_parts_Nm" in metric.details else "Of this gearbox"
    )
    over_order = Words(
        "ripple-spectrum",
        "Torque ripple by order",
        f"Amplitudes of the torque ripple over orders of the output; the strongest is {names[0]}.",
        f"{whose}, in periods of one output turn: the motor's turns are multiples of {n}, what "
        f"the lobes meet multiples of {n + 1}, every tooth {n * (n + 1)}, every pin "
        f"{pin_count * (n + 1)}.",
    )
    by_name = Words(
        "ripple-orders",
        "Strongest orders of the ripple",
        f"Amplitudes of the strongest orders of the torque ripple; {names[0]} leads with "
        f"{shown[0]} {unit}.",
        f"Amplitude in {unit}, by number of periods in one output turn and what repeats so often.",
    )
    marked = order[strongest[:_MARKED_ORDERS]].tolist()
    label = f"amplitude, {unit}"
    return [
        spectrum(over_order, order.astype(float), amplitude * scale, marked, label),
        bar_chart(by_name, names, values, shown),
    ]


def efficiency_maps(grid: Metric, *, driving_only: bool = False) -> tuple[Figure, ...]:
    """Cells of efficiency while driving and, where it was measured, while generating."""
    speed = np.abs(grid.trace["speed [rpm]"])
    torque, efficiency = grid.trace["torque [N m]"], np.nan_to_num(grid.trace["efficiency"])
    if driving_only:
        efficiency = np.where(torque > 0.0, efficiency, 0.0)
    found = efficiency[efficiency > 0.0]
    if not found.size:
        return ()
    scale = (float(found.min()), float(found.max()))
    figures = []
    for name, told, chosen in (
        ("driving", "the motor drives: mechanical over electrical power", torque > 0.0),
        ("generating", "the output drives: electrical over mechanical power", torque < 0.0),
    ):
        if not np.any(efficiency[chosen] > 0.0):
            continue
        best = int(np.where(chosen, efficiency, -1.0).argmax())
        peak = (
            f"{significant(100.0 * float(efficiency[best]), 3)} % at "
            f"{with_unit(float(speed[best]), 'rpm', 3)} and "
            f"{with_unit(abs(float(torque[best])), 'N*m', 3)}"
        )
        nothing = bool(np.any(efficiency[chosen] <= 0.0))
        words = Words(
            f"efficiency-{name}",
            f"Efficiency, {name}",
            f"Efficiency from the motor's terminals to the output, {name}, over speed and torque "
            f"of the output; the best is {peak}.",
            f"Per cent, motor's terminals to output; {told}. Framed: the best, {peak}."
            + (" A dash: both put power in, and all of it becomes heat." if nothing else ""),
        )
        places = (speed[chosen], np.abs(torque[chosen]), efficiency[chosen])
        figures.append(efficiency_cells(words, *places, scale))
    return tuple(figures)
