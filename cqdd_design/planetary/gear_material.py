"""Allowable stress numbers of gear materials: ISO 6336-5:2016, Table 1.

sigma_Hlim and sigma_Flim are A x + B of the hardness x in HV, by material class and quality. The
constants A and B and the range of x are those of Table 1 (rows 21 to 32, 41 to 55), read from the
open transcription in MechanicalCalculatorWeb (Iso6336Material.cs) and agreeing with the anchor
values commonly quoted: 1500 MPa for case-hardened MQ, 430 to 500 MPa in bending.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Literal, get_args

from cqdd_design.catalog import Material
from cqdd_design.errors import UsageError

MaterialClass = Literal[
    "through-hardened carbon steel",
    "through-hardened alloy steel",
    "case-hardened steel",
    "induction-hardened steel",
]
Quality = Literal["ML", "MQ", "ME"]
QUALITIES: tuple[Quality, ...] = get_args(Quality)


@dataclass(frozen=True)
class _Row:
    """sigma_lim = slope x + offset in MPa for least <= x <= most in HV; `number` in Table 1."""

    slope: float
    offset: float
    least: float
    most: float
    number: int


_CARBON: MaterialClass = "through-hardened carbon steel"
_ALLOY: MaterialClass = "through-hardened alloy steel"
_CASE: MaterialClass = "case-hardened steel"
_INDUCTION: MaterialClass = "induction-hardened steel"

_CONTACT: dict[tuple[MaterialClass, Quality], _Row] = {
    (_CARBON, "ML"): _Row(0.963, 283.0, 135.0, 210.0, 21),
    (_CARBON, "MQ"): _Row(0.925, 360.0, 135.0, 210.0, 22),
    (_CARBON, "ME"): _Row(0.838, 432.0, 135.0, 210.0, 23),
    (_ALLOY, "ML"): _Row(1.313, 188.0, 200.0, 360.0, 24),
    (_ALLOY, "MQ"): _Row(1.313, 373.0, 200.0, 360.0, 25),
    (_ALLOY, "ME"): _Row(2.213, 260.0, 200.0, 390.0, 26),
    (_CASE, "ML"): _Row(0.0, 1300.0, 600.0, 800.0, 41),
    (_CASE, "MQ"): _Row(0.0, 1500.0, 660.0, 800.0, 42),
    (_CASE, "ME"): _Row(0.0, 1650.0, 660.0, 800.0, 43),
    (_INDUCTION, "ML"): _Row(0.740, 602.0, 485.0, 615.0, 49),
    (_INDUCTION, "MQ"): _Row(0.541, 882.0, 500.0, 615.0, 50),
    (_INDUCTION, "ME"): _Row(0.505, 1013.0, 500.0, 615.0, 51),
}
_BENDING: dict[tuple[MaterialClass, Quality], _Row] = {
    (_CARBON, "ML"): _Row(0.250, 108.0, 115.0, 215.0, 27),
    (_CARBON, "MQ"): _Row(0.240, 163.0, 115.0, 215.0, 28),
    (_CARBON, "ME"): _Row(0.283, 202.0, 115.0, 215.0, 29),
    (_ALLOY, "ML"): _Row(0.423, 104.0, 200.0, 360.0, 30),
    (_ALLOY, "MQ"): _Row(0.425, 187.0, 200.0, 360.0, 31),
    (_ALLOY, "ME"): _Row(0.358, 231.0, 200.0, 390.0, 32),
    (_CASE, "ML"): _Row(0.0, 312.0, 600.0, 800.0, 44),
    (_CASE, "MQ"): _Row(0.0, 425.0, 660.0, 800.0, 45),
    (_CASE, "ME"): _Row(0.0, 525.0, 660.0, 800.0, 48),
    (_INDUCTION, "ML"): _Row(0.305, 76.0, 485.0, 615.0, 52),
    (_INDUCTION, "MQ"): _Row(0.138, 290.0, 500.0, 570.0, 53),
    (_INDUCTION, "ME"): _Row(0.271, 237.0, 500.0, 615.0, 55),
}

#: HRC and HV of unalloyed and low-alloy steel, ISO 18265:2013 Table A.1 (from memory, to 1 %).
_ROCKWELL_VICKERS = (
    (20.3, 240.0),
    (31.0, 310.0),
    (40.8, 400.0),
    (49.1, 500.0),
    (55.2, 600.0),
    (60.1, 700.0),
    (64.0, 800.0),
)


def vickers_from_brinell(brinell: float) -> float:
    """HV of steel from HB: 1.05 HB (ISO 18265:2013 Table A.1 to 1 % from 150 to 450 HB).

    Examples
    --------
    >>> round(vickers_from_brinell(335.0))
    352
    """
    return 1.05 * brinell


def vickers_from_rockwell(rockwell: float) -> float:
    """HV of steel from HRC by linear interpolation of ISO 18265:2013 Table A.1, 20 to 64 HRC.

    Examples
    --------
    >>> vickers_from_rockwell(60.1)
    700.0
    """
    table = _ROCKWELL_VICKERS
    if rockwell <= table[0][0]:
        return table[0][1]
    for (low, hv_low), (high, hv_high) in itertools.pairwise(table):
        if rockwell <= high:
            return hv_low + (hv_high - hv_low) * (rockwell - low) / (high - low)
    return table[-1][1]


@dataclass(frozen=True)
class GearMaterial:
    """A gear steel with the stress numbers ISO 6336 rates it by. Stresses in Pa.

    Attributes
    ----------
    name : str
        Catalogue name.
    youngs_modulus, poisson_ratio, density : float
        Pa, 1, kg/m^3.
    yield_strength : float
        sigma_S or sigma_0.2, Pa; enters the notch sensitivity.
    quality : {"ML", "MQ", "ME"}
        Modest, normal, high demands on the material.
    hardness_vickers : float
        Surface hardness, HV.
    contact_limit, bending_limit : float
        sigma_Hlim and sigma_Flim, Pa; sigma_FE is twice sigma_Flim.
    notes : tuple of str
        What had to be assumed; shown as warnings.
    """

    name: str
    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float
    material_class: MaterialClass
    quality: Quality
    hardness_vickers: float
    contact_limit: float
    bending_limit: float
    notes: tuple[str, ...] = ()

    @property
    def surface_hardened(self) -> bool:
        """Case or induction hardened (Eh, IF in ISO 6336) as against through-hardened (V)."""
        return self.material_class in (_CASE, _INDUCTION)

    @property
    def label(self) -> str:
        """Name, hardness and quality, as answers quote it."""
        return f"{self.name} ({self.hardness_vickers:.0f} HV, {self.quality})"


def stress_numbers(
    material_class: MaterialClass, quality: Quality, hardness_vickers: float
) -> tuple[float, float, str]:
    """sigma_Hlim and sigma_Flim in Pa by ISO 6336-5:2016 Table 1, and a note when clamped.

    Hardness outside a row's range is replaced by the nearest end of the range: the standard gives
    no credit for more, and none of the rows may be extended.

    Examples
    --------
    >>> contact, bending, note = stress_numbers("through-hardened alloy steel", "MQ", 352.0)
    >>> round(contact / 1e6), round(bending / 1e6), note
    (835, 337, '')
    """
    values, ranges = [], []
    for table in (_CONTACT, _BENDING):
        row = table[material_class, quality]
        used = min(max(hardness_vickers, row.least), row.most)
        values.append((row.slope * used + row.offset) * 1e6)
        # One per cent is the uncertainty of any conversion between hardness scales.
        if abs(used - hardness_vickers) > 0.01 * used:
            ranges.append(f"{row.least:.0f} to {row.most:.0f} HV (row {row.number})")
    note = ""
    if ranges:
        note = (
            f"ISO 6336-5 covers {material_class} {quality} from "
            f"{' and '.join(dict.fromkeys(ranges))}; {hardness_vickers:.0f} HV was rated as the "
            "nearest end."
        )
    return values[0], values[1], note


def gear_material(material: Material, quality: Quality = "MQ") -> GearMaterial:
    """A catalogue material as ISO 6336-5 sees it.

    What the catalogue calls case-hardened is; otherwise 485 HV and more is rated as
    induction-hardened (the only class of the table for hard steel without a case), 200 HV and more
    as through-hardened alloy steel, less as through-hardened carbon steel.

    Parameters
    ----------
    material : Material
        A steel with a hardness in HB or HRC.
    quality : {"ML", "MQ", "ME"}
        MQ is what an experienced maker reaches at ordinary cost.

    Raises
    ------
    UsageError
        Not a steel, or no hardness.

    Examples
    --------
    >>> from cqdd_design.catalog import find_material
    >>> round(gear_material(find_material("AISI 4140 Q&T 540C")).contact_limit / 1e6)
    835
    """
    vickers = _vickers(material)
    stainless = material.youngs_modulus < 200e9
    if not 185e9 <= material.youngs_modulus <= 220e9 or material.yield_strength is None:
        raise UsageError(
            f"material: ISO 6336-5 has no stress numbers for '{material.name}'; rate the planetary "
            "in a steel, such as 'AISI 4140 Q&T 540C'."
        )
    if vickers is None:
        raise UsageError(
            f"material: '{material.name}' has no hardness in the catalogue, and ISO 6336-5 rates "
            "steel by its hardness; choose one that has, such as 'AISI 4140 Q&T 540C'."
        )
    found_class = _class_of(material, vickers)
    contact, bending, note = stress_numbers(found_class, quality, vickers)
    notes = [note] if note else []
    if stainless:
        notes.append(
            f"ISO 6336-5 has no stainless steel: '{material.name}' was rated as {found_class} of "
            "its hardness."
        )
    return GearMaterial(
        name=material.name,
        youngs_modulus=material.youngs_modulus,
        poisson_ratio=material.poisson_ratio,
        density=material.density,
        yield_strength=material.yield_strength,
        material_class=found_class,
        quality=quality,
        hardness_vickers=vickers,
        contact_limit=contact,
        bending_limit=bending,
        notes=tuple(notes),
    )


def _vickers(material: Material) -> float | None:
    if material.rockwell_hardness is not None and material.rockwell_hardness >= 20.0:
        return vickers_from_rockwell(material.rockwell_hardness)
    if material.brinell_hardness is not None:
        return vickers_from_brinell(material.brinell_hardness)
    return None


def _class_of(material: Material, vickers: float) -> MaterialClass:
    if material.treatment == "case-hardened":
        return _CASE
    if vickers >= 485.0:
        return _INDUCTION
    return _ALLOY if vickers >= 200.0 else _CARBON
