"""What a log tells about its own units: angles, speeds, sample time, gains, signs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import FloatArray, asked_torque

MOST_ANGLE = 50.0
"""rad; eight turns of a joint. Degrees and motor counts lie beyond."""
SAMPLE_TIMES = (1e-5, 0.1)
"""s; of logs that hold a joint's dynamics."""
FACTORS: Mapping[float, str] = {
    180.0 / math.pi: "velocity in deg/s (units velocity=deg/s)",
    math.pi / 180.0: "position in degrees (units position=deg,target=deg)",
    30.0 / math.pi: "velocity in rpm (units velocity=rpm)",
    1000.0: "a sample time 1000 times too long (--dt, units time=ms)",
    0.001: "a sample time 1000 times too short (--dt)",
    -1.0: "velocity of the opposite sign",
}
"""Velocity over the derivative of position, and what makes it so."""
_KNOWN, _TRUSTED, _OFF = 0.03, 0.5, 0.1
"""How near to a known factor, how much of the variance explained, how far from 1 is a warning."""
_REFUSED = 2.0
"""Factor, or its inverse, from which a log is refused."""


def check_time(name: str, times: FloatArray) -> float:
    """Median sample time (s) of a log's time column, s.

    Raises
    ------
    UsageError
        When time does not rise, naming the line, or its steps are no sample time of a joint.
    """
    if len(times) < 3:
        raise UsageError(f"{name} has {len(times)} samples; a record needs 3 at least.")
    steps = np.diff(times)
    bad = np.flatnonzero(steps <= 0.0)
    if len(bad):
        place = int(bad[0]) + 1
        raise UsageError(
            f"{name}, line {place + 2}: time {times[place]:g} s does not rise after "
            f"{times[place - 1]:g} s; sort the log, or remove doubled lines."
        )
    dt = float(np.median(steps))
    low, high = SAMPLE_TIMES
    if not low <= dt <= high:
        unit = next((u for u, f in (("ms", 1e-3), ("us", 1e-6)) if low <= dt * f <= high), None)
        fix = f"; if time is in {unit}, give --units time={unit}" if unit else ""
        raise UsageError(
            f"{name}: its samples are {dt:g} s apart, which is no sample time of a joint "
            f"({low:g} to {high:g} s){fix}."
        )
    return dt


def check_signals(
    name: str,
    columns: Mapping[str, FloatArray],
    dt: float,
    *,
    position_gain: float,
    velocity_gain: float,
) -> tuple[str, ...]:
    """Compare a log's signals with each other, in SI.

    Parameters
    ----------
    columns : mapping
        Position, target, velocity, torque of one uninterrupted piece.
    dt : float
        s.

    Returns
    -------
    tuple of str
        Warnings.

    Raises
    ------
    UsageError
        For angles that no joint turns to, and a velocity that is another multiple of the
        derivative of position, naming the factor and what makes it so.
    """
    for signal in ("position", "target"):
        most = float(np.max(np.abs(columns[signal])))
        if most > MOST_ANGLE:
            raise UsageError(
                f"{name}: {signal} reaches {most:g} rad, {most / (2.0 * math.pi):.0f} turns of the "
                f"joint; if it is in degrees, give --units {signal}=deg; a motor's angle must be "
                "divided by the ratio first."
            )
    warnings = []
    found = velocity_factor(columns["position"], columns["velocity"], dt)
    if found is not None:
        factor, explained = found
        if explained < _TRUSTED:
            warnings.append(
                f"{name}: velocity is not the derivative of position (it explains "
                f"{explained:.0%} of it); check both columns."
            )
        elif not 1.0 / _REFUSED < factor < _REFUSED:
            causes = [text for known, text in FACTORS.items() if abs(factor / known - 1.0) < _KNOWN]
            cause = causes[0] if causes else "other units, a motor's side, or a wrong sample time"
            raise UsageError(
                f"{name}: velocity is {factor:.4g} times the derivative of position, which looks "
                f"like {cause}; correct --units, --dt or the columns."
            )
        elif abs(factor - 1.0) > _OFF:
            warnings.append(
                f"{name}: velocity is {factor:.4g} times the derivative of position; a sample time "
                "that is off by that much, or a filtered velocity, makes it so."
            )
    asked = asked_torque(columns, position_gain, velocity_gain)
    torque = columns["torque"]
    if np.ptp(torque) == 0.0 and np.ptp(columns["position"]) > 0.0:
        warnings.append(
            f"{name}: torque stays at {torque[0]:g} N*m while the joint moves, so that nothing can "
            "be learned from it; check the column, and whether the drive was on."
        )
    if np.std(asked) > 0.0 and np.std(torque) > 0.0:
        likeness = float(np.corrcoef(asked, torque)[0, 1])
        slope = likeness * float(np.std(torque) / np.std(asked))
        if likeness < -0.5:
            warnings.append(
                f"{name}: torque has the opposite sign of gains times errors; a positive position "
                "error must ask for a positive torque, so turn the sign of torque or of the angles."
            )
        elif likeness > 0.7 and not 0.1 < slope < 10.0:
            warnings.append(
                f"{name}: torque is {slope:.3g} times what the gains ask for; check the gains and "
                "the units of torque and angles."
            )
    return tuple(warnings)


def check_limit(torques: Sequence[FloatArray], limit: float) -> tuple[str, ...]:
    """A warning where recorded torques (N m) are beyond what the joint can be asked for (N m).

    Short ones may be: a wall or the load pushes back, or the sensor is noisy.
    """
    every = np.abs(np.concatenate(torques))
    beyond = float(np.mean(every > limit * (1.0 + 1e-9)))
    if beyond == 0.0:
        return ()
    return (
        f"the logs reach {float(every.max()):.4g} N*m, beyond the torque limit of {limit:g} N*m "
        f"for {100.0 * beyond:.2g} % of the samples; torques asked for are cut there, so check "
        "--torque-limit unless a wall or the load pushed back.",
    )


def velocity_factor(
    position: FloatArray, velocity: FloatArray, dt: float
) -> tuple[float, float] | None:
    """Velocity over the derivative of position, and the share of variance that this explains.

    By differences over several samples, so that an encoder's counts do not drown the speed; None
    where nothing moves.
    """
    span = max(min(len(position) // 8, math.ceil(0.02 / dt)), 1)
    if len(position) <= 2 * span:
        return None
    moved = (position[span:] - position[:-span]) / (span * dt)
    sums = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]))])
    seen = (sums[span:] - sums[:-span]) / span
    power, own = float(np.mean(moved**2)), float(np.mean(seen**2))
    if power < 1e-12 or own < 1e-12:
        return None
    both = float(np.mean(moved * seen))
    return both / power, both**2 / (power * own)
