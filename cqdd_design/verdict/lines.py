"""Lines of a verdict from its evidence: what the first screen says gives way to closer models."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.checks.equilibrium import (
    DUTY_MODEL,
    MODEL,
    PeakLoads,
    lasting_checks,
    peak_checks,
)
from cqdd_design.gearbox.checks.guide_row import RIGID
from cqdd_design.gearbox.checks.remedies import PEAK_KEY, lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import SEARCHED_CASES, torques_that_hold
from cqdd_design.results import Check
from cqdd_design.verdict.asked import asked_lines
from cqdd_design.verdict.cam_line import cam_lines
from cqdd_design.verdict.creep_lines import creep_lines
from cqdd_design.verdict.drawn import yield_line
from cqdd_design.verdict.evidence import Evidence
from cqdd_design.verdict.joint_lines import joint_lines
from cqdd_design.verdict.motor import motor_lines, with_drag
from cqdd_design.verdict.output_seat_line import output_seat_line
from cqdd_design.verdict.retention_lines import retention_lines
from cqdd_design.verdict.rotor_lines import rotor_lines
from cqdd_design.verdict.rubbing_lines import rubbing_lines
from cqdd_design.verdict.screw_lines import screw_lines
from cqdd_design.verdict.shaft_lines import shaft_lines

_BODIES = tuple(
    f"{part}-{kind}" for part in ("LIGAMENT", "ROOT", "RING") for kind in ("STRESS", "FATIGUE")
)
_HEAT = ("THERMAL-RISE", "THERMAL-CLEARANCE")


def with_drawn(evidence: Evidence, lines: Sequence[Check]) -> tuple[Check, ...]:
    """Every line: those of perfect parts, yield, and what else is asked."""
    drawn = yield_line(evidence.machine, evidence.drawn, evidence.drawn_missing, lines)
    asked = with_drag(asked_lines(evidence, lines), evidence.machine.motor)
    return (*lines, drawn, *asked)


def lines_without_drawn(evidence: Evidence) -> tuple[Check, ...]:
    """Lines of perfect parts, in the order of the first screen, then bodies, heat and motor."""
    machine = evidence.machine
    carried = _carried(machine)
    lines: list[Check] = []
    for check in machine.analysis.checks:
        if check.id.startswith("MOTOR-"):
            continue
        lines.append(carried.pop(check.id, check))
    lines += (
        *carried.values(),
        *shaft_lines(machine),
        output_seat_line(machine, evidence.temperatures),
        *rotor_lines(machine),
        *joint_lines(machine, evidence.temperatures),
        *cam_lines(machine, evidence.temperatures),
        *screw_lines(machine, evidence.temperatures),
        *retention_lines(machine, evidence.temperatures),
        *rubbing_lines(machine),
    )
    lines += creep_lines(machine, lines)
    lines += evidence.stress_checks or _missing(_BODIES, evidence.stress_missing)
    lines += evidence.heat_checks or _missing(_HEAT, evidence.heat_missing)
    lines += motor_lines(
        machine,
        evidence.actuator,
        evidence.actuator_missing,
        uncooled="" if machine.design.drive.thermal_resistance else evidence.heat_missing,
        lasting=evidence.lasting_torque,
    )
    return with_drag(lines, machine.motor)


def _carried(machine: Machine) -> dict[str, Check]:
    """Lines of the contact equilibrium by id; unknown where it has no answer."""
    state, contacts = machine.analysis, machine.loaded_contacts
    peak, steady = (
        machine.design.requirements.peak_torque,
        machine.design.requirements.continuous_torque,
    )
    found: dict[str, Check] = {
        check.id: build_check(
            check.id,
            None,
            check.limit,
            "the gearbox has no contact equilibrium at this load",
            "see CONTACT-REACH",
            model=DUTY_MODEL if check.id.endswith(("CONTINUOUS", "LIFE")) else MODEL,
        )
        for check in state.checks
        if check.basis == RIGID
    }
    try:
        loads = PeakLoads.of(peak, contacts.greatest(peak))
        cures = torques_that_hold(
            lambda torque: peak_checks(state, PeakLoads.of(torque, contacts.greatest(torque))),
            peak,
            peak_checks(state, loads),
        )
        found |= {check.id: check for check in peak_checks(state, loads, cures)}
    except ContactError as error:
        reach = contacts.reach(peak)
        found["CONTACT-REACH"] = build_check(
            "CONTACT-REACH",
            reach,
            peak,
            error.message,
            (f"{lower_peak(reach, steady, PEAK_KEY)}, or " if reach else "")
            + "make discs and pins thicker or the clearances smaller",
        )
    # Without an answer what stands there already says so.
    with suppress(ContactError):
        found |= {check.id: check for check in _lasting(machine)}
    return found


def _lasting(machine: Machine) -> tuple[Check, ...]:
    """Lines over the duty; ContactError where a case has no equilibrium."""
    state, lived = machine.analysis, machine.life
    found = lasting_checks(state, lived)
    if len(lived.duty) > SEARCHED_CASES:
        return found

    def at(share: float) -> tuple[Check, ...]:
        return lasting_checks(state, machine.under(duty_share=share).life)

    return lasting_checks(state, lived, torques_that_hold(at, 1.0, found))


def _missing(ids: tuple[str, ...], why: str) -> tuple[Check, ...]:
    """Lines of a model that has no answer."""
    return tuple(build_check(one, None, None, why, "see why there is none") for one in ids)
