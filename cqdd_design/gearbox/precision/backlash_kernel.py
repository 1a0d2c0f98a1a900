"""Compiled kernel of the backlash: how far the carrier turns before rigid parts stop it.

The carrier is pushed by a vanishing torque against springs, which in the limit maximises its
angle under "no gap negative". Each solution is a new state to linearise at, with the true
positions of holes and pins and each flank as its osculating circle, until it stands still.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import put
from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.equilibrium_kernel import CONVERGED, new_work, solve_state
from cqdd_design.gearbox.contact.kernel_values import (
    Contacts,
    Extremes,
    Forces,
    Load,
    RigidParts,
    Springs,
)
from cqdd_design.gearbox.contact.sweep_kernel import predict

OVERLAP = 1e-7
"""Overlap, m, above which parts are said to be preloaded and not merely touching."""
CLOSED = 5e-8
"""Range at the pin circle, m, up to which preloaded parts leave none: springs yield to the push."""

_PUSH = 2e-9
"""Force on springs of 1 N/m; the parts yield by about as many metres, which is taken off again."""
_FIRM = 20.0
_NEARLY_STILL = 2e-8
"""The same for states that do not settle: 4e-3 arcmin at 20 mm."""
_CLOSE = 2e-7
"""Metres at the pin circle within which states may go on changing: 0.03 arcmin at 20 mm."""
_APART = 1e-10
"""Added to all gaps where many of none at all leave a state undecided, m."""
_AGAINST = 0.02
"""Push on parts that are pressed on each other, over the greatest of their forces: on springs they
give way by as much of their overlap, and the slope that their curved flanks make is less."""
_YIELDS = 16.0
"""Most that a push moves springs of 1 N/m by, over it; beyond that other contacts bear it."""
_PUSHED = 4.0 * _PUSH
"""Overlap, m, that the push alone stays below; beyond it parts are pressed on each other."""
_ROUNDS, _FREE_ROUNDS = 40, 8
_STILL = 2e-10
"""Metres at the pin circle between two rounds that count as standing still: 1e-4 arcmin or less."""


@part(borrows=True)
def _true_gaps(parts: RigidParts, at: int, pins: Any, state: Any, rows: Any, gaps: Any) -> None:
    """Rows and gaps linearised at the displaced state, with gaps in the nominal coordinates.

    `at` is the index of the crank angle; `pins` (P, 4) has the pins' nominal places there, and room
    for those to which the carrier has turned them. A gap is seen as that of the flank's osculating
    circle of curvature kappa: with the tooth moved by a outward and b along, it opens by
    (2 a + kappa (a^2 + b^2))/(1 + sqrt((1 + kappa a)^2 + (kappa b)^2)).
    """
    eccentricity, length, tooth_centre = parts.eccentricity, parts.length, parts.tooth_centre
    nominal_rows, nominal_gaps = parts.rows[at], parts.gaps[at]
    curvature, own_angle = parts.curvature[at], parts.own_angle[at]
    pin_angle, apart = parts.pin_angle[at], parts.apart[at]
    teeth = tooth_centre.shape[0]
    discs, contacts = nominal_gaps.shape
    turn = state[2] / length
    for j in range(contacts - teeth):
        pins[j, 2] = length * math.cos(pin_angle[j] + turn)
        pins[j, 3] = length * math.sin(pin_angle[j] + turn)
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
            px, py = pins[j, 0], pins[j, 1]
            # Hole from the disc's centre, and the pin, both displaced; then hole from pin.
            hx, hy = c * px - s * py, s * px + c * py
            gx, gy = pins[j, 2], pins[j, 3]
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


@part(borrows=True)
def _overlaps(forces: Forces) -> tuple[float, float]:
    """Greatest overlap and the sum of their squares; on springs of 1 N/m a force is one."""
    force, cam_force = forces.contact, forces.cam
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
    parts: RigidParts, angles: Any, sense: float, starts: Any, found: Extremes
) -> int:
    """Extreme carrier angle of rigid parts at some crank angles.

    Parameters
    ----------
    parts : RigidParts
        At A crank angles.
    angles : array (B,)
        Indices of the angles to solve, rising.
    sense : float
        1 for the greatest carrier angle, -1 for the least.
    starts : array (A, 3 + 3 D)
        Known poses nearby, such as those of the perfect gearbox, or zeros; a state starts from
        its own plus the deviation of the one before.
    found : Extremes
        Out.

    Returns
    -------
    int
        -1, or the place in `angles` that did not converge.
    """
    discs, count = parts.gaps.shape[1:]
    length, size = parts.length, 3 + 3 * discs
    work = new_work(discs, count)
    rows = np.empty((discs, count, 3))
    gaps = np.empty((discs, count))
    ones = np.ones((discs, count))
    pin_angle = parts.pin_angle
    pins = np.empty((pin_angle.shape[1], 4))
    forces = Forces(np.empty((discs, count)), np.empty((discs, 2)))
    # Linear springs of 1 N/m everywhere, and a rigid bearing of the carrier.
    springs = Springs(parts.tooth_centre.shape[0], 2, 2, 0.0, 0.0, np.zeros(discs), 1.0, 1.0, 0.0)
    state, origin, deviation = np.zeros(size), np.zeros(size), np.zeros(size)
    last, before = np.zeros(size), np.zeros(size)
    for b in range(angles.size):
        a = angles[b]
        if b > 0:
            turn = parts.crank_angle[a] - parts.crank_angle[angles[b - 1]]
            predict(last, before, turn, 1, deviation)
        for i in range(size):
            state[i] = starts[a, i] + deviation[i]
        for j in range(pins.shape[0]):
            pins[j, 0] = length * math.cos(pin_angle[a, j])
            pins[j, 1] = length * math.sin(pin_angle[a, j])
        squares, overlap, moved, still, push = 0.0, 0.0, 0.0, False, sense * _PUSH
        for round_ in range(_ROUNDS):
            if round_ > _FREE_ROUNDS:
                # Two states that lead to each other: linearise between them.
                for i in range(size):
                    state[i] = 0.5 * (state[i] + origin[i])
            put(origin, state)
            _true_gaps(parts, a, pins, state, rows, gaps)
            contacts = Contacts(rows, gaps, ones, parts.offset[a], parts.half_play)
            # A firmer push first: it finds which contacts matter in fewer steps.
            firm = Load(_FIRM * push if round_ == 0 else push, 1.0)
            status, _, _ = solve_state(contacts, springs, firm, state, forces, work)
            if status != CONVERGED:
                # Many contacts of no gap at all, as of perfect parts: apart by next to nothing.
                for d in range(discs):
                    for k in range(count):
                        gaps[d, k] += _APART
                put(state, origin)
                status, _, _ = solve_state(contacts, springs, firm, state, forces, work)
                if status != CONVERGED:
                    return b
            # States that change contacts with each other end up closer than anyone can measure.
            near = _NEARLY_STILL if round_ > 2 * _FREE_ROUNDS else _STILL
            moved = abs(state[2] - origin[2])
            still = round_ > 0 and moved <= near
            overlap, squares = _overlaps(forces)
            if still:
                break
            # Of parts that are pressed on each other, more than what bends of their gaps does.
            push = sense * (_PUSH if overlap <= _PUSHED else max(_PUSH, _AGAINST * overlap))
        if overlap <= _PUSHED:
            if not still and moved > _CLOSE:
                return b
            # What the springs yield to the push: the work of the push is that of the contact forces
            # over gaps and overlaps, and rigid parts have the same forces without the overlaps.
            found.ends[b] = (state[2] - squares / push) / length
        else:
            if not still:
                # A valley so shallow that its bottom is all there is.
                for i in range(size):
                    state[i] = 0.5 * (state[i] + origin[i])
            put(origin, state)
            contacts = Contacts(rows, gaps, ones, parts.offset[a], parts.half_play)
            status, _, _ = solve_state(
                contacts, springs, Load(0.5 * push, 1.0), state, forces, work
            )
            # In proportion to the push while the same contacts bear it.
            yielded = 2.0 * (state[2] - origin[2])
            same = status == CONVERGED and still and abs(yielded) <= _YIELDS * abs(push)
            put(state, origin)
            found.ends[b] = (state[2] + (yielded if same else 0.0)) / length
        found.preload[b] = overlap
        put(found.poses[b], state)
        for i in range(size):
            last[i] = state[i] - starts[a, i]
    return -1
