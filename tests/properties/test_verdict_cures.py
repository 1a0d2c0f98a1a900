"""Torques that remedies name are ones at which the line holds, by the models that judge it.

Forces of the contact equilibrium are not in proportion to the torque: where it is less, fewer teeth
and pins share it, so a torque by proportion leaves lines failing.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.specimen import AS_DRAWN
from cqdd_design.design import Design, load_design
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.body_analysis import judged_bodies
from cqdd_design.machine.carrying import torque_limits
from cqdd_design.machine.cures import torques_that_hold
from cqdd_design.machine.screws import screw_joints
from cqdd_design.results import Check
from cqdd_design.verdict.creep_lines import creep_lines
from cqdd_design.verdict.lines import _carried
from cqdd_design.verdict.motor import motor_lines
from cqdd_design.verdict.screw_lines import screw_lines
from cqdd_design.verdict.shaft_lines import shaft_lines

_LOWER = re.compile(r"lower the (continuous )?torque to ([\d.]+) N\*m")


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def failing(paper) -> dict[str, Check]:
    return {one.id: one for one in _carried(resolve(paper)).values() if one.status == "fail"}


@pytest.mark.parametrize(
    "check_id", ["CONTACT-PIN-PEAK", "PIN-BENDING-PEAK", "PIN-BENDING-CONTINUOUS", "BEARING-LIFE"]
)
def test_the_torque_that_a_remedy_names_is_held_and_little_more_is_not(paper, failing, check_id):
    continuous, told = _LOWER.search(failing[check_id].remedy).groups()
    for share, status in ((1.0, "pass"), (1.02, "fail")):
        torque = share * float(told)
        changes = {"requirements.continuous_torque": torque}
        if not continuous:
            changes["requirements.peak_torque"] = torque
        lines = _carried(resolve(paper.replacing(changes)))
        assert lines[check_id].status == status, share


def test_remedies_and_what_limits_the_torque_say_the_same(paper, failing):
    limits = {one.check: one.torque for one in torque_limits(resolve(paper), "peak")}
    told = {
        check_id: float(_LOWER.search(line.remedy)[2])
        for check_id, line in failing.items()
        if check_id in limits
    }
    assert len(told) == 5
    # Rounded down to three digits, and limits are looked for at a third of the angles.
    assert told == pytest.approx({one: limits[one] for one in told}, rel=8e-3)


def test_a_duty_has_no_continuous_torque_to_lower(paper):
    duty = [{"torque": 40.0, "speed": 13.0, "share": 1.0}]
    lines = _carried(resolve(paper.replacing({"requirements.duty": duty})))
    for check_id in ("CONTACT-RING-CONTINUOUS", "PIN-BENDING-CONTINUOUS", "BEARING-LIFE"):
        assert lines[check_id].status == "fail"
        assert "continuous torque" not in lines[check_id].remedy
        told = re.search(r"torques of the duty to ([\d.]+) % of", lines[check_id].remedy)
        for more, status in ((1.0, "pass"), (1.03, "fail")):
            duty[0]["torque"] = 0.4 * float(told[1]) * more
            lowered = _carried(resolve(paper.replacing({"requirements.duty": duty})))
            assert lowered[check_id].status == status, more


def test_lines_of_shaft_and_screws_hold_at_the_torque_that_they_name(paper):
    """Forces on the shaft are not in proportion to the torque, nor is the rotor's weight."""
    lines = (*shaft_lines(resolve(paper)), *screw_lines(resolve(paper)))
    failing = {one.id: one.remedy for one in lines if _LOWER.search(one.remedy)}
    assert set(failing) == {"SUPPORT-STATIC", "SCREW-SLIP"}
    for check_id, remedy in failing.items():
        torque = float(_LOWER.search(remedy)[2])
        for share, status in ((1.0, "pass"), (1.05, "fail")):
            changes = {"requirements.peak_torque": share * torque,
                       "requirements.continuous_torque": min(40.0, share * torque)}  # fmt: skip
            machine = resolve(paper.replacing(changes))
            told = {one.id: one for one in (*shaft_lines(machine), *screw_lines(machine))}
            assert told[check_id].status == status, (check_id, share)


OUTSIDE = {
    "requirements.peak_torque": 20.0,
    "requirements.continuous_torque": 5.0,
    "requirements.external_moment": 900.0,
    "requirements.external_axial": 300.0,
}


def test_screws_hold_at_the_external_loads_that_they_name(paper):
    slip = screw_lines(resolve(paper.replacing(OUTSIDE)))[0]
    assert (slip.id, slip.status) == ("SCREW-SLIP", "fail")
    told = dict(re.findall(r"(external_\w+) to ([\d.]+)", slip.remedy))
    assert set(told) == {"external_moment", "external_axial"}
    for more, status in ((1.0, "pass"), (1.05, "fail")):
        lower = {f"requirements.{key}": more * float(one) for key, one in told.items()}
        assert screw_lines(resolve(paper.replacing(OUTSIDE | lower)))[0].status == status, more


def test_bolts_that_yield_themselves_ask_for_no_stronger_housing(paper):
    def output(changes):
        joints = screw_joints(resolve(paper.replacing(OUTSIDE | changes)))
        return next(one for one in joints if one.place == "output's face")

    joint = output({})
    assert joint.clamping.screw_yields
    assert joint.cure.startswith("raise output_pins.circle_radius")
    wider = paper.reducer.output_pins.circle_radius + 5e-4
    assert output({"reducer.output_pins.circle_radius": wider}).slip_safety > joint.slip_safety
    soft = output({"housing.material": "PC-CF FDM along layers"})
    assert not soft.clamping.screw_yields
    assert soft.cure == "take a stronger housing.material"


