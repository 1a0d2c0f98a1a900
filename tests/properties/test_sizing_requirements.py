"""Sizing as a whole: a checked design or a reason, for any requirements."""

import math
import os
import subprocess
import sys
from itertools import pairwise

import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shared_outputs import sized

from cqdd_design.catalog import find_material
from cqdd_design.design import Requirements, requirements_from_mapping
from cqdd_design.errors import DesignError, InfeasibleError
from cqdd_design.machine import resolve
from cqdd_design.results import worst_status
from cqdd_design.sizing import SizingInfeasibleError, size
from cqdd_design.sizing.frame import search_frame

MAY_WARN = {"BALANCE-STATIC", "BALANCE-COUPLE", "DISC-COUNT", "SPACE-DIAMETER", "SPACE-LENGTH"}


def assert_sound(result, requirements):
    """What every result promises, checked on a fresh analysis."""
    for design, objective in [
        (result.design, result.objective),
        *((one.design, one.objective) for one in result.alternatives),
    ]:
        assert design.requirements == requirements
        assert design.reducer.ring.outer_diameter <= requirements.outer_diameter + 1e-9
        assert design.reducer.pack_length <= requirements.length + 1e-9
        # Without the keys that were assumed: a motor that nobody named may fall short.
        checks = resolve(design.replacing({})).analysis.checks
        assert [check.id for check in checks if check.status == "fail"] == []
        warned = {check.id for check in checks if check.status == "warn"}
        assert all(one in MAY_WARN or one.startswith("MOTOR-") for one in warned)
        assert objective.torque_reserve >= 1.0 - 1e-9
        margins = {check.id: check.margin for check in checks}
        assert margins[objective.binding] == pytest.approx(objective.least_margin)
    all_different = [result.design.reducer]
    for one in result.alternatives:
        assert one.design.reducer not in all_different
        all_different.append(one.design.reducer)
    reserves = [one.objective.torque_reserve for one in result.alternatives]
    assert reserves == sorted(reserves)
    scores = [one.objective.score for one in result.alternatives]
    assert scores == sorted(scores)
    if reserves and reserves[-1] > 1.06:
        assert result.objective.torque_reserve >= 1.05
    assert result.survivors + sum(result.rejected.values()) == result.candidates_screened
    assert result.candidates_screened >= 200_000


@pytest.mark.parametrize(
    "ratio",
    [
        pytest.param(ratio, marks=() if ratio % 20 == 10 else pytest.mark.deep)
        for ratio in (*range(6, 12), 13, 15, 18, 21, 23, 26, 30)
    ],
)
def test_the_defaults_give_a_design_that_passes_every_check(ratio):
    result = sized(ratio=ratio)
    assert_sound(result, Requirements(ratio=ratio))
    assert len(result.alternatives) == 3
    assert {check.status for check in result.checks} == {"pass"}


@pytest.mark.deep
@pytest.mark.parametrize(
    "ratio",
    [4, *(pytest.param(ratio, marks=pytest.mark.deep) for ratio in (5, 31, 60)), 119],
)
def test_so_do_the_ratios_around_them(ratio):
    assert_sound(sized(ratio=ratio), Requirements(ratio=ratio))


REQUIREMENTS = st.fixed_dictionaries(
    {
        "ratio": st.integers(4, 119),
        "outer_diameter": st.floats(10, 250).map("{:.4g} mm".format),
        "length": st.floats(3, 60).map("{:.4g} mm".format),
        "peak_torque": st.floats(-2, 3).map(lambda x: f"{10**x:.4g} N*m"),
        "input_speed": st.floats(50, 9000).map("{:.4g} rpm".format),
        "disc_count": st.integers(1, 3),
        "disc_material": st.sampled_from(
            ["AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened", "17-4PH H900", "7075-T6"]
        ),
    }
)


@settings(
    deadline=None,
    max_examples=examples(10),
    suppress_health_check=[HealthCheck.too_slow],
    derandomize=True,
)
@given(given=REQUIREMENTS)
def test_any_requirements_give_a_design_or_a_reason(given):
    requirements = Requirements(**given)
    try:
        result = size(requirements)
    except InfeasibleError as error:
        assert_reasoned(error, requirements)
    else:
        assert_sound(result, requirements)


