"""Force laws of one contact: line contacts of teeth and pins, and the cam bearing's spring.

A line contact is written as approach over force, ``delta(F)``, because a pin adds its own linear
compliance in series; the equilibrium needs the inverse, force over approach, which the compiled
kernel (:mod:`.laws_kernel`) finds by Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.needles import NeedleSet
from cqdd_design.errors import DesignError
from cqdd_design.geometry.contours import FloatArray

LineModel = Literal["palmgren", "johnson", "linear"]

Bodies = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Of either body in contact: depth of the reference point behind the contact (m), Young's modulus
(Pa), Poisson's ratio."""

LINE_MODELS: dict[str, int] = {"palmgren": 0, "johnson": 1, "linear": 2}

_STEEL_MODULUS = 206e9 / (2.0 * (1.0 - 0.3**2))
"""E* of steel on steel, for which Palmgren measured his coefficient, Pa."""

_PALMGREN = 3.84e-5 * 1e-3 / (1e3) ** 0.8
"""3.84e-5 F^0.9/L^0.8 with N and mm, in N and m."""

LEAST_SLOPE = 0.05
"""Share of the coefficient a below which the slope of Johnson's law is not followed any more."""


@dataclass(frozen=True)
class LineLaw:
    """Approach of a family of line contacts over force.

    Attributes
    ----------
    model : {"palmgren", "johnson", "linear"}
        palmgren: ``delta = c F^0.9``; johnson: ``delta = F (a - B ln F)``; linear:
        ``delta = c F``. Each contact has its own coefficient ``c`` (or ``a``).
    logarithm : float
        B of Johnson's law, m/N; zero otherwise.
    """

    model: LineModel
    logarithm: float = 0.0

    @property
    def code(self) -> int:
        """Number of the model in the compiled kernel."""
        return LINE_MODELS[self.model]


def palmgren_coefficient(length: float, modulus: float) -> float:
    """Coefficient c of ``delta = c F^0.9`` (Palmgren 1959), N and m.

    Palmgren measured steel; other pairs are scaled by the ratio of their E* to steel's.

    Parameters
    ----------
    length : float
        Contact length, m.
    modulus : float
        E* of the pair, Pa.

    Examples
    --------
    >>> c = palmgren_coefficient(0.01, _STEEL_MODULUS)
    >>> print(round(1e3 * c * 1000.0**0.9, 7))
    0.0030502
    """
    return float(_PALMGREN / length**0.8 * (_STEEL_MODULUS / modulus))


def johnson_coefficients(
    length: float,
    equivalent_radius: ArrayLike,
    modulus: float,
    bodies: Bodies,
) -> tuple[FloatArray, float]:
    """Coefficients a and B of ``delta = F (a - B ln F)`` (Johnson 1985, eq. 5.57), N and m.

    Parameters
    ----------
    length : float
        Contact length b, m.
    equivalent_radius : array_like
        R_eq, m.
    modulus : float
        E* of the pair, Pa.

    Returns
    -------
    a : array
        m/N, with the shape of `equivalent_radius`.
    B : float
        m/N.
    """
    radius = np.asarray(equivalent_radius, dtype=float)
    # a_half^2 = F * spread, so 2 ln(2 d/a_half) = ln(4 d^2/spread) - ln F.
    spread = 4.0 * radius / (np.pi * length * modulus)
    constant = np.zeros_like(radius)
    logarithm = 0.0
    for depth, youngs, poisson in bodies:
        compliance = (1.0 - poisson * poisson) / (np.pi * youngs * length)
        constant = constant + compliance * (
            np.log(4.0 * depth * depth / spread) - poisson / (1.0 - poisson)
        )
        logarithm += compliance
    return constant, logarithm


def approach(
    law: LineLaw, coefficient: ArrayLike, series: ArrayLike, force: ArrayLike
) -> FloatArray:
    """Approach of contacts under `force`, series compliance included, m.

    Parameters
    ----------
    coefficient : array_like
        c or a of every contact.
    series : array_like
        Linear compliance in series, m/N.
    force : array_like
        N, not negative.
    """
    load = np.asarray(force, dtype=float)
    c = np.asarray(coefficient, dtype=float)
    if law.model == "palmgren":
        local = c * load**0.9
    elif law.model == "linear":
        local = c * load
    else:
        local = load * (c - law.logarithm * np.log(np.where(load > 0.0, load, 1.0)))
    return np.asarray(local + np.asarray(series, dtype=float) * load)


def force_limit(law: LineLaw, coefficient: ArrayLike) -> FloatArray:
    """Largest force up to which the law is used as published, N.

    Johnson's logarithm turns back once the contact is as wide as the body is deep. Where its
    slope has fallen to a twentieth of the coefficient the law continues straight, and a result
    there is refused.
    """
    c = np.asarray(coefficient, dtype=float)
    if law.model != "johnson":
        return np.full(c.shape, np.inf)
    return np.asarray(np.exp((1.0 - LEAST_SLOPE) * c / law.logarithm - 1.0))


