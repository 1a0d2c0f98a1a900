"""Stress over cycles, and damage summed over a duty (Palmgren and Miner)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
CyclesToFailure = Callable[[FloatArray], FloatArray]

_KNEE = 1e7
_STEEP, _STEEP_EXPONENT = 2.466, 0.056
_FLAT, _FLAT_EXPONENT = 1.4488, 0.023
_LONGEST = 1e30
"""Cycles that stand for no limit: the curves below have no endurance limit of their own."""

_PIN_KNEE, _PIN_SHORT = 1e6, 1e3
_PIN_SHORT_SHARE = 0.9


def contact_cycle_factor(cycles: ArrayLike) -> FloatArray:
    """Stress-cycle factor Z_N for pitting of steel (AGMA 2101-D04, figure 17).

    2.466 N^-0.056 up to 1e7 cycles, 1.4488 N^-0.023 beyond (the lower curve).

    Examples
    --------
    >>> print(contact_cycle_factor([1e4, 1e7, 1e10]).round(3))
    [1.472 1.    0.853]
    """
    n = np.asarray(cycles, dtype=float)
    steep = _STEEP * n**-_STEEP_EXPONENT
    return np.asarray(np.where(n <= _KNEE, steep, _FLAT * n**-_FLAT_EXPONENT))


def contact_cycles(pressure: ArrayLike, limit: float) -> FloatArray:
    """Cycles to pitting at a Hertz pressure: the inverse of ``p = limit Z_N``.

    Parameters
    ----------
    pressure : array_like
        Pa, not negative; zero never pits (1e30 cycles).
    limit : float
        Contact fatigue limit at 1e7 cycles, Pa, positive.
    """
    ratio = np.maximum(np.asarray(pressure, dtype=float) / limit, 1e-9)
    at_knee = float(contact_cycle_factor(_KNEE))
    steep = (_STEEP / ratio) ** (1.0 / _STEEP_EXPONENT)
    with np.errstate(over="ignore"):
        flat = (_FLAT / ratio) ** (1.0 / _FLAT_EXPONENT)
    return np.asarray(np.minimum(np.where(ratio >= at_knee, steep, flat), _LONGEST))


def pin_cycles(stress: ArrayLike, limit: float, ultimate: float) -> FloatArray:
    """Cycles to failure of a pin in bending.

    A straight line in logarithms from 0.9 S_u at 1e3 cycles to the limit at 1e6, none below the
    limit (Shigley and Mischke, Mechanical Engineering Design, sections 6-8 and 6-9).

    Parameters
    ----------
    stress : array_like
        Greatest bending stress of a cycle, Pa.
    limit : float
        Endurance limit of such cycles, Pa, positive.
    ultimate : float
        S_u, Pa.
    """
    s = np.asarray(stress, dtype=float)
    short = _PIN_SHORT_SHARE * ultimate
    slope = np.log10(_PIN_KNEE / _PIN_SHORT) / np.log10(short / limit)
    with np.errstate(divide="ignore"):
        finite = _PIN_KNEE * (limit / np.where(s > 0.0, s, limit)) ** slope
    return np.asarray(np.where(s > limit, finite, _LONGEST))


def damage_rate(
    stress: FloatArray, cycles_per_hour: FloatArray, to_failure: CyclesToFailure
) -> float:
    """Damage per hour of a duty by the linear rule of Palmgren and Miner.

    Parameters
    ----------
    stress, cycles_per_hour : array (C,)
        Of every load case, the share of time already in the cycles.
    to_failure : callable
        Cycles to failure over stress.
    """
    return float(np.sum(cycles_per_hour / to_failure(stress)))


def stress_reserve(
    stress: FloatArray, cycles_per_hour: FloatArray, to_failure: CyclesToFailure, hours: float
) -> float:
    """Factor on all stresses of a duty at which it lasts just `hours`; 1e6 without any stress."""
    if not np.any((stress > 0.0) & (cycles_per_hour > 0.0)):
        return 1e6
    low, high = 1e-6, 1e6
    for _ in range(200):
        middle = float(np.sqrt(low * high))
        if damage_rate(middle * stress, cycles_per_hour, to_failure) * hours > 1.0:
            high = middle
        else:
            low = middle
        if high <= low * (1.0 + 1e-12):
            break
    return low
