"""The room that housing and clamp leave the ring along the axis: a little, at all their limits.

The clamp rests on the housing all round, so that its screws press metal on metal where they stand.
A ring that stood proud of its seat would bend the clamp's thin flange instead; one that rattles
would be no clamp's work. So both faces have narrow limits, and what they leave at their worst, and
in heat and cold, is drawn as play; a retaining compound holds the ring in it.
"""

from __future__ import annotations

import math

from cqdd_design.catalog.materials import find_material
from cqdd_design.solids.features.flat import thickness_limits
from cqdd_design.solids.features.making import RING_FACE

_LEAST = 10e-6
"""Play that is left at the worst limits, m."""
_COLDER, _WARMER = 60.0, 100.0
"""Than the 20 deg C at which lengths hold (ISO 1), K."""
_STEP = 0.01e-3
"""To which the play is rounded up, m."""


def ring_play(ring: str, housing: str, thickness: float) -> float:
    """Play of a ring between ledge and clamp with nominal lengths, m.

    Parameters
    ----------
    ring, housing : str
        Catalogue names of their materials. Where the thermal expansion of one is not known, both
        are taken to grow alike.
    thickness : float
        Of the ring, m.

    Examples
    --------
    >>> round(1e3 * ring_play("AISI 52100 / 100Cr6 hardened", "7075-T6", 16.5e-3), 9)
    0.09
    >>> round(1e3 * ring_play("AISI 4140 Q&T 540C", "AISI 4140 Q&T 540C", 16.5e-3), 9)
    0.07
    """
    grows = [find_material(name).expansion for name in (ring, housing)]
    apart = 0.0 if None in grows else (grows[1] or 0.0) - (grows[0] or 0.0)
    lost = thickness * max(apart * _COLDER, -apart * _WARMER)
    thicker = thickness_limits(ring, thickness)[1]
    least = thicker + 2.0 * RING_FACE + _LEAST + lost
    return math.ceil(round(least / _STEP, 6)) * _STEP
