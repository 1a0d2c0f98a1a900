"""Tables of an evaluation of torque estimators."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from cqdd_design.catalog import paper
from cqdd_design.report.ink.numbers import MINUS, NONE, grouped, maybe, per_cent, significant
from cqdd_design.torque.evaluation.behaviour import BATCH, Behaviour
from cqdd_design.torque.evaluation.evaluate import EvaluationResult
from cqdd_design.torque.evaluation.markdown import ends_shown
from cqdd_design.torque.evaluation.metrics import REGIMES
from cqdd_design.torque.evaluation.ripple import BAND, FLANK_SEGMENT
from cqdd_design.torque.evaluation.rollout import HOLD

if TYPE_CHECKING:
    from cqdd_design.torque.evaluation.bootstrap import Interval
    from cqdd_design.torque.evaluation.ripple import Ripple
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


_NO_SIGN = re.compile(r"-(?=0(?:\.0+)?(?![\d.]))")
Item = TypeVar("Item")
Column = tuple[str, Callable[[Item], str | Cell]]
"""Heading, and what stands there for an item."""


def _table(
    title: str, items: Iterable[Item], columns: Sequence[Column[Item]], note: str = ""
) -> Table:
    """One row an item."""
    rows = tuple(tuple(cell(item) for _, cell in columns) for item in items)
    return Table(title, tuple(head for head, _ in columns), rows, note)


def _cell(value: Interval | None, factor: float = 1.0) -> Cell:
    # Nought has no sign.
    shown = (_NO_SIGN.sub("", text).replace("-", MINUS) for text in ends_shown(value, factor))
    return Cell(*shown)


def _of(part: Ripple | None, name: str) -> str | Cell:
    """A quantity of a ripple, or a dash where there is none."""
    return NONE if part is None else _cell(getattr(part, name))


def _by_error(models: Iterable[ModelScore]) -> list[ModelScore]:
    return sorted(models, key=lambda one: one.overall.rmse.value)


def ordered(results: EvaluationResult, found: SetResult) -> list[ModelScore]:
    """Networks first, each kind by its error."""
    kinds = {one.name: one.kind for one in results.models}
    return sorted(_by_error(found.models), key=lambda one: kinds[one.name] != "network")


def further_tables(results: EvaluationResult, headline: SetResult) -> tuple[Table, ...]:
    """All tables but that of the models and the paper's, where they have rows."""
    tables = [regimes_table(headline), pairs_table(headline), seeds_table(headline)]
    if len(results.sets) > 1:
        tables.append(sets_table(results))
    tables += [flank_table(headline), phase_table(headline)]
    tables += [loop_table(results), latency_table(results)]
    return tuple(one for one in tables if one.rows)


def models_table(results: EvaluationResult, found: SetResult) -> Table:
    """Ours on one set."""

    def share(one: ModelScore) -> str:
        band = one.ripple
        return NONE if band is None or band.share is None else per_cent(band.share.value, 2)

    columns: tuple[Column[ModelScore], ...] = (
        ("Model", lambda one: one.name),
        ("RMSE, N·m", lambda one: _cell(one.overall.rmse)),
        ("Bias, N·m", lambda one: _cell(one.overall.bias)),
        ("Variance, N²·m²", lambda one: _cell(one.overall.variance)),
        ("Ripple's share of it", share),
        ("Ripple band, error N·m", lambda one: _of(one.ripple, "error_rms")),
        ("Amplitude off, N·m", lambda one: _of(one.ripple, "amplitude_error")),
        ("Frequency, Hz", lambda one: _of(one.ripple, "frequency")),
        ("Phase, °", lambda one: _of(one.ripple, "phase")),
    )
    told = next((one.ripple for one in found.models if one.ripple is not None), None)
    note = "RMSE² is bias² plus variance."
    if told is not None:
        note += (
            f" The ripple band is {BAND[0]:g} to {BAND[1]:g} Hz at the output in free swing, where "
            f"the label has an amplitude of {significant(told.amplitude_label, 3)} N·m about "
            f"{significant(told.frequency_label, 3)} Hz; its share is that of the error's own "
            "variance. A positive phase leads."
        )
    return _table("Ours (simulated twin)", ordered(results, found), columns, note)


