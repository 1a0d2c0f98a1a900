"""Scaling laws of the ISO 6336 rating, the effect of every input, and no foreign exceptions."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.catalog import find_material, materials
from cqdd_design.errors import CqddError, UsageError
from cqdd_design.planetary import load_factors
from cqdd_design.planetary.compare import compare_planetary
from cqdd_design.planetary.cycloid import CycloidLimit
from cqdd_design.planetary.gear_material import gear_material, stress_numbers
from cqdd_design.planetary.gear_set import (
    LoadCase,
    build_gear_set,
    planets_needed,
    rate_gear_set,
)
from cqdd_design.planetary.iso6336 import bending, influence, pitting
from cqdd_design.planetary.kinematics import PlanetaryTeeth
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.planetary.tooth_geometry import GearPair

TEETH = PlanetaryTeeth(12, 36, 22, 70)
STEEL = gear_material(find_material("AISI 4140 Q&T 540C"))
SPEED = 1286.0 * math.pi / 30.0
NOMINAL = RatingSettings.nominal()


def rated(
    torque=40.0, planets=3, chosen=NOMINAL, *, scale=1.0, steel=STEEL, speed=SPEED, cycles=None
):
    gears = build_gear_set(TEETH, scale * 1e-3, scale * 12e-3, chosen)
    return rate_gear_set(gears, planets, LoadCase("continuous", torque, speed, cycles), steel)


@given(st.floats(0.1, 500.0), st.integers(1, 12))
def test_doubling_the_torque(torque, planets):
    """Hertz pressure grows with the root of the load, root stress with the load (all K = 1)."""
    for once, twice in zip(rated(torque, planets), rated(2.0 * torque, planets), strict=True):
        assert twice.contact_stress == pytest.approx(math.sqrt(2.0) * once.contact_stress)
        assert twice.root_stress == pytest.approx(2.0 * once.root_stress)
        assert twice.contact_safety == pytest.approx(once.contact_safety / math.sqrt(2.0))


@given(st.floats(1.0, 5.0))
def test_geometric_similarity(scale):
    """Gears `scale` times as large, rim and all, carry scale^3 the torque at the same stress."""
    grown_ratings = rated(40.0 * scale**3, scale=scale)
    for small, large in zip(rated(), grown_ratings, strict=True):
        assert large.contact_stress == pytest.approx(small.contact_stress, rel=1e-9)
        assert large.root_stress == pytest.approx(small.root_stress, rel=1e-9)


@pytest.mark.parametrize("chosen", [NOMINAL, RatingSettings(), RatingSettings(accuracy_class=8)])
@pytest.mark.parametrize("torque", [5.0, 40.0, 120.0])
def test_more_planets_lower_the_stress(chosen, torque):
    for mesh in (0, 1):
        found = [rated(torque, n, chosen)[mesh] for n in range(1, 25)]
        for fewer, more in pairwise(found):
            assert more.contact_stress < fewer.contact_stress
            assert more.root_stress < fewer.root_stress


@given(st.floats(1.0, 200.0))
def test_the_planets_needed_are_needed_and_enough(torque):
    gears = build_gear_set(TEETH, 1e-3, 12e-3)
    case = LoadCase("peak", torque, SPEED, 1e4)
    needed = planets_needed(gears, case, STEEL, "contact")
    safe = [
        min(r.contact_safety for r in rate_gear_set(gears, n, case, STEEL)) >= 1.0
        for n in range(1, 25)
    ]
    assert needed == (safe.index(True) + 1 if True in safe else None)


def test_a_simple_planetary_is_the_compound_one_with_equal_planet_gears():
    """One planet gear in both meshes: the same forces, and its roots bent both ways."""
    gears = build_gear_set(PlanetaryTeeth(20, 40, 40, 100), 1e-3, 12e-3, NOMINAL)
    sun, ring = rate_gear_set(gears, 3, LoadCase("peak", 40.0, SPEED, 1e4), STEEL)
    assert sun.load.tangential == pytest.approx(ring.load.tangential)
    assert sun.wheel.factors["Y_M"] == ring.pinion.factors["Y_M"] == 0.7
    assert sun.pinion.factors["Y_M"] == ring.wheel.factors["Y_M"] == 1.0
    stepped = rated(40.0, 3)
    assert all(gear.factors["Y_M"] == 1.0 for mesh in stepped for gear in (mesh.pinion, mesh.wheel))


CHANGED = {
    "application_factor": 1.25,
    "mesh_load_table": "abs",
    "dynamic_factor": 1.2,
    "face_load_factor": 3.0,
    "transverse_load_factor": 1.3,
    "accuracy_class": 7,
    "crowned": False,
    "lubricant_viscosity": 46e-6,
    "flank_roughness": 6e-6,
    "root_roughness": 20e-6,
    "life_hours": 5000.0,
}


@pytest.mark.parametrize("name", CHANGED)
def test_every_setting_has_an_effect(name):
    before = rated(planets=4, chosen=RatingSettings())
    after = rated(planets=4, chosen=replace(RatingSettings(), **{name: CHANGED[name]}))
    safeties = [
        [s for mesh in found for gear in (mesh.pinion, mesh.wheel)
         for s in (gear.contact_safety, gear.bending_safety)]
        for found in (before, after)
    ]  # fmt: skip
    assert safeties[0] != safeties[1]


def test_settings_that_act_elsewhere_have_an_effect():
    """The life at peak and the safety factors asked."""
    gears = build_gear_set(TEETH, 1e-3, 12e-3)
    peak = LoadCase("peak", 120.0, SPEED, 1e4)
    assert planets_needed(gears, replace(peak, cycles=1e7), STEEL, "contact") is None
    strict = build_gear_set(TEETH, 1e-3, 12e-3, RatingSettings(least_contact_safety=1.05))
    assert planets_needed(strict, peak, STEEL, "contact") > planets_needed(
        gears, peak, STEEL, "contact"
    )
    wary = build_gear_set(TEETH, 1e-3, 12e-3, RatingSettings(least_bending_safety=4.0))
    assert planets_needed(wary, peak, STEEL, "bending") > planets_needed(
        gears, peak, STEEL, "bending"
    )


@pytest.mark.parametrize("quality", ["ML", "ME"])
def test_the_material_s_quality_has_an_effect(quality):
    other = gear_material(find_material("AISI 4140 Q&T 540C"), quality)
    assert other.contact_limit != STEEL.contact_limit
    assert rated(steel=other)[0].contact_safety != rated()[0].contact_safety


def test_stiffer_steel_is_pressed_harder():
    stiffer = replace(STEEL, youngs_modulus=2.0 * STEEL.youngs_modulus)
    ratio = rated(steel=stiffer)[0].contact_stress / rated()[0].contact_stress
    assert ratio == pytest.approx(math.sqrt(2.0))


@given(st.floats(1.0, 1e11), st.floats(1.0, 1e11))
def test_life_factors_fall_with_cycles(first, second):
    fewer, more = sorted((first, second))
    assert pitting.life_factor(more) <= pitting.life_factor(fewer)
    assert bending.life_factor(STEEL, more) <= bending.life_factor(STEEL, fewer)
    bearable = [pitting.bearable_contact_stress(835e6, 0.8, 1.0, n) for n in (fewer, more)]
    assert bearable[1] <= bearable[0] * (1 + 1e-12)


def test_bearable_stress_is_continuous_where_its_branches_meet():
    for cycles, factor in ((1e5, 1.6), (5e7, 0.8)):
        for side in (0.999999, 1.000001):
            found = pitting.bearable_contact_stress(835e6, 0.8, 1.0, cycles * side)
            assert found == pytest.approx(835e6 * factor, rel=1e-4)
    for cycles, factor in ((1e4, 2.5 * 0.9), (3e6, 1.0)):
        for side in (0.999999, 1.000001):
            found = bending.bearable_root_stress(STEEL, 1.0, 0.9, cycles * side, False)
            assert found == pytest.approx(2.0 * STEEL.bending_limit * factor, rel=1e-4)


def test_load_factors_meet_where_their_branches_do():
    below = influence.face_load_factor_contact(9.99999e-6, 10e9, 5e4)
    above = influence.face_load_factor_contact(10.00001e-6, 10e9, 5e4)
    assert below == pytest.approx(2.0, rel=1e-5)
    assert above == pytest.approx(2.0, rel=1e-5)
    for ratio in (2.0 - 1e-9, 2.0 + 1e-9):
        found = influence.transverse_load_factor(10e9, 5e-6, 5e4, ratio)
        assert found == pytest.approx(0.9 + 0.4, rel=1e-6)
    for speed_ratio in (1.15, 1.5):
        around = [
            influence.dynamic_factor(speed_ratio + d, 10e9, 1e5, 5e-6, 5e-6, 1.5)
            for d in (-1e-7, 1e-7)
        ]
        assert around[0] == pytest.approx(around[1], rel=1e-4)
    # Between 1.15 and 1.5 times the resonance the factor falls along a straight line.
    main, halfway, above = (
        influence.dynamic_factor(speed_ratio, 10e9, 1e5, 5e-6, 5e-6, 1.5)
        for speed_ratio in (1.15, 0.5 * (1.15 + 1.5), 1.6)
    )
    assert main > above > 1.0
    assert halfway == pytest.approx(0.5 * (main + above), rel=1e-9)
    # Lightly loaded teeth leave the range below resonance sooner: N_S = 0.5 + 0.35 (25/100)^0.5.
    below, after = (
        influence.dynamic_factor(0.675 + d, 10e9, 0.25e5, 5e-6, 5e-6, 1.5) for d in (-1e-6, 1e-6)
    )
    deviations = 10e9 * 5e-6 / 0.25e5
    assert below == pytest.approx(
        1.0 + 0.675 * (0.32 + 0.34 + 0.23 / deviations) * deviations, rel=1e-4
    )
    assert after == pytest.approx(1.9 + (0.32 + 0.34) * deviations, rel=1e-9)


def test_lightly_loaded_teeth_are_softer_by_the_fourth_root():
    """Above 100 N/mm the stiffness is constant; at a sixteenth of it half is left (eq. 90)."""
    full, more, less = (
        influence.single_stiffness(10e9, 1.0, 0.0, load, 206e9, 206e9)
        for load in (1e5, 3e5, 1e5 / 16.0)
    )
    assert full == more == pytest.approx(8e9, rel=1e-12)
    assert less == pytest.approx(4e9, rel=1e-12)


def test_torsion_of_the_pinion_is_that_of_a_solid_shaft():
    """4/(pi G) (b/d)^2 F/b: a round bar of the reference diameter driven from one end."""
    width, diameter, load, shear_modulus = 12e-3, 12e-3, 2e4, 79.3e9
    torque = load * width * diameter / 2.0
    # The torque grows evenly along the face, so the total twist is half that of a constant one.
    twist = 0.5 * torque * width / (shear_modulus * math.pi / 32.0 * diameter**4)
    found = influence.torsional_misalignment(load, width, diameter, 1, True)
    assert found == pytest.approx(twist * diameter / 2.0, rel=5e-3)


def test_notch_sensitivity_goes_with_the_fourth_root_of_strength():
    """At 300 and at 16 times 300 MPa the root is 1 and a half (ISO 6336-3, 13.3.2)."""
    for strength, root in ((300e6, 1.0), (16 * 300e6, 0.5)):
        gear = replace(STEEL, yield_strength=strength)
        found = bending.relative_notch_sensitivity_static(gear, 3.0)
        assert found == pytest.approx((1.0 + 2.0 * 0.82 * root) / (1.0 + 0.82 * root))


def test_solid_gears_resonate_with_the_mass_at_their_mean_diameter():
    """ISO 6336-1, eq. 30 to 32 and 6.4.7.2, of a sun of 12 mm between 14 and 9.5 mm in a planet."""
    pair = SimpleNamespace(
        teeth=(12, 36),
        internal=False,
        tip_diameters=(14e-3, 38e-3),
        root_diameters=(9.5e-3, 33.5e-3),
        base_diameter=lambda teeth: teeth * 1e-3 * math.cos(math.radians(20.0)),
    )
    mesh = SimpleNamespace(pair=pair, pinion_is_sun=True)
    sun, planet = (
        math.pi / 8.0 * 7850.0 * mean**4 / pair.base_diameter(teeth) ** 2
        for mean, teeth in ((11.75e-3, 12), (35.75e-3, 36))
    )
    found = load_factors.reduced_mass(mesh, 3, 7850.0)
    assert found == pytest.approx(planet * sun / (3.0 * planet + sun))
    mesh.pinion_is_sun = False
    assert load_factors.reduced_mass(mesh, 3, 7850.0) == pytest.approx(sun)


def test_helix_interpolates_between_spur_and_full_overlap():
    spur = GearPair(20, 40, 2e-3, 20e-3)
    slight = GearPair(20, 40, 2e-3, 20e-3, helix_angle=1e-5)
    assert pitting.contact_ratio_factor(slight) == pytest.approx(
        pitting.contact_ratio_factor(spur), rel=1e-4
    )
    assert pitting.single_pair_factors(slight) == pytest.approx(
        pitting.single_pair_factors(spur), rel=1e-4
    )


def test_internal_contact_is_gentler_than_external():
    """A ring bends with the planet: (u + 1)/u is below 1 instead of above."""
    external = pitting.nominal_contact_stress(
        GearPair(22, 70, 1e-3, 12e-3), 100.0, 6e6, at_pitch_point=True
    )
    internal = pitting.nominal_contact_stress(
        GearPair(22, -70, 1e-3, 12e-3), 100.0, 6e6, at_pitch_point=True
    )
    assert internal / external == pytest.approx(math.sqrt((70 - 22) / (70 + 22)))


def test_harder_steel_bears_more_until_the_standard_stops():
    limits = [stress_numbers("through-hardened alloy steel", "MQ", hv) for hv in (200, 360, 500)]
    assert limits[0][0] < limits[1][0] == limits[2][0]
    assert limits[0][2] == limits[1][2] == ""
    assert "200 to 360 HV" in limits[2][2]


@pytest.mark.parametrize("name", list(materials()))
def test_every_catalogue_material_is_rated_or_refused(name):
    material = find_material(name)
    hardness = material.brinell_hardness or material.rockwell_hardness
    if not 185e9 <= material.youngs_modulus <= 220e9 or hardness is None:
        with pytest.raises(UsageError, match="AISI 4140 Q&T 540C"):
            gear_material(material)
    else:
        found = gear_material(material)
        assert 300e6 < found.contact_limit < 2000e6
        assert 100e6 < found.bending_limit < 600e6


@settings(deadline=None)
@given(
    st.lists(st.integers(3, 120), min_size=3, max_size=4),
    st.integers(-40, 40),
    st.floats(0.2e-3, 5e-3),
    st.floats(1e-3, 60e-3),
    st.integers(1, 24),
)
def test_nothing_but_our_own_errors(counts, change, module, width, planets):
    """Random teeth and sizes: a rating with finite numbers, or an error that names the fix."""
    try:
        ring = counts[0] + counts[1] + counts[2 if len(counts) == 4 else 1]
        teeth = PlanetaryTeeth(
            *counts[:2], counts[2 if len(counts) == 4 else 1], ring + change // 20
        )
        gears = build_gear_set(teeth, module, width)
        found = rate_gear_set(gears, planets, LoadCase("peak", 40.0, SPEED, 1e4), STEEL)
    except CqddError:
        return
    for mesh in found:
        numbers = [mesh.contact_stress, mesh.root_stress, mesh.contact_safety, mesh.bending_safety]
        assert all(math.isfinite(n) and n > 0.0 for n in numbers)


@pytest.mark.parametrize(
    ("change", "error", "named"),
    [
        ({"peak_torque": 0.0}, UsageError, "peak torque"),
        ({"peak_torque": math.nan}, UsageError, "peak torque"),
        ({"continuous_torque": -1.0}, UsageError, "continuous torque"),
        ({"input_speed": 0.0}, UsageError, "input speed"),
        ({"bore": -1.0}, UsageError, "bore"),
        ({"planets": 0}, UsageError, "planets"),
        ({"settings": RatingSettings(mesh_load_table="isoo")}, UsageError, "'iso'"),
    ],
)
def test_comparison_refuses(change, error, named):
    asked = {"peak_torque": 120.0, "continuous_torque": 40.0, "input_speed": SPEED, **change}
    with pytest.raises(error, match=named):
        compare_planetary(STEEL, **asked)


def limits() -> list[CycloidLimit]:
    return [
        CycloidLimit("output pins", "bending", "peak", 120.0, 963.0, 900.0, "MPa", 112.1),
        CycloidLimit("ring teeth", "pressure", "peak", 120.0, 1527.0, 1393.0, "MPa", 99.9),
        CycloidLimit("ring teeth", "pressure", "continuous", 40.0, 882.0, 944.0, "MPa", 45.8),
    ]


def test_claim_about_the_pins_follows_the_limits_handed_in():
    """Pressures are compared as torques: 1393/1527 is 100 N*m, less than the pins' 112 N*m."""
    asked = {"peak_torque": 120.0, "continuous_torque": 40.0, "input_speed": SPEED}
    with_ring = compare_planetary(STEEL, **asked, cycloid=limits()).claims[4]
    without = compare_planetary(STEEL, **asked, cycloid=limits()[:1]).claims[4]
    none = compare_planetary(STEEL, **asked).claims[4]
    assert (with_ring.holds, without.holds, none.holds) == (False, True, None)
    assert "99.9 N*m" in with_ring.ours


