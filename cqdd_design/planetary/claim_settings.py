"""The grid of materials and load factors over which two of the paper's claims are tried."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cqdd_design.catalog import find_material, paper
from cqdd_design.planetary.assembly import MOST_PLANETS, assembles, most_planets_that_fit
from cqdd_design.planetary.gear_material import GearMaterial, Quality, gear_material
from cqdd_design.planetary.gear_set import (
    LoadCase,
    PlanetaryGearSet,
    build_gear_set,
    rate_gear_set,
)
from cqdd_design.planetary.kinematics import PlanetaryTeeth
from cqdd_design.planetary.settings import RatingSettings

#: What the paper prints.
PAPER_TEETH = PlanetaryTeeth(*paper.PLANETARY_TEETH)
PAPER_MODULE, PAPER_FACE_WIDTH = paper.PLANETARY_MODULE, paper.PLANETARY_FACE_WIDTH
PAPER_PEAK_TORQUE, PAPER_CONTINUOUS_TORQUE = paper.PEAK_TORQUE, paper.CONTINUOUS_TORQUE
PAPER_RATIO, PAPER_PLANETS = paper.RATIO, paper.PLANETARY_PLANETS
#: Five 4 mm pins on 19.5 mm, each in single shear at 35 ksi, all fully loaded at once.
PAPER_PIN_TORQUE = paper.PINS_TORQUE

#: Materials and qualities of the grid: 4140 from soft to hard, and the usual gear steel.
SEARCHED_MATERIALS = (
    "AISI 4140 annealed",
    "AISI 4140 Q&T 650C",
    "AISI 4140 Q&T 540C",
    "AISI 4140 Q&T 425C",
    "SCM415/16MnCr5 case hardened",
)
SEARCHED_QUALITIES: tuple[Quality, ...] = ("ML", "MQ")
SEARCHED_APPLICATION_FACTORS = (1.0, 1.5)


def searched_factors(settings: RatingSettings) -> dict[str, RatingSettings]:
    """The sets of load factors of the grid, everything else as in `settings`.

    "stated" takes K_v 1.05 (IEC 61400-4, least value) and K_Hbeta 1.25 (the planetary of AGMA
    6123-C16 Annex C).
    """
    perfect = RatingSettings.nominal()
    nominal = replace(
        settings,
        mesh_load_table=perfect.mesh_load_table,
        dynamic_factor=perfect.dynamic_factor,
        face_load_factor=perfect.face_load_factor,
        transverse_load_factor=perfect.transverse_load_factor,
    )
    computed = replace(
        settings,
        mesh_load_table="iso",
        dynamic_factor=None,
        face_load_factor=None,
        transverse_load_factor=None,
    )
    return {
        "all K = 1": nominal,
        "sharing only": replace(nominal, mesh_load_table="iso"),
        "stated": replace(
            nominal, mesh_load_table="iso", dynamic_factor=1.05, face_load_factor=1.25
        ),
        "computed, class 5, crowned": replace(computed, accuracy_class=5, crowned=True),
        "computed, class 7, not crowned": replace(computed, accuracy_class=7, crowned=False),
    }


@dataclass(frozen=True)
class ClaimSetting:
    """The two claims that hang on settings, under one of them.

    Attributes
    ----------
    material, factors : str
        Material with hardness and quality; key of :func:`searched_factors`.
    planets_needed : int or None
        Fewest planets that bear the peak torque and assemble; None if 24 do not suffice.
    contact_safety_six, contact_safety_fitting : float
        S_H at the continuous torque with six planets, and with the most that fit.
    """

    material: str
    factors: str
    application_factor: float
    planets_needed: int | None
    contact_safety_six: float
    contact_safety_fitting: float
    least_contact_safety: float

    @property
    def six_needed(self) -> bool:
        """Whether exactly the paper's six planets are needed."""
        return self.planets_needed == PAPER_PLANETS

    @property
    def surface_failure(self) -> bool:
        """Whether the flanks of six planets fail at the continuous torque."""
        return self.contact_safety_six < self.least_contact_safety

    @property
    def label(self) -> str:
        """As answers quote it."""
        return f"{self.material} with {self.factors}, K_A {self.application_factor:g}"

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "material": self.material,
            "factors": self.factors,
            "application_factor": self.application_factor,
            "planets_needed_peak": self.planets_needed,
            "S_H_continuous_six_planets": self.contact_safety_six,
            "S_H_continuous_most_that_fit": self.contact_safety_fitting,
            "six_planets_needed": self.six_needed,
            "surface_failure": self.surface_failure,
        }


def _is_safe(gears: PlanetaryGearSet, planets: int, case: LoadCase, material: GearMaterial) -> bool:
    settings = gears.settings
    return all(
        rating.contact_safety >= settings.least_contact_safety
        and rating.bending_safety >= settings.least_bending_safety
        for rating in rate_gear_set(gears, planets, case, material)
    )


def planets_needed_and_assembling(
    gears: PlanetaryGearSet, case: LoadCase, material: GearMaterial
) -> int | None:
    """The fewest planets that bear the load in contact and bending and can be spaced equally."""
    for planets in range(1, MOST_PLANETS + 1):
        if assembles(gears.teeth, planets) and _is_safe(gears, planets, case, material):
            return planets
    return None


def evaluate_setting(
    gears: PlanetaryGearSet,
    peak: LoadCase,
    continuous: LoadCase,
    material: GearMaterial,
    factors: str,
) -> ClaimSetting:
    """Answer the two claims that hang on settings for one gear set, material and set of factors."""
    fitting = most_planets_that_fit(gears.centre_distance, gears.largest_tip_diameter)
    safety = [
        min(r.contact_safety for r in rate_gear_set(gears, planets, continuous, material))
        for planets in (PAPER_PLANETS, fitting)
    ]
    return ClaimSetting(
        material=material.label,
        factors=factors,
        application_factor=gears.settings.application_factor,
        planets_needed=planets_needed_and_assembling(gears, peak, material),
        contact_safety_six=safety[0],
        contact_safety_fitting=safety[1],
        least_contact_safety=gears.settings.least_contact_safety,
    )


def search_settings(
    settings: RatingSettings, peak: LoadCase, continuous: LoadCase
) -> tuple[ClaimSetting, ...]:
    """The paper's gear set under every combination of the searched materials and factors."""
    steels = [
        gear_material(find_material(name), quality)
        for name in SEARCHED_MATERIALS
        for quality in SEARCHED_QUALITIES
    ]
    found: list[ClaimSetting] = []
    for name, factors in searched_factors(settings).items():
        for application in SEARCHED_APPLICATION_FACTORS:
            gears = build_gear_set(
                PAPER_TEETH,
                PAPER_MODULE,
                PAPER_FACE_WIDTH,
                replace(factors, application_factor=application),
            )
            found.extend(evaluate_setting(gears, peak, continuous, steel, name) for steel in steels)
    return tuple(found)
