"""The sensor chain: what encoder and torque sensor make of the joint's true motion.

All four signals of an episode pass the SAME anti-alias filter before they are sampled. A label
that is filtered otherwise than the inputs is a label that comes early or late, and a network
would learn the filters instead of the actuator. What differs is stated in the facts: the torque
sensor's own lag, and half a period of the velocity's difference.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import FloatArray

LEAST_OVERSAMPLING = 4
"""Acquisition over filter frequency, below which a digital filter is no longer the analogue one."""
MOST_ACQUISITION = 20_000.0
"""Hz; a drive that controls faster is read out no faster."""


@dataclass(frozen=True)
class Filter:
    """Low-pass of second order, causal.

    Attributes
    ----------
    frequency : float
        Undamped natural frequency, Hz.
    damping : float
        Ratio; 1 is critical: no overshoot, 24 degrees at 17 Hz for 80 Hz.
    """

    frequency: float = 80.0
    damping: float = 1.0

    def __post_init__(self) -> None:
        """Refuse a filter that cannot be."""
        for name in ("frequency", "damping"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise UsageError(f"the anti-alias filter's {name} {value:g} must be above 0.")

    def phase_lag(self, frequency: float) -> float:
        """Phase lag (rad) at a frequency, Hz, of the analogue filter."""
        r = frequency / self.frequency
        return math.atan2(2.0 * self.damping * r, 1.0 - r * r)

    @property
    def delay(self) -> float:
        """Group delay at low frequency, s."""
        return self.damping / (math.pi * self.frequency)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form, units in the names."""
        return {
            "filter": "second order, causal, the same for every signal",
            "filter_frequency_Hz": self.frequency,
            "filter_damping_ratio": self.damping,
            "filter_delay_s": self.delay,
        }

    def coefficients(self, rate: float) -> tuple[FloatArray, FloatArray]:
        """Numerator and denominator (3,) at a rate, Hz: bilinear, exact at its own frequency.

        Raises
        ------
        UsageError
            When the rate is too low for the filter.
        """
        if rate < LEAST_OVERSAMPLING * self.frequency * (1.0 - 1e-9):
            raise UsageError(
                f"an anti-alias filter of {self.frequency:g} Hz needs samples at "
                f"{LEAST_OVERSAMPLING * self.frequency:g} Hz or more, not {rate:g} Hz."
            )
        turn = 2.0 * math.pi * self.frequency / rate
        cosine, alpha = math.cos(turn), math.sin(turn) * self.damping
        top = np.array([0.5, 1.0, 0.5]) * (1.0 - cosine)
        bottom = np.array([1.0 + alpha, -2.0 * cosine, 1.0 - alpha])
        return top / bottom[0], bottom / bottom[0]

    def applied(self, values: FloatArray, rate: float) -> FloatArray:
        """Values (N,) at a rate (Hz) after the filter, which stood at the first value before."""
        from scipy.signal import lfilter, lfilter_zi

        top, bottom = self.coefficients(rate)
        start = lfilter_zi(top, bottom) * values[0]
        return np.asarray(lfilter(top, bottom, values, zi=start)[0], np.float64)


@dataclass(frozen=True)
class SensorChain:
    """Encoder, torque sensor, filter and sampling.

    Attributes
    ----------
    rate : float
        Of the samples of an episode, Hz.
    filter : Filter
        One for position, target, velocity, torque and current.
    torque_noise : float
        Standard deviation of a reading, N m, white at the acquisition rate: 0.05 % of a sensor
        for 200 N m.
    torque_bias : float
        N m.
    torque_lag : float
        Corner of the torque sensor's first-order lag, Hz.
    """

    rate: float = 200.0
    filter: Filter = Filter()
    torque_noise: float = 0.1
    torque_bias: float = 0.0
    torque_lag: float = 500.0

    def __post_init__(self) -> None:
        """Refuse a chain that cannot be."""
        if not (math.isfinite(self.rate) and self.rate > 0.0):
            raise UsageError(f"a sample rate of {self.rate:g} Hz must be above 0; 200 is usual.")
        if not (math.isfinite(self.torque_noise) and self.torque_noise >= 0.0):
            raise UsageError(f"a torque noise of {self.torque_noise:g} N*m must be 0 or more.")
        if not math.isfinite(self.torque_bias):
            raise UsageError(f"a torque bias of {self.torque_bias:g} N*m must be finite.")
        if not (math.isfinite(self.torque_lag) and self.torque_lag > 0.0):
            raise UsageError(f"a torque sensor's corner of {self.torque_lag:g} Hz must be above 0.")

    def acquisition(self, control_rate: float) -> tuple[float, int]:
        """Rate at which sensors are read (Hz), and readings a sample: that of the control.

        Where it is no whole multiple of the samples' rate, the nearest that is; never so slow
        that the filter cannot be built.
        """
        wanted = min(control_rate, MOST_ACQUISITION)
        least = math.ceil(LEAST_OVERSAMPLING * self.filter.frequency / self.rate)
        each = max(round(wanted / self.rate), least, 1)
        return self.rate * each, each

    def to_dict(self, control_rate: float, encoder_bits: int, ratio: float) -> dict[str, Any]:
        """The JSON form, units in the names."""
        rate, _ = self.acquisition(control_rate)
        count = 2.0 * math.pi / 2**encoder_bits / abs(ratio) if encoder_bits else 0.0
        lag = math.degrees(math.atan(17.0 / self.torque_lag))
        return {
            "sample_rate_Hz": self.rate,
            "acquisition_rate_Hz": rate,
            "position": "encoder on the motor shaft over the signed ratio, homed",
            "encoder_bits": encoder_bits,
            "position_count_rad": count,
            "velocity": "difference of two encoder readings over the acquisition period",
            "velocity_count_rad_per_s": count * rate,
            "velocity_delay_s": 0.5 / rate,
            "torque": "on the load, by a sensor at the output flange",
            "torque_noise_Nm": self.torque_noise,
            "torque_bias_Nm": self.torque_bias,
            "torque_lag_Hz": self.torque_lag,
            "torque_lag_at_17_Hz_deg": lag,
            "current": "of the motor, positive where it drives the joint forward",
            **self.filter.to_dict(),
            "filter_lag_at_17_Hz_deg": math.degrees(self.filter.phase_lag(17.0)),
            "flags": "wall and saturated: at any time since the sample before, not filtered",
        }


