"""Compiled: forces, gradient and Hessian of one state, and the Newton step through its blocks.

The carrier couples the discs through one 3x3 block, so a state costs one small elimination per
disc. A plain numpy twin stands in ``tests/oracles/contact_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.kernel_values import Contacts, Forces, Springs, Work
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force


@part(borrows=True, forceinline=True)
def _press(
    contacts: Contacts, forces: Forces, work: Work, which: Any, displacement: Any, law: Any
) -> Any:
    """Some contacts of a disc: their largest force, and what they add to gradient and Hessian.

    A contact closes by delta = -(n_x x + n_y y + h t) - gap; its force f adds -f (n_x, n_y, h)
    to the gradient and f' n n^T to the Hessian. `which` are the disc and the first and last
    contact, `law` code, logarithm and series compliance. Written into its two callers, so that
    the ring's loop knows that nothing stands in series.
    """
    rows, gaps, coefficient = contacts.rows, contacts.gaps, contacts.coefficient
    force, stiff, closed = forces.contact, work.stiff, work.closed
    d, first, last = which
    x, y, t = displacement
    code, logarithm, series = law
    largest = gx = gy = gt = 0.0
    hxx = hxy = hxt = hyy = hyt = htt = 0.0
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
        gx -= f * nx
        gy -= f * ny
        gt -= f * h
        hxx += s * nx * nx
        hxy += s * nx * ny
        hxt += s * nx * h
        hyy += s * ny * ny
        hyt += s * ny * h
        htt += s * h * h
    return largest, (gx, gy, gt), (hxx, hxy, hxt, hyy, hyt, htt)


@part(borrows=True)
def evaluate_state(
    contacts: Contacts, springs: Springs, pull: float, state: Any, forces: Forces, work: Work
) -> float:
    """Forces, gradient and Hessian blocks at `state`; returns the largest force of a contact.

    The energy is Pi = sum of all springs + k_carrier (X^2 + Y^2)/2 - pull gamma. A contact of the
    ring sees its disc, one of a pin its disc against the carrier.
    """
    discs, count = contacts.gaps.shape
    # Arrays are taken out of their tuples before a loop: numba counts references at every access.
    offset, half_play, series = contacts.offset, contacts.half_play, springs.pin_series
    cam, teeth, gradient = forces.cam, springs.teeth, work.gradient
    block, shared = work.block, work.shared
    for i in range(gradient.size):
        gradient[i] = 0.0
    gradient[0] = springs.carrier_stiffness * state[0]
    gradient[1] = springs.carrier_stiffness * state[1]
    gradient[2] = -pull
    largest = 0.0
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d]
        ring = (springs.ring_law, springs.ring_logarithm, 0.0)
        on_ring, (gx, gy, gt), (hxx, hxy, hxt, hyy, hyt, htt) = _press(
            contacts, forces, work, (d, 0, teeth), (x, y, t), ring
        )
        pins = (springs.pin_law, springs.pin_logarithm, series[d])
        away = (x - state[0], y - state[1], t - state[2])
        on_pins, (px, py, pt), (sxx, sxy, sxt, syy, syt, stt) = _press(
            contacts, forces, work, (d, teeth, count), away, pins
        )
        largest = max(largest, on_ring, on_pins)
        gradient[0] -= px
        gradient[1] -= py
        gradient[2] -= pt
        # The cam pulls along its displacement beyond half of the play, F = K (rho - play/2)^p:
        # its Hessian is F' along u u^T and F/rho across it.
        rx = state[3 + 3 * d] - offset[d, 0]
        ry = state[4 + 3 * d] - offset[d, 1]
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
            gx += f * ux
            gy += f * uy
            hxx += s * ux * ux + across * uy * uy
            hxy += (s - across) * ux * uy
            hyy += s * uy * uy + across * ux * ux
        elif over >= 0.0 and springs.cam_exponent == 1.0:
            # A linear bearing without play is stiff in its centre too.
            hxx += springs.cam_stiffness
            hyy += springs.cam_stiffness
        gradient[3 + 3 * d] = gx + px
        gradient[4 + 3 * d] = gy + py
        gradient[5 + 3 * d] = gt + pt
        shared[d, 0], shared[d, 1], shared[d, 2] = sxx, sxy, sxt
        shared[d, 3], shared[d, 4], shared[d, 5] = syy, syt, stt
        block[d, 0], block[d, 1], block[d, 2] = hxx + sxx, hxy + sxy, hxt + sxt
        block[d, 3], block[d, 4], block[d, 5] = hyy + syy, hyt + syt, htt + stt
    return largest


@part(borrows=True, forceinline=True)
def _solve3(a: Any, ridge: float, b0: float, b1: float, b2: float) -> tuple[float, float, float]:
    """Solve a symmetric positive 3x3 system (xx, xy, xt, yy, yt, tt) plus ridge by LDL^T."""
    d0 = a[0] + ridge
    l1, l2 = a[1] / d0, a[2] / d0
    d1 = a[3] + ridge - l1 * a[1]
    d1 = max(d1, ridge)
    m = a[4] - l1 * a[2]
    l3 = m / d1
    d2 = max(a[5] + ridge - l2 * a[2] - l3 * m, ridge)
    y1 = b1 - l1 * b0
    y2 = (b2 - l2 * b0 - l3 * y1) / d2
    x1 = y1 / d1 - l3 * y2
    return b0 / d0 - l1 * x1 - l2 * y2, x1, y2


@part(borrows=True, forceinline=True)
def newton_step(work: Work, carrier_stiffness: float, ridge: float) -> float:
    """Newton step by eliminating the discs; returns the torsional stiffness left at the carrier.

    With H_d the block of a disc and S_d its pins' part, disc and carrier obey
    H_d dq_d - S_d dq_0 = -g_d and (k + sum S_d) dq_0 - sum S_d dq_d = -g_0. Eliminated:
    (k + sum (S_d - S_d H_d^-1 S_d)) dq_0 = -g_0 - sum S_d H_d^-1 g_d. With a rigid carrier bearing
    (stiffness 0) only its angle moves.
    """
    block, shared, gradient = work.block, work.shared, work.gradient
    step, carrier = work.step, work.carrier
    discs = block.shape[0]
    for i in range(6):
        carrier[i] = 0.0
    rx, ry, rt = -gradient[0], -gradient[1], -gradient[2]
    rigid = carrier_stiffness <= 0.0
    for d in range(discs):
        s = shared[d]
        gx, gy, gt = gradient[3 + 3 * d], gradient[4 + 3 * d], gradient[5 + 3 * d]
        zx, zy, zt = _solve3(block[d], ridge, gx, gy, gt)
        cx, cy, ct = _solve3(block[d], ridge, s[2], s[4], s[5])
        carrier[5] += s[5] - (s[2] * cx + s[4] * cy + s[5] * ct)
        rt -= s[2] * zx + s[4] * zy + s[5] * zt
        if not rigid:
            ax, ay, at = _solve3(block[d], ridge, s[0], s[1], s[2])
            bx, by, bt = _solve3(block[d], ridge, s[1], s[3], s[4])
            carrier[0] += s[0] - (s[0] * ax + s[1] * ay + s[2] * at)
            carrier[1] += s[1] - (s[0] * bx + s[1] * by + s[2] * bt)
            carrier[2] += s[2] - (s[0] * cx + s[1] * cy + s[2] * ct)
            carrier[3] += s[3] - (s[1] * bx + s[3] * by + s[4] * bt)
            carrier[4] += s[4] - (s[1] * cx + s[3] * cy + s[4] * ct)
            rx -= s[0] * zx + s[1] * zy + s[2] * zt
            ry -= s[1] * zx + s[3] * zy + s[4] * zt
    if rigid:
        torsional = carrier[5]
        dx = dy = 0.0
        dt = rt / (max(torsional, 0.0) + ridge)
    else:
        carrier[0] += carrier_stiffness
        carrier[3] += carrier_stiffness
        dx, dy, dt = _solve3(carrier, ridge, rx, ry, rt)
        inside = carrier[0] * carrier[3] - carrier[1] * carrier[1]
        torsional = (
            carrier[5]
            - (
                carrier[2] * (carrier[3] * carrier[2] - carrier[1] * carrier[4])
                + carrier[4] * (carrier[0] * carrier[4] - carrier[1] * carrier[2])
            )
            / inside
        )
    step[0], step[1], step[2] = dx, dy, dt
    for d in range(discs):
        s = shared[d]
        bx = s[0] * dx + s[1] * dy + s[2] * dt - gradient[3 + 3 * d]
        by = s[1] * dx + s[3] * dy + s[4] * dt - gradient[4 + 3 * d]
        bt = s[2] * dx + s[4] * dy + s[5] * dt - gradient[5 + 3 * d]
        vx, vy, vt = _solve3(block[d], ridge, bx, by, bt)
        step[3 + 3 * d], step[4 + 3 * d], step[5 + 3 * d] = vx, vy, vt
    return float(torsional)
