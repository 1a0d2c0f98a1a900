"""Pitting of teeth, flanks, holes and pins, place by place over the pressures of a duty."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.life import cycles, fatigue
from cqdd_design.geometry.contours import FloatArray


@dataclass(frozen=True, eq=False)
class Pressures:
    """Pressures that places of one part see in an output turn, for C load cases.

    Attributes
    ----------
    values : array (C, M, P)
        M passes at P places, Pa.
    times : int
        How often each of the M comes in an output turn.
    """

    values: FloatArray
    times: int

    def damage(self, turns_per_hour: FloatArray, limit: float) -> FloatArray:
        """Damage per hour at every place, (P,)."""
        return fatigue.damage_per_hour(
            self.values,
            self.times * turns_per_hour,
            lambda pressure: fatigue.contact_cycles(pressure, limit),
        )

    def reserve(self, turns_per_hour: FloatArray, limit: float, hours: float) -> float | None:
        """Factor on all pressures at which the worst place lasts `hours`; None without cycles."""
        loaded = self.values.max(axis=(1, 2), initial=0.0) > 0.0
        if not np.any(loaded & (turns_per_hour > 0.0)):
            return None
        tried: dict[int, float] = {}
        place = int(self.damage(turns_per_hour, limit).argmax())
        # The place that is worst as it is need not be worst at the factor found.
        while place not in tried:
            one = Pressures(self.values[:, :, [place]], self.times)
            tried[place] = fatigue.largest_factor(
                partial(one._greatest_damage, turns_per_hour, limit), hours
            )
            place = int(self.scaled(min(tried.values())).damage(turns_per_hour, limit).argmax())
        return min(tried.values())

    def _greatest_damage(self, turns_per_hour: FloatArray, limit: float, factor: float) -> float:
        return float(self.scaled(factor).damage(turns_per_hour, limit).max())

    def scaled(self, factor: float) -> Pressures:
        """Return all pressures times a factor."""
        return Pressures(factor * self.values, self.times)


def moving_contact(pressures: list[FloatArray], lobe_count: int) -> Pressures:
    """Pressures on flanks, holes or pins, which see every place of the crank alike.

    Parameters
    ----------
    pressures : list of array (A, D, contacts)
        Of each load case over the mesh period, Pa. Angle, disc and contact name one place of the
        part, the same in every case, rolled over at this pressure n + 1 times an output turn.
    lobe_count : int
        n.
    """
    stack = np.stack([pressure.ravel() for pressure in pressures])
    return Pressures(stack[:, None, :], cycles.disc_cycles(lobe_count))


def tooth_contact(sweeps: list[ContactSweep]) -> Pressures:
    """Pressures on the ring's teeth, in the zone of every disc, by place along the tooth.

    Parameters
    ----------
    sweeps : list of ContactSweep
        Of each load case over :func:`.cycles.crank_angles`.

    Returns
    -------
    Pressures
        Places D B; each sees 2 n/g pressures, g times an output turn, with g = gcd(n, N_w).
    """
    model = sweeps[0].model
    n, pins = model.lobe_count, model.pin_count
    angle, tooth = cycles.tooth_passes(n, pins)
    count = angle.shape[1] - 1
    again, share = _second_touch(model, count)
    stacks = []
    for sweep in sweeps:
        passed = np.moveaxis(sweep.ring_pressure[angle, :, tooth], 2, 0)
        # Between angles the force, so the square of the pressure, is nearly straight.
        square = passed**2
        disc = np.arange(model.disc_count)[:, None]
        lower, upper = square[disc, :, again], square[disc, :, again + 1]
        second = np.sqrt((1.0 - share)[..., None] * lower + share[..., None] * upper)
        first = np.moveaxis(passed[:, :, :-1], 1, 2)
        both = np.concatenate([first, second], axis=2)
        stacks.append(both.reshape(-1, both.shape[2]).T)
    return Pressures(np.stack(stacks), math.gcd(n, pins))


def _second_touch(model: ContactModel, count: int) -> tuple[NDArray[np.int64], FloatArray]:
    """Index of the crank angle before the second touch of each place, and how far beyond, (D, B).

    Column b of a pass is the crank angle 2 pi b/B of disc 0; another disc is ahead by its phase.
    """
    step = 2.0 * math.pi / count
    own = step * np.arange(count) + model.phases[:, None]
    again = cycles.other_touch(model.disc.shortening_coefficient, own) - model.phases[:, None]
    at = np.mod(again / step, count)
    index = np.minimum(at.astype(np.int64), count - 1)
    return index, at - index


def flank_place(sweep: ContactSweep, place: int) -> str:
    """Words for a place of :func:`moving_contact` on a flank."""
    angle, disc, tooth = np.unravel_index(place, sweep.ring_parameter.shape)
    pitch = 2.0 * math.pi / sweep.model.lobe_count
    along = float(sweep.ring_parameter[angle, disc, tooth]) % pitch / pitch
    share = 2.0 * min(along, 1.0 - along)
    return f"disc {disc + 1}, {100.0 * share:.0f} % of the way from valley to tip"


def hole_place(sweep: ContactSweep, place: int) -> str:
    """Words for a place of :func:`moving_contact` in a hole or on a pin."""
    disc = int(np.unravel_index(place, sweep.pin_force.shape)[1])
    return f"at disc {disc + 1}"


def tooth_place(model: ContactModel, places: int, place: int) -> str:
    """Words for a place of :func:`tooth_contact`."""
    count = places // model.disc_count
    disc, b = divmod(place, count)
    crank = 2.0 * math.pi * b / count + model.phases[disc]
    lean = cycles.contact_inclination(model.disc.shortening_coefficient, np.asarray(crank))
    return (
        f"at disc {disc + 1}, {abs(math.degrees(float(lean))):.0f} deg off the line to the centre"
    )
