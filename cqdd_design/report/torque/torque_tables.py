"""Tables of an evaluation of torque estimators."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.report.ink.numbers import MINUS, significant
from cqdd_design.torque.evaluation.evaluate import EvaluationResult
from cqdd_design.torque.evaluation.markdown import NONE, ends_shown
from cqdd_design.torque.evaluation.metrics import REGIMES
from cqdd_design.torque.evaluation.paper import PAPER
from cqdd_design.torque.evaluation.ripple import BAND

if TYPE_CHECKING:
    from cqdd_design.torque.evaluation.bootstrap import Interval
    from cqdd_design.torque.evaluation.scoring import SetResult
    from cqdd_design.torque.evaluation.seeds import ModelScore


@dataclass(frozen=True)
class Cell:
    """A value and, in small type below it, its interval."""

    shown: str
    ends: str = ""


@dataclass(frozen=True)
class Table:
    """Heading, columns and rows of cells; the first column is text."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str | Cell, ...], ...]
    note: str = ""


def _cell(value: Interval | None, factor: float = 1.0) -> Cell:
    middle, ends = ends_shown(value, factor)
    return Cell(middle.replace("-", MINUS), ends.replace("-", MINUS))


def ordered(results: EvaluationResult, found: SetResult) -> list[ModelScore]:
    """Networks first, each kind by its error."""
    kinds = {one.name: one.kind for one in results.models}
    return sorted(
        found.models, key=lambda one: (kinds[one.name] != "network", one.overall.rmse.value)
    )


def models_table(results: EvaluationResult, found: SetResult) -> Table:
    """Ours on one set."""
    rows: list[tuple[str | Cell, ...]] = []
    for one in ordered(results, found):
        band, whole = one.ripple, one.overall
        rows.append(
            (
                one.name,
                _cell(whole.rmse),
                _cell(whole.bias),
                _cell(whole.variance),
                NONE if band is None or band.share is None else
                f"{significant(100.0 * band.share.value, 2)}\u202f%",
                NONE if band is None else _cell(band.error_rms),
                NONE if band is None else _cell(band.amplitude_error),
                NONE if band is None else _cell(band.frequency),
                NONE if band is None else _cell(band.phase),
            )
        )  # fmt: skip
    head = (
        "Model", "RMSE, N·m", "Bias, N·m", "Variance, N²·m²", "Ripple's share of it",
        "Ripple band, error N·m", "Amplitude off, N·m", "Frequency, Hz", "Phase, °",
    )  # fmt: skip
    told = next((one.ripple for one in found.models if one.ripple is not None), None)
    note = "RMSE² is bias² plus variance."
    if told is not None:
        note += (
            f" The ripple band is {BAND[0]:g} to {BAND[1]:g} Hz at the output in free swing, where "
            f"the label has an amplitude of {significant(told.amplitude_label, 3)} N·m about "
            f"{significant(told.frequency_label, 3)} Hz; its share is that of the error's own "
            "variance. A positive phase leads."
        )
    return Table("Ours (simulated twin)", head, tuple(rows), note)


def paper_table() -> Table:
    """The paper's hardware."""
    rows = tuple(tuple(row.cells(NONE)) for row in PAPER)
    head = ("Model", "RMSE, N·m", "Size of bias, N·m", "Variance, N²·m²", "Cycle time, µs")
    return Table(
        "Paper (hardware)",
        head,
        rows,
        "Table II of the paper, measured on its own actuator. Its variances are printed in N·m and "
        "can only be N²·m²; the bias is recomputed from RMSE² less variance. 1.49 µs cannot be a "
        "window of 30 steps alone (1.30 MFLOP); it fits one recurrent step, or a share of a large "
        "batch. No number here is to be read against one of ours: other machine, other data.",
    )


