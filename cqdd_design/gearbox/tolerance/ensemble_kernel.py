"""Compiled kernel that solves many toleranced gearboxes, one a loop turn, in parallel.

Each gearbox is worked alone and in the same order of operations, so its numbers do not depend on
the number of threads. Memory is one gearbox's arrays a thread.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, solve_state
from cqdd_design.gearbox.contact.gaps_kernel import fill_errors
from cqdd_design.gearbox.contact.sweep_kernel import predict, solve_from_above
from cqdd_design.gearbox.precision.backlash_kernel import OVERLAP, backlash_sweep

BACKLASH, TRANSMISSION_ERROR, RING_FORCE, STIFFNESS, RIPPLE = range(5)


@numba.njit(cache=True, error_model="numpy")
def _slope(
    rows: Any,
    rates: Any,
    gap_rates: Any,
    offset_rates: Any,
    teeth: int,
    state: Any,
    force: Any,
    cam_force: Any,
) -> float:
    """dPi/dphi of one state: forces times the rates of closing at a held state, N m."""
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
    chosen: Any,
    base: Any,
    solved: Any,
    pull: float,
    scale_stiffness: float,
    rows: Any,
    rates: Any,
    coefficient: Any,
    crank_angle: Any,
    teeth: int,
    codes: Any,
    logarithms: Any,
    series: Any,
    cam: Any,
    carrier_stiffness: float,
    gaps: Any,
    gap_rates: Any,
    offset: Any,
    offset_rates: Any,
    half_play: Any,
    work: Any,
    marked: Any,
    seen: Any,
) -> int:
    """Solve the `chosen` angles in turn; -1, or the angle that did not converge.

    `base` (A, 3 + 3 D) are known states nearby, such as those of the perfect gearbox; a state
    starts from its base plus the deviations of the states before. `solved` (A, 3 + 3 D) returns
    the states, `seen` least and greatest gamma, greatest ring force, least and greatest slope, and
    the mean of gamma over the angles that are `marked`.
    """
    discs, contacts = gaps.shape[1:]
    size = 3 + 3 * discs
    state, deviation = np.zeros(size), np.zeros(size)
    last, before = np.zeros(size), np.zeros(size)
    force, cam_force = np.empty((discs, contacts)), np.empty((discs, 2))
    seen[0], seen[1], seen[2], seen[3], seen[4], seen[5] = np.inf, -np.inf, 0.0, np.inf, -np.inf, 0
    counted = 0
    for b in range(chosen.size):
        a = chosen[b]
        if b > 0:
            turn = crank_angle[a] - crank_angle[chosen[b - 1]]
            predict(last, before, turn, b, deviation)
        for i in range(size):
            state[i] = base[a, i] + deviation[i]
        status, _, _ = solve_state(
            rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam, offset[a],
            half_play, carrier_stiffness, pull, scale_stiffness, state, force, cam_force, work,
        )  # fmt: skip
        if status != CONVERGED:
            status, _, _ = solve_from_above(
                rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam,
                offset[a], half_play, carrier_stiffness, pull, scale_stiffness, state, force,
                cam_force, work,
            )  # fmt: skip
            if status != CONVERGED:
                return int(a)
        before[:] = last
        for i in range(size):
            last[i] = state[i] - base[a, i]
            solved[a, i] = state[i]
        seen[0], seen[1] = min(seen[0], state[2]), max(seen[1], state[2])
        for d in range(discs):
            for k in range(teeth):
                seen[2] = max(seen[2], force[d, k])
        slope = _slope(
            rows[a], rates[a], gap_rates[a], offset_rates[a], teeth, state, force, cam_force
        )
        seen[3], seen[4] = min(seen[3], slope), max(seen[4], slope)
        if marked[a]:
            seen[5] += state[2]
            counted += 1
    seen[5] /= counted
    return -1


@numba.njit(cache=True, error_model="numpy", parallel=True)
def solve_gearboxes(
    rows: Any,
    rates: Any,
    nominal_gaps: Any,
    coefficient: Any,
    parameter: Any,
    parameter_rate: Any,
    curvature: Any,
    tooth_centre: Any,
    crank_angle: Any,
    phases: Any,
    pin_angle: Any,
    marked: Any,
    perfect: Any,
    free_poses: Any,
    basis: Any,
    lobe_count: int,
    play: float,
    eccentricity: float,
    length: float,
    torque: float,
    scale_stiffness: float,
    codes: Any,
    logarithms: Any,
    series: Any,
    cam: Any,
    carrier_stiffness: float,
    tooth_position: Any,
    tooth_radius: Any,
    disc_profile: Any,
    hole_position: Any,
    hole_radius: Any,
    pin_position: Any,
    pin_radius: Any,
    cam_centre: Any,
    cam_play: Any,
    values: Any,
    failed: Any,
) -> None:
    """Backlash, transmission error, ring force, stiffness and ripple of S gearboxes.

    Nominal tables have a leading axis A (angles), errors a leading axis S. `marked` (A,) tells
    which angles are used for backlash and stiffness, `perfect` (A, 3 + 3 D) are the perfect
    gearbox's states under the same torque, `free_poses` (2, A, 3 + 3 D) those at both ends of its
    backlash. Out: `values` (S, 5) in SI (the backlash and
    the transmission error in rad, the ripple without the factor n), and `failed` (S,), -1 or the
    angle that did not converge.
    """
    samples = tooth_radius.shape[0]
    count, discs, contacts = nominal_gaps.shape
    teeth = tooth_centre.shape[0]
    pins = contacts - teeth
    size = 3 + 3 * discs
    every = np.arange(count)
    some = np.flatnonzero(marked)
    for s in numba.prange(samples):
        gaps = np.empty((count, discs, contacts))
        gap_rates = np.empty((count, discs, contacts))
        offset = np.empty((count, discs, 2))
        offset_rates = np.empty((count, discs, 2))
        half_play = np.empty(discs)
        fill_errors(
            rows, rates, parameter, parameter_rate, crank_angle, phases, lobe_count, play, basis,
            tooth_position[s], tooth_radius[s], disc_profile[s], hole_position[s],
            hole_radius[s], pin_position[s], pin_radius[s], cam_centre[s], cam_play[s],
            nominal_gaps, gaps, gap_rates, offset, offset_rates, half_play,
        )  # fmt: skip
        work = np.empty(6 * size + 2 * discs * contacts + 12 * discs + 6)
        seen = np.empty(6)
        solved, halved = np.empty((count, size)), np.empty((count, size))
        stopped = _follow(
            every, perfect, solved, torque / length, scale_stiffness, rows, rates, coefficient,
            crank_angle, teeth, codes, logarithms, series, cam, carrier_stiffness, gaps,
            gap_rates, offset, offset_rates, half_play, work, marked, seen,
        )  # fmt: skip
        values[s, TRANSMISSION_ERROR] = (seen[1] - seen[0]) / length
        values[s, RING_FORCE] = seen[2]
        values[s, RIPPLE] = seen[4] - seen[3]
        loaded = seen[5]
        if stopped < 0:
            stopped = _follow(
                some, solved, halved, 0.5 * torque / length, scale_stiffness, rows, rates,
                coefficient, crank_angle, teeth, codes, logarithms, series, cam, carrier_stiffness,
                gaps, gap_rates, offset, offset_rates, half_play, work, marked, seen,
            )  # fmt: skip
            values[s, STIFFNESS] = 0.5 * torque * length / (loaded - seen[5])
        if stopped < 0:
            apart = np.empty((count, discs, pins, 2))
            own = np.empty((count, discs))
            for a in range(count):
                back = -crank_angle[a] / lobe_count
                cosine, sine = math.cos(back), math.sin(back)
                for d in range(discs):
                    own[a, d] = crank_angle[a] + phases[d]
                    for j in range(pins):
                        x = hole_position[s, d, j, 0] - pin_position[s, j, 0]
                        y = hole_position[s, d, j, 1] - pin_position[s, j, 1]
                        apart[a, d, j, 0] = cosine * x - sine * y
                        apart[a, d, j, 1] = sine * x + cosine * y
            least, greatest = np.empty(some.size), np.empty(some.size)
            overlap, poses = np.empty(some.size), np.empty((some.size, size))
            at = backlash_sweep(
                rows, gaps, curvature, tooth_centre, own, pin_angle, apart, offset, half_play,
                eccentricity, length, some, crank_angle, -1.0, free_poses[0],
                least, overlap, poses,
            )  # fmt: skip
            if at < 0:
                at = backlash_sweep(
                    rows, gaps, curvature, tooth_centre, own, pin_angle, apart, offset,
                    half_play, eccentricity, length, some, crank_angle, 1.0, free_poses[1],
                    greatest, overlap, poses,
                )  # fmt: skip
            free = 0.0
            for b in range(some.size):
                if overlap[b] <= OVERLAP:
                    free += max(greatest[b] - least[b], 0.0)
            values[s, BACKLASH] = free / some.size
            if at >= 0:
                stopped = some[at]
        failed[s] = stopped
