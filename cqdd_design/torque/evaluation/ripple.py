"""Torque ripple in an estimate: amplitude, frequency and phase by cross-spectra.

Welch (1967): segments of 0.64 s that overlap by half, a straight line taken off, Hann window.
Only segments of free swing count, since a blow on the wall fills the same band. All quantities
are functions of sums over segments, so episodes can be resampled without a new transform.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.evaluation.bootstrap import Interval, circular_interval, interval

ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]

BAND = (10.0, 25.0)
"""Of the paper's ripple at the output (17.2 to 20 Hz), Hz."""
SEGMENT = 0.64
"""s."""
FLANK_SEGMENT = 0.4
"""Where torque and velocity must keep their sign, which they seldom do for longer, s."""
ORDERS = np.arange(4, 61)
"""Periods in one turn of the output that the order spectrum tells apart."""
_STROKE_SPEED, _STROKE_SPAN = 0.3, 1.0
"""A stroke is faster than this (rad/s) throughout and at least so long (rad)."""


@dataclass(frozen=True, eq=False)
class Spectra:
    """Sums over the segments of each episode.

    Attributes
    ----------
    frequency : array (F,)
        Hz.
    label, estimate : array (E, F)
        One-sided power densities, N^2 m^2/Hz, times the segments.
    cross : array (E, F)
        Conjugate of the label times the estimate: its angle is positive where the estimate leads.
    segments : array (E,)
    moments : array (E, 3)
        Count, sum and sum of squares of the error over the segments' samples.
    """

    frequency: FloatArray
    label: FloatArray
    estimate: FloatArray
    cross: ComplexArray
    segments: FloatArray
    moments: FloatArray


@dataclass(frozen=True)
class Ripple:
    """The ripple band of an estimate against that of the label.

    Attributes
    ----------
    amplitude_label : float
        Of the sine that carries the band's power, N m.
    amplitude : Interval
        The estimate's.
    amplitude_error : Interval
        Estimate less label, N m: negative where ripple is lost.
    frequency_label : float
        Mean of the band weighted with power, Hz.
    frequency, frequency_error : Interval or None
        The estimate's, and by how much it is off; None for an estimate without any ripple.
    phase : Interval or None
        Of the estimate against the label, degrees; positive leads.
    coherence : float
        Share of the label's band that a filter could make from the estimate.
    error_rms : Interval
        Of the error within the band, N m.
    share : Interval or None
        Of the error's variance that lies in the band; None where there is no error.
    """

    amplitude_label: float
    amplitude: Interval
    amplitude_error: Interval
    frequency_label: float
    frequency: Interval | None
    frequency_error: Interval | None
    phase: Interval | None
    coherence: float
    error_rms: Interval
    share: Interval | None
    segments: int


@dataclass(frozen=True, eq=False)
class OrderSpectrum:
    """Amplitudes over order, as the output turns.

    Attributes
    ----------
    orders : array (K,)
        Periods in one turn of the output.
    label, estimate : array (K,)
        N m.
    phase : array (K,)
        Of the estimate against the label over the angle, degrees of the ripple's own period;
        positive: at a smaller angle.
    """

    orders: FloatArray
    label: FloatArray
    estimate: FloatArray
    phase: FloatArray
    strokes: int


def reaches(dt: float) -> bool:
    """Whether a sample time shows the ripple band at all."""
    return 0.5 / dt > 1.1 * BAND[1]


