"""The MJCF export in MuJoCo 4 itself, against closed forms of the parameters.

The formulas here are written out again from the parameters, not taken from the exporter.
"""

from __future__ import annotations

import dataclasses
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import examples
from hypothesis import HealthCheck, assume, given, settings

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from actuator_samples import frictionless, paper_actuator, random_actuators, without_ripple

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.exporting.simulators.mjcf import (
    actuator_lines,
    fragment_text,
    joint_lines,
    model_text,
    tendon_lines,
)
from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator

mujoco = pytest.importorskip("mujoco", minversion="4.0.0", reason="MuJoCo 4 is not installed")

CLOSE = 0.005
"""The agreement asked for."""
HELD = 1e9
"""Damping, N m s/rad, of a hinge that stands still."""


def load(text: str) -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def run(model: Any, data: Any, steps: int) -> np.ndarray:
    """Angle and speed of the output at every step, from the model's sensors."""
    found = np.empty((steps, 2))
    for at in range(steps):
        mujoco.mj_step(model, data)
        found[at] = data.sensordata[:2]
    return found


def mass_matrix(model: Any, data: Any) -> np.ndarray:
    mujoco.mj_forward(model, data)
    found = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, found)
    return found


def kinematic_error(p: ActuatorParameters, output: np.ndarray) -> np.ndarray:
    """eps by its definition, at the crank angles that put the output at `output`."""
    gear = p.gear
    crank = gear.ratio * output
    phase = gear.error_orders[:, None] * crank / abs(gear.ratio)
    waves = gear.error_cosine[:, None] * np.cos(phase) + gear.error_sine[:, None] * np.sin(phase)
    return waves.sum(axis=0)


def test_loads_from_files(tmp_path: Path) -> None:
    p = paper_actuator()
    alone, included = tmp_path / "paper-test.xml", tmp_path / "paper.xml"
    alone.write_text(model_text(MjcfActuator(p, "paper")))
    included.write_text(fragment_text(MjcfActuator(p, "paper")))
    model = mujoco.MjModel.from_xml_path(str(alone))
    assert (model.nq, model.nu) == (2, 1)
    assert mujoco.MjModel.from_xml_path(str(included)).nu == 0


@pytest.mark.parametrize("ratio", [-10.0, 10.0, -11.0])
@pytest.mark.parametrize("backlash", [True, False])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_positive_command_gives_positive_motion(ratio: float, backlash: bool, sense: float) -> None:
    model, data = load(model_text(MjcfActuator(paper_actuator(ratio), "paper", backlash=backlash)))
    data.ctrl[0] = 6.0 * sense
    moved = run(model, data, 1000)[-1]
    assert sense * moved[0] > 0.01
    assert sense * moved[1] > 0.5


@pytest.mark.parametrize("kind", ["torque", "impedance"])
def test_sense_of_the_other_commands(kind: str) -> None:
    text = model_text(MjcfActuator(paper_actuator(), "paper")).replace(
        '<dcmotor name="paper" class="paper" ', f'<dcmotor name="paper" class="paper-{kind}" '
    )
    model, data = load(text)
    # Of the motor: a torque of 1 N m, or an angle of 2 rad, which is 0.2 rad at the joint.
    data.ctrl[0] = 1.0 if kind == "torque" else 2.0
    angles = run(model, data, 20000 if kind == "impedance" else 1000)[:, 0]
    assert angles[-1] > 0.05
    if kind == "impedance":
        # What friction holds off: breakaway over stiffness, and half the backlash.
        assert angles[-1] == pytest.approx(0.2, abs=1.24 / 60.0 + 0.002)


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
@pytest.mark.parametrize("backlash", [True, False])
def test_no_load_speed(ratio: float, backlash: bool) -> None:
    p = paper_actuator(ratio)
    model, data = load(model_text(MjcfActuator(p, "paper", backlash=backlash)))
    data.ctrl[0] = p.drive.supply_voltage
    speeds = run(model, data, 4000)[2000:, 1]
    motor, friction, n = p.motor, p.friction, abs(ratio)
    drag = friction.motor_coulomb + motor.hysteresis + friction.output_coulomb / n
    viscous = friction.motor_viscous + motor.iron_loss + friction.output_viscous / n**2
    constant, resistance = motor.torque_constant, motor.resistance
    expected = (constant * p.drive.supply_voltage / resistance - drag) / (
        constant**2 / resistance + viscous
    )
    assert speeds.mean() == pytest.approx(expected / n, rel=CLOSE)
    # Friction is felt, so that the agreement says something.
    assert expected < 0.997 * p.drive.supply_voltage / constant


