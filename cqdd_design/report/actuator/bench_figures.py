"""Figures of the virtual test bench from the traces of its measurements."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.bench.bandwidth import crossing
from cqdd_design.actuator.bench.gear import DIAL, DIAL_RADIUS
from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.operating import holds_itself
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.gearbox.precision.orders import order_name
from cqdd_design.report.actuator.bench_charts import (
    Mark,
    bode,
    efficiency_cells,
    hysteresis,
    spectrum,
    trace,
)
from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.svg import Figure

NONE = "\u2013"
"""Printed where there is no value."""
ARCMIN = 60.0 * 180.0 / math.pi
BACKDRIVEN = ("backdrive_static", "backdrive_dynamic")
"""Measurements in which the output turns the motor."""
_NAMED_ORDERS, _MARKED_ORDERS = 8, 5
_AT_REST = 0.01
"""Of a reading's whole motor angle: nearer to a flank the motor counts as resting there."""
_BREAK = 10.0 ** (-3.0 / 20.0)


def shown(value: float, digits: int = 4) -> str:
    """A number, or a dash where there is none."""
    return significant(value, digits) if math.isfinite(value) else NONE


def bench_figures(
    parameters: ActuatorParameters, bench: BenchResult, pin_count: int
) -> tuple[Figure, ...]:
    """Figures of all traces there are."""
    unturned = BACKDRIVEN if holds_itself(parameters) else ()
    found = {m.name: m for m in bench.metrics if m.trace and m.name not in unturned}
    figures: list[Figure | None] = [
        _torque_bode(found["torque_bandwidth"]) if "torque_bandwidth" in found else None
    ]
    for name in ("position_bandwidth_45deg", "position_bandwidth_5deg"):
        if name in found:
            figures.append(_position_bode(found[name]))
    if "backlash" in found:
        figures.append(_backlash(found["backlash"]))
    if "backdrive_static" in found:
        figures.append(_breakaway(found["backdrive_static"], parameters))
    if "backdrive_dynamic" in found:
        figures.append(_backdrive(found["backdrive_dynamic"]))
    if "torque_ripple" in found:
        figures += _ripple(found["torque_ripple"], parameters, pin_count)
    return tuple(figure for figure in figures if figure is not None)


def finite(details: Mapping[str, float], key: str) -> float | None:
    """A detail of a measurement; None where it has none or no number."""
    value = details.get(key)
    return value if value is not None and math.isfinite(value) else None


def _torque_bode(metric: Metric) -> Figure | None:
    columns = metric.trace
    frequency, gain = columns["frequency [Hz]"], columns["gain"]
    low = finite(metric.details, "low_frequency_gain") or float(gain[0])
    coherence = columns.get("coherence")
    phase = np.unwrap(columns["phase [rad]"])
    edge = _edge(frequency, gain / low, metric.value)
    quarter = _falls(frequency, phase, -0.5 * math.pi)
    caption = (
        f"Of the locked output, gain relative to {significant(low, 3)} N·m per N·m asked at low "
        f"frequencies; \u22123 dB at {_hertz(edge)}, \u221290° at {_hertz(quarter)}."
    )
    if coherence is not None:
        sure = _falls(frequency, coherence, 0.8)
        if sure is not None:
            caption += f" Beyond {_hertz(sure)} the coherence is below 0.8 and curves are faint."
    return bode(
        "torque-bode",
        "Torque bandwidth",
        f"Gain, phase and coherence of torque over the torque asked; minus 3 dB at {_hertz(edge)}.",
        frequency=frequency,
        gain=gain / low,
        phase=phase,
        coherence=coherence,
        edge=edge,
        quarter=quarter,
        caption=caption,
    )


def _edge(frequency: FloatArray, gain: FloatArray, value: float) -> float | None:
    """The measured bandwidth, where the gain falls so far at all."""
    return value if math.isfinite(value) and _falls(frequency, gain, _BREAK) is not None else None


def _falls(frequency: FloatArray, values: FloatArray, level: float) -> float | None:
    """Where values first fall through a level; None where they do not."""
    return crossing(frequency, values, level) if bool(np.any(values < level)) else None


