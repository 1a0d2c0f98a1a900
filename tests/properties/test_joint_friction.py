"""Torque at the joint after friction: what is carried and what is lost make up the motor's."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from actuator_samples import paper_actuator

from cqdd_design.actuator.joint_side import delivered_peak_torque, held_back_torque, joint_side

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
