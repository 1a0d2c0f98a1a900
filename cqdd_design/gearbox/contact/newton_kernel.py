"""Compiled: forces, gradient and Hessian of one state, and the Newton step through its blocks.

The carrier couples the discs through one 3x3 block, so a state costs one small elimination per
disc. A plain numpy twin stands in ``tests/oracles/contact_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.laws_kernel import line_force, radial_force


@numba.njit(cache=True, error_model="numpy")
def evaluate_state(
    rows: Any,
    gaps: Any,
    coefficient: Any,
    teeth: int,
    codes: Any,
    logarithms: Any,
    series: Any,
    cam: Any,
    offset: Any,
    half_play: Any,
    carrier_stiffness: float,
    pull: float,
    state: Any,
    force: Any,
    stiff: Any,
    closed: Any,
    cam_force: Any,
    gradient: Any,
    block: Any,
    shared: Any,
) -> float:
    """Forces, gradient and Hessian blocks at `state`; returns the largest force of a contact.

    `block` (D, 6) holds the disc blocks xx, xy, xt, yy, yt, tt, `shared` (D, 6) the pins' part,
    which also couples to the carrier; `force`, `stiff`, `closed` (D, C) are per contact.
    """
    discs, contacts = gaps.shape
    for i in range(gradient.size):
        gradient[i] = 0.0
    gradient[0] = carrier_stiffness * state[0]
    gradient[1] = carrier_stiffness * state[1]
    gradient[2] = -pull
    largest = 0.0
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d]
        hxx = hxy = hxt = hyy = hyt = htt = 0.0
        gx = gy = gt = 0.0
        for k in range(teeth):
            nx, ny, h = rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
            delta = -(nx * x + ny * y + h * t) - gaps[d, k]
            closed[d, k] = delta
            if delta <= 0.0:
                force[d, k] = 0.0
                stiff[d, k] = 0.0
                continue
            f, s = line_force(codes[0], coefficient[d, k], logarithms[0], 0.0, delta)
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
        x -= state[0]
        y -= state[1]
        t -= state[2]
        sxx = sxy = sxt = syy = syt = stt = 0.0
        px = py = pt = 0.0
        for k in range(teeth, contacts):
            nx, ny, h = rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
            delta = -(nx * x + ny * y + h * t) - gaps[d, k]
            closed[d, k] = delta
            if delta <= 0.0:
                force[d, k] = 0.0
                stiff[d, k] = 0.0
                continue
            f, s = line_force(codes[1], coefficient[d, k], logarithms[1], series[d], delta)
            force[d, k] = f
            stiff[d, k] = s
            largest = max(largest, f)
            px -= f * nx
            py -= f * ny
            pt -= f * h
            sxx += s * nx * nx
            sxy += s * nx * ny
            sxt += s * nx * h
            syy += s * ny * ny
            syt += s * ny * h
            stt += s * h * h
        gradient[0] -= px
        gradient[1] -= py
        gradient[2] -= pt
        rx = state[3 + 3 * d] - offset[d, 0]
        ry = state[4 + 3 * d] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        cam_force[d, 0] = 0.0
        cam_force[d, 1] = 0.0
        if over > 0.0 and rho > 0.0:
            f, s = radial_force(cam[0], cam[1], over)
            largest = max(largest, f)
            ux, uy, across = rx / rho, ry / rho, f / rho
            cam_force[d, 0] = -f * ux
            cam_force[d, 1] = -f * uy
            gx += f * ux
            gy += f * uy
            hxx += s * ux * ux + across * uy * uy
            hxy += (s - across) * ux * uy
            hyy += s * uy * uy + across * ux * ux
        elif over >= 0.0 and cam[1] == 1.0:
            # A linear bearing without play is stiff in its centre too.
            hxx += cam[0]
            hyy += cam[0]
        gradient[3 + 3 * d] = gx + px
        gradient[4 + 3 * d] = gy + py
        gradient[5 + 3 * d] = gt + pt
        shared[d, 0], shared[d, 1], shared[d, 2] = sxx, sxy, sxt
        shared[d, 3], shared[d, 4], shared[d, 5] = syy, syt, stt
        block[d, 0], block[d, 1], block[d, 2] = hxx + sxx, hxy + sxy, hxt + sxt
        block[d, 3], block[d, 4], block[d, 5] = hyy + syy, hyt + syt, htt + stt
    return largest


@numba.njit(cache=True, inline="always", error_model="numpy")
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


@numba.njit(cache=True, error_model="numpy")
def newton_step(
    block: Any,
    shared: Any,
    gradient: Any,
    carrier_stiffness: float,
    ridge: float,
    step: Any,
    carrier: Any,
) -> float:
    """Newton step by eliminating the discs; returns the torsional stiffness left at the carrier.

    With a rigid carrier bearing (stiffness 0) only its angle moves.
    """
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
