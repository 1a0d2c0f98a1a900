"""Sliding at ring teeth and output pins: path per radian of crank, and friction work.

The disc turns by -1/n per radian of crank about its pitch point P, which stands still on the ring.
A ring tooth at c therefore slides by (c - P).n_hat/n per radian, n_hat the contact normal: the
part of the velocity along the flank. In the carrier's frame the disc does not turn at all; it goes
round a circle of radius e at (1 + 1/n) of the crank, so every point of it, and every hole, moves at
the same speed e (1 + 1/n), across the crank direction in which the pins push::

        pin plain in its hole            sleeve on the pin
          v = e w (1 + 1/n)            the sleeve rolls in the hole at v and slides on
                                       the pin at v d_pin/d_sleeve

A ring pin that is free to turn in its pocket gains nothing: it rolls on the disc, and slides in
the pocket at the same surface speed under the same force. A pinwheel ring without sleeves is
therefore counted like a solid one. Every function broadcasts.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray


def ring_sliding(
    lobe_count: int, point: ArrayLike, normal: ArrayLike, pitch_point: ArrayLike
) -> FloatArray:
    """Sliding path at contacts with the fixed ring, per radian of crank.

    Parameters
    ----------
    lobe_count : int
        n.
    point, normal : array_like (..., 2)
        Contact point (m) and unit normal.
    pitch_point : array_like (..., 2)
        Instantaneous centre of the disc, (n + 1) e along its crank, m.

    Returns
    -------
    array (...)
        |(c - P).n_hat|/n in m/rad, not negative; |c - P|/n where the normal passes through P, as
        it does everywhere on an unmodified flank.
    """
    arm = np.asarray(point, dtype=float) - np.asarray(pitch_point, dtype=float)
    along = np.sum(arm * np.asarray(normal, dtype=float), axis=-1)
    return np.asarray(np.abs(along) / lobe_count)


def pin_sliding(lobe_count: int, eccentricity: ArrayLike) -> FloatArray:
    """Path of a disc's holes over the output pins per radian of crank, e (1 + 1/n), m/rad.

    Examples
    --------
    >>> print(round(1e3 * float(pin_sliding(10, 1.6e-3)), 2))
    1.76
    """
    return np.asarray(np.asarray(eccentricity, dtype=float) * (1.0 + 1.0 / lobe_count))


def friction_work(coefficient: ArrayLike, force: ArrayLike, sliding: ArrayLike) -> FloatArray:
    """Coulomb friction work of a row of contacts per radian of crank, N m.

    Parameters
    ----------
    coefficient : array_like
        mu.
    force, sliding : array_like (..., contacts)
        Normal forces (N) and sliding path per radian of crank (m/rad).

    Returns
    -------
    array (...)
        Sum of mu F s: the torque at the crank that friction takes; times the crank's speed, the
        power in W.
    """
    work = np.asarray(force, dtype=float) * np.asarray(sliding, dtype=float)
    return np.asarray(np.asarray(coefficient, dtype=float) * work.sum(axis=-1))
