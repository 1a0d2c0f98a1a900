"""Joints that carry the torque: what loads them, and that layouts give them what they need."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.catalog.dowels import SHARE, across_a_joint, along_a_seam
from cqdd_design.design import load_design
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.dowels import loaded_dowels, ring_torque
from cqdd_design.results import Check
from cqdd_design.verdict.joint_lines import joint_lines

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGNS / "reference-s.toml"))


def lines_of(machine: Machine) -> dict[str, Check]:
    return {line.id: line for line in joint_lines(machine)}


@given(
    torque=st.floats(1.0, 500.0),
    count=st.integers(2, 12),
    diameter=st.floats(1e-3, 10e-3),
    length=st.floats(3e-3, 40e-3),
)
def test_dowels_hold_the_torque(torque: float, count: int, diameter: float, length: float) -> None:
    """Their forces times their radius give the torque back, of those that bear."""
    radius = 36e-3
    seam = along_a_seam(torque, count, radius, diameter, length)
    across = across_a_joint(torque, count, radius, diameter, length)
    bearing = SHARE * count * radius
    assert seam.pressure * 0.5 * diameter * length * bearing == pytest.approx(torque)
    assert seam.shear * diameter * length * bearing == pytest.approx(torque)
    assert across.pressure * diameter * length * bearing == pytest.approx(torque)
    assert across.shear * 0.25 * math.pi * diameter**2 * bearing == pytest.approx(torque)
    lone = across_a_joint(torque, 1, radius, diameter, length)
    assert lone.pressure * diameter * length * radius == pytest.approx(torque)


def test_the_ring_takes_the_torques_of_output_and_crank(machine: Machine) -> None:
    """T (1 + 1/n) without friction, more with it: the sum of all moments on the gearbox is zero."""
    asked, ratio = machine.design.requirements, machine.design.reducer.ratio
    found = ring_torque(machine)
    assert found > asked.peak_torque * (1.0 + 1.0 / ratio)
    assert found < asked.peak_torque * (1.0 + 2.0 / ratio)
    crank = np.abs(machine.peak_pack.torque.sum(axis=2)).max()
    assert found - asked.peak_torque == pytest.approx(crank)


def test_dowel_lines_follow_the_torque(machine: Machine) -> None:
    """Twice the torque on the same dowels is twice the stress; a far larger one fails."""
    one = lines_of(machine)
    assert one["DOWEL-SHEAR"].status == one["DOWEL-BEARING"].status == "pass"
    less = machine.changed({"requirements.peak_torque": "45 N*m"})
    vars(less)["layout"] = machine.layout
    half = lines_of(less)
    for name in ("DOWEL-SHEAR", "DOWEL-BEARING"):
        assert half[name].value == pytest.approx(0.5 * one[name].compared[0], rel=0.03)
    weak = replace(
        machine.layout, dowels=replace(machine.layout.dowels, angles=(0.0,), bearing_length=1e-3)
    )
    vars(less)["layout"] = weak
    assert lines_of(less)["DOWEL-BEARING"].status == "fail"
    none = replace(machine.layout, dowels=replace(machine.layout.dowels, radius=0.0))
    vars(less)["layout"] = none
    assert {line.status for line in joint_lines(less)} == {"unknown"}


@pytest.mark.parametrize("torque", [40.0, 60.0, 150.0])
def test_layouts_take_as_many_dowels_as_the_torque_asks_for(
    machine: Machine, torque: float
) -> None:
    """And none fewer would do by the layout's own rule, which is closer than the check's."""
    now = machine.changed({"requirements.peak_torque": torque})
    counts = len(now.layout.dowels.angles), now.layout.carrier.flange_dowels.count
    more = machine.changed({"requirements.peak_torque": 2.0 * torque})
    after = len(more.layout.dowels.angles), more.layout.carrier.flange_dowels.count
    assert all(b >= a for a, b in zip(counts, after, strict=True))
    assert len(set(np.round(now.layout.dowels.angles, 9))) == counts[0]
    assert [one.stress.pressure < one.seat.value for one in loaded_dowels(machine)] == [True, True]


def test_dowel_holes_are_drawn_in_the_outputs_face(machine: Machine) -> None:
    """Their volume is missing in the plate, and clear of the bolts beside them."""
    carrier = machine.layout.carrier
    plate = next(part for part in machine.parts if part.name == "carrier plate")
    face = plate.shape.layers[-1].shape
    dowels, bolts = carrier.flange_dowels, carrier.bolt_thread
    holes = [hole for hole in face.holes if hasattr(hole, "radius")]
    drawn = [one for one in holes if one.radius == pytest.approx(0.5 * dowels.diameter)]
    assert len(drawn) == dowels.count
    for one in drawn:
        centre = np.asarray(one.centre)
        assert np.hypot(*centre) == pytest.approx(carrier.bolt_circle_radius)
        apart = [np.hypot(*(centre - np.asarray(hole.centre))) for hole in holes if hole is not one]
        assert min(apart) > 0.5 * dowels.diameter + 0.5 * bolts
