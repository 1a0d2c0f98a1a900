"""The K factors of one planetary mesh: stated by the settings, or computed by ISO 6336-1."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.iso6336 import deviations, influence, pitting
from cqdd_design.planetary.iso6336.form_factor import ToothForm, pair_tooth_forms
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.planetary.tooth_geometry import GearPair


@dataclass(frozen=True)
class PlanetaryMesh:
    """One of the two meshes, with what does not depend on the load.

    Attributes
    ----------
    name : str
        ``sun_planet`` or ``planet_ring``.
    reversed_bending : (bool, bool)
        Whether the roots of pinion and wheel are bent both ways by the other mesh (an idler
        planet).
    ring_rim : float
        Material outside the ring's roots, m. Gears inside have enough behind theirs: 1.2 tooth
        depths, below which ISO 6336-3, 9.3 raises the stress (`PlanetaryEnvelope`).
    """

    name: str
    pair: GearPair
    reversed_bending: tuple[bool, bool]
    ring_rim: float = math.inf

    @property
    def pinion_is_sun(self) -> bool:
        """The sun meets every planet, so its wind-up grows with their number; a planet one ring."""
        return not self.pair.internal

    @functools.cached_property
    def forms(self) -> tuple[ToothForm, ToothForm]:
        """Tooth forms of pinion and wheel, once for all loads."""
        return pair_tooth_forms(self.pair)


@dataclass(frozen=True)
class MeshLoad:
    """What one mesh carries.

    Attributes
    ----------
    name : str
        ``peak`` or ``continuous``.
    tangential : float
        Nominal F_t of one mesh with equal sharing, N.
    pinion_speed : float
        Against the carrier, rad/s, positive.
    pinion_cycles, wheel_cycles : float
        Load cycles of one tooth, N_L.
    """

    name: str
    planets: int
    tangential: float
    pinion_speed: float
    pinion_cycles: float
    wheel_cycles: float


@dataclass(frozen=True)
class LoadFactors:
    """K_A, K_gamma, K_v, K_Hbeta, K_Halpha, K_Fbeta, K_Falpha of one mesh at one load."""

    application: float
    mesh_load: float
    dynamic: float
    face_contact: float
    transverse_contact: float
    face_bending: float
    transverse_bending: float

    @property
    def contact(self) -> float:
        """Product under the root of the contact stress."""
        return (
            self.application
            * self.mesh_load
            * self.dynamic
            * self.face_contact
            * self.transverse_contact
        )

    @property
    def bending(self) -> float:
        """Product in the root stress."""
        return (
            self.application
            * self.mesh_load
            * self.dynamic
            * self.face_bending
            * self.transverse_bending
        )


def load_factors(
    mesh: PlanetaryMesh, load: MeshLoad, material: GearMaterial, settings: RatingSettings
) -> LoadFactors:
    """The K factors of one mesh: stated where the settings state them, else computed (part 1)."""
    pair = mesh.pair
    sharing = influence.mesh_load_factor(load.planets, settings.mesh_load_table)
    line_load = load.tangential * settings.application_factor * sharing / pair.face_width
    grade = settings.accuracy_class
    diameters = [pair.reference_diameter(teeth) for teeth in pair.teeth]
    base_pitch = max(deviations.single_pitch(pair.module, d, grade) for d in diameters)
    base_pitch *= math.cos(pair.transverse_pressure_angle)
    profile = deviations.profile_form(pair.module, grade)
    run_in = influence.running_in_pitch(
        base_pitch, material.contact_limit, material.surface_hardened
    )
    total_ratio = pair.transverse_contact_ratio + pair.overlap_ratio
    single = single_stiffness_of(pair, line_load, material)
    stiffness = influence.mesh_stiffness(single, pair.transverse_contact_ratio)

    dynamic = settings.dynamic_factor
    if dynamic is None:
        resonance = influence.resonance_speed(
            pair.pinion_teeth, stiffness, reduced_mass(mesh, load.planets, material.density)
        )
        dynamic = influence.dynamic_factor(
            load.pinion_speed / resonance,
            single,
            line_load,
            base_pitch - run_in,
            profile * (1.0 - 0.075),
            total_ratio,
        )
    face = settings.face_load_factor
    if face is None:
        face = _face_load_factor(mesh, load, line_load * dynamic, stiffness, material, settings)
    depth = max(pair.tooth_depths)
    face_bending = influence.face_load_factor_bending(face, pair.face_width / depth)
    transverse = settings.transverse_load_factor
    if transverse is not None:
        pair_of_factors = (transverse, transverse)
    else:
        pair_of_factors = influence.limited_transverse_factors(
            influence.transverse_load_factor(
                stiffness, base_pitch - run_in, line_load * dynamic * face, total_ratio
            ),
            pair.transverse_contact_ratio,
            total_ratio,
            pitting.contact_ratio_factor(pair),
        )
    return LoadFactors(
        settings.application_factor,
        sharing,
        dynamic,
        face,
        pair_of_factors[0],
        face_bending,
        pair_of_factors[1],
    )


def single_stiffness_of(pair: GearPair, line_load: float, material: GearMaterial) -> float:
    """Single stiffness c' of a pair at a line load (N/m), Pa; a ring counts as a rack."""
    virtual_1, virtual_2 = pair.virtual_teeth
    theoretical = influence.theoretical_single_stiffness(
        virtual_1,
        math.inf if pair.internal else virtual_2,
        pair.pinion_shift,
        pair.wheel_shift,
    )
    return influence.single_stiffness(
        theoretical,
        influence.basic_rack_factor(pair.rack.dedendum, pair.rack.pressure_angle),
        pair.helix_angle,
        line_load,
        material.youngs_modulus,
        material.youngs_modulus,
    )


