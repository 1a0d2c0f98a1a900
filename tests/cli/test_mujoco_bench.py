"""The exported MJCF, stepped in MuJoCo 4, against our own simulation and bench.

MJCF has no friction that grows with load, so it is switched off on our side too; all other friction
stays on both sides. `tests/cli/test_mujoco_client.py` compares the same files with closed forms.
"""

from __future__ import annotations

import dataclasses
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from actuator_samples import paper_actuator, without_ripple

from cqdd_design.actuator.bench import steady
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.joint_side import joint_side
from cqdd_design.actuator.packing import safe_step
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.scenario import Command, Constant, Load, Sampled, Scenario, Start
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design.toml import load_design
from cqdd_design.exporting.simulators.mjcf import model_text
from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator, play_damping
from cqdd_design.machine import resolve

mujoco = pytest.importorskip("mujoco", minversion="4.0.0", reason="MuJoCo 4 is not installed")

CLOSE = 0.005
"""The agreement asked for."""
HEAVY, STILL = 1e2, 1e9
"""Inertias of what moves steadily or stands, kg m^2; with contact the larger is beyond MuJoCo's
digits."""
DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
Validated = Callable[[str, str, float, float], None]
KINDS = ("perfect", "drawn", "by hand")


def bench_friction(p: ActuatorParameters) -> ActuatorParameters:
    """The same without the friction that grows with load."""
    friction = dataclasses.replace(p.friction, load_forward=0.0, load_backward=0.0)
    return dataclasses.replace(p, friction=friction)


def varying(p: ActuatorParameters) -> ActuatorParameters:
    """The actuator made by hand, with a stiffness that varies."""
    gear = dataclasses.replace(
        p.gear,
        stiffness_cosine=np.array([0.02, 0.0, -0.03, 0.01, 0.02]),
        stiffness_sine=np.array([0.0, 0.02, 0.01, -0.01, 0.0]),
    )
    return without_cogging(dataclasses.replace(p, gear=gear))


def without_cogging(p: ActuatorParameters) -> ActuatorParameters:
    """The same without the motor's own ripple."""
    motor = dataclasses.replace(p.motor, cogging_amplitude=0.0)
    return dataclasses.replace(p, motor=motor)


@pytest.fixture(scope="module")
def actuators() -> dict[str, ActuatorParameters]:
    design = load_design(DESIGN)
    found = {
        "perfect": actuator_parameters(resolve(design)),
        "drawn": actuator_parameters(resolve(design), Specimen(seed=3)),
        "by hand": varying(paper_actuator(voltage=96.0)),
    }
    return {kind: bench_friction(p) for kind, p in found.items()}


def load(text: str) -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def in_torque(p: ActuatorParameters, *, backlash: bool = True) -> tuple[Any, Any]:
    """The test model, commanded in torque of the motor."""
    text = model_text(MjcfActuator(p, "a", backlash=backlash))
    return load(text.replace('<dcmotor name="a" class="a" ', '<dcmotor name="a" class="a-torque" '))


def carrying(p: ActuatorParameters, torque: float) -> ActuatorParameters:
    """The same gearbox, its spring and its ripple stated at another torque."""
    gear = p.gear
    windup = (
        gear.error_torque / gear.stiffness * (torque / gear.error_torque) ** (1.0 / gear.stiffening)
    )
    stated = dataclasses.replace(gear, error_torque=torque, stiffness=torque / windup)
    return dataclasses.replace(p, gear=stated)


