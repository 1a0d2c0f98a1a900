"""Tolerances in the report: histograms of backlash and ripple, and what they come from."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.gearbox.tolerance.draws import GROUPS
from cqdd_design.gearbox.tolerance.evaluate import RANKED
from cqdd_design.report.ink.bars import bar_chart, histogram
from cqdd_design.report.ink.charts import Curve, Level, line_chart
from cqdd_design.report.ink.numbers import pretty_unit, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Figure, Words
from cqdd_design.report.judgement.check_rows import printed, sentence
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.gearbox.tolerance.clearance import ClearancePoint
    from cqdd_design.gearbox.tolerance.run import ToleranceResult

_STATISTICS = ("mean", "std", "p5", "p50", "p95", "p99")


def tolerance_view(result: ToleranceResult, clearances: Sequence[ClearancePoint] = ()) -> Values:
    """Figures, and rows of (name, mean, std, p5, p50, p95, p99, limit)."""
    ensemble, count = result.ensemble, len(result.values)
    lead = (
        f"{count} gearboxes drawn from the tolerances of the design (seed {ensemble.seed}) and "
        f"solved at {with_unit(ensemble.torque, 'N*m')} over a whole output turn, "
        f"{ensemble.angles} angles each, the motor driving against friction."
    )
    limits = result.limits
    rows = tuple(
        (
            ", ".join(_named(name)),
            *(significant(told[key]) for key in _STATISTICS),
            significant(limits[name]) if name in limits else "",
        )
        for name, told in result.statistics().items()
    )
    reserve = result.pressure_reserve()
    if reserve is not None:
        told = tuple(significant(reserve[key]) for key in _STATISTICS)
        rows += ((term("pressure_reserve").words, *told, "1, least"),)
    lead += "".join(f" {sentence(printed(words))}" for words in result.warnings)
    histograms = [_histogram(result, name) for name in RANKED]
    rankings = [_ranking(result, name) for name in RANKED if result.ranking(name)]
    return {
        "lead": lead,
        "figures": (*histograms, *rankings),
        "rows": rows,
        "clearances": [_clearance_row(point) for point in clearances],
        "longest": _longest(clearances),
        "clearance_figures": tuple(_clearance_figures(clearances)),
    }


def _named(key: str) -> tuple[str, str]:
    """An output in words, and its unit as printed."""
    words, unit = term(key)
    return words, pretty_unit(unit)


def _clearance_row(point: ClearancePoint) -> tuple[str, ...]:
    """Offset, hole clearance, hours, reserve, backlash, binding, stiffness."""
    name = f"{1e6 * point.equidistant:g}" + (", the design" if point.own else "")
    hole = f"{1e6 * point.hole_clearance:g}"
    if point.missing:
        return name, hole, "no equilibrium", "", "", "", ""
    known = point.hours is not None and point.reserve is not None
    return (
        name,
        hole,
        significant(point.hours, 2) if known and point.hours is not None else "not known",
        significant(point.reserve, 3) if known and point.reserve is not None else "not known",
        significant(point.backlash, 3),
        f"{100.0 * point.binding:.0f}\u202f%",
        significant(point.stiffness, 3),
    )


def _longest(points: Sequence[ClearancePoint]) -> str:
    """Where gearboxes last longest; empty where hours do not tell the points apart."""
    known = [(point.hours, point) for point in points if point.hours is not None]
    most, best = max(known, key=lambda one: one[0], default=(0.0, None))
    if best is None or not 1.0 <= most < math.inf or all(one == most for one, _ in known):
        return ""
    offset, hole = 1e6 * best.equidistant, 1e6 * best.hole_clearance
    return (
        f"Those with an offset of {with_unit(offset, 'um')} and a hole clearance of "
        f"{with_unit(hole, 'um')} last longest, {with_unit(most, 'h', 2)}. "
    )


def _clearance_figures(points: Sequence[ClearancePoint]) -> Iterator[Figure]:
    """Reserve of pressure, and backlash, over the flank's offset, a line for a hole clearance."""
    holes = sorted({point.hole_clearance for point in points})
    x = np.array(sorted({1e6 * point.equidistant for point in points}))
    if len(holes) < 2 or any(point.missing or point.reserve is None for point in points):
        return

    def curves(values: Sequence[float]) -> list[Curve]:
        by_hole = np.array(values).reshape(len(holes), -1)
        return [
            Curve(f"hole clearance {1e6 * hole:g} \u00b5m", row, f"series-{k + 1}")
            for k, (hole, row) in enumerate(zip(holes, by_hole, strict=True))
        ]

    note = "Medians and means of small ensembles with the same draws at every point."
    x_label, ticks = "offset of the flank, \u00b5m", [float(value) for value in x]
    yield line_chart(
        Words(
            "clearance-reserve",
            "Reserve of pressure over clearance",
            "Pressure that lasts the required hours over the greatest pressure at the continuous "
            "torque, over the offset of the flank; below 1 the ring does not last.",
            note,
        ),
        x,
        curves([point.reserve or 0.0 for point in points]),
        [Level("lasts", 1.0)],
        x_label=x_label,
        y_label="reserve of pressure",
        x_ticks=ticks,
    )
    yield line_chart(
        Words(
            "clearance-backlash",
            "Backlash over clearance",
            "Mean backlash over the offset of the flank.",
            note,
        ),
        x,
        curves([point.backlash for point in points]),
        x_label=x_label,
        y_label="backlash, arcmin",
        x_ticks=ticks,
    )


def _histogram(result: ToleranceResult, name: str) -> Figure:
    statistics, count = result.statistics(), len(result.values)
    told, (words, unit) = statistics[name], _named(name)
    return histogram(
        Words(
            f"histogram-{name.split('_')[0]}",
            f"Distribution of the {words}",
            f"Histogram of the {words} of {count} toleranced gearboxes: mean "
            f"{significant(told['mean'], 3)} {unit}, 5 to 95 per cent from "
            f"{significant(told['p5'], 3)} to {significant(told['p95'], 3)}.",
            f"{count} gearboxes at {with_unit(result.ensemble.torque, 'N*m')}, each over an "
            "output turn.",
        ),
        result.values[:, list(statistics).index(name)],
        [(f"{key[1:]}\u202f%", told[key]) for key in ("p5", "p50", "p95")],
        f"{words}, {unit}",
    )


def _ranking(result: ToleranceResult, name: str) -> Figure:
    words, sensitivity = term(name).words, result.sensitivity
    assert sensitivity is not None, "there is nothing to rank"
    widths = dict(zip(GROUPS, sensitivity[name].total_half_width.tolist(), strict=True))
    ranked = [
        (group.replace("_", " "), first, max(total, 0.0), widths[group])
        for group, first, total in result.ranking(name)
    ]
    return bar_chart(
        Words(
            f"ranking-{name.split('_')[0]}",
            f"What the {words} comes from",
            f"Share of the variance by tolerance; {ranked[0][0]} leads.",
            "Total Sobol' index of each tolerance (bar) and its share alone (tick); both are "
            "estimates, which may leave 0 to 100\u202f%; \u00b1 is half of the 95\u202f% interval "
            "of the bar.",
        ),
        [group for group, *_ in ranked],
        [total for _, _, total, _ in ranked],
        [f"{100.0 * total:.0f} \u00b1{100.0 * width:.0f}\u202f%" for _, _, total, width in ranked],
        [first for _, first, *_ in ranked],
    )
