"""The scored part of test episodes, and the stretches of them that figures show."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.evaluation.estimator import Estimator, without_phase
from cqdd_design.torque.evaluation.metrics import Mask
from cqdd_design.torque.evaluation.ripple import BAND, reaches

ZOOM = 0.4
"""Of the trace that shows ripple, s."""
_ERROR_BINS = 81


@dataclass(frozen=True, eq=False)
class Trace:
    """Label and estimates of a stretch of one episode, for figures: s and N m."""

    episode: str
    time: FloatArray
    label: FloatArray
    estimates: Mapping[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Records:
    """The scored part of every episode."""

    episodes: tuple[Episode, ...]
    skip: int
    labels: tuple[FloatArray, ...]
    masks: tuple[dict[str, Mask], ...]
    weights: FloatArray

    def estimates(self, estimator: Estimator, seed: int | None = None) -> list[FloatArray]:
        """Estimates over the scored samples; angles off by constants where a seed is given."""

        def scored(k: int) -> FloatArray:
            episode = self.episodes[k]
            given = episode if seed is None else without_phase(episode, seed, k)
            values = np.asarray(estimator.estimate(given), np.float64)
            if values.shape != (len(episode),):
                raise UsageError(
                    f"{estimator.name} gives {values.shape} values for the {len(episode)} samples "
                    f"of episode {episode.name}."
                )
            return values[self.skip :]

        # Compiled networks let other threads run; each episode is by itself.
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(scored, range(len(self.episodes))))

    def errors(self, estimates: Sequence[FloatArray]) -> list[FloatArray]:
        """Estimate less label of every episode, N m."""
        return [found - label for found, label in zip(estimates, self.labels, strict=True)]

    def scored_part(self) -> list[Episode]:
        """Every episode without the samples that are not scored."""
        return [
            Episode(
                one.name, one.group, one.dt, {k: v[self.skip :] for k, v in one.columns.items()}
            )
            for one in self.episodes
        ]


def error_edges(records: Records, estimates: Mapping[str, Sequence[FloatArray]]) -> FloatArray:
    """Bins of the error figures: symmetric, to where 99.5 % of the better half's errors lie."""
    reach = [
        float(np.quantile(np.abs(np.concatenate(found) - np.concatenate(records.labels)), 0.995))
        for found in estimates.values()
    ]
    most = 1.5 * max(float(np.median(reach)), 1e-9)
    return np.linspace(-most, most, _ERROR_BINS + 1)


def long_trace(records: Records, estimates: Mapping[str, Sequence[FloatArray]]) -> Trace:
    """The episode whose label has the median r.m.s."""
    power = [float(np.mean(label**2)) for label in records.labels]
    k = int(np.argsort(power, kind="stable")[len(power) // 2])
    return _trace(records, estimates, k, 0, len(records.labels[k]))


def zoom_trace(records: Records, estimates: Mapping[str, Sequence[FloatArray]]) -> Trace | None:
    """Where the label's ripple is strongest on one flank, else in free swing."""
    if not reaches(records.episodes[0].dt):
        return None
    for regime in ("flank", "swing"):
        place = _strongest(records, regime)
        if place is not None:
            size = round(ZOOM / records.episodes[0].dt)
            return _trace(records, estimates, *place, place[1] + size)
    return None


def _strongest(records: Records, regime: str) -> tuple[int, int] | None:
    """Episode and first sample of the stretch of most power in the band; None without one."""
    from scipy.signal import butter, sosfiltfilt

    dt = records.episodes[0].dt
    size = round(ZOOM / dt)
    filter_ = butter(3, BAND, "bandpass", fs=1.0 / dt, output="sos")
    best, place = 0.0, None
    for k, (label, mask) in enumerate(zip(records.labels, records.masks, strict=True)):
        if len(label) < max(size, 64):
            continue
        power = np.convolve(sosfiltfilt(filter_, label) ** 2, np.ones(size), "valid")
        power[np.convolve(mask[regime], np.ones(size), "valid") < size - 0.5] = 0.0
        at = int(power.argmax())
        if power[at] > best:
            best, place = float(power[at]), (k, at)
    return place


def _trace(
    records: Records,
    estimates: Mapping[str, Sequence[FloatArray]],
    k: int,
    begin: int,
    end: int,
) -> Trace:
    episode = records.episodes[k]
    return Trace(
        episode.name,
        episode.time[records.skip :][begin:end],
        records.labels[k][begin:end],
        {name: found[k][begin:end] for name, found in estimates.items()},
    )
