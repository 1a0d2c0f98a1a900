"""Any motor: what is left out, what the screen refuses, in which order, and what is told of it.

What is sized with the motor stands in tests/cli/test_cli_size.py; here another function takes the
place of sizing, so that only the choice is looked at.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from cqdd_design.catalog.motors import Motor, find_motor, motors
from cqdd_design.design import Requirements, load_design, requirements_from_mapping
from cqdd_design.errors import DesignError, InfeasibleError, UsageError
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION
from cqdd_design.machine import resolve
from cqdd_design.sizing import SizedDesign, SizingInfeasibleError, SizingResult
from cqdd_design.sizing.frame import search_frame
from cqdd_design.sizing.goals import tied, untied
from cqdd_design.sizing.motor_ranks import RANKED, losses_share, screened, with_motor
from cqdd_design.sizing.motors import NoMotorError, lacking, size_with_any
from cqdd_design.sizing.search import Search
from cqdd_design.verdict import judge

STANDARD, LITE = find_motor("CubeMars RO100 KV55"), find_motor("CubeMars RO100 Lite KV55")
DESIGNS = Path(__file__).resolve().parents[2] / "designs"


def asked(**more: object) -> Requirements:
    torques = {"peak_torque": "30 N*m", "continuous_torque": "6 N*m"}
    return requirements_from_mapping({"ratio": 10, **torques, **more})


def choose(requirements, attempt, rows=None, **more):
    return size_with_any(requirements, attempt, to_verdict=False, rows=rows, **more)


def taken(requirements: Requirements, motor: Motor) -> str:
    assert requirements.motor == motor.name
    return motor.name


@pytest.fixture(scope="module")
def sized() -> SizedDesign:
    search = Search.of(search_frame(asked()))
    most = search.most_reserve()
    assert most is not None
    found = search.lightest(most)
    assert found is not None
    return found[0]


def ranks(requirements: Requirements, *rows: Motor):
    return screened(requirements, rows, every_space=False, ambient=None, goal="mass")


def test_a_motor_is_left_out_with_the_figures_that_its_row_lacks():
    assert lacking(STANDARD) == lacking(LITE) == ()
    assert lacking(find_motor("CubeMars RO80 KV105")) == (
        "drag",
        "length of the stack",
        "depth of the slots",
    )
    bare = replace(STANDARD, peak_torque=None, speed_constant=None, torque_constant_printed=None)
    assert lacking(bare) == ("peak torque", "torque constant")
    assert lacking(replace(STANDARD, bore_diameter=None)) == ("stator bore",)


@pytest.mark.deep
@pytest.mark.parametrize("field", ["stack_length", "slot_depth", "peak_torque", "rotor_inertia"])
def test_what_a_row_lacks_leaves_the_verdict_unknown(field):
    """So leaving it out loses no design whose verdict is yes."""
    row = replace(STANDARD, **{field: None})
    assert lacking(row)
    design = load_design(DESIGNS / "reference-s.toml")
    lines = judge(resolve(design, row), samples=16).lines
    assert any(line.status == "unknown" and line.id != "YIELD" for line in lines)


def test_the_first_of_the_screens_order_that_fits_is_taken_and_the_rest_is_told():
    tried: list[str] = []

    def attempt(requirements: Requirements, motor: Motor) -> str:
        tried.append(motor.name)
        return taken(requirements, motor)

    found = choose(asked(), attempt)
    choice = found.choice
    # Of two with the same winding the lighter, by the mass that counts the motor.
    assert found.result == choice.chosen == LITE.name
    assert tried == [LITE.name]
    assert choice.untried == (STANDARD.name,)
    told = choice.to_dict()
    rows = motors().values()
    assert told["geared"] == sum(one.torque_at != "motor" for one in rows)
    assert len(choice.left_out) + len(choice.ranked) + choice.geared == len(rows)
    assert all(one["missing"] for one in told["left_out"])
    assert "1 tried by the search by closed forms, 1 only screened" in choice.sentences[1]
    # What the catalogue does not know of the lighter variant is the other's, which is said.
    lent = told["screened"][0]["taken_over"]
    assert "bore_diameter" in lent
    assert f"{len(lent)} of its figures are those of '{STANDARD.name}'" in choice.sentences[-1]
    assert told["screened"][1]["taken_over"] == []
    gearbox = choice.ranked[0].value - LITE.mass
    assert gearbox == pytest.approx(choice.ranked[1].value - STANDARD.mass)
    assert 0.05 < gearbox < 0.4


def test_the_next_motor_is_tried_where_one_is_refused():
    def attempt(requirements: Requirements, motor: Motor) -> str:
        if motor.name == LITE.name:
            raise InfeasibleError("too hot.")
        return taken(requirements, motor)

    choice = choose(asked(), attempt, (STANDARD, LITE)).choice
    assert choice.chosen == STANDARD.name
    assert [(one.name, one.why) for one in choice.tried] == [
        (LITE.name, "too hot."),
        (STANDARD.name, ""),
    ]
    assert choice.untried == ()


def test_when_none_fits_the_closest_are_told_with_what_binds():
    def attempt(requirements: Requirements, motor: Motor) -> str:
        most = 20.0 if motor.name == LITE.name else 25.0
        raise SizingInfeasibleError(
            f"most {most:g} N*m.", binding=(f"OF-{most:g}",), most_torque=most
        )

    weak = replace(STANDARD, name="weak", peak_torque=1.0)
    with pytest.raises(NoMotorError) as caught:
        choose(asked(), attempt, (weak, STANDARD, LITE))
    error = caught.value
    assert error.exit_code == 3
    assert error.binding == ("OF-20",)
    assert error.most_torque == 25.0
    message = error.message
    parts = (LITE.name, f"{STANDARD.name}: most 25 N*m", "weak: at most 8.8 of 30 N*m")
    places = [message.index(one) for one in parts]
    assert places == sorted(places)
    details = error.to_dict()
    assert details["most_peak_torque_Nm"] == 25.0
    assert details["motors"]["chosen"] is None
    assert [one["motor"] for one in details["motors"]["tried"]] == [LITE.name, STANDARD.name]


def test_a_mistake_that_is_no_design_is_not_taken_for_a_motors():
    def attempt(requirements: Requirements, motor: Motor) -> str:
        raise UsageError("no such file.")

    with pytest.raises(UsageError, match="no such file"):
        choose(asked(), attempt, (STANDARD,))


def test_no_rows_that_can_be_judged():
    with pytest.raises(NoMotorError, match="stator bore 1") as caught:
        choose(asked(), taken, (replace(STANDARD, bore_diameter=None),))
    assert caught.value.binding == ()
    assert caught.value.most_torque is None


def test_a_peak_torque_has_to_be_stated():
    with pytest.raises(UsageError, match="--peak-torque"):
        choose(requirements_from_mapping({"ratio": 10}), taken)


@pytest.mark.parametrize(
    ("changed", "more", "binding"),
    [
        # Times 10 and 0.88 at the output: 29.9 N*m, and 29.03 of 19 A x 0.17362 N*m/A.
        ({"peak_torque": 3.4}, {}, "MOTOR-PEAK"),
        ({}, {"current": "19 A"}, "MOTOR-PEAK"),
        # 48 V through 4 ohm are 12 A.
        ({"line_resistance": 4.0}, {}, "MOTOR-PEAK"),
        # 2640 rpm on 48 V, over 0.8955 with magnets at 120 degC.
        ({}, {"input_speed": "2960 rpm"}, "MOTOR-SPEED"),
        ({}, {"voltage": "20 V"}, "MOTOR-SPEED"),
    ],
)
def test_a_motor_too_weak_or_too_slow_is_refused_unsearched(changed, more, binding):
    (one,) = ranks(asked(**more), replace(STANDARD, **changed))
    assert one.binding == (binding,)
    assert 0.0 < one.reach < 1.0
    assert one.value is None
    assert not one.explained


@pytest.mark.parametrize("more", [{"current": "20 A"}, {"input_speed": "2940 rpm"}])
def test_a_motor_at_its_limits_passes(more):
    (one,) = ranks(asked(**more), STANDARD)
    assert one.why == ""


def test_a_bore_without_room_is_refused_and_explained_by_trying():
    whole = replace(STANDARD, name="small", bore_diameter=32e-3)
    tried: list[str] = []

    def attempt(requirements: Requirements, motor: Motor) -> str:
        tried.append(motor.name)
        raise InfeasibleError("the bore is too small.")

    with pytest.raises(NoMotorError, match="small: the bore is too small") as caught:
        choose(asked(), attempt, (whole,))
    assert tried == ["small"]
    assert "ring up to 31.14 mm" in caught.value.choice.ranked[0].why


def test_a_strong_motor_with_a_small_bore_comes_after_those_that_pass():
    small = replace(STANDARD, name="small", bore_diameter=32e-3, mass=0.01)
    order = ranks(asked(), small, STANDARD)
    assert [one.motor.name for one in order] == [STANDARD.name, "small"]


def test_values_count_the_motor(sized):
    wanted = asked(continuous_speed="300 rpm")
    objective = sized.objective
    assert with_motor("mass", sized, wanted, LITE) == pytest.approx(objective.mass + 0.525)
    turning = replace(
        sized,
        objective=replace(
            objective, goal="inertia", score=tied(objective.gearbox_inertia, objective.mass)
        ),
    )
    assert with_motor("inertia", turning, wanted, LITE) == pytest.approx(
        objective.reflected_inertia - STANDARD.rotor_inertia + LITE.rotor_inertia
    )
    playing = replace(sized, objective=replace(objective, score=tied(2e-3, objective.mass)))
    assert with_motor("backlash", playing, wanted, LITE) == pytest.approx(2e-3)
    box = with_motor("size", sized, wanted, STANDARD)
    assert box == pytest.approx(math.pi / 4.0 * 0.1135**2 * 0.0362)
    flat = replace(STANDARD, length=1e-3)
    reducer = sized.design.reducer
    pack = 2.0 * reducer.disc_thickness + reducer.disc_spacing
    assert with_motor("size", sized, wanted, flat) == pytest.approx(
        math.pi / 4.0 * 0.1135**2 * pack
    )
    rubbing = replace(sized, objective=replace(objective, score=tied(1.5, objective.mass)))
    assert with_motor("efficiency", rubbing, wanted, STANDARD) == pytest.approx(
        losses_share(wanted, STANDARD, 1.5 * BOUNDARY_FRICTION)
    )


def test_losses_of_the_motor_by_hand():
    """6 N*m at 300 rpm of the motor: 18.85 W leave, and gearbox, copper and drag lose theirs."""
    wanted = asked(continuous_speed="300 rpm")
    speed = 300.0 * math.pi / 30.0
    drag = 0.0999 + 0.000849887 * speed
    current = (0.6 * 1.2 + drag) * (2.0 * math.pi / 60.0) * 55.0
    lost = 0.2 * 6.0 * speed / 10.0 + 0.143 * current**2 + drag * speed
    assert losses_share(wanted, STANDARD, 0.2) == pytest.approx(lost / (6.0 * speed / 10.0))


def test_every_goal_has_its_words_and_its_value(sized):
    from typing import get_args

    from cqdd_design.sizing.frame import Goal

    assert set(RANKED) == set(get_args(Goal))
    assert untied("inertia", tied(3.0, 0.4), 0.4) == pytest.approx(3.0)
    assert untied("mass", 0.4, 0.4) == 0.4


def result(sized: SizedDesign, *suffixes: str) -> SizingResult:
    others = tuple(
        replace(sized, design=sized.design.replacing({"name": f"sized-10-{one}"}))
        for one in suffixes
    )
    counts = {"candidates_screened": 2, "survivors": 1, "rejected": {}, "seconds": 0.0}
    return SizingResult(**vars(sized), alternatives=others, **counts)


def test_an_alternative_takes_the_designs_place(sized):
    picked = result(sized, "b", "d").picking("d")
    names = [picked.design.name, *(one.design.name for one in picked.alternatives)]
    assert names == ["sized-10-d", "sized-10-a", "sized-10-b"]
    assert picked.candidates_screened == 2


def test_a_letter_that_was_not_found_names_those_there_are(sized):
    with pytest.raises(UsageError, match=r"--pick c: .* the letters there are: b, d"):
        result(sized, "b", "d").picking("c")
    with pytest.raises(UsageError, match="there is none"):
        result(sized).picking("b")


def test_refusals_are_of_the_projects_family():
    assert issubclass(NoMotorError, DesignError)
