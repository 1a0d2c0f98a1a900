"""The checks: limits as tabled, remedies that work, the paper's design, random designs."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import examples
from geometry_designs import design_of, discs
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.catalog import find_bearing, find_material, materials
from cqdd_design.design import Design, Requirements, load_design
from cqdd_design.errors import CqddError, GeometryError, InfeasibleError, UsageError
from cqdd_design.gearbox import (
    CHECK_GUIDE,
    GearboxAnalysis,
    check_guide,
)
from cqdd_design.gearbox.balance import paper_disc_count, stack_balance
from cqdd_design.gearbox.bearing_life import basic_rating_life_hours, load_for_life
from cqdd_design.gearbox.cam_bearing import choose
from cqdd_design.gearbox.checks import (
    allowables,
    guide_asked,
    guide_bodies,
    guide_heat,
    guide_joints,
    guide_retention,
    guide_shaft,
)
from cqdd_design.gearbox.checks.allowables import LIGAMENT
from cqdd_design.gearbox.checks.equilibrium import PeakLoads, lasting_checks, peak_checks
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import ligaments
from cqdd_design.machine import resolve
from cqdd_design.results import Check, MassProperties, worst_status
from cqdd_design.sizing.exact import exact_checks

GALLERY = Path(__file__).resolve().parents[2] / "docs" / "gallery"
PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
#: A design for the default requirements at ratio 10, found by an independent search.
SOUND = Design.from_mapping(
    {
        "requirements": {"ratio": 10},
        "reducer": {
            "ratio": 10,
            "ring_pitch_radius": "34.4 mm",
            "eccentricity": "1.56 mm",
            "ring_pin_diameter": "8.4 mm",
            "disc_thickness": "9 mm",
            "output_pins": {"count": 12, "diameter": "4 mm", "circle_radius": "23.6 mm"},
            "cam_bearing": {"designation": "6904"},
            "ring": {"outer_diameter": "72 mm"},
        },
    }
)

#: The same with room round its pins and bearing, for checks of the profile alone.
ROOMY = SOUND.replacing(
    {
        "reducer.cam_bearing.designation": "6801",
        "reducer.output_pins.count": 4,
        "reducer.output_pins.circle_radius": "17 mm",
    }
)


def by_id(analysis: GearboxAnalysis) -> dict[str, Check]:
    return {check.id: check for check in analysis.checks}


def changed(changes: Mapping[str, Any], base: Design = SOUND) -> dict[str, Check]:
    return by_id(resolve(base.replacing(changes)).analysis)


def test_limits_are_those_of_the_table() -> None:
    steel, hard = find_material("AISI 4140 Q&T 540C"), find_material("AISI 4140 Q&T 425C")
    bearing_steel = find_material("AISI 52100 / 100Cr6 hardened")
    screw = find_material("Alloy steel 12.9 (ISO 7379)")
    stainless = next(m for name, m in materials().items() if name.startswith("18-8"))

    def mpa(allowed: allowables.Allowable) -> int:
        return round(allowed.value / 1e6)

    assert [mpa(allowables.contact_limit_static(m)) for m in (steel, hard)] == [1393, 1900]
    assert [mpa(allowables.contact_limit_fatigue(m)) for m in (steel, hard)] == [944, 1081]
    assert mpa(allowables.contact_limit_static(bearing_steel)) == 2500
    assert mpa(allowables.contact_limit_fatigue(bearing_steel)) == 1500
    peak = [allowables.pin_limit_peak(m) for m in (screw, stainless)]
    shear = [allowables.pin_shear_limit_peak(m) for m in (screw, stainless)]
    fatigue = [
        allowables.pin_bending_limit_continuous(m, duty_reverses=False) for m in (screw, stainless)
    ]
    assert [mpa(a) for a in peak] == [900, 171]
    assert [mpa(a) for a in shear] == [522, 99]
    assert [mpa(a) for a in fatigue] == [300, 120]
    assert allowables.UNEVEN_SHARING == 1.15
    assert allowables.STATIC_SAFETY == 1.0
    assert Requirements(ratio=10).life_hours == 1000.0
    assert (allowables.LIGAMENT, allowables.RING_WALL) == (1.5e-3, 2.5e-3)


def test_a_reversing_duty_lowers_the_fatigue_limit() -> None:
    duty = [
        {"torque": "30 N*m", "speed": "1 rad/s", "share": 0.5},
        {"torque": "-30 N*m", "speed": "1 rad/s", "share": 0.5},
    ]
    mapping = SOUND.to_mapping()
    mapping["requirements"]["duty"] = duty
    both = by_id(resolve(Design.from_mapping(mapping)).analysis)["PIN-BENDING-CONTINUOUS"]
    duty[1]["torque"] = "20 N*m"
    one = by_id(resolve(Design.from_mapping(mapping)).analysis)["PIN-BENDING-CONTINUOUS"]
    assert one.limit == pytest.approx(300.0)
    # Goodman with S_u 1220 MPa: 150/(1 - 150/1220).
    assert both.limit == pytest.approx(150.0 / (1.0 - 150.0 / 1220.0))
    assert both.value == pytest.approx(one.value)


@pytest.mark.parametrize("name", list(materials()))
def test_every_material_has_a_stated_basis(name: str) -> None:
    """A limit is either supported by data or zero, and always says which."""
    material = materials()[name]
    limits = (
        allowables.contact_limit_static(material),
        allowables.contact_limit_fatigue(material),
        allowables.pin_limit_peak(material),
        allowables.pin_bending_limit_continuous(material, duty_reverses=False),
    )
    for allowed in limits:
        assert math.isfinite(allowed.value)
        assert allowed.value >= 0.0
        assert allowed.basis
        if allowed.value == 0.0:
            assert "no " in allowed.basis
    if not allowables.is_steel(material):
        assert limits[1].value == 0.0


def test_hardness_scales() -> None:
    """Brinell of printed HB, HRC, HRB and of nothing but a strength."""
    names = {
        "AISI 4140 Q&T 540C": 335.0,
        "17-4PH H900": 388.0,
        "Alloy steel 12.9 (ISO 7379)": 362.2,
        "304/303 cold worked F593 CW1": 210.0,
        "A2-70 (ISO 3506)": 700.0 / 3.45,
    }
    for name, expected in names.items():
        estimate = allowables.brinell_estimate(find_material(name))
        assert estimate is not None
        assert estimate[0] == pytest.approx(expected, abs=0.1)
    assert allowables.brinell_estimate(find_material("POM (acetal)")) is None


def test_a_sound_design_passes_everything() -> None:
    analysis = resolve(SOUND).analysis
    assert worst_status(analysis.checks) == "pass"
    assert analysis.warnings == ()
    least = min(check.margin for check in analysis.checks if check.unit in {"MPa", "h", ""})
    assert least == pytest.approx(1.0)
    assert by_id(analysis)["BEARING-STATIC"].margin == pytest.approx(1.07, abs=0.01)


def test_the_papers_design_fails_where_it_should() -> None:
    """Its own shear figure passes; contact, bending, bearing and motor do not."""
    checks = by_id(resolve(PAPER).analysis)
    assert checks["PIN-PAPER"].value == pytest.approx(295.65, abs=0.01)
    assert checks["PIN-SHARED"].value == pytest.approx(140.8, abs=0.1)
    assert {key for key, check in checks.items() if check.status == "fail"} == {
        "CONTACT-RING-PEAK",
        "CONTACT-RING-CONTINUOUS",
        "CONTACT-PIN-PEAK",
        "CONTACT-PIN-CONTINUOUS",
        "PIN-SHEAR-PEAK",
        "PIN-BENDING-PEAK",
        "PIN-BENDING-CONTINUOUS",
        "BEARING-STATIC",
        "BEARING-LIFE",
        "MOTOR-PEAK",
        "MOTOR-CONTINUOUS",
    }
    assert checks["CONTACT-RING-PEAK"].value == pytest.approx(math.sqrt(1.15) * 1526.855, abs=0.1)
    assert checks["PIN-BENDING-PEAK"].value == pytest.approx(1.15 * 2420.66, abs=0.1)
    cantilever = changed({"reducer.output_pins.support": "cantilever"}, PAPER)
    worse = cantilever["PIN-BENDING-PEAK"].value / checks["PIN-BENDING-PEAK"].value
    arm = checks["PIN-BENDING-PEAK"].value / (1.15 * 963.33) * 2.342857
    assert worse == pytest.approx(13.0 / arm, rel=1e-4)


REMEDIES = [
    # change that breaks the check, check, key the remedy names, unit
    ({"reducer.eccentricity": "0.9 mm"}, "GEO-K1-LEAST", "reducer.eccentricity", "mm"),
    ({"reducer.eccentricity": "2.8 mm"}, "GEO-K1-MOST", "reducer.eccentricity", "mm"),
    (
        {"reducer.ring_pin_diameter": "17 mm"},
        "GEO-TOOTH-OVERLAP",
        "reducer.ring_pin_diameter",
        "mm",
    ),
    (
        {"reducer.eccentricity": "2.75 mm", "reducer.ring_pin_diameter": "12.4 mm"},
        "GEO-UNDERCUT",
        "reducer.ring_pin_diameter",
        "mm",
    ),
    (
        {"reducer.ring.outer_diameter": "70 mm"},
        "GEO-RING-WALL",
        "reducer.ring.outer_diameter",
        "mm",
    ),
    (
        {"reducer.ring.outer_diameter": "80 mm"},
        "SPACE-DIAMETER",
        "reducer.ring.outer_diameter",
        "mm",
    ),
    (
        {"reducer.output_pins.circle_radius": "23.4 mm"},
        "GEO-LIGAMENT-BORE",
        "reducer.output_pins.circle_radius",
        "mm",
    ),
    (
        {"reducer.output_pins.circle_radius": "25.1 mm"},
        "GEO-LIGAMENT-PROFILE",
        "reducer.output_pins.circle_radius",
        "mm",
    ),
    (
        {"reducer.output_pins.hole_clearance": "4 um"},
        "FIT-PIN-HOLE",
        "reducer.output_pins.hole_clearance",
        "um",
    ),
    (
        {"reducer.output_pins.sleeve_diameter": "4.6 mm", "reducer.output_pins.count": 8},
        "GEO-SLEEVE-WALL",
        "reducer.output_pins.sleeve_diameter",
        "mm",
    ),
    ({"reducer.disc_thickness": "7 mm"}, "CONTACT-RING-PEAK", "reducer.disc_thickness", "mm"),
    ({"reducer.disc_thickness": "8 mm"}, "BEARING-WIDTH", "reducer.disc_thickness", "mm"),
    ({"motor.voltage": "12 V"}, "MOTOR-SPEED", "motor.voltage", "V"),
]


@pytest.mark.parametrize(("break_it", "check_id", "key", "unit"), REMEDIES)
def test_the_computed_remedy_makes_the_check_pass(
    break_it: dict[str, Any], check_id: str, key: str, unit: str
) -> None:
    base = ROOMY if check_id in {"GEO-K1-MOST", "GEO-UNDERCUT", "GEO-TOOTH-OVERLAP"} else SOUND
    broken = base.replacing(break_it)
    check = by_id(resolve(broken).analysis)[check_id]
    assert check.status != "pass"
    leaf = key.rsplit(".", 1)[1]
    named = re.search(rf"{leaf} to (?:about )?([\d.]+) {unit}", check.remedy)
    assert named, check.remedy
    mended = broken.replacing({key: f"{named.group(1)} {unit}"})
    assert by_id(resolve(mended).analysis)[check_id].status == "pass"


def test_holes_between_lobes_and_bore_are_told_what_leaves_both_enough() -> None:
    pins = "reducer.output_pins."
    wide = SOUND.replacing({f"{pins}diameter": "6 mm", f"{pins}circle_radius": "24 mm"})
    remedy = by_id(resolve(wide).analysis)["GEO-LIGAMENT-PROFILE"].remedy
    named = re.search(r"to ([\d.]+) mm with a cam bearing of at most ([\d.]+) mm", remedy)
    assert named, remedy
    moved = wide.replacing({f"{pins}circle_radius": f"{named[1]} mm"})
    for bore, enough in ((float(named[2]), True), (float(named[2]) + 0.1, False)):
        left = min(one.thickness for one in ligaments(moved, bore_diameter=1e-3 * bore))
        assert (left >= LIGAMENT - 1e-8) == enough


@pytest.mark.parametrize(
    ("check_id", "key"),
    [
        ("CONTACT-RING-PEAK", "peak_torque"),
        ("CONTACT-PIN-PEAK", "peak_torque"),
        ("PIN-SHEAR-PEAK", "peak_torque"),
        ("PIN-BENDING-PEAK", "peak_torque"),
        ("BEARING-STATIC", "peak_torque"),
        ("CONTACT-RING-CONTINUOUS", "continuous_torque"),
        ("PIN-BENDING-CONTINUOUS", "continuous_torque"),
        ("BEARING-LIFE", "continuous_torque"),
        ("MOTOR-PEAK", "peak_torque"),
        ("MOTOR-CONTINUOUS", "continuous_torque"),
    ],
)
def test_the_torque_named_is_the_most_that_passes(check_id: str, key: str) -> None:
    check = by_id(resolve(PAPER).analysis)[check_id]
    named = re.search(
        rf"lower (?:the torque|the continuous torque|requirements\.{key}) to ([\d.]+) N\*m",
        check.remedy,
    )
    assert named, check.remedy
    torque = float(named.group(1))
    changes = {f"requirements.{key}": torque}
    if key == "peak_torque":
        changes["requirements.continuous_torque"] = 0.1 * torque
    else:
        changes["requirements.peak_torque"] = 500.0
    assert changed(changes, PAPER)[check_id].status == "pass"
    changes[f"requirements.{key}"] = 1.02 * torque
    assert changed(changes, PAPER)[check_id].status != "pass"


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"reducer.output_pins.support": "cantilever"}, "hold the pins at both ends"),
        ({"reducer.carrier.joint": "hinged"}, "clamp them in the cap too"),
        ({"reducer.carrier.joint": "clamped"}, None),
    ],
)
def test_pins_are_to_be_held_better_only_where_they_can_be(
    changes: dict[str, Any], says: str | None
) -> None:
    design = load_design(Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml")
    weak = {"reducer.output_pins.material": "18-8 shoulder screw (seed-consistent)"}
    machine = resolve(design.replacing({**changes, **weak}))
    peak = design.requirements.peak_torque
    loads = PeakLoads.of(peak, machine.loaded_contacts.greatest(peak))
    checks = (
        *peak_checks(machine.analysis, loads),
        *lasting_checks(machine.analysis, machine.life),
    )
    lines = {one.id: one for one in checks}
    for name in ("PIN-BENDING-PEAK", "PIN-BENDING-CONTINUOUS"):
        for words in ("hold the pins at both ends", "clamp them in the cap too"):
            assert (words in lines[name].remedy) == (words == says), name


def test_space_that_nobody_stated_only_warns_as_the_guide_says() -> None:
    wide: dict[str, Any] = {"reducer.ring.outer_diameter": "73 mm"}
    assert changed(wide, PAPER)["SPACE-DIAMETER"].status == "warn"
    wide["requirements.outer_diameter"] = "72 mm"
    assert changed(wide, PAPER)["SPACE-DIAMETER"].status == "fail"
    assert "requirements.outer_diameter" in CHECK_GUIDE["SPACE-DIAMETER"].exception


def test_a_ring_too_large_for_the_motor_is_made_smaller_where_its_wall_allows_it() -> None:
    wide = {"reducer.ring.outer_diameter": "78 mm"}
    thick = changed(wide)["MOTOR-BORE"]
    told = re.search(r"lower ring.outer_diameter to ([\d.]+) mm", thick.remedy)
    assert told is not None
    smaller = changed({"reducer.ring.outer_diameter": f"{told[1]} mm"})
    assert smaller["MOTOR-BORE"].status == smaller["GEO-RING-WALL"].status == "pass"
    pitch = SOUND.reducer.ring_pitch_radius + 2e-3
    thin = changed(wide | {"reducer.ring_pitch_radius": pitch})["MOTOR-BORE"]
    assert thin.remedy.startswith("take a motor with a larger bore")


def test_thicker_pins_named_by_the_remedy_pass_in_bending() -> None:
    steel = {"reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)"}
    check = changed(steel, PAPER)["PIN-BENDING-PEAK"]
    named = re.search(r"at least ([\d.]+) mm", check.remedy)
    assert named
    assert "clamp them in the cap too (reducer.carrier.joint)" in check.remedy
    thick = changed({**steel, "reducer.output_pins.diameter": f"{named.group(1)} mm"}, PAPER)
    assert thick["PIN-BENDING-PEAK"].status == "pass"


@pytest.mark.parametrize("sleeve", ["0 mm", "6 mm"])
def test_the_numbers_of_a_pin_stress_give_its_value(sleeve: str) -> None:
    """F, diameter, thickness and arm as printed, by the formula of the guide."""
    checks = changed(
        {"reducer.output_pins.sleeve_diameter": sleeve, "reducer.output_pins.count": 8}
    )

    def printed(check_id: str) -> list[float]:
        inside = re.search(r"\(F (.*)\) at", checks[check_id].substituted)
        assert inside
        return [float(word) for word in re.findall(r"[\d.]+", inside.group(1))]

    force, d = printed("PIN-SHEAR-PEAK")
    assert checks["PIN-SHEAR-PEAK"].value == pytest.approx(force / (math.pi / 4.0 * d**2), rel=1e-3)
    force, d, arm = printed("PIN-BENDING-PEAK")
    assert checks["PIN-BENDING-PEAK"].value == pytest.approx(
        32.0 * force * arm / (math.pi * d**3), rel=1e-3
    )
    force, d, b = printed("PIN-BEARING-PEAK")
    assert d == (6.0 if sleeve == "6 mm" else 4.0)
    assert checks["PIN-BEARING-PEAK"].value == pytest.approx(force / (d * b), rel=1e-3)


def test_a_larger_sleeve_named_by_the_remedy_passes() -> None:
    soft = PAPER.replacing(
        {"reducer.output_pins.sleeve_diameter": "5 mm", "requirements.peak_torque": "300 N*m"}
    )
    check = by_id(resolve(soft).analysis)["PIN-BEARING-PEAK"]
    assert check.status == "fail"
    named = re.search(r"sleeve_diameter to ([\d.]+) mm", check.remedy)
    assert named, check.remedy
    wider = soft.replacing({"reducer.output_pins.sleeve_diameter": f"{named.group(1)} mm"})
    assert by_id(resolve(wider).analysis)["PIN-BEARING-PEAK"].status == "pass"


def test_motor_shortfall_is_a_warning_unless_the_motor_is_named() -> None:
    more = {"requirements.peak_torque": "119 N*m"}
    assert changed(more)["MOTOR-PEAK"].status == "warn"
    named = changed({**more, "motor.name": "CubeMars RO100 KV55"})
    assert named["MOTOR-PEAK"].status == "fail"


@pytest.mark.parametrize("design", [PAPER, SOUND], ids=["paper", "sound"])
def test_the_motor_checks_say_what_the_losses_compute(design: Design) -> None:
    """Between the efficiencies named, rounded, at either torque."""
    low, high = allowables.COMPUTED_EFFICIENCIES
    machine, wanted = resolve(design), design.requirements
    for torque in (wanted.continuous_torque, wanted.peak_torque):
        found = machine.losses.at(wanted.input_speed, torque).efficiency_forward
        assert found is not None
        assert low - 0.005 < found < high + 0.005
    page = (Path(__file__).resolve().parents[2] / "docs" / "assumptions.md").read_text()
    for words in (
        page,
        *(by_id(machine.analysis)[f"MOTOR-{k}"].why for k in ("PEAK", "CONTINUOUS")),
    ):
        assert f"{low:g} to {high:g} at ratio 10" in " ".join(words.split())
        assert "16 to 24 % more" in " ".join(words.split())


@pytest.mark.parametrize("design", [PAPER, SOUND], ids=["paper", "sound"])
def test_clearance_shares_less_evenly_than_the_checks_assume(design: Design) -> None:
    """As docs/assumptions.md says of the factor 1.15: 1.3 at the peak, 1.5 to 1.6 at continuous.

    That is of clearance alone, between plates that are one body; a cap that hangs on the pins adds
    a fifth where it is clamped, and a half on the soft pins of the paper's design.
    """
    model, wanted = ContactModel.from_design(design), design.requirements
    rigid = resolve(design).analysis.rigid_peak
    found = []
    for one in (dataclasses.replace(model, pin=None), model):
        for torque in (wanted.peak_torque, wanted.continuous_torque):
            sweeps = [contact_sweep(one, sense * torque, perfect_angles(one)) for sense in (1, -1)]
            most = max(float(sweep.ring_force.max()) for sweep in sweeps)
            found.append(most / rigid.at(torque).ring_force)
    assert 1.25 < found[0] < 1.4
    assert 1.45 < found[1] < 1.65
    assert 1.1 < found[2] / found[0] < 1.6
    assert 1.1 < found[3] / found[1] < 1.6


def test_a_motor_without_data_is_said_not_guessed() -> None:
    analysis = resolve(SOUND.replacing({"motor.name": "T-Motor U8 KV150"})).analysis
    assert any("no peak torque" in words for words in analysis.warnings)
    assert "MOTOR-PEAK" not in by_id(analysis)
    lacking = by_id(analysis)["MOTOR-DATA"]
    assert (lacking.value, lacking.limit, lacking.status) == (1.0, 4.0, "warn")
    assert "no peak torque, no rated torque, no stator bore" in lacking.substituted
    assert worst_status(analysis.checks) == "warn"


def test_disc_count_rule_and_balance() -> None:
    assert [paper_disc_count(n) for n in (4, 5, 10, 11)] == [2, 3, 2, 3]
    with pytest.raises(UsageError, match="ratio 4"):
        paper_disc_count(3)
    single = changed({"reducer.disc_count": 1, "requirements.peak_torque": "20 N*m"})
    assert single["BALANCE-STATIC"].status == "warn"
    assert single["DISC-COUNT"].status == "warn"
    weighted = changed({"reducer.disc_count": 1, "reducer.balance.counterweights": True})
    assert weighted["BALANCE-STATIC"].status == "pass"
    odd = changed({"reducer.ratio": 11, "requirements.ratio": 11})["DISC-COUNT"]
    assert odd.status == "pass"
    assert "the paper's rule asks for 3" in odd.substituted


@given(st.floats(0.01, 2.0), st.floats(1e-4, 5e-3), st.floats(1e-3, 0.03), st.floats(0.0, 2e-3))
def test_stack_balance_against_summed_vectors(
    mass: float, throw: float, thickness: float, spacing: float
) -> None:
    pitch, speed = thickness + spacing, 120.0
    one, two, three = (
        stack_balance(mass, throw, thickness, spacing, count, speed) for count in (1, 2, 3)
    )
    assert one.static_unbalance == pytest.approx(mass * throw)
    assert (one.couple_unbalance, two.static_unbalance, three.static_unbalance) == (0.0, 0.0, 0.0)
    assert two.couple_unbalance == pytest.approx(mass * throw * pitch)
    # Discs at -pitch and +pitch, 240 degrees apart: sqrt 3 of one moment.
    assert three.couple_unbalance == pytest.approx(math.sqrt(3.0) * mass * throw * pitch)
    assert two.shaking_moment == pytest.approx(two.couple_unbalance * speed**2)
    weight = MassProperties(mass, np.array([-throw, 0.0, 0.0]))
    balanced = stack_balance(mass, throw, thickness, spacing, 1, speed, [weight])
    assert balanced.static_unbalance == 0.0
    # A product of inertia is a couple: two half masses at +-z make the same as one tensor.
    pair = [
        MassProperties(0.5 * mass, np.array([side * throw, 0.0, side * thickness]))
        for side in (-1.0, 1.0)
    ]
    merged = pair[0] + pair[1]
    apart = stack_balance(mass, throw, thickness, spacing, 2, speed, pair)
    together = stack_balance(mass, throw, thickness, spacing, 2, speed, [merged])
    assert together.couple_unbalance == pytest.approx(apart.couple_unbalance, rel=1e-9)


@given(
    st.floats(1e3, 1e5), st.floats(10.0, 1e4), st.floats(10.0, 1e3), st.sampled_from([3.0, 10 / 3])
)
def test_bearing_life_and_its_inverse(
    rating: float, hours: float, speed: float, exponent: float
) -> None:
    load = load_for_life(rating, hours, speed, exponent)
    life = basic_rating_life_hours(rating, load, speed, exponent)
    assert float(life) == pytest.approx(hours, rel=1e-9)
    halved = basic_rating_life_hours(rating, 2.0 * load, speed, exponent)
    assert float(life / halved) == pytest.approx(2.0**exponent, rel=1e-9)


def test_auto_takes_the_smallest_bearing_that_passes() -> None:
    auto = SOUND.replacing({"reducer.cam_bearing.designation": "auto"})
    machine = resolve(auto)
    analysis = machine.analysis
    assert machine.given is auto
    assert analysis.design == machine.design
    assert machine.design.reducer.cam_bearing.designation == machine.cam.designation
    checks = by_id(analysis)
    assert checks["BEARING-STATIC"].status == checks["BEARING-LIFE"].status == "pass"
    assert resolve(SOUND).design is SOUND
    gentle = auto.replacing(
        {"requirements.peak_torque": "5 N*m", "requirements.continuous_torque": "1 N*m"}
    )
    lighter = resolve(gentle).analysis.cam_bearing.bearing
    assert lighter.outer_diameter < analysis.cam_bearing.bearing.outer_diameter
    overloaded = auto.replacing({"requirements.peak_torque": "900 N*m"})
    assert by_id(resolve(overloaded).analysis)["BEARING-STATIC"].status == "fail"
    crowded = auto.replacing({"reducer.output_pins.circle_radius": "8 mm"})
    with pytest.raises(InfeasibleError, match="no catalogue bearing fits"):
        resolve(crowded)


def test_soft_steel_is_no_raceway() -> None:
    cage = {"reducer.cam_bearing.designation": "needle cage K22x26x10"}
    soft = resolve(SOUND.replacing(cage)).analysis
    assert by_id(soft)["BEARING-RACEWAY"].status == "fail"
    assert any("58 HRC" in words for words in soft.warnings)
    hard = changed({**cage, "reducer.disc_material": "AISI 52100 / 100Cr6 hardened"})
    assert hard["BEARING-RACEWAY"].status == "pass"
    cup = resolve(SOUND.replacing({"reducer.cam_bearing.designation": "needle HK2210"})).analysis
    assert "BEARING-RACEWAY" not in by_id(cup)
    assert any("eccentric" in words for words in cup.warnings)


def test_impossible_parts_are_refused() -> None:
    with pytest.raises(GeometryError, match="sleeve_diameter"):
        resolve(SOUND.replacing({"reducer.output_pins.sleeve_diameter": "3 mm"})).analyse()
    with pytest.raises(GeometryError, match="break out"):
        resolve(SOUND.replacing({"reducer.output_pins.circle_radius": "30 mm"})).analyse()
    with pytest.raises(GeometryError, match="undercut"):
        resolve(SOUND.replacing({"reducer.eccentricity": "3.1 mm"})).analyse()
    tight = {"reducer.output_pins.hole_clearance": "-100 um", "reducer.eccentricity": "0.04 mm"}
    with pytest.raises(GeometryError, match="hole_clearance"):
        resolve(SOUND.replacing(tight)).analyse()


def test_guide_and_checks_speak_of_the_same_things() -> None:
    seen = set()
    for design in (
        SOUND,
        SOUND.replacing(
            {
                "reducer.output_pins.diameter": "3 mm",
                "reducer.output_pins.sleeve_diameter": "6 mm",
                "reducer.output_pins.sleeve": "needle",
                "reducer.output_pins.count": 8,
                "reducer.ring_type": "pinwheel",
                "reducer.ring_pin_diameter": "4 mm",
                "reducer.ring.roller_diameter": "8 mm",
                "reducer.ring.roller": "needle",
                "reducer.ring.outer_diameter": "80 mm",
            }
        ),
        SOUND.replacing(
            {
                "reducer.output_pins.count": 5,
                "reducer.carrier.joint": "columns",
                "reducer.carrier.column_diameter": "3 mm",
            }
        ),
    ):
        for check in resolve(design).analysis.checks:
            guide = CHECK_GUIDE[check.id]
            assert (check.title, check.unit, check.sense) == (guide.title, guide.unit, guide.sense)
            assert check.formula == guide.formula
            assert all((check.substituted, check.why, check.remedy, check.source))
            seen.add(check.id)
    # Needle cages alone have raceways, motors without data and weights without a place a line
    # that says so; solids are turned, stress and temperatures found, only when asked to.
    rare = {"BEARING-RACEWAY", "ASSEMBLY-CLEAR", "MOTOR-DATA", "BALANCE-WEIGHTS"}
    # Nor are gearboxes drawn; these lines are the verdict's.
    rare |= {"CONTACT-REACH", "DUTY-ENVELOPE", "YIELD", "PIN-RUBBING"}
    rare |= {row.id for row in (*guide_shaft.ROWS, *guide_joints.ROWS, *guide_retention.ROWS)}
    rare |= {row.id for row in (*guide_asked.ROWS, *guide_bodies.ROWS, *guide_heat.ROWS)}
    assert seen == set(CHECK_GUIDE) - rare
    with pytest.raises(UsageError, match="BEARING-LIFE"):
        check_guide("BEARING-LIVE")


def test_series_stay_within_the_maxima() -> None:
    analysis = resolve(PAPER).analyse(angles=720)
    series, most = analysis.series, analysis.rigid
    assert series.ring_force.shape == (720, 2, 11)
    assert series.output_pin_force.shape == (720, 2, 5)
    assert 0.999 * most.ring_force < series.ring_force.max() <= most.ring_force * (1 + 1e-9)
    assert 0.999 * most.cam_bearing_load < series.cam_load.max()
    assert series.cam_load.max() <= most.cam_bearing_load * (1 + 1e-9)
    assert 0.999 * most.ring_pressure < series.ring_pressure.max()
    half = resolve(PAPER).analyse(torque=60.0)
    assert half.rigid.ring_force == pytest.approx(0.5 * most.ring_force)
    assert half.checks == analysis.checks


def judged(design: Design) -> tuple[GearboxAnalysis | None, CqddError | None]:
    try:
        return resolve(design).analysis, None
    except CqddError as refusal:
        return None, refusal


@given(
    discs(most_lobes=40),
    st.integers(1, 3),
    st.integers(3, 14),
    st.floats(0.4, 0.75),
    st.sampled_from(["both", "cantilever"]),
    st.sampled_from(["solid", "conjugate", "pinwheel"]),
    st.floats(2e-3, 12e-3),
)
@settings(max_examples=examples(40), deadline=None)
def test_random_designs_are_judged_or_refused_in_words(
    disc: CycloidDisc,
    count: int,
    pins: int,
    circle: float,
    support: str,
    ring_type: str,
    thickness: float,
) -> None:
    if disc.lobe_count < 4:
        return
    analysis, refusal = judged(
        design_of(
            disc,
            disc_count=count,
            disc_thickness=thickness,
            ring_type=ring_type,
            output_pins={
                "count": pins,
                "circle_radius": circle * disc.ring_pitch_radius,
                "support": support,
            },
        )
    )
    if refusal is not None:
        assert refusal.exit_code == 3
        assert str(refusal).endswith(".")
        return
    assert analysis is not None
    json.dumps([analysis.to_dict(), [c.to_dict() for c in analysis.checks]], allow_nan=False)
    for check in analysis.checks:
        assert (check.status == "pass") == (check.margin >= 1.0 - 1e-9) or check.limit == 0.0


def test_a_disc_without_concave_valleys_says_so() -> None:
    """(n+1) K1 <= 1: the valleys bulge outward, and there is no radius for a wire to follow."""
    flat = ROOMY.replacing({"reducer.eccentricity": "0.25 mm"})
    analysis = resolve(flat).analysis
    assert analysis.geometry.to_dict()["disc_min_concave_radius_mm"] is None
    assert "EDM-DISC" not in by_id(analysis)
    assert any("no concave valley" in words for words in analysis.warnings)
    assert by_id(analysis)["GEO-K1-LEAST"].status == "fail"


def test_every_limit_is_the_one_the_sources_give() -> None:
    """The constants of `allowables`, once more, in the units that their sources print."""
    shares = {
        "SHORTENING_LEAST": 0.3,
        "SHORTENING_MOST": 0.85,
        "UNDERCUT_SHARE": 0.9,
        "TOOTH_OVERLAP_SHARE": 0.85,
        "SHAFT_CORE_SHARE": 0.25,
        "FIRST_YIELD_FACTOR": 1.67,
        "PIN_SAFETY_AT_PEAK": 1.2,
        "SHEAR_YIELD_SHARE": 0.58,
        "PAPER_SHEAR_SHARE": 0.5,
        "PIN_FATIGUE_SHARE": 0.25,
        "SHAKING_SHARE": 0.1,
        "REDUCER_EFFICIENCY": 0.88,
        "HARDENED_HRC": 58.0,
    }
    assert {name: getattr(allowables, name) for name in shares} == shares
    millimetres = {"RING_WALL": 2.5, "LIGAMENT": 1.5, "SLEEVE_WALL": 0.5, "BALANCE_GRADE": 6.3}
    assert {name: 1e3 * getattr(allowables, name) for name in millimetres} == millimetres


def test_limits_of_the_profile_follow_from_the_geometry() -> None:
    checks, reducer = by_id(resolve(SOUND).analysis), SOUND.reducer
    disc = CycloidDisc.from_design(SOUND)
    undercut = 1e3 * disc.unmodified.undercut_radius_limit
    assert checks["GEO-UNDERCUT"].limit == pytest.approx(0.9 * undercut)
    touching = 1e3 * reducer.ring_pitch_radius * math.sin(math.pi / 11)
    assert checks["GEO-TOOTH-OVERLAP"].limit == pytest.approx(0.85 * touching)


@pytest.mark.parametrize("discs", [2, 3])
def test_the_shaking_couple_is_carried_over_all_discs(discs: int) -> None:
    """|sum m r z| omega^2 over the width of all discs, against a tenth of the cam's load."""
    design = SOUND.replacing({"reducer.disc_count": discs, "reducer.disc_thickness": "6 mm"})
    analysis = resolve(design).analysis
    check = by_id(analysis)["BALANCE-COUPLE"]
    assert check.value == pytest.approx(analysis.balance.shaking_moment / (discs * 6e-3))
    assert check.limit == pytest.approx(0.1 * analysis.cam_bearing.continuous_load)


