"""A motor that no gearbox helps is told at once: its reach is a bound, and refusals name it."""

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import demands
from cqdd_design.actuator.motor import greatest_torque
from cqdd_design.catalog.motors import find_motor
from cqdd_design.design import load_design, requirements_from_mapping
from cqdd_design.machine import resolve
from cqdd_design.sizing import nearest
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.motor_reach import MotorShortError, reach, refuse_weak_motor
from cqdd_design.sizing.ratios import other_ratio
from cqdd_design.sizing.verified import size_to_verdict

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
MOTOR = find_motor("CubeMars RO100 KV55")


def asked(**given):
    return requirements_from_mapping({"ratio": 10, **given})


@pytest.mark.parametrize("ambient", [-40.0, 0.0, 25.0, 60.0])
def test_no_simulated_actuator_passes_the_reach_of_its_motor(ambient):
    design = load_design(DESIGN).replacing({"environment.ambient": ambient})
    actuator = actuator_parameters(resolve(design))
    most = reach(design.requirements, MOTOR, ambient)
    speeds = np.array([0.0, 1e-3, 0.999 * most.speed])
    for warm in (ambient, MOTOR.winding_most):
        there = greatest_torque(actuator.motor, actuator.drive, speeds, warm)
        assert np.all(there <= most.torque)
    peak = demands(actuator, design.requirements)[0].found.most
    # What losses leave is less; but not so little that the bound says nothing.
    assert 0.6 * most.torque * 10 < peak < most.torque * 10


def test_a_reach_is_that_of_the_supply_the_driver_and_the_motor():
    usual = reach(asked(), MOTOR, None)
    assert usual.torque == pytest.approx(MOTOR.torque_constant * 50.5)
    assert reach(asked(current="10 A"), MOTOR, None).torque == pytest.approx(
        10.0 * MOTOR.torque_constant
    )
    # Magnets in the cold are stronger.
    cold = reach(asked(current="10 A"), MOTOR, -15.0).torque
    assert cold == pytest.approx(10.0 * MOTOR.torque_constant * (1.0 + 0.0011 * 40.0))
    assert reach(asked(current="500 A"), MOTOR, None).torque == MOTOR.peak_torque
    assert reach(asked(voltage="1 V"), MOTOR, None).current == pytest.approx(
        1.0 / MOTOR.line_resistance
    )
    assert reach(asked(voltage="24 V"), MOTOR, None).speed == pytest.approx(0.5 * usual.speed)
    bare = replace(MOTOR, speed_constant=None, torque_constant_printed=None, peak_torque=None)
    assert reach(asked(), bare, None)[::2] == (float("inf"), float("inf"))


@pytest.mark.parametrize(
    ("given", "binding", "said"),
    [
        ({"peak_torque": "87 N*m", "continuous_torque": "5 N*m"}, (), ()),
        (
            {"peak_torque": "88 N*m", "continuous_torque": "5 N*m"},
            ("MOTOR-PEAK",),
            ("8.768 N*m at the shaft (50.5 A) are 87.68 of 88 N*m at ratio 10", "raise the ratio"),
        ),
        (
            {"peak_torque": "130 N*m", "current": "90 A"},
            ("MOTOR-PEAK",),
            ("12 N*m at the shaft (its own peak torque) are 120 of 130 N*m",),
        ),
        (
            {"input_speed": "3000 rpm"},
            ("MOTOR-SPEED",),
            ("48 V turn it at 2948 of 3000 rpm at most",),
        ),
        (
            {"peak_torque": "120 N*m", "input_speed": "3000 rpm"},
            ("MOTOR-PEAK", "MOTOR-SPEED"),
            ("87.68 of 120", "2948 of 3000"),
        ),
    ],
)
def test_what_no_gearbox_helps_is_refused_before_any_search(given, binding, said, monkeypatch):
    if not binding:
        refuse_weak_motor(asked(**given), MOTOR, None)
        return
    monkeypatch.setattr("cqdd_design.sizing.verified._searched", None)
    with pytest.raises(MotorShortError) as caught:
        size_to_verdict(asked(**given))
    assert caught.value.binding == binding
    for words in said:
        assert words in caught.value.message
    assert ("raise the ratio" in caught.value.message) == ("MOTOR-PEAK" in binding)