@pytest.mark.parametrize(
    ("voltage", "current"), [(24.0, 50.5), (24.0, 20.0), (3.0, 50.5)], ids=["drive", "low", "volts"]
)
def test_stall_torque(voltage: float, current: float) -> None:
    p = paper_actuator(voltage=voltage, current=current)
    model, data = load(model_text(MjcfActuator(p, "paper", backlash=False)))
    model.dof_damping[:] = HELD
    data.ctrl[0] = voltage
    steps = math.ceil(12.0 * p.motor.inductance / p.motor.resistance / model.opt.timestep)
    run(model, data, steps)
    mujoco.mj_forward(model, data)
    amps = min(voltage / p.motor.resistance, current)
    at_joint = data.actuator_force[0] * model.actuator_gear[0, 0]
    assert at_joint == pytest.approx(10.0 * p.motor.torque_constant * amps, rel=CLOSE)


@pytest.mark.parametrize("ratio", [-10.0, 7.0])
def test_reflected_inertia(ratio: float) -> None:
    p = paper_actuator(ratio)
    outer = p.gear.output_inertia
    whole = ratio**2 * (p.motor.rotor_inertia + p.gear.input_inertia) + outer
    rigid = mass_matrix(*load(model_text(MjcfActuator(p, "paper", backlash=False))))
    assert rigid == pytest.approx(np.array([[whole]]), rel=CLOSE)
    loose = mass_matrix(*load(model_text(MjcfActuator(p, "paper"))))
    assert loose == pytest.approx(np.array([[whole, outer], [outer, outer]]), rel=CLOSE)


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
@pytest.mark.parametrize("torque", [5.0, 20.0])
def test_ripple_is_the_work_of_the_kinematic_error(ratio: float, torque: float) -> None:
    p = frictionless(paper_actuator(ratio))
    p = dataclasses.replace(p, gear=dataclasses.replace(p.gear, error_torque=torque))
    model, data = load(model_text(MjcfActuator(p, "paper")))
    angles = 2.0 * math.pi * np.arange(512) / 512
    felt = np.empty(angles.size)
    for at, angle in enumerate(angles):
        data.qpos[0] = angle
        mujoco.mj_forward(model, data)
        felt[at] = data.qfrc_actuator[0]
    nudge = 1e-5
    slope = kinematic_error(p, angles + nudge) - kinematic_error(p, angles - nudge)
    expected = -torque * slope / (2.0 * nudge)
    assert felt == pytest.approx(expected, abs=CLOSE * np.abs(expected).max())
    spectrum = np.abs(np.fft.rfft(felt)) / 256.0
    orders = p.gear.error_orders
    amplitudes = torque * orders * np.hypot(p.gear.error_cosine, p.gear.error_sine)
    kept = amplitudes > 0.01 * amplitudes.max()
    assert kept.sum() == 4
    assert set(np.flatnonzero(spectrum > 1e-6)) == set(orders[kept])
    assert spectrum[orders[kept]] == pytest.approx(amplitudes[kept], rel=CLOSE)


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
def test_cogging_pulls_into_its_rest_positions(ratio: float) -> None:
    """-A sin(k theta) at the motor, as the actuator's own model has it."""
    p = paper_actuator(ratio)
    p = dataclasses.replace(p, friction=frictionless(p).friction)
    p = dataclasses.replace(p, motor=dataclasses.replace(p.motor, hysteresis=0.0))
    model, data = load(model_text(MjcfActuator(without_ripple(p), "paper", backlash=False)))
    for crank in (0.01, 0.04, -0.02):
        data.qpos[0] = crank / ratio
        mujoco.mj_forward(model, data)
        force = data.qfrc_actuator[0] / ratio
        assert force == pytest.approx(-0.02 * math.sin(42.0 * crank), rel=CLOSE)


def test_backlash_range_and_stiffness_of_its_ends() -> None:
    p = frictionless(paper_actuator())
    model, data = load(model_text(MjcfActuator(without_ripple(p), "paper")))
    model.dof_damping[0] = HELD
    model.dof_damping[1] = 0.05

    def pushed(torque: float) -> float:
        mujoco.mj_resetData(model, data)
        # The torque acts on the output, whose angle is the sum of both hinges.
        data.qfrc_applied[:] = torque
        run(model, data, 8000)
        return float(data.qpos[1])

    assert pushed(0.005) - pushed(-0.005) == pytest.approx(p.gear.backlash, rel=CLOSE)
    assert pushed(40.0) - 0.5 * p.gear.backlash == pytest.approx(40.0 / p.gear.stiffness, rel=0.01)
    # The hinge does not hold the output inside.
    data.qfrc_applied[:] = 0.0
    data.qpos[1], data.qvel[1] = 0.0, 0.01
    mujoco.mj_forward(model, data)
    assert data.nefc == 0


