"""Compiled loads: cogging, pendulum, sensor, wall, and what is stored; :mod:`..twin.loads` too."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.gear import TINY_CLOSING
from cqdd_design.actuator.kernels.laws import part, wall_spring


class Load(NamedTuple):
    """What turns with motor and output; names as in `columns.PARAMETERS`, inertia with flange."""

    motor_inertia: float
    cogging_amplitude: float
    cogging_order: float
    inertia: float
    viscous: float
    sensor_stiffness: float
    sensor_damping: float
    gravity_moment: float
    wall_angle: float
    wall_stiffness: float
    wall_exponent: float
    wall_damping: float
    wall_side: float


@part
def load_of(p: Any) -> Any:
    """Load from a row of parameters."""
    return Load(
        p[4],
        p[5],
        p[6],
        p[32] + p[33],
        p[34],
        p[35],
        p[36],
        p[37],
        p[38],
        p[39],
        p[40],
        p[41],
        p[42],
    )


@part
def cogging(load: Any, angle: float, turn: float) -> Any:
    """Mean cogging torque over a turn of the motor; the sinc by its first terms."""
    torque = 0.0
    if load.cogging_amplitude > 0.0:
        half = 0.5 * load.cogging_order * turn
        half *= half
        torque = 1.0 - half / 6.0 * (1.0 - half / 20.0 * (1.0 - half / 42.0))
        middle = math.sin(load.cogging_order * (angle + 0.5 * turn))
        torque *= load.cogging_amplitude * middle
    return torque


@part
def gravity_pull(load: Any, out_angle: float, h: float, y: float) -> Any:
    """Mean torque with which a pendulum hangs back, at a mean speed y."""
    pull = 0.0
    if load.gravity_moment != 0.0:
        half = 0.25 * h * h * y * y
        pull = load.gravity_moment * math.sin(out_angle + 0.5 * h * y)
        pull *= 1.0 - half / 6.0 * (1.0 - half / 20.0)
    return pull


@part
def wall_at(load: Any, out_angle: float) -> Any:
    """Depth in the wall, its push and its energy."""
    depth = load.wall_side * (out_angle - load.wall_angle)
    push, energy = wall_spring(depth, load.wall_stiffness, load.wall_exponent)
    return depth, push, energy


@part
def wall_push(load: Any, depth: float, push: float, energy: float, h: float, y: float) -> Any:
    """Mean push of the wall's spring, the damper's share with it, and their slope over y."""
    push_mean, push_slope, rubbing = 0.0, 0.0, 0.0
    if load.wall_stiffness > 0.0:
        deeper = load.wall_side * h * y
        if depth > 0.0 or depth + deeper > 0.0:
            new_push, new_energy = wall_spring(
                depth + deeper, load.wall_stiffness, load.wall_exponent
            )
            if abs(deeper) > TINY_CLOSING:
                push_mean = (new_energy - energy) / deeper
                push_slope = h * (new_push - push_mean) / deeper
            else:
                push_mean = 0.5 * (push + new_push)
            rub = load.wall_damping * load.wall_side * y
            if rub < -1.0:
                rubbing, push_slope = -push_mean, 0.0
            else:
                rubbing = push_mean * rub
                push_slope = push_slope * (1.0 + rub) + push_mean * load.wall_damping
    return push_mean, push_slope, rubbing


@part
def stored_energy(
    load: Any,
    angle: float,
    speed: float,
    out_angle: float,
    out_speed: float,
    winding_energy: float,
    mesh_energy: float,
    wall_energy: float,
    bristle_energy: float,
) -> Any:
    """Energy in winding, masses, springs, gravity and bristles, J."""
    found = winding_energy + 0.5 * load.motor_inertia * speed * speed
    found += 0.5 * load.inertia * out_speed * out_speed + mesh_energy + wall_energy
    found -= load.gravity_moment * math.cos(out_angle)
    found += 0.5 * load.sensor_stiffness * out_angle * out_angle
    found += bristle_energy
    if load.cogging_amplitude > 0.0:
        turned = math.cos(load.cogging_order * angle)
        found -= load.cogging_amplitude / load.cogging_order * turned
    return found
