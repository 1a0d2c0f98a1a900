"""MJCF as text, and the closed forms behind it; `tests/cli/test_mujoco_client.py` runs it."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from actuator_samples import frictionless, paper_actuator, random_actuators
from hypothesis import given, settings
from scipy.integrate import solve_ivp

from cqdd_design import __version__
from cqdd_design.actuator.parameters import ActuatorParameters, ThermalParameters
from cqdd_design.exporting.joint_side import joint_side, ripple_harmonics, single_node
from cqdd_design.exporting.mjcf import (
    MjcfOptions,
    fragment_text,
    model_text,
    write_fragment,
    write_test_model,
)
from cqdd_design.exporting.mjcf_classes import HOST_STEP, time_step
from cqdd_design.exporting.xml_text import comment, identifier, number


def motor_of(text: str, name: str) -> dict[str, str]:
    """Attributes of the motor's class."""
    found = ElementTree.fromstring(text).find(f".//default[@class='{name}']/dcmotor")
    assert found is not None
    return dict(found.attrib)


@settings(max_examples=60, deadline=None)
@given(p=random_actuators())
def test_numbers_of_the_motor_arrive(p: ActuatorParameters) -> None:
    for text in (model_text(p, "a"), fragment_text(p, "a")):
        motor = motor_of(text, "a")
        assert float(motor["gear"]) == abs(p.gear.ratio)
        assert float(motor["resistance"]) == pytest.approx(p.motor.resistance, rel=1e-8)
        assert float(motor["armature"]) == pytest.approx(
            p.motor.rotor_inertia + p.gear.input_inertia, rel=1e-8
        )
        limits = [float(one) for one in motor["ctrlrange"].split()]
        assert limits == pytest.approx([-p.drive.supply_voltage, p.drive.supply_voltage], rel=1e-8)
        assert float(motor["saturation"].split()[1]) == pytest.approx(
            p.drive.current_limit, rel=1e-8
        )


@settings(max_examples=60, deadline=None)
@given(p=random_actuators())
def test_friction_generates_no_energy(p: ActuatorParameters) -> None:
    """LuGre's condition sigma2 >= sigma1 (static - coulomb)/coulomb, at both sides."""
    root = ElementTree.fromstring(model_text(p, "a"))
    written = [one for one in root.iter("dcmotor") if "lugre" in one.attrib]
    coulomb = p.friction.motor_coulomb + p.motor.hysteresis
    assert len(written) == (coulomb > 0.0) + (p.friction.output_coulomb > 0.0)
    for one in written:
        stiffness, damping, running, static, _ = map(float, one.attrib["lugre"].split())
        assert static >= running > 0.0
        assert stiffness > 0.0
        if static > running:
            most = float(one.attrib["damping"]) * running / (static - running)
            assert damping <= most * (1.0 + 1e-6) + 1e-12


@settings(max_examples=60, deadline=None)
@given(p=random_actuators())
def test_bristles_suit_the_step(p: ActuatorParameters) -> None:
    """As stiff as breakaway over deflection, or as a step of a robot bears."""
    whole = p.friction.motor_coulomb * (1.0 + p.friction.stribeck_extra) + p.motor.hysteresis
    if whole == 0.0:
        return
    wanted = whole / p.friction.bristle_deflection
    for text, step in ((model_text(p, "a"), time_step(p)), (fragment_text(p, "a"), 2e-3)):
        stiffness = float(motor_of(text, "a")["lugre"].split()[0])
        bearable = p.motor_side_inertia * (0.5 / step) ** 2
        assert stiffness == pytest.approx(min(wanted, bearable), rel=1e-6)


@settings(max_examples=60, deadline=None)
@given(p=random_actuators())
def test_ripple_does_the_work_of_the_kinematic_error(p: ActuatorParameters) -> None:
    """Between any two angles the ripple takes up T times the change of eps; over a turn none."""
    gear = p.gear

    def error(output: float) -> float:
        phase = gear.error_orders * gear.ratio * output / abs(gear.ratio)
        return float(gear.error_cosine @ np.cos(phase) + gear.error_sine @ np.sin(phase))

    def work(output: float) -> float:
        return sum(
            one.amplitude
            * (math.cos(one.phase) - math.cos(one.order * output + one.phase))
            / one.order
            for one in ripple_harmonics(p, 7.0)
        )

    scale = 7.0 * float(np.abs(gear.error_cosine).sum() + np.abs(gear.error_sine).sum())
    for output in (0.3, 1.7, -2.4, 5.9):
        assert work(output) == pytest.approx(
            -7.0 * (error(output) - error(0.0)), abs=1e-9 * scale + 1e-15
        )
    assert work(2.0 * math.pi) == pytest.approx(0.0, abs=1e-9 * scale + 1e-15)


