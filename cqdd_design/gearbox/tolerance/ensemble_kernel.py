"""Compiled kernel that solves one toleranced gearbox; it lets other threads work on theirs.

Each gearbox is worked alone and in the same order of operations, so its numbers do not depend on
the number of threads. Memory is one gearbox's arrays a thread.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import put_rows
from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.gaps_kernel import fill_errors
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Extremes,
    Forces,
    Load,
    Nominal,
    RigidParts,
    Rubbing,
    Shared,
    Springs,
    Start,
    Toleranced,
    YieldingResult,
)
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.precision.backlash_kernel import CLOSED, OVERLAP, backlash_sweep
from cqdd_design.gearbox.tolerance.following_kernel import follow, room, turns_between

BACKLASH, TRANSMISSION_ERROR, RING_FORCE, STIFFNESS, RIPPLE = range(5)
PRESSURE, CAM_LOAD, PRELOAD, IDLE_TORQUE = range(5, 9)
RESULTS = 9
LOADS_ALONE, RANKED_ALONE, FREEDOM_ALONE, EVERYTHING = range(4)
"""How much of a gearbox is asked: its greatest loads; those with backlash and ripple; what it has
without load; all."""
_NEXT_TO_NOTHING = 1e-3
"""Load of a gearbox without load, over the torque: what hangs loose then has its place."""


@part(borrows=True)
def _slope(
    nominal: Nominal,
    found: Toleranced,
    compliance: Compliance,
    a: int,
    teeth: int,
    state: Any,
    forces: Forces,
) -> float:
    """dPi/dphi of one state: forces times the rates of closing at held motions, N m.

    A contact closes at the rate -(n' r + h' t) - gap', and a softer one stores less:
    dU/dc = -F^2/2 at a held closing, which `rates[..., 3]` takes part in.
    """
    rows, rates, gap_rates = nominal.rows[a], nominal.rates[a], found.gap_rates[a]
    force, cam_force, offset_rates = forces.contact, forces.cam, found.offset_rates[a]
    discs, contacts = force.shape
    slope = 0.0
    for d in range(discs):
        x, y, t = state[4 + 3 * d], state[5 + 3 * d], state[6 + 3 * d]
        for k in range(contacts):
            if k == teeth:
                x -= state[0]
                y -= state[1]
                t -= state[2] + compliance.at_cap[d] * (state[3] - state[2])
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


@part()
def _crank_torques(
    nominal: Nominal,
    found: Toleranced,
    shared: Shared,
    rubbing: Rubbing,
    sense: float,
    teeth: int,
    chosen: Any,
    result: YieldingResult,
) -> Any:
    """What the crank bears beyond T/n: the contacts' slope and, in its sense, friction's work."""
    torques = np.empty(chosen.size)
    for b in range(chosen.size):
        a = chosen[b]
        forces = Forces(result.force[b], result.cam_force[b])
        slope = _slope(nominal, found, shared.compliance, a, teeth, result.states[b], forces)
        share, slip = rubbing.share[a], shared.worn.slip[a]
        work = 0.0
        for d in range(share.shape[0]):
            for k in range(share.shape[1]):
                work += abs(share[d, k]) * result.force[b, d, k] * slip[d, k]
        torques[b] = slope + sense * work
    return torques


@part()
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
                apart[a, d, j, 0] = cosine * x - sine * y - errors.output_axis[0]
                apart[a, d, j, 1] = sine * x + cosine * y - errors.output_axis[1]
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


@part()
def _loaded(
    nominal: Nominal,
    found: Toleranced,
    springs: Springs,
    load: Load,
    start: Start,
    shared: Shared,
    some: Any,
    result: YieldingResult,
) -> int:
    """Equilibria under the torque at `some` angles into `result`; -1, or a failing angle."""
    discs, contacts = nominal.gaps.shape[1:]
    return int(
        follow(
            nominal,
            found,
            springs,
            load,
            shared.rubbing,
            shared.compliance,
            (some, turns_between(nominal, some)),
            room(0, discs, contacts),
            start.perfect,
            result,
        )
    )


@part()
def _greatest(teeth: int, shared: Shared, whole: YieldingResult, values: Any) -> None:
    """Greatest loads of the equilibria under the torque."""
    count, discs, _ = whole.force.shape
    most, pressed, borne = 0.0, 0.0, 0.0
    for a in range(count):
        for d in range(discs):
            for k in range(teeth):
                force = whole.force[a, d, k]
                most = max(most, force)
                pressed = max(pressed, force * shared.worn.pressing[a, d, k])
            x, y = whole.cam_force[a, d, 0], whole.cam_force[a, d, 1]
            borne = max(borne, x * x + y * y)
    values[RING_FORCE] = most
    values[PRESSURE] = math.sqrt(pressed)
    values[CAM_LOAD] = math.sqrt(borne)


@part()
def _swing(
    nominal: Nominal,
    found: Toleranced,
    shared: Shared,
    teeth: int,
    whole: YieldingResult,
    values: Any,
) -> None:
    """Transmission error and ripple of the equilibria under the torque."""
    turned = whole.states[:, 2]
    values[TRANSMISSION_ERROR] = (turned.max() - turned.min()) / nominal.length
    torques = _crank_torques(
        nominal,
        found,
        shared,
        shared.rubbing,
        shared.worn.crank_sense,
        teeth,
        np.arange(turned.size),
        whole,
    )
    values[RIPPLE] = torques.max() - torques.min()


@part()
def _windup(
    nominal: Nominal,
    found: Toleranced,
    springs: Springs,
    load: Load,
    start: Start,
    shared: Shared,
    whole: YieldingResult,
    values: Any,
) -> int:
    """Stiffness between half of the torque and all of it; -1, or a failing angle."""
    count, discs, contacts = nominal.gaps.shape
    length, some = nominal.length, np.flatnonzero(start.marked)[start.thinned]
    half = Load(0.5 * start.torque / length, load.scale_stiffness)
    eased = room(some.size, discs, contacts)
    base = np.empty((count, 3 + 3 * discs))
    put_rows(base, whole.states[:, :3])
    put_rows(base[:, 3:], whole.states[:, 4:])
    stopped = follow(
        nominal,
        found,
        springs,
        half,
        shared.rubbing,
        shared.compliance,
        (some, turns_between(nominal, some)),
        whole,
        base,
        eased,
    )
    if stopped >= 0:
        return int(stopped)
    # The secant between half of the torque and all of it, (T - T/2)/(gamma - gamma_half).
    apart = (whole.states[:, 2][some] - eased.states[:, 2]).mean()
    values[STIFFNESS] = 0.5 * start.torque * length / apart
    return -1


@part()
def _unloaded(
    nominal: Nominal,
    found: Toleranced,
    springs: Springs,
    load: Load,
    shared: Shared,
    some: Any,
    values: Any,
) -> int:
    """Forces of a gearbox without load at the angles that are tight, and what turns the crank.

    Friction is laid over them: without load nothing says which way parts that hang loose slide.
    """
    discs, contacts = nominal.gaps.shape[1:]
    idle = room(some.size, discs, contacts)
    stopped = follow(
        nominal,
        found,
        springs,
        Load(_NEXT_TO_NOTHING * load.pull, load.scale_stiffness),
        shared.smooth,
        shared.idle,
        (some, turns_between(nominal, some)),
        room(0, discs, contacts),
        np.zeros((nominal.gaps.shape[0], 3 + 3 * discs)),
        idle,
    )
    if stopped >= 0:
        return int(stopped)
    values[PRELOAD] = idle.force.max()
    values[IDLE_TORQUE] = _crank_torques(
        nominal, found, shared, shared.rubbing, 1.0, springs.teeth, some, idle
    ).max()
    return -1


@part()
def _with_errors(nominal: Nominal, errors: GearboxErrors) -> Toleranced:
    """What the errors of one gearbox make of the perfect one."""
    count, discs, contacts = nominal.gaps.shape
    found = Toleranced(
        np.empty((count, discs, contacts)),
        np.empty((count, discs, contacts)),
        np.empty((count, discs, 2)),
        np.empty((count, discs, 2)),
        np.empty(discs),
    )
    fill_errors(nominal, errors, found)
    return found


@part()
def _turned(parts: RigidParts, some: Any, sense: float, start: Start, ends: Any, tight: Any) -> int:
    """How far the output turns by next to nothing, and at which angles parts are `tight`.

    -1, or a failing angle.
    """
    found = Extremes(ends, np.empty(some.size), np.empty((some.size, start.free_poses.shape[2])))
    poses = start.free_poses[1 if sense > 0.0 else 0]
    at = backlash_sweep(parts, some, sense, poses, found)
    if at >= 0:
        return int(some[at])
    for b in range(some.size):
        tight[b] = found.preload[b] > OVERLAP
    return -1


@part()
def _free(parts: RigidParts, some: Any, start: Start, tight: Any, values: Any) -> int:
    """Backlash, and which of `some` angles are `tight`; -1, or a failing angle."""
    thinned = np.flatnonzero(start.thinned)
    count = thinned.size
    least, most = np.empty(count), np.empty(some.size)
    stopped = _turned(parts, some[thinned], -1.0, start, least, np.empty(count, dtype=np.bool_))
    if stopped < 0:
        stopped = _turned(parts, some, 1.0, start, most, tight)
    if stopped >= 0:
        return int(stopped)
    free = 0.0
    for b in range(count):
        width = most[thinned[b]] - least[b]
        # Pressed from both sides there is none.
        if not (tight[thinned[b]] and width <= CLOSED / parts.length):
            free += max(width, 0.0)
    values[BACKLASH] = free / count
    return -1


@numba.njit(cache=True, error_model="numpy", nogil=True)
def solve_gearbox(
    nominal: Nominal,
    springs: Springs,
    load: Load,
    start: Start,
    shared: Shared,
    errors: GearboxErrors,
    asked: int,
    values: Any,
) -> int:
    """What one gearbox shows, with friction and with the carrier joined as it is built.

    Parameters
    ----------
    nominal, springs, load, start, shared
        What all gearboxes of an ensemble have in common.
    asked : int
        `EVERYTHING`, or less in less time: `LOADS_ALONE` leaves all but `RING_FORCE`, `PRESSURE`
        and `CAM_LOAD`, `RANKED_ALONE` leaves `STIFFNESS`, `PRELOAD` and `IDLE_TORQUE`. What is
        found is the same to the bit. `FREEDOM_ALONE` finds `PRELOAD` and `IDLE_TORQUE`, and asks
        those of the marked angles alone for an equilibrium under load at which parts are tight.
    values : array (9,)
        Out, in SI, in the order of the module's names: backlash and transmission error in rad,
        ripple and idle torque at the crank.

    Returns
    -------
    int
        -1, or the angle that has no equilibrium.
    """
    found, some = _with_errors(nominal, errors), np.flatnonzero(start.marked)
    count, discs, contacts = nominal.gaps.shape
    tight = np.zeros(some.size, dtype=np.bool_)
    if asked == FREEDOM_ALONE:
        parts = _rigid_parts(nominal, found, errors)
        stopped = _turned(parts, some, 1.0, start, np.empty(some.size), tight)
        solved = some[tight]
    else:
        stopped, solved = -1, np.arange(count)
    if stopped >= 0:
        return stopped
    whole = room(solved.size, discs, contacts)
    stopped = _loaded(nominal, found, springs, load, start, shared, solved, whole)
    if stopped >= 0:
        return stopped
    if asked != FREEDOM_ALONE:
        _greatest(springs.teeth, shared, whole, values)
        if asked == LOADS_ALONE:
            return -1
        _swing(nominal, found, shared, springs.teeth, whole, values)
        if asked == EVERYTHING:
            stopped = _windup(nominal, found, springs, load, start, shared, whole, values)
            if stopped >= 0:
                return stopped
        parts = _rigid_parts(nominal, found, errors)
        stopped = _free(parts, some, start, tight, values)
        if stopped >= 0 or asked == RANKED_ALONE:
            return stopped
    values[PRELOAD] = values[IDLE_TORQUE] = 0.0
    if np.any(tight):
        return _unloaded(nominal, found, springs, load, shared, some[tight], values)
    return -1