def regimes_table(found: SetResult) -> Table:
    """RMSE of every model by regime."""
    rows: list[tuple[str | Cell, ...]] = []
    for one in sorted(found.models, key=lambda s: s.overall.rmse.value):
        cells: list[str | Cell] = []
        for regime in REGIMES:
            scores = one.regimes[regime]
            cells.append(NONE if scores is None else _cell(scores.rmse))
        whole = one.overall
        squared = NONE if whole.r_squared is None else f"{whole.r_squared.value:.4f}"
        rows.append(
            (
                one.name,
                *cells,
                squared.replace("-", MINUS),
                _cell(whole.p95),
                significant(whole.scores.most, 3),
            )
        )
    head = ("RMSE, N·m", *REGIMES, "R²", "95 % below, N·m", "Greatest, N·m")
    meanings = "; ".join(f"{name}: {meaning}" for name, meaning in REGIMES.items())
    return Table("By regime", head, tuple(rows), f"A sample may belong to several. {meanings}.")


def pairs_table(found: SetResult) -> Table:
    """Changes against the references."""
    titles = {"rmse": "RMSE", "variance": "variance", "ripple_error": "ripple band"}
    references = list(dict.fromkeys(pair.reference for pair in found.paired))
    models = list(dict.fromkeys(pair.model for pair in found.paired))
    known = {(p.model, p.reference, p.metric): p for p in found.paired}
    rows: list[tuple[str | Cell, ...]] = []
    for model in models:
        cells: list[str | Cell] = []
        for reference in references:
            for metric in titles:
                pair = known.get((model, reference, metric))
                cells.append(NONE if pair is None else _change(pair.ratio))
        rows.append((model, *cells))
    head = ["Change, %"]
    head += [f"{title} against {one}" for one in references for title in titles.values()]
    return Table(
        "Model against model",
        tuple(head),
        tuple(rows),
        "Both models of a pair are scored on the same resampled episodes, means over seeds.",
    )


def _change(ratio: Interval) -> Cell:
    told, ends = f"{100.0 * (ratio.value - 1.0):+.1f}", ""
    if ratio.low is not None and ratio.high is not None:
        ends = f"{100.0 * (ratio.low - 1.0):+.1f} to {100.0 * (ratio.high - 1.0):+.1f}"
    return Cell(told.replace("-", MINUS), ends.replace("-", MINUS))


def seeds_table(found: SetResult) -> Table:
    """Means over the seeds of each model."""
    rows = tuple(
        (
            one.model,
            str(one.seeds),
            _cell(one.rmse),
            significant(one.rmse_std, 2),
            _cell(one.variance),
            _cell(one.ripple_error),
        )
        for one in found.seeds
        if one.seeds > 1
    )
    head = (
        "Model", "Seeds", "Mean RMSE, N·m", "Spread over seeds", "Mean variance, N²·m²",
        "Mean error in the ripple band, N·m",
    )  # fmt: skip
    return Table("Mean over seeds", head, rows)


def sets_table(results: EvaluationResult) -> Table:
    """RMSE on every test set."""
    rows: list[tuple[str | Cell, ...]] = []
    for own in results.models:
        scored = [one.model(own.name) for one in results.sets]
        cells = [NONE if one is None else _cell(one.overall.rmse) for one in scored]
        rows.append((own.name, *cells))
    head = ("RMSE, N·m", *(f"{one.name} ({len(one.episodes)})" for one in results.sets))
    return Table(
        "Other test sets",
        head,
        tuple(rows),
        "In brackets the episodes of each set. A model is not scored where it was trained.",
    )


def flank_table(found: SetResult) -> Table:
    """The ripple band without steps of backlash and friction."""
    rows: list[tuple[str | Cell, ...]] = []
    told = ""
    for one in sorted(found.models, key=lambda s: s.overall.rmse.value):
        band = one.flank_ripple
        if band is None:
            continue
        told = (
            f" {band.segments} segments; the label has {significant(band.amplitude_label, 3)} N·m "
            f"about {significant(band.frequency_label, 3)} Hz."
        )
        rows.append(
            (
                one.name,
                _cell(band.error_rms),
                _cell(band.amplitude_error),
                _cell(band.frequency),
                _cell(band.phase),
                significant(band.coherence, 2),
            )
        )
    head = ("Model", "Error in the band, N·m", "Amplitude off, N·m", "Frequency, Hz", "Phase, °",
            "Coherence")  # fmt: skip
    return Table(
        "Ripple on one flank",
        head,
        tuple(rows),
        "The same band over segments of 0.4 s in which torque and velocity keep their signs: where "
        "they change, the gear crosses its backlash and friction turns round, and such steps fill "
        "the band as well." + told,
    )