def paper_table() -> Table:
    """The paper's hardware."""
    return _table(
        "Paper (hardware)",
        paper.NETWORKS,
        (
            ("Model", lambda row: row.title),
            ("RMSE, N·m", lambda row: f"{row.rmse:.2f}"),
            ("Size of bias, N·m", lambda row: NONE if row.bias is None else f"{row.bias:.2f}"),
            ("Variance, N²·m²", lambda row: f"{row.variance:.2f}"),
            ("Cycle time, µs", lambda row: f"{row.cycle_time:.2f}"),
        ),
        "Table III of the paper, measured on its own actuator. Its variances are printed in N·m "
        "and can only be N²·m²; the bias is recomputed from RMSE² less variance. "
        f"{paper.NETWORKS[0].cycle_time:.2f} µs cannot be a window of 30 steps alone (1.30 "
        "MFLOP); it fits one recurrent step, or a share of a large batch. No number here is to be "
        "read against one of ours: other machine, other data.",
    )


def regimes_table(found: SetResult) -> Table:
    """RMSE of every model by regime."""

    def squared(one: ModelScore) -> str:
        value = one.overall.r_squared
        return NONE if value is None else f"{value.value:.4f}".replace("-", MINUS)

    def within(regime: str) -> Column[ModelScore]:
        def cell(one: ModelScore) -> str | Cell:
            scores = one.regimes[regime]
            return NONE if scores is None else _cell(scores.rmse)

        return regime, cell

    columns: tuple[Column[ModelScore], ...] = (
        ("RMSE, N·m", lambda one: one.name),
        *map(within, REGIMES),
        ("R²", squared),
        ("95 % below, N·m", lambda one: _cell(one.overall.p95)),
        ("Greatest, N·m", lambda one: significant(one.overall.scores.most, 3)),
    )
    meanings = "; ".join(f"{name}: {meaning}" for name, meaning in REGIMES.items())
    note = f"A sample may belong to several. {meanings}."
    return _table("By regime", _by_error(found.models), columns, note)


def pairs_table(found: SetResult) -> Table:
    """Changes against the references."""
    titles = {"rmse": "RMSE", "variance": "variance", "ripple_error": "ripple band"}
    known = {(p.model, p.reference, p.metric): p for p in found.paired}

    def against(reference: str, metric: str) -> Column[str]:
        def cell(model: str) -> str | Cell:
            pair = known.get((model, reference, metric))
            return NONE if pair is None else _change(pair.ratio)

        return f"{titles[metric]} against {reference}", cell

    references = dict.fromkeys(pair.reference for pair in found.paired)
    return _table(
        "Model against model",
        dict.fromkeys(pair.model for pair in found.paired),
        (
            ("Change, %", lambda model: model),
            *(against(reference, metric) for reference in references for metric in titles),
        ),
        "Both models of a pair are scored on the same resampled episodes, means over seeds.",
    )


def _change(ratio: Interval) -> Cell:
    def told(value: float) -> str:
        return f"{100.0 * (value - 1.0):+.1f}".replace("-", MINUS)

    if ratio.low is None or ratio.high is None:
        return Cell(told(ratio.value))
    return Cell(told(ratio.value), f"{told(ratio.low)} to {told(ratio.high)}")


def seeds_table(found: SetResult) -> Table:
    """Means over the seeds of each model."""
    return _table(
        "Mean over seeds",
        [one for one in found.seeds if one.seeds > 1],
        (
            ("Model", lambda one: one.model),
            ("Seeds", lambda one: str(one.seeds)),
            ("Mean RMSE, N·m", lambda one: _cell(one.rmse)),
            ("Spread over seeds", lambda one: significant(one.rmse_std, 2)),
            ("Mean variance, N²·m²", lambda one: _cell(one.variance)),
            ("Mean error in the ripple band, N·m", lambda one: _cell(one.ripple_error)),
        ),
    )


def sets_table(results: EvaluationResult) -> Table:
    """RMSE on every test set."""

    def on(found: SetResult) -> Column[Behaviour]:
        def cell(own: Behaviour) -> str | Cell:
            scored = found.model(own.name)
            return NONE if scored is None else _cell(scored.overall.rmse)

        return f"{found.name} ({len(found.episodes)})", cell

    return _table(
        "Other test sets",
        results.models,
        (("RMSE, N·m", lambda own: own.name), *map(on, results.sets)),
        "In brackets the episodes of each set. A model is not scored where it was trained.",
    )


