"""One mesh of the planetary at one load: stresses and safety factors by ISO 6336, factors kept."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.iso6336 import bending, pitting
from cqdd_design.planetary.load_factors import LoadFactors, MeshLoad, PlanetaryMesh, load_factors
from cqdd_design.planetary.settings import RatingSettings


@dataclass(frozen=True)
class GearRating:
    """One gear of a mesh: stresses in Pa, safety factors, and the factors behind them.

    `contact_stress` sigma_H, `bearable_contact` sigma_HG, `contact_safety` S_H, `root_stress`
    sigma_F, `bearable_root` sigma_FG, `bending_safety` S_F, `cycles` N_L; `factors` are the Z and Y
    by their ISO names.
    """

    contact_stress: float
    bearable_contact: float
    root_stress: float
    bearable_root: float
    cycles: float
    factors: dict[str, float]

    @property
    def contact_safety(self) -> float:
        """S_H = sigma_HG/sigma_H."""
        return self.bearable_contact / self.contact_stress

    @property
    def bending_safety(self) -> float:
        """S_F = sigma_FG/sigma_F."""
        return self.bearable_root / self.root_stress


@dataclass(frozen=True)
class MeshRating:
    """A mesh at a load: its load, load factors, and both gears."""

    mesh: str
    load: MeshLoad
    load_factors: LoadFactors
    hertz_pitch_point: float
    pinion: GearRating
    wheel: GearRating

    @property
    def contact_stress(self) -> float:
        """The larger sigma_H of the two gears, Pa."""
        return max(self.pinion.contact_stress, self.wheel.contact_stress)

    @property
    def root_stress(self) -> float:
        """sigma_F of the gear with the smaller S_F, Pa."""
        return min((self.pinion, self.wheel), key=lambda gear: gear.bending_safety).root_stress

    @property
    def contact_safety(self) -> float:
        """The smaller S_H."""
        return min(self.pinion.contact_safety, self.wheel.contact_safety)

    @property
    def bending_safety(self) -> float:
        """The smaller S_F."""
        return min(self.pinion.bending_safety, self.wheel.bending_safety)


def rate_mesh(
    mesh: PlanetaryMesh, load: MeshLoad, material: GearMaterial, settings: RatingSettings
) -> MeshRating:
    """Rate one mesh at one load (ISO 6336-1, -2, -3; both gears of `material`)."""
    pair = mesh.pair
    factors = load_factors(mesh, load, material, settings)
    elasticity = pitting.elasticity_factor(material, material)
    nominal = pitting.nominal_contact_stress(pair, load.tangential, elasticity)
    single_pair = pitting.single_pair_factors(pair)
    pitch_line_speed = 0.5 * load.pinion_speed * pair.reference_diameter(pair.pinion_teeth)
    film = {
        "Z_L": pitting.lubricant_factor(material.contact_limit, settings.lubricant_viscosity),
        "Z_v": pitting.velocity_factor(material.contact_limit, pitch_line_speed),
        "Z_R": pitting.roughness_factor(
            material.contact_limit,
            settings.flank_roughness,
            pitting.relative_curvature_radius(pair),
        ),
    }
    strength = {
        "Z_W": pitting.work_hardening_factor(material, material),
        "Z_X": pitting.size_factor(material, pair.module),
    }
    common = {
        "Z_H": pitting.zone_factor(pair),
        "Z_E_sqrtMPa": elasticity * 1e-3,
        "Z_eps": pitting.contact_ratio_factor(pair),
        "Z_beta": pitting.helix_factor(pair),
    }
    gears = []
    for index, cycles in enumerate((load.pinion_cycles, load.wheel_cycles)):
        root_stress, bearable_root, root_factors = _rate_root(
            mesh, index, load.tangential, factors, cycles, material, settings
        )
        gears.append(
            GearRating(
                contact_stress=single_pair[index] * nominal * math.sqrt(factors.contact),
                bearable_contact=pitting.bearable_contact_stress(
                    material.contact_limit,
                    math.prod(film.values()),
                    math.prod(strength.values()),
                    cycles,
                ),
                root_stress=root_stress,
                bearable_root=bearable_root,
                cycles=cycles,
                factors={
                    **common,
                    "Z_B" if index == 0 else "Z_D": single_pair[index],
                    **film,
                    **strength,
                    "Z_NT": pitting.life_factor(cycles),
                    **root_factors,
                },
            )
        )
    hertz = pitting.nominal_contact_stress(pair, load.tangential, elasticity, at_pitch_point=True)
    return MeshRating(mesh.name, load, factors, hertz, gears[0], gears[1])


def _rate_root(
    mesh: PlanetaryMesh,
    index: int,
    tangential: float,
    factors: LoadFactors,
    cycles: float,
    material: GearMaterial,
    settings: RatingSettings,
) -> tuple[float, float, dict[str, float]]:
    """sigma_F, sigma_FG (Pa) and the Y factors of pinion (0) or wheel (1)."""
    pair, form = mesh.pair, mesh.forms[index]
    contact_ratio = pair.transverse_contact_ratio / math.cos(pair.base_helix_angle) ** 2
    of_ring = index == 1 and pair.internal
    rim = bending.rim_factor_internal(mesh.ring_rim, pair.module) if of_ring else 1.0
    helix = bending.helix_factor(pair)
    deep = bending.deep_tooth_factor(contact_ratio, settings.accuracy_class)
    nominal = bending.nominal_root_stress(
        tangential,
        pair.face_width,
        pair.module,
        form.form_factor,
        form.stress_correction,
        helix * rim * deep,
    )
    sensitivity = bending.relative_notch_sensitivity(
        form.notch_parameter, bending.slip_layer_thickness(material)
    )
    static = bending.relative_notch_sensitivity_static(material, form.stress_correction)
    surface = bending.relative_surface_factor(settings.root_roughness)
    size = bending.size_factor(material, pair.module)
    reversed_bending = mesh.reversed_bending[index]
    bearable = bending.bearable_root_stress(
        material, sensitivity * surface * size, static * size, cycles, reversed_bending
    )
    return (
        nominal * factors.bending,
        bearable,
        {
            "Y_F": form.form_factor,
            "Y_S": form.stress_correction,
            "Y_beta": helix,
            "Y_B": rim,
            "Y_DT": deep,
            "Y_NT": bending.life_factor(material, cycles),
            "Y_deltarelT": sensitivity,
            "Y_deltarelT_static": static,
            "Y_RrelT": surface,
            "Y_X": size,
            "Y_M": bending.REVERSED_BENDING_FACTOR if reversed_bending else 1.0,
        },
    )
