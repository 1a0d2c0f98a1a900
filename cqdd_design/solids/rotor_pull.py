"""A motor's rotor off its stator's axis: how hard it is pulled, and how its bell's web gives.

Where the rotor is off by e, the air gap is narrower on one side, and that side pulls harder
(Maxwell's stress B^2/(2 mu_0)). With a field B (1 + e/g cos t) round the gap, to first order::

    F = integral of B^2/(2 mu_0) (1 + e/g cos t)^2 cos t R l dt = pi D l B^2 e/(2 mu_0 g)

where g is the gap and the magnets together, which carry no more field than air, and B the field of
magnets of remanence B_r and height h behind a gap d, B = B_r h/(h + d). Iron counts as perfect,
slots and gaps between magnets as filled: all of these overstate the pull.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.catalog.materials import Material

_MU_0 = 4e-7 * math.pi
REMANENCE = 1.32
"""Of NdFeB magnets, T: the most of grade N42 (IEC 60404-8-1)."""
_SHARE = 0.6
"""Of what a rotor moves, that comes back as more pull through the web; shaft and bearings have the
rest to 1, where it would be pulled over."""
_STEP = 0.01e-3
_WORST_HEIGHT = 2.0
"""Of the magnets over the gap: h^2/(h + d)^3 is greatest there, 4/27 of 1/d."""


def pull_rate(diameter: float, length: float, gap: float) -> float:
    """The most that magnets of any height pull, N for each metre off centre.

    Parameters
    ----------
    diameter, length, gap : float
        Of the air gap, m; the gap is radial.

    Examples
    --------
    A motor of 100 mm, 20 mm long with a gap of 0.5 mm pulls with at most 65 N at 0.05 mm:

    >>> round(pull_rate(0.1, 0.02, 0.5e-3) * 0.05e-3)
    65
    """
    height = _WORST_HEIGHT * gap
    field = REMANENCE * height / (height + gap)
    return math.pi * diameter * length * field**2 / (2.0 * _MU_0 * (height + gap))


def web_tilting_rate(
    inner: float, outer: float, thickness: float, modulus: float, nu: float
) -> float:
    """Moment that tilts a stiff hub in a plate by one radian against a stiff rim, N m/rad.

    Kirchhoff's plate, w = (A r + B/r + C r^3 + D r ln r) cos t, clamped at both: the moment is
    4 pi D times the plate's E t^3/(12 (1 - nu^2)).

    Parameters
    ----------
    inner, outer, thickness : float
        Radius of the hub, of the rim, and the plate's thickness, m.
    modulus, nu : float
        E, Pa, and Poisson's ratio.

    Examples
    --------
    Young and Budynas 2002, Roark's Formulas, has E t^3 theta/M of 0.167 and 0.035 for hubs of 0.4
    and 0.6 of the rim:

    >>> [round(1.0 / web_tilting_rate(b, 1.0, 1.0, 1.0, 0.3), 3) for b in (0.4, 0.6)]
    [0.167, 0.035]
    """
    rows = []
    for radius in (inner, outer):
        log = math.log(radius)
        rows.append([radius, 1.0 / radius, radius**3, radius * log])
        rows.append([1.0, -1.0 / radius**2, 3.0 * radius**2, log + 1.0])
    *_, singular = np.linalg.solve(np.array(rows), np.array([inner, 1.0, 0.0, 0.0]))
    plate = modulus * thickness**3 / (12.0 * (1.0 - nu**2))
    return abs(4.0 * math.pi * plate * float(singular))


def stiff_web(
    inner: float, outer: float, arm: float, rate: float, metal: Material, least: float
) -> float:
    """Thickness of a web that holds its rotor against the pull, in steps of 0.01 mm, m.

    What the rotor moves as the web tilts under a pull raises it by at most `_SHARE` of that pull.

    Parameters
    ----------
    inner, outer : float
        Radius of hub and rim, m.
    arm : float
        From the web's upper face to the middle of the magnets, m.
    rate : float
        Of the pull, N/m.
    least : float
        Thickness that it has anyway, m.
    """

    def gives(thickness: float) -> float:
        tilting = web_tilting_rate(
            inner, outer, thickness, metal.youngs_modulus, metal.poisson_ratio
        )
        return rate * (arm + 0.5 * thickness) ** 2 / tilting

    if inner >= outer:
        return least
    thickness = least
    while gives(thickness) > _SHARE:
        thickness = round(thickness + _STEP, 8)
    return math.ceil(round(thickness / _STEP, 6)) * _STEP if thickness > least else least
