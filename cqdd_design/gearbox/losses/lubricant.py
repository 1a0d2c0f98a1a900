"""Lubricants by name: viscosity, density, yield stress.

Viscosity is that of the (base) oil at 40 C, taken as the temperature of the running gearbox; an
actuator that runs hotter drags less.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

BASE_OIL_VISCOSITY = 110e-6
"""Base oil of a general-purpose NLGI 2 grease (SKF LGMT 2) at 40 C, m^2/s; maker's data, handbook
value not re-read. Greases of one grade range from 15 to 500 mm^2/s."""

DENSITY = 900.0
"""Mineral oil, kg/m^3."""

DEFAULT_LUBRICANT = "NLGI 2 grease"

# Worked penetration at 25 C in tenths of a millimetre, middle of each class (ASTM D217; NLGI).
_PENETRATION = {"000": 460, "00": 415, "0": 370, "1": 325, "2": 280, "3": 235}
_GREASE = re.compile(r"nlgi\s*(000|00|0|1|2|3)(\s+grease)?", re.IGNORECASE)
_OIL = re.compile(r"iso\s*vg\s*(\d+)(\s+oil)?", re.IGNORECASE)
_LEAST_GRADE, _MOST_GRADE = 2, 3200
"""Viscosity grades of ISO 3448:1992."""

# Cone of ASTM D217: 150 g with its shaft; a tip of 30 degrees, 14.94 mm long and 8.38 mm in
# diameter, under a cone of 90 degrees with a largest radius of 32.5 mm.
_CONE_WEIGHT = 0.150 * 9.80665
_TIP_LENGTH, _TIP_RADIUS, _CONE_RADIUS = 14.94e-3, 4.19e-3, 32.5e-3


@dataclass(frozen=True)
class Lubricant:
    """A lubricant.

    Attributes
    ----------
    viscosity : float
        Kinematic viscosity nu of the (base) oil at 40 C, m^2/s.
    density : float
        kg/m^3.
    yield_stress : float
        Stress below which it does not flow, Pa; 0 for an oil.
    """

    name: str
    viscosity: float
    density: float
    yield_stress: float

    @property
    def dynamic_viscosity(self) -> float:
        """Dynamic viscosity eta of the (base) oil, Pa s."""
        return self.viscosity * self.density


def yield_stress_from_penetration(penetration: float) -> float:
    """Estimate the yield stress of a grease from its worked cone penetration.

    The cone of ASTM D217 comes to rest where (2 + pi) times the yield stress on its projected
    area (Prandtl's punch) carries its weight. An estimate: rheometers give 100 to 1000 Pa for
    NLGI 2, depending on method and temperature (Cyriac, Lugt and Bosman 2015).

    Parameters
    ----------
    penetration : float
        m, deeper than the 14.94 mm of the tip.

    Returns
    -------
    float
        Pa.

    Examples
    --------
    >>> print(round(yield_stress_from_penetration(28e-3)))
    306
    """
    radius = min(_TIP_RADIUS + penetration - _TIP_LENGTH, _CONE_RADIUS)
    return _CONE_WEIGHT / ((2.0 + math.pi) * math.pi * radius**2)


def find_lubricant(name: str) -> tuple[Lubricant, str | None]:
    """Return the lubricant called `name`, and a warning where the default had to be taken.

    Parameters
    ----------
    name : str
        ``NLGI 000 grease`` to ``NLGI 3 grease``, or ``ISO VG 100 oil`` with any grade from 2 to
        3200.

    Examples
    --------
    >>> find_lubricant("ISO VG 68 oil")[0].viscosity
    6.8e-05
    """
    text = name.strip()
    if grease := _GREASE.fullmatch(text):
        stress = yield_stress_from_penetration(_PENETRATION[grease[1]] * 1e-4)
        return Lubricant(text, BASE_OIL_VISCOSITY, DENSITY, stress), None
    oil = _OIL.fullmatch(text)
    if oil and _LEAST_GRADE <= int(oil[1]) <= _MOST_GRADE:
        return Lubricant(text, float(oil[1]) * 1e-6, DENSITY, 0.0), None
    taken, _ = find_lubricant(DEFAULT_LUBRICANT)
    warning = (
        f"friction.lubricant '{name}' is not known; its drag is that of {DEFAULT_LUBRICANT} "
        f"({BASE_OIL_VISCOSITY * 1e6:g} mm^2/s at 40 C). Known are 'NLGI 000 grease' to 'NLGI 3 "
        "grease' and 'ISO VG 2 oil' to 'ISO VG 3200 oil'."
    )
    return taken, warning