def reduced_mass(mesh: PlanetaryMesh, planets: int, density: float) -> float:
    """m_red per face width of a planetary mesh, kg/m (6.4.7.2 and 6.4.7.3, solid gears).

    Sun mesh: m_planet m_sun/(m_planet N + m_sun). Ring mesh with the ring held: the planet alone.
    Of a stepped planet only the gear in this mesh counts, which puts the resonance a little high.
    """
    pair = mesh.pair
    masses = []
    for teeth, tip, root in zip(pair.teeth, pair.tip_diameters, pair.root_diameters, strict=True):
        masses.append(influence.blank_mass(0.5 * (tip + root), pair.base_diameter(teeth), density))
    if not mesh.pinion_is_sun:
        return masses[0]
    sun, planet = masses
    return planet * sun / (planets * planet + sun)


def _face_load_factor(
    mesh: PlanetaryMesh,
    load: MeshLoad,
    line_load: float,
    stiffness: float,
    material: GearMaterial,
    settings: RatingSettings,
) -> float:
    """K_Hbeta by method C at the line load F_m/b including K_v, N/m."""
    pair = mesh.pair
    slopes = [
        deviations.helix_slope(
            pair.reference_diameter(teeth), pair.face_width, settings.accuracy_class
        )
        for teeth in pair.teeth
    ]
    meshes = load.planets if mesh.pinion_is_sun else 1
    wind_up = influence.torsional_misalignment(
        line_load,
        pair.face_width,
        pair.reference_diameter(pair.pinion_teeth),
        meshes,
        # A planet sits on its pin, which carries it along its whole length; the sun's meshes
        # balance from two planets up.
        balanced=not mesh.pinion_is_sun or load.planets > 1,
    )
    misalignment = influence.equivalent_misalignment(
        wind_up, slopes[0], slopes[1], line_load, settings.crowned
    )
    run_in = influence.running_in_helix(
        misalignment, material.contact_limit, material.surface_hardened
    )
    return influence.face_load_factor_contact(misalignment - run_in, 0.85 * stiffness, line_load)
