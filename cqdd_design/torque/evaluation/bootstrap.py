"""Intervals by resampling whole episodes: samples of one episode are not independent.

Block bootstrap with the episode as the block (Efron and Tibshirani 1993, chapters 8 and 13):
as many episodes are drawn with replacement as there are, and every score is formed anew; the
interval is that of the percentiles. All models share the same draws, so that their differences
and ratios are paired.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import FloatArray

DRAWS = 2000
LEVEL = 0.95
_MOST_MISSING = 0.05
"""Share of draws in which a quantity may not exist before its interval is withheld."""


@dataclass(frozen=True)
class Interval:
    """A value and where it lies with 95 %.

    Attributes
    ----------
    low, high : float or None
        None where there are too few episodes to say.
    """

    value: float
    low: float | None = None
    high: float | None = None

    @property
    def ends(self) -> list[float] | None:
        """Both ends, or None."""
        return None if self.low is None or self.high is None else [self.low, self.high]


@dataclass(frozen=True)
class Paired:
    """One model against another on the same episodes.

    Attributes
    ----------
    metric : str
        ``rmse``, ``variance`` or ``ripple_error``.
    difference : Interval
        Model less reference, in the metric's unit.
    ratio : Interval
        Model over reference.
    """

    model: str
    reference: str
    metric: str
    difference: Interval
    ratio: Interval


def draws(episodes: int, *, count: int = DRAWS, seed: int = 0) -> FloatArray:
    """How often each resample holds each episode (count, episodes).

    Raises
    ------
    UsageError
        For no episodes or no resamples.
    """
    if episodes < 1 or count < 1:
        raise UsageError(f"{count} resamples of {episodes} episodes; both must be 1 or more.")
    generator = np.random.default_rng(seed)
    shares = np.full(episodes, 1.0 / episodes)
    return np.asarray(generator.multinomial(episodes, shares, size=count), np.float64)


def interval(value: float, resampled: FloatArray, *, episodes: int) -> Interval:
    """The interval of a value from its resamples (B,); nan among them are left out.

    Fewer than two episodes, or a quantity that exists in fewer than 95 % of the resamples, get
    no ends.
    """
    kept = resampled[np.isfinite(resampled)]
    if episodes < 2 or len(kept) < (1.0 - _MOST_MISSING) * len(resampled):
        return Interval(value)
    tail = 0.5 * (1.0 - LEVEL)
    low, high = np.quantile(kept, [tail, 1.0 - tail])
    # The value itself belongs to the interval even where the percentiles are skewed.
    return Interval(value, min(float(low), value), max(float(high), value))


def circular_interval(degrees: float, resampled: FloatArray, *, episodes: int) -> Interval:
    """As `interval`, for angles: the ends count from the value, so they may pass 180 degrees."""
    turned = (resampled - degrees + 180.0) % 360.0 - 180.0
    found = interval(0.0, turned, episodes=episodes)
    if found.low is None or found.high is None:
        return Interval(degrees)
    return Interval(degrees, degrees + found.low, degrees + found.high)


def paired(
    model: str,
    reference: str,
    metric: str,
    values: Mapping[str, float],
    resampled: Mapping[str, FloatArray],
    *,
    episodes: int,
) -> Paired:
    """Difference and ratio of two models, by the same resamples (B,); values of every model."""
    own, other = values[model], values[reference]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = resampled[model] / resampled[reference]
    differences = resampled[model] - resampled[reference]
    ratio = own / other if other else math.nan
    return Paired(
        model=model,
        reference=reference,
        metric=metric,
        difference=interval(own - other, differences, episodes=episodes),
        ratio=interval(ratio, ratios, episodes=episodes),
    )
