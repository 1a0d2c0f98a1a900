"""Compiled sweep over crank angles: each state from the ones before, or from above.

The equilibrium of one state is :mod:`.equilibrium_kernel`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, solve_state

_FIRM_APPROACH = 5e-6
"""Approach, m, of a load that presses the discs firmly against what stops them."""


@numba.njit(cache=True, error_model="numpy")
def predict(state: Any, before: Any, turn: float, known: int, out: Any) -> None:
    """Start for the next angle: the last state turned with the crank, plus its last change.

    Disc centres are carried round with the crank, in whose frame they hardly move; `known` is the
    number of states behind (0, 1 or more).
    """
    cosine, sine = math.cos(turn), math.sin(turn)
    for i in range(3):
        out[i] = state[i] + (state[i] - before[i] if known > 1 else 0.0)
    for d in range((state.size - 3) // 3):
        i = 3 + 3 * d
        x, y, t = state[i], state[i + 1], state[i + 2]
        if known > 1:
            bx = cosine * before[i] - sine * before[i + 1]
            by = sine * before[i] + cosine * before[i + 1]
            x, y, t = 2.0 * x - bx, 2.0 * y - by, 2.0 * t - before[i + 2]
        out[i] = cosine * x - sine * y
        out[i + 1] = sine * x + cosine * y
        out[i + 2] = t


@numba.njit(cache=True, error_model="numpy")
def solve_from_above(
    rows: Any,
    gaps: Any,
    coefficient: Any,
    teeth: int,
    codes: Any,
    logarithms: Any,
    series: Any,
    cam: Any,
    offset: Any,
    half_play: Any,
    carrier_stiffness: float,
    pull: float,
    scale_stiffness: float,
    state: Any,
    force: Any,
    cam_force: Any,
    work: Any,
) -> tuple[int, int, float]:
    """Solve one state from nothing by lowering the load to `pull`, tenfold at a time.

    Slow and safe: under a small load the discs slide round their cams' play, a narrow curved
    valley that Newton's method follows only in small steps; under a firm one they do not.
    Arguments and returns are those of :func:`.equilibrium_kernel.solve_state`.
    """
    firm = abs(pull)
    while 0.0 < firm < _FIRM_APPROACH * scale_stiffness:
        firm *= 10.0
    state[:] = 0.0
    steps = 0
    while True:
        load = max(firm, abs(pull))
        status, used, torsional = solve_state(
            rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset, half_play,
            carrier_stiffness, math.copysign(load, pull), scale_stiffness, state, force,
            cam_force, work,
        )  # fmt: skip
        steps += used
        if load <= abs(pull):
            return status, steps, torsional
        firm /= 10.0
        if firm < 2.0 * abs(pull):
            firm = abs(pull)


@numba.njit(cache=True, error_model="numpy")
def solve_sweep(
    rows: Any,
    gaps: Any,
    coefficient: Any,
    teeth: int,
    codes: Any,
    logarithms: Any,
    series: Any,
    cam: Any,
    offset: Any,
    half_play: Any,
    carrier_stiffness: float,
    pull: float,
    scale_stiffness: float,
    turns: Any,
    states: Any,
    force: Any,
    cam_force: Any,
    torsional: Any,
    steps: Any,
) -> int:
    """Equilibria at consecutive crank angles, each from the ones before.

    Arrays are those of :func:`.equilibrium_kernel.solve_state` with a leading axis A (`states`
    (A, 3 + 3 D) and the rest are results); `turns` (A,) is the crank angle since the state before,
    rad.

    Returns
    -------
    int
        -1, or the index of the first state that did not converge.
    """
    count, discs, contacts = gaps.shape
    size = 3 + 3 * discs
    work = np.empty(6 * size + 2 * discs * contacts + 12 * discs + 6)
    for a in range(count):
        if a == 0:
            for i in range(size):
                states[0, i] = 0.0
        else:
            predict(states[a - 1], states[max(a - 2, 0)], turns[a], a, states[a])
        status, used, left = solve_state(
            rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam, offset[a],
            half_play, carrier_stiffness, pull, scale_stiffness, states[a], force[a],
            cam_force[a], work,
        )  # fmt: skip
        if status != CONVERGED:
            status, used, left = solve_from_above(
                rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam,
                offset[a], half_play, carrier_stiffness, pull, scale_stiffness, states[a],
                force[a], cam_force[a], work,
            )  # fmt: skip
            if status != CONVERGED:
                return a
        torsional[a] = left
        steps[a] = used
    return -1
