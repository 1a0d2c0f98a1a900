"""Scores of one estimator, their means over the seeds of a model, and model against model."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.torque.data.episodes import FloatArray
from cqdd_design.torque.evaluation import bootstrap
from cqdd_design.torque.evaluation.bootstrap import Interval, Paired
from cqdd_design.torque.evaluation.metrics import Scores
from cqdd_design.torque.evaluation.ripple import OrderSpectrum, Ripple

REFERENCES = ("mlp", "pva-gru")
"""Models that the others are paired with, where they are there."""


@dataclass(frozen=True)
class RegimeScores:
    """Scores in one regime with intervals over episodes.

    Attributes
    ----------
    episodes : int
        That have such samples.
    rmse, bias, variance : Interval
        N m and N^2 m^2.
    p95 : Interval
        Ends only over all samples, N m.
    """

    scores: Scores
    episodes: int
    rmse: Interval
    bias: Interval
    variance: Interval
    r_squared: Interval | None
    p95: Interval


@dataclass(frozen=True, eq=False)
class ModelScore:
    """One estimator on one set.

    Attributes
    ----------
    regimes : mapping of str to RegimeScores or None
        None where no sample belongs to the regime.
    flank_ripple : Ripple or None
        Of segments that stay on one flank of the gear; see `metrics.on_one_flank`.
    unknown_phase : RegimeScores or None
        With every angle off by a constant that differs between episodes; of models that use the
        homed position.
    error_counts : array (K,)
        Of the set's `error_edges`.
    spectrum : array (F,)
        Amplitude density of the estimate in free swing, N m/sqrt(Hz).
    """

    name: str
    model: str
    regimes: Mapping[str, RegimeScores | None]
    ripple: Ripple | None
    flank_ripple: Ripple | None
    unknown_phase: RegimeScores | None
    unknown_phase_ripple: Ripple | None
    error_counts: FloatArray
    spectrum: FloatArray
    orders: OrderSpectrum | None

    @property
    def overall(self) -> RegimeScores:
        """Over all samples."""
        found = self.regimes["all"]
        assert found is not None
        return found


@dataclass(frozen=True)
class SeedSummary:
    """Means over the seeds of one model, intervals over episodes.

    Attributes
    ----------
    rmse : Interval
        N m.
    rmse_std : float
        Between seeds, N m.
    variance : Interval
        N^2 m^2.
    ripple_error : Interval or None
        N m.
    regimes : mapping of str to float
        RMSE of each regime that has samples, N m.
    unknown_phase, unknown_phase_ripple : float or None
        RMSE and error in the ripple band with unknown phase, N m.
    """

    model: str
    seeds: int
    rmse: Interval
    rmse_std: float
    variance: Interval
    ripple_error: Interval | None
    regimes: Mapping[str, float]
    unknown_phase: float | None
    unknown_phase_ripple: float | None


METRICS: Mapping[str, Callable[[ModelScore], Interval | None]] = {
    "rmse": lambda one: one.overall.rmse,
    "variance": lambda one: one.overall.variance,
    "ripple_error": lambda one: _in_band(one.ripple),
}
"""What is averaged over seeds and compared between models."""


def _rmse(found: RegimeScores | None) -> Interval | None:
    return None if found is None else found.rmse


def _in_band(found: Ripple | None) -> Interval | None:
    return None if found is None else found.error_rms


def between(
    scored: Sequence[ModelScore], resampled: Mapping[str, Mapping[str, FloatArray]], episodes: int
) -> tuple[tuple[SeedSummary, ...], tuple[Paired, ...]]:
    """Means over the seeds of each model, and each model against the references."""
    members: dict[str, list[ModelScore]] = {}
    for one in scored:
        members.setdefault(one.model, []).append(one)
    values: dict[str, dict[str, float]] = {metric: {} for metric in METRICS}
    many: dict[str, dict[str, FloatArray]] = {metric: {} for metric in METRICS}
    seeds = []
    for model, own in members.items():
        told: dict[str, Interval] = {}
        for metric, of in METRICS.items():
            mean = _mean(of(one) for one in own)
            if mean is None:
                continue
            values[metric][model] = mean
            many[metric][model] = np.mean([resampled[one.name][metric] for one in own], axis=0)
            told[metric] = bootstrap.interval(mean, many[metric][model], episodes=episodes)
        errors = [one.overall.rmse.value for one in own]
        seeds.append(
            SeedSummary(
                model=model,
                seeds=len(own),
                rmse=told["rmse"],
                rmse_std=float(np.std(errors, ddof=1)) if len(own) > 1 else 0.0,
                variance=told["variance"],
                ripple_error=told.get("ripple_error"),
                regimes=_regimes(own),
                unknown_phase=_mean(_rmse(one.unknown_phase) for one in own),
                unknown_phase_ripple=_mean(_in_band(one.unknown_phase_ripple) for one in own),
            )
        )
    pairs = [
        bootstrap.paired(model, other, metric, values[metric], many[metric], episodes=episodes)
        for other in REFERENCES
        for metric, found in values.items()
        if other in found
        for model in found
        if model != other
    ]
    return tuple(seeds), tuple(pairs)


def _regimes(own: Sequence[ModelScore]) -> dict[str, float]:
    """Mean RMSE of each regime that every seed has samples of, N m."""
    names = own[0].regimes
    means = {name: _mean(_rmse(one.regimes[name]) for one in own) for name in names}
    return {name: mean for name, mean in means.items() if mean is not None}


def _mean(values: Iterable[Interval | None]) -> float | None:
    """Mean, or None where one is missing."""
    kept = list(values)
    known = [one.value for one in kept if one is not None]
    return float(np.mean(known)) if len(known) == len(kept) else None