def test_claims_are_computed_under_the_settings_given():
    """Soft steel with every factor against it fails and needs more; hard gears do not."""
    asked = {"peak_torque": 120.0, "continuous_torque": 40.0, "input_speed": SPEED}
    hard = gear_material(find_material("SCM415/16MnCr5 case hardened"))
    strong = compare_planetary(hard, **asked, settings=RatingSettings.nominal())
    weak = compare_planetary(STEEL, **asked, settings=RatingSettings(accuracy_class=8))
    assert [c.ours[:2] for c in (strong.claims[1], weak.claims[1])] == ["1 ", "16"]
    assert float(strong.claims[3].ours[4:8]) > 1.0 > float(weak.claims[3].ours[4:8])
    # What settings decide is neither true nor false.
    for found in (strong, weak):
        assert [c.holds for c in found.claims[:4]] == [False, None, True, None]
        assert found.claims[1].verdict == found.claims[3].verdict == "hangs on the settings"


def test_how_many_planets_are_needed_is_told_with_its_spread():
    """Six at the defaults is chance: four reach 0.98 of what is asked, five do not assemble."""
    asked = {"peak_torque": 120.0, "continuous_torque": 40.0, "input_speed": SPEED}
    found = compare_planetary(STEEL, **asked)
    claim = found.claims[1]
    assert claim.ours.startswith("6 under the settings given")
    assert "4 reach 0.98 of the safety asked" in claim.under
    assert "5 do not assemble" in claim.under
    needed = Counter(setting.planets_needed for setting in found.claim_settings)
    assert {2, 3, 4, 6, 8, 12} < set(needed)
    for planets, times in needed.items():
        assert (f"{planets} in {times}" if planets else f"more than 24 in {times}") in claim.ours
    for name, values in (
        ("mesh_load_table", 3),
        ("least_contact_safety", 2),
        ("peak_cycles", 2),
        ("application_factor", 2),
        ("factors", 4),
        ("material", 10),
    ):
        assert len({getattr(setting, name) for setting in found.claim_settings}) == values, name


