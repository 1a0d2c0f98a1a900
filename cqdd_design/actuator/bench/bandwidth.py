"""Bandwidths: torque by chirp against a locked output, position by stepped sine."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.bench.steady import cold, with_voltage
from cqdd_design.actuator.packing import safe_step
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.scenario import Chirp, Command, Load, Sampled, Scenario, Sine
from cqdd_design.actuator.simulate import simulate

DOWN = 10.0 ** (-3.0 / 20.0)
"""Gain at the edge of a bandwidth, over that of low frequencies: -3 dB."""
COHERENT = 0.8
"""Below it a transfer function is not to be trusted."""
_LOW = 4.0
"""Hz; the mean gain up to there is that of low frequencies."""
_FOLLOWS = 0.1
"""Least gain at the lowest frequency of a joint that follows at all."""
_SENSOR_DAMPING = 0.01
"""Ratio of the motor swinging on the sensor: steel with screwed flanges."""


def sensor(parameters: ActuatorParameters, stiffness: float | None = None) -> Load:
    """The output held through a rig of some stiffness, N m/rad.

    By default the one that was fitted, or that of a torque sensor rated for what the driver's limit
    gives, on a rigid rig.
    """
    gear = parameters.gear
    if stiffness is None:
        stiffness = parameters.rig.stiffness or parameters.sensor_stiffness
    swinging = parameters.motor_side_inertia * gear.ratio**2 + gear.output_inertia
    return Load.locked(stiffness, 2.0 * _SENSOR_DAMPING * math.sqrt(stiffness * swinging))


def saturation_limits(
    speed: float, torque: float, inertia: float, amplitude: float
) -> tuple[float, float]:
    """Frequencies above which a saturated position loop is more than 3 dB down, Hz.

    A limited speed or torque makes at most a square wave, whose fundamental is 4/pi of it; at
    -3 dB the output swings by amplitude over sqrt 2::

        f_w = (4/pi) w sqrt(2)/(2 pi A)            f_T = sqrt((4/pi) T sqrt(2)/(J A))/(2 pi)

    Parameters
    ----------
    speed, torque : float
        Limits at the output, rad/s and N m.
    inertia : float
        All that moves, at the output, kg m^2.
    amplitude : float
        rad.

    Returns
    -------
    tuple of float
        By speed, by torque.

    Examples
    --------
    With the values the paper measured (128.6 rpm at 24 V, 89.9 N m, 5.01e-4 kg m^2 at the motor):

    >>> from math import pi, radians
    >>> limits = lambda degrees: saturation_limits(
    ...     128.6 * pi / 30.0, 89.9, 5.01e-2, radians(degrees))
    >>> round(limits(45.0)[0], 1), round(limits(5.0)[1], 1)
    (4.9, 30.6)
    """
    swing = amplitude / math.sqrt(2.0)
    square = 4.0 / math.pi
    by_torque = math.sqrt(square * torque / (inertia * swing))
    return square * speed / (2.0 * math.pi * swing), by_torque / (2.0 * math.pi)


def torque_bandwidth(
    parameters: ActuatorParameters, amplitude: float = 5.0, rig_stiffness: float | None = None
) -> Metric:
    """Held output, torque chirp, H1 with coherence, -3 dB below the low-frequency gain.

    There is no value where friction holds the motor, nor where the coherence of chirp and torque
    falls below `COHERENT` before the gain has fallen by 3 dB: what a transfer function says there
    is not the actuator's.
    """
    first, last, chirping, settling = 0.5, 300.0, 12.0, 0.5
    duration = chirping + settling
    held = sensor(parameters, rig_stiffness)
    times = np.linspace(0.0, chirping, 120_001)
    chirp = Chirp(amplitude, first, last, chirping).values(times)
    scenes = [
        Scenario(
            Command("torque", Sampled(np.r_[times, duration], np.r_[sense * samples, 0.0])), held
        )
        for samples in (chirp, chirp[::-1])
        for sense in (1.0, -1.0)
    ]
    step = safe_step(parameters, *scenes)
    every = max(1, round(5e-4 / step))
    run = simulate(cold(parameters), scenes, duration, step, every=every)
    frequency, response, coherence = frequency_response(
        run.commanded_torque, run.output_torque, step * every, 2.0 * first, 0.9 * last
    )
    gain, phase = np.abs(response), np.unwrap(np.angle(response))
    # Each of the lowest bands holds a line or two of the chirp, so none of them ends a bandwidth.
    above = frequency > _LOW
    low = float(gain[~above].mean())
    held_fast = low <= 0.0
    edge = math.nan if held_fast else crossing(frequency[above], gain[above] / low, DOWN)
    sure = crossing(frequency, coherence, COHERENT)
    given = "fitted" if parameters.rig.stiffness else "a torque sensor"
    missing = ""
    if held_fast:
        missing = (
            f"friction holds motor and gearbox: of a chirp of {amplitude:g} N*m no torque reaches "
            "the output"
        )
    elif edge > sure:
        there = float(np.interp(sure, frequency, gain)) / low
        missing = (
            f"the coherence of the torque with the chirp falls below {COHERENT:g} at {sure:.3g} "
            f"Hz, where the gain is still {there:.3g} of that at low frequencies; play and "
            f"friction make the rest, so no -3 dB can be read with {amplitude:g} N*m"
        )
    elif not np.any(gain[above] < DOWN * low):
        missing = f"the gain has not fallen by 3 dB up to {frequency[-1]:.3g} Hz"
    return Metric(
        "torque_bandwidth",
        math.nan if missing else edge,
        "predicted",
        f"Output held by a rig of {held.sensor_stiffness:.3g} N*m/rad "
        f"({given if rig_stiffness is None else 'as given'}), torque chirp of "
        f"{amplitude:g} N*m from {first:g} to {last:g} Hz in {chirping:g} s, rising and falling in "
        "both senses, H1 over these and twelfths of an octave, -3 dB below the mean under "
        f"{_LOW:g} Hz, read only where the coherence is {COHERENT:g} or more up to there.",
        details={"sensor_stiffness_Nm_per_rad": held.sensor_stiffness}
        if held_fast
        else {
            "low_frequency_gain": low,
            "gain_falls_by_3_dB_Hz": edge,
            "phase_90_deg_Hz": crossing(frequency, phase, -0.5 * math.pi),
            f"coherence_falls_below_{COHERENT:g}_Hz": sure,
            "sensor_stiffness_Nm_per_rad": held.sensor_stiffness,
        },
        trace={}
        if held_fast
        else {
            "frequency [Hz]": frequency,
            "gain": gain,
            "phase [rad]": phase,
            "coherence": coherence,
        },
        missing=missing,
    )


def frequency_response(
    given: FloatArray, got: FloatArray, spacing: float, lowest: float, highest: float
) -> tuple[FloatArray, NDArray[np.complex128], FloatArray]:
    """H1 = Sxy/Sxx of whole records, averaged over them and over twelfths of an octave.

    Input and output (R, N) are at rest at both ends of each record; samples are `spacing` s apart.
    Frequencies (F,), Hz, even in logarithm, the response and its coherence, 0 to 1, come back.
    """
    x, y = np.fft.rfft(given, axis=1), np.fft.rfft(got, axis=1)
    line = np.fft.rfftfreq(given.shape[1], spacing)
    cross = (np.conj(x) * y).sum(axis=0)
    into, out = (np.abs(x) ** 2).sum(axis=0), (np.abs(y) ** 2).sum(axis=0)
    grid = np.geomspace(lowest, highest, 1 + round(12.0 * math.log2(highest / lowest)))
    half = 2.0 ** (1.0 / 24.0)
    begin = np.searchsorted(line, grid / half)
    end = np.maximum(np.searchsorted(line, grid * half), begin + 1)

    def banded(values: NDArray[Any]) -> NDArray[Any]:
        total = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(total[end] - total[begin])

    cross, into, out = banded(cross), banded(into), banded(out)
    coherence = np.abs(cross) ** 2 / np.maximum(into * out, 1e-300)
    return grid, cross / np.maximum(into, 1e-300), coherence


def crossing(frequency: FloatArray, values: FloatArray, level: float) -> float:
    """First frequency at which values fall through a level, by straight lines; the last if none."""
    below = np.flatnonzero(values < level)
    if not below.size:
        return float(frequency[-1])
    k = int(below[0])
    if k == 0:
        return float(frequency[0])
    span = values[k - 1] - values[k]
    share = (values[k - 1] - level) / span if span > 0.0 else 0.0
    return float(frequency[k - 1] + share * (frequency[k] - frequency[k - 1]))


def position_bandwidth(
    parameters: ActuatorParameters, amplitude_deg: float, voltage: float
) -> Metric:
    """Stepped sine of an impedance loop: gain of the fundamental at each frequency.

    There is no value where friction holds the output at the lowest of them.
    """
    supplied = with_voltage(parameters, voltage)
    amplitude = math.radians(amplitude_deg)
    frequencies = np.geomspace(0.5, 60.0 if amplitude_deg < 20.0 else 12.0, 28)
    periods, settle = 4, 4
    gains, delays = [], []
    scenes = [
        Scenario(Command("impedance", Sine(amplitude, float(f))), Load.free()) for f in frequencies
    ]
    for f, scene in zip(frequencies, scenes, strict=True):
        step = safe_step(parameters, scene)
        duration = (periods + settle) / float(f)
        every = max(1, int(1.0 / (float(f) * 200.0 * step)))
        run = simulate(cold(supplied), scene, duration, step, every=every)
        late = run.time > settle / float(f)
        turn = 2.0 * math.pi * float(f) * run.time[late]
        kernel = np.exp(-1j * turn)
        out = complex(np.mean(run.output_angle[0][late] * kernel))
        asked = complex(np.mean(amplitude * np.sin(turn) * kernel))
        gains.append(abs(out / asked))
        delays.append(float(np.angle(out / asked)))
    gain = np.array(gains)
    full_speed = voltage / parameters.motor.torque_constant / abs(parameters.gear.ratio)
    by_speed, by_torque = saturation_limits(
        full_speed,
        parameters.torque_limit,
        parameters.reflected_inertia,
        amplitude,
    )
    name = "position_bandwidth_45deg" if amplitude_deg > 20.0 else "position_bandwidth_5deg"
    missing, edge = "", math.nan
    if gain[0] >= _FOLLOWS:
        edge = crossing(frequencies, gain / gain[0], DOWN)
    else:
        push = parameters.drive.position_gain * amplitude
        missing = (
            f"friction holds the output: of {amplitude_deg:g} deg asked at {frequencies[0]:g} Hz "
            f"it follows {gain[0] * amplitude_deg:.2g} deg, with the {push:.3g} N*m that "
            f"{parameters.drive.position_gain:g} N*m/rad make of them; raise drive.position_gain"
        )
    return Metric(
        name,
        edge,
        "not comparable",
        f"Stepped sine of {amplitude_deg:g} deg amplitude, impedance control with "
        f"{parameters.drive.position_gain:g} N*m/rad and {parameters.drive.velocity_gain:g} "
        f"N*m*s/rad at {voltage:g} V, output free; gain of the fundamental, -3 dB.",
        details={
            "limit_by_speed_Hz": by_speed,
            "limit_by_torque_Hz": by_torque,
            "voltage_V": voltage,
            "position_gain_Nm_per_rad": parameters.drive.position_gain,
            "velocity_gain_Nms_per_rad": parameters.drive.velocity_gain,
        },
        trace={}
        if missing
        else {
            "frequency [Hz]": frequencies,
            "gain": gain,
            "phase [rad]": np.array(delays),
        },
        missing=missing,
    )
