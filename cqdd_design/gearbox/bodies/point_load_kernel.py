"""Compiled kernels of the half-plane fields: every load at every point of an edge.

The plain twin is `tests/oracles/flamant_plain.py`, in complex numbers as the equations stand in
:mod:`.point_load`. Of a place all is found once for its two loads: where A turns to i A, what goes
with A turns with it, and what goes with its conjugate turns back.
"""

from __future__ import annotations

import math

from cqdd_design.files.kernel_cache import numba
from cqdd_design.gearbox.bodies.mesh import IntArray
from cqdd_design.gearbox.bodies.point_load_values import Spread
from cqdd_design.geometry.contours import FloatArray

_OWN = 1e-26
"""Square of the distance from a load, over that from the origin, below which it is its own place:
graded points of quadrature come within 1e-9."""


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
def separations(
    z: FloatArray, which: IntArray, places: Spread, depth: float, first: int, found: FloatArray
) -> None:
    """Of what logarithm and angle are wanted, from point `first` of (2, P) on, (3, Q, N).

    The square of the distance over that from where the field ends; sine and cosine of the angle
    between the two, by any factor. Point p of P is seen with row ``p W / P`` of `which` (W, N).
    """
    # Out of their tuple: numba counts references at every access.
    point_x, point_y, inward_x, inward_y, void_x, void_y = places
    for q in range(found.shape[1]):
        x, y = z[0, first + q], z[1, first + q]
        row = (first + q) * which.shape[0] // z.shape[1]
        ratio, sine, cosine = found[0, q], found[1, q], found[2, q]
        for j in range(which.shape[1]):
            k = which[row, j]
            dx, dy = x - point_x[k], y - point_y[k]
            square = dx * dx + dy * dy
            over = point_x[k] * point_x[k] + point_y[k] * point_y[k]
            if square < _OWN * over:
                # On the edge itself the angle is the mean of both sides: the inward normal's.
                dx, dy = depth * inward_x[k], depth * inward_y[k]
                square = depth * depth
            ox, oy = -point_x[k], -point_y[k]
            if not math.isnan(void_x[k]):
                ox, oy = x - void_x[k], y - void_y[k]
                over = ox * ox + oy * oy
            ratio[j] = square / over
            sine[j], cosine[j] = dy * ox - dx * oy, dx * ox + dy * oy


@numba.njit(cache=True, error_model="numpy")
def displacements(
    z: FloatArray,
    which: IntArray,
    places: Spread,
    depth: float,
    first: int,
    even: FloatArray,
    unit: float,
    found: FloatArray,
) -> None:
    """Displacements of (2, P, 2 N) from point `first` on, as :func:`separations`.

    `even` (2, Q, N) has what goes with A, `unit` is 1/(2 pi) over twice the shear stiffness.
    """
    point_x, point_y, inward_x, inward_y, void_x, void_y = places
    for q in range(even.shape[1]):
        x, y = z[0, first + q], z[1, first + q]
        row = (first + q) * which.shape[0] // z.shape[1]
        size, turn = even[0, q], even[1, q]
        along_x, along_y = found[0, first + q], found[1, first + q]
        for j in range(which.shape[1]):
            k = which[row, j]
            ax, ay = -unit * inward_x[k], -unit * inward_y[k]
            dx, dy = x - point_x[k], y - point_y[k]
            square = dx * dx + dy * dy
            if square < _OWN * (point_x[k] * point_x[k] + point_y[k] * point_y[k]):
                dx, dy = depth * inward_x[k], depth * inward_y[k]
                square = depth * depth
            twist_x, twist_y = (dx * dx - dy * dy) / square, 2.0 * dx * dy / square
            if not math.isnan(void_x[k]):
                ox, oy = x - void_x[k], y - void_y[k]
                over = ox * ox + oy * oy
                twist_x -= (ox * ox - oy * oy) / over
                twist_y -= 2.0 * ox * oy / over
            even_x, even_y = ax * size[j] - ay * turn[j], ay * size[j] + ax * turn[j]
            odd_x, odd_y = ax * twist_x + ay * twist_y, ax * twist_y - ay * twist_x
            along_x[2 * j], along_x[2 * j + 1] = even_x - odd_x, -even_y - odd_y
            along_y[2 * j], along_y[2 * j + 1] = even_y - odd_y, even_x + odd_x