def stored_energy(
    law: LineLaw, coefficient: ArrayLike, series: ArrayLike, force: ArrayLike
) -> FloatArray:
    """Energy in contacts under `force`, F delta less the integral of delta over F, J.

    Parameters
    ----------
    law, coefficient, series, force
        As in :func:`approach`.
    """
    load = np.asarray(force, dtype=float)
    c = np.asarray(coefficient, dtype=float)
    if law.model == "palmgren":
        local = 0.9 / 1.9 * c * load**1.9
    elif law.model == "linear":
        local = 0.5 * c * load**2
    else:
        logarithm = np.log(np.where(load > 0.0, load, 1.0))
        local = 0.5 * load**2 * (c - law.logarithm * (logarithm + 0.5))
    return np.asarray(local + 0.5 * np.asarray(series, dtype=float) * load**2)


@dataclass(frozen=True)
class CamSpring:
    """Isotropic radial spring between a disc's bore and its cam, with play.

    Attributes
    ----------
    stiffness : float
        K of ``F = K delta^exponent``, N/m^exponent.
    exponent : float
        3/2 for balls, 10/9 for rollers, 1 for a linear bearing.
    play : float
        Total radial play, m (ISO 5753): the centre is free within half of it.
    """

    stiffness: float
    exponent: float
    play: float


_BALL_SHARE = 0.3
"""Ball diameter over (D - d) of deep-groove bearings; 0.29 to 0.32 in makers' tables."""
_F0_BALL = 12.3
"""f0 of ISO 76:2006, table 1, near D_w/D_pw = 0.18, N/mm^2."""


def ball_complement(bearing: Bearing) -> tuple[int, float]:
    """Number and diameter (m) of the balls of a deep-groove bearing.

    Catalogues do not print them. The diameter is 0.3 (D - d); the number follows from the static
    rating by ISO 76:2006, C0 = f0 Z D_w^2, or, where there is none, from balls on 62 % of the
    pitch circle.

    Examples
    --------
    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> balls, diameter = ball_complement(find_bearing("6902"))
    >>> balls, round(1e3 * diameter, 2)
    (12, 3.9)
    """
    diameter = _BALL_SHARE * (bearing.outer_diameter - bearing.bore_diameter)
    if bearing.static_rating is not None:
        return max(round(bearing.static_rating / (_F0_BALL * 1e6 * diameter**2)), 5), diameter
    pitch = 0.5 * (bearing.outer_diameter + bearing.bore_diameter)
    return max(int(0.62 * np.pi * pitch / diameter), 5), diameter


def cam_spring(bearing: Bearing, play: float) -> CamSpring:
    """Radial spring of a cam bearing from its rolling elements.

    Parameters
    ----------
    bearing : Bearing
        Catalogue row.
    play : float
        Total radial play, m.

    Notes
    -----
    Balls: delta = 4.36e-4 (Q^2/D_w)^(1/3) with Q = 4.37 F/Z. Rollers: delta = 7.68e-5 Q^0.9/l^0.8
    with Q = 4.08 F/Z; mm and N, both raceways (Palmgren 1959; Harris and Kotzalas 2006, ch. 7).
    The load distribution is that of zero clearance; the play enters as a gap.
    """
    if bearing.kind == "ball":
        count, diameter = ball_complement(bearing)
        per_force = 4.36e-4 * (4.37 / count) ** (2.0 / 3.0) / (diameter * 1e3) ** (1.0 / 3.0) * 1e-3
        return CamSpring(per_force**-1.5, 1.5, play)
    if bearing.kind == "crossed roller":
        raise DesignError(
            f"cam_bearing.designation '{bearing.designation}' is a crossed-roller bearing, which "
            "does not fit between disc and cam; choose a ball or needle bearing."
        )
    return CamSpring(needle_coefficient(bearing.needles) ** (-10.0 / 9.0), 10.0 / 9.0, play)


def needle_coefficient(needles: NeedleSet) -> float:
    """Coefficient c of ``delta = c F^0.9`` of a needle bearing, N and m; as in :func:`cam_spring`.

    Examples
    --------
    The 6 needles of 1.5 x 4.8 mm of a cage K4x7x7 under 500 N, in um:

    >>> from cqdd_design.catalog.needles import needle_set
    >>> needles = needle_set(4e-3, 7e-3, 7e-3, drawn_cup=False)
    >>> print(round(1e6 * needle_coefficient(needles) * 500.0**0.9, 2))
    4.16
    """
    share = 4.08 / needles.count
    return float(7.68e-5 * share**0.9 / (needles.length * 1e3) ** 0.8 * 1e-3)


def runner_coefficient(cage: Bearing | None, length: float, modulus: float) -> float:
    """Coefficient c of ``delta = c F^0.9`` between a pin and the sleeve on it, N and m.

    Parameters
    ----------
    cage : Bearing or None
        The needle cage between the two; a plain sleeve is one more line contact by Palmgren.
    length : float
        Of the sleeve, m.
    modulus : float
        E* of sleeve on pin, Pa.

    Notes
    -----
    The sleeve stays round: that it turns oval under the two opposite loads is left out.
    """
    if cage is None:
        return palmgren_coefficient(length, modulus)
    return needle_coefficient(cage.needles)
