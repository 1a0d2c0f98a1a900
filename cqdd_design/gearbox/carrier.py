"""The output carrier of a design as its pins feel it: how plate and cap hold them, what ties both.

The plate carries the output torque. The cap hangs on the pins, and on columns where there are any:
what the discs push onto it through the pins' far ends comes back to the plate through all of them,
so that the cap turns against the plate until the torque on it is zero. It does not move sideways:
the shaft's bearing and the pins' even spacing hold it about the axis.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.design.reducer import CarrierJoint
from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.carrier_columns import join_stiffness
from cqdd_design.gearbox.pin_beam import (
    HELD,
    PinBeam,
    PinEnd,
    PinSection,
    pin_in_stack,
    pin_section,
)
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

JOINTS: dict[CarrierJoint, tuple[PinEnd, PinEnd]] = {
    "clamped": ("clamped", "clamped"),
    "hinged": ("clamped", "hinged"),
    "columns": ("clamped", "hinged"),
}
"""Ends of a pin in plate and cap."""

_TURNS = 720


def pin_ends(design: Design) -> tuple[PinEnd, PinEnd]:
    """How plate and cap of a design hold the ends of its pins."""
    reducer = design.reducer
    if reducer.output_pins.support == "cantilever":
        return HELD["cantilever"]
    return JOINTS[reducer.carrier.joint]


def section_of(design: Design) -> PinSection:
    """Section of a design's pins and the yield of their seats."""
    pins = design.reducer.output_pins
    pin = find_material(pins.material)
    plate = find_material(design.carrier_material)
    return pin_section(pins.diameter, pin.youngs_modulus, pin.poisson_ratio, plate.youngs_modulus)


def pin_of(design: Design, ends: tuple[PinEnd, PinEnd] | None = None) -> PinBeam:
    """A pin of a design, its ends held as its carrier's joint says or as given."""
    reducer = design.reducer
    return pin_in_stack(
        reducer.disc_count,
        reducer.disc_thickness,
        reducer.disc_spacing,
        section_of(design),
        ends or pin_ends(design),
    )


def tie_of(design: Design) -> float:
    """Torque over turn between plate and cap by all but the pins, N m/rad; 0 without columns."""
    return join_stiffness(design)


def bending_arm(beam: PinBeam, peak_factor: float, tie: float = 0.0) -> float:
    """Greatest bending moment in a pin per newton of the greatest disc force on it, m.

    By the rigid law: every disc pushes a pin by F max(0, cos a_d) along its crank's own direction,
    a_d from the pin's tangent, and all pins together by T/(D R_w) along their tangents. The cap
    turns until nothing is left on it, by s at the pins::

        N_w (joint + tie) s = sum_d at_cap_d T/(D R_w),   F = k T/(D N_w R_w)

    Parameters
    ----------
    beam : PinBeam
        Between plate and cap.
    peak_factor : float
        k, from :func:`.rigid.peak_pin_force_factor`.
    tie : float
        Of plate and cap beside the pins: torque over turn over N_w R_w^2, N/m.

    Examples
    --------
    Two 8 mm discs 0.5 mm apart, 4 mm pins. Plates that are one body and hold the pins as hinges;
    pins clamped in plate and cap; a cap that only rides on them; no cap:

    >>> from cqdd_design.gearbox.pin_beam import pin_in_stack, pin_section
    >>> steel = pin_section(4e-3, 205e9, 0.29, 205e9)
    >>> for ends in (("hinged", "hinged"), ("clamped", "clamped"), ("clamped", "hinged"),
    ...              ("bedded", "free")):
    ...     beam = pin_in_stack(2, 8e-3, 0.5e-3, steel, ends)
    ...     print(round(1e3 * bending_arm(beam, 4.0), 2))
    2.34
    4.52
    5.95
    13.0
    """
    count = len(beam.at_cap)
    a = 2.0 * np.pi * np.arange(_TURNS) / _TURNS + kinematics.crank_phases(count)[:, None]
    push = np.maximum(np.cos(a), 0.0) * np.exp(1j * a)
    held = beam.joint + tie
    sway = float(np.sum(beam.at_cap)) / peak_factor / held if held > 0.0 else 0.0
    moment = beam.disc_moment @ push + beam.sway_moment[:, None] * sway
    return float(np.abs(moment).max())


def design_bending_arm(design: Design) -> float:
    """:func:`bending_arm` of a design's pins, slender and in stiff seats, m."""
    reducer = design.reducer
    pins, ends = reducer.output_pins, pin_ends(design)
    factor = rigid.peak_pin_force_factor(pins.count)
    stack = reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing
    tie = tie_of(design)
    if tie <= 0.0:
        return float(slender_bending_arm(*stack, ends, factor))
    slender = section_of(design)._replace(shear=np.inf, seat=0.0)
    held = tie / (pins.count * pins.circle_radius**2)
    return bending_arm(pin_in_stack(*stack, slender, ends), factor, held)


def slender_bending_arm(
    disc_count: int,
    disc_thickness: ArrayLike,
    disc_spacing: float,
    ends: tuple[PinEnd, PinEnd],
    peak_factor: ArrayLike,
) -> FloatArray:
    """:func:`bending_arm` of slender pins in stiff seats, which no size of the pin changes, m.

    Parameters
    ----------
    disc_thickness, peak_factor : array_like
        b (m) and k; they broadcast.

    Notes
    -----
    Beside :func:`bending_arm` of the pin as it is: at most a tenth more, for short thick pins.
    """
    b, k = np.asarray(disc_thickness, dtype=float), np.asarray(peak_factor, dtype=float)
    widths, width = np.unique(b, return_inverse=True)
    factors, factor = np.unique(k, return_inverse=True)
    table = [
        [_slender_arm(disc_count, float(one), disc_spacing, ends, float(f)) for f in factors]
        for one in widths
    ]
    return np.asarray(np.array(table)[width.reshape(b.shape), factor.reshape(k.shape)])


@cache
def _slender_arm(
    disc_count: int,
    disc_thickness: float,
    disc_spacing: float,
    ends: tuple[PinEnd, PinEnd],
    peak_factor: float,
) -> float:
    slender = PinSection(bending=1.0, shear=np.inf, seat=0.0, seat_length=disc_thickness)
    beam = pin_in_stack(disc_count, disc_thickness, disc_spacing, slender, ends)
    return bending_arm(beam, peak_factor)
