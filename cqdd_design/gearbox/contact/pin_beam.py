"""An output pin as a beam between the carrier's plate and its cap, pushed by the discs.

A pin is a Timoshenko beam of round section whose ends sit in plate and cap. The plate moves its end
by p and the cap the other by q, across the pin's axis; the discs push at their mid-planes a_d with
the forces F_d. What is linear in them is worked out once::

    deflection at disc d   w_d = at_plate_d p + at_cap_d q + sum_e influence_de F_e
    force on the cap       R   = sum_d at_cap_d F_d + joint (p - q)
    force on the plate         = sum_d F_d - R

By reciprocity one number is both: how much of the plate's motion the pin shows at a disc, and how
much of the disc's force goes to the plate. Plates turn about the pin's direction and do not tilt,
so that a clamped end keeps its slope whatever the plates do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from cqdd_design.gearbox.output_pins import PinSupport, disc_positions, pin_span
from cqdd_design.geometry.contours import FloatArray

SEAT_LENGTH = 1.0
"""Length of a pin's seat in its plate, in pin diameters."""

PinEnd = Literal["clamped", "bedded", "hinged", "free"]
"""How an end is held.

clamped: a shoulder or head drawn against the plate holds its slope, and its seat yields across the
pin alone; bedded: it lies in its seat as on an even elastic bed, which lets it turn too, about the
seat's middle; hinged: as clamped, with no moment; free: not at all.
"""


HELD: dict[PinSupport, tuple[PinEnd, PinEnd]] = {
    "both": ("hinged", "hinged"),
    "cantilever": ("bedded", "free"),
}
"""Ends of pins whose plates are one body, by how many hold them."""


class PinSection(NamedTuple):
    """How a pin and its seats yield."""

    bending: float
    """E I, N m^2."""
    shear: float
    """G A/k, N."""
    seat: float
    """Displacement of a seat by a unit force at its middle, m/N."""
    seat_length: float
    """m."""


@dataclass(frozen=True, eq=False)
class PinBeam:
    """A pin under the forces of D discs.

    Attributes
    ----------
    at_plate, at_cap : array (D,)
        Deflection at the discs when the plate, or the cap, moves by one; also the share of a disc's
        force that either bears.
    influence : array (D, D)
        Deflection at disc d by a unit force of disc e, plate and cap held, m/N.
    joint : float
        Force between plate and cap when they move apart by one, N/m.
    """

    at_plate: FloatArray
    at_cap: FloatArray
    influence: FloatArray
    joint: float


def pin_section(
    diameter: float, pin_modulus: float, pin_poisson: float, plate_modulus: float
) -> PinSection:
    """Section of a round pin, and the yield of its seat of one diameter in a plate.

    Parameters
    ----------
    diameter : float
        m.
    pin_modulus, pin_poisson, plate_modulus : float
        Young's modulus of the pin (Pa) and its Poisson's ratio; Young's modulus of the plate.

    Notes
    -----
    Shear coefficient k of a round section by Cowper (1966), (7 + 6 nu)/(6 (1 + nu)); a seat yields
    by 1/(l E_plate) + 1/(l E_pin) (Tate and Rosenfeld 1946, bearing of a fastener).
    """
    length = SEAT_LENGTH * diameter
    shear_modulus = pin_modulus / (2.0 * (1.0 + pin_poisson))
    coefficient = (7.0 + 6.0 * pin_poisson) / (6.0 * (1.0 + pin_poisson))
    return PinSection(
        bending=np.pi / 64.0 * diameter**4 * pin_modulus,
        shear=np.pi / 4.0 * diameter**2 * shear_modulus / coefficient,
        seat=1.0 / (length * plate_modulus) + 1.0 / (length * pin_modulus),
        seat_length=length,
    )


def pin_in_stack(
    disc_count: int,
    disc_thickness: float,
    disc_spacing: float,
    section: PinSection,
    ends: tuple[PinEnd, PinEnd],
) -> PinBeam:
    """A pin through a stack of discs, its ends at plate and cap held as `ends` say.

    Parameters
    ----------
    disc_count : int
        D.
    disc_thickness, disc_spacing : float
        b and s, m; the span is L = D b + (D+1) s.

    Examples
    --------
    A 4 mm steel pin through two 8 mm discs yields by 30.6 nm/N hinged at both ends, and by 10.5
    clamped, when the plate bears 82 % of the first disc's force:

    >>> steel = pin_section(4e-3, 205e9, 0.29, 205e9)
    >>> hinged = pin_in_stack(2, 8e-3, 0.5e-3, steel, ("hinged", "hinged"))
    >>> clamped = pin_in_stack(2, 8e-3, 0.5e-3, steel, ("clamped", "clamped"))
    >>> [round(1e9 * float(one.influence[0, 0]), 1) for one in (hinged, clamped)]
    [30.6, 10.5]
    >>> round(float(clamped.at_plate[0]), 2)
    0.82
    """
    span = float(pin_span(disc_count, disc_thickness, disc_spacing))
    at = disc_positions(disc_count, disc_thickness, disc_spacing)
    return pin_beam(at, span, section, ends)