def _hertz(frequency: float | None) -> str:
    return "no measured frequency" if frequency is None else with_unit(frequency, "Hz", 3)


def _position_bode(metric: Metric) -> Figure:
    columns, details = metric.trace, metric.details
    frequency, gain = columns["frequency [Hz]"], columns["gain"]
    relative = gain / float(gain[0])
    phase = np.unwrap(columns["phase [rad]"])
    edge = _edge(frequency, relative, metric.value)
    quarter = _falls(frequency, phase, -0.5 * math.pi)
    degrees = metric.name.removeprefix("position_bandwidth_").removesuffix("deg")
    limits, told = [], []
    for key, name in (("limit_by_speed_Hz", "speed"), ("limit_by_torque_Hz", "torque")):
        value = finite(details, key)
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
        f"\u22123 dB at {_hertz(edge)}."
    )
    if told:
        caption += f" Dotted: where a saturated drive is 3 dB down, by {' and by '.join(told)}."
    return bode(
        f"position-bode-{degrees}",
        f"Position bandwidth, ±{degrees}°",
        f"Gain and phase of the output's angle over the angle asked at {degrees} degrees; minus 3 "
        f"dB at {_hertz(edge)}.",
        frequency=frequency,
        gain=relative,
        phase=phase,
        edge=edge,
        quarter=quarter,
        limits=limits,
        caption=caption,
    )


def dead_zone(motor: FloatArray, output: FloatArray) -> tuple[float, float, float] | None:
    """Where the motor turns back and where the output follows, and the output's angle between.

    Parameters
    ----------
    motor, output : array (T,)
        Angles of one reading in the order of time, rad, the motor's over the ratio.

    Returns
    -------
    (begin, end, output angle) or None
        rad, the dial's own threshold taken off; None where the output never follows.
    """
    # The flank gone to first; the motor rests there until it turns back.
    first, last = sorted((int(motor.argmax()), int(motor.argmin())))
    near = np.abs(motor[first:last] - motor[first]) < _AT_REST * float(np.ptp(motor))
    if not near.any():
        return None
    resting = first + int(np.flatnonzero(near)[-1])
    threshold = DIAL / DIAL_RADIUS
    moved = np.flatnonzero(np.abs(output[resting:] - output[resting]) > threshold)
    if not moved.size:
        return None
    at = resting + int(moved[0])
    sense = math.copysign(threshold, float(motor[resting] - motor[at]))
    return float(motor[resting]), float(motor[at]) + sense, float(output[resting])


def _backlash(metric: Metric) -> Figure:
    motor, output = metric.trace["motor over ratio [rad]"], metric.trace["output [rad]"]
    found = dead_zone(motor, output)
    dead = None if found is None else tuple(ARCMIN * value for value in found)
    reading = "" if dead is None else f"{significant(abs(dead[1] - dead[0]), 3)} arcmin"
    caption = "First of the readings: onto one flank, rest, slowly back onto the other."
    if reading:
        caption += f" Shaded: {reading} in which the output stands, the dial's threshold taken off."
    closed = finite(metric.details, "dead_zone_arcmin")
    if closed is not None:
        caption += f" The dead zone of the gearbox is {significant(closed, 3)} arcmin."
    return hysteresis(
        "backlash-loop",
        "Backlash",
        f"Output angle over motor angle through the ratio; the output stands "
        f"for {reading or 'the whole reading'}.",
        motor=motor * ARCMIN,
        output=output * ARCMIN,
        dead=None if dead is None else (dead[0], dead[1], dead[2]),
        label=reading,
        caption=caption,
    )


