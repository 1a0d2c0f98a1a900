"""Compiled dry friction: levels, bristles, stick and slip; :mod:`..twin.friction` in numpy."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.laws import part

STICK, FREE = 0, 2
"""A body held by friction, and one that passes standstill without; 1 and -1 are slip."""


class Friction(NamedTuple):
    """Friction of both sides; names as in `columns.PARAMETERS`."""

    motor_coulomb: float
    output_coulomb: float
    hysteresis: float
    extra: float
    stribeck_speed: float
    load_forward: float
    load_backward: float
    motor_bristle: float
    motor_bristle_damping: float
    output_bristle: float


@part
def friction_of(p: Any) -> Any:
    """Friction from a row of parameters."""
    return Friction(p[21], p[22], p[8], p[25], p[26], p[27], p[28], p[29], p[30], p[31])


@part
def stribeck_rise(extra: float, fast: float) -> float:
    """Level over Coulomb's at a speed relative to Stribeck's."""
    rise = 1.0
    if extra > 0.0 and abs(fast) < 6.0:
        rise += extra * math.exp(-fast * fast)
    return rise


@part
def levels(
    friction: Any,
    ratio: float,
    toward: float,
    transmitted: float,
    guess: float,
    out_guess: float,
) -> Any:
    """Dry friction to be had at motor and output, N m.

    `toward` has the sign of the motor's motion, or at standstill of what pushes it; `transmitted`
    is the gear's torque of the step before.
    """
    n = abs(ratio)
    forward = toward * transmitted * ratio > 0.0
    load_share = friction.load_forward if forward else friction.load_backward
    rise = stribeck_rise(friction.extra, guess / friction.stribeck_speed)
    level = (friction.motor_coulomb + load_share * abs(transmitted) / n) * rise
    level += friction.hysteresis
    rise = stribeck_rise(friction.extra, out_guess * n / friction.stribeck_speed)
    return level, friction.output_coulomb * rise


@part
def bristled(
    stiffness: float,
    damping: float,
    level: float,
    h: float,
    guess: float,
    z: float,
    viscous: float,
) -> Any:
    """LuGre friction with viscous, ``viscous x + constant``, and how far its bristles relax.

    The damper is cut to what can never give energy, ``4 level / speed``.
    """
    if stiffness <= 0.0:
        return viscous, 0.0, 0.0
    level = max(level, 1e-12)
    relax = h * stiffness * abs(guess) / level
    damper = damping
    if abs(guess) * damper > 4.0 * level:
        damper = 4.0 * level / abs(guess)
    viscous += (stiffness * h + damper) / (1.0 + relax)
    return viscous, (stiffness - damper * relax / h) * z / (1.0 + relax), relax


@part
def begun(mode: int, speed: float) -> int:
    """Stick or slip with which a body begins a step: it slips the way it moves."""
    if mode == FREE or (mode == STICK and speed != 0.0):
        mode = 1 if speed > 0.0 else -1
    return mode


@part
def agreed(mode: int, friction: float, level: float, former: float, mean: float) -> int:
    """Stick or slip that agrees with the motion it allowed.

    A body held against more than there is friction slips, and one that friction would push on
    passes free; one that slips sticks where it would turn back within the step.
    """
    if mode == STICK:
        if abs(friction) > level:
            return 1 if friction > 0.0 else -1
        if friction * former < 0.0:
            return FREE
    elif mode != FREE:
        if mode * former < 0.0:
            if mode * mean < 0.0:
                return FREE
        elif mode * (2.0 * mean - former) < 0.0:
            return STICK
    return mode
