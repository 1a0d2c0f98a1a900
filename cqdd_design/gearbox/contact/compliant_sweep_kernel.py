"""Compiled equilibria of contacts with bodies that yield, plate and cap apart, over crank angle.

Approaches change smoothly over crank angle, open ones too, so that a state found from a few
before it starts near its end with the right contacts. The equilibrium of one state is
:mod:`.compliant_newton_kernel`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.compliant_kernel import (
    yielding_work,
)
from cqdd_design.gearbox.contact.compliant_newton_kernel import (
    EXACTLY,
    RIDGES,
    solve_yielding,
    solve_yielding_from,
)
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, NOT_CONVERGED
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Contacts,
    Forces,
    Load,
    Rubbing,
    Springs,
    YieldingResult,
)
from cqdd_design.gearbox.contact.sweep_kernel import contacts_at

_NEAR = 0.2
"""Turn of the crank, rad, beyond which the state before is the best start."""
PERFECT, TOLERANCED = 3, 2
"""States before an angle from which it is predicted: those of parts with errors bend more from one
angle to the next, and a parabola through them leads further away than a line."""


@part(forceinline=True)
def rubbing_at(rubbing: Rubbing, a: int) -> Rubbing:
    """The friction at one of many crank angles."""
    return Rubbing(rubbing.share[a], rubbing.disc_arm[a], rubbing.carrier_arm[a])


@part(borrows=True, forceinline=True)
def predict_yielding(result: YieldingResult, turns: Any, a: int, points: int) -> None:
    """Start for angle `a` from up to `points` before it, by Lagrange's polynomial through them.

    Disc centres are carried round with the crank, in whose frame they hardly move. Angles that are
    far apart, or not about even, give the state before.
    """
    states, approach = result.states, result.approach
    state, closed = states[a], approach[a]
    turn = turns[a]
    known = 1
    if abs(turn) < _NEAR:
        while known < min(a, points) and 0.5 < turns[a - known] / turn < 2.0:
            known += 1
    state[:] = 0.0
    closed[:] = 0.0
    behind = 0.0
    for i in range(known):
        behind += turns[a - i]
        weight, there = 1.0, 0.0
        for j in range(known):
            there += turns[a - j]
            if j != i:
                weight *= there / (there - behind)
        at = a - 1 - i
        cosine, sine = weight * math.cos(behind), weight * math.sin(behind)
        for j in range(4):
            state[j] += weight * states[at, j]
        for d in range(closed.shape[0]):
            j = 4 + 3 * d
            x, y = states[at, j], states[at, j + 1]
            state[j] += cosine * x - sine * y
            state[j + 1] += sine * x + cosine * y
            state[j + 2] += weight * states[at, j + 2]
            for k in range(closed.shape[1]):
                closed[d, k] += weight * approach[at, d, k]


@part(forceinline=True)
def compliance_at(compliance: Compliance, a: int) -> Compliance:
    """The compliance at one of many crank angles."""
    bodies = compliance.bodies
    some = bodies[a] if bodies.shape[0] > 0 else np.empty((0, 0, 0))
    return Compliance(compliance.pins, compliance.at_cap, compliance.join, some)


@numba.njit(cache=True, error_model="numpy")
def yield_sweep(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    turns: Any,
    start: Any,
    result: YieldingResult,
) -> int:
    """Equilibria with compliance and friction at consecutive crank angles.

    Parameters
    ----------
    contacts, rubbing, compliance
        With a leading axis A; `compliance` on its bodies alone. Without friction all shares are 0.
    springs, load
        Of all angles; the springs' `pin_series` is that of held plates.
    turns : array (A,)
        Crank angle since the state before, rad.
    start : array (A, 3 + 3 D)
        States of held plates and rigid bodies, with the friction or without it.
    result : YieldingResult
        Out.

    Returns
    -------
    int
        -1, or the index of the first angle at which no forces carry the load.
    """
    count, discs, each = contacts.gaps.shape
    work = yielding_work(discs, each)
    for a in range(count):
        here = contacts_at(contacts, a)
        rubs = rubbing_at(rubbing, a)
        some = compliance_at(compliance, a)
        forces = Forces(result.force[a], result.cam_force[a])
        state, approach = result.states[a], result.approach[a]
        status, used, left = NOT_CONVERGED, 0, 0.0
        if a > 0:
            predict_yielding(result, turns, a, PERFECT)
            status, used, left = solve_yielding(
                here, springs, load, rubs, some, state, approach, forces, work, RIDGES[0], EXACTLY
            )
        if status != CONVERGED:
            status, used, left = solve_yielding_from(
                here, springs, load, rubs, some, start[a], state, approach, forces, work
            )
        if status != CONVERGED:
            return a
        result.torsional[a] = left
        result.steps[a] = used
    return -1