def pin_beam(
    at: FloatArray, span: float, section: PinSection, ends: tuple[PinEnd, PinEnd]
) -> PinBeam:
    """A pin between plate and cap under forces at given places.

    Parameters
    ----------
    at : array (D,)
        Distances of the forces from the plate, m.
    span : float
        From plate to cap, m.
    section : PinSection
        With a seat of 0 the ends do not yield.
    ends : pair of {"clamped", "bedded", "hinged", "free"}
        At the plate, which holds every pin in some way, and at the cap; free is a cantilever.

    Notes
    -----
    The pin is a cantilever from the plate's face that also moves and turns there as a whole; two
    equations of balance and two of each end give that motion, and forces and moments of the ends.
    Lengths are counted in spans and forces in E I/L^2.
    """
    plate_end, cap_end = ends
    x = np.asarray(at, dtype=float) / span
    unit = section.bending / span**2
    shear = unit / section.shear
    seat = section.seat * unit / span
    length = section.seat_length / span
    # Where the seats' forces act, and by how much their beds let the pin turn.
    before, plate_turn = _bed(plate_end, length, seat)
    behind, cap_turn = _bed(cap_end, length, seat)
    count = len(x)

    # Unknowns: motion and turn at the plate's face; force and moment of plate, and of cap.
    a, b = np.zeros((6, 6)), np.zeros((6, 2 + count))
    a[0] = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0]
    b[0, 2:] = -1.0
    a[1] = [0.0, 0.0, -before, 1.0, 1.0 + behind, 1.0]
    b[1, 2:] = -x
    a[2] = [1.0, -before, seat, 0.0, 0.0, 0.0]
    b[2, 0] = 1.0
    a[3] = _no_force(3) if plate_end == "hinged" else [0.0, 1.0, 0.0, plate_turn, 0.0, 0.0]
    if cap_end == "free":
        a[4], a[5] = _no_force(4), _no_force(5)
    else:
        # Turn at the cap's face, by forces there and moments there, and by the discs.
        by_force, by_moment = 0.5 + behind, 1.0
        turned = 0.5 * x**2
        moved = x**2 * (3.0 - x) / 6.0 + shear * x
        own = 1.0 / 3.0 + shear + 0.5 * behind + behind * by_force
        a[4] = [1.0, 1.0 + behind, 0.0, 0.0, own + seat, 0.5 + behind * by_moment]
        b[4, 1] = 1.0
        b[4, 2:] = -(moved + behind * turned)
        if cap_end == "hinged":
            a[5] = _no_force(5)
        else:
            a[5] = [0.0, 1.0, 0.0, 0.0, by_force, by_moment + cap_turn]
            b[5, 2:] = -turned
    motion, slope, _, _, force, moment = np.linalg.solve(a, b)

    # Deflections at the discs: of the whole, by the cap's force and moment, and by the discs.
    at_cap_face = moment + behind * force
    shown = motion + np.outer(x, slope) + np.outer(0.5 * x**2, at_cap_face)
    shown += np.outer(x**2 * (3.0 - x) / 6.0 + shear * x, force)
    near, far = np.minimum.outer(x, x), np.maximum.outer(x, x)
    shown[:, 2:] += near**2 * (3.0 * far - near) / 6.0 + shear * near
    return PinBeam(
        at_plate=shown[:, 0],
        at_cap=shown[:, 1],
        influence=shown[:, 2:] * (span / unit),
        joint=float(force[1]) * unit / span,
    )


def _bed(end: PinEnd, length: float, seat: float) -> tuple[float, float]:
    """How far behind the plate's face a seat bears, and its turn by a unit moment."""
    if end != "bedded":
        return 0.0, 0.0
    return 0.5 * length, 12.0 * seat / length**2


def _no_force(which: int) -> FloatArray:
    """The equation that an end bears no force, or no moment."""
    row = np.zeros(6)
    row[which] = 1.0
    return row
