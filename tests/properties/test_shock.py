"""Stops: energy against closed forms, the contact equilibrium and the simulation in time."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
from cqdd_design.actuator.shock import METHODS, shock, shocks, simulated_torque, stop_torque
from cqdd_design.design import load_design
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.machine import Machine, resolve

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGN))


@pytest.fixture(scope="module")
def actuator(machine: Machine) -> ActuatorParameters:
    return actuator_parameters(machine)


def spring(power: float, backlash: float = 0.0) -> GearParameters:
    none = np.zeros(0)
    return GearParameters(
        ratio=-10.0, input_inertia=1e-4, output_inertia=1e-4, error_orders=none.astype(int),
        error_cosine=none, error_sine=none, error_torque=34.2, stiffness=22e3,
        stiffness_cosine=none, stiffness_sine=none, stiffening=power, damping=0.0,
        backlash=backlash,
    )  # fmt: skip


@given(st.floats(1.0, 3.0), st.floats(1e-6, 1e3), st.floats(0.0, 100.0), st.floats(0.0, 0.01))
def test_the_spring_takes_all_the_energy(
    power: float, energy: float, motor: float, backlash: float
) -> None:
    gear = spring(power, backlash)
    torque = stop_torque(gear, energy, motor)
    windup = 34.2 / 22e3 * (torque / 34.2) ** (1.0 / power)
    taken = torque * windup / (power + 1.0)
    assert taken == pytest.approx(energy + motor * (backlash + windup), rel=1e-9)


def test_a_linear_spring_peaks_at_the_closed_form() -> None:
    assert stop_torque(spring(1.0), 0.5 * 0.0759 * 9.0) == pytest.approx(
        3.0 * math.sqrt(22e3 * 0.0759), rel=1e-9
    )
    # Without energy the motor alone doubles its own torque on a linear spring.
    assert stop_torque(spring(1.0), 0.0, 40.0) == pytest.approx(80.0, rel=1e-9)
    assert stop_torque(spring(2.0), 0.0) == 0.0


def lossless(actuator: ActuatorParameters) -> ActuatorParameters:
    none = 0.0 * actuator.gear.error_cosine
    series = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
    friction = dataclasses.replace(
        actuator.friction,
        motor_coulomb=0.0, output_coulomb=0.0, motor_viscous=0.0, output_viscous=0.0,
        load_forward=0.0, load_backward=0.0,
    )  # fmt: skip
    gear = dataclasses.replace(actuator.gear, damping=0.0, **dict.fromkeys(series, none))
    motor = dataclasses.replace(
        actuator.motor,
        cogging_amplitude=0.0, iron_loss=0.0, hysteresis=0.0, coulomb=0.0, viscous=0.0,
    )  # fmt: skip
    return dataclasses.replace(actuator, friction=friction, gear=gear, motor=motor)


@pytest.mark.parametrize("speed", [0.3, 3.0, 20.0])
def test_time_integration_without_losses_is_the_energy(
    actuator: ActuatorParameters, speed: float
) -> None:
    plain = lossless(actuator)
    inertia = plain.motor_side_inertia * plain.gear.ratio**2
    wanted = stop_torque(plain.gear, 0.5 * inertia * speed**2)
    assert simulated_torque(plain, speed) == pytest.approx(wanted, rel=5e-3)


def test_the_motor_works_over_half_of_the_backlash_in_time(actuator: ActuatorParameters) -> None:
    """The simulation begins in the middle of the backlash, the energy with the whole of it."""
    plain = lossless(actuator)
    drive = dataclasses.replace(plain.drive, supply_voltage=1e3)
    quick = dataclasses.replace(plain.motor, inductance=0.0)
    plain = dataclasses.replace(plain, drive=drive, motor=quick)
    inertia = plain.motor_side_inertia * plain.gear.ratio**2
    half = dataclasses.replace(plain.gear, backlash=0.5 * plain.gear.backlash)
    motor = 20.0 * plain.motor.torque_constant * 10.0
    wanted = stop_torque(half, 0.5 * inertia * 9.0, motor)
    assert simulated_torque(plain, 3.0, 20.0) == pytest.approx(wanted, rel=0.01)


@pytest.mark.parametrize(("torque", "within"), [(60.0, 0.05), (160.0, 0.1)])
def test_the_stiffening_law_stores_what_the_contacts_store(
    machine: Machine, actuator: ActuatorParameters, torque: float, within: float
) -> None:
    """Far beyond the torque it is fitted to, the law's torque of a stop is near the contacts'."""
    states = nominal_states(machine.contact, perfect_angles(machine.contact, 24))
    stored = 0.0
    for load in (torque, -torque):
        sweep = contact_sweep(machine.contact, load, states=states)
        stored += 0.5 * float(np.mean(sweep.energy + load * sweep.carrier_angle_error))
    assert stop_torque(actuator.gear, stored) == pytest.approx(torque, rel=within)


def test_limits_are_those_of_the_checks(machine: Machine, actuator: ActuatorParameters) -> None:
    found = shock(machine, actuator, 3.0)
    assert set(found.stops) == set(METHODS)
    stop = found.stops["by_energy"]
    beside = {one.check: one for one in stop.limits}
    check = {one.id: one for one in machine.analysis.checks}["CONTACT-RING-PEAK"]
    assert beside["CONTACT-RING-PEAK"].limit == check.limit
    assert beside["CONTACT-RING-PEAK"].value == stop.forces["ring_pressure_max_MPa"]
    assert [one.share for one in stop.limits] == sorted(
        (one.share for one in stop.limits), reverse=True
    )
    assert "static rating of the cam bearing" in stop.told


def test_a_given_speed_stands_beside_the_rated_one(machine: Machine) -> None:
    assert set(shocks(machine)[0]) == {"rated"}
    asked = resolve(machine.design.replacing({"requirements.shock_speed": "0.5 rad/s"}))
    found, missing = shocks(asked)
    assert (set(found), missing) == ({"rated", "given"}, "")
    assert found["given"].speed == 0.5
    assert "within static limits" in found["given"].stops["by_simulation"].told
