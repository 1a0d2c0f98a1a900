"""Life of the cam bearings on their load as it varies over period and duty."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.gearbox.bearing_life import RollingElement, basic_rating_life_hours, life_exponent
from cqdd_design.gearbox.cam_bearing import rolling_element
from cqdd_design.geometry.contours import FloatArray

WEIBULL_BALL, WEIBULL_ROLLER = 10.0 / 9.0, 9.0 / 8.0
"""Slopes of the scatter of bearing lives (ISO 281:2007; Lundberg and Palmgren 1947, 1952)."""


@dataclass(frozen=True)
class CamLife:
    """Life of the cam bearings on their load as it varies.

    Attributes
    ----------
    speed : float
        Mean relative speed of crank and disc over the duty, rests included, rad/s.
    equivalent_load : tuple of float
        Of every disc's bearing over the period and the duty, N.
    hours : tuple of (float or None) or None
        L10h of each, None for one without load; None as a whole without a rating or motion.
    set_hours : float or None
        L10h of all of them together.
    hours_at_greatest : float or None
        At the greatest load of the duty as if it stood still at it.
    hours_of_rigid_law : float or None
        By the closed form: rigid law, greatest load at the continuous torque, input speed.
    """

    designation: str
    speed: float
    equivalent_load: tuple[float, ...]
    hours: tuple[float | None, ...] | None
    set_hours: float | None
    hours_at_greatest: float | None
    hours_of_rigid_law: float | None

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "designation": self.designation,
            "mean_speed_rad_per_s": self.speed,
            "equivalent_load_N": list(self.equivalent_load),
            "L10h": None if self.hours is None else list(self.hours),
            "set_L10h": self.set_hours,
            "L10h_at_greatest_load": self.hours_at_greatest,
            "L10h_of_rigid_law": self.hours_of_rigid_law,
        }


def equivalent_load(
    loads: FloatArray, shares: FloatArray, speeds: FloatArray, exponent: float
) -> FloatArray:
    """Constant load of the same life as loads that vary over period and duty.

    Parameters
    ----------
    loads : array (C, A, D)
        Of C cases at A even angles on D bearings, N.
    shares, speeds : array (C,)
        Share of time and speed of every case; only their products matter.
    exponent : float
        p.

    Returns
    -------
    array (D,)
        (sum share speed mean(P^p)/sum share speed)^(1/p), N; zero without motion (ISO 281:2007).
    """
    weight = shares * speeds
    if weight.sum() <= 0.0:
        return np.zeros(loads.shape[-1])
    mean = np.mean(loads**exponent, axis=1)
    return np.asarray((weight @ mean / weight.sum()) ** (1.0 / exponent))


def set_life(lives: Sequence[float], element: RollingElement) -> float:
    """L10 of several bearings together, (sum L^-b)^(-1/b), in the unit of `lives`.

    The set runs while each of its bearings does; the chances of survival multiply, and each is a
    Weibull distribution of slope b, 10/9 for balls and 9/8 for rollers (Lundberg and Palmgren).

    Examples
    --------
    >>> round(set_life([1000.0, 1000.0], "ball"), 1)
    535.9
    """
    slope = WEIBULL_BALL if element == "ball" else WEIBULL_ROLLER
    return float(np.sum(np.asarray(lives) ** -slope) ** (-1.0 / slope))


def cam_life(
    bearing: Bearing,
    loads: FloatArray,
    shares: FloatArray,
    speeds: FloatArray,
    hours_of_rigid_law: float | None,
) -> CamLife:
    """Rate one bearing per disc on a spectrum, given as to `equivalent_load`, speeds in rad/s."""
    element = rolling_element(bearing)
    exponent = life_exponent(element)
    equal = equivalent_load(loads, shares, speeds, exponent)
    speed = float(shares @ speeds)
    moving = shares * speeds > 0.0
    hours: tuple[float | None, ...] | None = None
    together = greatest = None
    rating = bearing.dynamic_rating
    if rating is not None and speed > 0.0:
        each = [
            float(basic_rating_life_hours(rating, load, speed, exponent)) if load > 0.0 else None
            for load in equal.tolist()
        ]
        ends = [one for one in each if one is not None and math.isfinite(one)]
        hours = tuple(each)
        if ends:
            together = set_life(ends, element)
            top = loads[moving].max()
            greatest = float(basic_rating_life_hours(rating, top, speed, exponent))
    return CamLife(
        designation=bearing.designation,
        speed=speed,
        equivalent_load=tuple(equal.tolist()),
        hours=hours,
        set_hours=together,
        hours_at_greatest=greatest,
        hours_of_rigid_law=hours_of_rigid_law,
    )
