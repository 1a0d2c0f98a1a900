"""Loads in plain numpy: cogging, pendulum, wall, and what is stored; see :mod:`..kernels.loads`."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.columns import Constants
from cqdd_design.actuator.parameters import FloatArray


def cogging(p: Constants, angle: float, turn: float) -> float:
    """Mean cogging torque over a turn of the motor."""
    half = 0.5 * p.cogging_order * turn
    torque = p.cogging_amplitude * math.sin(p.cogging_order * angle + half)
    return torque * float(np.sinc(half / math.pi))


def gravity_pull(p: Constants, out: float, out_turn: float) -> float:
    """Mean torque with which a pendulum hangs back over a turn of the output."""
    pull = p.gravity_moment * math.sin(out + 0.5 * out_turn)
    return pull * float(np.sinc(0.5 * out_turn / math.pi))


def wall_at(p: Constants, out: float) -> dict[str, float]:
    """Depth in the wall, its push and its energy."""
    depth = p.wall_side * (out - p.wall_angle)
    push = p.wall_stiffness * max(depth, 0.0) ** p.wall_exponent
    energy = push * max(depth, 0.0) / (p.wall_exponent + 1.0)
    return {"depth": depth, "push": push, "wall_energy": energy}


def wall_push(
    p: Constants, state: dict[str, float], end: dict[str, float], h: float, y: float
) -> tuple[float, float, float]:
    """Mean push of the wall's spring, the damper's share with it, and their slope over y."""
    deeper = p.wall_side * h * y
    push, push_slope = 0.5 * (state["push"] + end["push"]), 0.0
    if abs(deeper) > 1e-9:
        push = (end["wall_energy"] - state["wall_energy"]) / deeper
        push_slope = h * (end["push"] - push) / deeper
    rub = p.wall_damping * p.wall_side * y
    wall_rub = push * max(rub, -1.0)
    slope_kept = rub >= -1.0
    push_slope = push_slope * (1.0 + rub) + push * p.wall_damping if slope_kept else 0.0
    return push, push_slope, wall_rub


def bristle_energy(p: Constants, bristles: FloatArray) -> float:
    """Energy in the bristles of LuGre friction, J."""
    stiff = np.array([p.motor_bristle, p.output_bristle])
    return float(0.5 * stiff @ bristles**2)


def stored_energy(
    p: Constants, state: dict[str, float], current: float, bristles: FloatArray
) -> float:
    """Energy in winding, masses, springs, gravity and bristles, J."""
    s = state
    found = 0.5 * p.inductance * current**2 + 0.5 * p.motor_inertia * s["speed"] ** 2
    found += 0.5 * p.carried_inertia * s["out_speed"] ** 2
    found += s["share"] * s["energy"] + s["wall_energy"]
    found += -p.gravity_moment * math.cos(s["out"])
    found += 0.5 * p.sensor_stiffness * s["out"] ** 2 + bristle_energy(p, bristles)
    if p.cogging_amplitude > 0.0:
        ripple = math.cos(p.cogging_order * s["angle"])
        found -= p.cogging_amplitude / p.cogging_order * ripple
    return found
