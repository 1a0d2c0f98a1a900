"""The grid of materials and load factors over which two of the paper's claims are tried."""

from __future__ import annotations

import itertools
from bisect import bisect_left
from dataclasses import dataclass, replace
from functools import cache, lru_cache

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
#: K_gamma: equal shares, ISO 6336-1 with IEC 61400-4, and the ABS rules.
SEARCHED_MESH_LOAD_TABLES = ("equal", "iso", "abs")
#: S_H asked, and load cycles at the peak torque: static strength in contact, and a tenth of the
#: root's endurance.
SEARCHED_CONTACT_SAFETIES = (1.0, 1.2)
SEARCHED_PEAK_CYCLES = (1e4, 3e5)


def searched_factors(settings: RatingSettings) -> dict[str, RatingSettings]:
    """The sets of load factors of the grid, everything else as in `settings`.

    "stated" takes K_v 1.05 (IEC 61400-4, least value) and K_Hbeta 1.25 (the planetary of AGMA
    6123-C16 Annex C).
    """
    perfect = RatingSettings.nominal()
    nominal = replace(
        settings,
        dynamic_factor=perfect.dynamic_factor,
        face_load_factor=perfect.face_load_factor,
        transverse_load_factor=perfect.transverse_load_factor,
    )
    computed = replace(
        settings, dynamic_factor=None, face_load_factor=None, transverse_load_factor=None
    )
    return {
        "all other K = 1": nominal,
        "stated": replace(nominal, dynamic_factor=1.05, face_load_factor=1.25),
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
    least_contact_safety : float
        S_H asked.
    """

    material: str
    factors: str
    application_factor: float
    mesh_load_table: str
    peak_cycles: float
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
        return (
            f"{self.material} with {self.factors}, K_A {self.application_factor:g}, K_gamma "
            f"'{self.mesh_load_table}', S_H {self.least_contact_safety:g}, {self.peak_cycles:g} "
            "cycles at peak"
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "material": self.material,
            "factors": self.factors,
            "application_factor": self.application_factor,
            "mesh_load_table": self.mesh_load_table,
            "S_H_asked": self.least_contact_safety,
            "peak_cycles": self.peak_cycles,
            "planets_needed_peak": self.planets_needed,
            "S_H_continuous_six_planets": self.contact_safety_six,
            "S_H_continuous_most_that_fit": self.contact_safety_fitting,
            "six_planets_needed": self.six_needed,
            "surface_failure": self.surface_failure,
        }


def evaluate_settings(
    gears: PlanetaryGearSet,
    peak: LoadCase,
    continuous: LoadCase,
    material: GearMaterial,
    factors: str,
    asked: tuple[float, ...] = (),
) -> tuple[ClaimSetting, ...]:
    """Answer the two claims that hang on settings, for each contact safety asked.

    Parameters
    ----------
    asked : tuple of float
        S_H; default that of the gears' settings. The ratings are worked out once for all.
    """
    settings = gears.settings
    fitting = most_planets_that_fit(gears.centre_distance, gears.largest_tip_diameter)
    six, most = (
        min(r.contact_safety for r in rate_gear_set(gears, planets, continuous, material))
        for planets in (PAPER_PLANETS, fitting)
    )
    bears = cache(lambda planets: rate_gear_set(gears, planets, peak, material))

    assembling = [n for n in range(1, MOST_PLANETS + 1) if assembles(gears.teeth, n)]

    def needed(contact: float) -> int | None:
        """The fewest planets that bear the peak torque and can be spaced equally."""

        def safe(planets: int) -> bool:
            return all(
                r.contact_safety >= contact and r.bending_safety >= settings.least_bending_safety
                for r in bears(planets)
            )

        # More planets are never worse, so what bears it is a tail of the list.
        first = bisect_left(assembling, True, key=safe)
        return assembling[first] if first < len(assembling) else None

    return tuple(
        ClaimSetting(
            material=material.label,
            factors=factors,
            application_factor=settings.application_factor,
            mesh_load_table=settings.mesh_load_table,
            peak_cycles=settings.peak_cycles if peak.cycles is None else peak.cycles,
            planets_needed=needed(contact),
            contact_safety_six=six,
            contact_safety_fitting=most,
            least_contact_safety=contact,
        )
        for contact in asked or (settings.least_contact_safety,)
    )


@lru_cache(maxsize=8)
def search_settings(settings: RatingSettings, sun_speed: float) -> tuple[ClaimSetting, ...]:
    """The paper's gear set under every combination of what is searched.

    Parameters
    ----------
    settings : RatingSettings
        For everything else: life, lubricant, roughness, S_F, shifts.
    sun_speed : float
        rad/s.
    """
    steels = [
        gear_material(find_material(name), quality)
        for name in SEARCHED_MATERIALS
        for quality in SEARCHED_QUALITIES
    ]
    found: list[ClaimSetting] = []
    continuous = LoadCase("continuous", PAPER_CONTINUOUS_TORQUE, sun_speed, None)
    for (name, factors), table, application, cycles, steel in itertools.product(
        searched_factors(settings).items(),
        SEARCHED_MESH_LOAD_TABLES,
        SEARCHED_APPLICATION_FACTORS,
        SEARCHED_PEAK_CYCLES,
        steels,
    ):
        chosen = replace(factors, mesh_load_table=table, application_factor=application)
        gears = _papers_gears(chosen)
        peak = LoadCase("peak", PAPER_PEAK_TORQUE, sun_speed, cycles)
        found += evaluate_settings(gears, peak, continuous, steel, name, SEARCHED_CONTACT_SAFETIES)
    return tuple(found)


@lru_cache(maxsize=32)
def _papers_gears(settings: RatingSettings) -> PlanetaryGearSet:
    return build_gear_set(PAPER_TEETH, PAPER_MODULE, PAPER_FACE_WIDTH, settings)
