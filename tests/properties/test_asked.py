"""Lines of what people ask for beyond torque and life: only where asked, by the models' figures."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.operating import judge as judge_point
from cqdd_design.actuator.shock import simulated_torque
from cqdd_design.design import load_design
from cqdd_design.gearbox.checks.guide_asked import ROWS
from cqdd_design.gearbox.precision.precision import precision
from cqdd_design.gearbox.tolerance.evaluate import OUTPUTS
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.machine.heat_nodes import by_node
from cqdd_design.results import Check
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.asked import asked_lines
from cqdd_design.verdict.drawn import good_gearboxes
from cqdd_design.verdict.headline import headline
from cqdd_design.verdict.reached import standing_torque

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
ARCMIN = 180.0 * 60.0 / math.pi
ASKED = {
    "speed_at_peak": "6 rad/s",
    "shock_speed": "3 rad/s",
    "bore": "4 mm",
    "mass": "1.5 kg",
    "reflected_inertia": "0.1 kg*m^2",
    "backlash": "6 arcmin",
    "lost_motion": "9 arcmin",
    "stiffness": "2 N*m/arcmin",
    "efficiency": 0.6,
    "surface_temperature": "60 degC",
}


def under(**asked: object) -> Machine:
    design = load_design(DESIGNS / "reference-s.toml")
    torques = {"peak_torque": 50.0, "continuous_torque": 14.0}
    return resolve(design.replacing({f"requirements.{k}": v for k, v in (torques | asked).items()}))


@pytest.fixture(scope="module")
def judged() -> Verdict:
    return judge(under(**ASKED), samples=24)


@pytest.fixture(scope="module")
def lines(judged: Verdict) -> dict[str, Check]:
    return {line.id: line for line in judged.lines}


def test_what_is_not_asked_for_has_no_line(judged: Verdict) -> None:
    asked = {line.id for line in asked_lines(judged.evidence)}
    assert asked == {row.id for row in ROWS}
    silent = replace(judged.evidence, machine=under())
    assert asked_lines(silent) == ()
    figures = {one.id: one for one in headline(silent, judged.lines[: -len(ROWS)], judged.peak)}
    for name in ("backlash_p95", "efficiency", "mass"):
        assert figures[name].required is None


def test_figures_of_the_first_screen_and_their_lines_agree(
    judged: Verdict, lines: dict[str, Check]
) -> None:
    for figure in judged.headline:
        line = {"backlash_p95": "BACKLASH", "efficiency": "EFFICIENCY", "mass": "MASS"}.get(
            figure.id
        )
        if line is not None:
            told = lines[line]
            assert (figure.value, figure.required, figure.status) == (
                told.value,
                told.limit,
                told.status,
            )


def test_no_reflected_inertia_is_known_of_a_motor_without_one(judged: Verdict) -> None:
    """A rotor's share of the motor's mass draws it, and says nothing of its inertia."""
    machine = judged.evidence.machine
    lacking = replace(machine, motor=replace(machine.motor, rotor_inertia=None))
    assert lacking.inertia.rotor_drawn > 0.0
    lines = asked_lines(replace(judged.evidence, machine=lacking))
    line = next(one for one in lines if one.id == "REFLECTED-INERTIA")
    assert (line.status, line.value) == ("unknown", None)


def test_limits_are_those_asked_for(lines: dict[str, Check]) -> None:
    wanted = {
        "BACKLASH": 6.0,
        "LOST-MOTION": 9.0,
        "STIFFNESS": 2.0,
        "EFFICIENCY": 0.6,
        "MASS": 1.5,
        "REFLECTED-INERTIA": 0.1,
        "SURFACE-TEMPERATURE": 60.0,
        "BORE": 4.0,
        "PEAK-AT-SPEED": 50.0,
    }
    assert {name: lines[name].limit for name in wanted} == pytest.approx(wanted)


def test_values_are_those_of_their_models(judged: Verdict, lines: dict[str, Check]) -> None:
    machine, found = judged.evidence.machine, judged.evidence
    assert found.actuator is not None
    assert found.drawn is not None
    assert found.temperatures is not None
    exact = precision(machine.contact, 14.0, angles=96)
    drawn = found.drawn.continuous.values
    at = by_node(found.temperatures.steady)
    point = judge_point(found.actuator, 50.0, 6.0, lasting=False, hot=False)
    values = {
        "LOST-MOTION": exact.lost_motion * ARCMIN,
        "BACKLASH": np.percentile(drawn[:, OUTPUTS.index("backlash_arcmin")], 95),
        "STIFFNESS": np.percentile(drawn[:, OUTPUTS.index("stiffness_Nm_per_arcmin")], 5),
        "MASS": machine.inertia.mass,
        "REFLECTED-INERTIA": 100.0 * machine.inertia.reflected_input,
        "SURFACE-TEMPERATURE": max(at["housing"], at["cover"]),
        "PEAK-AT-SPEED": point.most,
        "SHOCK-STOP": simulated_torque(found.actuator, 3.0),
    }
    for name, value in values.items():
        assert lines[name].value == pytest.approx(value, rel=0.02), name
    carried = carried_torque(machine).limits[0].torque
    # Seats of the output pins in aluminium give way before.
    stood = standing_torque(found, judged.lines, carried)
    assert stood is not None
    assert lines["SHOCK-STOP"].limit == stood[0] < carried
    assert stood[1].startswith(lines["DOWEL-BEARING"].title)
    assert lines["BORE"].value == pytest.approx(2e3 * machine.layout.shaft.bore_radius)
    assert lines["BORE"].status == "pass"


def test_lost_motion_is_never_less_than_the_backlash_of_the_gearboxes(judged: Verdict) -> None:
    """Of perfect parts where they have more play; of drawn ones, with the same give, where not."""
    drawn = judged.evidence.drawn
    assert drawn is not None
    perfect = precision(judged.evidence.machine.contact, 14.0, angles=96)
    for more in (-60.0, 60.0):
        values = drawn.continuous.values.copy()
        values[:, OUTPUTS.index("backlash_arcmin")] += more
        loose = drawn._replace(continuous=replace(drawn.continuous, values=values))
        there = {one.id: one for one in asked_lines(replace(judged.evidence, drawn=loose))}
        play = max(there["BACKLASH"].value or 0.0, perfect.free.mean * ARCMIN)
        give = (perfect.lost_motion - perfect.free.mean) * ARCMIN
        assert there["LOST-MOTION"].value == pytest.approx(play + give)
        assert ("perfect" in there["LOST-MOTION"].substituted) == (more < 0.0)


def test_remedies_name_what_would_pass(judged: Verdict) -> None:
    asked = {"efficiency": 0.999, "surface_temperature": 26.0}
    machine = under(**ASKED | asked)
    there = {one.id: one for one in asked_lines(replace(judged.evidence, machine=machine))}
    hot, poor = there["SURFACE-TEMPERATURE"], there["EFFICIENCY"]
    assert hot.status == poor.status == "fail"
    assert hot.value is not None
    assert poor.value is not None
    told = re.search(r"surface_temperature of ([\d.]+) degC", hot.remedy)
    assert told
    assert hot.value <= float(told[1]) < 1.01 * hot.value
    told = re.search(r"efficiency of ([\d.]+)", poor.remedy)
    assert told
    assert 0.99 * poor.value < float(told[1]) <= poor.value


def test_senses_are_right(judged: Verdict) -> None:
    """Twice and half of what there is: at most for what should be small, at least for the rest."""
    there = {line.id: line for line in asked_lines(judged.evidence)}
    least = {"STIFFNESS", "EFFICIENCY", "BORE", "PEAK-AT-SPEED"}
    for name, line in there.items():
        assert line.sense == ("min" if name in least else "max"), name


def test_what_is_not_known_is_unknown(judged: Verdict) -> None:
    blind = replace(
        judged.evidence, actuator=None, actuator_missing="no motor", temperatures=None,
        heat_missing="no network", drawn=None, drawn_missing="none drawn",
    )  # fmt: skip
    found = {line.id: line for line in asked_lines(blind)}
    for name in ("PEAK-AT-SPEED", "SHOCK-STOP", "BACKLASH", "STIFFNESS", "SURFACE-TEMPERATURE"):
        assert found[name].status == "unknown", name
        assert found[name].substituted in {"no motor", "no network", "none drawn"}


def test_gearboxes_count_where_backlash_and_stiffness_are_those_asked_for(judged: Verdict) -> None:
    drawn = judged.evidence.drawn
    assert drawn is not None
    values, numbers = drawn.continuous.values, drawn.continuous.numbers
    play = values[:, OUTPUTS.index("backlash_arcmin")]
    stiff = values[:, OUTPUTS.index("stiffness_Nm_per_arcmin")]
    middle, firm = float(np.median(play)), float(np.median(stiff))
    for asked, column, worse in (
        ({"backlash": middle / ARCMIN}, "backlash", play > middle),
        ({"stiffness": firm * ARCMIN}, "stiffness", stiff < firm),
    ):
        found = good_gearboxes(under(**asked), drawn, judged.lines)
        assert found is not None
        good, fails = found
        assert fails[column] == worse.sum()
        assert not set(good) & set(numbers[worse])