@pytest.mark.parametrize(
    ("given", "binding", "said", "ratio"),
    [
        ({"reflected_inertia": "0.0871 kg*m^2", "mass": "0.72 kg"}, (), (), None),
        (
            {"reflected_inertia": "0.0869 kg*m^2"},
            ("REFLECTED-INERTIA",),
            (
                "its rotor of 0.00087 kg*m^2 alone is felt as 0.087 of 0.0869",
                "Allow more inertia, ",
            ),
            9,
        ),
        (
            {"mass": "700 g"},
            ("MASS",),
            ("it weighs 0.71 of 0.7 kg itself", "Allow more mass"),
            None,
        ),
        (
            {"mass": "500 g", "reflected_inertia": "0.0139 kg*m^2", "peak_torque": "130 N*m"},
            ("MOTOR-PEAK", "REFLECTED-INERTIA", "MASS"),
            ("Ask for less torque, raise the ratio, allow more inertia, allow more mass, or take",),
            3,
        ),
    ],
)
def test_a_motor_that_is_more_than_the_actuator_may_be_is_refused_at_once(
    given, binding, said, ratio
):
    """By its catalogue: 0.71 kg and 0.00087 kg m^2. Such a search took five minutes."""
    if not binding:
        refuse_weak_motor(asked(**given), MOTOR, None)
        return
    with pytest.raises(MotorShortError) as caught:
        refuse_weak_motor(asked(**given), MOTOR, None)
    assert caught.value.binding == binding
    assert caught.value.most_ratio == ratio
    for words in said:
        assert words in caught.value.message


def test_what_of_a_motor_is_not_known_refuses_nothing():
    bare = replace(MOTOR, mass=None, rotor_inertia=None)
    refuse_weak_motor(asked(mass="50 g", reflected_inertia="1e-6 kg*m^2"), bare, None)


def test_no_actuator_is_lighter_than_its_motor():
    found = resolve(load_design(DESIGN)).inertia
    assert found.whole_mass > found.motor.mass
    assert found.reflected_input > found.motor.rotor_inertia


def test_a_torque_that_nobody_stated_is_lowered_and_not_refused():
    free = asked(peak_torque="120 N*m").deriving(PEAK)
    refuse_weak_motor(free, MOTOR, None)


def told(monkeypatch, given, verdict):
    """The refusal of a motor that is too weak, and what was searched for on the way."""
    tried = []
    real = nearest.searched

    def searched(hunt, stated):
        own = hunt.requirements
        tried.append((own.ratio, own.peak_torque, own.continuous_torque))
        if len(tried) == 1:
            return real(hunt, stated)
        assert hunt.tables.lobe_count == own.ratio
        answer = verdict(own)
        if isinstance(answer, Exception):
            raise answer
        design = SimpleNamespace(
            requirements=SimpleNamespace(
                peak_torque=own.peak_torque, continuous_torque=own.continuous_torque
            )
        )
        return SimpleNamespace(sizing=SimpleNamespace(design=design))

    monkeypatch.setattr(nearest, "searched", searched)
    with pytest.raises(SizingInfeasibleError) as caught:
        nearest.size_or_nearest(asked(**given))
    return caught.value, tried[1:]


def short(*lines):
    return SizingInfeasibleError("it does not fit.", binding=lines, most_torque=None)


def test_the_torque_and_the_least_ratio_that_fit_are_told(monkeypatch):
    given = {"peak_torque": "120 N*m", "continuous_torque": "7 N*m"}
    error, tried = told(
        monkeypatch, given, lambda own: short("MOTOR-PEAK") if 10 < own.ratio < 18 else None
    )
    assert error.message.endswith(
        "What fits, by the whole verdict: peak_torque 85.8 N*m with continuous_torque 7 N*m, "
        "or ratio 18."
    )
    assert error.to_dict()["ratio_needed"] == 18
    assert error.length_needed is None
    assert error.binding == ("MOTOR-PEAK",)
    # Raised again towards what the motor gives without any loss, 87.68 N m.
    raised = [(10, peak, 7.0) for peak in (74.3, 80.7, 84.1, 85.8)]
    assert tried == [(10, 63.0, 7.0), *raised, *((ratio, 120.0, 7.0) for ratio in (20, 19, 18, 17))]


