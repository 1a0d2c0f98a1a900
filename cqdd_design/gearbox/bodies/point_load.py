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
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.point_load_values import Spread
from cqdd_design.geometry.contours import ComplexArray, FloatArray

DEPTH = 1e-3
"""Depth under a point force from which bodies count, m; other depths follow by a logarithm."""


_AT_ONCE = 8192
"""Points times places whose fields are found together: what a processor keeps at hand."""


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

    def some(self, which: NDArray[np.int64]) -> Places:
        """The places `which`."""
        return Places(self.point[which], self.inward[which], self.void[which])

    @property
    def directions(self) -> ComplexArray:
        """Of two unit loads a place, (2 N,): along the normal, then along i times the normal."""
        return np.asarray(np.repeat(self.inward, 2) * np.tile([1.0, 1.0j], len(self)))

    def spread(self) -> Spread:
        """The same as kernels read it."""
        void = np.where(np.isnan(self.void), np.nan, self.void)
        return Spread(*(_plane(one)[k] for one in (self.point, self.inward, void) for k in (0, 1)))


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


def traction(z: ComplexArray, normal: ComplexArray, places: Places) -> FloatArray:
    """Force per length on edges of outward `normal` at `z` (Q,) by the loads of places, N/m.

    Returns
    -------
    array (2, Q, 2 N)
        Along x, and along y; of every place the loads along :attr:`Places.directions`.
    """
    # numba takes its time to come in, and `size` and `check` do without.
    from cqdd_design.gearbox.bodies.point_load_kernel import tractions

    found = np.empty((2, len(z), 2 * len(places)))
    tractions(_plane(z), _plane(normal), places.spread(), found)
    return found


def displacement(z: ComplexArray, places: Places, plate: Plate) -> FloatArray:
    """Displacement at `z` (Q,) by the loads of places, m.

    At the load itself it is that of the point :data:`DEPTH` under it in the half plane: what is
    nearer to the load is the contact law's.

    Returns
    -------
    array (2, Q, 2 N)
        As :func:`traction`.
    """
    return displacement_of(np.arange(len(places))[None], z, places, plate)


def displacement_of(
    which: NDArray[np.int64], z: ComplexArray, places: Places, plate: Plate
) -> FloatArray:
    """Displacement at points by the loads of some places each, m.

    Parameters
    ----------
    which : array (W, M)
        Places.
    z : complex array (W Q,)
        Points, Q of them for each row of `which`.

    Returns
    -------
    array (2, W Q, 2 M)
        As :func:`displacement`.
    """
    from cqdd_design.gearbox.bodies.point_load_kernel import displacements, separations

    # A view has another type, for which numba would compile both kernels anew.
    which = np.ascontiguousarray(which)
    at, spread, count = _plane(z), places.spread(), which.shape[1]
    found = np.empty((2, len(z), 2 * count))
    rows = max(_AT_ONCE // max(count, 1), 1)
    unit = 1.0 / (2.0 * np.pi * plate.shear)
    for first in range(0, len(z), rows):
        apart = np.empty((3, min(rows, len(z) - first), count))
        separations(at, which, spread, DEPTH, first, apart)
        # numpy's logarithms and angles, many at once, take a tenth of compiled ones, one by one.
        even = apart[:2]
        np.arctan2(apart[1], apart[2], out=even[1])
        np.log(apart[0], out=even[0])
        even[0] *= 0.5 * (plate.kappa + 1.0)
        even[1] *= plate.kappa - 1.0
        displacements(at, which, spread, DEPTH, first, even, unit, found)
    return found


def stress(z: ComplexArray, places: Places, along: ComplexArray) -> FloatArray:
    """Normal stress times thickness in the direction `along` at `z` (Q,), (Q, 2 N), N/m."""
    x, y = traction(z, along, places)
    return np.asarray(x * along.real[:, None] + y * along.imag[:, None])


def _plane(z: ComplexArray) -> FloatArray:
    return np.stack([z.real, z.imag])
