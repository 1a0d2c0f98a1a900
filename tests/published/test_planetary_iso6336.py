"""ISO 6336 against published results.

- ISO/TR 6336-30:2017/2022, Annex A, example 1 (helical pair 17/103, module 8): group gear rating
  of `data/published_examples.csv`, the printed results (factors, stiffness, film, bearable stress)
  as quoted in gfsReboucas/Drivetrain (MATISO_6336.m).
- ISO 6336-5:2016, Table 1: stress numbers A x + B of every row, at one hardness within it.
- ISO 6336-3 charts for z = 20, x = 0: Y_F 2.80, Y_S 1.55.
- The paper's planetary with all K = 1 and x = 0 (E = 206 GPa, nu = 0.3): Hertz pressure at the
  pitch point 468 MPa with six planets and 661 MPa with three; with Z_eps 0.903 and Z_B 1.227, 518
  and 733 MPa (computed independently from AGMA's I factor, rounded to whole MPa).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from published_rows import Row, label, published_rows

from cqdd_design.catalog import find_material
from cqdd_design.planetary.gear_material import GearMaterial, gear_material, stress_numbers
from cqdd_design.planetary.iso6336 import influence, pitting
from cqdd_design.planetary.iso6336.form_factor import tooth_form
from cqdd_design.planetary.kinematics import PlanetaryTeeth, tangential_force, torques
from cqdd_design.planetary.load_factors import MeshLoad, PlanetaryMesh
from cqdd_design.planetary.rating import MeshRating, rate_mesh
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.planetary.tooth_geometry import BasicRack, GearPair

ROWS = published_rows("gear rating")
STEEL = replace(
    gear_material(find_material("AISI 4140 Q&T 540C")), youngs_modulus=206e9, poisson_ratio=0.3
)
CASE_HARDENED_LIMIT = 1500e6


def given(name: str) -> str:
    """A number of the example's input string, such as `beta15.8`."""
    return re.search(rf"(?:^|;){name}(-?[\d./]+|\s[\d.]+)", ROWS[0]["inputs"]).group(1)


def example_pair() -> GearPair:
    """The pair; rack profile D and the tip diameters are those of the report's Table A.1."""
    teeth = [int(z) for z in given("z").split("/")]
    shifts = [float(x) for x in given("x").split("/")]
    module, width = float(given("mn")) * 1e-3, float(given("b")) * 1e-3
    return GearPair(
        teeth[0],
        teeth[1],
        module,
        width,
        shifts[0],
        shifts[1],
        helix_angle=math.radians(float(given("beta"))),
        rack=BasicRack(dedendum=1.4, fillet_radius=0.39),
        pinion_tip_diameter=0.15966,
        wheel_tip_diameter=0.87235,
        centre_distance=float(given("a")) * 1e-3,
    )


def single_pair_of_the_example(pair: GearPair, stage: str) -> float:
    """Stiffness of the pair, 1e9 N/m^2: theoretical, of one pair of teeth, or of the mesh."""
    theoretical = influence.theoretical_single_stiffness(
        *pair.virtual_teeth, pair.pinion_shift, pair.wheel_shift
    )
    if stage == "theoretical":
        return theoretical * 1e-9
    rack = influence.basic_rack_factor(pair.rack.dedendum, pair.rack.pressure_angle)
    single = influence.single_stiffness(theoretical, rack, pair.helix_angle, 1e6, 206e9, 206e9)
    if stage == "single":
        return single * 1e-9
    return influence.mesh_stiffness(single, pair.transverse_contact_ratio) * 1e-9


def films(pair: GearPair) -> tuple[float, float, float]:
    """Z_L, Z_v and Z_R."""
    return (
        pitting.lubricant_factor(CASE_HARDENED_LIMIT, 320e-6),
        pitting.velocity_factor(CASE_HARDENED_LIMIT, 2.664),
        pitting.roughness_factor(
            CASE_HARDENED_LIMIT, 6e-6, pitting.relative_curvature_radius(pair)
        ),
    )


def bearable(pair: GearPair, cycles: float) -> float:
    """In MPa, with the films of the example."""
    film = math.prod(films(pair))
    stress = pitting.bearable_contact_stress(CASE_HARDENED_LIMIT, film, 1.0, cycles)
    return stress * 1e-6


