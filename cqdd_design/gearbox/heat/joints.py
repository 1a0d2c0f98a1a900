"""Heat from part to part: grease between them, seats, bearings, the winding in its slots."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray

GREASE_CONDUCTIVITY = 0.14
"""Of grease, W/(m K): that of its base oil, 0.13 to 0.15 (Lugt 2013, Grease Lubrication in Rolling
Bearings, ch. 3; handbook value not re-read)."""
ROUGHNESS = 1e-6
"""Grease that stays between faces that touch, m: about their roughness."""
SEAT_GAP = 37e-6
"""Air that a seat counts as, m: mean of laminations in aluminium frames (Staton, Boglietti and
Cavagnino 2005, IEEE Trans. Energy Convers. 20, 620-628, table II; 10 to 77 um)."""
SEAT_AIR = 0.027
"""Conductivity of the air in it, W/(m K)."""
LINER, LINER_CONDUCTIVITY = 0.25e-3, 0.21
"""Slot liner, m, and W/(m K) (as above)."""
RESIN_CONDUCTIVITY, FILL = 0.2, 0.4
"""Of the impregnation, W/(m K), and copper's share of a slot (as above)."""
BUSH_FILM = 25e-6
"""Mean film of grease in a plain bush, m."""


def film_conductance(
    gap: ArrayLike, equivalent_radius: ArrayLike, half_width: float, length: float
) -> FloatArray:
    """Of the grease between two cylinders side by side, W/K.

    The gap opens as h + x^2/(2 R) to either side of where they are nearest, and heat crosses it
    straight: k L times the integral of dx over the gap, 2 sqrt(2 R/h) atan(x/sqrt(2 R h)).

    Parameters
    ----------
    gap : array_like
        h, m; faces that touch count as :data:`ROUGHNESS` apart.
    equivalent_radius : array_like
        R of the pair, m.
    half_width : float
        x at which the grease ends, m.
    length : float
        L, m.
    """
    h = np.maximum(np.asarray(gap, dtype=float), 0.0) + ROUGHNESS
    wide = 2.0 * np.asarray(equivalent_radius, dtype=float)
    reach = np.arctan(half_width / np.sqrt(wide * h))
    return np.asarray(GREASE_CONDUCTIVITY * length * 2.0 * np.sqrt(wide / h) * reach)


def seat_conductance(radius: float, length: float) -> float:
    """Of a round seat, W/K."""
    return SEAT_AIR / SEAT_GAP * 2.0 * math.pi * radius * length


def bearing_conductance(mean_diameter: float, speed: float) -> float:
    """Of a greased rolling bearing from ring to ring, W/K.

    R = 0.45 (0.12 - d) (33 - w d), d in m and w in rad/s (Kylander 1995, Temperature modelling of
    small cage induction motors, Chalmers, eq. 5.32; as quoted by Boglietti et al. 2009; handbook
    value not re-read). Measured on motors' ball bearings; held at 0.08 m and 20 m/s beyond.
    """
    size = min(mean_diameter, 0.08)
    return 1.0 / (0.45 * (0.12 - size) * (33.0 - min(speed * size, 20.0)))


def bush_conductance(radius: float, length: float) -> float:
    """Of a greased plain bush, W/K."""
    return GREASE_CONDUCTIVITY / BUSH_FILM * 2.0 * math.pi * radius * length


def winding_conductance(slots: int, slot_depth: float, middle: float, length: float) -> float:
    """From the mean of a winding to its teeth, W/K.

    Slots half as wide as their pitch, each with a coil against either wall that heats evenly: its
    mean is w/(3 k) above the wall, w half of the slot's width. k across the wires by Hashin and
    Shtrikman 1962 (for windings: Simpson, Wrobel and Mellor 2013): k_r (1 + v)/(1 - v).

    Parameters
    ----------
    slots : int
    slot_depth, middle, length : float
        Of the slots, radius of their middle, and length of the laminations, m.
    """
    across = RESIN_CONDUCTIVITY * (1.0 + FILL) / (1.0 - FILL)
    coil = 0.25 * 2.0 * math.pi * middle / slots
    walls = 2.0 * slots * slot_depth * length
    return walls / (LINER / LINER_CONDUCTIVITY + coil / (3.0 * across))
