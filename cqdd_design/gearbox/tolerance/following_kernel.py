"""Compiled parts that follow a toleranced gearbox from one crank angle to the next under a load."""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import put, put_rows
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.compliant_kernel import yielding_work
from cqdd_design.gearbox.contact.compliant_newton_kernel import (
    DRAWN,
    RIDGES,
    solve_yielding,
    solve_yielding_from,
)
from cqdd_design.gearbox.contact.compliant_sweep_kernel import (
    TOLERANCED,
    compliance_at,
    predict_yielding,
    rubbing_at,
)
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, NOT_CONVERGED, new_work
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Contacts,
    Forces,
    Load,
    Nominal,
    Rubbing,
    Springs,
    Toleranced,
    YieldingResult,
)
from cqdd_design.gearbox.contact.sweep_kernel import contacts_at, solve_near


@part()
def follow(
    nominal: Nominal,
    found: Toleranced,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    angles: tuple[Any, Any],
    near: YieldingResult,
    base: Any,
    result: YieldingResult,
) -> int:
    """Equilibria at some angles in turn into `result`; -1, or the angle that has none.

    `angles` are the indices to solve and the turn of the crank since the one before. A state
    starts from that of `near` at its angle, such as those of another load, or where `near` is empty
    or does not lead to it, from those before it. Where that does not either, plates are held and
    friction left out first, from `base` (A, 3 + 3 D), states of held plates nearby such as the
    perfect gearbox's.
    """
    known = near.steps.size > 0
    chosen, turns = angles
    discs, contacts = found.gaps.shape[1:]
    work, held_work = yielding_work(discs, contacts), new_work(discs, contacts)
    over_angles = Contacts(
        nominal.rows, found.gaps, nominal.coefficient, found.offset, found.half_play
    )
    smooth = np.empty(3 + 3 * discs)
    for b in range(chosen.size):
        a = chosen[b]
        here, rubs = contacts_at(over_angles, a), rubbing_at(rubbing, a)
        some = compliance_at(compliance, a)
        forces = Forces(result.force[b], result.cam_force[b])
        state, approach = result.states[b], result.approach[b]
        status, used, left = NOT_CONVERGED, 0, 0.0
        if known:
            put(state, near.states[a])
            put_rows(approach, near.approach[a])
            status, used, left = solve_yielding(
                here, springs, load, rubs, some, state, approach, forces, work, RIDGES[0], DRAWN
            )
        if status != CONVERGED and b > 0:
            predict_yielding(result, turns, b, TOLERANCED)
            status, used, left = solve_yielding(
                here, springs, load, rubs, some, state, approach, forces, work, RIDGES[0], DRAWN
            )
        if status != CONVERGED:
            put(smooth, base[a])
            status, _, _ = solve_near(here, springs, load, smooth, forces, held_work)
            if status != CONVERGED:
                return int(a)
            status, used, left = solve_yielding_from(
                here, springs, load, rubs, some, smooth, state, approach, forces, work
            )
        if status != CONVERGED:
            return int(a)
        result.torsional[b] = left
        result.steps[b] = used
    return -1


@part()
def turns_between(nominal: Nominal, chosen: Any) -> Any:
    """Crank angle since the chosen angle before, rad."""
    turns = np.zeros(chosen.size)
    for b in range(1, chosen.size):
        turns[b] = nominal.crank_angle[chosen[b]] - nominal.crank_angle[chosen[b - 1]]
    return turns


@part()
def room(count: int, discs: int, contacts: int) -> YieldingResult:
    """For that many equilibria; for none, where there are no others to start from."""
    return YieldingResult(
        np.empty((count, 4 + 3 * discs)),
        np.empty((count, discs, contacts)),
        np.empty((count, discs, contacts)),
        np.empty((count, discs, 2)),
        np.empty(count),
        np.zeros(count, dtype=np.int64),
    )
