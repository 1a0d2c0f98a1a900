"""Motor constants and envelope, thermal network, and the parameters built from a design."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

from cqdd_design.actuator import motor as motors
from cqdd_design.actuator import operating
from cqdd_design.actuator import thermal as thermals
from cqdd_design.actuator import transmission as transmissions
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import demands
from cqdd_design.actuator.friction import friction_parameters
from cqdd_design.actuator.joint_side import backdrive_dynamic, backdrive_static, joint_side
from cqdd_design.actuator.load_friction import load_friction
from cqdd_design.actuator.motor import torque_constant_at
from cqdd_design.actuator.packing import gear_table, kinematic_error, stiffness_share
from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    MotorParameters,
    ThermalParameters,
    least_stiffness,
    refuse_variation,
)
from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Start
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.catalog.motors import find_motor, torque_constant_from
from cqdd_design.design import Design, load_design
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import contact_sweep, output_turn_angles
from cqdd_design.gearbox.losses import LossModel
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.machine import Machine, resolve
from cqdd_design.roads.export import left_out

PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
MOTOR = MotorParameters(0.1736, 0.143, 137e-6, 5.6e-4, 21, 4.0, 12.0, iron_loss=1e-4)
THERMAL = ThermalParameters(0.4, 0.8, 40.0, 1000.0)


@lru_cache(maxsize=4)
def built(seed: int | None = None) -> ActuatorParameters:
    return actuator_parameters(resolve(PAPER), Specimen(seed=seed))


@lru_cache(maxsize=1)
def loss_of_paper() -> LossModel:
    return resolve(PAPER).losses


@given(st.floats(1e-3, 10.0), st.floats(1e-3, 10.0), st.floats(0.1, 100.0))
def test_conventions_carry_the_same_power_and_heat(k: float, r: float, dc: float) -> None:
    found = motors.motor_constants(k)
    peak = 2.0 / math.sqrt(3.0) * dc
    assert found["torque_per_peak"] * peak == pytest.approx(k * dc)
    assert found["torque_per_rms"] * peak / math.sqrt(2.0) == pytest.approx(k * dc)
    # Three phases at an EMF and a current in phase give torque times speed.
    assert 1.5 * found["emf_phase_peak"] * peak == pytest.approx(k * dc)
    assert 3.0 * found["emf_phase_rms"] * peak / math.sqrt(2.0) == pytest.approx(k * dc)
    # Line to line is twice a phase in wye: the same copper loss.
    assert 1.5 * 0.5 * r * peak**2 == pytest.approx(r * dc**2)
    assert found["emf_line_rms"] == pytest.approx(math.sqrt(3.0) * found["emf_phase_rms"])
    for name, value in found.items():
        assert torque_constant_from(value, name) == pytest.approx(k)


def test_greatest_torque_is_bound_by_both_limits() -> None:
    drive = built().drive
    speed = np.linspace(-600.0, 600.0, 241)
    found = motors.greatest_torque(MOTOR, drive, speed, 25.0)
    rest = motors.greatest_torque(MOTOR, drive, 0.0, 25.0)
    stall = min(drive.supply_voltage / MOTOR.resistance, drive.current_limit)
    assert rest[0] == pytest.approx(MOTOR.torque_constant * stall)
    current = (found + motors.iron_drag(MOTOR, speed)) / MOTOR.torque_constant
    terminal = MOTOR.resistance * current + MOTOR.torque_constant * speed
    assert np.all(terminal <= drive.supply_voltage + 1e-9)
    driving = np.abs(speed) < drive.supply_voltage / MOTOR.torque_constant
    assert np.all(np.abs(current[driving]) <= drive.current_limit + 1e-9)
    # One of the two always binds, and backwards beyond both the EMF drives what it will.
    over = speed < -(drive.supply_voltage + drive.current_limit * MOTOR.resistance) / (
        MOTOR.torque_constant
    )
    assert over.any()
    np.testing.assert_allclose(terminal[over], -drive.supply_voltage)
    bound = (terminal > drive.supply_voltage - 1e-9) | (current > drive.current_limit - 1e-9)
    assert np.all(bound)
    # The torque vanishes at the no-load speed.
    free = motors.no_load_speed(MOTOR, drive.supply_voltage)
    at = motors.greatest_torque(replace(MOTOR, hysteresis=0.0), drive, free, 25.0)
    assert at[0] == pytest.approx(0.0, abs=1e-9)
    hot = motors.greatest_torque(MOTOR, drive, speed, 120.0)
    fast = np.argmax(speed > 200.0)
    assert hot[fast] != found[fast]
    assert motors.no_load_speed(MOTOR, 24.0, temperature=100.0) > motors.no_load_speed(MOTOR, 24.0)
    assert motors.no_load_speed(MOTOR, 24.0, drag=50.0) == 0.0


def test_iron_drags_against_the_motion_and_the_motor_pays_it() -> None:
    one = replace(MOTOR, hysteresis=0.02)
    np.testing.assert_allclose(motors.iron_drag(one, [-50.0, 0.0, 50.0]), [-0.025, 0.0, 0.025])
    speed = np.array([-50.0, 50.0])
    with_drag, without = (
        motors.greatest_torque(motor, built().drive, speed, 25.0)
        for motor in (one, replace(one, hysteresis=0.0, iron_loss=0.0))
    )
    np.testing.assert_allclose(without - with_drag, [-0.025, 0.025])
    needs = operating.needed(replace(built(), motor=one), 10.0, 5.0, 25.0)
    freely = operating.needed(
        replace(built(), motor=replace(one, hysteresis=0.0, iron_loss=0.0)), 10.0, 5.0, 25.0
    )
    assert (needs.current - freely.current) * one.torque_constant == pytest.approx(0.025)
    assert needs.heat - freely.heat == pytest.approx(0.025 * 50.0)


@given(st.floats(0.0, 30.0), st.floats(0.0, 20.0))
@settings(max_examples=examples(30))
def test_thermal_response_obeys_its_equations(current: float, heat: float) -> None:
    t = np.linspace(0.0, 3000.0, 31)
    found = thermals.response(MOTOR, THERMAL, current, t, housing_heat=heat)
    assert found[0] == pytest.approx([25.0, 25.0])
    d = 0.01
    near = thermals.response(MOTOR, THERMAL, current, t[1:, None] + [-d, d], housing_heat=heat)
    slope = (near[..., 1, :] - near[..., 0, :]) / (2.0 * d)
    winding, housing = found[1:, 0], found[1:, 1]
    copper = current**2 * motors.resistance_at(MOTOR, winding)
    across = (winding - housing) / THERMAL.winding_to_housing
    out = (housing - 25.0) / THERMAL.housing_to_ambient
    np.testing.assert_allclose(slope[:, 0] * 40.0, copper - across, atol=1e-3 + 1e-4 * copper.max())
    np.testing.assert_allclose(slope[:, 1] * 1000.0, heat + across - out, atol=1e-2 + 1e-4 * heat)


def test_continuous_current_ends_at_the_limit() -> None:
    current = thermals.continuous_current(MOTOR, THERMAL)
    ends = thermals.steady_state(MOTOR, THERMAL, current)
    assert ends[0] == pytest.approx(THERMAL.most)
    for heat in (0.0, 10.0):
        late = thermals.response(MOTOR, THERMAL, current, [1e6], housing_heat=heat)[0]
        assert late == pytest.approx(thermals.steady_state(MOTOR, THERMAL, current, heat))
    with pytest.raises(DesignError, match="without end"):
        thermals.steady_state(MOTOR, THERMAL, thermals.runaway_current(MOTOR, THERMAL))


def test_a_winding_that_runs_away_follows_the_network_until_numbers_would_end() -> None:
    current = 2.0 * thermals.runaway_current(MOTOR, THERMAL)
    matrix, forcing = thermals.system(MOTOR, THERMAL, current, 0.0)
    growing = float(np.linalg.eigvals(matrix).real.max())
    assert growing > 0.0
    time = 20.0 / growing
    first = np.array((THERMAL.ambient, THERMAL.ambient))
    rest = np.linalg.solve(matrix, forcing)
    wanted = expm(matrix * time) @ (first + rest) - rest
    assert thermals.response(MOTOR, THERMAL, current, [time])[0] == pytest.approx(wanted, rel=1e-6)
    late = thermals.response(MOTOR, THERMAL, current, [1e4 / growing, 1e9 / growing])
    assert np.isfinite(late).all()
    assert (late > 1e6).all()


@pytest.mark.parametrize("seed", [1, 2])
def test_a_gearbox_whose_backlash_varies_by_more_than_it_winds_up_can_be_simulated(
    monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    """Its windup is kept to a share of its mean: the stiffness is above zero, and that is told."""
    model = resolve(PAPER).contact
    felt = transmissions.transmission(model, PAPER, 1.0, seed=seed)
    assert felt.least_windup > transmissions.USUAL_LEAST
    series = felt.error_orders, felt.stiffness_cosine, felt.stiffness_sine
    # Kept by no more than the stiffness asks for.
    assert 0.05 <= least_stiffness(*series) < 0.075
    weak = PAPER.replacing({"requirements.continuous_torque": 1.0})
    told = actuator_parameters(resolve(weak), Specimen(seed=seed)).origins["gear.stiffness_sine"]
    assert f"windup kept above {100.0 * felt.least_windup:.3g} % of its mean" in told
    # Where nothing keeps it so, the gearbox is refused, which says what to change.
    monkeypatch.setattr(transmissions, "_LEAST_STIFFNESS", 1.1)
    transmissions.transmission.cache_clear()
    with pytest.raises(DesignError, match=r"raise requirements\.continuous_torque, or tighten"):
        transmissions.transmission(model, PAPER, 1.0, seed=seed)


def test_a_stiffness_that_varies_much_but_keeps_above_zero_is_kept() -> None:
    found = transmissions.transmission(resolve(PAPER).contact, PAPER, 4.0, seed=1)
    assert np.sum(np.hypot(found.stiffness_cosine, found.stiffness_sine)) > 2.0
    usual = transmissions.transmission(resolve(PAPER).contact, PAPER, 40.0, seed=1)
    assert usual.least_windup == transmissions.USUAL_LEAST


@given(arrays(float, 4, elements=st.floats(-1.0, 1.0)))
def test_the_least_of_a_stiffness_is_that_of_its_series(waves: NDArray[np.float64]) -> None:
    orders = np.array([3, 10])
    turn = np.linspace(0.0, 2.0 * np.pi, 4001)[:, None] * orders
    series = 1.0 + np.cos(turn) @ waves[:2] + np.sin(turn) @ waves[2:]
    found = least_stiffness(orders, waves[:2], waves[2:])
    # Where little is varied it is what the harmonics leave together, and that is less.
    assert found <= series.min() + 0.06 * np.abs(waves).sum()
    if found <= 0.0:
        with pytest.raises(DesignError, match=r"gear\.stiffness_cosine [\d.]+ is not below 1"):
            refuse_variation(orders, waves[:2], waves[2:])


def gallery(name: str) -> Machine:
    return resolve(load_design(Path(__file__).resolve().parents[2] / f"docs/gallery/{name}.toml"))


@pytest.mark.parametrize("name", ["plain-10", "knee-8"])
def test_friction_at_the_peak_torque_is_that_of_the_loss_model(name: str) -> None:
    """With films it is a third more of the torque there than at the continuous one.

    As an audit found: one share of it told a peak torque that was 6 to 10 % too high.
    """
    machine = gallery(name)
    friction, asked = actuator_parameters(machine).friction, machine.design.requirements
    peak, speed, n = asked.peak_torque, asked.input_speed, machine.design.reducer.ratio
    for torque in (asked.continuous_torque, peak):
        none, some = machine.losses.coulomb_work([0.0, torque], "drive", speed).sum(-1)
        lost = n * float(some - none)
        assert load_friction(friction, torque) == pytest.approx(lost, rel=1e-9)
    assert load_friction(friction, peak) / peak > 1.2 * friction.load_forward
    # Between them it is near.
    some, none = machine.losses.coulomb_work([2.5 * asked.continuous_torque, 0.0], "drive", speed)
    between = n * float(some.sum() - none.sum())
    assert load_friction(friction, 2.5 * asked.continuous_torque) == pytest.approx(
        between, rel=0.05
    )


@pytest.mark.parametrize(("name", "torque"), [("wrist-15", None), ("plain-10", 0.5)])
def test_what_drives_back_stays_below_the_knee(name: str, torque: float | None) -> None:
    """Backdrive torques are those of the loss model, however small the continuous torque is."""
    machine = gallery(name)
    if torque is not None:
        machine = machine.changed({"requirements.continuous_torque": torque})
    one = actuator_parameters(machine)
    motor, asked = one.motor, machine.design.requirements
    back = machine.losses.backdrive(
        film_speed=asked.input_speed,
        shaft_running=motor.dry_drag,
        shaft_resting=motor.dry_drag + motor.cogging_amplitude,
    )
    assert backdrive_static(one) == pytest.approx(back.static_torque, rel=5e-3)
    assert backdrive_dynamic(one) == pytest.approx(back.dynamic_torque, rel=5e-3)
    assert back.static_torque is not None
    assert one.friction.load_knee >= back.static_torque
    assert one.friction.load_growth > 0.0


def test_simulators_are_told_what_the_gearbox_does_not_carry() -> None:
    """As an audit found: 68 N m allowed where the cam bearing's static rating is 41."""
    design = gallery("efficient-10").given
    (said,) = left_out(design, "urdf,card")
    assert re.match(r"urdf, card: motor and drive give up to 6\d\.\d N\*m, the effort limit", said)
    assert re.search(
        r"does not carry it: static rating of the cam bearing from 5\d(\.\d)? N\*m", said
    )
    assert left_out(design, "dxf") == ()
    # Where it carries all that they give, nothing is said.
    assert left_out(gallery("plain-10").given, "urdf") == ()