def test_what_was_searched_for_in_vain_is_known(monkeypatch):
    given = {"peak_torque": "120 N*m", "continuous_torque": "7 N*m"}
    error, tried = told(
        monkeypatch, given, lambda own: short("YIELD") if own.peak_torque > 70.0 else None
    )
    vain = [(own.ratio, own.peak_torque, own.continuous_torque) for own in error.ways.in_vain]
    assert vain == [one for one in tried if one[1] > 70.0]
    assert vain


def test_a_ratio_at_which_the_motor_would_do_is_told_with_what_else_is_short(monkeypatch):
    given = {"peak_torque": "120 N*m", "continuous_torque": "11 N*m"}

    def verdict(own):
        if own.ratio > 10 or own.continuous_torque > 8.0:
            return short("SUPPORT-STATIC")
        return None

    error, tried = told(monkeypatch, given, verdict)
    assert error.to_dict()["ratio_needed"] is None
    # The continuous torque that is stated is kept first, and then not.
    assert tried[:2] == [(10, 63.0, 11.0), (10, 63.0, 7.5)]
    assert tried[-1] == (20, 120.0, 11.0)
    assert all(peak < 87.68 for _, peak, _ in tried[:-1])
    told_torques = re.search(
        r"peak_torque (\S+) N\*m with continuous_torque (\S+) N\*m. With", error.message
    )
    assert float(told_torques[1]) > 63.0
    assert 7.5 < float(told_torques[2]) <= 8.0
    assert "With ratio 20 it is still short of" in error.message
    assert "support bearings" in error.message


def test_no_space_and_no_torque_makes_a_motor_turn_faster(monkeypatch):
    error, tried = told(monkeypatch, {"input_speed": "3000 rpm"}, lambda own: None)
    assert tried == []
    assert error.message.endswith("or take another motor (--motor any tries all of the catalogue).")


def _duty(rows):
    """Requirements with steps of torque (N m) and speed (rpm) at the output."""
    steps = [{"torque": f"{t} N*m", "speed": f"{n} rpm", "share": 0.01} for t, n in rows]
    return asked(duty=steps)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([(87.0, 0.0), (-20.0, 30.0)], ()),
        # What brakes is held by friction too, and may be pulled faster than the supply turns it.
        ([(95.0, -10.0), (-95.0, 10.0), (-5.0, 400.0)], ()),
        ([(5.0, 10.0), (-120.0, -10.0)], ("are 87.68 of the duty's 120 N*m", "raise the ratio")),
        ([(90.0, 0.0)], ("are 87.68 of the duty's 90 N*m at ratio 10",)),
        ([(5.0, 300.0)], ("turn it at 2948 of the duty's 3000 rpm at most", "lower the ratio")),
    ],
)
def test_a_duty_beyond_the_motors_reach_is_refused_before_a_search(rows, said):
    requirements = _duty(rows)
    if not said:
        refuse_weak_motor(requirements, MOTOR, None)
        return
    with pytest.raises(MotorShortError) as refusal:
        refuse_weak_motor(requirements, MOTOR, None)
    assert refusal.value.binding == ("DUTY-ENVELOPE",)
    for words in said:
        assert words in refusal.value.message
    most = max((abs(t) for t, n in rows if t * n >= 0.0), default=0.0)
    assert refusal.value.needed == (most if most > 87.68 else 0.0)


def test_the_ratio_that_a_duty_needs_is_looked_for_from_where_it_is_driven():
    """By its own greatest torque: the peak torque is but a guess where a duty is stated."""
    hunt = SimpleNamespace(requirements=_duty([(120.0, 0.0)]), say=lambda _: None)
    with pytest.raises(MotorShortError) as refusal:
        refuse_weak_motor(hunt.requirements, MOTOR, None)
    tried = []

    def search(ratio):
        tried.append(ratio)
        return ratio >= 18, ("MOTOR-PEAK",)

    found = other_ratio(hunt, refusal.value, search)
    assert (found.ratio, found.tried) == (18, 20)
    assert tried == [20, 19, 18, 17]