def test_ranges_of_the_strength_rules() -> None:
    """Pitting strength ends at 400 HB; what is not as stiff as steel is no steel."""
    hard = allowables.contact_limit_fatigue(find_material("AISI 4340 Q&T 425C"))
    assert hard.value == pytest.approx(2.22e6 * 400.0 + 200e6)
    assert "held at 400 HB" in hard.basis
    steels = [name for name, one in materials().items() if allowables.is_steel(one)]
    assert len(steels) >= 20
    assert not {"7075-T6", "Brass CuZn39Pb3", "Bronze CuSn12"} & set(steels)


def test_a_case_is_no_through_hardening() -> None:
    case = find_material("SCM415/16MnCr5 case hardened")
    assert case.yield_strength is not None
    static = allowables.contact_limit_static(case)
    assert static.value == pytest.approx(1.67 * case.yield_strength)
    assert allowables.contact_limit_fatigue(case).value == pytest.approx(1500e6)


def test_a_sleeve_is_ground_to_size() -> None:
    """What a sleeve leaves of the hole clearance is all of it; a pin has a band."""
    sleeved = {"reducer.output_pins.sleeve_diameter": "6 mm", "reducer.output_pins.count": 8}
    assert changed(sleeved)["FIT-PIN-HOLE"].value == pytest.approx(16.0)
    assert changed({})["FIT-PIN-HOLE"].value == pytest.approx(16.0 - 15.0)


