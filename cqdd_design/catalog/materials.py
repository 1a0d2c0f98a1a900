"""Materials: elastic constants, strengths, hardness."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass

from cqdd_design.catalog.reader import find, number, optional_number, read_rows


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
    contact_allowable : float or None
        Static contact pressure quoted by the source, Pa; for information.
    source : str
        Where the row comes from.
    """

    name: str
    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float | None
    ultimate_strength: float | None
    hardness: str
    fatigue_strength: float | None
    contact_allowable: float | None
    source: str

    @property
    def brinell_hardness(self) -> float | None:
        """HB, the least of a printed range; None when hardness is unknown or not in HB."""
        return _least_hardness(self.hardness, "HB")

    @property
    def rockwell_hardness(self) -> float | None:
        """HRC, the least of a printed range; None when hardness is unknown or not in HRC."""
        return _least_hardness(self.hardness, "HRC")


def _least_hardness(text: str, scale: str) -> float | None:
    match = re.search(rf"(\d+(?:\.\d+)?)\s*(?:-\s*(\d+(?:\.\d+)?)\s*)?{scale}\b", text)
    return float(match.group(1)) if match else None


@functools.lru_cache(maxsize=1)
def materials() -> dict[str, Material]:
    """All materials by name, in file order."""
    table = {}
    for row in read_rows("materials.csv"):
        table[row["name"]] = Material(
            name=row["name"],
            youngs_modulus=number(row, "E_GPa", 1e9),
            poisson_ratio=number(row, "nu"),
            density=number(row, "density_kg_m3"),
            yield_strength=optional_number(row, "yield_MPa", 1e6),
            ultimate_strength=optional_number(row, "ultimate_MPa", 1e6),
            hardness=row["hardness"],
            fatigue_strength=optional_number(row, "fatigue_MPa", 1e6),
            contact_allowable=optional_number(row, "contact_allow_MPa", 1e6),
            source=row["source"],
        )
    return table


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
