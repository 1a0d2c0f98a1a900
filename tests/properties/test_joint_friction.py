"""Torque at the joint after friction: what is carried and what is lost make up the motor's."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from actuator_samples import paper_actuator

from cqdd_design.actuator.bench.steady import peak_torque, stall_torque
from cqdd_design.actuator.joint_side import delivered_peak_torque, held_back_torque, joint_side
from cqdd_design.actuator.motor import beyond_peak
from cqdd_design.exporting.simulators.actuator_card import actuator_card, card_markdown
from cqdd_design.exporting.simulators.bam import bam_document
from cqdd_design.exporting.simulators.mjcf import model_text
from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator
from cqdd_design.exporting.simulators.urdf import urdf_text

HYSTERESIS, COULOMB, OUTER, FORWARD, EXTRA = 0.01, 0.03, 0.8, 0.07, 0.4


@pytest.fixture(scope="module")
def rough():
    p = paper_actuator()
    friction = replace(
        p.friction,
        motor_coulomb=COULOMB,
        output_coulomb=OUTER,
        load_forward=FORWARD,
        stribeck_extra=EXTRA,
    )
    return replace(p, motor=replace(p.motor, hysteresis=HYSTERESIS), friction=friction)


def test_what_is_delivered_and_what_is_lost_on_the_way_make_up_the_peak(rough):
    peak = 10.0 * 0.178 * 50.5
    delivered = delivered_peak_torque(rough, joint_side(rough))
    carried = delivered + OUTER
    assert carried * (1.0 + FORWARD) + 10.0 * (COULOMB + HYSTERESIS) == pytest.approx(peak)


def test_friction_that_holds_the_motor_delivers_nothing(rough):
    stuck = replace(rough, friction=replace(rough.friction, motor_coulomb=9.0))
    assert delivered_peak_torque(stuck, joint_side(stuck)) == 0.0


def test_on_a_locked_output_friction_holds_back_what_the_gear_does_not_carry(rough):
    peak = 10.0 * 0.178 * 50.5
    carried = peak - held_back_torque(rough, joint_side(rough))
    assert carried * (1.0 + FORWARD * (1.0 + EXTRA)) == pytest.approx(peak)


OWN_PEAK = 4.0
"""N m, of a motor that bears less than the drive's 50.5 A give it."""


@pytest.fixture(scope="module")
def weak(rough):
    return replace(rough, motor=replace(rough.motor, peak_torque=OWN_PEAK))


def test_a_motor_that_bears_less_than_the_drive_gives_ends_the_peak_torque(weak):
    side = joint_side(weak)
    assert side.peak_torque == pytest.approx(10.0 * OWN_PEAK)
    assert side.peak_torque == pytest.approx(peak_torque(weak).value)
    held = side.peak_torque - held_back_torque(weak, side)
    assert stall_torque(weak).value < held + OUTER
    current, motor = OWN_PEAK / 0.178, weak.motor
    volts = weak.drive.supply_voltage - motor.resistance * current
    assert side.corner_speed == pytest.approx(volts / (10.0 * motor.torque_constant))
    assert joint_side(replace(weak, motor=replace(motor, peak_torque=12.0))).peak_torque > 89.0


def test_files_for_simulators_name_the_limit_that_binds(rough, weak):
    for parameters, told in ((weak, "the motor's own peak torque, 22.47 of"), (rough, "drive's")):
        for text in (urdf_text(parameters, "a"), model_text(MjcfActuator(parameters, "a"))):
            flat = " ".join(text.split())
            assert told in flat
            assert ("own peak torque" in flat) == (parameters is weak)
    card = card_markdown(actuator_card(weak, "a"))
    assert "not the 40 N m that motor and drive allow" in card
    assert bam_document(weak, "a")["_limits"]["peak_torque_Nm"] == pytest.approx(40.0)
    assert 'saturation="4 50.5 0"' in model_text(MjcfActuator(weak, "a"))
    assert 'saturation="0 50.5 0"' in model_text(MjcfActuator(rough, "a"))


def test_currents_beyond_the_motors_own_peak_are_told_with_the_limit_that_cures_it(rough, weak):
    at_peak = OWN_PEAK / 0.178
    told = beyond_peak(weak.motor, [[0.0, -at_peak], [2.0 * at_peak, at_peak]])
    assert "peak torque of 4 N*m in 25.00% of the records" in told
    assert "motor.current_limit to 22.5 A" in told
    assert beyond_peak(weak.motor, [at_peak, -at_peak]) == ""
    unknown = replace(weak.motor, peak_torque=float("nan"))
    assert beyond_peak(unknown, [1e3]) == ""