def test_more_pins_named_by_the_remedy_carry_the_load() -> None:
    few = SOUND.replacing(
        {
            "reducer.output_pins.count": 6,
            "reducer.output_pins.diameter": "3 mm",
            "requirements.peak_torque": "50 N*m",
            "requirements.continuous_torque": "15 N*m",
        }
    )
    check = by_id(resolve(few).analysis)["PIN-BENDING-PEAK"]
    assert check.status == "fail"
    named = re.search(r"use (\d+) pins of 3 mm", check.remedy)
    assert named, check.remedy
    count = int(named.group(1))
    more = by_id(resolve(few.replacing({"reducer.output_pins.count": count})).analysis)
    assert more["PIN-BENDING-PEAK"].status == "pass"
    fewer = by_id(resolve(few.replacing({"reducer.output_pins.count": count - 2})).analysis)
    assert fewer["PIN-BENDING-PEAK"].status == "fail"


@pytest.mark.parametrize(
    ("count", "circle", "more"), [(4, 23.0, 1.3), (6, 23.0, 1.3), (4, 21.5, 1.7), (5, 21.5, 1.2)]
)
def test_more_pins_of_parts_that_yield_are_enough_and_leave_the_disc_whole(
    count: int, circle: float, more: float
) -> None:
    """By proportion 6 for 4 held 0.89 of what they have to, and 8 came too near the lobes."""
    plain = load_design(GALLERY / "plain-10.toml")
    torque = more * plain.requirements.peak_torque
    few = plain.replacing(
        {
            "reducer.output_pins.count": count,
            "reducer.output_pins.circle_radius": f"{circle} mm",
            "requirements.peak_torque": f"{torque} N*m",
        }
    )
    check = {one.id: one for one in exact_checks(resolve(few))}["PIN-BENDING-PEAK"]
    assert check.status == "fail"
    named = re.search(r"use (\d+) pins of 4 mm", check.remedy)
    assert named, check.remedy
    cured = resolve(few.replacing({"reducer.output_pins.count": int(named[1])}))
    assert {one.id: one for one in exact_checks(cured)}["PIN-BENDING-PEAK"].status == "pass"
    shape = by_id(cured.analysis)
    assert {shape[f"GEO-LIGAMENT-{part}"].status for part in ("HOLES", "PROFILE")} == {"pass"}


