"""Actuators by hand for tests of the simulation: one with everything on, one with nothing rough."""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    FrictionParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)

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
