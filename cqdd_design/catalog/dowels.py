"""Ground dowels (ISO 8734): the sizes there are, and how they carry a torque.

Two ways, with N dowels at a radius R under a torque T, of which each takes ``F = T/(s N R)``; the
share s of those that bear is 1 for one and `SHARE` for several, because holes are never all in
their places (DIN 6892, several keys)::

    along a seam, half in either part:   tau = F/(d l)           p = 2 F/(d l)
    across a joint of two faces:         tau = F/(pi/4 d^2)      p = F/(d l)

(Wittel and others 2017, Roloff/Matek Maschinenelemente, section 9.3: longitudinal and transverse
pins.) The length l counts without the ends' chamfers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

# Diameter, chamfer, shortest and longest, mm (ISO 8734:1997, table 1).
_SIZES = (
    (1.0, 0.2, 3, 10),
    (1.5, 0.3, 4, 16),
    (2.0, 0.35, 5, 20),
    (2.5, 0.4, 6, 24),
    (3.0, 0.5, 8, 30),
    (4.0, 0.63, 10, 40),
    (5.0, 0.8, 12, 50),
    (6.0, 1.2, 14, 60),
    (8.0, 1.6, 18, 80),
    (10.0, 2.0, 22, 100),
    (12.0, 2.5, 26, 100),
)
_LENGTHS = (3, 4, 5, 6, 8, *range(10, 33, 2), *range(35, 101, 5))

SHEAR_STRENGTH = 896e6
"""At which hardened ground pins break, Pa: 130 ksi of single shear (ASME B18.8.2-2000, the loads of
its table of hardened ground machine dowel pins)."""
SHARE = 0.75
"""Of several dowels, those that bear."""
MATERIAL = "AISI 52100 / 100Cr6 hardened"
"""Of type A, hardened through to 550 to 650 HV 30 (ISO 8734:1997, table 2)."""


@dataclass(frozen=True)
class Dowel:
    """A ground dowel, m.

    Attributes
    ----------
    diameter, length : float
        Nominal; the diameter is m6.
    chamfer : float
        At either end, which does not bear.
    """

    diameter: float
    length: float
    chamfer: float

    @property
    def designation(self) -> str:
        """Such as ``ISO 8734 3 m6 x 10 A``."""
        return f"ISO 8734 {1e3 * self.diameter:g} m6 x {1e3 * self.length:g} A"

    @property
    def bearing_length(self) -> float:
        """Between the chamfers, m."""
        return self.length - 2.0 * self.chamfer


def dowels() -> tuple[Dowel, ...]:
    """Every dowel of the standard, the thinnest and shortest first."""
    return tuple(
        Dowel(diameter * 1e-3, length * 1e-3, chamfer * 1e-3)
        for diameter, chamfer, least, most in _SIZES
        for length in _LENGTHS
        if least <= length <= most
    )


def dowels_within(most_diameter: float, most_length: float) -> tuple[Dowel, ...]:
    """The longest dowel of every diameter that goes into a hole, the thickest first.

    Parameters
    ----------
    most_diameter, most_length : float
        Room for it, m.

    Examples
    --------
    >>> [one.designation for one in dowels_within(2.2e-3, 4.6e-3)]
    ['ISO 8734 1.5 m6 x 4 A', 'ISO 8734 1 m6 x 4 A']
    """
    longest: dict[float, Dowel] = {}
    for one in dowels():
        if one.diameter <= most_diameter + 1e-9 and one.length <= most_length + 1e-9:
            longest[one.diameter] = one
    return tuple(longest[diameter] for diameter in sorted(longest, reverse=True))


@dataclass(frozen=True)
class DowelStress:
    """What each of several dowels bears: its own shear, and the mean pressure on a seat, Pa."""

    shear: float
    pressure: float


def dowel_force(torque: float, count: int, radius: float) -> float:
    """On one of `count` dowels on a circle (radius, m) under a torque (N m), N."""
    return torque / ((SHARE if count > 1 else 1.0) * count * radius)


def along_a_seam(
    torque: float, count: int, radius: float, diameter: float, length: float
) -> DowelStress:
    """Of dowels whose axes lie in the seam of two parts, half of each dowel in either.

    Parameters
    ----------
    torque : float
        N m.
    radius : float
        Of the seam, m.
    length : float
        That bears, m.

    Examples
    --------
    One of 6 mm along a shaft of 30 mm under 100 N m, on 30 mm: p = 4 T/(D d l) = 74 MPa.

    >>> print(f"{along_a_seam(100.0, 1, 15e-3, 6e-3, 30e-3).pressure / 1e6:.1f}")
    74.1
    """
    force = dowel_force(torque, count, radius)
    return DowelStress(force / (diameter * length), 2.0 * force / (diameter * length))


def across_a_joint(
    torque: float, count: int, radius: float, diameter: float, length: float
) -> DowelStress:
    """Of dowels that stand in both of two faces.

    Parameters
    ----------
    length : float
        That bears in the part that is judged, m; the rest as in :func:`along_a_seam`.
    """
    force = dowel_force(torque, count, radius)
    return DowelStress(force / (0.25 * math.pi * diameter**2), force / (diameter * length))
