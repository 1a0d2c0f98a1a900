"""Torques that remedies name are ones at which the line holds, by the models that judge it.

Forces of the contact equilibrium are not in proportion to the torque: where it is less, fewer teeth
and pins share it, so a torque by proportion leaves lines failing.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from cqdd_design.design import Design, load_design
from cqdd_design.machine import resolve
from cqdd_design.machine.carrying import torque_limits
from cqdd_design.results import Check
from cqdd_design.verdict.cures import torques_that_hold
from cqdd_design.verdict.lines import _carried

_LOWER = re.compile(r"lower the (continuous )?torque to ([\d.]+) N\*m")


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def failing(paper) -> dict[str, Check]:
    return {one.id: one for one in _carried(resolve(paper)).values() if one.status == "fail"}


@pytest.mark.parametrize(
    "check_id", ["CONTACT-PIN-PEAK", "PIN-BENDING-PEAK", "PIN-BENDING-CONTINUOUS", "BEARING-LIFE"]
)
def test_the_torque_that_a_remedy_names_is_held_and_little_more_is_not(paper, failing, check_id):
    continuous, told = _LOWER.search(failing[check_id].remedy).groups()
    for share, status in ((1.0, "pass"), (1.02, "fail")):
        torque = share * float(told)
        changes = {"requirements.continuous_torque": torque}
        if not continuous:
            changes["requirements.peak_torque"] = torque
        lines = _carried(resolve(paper.replacing(changes)))
        assert lines[check_id].status == status, share


def test_remedies_and_what_limits_the_torque_say_the_same(paper, failing):
    limits = {one.check: one.torque for one in torque_limits(resolve(paper), "peak")}
    told = {
        check_id: float(_LOWER.search(line.remedy)[2])
        for check_id, line in failing.items()
        if check_id in limits
    }
    assert len(told) == 5
    # Rounded down to three digits, and limits are looked for at a third of the angles.
    assert told == pytest.approx({one: limits[one] for one in told}, rel=8e-3)


def test_a_duty_has_no_continuous_torque_to_lower(paper):
    duty = [{"torque": 40.0, "speed": 13.0, "share": 1.0}]
    lines = _carried(resolve(paper.replacing({"requirements.duty": duty})))
    for check_id in ("CONTACT-RING-CONTINUOUS", "PIN-BENDING-CONTINUOUS", "BEARING-LIFE"):
        assert lines[check_id].status == "fail"
        assert "lower the torques of the duty" in lines[check_id].remedy
        assert "continuous torque" not in lines[check_id].remedy


def _line(of: Callable[[float], float], line: Check) -> Callable[[float], tuple[Check, ...]]:
    """A line whose value over its limit goes with the torque as `of`."""
    return lambda torque: (replace(line, value=of(torque) * line.limit),)


def test_a_line_that_fails_at_any_torque_has_none(failing):
    line = failing["PIN-SHEAR-PEAK"]
    at = _line(lambda torque: 1.5 + torque, line)
    assert torques_that_hold(at, 20.0, at(20.0)) == {line.id: 0.0}


@pytest.mark.parametrize("power", [0.1, 0.5, 3.0])
def test_a_power_law_is_followed_to_its_limit(failing, power):
    line = failing["PIN-SHEAR-PEAK"]
    at = _line(lambda torque: (torque / 7.0) ** power, line)
    (found,) = torques_that_hold(at, 120.0, at(120.0)).values()
    assert 7.0 * (1.0 - 2e-3) ** (1.0 / power) <= found <= 7.0
