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
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.materials import Material
from cqdd_design.geometry.contours import FloatArray

_MU_0 = 4e-7 * math.pi
REMANENCE = 1.32
"""Of NdFeB magnets, T: the most of grade N42 (IEC 60404-8-1)."""
_SHARE = 0.6
"""Of what a rotor moves, that comes back as more pull through the web; shaft and bearings have the
rest to 1, where it would be pulled over."""
_STEP = 0.01e-3
_RADII = 400
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


class WebHoles(NamedTuple):
    """Holes through a web, evenly round the axis; m."""

    number: int
    circle: float
    radius: float

    def solid(self, at: FloatArray) -> FloatArray:
        """Share of the web's circumference at radii (n,) that the holes leave."""
        reach = (at**2 + self.circle**2 - self.radius**2) / (2.0 * at * self.circle)
        return np.asarray(1.0 - self.number * np.arccos(np.clip(reach, -1.0, 1.0)) / math.pi)


NO_HOLES = WebHoles(0, 1.0, 0.0)


def web_tilting_rate(
    inner: float,
    outer: float,
    thickness: float,
    modulus: float,
    nu: float,
    holes: WebHoles = NO_HOLES,
) -> float:
    """Moment that tilts a stiff hub in a plate by one radian against a stiff rim, N m/rad.

    Kirchhoff's plate, w = (A r + B/r + C r^3 + D r ln r) cos t, clamped at both: the moment is
    4 pi D times the plate's E t^3/(12 (1 - nu^2)). What holes leave of a circumference carries the
    moments of all of it: the plate's energy counts there as often as it is more than that.

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
    _, b, c, singular = np.linalg.solve(np.array(rows), np.array([inner, 1.0, 0.0, 0.0])).tolist()
    plate = modulus * thickness**3 / (12.0 * (1.0 - nu**2))
    whole = float(abs(4.0 * math.pi * plate * singular))
    if not holes.number:
        return whole
    at = np.linspace(inner, outer, _RADII)
    along = 2.0 * b / at**3 + 6.0 * c * at + singular / at
    across = -2.0 * b / at**3 + 2.0 * c * at + singular / at
    energy = (along**2 + across**2 + 2.0 * nu * along * across + 2.0 * (1.0 - nu) * across**2) * at
    return whole * float(energy.sum() / (energy / holes.solid(at)).sum())


class WebLoad(NamedTuple):
    """A bell or hub whose web carries a pulled rotor.

    Attributes
    ----------
    inner, outer : float
        Radius of hub and rim, m.
    arm : float
        From the web's upper face to the middle of the magnets, m.
    rate : float
        Of the pull, N/m.
    metal : Material
        Of the web.
    """

    inner: float
    outer: float
    arm: float
    rate: float
    metal: Material

    def share(self, thickness: float, holes: WebHoles = NO_HOLES) -> float:
        """Of what the rotor moves, that comes back as more pull as the web tilts."""
        tilting = web_tilting_rate(
            self.inner,
            self.outer,
            thickness,
            self.metal.youngs_modulus,
            self.metal.poisson_ratio,
            holes,
        )
        return float(self.rate * (self.arm + 0.5 * thickness) ** 2 / tilting)


def stiff_web(load: WebLoad, least: float) -> float:
    """Thickness of a web that holds its rotor against the pull, in steps of 0.01 mm, m.

    Parameters
    ----------
    least : float
        Thickness that it has anyway, m.
    """
    if load.inner >= load.outer:
        return least
    thickness = least
    while load.share(thickness) > _SHARE:
        thickness = round(thickness + _STEP, 8)
    return math.ceil(round(thickness / _STEP, 6)) * _STEP if thickness > least else least


def stiff_holes(load: WebLoad, thickness: float, most: WebHoles, least: float) -> WebHoles:
    """The largest lightening holes with which a web still holds its rotor, none below a radius (m).

    Their radius is lowered in steps of a quarter of the least, so that they leave spokes.
    """
    if load.inner >= load.outer:
        return most
    holes = most
    while holes.radius > least and load.share(thickness, holes) > _SHARE:
        holes = holes._replace(radius=holes.radius - 0.25 * least)
    return holes if holes.radius > least else NO_HOLES