@pytest.mark.parametrize("voltage", [24.0, -24.0, 0.0])
def test_four_thousand_steps_are_stable(voltage: float) -> None:
    p = paper_actuator()
    model, data = load(model_text(MjcfActuator(p, "paper")))
    data.ctrl[0] = voltage
    data.qvel[:] = (5.0, -5.0) if voltage == 0.0 else 0.0
    speeds = run(model, data, 4000)[:, 1]
    assert np.all(np.isfinite(speeds))
    most = p.drive.supply_voltage / (10.0 * p.motor.torque_constant)
    assert np.abs(speeds).max() < 1.02 * most
    if voltage == 0.0:
        # Short-circuited, it comes to rest and stays there.
        assert np.abs(speeds[-200:]).max() < 1e-3


HOST = """
<mujoco>
  <compiler angle="{angle}"/>
  <option timestep="0.002" integrator="implicitfast"/>
  <include file="paper.xml"/>
  <worldbody>
    <body name="thigh" pos="0 0 1">
      {hip}
      <inertial pos="0 0 -0.15" mass="2" diaginertia="0.02 0.02 0.01"/>
      <body name="shank" pos="0 0 -0.3">
        {knee}
        <inertial pos="0 0 -0.15" mass="1" diaginertia="0.01 0.01 0.005"/>
      </body>
    </body>
  </worldbody>
  <tendon>{tendon}</tendon>
  <actuator>{actuators}</actuator>
</mujoco>
"""


@pytest.mark.parametrize("angle", ["radian", "degree"])
def test_fragment_in_a_robot_by_the_lines_of_its_own_comment(tmp_path: Path, angle: str) -> None:
    p = paper_actuator()
    comment = fragment_text(MjcfActuator(p, "paper"))
    (tmp_path / "paper.xml").write_text(comment)
    hip = actuator_lines(MjcfActuator(p, "paper", backlash=False), "hip")
    loose = joint_lines("paper", "hip", play=True)
    ties = tendon_lines("hip")
    for text in (*hip, *joint_lines("paper", "hip", play=False), *loose, *ties):
        for line in text.splitlines():
            assert f"  {line}\n" in comment
    ending = "paper-play" if angle == "radian" else "paper-play-degree"
    robot = HOST.format(
        angle=angle,
        hip="".join(loose).replace("paper-play", ending),
        knee="".join(joint_lines("paper", "knee", play=False)),
        tendon="".join(ties),
        actuators="".join(
            (
                *actuator_lines(MjcfActuator(p, "paper"), "hip"),
                *actuator_lines(MjcfActuator(p, "paper", backlash=False), "knee"),
            )
        ),
    )
    (tmp_path / "robot.xml").write_text(robot)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    assert (model.njnt, model.nu) == (3, 2)
    assert model.joint("hip-play").range == pytest.approx(
        [-0.5 * p.gear.backlash, 0.5 * p.gear.backlash], rel=1e-8
    )
    armature = 100.0 * p.motor_side_inertia + p.gear.output_inertia
    added = mass_matrix(model, data)[2, 2] - 0.005
    assert added == pytest.approx(armature, rel=CLOSE)
    for sense in (1.0, -1.0):
        mujoco.mj_resetData(model, data)
        data.ctrl[:] = 8.0 * sense
        for _ in range(4000):
            mujoco.mj_step(model, data)
        assert np.all(np.isfinite(data.qpos))
        assert np.all(sense * data.qpos[[0, 2]] > 1.0)


