"""Compiled sweeps with friction over crank angle, each state from its neighbours.

Where a neighbour does not lead to a state, friction is raised from the state without it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import greatest, greatest_of_rows, put
from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, NOT_CONVERGED
from cqdd_design.gearbox.contact.friction_kernel import RIDGES, rubbing_work, solve_rubbed
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Forces,
    Load,
    Rubbing,
    RubbingWork,
    Springs,
    SweepResult,
)
from cqdd_design.gearbox.contact.sweep_kernel import contacts_at, predict

_SLACK = 1e-12
"""Share of the greatest force below which a disc carries nothing."""
_LEAST_RISE = 2.0**-8
"""Share of the friction below which no further rise is tried: the machine jams."""


@part()
def _raise(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    already: Any,
    state: Any,
    forces: Forces,
    scratch: RubbingWork,
    held: float,
) -> tuple[int, int, float]:
    """Raise friction from the share `already`, at which `state` is, to that of `rubbing`."""
    reached, rise, steps, torsional = 0.0, 1.0, 0, 0.0
    start = state.copy()
    while reached < 1.0:
        share = min(reached + rise, 1.0)
        some = already + share * (rubbing.share - already)
        put(state, start)
        status, used, torsional = solve_rubbed(
            contacts,
            springs,
            load,
            Rubbing(some, rubbing.disc_arm, rubbing.carrier_arm),
            state,
            forces,
            scratch,
            held,
        )
        steps += used
        if status == CONVERGED:
            put(start, state)
            reached = share
            continue
        rise *= 0.5
        if rise < _LEAST_RISE:
            return NOT_CONVERGED, steps, torsional
    return CONVERGED, steps, torsional


@part()
def solve_raised(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    smooth: Any,
    loaded: Any,
    state: Any,
    forces: Forces,
    scratch: RubbingWork,
    held: float,
) -> tuple[int, int, float]:
    """Solve one state by raising friction from the state `smooth` without it.

    A disc that hangs slack there (`loaded` is False) is left smooth at first, since what it must do
    is get out of the way; it rubs only where it is pinched in the end.
    """
    put(state, smooth)
    none = np.zeros_like(rubbing.share)
    some = rubbing.share.copy()
    for d in range(some.shape[0]):
        if not loaded[d]:
            some[d] = 0.0
    rubs = Rubbing(some, rubbing.disc_arm, rubbing.carrier_arm)
    status, steps, torsional = _raise(
        contacts, springs, load, rubs, none, state, forces, scratch, held
    )
    if status != CONVERGED:
        return status, steps, torsional
    left = 0.0
    for d in range(some.shape[0]):
        if not loaded[d]:
            left = max(left, greatest(forces.contact[d]))
    if left <= _SLACK * greatest_of_rows(forces.contact):
        return status, steps, torsional
    status, used, torsional = _raise(
        contacts, springs, load, rubbing, some, state, forces, scratch, held
    )
    return status, steps + used, torsional


@numba.njit(cache=True, error_model="numpy")
def rub_sweep(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    turns: Any,
    smooth: SweepResult,
    result: SweepResult,
) -> int:
    """Equilibria with friction at consecutive crank angles, each from the ones before.

    Parameters
    ----------
    contacts, rubbing : Contacts, Rubbing
        With a leading axis A.
    springs, load
        Of all angles.
    turns : array (A,)
        Crank angle since the state before, rad.
    smooth : SweepResult
        Without friction.
    result : SweepResult
        Out.

    Returns
    -------
    int
        -1, or the index of the first angle at which no forces carry the load.
    """
    count, discs, each = contacts.gaps.shape
    states = result.states
    scratch, loaded = rubbing_work(discs, each), np.empty(discs, dtype=np.bool_)
    for a in range(count):
        here = contacts_at(contacts, a)
        rubs = Rubbing(rubbing.share[a], rubbing.disc_arm[a], rubbing.carrier_arm[a])
        forces = Forces(result.force[a], result.cam_force[a])
        status, used, left = NOT_CONVERGED, 0, 0.0
        if a > 0:
            predict(states[a - 1], states[max(a - 2, 0)], turns[a], a, states[a])
            status, used, left = solve_rubbed(
                here, springs, load, rubs, states[a], forces, scratch, RIDGES[0]
            )
        if status != CONVERGED:
            enough = _SLACK * greatest_of_rows(smooth.force[a])
            for d in range(discs):
                loaded[d] = greatest(smooth.force[a, d]) > enough
        for held in RIDGES:
            if status == CONVERGED:
                break
            status, used, left = solve_raised(
                here,
                springs,
                load,
                rubs,
                smooth.states[a],
                loaded,
                states[a],
                forces,
                scratch,
                held,
            )
        if status != CONVERGED:
            return a
        result.torsional[a] = left
        result.steps[a] = used
    return -1
