"""The line of plastics that slide at output pins."""

from __future__ import annotations

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.checks.remedies import lower_shares, lower_to
from cqdd_design.gearbox.checks.rubbing import rubbing_check
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.film.plastics import rubbing_plastics, sliding_plastics
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.results import Check

_ANGLES = 120
"""Crank angles over the period at which plastics are looked at."""
_KEY = "requirements.continuous_torque"


def rubbing_lines(machine: Machine) -> tuple[Check, ...]:
    """The line at the continuous torque, or at the step of a duty with the most power.

    None where no plastic slides.
    """
    if not sliding_plastics(machine.design, machine.contact):
        return ()
    torque, speed = _hardest(machine)
    try:
        line = _judged(machine, torque, speed)
    except ContactError as error:
        return (build_check("PIN-RUBBING", None, None, error.message, "see CONTACT-REACH"),)
    if line.status != "fail" or machine.stiff:
        return (line,)
    (held,) = torques_that_hold(
        lambda lower: (_judged(machine, lower, speed),), torque, (line,), near=ROUGHLY
    ).values()
    lower = lower_to(held, _KEY)
    if machine.design.requirements.load_cases:
        lower = lower_shares(held / torque)
    return (_judged(machine, torque, speed, f"{lower}, or the speed about as much"),)


def _hardest(machine: Machine) -> tuple[float, float]:
    """Output torque, N m, and input speed, rad/s, at which they are judged."""
    asked = machine.design.requirements
    cases = [(abs(one.torque), asked.ratio * abs(one.speed)) for one in asked.load_cases]
    usual = asked.continuous_torque, asked.held_speed
    return max(cases, key=lambda case: case[0] * case[1], default=usual)


def _judged(
    machine: Machine, torque: float, speed: float, lower: str = "lower the torque or the speed"
) -> Check:
    model = machine.contact
    angles, friction = perfect_angles(model, _ANGLES), ContactFriction.of(model, "drive")
    sweep = contact_sweep(model, torque, angles, friction=friction)
    return rubbing_check(rubbing_plastics(machine.design, model, sweep, speed), torque, lower)