def test_what_is_held_for_ever_is_no_more_than_the_drive_gives() -> None:
    one = built()
    whole = joint_side(one)
    weak = replace(one, drive=replace(one.drive, current_limit=5.0))
    side = joint_side(weak)
    assert side.continuous_torque < side.peak_torque < whole.continuous_torque
    # Magnets are warm where it is held for ever.
    hot = torque_constant_at(one.motor, one.thermal.most) / one.motor.torque_constant
    assert side.continuous_torque == pytest.approx(hot * side.peak_torque)
    for speed in (0.0, 2.0):
        assert operating.lasting_torque(weak, speed) <= side.peak_torque
        held = float(operating.held_torque(one, speed)[0])
        assert operating.lasting_torque(one, speed) == pytest.approx(held)


@given(st.floats(0.0, 30.0), st.floats(0.0, 2.0), st.floats(0.5, 100.0), st.floats(0.0, 5.0))
@settings(max_examples=examples(50))
def test_what_the_motor_gives_comes_out_as_it_went_in(
    knee: float, growth: float, torque: float, speed: float
) -> None:
    one = built()
    friction = replace(one.friction, load_knee=knee, load_growth=growth)
    rubbing = replace(one, friction=friction)
    shaft = operating.motor_torque(rubbing, torque, speed)
    assert float(operating.output_torque(rubbing, shaft, speed)) == pytest.approx(torque)
    # Friction takes of what drives, and helps to hold what is driven.
    assert float(shaft) > torque / abs(one.gear.ratio)
    assert float(operating.motor_torque(rubbing, -torque, speed)) > -torque / abs(one.gear.ratio)


