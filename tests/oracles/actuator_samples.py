"""Actuators made by hand for the tests of what reads `ActuatorParameters`.

`paper_actuator` has the paper's motor constants, limits and inertia, and values of their usual size
where it gives none; `random_actuators` draws every value that an exporter reads.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from hypothesis import strategies as st

from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    FrictionParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)


def paper_actuator(
    ratio: float = -10.0, voltage: float = 24.0, current: float = 50.5
) -> ActuatorParameters:
    """Near the paper's: 0.178 N m/A, 24 V, 50.5 A, 5.01e-4 kg m^2 at the motor, 10:1 reversed."""
    return ActuatorParameters(
        name="paper",
        motor=MotorParameters(
            torque_constant=0.178,
            resistance=0.098,
            inductance=60e-6,
            rotor_inertia=4.6e-4,
            pole_pairs=21,
            rated_torque=3.5,
            peak_torque=12.0,
            cogging_amplitude=0.02,
            cogging_order=42,
            iron_loss=2e-4,
            hysteresis=0.02,
        ),
        drive=DriveParameters(
            supply_voltage=voltage,
            current_limit=current,
            current_bandwidth=1000.0,
            delay=1e-3,
            control_rate=1000.0,
            encoder_bits=14,
            position_gain=60.0,
            velocity_gain=2.0,
        ),
        thermal=ThermalParameters(
            winding_to_housing=0.4,
            housing_to_ambient=0.8,
            winding_capacity=120.0,
            housing_capacity=900.0,
        ),
        friction=FrictionParameters(
            motor_coulomb=0.05,
            output_coulomb=0.3,
            motor_viscous=3e-4,
            output_viscous=0.02,
            stribeck_extra=0.3,
            stribeck_speed=3.0,
            load_forward=0.09,
            load_backward=0.1,
        ),
        gear=GearParameters(
            ratio=ratio,
            input_inertia=4.1e-5,
            output_inertia=4e-4,
            error_orders=np.array([1, 5, 10, 11, 20]),
            error_cosine=np.array([1e-4, 4e-5, 8e-5, -3e-5, 1e-8]),
            error_sine=np.array([-5e-5, 2e-5, 6e-5, 4e-5, 0.0]),
            error_torque=5.0,
            stiffness=1e4,
            stiffness_cosine=np.zeros(5),
            stiffness_sine=np.zeros(5),
            stiffening=1.1,
            damping=5.0,
            backlash=np.radians(7.03 / 60.0),
        ),
        mass=1.59,
        origins={
            "motor.torque_constant": "catalogue (speed constant 55 rpm/V)",
            "gear.backlash": "computed, mean of an output turn",
            "thermal.winding_to_housing": "assumed",
        },
    )


def frictionless(parameters: ActuatorParameters) -> ActuatorParameters:
    """The same without friction, cogging and iron loss."""
    return dataclasses.replace(
        parameters,
        motor=dataclasses.replace(
            parameters.motor, cogging_amplitude=0.0, iron_loss=0.0, hysteresis=0.0
        ),
        friction=FrictionParameters(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    )


def without_ripple(parameters: ActuatorParameters) -> ActuatorParameters:
    """The same with a perfect profile."""
    gear = parameters.gear
    names = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
    none = {name: np.zeros(len(gear.error_orders)) for name in names}
    return dataclasses.replace(parameters, gear=dataclasses.replace(gear, **none))


def _between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


@st.composite
def random_actuators(draw: st.DrawFn) -> ActuatorParameters:
    """Actuators from a finger's to a leg's, either sense, with and without friction and play."""
    base = paper_actuator()
    count = draw(st.integers(0, 6))
    orders = sorted(draw(st.sets(st.integers(1, 200), min_size=count, max_size=count)))
    waves = st.lists(st.floats(-1e-4, 1e-4), min_size=count, max_size=count)
    zero_or = lambda low, high: st.one_of(st.just(0.0), _between(low, high))  # noqa: E731
    return dataclasses.replace(
        base,
        motor=dataclasses.replace(
            base.motor,
            torque_constant=draw(_between(0.01, 0.5)),
            resistance=draw(_between(0.02, 2.0)),
            inductance=draw(zero_or(1e-6, 1e-3)),
            rotor_inertia=draw(_between(1e-6, 1e-3)),
            cogging_amplitude=draw(zero_or(1e-4, 1e-2)),
            iron_loss=draw(zero_or(1e-6, 1e-4)),
            hysteresis=draw(zero_or(1e-4, 1e-2)),
        ),
        drive=dataclasses.replace(
            base.drive,
            supply_voltage=draw(_between(12.0, 96.0)),
            current_limit=draw(_between(5.0, 100.0)),
        ),
        friction=FrictionParameters(
            motor_coulomb=draw(zero_or(1e-4, 0.05)),
            output_coulomb=draw(zero_or(1e-3, 0.5)),
            motor_viscous=draw(zero_or(1e-6, 1e-3)),
            output_viscous=draw(zero_or(1e-4, 0.1)),
            stribeck_extra=draw(zero_or(0.05, 1.0)),
            stribeck_speed=draw(_between(0.5, 10.0)),
            load_forward=draw(zero_or(0.01, 0.3)),
            load_backward=draw(zero_or(0.01, 0.3)),
            load_knee=draw(zero_or(0.1, 20.0)),
            load_growth=draw(zero_or(0.05, 1.0)),
        ),
        gear=dataclasses.replace(
            base.gear,
            ratio=draw(st.sampled_from([-1.0, 1.0])) * draw(st.integers(4, 60)),
            input_inertia=draw(_between(1e-6, 1e-4)),
            output_inertia=draw(_between(1e-5, 1e-2)),
            error_orders=np.array(orders, dtype=np.int64),
            error_cosine=np.array(draw(waves)),
            error_sine=np.array(draw(waves)),
            stiffness_cosine=np.zeros(count),
            stiffness_sine=np.zeros(count),
            stiffness=draw(_between(1e3, 1e5)),
            backlash=draw(zero_or(1e-4, 5e-3)),
        ),
    )
