"""Friction of what meshes, sliding or rolling: bare pins and teeth, sleeves, rollers, on needles.

    bare            plain sleeve or roller         on needles
    t = mu F        t r = mu F r_pin               t r = mu_n F d/2

A sleeve turns where the moments of both of its faces balance: it rolls on the disc, and what its
bearing resists with is felt at its rim. Needles resist with the friction of every needle bearing,
M = mu_n F d/2 on the bore (JTEKT), and never count with more than the pin itself would.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import FRICTION_COEFFICIENT
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION
from cqdd_design.gearbox.output_pins import sleeve_share
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner


def at_rest(coefficient: float | Literal["film"]) -> float:
    """The coefficient that a design states, or that of a boundary layer where the film gives it."""
    return BOUNDARY_FRICTION if coefficient == "film" else coefficient


def most_breakaway(design: Design) -> tuple[float, float]:
    """Most by which breakaway exceeds running friction, at teeth and at pins.

    At rest nothing parts surfaces that rub, and metals have a boundary layer left: they break away
    with its coefficient at most, or with their own where that is higher. Needles roll and break
    away as bearings do, and the boundary layer of plastics is not known: no bound here.
    """
    reducer = design.reducer
    discs = reducer.disc_material
    teeth, pins = (reducer.ring_material, discs), (reducer.output_pins.material, discs)
    return (
        _most_breakaway(reducer.friction.tooth, ring_runner(design), teeth),
        _most_breakaway(reducer.friction.pin, pin_runner(design), pins),
    )


def _most_breakaway(
    stated: float | Literal["film"], runner: Runner | None, pair: tuple[str, str]
) -> float:
    if runner is not None and runner.cage is not None:
        return math.inf
    own = at_rest(stated)
    # What turns on a pin rubs on it, and is of its material.
    rubbing = pair if runner is None else pair[:1]
    bounded = stated == "film" or not any(find_material(name).is_plastic for name in rubbing)
    if own == 0.0 or not bounded:
        return math.inf
    return max(BOUNDARY_FRICTION / own, 1.0)


def hole_friction(design: Design) -> float:
    """Coefficient of friction at the wall of the output holes, without a film."""
    pins = design.reducer.output_pins
    own = at_rest(design.reducer.friction.pin)
    return _felt(own, pin_runner(design), mean_pin_diameter(pins))


def tooth_friction(design: Design) -> float:
    """Coefficient at the flanks of the discs, without a film: of teeth, bare pins, or rollers.

    A bare pin of a pinwheel ring that is free to turn in its pocket gains nothing: it rolls on the
    disc, and slides in the pocket at the same surface speed under the same force.
    """
    reducer = design.reducer
    return _felt(at_rest(reducer.friction.tooth), ring_runner(design), reducer.ring_pin_diameter)


def _felt(own: float, runner: Runner | None, pin_diameter: float) -> float:
    if runner is None:
        return own
    if runner.cage is None:
        return own * sleeve_share(pin_diameter, runner.diameter)
    rolling = min(own, FRICTION_COEFFICIENT[runner.cage.kind])
    return rolling * sleeve_share(runner.cage.bore_diameter, runner.diameter)


def sleeve_turn(lobe_count: int, eccentricity: ArrayLike, sleeve_diameter: ArrayLike) -> FloatArray:
    """Turn of a sleeve on its pin per radian of crank, 2 e (1 + 1/n)/d_s.

    It rolls in its hole, which passes at e (1 + 1/n). It is let go for half of every turn of the
    crank, and is taken to keep turning, which is on the safe side of its life.

    Examples
    --------
    >>> print(round(float(sleeve_turn(10, 1.6e-3, 8e-3)), 3))
    0.44
    """
    path = np.asarray(eccentricity, dtype=float) * (1.0 + 1.0 / lobe_count)
    return np.asarray(2.0 * path / np.asarray(sleeve_diameter, dtype=float))


def greatest_roller_turn(
    lobe_count: int, ring_pitch_radius: float, eccentricity: float, roller_diameter: float
) -> float:
    """Most turn of a roller on its ring pin per radian of crank.

    The disc turns by 1/n about its pitch point, (n + 1) e off the centre; the flank that touches
    the farthest tooth passes it by at (R + (n + 1) e - r)/n.

    Examples
    --------
    >>> print(round(greatest_roller_turn(10, 32e-3, 1.6e-3, 7e-3), 3))
    1.317
    """
    reach = ring_pitch_radius + (lobe_count + 1) * eccentricity - 0.5 * roller_diameter
    return 2.0 * reach / (lobe_count * roller_diameter)