@pytest.mark.parametrize("name", ["plain-10", "knee-8"])
def test_the_peak_torque_is_what_losses_at_rest_leave_of_the_motor(name: str) -> None:
    """Of the driver's current what the loss model takes at rest, found on its own way."""
    machine = gallery(name)
    one, asked, losses = actuator_parameters(machine), machine.design.requirements, machine.losses
    told = demands(one, asked)[0].found.most
    n = machine.design.reducer.ratio
    shaft = one.motor.torque_constant * one.peak_current - one.motor.dry_drag
    drag = sum(float(value) for value in losses.machine.drag(0.0).values())

    def left(torque: float) -> float:
        work = float(losses.coulomb_work(torque, "drive", 0.0).sum())
        return n * (shaft - drag - work) - torque

    assert told == pytest.approx(brentq(left, 1.0, n * shaft), rel=0.02)


def test_friction_keeps_efficiencies_and_backdrive_torques() -> None:
    one, losses = built(), loss_of_paper()
    friction, n = one.friction, abs(one.gear.ratio)
    torque, speed = PAPER.requirements.continuous_torque, PAPER.requirements.input_speed
    found = losses.at(speed, torque)
    # A motor that turns freely; what one that drags and cogs adds is another test's.
    friction = friction_parameters(losses, torque, speed)
    constant = n * friction.motor_coulomb + friction.output_coulomb
    drag = constant + n * friction.motor_viscous * speed + friction.output_viscous * speed / n
    assert found.efficiency_forward is not None
    assert found.efficiency_backward is not None
    forward = torque / (torque * (1.0 + friction.load_forward) + drag)
    assert forward == pytest.approx(found.efficiency_forward, rel=2e-3)
    backward = 1.0 - friction.load_backward - drag / torque
    assert backward == pytest.approx(found.efficiency_backward, abs=2e-3)
    back = losses.backdrive()
    # The output's own part is none of what is brought through the gearbox.
    at_motor = n * friction.motor_coulomb
    dynamic = friction.output_coulomb + at_motor / (1.0 - friction.load_backward)
    assert dynamic == pytest.approx(back.dynamic_torque)
    rise = 1.0 + friction.stribeck_extra
    static = rise * (friction.output_coulomb + at_motor / (1.0 - rise * friction.load_backward))
    assert static == pytest.approx(back.static_torque)


