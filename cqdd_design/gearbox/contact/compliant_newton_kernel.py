"""Compiled equilibrium of one state of contacts with bodies that yield, plate and cap apart.

Newton's method on :mod:`.compliant_kernel`'s system, and the roads to a state from that of held
plates and rigid bodies: compliance and the cap's part are raised from nothing, where the state is
known; where that jams on its way, friction is raised at full compliance.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import put, put_rows
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.compliant_apart_kernel import assemble_apart, eliminate_apart
from cqdd_design.gearbox.contact.compliant_kernel import (
    assemble,
    change_approach,
    discs_meet,
    eliminate,
    find_pushes,
    press,
)
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, NOT_CONVERGED
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Contacts,
    Forces,
    Load,
    Rubbing,
    Springs,
    YieldingWork,
)
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force

_STEPS = 60
_HALVINGS = 12
_GOOD = 1e-11
_NEARLY = 1e-2
EXACTLY, DRAWN = 3e-9, 1e-6
"""Square of a step, in shares of the greatest force, below which forces follow in first order: a
line contact's own curve, F^0.9, leaves a twentieth of it. The latter for gearboxes that are drawn
from tolerances, of which 5e-8 of a force is more than anyone reads."""
_UNLOADED = 1e-12
"""Approach, m, whose force is next to none: without load parts that touch nothing have no force
that others could be held against."""
_LEAST_RISE = 2.0**-8
"""Share of the compliance below which no further rise is tried: the machine jams."""
RIDGES = (1e-10, 1e-6, 1e-5, 1e-4)
"""Stiffness added to every displacement in a step, in typical stiffnesses; the greater ones hold a
disc that hangs slack."""


@part(borrows=True, forceinline=True)
def _lacking(work: YieldingWork, stiffness: float) -> tuple[float, float]:
    """Greatest force that is lacking, closings by their stiffness, and the sum of squares."""
    gradient, lack = work.gradient, work.lack
    most, square = 0.0, 0.0
    for i in range(gradient.size):
        most = max(most, abs(gradient[i]))
        square += gradient[i] * gradient[i]
    discs, count = lack.shape
    for d in range(discs):
        for k in range(count):
            force = stiffness * lack[d, k]
            most = max(most, abs(force))
            square += force * force
    return most, square


@part(borrows=True, forceinline=True)
def _within_first_order(
    contacts: Contacts, springs: Springs, u: Any, approach: Any, work: YieldingWork, most: float
) -> bool:
    """Whether the step opens and closes no contact, and its square changes a force by `most`."""
    change, stiff, step = work.change, work.stiff, work.step
    offset, half_play = contacts.offset, contacts.half_play
    discs, count = approach.shape
    for d in range(discs):
        for k in range(count):
            a, moved = approach[d, k], change[d, k]
            if a <= 0.0:
                if a + moved > 0.0:
                    return False
            elif stiff[d, k] * moved * moved > most * a or a + moved <= 0.0:
                return False
        i = 4 + 3 * d
        rx, ry = u[i] - offset[d, 0], u[i + 1] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        moved = step[i] * step[i] + step[i + 1] * step[i + 1]
        if over > 0.0:
            f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
            if (s / over + f / (rho * over)) * moved > 0.1 * most:
                return False
        elif math.sqrt(moved) >= -over:
            return False
    return True


@part(borrows=True, forceinline=True)
def _take_step(
    contacts: Contacts, springs: Springs, u: Any, approach: Any, forces: Forces, work: YieldingWork
) -> None:
    """Move the state by the step and the forces by their stiffness times it."""
    step, change, stiff = work.step, work.change, work.stiff
    offset, half_play, force, cam = contacts.offset, contacts.half_play, forces.contact, forces.cam
    discs, count = approach.shape
    for d in range(discs):
        for k in range(count):
            if force[d, k] > 0.0:
                force[d, k] = max(force[d, k] + stiff[d, k] * change[d, k], 0.0)
            approach[d, k] += change[d, k]
        i = 4 + 3 * d
        rx = u[i] - offset[d, 0]
        ry = u[i + 1] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        if over > 0.0 and rho > 0.0:
            f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
            ux, uy, across = rx / rho, ry / rho, f / rho
            along, sideways = ux * step[i] + uy * step[i + 1], -uy * step[i] + ux * step[i + 1]
            cam[d, 0] -= s * along * ux - across * sideways * uy
            cam[d, 1] -= s * along * uy + across * sideways * ux
        elif over >= 0.0 and springs.cam_exponent == 1.0:
            cam[d, 0] -= springs.cam_stiffness * step[i]
            cam[d, 1] -= springs.cam_stiffness * step[i + 1]
    for i in range(u.size):
        u[i] += step[i]


@part(borrows=True)
def solve_yielding(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
    held: float,
    curve: float,
) -> tuple[int, int, float]:
    """Find the equilibrium near `u` and `approach`, and into them.

    Returns are those of :func:`.equilibrium_kernel.solve_state`; `held` is one of `RIDGES`, and
    `curve` is `EXACTLY` or `DRAWN`.
    """
    ridge = held * load.scale_stiffness
    torsional, previous = 0.0, np.inf
    trial, trial_approach, step, change = work.trial, work.trial_approach, work.step, work.change
    pull, size = load.pull, u.size
    fixed = 2 if springs.carrier_stiffness <= 0.0 else 0
    discs, count = approach.shape
    find_pushes(contacts, rubbing, work)
    put(trial, u)
    put_rows(trial_approach, approach)
    before, share, halved, iteration = np.inf, 1.0, 0, 0
    while True:
        largest = press(contacts, springs, pull, compliance, trial, trial_approach, forces, work)
        residual, square = _lacking(work, load.scale_stiffness)
        if not (square < before) and halved < _HALVINGS:
            if before == np.inf:
                return NOT_CONVERGED, iteration, torsional
            share *= 0.5
            halved += 1
        else:
            for i in range(size):
                u[i] = trial[i]
            for d in range(discs):
                for k in range(count):
                    approach[d, k] = trial_approach[d, k]
            if iteration == _STEPS or not math.isfinite(square):
                return NOT_CONVERGED, iteration, torsional
            scale = max(abs(pull), largest, _UNLOADED * load.scale_stiffness)
            if discs_meet(work.touching, work.first, springs.teeth):
                assemble(contacts, springs, compliance, u, ridge, work)
                torsional = eliminate(work, fixed)
            else:
                assemble_apart(contacts, springs, compliance, u, ridge, work)
                torsional = eliminate_apart(work, fixed)
            change_approach(contacts, springs.teeth, compliance, work)
            stuck = iteration > 3 and residual >= 0.25 * previous and residual <= 1e-7 * scale
            # As with held plates, the last step is taken on the forces too, in first order.
            if (
                stuck
                or residual <= _GOOD * scale
                or (
                    residual <= _NEARLY * scale
                    and _within_first_order(contacts, springs, u, approach, work, curve * scale)
                )
            ):
                _take_step(contacts, springs, u, approach, forces, work)
                return CONVERGED, iteration, torsional
            previous, before, share, halved = residual, square, 1.0, 0
            iteration += 1
        for i in range(size):
            trial[i] = u[i] + share * step[i]
        for d in range(discs):
            for k in range(count):
                trial_approach[d, k] = approach[d, k] + share * change[d, k]


@part()
def _some(compliance: Compliance, held: Any, share: float) -> Compliance:
    """Compliance with a share of what held plates and rigid bodies do not have."""
    pins = share * compliance.pins
    for d in range(held.size):
        pins[d, d] += (1.0 - share) * held[d]
    return Compliance(pins, share * compliance.at_cap, compliance.join, share * compliance.bodies)


@part(borrows=True)
def _from_held(contacts: Contacts, springs: Springs, start: Any, u: Any, approach: Any) -> None:
    """Motions and approaches of the state `start` (3 + 3 D,) of held plates and rigid bodies."""
    rows, gaps, coefficient = contacts.rows, contacts.gaps, contacts.coefficient
    teeth, series = springs.teeth, springs.pin_series
    put(u, start[:3])
    put(u[3:], start[2:])
    discs, count = gaps.shape
    for d in range(discs):
        i = 3 + 3 * d
        x, y, t = start[i], start[i + 1], start[i + 2]
        for k in range(count):
            if k == teeth:
                x, y, t = x - start[0], y - start[1], t - start[2]
            closed = -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t) - gaps[d, k]
            if k >= teeth and closed > 0.0:
                f, _ = line_force(
                    springs.pin_law, coefficient[d, k], springs.pin_logarithm, series[d], closed
                )
                closed -= series[d] * f
            approach[d, k] = closed


@part()
def _raise(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    of_friction: bool,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
    held: float,
) -> tuple[int, int, float]:
    """Follow the state in `u` and `approach` while friction, or else compliance, rises to all."""
    reached, rise, steps, torsional = 0.0, 1.0, 0, 0.0
    known, known_approach = u.copy(), approach.copy()
    rubs, some = rubbing, compliance
    while reached < 1.0:
        share = min(reached + rise, 1.0)
        if of_friction:
            rubs = Rubbing(share * rubbing.share, rubbing.disc_arm, rubbing.carrier_arm)
        else:
            some = _some(compliance, springs.pin_series, share)
        put(u, known)
        put_rows(approach, known_approach)
        status, used, torsional = solve_yielding(
            contacts, springs, load, rubs, some, u, approach, forces, work, held, EXACTLY
        )
        steps += used
        if status == CONVERGED:
            put(known, u)
            put_rows(known_approach, approach)
            reached = share
            continue
        rise *= 0.5
        if rise < _LEAST_RISE:
            return NOT_CONVERGED, steps, torsional
    return CONVERGED, steps, torsional


@part()
def solve_yielding_raised(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    start: Any,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
    held: float,
) -> tuple[int, int, float]:
    """Solve one state by raising compliance from the state `start` without it.

    A start without friction, where there is some, is put right at the first share.
    """
    _from_held(contacts, springs, start, u, approach)
    return _raise(
        contacts, springs, load, rubbing, compliance, False, u, approach, forces, work, held
    )


@part()
def solve_yielding_rubbed(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    start: Any,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
    held: float,
) -> tuple[int, int, float]:
    """Solve one state by raising friction from the state with all compliance and none of it.

    For where that jams on its way; arguments and returns are those of
    :func:`solve_yielding_raised`.
    """
    none = Rubbing(np.zeros_like(rubbing.share), rubbing.disc_arm, rubbing.carrier_arm)
    status, steps, torsional = solve_yielding_raised(
        contacts, springs, load, none, compliance, start, u, approach, forces, work, held
    )
    if status != CONVERGED:
        return status, steps, torsional
    status, more, torsional = _raise(
        contacts, springs, load, rubbing, compliance, True, u, approach, forces, work, held
    )
    return status, steps + more, torsional


@part()
def solve_yielding_from(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    compliance: Compliance,
    start: Any,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
) -> tuple[int, int, float]:
    """Solve one state from `start`, of held plates and rigid bodies, by every road there is.

    Returns are those of :func:`solve_yielding`.
    """
    status, used, left = NOT_CONVERGED, 0, 0.0
    for held in RIDGES:
        if status != CONVERGED:
            status, used, left = solve_yielding_raised(
                contacts, springs, load, rubbing, compliance, start, u, approach, forces, work, held
            )
    for held in RIDGES:
        if status != CONVERGED:
            status, used, left = solve_yielding_rubbed(
                contacts, springs, load, rubbing, compliance, start, u, approach, forces, work, held
            )
    return status, used, left