def phase_table(found: SetResult) -> Table:
    """Models of the homed position, homed and not."""
    rows: list[tuple[str | Cell, ...]] = []
    for one in found.models:
        if one.unknown_phase is None:
            continue
        band, lost = one.ripple, one.unknown_phase_ripple
        rows.append(
            (
                one.name,
                _cell(one.overall.rmse),
                _cell(one.unknown_phase.rmse),
                NONE if band is None else _cell(band.error_rms),
                NONE if lost is None else _cell(lost.error_rms),
            )
        )
    head = (
        "Model", "RMSE homed, N·m", "RMSE not homed, N·m", "Ripple band homed, N·m",
        "Ripple band not homed, N·m",
    )  # fmt: skip
    return Table(
        "Without homing",
        head,
        tuple(rows),
        "A single-turn encoder on the motor does not tell the phase of the gearbox after power-up: "
        "all angles of an episode are off by a constant, drawn uniformly over a turn.",
    )


def loop_table(results: EvaluationResult) -> Table:
    """Closed loop and long streaming."""
    rows: list[tuple[str | Cell, ...]] = []
    for own in results.models:
        if not own.rollouts and own.drift is None:
            continue
        runs = own.rollouts
        growth = NONE
        if own.drift is not None:
            growth = f"{significant(100.0 * own.drift.growth, 2)}\u202f%"
            growth = growth if own.drift.finite else "not finite"
        rows.append(
            (
                own.name,
                str(len(runs)) if runs else own.missing or NONE,
                NONE if own.position_rms is None else _cell(own.position_rms, 1e3),
                str(sum(run.diverged for run in runs)) if runs else NONE,
                str(sum(run.injects for run in runs)) if runs else NONE,
                growth,
                NONE if own.modes is None else significant(own.modes.difference_rms, 3),
            )
        )
    head = (
        "Model", "Episodes", "Position off, mrad r.m.s.", "Ran away", "Grows when held",
        "Drift over 10⁵ steps", "Streaming less window, N·m r.m.s.",
    )  # fmt: skip
    return Table(
        "As the actuator of a simulation",
        head,
        tuple(rows),
        "The estimate drives the episode's pendulum, held between samples; afterwards the last "
        "target is held for 3 s, in which motion must not grow. Drift: change of the output's "
        "r.m.s. from the fourth to the last period of a periodic input, state kept.",
    )


def latency_table(results: EvaluationResult) -> Table:
    """Sizes and times."""

    def told(value: float | None) -> str:
        return NONE if value is None else significant(value, 3)

    rows = tuple(
        (
            own.name,
            f"{own.parameters:,}".replace(",", "\u202f"),
            str(own.history),
            told(own.latency.streaming_p50),
            told(own.latency.streaming_p99),
            told(own.latency.window_p50),
            told(own.latency.throughput_per_sample),
            NONE if own.leaked_rmse is None else f"{own.leaked_rmse:.3f}",
        )
        for own in results.models
        if own.latency is not None
    )
    head = (
        "Model", "Parameters", "History", "One step p50, µs", "p99, µs", "Whole window p50, µs",
        "Batch, µs a sample", "RMSE on random windows, N·m",
    )  # fmt: skip
    return Table(
        "Size and speed",
        head,
        rows,
        "Measured in this run, called from Python; a batch is 16 000 samples of one record. The "
        "last column is the score that a split of random windows would have shown: test windows "
        "that overlap those of training.",
    )
