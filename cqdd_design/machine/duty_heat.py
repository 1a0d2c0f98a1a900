"""What a duty loses, and where: gearbox, copper and the motor's own drag.

Losses are those of the machine that is given, at the temperatures of its parts. Half of what rubs
between two parts warms either of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.motors import (
    COPPER_COEFFICIENT,
    COPPER_REFERENCE,
    MAGNET_COEFFICIENT,
    Motor,
)
from cqdd_design.design.duty_log import DutyLog
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.network import Heat
from cqdd_design.gearbox.losses.machine import SOURCES
from cqdd_design.gearbox.losses.model import LossModel
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.machine.heat_nodes import Node, node_values
from cqdd_design.machine.machine import Machine

_SHARES: dict[str, dict[Node, float]] = {
    "ring_teeth": {"ring": 0.5, "disc": 0.5},
    "output_pins": {"disc": 0.5, "carrier": 0.5},
    "cam_bearings": {"disc": 0.5, "shaft": 0.5},
    "support_bearings": {"shaft": 0.5, "housing": 0.25, "carrier": 0.25},
    "output_bearing": {"housing": 0.5, "carrier": 0.5},
    "grease": {"disc": 0.5, "carrier": 0.5},
}
"""Which parts a loss warms."""
_PIECE = 50_000
_WINDOWS = 2048
"""Of a cycle, over which heat is taken to be even: far shorter than any winding warms in."""


class DutyCase(NamedTuple):
    """Output torque, N m, input speed, rad/s, both with their sign, and share of the time."""

    torque: float
    input_speed: float
    share: float


@dataclass(frozen=True, eq=False)
class DutyHeat:
    """What a duty loses, W.

    Attributes
    ----------
    heat : Heat
        By node.
    gearbox : float
        Mean of the gearbox's losses.
    current_squared : float
        Mean square of the motor's current, A^2.
    """

    heat: Heat
    gearbox: float
    current_squared: float


class _Points(NamedTuple):
    """Losses at M points, W: the gearbox's (M, 6), the motor's drag (M,); and i^2 (M,), A^2."""

    gearbox: FloatArray
    drag: FloatArray
    current_squared: FloatArray


def duty_cases(machine: Machine, *, duty: bool = True) -> tuple[DutyCase, ...]:
    """The duty of the requirements, or the continuous torque at its speed without one."""
    asked, n = machine.design.requirements, machine.design.reducer.ratio
    if duty and (steps := asked.load_cases):
        return tuple(DutyCase(one.torque, n * one.speed, one.share) for one in steps)
    return (DutyCase(asked.continuous_torque, asked.held_speed, 1.0),)


def duty_heat(
    machine: Machine, cases: Iterable[DutyCase], magnets: float = COPPER_REFERENCE
) -> DutyHeat:
    """Mean heat of a duty in every node.

    The motor is a DC machine, K that of its magnets at a temperature (deg C): copper heats its
    winding, and its own drag, of iron above all, the stator. Where the output drives, the gearbox
    loses what being driven takes, spread over its parts as while driving, and the motor brakes what
    losses leave, or pushes where they take more than the output gives.

    Raises
    ------
    DesignError
        When the catalogue has no torque constant or no resistance of the motor.
    ContactError
        When the gearbox has no equilibrium.
    """
    torque, speed, share = (np.array(column) for column in zip(*cases, strict=True))
    points = _points(machine, machine.losses_at(torque.tolist()), torque, speed, magnets)
    return _mean(machine, *(np.asarray(share @ column) for column in points))


def logged_heat(
    machine: Machine, log: DutyLog, magnets: float = COPPER_REFERENCE
) -> tuple[FloatArray, Heat, DutyHeat]:
    """Heat of a duty over time, row by row; magnets at a temperature, deg C.

    Returns
    -------
    steps : array (K,)
        Of the cycle, s.
    heats : Heat
        Its `fixed` and `slope` (K, N), of every step.
    mean : DutyHeat

    Raises
    ------
    DesignError, ContactError
        As `duty_heat`.
    """
    steps, *columns = _over_time(machine, log, magnets)
    whole = (np.asarray(steps @ column) / log.cycle_time for column in columns)
    return steps, _heat(machine, *columns), _mean(machine, *whole)


def _mean(machine: Machine, gearbox: FloatArray, drag: FloatArray, squared: FloatArray) -> DutyHeat:
    heat = _heat(machine, gearbox, drag, squared)
    return DutyHeat(heat, float(gearbox.sum()), float(squared))


def _heat(machine: Machine, gearbox: FloatArray, drag: FloatArray, squared: FloatArray) -> Heat:
    """Heat by node from losses of the gearbox (..., 6), drag (...), and i^2 (...)."""
    _, resistance = _winding(machine)
    winding, stator = (node_values({node: 1.0}) for node in ("winding", "stator"))
    spread = np.stack([node_values(_SHARES[source]) for source in SOURCES])
    slope = squared * resistance * COPPER_COEFFICIENT
    copper = squared * resistance * (1.0 - COPPER_COEFFICIENT * COPPER_REFERENCE)
    return Heat(
        gearbox @ spread + np.multiply.outer(copper, winding) + np.multiply.outer(drag, stator),
        np.multiply.outer(slope, winding),
        np.where(winding > 0.0, machine.motor.winding_most, np.inf),
    )


def _points(
    machine: Machine, losses: LossModel, torque: FloatArray, speed: FloatArray, magnets: float
) -> _Points:
    """What operating points lose: torques at the output, speeds of the input, with their signs."""
    constant, n = _winding(machine)[0], machine.design.reducer.ratio
    constant *= 1.0 - MAGNET_COEFFICIENT * (magnets - COPPER_REFERENCE)
    driving = losses.crank_torque(speed, torque, "drive")
    taken = driving.sum(axis=-1)
    backward = losses.crank_torque(speed, torque, "backdrive").sum(axis=-1)
    forward = torque * speed >= 0.0
    spent = np.where(forward, taken, backward)
    driven = np.divide(spent, taken, out=np.ones_like(taken), where=taken != 0.0)
    drag = motor_drag(machine.motor, speed)
    needed = np.abs(torque) / n + np.where(forward, 1.0, -1.0) * (spent + drag)
    turning = np.abs(speed)
    return _Points(driving * (driven * turning)[:, None], drag * turning, (needed / constant) ** 2)


def _over_time(
    machine: Machine, log: DutyLog, magnets: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Steps of the cycle, s, and the means of `_points` in each; rows are taken piece by piece."""
    n = machine.design.reducer.ratio
    between = np.diff(log.time)
    middle = (log.time[:-1] + 0.5 * between - log.time[0]) / log.cycle_time
    window = np.minimum((middle * _WINDOWS).astype(np.int64), _WINDOWS - 1)
    steps = np.bincount(window, between, _WINDOWS).astype(float)
    sums = np.zeros((_WINDOWS, len(SOURCES) + 2))
    for begin in range(0, len(between), _PIECE):
        rows = slice(begin, begin + _PIECE + 1)
        points = _points(machine, machine.losses, log.torque[rows], n * log.speed[rows], magnets)
        table = np.column_stack(points)
        here = slice(begin, begin + len(table) - 1)
        lost = 0.5 * (table[1:] + table[:-1]) * between[here, None]
        for k, column in enumerate(lost.T):
            sums[:, k] += np.bincount(window[here], column, _WINDOWS)
    there = steps > 0.0
    steps, means = steps[there], sums[there] / steps[there, None]
    return steps, means[:, :-2], means[:, -2], means[:, -1]


def _winding(machine: Machine) -> tuple[float, float]:
    row = machine.motor
    if not row.torque_constant or not row.line_resistance:
        raise DesignError(
            f"no temperatures: the torque constant or the resistance of '{row.name}' is not known, "
            "and so the heat of its winding is not; give torque_constant and resistance in [motor] "
            "or with --motor-file, or name a motor that has them, such as 'CubeMars RO100 KV55'."
        )
    return row.torque_constant, row.line_resistance


def motor_drag(row: Motor, speed: ArrayLike) -> FloatArray:
    """Torque that a motor's own drag takes at speeds (rad/s), N m; 0 where none is known."""
    turning = np.abs(np.asarray(speed, dtype=float))
    steady = (row.coulomb or 0.0) + (row.hysteresis or 0.0)
    grows = (row.viscous or 0.0) + (row.iron_loss or 0.0)
    return np.asarray(np.where(turning > 0.0, steady + grows * turning, 0.0))