def tangential(pair: GearPair) -> float:
    """In N, at the reference circle of the pinion."""
    torque, diameter = float(given("T1")), pair.reference_diameter(pair.pinion_teeth)
    return tangential_force(torque, 1, diameter)


def contact_stress(pair: GearPair) -> float:
    """sigma_H0 in MPa."""
    elasticity = pitting.elasticity_factor(STEEL, STEEL)
    return pitting.nominal_contact_stress(pair, tangential(pair), elasticity) * 1e-6


#: What computes a row, and the functions that it validates.
EXAMPLE_1: dict[str, tuple[Callable[[GearPair], float], tuple[Any, ...]]] = {
    "tangential force": (tangential, (tangential_force, GearPair.reference_diameter)),
    "zone factor Z_H": (
        lambda pair: pitting.zone_factor(pair),
        (pitting.zone_factor, GearPair.working_pressure_angle, GearPair.base_helix_angle),
    ),
    "elasticity factor Z_E": (
        lambda pair: pitting.elasticity_factor(STEEL, STEEL) * 1e-3,
        (pitting.elasticity_factor,),
    ),
    "contact ratio factor Z_ε": (
        lambda pair: pitting.contact_ratio_factor(pair),
        (pitting.contact_ratio_factor, GearPair.transverse_contact_ratio),
    ),
    "nominal contact stress": (
        contact_stress,
        (
            pitting.nominal_contact_stress,
            pitting.zone_factor,
            pitting.elasticity_factor,
            pitting.contact_ratio_factor,
            pitting.helix_factor,
            tangential_force,
        ),
    ),
    "virtual teeth of the pinion": (
        lambda pair: pair.virtual_teeth[0],
        (GearPair.virtual_teeth,),
    ),
    "virtual teeth of the wheel": (lambda pair: pair.virtual_teeth[1], (GearPair.virtual_teeth,)),
    "helix factor Z_β": (lambda pair: pitting.helix_factor(pair), (pitting.helix_factor,)),
    "theoretical single stiffness": (
        lambda pair: single_pair_of_the_example(pair, "theoretical"),
        (influence.theoretical_single_stiffness, GearPair.virtual_teeth),
    ),
    "single stiffness": (
        lambda pair: single_pair_of_the_example(pair, "single"),
        (influence.single_stiffness, influence.basic_rack_factor),
    ),
    "mesh stiffness": (
        lambda pair: single_pair_of_the_example(pair, "mesh"),
        (influence.mesh_stiffness, GearPair.transverse_contact_ratio),
    ),
    "lubricant factor Z_L": (lambda pair: films(pair)[0], (pitting.lubricant_factor,)),
    "velocity factor Z_v": (lambda pair: films(pair)[1], (pitting.velocity_factor,)),
    "roughness factor Z_R": (
        lambda pair: films(pair)[2],
        (pitting.roughness_factor, pitting.relative_curvature_radius),
    ),
    "bearable contact stress of the pinion, 1.08e9 cycles": (
        lambda pair: bearable(pair, 1.08e9),
        (pitting.bearable_contact_stress, pitting.life_factor),
    ),
    "bearable contact stress of the wheel, 1.783e8 cycles": (
        lambda pair: bearable(pair, 1.08e9 / pair.gear_ratio),
        (pitting.bearable_contact_stress, pitting.life_factor),
    ),
}


@pytest.mark.parametrize("row", ROWS, ids=label)
def test_example_1(row: Row, compared: Callable[..., None]) -> None:
    answer, used = EXAMPLE_1[row["quantity"]]
    compared(row, lambda: answer(example_pair()), *used)


def test_example_1_has_no_other_row() -> None:
    assert [row["quantity"] for row in ROWS] == list(EXAMPLE_1)
    assert pitting.single_pair_factors(example_pair()) == (1.0, 1.0)
    # c_gamma_beta of the report, beside its c_gamma_alpha.
    mesh = single_pair_of_the_example(example_pair(), "mesh")
    assert 0.85 * mesh == pytest.approx(14.84512, abs=5e-6)


@pytest.mark.parametrize("row", published_rows("tooth form"), ids=label)
def test_charts_of_form_and_stress_correction(row: Row, compared: Callable[..., None]) -> None:
    name = "form_factor" if row["quantity"].endswith("Y_F") else "stress_correction"

    def ours() -> float:
        form = tooth_form(20.0, 0.0, BasicRack(), load_point_diameter=22.0)
        return float(getattr(form, name))

    compared(row, ours, tooth_form)


