"""MJCF as text, and the closed forms behind it; `tests/cli/test_mujoco_client.py` runs it."""

from __future__ import annotations

import dataclasses
import math
from xml.etree import ElementTree

import numpy as np
import pytest
from actuator_samples import frictionless, paper_actuator, random_actuators, without_ripple
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from cqdd_design import __version__
from cqdd_design.actuator.joint_side import joint_side, ripple_harmonics
from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters, ThermalParameters
from cqdd_design.actuator.thermal import single_node
from cqdd_design.errors import DesignError
from cqdd_design.exporting.simulators.mjcf import fragment_text, model_text
from cqdd_design.exporting.simulators.mjcf_classes import (
    HOST_STEP,
    MjcfActuator,
    time_step,
)
from cqdd_design.exporting.simulators.xml_text import comment, identifier, number


def motor_of(text: str, name: str) -> dict[str, str]:
    """Attributes of the motor's class."""
    found = ElementTree.fromstring(text).find(f".//default[@class='{name}']/dcmotor")
    assert found is not None
    return dict(found.attrib)


@settings(max_examples=examples(60), deadline=None)
@given(p=random_actuators())
def test_numbers_of_the_motor_arrive(p: ActuatorParameters) -> None:
    for text in (model_text(MjcfActuator(p, "a")), fragment_text(MjcfActuator(p, "a"))):
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


@settings(max_examples=examples(60), deadline=None)
@given(p=random_actuators())
def test_friction_generates_no_energy(p: ActuatorParameters) -> None:
    """LuGre's condition sigma2 >= sigma1 (static - coulomb)/coulomb, at both sides."""
    root = ElementTree.fromstring(model_text(MjcfActuator(p, "a")))
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


@settings(max_examples=examples(60), deadline=None)
@given(p=random_actuators())
def test_bristles_suit_the_step(p: ActuatorParameters) -> None:
    """As stiff as breakaway over deflection, or as a step of a robot bears."""
    whole = p.friction.motor_coulomb * (1.0 + p.friction.stribeck_extra) + p.motor.hysteresis
    if whole == 0.0:
        return
    wanted = whole / p.friction.bristle_deflection
    model = MjcfActuator(p, "a")
    for text, step in ((model_text(model), time_step(p)), (fragment_text(model), 2e-3)):
        stiffness = float(motor_of(text, "a")["lugre"].split()[0])
        bearable = p.motor_side_inertia * (0.5 / step) ** 2
        assert stiffness == pytest.approx(min(wanted, bearable), rel=1e-6)


def with_stiffness(
    p: ActuatorParameters, cosine: float, sine: float, power: float
) -> GearParameters:
    """Stiffness that varies at every order of the kinematic error alike, and an exponent."""
    count = len(p.gear.error_orders)
    waves = {"stiffness_cosine": np.full(count, cosine), "stiffness_sine": np.full(count, sine)}
    return dataclasses.replace(p.gear, stiffening=power, **waves)


def told(p: ActuatorParameters, torque: float, joint: float) -> float:
    """Ripple at an angle of the joint by the harmonics."""
    found = ripple_harmonics(p, torque)
    return sum(one.amplitude * math.sin(one.order * joint + one.phase) for one in found)


@settings(max_examples=examples(40), deadline=None)
@given(
    p=random_actuators(),
    cosine=st.floats(-0.05, 0.05),
    sine=st.floats(-0.05, 0.05),
    power=st.floats(1.0, 3.0),
    torque=st.floats(1.0, 30.0),
    sense=st.sampled_from([1.0, -1.0]),
)
def test_ripple_is_that_of_the_stored_energy(
    p: ActuatorParameters, cosine: float, sine: float, power: float, torque: float, sense: float
) -> None:
    """The spring is closed until the energy's slope over the crank is the motor's torque."""
    gear = with_stiffness(p, cosine, sine, power)
    p = dataclasses.replace(p, gear=gear)
    torque = sense * torque

    def wave(cosines: np.ndarray, sines: np.ndarray, joint: float) -> float:
        phase = gear.error_orders * gear.ratio * joint / abs(gear.ratio)
        return float(cosines @ np.cos(phase) + sines @ np.sin(phase))

    def energy(joint: float, output: float) -> float:
        closing = joint + wave(gear.error_cosine, gear.error_sine, joint) - output
        share = 1.0 + wave(gear.stiffness_cosine, gear.stiffness_sine, joint)
        held = gear.error_torque * (gear.stiffness * abs(closing) / gear.error_torque) ** power
        return share * held * abs(closing) / (power + 1.0)

    def carried(joint: float) -> float:
        def missing(output: float) -> float:
            slope = energy(joint + nudge, output) - energy(joint - nudge, output)
            return slope / (2.0 * nudge) - torque

        middle = joint + wave(gear.error_cosine, gear.error_sine, joint)
        windup = (abs(torque) / gear.error_torque) ** (1.0 / power)
        windup *= 3.0 * gear.error_torque / gear.stiffness
        nudge = 1e-6 * windup
        output = brentq(missing, middle - sense * windup, middle, xtol=1e-12 * windup)
        slope = energy(joint, output - nudge) - energy(joint, output + nudge)
        return float(slope / (2.0 * nudge))

    turn = 2.0 * math.pi * np.arange(4) / 4.0 + 0.37
    found = np.array([carried(joint) for joint in turn])
    written = np.array([told(p, torque, joint) for joint in turn])
    # The mean over the turn belongs to no harmonic: compare differences. Small harmonics are not
    # told, each less than a ten-thousandth of the largest.
    largest = max((one.amplitude for one in ripple_harmonics(p, torque)), default=0.0)
    close = 1e-5 * abs(torque) + 5e-3 * largest
    assert found - found[0] == pytest.approx(written - written[0], abs=close)


