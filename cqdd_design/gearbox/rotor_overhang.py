"""A rotor on the overhung end of a shaft: how far the shaft gives, and where its pull is held.

::

        upper edge |=====| shaft
                   |     |
        lower edge |=====|            arm = lower edge - middle of the magnets
           top of  |_____|
           the hub  hub  |__ web __ [ring of magnets]   force
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from cqdd_design.gearbox.shaft_bending import ShaftSection

_GAUSS = 0.5 / math.sqrt(3.0)
_STEPS = 500
_SETTLED = 1e-12


def overhang_give(
    sections: Sequence[ShaftSection], edges: tuple[float, float], hub_top: float, at: float
) -> float:
    """Deflection of a shaft on two edges along a unit force on what its overhung end carries, m/N.

    Parameters
    ----------
    sections : sequence of ShaftSection
        From the hub's upper end to the upper edge.
    edges : pair of float
        Heights of the lower and the upper edge, m.
    hub_top : float
        Below the lower edge; from here down the hub stiffens the shaft, m.
    at : float
        Height of the force, below or above the edges, m.

    Examples
    --------
    A steel shaft of 10 mm that stands out 30 mm beyond edges 100 mm apart: F a^2 (a + L)/(3 E I).

    >>> bending = 205e9 * np.pi / 64.0 * 10e-3**4
    >>> shaft = [ShaftSection(-0.03, 0.1, bending, np.inf)]
    >>> give = overhang_give(shaft, (0.0, 0.1), -0.03, -0.03)
    >>> round(1e6 * 100.0 * give, 1), round(1e6 * 100.0 * 0.03**2 * 0.13 / (3.0 * bending), 1)
    (38.8, 38.8)
    """
    low, high = edges
    arm, span = low - at, high - low
    ends = np.unique(
        np.clip([low, *(end for one in sections for end in (one.bottom, one.top))], hub_top, high)
    )
    middle, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
    inside = [next(s for s in sections if s.bottom <= x <= s.top) for x in middle]
    x = np.concatenate([middle - _GAUSS * length, middle + _GAUSS * length])
    weight = 0.5 * np.tile(length, 2)
    moment = np.where(x < low, x - at, arm * (high - x) / span)
    force = np.where(x < low, 1.0, -arm / span)
    bent = weight / np.tile([one.bending for one in inside], 2)
    sheared = weight / np.tile([one.shear for one in inside], 2)
    return float(bent @ moment**2 + sheared @ force**2)


def bearings_give(
    force: float, stiffness: float, exponent: float, arm: float, span: float
) -> float:
    """Deflection of a stiff shaft on two bearings at a force beyond the lower of them, m.

    Parameters
    ----------
    force : float
        N, along which the deflection counts.
    stiffness, exponent : float
        Of either bearing, whose force is the stiffness times a power of what it gives.
    arm, span : float
        From the force to the lower bearing, negative where it stands above, and on to the upper, m.

    Examples
    --------
    Of springs of 1 N/um, 10 N give 10 um at the lower one, and (1.5^2 + 0.5^2) times as much half a
    span beyond it:

    >>> [round(1e6 * bearings_give(10.0, 1e6, 1.0, arm, 0.1), 9) for arm in (0.0, 0.05)]
    [10.0, 25.0]
    """
    lower, upper = (
        math.copysign((abs(one) / stiffness) ** (1.0 / exponent), one)
        for one in (force * (1.0 + arm / span), -force * arm / span)
    )
    return lower + (lower - upper) * arm / span


class Settled(NamedTuple):
    """Where a pulled rotor comes to rest."""

    deflection: float
    """m; infinite where the pull grows faster than what holds it."""
    force: float
    """N."""


def settled(
    rate: float, off_centre: float, steady: float, give: Callable[[float], float], gap: float
) -> Settled:
    """Deflection at which what carries a rotor holds its pull, which the deflection itself raises.

    Parameters
    ----------
    rate, off_centre : float
        Of the pull, N/m; and how far the rotor is built off centre, m.
    steady : float
        Other forces, N.
    give : callable
        Deflection under a force, which grows with it.
    gap : float
        At which the rotor touches, m.

    Examples
    --------
    A spring of twice the pull's rate gives as much again as built off centre:

    >>> found = settled(1e6, 50e-6, 0.0, lambda force: force / 2e6, 0.5e-3)
    >>> round(1e6 * found.deflection), round(found.force)
    (50, 100)
    >>> settled(1e6, 50e-6, 0.0, lambda force: force / 0.9e6, 0.5e-3).deflection
    inf
    """
    deflection = 0.0
    for _ in range(_STEPS):
        force = steady + rate * (off_centre + deflection)
        following = give(force)
        if off_centre + following >= gap:
            break
        if abs(following - deflection) <= _SETTLED:
            return Settled(following, force)
        deflection = following
    return Settled(math.inf, math.inf)