@pytest.mark.parametrize(
    ("disc", "ring", "torque"),
    [
        ("AISI 4140 Q&T 540C", "AISI 4140 Q&T 540C", 120.0),
        ("AISI 4140 Q&T 540C", "AISI 4140 Q&T 540C", 250.0),
        ("6061-T6", "6061-T6", 20.0),
        ("6061-T6", "AISI 4140 Q&T 540C", 20.0),
        ("PLA", "PLA", 6.0),
        ("AISI 4140 annealed", "Brass CuZn39Pb3", 10.0),
    ],
)
def test_the_materials_named_by_the_remedy_pass(disc: str, ring: str, torque: float) -> None:
    """What is named is another material, of which such a part can be made, and carries the load."""
    design = PAPER.replacing(
        {
            "reducer.disc_material": disc,
            "reducer.ring_material": ring,
            "requirements.peak_torque": torque,
            "requirements.continuous_torque": 0.2 * torque,
        }
    )
    keys = {
        "disc": "reducer.disc_material",
        "ring": "reducer.ring_material",
        "pins": "reducer.output_pins.material",
    }
    found = 0
    for check in by_id(resolve(design).analysis).values():
        named = re.findall(r"the (disc|ring|pins) of '([^']*)'", check.remedy)
        if not check.id.startswith("CONTACT") or not named:
            continue
        found += 1
        for part, name in named:
            table, _, key = keys[part].rpartition(".")
            now = design.reducer.output_pins if table.endswith("pins") else design.reducer
            assert name != getattr(now, key)
            form = find_material(name).form
            assert form == "stock" or (part == "pins" and form == "fastener")
        harder = {keys[part]: name for part, name in named}
        assert changed(harder, design)[check.id].status == "pass", check.remedy
    assert found


