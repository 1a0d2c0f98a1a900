"""Torque of a stop of the reference design beside a second implementation's.

That implementation: 553 N m from the rated speed and 123 N m from 3 rad/s, by w sqrt(k J) with the
stiffness and the reflected inertia that it found (0.0759 kg m^2 at the output, 22.2 kN m/rad).
"""

from __future__ import annotations

import dataclasses
import math

import pytest
from reference_design import DESIGN_S

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.shock import shock, simulated_torque
from cqdd_design.design import load_design
from cqdd_design.machine import Machine, resolve

RATED = 128.6 * math.pi / 30.0
INERTIA = 0.0759
"""Of rotor, crank and discs at the output: that of the motor's row at the time."""


@pytest.fixture(scope="module")
def reference() -> tuple[Machine, ActuatorParameters]:
    machine = resolve(load_design(DESIGN_S))
    found = actuator_parameters(machine)
    rotor = INERTIA / found.gear.ratio**2 - found.gear.input_inertia
    motor = dataclasses.replace(found.motor, rotor_inertia=rotor)
    return machine, dataclasses.replace(found, motor=motor)


@pytest.mark.parametrize(("speed", "published"), [(RATED, 553.0), (3.0, 123.0)])
def test_a_stop_of_the_reference_design(
    reference: tuple[Machine, ActuatorParameters], speed: float, published: float
) -> None:
    found = shock(*reference, speed)
    assert found.stops["by_secant"].torque == pytest.approx(published, rel=0.01)
    assert found.energy == pytest.approx(0.5 * INERTIA * speed**2)
    # Time integration of the same linear spring, nothing lost, misses it by no more than a step.
    parameters = reference[1]
    lossless = dataclasses.replace(
        parameters.friction,
        motor_coulomb=0.0, output_coulomb=0.0, motor_viscous=0.0, output_viscous=0.0,
        load_forward=0.0, load_backward=0.0,
    )  # fmt: skip
    none = 0.0 * parameters.gear.error_cosine
    linear = dataclasses.replace(
        parameters.gear,
        stiffening=1.0, damping=0.0,
        error_cosine=none, error_sine=none, stiffness_cosine=none, stiffness_sine=none,
    )  # fmt: skip
    motor = dataclasses.replace(
        parameters.motor, cogging_amplitude=0.0, iron_loss=0.0, hysteresis=0.0
    )
    plain = dataclasses.replace(parameters, friction=lossless, gear=linear, motor=motor)
    assert simulated_torque(plain, speed) == pytest.approx(published, rel=0.015)


def test_what_the_stiffening_explains(reference: tuple[Machine, ActuatorParameters]) -> None:
    """From 3 rad/s the stiffening law asks for a third more; friction takes a fifth off again."""
    stops = shock(*reference, 3.0).stops
    torque = {name: stop.torque for name, stop in stops.items()}
    assert torque["by_energy"] == pytest.approx(1.35 * 123.0, rel=0.05)
    assert 0.7 * torque["by_energy"] < torque["by_simulation"] < torque["by_energy"]
    assert torque["by_simulation_motor_in"] > torque["by_simulation"] + 50.0


def test_from_the_rated_speed_no_equilibrium_carries_it(
    reference: tuple[Machine, ActuatorParameters],
) -> None:
    """A sentence, and neither torque nor force, where the parts do not reach."""
    stop = shock(*reference, RATED).stops["by_energy"]
    assert stop.torque is None
    assert not stop.forces
    assert not stop.limits
    assert "farther than they reach" in stop.told
