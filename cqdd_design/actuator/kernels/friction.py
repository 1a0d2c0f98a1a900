"""Compiled dry friction: levels, bristles, stick and slip."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.laws import part

STICK, FREE = 0, 2
"""A body held by friction, and one that passes standstill without; 1 and -1 are slip."""


@part
def stribeck_rise(extra: float, fast: float) -> float:
    """Level over Coulomb's at a speed relative to Stribeck's."""
    rise = 1.0
    if extra > 0.0 and abs(fast) < 6.0:
        rise += extra * math.exp(-fast * fast)
    return rise


@part
def levels(p: Any, toward: float, transmitted: float, guess: float, out_guess: float) -> Any:
    """Dry friction to be had at motor and output, N m.

    `toward` has the sign of the motor's motion, or at standstill of what pushes it; `transmitted`
    is the gear's torque of the step before.
    """
    n = abs(p.ratio)
    forward = toward * transmitted * p.ratio > 0.0
    load_share = p.load_forward if forward else p.load_backward
    load = abs(transmitted) + p.load_growth * max(abs(transmitted) - p.load_knee, 0.0)
    rise = stribeck_rise(p.stribeck_extra, guess / p.stribeck_speed)
    level = (p.motor_coulomb + load_share * load / n) * rise
    level += p.hysteresis + p.motor_dry
    rise = stribeck_rise(p.stribeck_extra, out_guess * n / p.stribeck_speed)
    return level, p.output_coulomb * rise


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


class Rubbing(NamedTuple):
    """Friction that a step begins with.

    Attributes
    ----------
    level, output_level : float
        Dry friction to be had at motor and output, N m; 0 where bristles stand for it.
    viscous, output_viscous : float
        Over the mean speeds, bristles, iron and the load's own included, N m s/rad.
    held, output_held : float
        What the bristles' state adds, N m.
    relax, output_relax : float
        How far the bristles relax in the step.
    """

    level: float
    output_level: float
    viscous: float
    output_viscous: float
    held: float
    output_held: float
    relax: float
    output_relax: float


@part
def rubbing(
    p: Any,
    bristles: Any,
    h: float,
    toward: float,
    transmitted: float,
    guess: float,
    out_guess: float,
) -> Any:
    """Friction of a step at guessed mean speeds; see :func:`levels` for the arguments."""
    level, output_level = levels(p, toward, transmitted, guess, out_guess)
    viscous, output_viscous = p.motor_viscous + p.iron_viscous, p.output_viscous + p.load_viscous
    held, output_held, relax, output_relax = 0.0, 0.0, 0.0, 0.0
    if p.lugre != 0.0:
        viscous, held, relax = bristled(
            p.motor_bristle, p.motor_bristle_damping, level, h, guess, bristles[0], viscous
        )
        output_viscous, output_held, output_relax = bristled(
            p.output_bristle, 0.0, output_level, h, out_guess, bristles[1], output_viscous
        )
        level = output_level = 0.0
    return Rubbing(
        level, output_level, viscous, output_viscous, held, output_held, relax, output_relax
    )


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