def assert_reasoned(error, requirements):
    """A refusal names a key, or what binds and a torque that would fit."""
    message = str(error)
    assert message.endswith(".")
    if not isinstance(error, SizingInfeasibleError):
        assert message.startswith("requirements.")
        return
    assert error.binding
    if error.most_torque is not None:
        assert 0.0 < error.most_torque < requirements.peak_torque


@pytest.mark.deep
def test_the_same_answer_every_time_in_every_process():
    result = sized(ratio=13, peak_torque="40 N*m", continuous_torque="20 N*m")
    program = (
        "from cqdd_design.design import Requirements; from cqdd_design.sizing import size; "
        "r = size(Requirements(ratio=13, peak_torque='40 N*m', continuous_torque='20 N*m')); "
        "print(r.design.sha256, *(a.design.sha256 for a in r.alternatives), r.rejected)"
    )
    for threads in ("1", "4"):
        printed = subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split(maxsplit=4)
        hashes = [result.design.sha256, *(one.design.sha256 for one in result.alternatives)]
        assert printed[:4] == hashes
        assert printed[4].strip() == str(result.rejected)


@pytest.mark.deep
def test_a_bigger_ring_never_carries_less():
    most = []
    for diameter in (36, 42, 52, 64):
        with pytest.raises(SizingInfeasibleError) as caught:
            sized(ratio=10, peak_torque="500 N*m", outer_diameter=f"{diameter} mm")
        most.append(caught.value.most_torque)
    assert most == sorted(most)
    assert most[-1] > 5.0 * most[0]


@pytest.mark.deep
@pytest.mark.parametrize(
    "given",
    [
        {"ratio": 10, "outer_diameter": "36 mm"},
        pytest.param({"ratio": 10, "outer_diameter": "42 mm"}, marks=pytest.mark.deep),
        pytest.param({"ratio": 23, "outer_diameter": "52 mm"}, marks=pytest.mark.deep),
        pytest.param({"ratio": 6, "disc_count": 3}, marks=pytest.mark.deep),
    ],
)
def test_the_most_torque_fits_and_little_more_does_not(given):
    """However far away it is; a search for it once went on for ever."""
    with pytest.raises(SizingInfeasibleError) as caught:
        sized(**given, peak_torque="500 N*m", continuous_torque="150 N*m")
    most = caught.value.most_torque
    assert sized(**given, **_torques(most)).objective.torque_reserve >= 1.0
    with pytest.raises(SizingInfeasibleError):
        sized(**given, **_torques(1.02 * most))


def _torques(peak):
    return {"peak_torque": f"{peak:g} N*m", "continuous_torque": f"{0.3 * peak:g} N*m"}


@pytest.mark.deep
def test_the_nearest_requirements_named_do_fit():
    """Both ways out of an infeasible request are real designs."""
    asked = {"ratio": 10, "peak_torque": "80 N*m", "continuous_torque": "30 N*m"}
    small = {"outer_diameter": "60 mm"}
    with pytest.raises(SizingInfeasibleError) as caught:
        sized(**asked, **small)
    error = caught.value
    less = {**small, "ratio": 10, "peak_torque": f"{error.most_torque} N*m"}
    less["continuous_torque"] = f"{error.most_torque * 30 / 80} N*m"
    assert sized(**less).objective.torque_reserve < 1.05
    ring = round(error.outer_diameter_needed * 1e3)
    assert sized(**asked, outer_diameter=f"{ring} mm").objective.torque_reserve >= 1.0
    with pytest.raises(SizingInfeasibleError):
        sized(**asked, outer_diameter=f"{ring - 2} mm")


@pytest.mark.deep
def test_where_no_ring_helps_the_length_is_named():
    asked = {"ratio": 10, "peak_torque": "60 N*m", "length": "8 mm"}
    with pytest.raises(SizingInfeasibleError) as caught:
        sized(**asked)
    error = caught.value
    assert error.outer_diameter_needed is None
    assert "pack of discs" in str(error)
    needed = round(error.length_needed * 1e3)
    assert sized(**{**asked, "length": f"{needed} mm"}).objective.torque_reserve >= 1.0


