"""One call from a machine to its contact equilibrium, precision, losses and life.

The closed forms of `Machine.analysis` need none of this; the compiled kernels load only here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.contact.laws import LineModel
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, FrictionChoice
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import ANGLES, contact_sweep, idle_sweep, perfect_angles
from cqdd_design.gearbox.film.running import Running, running
from cqdd_design.gearbox.life import LifeResult, life
from cqdd_design.gearbox.losses import EfficiencyMap, Losses, loss_model
from cqdd_design.gearbox.precision.precision import Precision, precision
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.shaft import ShaftBending, shaft_bending

_MAP_STEPS = 8
_PICTURE_ANGLES = 180
_FILM_ANGLES = 120
"""Crank angles over the period at which films are taken."""


@dataclass(frozen=True, eq=False)
class ContactAnalysis:
    """What the contact equilibrium says about a gearbox of perfect parts.

    Attributes
    ----------
    sweep, reversed : ContactSweep
        Over the period, at the torque and at its negative.
    preload : ContactSweep or None
        Without load and friction, where parts overlap whatever they do.
    precision : Precision
        At the continuous torque, or at the one asked for.
    losses : Losses
        At the torque of `precision` and the input speed.
    map : EfficiencyMap
        From an eighth of the input speed and of the peak torque up to both.
    life : LifeResult
        Over the duty of the requirements.
    running : Running
        Films at the torque of `precision` and the input speed, and wear over the duty.
    bending : ShaftBending or None
        Of the shaft, and tilt, under the forces of both sweeps.
    bending_missing : str
        Why there is none.
    """

    model: ContactModel
    sweep: ContactSweep
    reversed: ContactSweep
    preload: ContactSweep | None
    precision: Precision
    losses: Losses
    map: EfficiencyMap
    life: LifeResult
    running: Running
    bending: ShaftBending | None
    bending_missing: str

    @property
    def crank_turn(self) -> ContactSweep:
        """The same load over one crank turn, every two degrees, for pictures."""
        angle = 2.0 * np.pi * np.arange(_PICTURE_ANGLES) / _PICTURE_ANGLES
        return contact_sweep(self.model, self.sweep.torque, angle, friction=self.sweep.friction)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Everything the parts warn of."""
        parts = (
            *self.precision.warnings,
            *self.losses.warnings,
            *self.life.warnings,
            *self.running.warnings,
        )
        if self.bending is None:
            return (*parts, f"no bound on bending and tilt: {self.bending_missing}")
        return (*parts, *self.bending.warnings)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form: ``contact``, ``precision``, ``losses``, ``film``, ``wear``, ...

        ... ``life`` and ``bending``.
        """
        back = self.reversed.maxima
        greatest = {key: max(here, back[key]) for key, here in self.sweep.maxima.items()}
        contact = self.sweep.to_dict() | greatest
        contact["contact_law"] = self.model.ring_law.model
        contact["preload"] = self.preload.maxima if self.preload else None
        return {
            "contact": contact,
            "precision": self.precision.to_dict(),
            "losses": self.losses.to_dict() | {"efficiency_map": self.map.to_dict()},
            "film": self.running.to_dict(),
            "wear": self.running.wear.to_dict(),
            "life": self.life.to_dict(),
            "bending": None if self.bending is None else self.bending.to_dict(),
        }


def analyse_contact(
    machine: Machine,
    *,
    torque: float | None = None,
    angles: int = ANGLES,
    line_model: LineModel = "palmgren",
    friction: FrictionChoice = "drive",
) -> ContactAnalysis:
    """Solve the contact equilibrium of a machine over its period, and what follows from it.

    Parameters
    ----------
    torque : float, optional
        Output torque, N m. Where left out, the forces are at the peak torque of the requirements,
        precision and losses at the continuous one.
    angles : int
        Crank angles over the period.
    line_model : {"palmgren", "johnson", "linear"}
        Approach of teeth and pins.
    friction : {"drive", "backdrive", "off"}
        Which way power goes through forces and precision, with Coulomb friction at teeth and pins;
        the duty's life takes the sense of each case. ``off`` leaves friction out of all three, and
        out of no losses.

    Raises
    ------
    ContactError
        When the gearbox has no equilibrium at the torque, naming torque and angle.
    """
    design, usual = machine.design, line_model == "palmgren"
    model = machine.contact if usual else machine.contact_by(line_model)
    states = nominal_states(model, perfect_angles(model, angles))
    asked = design.requirements
    peak = asked.peak_torque if torque is None else torque
    steady = asked.continuous_torque if torque is None else torque
    # The peak torque of the requirements is reached at rest, where no film lowers friction.
    rubbed = ContactFriction.of(model, friction, 0.0 if torque is None else None)
    sweep = contact_sweep(model, peak, states=states, friction=rubbed)
    losses = machine.losses if usual else loss_model(model, machine.friction, asked.peak_torque)
    back = contact_sweep(model, -peak, states=states, friction=rubbed)
    bending, missing = _bending(machine, sweep, back)
    # As losses do, films and wear are those of a motor that drives.
    some = nominal_states(model, perfect_angles(model, _FILM_ANGLES))
    at_steady = contact_sweep(
        model, steady, states=some, friction=ContactFriction.of(model, "drive")
    )
    shares = np.arange(1, _MAP_STEPS + 1) / _MAP_STEPS
    exact = precision(model, steady, angles=angles, friction=friction)
    tight = exact.free.preloaded
    return ContactAnalysis(
        model=model,
        sweep=sweep,
        reversed=back,
        preload=idle_sweep(model, peak, states) if tight else None,
        precision=exact,
        losses=losses.at(asked.held_speed, steady),
        map=losses.efficiency_map(shares * asked.input_speed, shares * asked.peak_torque),
        life=(
            machine.life
            if usual and friction != "off"
            else life(design, model, friction=friction != "off")
        ),
        running=running(design, model, losses, at_steady, some),
        bending=bending,
        bending_missing=missing,
    )


def _bending(machine: Machine, *sweeps: ContactSweep) -> tuple[ShaftBending | None, str]:
    """What shaft and carrier bend and tilt, or why that is not known."""
    try:
        return shaft_bending(machine, sweeps), ""
    except GeometryError as error:
        return None, error.message
