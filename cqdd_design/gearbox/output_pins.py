"""Output pins: the paper's capacity, and stresses under shared load. Every function broadcasts.

A stack of D discs of thickness b runs between two carrier plates with the same gap s between
neighbours and at both ends::

      plate | s | disc 0 | s | disc 1 | s | plate
            |<------------- L ------------->|        L = D b + (D + 1) s

A pin is loaded by disc d at a = s + b/2 + d (b + s) from the first plate. What it bends by, and
what plate and cap take of it, is :mod:`.pin_beam`'s.
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


def bending_modulus(pin_diameter: ArrayLike) -> FloatArray:
    """Section modulus pi d^3/32 of a round pin, m^3: stress is moment over it."""
    return np.asarray(np.pi / 32.0 * np.asarray(pin_diameter, dtype=float) ** 3)


def bending_stress(force: ArrayLike, arm: ArrayLike, pin_diameter: ArrayLike) -> FloatArray:
    """Bending stress 32 F arm/(pi d^3) of a round pin, Pa; arm by :func:`.carrier.bending_arm`."""
    moment = np.asarray(force, dtype=float) * np.asarray(arm, dtype=float)
    return np.asarray(moment / bending_modulus(pin_diameter))


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
