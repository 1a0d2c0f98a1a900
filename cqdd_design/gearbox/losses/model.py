"""Losses over speed and torque from contact sweeps with friction at a few torques.

Coulomb work is very nearly proportional to the torque, but not quite: the higher the load, the more
teeth share it. It is computed at the torques of the sweeps and taken straight between them, once
with the motor driving and once with the output driving, whose forces differ. Where friction follows
from films it changes with speed too (:mod:`.film_work`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.errors import UsageError
from cqdd_design.gearbox.losses.backdrive import STATIC_RATIO, Backdrive, balance_torque
from cqdd_design.gearbox.losses.film_work import FilmWork
from cqdd_design.gearbox.losses.machine import RUBBING, SOURCES, FrictionMachine, total
from cqdd_design.gearbox.losses.result import Losses
from cqdd_design.geometry.contours import FloatArray

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.rubbing import PowerSense
    from cqdd_design.gearbox.contact.solved import ContactSweep


SENSES: tuple[PowerSense, PowerSense] = ("drive", "backdrive")
"""Which way power goes, in the order of `LossModel.work`."""


@dataclass(frozen=True, eq=False)
class EfficiencyMap:
    """Efficiency over speed and torque.

    Attributes
    ----------
    input_speed : array (S,)
        rad/s.
    torque : array (T,)
        N m.
    power : array (S, T)
        Lost while the motor drives, W.
    loss_torque : array (S, T)
        At the output, likewise, N m.
    forward, backward : array (S, T)
        Efficiencies, the motor or the output driving; 0 at zero torque, where no power passes,
        and 0 backward where the output does not turn the gearbox.
    """

    input_speed: FloatArray
    torque: FloatArray
    power: FloatArray
    loss_torque: FloatArray
    forward: FloatArray
    backward: FloatArray

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form; efficiencies are null at zero torque."""
        zero = self.torque == 0.0

        def rows(values: FloatArray) -> list[list[float | None]]:
            return [
                [None if none else float(value) for value, none in zip(row, zero, strict=True)]
                for row in values
            ]

        return {
            "input_speed_rad_per_s": self.input_speed.tolist(),
            "torque_Nm": self.torque.tolist(),
            "total_W": self.power.tolist(),
            "loss_torque_Nm": self.loss_torque.tolist(),
            "efficiency_forward": rows(self.forward),
            "efficiency_backward": rows(self.backward),
        }