def test_thicker_pins_are_named_with_a_circle_that_has_room_for_them() -> None:
    check = by_id(resolve(PAPER).analysis)["PIN-SHEAR-PEAK"]
    named = re.search(r"use pins of ([\d.]+) mm .*circle_radius near ([\d.]+) mm", check.remedy)
    assert named, check.remedy
    size, circle = named.groups()
    before = by_id(resolve(PAPER).analysis)
    after = changed(
        {
            "reducer.output_pins.diameter": f"{size} mm",
            "reducer.output_pins.circle_radius": f"{circle} mm",
        },
        PAPER,
    )
    assert after["PIN-SHEAR-PEAK"].status == "pass"
    ligaments = [key for key in before if key.startswith("GEO-LIGAMENT")]
    assert all(after[key].margin > 0.95 for key in ligaments)
    overloaded = changed({"requirements.peak_torque": 2000.0}, PAPER)
    for key in ("PIN-PAPER", "PIN-SHEAR-PEAK", "PIN-BENDING-PEAK", "PIN-BEARING-PEAK"):
        sizes = re.findall(r"pins of (?:at least )?([\d.]+) mm \(", overloaded[key].remedy)
        # No pin of four times the diameter on the same disc.
        assert all(float(size) < 12.0 for size in sizes), overloaded[key].remedy


