"""Catalogue parts a search may use: output pins, bare or on needles, and cam bearings."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.screws import ShoulderScrew, shoulder_screws
from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox import bearing_life as rating
from cqdd_design.gearbox.cam_bearing import carries_raceways, rolling_element
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing.columns import Columns

PIN_FIT_ALLOWANCE = 1e-6
"""Least play left between the largest pin of its tolerance band and its hole, m."""
_PIN_SHARE = 0.2
"""Thickest pin searched, as a share of the ring's outside diameter."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class PinSize:
    """An output pin: a shoulder screw, or a hardened pin under a sleeve on needles.

    Attributes
    ----------
    diameter : float
        Nominal, of the pin, m.
    running_diameter : float
        Of what runs in the hole, m: mean real diameter of the screw, or of the sleeve.
    hole_clearance : float
        On the diameter to that, m: the design default, or as much more as the largest screw of the
        tolerance band needs.
    cages : tuple of Bearing
        Needle cages inside the sleeve, the strongest last; none of bare pins.
    """

    diameter: float
    running_diameter: float
    hole_clearance: float
    cages: tuple[Bearing, ...] = ()

    @property
    def sleeve_diameter(self) -> float:
        """0 of bare pins, m."""
        return self.running_diameter if self.cages else 0.0

    def cage_ratings(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """C0 and C (N) of the cage in discs of some thickness: 0 where none is narrow enough.

        Without bound for bare pins.
        """
        static = np.full(thickness.shape, 0.0 if self.cages else np.inf)
        dynamic = static.copy()
        for one in self.cages:
            fits = one.width <= thickness + _ROUNDING
            static[fits], dynamic[fits] = one.static_rating or 0.0, one.dynamic_rating or 0.0
        return static, dynamic


@dataclass(frozen=True)
class BearingTable(Columns):
    """Cam bearings as arrays (nB,), SI.

    Attributes
    ----------
    outer, bore, width, mass : array
    static_load, life_load : array
        Greatest loads at the peak torque that meet C0/P and, scaled to the continuous torque, the
        rating life, N.
    """

    outer: FloatArray
    bore: FloatArray
    width: FloatArray
    mass: FloatArray
    static_load: FloatArray
    life_load: FloatArray

    @property
    def allowed_load(self) -> FloatArray:
        """The lower of both loads, N."""
        return np.minimum(self.static_load, self.life_load)


def needle_pins(requirements: Requirements, clearance: float) -> tuple[PinSize, ...]:
    """Pins under sleeves on needle cages that could stand in a disc of this ring, ascending.

    The sleeve has the least wall over its cage.

    Raises
    ------
    InfeasibleError
        When the ring is too small for any.
    """
    most = _PIN_SHARE * requirements.outer_diameter
    cages = sorted(
        (one for one in bearings().values() if one.kind == "needle cage" and one.dynamic_rating),
        key=lambda one: one.dynamic_rating or 0.0,
    )
    found = []
    for bore, outside in sorted({(one.bore_diameter, one.outer_diameter) for one in cages}):
        sleeve = outside + 2.0 * allowables.SLEEVE_WALL
        same = (one for one in cages if (one.bore_diameter, one.outer_diameter) == (bore, outside))
        if sleeve <= most + _ROUNDING:
            found.append(PinSize(bore, sleeve, clearance, tuple(same)))
    if not found:
        least = min(one.outer_diameter for one in cages) + 2.0 * allowables.SLEEVE_WALL
        raise InfeasibleError(
            f"requirements.outer_diameter {requirements.outer_diameter * 1e3:g} mm leaves no room "
            f"for output pins on needles: the thinnest sleeve has {least * 1e3:g} mm; raise it to "
            f"at least {math.ceil(least / _PIN_SHARE * 1e3 - _ROUNDING):g} mm."
        )
    return tuple(found)


def pin_sizes(requirements: Requirements, default_clearance: float) -> tuple[PinSize, ...]:
    """Shoulder screws with limits of size that could stand in a disc of this ring, ascending.

    Rows without limits (the inch sizes) are left out: their fit in a hole cannot be checked.

    Raises
    ------
    InfeasibleError
        When the ring is too small for any.
    """
    most = _PIN_SHARE * requirements.outer_diameter
    toleranced = [
        screw
        for screw in shoulder_screws().values()
        if screw.shoulder_diameter_min < screw.shoulder_diameter_max
    ]
    fitting = [screw for screw in toleranced if screw.shoulder_diameter <= most + _ROUNDING]
    if not fitting:
        least = min(screw.shoulder_diameter for screw in toleranced)
        raise InfeasibleError(
            f"requirements.outer_diameter {requirements.outer_diameter * 1e3:g} mm leaves no room "
            f"for output pins: the thinnest shoulder screw of the catalogue has {least * 1e3:g} mm;"
            f" raise it to at least {math.ceil(least / _PIN_SHARE * 1e3 - _ROUNDING):g} mm."
        )
    fitting.sort(key=lambda screw: screw.shoulder_diameter)
    return tuple(_pin_size(screw, default_clearance) for screw in fitting)


def _pin_size(screw: ShoulderScrew, default_clearance: float) -> PinSize:
    spread = screw.shoulder_diameter_max - screw.mean_diameter
    needed = math.ceil((spread + PIN_FIT_ALLOWANCE) * 1e6 - 1e-6) * 1e-6
    clearance = default_clearance if default_clearance >= spread else needed
    return PinSize(screw.shoulder_diameter, screw.mean_diameter, clearance)


def cam_bearings(
    requirements: Requirements, most_thickness: float, spacing: float, thinnest_pin: float
) -> tuple[Bearing, ...]:
    """Rated bearings that could stand in a disc and that no other one beats, smallest first.

    Parameters
    ----------
    most_thickness, spacing : float
        Of the discs and between them, m.
    thinnest_pin : float
        Diameter of the thinnest output pin, m.

    Raises
    ------
    InfeasibleError
        When the length or the ring is too small for any.
    """
    hard = allowables.is_hardened(find_material(requirements.disc_material))
    # Needles run on the eccentric itself, so they are searched only where the parts are hard.
    usable = [
        bearing
        for bearing in bearings().values()
        if bearing.dynamic_rating is not None
        and bearing.static_rating is not None
        and (bearing.kind == "ball" or (hard and bearing.kind != "crossed roller"))
        and carries_raceways(bearing, requirements.disc_material)
    ]
    narrow = [b for b in usable if b.width <= most_thickness + _ROUNDING]
    if not narrow:
        least = min(bearing.width for bearing in usable)
        count = requirements.disc_count
        needed = count * least + (count - 1) * spacing
        raise InfeasibleError(
            f"requirements.length {requirements.length * 1e3:g} mm leaves "
            f"{max(most_thickness, 0.0) * 1e3:.4g} mm for each of {count} discs, and the "
            f"narrowest rated cam bearing is {least * 1e3:g} mm wide; raise length to "
            f"{needed * 1e3:g} mm or lower disc_count."
        )
    # Holes of the thinnest pins on both sides of two ligaments must still fit around it.
    room = requirements.outer_diameter - 2.0 * (
        allowables.RING_WALL + 2.0 * allowables.LIGAMENT + thinnest_pin
    )
    small = [b for b in narrow if b.outer_diameter <= room]
    if not small:
        least = min(bearing.outer_diameter for bearing in narrow)
        needed = least + requirements.outer_diameter - room
        raise InfeasibleError(
            f"requirements.outer_diameter {requirements.outer_diameter * 1e3:g} mm leaves no room "
            f"for a cam bearing: the smallest rated one is {least * 1e3:g} mm outside, and wall, "
            f"pins and ligaments around it need {needed * 1e3:.4g} mm; raise it above that."
        )
    return tuple(sorted(_unbeaten(small), key=lambda b: (b.outer_diameter, b.width)))


def _unbeaten(candidates: list[Bearing]) -> list[Bearing]:
    """Bearings that no other one equals or beats in size, ratings, mass and bore."""
    merits = np.array(
        [
            (
                b.outer_diameter,
                b.width,
                _mass(b),
                -b.bore_diameter,
                -(b.dynamic_rating or 0.0),
                -(b.static_rating or 0.0),
            )
            for b in candidates
        ]
    )
    not_worse = np.all(merits[:, None] <= merits[None, :], axis=-1)
    better = np.any(merits[:, None] < merits[None, :], axis=-1)
    # Of equal rows the first of the catalogue stays.
    earlier = np.arange(len(candidates))[:, None] < np.arange(len(candidates))
    beaten = np.any(not_worse & (better | earlier), axis=0)
    return [b for b, lost in zip(candidates, beaten, strict=True) if not lost]


def _mass(bearing: Bearing) -> float:
    """Catalogue mass; where the source gives none, two thirds of a solid steel annulus, kg."""
    if bearing.mass is not None:
        return bearing.mass
    area = math.pi / 4.0 * (bearing.outer_diameter**2 - bearing.bore_diameter**2)
    return 2.0 / 3.0 * 7800.0 * area * bearing.width


def bearing_table(
    rows: tuple[Bearing, ...], cam_speed: float, continuous_share: float, hours: float
) -> BearingTable:
    """The arrays of some bearings.

    Parameters
    ----------
    cam_speed : float
        Of the eccentric relative to a disc, rad/s.
    continuous_share : float
        Continuous over peak torque.
    hours : float
        Required life.
    """
    dynamic = np.array([b.dynamic_rating or 0.0 for b in rows])
    exponent = np.array([rating.life_exponent(rolling_element(b)) for b in rows])
    life = rating.load_for_life(dynamic, hours, cam_speed, exponent)
    return BearingTable(
        outer=np.array([b.outer_diameter for b in rows]),
        bore=np.array([b.bore_diameter for b in rows]),
        width=np.array([b.width for b in rows]),
        mass=np.array([_mass(b) for b in rows]),
        static_load=np.array([b.static_rating or 0.0 for b in rows]) / allowables.STATIC_SAFETY,
        life_load=np.asarray(life / continuous_share),
    )
