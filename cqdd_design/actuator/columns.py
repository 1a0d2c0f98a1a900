"""Values that the compiled kernel and its plain twin take and give, by name."""

from __future__ import annotations

from collections import namedtuple
from typing import Any, NamedTuple

_values: Any = namedtuple


class Constants(NamedTuple):
    """What stays the same over a run of one actuator; angles rad, temperatures deg C, else SI.

    What is computed for the step stands here too: how much of the current's miss is left after a
    step, and the matrices of the thermal network over it.
    """

    ratio: float
    torque_constant: float
    resistance: float
    inductance: float
    motor_inertia: float
    cogging_amplitude: float
    cogging_order: float
    iron_viscous: float
    hysteresis: float
    reference_temperature: float
    # Drive and control.
    supply_voltage: float
    current_limit: float
    current_decay: float
    control_step: float
    encoder_count: float
    position_gain: float
    velocity_gain: float
    integral_gain: float
    held_current: float
    derating_begins: float
    derating_span: float
    # Friction: of the gearbox, of the motor alone, and what drags on both together over speed.
    motor_coulomb: float
    motor_dry: float
    output_coulomb: float
    motor_viscous: float
    output_viscous: float
    stribeck_extra: float
    stribeck_speed: float
    load_forward: float
    load_backward: float
    load_knee: float
    load_growth: float
    motor_bristle: float
    motor_bristle_damping: float
    output_bristle: float
    # Load; the carried inertia is that of the output and of the load together.
    output_inertia: float
    carried_inertia: float
    load_viscous: float
    sensor_stiffness: float
    sensor_damping: float
    gravity_moment: float
    wall_angle: float
    wall_stiffness: float
    wall_exponent: float
    wall_damping: float
    wall_side: float
    # Gearbox; from a motor angle to output turns.
    error_torque: float
    stiffness: float
    stiffening: float
    gear_damping: float
    half_backlash: float
    per_turn: float
    # Heat: what is kept of both temperatures, and what a watt adds.
    winding_kept: float
    winding_from_housing: float
    housing_from_winding: float
    housing_kept: float
    winding_heated: float
    winding_by_housing_heat: float
    housing_by_winding_heat: float
    housing_heated: float
    cooling: float
    # What is done: places in `MODES` and `FRICTIONS`, whether the output is driven.
    delay_steps: float
    mode: float
    lugre: float
    driven: float
    # The state at the beginning.
    motor_angle: float
    motor_speed: float
    output_angle: float
    output_speed: float
    current: float
    winding_temperature: float
    housing_temperature: float


class Signals(NamedTuple):
    """What changes over a run: arrays (S, N) with one row and one column where all are the same.

    All but the driven speed count at the middle of each step, that at the ends (N + 1).
    """

    reference: Any
    reference_rate: Any
    feedforward: Any
    external: Any
    driven_speed: Any


class Steps(NamedTuple):
    """Length of a step, s; number of steps; steps a record."""

    length: float
    number: int
    every: int


TRACES: dict[str, str] = {
    "motor_angle": "rad",
    "motor_speed": "rad/s",
    "output_angle": "rad",
    "output_speed": "rad/s",
    "current": "A",
    "voltage": "V",
    "deflection": "rad",
    "gear_torque": "N m",
    "output_torque": "N m",
    "motor_friction": "N m",
    "output_friction": "N m",
    "commanded_torque": "N m",
    "winding_temperature": "degC",
    "housing_temperature": "degC",
}
"""What is recorded, with its unit. States are those at the end of a step, torques and voltage its
means; current and voltage are those of the DC machine, 0 V with open phases. `deflection` is
theta/ratio + eps(theta) - q, `gear_torque` acts on the output, `output_torque` is what the flange
gives the load, as a sensor reads it. Iron losses are left out of the viscous part of the frictions;
the command stands in its own unit: V, A or N m."""

Traces: Any = _values("Traces", list(TRACES))
"""An array (S, N) of each."""

LEDGER: tuple[str, ...] = (
    "electrical",
    "copper",
    "iron",
    "motor_friction",
    "output_friction",
    "gear_damping",
    "load_damping",
    "external",
    "throughput",
    "stored_before",
    "stored_after",
    "unsettled",
)
"""Energies in J of one run: put in by the drive, lost in six ways, put in from outside at the
output; the integral of the absolute powers of drive and outside; stored in inductance, masses,
springs and gravity. Last the number of steps whose equations did not settle."""

Ledger: Any = _values("Ledger", LEDGER)
"""An array (S,) of each, or the sums of one run."""

MODES: tuple[str, ...] = ("open", "voltage", "current", "torque", "impedance", "position")
"""Kinds of command."""

FRICTIONS: tuple[str, ...] = ("clip", "lugre")
"""Models of dry friction."""

SUMMARY = (
    ("output_torque_Nm_peak", "output torque, peak", "N*m"),
    ("output_torque_Nm_rms", "output torque, r.m.s.", "N*m"),
    ("output_speed_rad_per_s_peak", "output speed, peak", "rad/s"),
    ("output_speed_rad_per_s_rms", "output speed, r.m.s.", "rad/s"),
    ("current_A_peak", "current, peak", "A"),
    ("current_A_rms", "current, r.m.s.", "A"),
    ("winding_temperature_degC_peak", "winding, hottest", "degC"),
    ("electrical_J", "energy from the drive", "J"),
    ("external_J", "energy from outside", "J"),
    ("dissipated_J", "energy dissipated", "J"),
    ("stored_J", "energy stored", "J"),
    ("residual_J", "residual of the balance", "J"),
)
"""Keys of a run's summary, in words, with their units."""
