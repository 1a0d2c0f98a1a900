"""Small data sets of a joint in closed form, and an actuator in numbers, for tests of training."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    FrictionParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)
from cqdd_design.torque.data.episodes import DataSet, Episode

DT = 0.005
POSITION_GAIN, VELOCITY_GAIN = 60.0, 2.0
INERTIA, COULOMB, VISCOUS = 0.05, 1.2, 0.3


def episode(name: str, frequency: float, amplitude: float, samples: int = 160) -> Episode:
    """A sinusoid followed with a lag, its torque by law less inertia and friction, exact."""
    time = DT * np.arange(samples)
    pulse = 2.0 * math.pi * frequency
    target = amplitude * np.sin(pulse * time)
    position = 0.95 * amplitude * np.sin(pulse * time - 0.1)
    velocity = 0.95 * amplitude * pulse * np.cos(pulse * time - 0.1)
    rate = -0.95 * amplitude * pulse**2 * np.sin(pulse * time - 0.1)
    torque = POSITION_GAIN * (target - position) - VELOCITY_GAIN * velocity
    torque = torque - INERTIA * rate - COULOMB * np.tanh(velocity / 0.1) - VISCOUS * velocity
    torque = torque + 0.3 * np.cos(10.0 * position)
    return Episode(
        name,
        {"frequency": frequency, "amplitude": amplitude},
        DT,
        {
            "position": position,
            "target": target,
            "velocity": velocity,
            "torque": torque,
            "current": torque / 1.8,
        },
    )


def data_set(count: int = 8, samples: int = 160) -> DataSet:
    """Episodes of different frequencies and amplitudes."""
    episodes = tuple(
        episode(f"e{k}", 0.5 + 0.13 * k, 0.5 + 0.1 * (k % 5), samples) for k in range(count)
    )
    return DataSet(episodes, POSITION_GAIN, VELOCITY_GAIN, (-90.0, 90.0), {"source": "closed form"})


def actuator() -> ActuatorParameters:
    """Numbers of a small actuator; its gearbox ripples most in orders 10 and 11."""
    return ActuatorParameters(
        name="sample",
        motor=MotorParameters(0.18, 0.2, 2e-4, 3e-4, 21, 3.0, math.nan, iron_loss=1e-5),
        drive=DriveParameters(48.0, 50.0, 1000.0, 0.0, 1000.0, 14, POSITION_GAIN, VELOCITY_GAIN),
        thermal=ThermalParameters(0.4, 0.8, 100.0, 500.0),
        friction=FrictionParameters(0.03, 0.4, 1e-4, 0.05, 0.2, 2.0, 0.1, 0.12),
        gear=GearParameters(
            ratio=-10.0,
            input_inertia=2e-4,
            output_inertia=2e-3,
            error_orders=np.array([1, 10, 11, 20]),
            error_cosine=np.array([2e-4, 1e-4, 0.0, 1e-6]),
            error_sine=np.array([0.0, 0.0, 2e-4, 0.0]),
            error_torque=40.0,
            stiffness=2e4,
            stiffness_cosine=np.array([0.0, 0.01, 0.01, 0.0]),
            stiffness_sine=np.zeros(4),
            stiffening=1.2,
            damping=1.0,
            backlash=1e-3,
        ),
        mass=2.0,
    )
