"""The evaluation of torque estimators as a page of its own, in the report's dress."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.numbers import grouped, per_cent, significant
from cqdd_design.report.ink.page import Values, environment
from cqdd_design.report.ink.svg import Figure, Words
from cqdd_design.report.ink.tables import readable_tables
from cqdd_design.report.torque.charts import (
    Errors,
    IntervalBar,
    Named,
    distributions,
    interval_bars,
    long_trace,
    over,
    zoomed,
)
from cqdd_design.report.torque.tables import (
    further_tables,
    models_table,
    ordered,
    paper_table,
)
from cqdd_design.torque.evaluation.evaluate import EvaluationResult
from cqdd_design.torque.evaluation.metrics import REGIMES
from cqdd_design.torque.evaluation.ripple import BAND, SEGMENT
from cqdd_design.torque.evaluation.stretches import ZOOM

if TYPE_CHECKING:
    from cqdd_design.torque.evaluation.bootstrap import Interval
    from cqdd_design.torque.evaluation.scoring import SetResult
    from cqdd_design.torque.evaluation.seeds import ModelScore

_CURVES = 4
"""Models that share one panel; more cannot be told apart."""
_PANELS = 9
_COLOURS = 8
_LINES = 4


def torque_page(results: EvaluationResult, *, date: str = "") -> str:
    """One self-contained HTML page about an evaluation; it needs no network and no other file.

    Parameters
    ----------
    date : str
        As printed in the head; left out where empty.
    """
    from cqdd_design.version import __version__

    page = environment().get_template("torque_page.html")
    return readable_tables(
        page.render(
            torque=torque_view(results),
            facts=_facts(results),
            title=str(results.data.facts.get("design", "Torque data")),
            version=__version__,
            date=date,
            data_sha256=results.data.sha256,
        )
    )


def torque_view(results: EvaluationResult) -> Values:
    """Models on the headline set, the paper's hardware apart, figures and further tables."""
    headline = results.sets[0]
    return {
        "lead": _lead(headline),
        "models": models_table(results, headline),
        "paper": paper_table(),
        "wide": tuple(_wide(results, headline)),
        "figures": tuple(_figures(results, headline)),
        "regimes": tuple(_regime_bars(results, headline, tuple(REGIMES)[1:])),
        "tables": further_tables(results, headline),
        "warnings": results.warnings,
    }


def _facts(results: EvaluationResult) -> tuple[tuple[str, str, str], ...]:
    headline = results.sets[0]
    gains = f"{significant(results.data.position_gain)} / {significant(results.data.velocity_gain)}"
    rate = f"at {significant(1.0 / results.data.dt)} Hz"
    return (
        ("Test episodes", str(len(headline.episodes)), f"set {headline.name}"),
        ("Samples scored", grouped(headline.samples), rate),
        ("Gains", gains, "N·m/rad and N·m·s/rad, of the controller"),
        ("Models", str(len(results.models)), "networks and baselines"),
    )


def _lead(headline: SetResult) -> str:
    ordered = sorted(headline.models, key=lambda one: one.overall.rmse.value)
    best, last = ordered[0], ordered[-1]
    return (
        f"Output torque told from the joint's motion, on {len(headline.episodes)} held-out "
        f"episodes. The lowest r.m.s. error is that of "
        f"{best.name}, {significant(best.overall.rmse.value, 3)} N·m; the highest that of "
        f"{last.name}, {significant(last.overall.rmse.value, 3)} N·m. Intervals hold 95 % and come "
        "from resampling whole episodes."
    )


def _classes(results: EvaluationResult) -> dict[str, str]:
    """A colour of every network and a line of every baseline, the same in all figures."""
    networks = [one.name for one in results.models if one.kind == "network"]
    found = {name: f"t-{k % _COLOURS + 1}" for k, name in enumerate(networks)}
    others = [one.name for one in results.models if one.name not in found]
    return found | {name: f"t-base t-base-{k % _LINES + 1}" for k, name in enumerate(others)}


def _drawn(results: EvaluationResult, found: SetResult, count: int) -> list[ModelScore]:
    """What a figure can hold: one network of each model in the order given, then baselines."""
    chosen: dict[str, ModelScore] = {}
    for one in ordered(results, found):
        chosen.setdefault(one.model, one)
    order = {one.name: k for k, one in enumerate(results.models)}
    kinds = {one.name: one.kind for one in results.models}
    ranked = sorted(chosen.values(), key=lambda s: (kinds[s.name] != "network", order[s.name]))
    return ranked[:count]


