"""Tolerances in the report: histograms of backlash and ripple, and what they come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.report.ink.bars import bar_chart, histogram
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.svg import Figure

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


@dataclass(frozen=True)
class ToleranceView:
    """What the section shows.

    Attributes
    ----------
    lead : str
    histograms, rankings : tuple of Figure
    rows : tuple of (name, mean, std, p5, p50, p95, p99)
    """

    lead: str
    histograms: tuple[Figure, ...]
    rankings: tuple[Figure, ...]
    rows: tuple[tuple[str, ...], ...]


def tolerance_view(result: ToleranceResult) -> ToleranceView:
    """Values of the section."""
    statistics = result.statistics()
    names = list(statistics)
    torque = with_unit(result.ensemble.torque, "N*m")
    rows = tuple(
        (
            f"{_NAMES[name][0]}, {_NAMES[name][1]}",
            *(significant(told[key]) for key in ("mean", "std", "p5", "p50", "p95", "p99")),
        )
        for name, told in statistics.items()
    )
    figures = []
    for name in _SHOWN:
        words, unit = _NAMES[name]
        told = statistics[name]
        figures.append(
            histogram(
                f"histogram-{name.split('_')[0]}",
                f"Distribution of the {words}",
                f"Histogram of the {words} of {len(result.values)} toleranced gearboxes: mean "
                f"{significant(told['mean'], 3)} {unit}, 5 to 95 per cent from "
                f"{significant(told['p5'], 3)} to {significant(told['p95'], 3)}.",
                values=result.values[:, names.index(name)],
                marks=[(key, told[key]) for key in ("p5", "p50", "p95")],
                x_label=f"{words}, {unit}",
                caption=f"{len(result.values)} gearboxes at {torque}, each over an output turn.",
            )
        )
    rankings = []
    for name in _SHOWN:
        ranked = result.ranking(name)
        if not ranked:
            continue
        words = _NAMES[name][0]
        rankings.append(
            bar_chart(
                f"ranking-{name.split('_')[0]}",
                f"What the {words} comes from",
                f"Share of the variance by tolerance; {ranked[0][0].replace('_', ' ')} leads.",
                names=[group.replace("_", " ") for group, _, _ in ranked],
                values=[max(total, 0.0) for _, _, total in ranked],
                marks=[first for _, first, _ in ranked],
                shown=[f"{100.0 * max(total, 0.0):.0f}\u202f%" for _, _, total in ranked],
                caption="Total Sobol' index of each tolerance (bar) and its share alone (tick); "
                "both are estimates that scatter by some per cent.",
            )
        )
    lead = (
        f"{len(result.values)} gearboxes drawn from the tolerances of the design (seed "
        f"{result.ensemble.seed}) and solved at {torque} over a whole output turn, "
        f"{result.ensemble.angles} angles each."
    )
    return ToleranceView(lead, tuple(figures), tuple(rankings), rows)
