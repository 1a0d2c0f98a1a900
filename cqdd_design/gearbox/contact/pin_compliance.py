"""Compliance of an output pin under the force of one disc: bending, shear, and its seats."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.output_pins import PinSupport, disc_positions, pin_span
from cqdd_design.geometry.contours import FloatArray

SEAT_LENGTH = 1.0
"""Length of a pin's seat in its plate, in pin diameters."""


def pin_compliance(
    disc_count: int,
    disc_thickness: float,
    disc_spacing: float,
    pin_diameter: float,
    support: PinSupport,
    pin_modulus: float,
    pin_poisson: float,
    plate_modulus: float,
) -> FloatArray:
    """Deflection of a pin under unit force at the mid-plane of every disc.

    Parameters
    ----------
    disc_count : int
        D.
    disc_thickness, disc_spacing, pin_diameter : float
        b, s and d, m.
    support : {"both", "cantilever"}
        Held in a plate at either end of the span L = D b + (D+1) s, or in one plate only.
    pin_modulus, pin_poisson, plate_modulus : float
        Young's modulus of the pin (Pa) and its Poisson's ratio; Young's modulus of the plates.

    Returns
    -------
    array (D,)
        m/N. Both ends: a^2 (L-a)^2/(3 E I L) + k a (L-a)/(G A L) + the seats' share; cantilever:
        a^3/(3 E I) + k a/(G A) + seat in translation and rotation. Shear coefficient k of a round
        section by Cowper (1966), (7 + 6 nu)/(6 (1 + nu)); a seat of one diameter yields by
        1/(l E_plate) + 1/(l E_pin) (Tate and Rosenfeld 1946, bearing of a fastener).

    Examples
    --------
    A 4 mm steel pin through two 8 mm discs, held at both ends, in nm/N (25.3 of bending, 3.8
    of shear, 1.5 of its seats):

    >>> compliance = pin_compliance(2, 8e-3, 0.5e-3, 4e-3, "both", 205e9, 0.29, 205e9)
    >>> [round(1e9 * float(c), 2) for c in compliance]
    [30.59, 30.59]
    """
    span = float(pin_span(disc_count, disc_thickness, disc_spacing))
    at = disc_positions(disc_count, disc_thickness, disc_spacing)
    inertia = np.pi / 64.0 * pin_diameter**4
    area = np.pi / 4.0 * pin_diameter**2
    shear_modulus = pin_modulus / (2.0 * (1.0 + pin_poisson))
    shear = (7.0 + 6.0 * pin_poisson) / (6.0 * (1.0 + pin_poisson)) / (shear_modulus * area)
    length = SEAT_LENGTH * pin_diameter
    seat = 1.0 / (length * plate_modulus) + 1.0 / (length * pin_modulus)
    bending = 1.0 / (3.0 * pin_modulus * inertia)
    if support == "both":
        rest = span - at
        return np.asarray(
            bending * at**2 * rest**2 / span
            + shear * at * rest / span
            + seat * (at**2 + rest**2) / span**2
        )
    # The seat as an even elastic bed: translation, and rotation under the moment F (a + l/2).
    turn = 12.0 * (at + 0.5 * length) ** 2 / length**2
    return np.asarray(bending * at**3 + shear * at + seat * (1.0 + turn))