def test_ripple_scales_with_the_torque_carried_and_turns_with_its_sign() -> None:
    p = paper_actuator()
    for one, twice, back in zip(
        ripple_harmonics(p, 5.0), ripple_harmonics(p, 10.0), ripple_harmonics(p, -5.0), strict=True
    ):
        assert twice.amplitude == pytest.approx(2.0 * one.amplitude)
        assert math.cos(back.phase - one.phase) == pytest.approx(-1.0)


def test_one_thermal_node_for_two() -> None:
    """Same steady rise, and the same decay once the quick mode is gone."""
    thermal = ThermalParameters(0.4, 0.8, 120.0, 900.0)
    resistance, constant = single_node(thermal)
    assert resistance == pytest.approx(1.2)

    def rates(_: float, rise: np.ndarray) -> list[float]:
        flow, out = (rise[0] - rise[1]) / 0.4, rise[1] / 0.8
        return [-flow / 120.0, (flow - out) / 900.0]

    late = solve_ivp(rates, (0.0, 3000.0), [80.0, 40.0], rtol=1e-10, atol=1e-12, dense_output=True)
    first, second = late.sol(1500.0)[0], late.sol(2500.0)[0]
    assert 1000.0 / math.log(first / second) == pytest.approx(constant, rel=1e-6)


def test_bytes_are_reproducible_and_carry_their_origin(tmp_path: Path) -> None:
    p = paper_actuator()
    for writer in (write_test_model, write_fragment):
        first = writer(p, "paper", tmp_path / "a.xml", design_sha256="c0ffee")
        second = writer(p, "paper", tmp_path / "b.xml", design_sha256="c0ffee")
        assert first.sha256 == second.sha256
        text = first.path.read_text()
        assert f"cqdd-design {__version__}" in text
        assert "c0ffee" in text
        assert "signed ratio is -10" in text


def test_names_that_xml_or_mujoco_would_not_bear() -> None:
    assert identifier("a--b/c") == "a-b-c"
    for text in (model_text(paper_actuator(), "a--b<&"), fragment_text(paper_actuator(), "a--b<&")):
        root = ElementTree.fromstring(text)
        assert root.find(".//default[@class='a-b<&']") is not None
    assert "--" not in comment(["x -- y --- z"])[4:-3]


@pytest.mark.parametrize("value", [0.1, 1e-12, -3.0, 10.0, 123456789.0, math.pi])
def test_numbers_as_text(value: float) -> None:
    assert float(number(value)) == pytest.approx(value, rel=1e-8)


def test_small_harmonics_are_left_out_and_said_to_be() -> None:
    p = paper_actuator()
    text = model_text(p, "a")
    assert "a-ripple-11" in text
    assert "a-ripple-20" not in text
    assert "Left out as small: 1 harmonics" in " ".join(text.split())
    assert "ripple-" not in model_text(p, "a", options=MjcfOptions(ripple=False))


def test_the_step_suits_the_stiffest_friction() -> None:
    p = paper_actuator()
    assert time_step(p) == pytest.approx(1e-4)
    assert time_step(frictionless(p)) == pytest.approx(5e-4)
    stiffer = dataclasses.replace(p.friction, bristle_deflection=1e-5)
    assert time_step(dataclasses.replace(p, friction=stiffer)) == pytest.approx(1e-5)
    assert time_step(p) < HOST_STEP


def test_the_speed_and_torque_of_the_corner() -> None:
    """Peak torque and no-load speed by the motor's own equation."""
    side = joint_side(paper_actuator())
    motor_speed = 10.0 * side.corner_speed
    assert (24.0 - 0.178 * motor_speed) / 0.098 == pytest.approx(50.5)
    assert side.peak_torque == pytest.approx(89.89)
    current = (24.0 - 0.178 * 10.0 * side.no_load_speed) / 0.098
    drag = side.coulomb + side.viscous * side.no_load_speed
    assert 1.78 * current == pytest.approx(drag)
    assert 0.0 < side.continuous_torque < side.peak_torque
