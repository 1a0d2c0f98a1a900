"""Cycloid against compound planetary: one call, every number of planets, the paper's claims."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from cqdd_design.errors import UsageError
from cqdd_design.planetary.assembly import (
    MOST_PLANETS,
    assembles,
    assembly_number,
    most_planets_that_fit,
    neighbour_gap,
    validate_planets,
)
from cqdd_design.planetary.claim_settings import (
    PAPER_FACE_WIDTH,
    PAPER_MODULE,
    PAPER_TEETH,
    ClaimSetting,
)
from cqdd_design.planetary.claims import Claim, PaperCase, paper_claims
from cqdd_design.planetary.cycloid import CycloidLimit, binding_limit
from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.gear_set import (
    LoadCase,
    PlanetaryGearSet,
    build_gear_set,
    planets_needed,
    rate_gear_set,
)
from cqdd_design.planetary.kinematics import (
    PlanetaryTeeth,
    ratio_carrier_fixed,
    ratio_ring_fixed,
)
from cqdd_design.planetary.rating import GearRating, MeshRating
from cqdd_design.planetary.settings import RatingSettings

#: The table over the number of planets goes at least this far.
LEAST_ROWS = 8


@dataclass(frozen=True)
class PlanetaryComparison:
    """A compound planetary rated for the loads of a cycloid, and the paper's claims.

    Attributes
    ----------
    bore : float or None
        Space inside the stator, m.
    planets : int
        The number of planets looked at in detail.
    planets_that_fit : int
        The most whose tips clear each other.
    planets_that_assemble : tuple of int
        Numbers up to 24 that can be spaced equally.
    needed_peak_bending, needed_peak_contact, needed_continuous_contact : int or None
        Fewest planets that keep the safety factor, fitting or not; None when 24 do not.
    ratings : tuple of (int, tuple of MeshRating)
        For each number of planets: sun and ring mesh at peak, then at continuous torque.
    claim_settings : tuple of ClaimSetting
        The grid behind two of the claims.
    """

    gears: PlanetaryGearSet
    material: GearMaterial
    peak: LoadCase
    continuous: LoadCase
    bore: float | None
    planets: int
    planets_that_fit: int
    planets_that_assemble: tuple[int, ...]
    needed_peak_bending: int | None
    needed_peak_contact: int | None
    needed_continuous_contact: int | None
    ratings: tuple[tuple[int, tuple[MeshRating, ...]], ...]
    claims: tuple[Claim, ...]
    claim_settings: tuple[ClaimSetting, ...]
    cycloid: tuple[CycloidLimit, ...]
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, object]:
        """The `results` of ``compare`` in JSON; every number finite, units in the names."""
        return {
            "planetary": self._planetary(),
            "cycloid": {
                "limits": [limit.to_dict() for limit in self.cycloid],
                "binding": {
                    load: found.to_dict() if found is not None else None
                    for load, found in (
                        ("peak", binding_limit(self.cycloid, "peak")),
                        ("continuous", binding_limit(self.cycloid, "continuous")),
                    )
                },
            },
            "paper_claims": [claim.to_dict() for claim in self.claims],
            "claim_settings": [setting.to_dict() for setting in self.claim_settings],
        }

    def _planetary(self) -> dict[str, object]:
        gears, envelope = self.gears, self.gears.envelope
        return {
            "teeth": dict(vars(gears.teeth)),
            "module_mm": gears.module * 1e3,
            "face_width_mm": gears.face_width * 1e3,
            "profile_shifts": dict(vars(gears.shifts)),
            "material": self.material.label,
            "contact_limit_MPa": self.material.contact_limit * 1e-6,
            "bending_limit_MPa": self.material.bending_limit * 1e-6,
            "settings": self.gears.settings.label,
            "rating_settings": self.gears.settings.to_dict(),
            "rating_settings_given": [
                name for name, _, usual in self.gears.settings.rows() if not usual
            ],
            "peak_torque_Nm": self.peak.torque,
            "continuous_torque_Nm": self.continuous.torque,
            "ratio": ratio_ring_fixed(gears.teeth),
            "ratio_carrier_fixed": ratio_carrier_fixed(gears.teeth),
            "centre_distance_mm": gears.centre_distance * 1e3,
            "ring_tip_diameter_mm": gears.ring_tip_diameter * 1e3,
            "contact_ratios": {
                mesh.name: {
                    "tip_circles": mesh.pair.transverse_contact_ratio,
                    "interference_free": mesh.pair.interference_free_contact_ratio,
                }
                for mesh in (gears.sun_mesh, gears.ring_mesh)
            },
            "planet_tip_diameter_mm": gears.largest_tip_diameter * 1e3,
            "envelope": {
                "planet_sweep_diameter_mm": envelope.planet_sweep_diameter * 1e3,
                "ring_outer_diameter_mm": envelope.ring_outer_diameter * 1e3,
                "outer_diameter_mm": envelope.outer_diameter * 1e3,
                "planet_bore_most_mm": envelope.planet_bore_most * 1e3,
                "bore_mm": None if self.bore is None else self.bore * 1e3,
                "fits_bore": None if self.bore is None else envelope.fits(self.bore),
            },
            "assembly_number": assembly_number(gears.teeth),
            "planets": self.planets,
            "planets_that_fit": self.planets_that_fit,
            "planets_that_assemble": list(self.planets_that_assemble),
            "planets_needed_peak_bending": self.needed_peak_bending,
            "planets_needed_peak_contact": self.needed_peak_contact,
            "planets_needed_continuous_contact": self.needed_continuous_contact,
            "by_planets": [
                self._row(planets, rating) for planets, found in self.ratings for rating in found
            ],
            "detail": [
                _detail(rating)
                for planets, found in self.ratings
                if planets == self.planets
                for rating in found
            ],
        }

    def _row(self, planets: int, rating: MeshRating) -> dict[str, object]:
        gears = self.gears
        gap = neighbour_gap(gears.centre_distance, gears.largest_tip_diameter, planets)
        return {
            "planets": planets,
            "fits": gears.fits(planets),
            "assembles": assembles(gears.teeth, planets),
            "neighbour_gap_mm": gap * 1e3 if math.isfinite(gap) else None,
            "mesh": rating.mesh,
            "load": rating.load.name,
            "F_t_N": rating.load.tangential,
            "K_gamma": rating.load_factors.mesh_load,
            "hertz_pitch_point_MPa": rating.hertz_pitch_point * 1e-6,
            "sigma_H_MPa": rating.contact_stress * 1e-6,
            "S_H": rating.contact_safety,
            "sigma_F_MPa": rating.root_stress * 1e-6,
            "S_F": rating.bending_safety,
        }


def _detail(rating: MeshRating) -> dict[str, object]:
    factors = rating.load_factors
    return {
        "mesh": rating.mesh,
        "load": rating.load.name,
        "load_factors": {
            "K_A": factors.application,
            "K_gamma": factors.mesh_load,
            "K_v": factors.dynamic,
            "K_Hbeta": factors.face_contact,
            "K_Halpha": factors.transverse_contact,
            "K_Fbeta": factors.face_bending,
            "K_Falpha": factors.transverse_bending,
        },
        "pinion": _gear(rating.pinion),
        "wheel": _gear(rating.wheel),
    }


def _gear(rating: GearRating) -> dict[str, object]:
    return {
        "sigma_H_MPa": rating.contact_stress * 1e-6,
        "sigma_HG_MPa": rating.bearable_contact * 1e-6,
        "S_H": rating.contact_safety,
        "sigma_F_MPa": rating.root_stress * 1e-6,
        "sigma_FG_MPa": rating.bearable_root * 1e-6,
        "S_F": rating.bending_safety,
        "N_L": rating.cycles,
        "factors": dict(rating.factors),
    }


def compare_planetary(
    material: GearMaterial,
    *,
    peak_torque: float,
    continuous_torque: float,
    input_speed: float,
    teeth: PlanetaryTeeth = PAPER_TEETH,
    module: float = PAPER_MODULE,
    face_width: float = PAPER_FACE_WIDTH,
    planets: int | None = None,
    bore: float | None = None,
    settings: RatingSettings | None = None,
    cycloid: Sequence[CycloidLimit] = (),
    paper: PaperCase | None = None,
) -> PlanetaryComparison:
    """Rate a compound planetary for a cycloid's loads and answer the paper's claims.

    Parameters
    ----------
    material : GearMaterial
        Of all gears; see :func:`gear_material.gear_material`.
    peak_torque, continuous_torque : float
        At the carrier, N*m, positive.
    input_speed : float
        Of the sun, rad/s, positive.
    teeth : PlanetaryTeeth
        Default the paper's 12/36/22/70.
    module, face_width : float
        m.
    planets : int, optional
        The number looked at in detail; default the most that fit and assemble.
    bore : float, optional
        Diameter of the space inside the stator, m.
    cycloid : sequence of CycloidLimit
        The cycloid's limits at the same loads, computed elsewhere.
    settings : RatingSettings, optional
        What ISO 6336 leaves to the designer.
    paper : PaperCase, optional
        What the paper's claims are judged on; default what is compared here.

    Raises
    ------
    UsageError
        A number outside its range.
    GeometryError
        Teeth that cannot make this gear.

    Examples
    --------
    >>> from cqdd_design.catalog import find_material
    >>> from cqdd_design.planetary.gear_material import gear_material
    >>> steel = gear_material(find_material("AISI 4140 Q&T 540C"))
    >>> found = compare_planetary(
    ...     steel, peak_torque=120.0, continuous_torque=40.0, input_speed=134.7
    ... )
    >>> found.planets_that_fit, found.planets_that_assemble[:5]
    (3, (1, 2, 3, 4, 6))
    """
    chosen = settings or RatingSettings()
    for name, value, unit in (
        ("peak torque", peak_torque, "N*m"),
        ("continuous torque", continuous_torque, "N*m"),
        ("input speed", input_speed, "rad/s"),
        ("bore", 1.0 if bore is None else bore, "m"),
    ):
        if not 0.0 < value < math.inf:
            raise UsageError(f"{name}: {value:g} {unit} is not a positive number.")
    if planets is not None:
        validate_planets(planets)
    gears = build_gear_set(teeth, module, face_width, chosen)
    peak = LoadCase("peak", peak_torque, input_speed, chosen.peak_cycles)
    continuous = LoadCase("continuous", continuous_torque, input_speed, None)
    most = most_planets_that_fit(gears.centre_distance, gears.largest_tip_diameter)
    assembling = tuple(n for n in range(1, MOST_PLANETS + 1) if assembles(teeth, n))
    needed = (
        planets_needed(gears, peak, material, "bending"),
        planets_needed(gears, peak, material, "contact"),
        planets_needed(gears, continuous, material, "contact"),
    )
    looked_at = planets or max(n for n in assembling if n <= most)
    last = max(LEAST_ROWS, looked_at, most, *(n for n in needed if n is not None))
    ratings = tuple(
        (
            n,
            (
                *rate_gear_set(gears, n, peak, material),
                *rate_gear_set(gears, n, continuous, material),
            ),
        )
        for n in range(1, last + 1)
    )
    case = paper or PaperCase(material, input_speed, bore, tuple(cycloid))
    # Shifts and tips drawn for other teeth say nothing about the paper's.
    own = teeth == PAPER_TEETH and module == PAPER_MODULE
    for_paper = chosen if own else replace(chosen, shifts=None, ring_tip_diameter=None)
    claims, grid = paper_claims(case, for_paper)
    return PlanetaryComparison(
        gears=gears,
        material=material,
        peak=peak,
        continuous=continuous,
        bore=bore,
        planets=looked_at,
        planets_that_fit=most,
        planets_that_assemble=assembling,
        needed_peak_bending=needed[0],
        needed_peak_contact=needed[1],
        needed_continuous_contact=needed[2],
        ratings=ratings,
        claims=claims,
        claim_settings=grid,
        cycloid=tuple(cycloid),
        warnings=_warnings(gears, material, looked_at, bore, needed),
    )


def _warnings(
    gears: PlanetaryGearSet,
    material: GearMaterial,
    planets: int,
    bore: float | None,
    needed: tuple[int | None, int | None, int | None],
) -> tuple[str, ...]:
    found = [*gears.warnings, *material.notes]
    if not gears.fits(planets):
        found.append(f"{planets} planets overlap; the rating says what their teeth would bear.")
    if not assembles(gears.teeth, planets):
        found.append(f"{planets} identical planets cannot be spaced equally with these teeth.")
    if bore is not None and not gears.envelope.fits(bore):
        found.append(
            f"The planetary needs {gears.envelope.outer_diameter * 1e3:.4g} mm, more than the bore "
            f"of {bore * 1e3:.4g} mm."
        )
    for name, value in zip(
        ("bending at peak torque", "contact at peak torque", "contact at continuous torque"),
        needed,
        strict=True,
    ):
        if value is None:
            found.append(
                f"Not even {MOST_PLANETS} planets keep the safety factor in {name}, so no number "
                "is given."
            )
    return tuple(found)
