"""Friction of bearings: a load torque mu F d/2 and Palmgren's load-independent drag.

The published mu holds for a bearing's whole friction at about a tenth of its rating, so adding the
drag counts a little of it twice; at the loads of a cycloid's cam the load torque rules. Contact
seals, where a design has them, add a torque of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import FRICTION_COEFFICIENT, Bearing, BearingKind
from cqdd_design.geometry.contours import FloatArray

DRAG_FACTOR: dict[BearingKind, float] = {
    "ball": 1.4,
    "needle": 12.0,
    "needle cage": 12.0,
    "crossed roller": 6.0,
}
"""f0 for grease. Harris, Rolling Bearing Analysis, after Palmgren 1959 (handbook values not
re-read): deep groove ball 0.7 (light series) to 2 (heavy), the middle; needle 12; tapered roller 6,
taken for crossed rollers."""

SEALS = ((52e-3, 0.028, 2.0), (80e-3, 0.018, 20.0), (100e-3, 0.018, 15.0), (np.inf, 0.018, 0.0))
"""Outside diameter (m) up to which K_S1 and K_S2 hold, of contact seals on both sides of ball
bearings: SKF 2013, Rolling bearings, table of seal friction of deep groove ball bearings, RSH and
from 62 mm RS1 (handbook values not re-read); between 52 and 62 mm the next row is taken."""
_SEAL_POWER = 2.25
_SHOULDER = 1.0 / 3.0
"""Of the way from bore to outside, where the seal's lip runs on the inner ring: 0.3 to 0.36 of deep
groove ball bearings of SKF 2013; no catalogue here has it."""

_LOW_SPEED_PRODUCT = 2000.0
"""nu n in mm^2/s rpm below which the drag no longer depends on speed."""


def drag_torque(
    drag_factor: ArrayLike, viscosity: ArrayLike, speed: ArrayLike, mean_diameter: ArrayLike
) -> FloatArray:
    """Load-independent friction torque M0 of a bearing by Palmgren.

    Parameters
    ----------
    drag_factor : array_like
        f0, :data:`DRAG_FACTOR`.
    viscosity : array_like
        nu in m^2/s; that of the base oil for grease.
    speed : array_like
        Of one ring against the other, rad/s, either sense.
    mean_diameter : array_like
        d_m = (d + D)/2, m.

    Returns
    -------
    array
        N m. With nu in mm^2/s, n in rpm, d_m in mm and M0 in N mm: 1e-7 f0 (nu n)^(2/3) d_m^3, and
        160e-7 f0 d_m^3 where nu n is below 2000 (Palmgren 1959, Ball and Roller Bearing
        Engineering; Harris 2001, ch. 14). The published branches differ by 0.8 % where they meet.

    Examples
    --------
    d_m 50 mm, f0 2, nu n 8000: 1e-7 x 2 x 400 x 125000 = 10 N mm.

    >>> print(round(1e3 * float(drag_torque(2.0, 80e-6, 100 * 2 * np.pi / 60, 0.05)), 6))
    10.0
    """
    product = np.abs(np.asarray(viscosity, dtype=float) * np.asarray(speed, dtype=float))
    product = product * 1e6 * 30.0 / np.pi
    fast = 1e-7 * product ** (2.0 / 3.0)
    cube = (np.asarray(mean_diameter, dtype=float) * 1e3) ** 3
    scale = np.where(product < _LOW_SPEED_PRODUCT, 160e-7, fast)
    return np.asarray(1e-3 * np.asarray(drag_factor, dtype=float) * scale * cube)


def seal_torque(bore_diameter: float, outer_diameter: float) -> float:
    """Friction torque of both contact seals of a ball bearing, N m, at any speed.

    M = K_S1 d_s^2.25 + K_S2 with d_s in mm and M in N mm (SKF 2013, Rolling bearings, frictional
    moment of seals), :data:`SEALS`.

    Parameters
    ----------
    bore_diameter, outer_diameter : float
        m.

    Examples
    --------
    >>> print(round(1e3 * seal_torque(0.02, 0.047), 1))
    56.6
    """
    lip = 1e3 * (bore_diameter + _SHOULDER * (outer_diameter - bore_diameter))
    slope, constant = next(row[1:] for row in SEALS if outer_diameter <= row[0] + 1e-9)
    return float(1e-3 * (slope * lip**_SEAL_POWER + constant))


@dataclass(frozen=True)
class BearingFriction:
    """What the losses need of one bearing.

    Attributes
    ----------
    coefficient, drag_factor : float
        mu on the bore and f0.
    bore_diameter, mean_diameter, width : float
        d, d_m and B, m.
    seal : float
        Torque of its seals, N m; 0 where it is open.
    """

    name: str
    coefficient: float
    drag_factor: float
    bore_diameter: float
    mean_diameter: float
    width: float
    seal: float = 0.0

    @classmethod
    def of(cls, bearing: Bearing, *, sealed: bool = False) -> BearingFriction:
        """Return the friction of a catalogue bearing, open or with contact seals on both sides."""
        seal = seal_torque(bearing.bore_diameter, bearing.outer_diameter) if sealed else 0.0
        return cls(
            name=bearing.designation,
            coefficient=FRICTION_COEFFICIENT[bearing.kind],
            drag_factor=DRAG_FACTOR[bearing.kind],
            bore_diameter=bearing.bore_diameter,
            mean_diameter=0.5 * (bearing.bore_diameter + bearing.outer_diameter),
            width=bearing.width,
            seal=seal,
        )

    @classmethod
    def bush(cls, bore_diameter: float, width: float, coefficient: float) -> BearingFriction:
        """Return the friction of a greased plain bush, Coulomb only."""
        name = f"bush {bore_diameter * 1e3:.3g} mm"
        return cls(name, coefficient, 0.0, bore_diameter, bore_diameter, width)

    def load_torque(self, load: ArrayLike) -> FloatArray:
        """Load-dependent M1 = mu F d/2 under an equivalent radial load F (N), N m.

        SKF and JTEKT catalogues, for about a tenth of the dynamic rating and good lubrication.
        """
        return np.asarray(0.5 * self.coefficient * (np.asarray(load) * self.bore_diameter))

    def drag_torque(self, viscosity: float, speed: ArrayLike) -> FloatArray:
        """M0 and the seals' torque at a relative speed (rad/s), N m."""
        return self.seal + drag_torque(self.drag_factor, viscosity, speed, self.mean_diameter)
