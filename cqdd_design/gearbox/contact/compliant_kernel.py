"""Compiled: the contacts in series with bodies that yield, plate and cap apart; one Newton step.

Unknown are the rigid motions u (carrier X and Y, turn of the plate and of the cap, every disc) and
the approach a of every contact, which is negative where it is open and gives its force f(a) by the
contact's own law. With B the closings and P the pushes of the contacts (P is B without friction),
W what bodies yield under the forces, and the springs of cams, carrier and pins in K::

    a + W f(a) = B u - gap          of every contact
    P' f(a) + K u = load            of every body

Newton's method takes both at once: the contacts that touch are eliminated from
[1/f' + W, -B; P', K], which leaves the motions alone. Where no pin is pushed by two discs,
:mod:`.compliant_apart_kernel` does that in less time; :mod:`.compliant_newton_kernel` solves.
A plain numpy twin stands in ``tests/oracles/contact_carrier_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Contacts,
    Forces,
    Rubbing,
    Springs,
    YieldingWork,
)
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force


@part()
def yielding_work(discs: int, contacts: int) -> YieldingWork:
    """Scratch for states of D discs with C contacts each."""
    size, forces = 4 + 3 * discs, discs * contacts
    return YieldingWork(
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty((discs, contacts)),
        np.empty((discs, contacts)),
        np.empty((discs, contacts)),
        np.empty((discs, contacts)),
        np.empty((discs, contacts)),
        np.empty((discs, contacts, 4)),
        np.empty((discs, contacts), dtype=np.int64),
        np.empty(discs + 1, dtype=np.int64),
        np.empty((forces + size, forces + 1 + size)),
        np.empty((discs, 7 + contacts, 8 + 4 * ((contacts + 3) // 4))),
    )


@part(borrows=True)
def find_pushes(contacts: Contacts, rubbing: Rubbing, work: YieldingWork) -> None:
    """Force and arms of every contact by a unit normal force, friction included."""
    rows, share, push = contacts.rows, rubbing.share, work.push
    disc_arm, carrier_arm = rubbing.disc_arm, rubbing.carrier_arm
    discs, count = share.shape
    for d in range(discs):
        for k in range(count):
            m, nx, ny, h = share[d, k], rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
            push[d, k, 0] = nx - m * ny
            push[d, k, 1] = ny + m * nx
            push[d, k, 2] = h + m * disc_arm[d, k]
            push[d, k, 3] = h + m * carrier_arm[d, k]


@part(borrows=True, forceinline=True)
def _find_yield(
    contacts: Contacts, teeth: int, compliance: Compliance, force: Any, work: YieldingWork
) -> None:
    """What the bodies yield at every contact under `force`, into `work.yielded`."""
    rows, pins, bodies, push = contacts.rows, compliance.pins, compliance.bodies, work.push
    yielded, touching, first = work.yielded, work.touching, work.first
    discs, count = force.shape
    rigid = bodies.shape[0] == 0
    for d in range(discs):
        for c in range(count):
            yielded[d, c] = 0.0
        if rigid:
            continue
        for i in range(first[d + 1] - first[d]):
            k = touching[d, i]
            f = force[d, k]
            for c in range(count):
                yielded[d, c] += bodies[d, k, c] * f
    for e in range(discs):
        for i in range(first[e + 1] - first[e]):
            k = touching[e, i]
            if k >= teeth:
                fx, fy = force[e, k] * push[e, k, 0], force[e, k] * push[e, k, 1]
                for d in range(discs):
                    yielded[d, k] += pins[d, e] * (rows[d, k, 0] * fx + rows[d, k, 1] * fy)


@part(borrows=True, forceinline=True)
def press(
    contacts: Contacts,
    springs: Springs,
    pull: float,
    compliance: Compliance,
    u: Any,
    approach: Any,
    forces: Forces,
    work: YieldingWork,
) -> float:
    """Forces, and what balances (`gradient`) and closings (`lack`) lack; the largest force."""
    rows, gaps, coefficient = contacts.rows, contacts.gaps, contacts.coefficient
    offset, half_play = contacts.offset, contacts.half_play
    force, cam, stiff, push = forces.contact, forces.cam, work.stiff, work.push
    gradient, lack, touching, yielded = work.gradient, work.lack, work.touching, work.yielded
    first, at_cap = work.first, compliance.at_cap
    teeth, bed, join = springs.teeth, springs.carrier_stiffness, compliance.join
    ring_law, ring_logarithm = springs.ring_law, springs.ring_logarithm
    pin_law, pin_logarithm = springs.pin_law, springs.pin_logarithm
    discs, count = gaps.shape
    gradient[0] = bed * u[0]
    gradient[1] = bed * u[1]
    gradient[2] = join * (u[2] - u[3]) - pull
    gradient[3] = join * (u[3] - u[2])
    largest = 0.0
    first[0] = 0
    for d in range(discs):
        px = py = pt = cx = cy = ct = 0.0
        touch = 0
        for k in range(count):
            a = approach[d, k]
            if a <= 0.0:
                force[d, k] = 0.0
                stiff[d, k] = 0.0
                continue
            if k < teeth:
                f, s = line_force(ring_law, coefficient[d, k], ring_logarithm, 0.0, a)
            else:
                f, s = line_force(pin_law, coefficient[d, k], pin_logarithm, 0.0, a)
            force[d, k] = f
            stiff[d, k] = s
            touching[d, touch] = k
            touch += 1
            largest = max(largest, f)
            fx, fy = f * push[d, k, 0], f * push[d, k, 1]
            px += fx
            py += fy
            pt += f * push[d, k, 2]
            if k >= teeth:
                cx += fx
                cy += fy
                ct += f * push[d, k, 3]
        first[d + 1] = first[d] + touch
        i = 4 + 3 * d
        gradient[0] += cx
        gradient[1] += cy
        gradient[2] += (1.0 - at_cap[d]) * ct
        gradient[3] += at_cap[d] * ct
        rx = u[i] - offset[d, 0]
        ry = u[i + 1] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        mx = my = 0.0
        if over > 0.0 and rho > 0.0:
            f, _ = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
            largest = max(largest, f)
            mx, my = -f * rx / rho, -f * ry / rho
        cam[d, 0] = mx
        cam[d, 1] = my
        gradient[i] = -px - mx
        gradient[i + 1] = -py - my
        gradient[i + 2] = -pt
    if bed <= 0.0:
        gradient[0] = 0.0
        gradient[1] = 0.0
    _find_yield(contacts, teeth, compliance, force, work)
    for d in range(discs):
        i = 4 + 3 * d
        x, y, t = u[i], u[i + 1], u[i + 2]
        for k in range(count):
            if k == teeth:
                x, y, t = x - u[0], y - u[1], t - u[2] - at_cap[d] * (u[3] - u[2])
            closed = -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t) - gaps[d, k]
            lack[d, k] = approach[d, k] + yielded[d, k] - closed
    return largest


@part(borrows=True, forceinline=True)
def discs_meet(touching: Any, first: Any, teeth: int) -> bool:
    """Whether any two discs push the same pin; contacts stand in rising order."""
    for e in range(1, first.size - 1):
        for d in range(e):
            i, j = 0, 0
            while i < first[d + 1] - first[d] and j < first[e + 1] - first[e]:
                if touching[d, i] < touching[e, j]:
                    i += 1
                elif touching[d, i] > touching[e, j]:
                    j += 1
                elif touching[d, i] >= teeth:
                    return True
                else:
                    i += 1
                    j += 1
    return False


@part(borrows=True, forceinline=True)
def add_cam(
    contacts: Contacts, springs: Springs, u: Any, d: int, matrix: Any, row: int, column: int
) -> None:
    """Stiffness of a disc's cam bearing, from the disc's first row and column."""
    half_play, i, j = contacts.half_play[d], 4 + 3 * d, row + 1
    rx = u[i] - contacts.offset[d, 0]
    ry = u[i + 1] - contacts.offset[d, 1]
    rho = math.sqrt(rx * rx + ry * ry)
    over = rho - half_play
    if over > 0.0 and rho > 0.0:
        f, s = radial_force(springs.cam_stiffness, springs.cam_exponent, over)
        ux, uy, across = rx / rho, ry / rho, f / rho
        matrix[row, column] += s * ux * ux + across * uy * uy
        matrix[row, column + 1] += (s - across) * ux * uy
        matrix[j, column] += (s - across) * ux * uy
        matrix[j, column + 1] += s * uy * uy + across * ux * ux
    elif over >= 0.0 and springs.cam_exponent == 1.0:
        matrix[row, column] += springs.cam_stiffness
        matrix[j, column + 1] += springs.cam_stiffness


@part(borrows=True, forceinline=True)
def assemble(
    contacts: Contacts,
    springs: Springs,
    compliance: Compliance,
    u: Any,
    ridge: float,
    work: YieldingWork,
) -> None:
    """The system of forces and motions."""
    rows, pins, bodies, push = contacts.rows, compliance.pins, compliance.bodies, work.push
    gradient = work.gradient
    at_cap, touching, matrix, stiff = compliance.at_cap, work.touching, work.matrix, work.stiff
    teeth, bed, join, lack = springs.teeth, springs.carrier_stiffness, compliance.join, work.lack
    first = work.first
    discs = rows.shape[0]
    touch, size = int(first[discs]), 4 + 3 * discs
    total = touch + 1 + size
    right, motion = touch, touch + 1
    yields = bodies.shape[0] > 0
    for i in range(touch + size):
        for j in range(total):
            matrix[i, j] = 0.0
    for d in range(discs):
        column, row, shown = motion + 4 + 3 * d, touch + 4 + 3 * d, at_cap[d]
        for i in range(first[d], first[d + 1]):
            k = touching[d, i - first[d]]
            nx, ny, h = rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
            for j in range(first[d], first[d + 1]):
                matrix[i, j] = bodies[d, touching[d, j - first[d]], k] if yields else 0.0
            matrix[i, i] += 1.0 / stiff[d, k]
            matrix[i, right] = -lack[d, k]
            matrix[i, column] = nx
            matrix[i, column + 1] = ny
            matrix[i, column + 2] = h
            fx, fy = push[d, k, 0], push[d, k, 1]
            matrix[row, i] = -fx
            matrix[row + 1, i] = -fy
            matrix[row + 2, i] = -push[d, k, 2]
            if k < teeth:
                continue
            matrix[i, i] += pins[d, d] * (nx * fx + ny * fy)
            matrix[i, motion] = -nx if bed > 0.0 else 0.0
            matrix[i, motion + 1] = -ny if bed > 0.0 else 0.0
            matrix[i, motion + 2] = -(1.0 - shown) * h
            matrix[i, motion + 3] = -shown * h
            held = push[d, k, 3]
            matrix[touch, i] = fx if bed > 0.0 else 0.0
            matrix[touch + 1, i] = fy if bed > 0.0 else 0.0
            matrix[touch + 2, i] = (1.0 - shown) * held
            matrix[touch + 3, i] = shown * held
    for d in range(discs):
        for e in range(discs):
            for i in range(first[d], first[d + 1]):
                k = touching[d, i - first[d]]
                for j in range(first[e], first[e + 1]):
                    if e != d and k >= teeth and touching[e, j - first[e]] == k:
                        along = rows[d, k, 0] * push[e, k, 0] + rows[d, k, 1] * push[e, k, 1]
                        matrix[i, j] = pins[d, e] * along
    matrix[touch, motion] = bed if bed > 0.0 else 1.0
    matrix[touch + 1, motion + 1] = bed if bed > 0.0 else 1.0
    matrix[touch + 2, motion + 2] = join
    matrix[touch + 2, motion + 3] = -join
    matrix[touch + 3, motion + 2] = -join
    matrix[touch + 3, motion + 3] = join
    for d in range(discs):
        add_cam(contacts, springs, u, d, matrix, touch + 4 + 3 * d, motion + 4 + 3 * d)
    for i in range(size):
        matrix[touch + i, motion + i] += ridge
        matrix[touch + i, right] = -gradient[i]


@part(borrows=True, forceinline=True)
def _clear(matrix: Any, pivot: Any, rows: Any, columns: Any) -> None:
    """Take a pivot (row and column) out of some rows, in some columns."""
    i, c = pivot
    inverse = 1.0 / matrix[i, c]
    for j in range(rows[0], rows[1]):
        share = matrix[j, c] * inverse
        if share != 0.0:
            for k in range(columns[0], columns[1]):
                matrix[j, k] -= share * matrix[i, k]


@part(borrows=True, forceinline=True)
def swap_for_pivot(matrix: Any, i: int, c: int, last: int, columns: Any) -> int:
    """Bring the greatest entry of column c among rows i to `last` into row i; where it was."""
    pivot = i
    for j in range(i + 1, last):
        if abs(matrix[j, c]) > abs(matrix[pivot, c]):
            pivot = j
    if pivot != i:
        for k in range(columns[0], columns[1]):
            kept = matrix[i, k]
            matrix[i, k] = matrix[pivot, k]
            matrix[pivot, k] = kept
    return pivot


@part(borrows=True, forceinline=True)
def carrier_motion(matrix: Any, row: int, right: int, fixed: int, work: YieldingWork) -> float:
    """Motions of the carrier into `work.step`, of which the first `fixed` are none.

    Its four rows begin at `row`; the right-hand side stands before its four columns. A unit torque
    on the plate is solved beside it, and the torque over its turn returned.
    """
    step, unit, motion = work.step, work.unit, right + 1
    for i in range(4):
        unit[i] = 0.0
    unit[2] = 1.0
    for i in range(fixed, 4):
        r, c = row + i, motion + i
        pivot = swap_for_pivot(matrix, r, c, row + 4, (right, motion + 4)) - row
        unit[i], unit[pivot] = unit[pivot], unit[i]
        for j in range(i + 1, 4):
            share = matrix[row + j, c] / matrix[r, c]
            unit[j] -= share * unit[i]
        _clear(matrix, (r, c), (r + 1, row + 4), (right, motion + 4))
    for i in range(fixed):
        step[i] = 0.0
        unit[i] = 0.0
    for i in range(3, fixed - 1, -1):
        left, lone = matrix[row + i, right], unit[i]
        for k in range(i + 1, 4):
            left -= matrix[row + i, motion + k] * step[k]
            lone -= matrix[row + i, motion + k] * unit[k]
        step[i] = left / matrix[row + i, motion + i]
        unit[i] = lone / matrix[row + i, motion + i]
    return 1.0 / float(unit[2])


@part(borrows=True, forceinline=True)
def eliminate(work: YieldingWork, fixed: int) -> float:
    """Motions into `work.step`, changes of force into `work.change`, where the contacts touch.

    The forces go first: their diagonal is above what couples them. Then go the motions of the discs
    and those of the carrier, of which the first `fixed` do not move, with row pivots; beside the
    residual a unit torque on the plate. Returned is the torque over its turn.
    """
    matrix, step, first, touching = work.matrix, work.step, work.first, work.touching
    change, size, discs = work.change, work.step.size, work.first.size - 1
    touch = int(first[discs])
    right, motion, total = touch, touch + 1, touch + 1 + size
    carrier, end = (touch + fixed, touch + 4), touch + size
    for i in range(touch):
        _clear(matrix, (i, i), (i + 1, end), (i + 1, total))
    # Discs before the carrier.
    for i in range(4, size):
        r, c = touch + i, motion + i
        swap_for_pivot(matrix, r, c, end, (right, total))
        _clear(matrix, (r, c), (r + 1, end), (c + 1, total))
        _clear(matrix, (r, c), (r + 1, end), (right, motion + 4))
        _clear(matrix, (r, c), carrier, (c + 1, total))
        _clear(matrix, (r, c), carrier, (right, motion + 4))
    turn = carrier_motion(matrix, touch, right, fixed, work)
    for i in range(size - 1, 3, -1):
        left = matrix[touch + i, right]
        for k in range(fixed, 4):
            left -= matrix[touch + i, motion + k] * step[k]
        for k in range(i + 1, size):
            left -= matrix[touch + i, motion + k] * step[k]
        step[i] = left / matrix[touch + i, motion + i]
    for d in range(discs - 1, -1, -1):
        for i in range(int(first[d + 1]) - 1, int(first[d]) - 1, -1):
            left = matrix[i, right]
            for k in range(i + 1, touch):
                left -= matrix[i, k] * matrix[k, right]
            for k in range(fixed, 4):
                left -= matrix[i, motion + k] * step[k]
            for k in range(4, size):
                left -= matrix[i, motion + k] * step[k]
            matrix[i, right] = left / matrix[i, i]
            change[d, touching[d, i - first[d]]] = matrix[i, right]
    return turn


@part(borrows=True, forceinline=True)
def change_approach(
    contacts: Contacts, teeth: int, compliance: Compliance, work: YieldingWork
) -> None:
    """Change of every approach into `work.change`, where the change of every force stands."""
    rows, at_cap, lack = contacts.rows, compliance.at_cap, work.lack
    change, step, yielded = work.change, work.step, work.yielded
    discs, count = lack.shape
    _find_yield(contacts, teeth, compliance, change, work)
    for d in range(discs):
        i = 4 + 3 * d
        x, y, t = step[i], step[i + 1], step[i + 2]
        for k in range(count):
            if k == teeth:
                x, y, t = x - step[0], y - step[1], t - step[2] - at_cap[d] * (step[3] - step[2])
            closed = -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t)
            change[d, k] = closed - yielded[d, k] - lack[d, k]
