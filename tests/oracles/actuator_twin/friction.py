"""Dry friction in plain numpy: levels, bristles, stick and slip."""

from __future__ import annotations

import math

from cqdd_design.actuator.columns import Constants

STICK, FREE = 0, 2
"""A body held by friction, and one that passes standstill without; 1 and -1 are slip."""


def levels(
    p: Constants, toward: float, transmitted: float, guess: float, out_guess: float
) -> list[float]:
    """Dry friction to be had at motor and output, N m; see the kernel for the arguments."""
    n = abs(p.ratio)
    forward = toward * transmitted * p.ratio > 0.0
    load = p.load_forward if forward else p.load_backward
    above = p.load_growth * max(abs(transmitted) - p.load_knee, 0.0)
    rises = []
    for fast in (guess / p.stribeck_speed, out_guess * n / p.stribeck_speed):
        rises.append(1.0 + (p.stribeck_extra * math.exp(-(fast**2)) if abs(fast) < 6 else 0.0))
    level = (p.motor_coulomb + load * (abs(transmitted) + above) / n) * rises[0]
    level += p.hysteresis + p.motor_dry
    return [level, p.output_coulomb * rises[1]]


def bristled(
    stiffness: float, damping: float, level: float, h: float, guess: float, z: float
) -> tuple[float, float, float]:
    """LuGre friction of a step, ``viscous x + constant``, and how far its bristles relax."""
    if not stiffness:
        return 0.0, 0.0, 0.0
    fast, level = abs(guess), max(level, 1e-12)
    relax = h * stiffness * fast / level
    damper = min(damping, 4.0 * level / fast) if fast else damping
    viscous = (stiffness * h + damper) / (1.0 + relax)
    return viscous, (stiffness - damper * relax / h) * z / (1.0 + relax), relax


def begun(mode: int, speed: float) -> int:
    """Stick or slip with which a body begins a step: it slips the way it moves."""
    if mode == FREE or (mode == STICK and speed != 0.0):
        return 1 if speed > 0.0 else -1
    return mode


def agreed(mode: int, friction: float, level: float, former: float, mean: float) -> int:
    """Stick or slip that agrees with the motion it allowed."""
    if mode == STICK:
        if abs(friction) > level:
            return 1 if friction > 0.0 else -1
        return FREE if friction * former < 0.0 else STICK
    if mode == FREE:
        return FREE
    if mode * former < 0.0:
        return FREE if mode * mean < 0.0 else mode
    return STICK if mode * (2.0 * mean - former) < 0.0 else mode
