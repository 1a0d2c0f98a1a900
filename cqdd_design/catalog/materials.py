"""Materials: elastic constants, strengths, hardness, and what heat does to them."""

from __future__ import annotations

import functools
import math
import re
from dataclasses import dataclass
from typing import Literal

from cqdd_design.catalog.reader import column, find, read_records

_PLASTIC_MODULUS = 20e9
"""Materials softer than this are plastics, Pa."""

DESIGN_STRAIN = 0.01
"""Most strain of a plastic that is loaded for long (Crawford, Plastics Engineering, p. 19:
1 % in the absence of specific information, about half of it of brittle plastics)."""


@dataclass(frozen=True)
class Material:
    """A material as delivered in a named condition.

    Attributes
    ----------
    name : str
        Catalogue name, as in design files.
    youngs_modulus, poisson_ratio, density : float
        Pa, 1, kg/m^3.
    yield_strength, ultimate_strength : float or None
        Pa; None where the source gives none.
    hardness : str
        As the source prints it ("335 HB @538C", "58-64 HRC"); empty where unknown.
    fatigue_strength : float or None
        Endurance limit in rotating bending, Pa.
    treatment : str
        Heat or cold treatment ("annealed", "case-hardened"); empty where there is none to speak of.
    drawing_note : str
        The treatment as a drawing of a part that is cut by wire says it; empty for stock as it is
        delivered.
    form : {"stock", "fastener", "motor"}
        Whether parts are made of it, it is bought as screws and pins, or it makes laminations,
        magnets and boards of motors.
    pulsating_strength : float or None
        Bending stress that may come and go for ever, Pa, where it is tabled for the part itself:
        shoulder screws, about S_u/4 for ground shoulder and fillet.
    pulsating_basis : str
        What it is tabled for, in words.
    contact_allowable : float or None
        Static contact pressure quoted by the source, Pa; for information.
    source : str
        Where the row comes from.
    expansion : float or None
        Linear thermal expansion near room temperature, 1/K; None where the source gives none.
    conductivity, specific_heat, emissivity : float or None
        W/(m K), J/(kg K), and of a surface as it is machined or moulded.
    service_limit : float or None
        Temperature up to which parts of it keep strength and shape, deg C.
    thermal_source : str
        Where these five come from.
    creep_modulus : float or None
        Of a plastic: stress over strain after 1000 h in tension at 23 deg C, Pa (ISO 899-1); None
        where no source has been read. Moulded bars say nothing of printed ones.
    creep_source : str
        Where it comes from.
    """

    name: str = column("name")
    youngs_modulus: float = column("E_GPa", 1e9)
    poisson_ratio: float = column("nu")
    density: float = column("density_kg_m3")
    yield_strength: float | None = column("yield_MPa", 1e6)
    ultimate_strength: float | None = column("ultimate_MPa", 1e6)
    hardness: str = column("hardness")
    fatigue_strength: float | None = column("fatigue_MPa", 1e6)
    treatment: str = column("treatment")
    drawing_note: str = column("drawing_note")
    form: Literal["stock", "fastener", "motor"] = column("form")
    pulsating_strength: float | None = column("pulsating_MPa", 1e6)
    pulsating_basis: str = column("pulsating_basis")
    contact_allowable: float | None = column("contact_allow_MPa", 1e6)
    source: str = column("source")
    expansion: float | None = column("cte_um_mK", 1e-6)
    conductivity: float | None = column("conductivity_W_mK")
    specific_heat: float | None = column("specific_heat_J_kgK")
    emissivity: float | None = column("emissivity")
    service_limit: float | None = column("service_C")
    thermal_source: str = column("thermal_source")
    creep_modulus: float | None = column("creep_GPa", 1e9)
    creep_source: str = column("creep_source")

    @property
    def is_plastic(self) -> bool:
        """Whether it is softer than any metal of the catalogue."""
        return self.youngs_modulus < _PLASTIC_MODULUS

    @property
    def held_stress(self) -> float | None:
        """What a plastic bears for long, Pa: `DESIGN_STRAIN` after 1000 h; None where not known."""
        return None if self.creep_modulus is None else DESIGN_STRAIN * self.creep_modulus

    @property
    def brinell_hardness(self) -> float | None:
        """HB, the least of a printed range; None when hardness is unknown or not in HB."""
        return _least_hardness(self.hardness, "HB")

    @property
    def drawn_hardness(self) -> str:
        """As a drawing asks for it.

        A range or a least value as printed. What is tempered to one value gets a band above it:
        strengths of the same row are counted on, so that less will not do. What comes as it is
        delivered is only told. Standards of wrought aluminium hold a temper by its strengths;
        hardness stands in them, where it does, as one figure for information (EN 485-2).

        Examples
        --------
        >>> find_material("AISI 4140 Q&T 540C").drawn_hardness
        '335 to 370 HB'
        >>> find_material("7075-T6").drawn_hardness
        'about 150 HB, no range in its standard'
        """
        text = re.sub(r"\(.*?\)|@\S+|~", "", self.hardness).strip()
        if not text:
            return "not specified"
        if found := re.fullmatch(r"(\d+)-(\d+) (.*)", text):
            return f"{found[1]} to {found[2]} {found[3]}"
        if found := re.fullmatch(r"(\d+) (\w+) min", text):
            return f"at least {found[1]} {found[2]}"
        value, _, scale = text.partition(" ")
        if "tempered" in self.treatment or "tempered" in self.drawing_note:
            return f"{value} to {math.ceil(_BAND * int(value) / 5.0) * 5} {scale}"
        aged = self.treatment == "precipitation-hardened"
        return f"about {text}{', no range in its standard' if aged else ''}"

    @property
    def rockwell_hardness(self) -> float | None:
        """HRC, the least of a printed range; None when hardness is unknown or not in HRC."""
        return _least_hardness(self.hardness, "HRC")

    @property
    def is_hardened(self) -> bool:
        """Whether the surface is hard enough for raceways, which :data:`HARDENED_HRC` says."""
        return self.rockwell_hardness is not None and self.rockwell_hardness >= HARDENED_HRC


HARDENED_HRC = 58.0
"""Least hardness of raceways, HRC: what ISO 76 and ISO 281 presume."""

_BAND = 1.1
"""Highest over least hardness that a drawing asks for where the catalogue has one value."""


def _least_hardness(text: str, scale: str) -> float | None:
    match = re.search(rf"(\d+(?:\.\d+)?)\s*(?:-\s*(\d+(?:\.\d+)?)\s*)?{scale}\b", text)
    return float(match.group(1)) if match else None


@functools.lru_cache(maxsize=1)
def materials() -> dict[str, Material]:
    """All materials by name, in file order."""
    return {one.name: one for one in read_records("materials.csv", Material)}


def find_material(name: str) -> Material:
    """The material called `name`.

    Raises
    ------
    CatalogError
        With the nearest names, when there is none.

    Examples
    --------
    >>> find_material("AISI 4140 Q&T 540C").yield_strength
    834000000.0
    """
    return find(name, materials(), "material")
