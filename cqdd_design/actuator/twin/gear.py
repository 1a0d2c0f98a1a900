"""Gear mesh in plain numpy: dead zone, stiffness and kinematic error; see :mod:`..kernels.gear`."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.columns import Constants
from cqdd_design.actuator.parameters import FloatArray


def look_up(p: Constants, table: FloatArray, angle: float) -> dict[str, float]:
    """Kinematic error and stiffness share at a motor angle, with slopes per rad."""
    n = abs(p.ratio)
    count = len(table)
    place = (angle / (2.0 * math.pi * n)) % 1.0 * count
    low = int(place) % count
    x = place - int(place)
    basis = np.array([(1 + 2 * x) * (1 - x) ** 2, x * (1 - x) ** 2, x * x * (3 - 2 * x)])
    basis = np.append(basis, x * x * (x - 1))
    slope = np.array([6 * x * (x - 1), (x - 1) * (3 * x - 1), 6 * x * (1 - x), x * (3 * x - 2)])
    near = np.concatenate([table[low], table[(low + 1) % count]])
    per = count / (2.0 * math.pi * n)
    error, share = near[[0, 1, 4, 5]], near[[2, 3, 6, 7]]
    return {
        "error": float(basis @ error),
        "error_slope": float(slope @ error) * per,
        "share": float(basis @ share),
        "share_slope": float(slope @ share) * per,
    }


def spring(p: Constants, closing: float) -> dict[str, float]:
    """Deflection beyond the dead zone, torque, energy and tangent stiffness."""
    gap, power = p.half_backlash, p.stiffening
    beyond = math.copysign(max(abs(closing) - gap, 0.0), closing)
    k, reference = p.stiffness, p.error_torque
    torque = math.copysign(reference * (k * abs(beyond) / reference) ** power, beyond)
    secant = torque / beyond if beyond else (k if power == 1.0 and abs(closing) > gap else 0.0)
    return {
        "deflection": beyond,
        "elastic": torque,
        "energy": torque * beyond / (power + 1.0),
        "tangent": power * secant,
    }


def meshed(
    p: Constants,
    state: dict[str, float],
    table: FloatArray,
    turn: float,
    out_turn: float,
    h: float,
) -> tuple[dict[str, float], dict[str, float], bool]:
    """Torques of the mesh over a step, the mesh at its end, and whether a pull was cut.

    The torques: `gear` on the output, its `slope` over the closing, its lever `arm` on the motor,
    and `varying`, by which varying stiffness turns the motor. What is cut is the flank that gives
    way; one that the step meets beyond the gap pushes all the same.
    """
    end = look_up(p, table, state["angle"] + turn)
    change = turn / p.ratio + (end["error"] - state["error"]) - out_turn
    end |= spring(p, state["closing"] + change)
    arm = 1.0 / p.ratio + state["error_slope"]
    bend = state["share_slope"]
    if abs(turn) > 1e-10:
        arm = 1.0 / p.ratio + (end["error"] - state["error"]) / turn
        bend = (end["share"] - state["share"]) / turn
    share = 0.5 * (state["share"] + end["share"])
    gear, slope = _torque(p, share, state, end, change, h)
    cut = False
    if p.half_backlash > 0.0:
        nothing = {"energy": 0.0, "elastic": 0.0, "deflection": 0.0, "tangent": 0.0}
        passed = state["deflection"] * end["deflection"] < 0.0
        left = _torque(p, share, state, nothing if passed else end, change, h)[0]
        pressed = state["elastic"] or end["elastic"]
        cut = left * pressed <= 0.0
        if cut:
            gear, slope = _torque(p, share, nothing, end, change, h) if passed else (0.0, 0.0)
    varying = 0.5 * (state["energy"] + end["energy"]) * bend
    torques = {"gear": gear, "slope": slope, "arm": arm, "varying": varying}
    return torques, end, cut


def _torque(
    p: Constants,
    share: float,
    begin: dict[str, float],
    end: dict[str, float],
    change: float,
    h: float,
) -> tuple[float, float]:
    """Mean torque of spring and damper between two states of the mesh, and its slope."""
    if abs(change) > 1e-9:
        mean = (end["energy"] - begin["energy"]) / change
        slope = (end["elastic"] - mean) / change
    else:
        mean, slope = 0.5 * (begin["elastic"] + end["elastic"]), 0.5 * end["tangent"]
    torque = share * mean + p.gear_damping * (end["deflection"] - begin["deflection"]) / h
    return torque, share * slope + (p.gear_damping / h if end["deflection"] else 0.0)


def damped_in_mesh(
    p: Constants,
    state: dict[str, float],
    end: dict[str, float],
    change: float,
    cut: bool,
    h: float,
) -> float:
    """Energy that the mesh lost in a step, J: its damper's, and all that a cut flank held."""
    share = 0.5 * (state["share"] + end["share"])
    if not cut:
        return p.gear_damping * (end["deflection"] - state["deflection"]) * change / h
    if state["deflection"] * end["deflection"] < 0.0:
        return share * state["energy"] + p.gear_damping * end["deflection"] * change / h
    return -share * (end["energy"] - state["energy"])
