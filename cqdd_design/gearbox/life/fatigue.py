"""Stress over cycles, and damage summed over a duty (Palmgren and Miner)."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray

_KNEE = 1e7
_STEEP, _STEEP_EXPONENT = 2.466, 0.056
_FLAT, _FLAT_EXPONENT = 1.4488, 0.023
CURVE_BEGINS = 1e4
"""Cycles at which the pitting curve begins. Higher pressures yield rather than tire; the line is
carried on for them, and the life is then a number without support by the source."""

_PIN_KNEE, _PIN_SHORT = 1e6, 1e3
_KPSI = 6.894757e6
_FRACTION_RANGE = (70.0, 200.0)


def contact_cycle_factor(cycles: ArrayLike) -> FloatArray:
    """Stress-cycle factor Z_N for pitting of steel (AGMA 2101-D04, figure 17).

    2.466 N^-0.056 up to 1e7 cycles, 1.4488 N^-0.023 beyond (the lower of its two curves there).

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
        Pa, not negative; zero never pits (infinite cycles).
    limit : float
        Contact fatigue limit at 1e7 cycles, Pa, positive.
    """
    ratio = np.asarray(pressure, dtype=float) / limit
    at_knee = float(contact_cycle_factor(_KNEE))
    with np.errstate(over="ignore", divide="ignore"):
        steep = (_STEEP / ratio) ** (1.0 / _STEEP_EXPONENT)
        flat = (_FLAT / ratio) ** (1.0 / _FLAT_EXPONENT)
    return np.asarray(np.where(ratio >= at_knee, steep, flat))


def fatigue_strength_fraction(ultimate: float) -> float:
    """Reversed bending strength of steel at 1e3 cycles over its ultimate strength.

    1.06 - 2.8e-3 S + 6.9e-6 S^2 with S in kpsi, 70 to 200 kpsi; the value at the nearer end
    outside, as the curve is drawn to be 0.9 below (Budynas and Nisbett 2020, Shigley's Mechanical
    Engineering Design, 11th edition, section 6-9, fit of their figure of f over S_u).

    Parameters
    ----------
    ultimate : float
        S_u, Pa.

    Examples
    --------
    >>> round(fatigue_strength_fraction(120 * 6.894757e6), 3)
    0.823
    """
    s = min(max(ultimate / _KPSI, _FRACTION_RANGE[0]), _FRACTION_RANGE[1])
    return 1.06 - 2.8e-3 * s + 6.9e-6 * s * s


def pin_cycles(amplitude: ArrayLike, limit: float, ultimate: float) -> FloatArray:
    """Cycles to failure in reversed bending.

    A straight line in logarithms from f S_u at 1e3 cycles to the limit at 1e6, none below the
    limit (Budynas and Nisbett 2020, section 6-9: S = a N^b with a = (f S_u)^2/S_e and
    b = -log10(f S_u/S_e)/3). The line is carried on above f S_u, down to a single cycle.

    Parameters
    ----------
    amplitude : array_like
        Fully reversed stress, Pa; infinite breaks at once.
    limit : float
        Endurance limit S_e in reversed bending, Pa, positive and below f S_u.
    ultimate : float
        S_u, Pa.

    Examples
    --------
    The book's steel of 120 kpsi with S_e = 60 at 66 kpsi:

    >>> kpsi = 6.894757e6
    >>> print(float(pin_cycles(66 * kpsi, 60 * kpsi, 120 * kpsi)).__round__(-3))
    267000.0
    """
    s = np.asarray(amplitude, dtype=float)
    short = fatigue_strength_fraction(ultimate) * ultimate
    slope = np.log10(_PIN_KNEE / _PIN_SHORT) / np.log10(short / limit)
    finite = _PIN_KNEE * (limit / np.maximum(s, limit)) ** slope
    return np.asarray(np.where(s > limit, np.maximum(finite, 1.0), np.inf))


BROKEN = 100.0
"""Of S_u: told where a mean stress reaches it, which no reversed amplitude stands for."""


def goodman_reversed(low: ArrayLike, high: ArrayLike, ultimate: float) -> FloatArray:
    """Reversed amplitude as harmful as a cycle between two stresses: s_a/(1 - s_m/S_u).

    A compressive mean stress is given no credit (Goodman's line; Budynas and Nisbett 2020,
    section 6-14).

    Parameters
    ----------
    low, high : array_like
        Ends of the cycle, Pa.
    ultimate : float
        S_u, Pa.

    Returns
    -------
    array
        Pa; infinite where the mean stress reaches the ultimate strength.
    """
    ends = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    amplitude, mean = 0.5 * (ends[1] - ends[0]), 0.5 * (ends[0] + ends[1])
    left = 1.0 - np.maximum(mean, 0.0) / ultimate
    return np.asarray(
        np.divide(amplitude, left, out=np.full(amplitude.shape, np.inf), where=left > 1e-9)
    )


def goodman_pulsating(reversed_amplitude: float, ultimate: float) -> float:
    """Top of the cycle from zero that is as harmful as a reversed one: 2 s/(1 + s/S_u), Pa."""
    return 2.0 / (1.0 / reversed_amplitude + 1.0 / ultimate) if reversed_amplitude > 0.0 else 0.0


def rainflow(history: ArrayLike) -> list[tuple[float, float, float]]:
    """Cycles (low, high, count) of a stress history (ASTM E1049-85, section 5.4.4).

    Parameters
    ----------
    history : array_like (A,)
        Stresses in order. For a history that repeats, begin and end at its greatest value: every
        cycle is then closed but the largest, which is two halves.

    Examples
    --------
    The standard's own example:

    >>> for low, high, count in rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2]):
    ...     print(high - low, count)
    3.0 0.5
    4.0 0.5
    4.0 1.0
    8.0 0.5
    9.0 0.5
    8.0 0.5
    6.0 0.5
    """
    found: list[tuple[float, float, float]] = []
    left: list[float] = []
    for value in _turning_points(np.asarray(history, dtype=float)).tolist():
        left.append(value)
        while len(left) >= 3:
            before, last = abs(left[-2] - left[-3]), abs(left[-1] - left[-2])
            if last < before:
                break
            low, high = sorted(left[-3:-1])
            if len(left) == 3:
                found.append((low, high, 0.5))
                del left[0]
            else:
                found.append((low, high, 1.0))
                del left[-3:-1]
    for one, two in itertools.pairwise(left):
        found.append((min(one, two), max(one, two), 0.5))
    return found


def _turning_points(history: FloatArray) -> FloatArray:
    """Ends and reversals of a history, without ripples below a millionth of its range."""
    least = 1e-6 * float(np.ptp(history))
    steps = np.diff(history)
    moving = np.flatnonzero(steps)
    rises = steps[moving] > 0.0
    turns = moving[1:][rises[1:] != rises[:-1]]
    kept = [float(history[0])]
    for value in (*history[turns].tolist(), float(history[-1])):
        rising = len(kept) > 1 and kept[-1] > kept[-2]
        if len(kept) > 1 and (value >= kept[-1] if rising else value <= kept[-1]):
            kept[-1] = value
        elif abs(value - kept[-1]) > least:
            kept.append(value)
    return np.array(kept)


def damage_per_hour(
    stress: FloatArray, cycles_per_hour: FloatArray, to_failure: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Damage of every place under a duty by the linear rule of Palmgren and Miner.

    Parameters
    ----------
    stress : array (C, M, P)
        Of C load cases, M cycles and P places, Pa.
    cycles_per_hour : array (C,)
        Of each of the M cycles, the share of time already in them.
    to_failure : callable
        Cycles to failure over stress.

    Returns
    -------
    array (P,)
        1/h.
    """
    spent = np.sum(1.0 / to_failure(stress), axis=1)
    return np.asarray(cycles_per_hour @ spent)


def largest_factor(damage: Callable[[float], float], hours: float) -> float:
    """Factor on all stresses at which a place lasts just `hours`, to 1e-9.

    Parameters
    ----------
    damage : callable
        Damage per hour over the factor, rising, and above 1/hours for some factor.
    hours : float
        Required life.
    """
    low, high = 1e-6, 1e6
    while high > low * (1.0 + 1e-9):
        middle = float(np.sqrt(low * high))
        if damage(middle) * hours > 1.0:
            high = middle
        else:
            low = middle
    return low
