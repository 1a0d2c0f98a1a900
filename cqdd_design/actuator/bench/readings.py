"""What is read off a record: play, stiffness and losses of a locked loop, friction over speed.

The same reading serves a record of hardware and a predicted one, so that what is compared is the
same quantity. A loop is one cycle of the torque asked for: up from nothing to its peak, down
through nothing to the negative peak, and back to nothing, the output locked.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.parameters import FloatArray
from cqdd_design.errors import UsageError

LOADED_FROM, LOADED_TO = 1.0 / 3.0, 0.9
"""Shares of the peak torque between which a rising branch is straight: beyond the take-up of the
play, and short of where a driver's limit rounds it off."""
_LEAST_SAMPLES = 8
"""On a branch or at one sense of speed, for a straight line."""


@dataclass(frozen=True)
class LoopReading:
    """One loop of motor position over motor torque, both at the output, the output locked.

    Attributes
    ----------
    peak : float
        Greatest torque, N m.
    play : float
        Width of the loop where the torque asked for passes zero, rad.
    stiffness : float
        Torque over angle on the loaded parts of both rising branches, N m/rad.
    reach : float
        Half of the angle between both peaks, rad.
    lost : float
        Work that a cycle leaves in the machine, J.
    """

    peak: float
    play: float
    stiffness: float
    reach: float
    lost: float

    @property
    def compliance(self) -> float:
        """Angle over torque, rad/(N m)."""
        return 1.0 / self.stiffness


def read_loop(command: ArrayLike, torque: ArrayLike, angle: ArrayLike) -> LoopReading:
    """Read a loop.

    Parameters
    ----------
    command : array_like (N,)
        Torque asked for in order of time, N m at the output; it tells the branches apart and may
        go beyond what the driver gives.
    torque : array_like (N,)
        Of the motor, N m at the output.
    angle : array_like (N,)
        Of the motor, rad at the output.

    Raises
    ------
    UsageError
        For a record that is no such loop, saying what is wrong with it.
    """
    asked, given, place = _columns(("command", command), ("torque", torque), ("angle", angle))
    top, bottom = int(np.argmax(asked)), int(np.argmin(asked))
    if not (0 < top < bottom < len(asked) - 1 and asked[bottom] < 0.0 < asked[top]):
        raise UsageError(
            "a locked loop asks for torque up to a peak, down to a negative one and back to "
            f"nothing; this record's greatest command of {asked[top]:g} N*m is its sample {top}, "
            f"its least of {asked[bottom]:g} N*m sample {bottom} of {len(asked)}."
        )
    down = top + int(np.argmin(np.abs(asked[top : bottom + 1])))
    peak = float(np.abs(given).max())
    if peak <= 0.0:
        raise UsageError("a locked loop without torque has no stiffness to read.")
    # From nothing to the peak, and from nothing to the negative one.
    branches = (
        _slope(given[: top + 1], place[: top + 1], peak),
        _slope(-given[down : bottom + 1], -place[down : bottom + 1], peak),
    )
    slope = 0.5 * sum(branches)
    if slope <= 0.0:
        raise UsageError(
            f"the loaded branches of the loop turn back by {-slope:.3g} rad a N*m: angle and "
            "torque must have one sign."
        )
    around = np.append(place, place[0])
    mean = 0.5 * (given + np.roll(given, -1))
    return LoopReading(
        peak=peak,
        play=float(place[down] - place[-1]),
        stiffness=1.0 / slope,
        reach=0.5 * float(place[top] - place[bottom]),
        lost=float(mean @ np.diff(around)),
    )


def _slope(torque: FloatArray, angle: FloatArray, peak: float) -> float:
    """Angle over torque where a rising branch is loaded, rad/(N m)."""
    loaded = (torque > LOADED_FROM * peak) & (torque < LOADED_TO * peak)
    if int(loaded.sum()) < _LEAST_SAMPLES:
        raise UsageError(
            f"a rising branch of the loop has {int(loaded.sum())} samples between "
            f"{LOADED_FROM * peak:.3g} and {LOADED_TO * peak:.3g} N*m; its slope needs "
            f"{_LEAST_SAMPLES}."
        )
    return float(np.polyfit(torque[loaded], angle[loaded], 1)[0])


@dataclass(frozen=True)
class FrictionLine:
    """Friction as a straight line over speed, the mean of both senses.

    Attributes
    ----------
    coulomb : float
        Where the line meets zero speed, N m.
    viscous : float
        Its slope, N m s/rad.
    """

    coulomb: float
    viscous: float

    @property
    def viscous_per_turn(self) -> float:
        """The slope over revolutions a second, N m s."""
        return 2.0 * math.pi * self.viscous


def read_friction(speed: ArrayLike, torque: ArrayLike, least: float) -> FrictionLine:
    """Read friction off a slow ramp of speed without load.

    Parameters
    ----------
    speed, torque : array_like (N,)
        At the output, rad/s and N m; with power going in they have one sign.
    least : float
        Slowest speed that counts, rad/s, above zero: below it the machine breaks away.

    Raises
    ------
    UsageError
        When a sense of rotation is missing or its friction is not above zero.
    """
    turning, given = _columns(("speed", speed), ("torque", torque))
    counted = [(sense, sense * turning > least) for sense in (1.0, -1.0)]
    for sense, counts in counted:
        if int(counts.sum()) < _LEAST_SAMPLES:
            raise UsageError(
                f"the record has {int(counts.sum())} samples faster than {sense * least:+.3g} "
                f"rad/s; a line of friction needs {_LEAST_SAMPLES} of either sense."
            )
    lines = []
    for sense, counts in counted:
        slope, start = np.polyfit(sense * turning[counts], sense * given[counts], 1)
        if start <= 0.0:
            raise UsageError(
                f"friction would drive the machine: {start:.3g} N*m at rest; speed and torque "
                "must have one sign where the motor drives."
            )
        lines.append((float(start), float(slope)))
    coulomb, viscous = np.mean(lines, axis=0)
    return FrictionLine(float(coulomb), float(viscous))


def _columns(*named: tuple[str, ArrayLike]) -> tuple[FloatArray, ...]:
    """Columns as arrays, refused where they are no record."""
    found = tuple(np.asarray(values, dtype=float) for _, values in named)
    lengths = {len(one) if one.ndim == 1 else -1 for one in found}
    if len(lengths) != 1 or lengths == {-1}:
        names = ", ".join(name for name, _ in named)
        raise UsageError(f"the columns {names} of a record must be of one length.")
    for (name, _), one in zip(named, found, strict=True):
        bad = np.flatnonzero(~np.isfinite(one))
        if len(bad):
            raise UsageError(f"{name} is {one[bad[0]]:g} in sample {bad[0]} of the record.")
    return found
