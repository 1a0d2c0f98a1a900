"""What happens to an actuator in a simulation: signals over time, commands, loads.

Everything is frozen and says its own units; angles and torques of commands and loads count at the
output, positive counter-clockwise, voltages and currents at the motor's own terminals.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from cqdd_design.actuator.parameters import DriveParameters, FloatArray
from cqdd_design.errors import UsageError

CommandMode = Literal["open", "voltage", "current", "torque", "impedance", "position"]
FrictionModel = Literal["clip", "lugre"]
GRAVITY = 9.80665
"""Standard gravity, m/s^2."""


class Signal(Protocol):
    """A quantity over time."""

    def values(self, times: FloatArray) -> FloatArray:
        """Values (N,) at times (N,), s."""

    def rates(self, times: FloatArray) -> FloatArray:
        """Time derivatives (N,)."""


class _Finite:
    """A signal of finite numbers."""

    def __post_init__(self) -> None:
        """Refuse what is not finite."""
        for name, value in vars(self).items():
            if not np.all(np.isfinite(np.asarray(value, dtype=float))):
                raise UsageError(
                    f"{type(self).__name__}.{name} is {value}; signals need finite numbers."
                )


@dataclass(frozen=True)
class Constant(_Finite):
    """The same value always."""

    value: float = 0.0

    def values(self, times: FloatArray) -> FloatArray:
        """The value at all times."""
        return np.full(np.shape(times), self.value)

    def rates(self, times: FloatArray) -> FloatArray:
        """Zero."""
        return np.zeros(np.shape(times))


@dataclass(frozen=True)
class Ramp(_Finite):
    """``start + slope t``."""

    start: float
    slope: float

    def values(self, times: FloatArray) -> FloatArray:
        """Values at times, s."""
        return self.start + self.slope * np.asarray(times)

    def rates(self, times: FloatArray) -> FloatArray:
        """The slope."""
        return np.full(np.shape(times), self.slope)


@dataclass(frozen=True)
class Sine(_Finite):
    """``offset + amplitude sin(2 pi frequency t + phase)``; Hz and rad."""

    amplitude: float
    frequency: float
    offset: float = 0.0
    phase: float = 0.0

    def values(self, times: FloatArray) -> FloatArray:
        """Values at times, s."""
        turns = 2.0 * math.pi * self.frequency * np.asarray(times) + self.phase
        return np.asarray(self.offset + self.amplitude * np.sin(turns))

    def rates(self, times: FloatArray) -> FloatArray:
        """Their derivatives."""
        pulse = 2.0 * math.pi * self.frequency
        return np.asarray(self.amplitude * pulse * np.cos(pulse * np.asarray(times) + self.phase))


@dataclass(frozen=True)
class Chirp(_Finite):
    """A sine whose frequency rises from `first` to `last` (Hz) by a constant factor a second."""

    amplitude: float
    first: float
    last: float
    duration: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a sweep that does not move."""
        super().__post_init__()
        if not (self.first > 0.0 and self.last > self.first and self.duration > 0.0):
            raise UsageError(
                f"a chirp rises from above 0 Hz over some time, not from {self.first:g} to "
                f"{self.last:g} Hz in {self.duration:g} s."
            )

    def _phase(self, times: FloatArray) -> FloatArray:
        rate = math.log(self.last / self.first) / self.duration
        return np.asarray(2.0 * math.pi * self.first * np.expm1(rate * times) / rate)

    def values(self, times: FloatArray) -> FloatArray:
        """Values at times, s."""
        return np.asarray(self.offset + self.amplitude * np.sin(self._phase(np.asarray(times))))

    def rates(self, times: FloatArray) -> FloatArray:
        """Their derivatives."""
        t = np.asarray(times)
        pulse = 2.0 * math.pi * self.first * (self.last / self.first) ** (t / self.duration)
        return np.asarray(self.amplitude * pulse * np.cos(self._phase(t)))


@dataclass(frozen=True, eq=False)
class Sampled(_Finite):
    """Straight lines between samples, the first and last value held beyond them."""

    times: FloatArray
    samples: FloatArray

    def __post_init__(self) -> None:
        """Refuse samples that do not follow each other."""
        super().__post_init__()
        shape = np.shape(self.times)
        if len(shape) != 1 or not shape[0] or shape != np.shape(self.samples):
            raise UsageError("a sampled signal needs as many samples as times, one or more.")
        if np.any(np.diff(self.times) <= 0.0):
            raise UsageError("the times of a sampled signal must rise.")

    def values(self, times: FloatArray) -> FloatArray:
        """Values at times, s."""
        return np.asarray(np.interp(times, self.times, self.samples))

    def rates(self, times: FloatArray) -> FloatArray:
        """Slopes of the lines, zero beyond them."""
        if len(self.times) < 2:
            return np.zeros(np.shape(times))
        slopes = np.concatenate([[0.0], np.diff(self.samples) / np.diff(self.times), [0.0]])
        return np.asarray(slopes[np.searchsorted(self.times, times, side="right")])


@dataclass(frozen=True)
class Command:
    """What the drive is told.

    Attributes
    ----------
    mode : str
        "open" (phases open, no current), "voltage" (V at the motor), "current" (A in the motor),
        "torque" (N m at the output, by the nominal constant and ratio), "impedance" (rad at the
        output, the signal's rate fed forward) and "position" (rad, against the speed itself, with
        an integral).
    feedforward : Signal
        Torque added by impedance and position control, N m.
    position_gain, velocity_gain : float, optional
        N m/rad and N m s/rad at the output; default the drive's.
    integral_gain : float
        Of position control, N m/(rad s).
    """

    mode: CommandMode = "open"
    reference: Signal = field(default_factory=Constant)
    feedforward: Signal = field(default_factory=Constant)
    position_gain: float | None = None
    velocity_gain: float | None = None
    integral_gain: float = 0.0

    def gains(self, drive: DriveParameters) -> tuple[float, float]:
        """Position and velocity gain at the output, N m/rad and N m s/rad."""
        stiff, damped = self.position_gain, self.velocity_gain
        return (
            drive.position_gain if stiff is None else stiff,
            drive.velocity_gain if damped is None else damped,
        )


