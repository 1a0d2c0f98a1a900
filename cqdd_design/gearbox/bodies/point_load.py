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

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.geometry.contours import ComplexArray, FloatArray

DEPTH = 1e-3
"""Depth under a point force from which bodies count, m; other depths follow by a logarithm."""


_AT_ONCE = 12000
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
        """The places `which`, an array of any shape."""
        return Places(self.point[which], self.inward[which], self.void[which])

    @property
    def bored(self) -> bool:
        """Whether they lie in holes: all of them, where not outside."""
        return not np.isnan(self.void).any()

    @property
    def directions(self) -> ComplexArray:
        """Of two unit loads a place, (2 N,): along the normal, then along i times the normal."""
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


def traction(z: ComplexArray, normal: ComplexArray, places: Places) -> FloatArray:
    """Force per length on edges of outward `normal` at `z` (Q,) by the loads of places, N/m.

    Returns
    -------
    array (2, Q, 2 N)
        Along x, and along y; of every place the loads along :attr:`Places.directions`.
    """

    def field(z: ComplexArray, normal: ComplexArray, some: Places) -> Field:
        total = _radial(z - some.point, normal, some.inward)
        if not some.bored:
            return total
        back = _radial(z - some.void, normal, some.inward)
        return Field(*(one - other for one, other in zip(total, back, strict=True)))

    return _everywhere(field, places, z, normal)


def displacement(z: ComplexArray, places: Places, plate: Plate) -> FloatArray:
    """Displacement at `z` (Q,) by the loads of places, m.

    At the load itself it is that of the point :data:`DEPTH` under it in the half plane: what is
    nearer to the load is the contact law's.

    Returns
    -------
    array (2, Q, 2 N)
        As :func:`traction`.
    """
    return _everywhere(lambda z, some: displaced(z, some, plate), places, z)


class Field(NamedTuple):
    """A field's parts along x and y by the normal loads, and by the tangential ones."""

    normal_x: FloatArray
    normal_y: FloatArray
    tangential_x: FloatArray
    tangential_y: FloatArray


def displaced(z: ComplexArray, places: Places, plate: Plate) -> Field:
    """Displacement at `z` by either load of places that are all in holes or all outside, m.

    `z` and the places may have any shapes that go together.
    """
    # In real numbers, since numpy's complex ones take four times as long.
    A = -places.inward / (2.0 * np.pi * plate.shear)
    ax, ay = A.real, A.imag
    away = z - places.point
    dx, dy = away.real.copy(), away.imag.copy()
    square = dx * dx + dy * dy
    own = square < 1e-18 * _square(places.point)
    if own.any():
        # On the edge itself the angle is the mean of both sides: that of the inward normal.
        dx, dy = (
            np.where(own, DEPTH * part, given)
            for part, given in ((places.inward.real, dx), (places.inward.imag, dy))
        )
        square = dx * dx + dy * dy
    over = z - places.void if places.bored else -places.point
    ox, oy = over.real.copy(), over.imag.copy()
    over_square = ox * ox + oy * oy
    size = (0.5 * (plate.kappa + 1.0)) * np.log(square / over_square)
    turn = (plate.kappa - 1.0) * np.arctan2(dy * ox - dx * oy, dx * ox + dy * oy)
    # (z - z0)^2 over its size
    twist_x, twist_y = (dx * dx - dy * dy) / square, 2.0 * dx * dy / square
    if places.bored:
        twist_x -= (ox * ox - oy * oy) / over_square
        twist_y -= 2.0 * ox * oy / over_square
    # A (size + i turn), and conj(A) twist, which changes its sign when A is turned to i A.
    even_x, even_y = ax * size - ay * turn, ay * size + ax * turn
    odd_x, odd_y = ax * twist_x + ay * twist_y, ax * twist_y - ay * twist_x
    return Field(even_x - odd_x, even_y - odd_y, -even_y - odd_y, even_x + odd_x)


def stress(z: ComplexArray, places: Places, along: ComplexArray) -> FloatArray:
    """Normal stress times thickness in the direction `along` at `z` (Q,), (Q, 2 N), N/m."""
    x, y = traction(z, along, places)
    return np.asarray(x * along.real[:, None] + y * along.imag[:, None])


def _everywhere(field: Callable[..., Field], places: Places, *at: ComplexArray) -> FloatArray:
    """A field of both loads of places at points (Q,), block by block, (2, Q, 2 N)."""
    count = len(at[0])
    found = np.empty((2, count, len(places), 2))
    rows = max(_AT_ONCE // max(len(places), 1), 1)
    for bored in (False, True):
        which = np.flatnonzero(np.isnan(places.void) != bored)
        some = places.some(which)
        # A slice where it can be one: it is written far faster.
        one_run = len(which) > 0 and which[-1] - which[0] == len(which) - 1
        columns = slice(which[0], which[-1] + 1) if one_run else which
        for first in range(0, count if len(which) else 0, rows):
            block = slice(first, first + rows)
            parts = field(*(one[block, None] for one in at), some)
            for k, part in enumerate(parts):
                found[k % 2, block, columns, k // 2] = part
    return found.reshape(2, count, 2 * len(places))


def _radial(away: ComplexArray, normal: ComplexArray, inward: ComplexArray) -> Field:
    dx, dy, ix, iy = away.real.copy(), away.imag.copy(), inward.real, inward.imag
    square = dx * dx + dy * dy
    common = (-2.0 / np.pi * normal.real) * dx + (-2.0 / np.pi * normal.imag) * dy
    common /= square * square
    along, across = common * (ix * dx + iy * dy), common * (ix * dy - iy * dx)
    return Field(along * dx, along * dy, across * dx, across * dy)


def _square(z: ComplexArray) -> FloatArray:
    return np.asarray(z.real * z.real + z.imag * z.imag)
