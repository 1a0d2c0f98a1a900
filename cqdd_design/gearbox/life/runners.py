"""Life of what turns on pins under a duty: sleeves and rollers, on needles or plain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bearing_life import life_exponent
from cqdd_design.gearbox.checks.allowables import HARDENED_HRC
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.life.cam import set_life
from cqdd_design.gearbox.life.pins import pin_histories
from cqdd_design.gearbox.losses.sliding import pin_sliding, ring_sliding
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner


@dataclass(frozen=True)
class RunnerLife:
    """Life of the sleeves on the output pins, or of the rollers on the ring's.

    Attributes
    ----------
    name : {"sleeves", "rollers"}
    kind : {"plain", "needle"}
    designation : str
        Of the needle cage; empty for plain ones.
    speed : float
        Mean turn on the pin over the duty, rad/s.
    equivalent_load : float
        Of the worst loaded cage: the constant load of the same life; for plain ones the mean
        force on the worst loaded, N.
    pressure_velocity : float or None
        Greatest p v of a plain one over the duty: mean of force times sliding speed over pin
        diameter times length, Pa m/s; None on needles.
    hours, set_hours : float or None
        L10h of the worst cage and of all of them together; None where none is known.
    unknown : str
        Why no life is known; empty where one is.
    """

    name: str
    kind: str
    designation: str
    speed: float
    equivalent_load: float
    pressure_velocity: float | None
    hours: float | None
    set_hours: float | None
    unknown: str

    def lasts(self, hours: float) -> bool:
        """Whether all of them together live so long; never where no life is known."""
        return not self.unknown and (self.set_hours is None or self.set_hours >= hours)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        pv = self.pressure_velocity
        return {
            "kind": self.kind,
            "designation": self.designation or None,
            "mean_speed_rad_per_s": self.speed,
            "equivalent_load_N": self.equivalent_load,
            "pressure_velocity_MPa_m_per_s": None if pv is None else pv / 1e6,
            "L10h": self.hours,
            "set_L10h": self.set_hours,
            "unknown": self.unknown or None,
        }


class RunnerDuty(NamedTuple):
    """Load cases with their solved sweeps over the mesh period."""

    design: Design
    sweeps: Sequence[ContactSweep]
    shares: FloatArray
    """Of time, (C,); what is missing to 1 is rest."""
    speeds: FloatArray
    """Of the output without their signs, (C,), rad/s."""

    @property
    def crank_speeds(self) -> FloatArray:
        """rad/s, (C,)."""
        return self.design.reducer.ratio * self.speeds


class _History(NamedTuple):
    """Forces on runners that differ in more than the time, and how fast these roll on the disc."""

    force: FloatArray
    """(C, A, K), N."""
    path: FloatArray
    """Speed of the disc's surface, (C, A, K), m per radian of crank."""
    alike: int
    """How many there are of each of the K."""


def sleeve_life(duty: RunnerDuty) -> RunnerLife | None:
    """Life of the sleeves on the output pins; None without.

    Notes
    -----
    ISO 281 with p = 10/3 on force and turn of every cage as they vary over a turn of the crank; a
    sleeve counts as turning all the time. The raceways presume a pin of 58 HRC. For plain sleeves
    of steel on steel no limit of p v has a source, so no life is given.
    """
    runner, reducer = pin_runner(duty.design), duty.design.reducer
    if runner is None:
        return None
    forces = [
        pin_histories(sweep.model, np.hypot(sweep.pin_force, sweep.pin_tangential))
        for sweep in duty.sweeps
    ]
    each = np.stack([force.reshape(len(force), -1) for force in forces])
    path = np.full(each.shape, float(pin_sliding(reducer.ratio, reducer.eccentricity)))
    alike = reducer.disc_count * reducer.output_pins.count // each.shape[-1]
    history = _History(each, path, alike)
    return _life("sleeves", runner, reducer.output_pins.material, duty, history)


def roller_life(duty: RunnerDuty) -> RunnerLife | None:
    """Life of the rollers on the pins of a pinwheel ring; None without.

    Notes
    -----
    As :func:`sleeve_life`; in one turn of the output every roller of a disc bears what every other
    does, at the speed at which the flank passes it.
    """
    runner, reducer = ring_runner(duty.design), duty.design.reducer
    if runner is None:
        return None
    n = reducer.ratio
    forces, paths = [], []
    for sweep in duty.sweeps:
        pitch = (n + 1) * np.asarray(sweep.disc_centre)[:, :, None, :]
        paths.append(_by_disc(ring_sliding(n, sweep.ring_point, sweep.ring_normal, pitch)))
        load = np.linalg.norm(sweep.ring_load, axis=-1)
        forces.append(_by_disc(load))
    history = _History(np.stack(forces), np.stack(paths), n + 1)
    return _life("rollers", runner, reducer.ring_material, duty, history)


def _by_disc(values: FloatArray) -> FloatArray:
    """(A, D, T) as the history of one tooth a disc, (A T, D)."""
    return np.asarray(np.moveaxis(values, 2, 1).reshape(-1, values.shape[1]))


def _life(
    name: str, runner: Runner, material: str, duty: RunnerDuty, history: _History
) -> RunnerLife:
    # Turns of the runner on its pin per second, at every load of every case.
    turns = history.path * duty.crank_speeds[:, None, None] / (np.pi * runner.diameter)
    share = duty.shares
    mean_turns = float(share @ turns.mean(axis=(1, 2)))
    hours = together = pressure_velocity = None
    if runner.cage is None:
        equal = float(history.force.mean(axis=1).max())
        rubbed = (history.force * turns).mean(axis=1) * np.pi * runner.pin_diameter
        pressure_velocity = float(rubbed.max() / (runner.pin_diameter * runner.length))
        unknown = "no limit of p v with a source is known for steel turning on steel pins"
    else:
        exponent = life_exponent("roller")
        # Turns an hour, each weighed with the load it bears.
        each = history.force / runner.rows
        worn = 3600.0 * np.einsum("c,cak->k", share, turns * each**exponent)
        worn /= history.force.shape[1]
        all_turns = 3600.0 * mean_turns
        equal = float((worn.max() / all_turns) ** (1.0 / exponent)) if all_turns > 0.0 else 0.0
        unknown = _unknown(material)
        if not unknown and worn.max() > 0.0:
            lives = 1e6 * (runner.cage.dynamic_rating or 0.0) ** exponent / worn[worn > 0.0]
            hours = float(lives.min())
            together = set_life(np.repeat(lives, history.alike * runner.rows).tolist(), "roller")
    return RunnerLife(
        name=name,
        kind="plain" if runner.cage is None else "needle",
        designation="" if runner.cage is None else runner.cage.designation,
        speed=2.0 * np.pi * mean_turns,
        equivalent_load=equal,
        pressure_velocity=pressure_velocity,
        hours=hours,
        set_hours=together,
        unknown=unknown,
    )


def _unknown(material: str) -> str:
    """Why the rating of needles does not hold; empty where it does."""
    if (find_material(material).rockwell_hardness or 0.0) >= HARDENED_HRC:
        return ""
    return f"{material} is softer than the {HARDENED_HRC:g} HRC that the rating of needles presumes"
