"""The actuator in time: energy, passivity, analytic limits, scipy, the plain twin, bad input."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.columns import TRACES
from cqdd_design.actuator.compiled import is_compiled
from cqdd_design.actuator.packing import kinematic_error, largest_step, stiffness_share
from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    FrictionParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)
from cqdd_design.actuator.scenario import (
    Chirp,
    Command,
    Constant,
    Load,
    Ramp,
    Sampled,
    Scenario,
    Signal,
    Sine,
    Start,
    Wall,
)
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.thermal import continuous_current, response
from cqdd_design.design import load_design
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.gearbox.compiled import in_cache

SAMPLE = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
LOSSES = ("copper", "iron", "motor_friction", "output_friction", "gear_damping", "load_damping")
NO_FRICTION = FrictionParameters(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
COLD = ThermalParameters(0.4, 0.8, 1e12, 1e12)


def machine(friction: FrictionParameters | None = None, **changes: Any) -> ActuatorParameters:
    """An actuator with everything on; changes go to whichever table has the key."""
    tables: dict[str, dict[str, Any]] = {
        "motor": {
            "torque_constant": 0.17,
            "resistance": 0.15,
            "inductance": 1.4e-4,
            "rotor_inertia": 5e-4,
            "pole_pairs": 21,
            "rated_torque": 4.0,
            "peak_torque": 12.0,
            "cogging_amplitude": 0.02,
            "cogging_order": 36,
            "iron_loss": 2e-5,
            "hysteresis": 0.003,
        },
        "drive": {
            "supply_voltage": 48.0,
            "current_limit": 50.0,
            "current_bandwidth": 1000.0,
            "delay": 1e-4,
            "control_rate": 1000.0,
            "encoder_bits": 14,
            "position_gain": 60.0,
            "velocity_gain": 2.0,
        },
        "gear": {
            "ratio": -10.0,
            "input_inertia": 1e-5,
            "output_inertia": 2e-4,
            "error_orders": np.array([10, 11, 110]),
            "error_cosine": np.array([1e-4, 5e-5, 2e-5]),
            "error_sine": np.array([0.0, 3e-5, 1e-5]),
            "error_torque": 40.0,
            "stiffness": 1.4e4,
            "stiffness_cosine": np.array([0.0, 0.02, 0.02]),
            "stiffness_sine": np.array([0.01, 0.0, 0.01]),
            "stiffening": 1.3,
            "damping": 0.1,
            "backlash": 2e-3,
        },
    }
    thermal = changes.pop("thermal", ThermalParameters(0.4, 0.8, 40.0, 500.0))
    for key, value in changes.items():
        table = next(table for table in tables.values() if key in table)
        table[key] = value
    return ActuatorParameters(
        name="bench",
        motor=MotorParameters(**tables["motor"]),
        drive=DriveParameters(**tables["drive"]),
        thermal=thermal,
        friction=friction or FrictionParameters(0.01, 0.02, 1e-4, 1e-3, 0.5, 5.0, 0.3, 0.25),
        gear=GearParameters(**tables["gear"]),
        mass=1.8,
    )


def smooth(**changes: Any) -> ActuatorParameters:
    """A linear spring without gap, dry friction, cogging or warming."""
    plain = {
        "cogging_amplitude": 0.0,
        "hysteresis": 0.0,
        "iron_loss": 0.0,
        "stiffening": 1.0,
        "backlash": 0.0,
        "thermal": COLD,
        "delay": 0.0,
    }
    return machine(**{"friction": NO_FRICTION, **plain, **changes})


SCENES = {
    "locked": Scenario(Command("torque", Sine(20.0, 20.0)), Load.locked(5e4, 1.0)),
    "free": Scenario(Command("voltage", Constant(24.0)), Load.free()),
    "current": Scenario(Command("current", Sine(60.0, 30.0)), Load.flywheel(0.05, 0.1)),
    "wall": Scenario(
        Command("impedance", Sine(0.5, 4.0)),
        Load.pendulum(2.0, 0.5, viscous=0.02, wall=Wall(0.05, 3000.0)),
    ),
    "position": Scenario(
        Command("position", Constant(-0.3), integral_gain=20.0), Load.pendulum(1.0, 0.3)
    ),
    "driven": Scenario(Command("open"), Load.driven(Sine(1.0, 3.0))),
    "pushed": Scenario(Command("voltage"), Load.flywheel(0.01, torque=Sine(5.0, 3.0))),
}


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("name", list(SCENES))
def test_energy_is_kept_over_ten_seconds(name: str, friction: str) -> None:
    scene = replace(SCENES[name], friction=friction)
    found = simulate(machine(), scene, 10.0, 2e-5, every=1000)
    assert found.ledger.throughput[0] > 1e-3
    assert found.ledger.residual_share[0] < 1e-6
    assert not found.warnings
    assert all(getattr(found.ledger, loss)[0] >= 0.0 for loss in LOSSES)


@pytest.fixture(scope="module")
def drawn() -> ActuatorParameters:
    """The sample design with one gearbox drawn from its tolerances."""
    return actuator_parameters(load_design(SAMPLE), seed=3)


LOADS = {
    "locked": Scenario(Command("torque", Sine(20.0, 2.0)), Load.locked(2e4, 1.0)),
    "pendulum": Scenario(Command("impedance", Sine(1.0, 0.8)), Load.pendulum(2.28, 0.5)),
    "wall": Scenario(
        Command("impedance", Sine(1.0, 0.8)), Load.pendulum(2.28, 0.5, wall=Wall(0.5, 2000.0))
    ),
    "driven": Scenario(Command("open"), Load.driven(Sine(2.0, 0.5))),
    "free": Scenario(Command("voltage", Sine(24.0, 0.5)), Load.free()),
    "inertia": Scenario(Command("torque", Sine(10.0, 1.0)), Load.flywheel(0.1, 0.1)),
}


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("name", list(LOADS))
def test_energy_is_kept_by_a_drawn_gearbox(
    drawn: ActuatorParameters, name: str, friction: str
) -> None:
    found = simulate(drawn, replace(LOADS[name], friction=friction), 10.0, 2e-5, every=1000)
    assert found.ledger.throughput[0] > 1.0
    assert found.ledger.residual_share[0] < 1e-9
    assert not found.warnings


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("name", list(SCENES))
def test_kernel_and_plain_twin_agree(name: str, friction: str) -> None:
    scene = replace(SCENES[name], friction=friction)
    fast = simulate(machine(), scene, 0.008, 2e-5)
    slow = simulate(machine(), scene, 0.008, 2e-5, engine="plain")
    assert slow.ledger.residual_share[0] < 1e-12
    scale = {"output_torque": 1.0, "motor_friction": 1.0, "output_friction": 1.0}
    for trace in TRACES:
        ours, theirs = getattr(fast, trace), getattr(slow, trace)
        size = max(float(np.abs(theirs).max()), scale.get(trace, 1e-4))
        np.testing.assert_allclose(ours, theirs, atol=1e-6 * size, rtol=0, err_msg=trace)


@settings(max_examples=40, deadline=None)
@given(
    friction=st.builds(
        FrictionParameters,
        motor_coulomb=st.floats(0.0, 0.3),
        output_coulomb=st.floats(0.0, 2.0),
        motor_viscous=st.floats(0.0, 1e-2),
        output_viscous=st.floats(0.0, 0.1),
        stribeck_extra=st.floats(0.0, 1.0),
        stribeck_speed=st.floats(0.5, 20.0),
        load_forward=st.floats(0.0, 1.5),
        load_backward=st.floats(0.0, 1.5),
        bristle_deflection=st.floats(1e-4, 1e-2),
        bristle_damping=st.floats(0.0, 0.1),
    ),
    backlash=st.just(0.0) | st.floats(1e-5, 5e-3),
    damping=st.floats(0.0, 5.0),
    stiffening=st.floats(1.0, 2.0),
    speed=st.floats(-10.0, 10.0),
    motor_speed=st.floats(-100.0, 100.0),
    wound=st.floats(-0.03, 0.03),
    step=st.floats(2e-6, 3e-5),
    model=st.sampled_from(["clip", "lugre"]),
)
def test_friction_and_backlash_never_give_energy(
    friction: FrictionParameters,
    backlash: float,
    damping: float,
    stiffening: float,
    speed: float,
    motor_speed: float,
    wound: float,
    step: float,
    model: Any,
) -> None:
    one = machine(friction, backlash=backlash, damping=damping, stiffening=stiffening)
    start = Start(motor_angle=wound, motor_speed=motor_speed, output_speed=speed)
    scene = Scenario(Command("open"), Load.free(), start, model)
    found = simulate(one, scene, 2000 * step, step)
    ledger = found.ledger
    scale = float(ledger.stored_before[0]) + 1e-3
    assert abs(ledger.residual[0]) < 1e-7 * scale
    for loss in LOSSES:
        assert getattr(ledger, loss)[0] >= -1e-12 * scale
    if backlash > 0.0:
        apart = np.sign(found.deflection) * np.maximum(
            np.abs(found.deflection) - 0.5 * backlash, 0.0
        )
        # Contact pushes only: within a step the sides do not change but at its ends.
        inside = (np.abs(apart[0, 1:]) > 0.0) & (apart[0, 1:] * apart[0, :-1] > 0.0)
        assert np.all(found.gear_torque[0, 1:][inside] * apart[0, 1:][inside] >= -1e-9)
    if model == "clip":
        mean = np.diff(found.motor_angle[0]) / step
        viscous = friction.motor_viscous * mean
        dry = found.motor_friction[0, 1:] - viscous
        assert np.all(dry * mean >= -1e-7 * (np.abs(dry).max() + 1e-3))


def test_dry_friction_holds_a_pendulum_for_good() -> None:
    one = machine(replace(machine().friction, motor_coulomb=1.0), cogging_amplitude=0.0)
    scene = Scenario(Command("open"), Load.pendulum(2.0, 0.25), Start(output_angle=0.8))
    found = simulate(one, scene, 3.0, 2e-5, every=500)
    last = found.output_angle[0, -60:]
    assert np.ptp(found.motor_angle[0, -60:]) == 0.0
    assert np.ptp(last) < 1e-12
    assert last[0] > 0.7


def test_friction_of_both_realisations_agrees_while_sliding() -> None:
    scene = Scenario(Command("open"), Load.driven(Constant(1.0)))
    both = [
        simulate(machine(), replace(scene, friction=kind), 0.5, 2e-5, every=10)
        for kind in ("clip", "lugre")
    ]
    mean = [float(run.motor_friction[0, -1000:].mean()) for run in both]
    assert mean[0] == pytest.approx(mean[1], rel=0.01)


@pytest.mark.parametrize("forward", [True, False])
def test_load_friction_gives_its_efficiency(forward: bool) -> None:
    friction = replace(NO_FRICTION, load_forward=0.3, load_backward=0.25)
    one = machine(friction, cogging_amplitude=0.0, hysteresis=0.0, iron_loss=0.0, thermal=COLD)
    load = Load.flywheel(0.1, torque=Constant(-10.0 if forward else 10.0))
    # The motor gives, or holds back, what the efficiency leaves of 10 N m at the output.
    torque = 1.3 if forward else -0.75
    current = -torque / one.motor.torque_constant
    start = Start(output_speed=1.0, current=current)
    found = simulate(one, Scenario(Command("current", Constant(current)), load, start), 1.0, 2e-5,
                     every=10)  # fmt: skip
    # Balanced by the efficiency, the machine neither gains nor loses speed.
    speed = found.output_speed[0]
    assert abs(float(speed[-2000:].mean()) - float(speed[3000:5000].mean())) < 0.02


def test_current_rises_as_in_a_coil() -> None:
    one = smooth(rotor_inertia=1e6)
    found = simulate(one, Scenario(Command("voltage", Constant(3.0))), 5e-3, 2e-6)
    tau = one.motor.inductance / one.motor.resistance
    wanted = 3.0 / one.motor.resistance * -np.expm1(-found.time / tau)
    np.testing.assert_allclose(found.current[0], wanted, atol=1e-4 * wanted[-1], rtol=0)


def test_current_loop_is_of_first_order_and_late_by_its_delay() -> None:
    one = smooth(rotor_inertia=1e6, delay=5e-4)
    found = simulate(one, Scenario(Command("current", Constant(2.0))), 3e-3, 2e-6)
    late = np.maximum(found.time - 5e-4, 0.0)
    wanted = 2.0 * -np.expm1(-2.0 * math.pi * 1000.0 * late)
    np.testing.assert_allclose(found.current[0], wanted, atol=2e-4, rtol=0)


def test_temperatures_follow_the_exact_network() -> None:
    thermal = ThermalParameters(0.4, 0.8, 4.0, 30.0)
    one = replace(smooth(stiffness=50.0, rotor_inertia=0.1), thermal=thermal)
    load = Load.locked(50.0, 20.0)
    command = Command("current", Constant(15.0))
    start = Start(current=15.0, motor_angle=-15.0 * 0.17 * 100.0 * (1 / 50.0 + 0.1 / 50.0))
    found = simulate(one, Scenario(command, load, start), 60.0, 2e-4, every=5000)
    exact = response(one.motor, thermal, 15.0, found.time)
    rise = exact[-1, 0] - 25.0
    # What the swing of the load loses in friction is nothing here.
    np.testing.assert_allclose(found.winding_temperature[0], exact[:, 0], atol=1e-4 * rise)
    np.testing.assert_allclose(found.housing_temperature[0], exact[:, 1], atol=1e-4 * rise)


def test_linear_transmission_swings_as_a_second_order_system() -> None:
    one = smooth(
        error_cosine=np.zeros(3),
        error_sine=np.zeros(3),
        stiffness_cosine=np.zeros(3),
        stiffness_sine=np.zeros(3),
    )
    start = Start(motor_angle=-0.01)
    found = simulate(one, Scenario(Command("open"), Load.free(), start), 4e-3, 4e-7)
    gear = one.gear
    mobility = 1.0 / (gear.ratio**2 * one.motor_side_inertia) + 1.0 / gear.output_inertia
    decay = 0.5 * gear.damping * mobility
    pulse = math.sqrt(gear.stiffness * mobility - decay**2)
    t = found.time
    swing = np.exp(-decay * t) * (np.cos(pulse * t) + decay / pulse * np.sin(pulse * t))
    np.testing.assert_allclose(found.deflection[0], 1e-3 * swing, atol=1e-7, rtol=0)


def test_nothing_passes_the_dead_zone_until_it_is_crossed() -> None:
    one = smooth(backlash=2e-3, damping=1.0, error_cosine=np.zeros(3), error_sine=np.zeros(3))
    start = Start(motor_speed=0.0)
    scene = Scenario(Command("open"), Load.driven(Constant(0.1)), start)
    found = simulate(one, scene, 0.02, 2e-6)
    crossed = 0.5 * one.gear.backlash / 0.1
    before = found.time < crossed - 2e-6
    assert np.all(found.gear_torque[0, before] == 0.0)
    assert np.all(found.motor_speed[0, before] == 0.0)
    first = found.time[np.flatnonzero(found.gear_torque[0])[0]]
    assert first == pytest.approx(crossed, rel=1e-3)


def test_what_hits_behind_the_dead_zone_rebounds_as_a_second_order_system() -> None:
    flat = {"error_cosine": np.zeros(3), "error_sine": np.zeros(3)}
    flat |= {"stiffness_cosine": np.zeros(3), "stiffness_sine": np.zeros(3)}
    one = smooth(backlash=2e-3, damping=1.0, **flat)
    gear, speed = one.gear, 0.1
    scene = Scenario(Command("open"), Load.driven(Constant(speed)), Start(motor_speed=0.0))
    found = simulate(one, scene, 0.016, 2e-7)
    # The motor's inertia at rest is met by spring and damper that move with the output.
    mass = gear.ratio**2 * one.motor_side_inertia
    decay = 0.5 * gear.damping / mass
    pulse = math.sqrt(gear.stiffness / mass - decay**2)
    since = found.time - 0.5 * gear.backlash / speed
    pushing = (since > 0.0) & (since < 0.9 * math.pi / pulse)
    t = since[pushing]
    pressed = speed / pulse * np.exp(-decay * t) * np.sin(pulse * t)
    most = float(np.abs(pressed).max())
    deflection = -found.deflection[0, pushing] - 0.5 * gear.backlash
    assert pushing.sum() > 1000
    np.testing.assert_allclose(deflection, pressed, atol=1e-4 * most, rtol=0)


def test_held_torque_winds_up_gap_and_spring() -> None:
    one = smooth(backlash=2e-3, damping=5.0, error_cosine=np.zeros(3), error_sine=np.zeros(3))
    still = {"stiffness_cosine": np.zeros(3), "stiffness_sine": np.zeros(3)}
    one = replace(one, gear=replace(one.gear, stiffening=1.4, **still))
    load = Load.locked(3e4, 20.0)
    found = simulate(one, Scenario(Command("torque", Constant(12.0)), load), 1.5, 2e-5, every=100)
    gear = one.gear
    windup = (12.0 / gear.error_torque) ** (1.0 / 1.4) * gear.error_torque / gear.stiffness
    assert found.deflection[0, -1] == pytest.approx(1e-3 + windup, rel=1e-4)
    assert found.output_torque[0, -1] == pytest.approx(12.0, rel=1e-4)
    assert found.output_angle[0, -1] == pytest.approx(12.0 / 3e4, rel=1e-4)


def test_agrees_with_radau_on_the_smooth_equations() -> None:
    from scipy.integrate import solve_ivp

    friction = replace(NO_FRICTION, motor_viscous=2e-4, output_viscous=5e-3)
    one = smooth(
        friction=friction, stiffness=800.0, cogging_amplitude=0.02, error_orders=np.array([1, 3, 7])
    )
    moment, inertia = 1.5 * 9.80665 * 0.2, 1.5 * 0.04
    load = Load.pendulum(1.5, 0.2)
    gear, motor = one.gear, one.motor

    def slope_of(function: Any, angle: float) -> float:
        ends = function(gear, np.array([angle - 1e-4, angle + 1e-4]))
        return float(ends[1] - ends[0]) / 2e-4

    def rates(t: float, state: np.ndarray) -> list[float]:
        current, angle, speed, out, out_speed = state
        at = np.array([angle])
        shape = 1.0 / gear.ratio + slope_of(kinematic_error, angle)
        closing = angle / gear.ratio + float(kinematic_error(gear, at)[0]) - out
        share = float(stiffness_share(gear, at)[0])
        torque = share * gear.stiffness * closing
        torque += gear.damping * (shape * speed - out_speed)
        varying = 0.5 * gear.stiffness * closing**2 * slope_of(stiffness_share, angle)
        voltage = 6.0 * math.sin(2.0 * math.pi * 8.0 * t)
        drive = motor.torque_constant * current - friction.motor_viscous * speed
        drive -= motor.cogging_amplitude * math.sin(motor.cogging_order * angle)
        pull = moment * math.sin(out) + friction.output_viscous * out_speed
        back = motor.resistance * current + motor.torque_constant * speed
        return [
            (voltage - back) / motor.inductance,
            speed,
            (drive - shape * torque - varying) / one.motor_side_inertia,
            out_speed,
            (torque - pull) / (gear.output_inertia + inertia),
        ]

    scene = Scenario(Command("voltage", Sine(6.0, 8.0)), load)
    found = simulate(one, scene, 0.2, 1e-6, every=1000)
    first = -gear.ratio * 0.0
    for _ in range(50):
        first = -gear.ratio * float(kinematic_error(gear, np.array([first]))[0])
    exact = solve_ivp(
        rates, (0.0, 0.2), [0.0, first, 0.0, 0.0, 0.0], "Radau", found.time, rtol=1e-9, atol=1e-11
    ).y
    for row, name in enumerate(
        ("current", "motor_angle", "motor_speed", "output_angle", "output_speed")
    ):
        size = float(np.abs(exact[row]).max())
        np.testing.assert_allclose(getattr(found, name)[0], exact[row], atol=1e-6 * size, rtol=0)


@pytest.mark.parametrize("mode", ["torque", "impedance", "position"])
def test_a_positive_command_moves_the_output_positively(mode: Any) -> None:
    scene = Scenario(Command(mode, Constant(0.5)), Load.flywheel(0.02))
    for ratio in (-10.0, 11.0):
        found = simulate(machine(ratio=ratio), scene, 0.1, 2e-5)
        assert found.output_angle[0, -1] > 0.005
        assert found.gear_torque[0].max() > 0.0


def test_derating_leaves_the_current_that_can_be_held() -> None:
    one = machine()
    hot = Start(winding_temperature=130.0, housing_temperature=90.0)
    scene = Scenario(Command("torque", Constant(50.0)), Load.locked(2e4, 10.0), hot)
    found = simulate(one, scene, 0.05, 2e-5)
    held = continuous_current(one.motor, one.thermal)
    assert abs(found.current[0, -1]) == pytest.approx(held, rel=1e-6)


def test_numbers_do_not_depend_on_threads_or_company() -> None:
    sets = [machine(stiffness=1e4 + 500.0 * i, backlash=1e-4 * i) for i in range(7)]
    scenes = [replace(SCENES["wall"], command=Command("impedance", Sine(0.1 * i, 3.0)))
              for i in range(1, 8)]  # fmt: skip
    one, three = (simulate(sets, scenes, 0.1, 2e-5, threads=k) for k in (1, 3))
    alone = simulate(sets[4], scenes[4], 0.1, 2e-5)
    for trace in TRACES:
        assert np.array_equal(getattr(one, trace), getattr(three, trace))
        assert np.array_equal(getattr(one, trace)[4], getattr(alone, trace)[0])


@pytest.mark.parametrize(
    "signal",
    [
        Sine(2.0, 3.0, 0.5, 0.7),
        Chirp(1.5, 0.5, 20.0, 2.0, 0.1),
        Ramp(1.0, -2.0),
        Sampled(np.array([0.0, 0.5, 3.0]), np.array([1.0, 3.0, -2.0])),
        Constant(4.0),
    ],
)
def test_rates_are_the_derivatives_of_signals(signal: Signal) -> None:
    t = np.linspace(0.013, 1.9, 101)
    numeric = (signal.values(t + 1e-6) - signal.values(t - 1e-6)) / 2e-6
    np.testing.assert_allclose(signal.rates(t), numeric, atol=1e-4)


@pytest.mark.parametrize("name", ["free", "locked", "wall", "position"])
def test_a_step_too_large_names_one_that_works(name: str) -> None:
    one = machine()
    limit, cause = largest_step(one, SCENES[name])
    with pytest.raises(UsageError, match=cause) as told:
        simulate(one, SCENES[name], 1.0, 1.2 * limit)
    works = float(str(told.value).split("use ")[1].split(" s")[0])
    assert works <= limit
    assert simulate(one, SCENES[name], 100 * works, works).ledger.residual_share[0] < 1e-6


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"resistance": 0.0}, "motor.resistance"),
        ({"rotor_inertia": -1e-4}, "motor.rotor_inertia"),
        ({"supply_voltage": 0.0}, "drive.supply_voltage"),
        ({"torque_constant": math.nan}, "motor.torque_constant"),
        ({"backlash": -1e-3}, "gear.backlash"),
        ({"output_inertia": 0.0}, "gear.output_inertia"),
        ({"ratio": 0.5}, "gear.ratio"),
        ({"encoder_bits": 40}, "drive.encoder_bits"),
        ({"error_sine": np.array([math.nan, 0.0, 0.0])}, "gear.error_sine"),
        ({"stiffness_sine": np.array([0.9, 0.9, 0.9])}, "gear.stiffness_cosine"),
        ({"rotor_inertia": 0.0, "input_inertia": 0.0}, "rotor_inertia"),
    ],
)
def test_impossible_machines_are_refused(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(DesignError, match=word):
        machine(**changes)


@pytest.mark.parametrize(
    ("duration", "step", "every"),
    [
        (0.0, 1e-5, 1),
        (-1.0, 1e-5, 1),
        (math.inf, 1e-5, 1),
        (math.nan, 1e-5, 1),
        (1.0, 0.0, 1),
        (1.0, -1e-5, 1),
        (1.0, math.nan, 1),
        (1e-4, 1e-5, 20),
        (1.0, 1e-5, 0),
    ],
)
def test_senseless_times_are_refused(duration: float, step: float, every: int) -> None:
    times_are_sound = duration > 0.0 and step > 0.0 and math.isfinite(duration)
    word = "every|record" if times_are_sound else "duration|step"
    with pytest.raises(UsageError, match=word):
        simulate(machine(), SCENES["free"], duration, step, every=every)


@dataclass(frozen=True)
class Gap:
    """A signal that is missing after half a second."""

    def values(self, times: np.ndarray) -> np.ndarray:
        return np.where(times < 0.5, 1.0, np.nan)

    def rates(self, times: np.ndarray) -> np.ndarray:
        return np.zeros_like(times)


@pytest.mark.parametrize(
    ("scenario", "word"),
    [
        (Scenario(Command("torque", Gap())), "0.50001 s"),
        (Scenario(Command("impedance", feedforward=Gap())), "finite"),
        (Scenario(Command("open"), Load.driven(Gap())), "finite"),
        (Scenario(Command("impedance", position_gain=math.nan)), "position_gain nan"),
        (Scenario(Command("position", integral_gain=math.inf)), "integral_gain inf"),
        (Scenario(start=Start(output_angle=math.nan)), "output_angle nan"),
        (Scenario(Command("torqe")), "command.mode 'torqe'.*impedance"),  # type: ignore[arg-type]
        (Scenario(friction="dahl"), "friction 'dahl'.*lugre"),  # type: ignore[arg-type]
    ],
)
def test_what_is_not_a_number_or_not_known_is_named(scenario: Scenario, word: str) -> None:
    with pytest.raises(UsageError, match=word):
        simulate(machine(), scenario, 1.0, 2e-5)


def test_a_simulation_of_nothing_is_refused() -> None:
    for sets, scenes in (([], SCENES["free"]), (machine(), [])):
        with pytest.raises(UsageError, match="there is none"):
            simulate(sets, scenes, 0.01, 1e-5)
    with pytest.raises(UsageError, match="threads -1"):
        simulate(machine(), SCENES["free"], 0.01, 1e-5, threads=-1)
    with pytest.raises(UsageError, match="engine"):
        simulate(machine(), SCENES["free"], 0.01, 1e-5, engine="fortran")  # type: ignore[arg-type]


def test_compilation_is_told_from_the_cache(tmp_path: Path) -> None:
    simulate(machine(), SCENES["free"], 1e-3, 2e-5)
    assert is_compiled()
    stand_in = SimpleNamespace(
        _cache=SimpleNamespace(cache_path=str(tmp_path)),
        __module__="somewhere.kernel",
        __name__="run_sets",
    )
    assert not in_cache(stand_in)
    (tmp_path / "kernel.run_sets-1.py311.nbi").touch()
    assert in_cache(stand_in)


def test_senseless_loads_and_signals_are_refused() -> None:
    with pytest.raises(UsageError, match="finite"):
        Sine(math.nan, 1.0)
    with pytest.raises(UsageError, match="rise"):
        Sampled(np.array([0.0, 0.0]), np.array([1.0, 1.0]))
    with pytest.raises(UsageError, match="mass"):
        Load.pendulum(0.0, 1.0)
    with pytest.raises(UsageError, match="inertia"):
        Load.flywheel(-1.0)
    with pytest.raises(UsageError, match="pair"):
        simulate([machine()] * 3, [SCENES["free"]] * 2, 0.01, 1e-5)