def spectra(
    labels: Sequence[FloatArray],
    estimates: Sequence[FloatArray],
    free: Sequence[Mask],
    dt: float,
    *,
    seconds: float = SEGMENT,
) -> Spectra:
    """Auto- and cross-spectra of every episode.

    Parameters
    ----------
    labels, estimates : sequences of array (N,)
        N m, finite.
    free : sequence of array (N,) of bool
        Samples of free swing; a segment counts where all of its samples are.
    dt : float
        s.
    seconds : float
        Length of a segment.
    """
    from scipy.signal import detrend

    size = max(round(seconds / dt), 8)
    window = np.asarray(np.hanning(size + 1)[:-1])
    scale = 2.0 * dt / float(np.sum(window**2))
    frequency = np.asarray(np.fft.rfftfreq(size, dt), np.float64)
    shape = (len(labels), len(frequency))
    label, estimate = np.zeros(shape), np.zeros(shape)
    cross = np.zeros(shape, np.complex128)
    counts, moments = np.zeros(len(labels)), np.zeros((len(labels), 3))
    for k, (y, p, mask) in enumerate(zip(labels, estimates, free, strict=True)):
        if len(y) < size:
            continue
        starts = np.arange(0, len(y) - size + 1, size // 2)
        starts = starts[sliding_window_view(mask, size)[starts].all(axis=1)]
        if not len(starts):
            continue
        cut_y = sliding_window_view(np.asarray(y, np.float64), size)[starts]
        cut_p = sliding_window_view(np.asarray(p, np.float64), size)[starts]
        turned_y = np.fft.rfft(detrend(cut_y, axis=1) * window)
        turned_p = np.fft.rfft(detrend(cut_p, axis=1) * window)
        label[k] = scale * np.sum(np.abs(turned_y) ** 2, axis=0)
        estimate[k] = scale * np.sum(np.abs(turned_p) ** 2, axis=0)
        cross[k] = scale * np.sum(np.conj(turned_y) * turned_p, axis=0)
        counts[k] = len(starts)
        error = cut_p - cut_y
        moments[k] = (error.size, error.sum(), np.sum(error**2))
    return Spectra(frequency, label, estimate, cross, counts, moments)


def _quantities(found: Spectra, weights: FloatArray) -> dict[str, FloatArray]:
    """All quantities of resamples (B, E), arrays (B,)."""
    inside = (found.frequency >= BAND[0]) & (found.frequency <= BAND[1])
    f = found.frequency[inside]
    df = float(found.frequency[1])
    with np.errstate(invalid="ignore", divide="ignore"):
        count = weights @ found.segments
        y = weights @ found.label[:, inside] / count[:, None]
        p = weights @ found.estimate[:, inside] / count[:, None]
        c = weights @ found.cross[:, inside] / count[:, None]
        # Rounding may leave less than nothing of the error of a perfect estimate.
        between = np.maximum(y + p - 2.0 * c.real, 0.0)
        label, estimate, error = (df * s.sum(axis=1) for s in (y, p, between))
        total, first, second = (weights @ found.moments).T
        variance = second / total - (first / total) ** 2
        through = np.where(p > 0.0, np.abs(c) ** 2 / np.where(p > 0.0, p, 1.0), 0.0)
        return {
            "amplitude_label": np.sqrt(2.0 * label),
            "amplitude": np.sqrt(2.0 * estimate),
            "frequency_label": y @ f / y.sum(axis=1),
            "frequency": p @ f / p.sum(axis=1),
            "phase": np.degrees(np.angle(c.sum(axis=1))),
            "coherence": through.sum(axis=1) / y.sum(axis=1),
            "error_rms": np.sqrt(error),
            "share": np.where(second > 0.0, error / variance, np.nan),
        }


def error_rms(found: Spectra, weights: FloatArray) -> FloatArray:
    """Error within the band of resamples (B, E), N m (B,)."""
    return _quantities(found, weights)["error_rms"]


def ripple(found: Spectra, weights: FloatArray) -> Ripple | None:
    """The band's quantities with intervals; None where no segment swings freely or all is still.

    Weights (B, E) are those of `bootstrap.draws`.
    """
    episodes = int(np.sum(found.segments > 0.0))
    if not episodes:
        return None
    alone, many = (_quantities(found, one) for one in (np.ones((1, len(weights[0]))), weights))
    for told in (alone, many):
        for name in ("amplitude", "frequency"):
            told[f"{name}_error"] = told[name] - told[f"{name}_label"]
    whole = {name: float(values[0]) for name, values in alone.items()}
    if not whole["amplitude_label"] > 0.0:
        return None
    ends = {
        name: interval(value, many[name], episodes=episodes)
        for name, value in whole.items()
        if not math.isnan(value)
    }
    silent = not whole["amplitude"] > 0.0
    return Ripple(
        amplitude_label=whole["amplitude_label"],
        amplitude=ends["amplitude"],
        amplitude_error=ends["amplitude_error"],
        frequency_label=whole["frequency_label"],
        frequency=ends.get("frequency"),
        frequency_error=ends.get("frequency_error"),
        phase=None
        if silent
        else circular_interval(whole["phase"], many["phase"], episodes=episodes),
        coherence=whole["coherence"],
        error_rms=ends["error_rms"],
        share=ends.get("share"),
        segments=int(found.segments.sum()),
    )


def mean_amplitudes(found: Spectra) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Frequencies (F,) and amplitude densities of label and estimate, N m/sqrt(Hz)."""
    count = max(float(found.segments.sum()), 1.0)
    label, estimate = found.label.sum(axis=0) / count, found.estimate.sum(axis=0) / count
    return found.frequency, np.sqrt(label), np.sqrt(estimate)


@dataclass(frozen=True, eq=False)
class Stroke:
    """A swing in one sense, and what turns its samples into amplitudes by order.

    Attributes
    ----------
    episode, begin, end : int
        Index of the episode, first sample and the one past the last.
    span : float
        rad.
    rising, grid : arrays (N,), (G,)
        Angle of the samples and of the even grid they are resampled to, rad.
    waves : array (2 K, G)
        Cosines and sines of `ORDERS` under a Hann window, scaled to amplitudes.
    """

    episode: int
    begin: int
    end: int
    span: float
    rising: FloatArray
    grid: FloatArray
    waves: FloatArray

    def amplitudes(self, values: FloatArray) -> ComplexArray:
        """Complex amplitudes (K,) of a signal of the whole episode."""
        resampled = np.interp(self.grid, self.rising, values[self.begin : self.end])
        found = self.waves @ _flattened(self.grid, resampled)
        return np.asarray(found[: len(ORDERS)] - 1j * found[len(ORDERS) :])


def strokes(episodes: Sequence[Episode], free: Sequence[Mask]) -> tuple[Stroke, ...]:
    """Strokes of free swing that are fast and long enough to tell orders apart."""
    found = []
    for k, (episode, mask) in enumerate(zip(episodes, free, strict=True)):
        velocity = np.asarray(episode.columns["velocity"], np.float64)
        position = np.asarray(episode.columns["position"], np.float64)
        for begin, end in _ranges(velocity, mask):
            angle = position[begin:end]
            sense = 1.0 if angle[-1] > angle[0] else -1.0
            rising = np.maximum.accumulate(sense * angle)
            span = float(rising[-1] - rising[0])
            if span < _STROKE_SPAN:
                continue
            grid = np.linspace(rising[0], rising[-1], 2 * (end - begin))
            window = np.hanning(len(grid))
            turn = np.multiply.outer(ORDERS, sense * grid)
            waves = np.concatenate([np.cos(turn), np.sin(turn)]) * (2.0 * window / window.sum())
            found.append(Stroke(k, begin, end, span, rising, grid, waves))
    return tuple(found)


def order_spectrum(
    swings: Sequence[Stroke], labels: Sequence[FloatArray], estimates: Sequence[FloatArray]
) -> OrderSpectrum | None:
    """Amplitudes by order over all strokes, weighted by their spans; None without strokes.

    Each stroke is resampled over the output's angle and freed of a parabola; an order is resolved
    to about one turn over the stroke's span.
    """
    if not swings:
        return None
    sums = np.zeros((3, len(ORDERS)), np.complex128)
    for one in swings:
        y, p = one.amplitudes(labels[one.episode]), one.amplitudes(estimates[one.episode])
        sums += one.span * np.array([np.abs(y) ** 2, np.abs(p) ** 2, np.conj(y) * p])
    label, estimate, cross = sums / sum(one.span for one in swings)
    return OrderSpectrum(
        orders=ORDERS.astype(np.float64),
        label=np.sqrt(label.real),
        estimate=np.sqrt(estimate.real),
        phase=np.degrees(np.angle(cross)),
        strokes=len(swings),
    )


def _ranges(velocity: FloatArray, mask: Mask) -> list[tuple[int, int]]:
    """Ranges of samples that move in one sense, fast enough and freely."""
    moving = np.where(mask & (np.abs(velocity) > _STROKE_SPEED), np.sign(velocity), 0.0)
    edges = np.flatnonzero(np.diff(moving)) + 1
    bounds = [0, *edges.tolist(), len(velocity)]
    return [(a, b) for a, b in pairwise(bounds) if moving[a] and b - a > 8]


def _flattened(x: FloatArray, y: FloatArray) -> FloatArray:
    """Values less their best parabola."""
    inner = (x - x.mean()) / (np.ptp(x) or 1.0)
    return np.asarray(y - np.polyval(np.polyfit(inner, y, 2), inner))
