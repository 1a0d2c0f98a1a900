"""Causal acceleration: a slope of the last velocities, and what it does to a frequency."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import FloatArray


@dataclass(frozen=True)
class Differentiator:
    """Causal acceleration: one-sided Savitzky-Golay derivative of the velocity.

    Attributes
    ----------
    taps : tuple of float
        Weights of the newest, the one before, ... velocity, 1/s.
    delay : float
        Group delay at zero frequency, s.
    """

    taps: tuple[float, ...]
    delay: float


def savitzky_golay(dt: float, points: int = 5, order: int = 2) -> Differentiator:
    """Slope, at its newest point, of the polynomial through the last samples in least squares.

    Savitzky and Golay 1964, one-sided: no sample after the newest one takes part.

    Parameters
    ----------
    dt : float
        Sample time, s.
    points : int
        Samples that take part, 2 to 64.
    order : int
        Of the polynomial, 1 to ``points - 1``. From 2 on, the group delay at zero frequency is 0,
        and the noise is greater than that of order 1.

    Raises
    ------
    UsageError
        For numbers that make no such filter.
    """
    if not (math.isfinite(dt) and dt > 0.0):
        raise UsageError(f"a differentiator's sample time {dt:g} s must be above 0.")
    if not (2 <= points <= 64 and 1 <= order < points):
        raise UsageError(
            f"a differentiator of order {order} over {points} points does not exist; take 2 to 64 "
            "points and an order from 1 to one less than them, such as 5 and 2."
        )
    past = -np.arange(points, dtype=np.float64)
    taps = np.linalg.pinv(np.vander(past, order + 1, increasing=True))[1] / dt
    delay = -0.5 * float(np.sum(taps * (past * dt) ** 2))
    # What is left of a sum that is zero by construction.
    delay = 0.0 if abs(delay) < 1e-9 * dt else delay
    return Differentiator(tuple(float(tap) for tap in taps), delay)


def acceleration(velocity: FloatArray, differentiator: Differentiator) -> FloatArray:
    """Acceleration (N,), rad/s^2, of a velocity (N,), rad/s; before its start it stood still at it.

    Sample k depends on samples up to k only.
    """
    taps = np.asarray(differentiator.taps)
    velocity = np.asarray(velocity, np.float64)
    past = np.concatenate([np.full(len(taps) - 1, velocity[0]), velocity])
    return np.convolve(past, taps, mode="valid")


def differentiator_error(
    differentiator: Differentiator, dt: float, frequency: float
) -> dict[str, float]:
    """What a differentiator does to one frequency, Hz.

    Returns
    -------
    dict of str to float
        ``frequency`` (Hz), ``gain`` over that of a true derivative, ``phase`` ahead of it (rad),
        the ``delay`` (s) that this phase is, negative where the filter leads, and ``noise``:
        standard deviation of the acceleration over that of white noise of the velocity, 1/s.
    """
    if not 0.0 < frequency < 0.5 / dt:
        raise UsageError(
            f"{frequency:g} Hz is not between 0 and {0.5 / dt:g} Hz, half of the sample rate."
        )
    pulse = 2.0 * math.pi * frequency
    response = sum(
        tap * cmath.exp(-1j * pulse * dt * k) for k, tap in enumerate(differentiator.taps)
    )
    ratio = response / (1j * pulse)
    phase = cmath.phase(ratio)
    return {
        "frequency": frequency,
        "gain": abs(ratio),
        "phase": phase,
        "delay": -phase / pulse,
        "noise": math.sqrt(sum(tap**2 for tap in differentiator.taps)),
    }