def sun_mesh(planets: int, steel: GearMaterial) -> MeshRating:
    """The paper's sun and planet without profile shift, 40 N m over so many planets, all K = 1."""
    teeth = PlanetaryTeeth(12, 36, 22, 70)
    tangential = tangential_force(torques(teeth, 40.0, planets).sun / planets, 12, 1e-3)
    load = MeshLoad("continuous", planets, tangential, 134.7, 1e8, 1e8)
    mesh = PlanetaryMesh("sun_planet", GearPair(12, 36, 1e-3, 12e-3), (False, False))
    return rate_mesh(mesh, load, steel, RatingSettings.nominal())


def test_hertz_pressure_of_the_papers_planetary():
    for planets, pitch_point, with_factors in ((6, 468.0, 518.0), (3, 661.0, 733.0)):
        sun = sun_mesh(planets, STEEL)
        assert sun.hertz_pitch_point * 1e-6 == pytest.approx(pitch_point, abs=0.5)
        # The printed pair multiplies rounded factors: 661.4 * 0.903 * 1.227 = 732.8.
        assert sun.contact_stress * 1e-6 == pytest.approx(with_factors, abs=0.8)
        assert sun.pinion.factors["Z_eps"] == pytest.approx(0.903, abs=5e-4)
        assert sun.pinion.factors["Z_B"] == pytest.approx(1.227, abs=5e-4)


def test_hertz_pressure_needs_the_modulus_it_was_computed_with():
    """With the catalogue's 205 GPa and 0.29 the same gear has 465 MPa: 206 GPa and 0.3 give 468."""
    sun = sun_mesh(6, gear_material(find_material("AISI 4140 Q&T 540C")))
    assert sun.hertz_pitch_point * 1e-6 == pytest.approx(465.0, abs=0.5)


@pytest.mark.parametrize(
    ("vickers", "factor"),
    [
        # Z_W = 1.2 - (HB - 130)/1700 with HV = 1.05 HB, between HB 130 and 470 (clause 13).
        (100.0, 1.2),
        (1.05 * 300.0, 1.1),
        (1.05 * 470.0, 1.0),
        (550.0, 1.0),
    ],
)
def test_work_hardening_of_a_soft_gear_by_a_hard_mate(vickers, factor):
    hard = gear_material(find_material("SCM415/16MnCr5 case hardened"))
    soft = replace(gear_material(find_material("AISI 4140 Q&T 540C")), hardness_vickers=vickers)
    assert pitting.work_hardening_factor(soft, hard) == pytest.approx(factor)
    assert pitting.work_hardening_factor(soft, soft) == 1.0
    assert pitting.work_hardening_factor(hard, soft) == 1.0


@pytest.mark.parametrize(
    ("kind", "quality", "hardness", "contact", "bending"),
    # ISO 6336-5:2016, Table 1: sigma_Hlim and sigma_Flim, MPa, at a hardness HV within the row.
    [
        ("through-hardened carbon steel", "ML", 200.0, 475.6, 158.0),
        ("through-hardened carbon steel", "MQ", 200.0, 545.0, 211.0),
        ("through-hardened carbon steel", "ME", 200.0, 599.6, 258.6),
        ("through-hardened alloy steel", "ML", 300.0, 581.9, 230.9),
        ("through-hardened alloy steel", "MQ", 300.0, 766.9, 314.5),
        ("through-hardened alloy steel", "ME", 300.0, 923.9, 338.4),
        ("case-hardened steel", "ML", 700.0, 1300.0, 312.0),
        ("case-hardened steel", "MQ", 700.0, 1500.0, 425.0),
        ("case-hardened steel", "ME", 700.0, 1650.0, 525.0),
        ("induction-hardened steel", "ML", 550.0, 1009.0, 243.75),
        ("induction-hardened steel", "MQ", 550.0, 1179.55, 365.9),
        ("induction-hardened steel", "ME", 550.0, 1290.75, 386.05),
    ],
)
def test_stress_numbers_are_those_of_the_table(kind, quality, hardness, contact, bending):
    found = stress_numbers(kind, quality, hardness)
    assert found[0] == pytest.approx(1e6 * contact, rel=1e-9)
    assert found[1] == pytest.approx(1e6 * bending, rel=1e-9)
    assert found[2] == ""
