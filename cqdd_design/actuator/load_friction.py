"""Friction under load: a share of the torque carried, and beyond a knee more of what is above it.

With G carried at the output, friction is ``f(G) = mu (G + chi max(G - K, 0))``, mu of its own
while the motor drives and while the output does: what teeth and pins lose for each N m grows with
the load, and the share of the continuous torque would promise too much at the peak.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.parameters import FloatArray, FrictionParameters

_LEAST = 1e-3
"""Of what arrives over what is carried, where friction holds nearly all of it."""


def load_friction(friction: FrictionParameters, carried: ArrayLike) -> FloatArray:
    """Friction in motion under a torque carried, N m, positive where the motor drives; a size, N m.

    Examples
    --------
    A tenth of it, and beyond 10 N m a fifth of the rest.

    >>> some = FrictionParameters(0, 0, 0, 0, 0, 1, 0.1, 0.2, load_knee=10.0, load_growth=1.0)
    >>> load_friction(some, [5.0, 20.0, -5.0]).tolist()
    [0.5, 3.0, 1.0]
    """
    torque = np.asarray(carried, dtype=float)
    size = np.abs(torque)
    share = np.where(torque >= 0.0, friction.load_forward, friction.load_backward)
    beyond = np.maximum(size - friction.load_knee, 0.0)
    return np.asarray(share * (size + friction.load_growth * beyond))


def carried_torque(
    friction: FrictionParameters,
    given: ArrayLike,
    rise: ArrayLike,
    way: ArrayLike,
    least: float = _LEAST,
) -> FloatArray:
    """Torque G carried at the output, a size in N m, of ``given = G + way rise f(G)``.

    Parameters
    ----------
    given : array_like
        At the motor times the ratio, sizes, N m.
    rise : array_like
        Friction over that in motion.
    way : array_like
        1 where the motor drives, -1 where the output does; between, a part of friction is to be
        had.
    least : float
        Least of what arrives over what is carried.

    Examples
    --------
    >>> some = FrictionParameters(0, 0, 0, 0, 0, 1, 0.1, 0.2, load_knee=10.0, load_growth=1.0)
    >>> carried_torque(some, [11.0, 23.0], 1.0, 1.0).tolist()
    [10.0, 20.0]
    """
    size, part = np.asarray(given, dtype=float), np.asarray(way, dtype=float) * rise
    share = part * np.where(part > 0.0, friction.load_forward, friction.load_backward)
    below = np.maximum(1.0 + share, least)
    beyond = np.maximum(1.0 + share * (1.0 + friction.load_growth), least)
    at_knee = below * friction.load_knee
    return np.asarray(
        np.where(size <= at_knee, size / below, friction.load_knee + (size - at_knee) / beyond)
    )
