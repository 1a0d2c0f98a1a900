"""Compiled equilibrium of one state of the contacts; :mod:`.sweep_kernel` goes over many.

The energy of all springs is convex, so its only stationary point is the equilibrium. Newton's
method meets it in two or three steps from a neighbouring state; a line search on the directional
derivative, which is monotone, makes it safe from any start. The carrier couples the discs through
one 3x3 block, so a state costs one small elimination per disc.

State vector: carrier (X, Y, gamma), then each disc (x, y, theta); angles are multiplied by
`length` (the pin circle), so that every entry is a length and every gradient a force. A plain
numpy twin stands in ``tests/oracles/contact_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force
from cqdd_design.gearbox.contact.newton_kernel import evaluate_state, newton_step

_STEPS = 300
_SEARCHES = 200
_ENOUGH, _LEAST = 0.7, 0.1
"""Derivative along a step, in shares of that at its start: accepted, and aimed at."""

_GOOD = 1e-11
_NEARLY = 1e-6

CONVERGED, NOT_CONVERGED = 0, 1


@numba.njit(cache=True, error_model="numpy")
def solve_state(
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
    """Find the equilibrium at one crank angle, from `state` and into it.

    Parameters
    ----------
    rows : array (D, C, 3)
        n_x, n_y and h/length of C = teeth + pins contacts on every disc.
    gaps, coefficient : array (D, C)
        m; coefficient of either law.
    teeth : int
        Contacts that belong to the ring; the rest are pins.
    codes, logarithms : sequences of two
        Law of ring and pins, and Johnson's B.
    series, half_play : array (D,)
        Compliance of the pins, m/N; half of the play, m.
    cam : sequence of two
        K and exponent.
    offset : array (D, 2)
        Displacement of the cams' centres, m.
    carrier_stiffness : float
        N/m; 0 is rigid.
    pull : float
        T/length, N.
    scale_stiffness : float
        A typical stiffness, N/m; sets the ridge that keeps slack discs where they are.
    state : array (3 + 3 D,)
        In: a start. Out: the equilibrium.
    force, cam_force : array (D, C), (D, 2)
        Out: forces at the equilibrium, N.
    work : array (6 (3 + 3 D) + 2 D C + 12 D + 6,)
        Scratch.

    Returns
    -------
    status, steps, torsional : int, int, float
        0 when converged; Newton steps; dT/dgamma/length^2, N/m.
    """
    discs, contacts = gaps.shape
    size = 3 + 3 * discs
    gradient, step = work[:size], work[size : 2 * size]
    trial = work[2 * size : 3 * size]
    at = 3 * size
    stiff = work[at : at + discs * contacts].reshape(discs, contacts)
    at += discs * contacts
    closed = work[at : at + discs * contacts].reshape(discs, contacts)
    at += discs * contacts
    block = work[at : at + 6 * discs].reshape(discs, 6)
    at += 6 * discs
    shared = work[at : at + 6 * discs].reshape(discs, 6)
    at += 6 * discs
    carrier = work[at : at + 6]
    ridge = 1e-10 * scale_stiffness
    torsional = 0.0
    previous = np.inf
    largest = evaluate_state(
        rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset, half_play,
        carrier_stiffness, pull, state, force, stiff, closed, cam_force, gradient, block, shared,
    )  # fmt: skip
    for iteration in range(_STEPS):
        if carrier_stiffness <= 0.0:
            gradient[0] = 0.0
            gradient[1] = 0.0
        residual = 0.0
        for i in range(size):
            residual = max(residual, abs(gradient[i]))
        scale = max(abs(pull), largest)
        torsional = newton_step(block, shared, gradient, carrier_stiffness, ridge, step, carrier)
        stuck = (
            iteration > 3
            and residual >= 0.25 * previous
            and residual <= max(1e-7 * scale, _rounding(stiff, state))
        )
        if residual <= _NEARLY * scale or stuck:
            # The last step is taken on the forces too, in first order: this balances them to
            # rounding, and its own error is the square of a relative 1e-6.
            smooth = True
            if residual > _GOOD * scale and not stuck:
                smooth = _within_first_order(rows, teeth, closed, stiff, step, scale)
            if smooth:
                _take_step(
                    rows, teeth, stiff, cam, offset, half_play, state, step, force, cam_force
                )
                return CONVERGED, iteration, torsional
        previous = residual
        slope = 0.0
        for i in range(size):
            slope += gradient[i] * step[i]
        if not slope < 0.0:
            return NOT_CONVERGED, iteration, torsional
        share = 1.0
        for _ in range(2):
            for i in range(size):
                trial[i] = state[i] + share * step[i]
            largest = evaluate_state(
                rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset,
                half_play, carrier_stiffness, pull, trial, force, stiff, closed, cam_force,
                gradient, block, shared,
            )  # fmt: skip
            if carrier_stiffness <= 0.0:
                gradient[0] = 0.0
                gradient[1] = 0.0
            there = 0.0
            for i in range(size):
                there += gradient[i] * step[i]
            if share != 1.0 or abs(there) <= _ENOUGH * abs(slope):
                break
            share = _least_along(
                rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset, half_play,
                carrier_stiffness, pull, state, step, slope, there, closed, stiff,
            )  # fmt: skip
        for i in range(size):
            state[i] = trial[i]
    return NOT_CONVERGED, _STEPS, torsional


@numba.njit(cache=True, error_model="numpy")
def _least_along(
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
    state: Any,
    step: Any,
    slope: float,
    there: float,
    start: Any,
    moved: Any,
) -> float:
    """Share of a step where the energy is least along it.

    All closings but the cams' are straight lines over the share, so that a trial here costs a
    small part of a state. `slope` and `there` are the derivatives at shares 0 and 1; `start` and
    `moved` (D, C) are scratch for the closings at 0 and their change to 1.
    """
    discs, contacts = gaps.shape
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d]
        for k in range(contacts):
            if k == teeth:
                x, y, t = x - state[0], y - state[1], t - state[2]
            start[d, k] = -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t) - gaps[d, k]
            moved[d, k] = _moved(rows, teeth, step, d, k)
    held = carrier_stiffness * (step[0] * step[0] + step[1] * step[1])
    force = carrier_stiffness * (state[0] * step[0] + state[1] * step[1]) - pull * step[2]
    low, high = (0.0, 1.0) if there > 0.0 else (1.0, np.inf)
    share = slope / (slope - there) if there > 0.0 else 4.0
    for _ in range(_SEARCHES):
        along, bend = force + share * held, held
        for d in range(discs):
            for k in range(contacts):
                delta = start[d, k] + share * moved[d, k]
                if delta > 0.0 and moved[d, k] != 0.0:
                    if k < teeth:
                        f, s = line_force(codes[0], coefficient[d, k], logarithms[0], 0.0, delta)
                    else:
                        f, s = line_force(
                            codes[1], coefficient[d, k], logarithms[1], series[d], delta
                        )
                    along += f * moved[d, k]
                    bend += s * moved[d, k] * moved[d, k]
            vx, vy = step[3 + 3 * d], step[4 + 3 * d]
            rx = state[3 + 3 * d] - offset[d, 0] + share * vx
            ry = state[4 + 3 * d] - offset[d, 1] + share * vy
            rho = math.sqrt(rx * rx + ry * ry)
            over = rho - half_play[d]
            if over > 0.0 and rho > 0.0:
                f, s = radial_force(cam[0], cam[1], over)
                out, across = (rx * vx + ry * vy) / rho, (rx * vy - ry * vx) / rho
                along += f * out
                bend += s * out * out + f / rho * across * across
        if abs(along) <= _LEAST * abs(slope):
            break
        if along > 0.0:
            high = share
        else:
            low = share
        if high - low <= 1e-14 * high:
            break
        # Newton's method, and halves where it leaves what is known to hold the least.
        share = share - along / bend if bend > 0.0 else np.inf
        if not low < share < high:
            if high == np.inf:
                share = 4.0 * low
            elif low > 0.0 and high > 4.0 * low:
                share = math.sqrt(low * high)
            else:
                share = 0.5 * (low + high) if low > 0.0 else 0.1 * high
    return share


@numba.njit(cache=True, error_model="numpy")
def _rounding(stiff: Any, state: Any) -> float:
    """Force that the rounding of the closings alone leaves unbalanced."""
    stiffest, furthest = 0.0, 0.0
    for d in range(stiff.shape[0]):
        for k in range(stiff.shape[1]):
            stiffest = max(stiffest, stiff[d, k])
    for i in range(state.size):
        furthest = max(furthest, abs(state[i]))
    return 1e-15 * stiffest * furthest


@numba.njit(cache=True, error_model="numpy")
def _moved(rows: Any, teeth: int, step: Any, d: int, k: int) -> float:
    """How much further a contact closes by `step`."""
    x, y, t = step[3 + 3 * d], step[4 + 3 * d], step[5 + 3 * d]
    if k >= teeth:
        x -= step[0]
        y -= step[1]
        t -= step[2]
    return -float(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t)


@numba.njit(cache=True, error_model="numpy")
def _within_first_order(
    rows: Any, teeth: int, closed: Any, stiff: Any, step: Any, scale: float
) -> bool:
    """Whether a step neither opens nor closes a contact, nor changes a force by its square."""
    discs, contacts = closed.shape
    for d in range(discs):
        for k in range(contacts):
            moved = _moved(rows, teeth, step, d, k)
            if closed[d, k] <= 0.0:
                if closed[d, k] + moved > 0.0:
                    return False
            elif stiff[d, k] * moved * moved > 1e-12 * scale * closed[d, k]:
                return False
    return True


@numba.njit(cache=True, error_model="numpy")
def _take_step(
    rows: Any,
    teeth: int,
    stiff: Any,
    cam: Any,
    offset: Any,
    half_play: Any,
    state: Any,
    step: Any,
    force: Any,
    cam_force: Any,
) -> None:
    """Move the state by `step` and the forces by their stiffness times it."""
    discs, contacts = force.shape
    for d in range(discs):
        for k in range(contacts):
            if force[d, k] > 0.0:
                force[d, k] = max(force[d, k] + stiff[d, k] * _moved(rows, teeth, step, d, k), 0.0)
        rx = state[3 + 3 * d] - offset[d, 0]
        ry = state[4 + 3 * d] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        if over > 0.0 and rho > 0.0:
            f, s = radial_force(cam[0], cam[1], over)
            ux, uy, across = rx / rho, ry / rho, f / rho
            vx, vy = step[3 + 3 * d], step[4 + 3 * d]
            along, sideways = ux * vx + uy * vy, -uy * vx + ux * vy
            cam_force[d, 0] -= s * along * ux - across * sideways * uy
            cam_force[d, 1] -= s * along * uy + across * sideways * ux
        elif over >= 0.0 and cam[1] == 1.0:
            cam_force[d, 0] -= cam[0] * step[3 + 3 * d]
            cam_force[d, 1] -= cam[0] * step[4 + 3 * d]
    for i in range(state.size):
        state[i] += step[i]
