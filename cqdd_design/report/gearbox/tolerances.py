"""Tolerances in the report: histograms of backlash and ripple, and what they come from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.report.ink.bars import bar_chart, histogram
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Figure, Words

if TYPE_CHECKING:
    from cqdd_design.gearbox.tolerance.ensemble import ToleranceResult

_NAMES = {
    "backlash_arcmin": ("backlash", "arcmin"),
    "transmission_error_pp_arcmin": ("transmission error, peak to peak", "arcmin"),
    "ring_force_max_N": ("greatest ring force", "N"),
    "stiffness_Nm_per_arcmin": ("stiffness", "N\u00b7m/arcmin"),
    "torque_ripple_pp_Nm": ("torque ripple, peak to peak", "N\u00b7m"),
}
_SHOWN = ("backlash_arcmin", "torque_ripple_pp_Nm")
_STATISTICS = ("mean", "std", "p5", "p50", "p95", "p99")


def tolerance_view(result: ToleranceResult) -> Values:
    """Figures, and rows of (name, mean, std, p5, p50, p95, p99)."""
    ensemble, count = result.ensemble, len(result.values)
    lead = (
        f"{count} gearboxes drawn from the tolerances of the design (seed {ensemble.seed}) and "
        f"solved at {with_unit(ensemble.torque, 'N*m')} over a whole output turn, "
        f"{ensemble.angles} angles each, without friction."
    )
    rows = tuple(
        (", ".join(_NAMES[name]), *(significant(told[key]) for key in _STATISTICS))
        for name, told in result.statistics().items()
    )
    histograms = [_histogram(result, name) for name in _SHOWN]
    rankings = [_ranking(result, name) for name in _SHOWN if result.ranking(name)]
    return {"lead": lead, "figures": (*histograms, *rankings), "rows": rows}


def _histogram(result: ToleranceResult, name: str) -> Figure:
    statistics, count = result.statistics(), len(result.values)
    told, (words, unit) = statistics[name], _NAMES[name]
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
        [(key, told[key]) for key in ("p5", "p50", "p95")],
        f"{words}, {unit}",
    )


def _ranking(result: ToleranceResult, name: str) -> Figure:
    words = _NAMES[name][0]
    ranked = [
        (group.replace("_", " "), first, max(total, 0.0))
        for group, first, total in result.ranking(name)
    ]
    return bar_chart(
        Words(
            f"ranking-{name.split('_')[0]}",
            f"What the {words} comes from",
            f"Share of the variance by tolerance; {ranked[0][0]} leads.",
            "Total Sobol' index of each tolerance (bar) and its share alone (tick); both are "
            "estimates that scatter by some per cent.",
        ),
        [group for group, _, _ in ranked],
        [total for _, _, total in ranked],
        [f"{100.0 * total:.0f}\u202f%" for _, _, total in ranked],
        [first for _, first, _ in ranked],
    )