def _wide(results: EvaluationResult, found: SetResult) -> list[Figure]:
    classes = _classes(results)

    def curves(estimates: Mapping[str, FloatArray], count: int) -> Named:
        return [
            (one.name, classes[one.name], estimates[one.name])
            for one in _drawn(results, found, count)
        ]

    trace, zoom = found.trace, found.zoom
    words = Words(
        "torque-trace",
        "A whole episode",
        f"Torque of the label and of some models over episode {trace.episode}, errors below.",
        f"Episode {trace.episode}, that of the median r.m.s. torque.",
    )
    figures = [long_trace(words, trace.time, trace.label, curves(trace.estimates, _CURVES))]
    if zoom is not None:
        words = Words(
            "torque-zoom",
            "Ripple",
            f"{ZOOM:g} s of episode {zoom.episode}, one panel a model beside the label.",
            f"Episode {zoom.episode}, where the label's ripple is strongest, on one flank of the "
            "gear if it can be; a model beside the label. From all curves the same cubic is taken "
            "off, that through the label, so that bias stays. Chosen by the label alone.",
        )
        figures.append(zoomed(words, zoom.time, zoom.label, curves(zoom.estimates, _PANELS)))
    return figures


def _figures(results: EvaluationResult, found: SetResult) -> list[Figure]:
    classes = _classes(results)
    errors = [
        Errors(
            one.name,
            classes[one.name],
            one.error_counts,
            one.overall.bias.value,
            one.overall.variance.value**0.5,
        )
        for one in ordered(results, found)
    ]
    words = Words(
        "torque-errors",
        "Errors",
        "Distribution of the errors of every model, prediction less label.",
        "Prediction less label; heights by the root of the frequency, lines one standard "
        "deviation to either side of the mean. What lies beyond stands in the last bins.",
    )
    figures = [distributions(words, found.error_edges, errors)]
    drawn = _drawn(results, found, _CURVES)
    if len(found.frequency):
        words = Words(
            "torque-spectrum",
            "Ripple band",
            "Amplitude density of label and models over frequency.",
            f"Segments of {SEGMENT:g} s in free swing; the band from {BAND[0]:g} to {BAND[1]:g} Hz "
            "is shaded.",
        )
        spectra = [(one.name, classes[one.name], one.spectrum) for one in drawn]
        x = ("frequency, Hz", found.frequency)
        figures.append(over(words, x, "N·m/√Hz", found.label_spectrum, spectra, BAND))
    orders = [(one.name, one.orders) for one in drawn if one.orders is not None]
    if orders:
        first = orders[0][1]
        words = Words(
            "torque-orders",
            "Ripple by order",
            "Amplitude of label and models over order of the output angle.",
            f"Over {first.strokes} strokes in one sense, resampled over the output's angle; a "
            "stroke of 2 rad tells orders three apart.",
        )
        amplitudes = [(name, classes[name], found.estimate) for name, found in orders]
        x = ("order, periods in an output turn", first.orders)
        figures.append(over(words, x, "amplitude, N·m", first.label, amplitudes))
    return [*figures, *_regime_bars(results, found, ("all",))]


def _regime_bars(
    results: EvaluationResult, found: SetResult, regimes: Sequence[str]
) -> list[Figure]:
    classes = _classes(results)
    figures = []
    for regime in regimes:
        meaning = REGIMES[regime]
        rows = [
            (one.name, scores)
            for one in ordered(results, found)
            if (scores := one.regimes[regime]) is not None
        ]
        if not rows:
            continue
        # Half of the models set the scale; one far off is cut, and says so.
        middle = sorted(scores.rmse.value for _, scores in rows)[len(rows) // 2]
        reach = max(
            scores.rmse.high or scores.rmse.value
            for _, scores in rows
            if scores.rmse.value <= 2.5 * middle
        )
        share = rows[0][1].scores.samples / found.samples
        words = Words(
            f"torque-rmse-{regime}",
            f"RMSE, {regime}" if regime != "all" else "RMSE",
            f"RMSE of every model: {meaning}.",
            f"{meaning[0].upper()}{meaning[1:]}: {per_cent(share, 3)} of the samples, "
            f"{rows[0][1].episodes} episodes.",
        )
        bars = [
            IntervalBar(name, scores.rmse.value, _bounds(scores.rmse), classes[name])
            for name, scores in rows
        ]
        figures.append(interval_bars(words, bars, 1.02 * reach if reach > 0.0 else 1.0))
    return figures


def _bounds(value: Interval) -> tuple[float, float] | None:
    return None if value.low is None or value.high is None else (value.low, value.high)
