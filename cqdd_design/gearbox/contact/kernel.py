"""Compiled kernels of the contact equilibrium: force laws, one state, a sweep of states.

The energy of all springs is convex, so its only stationary point is the equilibrium. Newton's
method meets it in two or three steps from a neighbouring state; a line search on the directional
derivative, which is monotone, makes it safe from any start. The carrier couples the discs through
one 3x3 block, so a state costs one small elimination per disc.

State vector: carrier (X, Y, gamma), then each disc (x, y, theta); angles are multiplied by
`length` (the pin circle), so that every entry is a length and every gradient a force. The plain
numpy twin is :mod:`.plain`.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

_STEPS = 300
_SEARCHES = 200
_GOOD = 1e-11
_NEARLY = 1e-6

_FIRM_APPROACH = 5e-6
"""Approach, m, of a load that presses the discs firmly against what stops them."""

CONVERGED, NOT_CONVERGED = 0, 1


@numba.njit(cache=True, inline="always", error_model="numpy")  # type: ignore[misc]
def _palmgren(c: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of delta = c F^0.9 + s F."""
    u = math.exp(math.log(delta / c) / 9.0)
    if s > 0.0:
        upper = math.exp(0.1 * math.log(delta / s))
        u = min(u, upper)
        for _ in range(60):
            u2 = u * u
            u8 = u2 * u2 * u2 * u2
            step = (u8 * u * (c + s * u) - delta) / (u8 * (9.0 * c + 10.0 * s * u))
            u -= step
            if abs(step) <= 1e-9 * u:
                break
    u2 = u * u
    u4 = u2 * u2
    load = u4 * u4 * u2
    return load, 1.0 / (0.9 * c / u + s)


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _johnson(a: float, b: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of delta = F (a + s - b ln F), straight beyond the law's limit."""
    c = a + s
    limit = math.exp(0.95 * a / b - 1.0)
    steepest = c - b * (math.log(limit) + 1.0)
    edge = limit * (c - b * math.log(limit))
    if delta >= edge:
        return limit + (delta - edge) / steepest, 1.0 / steepest
    load = min(delta / c, limit)
    for _ in range(100):
        logarithm = math.log(load)
        step = (load * (c - b * logarithm) - delta) / (c - b * (logarithm + 1.0))
        new = min(max(load - step, 0.1 * load), limit)
        change = abs(new - load)
        load = new
        if change <= 1e-15 * load:
            break
    return load, 1.0 / (c - b * (math.log(load) + 1.0))


@numba.njit(cache=True, inline="always", error_model="numpy")  # type: ignore[misc]
def _line(code: int, c: float, b: float, s: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of a line contact pressed together by delta > 0."""
    if code == 0:
        return _palmgren(c, s, delta)
    if code == 1:
        return _johnson(c, b, s, delta)
    k = 1.0 / (c + s)
    return k * delta, k


@numba.njit(cache=True, inline="always", error_model="numpy")  # type: ignore[misc]
def _radial(stiffness: float, exponent: float, delta: float) -> tuple[float, float]:
    """Force and stiffness of F = K delta^exponent."""
    if exponent == 1.5:
        root = math.sqrt(delta)
        return stiffness * delta * root, 1.5 * stiffness * root
    if exponent == 1.0:
        return stiffness * delta, stiffness
    load = stiffness * math.exp(exponent * math.log(delta))
    return load, exponent * load / delta


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _evaluate(
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
            f, s = _line(codes[0], coefficient[d, k], logarithms[0], 0.0, delta)
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
            f, s = _line(codes[1], coefficient[d, k], logarithms[1], series[d], delta)
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
            f, s = _radial(cam[0], cam[1], over)
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


@numba.njit(cache=True, inline="always", error_model="numpy")  # type: ignore[misc]
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


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _newton_step(
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
    return torsional


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def solve_state(
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
    scale_stiffness: float,
    state: Any,
    force: Any,
    cam_force: Any,
    work: Any,
) -> tuple[int, int, float]:
    """Find the equilibrium at one crank angle, from `state` and into it.

    Parameters
    ----------
    rows : array (D, C, 3)
        n_x, n_y and h/length of C = teeth + pins contacts on every disc.
    gaps, coefficient : array (D, C)
        m; coefficient of either law.
    teeth : int
        Contacts that belong to the ring; the rest are pins.
    codes, logarithms : sequences of two
        Law of ring and pins, and Johnson's B.
    series, half_play : array (D,)
        Compliance of the pins, m/N; half of the play, m.
    cam : sequence of two
        K and exponent.
    offset : array (D, 2)
        Displacement of the cams' centres, m.
    carrier_stiffness : float
        N/m; 0 is rigid.
    pull : float
        T/length, N.
    scale_stiffness : float
        A typical stiffness, N/m; sets the ridge that keeps slack discs where they are.
    state : array (3 + 3 D,)
        In: a start. Out: the equilibrium.
    force, cam_force : array (D, C), (D, 2)
        Out: forces at the equilibrium, N.
    work : array (6 (3 + 3 D) + 2 D C + 12 D + 6,)
        Scratch.

    Returns
    -------
    status, steps, torsional : int, int, float
        0 when converged; Newton steps; dT/dgamma/length^2, N/m.
    """
    discs, contacts = gaps.shape
    size = 3 + 3 * discs
    gradient, step = work[:size], work[size : 2 * size]
    trial = work[2 * size : 3 * size]
    at = 3 * size
    stiff = work[at : at + discs * contacts].reshape(discs, contacts)
    at += discs * contacts
    closed = work[at : at + discs * contacts].reshape(discs, contacts)
    at += discs * contacts
    block = work[at : at + 6 * discs].reshape(discs, 6)
    at += 6 * discs
    shared = work[at : at + 6 * discs].reshape(discs, 6)
    at += 6 * discs
    carrier = work[at : at + 6]
    ridge = 1e-10 * scale_stiffness
    torsional = 0.0
    previous = np.inf
    largest = _evaluate(
        rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset, half_play,
        carrier_stiffness, pull, state, force, stiff, closed, cam_force, gradient, block, shared,
    )  # fmt: skip
    for iteration in range(_STEPS):
        if carrier_stiffness <= 0.0:
            gradient[0] = 0.0
            gradient[1] = 0.0
        residual = 0.0
        for i in range(size):
            residual = max(residual, abs(gradient[i]))
        scale = max(abs(pull), largest)
        torsional = _newton_step(block, shared, gradient, carrier_stiffness, ridge, step, carrier)
        # Rounding of the closings alone leaves forces of this size unbalanced.
        noise = 0.0
        for d in range(discs):
            for k in range(contacts):
                noise = max(noise, stiff[d, k])
        furthest = 0.0
        for i in range(size):
            furthest = max(furthest, abs(state[i]))
        noise *= 1e-15 * furthest
        stuck = (
            iteration > 3 and residual <= max(1e-7 * scale, noise) and residual >= 0.25 * previous
        )
        if residual <= _NEARLY * scale or stuck:
            # The last step is taken on the forces too, in first order: this balances them to
            # rounding, and its own error is the square of a relative 1e-6.
            smooth = True
            if residual > _GOOD * scale and not stuck:
                smooth = _within_first_order(rows, teeth, closed, stiff, step, scale)
            if smooth:
                _take_step(
                    rows, teeth, stiff, cam, offset, half_play, state, step, force, cam_force
                )
                return CONVERGED, iteration, torsional
        previous = residual
        slope = 0.0
        for i in range(size):
            slope += gradient[i] * step[i]
        if not slope < 0.0:
            return NOT_CONVERGED, iteration, torsional
        share, low, high = 1.0, 0.0, np.inf
        for _ in range(_SEARCHES):
            for i in range(size):
                trial[i] = state[i] + share * step[i]
            largest = _evaluate(
                rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset,
                half_play, carrier_stiffness, pull, trial, force, stiff, closed, cam_force,
                gradient, block, shared,
            )  # fmt: skip
            if carrier_stiffness <= 0.0:
                gradient[0] = 0.0
                gradient[1] = 0.0
            there = 0.0
            for i in range(size):
                there += gradient[i] * step[i]
            if abs(there) <= 0.7 * abs(slope):
                break
            if there > 0.0:
                high = share
            else:
                low = share
            if high == np.inf:
                share *= 4.0
            elif low == 0.0 and high > 1e-3:
                share = 0.1 * high
            elif low > 0.0 and high > 4.0 * low:
                share = math.sqrt(low * high)
            elif low > 0.0:
                share = 0.5 * (low + high)
            else:
                share = 0.1 * high
            if high - low <= 1e-14 * high:
                break
        for i in range(size):
            state[i] = trial[i]
    return NOT_CONVERGED, _STEPS, torsional


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _moved(rows: Any, teeth: int, step: Any, d: int, k: int) -> float:
    """How much further a contact closes by `step`."""
    x, y, t = step[3 + 3 * d], step[4 + 3 * d], step[5 + 3 * d]
    if k >= teeth:
        x -= step[0]
        y -= step[1]
        t -= step[2]
    return -(rows[d, k, 0] * x + rows[d, k, 1] * y + rows[d, k, 2] * t)


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _within_first_order(
    rows: Any, teeth: int, closed: Any, stiff: Any, step: Any, scale: float
) -> bool:
    """Whether a step neither opens nor closes a contact, nor changes a force by its square."""
    discs, contacts = closed.shape
    for d in range(discs):
        for k in range(contacts):
            moved = _moved(rows, teeth, step, d, k)
            if closed[d, k] <= 0.0:
                if closed[d, k] + moved > 0.0:
                    return False
            elif stiff[d, k] * moved * moved > 1e-12 * scale * closed[d, k]:
                return False
    return True


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def _take_step(
    rows: Any,
    teeth: int,
    stiff: Any,
    cam: Any,
    offset: Any,
    half_play: Any,
    state: Any,
    step: Any,
    force: Any,
    cam_force: Any,
) -> None:
    """Move the state by `step` and the forces by their stiffness times it."""
    discs, contacts = force.shape
    for d in range(discs):
        for k in range(contacts):
            if force[d, k] > 0.0:
                force[d, k] = max(force[d, k] + stiff[d, k] * _moved(rows, teeth, step, d, k), 0.0)
        rx = state[3 + 3 * d] - offset[d, 0]
        ry = state[4 + 3 * d] - offset[d, 1]
        rho = math.sqrt(rx * rx + ry * ry)
        over = rho - half_play[d]
        if over > 0.0 and rho > 0.0:
            f, s = _radial(cam[0], cam[1], over)
            ux, uy, across = rx / rho, ry / rho, f / rho
            vx, vy = step[3 + 3 * d], step[4 + 3 * d]
            along, sideways = ux * vx + uy * vy, -uy * vx + ux * vy
            cam_force[d, 0] -= s * along * ux - across * sideways * uy
            cam_force[d, 1] -= s * along * uy + across * sideways * ux
        elif over >= 0.0 and cam[1] == 1.0:
            cam_force[d, 0] -= cam[0] * step[3 + 3 * d]
            cam_force[d, 1] -= cam[0] * step[4 + 3 * d]
    for i in range(state.size):
        state[i] += step[i]


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def predict(state: Any, before: Any, turn: float, known: int, out: Any) -> None:
    """Start for the next angle: the last state turned with the crank, plus its last change.

    Disc centres are carried round with the crank, in whose frame they hardly move; `known` is the
    number of states behind (0, 1 or more).
    """
    cosine, sine = math.cos(turn), math.sin(turn)
    for i in range(3):
        out[i] = state[i] + (state[i] - before[i] if known > 1 else 0.0)
    for d in range((state.size - 3) // 3):
        i = 3 + 3 * d
        x, y, t = state[i], state[i + 1], state[i + 2]
        if known > 1:
            bx = cosine * before[i] - sine * before[i + 1]
            by = sine * before[i] + cosine * before[i + 1]
            x, y, t = 2.0 * x - bx, 2.0 * y - by, 2.0 * t - before[i + 2]
        out[i] = cosine * x - sine * y
        out[i + 1] = sine * x + cosine * y
        out[i + 2] = t


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def solve_from_above(
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
    scale_stiffness: float,
    state: Any,
    force: Any,
    cam_force: Any,
    work: Any,
) -> tuple[int, int, float]:
    """Solve one state from nothing by lowering the load to `pull`, tenfold at a time.

    Slow and safe: under a small load the discs slide round their cams' play, a narrow curved
    valley that Newton's method follows only in small steps; under a firm one they do not.
    Arguments and returns are those of :func:`solve_state`.
    """
    firm = abs(pull)
    while 0.0 < firm < _FIRM_APPROACH * scale_stiffness:
        firm *= 10.0
    state[:] = 0.0
    steps = 0
    while True:
        load = max(firm, abs(pull))
        status, used, torsional = solve_state(
            rows, gaps, coefficient, teeth, codes, logarithms, series, cam, offset, half_play,
            carrier_stiffness, math.copysign(load, pull), scale_stiffness, state, force,
            cam_force, work,
        )  # fmt: skip
        steps += used
        if load <= abs(pull):
            return status, steps, torsional
        firm /= 10.0
        if firm < 2.0 * abs(pull):
            firm = abs(pull)


@numba.njit(cache=True, error_model="numpy")  # type: ignore[misc]
def solve_sweep(
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
    scale_stiffness: float,
    turns: Any,
    states: Any,
    force: Any,
    cam_force: Any,
    torsional: Any,
    steps: Any,
) -> int:
    """Equilibria at consecutive crank angles, each from the ones before.

    Arrays are those of :func:`solve_state` with a leading axis A (`states` (A, 3 + 3 D) and the
    rest are results); `turns` (A,) is the crank angle since the state before, rad.

    Returns
    -------
    int
        -1, or the index of the first state that did not converge.
    """
    count, discs, contacts = gaps.shape
    size = 3 + 3 * discs
    work = np.empty(6 * size + 2 * discs * contacts + 12 * discs + 6)
    for a in range(count):
        if a == 0:
            for i in range(size):
                states[0, i] = 0.0
        else:
            predict(states[a - 1], states[max(a - 2, 0)], turns[a], a, states[a])
        status, used, left = solve_state(
            rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam, offset[a],
            half_play, carrier_stiffness, pull, scale_stiffness, states[a], force[a],
            cam_force[a], work,
        )  # fmt: skip
        if status != CONVERGED:
            status, used, left = solve_from_above(
                rows[a], gaps[a], coefficient[a], teeth, codes, logarithms, series, cam,
                offset[a], half_play, carrier_stiffness, pull, scale_stiffness, states[a],
                force[a], cam_force[a], work,
            )  # fmt: skip
            if status != CONVERGED:
                return a
        torsional[a] = left
        steps[a] = used
    return -1
