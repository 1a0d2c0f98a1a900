"""Rigid-law loads of a design: maxima over the whole period, and curves over crank angle.

All discs share the torque equally. Maxima cover both senses of torque, every disc and the whole
period of each stage, and are refined until sampling no longer shows (1e-6 and better). Forces grow
with the torque and Hertz pressures with its root, so they are found once, at 1 N m.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

_SAMPLES_PER_RING_PERIOD = 96
_ZOOM_POINTS, _ZOOMS = 33, 3
_RIVALS = 4
"""Sampled peaks, highest first, that are refined before one is called the peak."""


def period_maximum(
    curve: Callable[[FloatArray], FloatArray],
    period: float,
    samples: int,
    sampled: FloatArray | None = None,
) -> float:
    """Greatest value of a periodic curve.

    Sampled, then the highest sampled peaks are resampled between their neighbours until the
    bracket is 2e-4 of a sample.

    Parameters
    ----------
    curve : callable
        Maps angles (A,) to values (A,).
    period : float
        rad.
    samples : int
        Points over the period; features narrower than two of them may be missed.
    sampled : array (samples,), optional
        The curve at those points, where it is cheaper to get together.
    """
    step = period / samples
    angle = np.asarray(step * np.arange(samples), dtype=float)
    value = curve(angle) if sampled is None else sampled
    peaks = np.flatnonzero((value >= np.roll(value, 1)) & (value >= np.roll(value, -1)))
    centre = angle[peaks[np.argsort(-value[peaks], kind="stable")][:_RIVALS]]
    best = float(value.max())
    offsets = np.linspace(-1.0, 1.0, _ZOOM_POINTS)
    for _ in range(_ZOOMS):
        grid = centre[:, None] + step * offsets
        found = curve(grid.ravel()).reshape(grid.shape)
        at = found.argmax(axis=1)
        centre = grid[np.arange(at.size), at]
        best = max(best, float(found.max()))
        step *= 2.0 / (_ZOOM_POINTS - 1)
    return best


@dataclass(frozen=True)
class RigidMaxima:
    """Maxima of the rigid law at one output torque, raw: no factor for uneven sharing.

    Attributes
    ----------
    torque : float
        Output torque they belong to, N m.
    ring_force, output_pin_force, cam_bearing_load : float
        N, of one disc.
    ring_pressure, output_pressure : float
        Hertz pressures, Pa.
    cam_load_by_disc : array (D,)
        Greatest cam bearing load of every disc, N.
    """

    torque: float
    ring_force: float
    output_pin_force: float
    cam_bearing_load: float
    ring_pressure: float
    output_pressure: float
    cam_load_by_disc: FloatArray

    def at(self, torque: float) -> RigidMaxima:
        """Return them at another torque (N m): forces scale with it, pressures with its root."""
        share = torque / self.torque
        return RigidMaxima(
            torque=torque,
            ring_force=share * self.ring_force,
            output_pin_force=share * self.output_pin_force,
            cam_bearing_load=share * self.cam_bearing_load,
            ring_pressure=share**0.5 * self.ring_pressure,
            output_pressure=share**0.5 * self.output_pressure,
            cam_load_by_disc=share * self.cam_load_by_disc,
        )

    def to_dict(self) -> dict[str, float]:
        """Return the JSON form (``rigid``)."""
        return {
            "torque_Nm": self.torque,
            "ring_force_max_N": self.ring_force,
            "output_pin_force_max_N": self.output_pin_force,
            "cam_bearing_load_max_N": self.cam_bearing_load,
            "ring_pressure_max_MPa": self.ring_pressure / 1e6,
            "output_pressure_max_MPa": self.output_pressure / 1e6,
        }


def rigid_maxima(stages: Stages, torque: float) -> RigidMaxima:
    """Maxima of forces, pressures and cam load over the period, both senses and all discs.

    Ring and pin maxima are those of any disc: over a whole period of its stage every disc sees
    the same values. The cam load depends on how the holes stand against the lobes, so it is
    found for every disc and both senses over the common period.

    Parameters
    ----------
    stages : Stages
        From :meth:`Stages.from_design`.
    torque : float
        Output torque, N m, positive.
    """
    return _maxima_at_one(astuple(stages)).at(torque)


@lru_cache(maxsize=4)
def _maxima_at_one(values: tuple[Any, ...]) -> RigidMaxima:
    """At 1 N m. Analysis, life and the cam's bearing of one design ask for the same."""
    stages = Stages(*values)
    n, pins = stages.lobe_count, stages.pin_count
    disc_torque = 1.0 / stages.disc_count
    ring_period = kinematics.ring_period(n)

    def ring_force(angle: FloatArray) -> FloatArray:
        return np.asarray(stages.ring_forces(disc_torque, angle).max(axis=-1))

    def ring_pressure(angle: FloatArray) -> FloatArray:
        forces = stages.ring_forces(disc_torque, angle)
        return np.asarray(stages.ring_pressures(forces, angle).max(axis=-1))

    def pin_force(angle: FloatArray) -> FloatArray:
        return np.asarray(stages.pin_forces(disc_torque, angle, 0.0).max(axis=-1))

    samples = 2 * _SAMPLES_PER_RING_PERIOD
    force = period_maximum(ring_force, ring_period, samples)
    pressure = period_maximum(ring_pressure, ring_period, samples)
    pin = period_maximum(pin_force, kinematics.output_period(n, pins), samples)
    cam = np.array([_cam_peak(stages, disc_torque, phase) for phase in stages.phases])
    return RigidMaxima(
        torque=1.0,
        ring_force=force,
        output_pin_force=pin,
        cam_bearing_load=float(cam.max()),
        ring_pressure=pressure,
        output_pressure=float(stages.pin_pressures(np.asarray(pin))),
        cam_load_by_disc=cam,
    )