def _breakaway(metric: Metric, parameters: ActuatorParameters) -> Figure | None:
    columns = metric.trace
    if not {"output torque [N m]", "motor speed [rad/s]"} <= set(columns):
        return None
    torque = np.abs(columns["output torque [N m]"])
    speed = np.abs(columns["motor speed [rad/s]"]) / abs(parameters.gear.ratio)
    marks = []
    if math.isfinite(metric.value) and torque.min() <= metric.value <= torque.max():
        at = float(np.interp(metric.value, torque, speed))
        marks = [Mark(metric.value, at, f"breaks away at {with_unit(metric.value, 'N*m', 3)}")]
    return trace(
        "breakaway-trace",
        "Backdrive torque, breakaway",
        f"Output speed while the torque on the output rises; it breaks away at "
        f"{shown(metric.value, 3)} N·m.",
        x=torque,
        y=speed,
        x_label="torque on the output, N·m",
        y_label="output speed, rad/s",
        marks=marks,
        caption="Phases open, the first of the readings; marked: the mean of all.",
    )


def _backdrive(metric: Metric) -> Figure:
    angle, torque = metric.trace["output angle [rad]"], metric.trace["output torque [N m]"]
    resisting = torque if torque.mean() >= 0.0 else -torque
    turned = np.degrees(np.abs(angle - angle[0]))
    mean = float(resisting.mean())
    return trace(
        "backdrive-trace",
        "Backdrive torque, running",
        f"Torque that turns the output slowly, over its angle; {shown(mean, 3)} N·m on the mean.",
        x=turned,
        y=resisting,
        x_label="output angle, °",
        y_label="torque, N·m",
        level=(f"mean {with_unit(mean, 'N*m', 3)}", mean),
        caption="Phases open, the output turned at a steady speed.",
    )


def _ripple(metric: Metric, parameters: ActuatorParameters, pin_count: int) -> list[Figure]:
    """The spectrum in orders, and its strongest by name."""
    order = metric.trace["order of the output"].astype(int)
    amplitude = metric.trace["amplitude [N m]"]
    n = round(abs(parameters.gear.ratio))
    strongest = np.argsort(-amplitude, kind="stable")[:_NAMED_ORDERS]
    strongest = strongest[amplitude[strongest] > 0.01 * float(amplitude.max())]
    if not strongest.size:
        return []
    scale, unit = (1e3, "mN\u00b7m") if float(amplitude.max()) < 0.1 else (1.0, "N\u00b7m")
    names = [f"{order[k]}: {order_name(int(order[k]), n, pin_count)}" for k in strongest]
    whose = (
        "Of the first drawn gearbox" if "perfect_parts_Nm" in metric.details else "Of this gearbox"
    )
    return [
        spectrum(
            "ripple-spectrum",
            "Torque ripple by order",
            f"Amplitudes of the torque ripple over orders of the output; the strongest is "
            f"{names[0]}.",
            order=order.astype(float),
            amplitude=amplitude * scale,
            named=order[strongest[:_MARKED_ORDERS]].tolist(),
            y_label=f"amplitude, {unit}",
            caption=f"{whose}, in periods of one output turn: the motor's turns are multiples of "
            f"{n}, what the lobes meet multiples of {n + 1}, every tooth {n * (n + 1)}, "
            f"every pin {pin_count * (n + 1)}.",
        ),
        bar_chart(
            "ripple-orders",
            "Strongest orders of the ripple",
            f"Amplitudes of the strongest orders of the torque ripple; {names[0]} leads with "
            f"{significant(scale * float(amplitude[strongest[0]]), 3)} {unit}.",
            names=names,
            values=(scale * amplitude[strongest]).tolist(),
            shown=[significant(scale * float(amplitude[k]), 3) for k in strongest],
            caption=f"Amplitude in {unit}, by number of periods in one output turn and what "
            "repeats so often.",
        ),
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
    for name, words, chosen in (
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
        figures.append(
            efficiency_cells(
                f"efficiency-{name}",
                f"Efficiency, {name}",
                f"Efficiency from the motor's terminals to the output, {name}, over speed and "
                f"torque of the output; the best is {peak}.",
                speed=speed[chosen],
                torque=np.abs(torque[chosen]),
                efficiency=efficiency[chosen],
                scale=scale,
                caption=f"Per cent, motor's terminals to output; {words}. Framed: the best, {peak}."
                + (" A dash: both put power in, and all of it becomes heat." if nothing else ""),
            )
        )
    return tuple(figures)
