"""The virtual test bench in the report: the table, frequency responses, traces, comparison."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.bench.metric import NEAR, NEAR_EFFICIENCY, Metric, is_near
from cqdd_design.actuator.comparison import ComparedActuator, compare_actuators, present_actuator
from cqdd_design.actuator.operating import holds_itself
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog.paper import METRICS
from cqdd_design.report.actuator.bench_figures import BACKDRIVEN, bench_figures, finite
from cqdd_design.report.actuator.parameter_rows import prose
from cqdd_design.report.ink.numbers import (
    MINUS,
    NONE,
    decimals,
    maybe,
    per_cent,
    pretty_unit,
    significant,
    with_unit,
)
from cqdd_design.report.ink.page import Values
from cqdd_design.terms import measurement

_NO_SPREAD = 1e-3
"""Of the value: a smaller spread is not told in digits."""

_BESIDE_MEASURED = (
    (
        "given",
        "an input, an identity, or what follows from clearances that the design assumes: an "
        "agreement says nothing, or that they fit",
    ),
    ("calibrated", "fitted to the measured value"),
    (
        "predicted",
        "computed from geometry, catalogue and usual friction and cooling, without looking at the "
        "measured value",
    ),
    ("not comparable", "measured under conditions that are not known"),
)
"""What the words about an agreement with measured values mean."""
_ALONE = (
    ("given", "an input, an identity, or what follows from clearances that the design assumes"),
    ("calibrated", "fitted to a measured value"),
    ("predicted", "computed from geometry, catalogue and usual friction and cooling"),
    (
        "not comparable",
        "hangs on gains, amplitude and supply, which data sheets seldom state: no measure beside "
        "another actuator's",
    ),
)
"""What they mean where no measured values stand beside."""

_SHOWN_UNITS: dict[str, tuple[str, float]] = {"": ("%", 100.0), "kg*m^2": ("kg·cm²", 1e4)}


def bench_view(parameters: ActuatorParameters, bench: BenchResult, *, pin_count: int) -> Values:
    """Table, figures and comparison; `summary` is empty where no measured values stand beside.

    Parameters
    ----------
    bench : BenchResult
        Of the same actuator.
    pin_count : int
        Of the output, to name orders.
    """
    count = len(bench.metrics)
    lead = (
        f"{count} measurement{'' if count == 1 else 's'} on the simulation of the actuator, each "
        "by the protocol a laboratory would use; no-load speed, efficiency and position bandwidths "
        f"on {with_unit(bench.voltage, 'V')}, all else on "
        f"{with_unit(parameters.drive.supply_voltage, 'V')}."
    )
    holds = holds_itself(parameters)
    return {
        "lead": lead,
        "summary": _summary(bench),
        "rows": tuple(bench_row(metric, bench, holds=holds) for metric in bench.metrics),
        "beside_paper": bench.beside_paper,
        "relation_heading": "Agreement is" if bench.beside_paper else "Value is",
        "relations": _BESIDE_MEASURED if bench.beside_paper else _ALONE,
        "figures": bench_figures(parameters, bench, pin_count),
        "comparison": comparison(parameters, bench),
    }


def bench_row(metric: Metric, bench: BenchResult, *, holds: bool = False) -> Values:
    """One measurement as printed; `off` is how far it lies from the paper's.

    `holds` tells that the output cannot turn the gearbox.
    """
    protocol = prose(metric.protocol)
    for told in (metric.remark, metric.missing):
        protocol += " " + prose(_sentence(told)) if told else ""
    if holds and metric.name in BACKDRIVEN:
        metric = dataclasses.replace(metric, value=math.nan, spread=None)
        protocol += " The gearbox holds itself: the output does not turn it."
    if bench.beside_paper and metric.relation == "not comparable":
        protocol += " The paper gives no gains."
    unit, factor = _SHOWN_UNITS.get(metric.unit, (pretty_unit(metric.unit), 1.0))
    paper = bench.paper(metric.name)
    return {
        "name": metric.name,
        "words": measurement(metric.name),
        "value": maybe(factor * metric.value),
        "spread": _spread(metric, factor),
        "unit": unit,
        "paper": NONE if paper is None else _paper(metric.name, paper, factor),
        "off": off_by(metric, paper),
        "relation": metric.relation,
        "protocol": protocol,
    }


def _sentence(words: str) -> str:
    """Words as a sentence, its first letter capital."""
    return f"{words[:1].upper()}{words[1:].removesuffix('.')}."


def _spread(metric: Metric, factor: float) -> str:
    """A standard deviation, or that it is nothing beside the value."""
    if metric.spread is None or not math.isfinite(metric.spread):
        return NONE
    if metric.spread < _NO_SPREAD * abs(metric.value):
        return f"<{per_cent(_NO_SPREAD)}"
    return f"±{significant(factor * metric.spread, 2)}"


def _paper(name: str, value: float, factor: float) -> str:
    spread = METRICS[name].spread
    shown = significant(factor * value)
    return shown if spread is None else f"{shown} ±{significant(factor * spread, 2)}"


def off_by(metric: Metric, paper: float | None) -> str:
    """How far a value lies from the paper's: in per cent, efficiencies in points."""
    if paper is None or not math.isfinite(metric.value) or metric.relation == "not comparable":
        return NONE
    if metric.unit == "":
        return f"{_signed(100.0 * (metric.value - paper), 1)} points"
    relative = 100.0 * (metric.value / paper - 1.0)
    return f"{_signed(relative, 1 if abs(relative) < 10.0 else 0)}\u202f%"


