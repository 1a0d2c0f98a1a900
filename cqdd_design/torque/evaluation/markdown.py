"""The table of models as Markdown: ours with intervals, the paper's hardware apart."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, log10

from cqdd_design.catalog import paper
from cqdd_design.torque.evaluation.bootstrap import Interval
from cqdd_design.torque.evaluation.evaluate import EvaluationResult
from cqdd_design.torque.evaluation.scoring import SetResult

OURS = "ours (simulated twin)"
THEIRS = "paper (hardware)"
NONE = "\u2013"
_REGIMES = ("swing", "wall", "saturation", "reversal")


def markdown(result: EvaluationResult) -> str:
    """Every test set's table, the paired ratios, and the paper's own table.

    Returns
    -------
    str
        Markdown that ends with a line break; the same result gives the same text but for times.
    """
    parts = []
    for one in result.sets:
        parts += [f"### Set `{one.name}`, {OURS}", "", _describe(one), ""]
        if any(model.seeds > 1 for model in one.seeds):
            parts += ["Means over the seeds of each model:", "", _seeds(one), ""]
        if one.paired:
            parts += [_pairs(one), ""]
        parts += ["Each network and baseline:", "", _models(result, one), ""]
    parts += [f"### {THEIRS[0].upper()}{THEIRS[1:]}", "", paper_table(), ""]
    return "\n".join(parts).rstrip() + "\n"


def paper_table() -> str:
    """The paper's Table III with the bias that its numbers imply."""
    rows = [row.cells(NONE) for row in paper.NETWORKS]
    head = ["model", "RMSE, N·m", "size of bias, N·m ¹", "variance, N²·m² ²", "cycle time, µs"]
    notes = (
        "¹ Recomputed: RMSE² less variance. ² Printed there in N·m. Measured on hardware that "
        "nobody here has: no column of it is to be read against one of ours."
    )
    return f"{_table(head, rows)}\n\n{notes}"


def shown(value: Interval | None, digits: int = 3) -> str:
    """A value and its interval, such as ``0.97 [0.91, 1.04]``."""
    if value is None:
        return NONE
    if value.low is None or value.high is None:
        return f"{value.value:.{digits}g}"
    places = _places(value.high - value.low)
    return f"{value.value:.{places}f} [{value.low:.{places}f}, {value.high:.{places}f}]"


def ends_shown(value: Interval | None, factor: float = 1.0) -> tuple[str, str]:
    """A value and its ends to the same decimals, the ends empty where there are none."""
    if value is None:
        return NONE, ""
    if value.low is None or value.high is None:
        return f"{factor * value.value:.3g}", ""
    places = _places(factor * (value.high - value.low))
    low, middle, high = (
        f"{factor * one:.{places}f}" for one in (value.low, value.value, value.high)
    )
    return middle, f"{low} to {high}"


def _places(width: float) -> int:
    """Decimals that give the width of an interval two figures."""
    return min(max(1 - floor(log10(width)), 0), 6) if width > 0.0 else 3


def _describe(one: SetResult) -> str:
    return (
        f"{len(one.episodes)} held-out episodes, {one.samples:,} samples; in brackets 95 % "
        "intervals by resampling whole episodes."
    )


def _models(result: EvaluationResult, one: SetResult) -> str:
    rows = []
    for score in one.models:
        own = result.behaviour(score.name)
        band, times, whole = score.ripple, own.latency, score.overall
        rows.append(
            [
                score.name,
                shown(whole.rmse),
                shown(whole.bias, 2),
                shown(whole.variance),
                NONE if band is None or band.share is None else
                f"{100.0 * band.share.value:.2g}",
                NONE if band is None else shown(band.amplitude_error, 2),
                NONE if band is None else shown(band.frequency),
                NONE if band is None else shown(band.phase, 2),
                NONE if band is None else shown(band.error_rms),
                f"{own.parameters:,}",
                NONE if times is None or times.streaming_p50 is None else
                f"{times.streaming_p50:.2g}",
                NONE if times is None else f"{times.throughput_per_sample:.2g}",
            ]
        )  # fmt: skip
    head = [
        "model", "RMSE, N·m", "bias, N·m", "variance, N²·m²", "ripple's share of variance, %",
        "ripple amplitude error, N·m", "ripple frequency, Hz", "ripple phase, °",
        "error in the ripple band, N·m", "parameters",
        "one step, µs", "batch, µs a sample",
    ]  # fmt: skip
    told = next((score.ripple for score in one.models if score.ripple is not None), None)
    remark = ""
    if told is not None:
        remark = (
            f"\n\nThe label's ripple band (10 to 25 Hz, free swing): amplitude "
            f"{told.amplitude_label:.3f} N·m, mean frequency {told.frequency_label:.1f} Hz."
        )
    return _table(head, rows) + remark


def _seeds(one: SetResult) -> str:
    """Means over seeds, best first, by regime and with unknown phase."""
    rows = []
    for model in sorted(one.seeds, key=lambda each: each.rmse.value):
        regimes = [model.regimes.get(name) for name in _REGIMES]
        rest = [*regimes, model.unknown_phase, model.unknown_phase_ripple]
        rows.append(
            [
                model.model,
                str(model.seeds),
                shown(model.rmse),
                f"{model.rmse_std:.2g}" if model.seeds > 1 else NONE,
                shown(model.variance),
                shown(model.ripple_error),
                *(NONE if value is None else f"{value:.3g}" for value in rest),
            ]
        )
    head = [
        "model", "seeds", "RMSE, N·m", "between seeds", "variance, N²·m²",
        "in the ripple band, N·m", *(f"RMSE, {name}" for name in _REGIMES),
        "RMSE, unknown phase", "in the band, unknown phase",
    ]  # fmt: skip
    return _table(head, rows)


def _pairs(one: SetResult) -> str:
    titles = {"rmse": "RMSE", "variance": "variance", "ripple_error": "in the ripple band"}
    rows: dict[tuple[str, str], list[str]] = {}
    for pair in one.paired:
        row = rows.setdefault((pair.model, pair.reference), [NONE] * len(titles))
        row[list(titles).index(pair.metric)] = _percent(pair.ratio)
    head = ["model", "against", *(f"{title}, %" for title in titles.values())]
    return _table(head, [[*names, *row] for names, row in rows.items()])


def _percent(ratio: Interval) -> str:
    """A ratio as a change: ``-43.3 [-45.1, -41.0]``."""
    change = f"{100.0 * (ratio.value - 1.0):+.1f}"
    if ratio.low is None or ratio.high is None:
        return change
    return f"{change} [{100.0 * (ratio.low - 1.0):+.1f}, {100.0 * (ratio.high - 1.0):+.1f}]"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|---" + "|---:" * (len(head) - 1) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)
