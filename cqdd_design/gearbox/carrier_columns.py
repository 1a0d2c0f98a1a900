"""How stiffly columns hold the carrier's cap against turning on its plate."""

from __future__ import annotations

import math

from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.screws import column_screw
from cqdd_design.design import Design
from cqdd_design.gearbox.output_pins import pin_span
from cqdd_design.geometry.columns import COLUMN_MATERIAL, has_columns


def column_stiffness(
    length: float, diameter: float, bore: float, modulus: float, poisson: float
) -> float:
    """Force across a column over the motion of its ends, both clamped and kept parallel, N/m.

    Parameters
    ----------
    length : float
        Between the plates, m.
    diameter, bore : float
        Outside and inside, m; a bore of 0 makes it solid.
    modulus, poisson : float
        Young's modulus (Pa) and Poisson's ratio.

    Returns
    -------
    float
        12 E I/(L^3 (1 + phi)) with phi = 12 E I/(kappa G A L^2), after Timoshenko; kappa of a
        hollow round section by Cowper (1966, J. Appl. Mech. 33:335). The screw inside adds nothing.

    Examples
    --------
    A 6 mm steel tube over an M3 screw between plates 17.5 mm apart takes 18.1 kN for a millimetre:

    >>> round(column_stiffness(17.5e-3, 6e-3, 3.2e-3, 205e9, 0.29) * 1e-6, 1)
    18.1
    """
    inside, outside = bore**2, diameter**2
    ratio = inside / outside
    inertia = math.pi / 64.0 * (outside**2 - inside**2)
    area = math.pi / 4.0 * (outside - inside)
    squared = (1.0 + ratio) ** 2
    kappa = (
        6.0
        * (1.0 + poisson)
        * squared
        / ((7.0 + 6.0 * poisson) * squared + (20.0 + 12.0 * poisson) * ratio)
    )
    shear_modulus = modulus / (2.0 * (1.0 + poisson))
    bending = 12.0 * modulus * inertia / length**3
    return bending / (1.0 + bending * length / (kappa * shear_modulus * area))


def feet_compliance(length: float, diameter: float, modulus: float, poisson: float) -> float:
    """What plates that yield under both feet of a column add to its compliance, m/N.

    Parameters
    ----------
    length, diameter : float
        Of the column, m.
    modulus, poisson : float
        Of the plates.

    Returns
    -------
    float
        2/K_x + L^2/(2 K_t), each foot a rigid disc of radius a on a half space: it slides with
        K_x = 8 G a/(2 - nu) and turns with K_t = 8 G a^3/(3 (1 - nu)) (Johnson 1985, Contact
        Mechanics, sections 3.7 and 5.4).
    """
    shear_modulus, radius = modulus / (2.0 * (1.0 + poisson)), 0.5 * diameter
    slides = 8.0 * shear_modulus * radius / (2.0 - poisson)
    turns = 8.0 * shear_modulus * radius**3 / (3.0 * (1.0 - poisson))
    return 2.0 / slides + length**2 / (2.0 * turns)


def join_stiffness(design: Design) -> float:
    """Torque about the axis by which the columns resist a turn of cap on plate, N m/rad.

    N_c k R_w^2, k of a column on feet that yield; 0 without columns.
    """
    reducer = design.reducer
    if not has_columns(reducer):
        return 0.0
    carrier, steel = reducer.carrier, find_material(COLUMN_MATERIAL)
    plate = find_material(design.carrier_material)
    length = float(pin_span(reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing))
    own = column_stiffness(
        length,
        carrier.column_diameter,
        column_screw(carrier.column_diameter).bore,
        steel.youngs_modulus,
        steel.poisson_ratio,
    )
    feet = feet_compliance(
        length, carrier.column_diameter, plate.youngs_modulus, plate.poisson_ratio
    )
    each = 1.0 / (1.0 / own + feet)
    return carrier.column_count * each * reducer.output_pins.circle_radius**2