def test_parts_of_the_ripple_over_the_torque() -> None:
    """Closed forms where it is small: -T d(eps)/dq, and T d kappa'/(p + 1) of the stiffness."""
    p = paper_actuator()
    nothing = np.zeros(5)
    error = dataclasses.replace(
        p.gear, error_cosine=np.array([0.0, 0.0, 1e-7, 0.0, 0.0]), error_sine=nothing
    )
    kappa = dataclasses.replace(
        p.gear,
        error_cosine=nothing,
        error_sine=nothing,
        stiffness_cosine=np.array([0.0, 0.0, 1e-5, 0.0, 0.0]),
        stiffening=1.5,
    )
    for torque in (5.0, 10.0, -10.0):
        sense = math.copysign(1.0, torque)
        (one,) = ripple_harmonics(dataclasses.replace(p, gear=error), torque)
        assert one.order == 10
        # eps = a cos 10 q: Q = 10 a T sin 10 q.
        assert one.amplitude == pytest.approx(1e-6 * abs(torque), rel=1e-4)
        assert math.cos(one.phase) == pytest.approx(sense, rel=1e-4)
        (one,) = ripple_harmonics(dataclasses.replace(p, gear=kappa), torque)
        windup = 5.0 / 1e4 * (abs(torque) / 5.0) ** (1.0 / 1.5)
        assert one.amplitude == pytest.approx(abs(torque) * windup * 1e-4 / 2.5, rel=1e-3)
        # s = 1 + kappa cos 10 q: Q = 10 kappa |T| d/(p + 1) sin 10 q, whatever the torque's sign.
        assert math.cos(one.phase) == pytest.approx(1.0, rel=1e-4)


def test_no_ripple_without_torque_or_harmonics() -> None:
    p = paper_actuator()
    assert ripple_harmonics(p, 0.0) == ()
    none = {key: np.zeros(0) for key in ("error_cosine", "error_sine")}
    none |= {key: np.zeros(0) for key in ("stiffness_cosine", "stiffness_sine")}
    gear = dataclasses.replace(p.gear, error_orders=np.zeros(0, dtype=np.int64), **none)
    assert ripple_harmonics(dataclasses.replace(p, gear=gear)) == ()


def test_an_error_that_turns_the_output_back_is_refused() -> None:
    p = paper_actuator()
    gear = dataclasses.replace(p.gear, error_cosine=np.array([0.0, 0.0, 0.2, 0.0, 0.0]))
    with pytest.raises(DesignError, match=r"gear\.error_cosine .* at 5 N\*m"):
        model_text(MjcfActuator(dataclasses.replace(p, gear=gear), "a"))


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


def test_texts_are_reproducible_and_carry_their_origin() -> None:
    p = paper_actuator()
    for written in (model_text, fragment_text):
        text = written(MjcfActuator(p, "paper", design_sha256="c0ffee"))
        assert text == written(MjcfActuator(p, "paper", design_sha256="c0ffee"))
        assert f"cqdd-design {__version__}" in text
        assert "c0ffee" in text
        assert "signed ratio is -10" in text


def test_names_that_xml_or_mujoco_would_not_bear() -> None:
    assert identifier("a--b/c") == "a-b-c"
    model = MjcfActuator(paper_actuator(), "a--b<&")
    for text in (model_text(model), fragment_text(model)):
        root = ElementTree.fromstring(text)
        assert root.find(".//default[@class='a-b<&']") is not None
    assert "--" not in comment(["x -- y --- z"])[4:-3]


@pytest.mark.parametrize("value", [0.1, 1e-12, -3.0, 10.0, 123456789.0, math.pi])
def test_numbers_as_text(value: float) -> None:
    assert float(number(value)) == pytest.approx(value, rel=1e-8)


def test_small_harmonics_are_left_out_and_said_to_be() -> None:
    p = paper_actuator()
    text = model_text(MjcfActuator(p, "a"))
    assert "a-ripple-11" in text
    assert "a-ripple-20" not in text
    found = ripple_harmonics(p)
    most = max(one.amplitude for one in found)
    small = [one for one in found if one.amplitude < 0.01 * most]
    assert 20 in [one.order for one in small]
    assert all(f'a-ripple-{one.order}"' not in text for one in small)
    assert f"Left out as small: {len(small)} harmonics" in " ".join(text.split())
    assert "ripple-" not in model_text(MjcfActuator(without_ripple(p), "a"))


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