@dataclass(frozen=True, eq=False)
class LossModel:
    """Losses of one gearbox at any speed and torque.

    Attributes
    ----------
    torque : array (K,)
        Of the sweeps, rising from zero, N m (sizes; both senses lose alike within the asymmetry
        of the hole clocking).
    work : array (2, K, 6)
        Coulomb work per radian of crank at those torques, by source, N m: the motor driving, and
        the output.
    rubbed : array (K, 2)
        Normal force times sliding path per radian of crank, of teeth and of pins, the motor
        driving, N m.
    film : FilmWork or None
        Of films that lower friction with speed, `work` being that at one speed; None where
        friction does not know the speed.
    """

    machine: FrictionMachine
    torque: FloatArray
    work: FloatArray
    rubbed: FloatArray
    film: FilmWork | None = None

    @classmethod
    def from_sweeps(
        cls,
        machine: FrictionMachine,
        driving: Sequence[ContactSweep],
        driven: Sequence[ContactSweep],
    ) -> LossModel:
        """Read the friction work of one or more sweeps of the same gearbox.

        Parameters
        ----------
        driving, driven : sequence of ContactSweep
            With the motor driving, and with the output driving, at the same torques: of one sense
            and different sizes. Without one at zero torque the work is taken to vanish there, as
            it does without preload.

        Raises
        ------
        UsageError
            With no sweep, torques of both senses, the same torque twice, or other torques driven.
        """
        if not driving:
            raise UsageError("losses need at least one contact sweep; there is none.")
        given = [float(sweep.torque) for sweep in driving]
        if min(given) < 0.0 < max(given):
            raise UsageError(
                f"losses need sweeps of one sense of torque, not from {min(given):g} to "
                f"{max(given):g} N*m; compute the two senses apart."
            )
        if len({abs(torque) for torque in given}) < len(given):
            raise UsageError(f"two of the sweeps have the same torque; leave one out of {given}.")
        if [float(sweep.torque) for sweep in driven] != given:
            raise UsageError(f"losses need sweeps with the output driving at {given} N*m too.")
        found = [
            {abs(sweep.torque): machine.coulomb_work(sweep) for sweep in sweeps}
            for sweeps in (driving, driven)
        ]
        for sense in found:
            sense.setdefault(0.0, dict.fromkeys(SOURCES, 0.0))
            if len(sense) == 1:
                # A lone sweep at zero torque: the work there is all that is known.
                sense[1.0] = sense[0.0]
        torque = np.array(sorted(found[0]))
        work = [[[sense[size][name] for name in SOURCES] for size in torque] for sense in found]
        paths = {abs(sweep.torque): machine.rubbed(sweep) for sweep in driving}
        rubbed = [paths.get(size, (0.0, 0.0)) for size in torque.tolist()]
        return cls(machine, torque, np.array(work), np.array(rubbed))

    def coulomb_work(
        self,
        torque: ArrayLike,
        sense: PowerSense = "drive",
        crank_speed: ArrayLike | None = None,
    ) -> FloatArray:
        """Coulomb work per radian of crank by source, (..., 6), N m.

        Straight between the sweeps; beyond the largest, the part that came with the torque goes on
        in proportion to it.

        Parameters
        ----------
        crank_speed : array_like, optional
            rad/s, either sense, where films know it, of all torques or of each; default that of
            the sweeps.
        """
        found = self._between(torque, self.work[SENSES.index(sense)])
        if self.film is None or crank_speed is None:
            return found
        rest = self._between(torque, self.film.at_rest[SENSES.index(sense)])
        return np.asarray(rest + self.film.share(torque, crank_speed) * (found - rest))

    def crank_torque(
        self, input_speed: FloatArray, torque: FloatArray, sense: PowerSense
    ) -> FloatArray:
        """Friction torque at the crank by source, (M, 6), N m, at speeds and torques (M,)."""
        drag = self.machine.drag(input_speed)
        columns = np.stack([drag[name] for name in SOURCES], axis=-1)
        return np.asarray(columns + self.coulomb_work(torque, sense, input_speed))

    def rubbed_at(self, torque: ArrayLike) -> FloatArray:
        """Normal force times sliding path per radian of crank, teeth and pins, (..., 2), N m."""
        return self._between(torque, self.rubbed)

    def _between(self, torque: ArrayLike, work: FloatArray) -> FloatArray:
        """Columns of `work` (K, ...) at torques."""
        size = np.abs(np.asarray(torque, dtype=float))
        within = np.minimum(size, self.torque[-1])
        beyond = np.maximum(size / self.torque[-1], 1.0)
        columns = [np.interp(within, self.torque, column) for column in work.T]
        at_rest, found = work[0], np.stack(columns, axis=-1)
        return np.asarray(at_rest + (found - at_rest) * beyond[..., None])

    def _crank_torque(
        self, speed: FloatArray, torque: FloatArray, sense: PowerSense
    ) -> tuple[FloatArray, FloatArray]:
        """Friction torque at the crank by source (S, T, 6), and its load-independent part (S,)."""
        drag = self.machine.drag(speed)
        columns = np.stack([drag[name] for name in SOURCES], axis=-1)
        if self.film is None:
            return columns[:, None, :] + self.coulomb_work(torque, sense), total(drag)
        work = np.stack([self.coulomb_work(torque, sense, float(one)) for one in speed])
        return columns[:, None, :] + work, total(drag)

    def efficiency_map(self, input_speeds: ArrayLike, torques: ArrayLike) -> EfficiencyMap:
        """Losses and efficiencies over a grid.

        Parameters
        ----------
        input_speeds : array_like (S,)
            rad/s, either sense, 0 allowed.
        torques : array_like (T,)
            N m, either sense, 0 allowed.
        """
        speed, torque = _finite("speed", input_speeds), _finite("torque", torques)
        crank, driven = (
            self._crank_torque(speed, torque, sense)[0].sum(axis=-1) for sense in SENSES
        )
        loss, back = self.machine.lobe_count * crank, self.machine.lobe_count * driven
        size = np.abs(torque)
        some = size > 0.0
        safe = np.where(some, size, 1.0)
        return EfficiencyMap(
            input_speed=speed,
            torque=torque,
            power=np.abs(speed)[:, None] * crank,
            loss_torque=loss,
            forward=np.where(some, safe / (safe + loss), 0.0),
            backward=np.where(some, np.maximum(1.0 - back / safe, 0.0), 0.0),
        )

    def at(
        self,
        input_speed: float,
        torque: float,
        *,
        static_ratio: float = STATIC_RATIO,
        backdrive_speed: float = 0.0,
    ) -> Losses:
        """Losses at one speed and torque.

        Parameters
        ----------
        input_speed, torque : float
            rad/s and N m, finite.
        static_ratio, backdrive_speed : float
            As for :meth:`backdrive`.
        """
        grid = self.efficiency_map([input_speed], [torque])
        by_source, drag = self._crank_torque(grid.input_speed, grid.torque, "drive")
        driven, _ = self._crank_torque(grid.input_speed, grid.torque, "backdrive")
        size = abs(input_speed)
        power = dict(zip(SOURCES, (size * by_source[0, 0]).tolist(), strict=True))
        loss, some = float(grid.loss_torque[0, 0]), torque != 0.0
        back = self.machine.lobe_count * float(driven.sum())
        warnings = []
        if not some:
            warnings.append("efficiency does not exist at zero torque, where no power passes.")
        elif back >= abs(torque):
            warnings.append(
                f"{abs(torque):g} N*m at the output does not backdrive the gearbox: friction "
                f"takes {back:.3g} N*m."
            )
        if some and size == 0.0:
            warnings.append("efficiency at zero speed is the limit of slow motion; no power flows.")
        if abs(torque) > 1.001 * self.torque[-1]:
            warnings.append(
                f"losses at {abs(torque):g} N*m are extrapolated in proportion from the largest "
                f"sweep, {self.torque[-1]:g} N*m."
            )
        return Losses(
            torque=float(torque),
            input_speed=float(input_speed),
            output_speed=size / self.machine.lobe_count,
            by_source=power,
            load_independent=size * float(drag[0]),
            loss_torque=loss,
            loss_torque_backward=back,
            efficiency_forward=float(grid.forward[0, 0]) if some else None,
            efficiency_backward=float(grid.backward[0, 0]) if some else None,
            backdrives=back < abs(torque) if some else None,
            backdrive=self.backdrive(static_ratio=static_ratio, output_speed=backdrive_speed),
            bearings={
                "cam": self.machine.cam.name,
                "support": self.machine.support.name,
                "output": self.machine.output.name,
            },
            lubricant=self.machine.lubricant.name,
            warnings=tuple(warnings),
        )

    def backdrive(
        self,
        *,
        static_ratio: float = STATIC_RATIO,
        output_speed: float = 0.0,
        film_speed: float | None = None,
        shaft_running: float = 0.0,
        shaft_resting: float = 0.0,
    ) -> Backdrive:
        """Torques at the output that break the gearbox away and keep it turning.

        Parameters
        ----------
        static_ratio : float
            Breakaway over running friction, at least 1, of bearings, and of teeth and pins as far
            as a boundary layer goes (:func:`..rolling_contacts.most_breakaway`); the yield stress
            of the grease is already that of rest.
        output_speed : float
            Of the dynamic torque, rad/s; the default is the limit of slow motion, because drag
            grows with speed.
        film_speed : float, optional
            Speed of the crank whose films carry the dynamic torque, rad/s; default that of
            `output_speed`.
        shaft_running, shaft_resting : float
            What the gearbox has to turn with its shaft, in motion and from rest, N m at the shaft:
            a motor's own drag; default none.
        """
        if not (math.isfinite(static_ratio) and static_ratio >= 1.0):
            raise UsageError(f"static_ratio {static_ratio:g} must be at least 1.")
        n = self.machine.lobe_count
        speed = n * float(_finite("speed", output_speed))
        running = total(self.machine.drag(speed))
        resting = total(self.machine.drag(0.0))
        grease = self.machine.grease_torque(0.0)
        moving = self.coulomb_work(
            self.torque, "backdrive", speed if film_speed is None else film_speed
        )
        rest = self.coulomb_work(self.torque, "backdrive", 0.0)
        ratios = np.full(len(SOURCES), static_ratio)
        for name, most in zip(RUBBING, self.machine.most_breakaway, strict=True):
            ratios[SOURCES.index(name)] = min(static_ratio, most)
        broken = rest @ ratios
        dynamic = n * (moving.sum(axis=1) + running + shaft_running)
        static = n * (broken + static_ratio * (resting - grease) + grease + shaft_resting)
        return Backdrive(
            static_torque=balance_torque(self.torque, static),
            dynamic_torque=balance_torque(self.torque, dynamic),
            load_independent=float(dynamic[0]),
            load_share=float((dynamic[1] - dynamic[0]) / (self.torque[1] - self.torque[0])),
            static_ratio=float(static_ratio),
            output_speed=float(output_speed),
        )


def _finite(what: str, values: ArrayLike) -> FloatArray:
    array = np.asarray(values, dtype=float)
    if not np.all(np.isfinite(array)):
        raise UsageError(f"losses need a finite {what}, not {array.ravel().tolist()}.")
    return array
