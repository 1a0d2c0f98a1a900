"""Rows of a data sheet that come from the gearbox: backlash, backdrive torque, ripple."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import numpy as np

from cqdd_design.actuator import joint_side
from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.actuator.bench.steady import run_cold
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray, GearParameters
from cqdd_design.actuator.scenario import (
    Command,
    Constant,
    Load,
    Ramp,
    Sampled,
    Scenario,
    Start,
)
from cqdd_design.actuator.simulate import Simulation

ARCMIN = 60.0 * 180.0 / math.pi
DIAL = 0.0127e-3
"""Least movement a dial gauge shows, m: half a thousandth of an inch (Gebler 1998)."""
DIAL_RADIUS = 0.1
"""Where the dial touches an arm on the output, m."""
_BROKEN_AWAY = 1.15
"""Torque by which most break away, over what is expected."""
_MOVING = 5e-4
"""Output speed above which it counts as broken away, rad/s."""
_LEAD, _BACK = 0.4, 2.0
"""Time onto a flank, and as long at rest; then to the other flank, s."""
_RETURNED = 2.0 * _LEAD + _BACK
_DIAL_SPACING = 5e-4
"""Between two records of the dial, s."""
_AT_REST = 0.01
"""Of a reading's whole motor angle: nearer to a flank the motor counts as resting there."""


def backlash(
    parameters: ActuatorParameters,
    drawn: Collection[ActuatorParameters] = (),
    positions: int = 6,
) -> Metric:
    """Gebler's method: turn the motor until the output moves, from either flank.

    Of drawn gearboxes the mean, each read in the same way.
    """
    own = _readings(parameters, positions)
    # The dead zone of a gearbox is one number here: two places of each are as good as six.
    others = [_readings(one, min(positions, 2)) for one in drawn]
    each = np.array([float(values.mean()) for values in others if values.size]) if others else own
    details = {
        "dead_zone_arcmin": parameters.gear.backlash * ARCMIN,
        "readings": float(own.size + sum(values.size for values in others)),
    }
    protocol = (
        f"Gebler: onto one flank, then the motor slowly back until a dial of {DIAL * 1e3:g} mm at "
        f"{DIAL_RADIUS * 1e3:g} mm moves, at {positions} places from both flanks; the dial's own "
        "threshold is taken off"
    )
    if others:
        details["perfect_parts_arcmin"] = float(own.mean()) if own.size else 0.0
        protocol += told_draws(len(others))
    shown = run_cold(parameters, _to_and_fro(parameters, positions)[0], _RETURNED, _DIAL_SPACING)
    return Metric(
        "backlash",
        float(each.mean()) if each.size else 0.0,
        # It says how large the clearances are that the design assumes, which nobody measured.
        "given",
        protocol + ".",
        spread=float(each.std(ddof=1)) if each.size > 1 else None,
        details=details,
        trace={
            "motor over ratio [rad]": shown.motor_angle[0] / parameters.gear.ratio,
            "output [rad]": shown.output_angle[0],
        },
    )


def told_draws(count: int) -> str:
    """What a protocol says of an ensemble."""
    return f"; mean and spread of {count} gearboxes drawn from the tolerances"


def _first_found(
    parameters: ActuatorParameters,
    scenes: Sequence[Scenario],
    durations: tuple[float, float],
    spacing: float,
    read: Callable[[Simulation, int], float | None],
) -> FloatArray:
    """What is read off each scene, in order, of those that show anything.

    All are run as far as the first duration, s, which is enough for most, and to the second one
    where nothing has been read yet: a run is the same, however long it goes on.
    """
    found: list[float | None] = [None] * len(scenes)
    for duration in durations:
        left = [i for i, value in enumerate(found) if value is None]
        if not left:
            break
        run = run_cold(parameters, [scenes[i] for i in left], duration, spacing)
        for place, i in enumerate(left):
            found[i] = read(run, place)
    return np.array([value for value in found if value is not None])


def _sweep(gear: GearParameters) -> float:
    """How far the motor is turned to either side of a place, rad at the output."""
    return gear.backlash + 6.0 * (DIAL / DIAL_RADIUS) + 2.0 / ARCMIN


def _to_and_fro(parameters: ActuatorParameters, positions: int) -> list[Scenario]:
    """Onto one flank, rest, then slowly off it and onto the other; both senses at every place."""
    times = np.array([0.0, _LEAD, 2.0 * _LEAD, _RETURNED])
    sweep = _sweep(parameters.gear)
    scenes = []
    for place in 2.0 * math.pi * np.arange(positions) / positions:
        for sense in (1.0, -1.0):
            path = place + sense * np.array([0.0, 1.0, 1.0, -1.0]) * sweep
            scenes.append(
                Scenario(
                    Command(
                        "position",
                        Sampled(times, path),
                        position_gain=40.0 * parameters.drive.position_gain,
                        velocity_gain=10.0 * parameters.drive.velocity_gain,
                        integral_gain=400.0 * parameters.drive.position_gain,
                    ),
                    Load.free(),
                    Start(output_angle=place),
                )
            )
    return scenes


