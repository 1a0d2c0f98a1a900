"""Contacts of a perfect gearbox whose play is taken up: where a load of one sense starts from.

The nominal pose has every part in the middle of its play, and an equilibrium that is linearised
there can ask no part to move by more than a share of the eccentricity. Loose parts go that far
before anything touches. Here all discs are turned about their centres until the first tooth
touches, and the carrier on from there until the first pin does; rows, gaps and rates are exact at
that pose::

    discs     turned by a     tooth seen in one   (c - S) exp(-i a)/turn
    carrier   turned by b     hole to pin         d = exp(i b) p - (S + exp(i a) p)

S a disc's centre and p the pin off the ring's.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates, states_of
from cqdd_design.gearbox.contact.tables import RingTable, ring_table
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.kinematics import carrier_angle, disc_pose

_STEPS = 400
"""Of a part on its way to a stop, at most; each leaves a share of what is still free."""
_TOUCHING = 1e-12
"""Gap that counts as none, m."""


class TakenUp(NamedTuple):
    """Contacts with the play taken up in one sense.

    Attributes
    ----------
    states : NominalStates
    carrier_turn : array (A,)
        From the nominal pose, rad, of the sense's sign; 0 where parts overlap already.
    """

    states: NominalStates
    carrier_turn: FloatArray


def taken_up(model: ContactModel, crank_angle: FloatArray, sense: float) -> TakenUp:
    """Turn discs and carrier until they touch.

    Parameters
    ----------
    crank_angle : array (A,)
        rad.
    sense : {1.0, -1.0}
        Of the torque on the carrier.

    Raises
    ------
    ContactError
        Where nothing stops a part within half a lobe.
    """
    most = np.pi / model.lobe_count
    reach = model.ring_pitch_radius + model.eccentricity

    def ring(turn: FloatArray) -> RingTable:
        return ring_table(model, crank_angle, turn[:, None])

    discs = _until_touching(
        lambda turn: ring(turn).gap, np.zeros(len(crank_angle)), sense, reach, most
    )
    carrier = _until_touching(
        lambda turn: _pins(model, crank_angle, discs, turn)[2],
        discs,
        sense,
        model.pin_circle_radius,
        most,
    )
    rows, rates, gaps, angle = _pins(model, crank_angle, discs, carrier)
    return TakenUp(states_of(model, crank_angle, ring(discs), (rows, rates, gaps), angle), carrier)


def _until_touching(
    gaps_at: Callable[[FloatArray], FloatArray],
    turn: FloatArray,
    sense: float,
    radius: float,
    most: float,
) -> FloatArray:
    """Turn (A,), rad, on from a given one, at which the least of gaps (A, D, C) is none.

    A gap closes by no more than `radius` (m) times the turn, so that a step of the least gap over
    it never goes too far.
    """
    for _ in range(_STEPS):
        least = np.maximum(gaps_at(turn).min(axis=(1, 2)), 0.0)
        if least.max() < _TOUCHING:
            return turn
        turn = turn + sense * least / radius
        if np.abs(turn).max() > most:
            break
    raise ContactError(
        "the parts are so loose that nothing stops them within half a lobe. Lower "
        "reducer.modification or output_pins.hole_clearance."
    )


def _pins(
    model: ContactModel, crank_angle: FloatArray, discs: FloatArray, carrier: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Rows (A, D, P, 3), rates (A, D, P, 3) of angle, arm and gap, gaps, and angles of the pins."""
    n, count = model.lobe_count, model.pin_count
    around = 2.0 * np.pi * np.arange(count) / count
    nominal = model.hole_clocking + around + carrier_angle(n, crank_angle)[:, None]
    at = model.pin_circle_radius * np.exp(1j * nominal)[:, None]
    centre = disc_pose(model.disc, crank_angle[:, None] + model.phases)[1][..., None]
    pin, hole = np.exp(1j * carrier[:, None, None]) * at, np.exp(1j * discs[:, None, None]) * at
    apart = pin - hole - centre
    distance = np.abs(apart)
    normal = apart / distance
    # The carrier goes round at -1/n of the crank, and a disc's centre with it.
    drift = (-1j / n) * (pin - hole) - 1j * centre
    spin = (np.conj(normal) * drift).imag / distance
    arm = (np.conj(pin) * normal).imag
    arm_rate = (np.conj((-1j / n) * pin) * normal + np.conj(pin) * 1j * normal * spin).imag
    opening = -(np.conj(normal) * drift).real
    return (
        np.stack([normal.real, normal.imag, arm], axis=-1),
        np.stack([spin, arm_rate, opening], axis=-1),
        model.pin_gap + model.eccentricity - distance,
        nominal + carrier[:, None],
    )
