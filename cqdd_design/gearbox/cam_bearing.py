"""The cam bearing of a disc: which of the catalogue's fit, what they bear, which is chosen."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from cqdd_design.catalog.bearings import Bearing, bearings, find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bearing_life import (
    RollingElement,
    basic_rating_life_hours,
    life_exponent,
    static_safety,
)
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.columns import column_hole_diameter
from cqdd_design.geometry.contours import FloatArray

_Lengths = TypeVar("_Lengths", float, FloatArray)


def rolling_element(bearing: Bearing) -> RollingElement:
    """Ball or roller, which decides the life exponent."""
    return "ball" if bearing.kind == "ball" else "roller"


def carries_raceways(bearing: Bearing, disc_material: str) -> bool:
    """Whether the bearing brings its own outer ring, or the disc is hard enough to be one.

    A needle cage runs in the bore itself; steel below 58 HRC is no raceway.
    """
    if bearing.kind != "needle cage":
        return True
    return allowables.is_hardened(find_material(disc_material))


def largest_outer_diameter(design: Design, hole_diameter: float, valley_distance: float) -> float:
    """Largest cam bearing that leaves the least ligament to holes and valleys, m."""
    holes = max(hole_diameter, column_hole_diameter(design.reducer))
    to_holes = design.reducer.output_pins.circle_radius - 0.5 * holes
    return 2.0 * (min(to_holes, valley_distance) - allowables.LIGAMENT)


def least_bore(eccentricity: _Lengths) -> _Lengths:
    """Smallest bore whose eccentrics (m) still share the least shaft core, m.

    Neighbouring cams of radius d/2 stand e to either side of the axis, so a core of radius
    d/2 - e runs through; it must be at least a quarter of the bore.
    """
    return eccentricity / (0.5 - allowables.SHAFT_CORE_SHARE)


def fitting_bearings(design: Design, most_outer_diameter: float) -> tuple[Bearing, ...]:
    """Rated catalogue bearings that fit the disc, smallest first.

    Parameters
    ----------
    design : Design
        For the disc's thickness and material and the eccentricity.
    most_outer_diameter : float
        From :func:`largest_outer_diameter`, m.
    """
    reducer = design.reducer
    fitting = [
        bearing
        for bearing in bearings().values()
        if bearing.dynamic_rating is not None
        and bearing.static_rating is not None
        and bearing.kind != "crossed roller"
        and bearing.width <= reducer.disc_thickness + 1e-9
        and bearing.outer_diameter <= most_outer_diameter + 1e-9
        and bearing.bore_diameter >= least_bore(reducer.eccentricity)
        and carries_raceways(bearing, reducer.disc_material)
    ]
    return tuple(sorted(fitting, key=_size))


def _size(bearing: Bearing) -> tuple[float, float, float, str]:
    return (
        bearing.outer_diameter,
        bearing.width,
        bearing.mass if bearing.mass is not None else float("inf"),
        bearing.designation,
    )


@dataclass(frozen=True)
class BearingResult:
    """Rating of a cam bearing.

    Attributes
    ----------
    bearing : Bearing
        The catalogue row.
    peak_load, continuous_load : float
        Greatest radial load at peak and at continuous torque, N. The greatest over the period is
        used for the life too, which is on the safe side of the mean that ISO 281 allows.
    speed : float
        Of the crank relative to the disc, rad/s.
    static_safety : float or None
        C0/P at the peak torque; None where the catalogue has no rating.
    life_hours : float or None
        L10h at the continuous torque; None where the catalogue has no rating.
    """

    bearing: Bearing
    peak_load: float
    continuous_load: float
    speed: float
    static_safety: float | None
    life_hours: float | None

    @property
    def exponent(self) -> float:
        """Life exponent p."""
        return life_exponent(rolling_element(self.bearing))

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form of one seat of ``bearings``."""
        rating, static = self.bearing.dynamic_rating, self.bearing.static_rating
        return {
            "designation": self.bearing.designation,
            "kind": self.bearing.kind,
            "model": "rigid law",
            "load_peak_N": self.peak_load,
            "load_continuous_N": self.continuous_load,
            "speed_rad_per_s": self.speed,
            "dynamic_rating_N": rating,
            "static_rating_N": static,
            "static_safety": self.static_safety,
            "L10h": self.life_hours,
        }


def rate(bearing: Bearing, peak_load: float, continuous_load: float, speed: float) -> BearingResult:
    """Rate a cam bearing by ISO 76 and ISO 281.

    Parameters
    ----------
    bearing : Bearing
        Catalogue row.
    peak_load, continuous_load : float
        N.
    speed : float
        Relative speed of the rings, rad/s.
    """
    safety = life = None
    if bearing.static_rating is not None:
        safety = float(static_safety(bearing.static_rating, peak_load))
    if bearing.dynamic_rating is not None:
        exponent = life_exponent(rolling_element(bearing))
        life = float(
            basic_rating_life_hours(bearing.dynamic_rating, continuous_load, speed, exponent)
        )
    return BearingResult(bearing, peak_load, continuous_load, speed, safety, life)


def passes(result: BearingResult, hours: float) -> bool:
    """Whether both ratings meet their limits, the life these hours."""
    return (
        result.static_safety is not None
        and result.life_hours is not None
        and result.static_safety >= allowables.STATIC_SAFETY
        and result.life_hours >= hours
    )


def _reserve(result: BearingResult, hours: float) -> float:
    """Load reserve of a rated bearing over some hours: how many times the load it could carry."""
    safety, life = result.static_safety or 0.0, result.life_hours or 0.0
    by_life = float((life / hours) ** (1.0 / result.exponent))
    return min(safety / allowables.STATIC_SAFETY, by_life)


def choose(
    candidates: Iterable[Bearing],
    peak_load: float,
    continuous_load: float,
    speed: float,
    hours: float,
) -> BearingResult | None:
    """Return the smallest candidate that passes, or else the one with the most reserve.

    Loads and speed are those of `rate`, and the hours those that it has to last.

    Returns
    -------
    BearingResult or None
        None only when there are no candidates.
    """
    rated = [rate(bearing, peak_load, continuous_load, speed) for bearing in candidates]
    for result in rated:
        if passes(result, hours):
            return result
    return max(rated, key=lambda result: _reserve(result, hours), default=None)


def relative_speed(design: Design) -> float:
    """Speed of the crank against the discs at the continuous torque's input speed, rad/s."""
    return float(
        kinematics.cam_bearing_speed_ring_fixed(
            design.reducer.ratio, design.requirements.held_speed
        )
    )


def continuous_load(design: Design, peak_load: float) -> float:
    """Cam load at the continuous torque of the requirements, N, from that at the peak torque."""
    requirements = design.requirements
    return peak_load * requirements.continuous_torque / requirements.peak_torque


def cam_bearing(design: Design, peak_load: float) -> BearingResult:
    """Rate the cam bearing that a design names.

    Parameters
    ----------
    design : Design
        With requirements and a named cam bearing.
    peak_load : float
        Greatest cam load at the peak torque, N.
    """
    bearing = find_bearing(design.reducer.cam_bearing.designation)
    return rate(bearing, peak_load, continuous_load(design, peak_load), relative_speed(design))
