"""A ring with an eccentric bore that is pressed on a round core: stress and growth, plane stress.

Muskhelishvili 1953, Some Basic Problems of the Mathematical Theory of Elasticity, sections 32, 41:
two analytic functions phi and psi carry the state of each body, here a Laurent series in the ring
and a power series in the core, fitted to the conditions at their edges by least squares. No
logarithms: no edge has a resultant, and the figure is symmetric about the line of centres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.materials import Material
from cqdd_design.geometry.contours import ComplexArray, FloatArray

IntArray = NDArray[np.intp]

_TERMS, _POINTS = 32, 240
"""Powers of either sign, and points on each edge."""


@dataclass(frozen=True)
class PressedRing:
    """A ring on its core, at an interference.

    Attributes
    ----------
    hoop, across : float
        At the bore, where its von Mises stress is greatest: tension round it, and pressure, Pa.
    pressure : float
        Mean of the joint, Pa.
    growth : float
        Of the outside's mean diameter, m.
    out_of_round : float
        Of the outside: greatest less least radius from the best circle, m.
    """

    hoop: float
    across: float
    pressure: float
    growth: float
    out_of_round: float

    def mises(self, push: float = 0.0) -> float:
        """Greatest von Mises stress at the bore with `push` (Pa) more on the joint there, Pa."""
        across = self.across + push
        return math.sqrt(self.hoop**2 + self.hoop * across + across**2)


@dataclass(frozen=True)
class _Field:
    """Shares (points, unknowns) of every coefficient in displacement and stress at points.

    Coefficients are real, in phi first and psi then; displacement is 2 G (u + i v).
    """

    displacement: ComplexArray
    traction: ComplexArray
    mean: FloatArray

    @property
    def radial(self) -> FloatArray:
        """Stress across the circle, Pa a unit."""
        return self.traction.real

    @property
    def hoop(self) -> FloatArray:
        """Stress along the circle, Pa a unit."""
        return 2.0 * self.mean - self.traction.real


def pressed_ring(
    core: float, outside: float, throw: float, interference: float, material: Material
) -> PressedRing:
    """Stress of a ring of `outside` radius round a solid core of the same material.

    Parameters
    ----------
    core, outside : float
        Radii of the joint and of the ring's outside, m.
    throw : float
        Of the two axes, m; less than outside - core.
    interference : float
        On the diameter, m; none and a play put no stress into it.
    material : Material
        Elastic data of both.

    Notes
    -----
    The joint slips along itself, which compound or oil between its faces and the pressing along
    the axis allow. Where it sticks, the bore is stretched evenly and the thin wall by less. A core
    that is hollow gives way, and the stress is less too.

    Concentric it is Lame's: a solid core's p = E delta/(4 a) (1 - a^2/b^2), sigma = p (b^2 + a^2)/
    (b^2 - a^2). The mean growth of the outside is delta a/b at any throw (Betti's theorem).
    Jeffery's tube under an even pressure (1921; Timoshenko and Goodier 1970, section 66), p (2 b^2
    (b^2 + a^2 - 2 a e - e^2)/((a^2 + b^2) (b^2 - a^2 - 2 a e - e^2)) - 1), has less at the thin
    side, 0.87 of it where the wall is a tenth of b: the core keeps its bore round.

    Examples
    --------
    Of steel, a core of 10 mm in a ring of 17 mm, 10 um of interference, and 2 mm off its centre:

    >>> from cqdd_design.catalog.materials import find_material
    >>> steel = find_material("AISI 4140 Q&T 540C")
    >>> on = pressed_ring(5e-3, 8.5e-3, 0.0, 10e-6, steel)
    >>> [round(one / 1e6) for one in (on.pressure, on.hoop, on.mises())]
    [67, 138, 181]
    >>> off = pressed_ring(5e-3, 8.5e-3, 2e-3, 10e-6, steel)
    >>> round(off.hoop / on.hoop, 2), round(off.growth * 1e6, 2)
    (1.64, 5.88)
    """
    if interference <= 0.0:
        return PressedRing(0.0, 0.0, 0.0, 0.0, 0.0)
    modulus, ratio = material.youngs_modulus, material.poisson_ratio
    shear, kappa = 0.5 * modulus / (1.0 + ratio), (3.0 - ratio) / (1.0 + ratio)
    angles = 2.0 * math.pi * np.arange(_POINTS) / _POINTS
    turn = np.exp(1j * angles)
    # In units of the core's radius, so that powers stay of one size on the joint.
    reach, off = outside / core, throw / core
    powers = np.arange(-_TERMS, _TERMS + 1)
    scale = np.where(powers > 0, reach + off, 1.0)
    inner = _field(turn, turn, powers, scale, kappa)
    outer = _field(off + reach * turn, turn, powers, scale, kappa)
    within = _field(turn, turn, np.arange(_TERMS + 1), np.ones(_TERMS + 1), kappa)
    nothing = np.zeros_like(within.radial)
    none_outside = np.zeros((_POINTS, within.radial.shape[1]))
    lines = np.vstack(
        [
            np.hstack([outer.traction.real, none_outside]),
            np.hstack([outer.traction.imag, none_outside]),
            np.hstack([inner.traction.imag, nothing]),
            np.hstack([np.zeros_like(inner.radial), within.traction.imag]),
            np.hstack([inner.radial, -within.radial]),
            np.hstack(
                [
                    (inner.displacement / turn[:, None]).real,
                    -(within.displacement / turn[:, None]).real,
                ]
            ),
        ]
    )
    gap = 2.0 * shear * 0.5 * interference / core
    asked = np.concatenate([np.zeros(5 * _POINTS), np.full(_POINTS, gap)])
    found = np.linalg.lstsq(lines, asked, rcond=1e-13)[0][: inner.radial.shape[1]]
    hoop, across = inner.hoop @ found, -(inner.radial @ found)
    worst = int(np.argmax(hoop**2 + hoop * across + across**2))
    moved = (outer.displacement @ found / turn).real * core / (2.0 * shear)
    return PressedRing(
        hoop=float(hoop[worst]),
        across=float(across[worst]),
        pressure=float(across.mean()),
        growth=2.0 * float(moved.mean()),
        out_of_round=_out_of_round(moved, angles),
    )


def _field(
    at: ComplexArray, outward: ComplexArray, powers: IntArray, scale: FloatArray, kappa: float
) -> _Field:
    """Of the terms (z/scale)^k of phi and psi at points of a circle, whose normals are `outward`.

    Its traction is sigma_r + i tau_r theta there (eq. 39.5, conjugate).
    """
    z = at[:, None]
    term = (z / scale) ** powers
    slope = powers * term / z
    curve = (powers - 1) * slope / z
    unit = outward[:, None]
    first = kappa * term - z * np.conj(slope)
    # sigma_r - i tau = 2 Re phi' - e^(2 i theta) (conj(z) phi'' + psi').
    traction = np.hstack(
        [2.0 * slope.real - unit**2 * (np.conj(z) * curve), -(unit**2) * slope],
    )
    return _Field(
        displacement=np.hstack([first, -np.conj(term)]),
        traction=np.conj(traction),
        mean=np.hstack([2.0 * slope.real, np.zeros_like(slope.real)]),
    )


def _out_of_round(moved: FloatArray, angles: FloatArray) -> float:
    """Greatest less least of a displacement outward about the circle that fits it best."""
    circle = np.column_stack([np.ones_like(angles), np.cos(angles), np.sin(angles)])
    left = moved - circle @ np.linalg.lstsq(circle, moved, rcond=None)[0]
    return float(np.ptp(left))
