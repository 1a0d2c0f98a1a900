"""What a search makes small: mass, inertia, backlash, losses or size, in closed form."""

from __future__ import annotations

import math
from typing import NamedTuple, assert_never

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import FRICTION_COEFFICIENT
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing.frame import Frame, Goal
from cqdd_design.sizing.masses import Weights

_NEEDLES = FRICTION_COEFFICIENT["needle cage"] / BOUNDARY_FRICTION
"""Friction of a pin on needles over that of a bare one."""
PINS_PLAY, FEW_PINS_PLAY = 0.72, 3.4
"""Of the pins' clearance in the output's play: of many pins, and more where there are few."""
_TIE = 0.02
"""Power of the mass beside another goal: of two equal ones the lighter is the better."""


class Sizes(NamedTuple):
    """What goals need beside weights; all broadcast with them, SI.

    `hole_clearance` is on the diameter; `friction` is the number of
    :class:`~cqdd_design.sizing.stage_tables.StageTables`; of one disc are the `pin_count` holes.
    """

    eccentricity: FloatArray
    thickness: FloatArray
    pin_count: NDArray[np.intp]
    pin_circle: FloatArray
    hole_clearance: FloatArray
    outer_radius: FloatArray
    friction: FloatArray


def goal_value(frame: Frame, weights: Weights, sizes: Sizes) -> FloatArray:
    """What `frame.goal` makes small, lighter candidates first among equals; broadcasts."""
    if frame.goal == "mass":
        return weights.mass
    if frame.goal == "inertia":
        value = weights.gearbox_inertia
    elif frame.goal == "backlash":
        value = backlash_angle(frame, sizes)
    elif frame.goal == "efficiency":
        value = friction_share(frame, sizes)
    elif frame.goal == "size":
        value = swept_volume(frame, sizes)
    else:
        assert_never(frame.goal)
    return np.asarray(value * weights.mass**_TIE)


def untied(goal: Goal, score: float, mass: float) -> float:
    """What a goal alone makes small, of a design with a score and a mass (kg): see `goal_value`."""
    return score if goal == "mass" else score / float(mass**_TIE)


def tied(value: float, mass: float) -> float:
    """A value with its mass (kg) beside it: of two equal ones the lighter is the smaller."""
    return value * float(mass**_TIE)


def backlash_angle(frame: Frame, sizes: Sizes) -> FloatArray:
    """About the play of the output that 95 % of toleranced gearboxes stay below, rad.

    Teeth have their gap at both flanks and their longest arm n e, pins their clearance at R_w, of
    which little contributes where many share it: 2 q/(n e) + (0.72 + 3.4/(N_w D)) c/R_w, by least
    squares over 70 gearboxes of ratios 6 to 20, 1 to 3 discs, 4 to 12 pins and 5 fits at the usual
    tolerances, 64 of each: within 8 % r.m.s., at worst 31 % above and 10 % below
    (benchmarks/backlash_closed_form.py).
    """
    arm = frame.lobe_count * sizes.eccentricity
    pins = PINS_PLAY + FEW_PINS_PLAY / (sizes.pin_count * frame.disc_count)
    return np.asarray(
        2.0 * frame.equidistant / arm + pins * sizes.hole_clearance / sizes.pin_circle
    )


def friction_share(frame: Frame, sizes: Sizes) -> FloatArray:
    """Losses of teeth and pins over the work at the output, for a coefficient of friction of 1.

    Pins push (4/pi) T/R_w in all (many of them) and slide with e (1 + 1/n) of the crank's speed.
    """
    n = frame.lobe_count
    pins = 4.0 / math.pi * (n + 1) * sizes.eccentricity / sizes.pin_circle
    # Needles' friction is small against that of anything that slides.
    return np.asarray(sizes.friction + (_NEEDLES if frame.needles else 1.0) * pins)


def swept_volume(frame: Frame, sizes: Sizes) -> FloatArray:
    """Of the cylinder round the ring, as long as the pack, m^3."""
    count = frame.disc_count
    pack = count * sizes.thickness + (count - 1) * frame.spacing
    return np.asarray(math.pi * sizes.outer_radius**2 * pack)
