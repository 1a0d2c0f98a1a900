"""Coulomb friction at ring teeth and output pins as the equilibrium takes it: where, which way.

While the crank turns every loaded contact slides, in a direction that the kinematics alone gives.
Per radian of the crank a disc turns by -1/n about its pitch point P, so that along the tangent
t = (-n_y, n_x) of a contact at c with the normal n it slides by -(c - P).n/n on the ring; against
the carrier all of its points move by e (1 + 1/n) across the crank direction u, and along the
tangent of a pin, whose normal is -u, by -e (1 + 1/n). Friction is then a known share of each normal
force. A carrier turns against the crank, so that a crank which drives turns with the torque on the
carrier, and one which is driven turns against it.

Where the coefficient follows from the film (:mod:`.films`) it depends a little on the force it goes
with, as F^-0.13 through the thickness: an equilibrium is solved with the coefficients of forces
close by, and again until they agree.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from cqdd_design.gearbox.contact.films import SETTLED, Felt, hole_film, ring_film
from cqdd_design.gearbox.contact.kernel_values import Rubbing
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

PowerSense = Literal["drive", "backdrive"]
FrictionChoice = Literal["drive", "backdrive", "off"]


@dataclass(frozen=True)
class ContactFriction:
    """Friction of an equilibrium.

    Attributes
    ----------
    sense : {"drive", "backdrive"}
        Whether the crank drives the carrier, or the carrier the crank.
    tooth, pin : float
        mu at ring teeth, and at the holes: that of plain pins, or what sleeves leave of it.
    film_speed : float
        Speed of the crank whose films lower both where the gearbox takes them from films, rad/s;
        0 where they stay as they are.
    felt : Felt or None
        Coefficients of every contact of an equilibrium, once they are found.
    """

    sense: PowerSense
    tooth: float
    pin: float
    film_speed: float = 0.0
    felt: Felt | None = None

    @classmethod
    def of(
        cls, model: ContactModel, choice: FrictionChoice, crank_speed: float | None = None
    ) -> ContactFriction | None:
        """The friction of a gearbox in one sense of power; None where it is off.

        Parameters
        ----------
        crank_speed : float, optional
            rad/s, either sense, for coefficients that follow from the film; default that of the
            model, and 0 is a gearbox at rest.
        """
        if choice == "off":
            return None
        speed = 0.0
        if any(model.by_film):
            speed = abs(model.film_speed if crank_speed is None else crank_speed)
        return cls(choice, model.tooth_friction, model.hole_friction, speed)

    def under(
        self, model: ContactModel, states: NominalStates, force: FloatArray
    ) -> ContactFriction:
        """The same with the coefficients that films leave under forces (A, D, C), N."""
        if not self.film_speed:
            return replace(self, felt=None)
        teeth = model.tooth_count
        found = np.empty(force.shape)
        found[..., :teeth], found[..., teeth:] = self.tooth, self.pin
        if model.by_film[0]:
            moved = slip(model, states)
            film = ring_film(model, states, moved, force[..., :teeth], self.film_speed)
            assert film is not None
            found[..., :teeth] = film.friction
        if model.by_film[1]:
            film = hole_film(model, force[..., teeth:], self.film_speed)
            assert film is not None
            found[..., teeth:] = film.friction
        return replace(self, felt=Felt(found))

    def agrees(self, other: ContactFriction, force: FloatArray) -> bool:
        """Whether another round would change no friction under these forces to speak of."""
        if self.felt is None or other.felt is None:
            return True
        change = np.abs(other.felt.coefficient - self.felt.coefficient) * force
        return float(change.max()) <= SETTLED * float(force.max())

    def crank_sense(self, torque: float) -> float:
        """Sense in which the crank turns under a torque on the carrier, 1 or -1."""
        along = 1.0 if torque >= 0.0 else -1.0
        return along if self.sense == "drive" else -along


@lru_cache(maxsize=4)
def slip(model: ContactModel, states: NominalStates) -> FloatArray:
    """Slip of the discs along the contacts' tangents at the nominal pose, (A, D, C), m/rad."""
    n, teeth = model.lobe_count, model.tooth_count
    pitch_point = (n + 1) * _centre(model, states)
    found = np.full(states.gaps.shape, -model.eccentricity * (1.0 + 1.0 / n))
    arm = states.ring.point - pitch_point
    found[:, :, :teeth] = -np.sum(arm * states.rows[:, :, :teeth, :2], axis=-1) / n
    return found


def rubbing(
    model: ContactModel, states: NominalStates, friction: ContactFriction, torque: float
) -> Rubbing:
    """Friction of every contact over crank angle, for a torque on the carrier (N m).

    A force along the tangent t = i n at c has the moment (c - C) x t = (c - C).n about C.
    """
    return _rubbing(model, states, friction, friction.crank_sense(torque))


@lru_cache(maxsize=2)
def _rubbing(
    model: ContactModel, states: NominalStates, friction: ContactFriction, crank_sense: float
) -> Rubbing:
    """Asked for several times by one sweep, and by sweeps at other torques."""
    mu = np.full(states.gaps.shape[2], friction.pin)
    mu[: model.tooth_count] = friction.tooth
    if friction.felt is not None:
        mu = friction.felt.coefficient
    arms = _arms(model, states)
    return arms._replace(share=-crank_sense * mu * arms.share)


@lru_cache(maxsize=4)
def _arms(model: ContactModel, states: NominalStates) -> Rubbing:
    """Arms of friction, and with which sense of the slip it goes, whatever the coefficients."""
    teeth = model.tooth_count
    normal = states.rows[..., :2]
    at = model.pin_circle_radius * np.stack(
        [np.cos(states.pin_angle), np.sin(states.pin_angle)], axis=-1
    )
    pins = at[:, None] + model.pin_contact_radius * normal[:, :, teeth:]
    point = np.concatenate([states.ring.point, pins], axis=2)
    return Rubbing(
        share=np.sign(slip(model, states)),
        disc_arm=np.sum((point - _centre(model, states)) * normal, axis=-1) / states.length,
        carrier_arm=np.sum(point * normal, axis=-1) / states.length,
    )


def _centre(model: ContactModel, states: NominalStates) -> FloatArray:
    """Nominal centres of the discs, (A, D, 1, 2), m."""
    angle = states.crank_angle[:, None]
    return kinematics.disc_centre(model.eccentricity, angle, model.phases)[:, :, None, :]
