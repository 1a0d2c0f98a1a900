r"""Compiled: compliance between the contacts of a body, from its influence matrix.

Contacts stand between the places of the matrix (four of them, with weights), so that a compliance
is a double sum over places. A disc's bore gives way on its rolling elements besides. With R_j the
compliance from load j to the elements' stations, times the roots r of their stiffnesses, N the
radial directions times r, n_j the direction of the load, F = 1 + r G r, S = N' F^-1 N and
q_j = n_j - N' F^-1 R_j, the disc on its elements gives at i under load j what it does with its
reactions spread evenly round the raceway and

    - R_i' F^-1 R_j + q_i' S^-1 q_j,

less the rigid disc's n_i' (N' N)^-1 n_j. Stations without stiffness bear nothing and drop out.
A plain numpy twin stands in ``tests/oracles/bodies_plain.py``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.files.kernel_arrays import put_rows
from cqdd_design.files.kernel_cache import numba
from cqdd_design.files.kernel_part import part


@numba.njit(cache=True, error_model="numpy")
def add_contacts(
    near: Any, share: Any, normal: Any, shear: Any, deeper: Any, pushed: Any, rubbed: Any
) -> None:
    """Add a body's compliance between its contacts.

    Parameters
    ----------
    near, share : array (A, C, 4)
        Places round every contact, and their weights.
    normal, shear : array (P, P)
        Displacement along the normal of a place by a unit force along the normal of another, and
        along its tangent, m/N.
    deeper : array (A, C)
        What the matrix counts at a contact itself below the depth that the law counts, m/N.
    pushed, rubbed : array (A, E, E) with E >= C
        Out, m/N: displacement along a contact's normal by a unit force along the normal of another,
        and along its tangent.
    """
    count, contacts, _ = near.shape
    for a in range(count):
        for i in range(contacts):
            for j in range(contacts):
                along, across = 0.0, 0.0
                for k in range(4):
                    row, weight = near[a, i, k], share[a, i, k]
                    if i == j:
                        # A force's own place: its field is singular, and not to be mixed.
                        along += weight * normal[row, row]
                        across += weight * shear[row, row]
                        continue
                    for m in range(4):
                        both, column = weight * share[a, j, m], near[a, j, m]
                        along += both * normal[row, column]
                        across += both * shear[row, column]
                if i == j:
                    along -= deeper[a, i]
                pushed[a, i, j] += along
                rubbed[a, i, j] += across


@part(borrows=True, forceinline=True)
def _solve_lower(matrix: Any, given: Any, size: int, columns: int) -> None:
    """Cholesky's lower factor L of a positive definite matrix, over it, and L^-1 `given`.

    Row by row, so that the innermost step is the same for many numbers side by side.
    """
    for k in range(size):
        own = 1.0 / math.sqrt(matrix[k, k])
        for c in range(columns):
            given[k, c] *= own
        for i in range(k + 1, size):
            matrix[k, i] *= own
        for i in range(k + 1, size):
            factor = matrix[k, i]
            for j in range(i, size):
                matrix[i, j] -= factor * matrix[k, j]
            for c in range(columns):
                given[i, c] -= factor * given[k, c]


@part(borrows=True, forceinline=True)
def _inverse(a: float, b: float, c: float) -> tuple[float, float, float]:
    """Entries of the inverse of [[a, b], [b, c]]."""
    determinant = a * c - b * b
    return c / determinant, -b / determinant, a / determinant


@numba.njit(cache=True, error_model="numpy")
def add_bearing(
    near: Any,
    share: Any,
    normal: Any,
    shear: Any,
    stations: Any,
    radial: Any,
    stiffness: Any,
    direction: Any,
    slip: Any,
    smooth: Any,
    rubbing: Any,
) -> None:
    """Add how a disc gives way on its bearing's rolling elements, less the rigid disc on them.

    Parameters
    ----------
    near, share
        As in :func:`add_contacts`.
    normal, shear : array (P, B)
        Displacement at the stations by unit forces at the places, m/N.
    stations : array (B, B)
        Between stations, m/N.
    radial : array (B, 2)
        Outward, of every station.
    stiffness : array (A, B)
        Of the rolling elements, N/m.
    direction : array (A, C, 2)
        Of every normal force.
    slip : array (A, C)
        Force along the tangent over the normal force.
    smooth, rubbing : array (A, C, C)
        Out, m/N: without friction, and with it; of no length where it is not asked for.
    """
    count, contacts, _ = near.shape
    rubs = rubbing.shape[0] > 0
    loads = 2 * contacts if rubs else contacts
    most = len(radial)
    under, root = np.empty(most, dtype=np.int64), np.empty(most)
    flexible, given = np.empty((most, most)), np.empty((most, loads + 2))
    way, left, moved = np.empty((loads, 2)), np.empty((loads, 2)), np.empty(loads)
    for a in range(count):
        size, seat_xx, seat_xy, seat_yy = 0, 0.0, 0.0, 0.0
        for b in range(most):
            if stiffness[a, b] > 0.0:
                under[size], root[size] = b, math.sqrt(stiffness[a, b])
                seat_xx += stiffness[a, b] * radial[b, 0] * radial[b, 0]
                seat_xy += stiffness[a, b] * radial[b, 0] * radial[b, 1]
                seat_yy += stiffness[a, b] * radial[b, 1] * radial[b, 1]
                size += 1
        seat_xx, seat_xy, seat_yy = _inverse(seat_xx, seat_xy, seat_yy)
        for c in range(contacts):
            x, y = direction[a, c, 0], direction[a, c, 1]
            way[c, 0], way[c, 1] = x, y
            if rubs:
                way[contacts + c, 0] = x - slip[a, c] * y
                way[contacts + c, 1] = y + slip[a, c] * x
        given[:, :] = 0.0
        for i in range(size):
            station = under[i]
            for j in range(i, size):
                flexible[i, j] = root[i] * stations[station, under[j]] * root[j]
            flexible[i, i] += 1.0
            for c in range(contacts):
                pushed, rubbed = 0.0, 0.0
                for k in range(4):
                    row, weight = near[a, c, k], share[a, c, k]
                    pushed += weight * normal[row, station]
                    if rubs:
                        rubbed += weight * shear[row, station]
                given[i, c] = root[i] * pushed
                if rubs:
                    given[i, contacts + c] = root[i] * (pushed + slip[a, c] * rubbed)
            given[i, loads] = root[i] * radial[station, 0]
            given[i, loads + 1] = root[i] * radial[station, 1]
        _solve_lower(flexible, given, size, loads + 2)
        s_xx, s_xy, s_yy = 0.0, 0.0, 0.0
        put_rows(left, way)
        for i in range(size):
            x, y = given[i, loads], given[i, loads + 1]
            s_xx, s_xy, s_yy = s_xx + x * x, s_xy + x * y, s_yy + y * y
            for c in range(loads):
                left[c, 0] -= given[i, c] * x
                left[c, 1] -= given[i, c] * y
        s_xx, s_xy, s_yy = _inverse(s_xx, s_xy, s_yy)
        for i in range(contacts):
            drift_x = s_xx * left[i, 0] + s_xy * left[i, 1]
            drift_y = s_xy * left[i, 0] + s_yy * left[i, 1]
            rigid_x = seat_xx * way[i, 0] + seat_xy * way[i, 1]
            rigid_y = seat_xy * way[i, 0] + seat_yy * way[i, 1]
            for c in range(loads):
                moved[c] = drift_x * left[c, 0] + drift_y * left[c, 1]
                moved[c] -= rigid_x * way[c, 0] + rigid_y * way[c, 1]
            for k in range(size):
                factor = given[k, i]
                for c in range(loads):
                    moved[c] -= factor * given[k, c]
            for c in range(contacts):
                smooth[a, i, c] += moved[c]
                if rubs:
                    rubbing[a, i, c] += moved[contacts + c]