def test_friction_with_the_motor_on_the_shaft_keeps_backdrive_torques() -> None:
    """Gearbox and motor together take what the loss model says of a shaft that drags and cogs."""
    one, losses = built(), loss_of_paper()
    n, torque = abs(one.gear.ratio), PAPER.requirements.continuous_torque
    for drag, cogging in ((0.001, 0.0), (0.003, 0.002)):
        friction = friction_parameters(
            losses, torque, PAPER.requirements.input_speed, drag=drag, cogging=cogging
        )
        assert friction.motor_coulomb > 0.0
        motor = replace(one.motor, coulomb=drag, viscous=0.0, cogging_amplitude=cogging)
        whole = replace(one, motor=motor, friction=friction)
        found = losses.backdrive(shaft_running=drag, shaft_resting=drag + cogging)
        assert backdrive_dynamic(whole) == pytest.approx(found.dynamic_torque, rel=1e-9)
        assert backdrive_static(whole) == pytest.approx(found.static_torque, rel=1e-9)
    # A motor that drags more than the gearbox: its friction under load says too much already.
    assert one.motor.dry_drag == 0.0999
    assert one.friction.motor_coulomb == 0.0
    assert one.friction.output_coulomb > 0.01
    found = losses.backdrive(
        shaft_running=one.motor.dry_drag,
        shaft_resting=one.motor.dry_drag + one.motor.cogging_amplitude,
    )
    assert n * one.motor.dry_drag < found.dynamic_torque < backdrive_dynamic(one)
    assert backdrive_dynamic(one) == pytest.approx(found.dynamic_torque, rel=0.06)
    assert backdrive_static(one) == pytest.approx(found.static_torque, rel=0.01)


