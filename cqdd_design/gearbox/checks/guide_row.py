"""One row of the guide to the checks, and the sources that several rows name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING

HOUSE = "house rule, fixed in cqdd_design.gearbox.checks.allowables"
PAPER = "Zhu, Tanaka, Rafeedi and Hong 2024, arXiv:2410.16591"
JOHNSON = "Johnson 1985, Contact Mechanics, eq. 4.45 (pressure) and section 6.1 (first yield)"
PITTING = "Johnson 1985, eq. 4.45; AGMA 2101-D04 grade 1, ISO 6336-5 MQ (strengths)"
WANG = "Wang, Luo and Su 2016, Mech. Mach. Theory 102, 135-148"
SHIGLEY = "Budynas and Nisbett, Shigley's Mechanical Engineering Design, pinned joints"

BODIES = (
    "plane stress by finite elements under the contact equilibrium's forces, "
    "cqdd_design.gearbox.bodies"
)
GOODMAN = "Budynas and Nisbett 2020, Shigley's Mechanical Engineering Design, sections 6-7 to 6-14"


GEOMETRY = "dimensions and materials of the design"
RIGID = f"rigid law x {UNEVEN_SHARING:g}, a first screen"
SCREENED = (
    "Forces are those of the contact equilibrium, driving with friction; the first screen of a "
    f"search takes {UNEVEN_SHARING:g} times the rigid law's."
)
FINITE_ELEMENTS = "finite elements under the forces of the contact equilibrium"
DRAWN = "gearboxes drawn from the tolerances, contact equilibrium with friction"
NETWORK = "thermal network of the drawn parts"


@dataclass(frozen=True)
class CheckGuide:
    """What one check means.

    Attributes
    ----------
    id, title, unit, sense, formula, why, source, severity
        As in :class:`cqdd_design.results.Check`.
    basis : str
        Of a value that no closer model gives.
    exception : str
        Where a violation counts otherwise than `severity` says, in words; empty where nowhere.
    """

    id: str
    title: str
    unit: str
    sense: Literal["max", "min"]
    formula: str
    why: str
    source: str
    severity: Literal["fail", "warn"] = "fail"
    basis: str = GEOMETRY
    exception: str = ""
