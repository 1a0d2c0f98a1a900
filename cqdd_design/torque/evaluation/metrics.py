"""Errors of a torque estimate: r.m.s., bias, variance and the rest, over all and by regime."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.torque.data.episodes import Episode, FloatArray

Mask = NDArray[np.bool_]

REGIMES: Mapping[str, str] = {
    "all": "every sample",
    "swing": "no wall touched and no limit of the drive binding",
    "wall": "a wall touched",
    "saturation": "the drive's voltage or current limit binding",
    "reversal": "slower than 0.2 rad/s, or turning round within two samples",
}
"""Names and meanings; a sample may belong to several."""
REVERSAL_SPEED = 0.2
"""Below it a joint counts as turning round, rad/s."""
REVERSAL_SAMPLES = 2
"""On both sides of a change of sign."""
FLANK_TIME = 0.04
"""To either side of a change of sign, s."""

_BINS = 4000


@dataclass(frozen=True)
class Scores:
    """Errors, prediction less label.

    Attributes
    ----------
    rmse, bias : float
        N m.
    variance : float
        Of the error about its own mean, N^2 m^2: ``rmse^2 = bias^2 + variance``.
    r_squared : float or None
        1 less the mean square error over the label's variance; None where the label stands still.
    p95, most : float
        Of the error's size, N m.
    """

    samples: int
    rmse: float
    bias: float
    variance: float
    r_squared: float | None
    p95: float
    most: float


def regimes(episode: Episode) -> dict[str, Mask]:
    """Which samples belong to which regime: masks (N,) by the names of `REGIMES`."""
    wall, saturated = episode.flag("wall"), episode.flag("saturated")
    velocity = np.asarray(episode.columns["velocity"], np.float64)
    turning = np.abs(velocity) < REVERSAL_SPEED
    signs = np.signbit(velocity)
    for k in np.flatnonzero(signs[1:] != signs[:-1]):
        turning[max(k + 1 - REVERSAL_SAMPLES, 0) : k + 1 + REVERSAL_SAMPLES] = True
    return {
        "all": np.ones(len(episode), bool),
        "swing": ~wall & ~saturated,
        "wall": wall,
        "saturation": saturated,
        "reversal": turning,
    }


def on_one_flank(episode: Episode) -> Mask:
    """Samples (N,) of free swing away from where torque or velocity change their sign.

    Where the torque does, the gear crosses its backlash and strikes the other flank; where the
    velocity does, friction turns round. Either is a step over all frequencies, which hides the
    ripple of the meshing teeth.
    """
    found = ~episode.flag("wall") & ~episode.flag("saturated")
    near = max(round(FLANK_TIME / episode.dt), 1)
    for name in ("torque", "velocity"):
        for k in np.flatnonzero(np.diff(np.signbit(episode.columns[name]))):
            found[max(k + 1 - near, 0) : k + 1 + near] = False
    return found


def scores(prediction: FloatArray, label: FloatArray) -> Scores | None:
    """Scores of estimates (N,) against labels (N,), N m, all finite; None for no samples."""
    error = prediction - label
    if not len(error):
        return None
    bias = float(error.mean())
    spread = float(np.var(label))
    square = float(np.mean(error**2))
    size = np.abs(error)
    return Scores(
        samples=len(error),
        rmse=square**0.5,
        bias=bias,
        variance=float(np.mean((error - bias) ** 2)),
        r_squared=1.0 - square / spread if spread > 0.0 else None,
        p95=float(np.quantile(size, 0.95)),
        most=float(size.max()),
    )


def sums(error: FloatArray, label: FloatArray, mask: Mask) -> FloatArray:
    """What an episode adds to a resample's scores over the samples of a mask (5,).

    Count, error and its square, label and its square.
    """
    e, y = error[mask], label[mask]
    return np.array([len(e), e.sum(), np.sum(e * e), y.sum(), np.sum(y * y)], np.float64)


def scores_of_sums(totals: FloatArray) -> dict[str, FloatArray]:
    """Scores of many resamples (..., 5) at once; nan where a resample has no such sample."""
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = totals[..., 1:] / totals[..., :1]
        bias, square = mean[..., 0], mean[..., 1]
        spread = mean[..., 3] - mean[..., 2] ** 2
        return {
            "rmse": np.sqrt(square),
            "bias": bias,
            "variance": np.maximum(square - bias**2, 0.0),
            "r_squared": np.where(spread > 0.0, 1.0 - square / spread, np.nan),
        }


def size_histograms(sizes: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Counts (E, K) of each episode's error sizes, and the bins' upper ends (K,)."""
    most = max((float(one.max()) for one in sizes if len(one)), default=0.0)
    edges = np.linspace(0.0, most if most > 0.0 else 1.0, _BINS + 1)
    counts = np.array([np.histogram(one, edges)[0] for one in sizes], np.float64)
    return counts, np.asarray(edges[1:])


def quantiles_of_histograms(counts: FloatArray, ends: FloatArray, share: float) -> FloatArray:
    """Quantile of each row of summed histograms (B, K), to one bin's width; nan for none."""
    run = np.cumsum(counts, axis=1)
    whole = run[:, -1]
    index = np.argmax(run >= share * whole[:, None], axis=1)
    return np.where(whole > 0.0, ends[index], np.nan)