def test_a_rotor_of_unknown_inertia_is_a_ring_of_part_of_the_motors_mass() -> None:
    """Of 30 % of the mass at 95 % of the radius, where the rotor is neither drawn nor listed."""
    row = replace(find_motor("CubeMars RI70 KV95"), rotor_inertia=None)
    one = actuator_parameters(resolve(PAPER.replacing({"motor.name": row.name}), row))
    assert one.origins["motor.rotor_inertia"].startswith("assumed: ring of 30 %")
    ring = 0.3 * row.mass * (0.95 * 0.5 * row.outer_diameter) ** 2
    assert one.motor.rotor_inertia == pytest.approx(ring, rel=1e-12)


def test_preload_is_friction_without_load() -> None:
    """Work that is there without any torque belongs to the motor's own friction."""
    tight = resolve(PAPER.replacing({"reducer.output_pins.hole_clearance": -8e-6})).losses
    torque, speed = PAPER.requirements.continuous_torque, PAPER.requirements.input_speed
    friction = friction_parameters(tight, torque, speed)
    for sense, share in (("drive", friction.load_forward), ("backdrive", friction.load_backward)):
        loaded, free = tight.coulomb_work([torque, 0.0], sense).sum(axis=-1)
        assert free > 0.0
        assert share == pytest.approx(10.0 * (loaded - free) / torque, rel=1e-12)
    usual = friction_parameters(loss_of_paper(), torque, speed)
    assert friction.motor_coulomb > 2.0 * usual.motor_coulomb


