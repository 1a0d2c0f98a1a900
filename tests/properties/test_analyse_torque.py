"""`analyse` at a torque: what follows it, and what stays that of the requirements."""

from pathlib import Path

import pytest

from cqdd_design.cli.analysis_text import analysis_lines
from cqdd_design.design import load_design
from cqdd_design.roads.analyse import ASKED, UNLOADED, Analysis, analyse

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
TORQUE = 25.0
DUTY = [{"torque": "12 N*m", "speed": "4 rad/s", "share": 0.5}]


def found(torque: float | None, **changes: object) -> Analysis:
    design = load_design(PAPER).replacing({f"requirements.{k}": v for k, v in changes.items()})
    return analyse(design, torque=torque, angles=8)


@pytest.fixture(scope="module")
def asked() -> Analysis:
    return found(TORQUE, duty=DUTY)


@pytest.fixture(scope="module")
def usual() -> Analysis:
    return found(None, duty=DUTY)


def test_every_section_says_what_it_stands_for(asked: Analysis, usual: Analysis) -> None:
    for one in (asked, usual):
        told = one.to_dict()
        sections = told["at"]["sections"]
        present = {key for key, value in told.items() if key != "at" and value is not None}
        assert set(sections) == present | {"checks"}
    assert asked.to_dict()["at"]["torque_Nm"] == TORQUE
    follow = {name for name, load in asked.at.items() if load == ASKED}
    assert follow == set(asked.at) - {"geometry", "balance", "shock", "checks"}
    assert {usual.at[name] for name in ("life", "wear", "heat")} == {"duty"}
    assert {usual.at[name] for name in ("geometry", "balance", "shock")} == {UNLOADED}
    assert usual.at["checks"] == asked.at["checks"] == "requirements"


@pytest.mark.deep
def test_sections_that_follow_are_those_of_a_design_with_that_torque(asked: Analysis) -> None:
    """Peak, continuous torque and duty all at the torque asked for: the same in every section."""
    design = load_design(PAPER)
    same = analyse(design.under_torque(TORQUE), angles=8).to_dict()
    told = asked.to_dict()
    for section, load in asked.at.items():
        if load in (ASKED, UNLOADED) and section != "shock":
            assert told[section] == same[section], section


def test_nothing_that_follows_stays_and_the_verdict_does(asked: Analysis, usual: Analysis) -> None:
    told, before = asked.to_dict(), usual.to_dict()
    for section, load in asked.at.items():
        if load == ASKED:
            assert told[section] != before[section], section
        elif load == UNLOADED:
            assert told[section] == before[section], section
    assert [line.to_dict() for line in asked.checks] == [line.to_dict() for line in usual.checks]
    assert told["life"]["duty"][0]["torque_Nm"] == TORQUE
    assert told["losses"]["torque_Nm"] == told["precision"]["torque_Nm"] == TORQUE


@pytest.mark.deep
def test_a_speed_moves_its_sections_and_not_the_verdict() -> None:
    """A design that fails at its own speed does not pass because it was looked at at another."""
    design = load_design(PAPER)
    usual = analyse(design, angles=8)
    slow = analyse(design, speed=20.0, angles=8)
    assert [line.to_dict() for line in slow.checks] == [line.to_dict() for line in usual.checks]
    assert slow.machine.given == design
    told, before = slow.to_dict(), usual.to_dict()
    assert told["at"]["speed_rpm"] == pytest.approx(20.0 * 30.0 / 3.141592653589793)
    assert before["at"]["speed_rpm"] is None
    same = analyse(design.turning_at(20.0), angles=8).to_dict()
    for section in slow.at:
        if section != "checks":
            assert told[section] == same[section], section
    assert told["losses"] != before["losses"]
    lines = " ".join(analysis_lines(slow))
    assert "and 191 rpm (--speed)" in lines
    assert "judged at the requirements, not at the speed asked for" in " ".join(lines.split())


@pytest.mark.deep
def test_torque_and_speed_together_are_both_told() -> None:
    both = analyse(load_design(PAPER), torque=TORQUE, speed=20.0, angles=8)
    same = analyse(load_design(PAPER).turning_at(20.0), torque=TORQUE, angles=8).to_dict()
    told = both.to_dict()
    for section, load in both.at.items():
        if load in (ASKED, UNLOADED):
            assert told[section] == same[section], section
    lines = " ".join(" ".join(analysis_lines(both)).split())
    assert "at 25 N*m (--torque) and 191 rpm (--speed)" in lines
    assert "not at the torque and speed asked for" in lines