@dataclass(frozen=True)
class Wall:
    """A compliant, damped stop that only pushes (Hunt and Crossley 1975).

    Torque ``k d^n (1 + c d')``, never pulling, with the depth d beyond `angle`.

    Attributes
    ----------
    angle : float
        rad at the output.
    stiffness : float
        k, N m/rad^n.
    exponent : float
        n: 1.5 for a ball in a plane.
    damping : float
        c, s/rad.
    side : int
        1 where it stops positive motion, -1 where it stops negative motion.
    """

    angle: float
    stiffness: float
    exponent: float = 1.5
    damping: float = 0.2
    side: int = 1

    def __post_init__(self) -> None:
        """Refuse a wall that cannot be."""
        numbers = (self.angle, self.stiffness, self.exponent, self.damping)
        if not all(math.isfinite(value) for value in numbers):
            raise UsageError(f"a wall needs finite numbers, not {numbers}.")
        if not (self.stiffness > 0.0 and 1.0 <= self.exponent <= 4.0 and self.damping >= 0.0):
            raise UsageError(
                f"a wall needs a stiffness above 0, an exponent within 1 to 4 and damping of 0 or "
                f"more, not {self.stiffness:g}, {self.exponent:g} and {self.damping:g}."
            )
        if self.side not in (1, -1):
            raise UsageError(f"a wall stands on side 1 or -1, not {self.side}.")


@dataclass(frozen=True)
class Load:
    """What the output carries; use the constructors.

    Attributes
    ----------
    inertia : float
        kg m^2 about the output's axis.
    viscous : float
        N m s/rad.
    sensor_stiffness, sensor_damping : float
        Of a torque sensor to ground, N m/rad and N m s/rad; 0 is none.
    gravity_moment : float
        m g r of a pendulum that hangs at output angle 0, N m.
    torque : Signal
        From outside on the output, N m.
    speed : Signal, optional
        Of an output that is driven with all the torque it takes, rad/s.
    """

    inertia: float = 0.0
    viscous: float = 0.0
    sensor_stiffness: float = 0.0
    sensor_damping: float = 0.0
    gravity_moment: float = 0.0
    wall: Wall | None = None
    torque: Signal = field(default_factory=Constant)
    speed: Signal | None = None

    def __post_init__(self) -> None:
        """Refuse a load that cannot be."""
        for name in ("inertia", "viscous", "sensor_stiffness", "sensor_damping"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise UsageError(f"load.{name} {value:g} must be 0 or more; use 0 to leave it out.")
        if not math.isfinite(self.gravity_moment):
            raise UsageError(f"load.gravity_moment {self.gravity_moment:g} must be finite.")

    @classmethod
    def free(cls, torque: Signal | None = None) -> Load:
        """Nothing but the output's own inertia, and perhaps a torque."""
        return cls(torque=torque or Constant())

    @classmethod
    def locked(cls, stiffness: float = 5e4, damping: float = 0.0) -> Load:
        """Held to ground through a torque sensor (N m/rad, N m s/rad)."""
        return cls(sensor_stiffness=stiffness, sensor_damping=damping)

    @classmethod
    def flywheel(cls, inertia: float, viscous: float = 0.0, torque: Signal | None = None) -> Load:
        """An inertia (kg m^2) with viscous drag."""
        return cls(inertia=inertia, viscous=viscous, torque=torque or Constant())

    @classmethod
    def driven(cls, speed: Signal) -> Load:
        """The output turned from outside at a given speed (rad/s), whatever torque that takes."""
        return cls(speed=speed)

    @classmethod
    def pendulum(
        cls,
        mass: float,
        radius: float,
        *,
        bar_inertia: float = 0.0,
        viscous: float = 0.0,
        wall: Wall | None = None,
    ) -> Load:
        """A mass (kg) at a radius (m) that hangs at output angle 0, perhaps before a wall."""
        for name, value in (("mass", mass), ("radius", radius)):
            if not (math.isfinite(value) and value > 0.0):
                raise UsageError(f"a pendulum's {name} {value:g} must be above 0.")
        return cls(
            inertia=mass * radius**2 + bar_inertia,
            viscous=viscous,
            gravity_moment=mass * GRAVITY * radius,
            wall=wall,
        )


@dataclass(frozen=True)
class Start:
    """State at time 0; angles in rad, speeds in rad/s, current in A, temperatures in deg C.

    Left out, the motor stands where the unloaded gearbox puts it for the output's angle, turns
    with it, and winding and housing are at ambient temperature.
    """

    output_angle: float = 0.0
    output_speed: float = 0.0
    motor_angle: float | None = None
    motor_speed: float | None = None
    current: float = 0.0
    winding_temperature: float | None = None
    housing_temperature: float | None = None


@dataclass(frozen=True)
class Scenario:
    """One experiment.

    Attributes
    ----------
    friction : {"clip", "lugre"}
        Coulomb friction as the torque that stops the body within the step, as far as there is
        friction, or by LuGre's bristles.
    """

    command: Command = field(default_factory=Command)
    load: Load = field(default_factory=Load)
    start: Start = field(default_factory=Start)
    friction: FrictionModel = "clip"
