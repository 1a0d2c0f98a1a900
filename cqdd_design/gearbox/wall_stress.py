"""Stress of turned bodies under what they hold: tubes, plates, lips, seats. Every one is nominal.

Closed forms of strength of materials (Young and Budynas 2002, Roark's Formulas for Stress and
Strain; Wittel and others 2017, Roloff/Matek Maschinenelemente). Stress is that of the plain body:
no notch is counted, which a plastic that is held for long evens out.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.catalog.threads import Thread
from cqdd_design.catalog.tightening import stripping_force
from cqdd_design.geometry.contours import FloatArray


def tube_stress(outer: float, inner: float, moment: float, torque: float) -> float:
    """Von Mises stress at the outside of a tube that is bent and twisted, Pa.

    Parameters
    ----------
    outer, inner : float
        Radii, m.
    moment, torque : float
        Of bending and of torsion, N m.

    Notes
    -----
    sigma = M r/I, tau = T r/(2 I), I = pi/4 (r^4 - r_i^4) (Roark, sections 8.1 and 10.1).

    Examples
    --------
    A shaft of 20 mm under 10 N m of bending, 32 M/(pi d^3), and under 10 N m of torsion:

    >>> print(f"{tube_stress(10e-3, 0.0, 10.0, 0.0) / 1e6:.2f}")
    12.73
    >>> print(f"{tube_stress(10e-3, 0.0, 0.0, 10.0) / 1e6 / 3**0.5:.2f}")
    6.37
    """
    second = 0.25 * math.pi * (outer**4 - inner**4)
    return outer / second * math.hypot(moment, math.sqrt(0.75) * torque)


def tilted_plate_stress(hub: float, edge: float, thickness: float, moment: float) -> float:
    """Radial bending stress at a rigid hub that tilts in a plate with a clamped edge, Pa.

    Parameters
    ----------
    hub, edge : float
        Radii between which the plate bends, m; no stress where there is nothing between them.
    thickness : float
        m.
    moment : float
        About an axis in the plate's plane, N m.

    Notes
    -----
    Of the thin plate's deflection ``(A r + B r^3 + C/r + M r ln r/(4 pi D)) cos(theta)``, clamped
    outside and straight along the hub: ``3 M/(pi b t^2) (a^2 - b^2)/(a^2 + b^2)`` with a edge and
    b hub. The edge has b/a of it (Roark, table 11.2, case 21 gives it in numbers).

    Examples
    --------
    Roark's table has beta = sigma a t^2/M of 4.41 for b/a = 0.2 and 1.146 for 0.5:

    >>> [round(tilted_plate_stress(b, 1.0, 1.0, 1.0), 3) for b in (0.2, 0.5)]
    [4.407, 1.146]
    """
    if hub >= edge:
        return 0.0
    return 3.0 * moment / (math.pi * hub * thickness**2) * (edge**2 - hub**2) / (edge**2 + hub**2)


def pushed_plate_stress(hub: float, edge: float, thickness: float, force: float) -> float:
    """The same where a force along the axis (N) pushes the hub, which does not tilt, Pa.

    ``3 F/(2 pi t^2) (2 a^2 ln(a/b)/(a^2 - b^2) - 1)`` (Roark, table 11.2, case 1f).

    Examples
    --------
    >>> print(round(pushed_plate_stress(0.5, 1.0, 1.0, 1.0), 3))
    0.405
    """
    if hub >= edge:
        return 0.0
    bent = 2.0 * edge**2 * math.log(edge / hub) / (edge**2 - hub**2) - 1.0
    return 1.5 * force / (math.pi * thickness**2) * bent


def line_load(diameter: float, axial: FloatArray, moment: FloatArray) -> FloatArray:
    """Greatest force for every metre of a ring that is pushed and tilted, N/m.

    F/(pi d) + 4 M/(pi d^2): the moment is spread with the cosine. Force (N) and moment (N m) are
    arrays of one shape.
    """
    return np.asarray(axial / (math.pi * diameter) + 4.0 * moment / (math.pi * diameter**2))


def lip_stress(load: float, arm: float, thickness: float) -> float:
    """Bending stress at the root of a lip, as of a strip for itself, Pa; its ring would help.

    Parameters
    ----------
    load : float
        N/m.
    arm : float
        From the root, m.
    thickness : float
        m.
    """
    return 6.0 * load * arm / thickness**2


def seat_pressure(force: float, diameter: float, length: float) -> float:
    """Mean pressure F/(d l) on the projected area of a seat under a force across it, Pa."""
    return force / (diameter * length)


def socket_pressure(
    force: FloatArray, moment: FloatArray, diameter: float, length: float
) -> FloatArray:
    """Greatest pressure in a blind seat that holds the end of a pin alone, Pa.

    Parameters
    ----------
    force, moment : arrays of one shape
        Across the pin and of bending, at the mouth of the seat, N and N m; both turn it one way.
    diameter, length : float
        Of the seat, m.

    Notes
    -----
    ``4 F/(d s) + 6 M/(d s^2)``: with M = F h the F (6 h + 4 s)/(d s^2) of a pin whose free end is
    pushed (Roloff/Matek, section 9.3, Steckstift).

    Examples
    --------
    A pin of 6 mm, 15 mm deep, under 500 N that act 12 mm off:

    >>> force = np.array([500.0])
    >>> print((socket_pressure(force, 12e-3 * force, 6e-3, 15e-3) / 1e6).round(1))
    [48.9]
    """
    return np.asarray((4.0 * force + 6.0 * moment / length) / (diameter * length))


def disc_shear(torque: float, radius: float, thickness: float) -> float:
    """Von Mises stress of a plate that passes a torque on across a circle, Pa.

    tau = T/(2 pi r^2 t), and sqrt(3) of it.
    """
    return math.sqrt(3.0) * torque / (2.0 * math.pi * radius**2 * thickness)


def thread_stress(thread: Thread, engaged: float, force: float) -> float:
    """Von Mises stress where a force (N) would shear off an engaged length (m) of thread, Pa."""
    return math.sqrt(3.0) * force / stripping_force(thread, engaged, 1.0)
