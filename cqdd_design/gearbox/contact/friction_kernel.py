"""Compiled equilibrium of the contacts with Coulomb friction at ring teeth and output pins.

Every contact slides in a direction that the kinematics gives (:mod:`.rubbing`), so that its force
is f (n + m t), t the normal n turned a quarter turn counter-clockwise and m known. It closes along
n and pushes along n + m t: the matrix is not symmetric, and no energy exists whose minimum would be
the equilibrium. Newton's method therefore starts near it, at the neighbouring angle or at the state
without friction, and lowers the residual; where that fails, :mod:`.friction_sweep_kernel` raises
friction in steps.

A plain numpy twin stands in ``tests/oracles/contact_friction_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import greatest, sum_of_squares
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.equilibrium_kernel import (
    CONVERGED,
    NOT_CONVERGED,
    new_work,
    rounding,
    take_step,
    within_first_order,
)
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Forces,
    Load,
    Rubbing,
    RubbingWork,
    Springs,
)
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force

_STEPS, _HELD_STEPS = 60, 240
"""Newton steps before a state is given up: plain ones, and where slack discs are held."""
_HALVINGS = 12
_GOOD = 1e-11
_NEARLY = 1e-6
RIDGES = (1e-10, 1e-6, 1e-5, 1e-4)
"""Stiffness that is added to every displacement in a step, in typical stiffnesses. The least one
leaves Newton's method as it is; the others hold a disc that hangs slack between tooth and pin,
which friction may wedge in more places than one."""


@part()
def rubbing_work(discs: int, contacts: int) -> RubbingWork:
    """Scratch for states of D discs with C contacts each."""
    size = 3 + 3 * discs
    return RubbingWork(new_work(discs, contacts), np.empty((size, size)), np.empty(size))


@part(borrows=True, forceinline=True)
def _press(
    contacts: Contacts,
    rubbing: Rubbing,
    forces: Forces,
    work: RubbingWork,
    which: Any,
    displacement: Any,
    law: Any,
) -> Any:
    """Some contacts of a disc: forces on the disc, and their derivatives over its displacement.

    Returned are the largest force; force x, y and moment on the disc, and moment about the ring's
    centre; and, row by row for these four, what they lose per unit of x, y and angle.
    """
    rows, gaps, coefficient = contacts.rows, contacts.gaps, contacts.coefficient
    force, stiff, closed = forces.contact, work.work.stiff, work.work.closed
    rubs, disc_arm, carrier_arm = rubbing.share, rubbing.disc_arm, rubbing.carrier_arm
    d, first, last = which
    x, y, t = displacement
    code, logarithm, series = law
    largest = px = py = pt = pc = 0.0
    xx = xy = xt = yx = yy = yt = tx = ty = tt = cx = cy = ct = 0.0
    for k in range(first, last):
        nx, ny, h = rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
        delta = -(nx * x + ny * y + h * t) - gaps[d, k]
        closed[d, k] = delta
        if delta <= 0.0:
            force[d, k] = 0.0
            stiff[d, k] = 0.0
            continue
        f, s = line_force(code, coefficient[d, k], logarithm, series, delta)
        force[d, k] = f
        stiff[d, k] = s
        largest = max(largest, f)
        m = rubs[d, k]
        bx, by = nx - m * ny, ny + m * nx
        bt, bc = h + m * disc_arm[d, k], h + m * carrier_arm[d, k]
        px += f * bx
        py += f * by
        pt += f * bt
        pc += f * bc
        sx, sy, st = s * nx, s * ny, s * h
        xx += bx * sx
        xy += bx * sy
        xt += bx * st
        yx += by * sx
        yy += by * sy
        yt += by * st
        tx += bt * sx
        ty += bt * sy
        tt += bt * st
        cx += bc * sx
        cy += bc * sy
        ct += bc * st
    on_disc = (xx, xy, xt, yx, yy, yt, tx, ty, tt)
    return largest, (px, py, pt, pc), on_disc, (cx, cy, ct)


@part(borrows=True, forceinline=True)
def _add(matrix: Any, i: int, j: int, sign: float, block: Any) -> None:
    """Add a 3x3 block, row by row, at row i and column j."""
    xx, xy, xt, yx, yy, yt, tx, ty, tt = block
    matrix[i, j] += sign * xx
    matrix[i, j + 1] += sign * xy
    matrix[i, j + 2] += sign * xt
    matrix[i + 1, j] += sign * yx
    matrix[i + 1, j + 1] += sign * yy
    matrix[i + 1, j + 2] += sign * yt
    matrix[i + 2, j] += sign * tx
    matrix[i + 2, j + 1] += sign * ty
    matrix[i + 2, j + 2] += sign * tt


@part(borrows=True)
def evaluate_rubbed(
    contacts: Contacts,
    springs: Springs,
    pull: float,
    rubbing: Rubbing,
    state: Any,
    forces: Forces,
    work: RubbingWork,
) -> float:
    """Forces, residual (into `work.work.gradient`) and matrix; returns the largest force.

    The residual is what the forces on a body lack, with the sign of an energy's gradient.
    """
    discs, count = contacts.gaps.shape
    offset, half_play, series = contacts.offset, contacts.half_play, springs.pin_series
    cam, teeth, gradient, matrix = forces.cam, springs.teeth, work.work.gradient, work.matrix
    bed = springs.carrier_stiffness
    matrix[:] = 0.0
    matrix[0, 0] = bed
    matrix[1, 1] = bed
    gradient[0] = bed * state[0]
    gradient[1] = bed * state[1]
    gradient[2] = -pull
    largest = 0.0
    for d in range(discs):
        i = 3 + 3 * d
        x, y, t = state[i], state[i + 1], state[i + 2]
        ring = (springs.ring_law, springs.ring_logarithm, 0.0)
        on_ring, (px, py, pt, _), block, _ = _press(
            contacts, rubbing, forces, work, (d, 0, teeth), (x, y, t), ring
        )
        _add(matrix, i, i, 1.0, block)
        pins = (springs.pin_law, springs.pin_logarithm, series[d])
        away = (x - state[0], y - state[1], t - state[2])
        on_pins, (qx, qy, qt, qc), shared, (cx, cy, ct) = _press(
            contacts, rubbing, forces, work, (d, teeth, count), away, pins
        )
        largest = max(largest, on_ring, on_pins)
        # Friction has one arm about the disc's centre and another about the carrier's.
        xx, xy, xt, yx, yy, yt, _, _, _ = shared
        carried = (xx, xy, xt, yx, yy, yt, cx, cy, ct)
        _add(matrix, i, i, 1.0, shared)
        _add(matrix, i, 0, -1.0, shared)
        _add(matrix, 0, i, -1.0, carried)
        _add(matrix, 0, 0, 1.0, carried)
        gradient[0] += qx
        gradient[1] += qy
        gradient[2] += qc
        gradient[i] = -px - qx
        gradient[i + 1] = -py - qy
        gradient[i + 2] = -pt - qt
        rx = x - offset[d, 0]
        ry = y - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        cam[d, 0] = 0.0
        cam[d, 1] = 0.0
        if over > 0.0 and rho > 0.0:
            f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
            largest = max(largest, f)
            ux, uy, across = rx / rho, ry / rho, f / rho
            cam[d, 0] = -f * ux
            cam[d, 1] = -f * uy
            gradient[i] += f * ux
            gradient[i + 1] += f * uy
            matrix[i, i] += s * ux * ux + across * uy * uy
            matrix[i, i + 1] += (s - across) * ux * uy
            matrix[i + 1, i] += (s - across) * ux * uy
            matrix[i + 1, i + 1] += s * uy * uy + across * ux * ux
        elif over >= 0.0 and springs.cam_exponent == 1.0:
            matrix[i, i] += springs.cam_stiffness
            matrix[i + 1, i + 1] += springs.cam_stiffness
    if bed <= 0.0:
        # A rigid bearing takes whatever force there is, and the carrier's centre stays.
        matrix[:2, :] = 0.0
        matrix[:, :2] = 0.0
        matrix[0, 0] = 1.0
        matrix[1, 1] = 1.0
        gradient[0] = 0.0
        gradient[1] = 0.0
    return largest


@part(borrows=True)
def rubbed_step(work: RubbingWork, ridge: float) -> float:
    """Newton step into `work.work.step`; returns the torsional stiffness at the carrier.

    Gauss's elimination with row pivots of the residual, and of a unit torque beside it.
    """
    matrix, step, unit, gradient = work.matrix, work.work.step, work.unit, work.work.gradient
    size = step.size
    for i in range(size):
        matrix[i, i] += ridge
        step[i] = -gradient[i]
        unit[i] = 0.0
    unit[2] = 1.0
    for i in range(size):
        pivot = i
        for j in range(i + 1, size):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        if pivot != i:
            for k in range(i, size):
                matrix[i, k], matrix[pivot, k] = matrix[pivot, k], matrix[i, k]
            step[i], step[pivot] = step[pivot], step[i]
            unit[i], unit[pivot] = unit[pivot], unit[i]
        for j in range(i + 1, size):
            if matrix[j, i] != 0.0:
                share = matrix[j, i] / matrix[i, i]
                for k in range(i + 1, size):
                    matrix[j, k] -= share * matrix[i, k]
                step[j] -= share * step[i]
                unit[j] -= share * unit[i]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            step[i] -= matrix[i, k] * step[k]
            unit[i] -= matrix[i, k] * unit[k]
        step[i] /= matrix[i, i]
        unit[i] /= matrix[i, i]
    return 1.0 / float(unit[2])


@part(borrows=True)
def solve_rubbed(
    contacts: Contacts,
    springs: Springs,
    load: Load,
    rubbing: Rubbing,
    state: Any,
    forces: Forces,
    scratch: RubbingWork,
    held: float,
) -> tuple[int, int, float]:
    """Find the equilibrium with friction near `state`, and into it.

    Arguments and returns are those of :func:`.equilibrium_kernel.solve_state`, with the friction;
    `held` is one of `RIDGES`.
    """
    work = scratch.work
    gradient, step, trial = work.gradient, work.step, work.trial
    ridge = held * load.scale_stiffness
    torsional, previous = 0.0, np.inf
    largest = evaluate_rubbed(contacts, springs, load.pull, rubbing, state, forces, scratch)
    most = _STEPS if held == RIDGES[0] else _HELD_STEPS
    for iteration in range(most):
        residual = greatest(gradient)
        square = sum_of_squares(gradient)
        if not math.isfinite(square):
            break
        scale = max(abs(load.pull), largest)
        torsional = rubbed_step(scratch, ridge)
        stuck = (
            iteration > 3
            and residual >= 0.25 * previous
            and residual <= max(1e-7 * scale, rounding(work.stiff, state))
        )
        if residual <= _NEARLY * scale or stuck:
            # As without friction, the last step is taken on the forces too, in first order.
            first_order = within_first_order(contacts, springs.teeth, work, scale)
            if stuck or residual <= _GOOD * scale or first_order:
                take_step(contacts, springs, state, forces, work)
                return CONVERGED, iteration, torsional
        previous = residual
        share = 1.0
        for _ in range(_HALVINGS):
            for i in range(state.size):
                trial[i] = state[i] + share * step[i]
            largest = evaluate_rubbed(contacts, springs, load.pull, rubbing, trial, forces, scratch)
            if sum_of_squares(gradient) < square:
                break
            share *= 0.5
        for i in range(state.size):
            state[i] = trial[i]
    return NOT_CONVERGED, most, torsional
