"""Compiled sweep over crank angles: each state from the ones before, or from above.

The equilibrium of one state is :mod:`.equilibrium_kernel`.
"""

from __future__ import annotations

import math
from typing import Any

from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, new_work, solve_state
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Forces,
    Load,
    Springs,
    SweepResult,
    Work,
)

_FIRM_APPROACH = 5e-6
"""Approach, m, of a load that presses the discs firmly against what stops them."""


@part(borrows=True)
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


@part(borrows=True)
def solve_from_above(
    contacts: Contacts, springs: Springs, load: Load, state: Any, forces: Forces, work: Work
) -> tuple[int, int, float]:
    """Solve one state from nothing by lowering the load to its pull, tenfold at a time.

    Slow and safe: under a small load the discs slide round their cams' play, a narrow curved
    valley that Newton's method follows only in small steps; under a firm one they do not.
    Arguments and returns are those of :func:`.equilibrium_kernel.solve_state`.
    """
    pull = load.pull
    firm = abs(pull)
    while 0.0 < firm < _FIRM_APPROACH * load.scale_stiffness:
        firm *= 10.0
    state[:] = 0.0
    steps = 0
    while True:
        now = max(firm, abs(pull))
        eased = Load(math.copysign(now, pull), load.scale_stiffness)
        status, used, torsional = solve_state(contacts, springs, eased, state, forces, work)
        steps += used
        if now <= abs(pull):
            return status, steps, torsional
        firm /= 10.0
        if firm < 2.0 * abs(pull):
            firm = abs(pull)


@part(borrows=True, forceinline=True)
def solve_near(
    contacts: Contacts, springs: Springs, load: Load, state: Any, forces: Forces, work: Work
) -> tuple[int, int, float]:
    """Solve one state from the start in `state`, and from above where that does not lead to it."""
    status, steps, torsional = solve_state(contacts, springs, load, state, forces, work)
    if status != CONVERGED:
        return solve_from_above(contacts, springs, load, state, forces, work)
    return status, steps, torsional


@part(forceinline=True)
def contacts_at(contacts: Contacts, a: int) -> Contacts:
    """The contacts at one of many crank angles."""
    return Contacts(
        contacts.rows[a],
        contacts.gaps[a],
        contacts.coefficient[a],
        contacts.offset[a],
        contacts.half_play,
    )


@numba.njit(cache=True, error_model="numpy")
def solve_sweep(
    contacts: Contacts, springs: Springs, load: Load, turns: Any, result: SweepResult
) -> int:
    """Equilibria at consecutive crank angles, each from the ones before.

    Parameters
    ----------
    contacts : Contacts
        With a leading axis A.
    springs, load
        Of all angles.
    turns : array (A,)
        Crank angle since the state before, rad.
    result : SweepResult
        Out.

    Returns
    -------
    int
        -1, or the index of the first state that did not converge.
    """
    count, discs, each = contacts.gaps.shape
    states = result.states
    work = new_work(discs, each)
    for a in range(count):
        if a == 0:
            states[0, :] = 0.0
        else:
            predict(states[a - 1], states[max(a - 2, 0)], turns[a], a, states[a])
        forces = Forces(result.force[a], result.cam_force[a])
        status, used, left = solve_near(
            contacts_at(contacts, a), springs, load, states[a], forces, work
        )
        if status != CONVERGED:
            return a
        result.torsional[a] = left
        result.steps[a] = used
    return -1