def _readings(parameters: ActuatorParameters, positions: int) -> FloatArray:
    """Backlash at each place and from each flank, arcmin."""
    gear, threshold = parameters.gear, DIAL / DIAL_RADIUS

    def read(run: Simulation, i: int) -> float | None:
        rest = int(np.searchsorted(run.time, 1.9 * _LEAD))
        motor, output = run.motor_angle[i] / gear.ratio, run.output_angle[i]
        moved = np.flatnonzero(np.abs(output[rest:] - output[rest]) > threshold)
        if not moved.size:
            return None
        return float(abs(motor[rest + int(moved[0])] - motor[rest]) - threshold)

    # On the way back the output has moved once backlash and threshold are passed.
    passed = (gear.backlash + 2.0 * threshold) / (2.0 * _sweep(gear))
    durations = (2.0 * _LEAD + passed * _BACK, _RETURNED)
    scenes = _to_and_fro(parameters, positions)
    return _first_found(parameters, scenes, durations, _DIAL_SPACING, read) * ARCMIN


def dead_zone(motor: FloatArray, output: FloatArray) -> tuple[float, float, float] | None:
    """Where the motor turns back and where the output follows, and the output's angle between.

    From the angles (T,) of one reading in the order of time, the motor's over the ratio; all rad,
    the dial's own threshold taken off. None where the output never follows.
    """
    # The flank gone to first; the motor rests there until it turns back.
    first, last = sorted((int(motor.argmax()), int(motor.argmin())))
    near = np.abs(motor[first:last] - motor[first]) < _AT_REST * float(np.ptp(motor))
    if not near.any():
        return None
    resting = first + int(np.flatnonzero(near)[-1])
    threshold = DIAL / DIAL_RADIUS
    moved = np.flatnonzero(np.abs(output[resting:] - output[resting]) > threshold)
    if not moved.size:
        return None
    at = resting + int(moved[0])
    sense = math.copysign(threshold, float(motor[resting] - motor[at]))
    return float(motor[resting]), float(motor[at]) + sense, float(output[resting])


def backdrive_static(parameters: ActuatorParameters, positions: int = 12) -> Metric | None:
    """Phases open, torque on the output ramped until it breaks away; None where it never does."""
    ratio, motor = abs(parameters.gear.ratio), parameters.motor
    expected = joint_side.backdrive_static(parameters)
    if math.isinf(expected):
        return None
    slope, duration = max(0.8 * expected, 0.01), 2.5
    turn = 2.0 * math.pi / ratio
    scenes = [
        Scenario(
            Command("open"),
            Load.free(Ramp(0.0, sense * slope)),
            Start(output_angle=turn * place / positions),
        )
        for place in range(positions)
        for sense in (1.0, -1.0)
    ]
    # Within a well of cogging the motor gives way and does not break away.
    well = math.pi / motor.cogging_order if motor.cogging_amplitude > 0.0 else 0.0

    def read(run: Simulation, i: int) -> float | None:
        travel = np.abs(run.motor_angle[i] - run.motor_angle[i][0])
        fast = np.abs(run.motor_speed[i]) > _MOVING * ratio
        moving = np.flatnonzero(fast & (travel > well))
        if not moving.size:
            return None
        at = int(moving[0])
        # What it withstood is the torque at the crest of the cogging, not that past it.
        below = np.flatnonzero(travel[:at] <= 0.5 * well) if well else moving[:0]
        return float(slope * run.time[below[-1] if below.size else at])

    likely = min(_BROKEN_AWAY * expected / slope, duration)
    values = _first_found(parameters, scenes, (likely, duration), 1e-3, read)
    if not values.size:
        return None
    shown = run_cold(parameters, scenes[0], duration, 1e-3)
    return Metric(
        "backdrive_static",
        float(values.mean()),
        "predicted",
        f"Phases open, output torque ramped at {slope:.3g} N*m/s until the motor turns faster than "
        f"{_MOVING:g} rad/s of output{', out of its well of cogging' if well else ''}, at "
        f"{positions} places in both senses.",
        spread=float(values.std(ddof=1)) if values.size > 1 else None,
        details={"readings": float(values.size)},
        trace={
            "time [s]": shown.time,
            "output torque [N m]": slope * shown.time,
            "motor speed [rad/s]": shown.motor_speed[0],
        },
    )


