"""Lubricants by name: viscosity over temperature, density, yield stress, what a film needs.

Viscosity is that of the (base) oil. Between and beyond the 40 and 100 C that makers print it
follows ASTM D341, Walther's equation: log10 log10(nu + 0.7) falls along a line over log10 T, nu in
mm^2/s and T in kelvin.
"""

from __future__ import annotations

import functools
import math
import re
from dataclasses import dataclass, replace

from cqdd_design.catalog.reader import column, find, read_records
from cqdd_design.errors import CatalogError, UsageError

RUNNING_TEMPERATURE = 40.0
"""Of the lubricant where nothing else is said, deg C: that of the printed viscosities."""

# Worked penetration at 25 C in tenths of a millimetre, middle of each class (ASTM D217; NLGI).
_PENETRATION = {"000": 460, "00": 415, "0": 370, "1": 325, "2": 280, "3": 235}
_OIL = re.compile(r"iso\s*vg\s*(\d+)(\s+oil)?", re.IGNORECASE)
_GREASE = re.compile(r"nlgi\s*(000|00|0|1|2|3)(\s+grease)?", re.IGNORECASE)
_LEAST_GRADE, _MOST_GRADE = 2, 3200
"""Viscosity grades of ISO 3448:1992."""
_KELVIN = 273.15
_WALTHER = 0.7
"""Constant of ASTM D341 for kinematic viscosities above 2 mm^2/s."""
_COLD, _HOT = 40.0, 100.0

# Cone of ASTM D217: 150 g with its shaft; a tip of 30 degrees, 14.94 mm long and 8.38 mm in
# diameter, under a cone of 90 degrees with a largest radius of 32.5 mm.
_CONE_WEIGHT = 0.150 * 9.80665
_TIP_LENGTH, _TIP_RADIUS, _CONE_RADIUS = 14.94e-3, 4.19e-3, 32.5e-3


@dataclass(frozen=True)
class Lubricant:
    """A lubricant; its base oil, where it is a grease.

    Attributes
    ----------
    kind : {"grease", "oil"}
    base_oil, thickener, grade : str
        Mineral or synthetic; the soap; the NLGI number. Empty where there is none.
    viscosity, hot_viscosity : float
        Kinematic viscosity nu at 40 and at 100 C, m^2/s.
    density : float
        kg/m^3, taken not to change with temperature.
    pressure_coefficient, hot_pressure_coefficient : float
        alpha of Barus' law at 40 and at 100 C, 1/Pa. Mineral: 23.7, 20.5 and 15.8 1/GPa at 30, 60
        and 100 C for oils of about this viscosity (Stachowiak and Batchelor 2005, Engineering
        Tribology, table 2.3).
    film_friction : float
        Coefficient of friction of a full film: 0.05 for mineral, 0.04 for synthetic oils (SKF 2013,
        Rolling bearings, sliding frictional moment).
    coldest, hottest : float
        Temperatures between which it is sold to work, deg C.
    source : str
        Where the row comes from.
    """

    name: str = column("name")
    kind: str = column("kind")
    base_oil: str = column("base_oil")
    thickener: str = column("thickener")
    grade: str = column("nlgi")
    viscosity: float = column("nu40_mm2_s", 1e-6)
    hot_viscosity: float = column("nu100_mm2_s", 1e-6)
    density: float = column("density_kg_m3")
    pressure_coefficient: float = column("alpha40_1_GPa", 1e-9)
    hot_pressure_coefficient: float = column("alpha100_1_GPa", 1e-9)
    film_friction: float = column("film_friction")
    coldest: float = column("low_C")
    hottest: float = column("high_C")
    source: str = column("source")

    @property
    def yield_stress(self) -> float:
        """Stress below which it does not flow, Pa; 0 for an oil."""
        if self.kind == "oil":
            return 0.0
        return yield_stress_from_penetration(_PENETRATION[self.grade] * 1e-4)

    @property
    def dynamic_viscosity(self) -> float:
        """Dynamic viscosity eta of the (base) oil at 40 C, Pa s."""
        return self.viscosity * self.density

    def viscosity_at(self, temperature: float) -> float:
        """Kinematic viscosity at a temperature (deg C), m^2/s.

        Raises
        ------
        UsageError
            Outside the temperatures at which the lubricant works.
        """
        if not self.coldest <= temperature <= self.hottest:
            raise UsageError(
                f"{self.name} works from {self.coldest:g} to {self.hottest:g} degC, and has no "
                f"viscosity at {temperature:g} degC; choose another lubricant (`cqdd-design "
                "catalog lubricants`) or temperature."
            )
        return walther_viscosity(temperature, self.viscosity, self.hot_viscosity)

    def pressure_coefficient_at(self, temperature: float) -> float:
        """Barus' alpha at a temperature (deg C), on the line through both that are given, 1/Pa."""
        slope = (self.hot_pressure_coefficient - self.pressure_coefficient) / (_HOT - _COLD)
        return self.pressure_coefficient + slope * (temperature - _COLD)


