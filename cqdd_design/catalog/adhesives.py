"""Retaining compounds of cylindrical joints, and the torque that they hold.

A joint of diameter d and length l is sheared by ``tau = 2 T/(pi d^2 l)``; it may be by the
compound's strength, less for what it bonds and for its temperature, over a safety (Wittel and
others 2017, Roloff/Matek Maschinenelemente, section 5.1, safety 1.5 to 2.5).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.materials import Material

_STEEL, _METAL = 180e9, 40e9
"""Least Young's modulus of a steel and of a metal, Pa."""
SAFETY = 2.0
"""On the strength of a bonded joint, in the middle of the range of Roloff/Matek."""


@dataclass(frozen=True)
class RetainingCompound:
    """An anaerobic adhesive for cylindrical parts.

    Attributes
    ----------
    strength : float
        Least compressive shear strength on steel pins and collars (ISO 10123), Pa.
    metal_share : float
        Of that on other metals.
    full_until, half_at, hottest : float
        Temperatures from which the strength falls, at which it has fallen to a half, on a straight
        line, and beyond which none is known, deg C.
    source : str
        Where this comes from.
    """

    name: str
    strength: float
    metal_share: float
    full_until: float
    half_at: float
    hottest: float
    source: str

    def share_on(self, material: Material) -> float:
        """Share of the strength on steel; 0 on plastics, where it does not cure."""
        if material.youngs_modulus >= _STEEL:
            return 1.0
        return self.metal_share if material.youngs_modulus >= _METAL else 0.0

    def share_at(self, temperature: float) -> float:
        """Of the strength at room temperature that is left at a temperature (deg C).

        Examples
        --------
        >>> ROTOR_COMPOUND.share_at(22.0), ROTOR_COMPOUND.share_at(150.0)
        (1.0, 0.5)
        """
        if temperature > self.hottest:
            return 0.0
        beyond = max(temperature - self.full_until, 0.0)
        return 1.0 - 0.5 * beyond / (self.half_at - self.full_until)


NUT_LOCKING = (
    "A medium-strength threadlocker (such as LOCTITE 243, which hand tools undo) goes on the "
    "thread, none on the bearing."
)
"""How a nut without a tab washer is kept (Henkel, LOCTITE 243 technical data sheet)."""

RING_COMPOUND = "LOCTITE 641"
"""Round the ring, which wears and comes out again: of medium strength, for joints that are to be
taken apart (Henkel, LOCTITE 641 technical data sheet). No torque is asked of it."""

EPOXY = "LOCTITE EA 9466"
"""Where a retaining compound does not cure, which takes metal all round: a toughened epoxy of two
parts, to 120 degC (Henkel, LOCTITE EA 9466 technical data sheet)."""

ROTOR_COMPOUND = RetainingCompound(
    name="LOCTITE 648",
    strength=25e6,
    metal_share=0.5,
    full_until=22.0,
    half_at=150.0,
    hottest=175.0,
    source="Henkel, LOCTITE 648 technical data sheet (2013): at least 25 N/mm2 on steel pins and "
    "collars by ISO 10123; aluminium and hot strength as its graphs, read coarsely to the safe "
    "side; handbook value not re-read",
)
"""For rotors on the shafts of motors."""


def joint_shear(torque: float, diameter: float, length: float) -> float:
    """Mean shear stress of a cylindrical joint, Pa.

    Parameters
    ----------
    torque : float
        N m.
    diameter, length : float
        m.

    Examples
    --------
    >>> print(f"{joint_shear(10.0, 10e-3, 10e-3) / 1e6:.2f}")
    6.37
    """
    return torque / (0.5 * math.pi * diameter**2 * length)


def length_needed(torque: float, diameter: float, shear: float) -> float:
    """Length of a joint that bears a shear stress (Pa), m; the rest as in :func:`joint_shear`."""
    return torque / (0.5 * math.pi * diameter**2 * shear)