def our_orders(p: ActuatorParameters, torque: float, speed: float, turns: float) -> np.ndarray:
    """Complex amplitudes (4096,) of the torque at the output over the crank's angle, by order.

    As the bench's row of ripple, but slow enough for the motor not to swing on the gearbox, and
    with what drags on the motor's side, the motor's own included, added to the current: the torque
    of the ripple is the one that the gearbox carries.
    """
    friction, n = p.friction, abs(p.gear.ratio)
    rub = 1.0 + friction.stribeck_extra * math.exp(-((n * speed / friction.stribeck_speed) ** 2))
    rub = friction.motor_coulomb * rub + p.motor.dry_drag
    rub += (friction.motor_viscous + p.motor.drag_slope) * n * speed
    current = (torque + n * rub) / (p.gear.ratio * p.motor.torque_constant)
    rise, span = 1.0, 2.0 * math.pi * turns
    slowly = Sampled(np.array([0.0, rise]), np.array([0.0, current]))
    scene = Scenario(
        Command("current", slowly), Load.driven(Constant(speed)), Start(output_speed=speed)
    )
    step = safe_step(p, scene)
    every = max(1, int(span / speed / 40000 / step))
    run = simulate(steady.cold(p), scene, 1.5 * rise + 1.01 * span / speed, step, every=every)
    late = run.time > 1.5 * rise
    angle = run.motor_angle[0][late] / p.gear.ratio
    count = 8192
    even = angle[0] + span * np.arange(count) / count
    felt = np.interp(even, angle, run.output_torque[0][late])
    lines = 2.0 * np.fft.rfft(felt)[:4096] / count
    found = np.zeros(4096, dtype=complex)
    per_turn = round(1.0 / turns)
    orders = np.arange(0, 4096, per_turn)
    found[orders] = lines[: len(orders)] * np.exp(-1j * orders * angle[0])
    return found


def mujoco_orders(p: ActuatorParameters, torque: float) -> np.ndarray:
    """The same in MuJoCo: forces of the ripple while the joint is turned steadily by a command."""
    model, data = in_torque(carrying(p, torque), backlash=False)
    count = 8192
    model.dof_armature[0] = STILL
    mujoco.mj_setConst(model, data)
    data.qvel[0] = 2.0 * math.pi / (count * model.opt.timestep)
    data.ctrl[0] = torque / abs(p.gear.ratio)
    ripple = [i for i in range(len(model.actuator_gear)) if "-ripple-" in model.actuator(i).name]
    assert np.all(model.actuator_gear[ripple, 0] == 1.0)
    felt = np.empty(count)
    for at in range(count):
        mujoco.mj_step(model, data)
        felt[at] = data.actuator_force[ripple].sum()
    assert data.qpos[0] == pytest.approx(2.0 * math.pi, rel=1e-6)
    return np.asarray(2.0 * np.fft.rfft(felt)[:4096] / count)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("share", [1.0, pytest.param(0.5, marks=pytest.mark.deep)])
def test_ripple_orders(
    actuators: dict[str, ActuatorParameters], validated: Validated, kind: str, share: float
) -> None:
    """Every order above 1 % of the largest, in amplitude and in phase.

    The gearbox's: the motor's cogging, ten times as large and of no order of the gearbox, is
    compared in `test_mujoco_client.py`.
    """
    p = without_cogging(actuators[kind])
    turns = 1.0 / int(np.gcd.reduce(p.gear.error_orders))
    torque = share * p.gear.error_torque
    ours = our_orders(p, torque, 0.03 * max(turns, 0.1), turns)
    theirs = mujoco_orders(p, torque)
    size = np.abs(ours[1:])
    above = 1 + np.flatnonzero(size > 0.0101 * size.max())
    assert len(above) >= 5
    miss = np.abs(np.abs(theirs[above]) / np.abs(ours[above]) - 1.0)
    validated(f"MuJoCo: ripple orders, {kind}, {torque:g} N m", "our simulation", miss.max(), CLOSE)
    assert np.abs(theirs[above] - ours[above]).max() < CLOSE * size.max()
    # Nothing else is there: what is left out of the file, or belongs to no order of the model.
    rest = np.setdiff1d(np.arange(1, 4096), above)
    assert np.abs(theirs[rest]).max() < 0.011 * size.max()


@pytest.mark.parametrize("kind", ["perfect", "drawn"])
def test_friction_under_load_lessens_the_ripple(
    actuators: dict[str, ActuatorParameters], kind: str
) -> None:
    """What the head of the file says: with friction f of the carried torque, by 1 + f."""
    p = without_cogging(actuators[kind])
    load = 0.3
    friction = dataclasses.replace(p.friction, load_forward=load, stribeck_extra=0.0)
    p = dataclasses.replace(p, friction=friction)
    turns, torque = 1.0 / int(np.gcd.reduce(p.gear.error_orders)), p.gear.error_torque
    ours = our_orders(p, torque * (1.0 + load), 0.03 * max(turns, 0.1), turns)
    theirs = mujoco_orders(p, torque)
    largest = np.abs(ours[1:]).max()
    assert np.abs(theirs[1:] / (1.0 + load) - ours[1:]).max() < 0.011 * largest
    most = int(np.argmax(np.abs(ours[1:]))) + 1
    assert abs(theirs[most]) / (1.0 + load) == pytest.approx(abs(ours[most]), rel=CLOSE)
    assert "divides it by 1.3 where" in " ".join(model_text(MjcfActuator(p, "a")).split())