def walther_viscosity(temperature: float, cold: float, hot: float) -> float:
    """Kinematic viscosity over temperature by ASTM D341.

    Parameters
    ----------
    temperature : float
        deg C.
    cold, hot : float
        At 40 and 100 C, m^2/s.

    Returns
    -------
    float
        m^2/s.

    Examples
    --------
    >>> print(round(1e6 * walther_viscosity(100.0, 110e-6, 11e-6), 9))
    11.0
    """
    ends = [_walther(1e6 * nu) for nu in (cold, hot)]
    at = [math.log10(t + _KELVIN) for t in (_COLD, _HOT, temperature)]
    line = ends[0] + (ends[1] - ends[0]) * (at[2] - at[0]) / (at[1] - at[0])
    return float(1e-6 * (10.0 ** (10.0**line) - _WALTHER))


def _walther(viscosity: float) -> float:
    """log10 log10(nu + 0.7), nu in mm^2/s."""
    return math.log10(math.log10(viscosity + _WALTHER))


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


@functools.lru_cache(maxsize=1)
def lubricants() -> dict[str, Lubricant]:
    """All lubricants by name, in file order."""
    return {one.name: one for one in read_records("lubricants.csv", Lubricant)}


def find_lubricant(name: str) -> Lubricant:
    """The lubricant called `name`.

    Parameters
    ----------
    name : str
        A row of the catalogue; ``NLGI 000 grease`` to ``NLGI 3 grease``, or ``ISO VG 100 oil`` with
        any grade from 2 to 3200: those between the catalogue's rows lie between them.

    Raises
    ------
    CatalogError
        With the nearest names, when there is none.

    Examples
    --------
    >>> find_lubricant("ISO VG 68 oil").viscosity
    6.8e-05
    """
    text = " ".join(name.split())
    if grease := _GREASE.fullmatch(text):
        return lubricants()[f"NLGI {grease[1]} grease"]
    oil = _OIL.fullmatch(text)
    if oil and _LEAST_GRADE <= int(oil[1]) <= _MOST_GRADE:
        return _oil_of_grade(int(oil[1]))
    try:
        return find(name, lubricants(), "lubricant")
    except CatalogError as error:
        raise CatalogError(
            f"{error.message.removesuffix('.')}, and oils may have any grade from "
            f"'ISO VG {_LEAST_GRADE} oil' to 'ISO VG {_MOST_GRADE} oil'."
        ) from None


def _oil_of_grade(grade: int) -> Lubricant:
    """An oil whose viscosity at 100 C stands between those of its neighbours, as ASTM D341 draws.

    Beyond the catalogue's last rows the line through the two of them goes on.
    """
    oils = sorted(
        (one for one in lubricants().values() if one.kind == "oil"), key=lambda one: one.viscosity
    )
    grades = [round(1e6 * one.viscosity) for one in oils]
    if grade in grades:
        return oils[grades.index(grade)]
    after = min(max(sum(one < grade for one in grades), 1), len(oils) - 1)
    low, high = oils[after - 1], oils[after]
    share = (_walther(grade) - _walther(1e6 * low.viscosity)) / (
        _walther(1e6 * high.viscosity) - _walther(1e6 * low.viscosity)
    )
    ends = [_walther(1e6 * one.hot_viscosity) for one in (low, high)]
    hot = 10.0 ** (10.0 ** (ends[0] + share * (ends[1] - ends[0]))) - _WALTHER
    near = low if grade < 1e6 * low.viscosity else high
    name = f"ISO VG {grade} oil"
    return replace(near, name=name, viscosity=grade * 1e-6, hot_viscosity=hot * 1e-6)
