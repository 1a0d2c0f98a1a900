"""Variance-based sensitivity by pick-freeze: first-order and total Sobol' indices of groups.

Two independent samples A and B of all inputs, and for every group i the sample AB_i, which is A
with group i from B. Inputs of a group are exchanged together, so a group's index counts all its
errors at once, with their interactions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import FloatArray

_RESAMPLES = 200


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Indices of k groups for one output.

    Attributes
    ----------
    first, total : array (k,)
        Share of the variance by the group alone, and with its interactions. All zero where the
        output does not vary. Estimates may leave 0 to 1 by their uncertainty.
    first_half_width, total_half_width : array (k,)
        Half widths of 95 % intervals, by bootstrap.
    """

    first: FloatArray
    total: FloatArray
    first_half_width: FloatArray
    total_half_width: FloatArray


def _indices(a: FloatArray, b: FloatArray, ab: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First-order by Saltelli et al. (2010), total by Jansen (1999); ab is (k, N)."""
    variance = np.var(np.concatenate([a, b], axis=-1), axis=-1)
    safe = np.where(variance > 0.0, variance, 1.0)
    first = np.mean(b[..., None, :] * (ab - a[..., None, :]), axis=-1) / safe[..., None]
    total = 0.5 * np.mean((a[..., None, :] - ab) ** 2, axis=-1) / safe[..., None]
    varies = (variance > 0.0)[..., None]
    return np.where(varies, first, 0.0), np.where(varies, total, 0.0)


def sobol_indices(a: FloatArray, b: FloatArray, ab: FloatArray) -> SobolIndices:
    """Sobol' indices of one output.

    Parameters
    ----------
    a, b : array (N,)
        Output of the samples A and B.
    ab : array (k, N)
        Output of every AB_i.

    Notes
    -----
    First order: Saltelli et al. 2010, Computer Physics Communications 181, table 2 (b); total:
    Jansen 1999, the same table (f). Outputs are centred first, which lowers the scatter.
    """
    everything = np.concatenate([a, b, ab.ravel()])
    mean, spread = float(everything.mean()), float(everything.std())
    scale = spread if spread > 1e-14 * abs(mean) else np.inf
    a, b, ab = (a - mean) / scale, (b - mean) / scale, (ab - mean) / scale
    first, total = _indices(a, b, ab)
    picks = np.random.default_rng(0).integers(0, len(a), size=(_RESAMPLES, len(a)))
    again = _indices(a[picks], b[picks], np.moveaxis(ab[:, picks], 0, 1))
    half = [1.96 * np.std(values, axis=0, ddof=1) for values in again]
    return SobolIndices(first, total, half[0], half[1])