@pytest.mark.parametrize("ratio", [-10.0, 10.0])
@pytest.mark.parametrize("kind", ["torque", "impedance"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_sense_of_the_other_commands_in_a_robot(
    tmp_path: Path, ratio: float, kind: str, sense: float
) -> None:
    """1 N m, or 3 rad, of the motor moves the rigid joints of a robot the same way."""
    p = paper_actuator(ratio)
    (tmp_path / "paper.xml").write_text(fragment_text(MjcfActuator(p, "paper")))
    lines = [
        line
        for joint in ("hip", "knee")
        for line in actuator_lines(MjcfActuator(p, "paper", backlash=False), joint)
    ]
    robot = HOST.format(
        angle="radian",
        hip="".join(joint_lines("paper", "hip", play=False)),
        knee="".join(joint_lines("paper", "knee", play=False)),
        tendon="",
        actuators="".join(lines).replace('class="paper"', f'class="paper-{kind}"'),
    )
    (tmp_path / "robot.xml").write_text(robot)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    for actuator in ("hip", "knee"):
        data.actuator(actuator).ctrl[0] = sense * (1.0 if kind == "torque" else 3.0)
    for _ in range(400 if kind == "torque" else 4000):
        mujoco.mj_step(model, data)
    assert np.all(sense * data.qpos > 0.1)


@settings(max_examples=examples(25), deadline=None, suppress_health_check=list(HealthCheck))
@given(p=random_actuators())
def test_random_actuators(p: ActuatorParameters) -> None:
    model, data = load(model_text(MjcfActuator(p, "drawn")))
    n, motor = abs(p.gear.ratio), p.motor
    assert mass_matrix(model, data)[0, 0] == pytest.approx(p.reflected_inertia, rel=1e-6)
    data.ctrl[0] = p.drive.supply_voltage
    found = run(model, data, 400)
    assert np.all(np.isfinite(found))
    assert np.abs(data.actuator_force[0]) <= motor.torque_constant * p.drive.current_limit * 1.5
    breakaway = (
        (p.friction.motor_coulomb + p.friction.output_coulomb / n)
        * (1.0 + p.friction.stribeck_extra)
        + motor.hysteresis
        + motor.cogging_amplitude
    )
    amps = min(p.drive.supply_voltage / motor.resistance, p.drive.current_limit)
    if motor.torque_constant * amps > 2.0 * breakaway:
        assert found[-1, 0] > 0.0


@settings(max_examples=examples(25), deadline=None, suppress_health_check=list(HealthCheck))
@given(p=random_actuators())
def test_random_actuators_in_a_robot_at_its_own_step(
    tmp_path_factory: pytest.TempPathFactory, p: ActuatorParameters
) -> None:
    """Two joints with and without play, links as inert as the actuator, 2 ms, full voltage."""
    most = p.drive.supply_voltage / (abs(p.gear.ratio) * p.motor.torque_constant)
    peak = abs(p.gear.ratio) * p.motor.torque_constant * p.drive.current_limit
    assume(peak * 0.002 < 0.5 * most * p.reflected_inertia)
    folder = tmp_path_factory.mktemp("robot")
    (folder / "paper.xml").write_text(fragment_text(MjcfActuator(p, "paper")))
    play = p.gear.backlash > 0.0
    inertia = max(p.reflected_inertia, 1e-4)
    body = f'mass="1" diaginertia="{inertia} {inertia} {inertia}"'
    robot = HOST.format(
        angle="radian",
        hip="".join(joint_lines("paper", "hip", play=play)),
        knee="".join(joint_lines("paper", "knee", play=False)),
        tendon="".join(tendon_lines("hip")) if play else "",
        actuators="".join(
            (
                *actuator_lines(MjcfActuator(p, "paper"), "hip"),
                *actuator_lines(MjcfActuator(p, "paper", backlash=False), "knee"),
            )
        ),
    )
    robot = robot.replace('mass="2" diaginertia="0.02 0.02 0.01"', body)
    robot = robot.replace('mass="1" diaginertia="0.01 0.01 0.005"', body)
    (folder / "robot.xml").write_text(robot)
    model = mujoco.MjModel.from_xml_path(str(folder / "robot.xml"))
    data = mujoco.MjData(model)
    for volts in (1.0, -1.0, 0.0):
        data.ctrl[:] = volts * p.drive.supply_voltage
        for _ in range(300):
            mujoco.mj_step(model, data)
            assert abs(data.qvel[-1]) < 3.0 * most + 1.0
    assert data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number == 0
    assert np.all(np.isfinite(data.qpos))


def test_without_friction_and_play_nothing_of_them_is_written() -> None:
    p = frictionless(paper_actuator())
    p = dataclasses.replace(p, gear=dataclasses.replace(p.gear, backlash=0.0))
    text = model_text(MjcfActuator(without_ripple(p), "bare"))
    model, _ = load(text)
    assert (model.nq, model.nu) == (1, 1)
    assert "lugre=" not in text
    assert "cogging=" not in text
    # Only current and temperature are left as states.
    assert model.na == 2
