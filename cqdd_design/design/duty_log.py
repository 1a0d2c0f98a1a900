"""A duty over time: torque and speed at the output in rows, and what they come to in a cycle."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class DutyColumns:
    """Which columns of a file are the duty's: names, with the unit in brackets where need be.

    An empty name leaves the column to its usual names.
    """

    time: str = ""
    torque: str = ""
    speed: str = ""


@dataclass(frozen=True)
class DutyLog:
    """Torque and speed at the output over one cycle, which comes again and again.

    Between rows both go straight; the cycle ends with the last row. Equal logs come from equal
    files.

    Attributes
    ----------
    source : str
        Name of the file.
    digest : str
        Its sha256, and what was said of its columns.
    first_line : int
        Line of the file in which the first row stands.
    time, torque, speed : array (N,)
        s, rising from the first row; N m and rad/s with their signs.
    """

    source: str
    digest: str
    first_line: int = field(compare=False)
    time: FloatArray = field(compare=False, repr=False)
    torque: FloatArray = field(compare=False, repr=False)
    speed: FloatArray = field(compare=False, repr=False)

    @property
    def rows(self) -> int:
        """N."""
        return len(self.time)

    @property
    def cycle_time(self) -> float:
        """Of one cycle, s."""
        return float(self.time[-1] - self.time[0])

    @cached_property
    def weights(self) -> FloatArray:
        """Time that every row stands for, (N,), s: half of what lies before and after it."""
        half = 0.5 * np.diff(self.time)
        return np.asarray(np.concatenate([[0.0], half]) + np.concatenate([half, [0.0]]))

    @cached_property
    def figures(self) -> DutyFigures:
        """What a cycle comes to."""
        weight, torque, speed = self.weights, self.torque, self.speed
        power = torque * speed
        top = int(np.abs(torque).argmax())
        return DutyFigures(
            rows=self.rows,
            cycle_time=self.cycle_time,
            torque_rms=float(np.sqrt(weight @ torque**2 / self.cycle_time)),
            speed_rms=float(np.sqrt(weight @ speed**2 / self.cycle_time)),
            speed_mean=float(weight @ np.abs(speed) / self.cycle_time),
            torque_peak=float(torque[top]),
            torque_peak_at=float(self.time[top]),
            speed_peak=float(np.abs(speed).max()),
            energy_delivered=float(weight @ np.maximum(power, 0.0)),
            energy_returned=float(weight @ np.maximum(-power, 0.0)),
        )

    def line(self, row: int) -> int:
        """Line of the file in which a row stands."""
        return self.first_line + row


@dataclass(frozen=True)
class DutyFigures:
    """What one cycle comes to, at the output.

    Attributes
    ----------
    cycle_time : float
        s.
    torque_rms, torque_peak : float
        N m; the peak with its sign.
    torque_peak_at : float
        s.
    speed_rms, speed_mean, speed_peak : float
        Of the speed's size, rad/s.
    energy_delivered, energy_returned : float
        Work done on the load, and work that the load does on the actuator, in a cycle, J.
    """

    rows: int
    cycle_time: float
    torque_rms: float
    speed_rms: float
    speed_mean: float
    torque_peak: float
    torque_peak_at: float
    speed_peak: float
    energy_delivered: float
    energy_returned: float

    def to_dict(self) -> dict[str, float]:
        """Return the JSON form."""
        return {
            "rows": self.rows,
            "cycle_time_s": self.cycle_time,
            "torque_rms_Nm": self.torque_rms,
            "torque_peak_Nm": self.torque_peak,
            "torque_peak_at_s": self.torque_peak_at,
            "speed_rms_rad_per_s": self.speed_rms,
            "speed_mean_rad_per_s": self.speed_mean,
            "speed_peak_rad_per_s": self.speed_peak,
            "energy_delivered_J": self.energy_delivered,
            "energy_returned_J": self.energy_returned,
        }