@dataclass(frozen=True, eq=False)
class Truth:
    """What the sensors look at, at a rate that is a whole multiple of the acquisition's.

    Attributes
    ----------
    rate : float
        Hz.
    motor_angle : array (M,)
        rad at the motor.
    target : array (M,)
        rad at the joint.
    torque : array (M,)
        On the load, N m.
    current : array (M,)
        Of the motor, A.
    wall, saturated : array (M,) of bool
    """

    rate: float
    motor_angle: FloatArray
    target: FloatArray
    torque: FloatArray
    current: FloatArray
    wall: NDArray[np.bool_]
    saturated: NDArray[np.bool_]


def measured(
    truth: Truth,
    chain: SensorChain,
    *,
    ratio: float,
    encoder_bits: int,
    control_rate: float,
    generator: np.random.Generator,
) -> dict[str, FloatArray]:
    """Columns of an episode from the true motion.

    Parameters
    ----------
    ratio : float
        Signed, motor over joint.
    encoder_bits : int
        Counts of a motor turn are 2^bits; 0 is ideal.
    control_rate : float
        Hz.
    generator : numpy Generator
        Of the torque sensor's noise.

    Returns
    -------
    dict of str to array (N,)
        position, target, velocity, torque, current, wall, saturated.

    Raises
    ------
    UsageError
        When the rates do not divide, or there is no whole sample.
    """
    rate, each = chain.acquisition(control_rate)
    fold = round(truth.rate / rate)
    if fold < 1 or abs(fold * rate - truth.rate) > 1e-6 * truth.rate:
        raise UsageError(
            f"records at {truth.rate:g} Hz are no whole multiple of readings at {rate:g} Hz."
        )
    readings = slice(fold - 1, None, fold)
    position = encoded(truth.motor_angle[readings], encoder_bits) / ratio
    velocity = np.diff(position, prepend=position[:1]) * rate
    torque = lagged(truth.torque, chain.torque_lag, truth.rate)[readings] + chain.torque_bias
    if chain.torque_noise > 0.0:
        torque = torque + generator.normal(0.0, chain.torque_noise, len(torque))
    signals = {
        "position": position,
        "target": truth.target[readings],
        "velocity": velocity,
        "torque": torque,
        "current": math.copysign(1.0, ratio) * truth.current[readings],
    }
    samples = slice(each - 1, None, each)
    count = len(position) // each
    if not count:
        raise UsageError(
            f"{len(truth.torque) / truth.rate:g} s hold no sample at {chain.rate:g} Hz; record "
            "longer."
        )
    found = {
        name: chain.filter.applied(values, rate)[samples][:count]
        for name, values in signals.items()
    }
    for name in ("wall", "saturated"):
        flags = getattr(truth, name)[: count * each * fold]
        found[name] = flags.reshape(count, -1).any(axis=1).astype(np.float64)
    return found


def encoded(motor_angle: FloatArray, bits: int) -> FloatArray:
    """Motor angles (N,) to the nearest count of the encoder, rad."""
    if not bits:
        return motor_angle
    count = 2.0 * math.pi / 2**bits
    return np.asarray(np.floor(motor_angle / count + 0.5) * count)


def lagged(values: FloatArray, corner: float, rate: float) -> FloatArray:
    """Values (N,) after a first-order lag that stood at the first value before; Hz."""
    from scipy.signal import lfilter

    kept = math.exp(-2.0 * math.pi * corner / rate)
    return np.asarray(lfilter([1.0 - kept], [1.0, -kept], values, zi=[kept * values[0]])[0])
