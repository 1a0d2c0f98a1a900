"""Compiled kernels of the half-plane fields: every load at every point of an edge.

The plain twin is `tests/oracles/flamant_plain.py`, in complex numbers as the equations stand in
:mod:`.point_load`. Of a place all is found once for its two loads: where A turns to i A, what goes
with A turns with it, and what goes with its conjugate turns back.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.bodies.mesh import IntArray
from cqdd_design.geometry.contours import FloatArray


class Spread(NamedTuple):
    """Places as a kernel reads them, real parts and imaginary ones apart, (N,).

    A place outside has nan as its void.
    """

    point_x: FloatArray
    point_y: FloatArray
    inward_x: FloatArray
    inward_y: FloatArray
    void_x: FloatArray
    void_y: FloatArray


@numba.njit(cache=True, error_model="numpy")
def tractions(z: FloatArray, normal: FloatArray, places: Spread, found: FloatArray) -> None:
    """Tractions at points (2, Q) of normals (2, Q), into an array (2, Q, 2 N)."""
    point_x, point_y, inward_x, inward_y, void_x, void_y = places
    for q in range(z.shape[1]):
        x, y = z[0, q], z[1, q]
        nx, ny = -2.0 / math.pi * normal[0, q], -2.0 / math.pi * normal[1, q]
        along_x, along_y = found[0, q], found[1, q]
        for k in range(len(point_x)):
            ix, iy = inward_x[k], inward_y[k]
            dx, dy = x - point_x[k], y - point_y[k]
            square = dx * dx + dy * dy
            common = (nx * dx + ny * dy) / (square * square)
            push, shear = common * (ix * dx + iy * dy), common * (ix * dy - iy * dx)
            along_x[2 * k], along_x[2 * k + 1] = push * dx, shear * dx
            along_y[2 * k], along_y[2 * k + 1] = push * dy, shear * dy
        for k in range(len(point_x)):
            if math.isnan(void_x[k]):
                continue
            ix, iy = inward_x[k], inward_y[k]
            dx, dy = x - void_x[k], y - void_y[k]
            square = dx * dx + dy * dy
            common = (nx * dx + ny * dy) / (square * square)
            push, shear = common * (ix * dx + iy * dy), common * (ix * dy - iy * dx)
            along_x[2 * k] -= push * dx
            along_x[2 * k + 1] -= shear * dx
            along_y[2 * k] -= push * dy
            along_y[2 * k + 1] -= shear * dy


@numba.njit(cache=True, error_model="numpy")
def displacements(
    z: FloatArray,
    which: IntArray,
    places: Spread,
    kappa: float,
    shear: float,
    depth: float,
    found: FloatArray,
) -> None:
    """Displacements at points (P, 2, Q) by both loads of places `which` (P, N), (P, 2, Q, 2 N).

    Other points are of every row of `which` those at which its places' loads are wanted.
    """
    # Out of their tuple: numba counts references at every access.
    point_x, point_y, inward_x, inward_y, void_x, void_y = places
    unit = 1.0 / (2.0 * math.pi * shear)
    for p in range(which.shape[0]):
        for q in range(z.shape[2]):
            x, y = z[p, 0, q], z[p, 1, q]
            for j in range(which.shape[1]):
                k = which[p, j]
                ax, ay = -unit * inward_x[k], -unit * inward_y[k]
                dx, dy = x - point_x[k], y - point_y[k]
                square = dx * dx + dy * dy
                far = point_x[k] ** 2 + point_y[k] ** 2
                if square < 1e-18 * far:
                    # On the edge itself the angle is the mean of both sides: the inward normal's.
                    dx, dy = depth * inward_x[k], depth * inward_y[k]
                    square = depth * depth
                twist_x, twist_y = (dx * dx - dy * dy) / square, 2.0 * dx * dy / square
                if math.isnan(void_x[k]):
                    ox, oy = -point_x[k], -point_y[k]
                    over = far
                else:
                    ox, oy = x - void_x[k], y - void_y[k]
                    over = ox * ox + oy * oy
                    twist_x -= (ox * ox - oy * oy) / over
                    twist_y -= 2.0 * ox * oy / over
                size = 0.5 * (kappa + 1.0) * math.log(square / over)
                turn = (kappa - 1.0) * math.atan2(dy * ox - dx * oy, dx * ox + dy * oy)
                even_x, even_y = ax * size - ay * turn, ay * size + ax * turn
                odd_x, odd_y = ax * twist_x + ay * twist_y, ax * twist_y - ay * twist_x
                found[p, 0, q, 2 * j] = even_x - odd_x
                found[p, 1, q, 2 * j] = even_y - odd_y
                found[p, 0, q, 2 * j + 1] = -even_y - odd_y
                found[p, 1, q, 2 * j + 1] = even_x + odd_x
