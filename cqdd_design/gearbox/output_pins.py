"""Output pins: the paper's capacity, and stresses under shared load. Every function broadcasts.

A stack of D discs of thickness b runs between two carrier plates with the same gap s between
neighbours and at both ends::

      plate | s | disc 0 | s | disc 1 | s | plate
            |<------------- L ------------->|        L = D b + (D + 1) s

A pin is loaded by disc d at a = s + b/2 + d (b + s) from the first plate. Discs 180 degrees apart
never load the same pin together; three discs at 120 degrees load it two at a time in directions
120 degrees apart, whose resultant moment is never above the larger one. The worst single load
therefore bounds the moment for one, two and three discs.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import FloatArray

PinSupport = Literal["both", "cantilever"]


def single_shear_torque_per_pin(
    pin_diameter: ArrayLike, allowable_shear: ArrayLike, pin_circle_radius: ArrayLike
) -> FloatArray:
    """Torque of one pin by the paper's method: area in single shear times allowable times radius.

    Every pin is taken at its full load and full radius at once, which no set of pins does; it is
    the paper's figure (section III-A), not a capacity.

    Parameters
    ----------
    pin_diameter, pin_circle_radius : array_like
        d and R_w in m.
    allowable_shear : array_like
        Pa; half of the ultimate strength in the paper (35 of 70 ksi).

    Returns
    -------
    array
        pi/4 d^2 tau R_w in N m.

    Examples
    --------
    >>> print(round(float(single_shear_torque_per_pin(4e-3, 35e3 * 6894.757, 19.5e-3)), 2))
    59.13
    """
    d = np.asarray(pin_diameter, dtype=float)
    tau, radius = np.asarray(allowable_shear, dtype=float), np.asarray(pin_circle_radius)
    return np.asarray(np.pi / 4.0 * d * d * tau * radius)


def pin_span(disc_count: int, disc_thickness: ArrayLike, disc_spacing: ArrayLike) -> FloatArray:
    """Free length L = D b + (D+1) s of a pin between the carrier plates, m."""
    b, s = np.asarray(disc_thickness, dtype=float), np.asarray(disc_spacing, dtype=float)
    return np.asarray(disc_count * b + (disc_count + 1) * s)


def disc_positions(
    disc_count: int, disc_thickness: ArrayLike, disc_spacing: ArrayLike
) -> FloatArray:
    """Distances of the disc mid-planes from the first carrier plate, shape (..., D), m."""
    b = np.asarray(disc_thickness, dtype=float)[..., None]
    s = np.asarray(disc_spacing, dtype=float)[..., None]
    return np.asarray(s + b / 2.0 + np.arange(disc_count) * (b + s))


def bending_arm(
    disc_count: int,
    disc_thickness: ArrayLike,
    disc_spacing: ArrayLike,
    support: PinSupport,
) -> FloatArray:
    """Greatest bending moment per newton of disc force on a pin, over the discs of the stack, m.

    Held at both ends (simply supported, force spread evenly over the thickness b):
    a (L - a)/L - b/8, taken at the middle of the patch. Cantilever from the first plate: the
    distance a of the farthest disc.

    Parameters
    ----------
    disc_count : int
        D, 1 to 3.
    disc_thickness, disc_spacing : array_like
        b and s in m.
    support : {"both", "cantilever"}
        How the pin is held.

    Examples
    --------
    Two 8 mm discs 0.5 mm apart: L = 17.5 mm, a = 4.5 mm.

    >>> print(round(float(bending_arm(2, 8e-3, 0.5e-3, "both")) * 1e3, 4))
    2.3429
    >>> print(round(float(bending_arm(2, 8e-3, 0.5e-3, "cantilever")) * 1e3, 4))
    13.0
    """
    at = disc_positions(disc_count, disc_thickness, disc_spacing)
    if support == "cantilever":
        return np.asarray(at.max(axis=-1))
    span = pin_span(disc_count, disc_thickness, disc_spacing)[..., None]
    b = np.asarray(disc_thickness, dtype=float)[..., None]
    return np.asarray((at * (span - at) / span - b / 8.0).max(axis=-1))


def bending_stress(force: ArrayLike, arm: ArrayLike, pin_diameter: ArrayLike) -> FloatArray:
    """Bending stress 32 F arm/(pi d^3) of a round pin, Pa (arm from :func:`bending_arm`)."""
    moment = np.asarray(force, dtype=float) * np.asarray(arm, dtype=float)
    return np.asarray(32.0 * moment / (np.pi * np.asarray(pin_diameter, dtype=float) ** 3))


def shear_stress(force: ArrayLike, pin_diameter: ArrayLike) -> FloatArray:
    """Mean shear stress 4 F/(pi d^2) of one section that carries the whole disc force, Pa.

    Single shear, as the paper counts it. A pin held at both ends shares the force between two
    sections, so this is on the safe side there.
    """
    d = np.asarray(pin_diameter, dtype=float)
    return np.asarray(4.0 * np.asarray(force, dtype=float) / (np.pi * d * d))


def bearing_pressure(
    force: ArrayLike, pin_diameter: ArrayLike, disc_thickness: ArrayLike
) -> FloatArray:
    """Mean pressure F/(d b) on the projected area of pin (or sleeve) in hole, Pa."""
    area = np.asarray(pin_diameter, dtype=float) * np.asarray(disc_thickness, dtype=float)
    return np.asarray(np.asarray(force, dtype=float) / area)


def shared_torque_capacity(
    disc_count: int,
    pin_count: int,
    pin_circle_radius: ArrayLike,
    allowable_pin_force: ArrayLike,
    peak_factor: float,
) -> FloatArray:
    """Output torque at which the most loaded pin reaches its allowable force.

    T = F D N_w R_w/k with k from :func:`.rigid.peak_pin_force_factor` (4 for even N_w).

    Parameters
    ----------
    disc_count, pin_count : int
        D and N_w.
    pin_circle_radius, allowable_pin_force : array_like
        R_w in m and F in N.
    peak_factor : float
        k.

    Returns
    -------
    array
        N m.
    """
    radius = np.asarray(pin_circle_radius, dtype=float)
    force = np.asarray(allowable_pin_force, dtype=float)
    return np.asarray(force * disc_count * pin_count * radius / peak_factor)


def sleeve_share(pin_diameter: float, sleeve_diameter: float) -> float:
    """Share of the sliding path that a sleeve leaves: d_pin/d_sleeve, or 1 without a sleeve.

    The sleeve (radius r_s) turns on the pin (radius r_p), which stands still in the carrier's
    frame. Rolling without slip in the hole gives it the hole's speed at its rim, v = w_s r_s; it
    slides on the pin at w_s r_p = v r_p/r_s under the same force. It rolls rather than slips
    because slipping in the hole would take the moment mu F r_s and turning on the pin takes only
    mu F r_p.

    Examples
    --------
    >>> sleeve_share(4e-3, 6.4e-3), sleeve_share(4e-3, 0.0)
    (0.625, 1.0)
    """
    return pin_diameter / sleeve_diameter if sleeve_diameter > 0.0 else 1.0
