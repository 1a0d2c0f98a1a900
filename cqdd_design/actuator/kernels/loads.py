"""Compiled loads: cogging, pendulum, sensor, wall, and what is stored."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.gear import TINY_CLOSING
from cqdd_design.actuator.kernels.laws import part, wall_spring

FEW_TERMS = 0.03
"""Square of half a step's phase, up to which the terms of the sinc leave out less than 1e-11."""


class Motion(NamedTuple):
    """Motor and output at an instant: angles and speeds."""

    angle: float
    speed: float
    out_angle: float
    out_speed: float


class Wall(NamedTuple):
    """The wall at an instant: depth of the output in it, push and energy of its spring."""

    depth: float
    push: float
    energy: float


@part
def cogging(p: Any, angle: float, turn: float) -> Any:
    """Mean cogging torque over a turn of the motor, and its slope over the turn.

    The sinc by its first terms where they do. Fine cogging passes a period in a few steps, and its
    mean must still be energy over angle.
    """
    torque, slope = 0.0, 0.0
    if p.cogging_amplitude > 0.0:
        half = 0.5 * p.cogging_order * turn
        square = half * half
        middle = p.cogging_order * (angle + 0.5 * turn)
        if square > FEW_TERMS:
            torque = p.cogging_amplitude * math.sin(half) / half * math.sin(middle)
            slope = (p.cogging_amplitude * math.sin(middle + half) - torque) / turn
        else:
            share = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
            torque = p.cogging_amplitude * share * math.sin(middle)
            slope = 0.5 * p.cogging_amplitude * p.cogging_order * math.cos(middle)
    return torque, slope


@part
def gravity_pull(p: Any, out_angle: float, h: float, y: float) -> Any:
    """Mean torque with which a pendulum hangs back, at a mean speed y."""
    pull = 0.0
    if p.gravity_moment != 0.0:
        half = 0.25 * h * h * y * y
        pull = p.gravity_moment * math.sin(out_angle + 0.5 * h * y)
        pull *= 1.0 - half / 6.0 * (1.0 - half / 20.0)
    return pull


@part
def wall_at(p: Any, out_angle: float) -> Any:
    """The wall at an angle of the output."""
    depth = p.wall_side * (out_angle - p.wall_angle)
    push, energy = wall_spring(depth, p.wall_stiffness, p.wall_exponent)
    return Wall(depth, push, energy)


@part
def wall_push(p: Any, wall: Any, h: float, y: float) -> Any:
    """Mean push of the wall's spring, the damper's share with it, and their slope over y.

    The push is F (1 + c d') with F the energy gained over the depth gained, and never pulls.
    """
    push_mean, push_slope, rubbing = 0.0, 0.0, 0.0
    if p.wall_stiffness > 0.0:
        deeper = p.wall_side * h * y
        if wall.depth > 0.0 or wall.depth + deeper > 0.0:
            new_push, new_energy = wall_spring(
                wall.depth + deeper, p.wall_stiffness, p.wall_exponent
            )
            if abs(deeper) > TINY_CLOSING:
                push_mean = (new_energy - wall.energy) / deeper
                push_slope = h * (new_push - push_mean) / deeper
            else:
                push_mean = 0.5 * (wall.push + new_push)
            rub = p.wall_damping * p.wall_side * y
            if rub < -1.0:
                rubbing, push_slope = -push_mean, 0.0
            else:
                rubbing = push_mean * rub
                push_slope = push_slope * (1.0 + rub) + push_mean * p.wall_damping
    return push_mean, push_slope, rubbing


@part
def stored_energy(
    p: Any, motion: Any, current: float, mesh: Any, wall_energy: float, bristle_energy: float
) -> Any:
    """Energy in winding, masses, springs, gravity, bristles and cogging, J."""
    winding_energy = 0.5 * p.inductance * current * current
    mesh_energy = mesh.share * mesh.energy
    found = winding_energy + 0.5 * p.motor_inertia * motion.speed * motion.speed
    speed = motion.out_speed
    found += 0.5 * p.carried_inertia * speed * speed + mesh_energy + wall_energy
    found -= p.gravity_moment * math.cos(motion.out_angle)
    found += 0.5 * p.sensor_stiffness * motion.out_angle * motion.out_angle
    found += bristle_energy
    if p.cogging_amplitude > 0.0:
        turned = math.cos(p.cogging_order * motion.angle)
        found -= p.cogging_amplitude / p.cogging_order * turned
    return found
