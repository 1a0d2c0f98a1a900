"""Compiled kernel of the backlash: how far the carrier turns before rigid parts stop it.

The carrier is pushed by a vanishing torque against springs, which in the limit maximises its
angle under "no gap negative". Each solution is a new state to linearise at, with the true
positions of holes and pins and each flank as its osculating circle, until it stands still.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, solve_state
from cqdd_design.gearbox.contact.sweep_kernel import predict

OVERLAP = 1e-7
"""Overlap, m, above which parts are said to be preloaded and not merely touching."""

_PUSH = 2e-9
"""Force on springs of 1 N/m; the parts yield by about as many metres, which is taken off again."""
_FIRM = 20.0
_NEARLY_STILL = 2e-8
"""The same for states that do not settle: 4e-3 arcmin at 20 mm."""
_TOUCHING = 2e-8
"""Overlap, m, that freely touching parts stay below."""
_ROUNDS, _FREE_ROUNDS = 40, 8
_STILL = 2e-10
"""Metres at the pin circle between two rounds that count as standing still: 1e-4 arcmin or less."""


@numba.njit(cache=True, error_model="numpy")
def _true_gaps(
    nominal_rows: Any,
    nominal_gaps: Any,
    curvature: Any,
    tooth_centre: Any,
    own_angle: Any,
    pin_angle: Any,
    apart: Any,
    eccentricity: float,
    length: float,
    teeth: int,
    state: Any,
    rows: Any,
    gaps: Any,
) -> None:
    """Rows and gaps linearised at the displaced state, with gaps in the nominal coordinates.

    `apart` (D, P, 2) is how far each hole stands off its pin by position errors, in the ring's
    frame; everything else is as in :func:`backlash_sweep`.
    """
    discs, contacts = nominal_gaps.shape
    turn = state[2] / length
    for d in range(discs):
        x, y, t = state[3 + 3 * d], state[4 + 3 * d], state[5 + 3 * d] / length
        ex = eccentricity * math.cos(own_angle[d])
        ey = eccentricity * math.sin(own_angle[d])
        c, s = math.cos(t), math.sin(t)
        # 1 - cos without cancellation.
        less = 2.0 * math.sin(0.5 * t) ** 2
        for k in range(teeth):
            nx, ny = nominal_rows[d, k, 0], nominal_rows[d, k, 1]
            ax, ay = tooth_centre[k, 0] - ex - x, tooth_centre[k, 1] - ey - y
            # Seen from the disc, which turned by t: displacement of the tooth's centre.
            dx = -x - less * ax + s * ay
            dy = -y - s * ax - less * ay
            a = -(dx * nx + dy * ny)
            b = dx * ny - dy * nx
            bend = curvature[d, k]
            root = math.sqrt((1.0 + bend * a) ** 2 + (bend * b) ** 2)
            opened = (2.0 * a + bend * (a * a + b * b)) / (1.0 + root)
            # Outward normal m = -n, tangent i m; the new normal leans by bend*b.
            mx = ((1.0 + bend * a) * -nx + bend * b * ny) / root
            my = ((1.0 + bend * a) * -ny - bend * b * nx) / root
            vx, vy = -(c * mx - s * my), -(s * mx + c * my)
            arm = (ax * vy - ay * vx) / length
            rows[d, k, 0], rows[d, k, 1], rows[d, k, 2] = vx, vy, arm
            gaps[d, k] = nominal_gaps[d, k] + opened - (vx * x + vy * y + arm * t * length)
        for k in range(teeth, contacts):
            j = k - teeth
            px, py = length * math.cos(pin_angle[j]), length * math.sin(pin_angle[j])
            # Hole from the disc's centre, and the pin, both displaced; then hole from pin.
            hx, hy = c * px - s * py, s * px + c * py
            gx = length * math.cos(pin_angle[j] + turn)
            gy = length * math.sin(pin_angle[j] + turn)
            wx = ex + x + hx + apart[d, j, 0] - gx - state[0]
            wy = ey + y + hy + apart[d, j, 1] - gy - state[1]
            far = math.sqrt(wx * wx + wy * wy)
            vx, vy = -wx / far, -wy / far
            arm = (hx * vy - hy * vx) / length
            rows[d, k, 0], rows[d, k, 1], rows[d, k, 2] = vx, vy, arm
            # Nominal gaps hold the position error to first order already; take the true one.
            first = nominal_rows[d, k, 0] * apart[d, j, 0] + nominal_rows[d, k, 1] * apart[d, j, 1]
            true = nominal_gaps[d, k] - first - (far - eccentricity)
            gaps[d, k] = true - (
                vx * (x - state[0]) + vy * (y - state[1]) + arm * (t * length - state[2])
            )


@numba.njit(cache=True, error_model="numpy")
def _overlaps(force: Any, cam_force: Any) -> tuple[float, float]:
    """Greatest overlap and the sum of their squares; on springs of 1 N/m a force is one."""
    greatest, squares = 0.0, 0.0
    for d in range(force.shape[0]):
        for k in range(force.shape[1]):
            greatest = max(greatest, force[d, k])
            squares += force[d, k] * force[d, k]
        cam = cam_force[d, 0] * cam_force[d, 0] + cam_force[d, 1] * cam_force[d, 1]
        greatest = max(greatest, math.sqrt(cam))
        squares += cam
    return greatest, squares


@numba.njit(cache=True, error_model="numpy")
def backlash_sweep(
    nominal_rows: Any,
    nominal_gaps: Any,
    curvature: Any,
    tooth_centre: Any,
    own_angle: Any,
    pin_angle: Any,
    apart: Any,
    offset: Any,
    half_play: Any,
    eccentricity: float,
    length: float,
    angles: Any,
    crank_angle: Any,
    sense: float,
    starts: Any,
    ends: Any,
    preload: Any,
    poses: Any,
) -> int:
    """Extreme carrier angle of rigid parts at some crank angles.

    Parameters
    ----------
    nominal_rows : array (A, D, C, 3)
        n_x, n_y, h/length at the nominal pose.
    nominal_gaps : array (A, D, C)
        With errors, m.
    curvature : array (A, D, T)
        Of the curve parallel to the flank through each tooth's centre, 1/m.
    tooth_centre : array (T, 2)
        Nominal, m.
    own_angle : array (A, D)
        Crank angle of every disc, rad.
    pin_angle : array (A, P)
        Of every pin in the ring's frame, rad.
    apart : array (A, D, P, 2)
        Hole off its pin by position errors, in the ring's frame, m.
    offset, half_play : array (A, D, 2), (D,)
        Of the cams, m.
    eccentricity, length : float
        e and the pin circle, m.
    angles : array (B,)
        Indices of the angles to solve, rising.
    crank_angle : array (A,)
        rad.
    sense : float
        1 for the greatest carrier angle, -1 for the least.
    starts : array (A, 3 + 3 D)
        Known poses nearby, such as those of the perfect gearbox, or zeros; a state starts from
        its own plus the deviation of the one before.
    ends : array (B,)
        Out: that angle, rad; meaningless where parts overlap whatever they do.
    preload : array (B,)
        Out: greatest overlap that no motion removes, m; clearances give about the push.
    poses : array (B, 3 + 3 D)
        Out: carrier and discs there, angles times `length`, m.

    Returns
    -------
    int
        -1, or the place in `angles` that did not converge.
    """
    discs, contacts = nominal_gaps.shape[1:]
    teeth = tooth_centre.shape[0]
    size = 3 + 3 * discs
    work = np.empty(6 * size + 2 * discs * contacts + 12 * discs + 6)
    rows = np.empty((discs, contacts, 3))
    gaps = np.empty((discs, contacts))
    force = np.empty((discs, contacts))
    cam_force = np.empty((discs, 2))
    ones = np.ones((discs, contacts))
    soft = np.zeros(discs)
    state, origin, deviation = np.zeros(size), np.zeros(size), np.zeros(size)
    last, before = np.zeros(size), np.zeros(size)
    push = sense * _PUSH
    for b in range(angles.size):
        a = angles[b]
        if b > 0:
            turn = crank_angle[a] - crank_angle[angles[b - 1]]
            predict(last, before, turn, 1, deviation)
        for i in range(size):
            state[i] = starts[a, i] + deviation[i]
        squares, overlap, worst, still, tight = 0.0, 0.0, 0.0, False, 0
        for round_ in range(_ROUNDS):
            if round_ > _FREE_ROUNDS:
                # Two states that lead to each other: linearise between them.
                for i in range(size):
                    state[i] = 0.5 * (state[i] + origin[i])
            origin[:] = state
            _true_gaps(
                nominal_rows[a], nominal_gaps[a], curvature[a], tooth_centre, own_angle[a],
                pin_angle[a], apart[a], eccentricity, length, teeth, state, rows, gaps,
            )  # fmt: skip
            # A firmer push first: it finds which contacts matter in fewer steps.
            firm = _FIRM * push if round_ == 0 else push
            status, _, _ = solve_state(
                rows, gaps, ones, teeth, (2, 2), (0.0, 0.0), soft, (1.0, 1.0), offset[a],
                half_play, 0.0, firm, 1.0, state, force, cam_force, work,
            )  # fmt: skip
            if status != CONVERGED:
                return b
            # States that change contacts with each other end up closer than anyone can measure.
            near = _NEARLY_STILL if round_ > 2 * _FREE_ROUNDS else _STILL
            still = round_ > 0 and abs(state[2] - origin[2]) <= near
            overlap, squares = _overlaps(force, cam_force)
            # Parts that overlap wherever they go have no free range to converge to.
            tight = tight + 1 if overlap > OVERLAP else 0
            if round_ > _FREE_ROUNDS:
                worst = max(worst, overlap)
            if still or tight > 3:
                break
        if not (still or tight > 3):
            if worst <= _TOUCHING:
                return b
            # Free by nanometres at most, on all sides: too little to be called a range.
            overlap = max(worst, 2.0 * OVERLAP)
        # What the springs yield to the push: the work of the push is that of the contact forces
        # over gaps and overlaps, and rigid parts have the same forces without the overlaps.
        ends[b] = (state[2] - squares / push) / length
        preload[b] = overlap
        poses[b] = state
        for i in range(size):
            last[i] = state[i] - starts[a, i]
    return -1
