"""Score estimators on one set of test episodes: errors, ripple, intervals, paired differences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.evaluation import bootstrap, metrics
from cqdd_design.torque.evaluation.bootstrap import Interval, Paired
from cqdd_design.torque.evaluation.estimator import Estimator
from cqdd_design.torque.evaluation.metrics import REGIMES, Mask
from cqdd_design.torque.evaluation.ripple import (
    FLANK_SEGMENT,
    SEGMENT,
    Ripple,
    Spectra,
    Stroke,
    error_rms,
    mean_amplitudes,
    order_spectrum,
    reaches,
    ripple,
    spectra,
    strokes,
)
from cqdd_design.torque.evaluation.seeds import ModelScore, RegimeScores, SeedSummary, between
from cqdd_design.torque.evaluation.stretches import (
    Records,
    Trace,
    error_edges,
    long_trace,
    zoom_trace,
)


@dataclass(frozen=True, eq=False)
class SetResult:
    """All estimators on one set of episodes.

    Attributes
    ----------
    samples : int
        Scored, the same of every estimator.
    paired : tuple of Paired
        Means over seeds against those of `seeds.REFERENCES`.
    error_edges : array (K + 1,)
        N m.
    frequency, label_spectrum : array (F,)
    trace, zoom : Trace
        The episode of median r.m.s. label, and where the label's ripple is strongest: chosen by
        labels alone.
    """

    name: str
    episodes: tuple[str, ...]
    samples: int
    models: tuple[ModelScore, ...]
    seeds: tuple[SeedSummary, ...]
    paired: tuple[Paired, ...]
    error_edges: FloatArray
    frequency: FloatArray
    label_spectrum: FloatArray
    trace: Trace
    zoom: Trace | None
    warnings: tuple[str, ...]

    def model(self, name: str) -> ModelScore | None:
        """A score by name."""
        return next((one for one in self.models if one.name == name), None)


def score_set(
    name: str,
    episodes: Sequence[Episode],
    estimators: Sequence[Estimator],
    *,
    count: int = bootstrap.DRAWS,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> SetResult:
    """Score estimators on the episodes of one set.

    Every estimator is scored on the same samples: those at which the one with the longest
    history has a full window.

    Raises
    ------
    UsageError
        Without episodes that are long enough, or for estimates that are not finite.
    """
    skip = max((one.history for one in estimators), default=1) - 1
    kept = tuple(one for one in episodes if len(one) > skip)
    warnings = []
    if len(kept) < len(episodes):
        warnings.append(
            f"{len(episodes) - len(kept)} episodes of set {name} are no longer than a window of "
            f"{skip + 1} samples and are left out."
        )
    if not kept or not estimators:
        raise UsageError(
            f"set {name} has no episode of more than {skip} samples to test on; record more, or "
            "choose another --set."
        )
    if len(kept) == 1:
        warnings.append(f"set {name} is one episode: its scores have no intervals.")
    records = Records(
        kept,
        skip,
        tuple(np.asarray(one.columns["torque"], np.float64)[skip:] for one in kept),
        tuple(_masks(one, skip) for one in kept),
        bootstrap.draws(len(kept), count=count, seed=seed),
    )
    if not reaches(kept[0].dt):
        warnings.append(
            f"a sample time of {kept[0].dt:g} s does not show the ripple band up to 25 Hz; its "
            "rows are left out."
        )
    estimates: dict[str, list[FloatArray]] = {}
    for one in estimators:
        if progress is not None:
            progress(f"{one.name} on {name}")
        missing = [c for c in one.needs if any(c not in e.columns for e in kept)]
        if missing:
            warnings.append(f"{one.name} needs {', '.join(missing)}, which is not recorded.")
            continue
        estimates[one.name] = records.estimates(one)
    known = [one for one in estimators if one.name in estimates]
    if not known:
        raise UsageError(f"no model can be scored on set {name}: {' '.join(warnings)}")
    for one in known:
        _refuse_gaps(one.name, estimates[one.name], kept, skip)
    edges = error_edges(records, estimates)
    swings = strokes(records.scored_part(), [mask["swing"] for mask in records.masks])
    scored, resampled = [], {}
    label_spectrum = frequency = np.zeros(0)
    for one in known:
        score, own, found = _score(one, estimates[one.name], records, edges, swings, seed)
        scored.append(score)
        resampled[one.name] = own
        if found is not None:
            frequency, label_spectrum, _ = mean_amplitudes(found)
    seeds, pairs = between(scored, resampled, len(kept))
    return SetResult(
        name=name,
        episodes=tuple(one.name for one in kept),
        samples=sum(map(len, records.labels)),
        models=tuple(scored),
        seeds=seeds,
        paired=pairs,
        error_edges=edges,
        frequency=frequency,
        label_spectrum=label_spectrum,
        trace=long_trace(records, estimates),
        zoom=zoom_trace(records, estimates),
        warnings=tuple(warnings),
    )


def _masks(episode: Episode, skip: int) -> dict[str, Mask]:
    found = metrics.regimes(episode) | {"flank": metrics.on_one_flank(episode)}
    return {name: mask[skip:] for name, mask in found.items()}


def _refuse_gaps(
    name: str, estimates: Sequence[FloatArray], episodes: Sequence[Episode], skip: int
) -> None:
    for values, episode in zip(estimates, episodes, strict=True):
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise UsageError(
                f"{name} gives {values[bad[0]]} at sample {bad[0] + skip} of episode "
                f"{episode.name}, and no number {len(bad)} times in all; look for inputs far "
                "outside what it was trained on."
            )


def _score(
    estimator: Estimator,
    estimates: Sequence[FloatArray],
    records: Records,
    edges: FloatArray,
    swings: Sequence[Stroke],
    seed: int,
) -> tuple[ModelScore, dict[str, FloatArray], Spectra | None]:
    dt = records.episodes[0].dt

    def band(told: Sequence[FloatArray], mask: str, seconds: float = SEGMENT) -> Spectra | None:
        free = [one[mask] for one in records.masks]
        return spectra(records.labels, told, free, dt, seconds=seconds) if reaches(dt) else None

    def rippled(found: Spectra | None) -> Ripple | None:
        return None if found is None else ripple(found, records.weights)

    errors = records.errors(estimates)
    totals = np.array([_sums(e, k, "all", records) for k, e in enumerate(errors)])
    resampled = metrics.scores_of_sums(records.weights @ totals)
    own = {"rmse": resampled["rmse"], "variance": resampled["variance"]}
    found = band(estimates, "swing")
    if found is not None:
        own["ripple_error"] = error_rms(found, records.weights)
    lost, lost_ripple = None, None
    if estimator.knows_phase:
        turned = records.estimates(estimator, seed)
        lost = _regime("all", turned, records)
        lost_ripple = rippled(band(turned, "swing"))
    clipped = np.clip(np.concatenate(errors), edges[0], edges[-1])
    score = ModelScore(
        name=estimator.name,
        model=estimator.model or estimator.name,
        regimes={name: _regime(name, estimates, records) for name in REGIMES},
        ripple=rippled(found),
        flank_ripple=rippled(band(estimates, "flank", FLANK_SEGMENT)),
        unknown_phase=lost,
        unknown_phase_ripple=lost_ripple,
        error_counts=np.asarray(np.histogram(clipped, edges)[0], np.float64),
        spectrum=np.zeros(0) if found is None else mean_amplitudes(found)[2],
        orders=None if found is None else order_spectrum(swings, records.labels, estimates),
    )
    return score, own, found


def _sums(error: FloatArray, index: int, regime: str, records: Records) -> FloatArray:
    return metrics.sums(error, records.labels[index], records.masks[index][regime])


def _regime(regime: str, estimates: Sequence[FloatArray], records: Records) -> RegimeScores | None:
    masks = [mask[regime] for mask in records.masks]
    chosen = np.concatenate([p[m] for p, m in zip(estimates, masks, strict=True)])
    labels = np.concatenate([y[m] for y, m in zip(records.labels, masks, strict=True)])
    found = metrics.scores(chosen, labels)
    if found is None:
        return None
    errors = records.errors(estimates)
    totals = np.array([_sums(error, k, regime, records) for k, error in enumerate(errors)])
    many = metrics.scores_of_sums(records.weights @ totals)
    episodes = int(np.sum(totals[:, 0] > 0.0))
    p95 = Interval(found.p95)
    if regime == "all":
        counts, ends = metrics.size_histograms([np.abs(error) for error in errors])
        p95 = bootstrap.interval(
            found.p95,
            metrics.quantiles_of_histograms(records.weights[:500] @ counts, ends, 0.95),
            episodes=episodes,
        )

    def told(name: str, value: float) -> Interval:
        return bootstrap.interval(value, many[name], episodes=episodes)

    return RegimeScores(
        scores=found,
        episodes=episodes,
        rmse=told("rmse", found.rmse),
        bias=told("bias", found.bias),
        variance=told("variance", found.variance),
        r_squared=None if found.r_squared is None else told("r_squared", found.r_squared),
        p95=p95,
    )
