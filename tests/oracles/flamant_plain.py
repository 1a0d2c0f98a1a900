"""Half-plane fields of point forces in complex numbers, load by load: twin of the kernels."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.bodies.point_load import DEPTH, Places, Plate


def tractions_plain(z: np.ndarray, normal: np.ndarray, places: Places) -> np.ndarray:
    """Complex tractions (Q, 2 N) on edges of outward `normal` at `z`, N/m."""
    point, void = np.repeat(places.point, 2), np.repeat(places.void, 2)
    force, normal = places.directions, normal[:, None]

    def radial(away: np.ndarray) -> np.ndarray:
        along = (np.conj(force) * away).real * (np.conj(normal) * away).real
        return -2.0 / np.pi * along * away / np.abs(away) ** 4

    back = radial(z[:, None] - np.nan_to_num(void))
    return radial(z[:, None] - point) - np.where(np.isnan(void), 0.0, back)


def displacements_plain(z: np.ndarray, places: Places, plate: Plate) -> np.ndarray:
    """Complex displacements (Q, 2 N) at `z`, m: Kolosov's formula with phi = A log(z - z0)."""
    point, inward, void = (np.repeat(one, 2) for one in vars(places).values())
    A, hole = -places.directions / (2.0 * np.pi), ~np.isnan(void)
    away = z[:, None] - point
    away = np.where(np.abs(away) < 1e-9 * np.abs(point), DEPTH * inward, away)
    over = np.where(hole, z[:, None] - np.nan_to_num(void), -point)
    log = np.log(np.abs(away / over)) + 0j
    turn = np.angle(away * np.conj(over))
    field = A * ((plate.kappa + 1.0) * log + 1j * (plate.kappa - 1.0) * turn)
    field -= np.conj(A) * away / np.conj(away)
    field += np.where(hole, np.conj(A) * over / np.conj(over), 0.0)
    return field / plate.shear
