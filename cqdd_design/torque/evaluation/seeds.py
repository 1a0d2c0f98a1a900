"""Scores of one estimator, their means over the seeds of a model, and model against model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.torque.evaluation import bootstrap
from cqdd_design.torque.evaluation.bootstrap import Interval, Paired
from cqdd_design.torque.evaluation.metrics import Scores
from cqdd_design.torque.evaluation.ripple import OrderSpectrum, Ripple

FloatArray = NDArray[np.float64]

REFERENCES = ("mlp", "pva-gru")
"""Models that the others are paired with, where they are there."""


@dataclass(frozen=True)
class RegimeScores:
    """Scores in one regime with intervals over episodes.

    Attributes
    ----------
    scores : Scores
    episodes : int
        That have such samples.
    rmse, bias, variance : Interval
        N m and N^2 m^2.
    r_squared : Interval or None
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
    name, model : str
    regimes : mapping of str to RegimeScores or None
        None where no sample belongs to the regime.
    ripple : Ripple or None
    flank_ripple : Ripple or None
        Of segments that stay on one flank of the gear; see `metrics.on_one_flank`.
    unknown_phase : RegimeScores or None
        With every angle off by a constant that differs between episodes; of models that use the
        homed position.
    unknown_phase_ripple : Ripple or None
    error_counts : array (K,)
        Of the set's `error_edges`.
    spectrum : array (F,)
        Amplitude density of the estimate in free swing, N m/sqrt(Hz).
    orders : OrderSpectrum or None
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
    model : str
    seeds : int
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


def between(
    scored: Sequence[ModelScore], resampled: Mapping[str, Mapping[str, FloatArray]], episodes: int
) -> tuple[tuple[SeedSummary, ...], tuple[Paired, ...]]:
    """Means over the seeds of each model, and each model against the references."""
    members: dict[str, list[ModelScore]] = {}
    for one in scored:
        members.setdefault(one.model, []).append(one)
    values: dict[str, dict[str, float]] = {"rmse": {}, "variance": {}, "ripple_error": {}}
    many: dict[str, dict[str, FloatArray]] = {metric: {} for metric in values}
    seeds = []
    for model, own in members.items():
        rows = {
            "rmse": [one.overall.rmse.value for one in own],
            "variance": [one.overall.variance.value for one in own],
            "ripple_error": [one.ripple.error_rms.value for one in own if one.ripple is not None],
        }
        told: dict[str, Interval] = {}
        for metric, found in rows.items():
            if len(found) < len(own):
                continue
            values[metric][model] = float(np.mean(found))
            many[metric][model] = np.mean([resampled[one.name][metric] for one in own], axis=0)
            told[metric] = bootstrap.interval(
                values[metric][model], many[metric][model], episodes=episodes
            )
        spread = float(np.std(rows["rmse"], ddof=1)) if len(own) > 1 else 0.0
        seeds.append(
            SeedSummary(
                model,
                len(own),
                told["rmse"],
                spread,
                told["variance"],
                told.get("ripple_error"),
                _regimes(own),
                _mean(None if one.unknown_phase is None else one.unknown_phase.rmse for one in own),
                _mean(
                    None if one.unknown_phase_ripple is None else one.unknown_phase_ripple.error_rms
                    for one in own
                ),
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
    found = {}
    for name in own[0].regimes:
        scores = [one.regimes[name] for one in own]
        mean = _mean(None if one is None else one.rmse for one in scores)
        if mean is not None:
            found[name] = mean
    return found


def _mean(values: Iterable[Interval | None]) -> float | None:
    """Mean, or None where one is missing."""
    kept = list(values)
    known = [one.value for one in kept if one is not None]
    return float(np.mean(known)) if len(known) == len(kept) else None