@pytest.mark.parametrize(
    ("given", "key", "words"),
    [
        ({"length": "3 mm"}, "length", "narrowest rated cam bearing"),
        ({"outer_diameter": "12 mm"}, "outer_diameter", "output pins"),
        ({"outer_diameter": "22 mm"}, "outer_diameter", "cam bearing"),
        ({"disc_material": "7075-T6"}, "disc_material", "no contact fatigue strength"),
    ],
)
def test_requirements_without_room_for_any_part_name_their_key(given, key, words):
    with pytest.raises(InfeasibleError) as caught:
        sized(ratio=10, **given)
    message = str(caught.value)
    assert message.startswith(f"requirements.{key} ")
    assert words in message
    assert caught.value.exit_code == 3


@pytest.mark.deep
def test_a_motor_asked_for_must_be_enough():
    """The default motor only warns; the same motor asked for is a requirement."""
    peak = {"ratio": 6, "peak_torque": "66 N*m", "continuous_torque": "10 N*m"}
    result = sized(**peak)
    assert [check.id for check in result.checks if check.status == "warn"] == ["MOTOR-PEAK"]
    with pytest.raises(SizingInfeasibleError) as caught:
        sized(**peak, motor="CubeMars RO100 KV55")
    error = caught.value
    assert error.binding == ("MOTOR-PEAK",)
    assert error.most_torque == pytest.approx(6 * 0.88 * 12.0, rel=0.01)
    within = {**peak, "peak_torque": f"{error.most_torque} N*m"}
    assert sized(**within, motor="CubeMars RO100 KV55").design.motor.name == "CubeMars RO100 KV55"


@pytest.mark.deep
def test_a_motor_without_data_is_named_and_its_inertia_is_not_zero():
    """What the catalogue does not know is said in words and is no number."""
    found = sized(ratio=10, motor="T-Motor U8 KV150")
    assert any(
        "rotor inertia of 'T-Motor U8 KV150' is not known" in words for words in found.warnings
    )
    assert any("no peak torque" in words for words in found.warnings)
    assert found.objective.reflected_inertia is None
    assert found.objective.to_dict()["reflected_inertia_kgm2"] is None
    # What no reflected inertia is known of is weighed by mass alone, never with a rotor of none.
    assert found.objective.score == pytest.approx(found.objective.mass)
    assert found.objective.to_dict()["goal"] == "mass"
    assert worst_status(found.checks) == "warn"
    known = sized(ratio=10)
    assert known.warnings == ()
    assert known.objective.reflected_inertia > known.objective.gearbox_inertia


def test_a_geared_actuator_is_no_motor():
    with pytest.raises(DesignError, match=r"motor = 'CubeMars AK80-9 V3': .* geared actuator"):
        requirements_from_mapping({"ratio": 10, "motor": "CubeMars AK80-9 V3"})


@pytest.mark.deep
def test_what_was_not_stated_stays_assumed():
    design = sized(ratio=10).design
    assert "requirements.peak_torque" in design.assumed
    assert "reducer.output_pins.hole_clocking" in design.assumed
    assert "reducer.eccentricity" not in design.assumed
    told = []
    asked = Requirements(ratio=10, peak_torque="50 N*m", length="20 mm")
    stated = size(asked, progress=told.append).design
    assert "requirements.peak_torque" not in stated.assumed
    assert "requirements.length" not in stated.assumed
    assert "requirements.continuous_torque" in stated.assumed
    assert stated.requirements.continuous_torque == pytest.approx(19.0)
    # What is done meanwhile is told in sentences.
    assert len(told) >= 2
    assert any("candidates meet every limit" in line for line in told)


def test_sizes_are_those_a_shop_can_make():
    reducer = sized(ratio=10).design.reducer
    for value, step in (
        (reducer.eccentricity, 10e-6),
        (reducer.ring_pin_diameter, 100e-6),
        (reducer.ring_pitch_radius, 50e-6),
        (reducer.output_pins.circle_radius, 50e-6),
        (reducer.disc_thickness, 100e-6),
    ):
        assert math.isclose(value / step, round(value / step), abs_tol=1e-6)


