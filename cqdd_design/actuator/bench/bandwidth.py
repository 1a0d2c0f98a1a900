"""Bandwidths: torque by chirp against a locked output, position by stepped sine."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.bench.steady import cold, safe_step, with_voltage
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.scenario import Chirp, Command, Load, Scenario, Sine
from cqdd_design.actuator.simulate import simulate

_DOWN = 10.0 ** (-3.0 / 20.0)


def torque_bandwidth(parameters: ActuatorParameters, amplitude: float = 5.0) -> Metric:
    """Locked output, torque chirp, H1 with coherence, -3 dB below the low-frequency gain."""
    from scipy import signal

    first, last, duration = 0.5, 300.0, 12.0
    scene = Scenario(
        Command("torque", Chirp(amplitude, first, last, duration)),
        Load.locked(stiffness=5.0 * parameters.gear.stiffness, damping=10.0),
    )
    step = safe_step(parameters, scene)
    every = max(1, round(5e-4 / step))
    run = simulate(cold(parameters), scene, duration, step, every=every)
    rate = 1.0 / (step * every)
    asked, given = run.commanded_torque[0], run.output_torque[0]
    length = min(4096, len(asked) // 4)
    frequency, cross = signal.csd(asked, given, rate, nperseg=length)
    _, power = signal.welch(asked, rate, nperseg=length)
    _, coherence = signal.coherence(asked, given, rate, nperseg=length)
    used = (frequency >= 2.0 * first) & (frequency <= 0.9 * last)
    frequency, coherence = frequency[used], coherence[used]
    response = np.asarray(cross / np.where(power > 0.0, power, 1.0))[used]
    gain, phase = np.abs(response), np.unwrap(np.angle(response))
    low = float(gain[frequency <= 4.0].mean())
    edge = crossing(frequency, gain / low, _DOWN)
    quarter = crossing(frequency, phase, -0.5 * math.pi)
    coherent = crossing(frequency, coherence, 0.8)
    return Metric(
        "torque_bandwidth",
        edge,
        "predicted",
        f"Output locked, torque chirp of {amplitude:g} N m from {first:g} to {last:g} Hz, H1 by "
        "Welch's method, -3 dB below the gain under 4 Hz.",
        details={
            "low_frequency_gain": low,
            "phase_90_deg_Hz": quarter,
            "coherence_falls_below_0.8_Hz": coherent,
        },
        trace={
            "frequency [Hz]": frequency,
            "gain": gain,
            "phase [rad]": phase,
            "coherence": coherence,
        },
    )


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
    """Stepped sine of an impedance loop: gain of the fundamental at each frequency."""
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
    inertia = parameters.reflected_inertia
    speed = voltage / parameters.motor.torque_constant / abs(parameters.gear.ratio)
    torque = parameters.drive.current_limit * parameters.motor.torque_constant
    torque *= abs(parameters.gear.ratio)
    # The fundamental of a square wave is 4/pi of it, and -3 dB is amplitude over sqrt 2.
    by_speed = speed * 4.0 / math.pi * math.sqrt(2.0) / (2.0 * math.pi * amplitude)
    by_torque = math.sqrt(torque * 4.0 / math.pi * math.sqrt(2.0) / (inertia * amplitude))
    name = "position_bandwidth_45deg" if amplitude_deg > 20.0 else "position_bandwidth_5deg"
    return Metric(
        name,
        crossing(frequencies, gain / gain[0], _DOWN),
        "not comparable",
        f"Stepped sine of {amplitude_deg:g} deg amplitude, impedance control with "
        f"{parameters.drive.position_gain:g} N m/rad and {parameters.drive.velocity_gain:g} "
        f"N m s/rad at {voltage:g} V, output free; gain of the fundamental, -3 dB. The paper gives "
        "no gains.",
        details={
            "limit_by_speed_Hz": by_speed,
            "limit_by_torque_Hz": by_torque / (2.0 * math.pi),
            "voltage_V": voltage,
            "position_gain_Nm_per_rad": parameters.drive.position_gain,
            "velocity_gain_Nms_per_rad": parameters.drive.velocity_gain,
        },
        trace={
            "frequency [Hz]": frequencies,
            "gain": gain,
            "phase [rad]": np.array(delays),
        },
    )
