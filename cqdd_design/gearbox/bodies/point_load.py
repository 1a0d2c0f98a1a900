r"""A force on the edge of a half plane (Flamant): the part of a field that no mesh resolves.

In complex coordinates a force P at z0 on a straight edge makes purely radial stress,
``phi' = A/(z - z0)`` with A = -P/(2 pi), whatever the direction of the edge or of the force
(Muskhelishvili 1953, section 90). A body's own edge is curved: the tractions that this field leaves
there are smooth, and finite elements take them away with a coarse mesh.

The displacement turns with the angle about z0, so its cut must run where there is no material:
outward from a body that is loaded on its outside, and from the edge of a hole to the hole's centre,
where the opposite field ends it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import ComplexArray, FloatArray

DEPTH = 1e-3
"""Depth under a point force from which bodies count, m; other depths follow by a logarithm."""


@dataclass(frozen=True, eq=False)
class Places:
    """Places on edges of a body where it may be loaded.

    Attributes
    ----------
    point, inward : complex array (N,)
        m, and the unit normal into the material.
    void : complex array (N,)
        Centre of the hole whose edge it is, m; nan on the outside.
    """

    point: ComplexArray
    inward: ComplexArray
    void: ComplexArray

    def __len__(self) -> int:
        """Number of places."""
        return len(self.point)

    def loads(self) -> Places:
        """Two unit loads a place: along the normal, then along the tangent (i times the normal)."""
        return Places(*(np.repeat(one, 2) for one in (self.point, self.inward, self.void)))

    @property
    def directions(self) -> ComplexArray:
        """Directions of :meth:`loads`, (2 N,)."""
        return np.asarray(np.repeat(self.inward, 2) * np.tile([1.0, 1.0j], len(self)))


@dataclass(frozen=True)
class Plate:
    """Plane stress: modulus (Pa), Poisson's ratio, thickness (m)."""

    modulus: float
    poisson: float
    thickness: float

    @property
    def kappa(self) -> float:
        """Kolosov's constant (3 - nu)/(1 + nu)."""
        return (3.0 - self.poisson) / (1.0 + self.poisson)

    @property
    def shear(self) -> float:
        """2 G b, N/m."""
        return self.modulus * self.thickness / (1.0 + self.poisson)

    def approach(self, depth: float | FloatArray, half_width: float | FloatArray) -> FloatArray:
        """Approach of a Hertzian patch to a point `depth` under it, by unit force, m/N.

        Johnson 1985, eq. 5.57, in plane stress.
        """
        apart = 2.0 * np.log(2.0 * np.asarray(depth) / half_width) - self.poisson
        return np.asarray(apart / (np.pi * self.modulus * self.thickness))


def traction(
    z: ComplexArray, normal: ComplexArray, loads: Places, force: ComplexArray
) -> ComplexArray:
    """Force per length on edges of outward `normal` at `z` (Q,), by every load, (Q, N), N/m."""
    total = _radial(z[:, None] - loads.point, normal[:, None], force)
    hole = ~np.isnan(loads.void)
    total[:, hole] -= _radial(z[:, None] - loads.void[hole], normal[:, None], force[hole])
    return total


def _radial(away: ComplexArray, normal: ComplexArray, force: ComplexArray) -> ComplexArray:
    square = _square(away)
    along = _dot(force, away) * _dot(normal, away) / (square * square)
    return np.asarray(-2.0 / np.pi * along * away)


def _dot(first: ComplexArray, second: ComplexArray) -> FloatArray:
    return np.asarray(first.real * second.real + first.imag * second.imag)


def _square(z: ComplexArray) -> FloatArray:
    return np.asarray(z.real * z.real + z.imag * z.imag)


def stress(z: ComplexArray, loads: Places, force: ComplexArray, along: ComplexArray) -> FloatArray:
    """Normal stress times thickness in the direction `along` at `z` (Q,), (Q, N), N/m."""
    total = _radial(z[:, None] - loads.point, along[:, None], force)
    hole = ~np.isnan(loads.void)
    total[:, hole] -= _radial(z[:, None] - loads.void[hole], along[:, None], force[hole])
    return np.asarray((total * np.conj(along)[:, None]).real)


def displacement(z: ComplexArray, loads: Places, force: ComplexArray, plate: Plate) -> ComplexArray:
    """Displacement at `z` (Q,) by every load (N,), (Q, N), m.

    At the load itself it is that of the point :data:`DEPTH` under it in the half plane: what is
    nearer to the load is the contact law's.
    """
    A = -force / (2.0 * np.pi)
    away = z[:, None] - loads.point
    own = np.abs(away) < 1e-9 * np.abs(loads.point)
    away = np.where(own, DEPTH * loads.inward, away)
    hole = ~np.isnan(loads.void)
    from_void = z[:, None] - np.where(hole, loads.void, 0.0)
    over = np.where(hole, from_void, -loads.point)
    # On the edge itself the angle is the mean of both sides: that of the inward normal, which
    # `away` has been given.
    square = _square(away)
    size, turn = 0.5 * np.log(square / _square(over)), np.angle(away * np.conj(over))
    field = A * ((plate.kappa + 1.0) * size + 1j * (plate.kappa - 1.0) * turn)
    field -= np.conj(A) * (away * away / square)
    if hole.any():
        back = from_void[:, hole]
        field[:, hole] += np.conj(A[hole]) * (back * back / _square(back))
    return np.asarray(field / plate.shear)
