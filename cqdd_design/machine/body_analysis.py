"""Elastic bodies of a machine under the forces of its contact equilibrium."""

from __future__ import annotations

import math
from functools import lru_cache

from cqdd_design.catalog.materials import find_material
from cqdd_design.errors import ContactError, GeometryError
from cqdd_design.gearbox.bodies.made import elastic_bodies
from cqdd_design.gearbox.bodies.strength import BodyStrength, body_strength
from cqdd_design.gearbox.checks.bodies import body_checks
from cqdd_design.gearbox.contact.laws import LineModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, FrictionChoice
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.geometry.kinematics import mesh_period
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.machine.machine import Machine
from cqdd_design.results import Check

_ANGLES = 96
"""Crank angles over both stages' period: stress along edges changes less than pressures do."""


def analyse_bodies(
    machine: Machine,
    *,
    torque: float | None = None,
    line_model: LineModel = "palmgren",
    friction: FrictionChoice = "drive",
) -> BodyStrength:
    """Stress of discs and ring, and give of the teeth.

    Parameters
    ----------
    torque : float, optional
        Output torque, N m. Where left out, peaks are those at the peak torque of the requirements,
        cycles those at the greatest torque of the duty, without one at the continuous torque.
    line_model : {"palmgren", "johnson", "linear"}
        Approach of teeth and pins.
    friction : {"drive", "backdrive", "off"}
        Which way power goes.

    Raises
    ------
    ContactError
        When the gearbox has no equilibrium at the torque.
    GeometryError
        When material is too thin to mesh.

    Notes
    -----
    A verdict and a command ask for the same, so that the last results are kept.
    """
    return _analysed(machine, torque, line_model, friction)


@lru_cache(maxsize=2)
def _analysed(
    machine: Machine, torque: float | None, line_model: LineModel, friction: FrictionChoice
) -> BodyStrength:
    design, usual = machine.design, line_model == "palmgren"
    model = machine.contact if usual else machine.contact_by(line_model)
    asked = design.requirements
    peak = asked.peak_torque if torque is None else torque
    steady = machine.lasting_torque if torque is None else torque
    # Fewer columns than pins: several of these periods until a place has met all of its forces.
    periods = round(model.period / mesh_period(model.lobe_count, model.pin_count))
    states = nominal_states(model, perfect_angles(model, periods * _ANGLES))

    def both(size: float, speed: float | None = None) -> list[ContactSweep]:
        rubbed = ContactFriction.of(model, friction, speed)
        return [contact_sweep(model, t, states=states, friction=rubbed) for t in (size, -size)]

    # The peak torque of the requirements is reached at rest, where no film lowers friction.
    at_peak = both(peak, 0.0 if torque is None else None)
    senses = [case.torque for case in asked.load_cases]
    strengths = [
        find_material(name).ultimate_strength or math.inf
        for name in (design.reducer.disc_material, design.reducer.ring_material)
    ]
    return body_strength(
        machine.bodies or elastic_bodies(design),
        states,
        at_peak,
        at_peak if torque is not None else both(steady),
        reverses=min(senses, default=0.0) < 0.0 < max(senses, default=0.0),
        ultimate=(strengths[0], strengths[1]),
    )


def stress_under(
    lowered: Machine, line_model: LineModel = "palmgren", friction: FrictionChoice = "drive"
) -> BodyStrength:
    """Stress of a machine at other torques, which is not kept: nobody else asks for it."""
    return _analysed.__wrapped__(lowered, None, line_model, friction)


def no_stress(machine: Machine, why: str) -> str:
    """A sentence on bodies whose stress is not known."""
    rigid = ", which count as rigid in the equilibrium" if machine.bodies is None else ""
    return f"no stress of discs and ring{rigid}: {why}"


def judged_bodies(
    machine: Machine, line_model: LineModel = "palmgren", friction: FrictionChoice = "drive"
) -> tuple[tuple[Check, ...], BodyStrength]:
    """Checks of the stress at the torques of the requirements, and what they judge.

    Raises
    ------
    ContactError, GeometryError
        As :func:`analyse_bodies`.
    """
    strength = analyse_bodies(machine, line_model=line_model, friction=friction)
    found = body_checks(machine.design, strength)
    if all(line.status != "fail" for line in found):
        return found, strength

    def at(lowered: Machine) -> tuple[Check, ...]:
        return body_checks(lowered.design, stress_under(lowered, line_model, friction))

    asked = machine.design.requirements
    peak = [line for line in found if line.id.endswith("-STRESS")]
    lasting = [line for line in found if line not in peak]
    cures = torques_that_hold(
        lambda torque: at(machine.under(peak=torque)), asked.peak_torque, peak, near=ROUGHLY
    ) | torques_that_hold(
        lambda share: at(machine.under(duty_share=share)),
        1.0,
        lasting,
        near=ROUGHLY,
    )
    return body_checks(machine.design, strength, cures), strength


def judged_or_told(
    machine: Machine,
) -> tuple[BodyStrength | None, tuple[Check, ...], tuple[str, ...]]:
    """Stress of discs and ring with its checks, or a sentence on why there is none."""
    try:
        checks, strength = judged_bodies(machine)
    except (ContactError, GeometryError) as error:
        return None, (), (no_stress(machine, error.message),)
    return strength, checks, ()
