"""Clearances through the motion: known gaps, wrong phases, seats."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from solids_designs import known_design, known_parts, part_named

from cqdd_design.geometry.columns import column_clearance
from cqdd_design.machine import resolve
from cqdd_design.roads.check import assembly_check
from cqdd_design.solids.clearances import SEARCH, AssemblyMotion, assembly_motion, output_revolution
from cqdd_design.solids.layers import Annulus, turned
from cqdd_design.solids.mesh import DISPLAY
from cqdd_design.solids.motor_parts import piece
from cqdd_design.solids.part import Instance, Part
from cqdd_design.solids.poses import transform

ANGLES = output_revolution(known_design("paper"), 5)
TRAIN = ("disc", "ring", "shoulder screw", "cam bearing", "eccentric shaft", "carrier plate")


def train() -> tuple[Part, ...]:
    return tuple(part_named(known_parts("paper"), name) for name in TRAIN)


@pytest.fixture(scope="module")
def motion() -> AssemblyMotion:
    return assembly_motion(known_design("paper"), train(), ANGLES)


def gap(motion: AssemblyMotion, first: str, second: str) -> float:
    return next(one.gap for one in motion.clearances if {one.first, one.second} == {first, second})


def test_the_angles_go_once_round_the_output() -> None:
    angles = output_revolution(known_design("paper"), 72)
    assert len(angles) == 72
    assert np.ptp(angles) == pytest.approx(2.0 * math.pi * 10 * 71 / 72)


@pytest.mark.deep
def test_gaps_are_those_of_the_design(motion: AssemblyMotion) -> None:
    assert motion.collisions == ()
    # 6 um at the teeth, half of 16 um in the holes, 0.5 mm beside the discs; facets take some.
    assert gap(motion, "disc", "ring") == pytest.approx(6e-6, abs=1.5e-6)
    assert gap(motion, "disc", "shoulder screw") == pytest.approx(8e-6, abs=1.5e-6)
    assert gap(motion, "disc", "carrier plate") == pytest.approx(0.5e-3, abs=1e-9)
    assert gap(motion, "disc", "disc") == pytest.approx(0.5e-3, abs=1e-9)
    assert all(one.gap < SEARCH for one in motion.clearances)
    assert {"eccentric shaft", "cam bearing"} in [set(pair) for pair in motion.seats]


@pytest.mark.deep
def test_columns_keep_their_distance_from_the_discs_all_the_way_round() -> None:
    design, parts = known_design("columns"), known_parts("columns")
    pieces = tuple(part_named(parts, name) for name in ("disc", "carrier column"))
    angles = output_revolution(design, 12)
    found = assembly_motion(design, pieces, angles, DISPLAY)
    assert found.collisions == ()
    (one,) = (c for c in found.clearances if "carrier column" in {c.first, c.second})
    half = 0.5 * column_clearance(design.reducer)
    assert one.gap == pytest.approx(half, abs=one.slack)
    assert half > 0.1e-3


@pytest.mark.parametrize(
    ("more", "collides"), [(0.0, False), (1.6e-6, True), (4e-6, True), (-2e-6, False)]
)
def test_an_overlap_of_two_micrometres_is_told_from_a_fit(more: float, collides: bool) -> None:
    """Facets of parts of 20 and 30 mm explain 2.75 um; those that do shrink when they are finer."""
    grey = (0.5, 0.5, 0.5)
    tube = turned([Annulus(0.0, 10e-3, 20e-3, 30e-3)])
    plug = turned([Annulus(2e-3, 8e-3, 5e-3, 20e-3 + more)])
    parts = [
        piece("tube", tube, "7075-T6", grey, "turned"),
        piece("plug", plug, "7075-T6", grey, "turned"),
    ]
    motion = assembly_motion(known_design("paper"), parts, np.zeros(1))
    assert bool(motion.collisions) is collides
    if more > 0.0:
        (one,) = motion.collisions
        assert one.thickness == pytest.approx(more, rel=0.2)


@pytest.mark.deep
def test_a_sound_machine_passes_its_check(motion: AssemblyMotion) -> None:
    check = assembly_check(motion)
    assert (check.id, check.status, check.value) == ("ASSEMBLY-CLEAR", "pass", 0.0)
    told = motion.to_dict()
    assert told["crank_angles"] == 5
    assert told["collisions"] == []


def test_a_disc_in_the_wrong_phase_fails_it() -> None:
    disc, *others = train()
    first, second = disc.instances
    out = Instance(second.name, second.body, transform(math.pi / 10.0) @ second.placement)
    wrong = dataclasses.replace(disc, instances=(first, out))
    motion = assembly_motion(known_design("paper"), (wrong, *others), ANGLES[:2], DISPLAY)
    check = assembly_check(motion)
    assert check.status == "fail"
    assert "disc 2" in check.remedy
    assert {"disc 2"} <= {motion.collisions[0].first, motion.collisions[0].second}


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    disc = part_named(known_parts("paper"), "disc")
    assembly_motion(
        known_design("paper"), (disc,), ANGLES[:2], DISPLAY, lambda *done: told.append(done)
    )
    assert told == [(1, 2), (2, 2)]


def test_facets_beside_half_grooves_are_no_overlap() -> None:
    """Of coarse meshes they leave a third in a closer look, not the quarter that others do."""
    grooved = known_design("paper").replacing(
        {"reducer.ring.outer_diameter": "135 mm", "reducer.ring_type": "pinwheel",
         "reducer.ring_pitch_radius": "58 mm", "reducer.ring_pin_diameter": "9 mm"}
    )  # fmt: skip
    parts = [part for part in resolve(grooved).parts if part.name in ("ring", "housing")]
    motion = assembly_motion(grooved, parts, np.zeros(1), DISPLAY)
    assert motion.pairs == 1
    assert motion.collisions == ()