def flank_table(found: SetResult) -> Table:
    """The ripple band without steps of backlash and friction."""
    bands = [
        (one.name, one.flank_ripple)
        for one in _by_error(found.models)
        if one.flank_ripple is not None
    ]
    note = (
        f"The same band over segments of {FLANK_SEGMENT:g} s in which torque and velocity keep "
        "their signs: where they change, the gear crosses its backlash and friction turns round, "
        "and such steps fill the band as well."
    )
    if bands:
        last = bands[-1][1]
        note += (
            f" {last.segments} segments; the label has {significant(last.amplitude_label, 3)} N·m "
            f"about {significant(last.frequency_label, 3)} Hz."
        )
    columns: tuple[Column[tuple[str, Ripple]], ...] = (
        ("Model", lambda row: row[0]),
        ("Error in the band, N·m", lambda row: _cell(row[1].error_rms)),
        ("Amplitude off, N·m", lambda row: _cell(row[1].amplitude_error)),
        ("Frequency, Hz", lambda row: _cell(row[1].frequency)),
        ("Phase, °", lambda row: _cell(row[1].phase)),
        ("Coherence", lambda row: significant(row[1].coherence, 2)),
    )
    return _table("Ripple on one flank", bands, columns, note)


def phase_table(found: SetResult) -> Table:
    """Models of the homed position, homed and not."""
    models = [(one, one.unknown_phase) for one in found.models if one.unknown_phase is not None]
    return _table(
        "Without homing",
        models,
        (
            ("Model", lambda row: row[0].name),
            ("RMSE homed, N·m", lambda row: _cell(row[0].overall.rmse)),
            ("RMSE not homed, N·m", lambda row: _cell(row[1].rmse)),
            ("Ripple band homed, N·m", lambda row: _of(row[0].ripple, "error_rms")),
            (
                "Ripple band not homed, N·m",
                lambda row: _of(row[0].unknown_phase_ripple, "error_rms"),
            ),
        ),
        "A single-turn encoder on the motor does not tell the phase of the gearbox after power-up: "
        "all angles of an episode are off by a constant, drawn uniformly over a turn.",
    )


def loop_table(results: EvaluationResult) -> Table:
    """Closed loop and long streaming."""

    def growth(own: Behaviour) -> str:
        if own.drift is None:
            return NONE
        return per_cent(own.drift.growth, 2) if own.drift.finite else "not finite"

    def counted(own: Behaviour, flag: str) -> str:
        return str(sum(getattr(run, flag) for run in own.rollouts)) if own.rollouts else NONE

    def position(own: Behaviour) -> str | Cell:
        return NONE if own.position_rms is None else _cell(own.position_rms, 1e3)

    columns: tuple[Column[Behaviour], ...] = (
        ("Model", lambda own: own.name),
        ("Episodes", lambda own: str(len(own.rollouts) or own.missing or NONE)),
        ("Position off, mrad r.m.s.", position),
        ("Ran away", lambda own: counted(own, "diverged")),
        ("Grows when held", lambda own: counted(own, "injects")),
        ("Drift over 10⁵ steps", growth),
        (
            "Streaming less window, N·m r.m.s.",
            lambda own: NONE if own.modes is None else significant(own.modes.difference_rms, 3),
        ),
    )
    return _table(
        "As the actuator of a simulation",
        [own for own in results.models if own.rollouts or own.drift is not None],
        columns,
        "The estimate drives the episode's pendulum, held between samples; afterwards the last "
        f"target is held for {HOLD:g} s, in which motion must not grow. Drift: change of the "
        "output's r.m.s. from the fourth to the last period of a periodic input, state kept.",
    )


def latency_table(results: EvaluationResult) -> Table:
    """Sizes and times."""
    batch = f"{BATCH:,}".replace(",", " ")
    timed = [(own, own.latency) for own in results.models if own.latency is not None]
    return _table(
        "Size and speed",
        timed,
        (
            ("Model", lambda row: row[0].name),
            ("Parameters", lambda row: grouped(row[0].parameters)),
            ("History", lambda row: str(row[0].history)),
            ("One step p50, µs", lambda row: maybe(row[1].streaming_p50, 3)),
            ("p99, µs", lambda row: maybe(row[1].streaming_p99, 3)),
            ("Whole window p50, µs", lambda row: maybe(row[1].window_p50, 3)),
            ("Batch, µs a sample", lambda row: maybe(row[1].throughput_per_sample, 3)),
            (
                "RMSE on random windows, N·m",
                lambda row: NONE if row[0].leaked_rmse is None else f"{row[0].leaked_rmse:.3f}",
            ),
        ),
        f"Measured in this run, called from Python; a batch is {batch} samples of one "
        "record. The last column is the score that a split of random windows would have shown: "
        "test windows that overlap those of training.",
    )
