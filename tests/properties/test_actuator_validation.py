"""What the actuator in time is held to, whose figures docs/actuator-model.md shows.

Each test records what it compared with, the worst difference it met and the bound it holds to;
`docs/build.py` runs this file and writes the table from those records.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from actuator_machines import NO_FRICTION, smooth

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.packing import kinematic_error, stiffness_share
from cqdd_design.actuator.parameters import ActuatorParameters, ThermalParameters
from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Sine, Start, Wall
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.actuator.thermal import response
from cqdd_design.design import load_design
from cqdd_design.machine import resolve

Validated = Callable[[str, str, float, float], None]
SAMPLE = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"


def worst(found: Any, wanted: Any) -> float:
    """Greatest difference over the greatest wanted value."""
    return float(np.abs(np.asarray(found) - wanted).max() / np.abs(wanted).max())


@pytest.fixture(scope="module")
def drawn() -> ActuatorParameters:
    """The sample design with one gearbox drawn from its tolerances."""
    return actuator_parameters(resolve(load_design(SAMPLE)), Specimen(seed=3))


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
    drawn: ActuatorParameters, validated: Validated, name: str, friction: str
) -> None:
    found = simulate(drawn, replace(LOADS[name], friction=friction), 10.0, 2e-5, every=1000)
    assert found.ledger.throughput[0] > 1.0
    assert not found.warnings
    what = f"energy over 10 s, {name}, {friction}, missing share of throughput"
    validated(what, "sum of all works and losses", float(found.ledger.residual_share[0]), 1e-9)


def test_current_rises_as_in_a_coil(validated: Validated) -> None:
    one = smooth(rotor_inertia=1e6)
    found = simulate(one, Scenario(Command("voltage", Constant(3.0))), 5e-3, 2e-6)
    tau = one.motor.inductance / one.motor.resistance
    wanted = 3.0 / one.motor.resistance * -np.expm1(-found.time / tau)
    validated(
        "current of a held motor under voltage", "RL circuit", worst(found.current[0], wanted), 1e-4
    )


def test_current_loop_is_of_first_order_and_late_by_its_delay(validated: Validated) -> None:
    one = smooth(rotor_inertia=1e6, delay=5e-4)
    found = simulate(one, Scenario(Command("current", Constant(2.0))), 3e-3, 2e-6)
    late = np.maximum(found.time - 5e-4, 0.0)
    wanted = 2.0 * -np.expm1(-2.0 * math.pi * 1000.0 * late)
    miss = worst(found.current[0], wanted)
    validated("current loop with delay", "first order, late by the delay", miss, 1e-4)


def test_temperatures_follow_the_exact_network(validated: Validated) -> None:
    thermal = ThermalParameters(0.4, 0.8, 4.0, 30.0)
    one = replace(smooth(stiffness=50.0, rotor_inertia=0.1), thermal=thermal)
    load = Load.locked(50.0, 20.0)
    command = Command("current", Constant(15.0))
    start = Start(current=15.0, motor_angle=-15.0 * 0.17 * 100.0 * (1 / 50.0 + 0.1 / 50.0))
    found = simulate(one, Scenario(command, load, start), 60.0, 2e-4, every=5000)
    exact = response(one.motor, thermal, 15.0, found.time)
    rise = exact[-1, 0] - 25.0
    # What the swing of the load loses in friction is nothing here.
    told = np.stack([found.winding_temperature[0], found.housing_temperature[0]], axis=1)
    miss = float(np.abs(told - exact).max()) / rise
    validated("temperatures of winding and housing", "exact RC network", miss, 1e-4)


def test_linear_transmission_swings_as_a_second_order_system(validated: Validated) -> None:
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
    miss = worst(found.deflection[0], 1e-3 * swing)
    validated("swing of motor and output on the gearbox", "second-order system", miss, 1e-4)


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


def test_what_hits_behind_the_dead_zone_rebounds_as_a_second_order_system(
    validated: Validated,
) -> None:
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
    deflection = -found.deflection[0, pushing] - 0.5 * gear.backlash
    assert pushing.sum() > 1000
    validated(
        "impact behind the dead zone", "second-order rebound", worst(deflection, pressed), 1e-4
    )


def test_held_torque_winds_up_gap_and_spring(validated: Validated) -> None:
    one = smooth(backlash=2e-3, damping=5.0, error_cosine=np.zeros(3), error_sine=np.zeros(3))
    still = {"stiffness_cosine": np.zeros(3), "stiffness_sine": np.zeros(3)}
    one = replace(one, gear=replace(one.gear, stiffening=1.4, **still))
    load = Load.locked(3e4, 20.0)
    found = simulate(one, Scenario(Command("torque", Constant(12.0)), load), 1.5, 2e-5, every=100)
    gear = one.gear
    windup = (12.0 / gear.error_torque) ** (1.0 / 1.4) * gear.error_torque / gear.stiffness
    miss = abs(found.deflection[0, -1] / (1e-3 + windup) - 1.0)
    validated("windup behind the dead zone, stiffening spring", "closed form", miss, 1e-4)
    assert found.output_torque[0, -1] == pytest.approx(12.0, rel=1e-4)
    assert found.output_angle[0, -1] == pytest.approx(12.0 / 3e4, rel=1e-4)


def test_agrees_with_radau_on_the_smooth_equations(validated: Validated) -> None:
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
    states = ("current", "motor_angle", "motor_speed", "output_angle", "output_speed")
    miss = max(worst(getattr(found, name)[0], exact[k]) for k, name in enumerate(states))
    validated("all states of a pendulum, smooth equations", "Radau of scipy", miss, 1e-6)
