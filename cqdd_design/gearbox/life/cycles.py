"""How often each place of the gearbox is loaded in one turn of the output, and where.

The ring stands still, so the load zone passes every tooth once a crank turn: n times. While it
does, the contact runs out along the tooth and back again, so that a point of the tooth is rolled
over twice each time, by two places of the flank. Disc, holes and pins turn backwards with the
output, so the load zone passes them n + 1 times. A point of a flank, of a hole or of a pin is
rolled over once each time, always at the same angle of the crank against it; as every part but
the ring's number of the tooth is then back in its place, always under the same pressure when the
parts are perfect.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from cqdd_design.geometry.contours import FloatArray

IntArray = NDArray[np.int64]

_LEAST_ANGLES, _LEAST_PLACES = 120, 360


def ring_tooth_cycles(lobe_count: int) -> int:
    """Load cycles of a ring tooth, in the zone of one disc, per output turn: n."""
    return lobe_count


def disc_cycles(lobe_count: int) -> int:
    """Load cycles of a point of a flank, of a hole and of a pin per output turn: n + 1."""
    return lobe_count + 1


def steps_per_tooth(lobe_count: int, pin_count: int) -> int:
    """Crank angles per tooth pitch that give the period of both stages 120 angles or more.

    A ring tooth is then seen at 360 places of the crank or more.
    """
    shared = math.gcd(lobe_count, pin_count)
    for_period = -(-_LEAST_ANGLES * shared // lobe_count)
    return max(for_period, -(-_LEAST_PLACES // (lobe_count + 1)))


def crank_angles(lobe_count: int, pin_count: int) -> FloatArray:
    """Crank angles over the mesh period on which all teeth see the same places of the crank.

    Returns
    -------
    array (A,)
        rad, the end left out; A = q n/gcd(n, N_w) with q of :func:`steps_per_tooth`.
    """
    steps = steps_per_tooth(lobe_count, pin_count)
    count = steps * lobe_count // math.gcd(lobe_count, pin_count)
    return np.asarray(2.0 * math.pi / ((lobe_count + 1) * steps) * np.arange(count))


def tooth_passes(lobe_count: int, pin_count: int) -> tuple[IntArray, IntArray]:
    """Where a sweep over :func:`crank_angles` shows one ring tooth all round the crank.

    A period later every tooth carries what the one n/gcd(n, N_w) before it carried, so the teeth
    of one period make up all the passes that a single tooth sees in an output turn. There are
    n/gcd(n, N_w) different ones, each gcd(n, N_w) times, because the pins stand differently.

    Returns
    -------
    angle, tooth : array (M, B + 1)
        Indices into a sweep's arrays for pass m at the crank angle 2 pi b/B against the tooth;
        B = (n + 1) q, and the last column closes the turn.
    """
    steps = steps_per_tooth(lobe_count, pin_count)
    different = lobe_count // math.gcd(lobe_count, pin_count)
    count = steps * different
    first = np.arange(different)[:, None]
    along = first * steps + np.arange((lobe_count + 1) * steps + 1)
    periods = along // count
    return along % count, (first - periods * different) % (lobe_count + 1)


def other_touch(shortening: float, crank: FloatArray) -> FloatArray:
    """Crank angle at which the place of a tooth touched at `crank` is touched again, rad.

    The contact normal runs from the tooth's centre through the pitch point, which goes round the
    circle of radius K1 R; a line through the tooth cuts that circle twice, at crank angles that
    add up to pi less twice its inclination psi.

    Parameters
    ----------
    shortening : float
        K1.
    crank : array
        Crank angle of the disc against the tooth, rad.

    Examples
    --------
    >>> print(np.degrees(other_touch(0.5, np.radians([30.0, 60.0]))).round(6))
    [102.412046  60.      ]
    """
    return np.asarray(math.pi - 2.0 * contact_inclination(shortening, crank) - crank)


def contact_inclination(shortening: float, crank: FloatArray) -> FloatArray:
    """Inclination psi of the contact normal to the tooth's radius, rad (see `other_touch`)."""
    return np.asarray(
        np.arctan2(shortening * np.sin(crank), 1.0 - shortening * np.cos(crank)), dtype=float
    )
