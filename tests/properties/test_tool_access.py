"""Keys reach screws at their step of the assembly, and what stands in their way is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.machine import Machine, resolve
from cqdd_design.roads.check import access_check
from cqdd_design.solids.apart import Step, taken_apart
from cqdd_design.solids.tool_access import GRIP, reaches

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGNS / "cqdd-10.toml"))


@pytest.fixture(scope="module")
def steps(machine: Machine) -> tuple[Step, ...]:
    return taken_apart(machine.design, machine.parts)[0]


def test_every_screw_is_turned_by_its_key(machine: Machine, steps: tuple[Step, ...]) -> None:
    found = {one.screw: one for one in reaches(machine.design, steps)}
    assert {name: round(1e3 * one.size, 6) for name, one in found.items()} == {
        "cover screw": 2.5,
        "motor cover screw": 2.5,
        "encoder screw": 1.5,
        "shoulder screw": 2.0,
    }
    assert all(one.reaches for one in found.values())
    # By hand: 58.5 mm of key from half the head of 3 mm, past the cover's hub.
    housing = machine.layout.housing
    floor = housing.cover_flange_top + 1.5e-3
    out = 58.5e-3 - (housing.cover_top - floor)
    assert found["cover screw"].spare == pytest.approx(out - GRIP, abs=1e-7)
    line = access_check(machine)
    assert line.status == "pass"
    assert line.value == 0.0


def test_screws_put_in_too_late_are_behind_the_housing(
    machine: Machine, steps: tuple[Step, ...]
) -> None:
    """The pins' heads look to the motor: once housing and bell are in place no key gets there."""
    late = next(one for one in steps if one.moved[0].part.name == "shoulder screw")
    others = [one for one in steps if one is not late]
    moved = [Step(late.moved, late.way), *others]
    found = {one.screw: one for one in reaches(machine.design, moved)}["shoulder screw"]
    assert not found.reaches
    assert {"housing", "rotor bell"} <= set(found.blocked_by)
    assert "is blocked by" in found.told


def test_a_deep_tunnel_leaves_no_room_for_a_hand(
    machine: Machine, steps: tuple[Step, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cqdd_design.solids.tool_access.GRIP", 53e-3)
    found = {one.screw: one for one in reaches(machine.design, steps)}
    assert not found["cover screw"].reaches
    assert found["cover screw"].blocked_by == ()