def test_a_gearbox_that_binds_is_refused_in_the_words_of_its_design() -> None:
    """Its friction falls under load, which no share of the torque carried describes."""
    design = load_design(Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml")
    bound = resolve(design.replacing({"reducer.output_pins.hole_clearance": "-50 um"}))
    with pytest.raises(DesignError) as caught:
        actuator_parameters(bound)
    said = caught.value.message
    assert "the gearbox binds: with output_pins.hole_clearance -50 um" in said
    assert "raise output_pins.hole_clearance to 15 um, or more" in said
    assert "load_backward" not in said


def test_simulated_backdrive_is_that_of_the_losses() -> None:
    one = built()
    scene = Scenario(Command("open"), Load.driven(Constant(0.5)), Start(motor_angle=0.0))
    found = simulate(one, scene, 15.0, 5e-5, every=20)
    late = found.time > 2.0
    mean = -float(found.output_torque[0, late].mean()) + 0.0
    drag = float(motors.iron_drag(one.motor, 0.5 * abs(one.gear.ratio)))
    losses = loss_of_paper().backdrive(output_speed=0.5, shaft_running=drag)
    assert mean == pytest.approx(losses.dynamic_torque, rel=0.06)
    # In the closed form too, with every term of it.
    assert mean == pytest.approx(backdrive_dynamic(one, 0.5), rel=0.01)


def test_simulated_no_load_speed_is_the_closed_form() -> None:
    one = actuator_parameters(resolve(PAPER), supply_voltage=24.0)
    assert one.drive.supply_voltage == 24.0
    friction, n = one.friction, abs(one.gear.ratio)
    wanted = motors.no_load_speed(
        one.motor,
        24.0,
        drag=friction.motor_coulomb + friction.output_coulomb / n,
        viscous=friction.motor_viscous + friction.output_viscous / n**2,
    )
    found = simulate(one, Scenario(Command("voltage", Constant(24.0))), 1.0, 5e-5, every=10)
    late = found.time > 0.7
    assert float(found.motor_speed[0, late].mean()) == pytest.approx(wanted, rel=2e-3)


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_virtual_work_gives_the_ripple_of_the_contact_engine(seed: int | None) -> None:
    """Motor torque that holds the output's load: shape of eps and stiffness, against dPi/dphi."""
    one, model = built(seed), resolve(PAPER).contact
    errors = None if seed is None else draw_errors(model, PAPER.tolerances, seed, 0, 1).one(0)
    gear, torque, angle = one.gear, one.gear.error_torque, output_turn_angles(model)
    d = 1e-5
    error_slope = (kinematic_error(gear, angle + d) - kinematic_error(gear, angle - d)) / (2.0 * d)
    share_slope = (stiffness_share(gear, angle + d) - stiffness_share(gear, angle - d)) / (2.0 * d)
    share, p = stiffness_share(gear, angle), gear.stiffening
    energy = torque / share * torque / gear.stiffness * share ** (-1.0 / p) / (p + 1.0)
    for sense in (1.0, -1.0):
        engine = contact_sweep(model, sense * torque, angle, errors=errors).energy_slope
        ours = -sense * torque * error_slope + share_slope * energy
        assert np.ptp(ours) == pytest.approx(np.ptp(engine), rel=0.1)
        assert np.sqrt(np.mean((ours - engine) ** 2)) < 0.1 * np.std(engine)


def test_inertias_and_mass_are_those_of_the_solids() -> None:
    solids = resolve(PAPER).inertia
    one = built()
    n = abs(one.gear.ratio)
    whole = one.motor_side_inertia + one.gear.output_inertia / n**2
    assert whole == pytest.approx(solids.reflected_input)
    assert one.reflected_inertia == pytest.approx(solids.reflected_output)
    assert one.mass == pytest.approx(solids.total.mass)
    plates = sum(p.reflected for p in solids.parts if p.name.startswith("carrier"))
    assert one.gear.output_inertia > n**2 * plates


def test_a_seed_draws_one_gearbox_and_always_the_same() -> None:
    first, again = built(1), actuator_parameters(resolve(PAPER), Specimen(seed=1))
    assert first.gear.backlash == again.gear.backlash
    np.testing.assert_array_equal(first.gear.error_cosine, again.gear.error_cosine)
    assert first.gear.backlash != built(2).gear.backlash
    assert len(first.gear.error_orders) <= 64
    assert {10, 11} <= set(first.gear.error_orders)
    assert set(built().gear.error_orders) <= set(range(55, 6000, 55))


def test_a_drawn_gearbox_that_cannot_carry_its_load_is_soon_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    solved = []
    real = transmissions.contact_sweep

    def counted(model: ContactModel, load: float, angle: Any = None, **more: Any) -> Any:
        solved.append(len(more["states"].crank_angle) if angle is None else len(angle))
        return real(model, load, angle, **more)

    monkeypatch.setattr(transmissions, "contact_sweep", counted)
    model = ContactModel.from_design(PAPER)
    with pytest.raises(ContactError, match="beyond this gearbox"):
        transmissions.transmission(model, PAPER, 2000.0, seed=1)
    assert sum(solved) < 0.1 * len(output_turn_angles(model))


def test_a_drawn_gearbox_beyond_memory_is_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    model = replace(ContactModel.from_design(PAPER), lobe_count=119)
    monkeypatch.setattr(transmissions, "nominal_states", None)
    with pytest.raises(DesignError, match="use perfect parts"):
        transmissions.transmission(model, PAPER, 40.0, seed=1)


def test_table_follows_the_series() -> None:
    gear = built(1).gear
    table = gear_table(gear, 16384)
    turn = 2.0 * math.pi * abs(gear.ratio)
    angle = turn * np.arange(16384) / 16384
    np.testing.assert_allclose(table[:, 0], kinematic_error(gear, angle), atol=1e-15)
    np.testing.assert_allclose(table[:, 2], stiffness_share(gear, angle), atol=1e-12)
    slope = np.gradient(table[:, 0])[1:-1]
    np.testing.assert_allclose(table[1:-1, 1], slope, atol=0.05 * np.abs(slope).max())


def test_every_number_says_where_it_comes_from() -> None:
    one = built()
    known = ("catalogue", "computed", "assumed", "calibrated", "design", "given", "missing")
    for table in ("motor", "drive", "thermal", "friction", "gear"):
        for name in type(getattr(one, table)).__dataclass_fields__:
            if name in ("cogging_order", "reference_temperature"):
                continue
            assert one.origins[f"{table}.{name}"].startswith(known), (table, name)
    assert one.origins["mass"].startswith("computed")


def changed(**keys: object) -> Design:
    return PAPER.replacing({key.replace("__", "."): value for key, value in keys.items()})


def test_motors_that_cannot_be_simulated_are_refused() -> None:
    with pytest.raises(DesignError, match="the resistance of VT8020 is not known"):
        actuator_parameters(resolve(changed(motor__name="VT8020")))
    with pytest.raises(DesignError, match="never binds"):
        actuator_parameters(resolve(changed(motor__current_limit="500 A")))
    with pytest.raises(DesignError, match="supply_voltage"):
        actuator_parameters(resolve(PAPER), supply_voltage=0.0)


def test_missing_catalogue_data_are_assumed_and_said() -> None:
    one = actuator_parameters(resolve(changed(motor__name="T-Motor MN8014 KV100")))
    assert one.origins["motor.inductance"].startswith("assumed")
    assert one.origins["motor.rotor_inertia"].startswith(("assumed", "computed"))
    assert math.isnan(one.motor.rated_torque)
