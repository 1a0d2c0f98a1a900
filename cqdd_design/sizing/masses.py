"""Closed-form mass and reflected inertia of the parts that the search decides.

Counted: discs, ring (as long as the pack), shoulders of the output pins over their free span, cam
bearings, and solid eccentrics in their bores. Housing, carrier plates and shaft ends are much the
same for every candidate and left out. The inertia counts the motor's rotor, because only what a
candidate adds to it matters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox.output_pins import pin_span
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing.frame import Frame

SCOPE = "discs, ring, output pins over their free span, cam bearings and eccentrics"
"""What is counted, in words."""
SHAFT_DENSITY = 7850.0
"""Steel eccentrics, kg/m^3."""


@dataclass(frozen=True)
class Weights:
    """Mass and reflected inertia of candidates.

    Attributes
    ----------
    mass : array
        kg.
    gearbox_inertia : array
        At the crank, without the rotor, kg m^2.
    reflected_inertia : array
        At the crank, with the rotor, kg m^2; nan where the rotor's is not known.
    """

    mass: FloatArray
    gearbox_inertia: FloatArray
    reflected_inertia: FloatArray


def weigh(
    frame: Frame,
    *,
    profile_area: ArrayLike,
    profile_polar: ArrayLike,
    ring_opening: ArrayLike,
    ring_outer: ArrayLike,
    eccentricity: ArrayLike,
    thickness: ArrayLike,
    pin_count: ArrayLike,
    pin_diameter: ArrayLike,
    sleeve_diameter: ArrayLike,
    hole_radius: ArrayLike,
    pin_circle: ArrayLike,
    bearing_outer: ArrayLike,
    bearing_bore: ArrayLike,
    bearing_mass: ArrayLike,
) -> Weights:
    """Mass and reflected inertia; every argument broadcasts, SI.

    Sleeves count with what is between them and their pins, in every disc; 0 m of bare pins.
    The crank turns its eccentrics and the inner half of each cam bearing, carries each disc with
    the outer half round at e, and turns discs and pins at 1/n.
    """
    e, b = np.asarray(eccentricity, dtype=float), np.asarray(thickness, dtype=float)
    count, d = np.asarray(pin_count, dtype=float), np.asarray(pin_diameter, dtype=float)
    hole, circle = np.asarray(hole_radius, dtype=float), np.asarray(pin_circle, dtype=float)
    seat = 0.5 * np.asarray(bearing_outer, dtype=float)
    bore = 0.5 * np.asarray(bearing_bore, dtype=float)
    half_bearing = 0.5 * np.asarray(bearing_mass, dtype=float)
    discs, n2 = frame.disc_count, frame.lobe_count**2

    hole_area, seat_area = math.pi * hole * hole, math.pi * seat * seat
    area = np.asarray(profile_area, dtype=float) - count * hole_area - seat_area
    polar = (
        np.asarray(profile_polar, dtype=float)
        - count * hole_area * (0.5 * hole * hole + circle * circle)
        - 0.5 * seat_area * seat * seat
    )
    disc = frame.disc_density * b * area
    disc_spin = frame.disc_density * b * polar
    shaft = SHAFT_DENSITY * math.pi * bore * bore * b
    sleeve = np.asarray(sleeve_diameter, dtype=float)
    over = np.where(sleeve > 0.0, sleeve * sleeve - d * d, 0.0) * discs * b
    shoulders = d * d * pin_span(discs, b, frame.spacing)
    pins = count * frame.pin_density * math.pi / 4.0 * (shoulders + over)
    pack = discs * b + (discs - 1) * frame.spacing
    outside = math.pi * np.asarray(ring_outer, dtype=float) ** 2
    ring = frame.ring_density * pack * (outside - np.asarray(ring_opening, dtype=float))

    mass = discs * (disc + 2.0 * half_bearing + shaft) + pins + ring
    turning = shaft * (0.5 * bore * bore + e * e) + half_bearing * (bore * bore + e * e)
    orbiting = (disc + half_bearing) * e * e
    spinning = (disc_spin + half_bearing * seat * seat) / n2
    inertia = discs * (turning + orbiting + spinning) + pins * circle * circle / n2
    turned = inertia + (np.nan if frame.rotor_inertia is None else frame.rotor_inertia)
    return Weights(np.asarray(mass), np.asarray(inertia), np.asarray(turned))
