"""A duty over time on an actuator: which rows it cannot follow, current, and electrical energy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.operating import DRIVER, PEAK, VOLTAGE, Needs, needs
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.design.duty_log import DutyLog

MOST_NAMED = 3
"""Rows outside that are named."""
_PIECE = 100_000
SLACK = 1.0 + 1e-9
"""Of a limit, for rounding."""
ASKED = "peak torque that is asked for"
"""The limit of the requirements, up to which parts are judged, beside those of motor and drive."""


@dataclass(frozen=True)
class OutsideRow:
    """The worst row of a stretch that lies outside.

    Attributes
    ----------
    line : int
        Of the duty's file.
    time, torque, speed : float
        s, N m and rad/s, with their signs.
    binding : tuple of str
        Limits that are exceeded.
    share : float
        What it asks of the worst of them, over the limit.
    """

    line: int
    time: float
    torque: float
    speed: float
    binding: tuple[str, ...]
    share: float

    @property
    def told(self) -> str:
        """Where it stands, what it asks, and what binds."""
        return (
            f"line {self.line} ({self.time:.6g} s): {self.torque:.4g} N*m at {self.speed:.4g} "
            f"rad/s, {' and '.join(self.binding)}"
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "line": self.line,
            "time_s": self.time,
            "torque_Nm": self.torque,
            "speed_rad_per_s": self.speed,
            "binding": list(self.binding),
            "share_of_limit": self.share,
        }


@dataclass(frozen=True)
class DutyPoints:
    """What a duty over time asks of motor and driver, the winding at its limit.

    Rows are outside where they are so with the winding at its limit or at ambient: cold magnets ask
    for more voltage at a speed, hot ones for more current at a torque.

    Attributes
    ----------
    rows, outside, stretches : int
        Rows, those of them outside, and the stretches without a break that these make.
    share_outside : float
        Of the time.
    named : tuple of OutsideRow
        The worst row of the worst stretches; where none is outside, the row nearest to a limit.
    current_rms : float
        A.
    heat : float
        Mean of friction and iron losses, W.
    energy_taken, energy_fed_back : float
        Electrical, at the motor's terminals in one cycle, J.
    """

    rows: int
    outside: int
    stretches: int
    share_outside: float
    named: tuple[OutsideRow, ...]
    current_rms: float
    heat: float
    energy_taken: float
    energy_fed_back: float

    @property
    def told(self) -> str:
        """Which rows are outside, and how many."""
        if not self.outside:
            nearest = self.named[0]
            return (
                f"all {self.rows} rows are inside; nearest to a limit, {100.0 * nearest.share:.3g} "
                f"% of it, is {nearest.told}"
            )
        more = self.stretches - len(self.named)
        return (
            f"{self.outside} of {self.rows} rows in {self.stretches} stretches, "
            f"{100.0 * self.share_outside:.3g} % of the time, the worst "
            + "; ".join(one.told for one in self.named)
            + (f"; and {more} more" if more else "")
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "rows_outside": self.outside,
            "stretches_outside": self.stretches,
            "time_share_outside": self.share_outside,
            "outside": [one.to_dict() for one in self.named] if self.outside else [],
            "current_rms_A": self.current_rms,
            "electrical_energy_taken_J": self.energy_taken,
            "electrical_energy_fed_back_J": self.energy_fed_back,
        }


@lru_cache(maxsize=4)
def duty_points(parameters: ActuatorParameters, log: DutyLog, peak: float = math.inf) -> DutyPoints:
    """Judge every row of a duty as a steady point; currents and heat are those of a hot winding.

    Parameters
    ----------
    peak : float
        Torque above which a row is outside too, N m.
    """
    weight = log.weights
    worst = np.empty(log.rows)
    squares = heat = taken = fed_back = 0.0
    for begin in range(0, log.rows, _PIECE):
        rows = slice(begin, begin + _PIECE)
        torque, speed = log.torque[rows], log.speed[rows]
        found = _asked(parameters, torque, speed)
        here, power = weight[rows], found.voltage * found.current
        worst[rows] = np.max(_worst_shares(parameters, torque, speed, peak), axis=1)
        squares += float(here @ found.current**2)
        heat += float(here @ found.heat)
        taken += float(here @ np.maximum(power, 0.0))
        fed_back += float(here @ np.maximum(-power, 0.0))
    beyond = worst > SLACK
    chosen, stretches = _worst_rows(worst, beyond)
    return DutyPoints(
        rows=log.rows,
        outside=int(beyond.sum()),
        stretches=stretches,
        share_outside=float(weight[beyond].sum() / log.cycle_time),
        named=tuple(_named(parameters, log, row, peak) for row in chosen),
        current_rms=float(np.sqrt(squares / log.cycle_time)),
        heat=heat / log.cycle_time,
        energy_taken=taken,
        energy_fed_back=fed_back,
    )


def _asked(
    parameters: ActuatorParameters, torque: FloatArray, speed: FloatArray, *, hot: bool = True
) -> Needs:
    """What rows ask; torque counts as positive where the motor drives."""
    sign = np.where(torque * speed < 0.0, -1.0, 1.0)
    thermal = parameters.thermal
    temperature = thermal.most if hot else thermal.ambient
    return needs(parameters, sign * np.abs(torque), np.abs(speed), temperature)


def _worst_shares(
    parameters: ActuatorParameters, torque: FloatArray, speed: FloatArray, peak: float
) -> FloatArray:
    """The greater of `_shares` hot and cold, and that of the peak torque, (M, 4)."""
    hot, cold = (_asked(parameters, torque, speed, hot=warm) for warm in (True, False))
    shares = np.maximum(_shares(parameters, hot), _shares(parameters, cold))
    return np.column_stack([shares, np.abs(torque) / peak])


def _shares(parameters: ActuatorParameters, found: Needs) -> FloatArray:
    """What is asked of driver, voltage and motor over what they give, (M, 3)."""
    drive, motor = parameters.drive, parameters.motor
    return np.stack(
        [
            np.abs(found.current) / drive.current_limit,
            np.abs(found.voltage) / drive.supply_voltage,
            np.abs(found.motor_torque) / motor.peak_torque,
        ],
        axis=1,
    )


def _worst_rows(worst: FloatArray, beyond: NDArray[np.bool_]) -> tuple[list[int], int]:
    """The worst row of the worst stretches outside, and how many stretches there are."""
    if not np.any(beyond):
        return [int(worst.argmax())], 0
    edges = np.flatnonzero(np.diff(np.concatenate([[0], beyond.astype(np.int8), [0]])))
    starts, ends = edges[::2], edges[1::2]
    tops = [int(begin + worst[begin:end].argmax()) for begin, end in zip(starts, ends, strict=True)]
    return sorted(tops, key=lambda row: -worst[row])[:MOST_NAMED], len(tops)


def _named(parameters: ActuatorParameters, log: DutyLog, row: int, peak: float) -> OutsideRow:
    here = slice(row, row + 1)
    shares = _worst_shares(parameters, log.torque[here], log.speed[here], peak)[0]
    names = np.array([DRIVER, VOLTAGE, PEAK, ASKED])
    exceeded = shares > SLACK
    binding = names[exceeded] if np.any(exceeded) else names[[int(shares.argmax())]]
    return OutsideRow(
        line=log.line(row),
        time=float(log.time[row]),
        torque=float(log.torque[row]),
        speed=float(log.speed[row]),
        binding=tuple(binding.tolist()),
        share=float(shares.max()),
    )
