"""Loads of the bearings beside the cam: statics of the eccentric shaft and of the carrier.

Heights count from the first carrier plate, as those of the output pins do::

     support | plate | s | disc 0 | s | disc 1 | s | plate | support
      first                                                  second
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray


def support_reactions(
    force: ArrayLike, height: ArrayLike, first: float, second: float
) -> FloatArray:
    """Forces of two bearings on a shaft that carries forces between or beyond them.

    Parameters
    ----------
    force : array_like (..., D, 2)
        Forces on the shaft, N.
    height : array_like (D,)
        Where they act along the shaft, m.
    first, second : float
        Heights of the bearings, m, different.

    Returns
    -------
    array (..., 2, 2)
        Forces of the first and of the second bearing on the shaft, by the lever rule, N.

    Examples
    --------
    Opposite forces on two discs load the bearings with a couple:

    >>> pair = [[1000.0, 0.0], [-1000.0, 0.0]]
    >>> support_reactions(pair, [0.004, 0.012], 0.0, 0.016)[:, 0].round(6).tolist()
    [-500.0, 500.0]
    """
    load = np.asarray(force, dtype=float)
    share = ((np.asarray(height, dtype=float) - first) / (second - first))[:, None]
    return np.asarray(
        np.stack([-(load * (1.0 - share)).sum(axis=-2), -(load * share).sum(axis=-2)], axis=-2)
    )


def equivalent_load(
    force: ArrayLike, height: ArrayLike, bearing_height: float, mean_diameter: float
) -> FloatArray:
    """Radial load that stands for the force and tilting moment on a single bearing.

    Parameters
    ----------
    force : array_like (..., K, 2)
        Forces on the part that one bearing carries, N.
    height : array_like (K,)
        Where they act, m.
    bearing_height, mean_diameter : float
        Mid-plane of the bearing and its pitch diameter d_p, m.

    Returns
    -------
    array (...)
        F_r + 2 M/d_p, N (equivalent load of crossed-roller bearings, THK and Harmonic Drive
        catalogues, without their factor X <= 1).
    """
    load = np.asarray(force, dtype=float)
    arm = (np.asarray(height, dtype=float) - bearing_height)[:, None]
    net = np.linalg.norm(load.sum(axis=-2), axis=-1)
    moment = np.linalg.norm((load * arm).sum(axis=-2), axis=-1)
    return np.asarray(net + 2.0 * moment / mean_diameter)
