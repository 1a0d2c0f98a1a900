"""Keys reach screws at their step of the assembly, and what stands in their way is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from manifold3d import CrossSection

from cqdd_design.catalog.hex_keys import hex_key
from cqdd_design.design import load_design
from cqdd_design.machine import Machine, resolve
from cqdd_design.solids.apart import Step, taken_apart
from cqdd_design.solids.tool_access import GRIP, _swings, reaches
from cqdd_design.verdict.screw_lines import screw_lines

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
    line = screw_lines(machine)[-1]
    assert line.id == "SCREW-TOOL-ACCESS"
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
    deep = found["cover screw"]
    assert deep.spare < 0.0
    assert deep.blocked_by == ()
    # The hub of the cover is 5.6 mm above its flange: the short arm, 20.5 mm, stands out of it.
    assert deep.bent
    assert deep.reaches
    assert deep.told == "key 2.5 mm of the cover screw turns by its long arm"


@pytest.mark.parametrize(("opening", "turns"), [(0.0, False), (55.0, False), (95.0, True)])
def test_a_bent_key_turns_where_a_sixth_of_a_turn_is_open(opening: float, turns: bool) -> None:
    """A wall about the screw, open over an angle: the arm needs 60 degrees and its own width."""
    wall = CrossSection.circle(20.0, 96) - CrossSection.circle(8.0, 96)
    if opening:
        edge = np.radians(np.linspace(100.0, 100.0 + opening, 33))
        fan = np.vstack([[0.0, 0.0], 30.0 * np.column_stack([np.cos(edge), np.sin(edge)])])
        wall -= CrossSection([fan])
    at = (30e-3, -10e-3)
    moved = wall.translate((30.0, -10.0))
    assert _swings(hex_key(2.5e-3), [at], [moved]) is turns
    # And nowhere else does anything stand.
    assert _swings(hex_key(2.5e-3), [(-60e-3, 60e-3)], [moved])