def test_shaft_that_tires_under_a_duty_speaks_of_the_duty(paper):
    duty = [{"torque": 250.0, "speed": 13.0, "share": 1.0}]
    machine = resolve(paper.replacing({"requirements.duty": duty}))
    line = next(one for one in shaft_lines(machine) if one.id == "SHAFT-FATIGUE")
    assert line.status == "fail"
    assert "lower the torques of the duty to " in line.remedy
    assert "continuous torque" not in line.remedy


def _line(of: Callable[[float], float], line: Check) -> Callable[[float], tuple[Check, ...]]:
    """A line whose value over its limit goes with the torque as `of`."""
    return lambda torque: (replace(line, value=of(torque) * line.limit),)


def test_a_line_that_fails_at_any_torque_has_none(failing):
    line = failing["PIN-SHEAR-PEAK"]
    at = _line(lambda torque: 1.5 + torque, line)
    assert torques_that_hold(at, 20.0, at(20.0)) == {line.id: 0.0}


@pytest.mark.parametrize("power", [0.1, 0.5, 3.0])
def test_a_power_law_is_followed_to_its_limit(failing, power):
    line = failing["PIN-SHEAR-PEAK"]
    at = _line(lambda torque: (torque / 7.0) ** power, line)
    (found,) = torques_that_hold(at, 120.0, at(120.0)).values()
    assert 7.0 * (1.0 - 2e-3) ** (1.0 / power) <= found <= 7.0


@pytest.mark.parametrize("part", ["pins", "housing"])
def test_plastics_hold_the_torque_that_their_creep_names(paper_design_file, part):
    design = load_design(paper_design_file.with_name("reference-s.toml"))
    key = {"pins": "reducer.output_pins.material", "housing": "housing.material"}[part]
    torques = {"requirements.peak_torque": 6.0, "requirements.continuous_torque": 3.0}
    weak = design.replacing({key: "POM (acetal)", **torques})

    def creep(machine: Machine) -> dict[str, Check]:
        return {one.id: one for one in creep_lines(machine, _carried(machine).values())}

    name = {"pins": "PIN-CREEP", "housing": "HOUSING-CREEP"}[part]
    line = creep(resolve(weak))[name]
    assert line.status == "fail"
    told = float(_LOWER.search(line.remedy)[2])
    for share, status in ((1.0, "pass"), (1.04, "fail")):
        lowered = resolve(weak.replacing({"requirements.continuous_torque": share * told}))
        assert creep(lowered)[name].status == status, share


def test_motor_peak_names_what_binds_and_the_value_that_lets_it(paper):
    """What the driver lacks is a current; a motor at its own peak torque is cured by no driver."""

    def line(**changes: float) -> Check:
        design = paper.replacing({key.replace("__", "."): value for key, value in changes.items()})
        machine = resolve(design)
        actuator = actuator_parameters(machine, AS_DRAWN)
        return next(o for o in motor_lines(machine, actuator, "") if o.id == "MOTOR-PEAK")

    beyond = line()
    assert beyond.status == "fail"
    assert "current_limit" not in beyond.remedy
    weak = {"requirements__peak_torque": 40.0, "requirements__continuous_torque": 10.0}
    short = line(motor__current_limit=20.0, **weak)
    assert short.status == "fail"
    told = float(re.search(r"motor\.current_limit .* to about ([\d.]+) A", short.remedy)[1])
    assert line(motor__current_limit=told, **weak).status == "pass"
    assert line(motor__current_limit=0.97 * told, **weak).status == "fail"


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        (
            {"reducer.disc_material": "7075-T6", "reducer.output_pins.circle_radius": 24.4e-3,
             "requirements.peak_torque": 150.0, "requirements.continuous_torque": 90.0},
            {"LIGAMENT-STRESS", "ROOT-STRESS"},
        ),
        (
            {"reducer.disc_material": "POM (acetal)", "reducer.ring_material": "POM (acetal)",
             "requirements.peak_torque": 25.0, "requirements.continuous_torque": 20.0},
            {"PLASTIC-CREEP"},
        ),
    ],
    ids=["stress", "creep"],
)  # fmt: skip
def test_discs_hold_the_torque_that_their_remedy_names(paper_design_file, changes, names):
    design = load_design(paper_design_file.with_name("reference-s.toml")).replacing(changes)
    machine = resolve(design)
    lines = {one.id: one for one in judged_bodies(machine)[0] if one.status == "fail"}
    assert set(lines) == names
    for check_id, line in lines.items():
        load, told = re.search(r"lower the (\w+) torque to ([\d.]+) N\*m", line.remedy).groups()
        for share, status in ((1.0, "pass"), (1.04, "fail")):
            at = machine.under(**{load: share * float(told)})
            assert {o.id: o.status for o in judged_bodies(at)[0]}[check_id] == status, check_id


def test_pins_that_break_at_once_are_told_with_the_stress_there_is(paper):
    """Under 250 N m the mean stress passes the ultimate strength: no reversed stress is finite."""
    duty = [{"torque": 250.0, "speed": 10.0, "share": 0.5},
            {"torque": -60.0, "speed": 20.0, "share": 0.3}]  # fmt: skip
    machine = resolve(paper.replacing({"requirements.duty": duty}))
    line = _carried(machine)["PIN-BENDING-CONTINUOUS"]
    assert line.status == "fail"
    assert line.margin == pytest.approx(machine.life.parts[-1].reserve)
    told = re.search(r"torques of the duty to ([\d.]+) % of", line.remedy)
    lived = machine.under(duty_share=0.01 * float(told[1])).life
    assert 1.0 <= lived.parts[-1].reserve < 1.1
