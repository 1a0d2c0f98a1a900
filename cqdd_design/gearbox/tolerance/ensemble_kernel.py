"""Compiled kernel that solves many toleranced gearboxes, one a loop turn, in parallel.

Each gearbox is worked alone and in the same order of operations, so its numbers do not depend on
the number of threads. Memory is one gearbox's arrays a thread.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, new_work
from cqdd_design.gearbox.contact.gaps_kernel import fill_errors
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Extremes,
    Forces,
    Load,
    Nominal,
    RigidParts,
    Springs,
    Start,
    Toleranced,
)
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.sweep_kernel import contacts_at, predict, solve_near
from cqdd_design.gearbox.precision.backlash_kernel import OVERLAP, backlash_sweep

BACKLASH, TRANSMISSION_ERROR, RING_FORCE, STIFFNESS, RIPPLE = range(5)


class _Seen(NamedTuple):
    """What the states of one sweep show: carrier angles times length (m), N, N m."""

    least: float
    greatest: float
    ring_force: float
    least_slope: float
    greatest_slope: float
    mean: float
    """Of the carrier angle at the marked angles."""


@numba.njit(cache=True, error_model="numpy")
def _slope(
    nominal: Nominal, found: Toleranced, a: int, teeth: int, state: Any, forces: Forces
) -> float:
    """dPi/dphi of one state: forces times the rates of closing at a held state, N m.

    A contact closes at the rate -(n' r + h' t) - gap', and a softer one stores less:
    dU/dc = -F^2/2 at a held closing, which `rates[..., 3]` takes part in.
    """
    rows, rates, gap_rates = nominal.rows[a], nominal.rates[a], found.gap_rates[a]
    force, cam_force, offset_rates = forces.contact, forces.cam, found.offset_rates[a]
    discs, contacts = force.shape
    slope = 0.0
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d]
        for k in range(contacts):
            if k == teeth:
                x -= state[0]
                y -= state[1]
                t -= state[2]
            if force[d, k] > 0.0:
                across = rows[d, k, 0] * y - rows[d, k, 1] * x
                slope -= force[d, k] * (
                    rates[d, k, 0] * across
                    + rates[d, k, 1] * t
                    + rates[d, k, 2]
                    + gap_rates[d, k]
                    + 0.5 * force[d, k] * rates[d, k, 3]
                )
        slope += cam_force[d, 0] * offset_rates[d, 0] + cam_force[d, 1] * offset_rates[d, 1]
    return slope


@numba.njit(cache=True, error_model="numpy")
def _follow(
    nominal: Nominal,
    found: Toleranced,
    springs: Springs,
    load: Load,
    angles: tuple[Any, Any],
    base: Any,
    solved: Any,
) -> Any:
    """Solve some angles in turn: (-1 or the angle that did not converge, what was seen).

    `angles` are the indices to solve and (A,) whether an angle is marked; `base` (A, 3 + 3 D) are
    known states nearby, such as those of the perfect gearbox: a state starts from its base plus
    the deviations of the states before. `solved` (A, 3 + 3 D) returns the states.
    """
    chosen, marked = angles
    discs, contacts = found.gaps.shape[1:]
    teeth, size = springs.teeth, 3 + 3 * discs
    work = new_work(discs, contacts)
    state, deviation = np.zeros(size), np.zeros(size)
    last, before = np.zeros(size), np.zeros(size)
    forces = Forces(np.empty((discs, contacts)), np.empty((discs, 2)))
    over_angles = Contacts(
        nominal.rows, found.gaps, nominal.coefficient, found.offset, found.half_play
    )
    least, greatest, most, total = np.inf, -np.inf, 0.0, 0.0
    least_slope, greatest_slope = np.inf, -np.inf
    stopped, counted = -1, 0
    for b in range(chosen.size):
        a = chosen[b]
        if b > 0:
            turn = nominal.crank_angle[a] - nominal.crank_angle[chosen[b - 1]]
            predict(last, before, turn, b, deviation)
        for i in range(size):
            state[i] = base[a, i] + deviation[i]
        contacts_here = contacts_at(over_angles, a)
        status, _, _ = solve_near(contacts_here, springs, load, state, forces, work)
        if status != CONVERGED:
            stopped = int(a)
            break
        before[:] = last
        for i in range(size):
            last[i] = state[i] - base[a, i]
            solved[a, i] = state[i]
        least, greatest = min(least, state[2]), max(greatest, state[2])
        for d in range(discs):
            for k in range(teeth):
                most = max(most, forces.contact[d, k])
        slope = _slope(nominal, found, a, teeth, state, forces)
        least_slope, greatest_slope = min(least_slope, slope), max(greatest_slope, slope)
        if marked[a]:
            total += state[2]
            counted += 1
    return stopped, _Seen(least, greatest, most, least_slope, greatest_slope, total / counted)


@numba.njit(cache=True, error_model="numpy")
def _rigid_parts(nominal: Nominal, found: Toleranced, errors: GearboxErrors) -> RigidParts:
    """One gearbox with its errors as the backlash sees it."""
    count, discs, contacts = found.gaps.shape
    pins = contacts - nominal.tooth_centre.shape[0]
    apart = np.empty((count, discs, pins, 2))
    own = np.empty((count, discs))
    for a in range(count):
        # `kinematics.turned_with_carrier` of the holes' places against the pins'.
        back = -nominal.crank_angle[a] / nominal.lobe_count
        cosine, sine = math.cos(back), math.sin(back)
        for d in range(discs):
            own[a, d] = nominal.crank_angle[a] + nominal.phases[d]
            for j in range(pins):
                x = errors.hole_position[d, j, 0] - errors.pin_position[j, 0]
                y = errors.hole_position[d, j, 1] - errors.pin_position[j, 1]
                apart[a, d, j, 0] = cosine * x - sine * y
                apart[a, d, j, 1] = sine * x + cosine * y
    return RigidParts(
        nominal.rows,
        found.gaps,
        nominal.curvature,
        nominal.tooth_centre,
        nominal.pin_angle,
        nominal.crank_angle,
        own,
        apart,
        found.offset,
        found.half_play,
        nominal.eccentricity,
        nominal.length,
    )


@numba.njit(cache=True, error_model="numpy")
def _solve_gearbox(
    nominal: Nominal, springs: Springs, load: Load, start: Start, errors: GearboxErrors, values: Any
) -> int:
    """All five results of one gearbox; -1, or the angle that did not converge."""
    count, discs, contacts = nominal.gaps.shape
    size, length = 3 + 3 * discs, nominal.length
    every, some = np.arange(count), np.flatnonzero(start.marked)
    found = Toleranced(
        np.empty((count, discs, contacts)),
        np.empty((count, discs, contacts)),
        np.empty((count, discs, 2)),
        np.empty((count, discs, 2)),
        np.empty(discs),
    )
    fill_errors(nominal, errors, found)
    solved, halved = np.empty((count, size)), np.empty((count, size))
    stopped, seen = _follow(
        nominal, found, springs, load, (every, start.marked), start.perfect, solved
    )
    values[TRANSMISSION_ERROR] = (seen.greatest - seen.least) / length
    values[RING_FORCE] = seen.ring_force
    values[RIPPLE] = seen.greatest_slope - seen.least_slope
    if stopped >= 0:
        return int(stopped)
    half = Load(0.5 * start.torque / length, load.scale_stiffness)
    stopped, eased = _follow(nominal, found, springs, half, (some, start.marked), solved, halved)
    # The secant between half of the torque and all of it, (T - T/2)/(gamma - gamma_half).
    values[STIFFNESS] = 0.5 * start.torque * length / (seen.mean - eased.mean)
    if stopped >= 0:
        return int(stopped)
    parts = _rigid_parts(nominal, found, errors)
    free_count = some.size
    least = Extremes(np.empty(free_count), np.empty(free_count), np.empty((free_count, size)))
    most = Extremes(np.empty(free_count), least.preload, least.poses)
    at = backlash_sweep(parts, some, -1.0, start.free_poses[0], least)
    if at < 0:
        at = backlash_sweep(parts, some, 1.0, start.free_poses[1], most)
    free = 0.0
    for b in range(free_count):
        if most.preload[b] <= OVERLAP:
            free += max(most.ends[b] - least.ends[b], 0.0)
    values[BACKLASH] = free / free_count
    return int(some[at]) if at >= 0 else -1


@numba.njit(cache=True, error_model="numpy", parallel=True)
def solve_gearboxes(
    nominal: Nominal,
    springs: Springs,
    load: Load,
    start: Start,
    batch: GearboxErrors,
    values: Any,
    failed: Any,
) -> None:
    """Backlash, transmission error, ring force, stiffness and ripple of S gearboxes.

    Parameters
    ----------
    nominal, springs, load, start
        What all gearboxes share.
    batch : GearboxErrors
        With a leading axis S.
    values : array (S, 5)
        Out, in SI: backlash and transmission error in rad, the ripple without the factor n.
    failed : array (S,)
        Out: -1, or the angle that did not converge.
    """
    for s in numba.prange(batch.tooth_radius.shape[0]):
        errors = GearboxErrors(
            batch.tooth_position[s],
            batch.tooth_radius[s],
            batch.disc_profile[s],
            batch.hole_position[s],
            batch.hole_radius[s],
            batch.pin_position[s],
            batch.pin_radius[s],
            batch.cam_centre[s],
            batch.cam_play[s],
        )
        failed[s] = _solve_gearbox(nominal, springs, load, start, errors, values[s])