def test_thick_screws_get_the_clearance_their_tolerance_needs():
    """Shoulders of 8 mm vary by 36 um, more than twice the default clearance allows."""
    # A motor whose bore nobody knows sets no limit to the ring.
    wide = {"outer_diameter": "180 mm", "motor": "T-Motor U8 KV150"}
    sizes = search_frame(requirements_from_mapping({"ratio": 10, **wide})).pin_sizes
    thick = [one for one in sizes if one.diameter >= 8e-3]
    assert thick
    assert all(one.hole_clearance > 16e-6 for one in thick)
    assert all(one.hole_clearance == 16e-6 for one in sizes if one.diameter < 6e-3)


@pytest.mark.deep
def test_every_requirement_has_an_effect():
    asked = {"ratio": 12, "peak_torque": "50 N*m", "continuous_torque": "15 N*m"}
    base = sized(**asked).design
    for change in (
        {"peak_torque": "80 N*m"},
        {"continuous_torque": "30 N*m"},
        {"input_speed": "6000 rpm"},
        {"outer_diameter": "57 mm"},
        {"length": "11 mm", "peak_torque": "40 N*m"},
        {"disc_count": 3},
        {"disc_material": "AISI 4140 Q&T 425C", "ring_material": "AISI 4140 Q&T 425C"},
        {"pin_material": "18-8 shoulder screw (seed-consistent)"},
    ):
        assert sized(**{**asked, **change}).design.reducer != base.reducer, change


@pytest.mark.deep
def test_needles_are_used_where_the_discs_are_hard_enough_to_be_raceways():
    """What balls cannot carry in a 72 mm ring, caged needles do, in discs of bearing steel."""
    asked = {"ratio": 10, "peak_torque": "120 N*m", "length": "21 mm"}
    with pytest.raises(SizingInfeasibleError):
        sized(**asked)
    steel = "AISI 52100 / 100Cr6 hardened"
    design = sized(**asked, disc_material=steel, ring_material=steel).design
    assert design.reducer.cam_bearing.designation.startswith("needle")


@pytest.mark.deep
def test_harder_discs_allow_more():
    """Pressure limits rise with hardness, so the ring contact stops binding."""
    assert find_material("AISI 52100 / 100Cr6 hardened").rockwell_hardness >= 58.0
    with pytest.raises(SizingInfeasibleError) as soft:
        sized(ratio=10, peak_torque="500 N*m")
    with pytest.raises(SizingInfeasibleError) as hard:
        sized(
            ratio=10,
            peak_torque="500 N*m",
            disc_material="AISI 52100 / 100Cr6 hardened",
            ring_material="AISI 52100 / 100Cr6 hardened",
        )
    assert hard.value.most_torque > soft.value.most_torque
    assert not any(check.startswith("CONTACT-RING") for check in hard.value.binding)


@pytest.mark.parametrize(
    ("given", "most", "ring"),
    [
        ({"outer_diameter": "110 mm"}, 0.121, 55.6e-3),
        pytest.param({"outer_diameter": "48 mm"}, 0.114, 48.1e-3, marks=pytest.mark.deep),
    ],
)
def test_outer_diameter_is_a_limit_and_not_a_target(given, most, ring):
    """A ring that fills 110 mm weighs 0.346 kg; 15 N m go into the least round which the motor is
    drawn, and weigh less in a smaller one where no more is allowed."""
    found = sized(ratio=16, peak_torque="15 N*m", **given)
    assert found.objective.mass < most
    assert found.design.reducer.ring.outer_diameter < ring


def test_the_ring_goes_into_the_motors_bore():
    found = sized(ratio=20, peak_torque="150 N*m", outer_diameter="150 mm", length="30 mm")
    bore = next(one for one in found.checks if one.id == "MOTOR-BORE")
    assert found.design.reducer.ring.outer_diameter * 1e3 <= bore.limit


def test_a_larger_ring_is_found_however_small_the_present_one():
    """3 N m at ratio 4 need a 44 mm ring."""
    with pytest.raises(SizingInfeasibleError) as caught:
        sized(ratio=4, peak_torque="3 N*m", outer_diameter="34 mm", length="12 mm")
    assert caught.value.outer_diameter_needed == pytest.approx(44e-3)


@pytest.mark.deep
def test_mass_does_not_fall_when_torque_grows():
    masses = [
        sized(ratio=10, peak_torque=f"{torque} N*m").objective.mass
        for torque in (60, 75, 90, 90.1, 98)
    ]
    assert all(after >= 0.99 * before for before, after in pairwise(masses))
