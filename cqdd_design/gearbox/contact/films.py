"""Films at the contacts of an equilibrium: how fast oil is drawn in, and the friction it leaves.

A film is drawn in by the mean of both surfaces' speeds past the contact, which itself travels. Per
radian of the crank the normal at a ring tooth of radius r turns by k, so the contact travels r k
along the tooth, which stands still; on the disc, which slides by s, it travels r k - s::

    tooth       |r k - s/2|                     R of tooth and flank
    pin         (r_pin + r_hole) (1 + 1/n)/2    R of pin and hole
    roller, sleeve: at the bore, whose surface passes at what its rim has, times r_bore/r_rim

The normal at a pin turns with the crank against the carrier, by 1 + 1/n.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.gearbox.film.law import Film
from cqdd_design.geometry.contours import FloatArray

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.model import ContactModel
    from cqdd_design.gearbox.contact.states import NominalStates

SETTLED = 1e-4
"""Friction has settled on its film where no contact's friction changes by more than this share of
the greatest normal force in another round: a ten thousandth in mu of the most loaded contact."""
MOST_ROUNDS = 12


@dataclass(frozen=True, eq=False)
class Felt:
    """Coefficients of friction of every contact, (A, D, C); compared by identity."""

    coefficient: FloatArray


def travel(model: ContactModel, states: NominalStates, slip: FloatArray) -> FloatArray:
    """Way of the contacts along ring teeth and along the flanks, (2, A, D, T), m/rad, signed."""
    teeth = model.tooth_count
    on_tooth = model.tooth_radius * states.rates[:, :, :teeth, 0]
    return np.stack([on_tooth, on_tooth - slip[:, :, :teeth]])


def ring_film(
    model: ContactModel,
    states: NominalStates,
    slip: FloatArray,
    force: FloatArray,
    crank_speed: float,
) -> Film | None:
    """Films at ring teeth, (A, D, T), under forces (N) at a speed of the crank (rad/s).

    None where rollers run on needles.
    """
    if model.tooth_film is None:
        return None
    law, journal = model.tooth_film
    on_tooth, on_disc = travel(model, states, slip)
    if journal is None:
        entrained, radius = 0.5 * (on_tooth + on_disc), states.ring.equivalent_radius
    else:
        spin = states.rates[:, :, : model.tooth_count, 0]
        entrained = 0.5 * (journal.pin * spin + on_disc * journal.bore / journal.rim)
        radius = np.full(force.shape, journal.radius)
    return law.at(force, np.abs(entrained) * abs(crank_speed), radius)


def hole_film(model: ContactModel, force: FloatArray, crank_speed: float) -> Film | None:
    """Films at output pins, of the forces' shape; None where sleeves run on needles."""
    if model.hole_film is None:
        return None
    law, journal = model.hole_film
    turn = 1.0 + 1.0 / model.lobe_count
    if journal is None:
        passing, radius = model.pin_contact_radius + model.hole_radius, model.pin_equivalent_radius
    else:
        passing = journal.pin + model.hole_radius * journal.bore / journal.rim
        radius = journal.radius
    return law.at(force, 0.5 * passing * turn * abs(crank_speed), radius)
