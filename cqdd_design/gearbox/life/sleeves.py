"""Life of the sleeves on the output pins, on needles or plain, under a duty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bearing_life import basic_rating_life_hours, life_exponent
from cqdd_design.gearbox.checks.allowables import HARDENED_HRC
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.life.cam import equivalent_load, set_life
from cqdd_design.gearbox.life.pins import pin_force_histories
from cqdd_design.gearbox.output_pins import sleeve_turn
from cqdd_design.geometry.runners import Runner, pin_runner


@dataclass(frozen=True)
class SleeveLife:
    """Life of the sleeves on the output pins.

    Attributes
    ----------
    kind : {"plain", "needle"}
    designation : str
        Of the needle cage; empty for plain sleeves.
    speed : float
        Mean turn of a sleeve on its pin over the duty, rad/s.
    equivalent_load : float
        Of the worst loaded cage; for plain sleeves the mean force on the worst loaded, N.
    pressure_velocity : float or None
        Greatest p v of a plain sleeve over the duty: mean force on pin diameter times length, and
        sliding speed, Pa m/s; None on needles.
    hours, set_hours : float or None
        L10h of the worst cage and of all of them together; None where none is known.
    unknown : str
        Why no life is known; empty where one is.
    """

    kind: str
    designation: str
    speed: float
    equivalent_load: float
    pressure_velocity: float | None
    hours: float | None
    set_hours: float | None
    unknown: str

    def lasts(self, hours: float) -> bool:
        """Whether all sleeves together live so long; never where no life is known."""
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


def sleeve_life(
    design: Design,
    sweeps: Sequence[ContactSweep],
    shares: Sequence[float],
    output_speeds: Sequence[float],
) -> SleeveLife | None:
    """Life of the sleeves under a duty; None without sleeves.

    Parameters
    ----------
    sweeps : sequence of ContactSweep
        Of every load case over the mesh period.
    shares, output_speeds : sequence of float
        Share of time, and speed of the output without its sign, rad/s.

    Notes
    -----
    ISO 281 with p = 10/3 on the force of every disc as it varies over a turn of the crank; the
    sleeve counts as turning all the time. Its raceways presume a pin of 58 HRC. For plain sleeves
    of hardened steel on hardened steel no limit of p v has a source, so no life is given.
    """
    runner = pin_runner(design)
    if runner is None:
        return None
    n, throw = design.reducer.ratio, design.reducer.eccentricity
    per_output = n * float(sleeve_turn(n, throw, runner.diameter))
    share, speed = np.asarray(shares), per_output * np.asarray(output_speeds)
    forces = [np.abs(pin_force_histories(sweep)) for sweep in sweeps]
    # (C, g A, D, N_w/g): every sleeve of a disc that differs in more than the time.
    each = np.stack([force.reshape(len(force), -1) for force in forces])
    mean_speed = float(share @ speed / share.sum())
    if runner.cage is None:
        return _plain(runner, each.mean(axis=1).max(axis=1), speed, mean_speed)
    exponent = life_exponent("roller")
    loads = equivalent_load(each, share, speed, exponent)
    hardness = find_material(design.reducer.output_pins.material).rockwell_hardness or 0.0
    unknown, hours, together = "", None, None
    if hardness < HARDENED_HRC:
        unknown = (
            f"{design.reducer.output_pins.material} is softer than the {HARDENED_HRC:g} HRC that "
            "the rating of needles presumes"
        )
    elif runner.cage.dynamic_rating is not None and mean_speed > 0.0 and loads.max() > 0.0:
        # Pins of a circle come in N_w/g kinds, g of each.
        alike = design.reducer.output_pins.count * len(forces[0][0]) // each.shape[-1]
        lives = basic_rating_life_hours(
            runner.cage.dynamic_rating, loads[loads > 0.0], mean_speed, exponent
        )
        hours = float(lives.min())
        together = set_life([float(one) for one in lives for _ in range(alike)], "roller")
    return SleeveLife(
        kind="needle",
        designation=runner.cage.designation,
        speed=mean_speed,
        equivalent_load=float(loads.max()),
        pressure_velocity=None,
        hours=hours,
        set_hours=together,
        unknown=unknown,
    )


def _plain(
    runner: Runner, mean_force: np.ndarray, speed: np.ndarray, mean_speed: float
) -> SleeveLife:
    """Return what a plain sleeve bears, of every load case the worst."""
    pressure = mean_force / (runner.pin_diameter * runner.length)
    return SleeveLife(
        kind="plain",
        designation="",
        speed=mean_speed,
        equivalent_load=float(mean_force.max()),
        pressure_velocity=float((pressure * 0.5 * runner.pin_diameter * speed).max()),
        hours=None,
        set_hours=None,
        unknown="no limit of p v with a source is known for steel sleeves on steel pins",
    )