def _cam_peak(stages: Stages, disc_torque: float, phase: float) -> float:
    """Greatest cam load of the disc at crank phase `phase`, both senses of torque."""
    n = stages.lobe_count
    period = kinematics.mesh_period(n, stages.pin_count)
    cells = round(period / kinematics.ring_period(n))
    samples = cells * _SAMPLES_PER_RING_PERIOD
    coarse = np.asarray(period / samples * np.arange(samples), dtype=float)
    clocking = stages.disc_clocking(float(phase))

    def peak(torque: float) -> float:
        def load(angle: FloatArray) -> FloatArray:
            parts = stages.cam_loads(torque, angle, clocking)
            return np.asarray(np.hypot(parts[..., 0], parts[..., 1]))

        # The ring's part repeats in every cell; only the pins need the whole period.
        radial = np.tile(stages.ring_radial_force(torque, coarse[:_SAMPLES_PER_RING_PERIOD]), cells)
        pins = stages.pin_forces(torque, coarse, clocking).sum(axis=-1)
        parts = rigid.cam_load(n, stages.eccentricity, torque, radial, pins)
        return period_maximum(load, period, samples, np.hypot(parts[..., 0], parts[..., 1]))

    return max(peak(disc_torque), peak(-disc_torque))


@dataclass(frozen=True)
class RigidSeries:
    """Rigid-law curves over crank angle for plots, at one output torque.

    Attributes
    ----------
    crank_angle : array (A,)
        rad.
    torque : float
        N m, signed.
    ring_force : array (A, D, n+1)
        N.
    ring_pressure : array (A, D)
        Greatest Hertz pressure over the teeth, Pa.
    output_pin_force : array (A, D, N_w)
        N.
    output_pressure : array (A, D)
        Greatest Hertz pressure over the pins, Pa.
    cam_force : array (A, D, 2)
        Force of the cam bearing on each disc in the ring's frame, N.
    """

    crank_angle: FloatArray
    torque: float
    ring_force: FloatArray
    ring_pressure: FloatArray
    output_pin_force: FloatArray
    output_pressure: FloatArray
    cam_force: FloatArray

    @property
    def cam_load(self) -> FloatArray:
        """Size of the cam force, (A, D), N."""
        return np.asarray(np.hypot(self.cam_force[..., 0], self.cam_force[..., 1]))

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``rigid_series``)."""
        return {
            "crank_angle_deg": np.degrees(self.crank_angle).tolist(),
            "torque_Nm": self.torque,
            "ring_force_max_N": self.ring_force.max(axis=2).tolist(),
            "ring_pressure_max_MPa": (self.ring_pressure / 1e6).tolist(),
            "output_pin_force_N": self.output_pin_force.tolist(),
            "output_pressure_max_MPa": (self.output_pressure / 1e6).tolist(),
            "cam_bearing_load_N": self.cam_load.tolist(),
        }


def rigid_series(stages: Stages, torque: float, crank_angle: FloatArray) -> RigidSeries:
    """Curves of forces, pressures and cam load for every disc.

    Parameters
    ----------
    stages : Stages
        From :meth:`Stages.from_design`.
    torque : float
        Torque with which the discs turn the carrier counter-clockwise, N m; negative for the
        other sense.
    crank_angle : array (A,)
        Crank angles of the machine, rad.
    """
    disc_torque = torque / stages.disc_count
    ring, pressure, pins, cam = [], [], [], []
    for phase in stages.phases:
        angle = np.asarray(crank_angle, dtype=float) + phase
        clocking = stages.disc_clocking(float(phase))
        forces = stages.ring_forces(disc_torque, angle)
        ring.append(forces)
        pressure.append(stages.ring_pressures(forces, angle).max(axis=-1))
        pins.append(stages.pin_forces(disc_torque, angle, clocking))
        along, across = np.moveaxis(stages.cam_loads(disc_torque, angle, clocking), -1, 0)
        cosine, sine = np.cos(angle), np.sin(angle)
        cam.append(
            np.stack([along * cosine - across * sine, along * sine + across * cosine], axis=-1)
        )
    pin_force = np.stack(pins, axis=1)
    return RigidSeries(
        crank_angle=np.asarray(crank_angle, dtype=float),
        torque=torque,
        ring_force=np.stack(ring, axis=1),
        ring_pressure=np.stack(pressure, axis=1),
        output_pin_force=pin_force,
        output_pressure=stages.pin_pressures(pin_force).max(axis=2),
        cam_force=np.stack(cam, axis=1),
    )