def test_a_ring_wall_needs_half_of_a_diameter() -> None:
    check = changed({"reducer.ring.outer_diameter": "66 mm"}, PAPER)["GEO-RING-WALL"]
    named = re.search(r"ring_pitch_radius to about ([\d.]+) mm", check.remedy)
    assert named, check.remedy
    lower = 32.0 - float(named.group(1))
    assert lower == pytest.approx(check.limit - check.value, abs=0.01)


def test_a_remedy_says_a_thing_once() -> None:
    even = changed({"reducer.disc_count": 1}, PAPER)["DISC-COUNT"]
    assert even.remedy == "disc_count = 2 balances statically and follows the paper's rule"
    odd = changed({"reducer.disc_count": 1, "reducer.ratio": 11, "requirements.ratio": 11})
    assert "; disc_count = 3 follows" in odd["DISC-COUNT"].remedy
    short = changed({"requirements.length": "12 mm"}, PAPER)["SPACE-LENGTH"]
    named = re.search(r"disc_thickness to ([\d.]+) mm", short.remedy)
    assert named, short.remedy
    thinner = {"requirements.length": "12 mm", "reducer.disc_thickness": f"{named.group(1)} mm"}
    assert changed(thinner, PAPER)["SPACE-LENGTH"].status == "pass"


