"""A ring on a fine lattice, its teeth loaded by pressures on patches, its outside on springs."""

from __future__ import annotations

import numpy as np
import plane_stress
from scipy.sparse import coo_matrix

from cqdd_design.gearbox.bodies.ring import RingShape


def ring_stress_at(
    shape: RingShape,
    contacts: np.ndarray,
    forces: np.ndarray,
    place: complex,
    half_width: float,
    coarse: float,
) -> float:
    """E times the elongation of the side of the toothed contour nearest to a place, Pa.

    Parameters
    ----------
    contacts, forces : complex arrays
        Where the forces on the ring act, and they, N.
    place : complex
        On the toothed contour, m.
    half_width, coarse : float
        Of the patches, and side of the lattice away from them, m.
    """
    contour, plate = shape.loops()[1], shape.plate

    def outside(u: np.ndarray) -> np.ndarray:
        return shape.outer * np.exp(2j * np.pi * np.asarray(u))

    def teeth(u: np.ndarray) -> np.ndarray:
        return contour.curve(np.mod(u, 1.0))[0]

    rim = teeth(np.arange(20_001) / 20_000)
    angle = np.unwrap(np.angle(rim))
    rising = np.argsort(np.mod(angle, 2.0 * np.pi))
    around, reach = np.mod(angle, 2.0 * np.pi)[rising], np.abs(rim)[rising]

    def inside(z: np.ndarray) -> np.ndarray:
        """The contour meets every ray once."""
        within = np.interp(np.mod(np.angle(z), 2.0 * np.pi), around, reach, period=2.0 * np.pi)
        return (np.abs(z) < shape.outer) & (np.abs(z) > within)

    loaded = forces != 0.0
    mesh = plane_stress.lattice(
        plane_stress.Domain([outside, teeth], inside),
        coarse,
        [*contacts[loaded], place],
        half_width / 5.0,
    )
    matrix = plane_stress.stiffness(mesh, plate.modulus, plate.poisson, plate.thickness)
    seated = mesh.edges[0]
    springs = shape.seat * plane_stress.nodal(mesh, 0, lambda z: 1.0 + 0.0 * z)[2 * seated]
    both = np.concatenate([2 * seated, 2 * seated + 1])
    matrix = matrix + coo_matrix((np.tile(springs, 2), (both, both)), shape=matrix.shape)
    load = np.zeros(2 * len(mesh.nodes))
    for contact, force in zip(contacts[loaded], forces[loaded], strict=True):
        patch = plane_stress.nodal(
            mesh,
            1,
            lambda z, c=contact: np.sqrt(
                np.clip(half_width**2 - np.abs(z - c) ** 2, 0.0, None)
            ).astype(complex),
        )[0::2]
        patch /= patch.sum()
        load[0::2] += patch * force.real
        load[1::2] += patch * force.imag
    moved = plane_stress.solve(matrix.tocsc(), load[:, None], [])[:, 0]
    corners = mesh.edges[1][0::2]
    z, u = mesh.nodes[corners], moved[2 * corners] + 1j * moved[2 * corners + 1]
    side, longer = np.roll(z, -1) - z, np.roll(u, -1) - u
    nearest = int(np.abs(z + 0.5 * side - place).argmin())
    strain = (np.conj(side) * longer).real / np.abs(side) ** 2
    return float(plate.modulus * strain[nearest])