def backdrive_dynamic(parameters: ActuatorParameters, speed: float = 1.0) -> Metric | None:
    """Phases open, the output turned slowly at a steady speed; None where it does not turn."""
    if parameters.friction.load_backward >= 1.0:
        return None
    # Brought up slowly: a jump would leave the motor swinging on the gearbox's stiffness.
    rise = 1.0
    slowly = Sampled(np.array([0.0, rise]), np.array([0.0, speed]))
    scene = Scenario(Command("open"), Load.driven(slowly))
    run = run_cold(parameters, scene, 1.5 * rise + 2.0, 1e-4)
    late = run.time > 1.5 * rise
    torque = -np.sign(speed) * run.output_torque[0][late]
    return Metric(
        "backdrive_dynamic",
        float(torque.mean()),
        "predicted",
        f"Phases open, output turned at {speed:g} rad/s, mean torque over 2 s.",
        spread=float(torque.std()),
        trace={
            "output angle [rad]": run.output_angle[0][late],
            "output torque [N m]": run.output_torque[0][late],
        },
    )


def torque_ripple(
    parameters: ActuatorParameters,
    drawn: Collection[ActuatorParameters] = (),
    speed: float = 1.0,
) -> Metric:
    """Steady speed and current: half of the peak-to-peak torque over each turn of the motor."""
    own = _ripple(parameters, speed)
    others = [_ripple(one, speed) for one in drawn]
    shown = others[0] if others else own
    current, gear = _current(parameters), parameters.gear
    meant = f" for about {gear.error_torque:g} N*m"
    if current >= parameters.drive.current_limit:
        meant = f", the most its driver gives and too little for {gear.error_torque:g} N*m"
    protocol = (
        f"Output at {speed:g} rad/s, {current:.3g} A in the motor{meant}: half of the "
        "peak-to-peak torque over each turn of the motor, mean over a turn of the output"
    )
    strongest = np.argsort(shown.amplitudes)[::-1][:5]
    details = {f"order_{int(shown.orders[k])}_Nm": float(shown.amplitudes[k]) for k in strongest}
    if others:
        details["perfect_parts_Nm"] = float(own.halves.mean())
        protocol += told_draws(len(others))
    each = np.array([one.halves.mean() for one in others]) if others else own.halves
    return Metric(
        "torque_ripple",
        float(each.mean()),
        "predicted",
        protocol + ".",
        spread=float(each.std(ddof=1)) if len(each) > 1 else None,
        details=details,
        trace={"order of the output": shown.orders, "amplitude [N m]": shown.amplitudes},
    )


class _Ripple(NamedTuple):
    """Half of the peak-to-peak of each motor turn, N m, and the spectrum in orders."""

    halves: FloatArray
    orders: FloatArray
    amplitudes: FloatArray


def _current(parameters: ActuatorParameters) -> float:
    """For the torque at which the kinematic error stands, friction under load included, A."""
    gear, friction = parameters.gear, parameters.friction
    at_motor = gear.error_torque * (1.0 + friction.load_forward) / abs(gear.ratio)
    return min(at_motor / parameters.motor.torque_constant, parameters.drive.current_limit)


def _ripple(parameters: ActuatorParameters, speed: float) -> _Ripple:
    gear, current = parameters.gear, _current(parameters)
    turning = math.copysign(speed, gear.ratio)
    whole, rise = 2.0 * math.pi / speed, 1.0
    # Brought up slowly: a jump would leave the motor swinging on the gearbox's stiffness.
    slowly = Sampled(np.array([0.0, rise]), np.array([0.0, current]))
    load, start = Load.driven(Constant(turning)), Start(output_speed=turning)
    scene = Scenario(Command("current", slowly), load, start)
    run = run_cold(parameters, scene, 1.5 * rise + whole, 1e-4)
    late = run.time > 1.5 * rise
    torque = run.output_torque[0][late]
    angle = np.abs(run.motor_angle[0][late] - run.motor_angle[0][late][0])
    turns = np.floor(angle / (2.0 * math.pi)).astype(int)
    halves = [0.5 * np.ptp(torque[turns == turn]) for turn in range(int(turns.max()))]
    # Every tooth of every lobe in a turn of the output, cogging, and what comes above.
    fastest = abs(gear.ratio) * max(abs(gear.ratio) + 1.0, float(parameters.motor.cogging_order))
    most = max(400, math.ceil(1.5 * fastest))
    spectrum = order_spectrum(angle / abs(gear.ratio), torque, min(most, len(torque) // 4))
    return _Ripple(np.array(halves), *spectrum)


def order_spectrum(
    angle: np.ndarray, torque: np.ndarray, most: int = 400
) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes (most,) at whole orders 1 to `most` of one turn of the output angle (rad)."""
    count = 4 * most
    even = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    reach = float(angle[-1])
    sampled = np.interp(even * min(reach / (2.0 * math.pi), 1.0), angle, torque)
    amplitudes = 2.0 * np.abs(np.fft.rfft(sampled - sampled.mean())) / count
    return np.arange(1, most + 1), amplitudes[1 : most + 1]