def test_ripple_of_perfect_parts_is_that_of_the_stiffness(
    actuators: dict[str, ActuatorParameters],
) -> None:
    """A gearbox without an angle error has a ripple all the same, and none on an even stiffness."""
    p = actuators["perfect"]
    none = np.zeros_like(p.gear.error_cosine)
    straight = dataclasses.replace(p.gear, error_cosine=none, error_sine=none)
    flat = dataclasses.replace(straight, stiffness_cosine=none, stiffness_sine=none)
    torque = p.gear.error_torque
    soft, even = (
        np.abs(mujoco_orders(dataclasses.replace(p, gear=gear), torque)[1:]).max()
        for gear in (straight, flat)
    )
    assert soft > 1e-4
    assert even < 1e-6 * soft


def idle_speeds(p: ActuatorParameters, *, backlash: bool) -> tuple[float, float]:
    """Speed at full voltage without load in MuJoCo and on the bench, rad/s."""
    volts = p.drive.supply_voltage
    model, data = load(model_text(MjcfActuator(p, "a", backlash=backlash)))
    data.ctrl[0] = volts
    speeds = []
    while data.time < 1.0:
        mujoco.mj_step(model, data)
        speeds.append(float(data.sensordata[1]))
    found = float(np.mean(speeds[len(speeds) // 2 :]))
    measured = steady.no_load_speed(p, volts).value * math.pi / 30.0
    return found, measured


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("backlash", [True, False])
def test_no_load_speed(
    actuators: dict[str, ActuatorParameters], validated: Validated, kind: str, backlash: bool
) -> None:
    """With Coulomb, Stribeck and viscous friction of both sides, and the ripple as written."""
    p = actuators[kind]
    found, measured = idle_speeds(p, backlash=backlash)
    what = f"MuJoCo: no-load speed, {kind}, {'with' if backlash else 'without'} backlash"
    validated(what, "our bench", abs(found / measured - 1.0), CLOSE)


@pytest.mark.parametrize("ambient", [-20.0, 60.0])
def test_no_load_speed_in_the_cold_and_in_the_heat(
    actuators: dict[str, ActuatorParameters], ambient: float
) -> None:
    """Magnets and winding are as warm as the place, on the bench and in the file."""
    p = actuators["perfect"]
    thermal = dataclasses.replace(p.thermal, ambient=ambient)
    p = dataclasses.replace(p, thermal=thermal)
    found, measured = idle_speeds(p, backlash=False)
    assert found == pytest.approx(measured, rel=1e-4)
    assert joint_side(p).no_load_speed == pytest.approx(measured, rel=1e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_stall_torque_on_a_locked_output(
    actuators: dict[str, ActuatorParameters], validated: Validated, kind: str
) -> None:
    """The bench's protocol in MuJoCo: current ramped to the limit in 0.3 s and held.

    The motor winds up against the end of the play, so its Coulomb friction holds back what it can,
    as on the bench; what friction under load holds back besides is in no MJCF. Neither is the
    stiffening of the gearbox, so the motor winds up by another angle: without cogging, which would
    be felt there at another phase.
    """
    p = without_cogging(actuators[kind])
    model, data = in_torque(p)
    model.body_inertia[model.body("output").id] = STILL
    measured = steady.stall_torque(p)
    most = p.motor.torque_constant * measured.details["current_A"]
    turn = 2.0 * math.pi / abs(p.gear.ratio)
    held = []
    for place in range(12):
        mujoco.mj_resetData(model, data)
        data.qpos[0] = turn * place / 12
        felt = []
        while data.time < 0.6:
            data.ctrl[0] = most * min(data.time / 0.3, 1.0)
            mujoco.mj_step(model, data)
            if data.time > 0.45:
                felt.append(float(data.qfrc_constraint[1]))
        held.append(abs(np.mean(felt)))
    miss = abs(float(np.mean(held)) / measured.value - 1.0)
    validated(f"MuJoCo: stall torque before friction under load, {kind}", "our bench", miss, CLOSE)


@pytest.mark.parametrize("kind", KINDS)
def test_inertia_by_spin_up(
    actuators: dict[str, ActuatorParameters], validated: Validated, kind: str
) -> None:
    """The bench's protocol in MuJoCo: difference of torques over difference of accelerations.

    Between the same two speeds, those that the lesser torque has at 10 and at 30 ms, so that the
    drag of motor and gearbox over speed cancels.
    """
    p = actuators[kind]
    n = abs(p.gear.ratio)
    # The bench's ripple grows with the torque, which that of the file does not.
    model, data = in_torque(without_ripple(p), backlash=False)
    torques, rises, between = [], [], (0.0, 0.0)
    for share in (0.25, 0.5):
        mujoco.mj_resetData(model, data)
        torques.append(share * p.drive.current_limit * p.motor.torque_constant)
        data.ctrl[0] = torques[-1]
        times, speeds = [0.0], [0.0]
        while data.time < 0.03:
            mujoco.mj_step(model, data)
            times.append(data.time)
            speeds.append(float(data.qvel[0]) * n)
        if not rises:
            between = np.interp((0.01, 0.03), times, speeds)
        first, last = np.interp(between, speeds, times)
        rises.append((between[1] - between[0]) / (last - first))
    found = (torques[1] - torques[0]) / (rises[1] - rises[0])
    measured = steady.actuator_inertia(p).value
    what = f"MuJoCo: inertia by spin-up, {kind}"
    validated(what, "our bench", abs(found / measured - 1.0), CLOSE)
    mujoco.mj_forward(model, data)
    matrix = np.zeros((1, 1))
    mujoco.mj_fullM(model, data, matrix)
    assert matrix[0, 0] == pytest.approx(p.reflected_inertia, rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_lost_motion(
    actuators: dict[str, ActuatorParameters], validated: Validated, kind: str
) -> None:
    """The motor turned slowly to and fro: its lead over the output, forth less back.

    The friction of the output side keeps it on the flank and winds up the ends of the play.
    """
    p = actuators[kind]
    model, data = load(model_text(MjcfActuator(without_ripple(p), "a")))
    model.dof_armature[0] = HEAVY
    speed, lead = 0.05, []
    for sense in (1.0, -1.0):
        data.qvel[0] = sense * speed
        for _ in range(round(1.0 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        lead.append(-float(data.qpos[1]))
    friction, n = p.friction, abs(p.gear.ratio)
    fast = math.exp(-((n * speed / friction.stribeck_speed) ** 2))
    drag = friction.output_coulomb * (1.0 + friction.stribeck_extra * fast)
    drag += friction.output_viscous * speed
    windup = 2.0 * drag / p.gear.stiffness
    miss = abs((lead[0] - lead[1] - windup) / p.gear.backlash - 1.0)
    validated(f"MuJoCo: lost motion, {kind}", "backlash of the gearbox", miss, CLOSE)


@pytest.mark.parametrize("kind", KINDS)
def test_stiffness_and_damping_at_the_ends_of_the_play(
    actuators: dict[str, ActuatorParameters], kind: str
) -> None:
    """The output pressed on at two steady speeds; the damping is what the head of the file says."""
    p = actuators[kind]
    text = model_text(MjcfActuator(without_ripple(p), "a"))
    model, data = load(text)
    model.dof_armature[:] = STILL
    depth = 2e-3
    found = []
    for speed in (0.0, 0.1):
        data.qpos[1], data.qvel[:] = 0.5 * p.gear.backlash + depth, (0.0, speed)
        mujoco.mj_forward(model, data)
        found.append(-float(data.qfrc_constraint[1]))
    damped = play_damping(p, alone=True)
    assert found[0] == pytest.approx(p.gear.stiffness * depth, rel=CLOSE)
    assert found[1] - found[0] == pytest.approx(0.1 * damped, rel=CLOSE)
    assert f"which is {damped:.9g} N m s/rad" in " ".join(text.split())
    assert f"damping of the transmission, {p.gear.damping:.9g} N m s/rad" in " ".join(text.split())
