"""Compiled equilibrium of one state of the contacts; :mod:`.sweep_kernel` goes over many.

The energy of all springs is convex, so its only stationary point is the equilibrium. Newton's
method meets it in two or three steps from a neighbouring state; a line search on the directional
derivative, which is monotone, makes it safe from any start. The carrier couples the discs through
one 3x3 block, so a state costs one small elimination per disc.

State vector: carrier (X, Y, gamma), then each disc (x, y, theta); angles are multiplied by
`length` (the pin circle), so that every entry is a length and every gradient a force. A plain
numpy twin stands in ``tests/oracles/contact_plain.py``.

Values with names (:mod:`.kernel_values`) pass a hundred words a call; what is called from one place
alone is therefore inlined by the compiler (`forceinline`), which a fifth of the speed hangs on.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.kernel_values import Contacts, Forces, Load, Springs, Work
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force
from cqdd_design.gearbox.contact.newton_kernel import evaluate_state, newton_step

_STEPS = 300
_SEARCHES = 200
_ENOUGH, _LEAST = 0.7, 0.1
"""Derivative along a step, in shares of that at its start: accepted, and aimed at."""

_GOOD = 1e-11
_NEARLY = 1e-6

CONVERGED, NOT_CONVERGED = 0, 1


@part()
def new_work(discs: int, contacts: int) -> Work:
    """Scratch for states of D discs with C contacts each."""
    size = 3 + 3 * discs
    return Work(
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty((discs, contacts)),
        np.empty((discs, contacts)),
        np.empty((discs, 6)),
        np.empty((discs, 6)),
        np.empty(6),
    )


@part(borrows=True)
def solve_state(
    contacts: Contacts, springs: Springs, load: Load, state: Any, forces: Forces, work: Work
) -> tuple[int, int, float]:
    """Find the equilibrium at one crank angle, from `state` and into it.

    Parameters
    ----------
    contacts, springs, load
        What acts, see :mod:`.kernel_values`.
    state : array (3 + 3 D,)
        In: a start. Out: the equilibrium.
    forces : Forces
        Out: forces at the equilibrium.
    work : Work
        Scratch.

    Returns
    -------
    status, steps, torsional : int, int, float
        0 when converged; Newton steps; dT/dgamma/length^2, N/m.
    """
    rigid = springs.carrier_stiffness <= 0.0
    gradient, step, trial = work.gradient, work.step, work.trial
    size = state.size
    ridge = 1e-10 * load.scale_stiffness
    torsional = 0.0
    previous = np.inf
    largest = evaluate_state(contacts, springs, load.pull, state, forces, work)
    for iteration in range(_STEPS):
        if rigid:
            gradient[0] = 0.0
            gradient[1] = 0.0
        residual = 0.0
        for i in range(size):
            residual = max(residual, abs(gradient[i]))
        scale = max(abs(load.pull), largest)
        torsional = newton_step(work, springs.carrier_stiffness, ridge)
        stuck = (
            iteration > 3
            and residual >= 0.25 * previous
            and residual <= max(1e-7 * scale, rounding(work.stiff, state))
        )
        if residual <= _NEARLY * scale or stuck:
            # The last step is taken on the forces too, in first order: this balances them to
            # rounding, and its own error is the square of a relative 1e-6.
            smooth = True
            if residual > _GOOD * scale and not stuck:
                smooth = within_first_order(contacts, springs.teeth, work, scale)
            if smooth:
                take_step(contacts, springs, state, forces, work)
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
            largest = evaluate_state(contacts, springs, load.pull, trial, forces, work)
            if rigid:
                gradient[0] = 0.0
                gradient[1] = 0.0
            there = 0.0
            for i in range(size):
                there += gradient[i] * step[i]
            if share != 1.0 or abs(there) <= _ENOUGH * abs(slope):
                break
            share = _least_along(contacts, springs, load.pull, state, (slope, there), work)
        for i in range(size):
            state[i] = trial[i]
    return NOT_CONVERGED, _STEPS, torsional


@part(borrows=True)
def _least_along(
    contacts: Contacts,
    springs: Springs,
    pull: float,
    state: Any,
    slopes: tuple[float, float],
    work: Work,
) -> float:
    """Share of `work.step` where the energy is least along it.

    All closings but the cams' are straight lines over the share, so that a trial here costs a
    small part of a state. `slopes` are the derivatives of the energy at shares 0 and 1; the
    closings at 0 and their change to 1 go into `work.closed` and `work.stiff`.
    """
    slope, there = slopes
    rows, gaps, coefficient = contacts.rows, contacts.gaps, contacts.coefficient
    teeth, step, start, moved = springs.teeth, work.step, work.closed, work.stiff
    offset, half_play, pin_series = contacts.offset, contacts.half_play, springs.pin_series
    discs, count = gaps.shape
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d]
        for k in range(count):
            if k == teeth:
                x, y, t = x - state[0], y - state[1], t - state[2]
            start[d, k] = -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t) - gaps[d, k]
            moved[d, k] = _moved(rows, teeth, step, d, k)
    bed = springs.carrier_stiffness
    held = bed * (step[0] * step[0] + step[1] * step[1])
    force = bed * (state[0] * step[0] + state[1] * step[1]) - pull * step[2]
    low, high = (0.0, 1.0) if there > 0.0 else (1.0, np.inf)
    share = slope / (slope - there) if there > 0.0 else 4.0
    for _ in range(_SEARCHES):
        along, bend = force + share * held, held
        for d in range(discs):
            for k in range(count):
                delta = start[d, k] + share * moved[d, k]
                if delta > 0.0 and moved[d, k] != 0.0:
                    if k < teeth:
                        code, logarithm, series = springs.ring_law, springs.ring_logarithm, 0.0
                    else:
                        code, logarithm = springs.pin_law, springs.pin_logarithm
                        series = pin_series[d]
                    f, s = line_force(code, coefficient[d, k], logarithm, series, delta)
                    along += f * moved[d, k]
                    bend += s * moved[d, k] * moved[d, k]
            vx, vy = step[3 + 3 * d], step[4 + 3 * d]
            rx = state[3 + 3 * d] - offset[d, 0] + share * vx
            ry = state[4 + 3 * d] - offset[d, 1] + share * vy
            rho = math.sqrt(rx * rx + ry * ry)
            over = rho - half_play[d]
            if over > 0.0 and rho > 0.0:
                f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
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


@part(borrows=True, forceinline=True)
def rounding(stiff: Any, state: Any) -> float:
    """Force that the rounding of the closings alone leaves unbalanced."""
    stiffest, furthest = 0.0, 0.0
    for d in range(stiff.shape[0]):
        for k in range(stiff.shape[1]):
            stiffest = max(stiffest, stiff[d, k])
    for i in range(state.size):
        furthest = max(furthest, abs(state[i]))
    return 1e-15 * stiffest * furthest


@part(borrows=True)
def _moved(rows: Any, teeth: int, step: Any, d: int, k: int) -> float:
    """How much further a contact closes by `step`."""
    x, y, t = step[3 + 3 * d], step[4 + 3 * d], step[5 + 3 * d]
    if k >= teeth:
        x -= step[0]
        y -= step[1]
        t -= step[2]
    return -float(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t)


@part(borrows=True, forceinline=True)
def within_first_order(contacts: Contacts, teeth: int, work: Work, scale: float) -> bool:
    """Whether the step neither opens nor closes a contact, nor changes a force by its square."""
    rows, step, closed, stiff = contacts.rows, work.step, work.closed, work.stiff
    discs, count = closed.shape
    for d in range(discs):
        for k in range(count):
            moved = _moved(rows, teeth, step, d, k)
            if closed[d, k] <= 0.0:
                if closed[d, k] + moved > 0.0:
                    return False
            elif stiff[d, k] * moved * moved > 1e-12 * scale * closed[d, k]:
                return False
    return True


@part(borrows=True, forceinline=True)
def take_step(contacts: Contacts, springs: Springs, state: Any, forces: Forces, work: Work) -> None:
    """Move the state by the step and the forces by their stiffness times it."""
    rows, step, stiff, teeth = contacts.rows, work.step, work.stiff, springs.teeth
    offset, half_play, force, cam = contacts.offset, contacts.half_play, forces.contact, forces.cam
    discs, count = force.shape
    for d in range(discs):
        for k in range(count):
            if force[d, k] > 0.0:
                force[d, k] = max(force[d, k] + stiff[d, k] * _moved(rows, teeth, step, d, k), 0.0)
        rx = state[3 + 3 * d] - offset[d, 0]
        ry = state[4 + 3 * d] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        if over > 0.0 and rho > 0.0:
            # dF = -(F' u u^T + F/rho v v^T) dr, with u along the displacement and v across it.
            f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
            ux, uy, across = rx / rho, ry / rho, f / rho
            vx, vy = step[3 + 3 * d], step[4 + 3 * d]
            along, sideways = ux * vx + uy * vy, -uy * vx + ux * vy
            cam[d, 0] -= s * along * ux - across * sideways * uy
            cam[d, 1] -= s * along * uy + across * sideways * ux
        elif over >= 0.0 and springs.cam_exponent == 1.0:
            cam[d, 0] -= springs.cam_stiffness * step[3 + 3 * d]
            cam[d, 1] -= springs.cam_stiffness * step[4 + 3 * d]
    for i in range(state.size):
        state[i] += step[i]