def test_the_wire_named_by_the_remedy_passes() -> None:
    """Valleys finer than the wire: the remedy's wire just goes through them."""
    fine = SOUND.replacing(
        {
            "reducer.ring_pin_diameter": "0.3 mm",
            "reducer.eccentricity": "2.9 mm",
            "reducer.ring.outer_diameter": "90 mm",
            "reducer.ring.relief_clearance": "0.01 mm",
            "edm.wire_diameter": "0.25 mm",
            "edm.spark_gap": "100 um",
        }
    )
    check = by_id(resolve(fine).analysis)["EDM-DISC"]
    assert check.status == "fail"
    named = re.search(r"wire of at most ([\d.]+) mm", check.remedy)
    assert named, check.remedy
    wire = float(named.group(1))
    thinner = {"edm.wire_diameter": f"{wire} mm"}
    assert by_id(resolve(fine.replacing(thinner)).analysis)["EDM-DISC"].status == "pass"
    thicker = {"edm.wire_diameter": f"{1.02 * wire:.4f} mm"}
    assert by_id(resolve(fine.replacing(thicker)).analysis)["EDM-DISC"].status == "fail"


def test_the_crank_turns_faster_against_the_disc() -> None:
    """(1 + 1/n) of the input: the disc turns backwards at 1/n."""
    analysis = resolve(SOUND).analysis
    speed = SOUND.requirements.input_speed
    assert analysis.cam_bearing.speed == pytest.approx(1.1 * speed)
    cam = analysis.cam_bearing
    turns = (cam.bearing.dynamic_rating / cam.continuous_load) ** 3 * 1e6
    assert by_id(analysis)["BEARING-LIFE"].value == pytest.approx(
        turns * 2.0 * math.pi / (3600.0 * 1.1 * speed)
    )


def test_of_bearings_that_fail_the_one_with_most_load_reserve_is_chosen() -> None:
    """Half the life of a ball bearing is a reserve of 0.79, more than a static safety of 0.6."""
    speed = 100.0
    load = float(load_for_life(10e3, 500.0, speed))
    short = dataclasses.replace(find_bearing("6902"), dynamic_rating=10e3, static_rating=1e9)
    weak = dataclasses.replace(short, dynamic_rating=1e9, static_rating=0.6 * load)
    for order in ((short, weak), (weak, short)):
        chosen = choose(order, load, load, speed, 1000.0)
        assert chosen is not None
        assert chosen.bearing is short
