"""Stress of a stepped shaft at its changes of section: bending and torsion together.

Nominal stresses of the thinner side, with a bore of radius b::

    sigma = M r/I,   I = pi/4 (r^4 - b^4)          tau = T r/(2 I)

At rest von Mises' stress counts, without notches, because a ductile shaft yields there first and
no further. Against fatigue every fibre has its own cycle, in the frame that turns with the shaft,
where a constant torque changes little: each start from rest is a cycle too. There
sigma and tau are multiplied by the fatigue notch factors of the shoulder and joined as von Mises
does, amplitudes and means apart (Budynas and Nisbett 2020, section 7-4, with notch factors on the
means as well, to the safe side).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox.life.fatigue import BROKEN, goodman_reversed
from cqdd_design.geometry.contours import ComplexArray, FloatArray

_FIBRES = 24
"""Round the shaft."""
_PSI = 6894.757
_BENDING_ROW = ((0.927, 1.149, -0.086), (0.015, -3.281, 0.837),
                (0.847, 1.716, -0.506), (-0.790, 0.417, -0.246))  # fmt: skip
_STEEP_ROW = ((1.225, 0.831, -0.010), (-3.790, 0.958, -0.257),
              (7.374, -4.834, 0.862), (-3.809, 3.046, -0.595))  # fmt: skip
_TORSION_ROW = ((0.905, 0.783, -0.075), (-0.437, -1.969, 0.553),
                (1.557, 1.073, -0.578), (-1.061, 0.171, 0.086))  # fmt: skip
_STEEP = 2.0
"""Height of a shoulder over its fillet from which the second row of bending holds."""
_BENDING_RANGE, _TORSION_RANGE = (0.25, 20.0), (0.25, 10.0)
"""Of that ratio, within which the fits are used, and at the ends beyond; that of torsion is stated
to 4 and agrees with the charts of Budynas and Nisbett within 8 % up to 10."""


class Step(NamedTuple):
    """A change of section at which a shaft is judged."""

    place: str
    """In words."""
    height: float
    """m."""
    radius: float
    """Of the thinner side, m."""
    bore: float
    """Radius of the hole through it, m."""
    larger: float
    """Radius of the thicker side, or of what is pressed on, m."""
    fillet: float
    """Radius between them, m; 0 under a hub that is pressed on."""


@dataclass(frozen=True)
class StepStress:
    """Stress at a step.

    Attributes
    ----------
    static : float
        Greatest von Mises stress, Pa, nominal.
    reversed_amplitude : float
        Of the reversed stress that harms as much as the worst fibre's cycle, notches in it, Pa; a
        hundred times the ultimate strength where its mean alone breaks the shaft.
    bending_factor, torsion_factor : float
        Fatigue notch factors.
    """

    step: Step
    static: float
    reversed_amplitude: float
    bending_factor: float
    torsion_factor: float


def bending_notch(larger: float, smaller: float, fillet: float) -> float:
    """Stress concentration of a shouldered shaft in bending (Young and Budynas 2002, table 17.1).

    Parameters
    ----------
    larger, smaller, fillet : float
        Radii of both sides and of the fillet, m.

    Examples
    --------
    Chart A-15-9 of Budynas and Nisbett reads 1.70 at D/d = 1.5, r/d = 0.1:

    >>> round(bending_notch(15e-3, 10e-3, 2e-3), 2)
    1.73
    """
    height = (larger - smaller) / fillet
    rows = _STEEP_ROW if height > _STEEP else _BENDING_ROW
    return _chart(rows, height, _BENDING_RANGE, 1.0 - smaller / larger)


def torsion_notch(larger: float, smaller: float, fillet: float) -> float:
    """The same in torsion (Pilkey and Pilkey 2008, chart 3.12).

    Examples
    --------
    Chart A-15-8 of Budynas and Nisbett reads 1.45 at D/d = 1.33, r/d = 0.1:

    >>> round(torsion_notch(13.3e-3, 10e-3, 2e-3), 2)
    1.39
    """
    height = (larger - smaller) / fillet
    return _chart(_TORSION_ROW, height, _TORSION_RANGE, 1.0 - smaller / larger)


def _chart(
    rows: tuple[tuple[float, float, float], ...],
    height: float,
    valid: tuple[float, float],
    depth: float,
) -> float:
    """A cubic in 2 h/D whose coefficients are quadratics in the root of h/r."""
    ratio = min(max(height, valid[0]), valid[1])
    terms = np.array([1.0, math.sqrt(ratio), ratio])
    factors = np.asarray(rows) @ terms
    return max(float(factors @ depth ** np.arange(4)), 1.0)


def notch_sensitivity(ultimate: float, fillet: float, *, torsion: bool = False) -> float:
    """Share of a concentration that steel feels (Neuber; Budynas and Nisbett 2020, eq. 6-35).

    Parameters
    ----------
    ultimate : float
        S_u, Pa.
    fillet : float
        m.

    Examples
    --------
    Figure 6-26 reads about 0.85 for 1.0 GPa (145 kpsi) and a notch of 1 mm:

    >>> round(notch_sensitivity(1.0e9, 1e-3), 2)
    0.85
    """
    strength = min(ultimate / _PSI / 1e3, 250.0)
    powers = strength ** np.arange(4)
    row = (0.190, -2.51e-3, 1.35e-5, -2.67e-8) if torsion else (0.246, -3.08e-3, 1.51e-5, -2.67e-8)
    root = max(float(np.asarray(row) @ powers), 0.0)
    return 1.0 / (1.0 + root / math.sqrt(fillet / 25.4e-3))


def fatigue_factors(step: Step, ultimate: float) -> tuple[float, float]:
    """Fatigue notch factors of a step in bending and torsion.

    Under a hub that is pressed on 2.7 (S_u/1000 MPa)^0.43 and 0.65 of it (DIN 743-2).
    """
    if step.fillet <= 0.0:
        pressed = 2.7 * (ultimate / 1e9) ** 0.43
        return pressed, 0.65 * pressed
    shape = step.larger, step.radius, step.fillet
    bend, turn = bending_notch(*shape) - 1.0, torsion_notch(*shape) - 1.0
    return (
        1.0 + notch_sensitivity(ultimate, step.fillet) * bend,
        1.0 + notch_sensitivity(ultimate, step.fillet, torsion=True) * turn,
    )


def step_stress(
    step: Step, moment: ComplexArray, torque: FloatArray, ultimate: float
) -> StepStress:
    """Stress at a step under the bending moments and torques that it meets.

    Parameters
    ----------
    moment : complex array
        In the shaft's own frame, positive where it pulls the fibres on that side, N m.
    torque : array
        At the same instants, N m.
    ultimate : float
        S_u of the shaft, Pa.

    Examples
    --------
    A bar of 10 mm that bends by 5 N m to and fro: 32 M/(pi d^3) of 50.9 MPa.

    >>> bar = Step("middle", 0.0, 5e-3, 0.0, 6e-3, 1e-3)
    >>> told = step_stress(bar, np.array([5.0, -5.0]), np.zeros(2), 1e9)
    >>> print(f"{told.static / 1e6:.1f} {told.reversed_amplitude / told.bending_factor / 1e6:.1f}")
    50.9 50.9
    """
    second = 0.25 * math.pi * (step.radius**4 - step.bore**4)
    # It starts from rest, where nothing is loaded.
    bent = np.append(0.0, moment) * step.radius / second
    sheared = np.append(0.0, torque) * step.radius / (2.0 * second)
    static = float(np.hypot(np.abs(bent), math.sqrt(3.0) * sheared).max())
    fibre = np.exp(2j * math.pi * np.arange(_FIBRES) / _FIBRES)
    stress = np.real(bent[:, None] * np.conj(fibre))
    bend, turn = fatigue_factors(step, ultimate)
    amplitude = _joined(bend * np.ptp(stress, axis=0), turn * np.ptp(sheared))
    middle = _joined(
        bend * np.abs(stress.max(axis=0) + stress.min(axis=0)),
        turn * abs(sheared.max() + sheared.min()),
    )
    worst = goodman_reversed(middle - amplitude, middle + amplitude, ultimate)
    return StepStress(step, static, min(float(worst.max()), BROKEN * ultimate), bend, turn)


def _joined(twice_bent: ArrayLike, twice_sheared: ArrayLike) -> FloatArray:
    """Von Mises of half of a range, or of a sum, of both stresses."""
    return np.asarray(
        0.5 * np.hypot(np.asarray(twice_bent), math.sqrt(3.0) * np.asarray(twice_sheared))
    )