def _signed(value: float, places: int) -> str:
    shown = decimals(value, places)
    return shown if shown.startswith(MINUS) or float(f"{value:.{places}f}") == 0.0 else f"+{shown}"


def _summary(bench: BenchResult) -> str:
    """How many predictions are near the measured values, which are not, and why."""
    beside = [(m, p) for m in bench.metrics if (p := bench.paper(m.name)) is not None]
    told = [(m, p) for m, p in beside if m.relation == "predicted" and math.isfinite(m.value)]
    if not told:
        return ""
    near = [measurement(m.name) for m, p in told if is_near(m.unit, m.value, p)]
    far = [measurement(m.name) for m, p in told if not is_near(m.unit, m.value, p)]
    listed = f": {'; '.join(near)}." if near else "."
    parts = [
        f"Of {len(told)} predicted rows {len(near)} lie within {per_cent(NEAR)} of the paper's "
        f"(efficiency within {100.0 * NEAR_EFFICIENCY:.0f} points){listed}"
    ]
    if far:
        parts.append(f"Not so: {'; '.join(far)}.")
    calibrated = [measurement(m.name) for m, _ in beside if m.relation == "calibrated"]
    if calibrated:
        parts.append(f"Calibrated: {'; '.join(calibrated)}.")
    ripple = next((m for m, _ in told if m.name == "torque_ripple"), None)
    if ripple is not None and measurement(ripple.name) in far:
        perfect = finite(ripple.details, "perfect_parts_Nm")
        if perfect is not None:
            parts.append(
                f"The tolerances explain ±{significant(ripple.value, 2)}\u202fN·m of the ripple, "
                f"perfect parts ±{significant(perfect, 2)}\u202fN·m."
            )
    return " ".join(parts)


def comparison(parameters: ActuatorParameters, bench: BenchResult) -> Values:
    """The paper's table of actuators with this one as a column, whose number is `own`."""
    peak, efficiency = bench.counted_peak, bench.value("efficiency_peak")
    own = None
    if peak is not None and math.isfinite(peak):
        ratio = parameters.gear.ratio
        own = present_actuator(bench.name, ratio, peak, parameters.mass, efficiency)
    table = compare_actuators(own)

    names = [actuator.name for actuator in table]
    return {
        "headings": tuple(names),
        "rows": tuple((name, tuple(cell(actuator) for actuator in table)) for name, cell in _CELLS),
        "own": -1 if own is None else names.index(own.name),
        "remarks": tuple(prose(actuator.remark) for actuator in table if actuator.remark),
        "sources": tuple(dict.fromkeys(actuator.source for actuator in table)),
    }


def _peak(actuator: ComparedActuator) -> str:
    """With one digit more beside a printed torque density, which follows from it."""
    return significant(actuator.peak_torque, 4 if actuator.torque_density_printed is None else 5)


_CELLS: tuple[tuple[str, Callable[[ComparedActuator], str]], ...] = (
    ("gearing", lambda one: one.gearing),
    ("ratio", lambda one: maybe(one.ratio, 3)),
    ("peak torque, N·m", _peak),
    ("mass, kg", lambda one: significant(one.mass, 3)),
    ("torque density, N·m/kg", lambda one: significant(one.torque_density)),
    ("as printed, N·m/kg", lambda one: maybe(one.torque_density_printed)),
    (
        "greatest efficiency, %",
        lambda one: NONE if one.efficiency is None else significant(100.0 * one.efficiency, 3),
    ),
)
"""Rows of the table: quantity and what stands there."""