def test_the_planetary_is_too_wide_for_the_stator_that_the_paper_says_it_fits():
    asked = {"peak_torque": 120.0, "continuous_torque": 40.0, "input_speed": SPEED}
    compact = [compare_planetary(STEEL, **asked, bore=bore).claims[5] for bore in (76e-3, 86e-3)]
    assert [claim.holds for claim in compact] == [False, True]
    assert "85.4 mm" in compact[0].ours
    assert compare_planetary(STEEL, **asked).claims[5].verdict == "not computed"


def test_claims_are_about_the_papers_gears_whatever_is_compared():
    asked = {"peak_torque": 30.0, "continuous_torque": 10.0, "input_speed": SPEED}
    other = compare_planetary(STEEL, **asked, teeth=PlanetaryTeeth(18, 42, 30, 90), module=0.8e-3)
    own = compare_planetary(STEEL, **asked)
    assert other.claims == own.claims
    assert str(other.gears.teeth) == "18/42/30/90"


def test_json_has_the_promised_keys_and_finite_numbers():
    found = compare_planetary(
        STEEL,
        peak_torque=120.0,
        continuous_torque=40.0,
        input_speed=SPEED,
        planets=6,
        bore=76e-3,
        cycloid=limits(),
    )
    document = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    planetary = document["planetary"]
    assert planetary["ratio"] == pytest.approx(10.545454545)
    assert planetary["centre_distance_mm"] == pytest.approx(24.0)
    assert planetary["planets_that_fit"] == 3
    assert planetary["planets_that_assemble"] == [1, 2, 3, 4, 6, 8, 12, 16, 24]
    for key in ("peak_bending", "peak_contact", "continuous_contact"):
        assert f"planets_needed_{key}" in planetary
    assert planetary["planets_needed_continuous_contact"] is None
    assert any("Not even 24 planets" in text for text in found.warnings)
    assert any("6 planets overlap" in text for text in found.warnings)
    for row in planetary["by_planets"]:
        assert {"planets", "fits", "assembles", "sigma_H_MPa", "S_H", "sigma_F_MPa", "S_F"} <= set(
            row
        )
    cases = {(row["planets"], row["mesh"], row["load"]) for row in planetary["by_planets"]}
    assert len(cases) == len(planetary["by_planets"]) == 8 * 4
    assert len(document["paper_claims"]) == 6
    for claim in document["paper_claims"]:
        assert set(claim) == {"claim", "paper", "ours", "holds", "under", "verdict"}
    assert document["cycloid"]["binding"]["peak"]["part"] == "ring teeth"
    assert len(document["claim_settings"]) == 960


@pytest.mark.parametrize(
    ("table", "factors"),
    # For 3, 4, 5, 6 and 7 planets: IEC 61400-4, and the ABS steel vessel rules.
    [("iso", [1.10, 1.25, 1.35, 1.44, 1.47]), ("abs", [1.0, 1.2, 1.3, 1.4, 1.4])],
)
def test_mesh_load_factors_are_those_of_the_tables(table, factors):
    assert [influence.mesh_load_factor(planets, table) for planets in range(3, 8)] == factors
