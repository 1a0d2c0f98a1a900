"""How the actuator is fixed to another machine, and what gives way where its output is stopped."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import manifold3d
import numpy as np
import pytest

from cqdd_design.actuator.specimen import AS_DRAWN
from cqdd_design.design import load_design
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.machine.screws import screw_joints
from cqdd_design.solids.features.holes import ClearanceHole, TappedHole
from cqdd_design.solids.interference import posed_manifold
from cqdd_design.solids.mesh import FINE
from cqdd_design.solids.part import overall_size
from cqdd_design.verdict.asked import asked_lines
from cqdd_design.verdict.evidence import gather
from cqdd_design.verdict.headline import peak_torque
from cqdd_design.verdict.lines import lines_without_drawn, with_drawn

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@lru_cache
def drawn(name: str) -> Machine:
    return resolve(load_design(DESIGNS / f"{name}.toml"))


@pytest.mark.parametrize("name", ["cqdd-10", "reference-s", "printed-13"])
def test_a_screw_goes_in_from_the_output_and_ends_in_the_flange(name: str) -> None:
    """Of the longest that is told a cylinder meets nothing, its thread apart."""
    machine = drawn(name)
    housing, parts = machine.layout.housing, machine.parts
    (body,) = (part for part in parts if part.name == "housing")
    (thread,) = (f for f in body.features if f.name == "threads of the mounting")
    assert isinstance(thread, TappedHole)
    assert thread.through
    for other in ("ring clamp", "output cover"):
        (part,) = (one for one in parts if one.name == other)
        (hole,) = (f for f in part.features if f.name == "mounting holes")
        assert isinstance(hole, ClearanceHole)
        assert hole.diameter > housing.mount_thread
        assert hole.circle.angles == thread.circle.angles
    # As thick as the part that it holds, its head is beyond all of the machine there.
    top, radius = housing.cover_flange_top + 2.0 * housing.mount_thread, housing.bolt_circle_radius
    angle, size = thread.circle.angles[0], housing.mount_thread
    length = 1e3 * (top - housing.flange_bottom)
    screw = manifold3d.Manifold.cylinder(length, 499.0 * size, circular_segments=48).translate(
        [
            1e3 * radius * math.cos(angle),
            1e3 * radius * math.sin(angle),
            1e3 * housing.flange_bottom,
        ]
    )
    fixed = {"housing", "ring clamp", "output cover", "ring", "motor stator", "motor cover"}
    for part in (one for one in parts if one.name in fixed):
        for piece in part.instances:
            common = posed_manifold(part, piece.placement, FINE) ^ screw
            assert common.volume() < 1e-3, part.name
    assert housing.face - housing.flange_bottom >= size, "a diameter of thread holds it"


def test_the_sheet_says_how_long_they_are() -> None:
    machine = drawn("cqdd-10")
    housing = machine.layout.housing
    said = AssemblyFacts(machine).mounting()
    most = 1e3 * (housing.cover_flange_top - housing.flange_bottom)
    assert "8 screws M4 from the output's side" in said
    assert f"to {most:.3g} mm longer" in said


def test_the_sheet_says_what_it_is_built_into() -> None:
    """Circles of the screws on both sides, and the greatest sizes of all pieces as placed."""
    machine = drawn("cqdd-10")
    housing, carrier = machine.layout.housing, machine.layout.carrier
    (said,) = (one for one in AssemblyFacts(machine).notes() if one.startswith("Overall"))
    assert f"8 \u00d7 M4 on \u00d8{2e3 * housing.bolt_circle_radius:.4g}" in said
    assert f"output 6 \u00d7 M4 on \u00d8{2e3 * carrier.bolt_circle_radius:.4g}" in said
    motor = machine.motor
    assert motor.outer_diameter is not None
    # The can of the motor is the widest; its cover adds a wall to either side.
    wide = float(said.split("\u00d8")[1].split()[0])
    assert 1e3 * motor.outer_diameter < wide < 1e3 * motor.outer_diameter + 15.0


def test_a_joint_is_fixed_as_its_thread_bears_it() -> None:
    """Into 1 mm of aluminium a screw is not drawn as firmly as it could be."""
    machine = drawn("reference-s")
    joints = {one.place: one for one in screw_joints(machine)}
    fixed = joints["housing on its machine, by friction"]
    assert fixed.clamping.engaged == pytest.approx(
        machine.layout.housing.face - machine.layout.housing.flange_bottom
    )
    thin = replace(fixed, clamping=replace(fixed.clamping, engaged=1e-3))
    assert thin.slip_safety < 0.5 * fixed.slip_safety


@pytest.mark.deep
def test_a_stop_is_judged_by_all_that_gives_way() -> None:
    """Cover screws of M3 slip long before ring, pins and cam bearing are at their limits."""
    machine = drawn("reference-s").changed({"requirements.shock_speed": "1 rad/s"})
    evidence, plain = gather(machine, AS_DRAWN, lines_without_drawn, samples=0)
    lines = with_drawn(evidence, plain)
    (stop,) = (line for line in lines if line.id == "SHOCK-STOP")
    carried = carried_torque(machine).limits[0].torque
    assert stop.limit is not None
    assert stop.limit <= carried
    (alone,) = asked_lines(evidence)
    assert alone.limit == carried
    weak = machine.layout.housing.screw
    small = replace(
        machine.layout, housing=replace(machine.layout.housing, screw=replace(weak, thread=2e-3))
    )
    loose = replace(machine)
    vars(loose).update(vars(machine), layout=small)
    worse = replace(evidence, machine=loose)
    told = with_drawn(worse, lines_without_drawn(worse))
    (line,) = (one for one in told if one.id == "SHOCK-STOP")
    assert line.limit is not None
    assert line.limit < 0.7 * carried
    peak = peak_torque(worse, told)
    assert peak.value is None or peak.value <= line.limit * 1.01


@pytest.mark.parametrize("name", ["cqdd-10", "printed-13"])
def test_the_overall_diameter_is_that_of_the_solids(name: str) -> None:
    """The ears of the covers are arcs, whose middle is farther out than their ends."""
    machine = drawn(name)
    told, _ = overall_size(machine.parts)
    reach = 0.0
    for part in machine.parts:
        for piece in part.instances:
            mesh = posed_manifold(part, piece.placement, FINE).to_mesh().vert_properties
            reach = max(reach, float(np.hypot(mesh[:, 0], mesh[:, 1]).max()))
    assert 1e3 * told == pytest.approx(2.0 * reach, abs=0.02)
