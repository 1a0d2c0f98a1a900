"""A way through the middle: nothing closes it, and the encoder beside the shaft can read."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest
from legible import assert_legible

from cqdd_design.catalog.encoders import encoder_sensors
from cqdd_design.design import Design, load_design, requirements_from_mapping
from cqdd_design.design.templates import example_text
from cqdd_design.design.toml import design_of_text
from cqdd_design.errors import InfeasibleError
from cqdd_design.exporting.bill.fitting import fitting_notes
from cqdd_design.exporting.bill.substitutes import substitutes
from cqdd_design.exporting.sheets.canvas import render
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import draw_part
from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.machine import Machine, resolve
from cqdd_design.sizing import size
from cqdd_design.sizing.refusals import nothing
from cqdd_design.sizing.shafts import weak_lines
from cqdd_design.sizing.verified import new_hunt, size_to_verdict
from cqdd_design.solids.apart import taken_apart
from cqdd_design.solids.clearances import assembly_motion, output_revolution
from cqdd_design.solids.encoder_rules import (
    BESIDE,
    FROM_EDGE,
    RING_HEIGHT,
    RING_WALL,
    SENSOR_SIDE,
)
from cqdd_design.solids.mesh import DISPLAY
from cqdd_design.solids.motor_layout import MotorEnd
from cqdd_design.solids.motor_parts import encoder_parts
from cqdd_design.solids.retention import _enclosed
from cqdd_design.solids.tool_access import reaches
from cqdd_design.verdict.bore_line import bore_line
from cqdd_design.verdict.shaft_lines import shaft_lines

MACHINES: dict[str, dict[str, object]] = {
    "round the tube": {},
    "three discs": {
        "reducer.disc_count": 3,
        "reducer.disc_thickness": 0.006,
        "reducer.cam_bearing.designation": "6802",
    },
    "behind": {"reducer.ring.outer_diameter": "110 mm"},
    "inrunner": {"motor": {"name": "CubeMars RI50 KV100", "rotor_length": "18 mm"}},
    "not drawn": {"motor.name": "maxon EC-i 40 100 W"},
}
DRAWN = [name for name in MACHINES if name != "not drawn"]
BORE = "6 mm"


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def machines(paper: Design) -> dict[str, Machine]:
    asked = {"requirements.bore": BORE}
    return {name: resolve(paper.replacing(own | asked)) for name, own in MACHINES.items()}


def end_of(machine: Machine) -> MotorEnd:
    motor = machine.layout.motor_end
    assert motor is not None
    return motor


@pytest.mark.parametrize("name", MACHINES)
def test_nothing_stands_in_the_way(machines: dict[str, Machine], name: str) -> None:
    """Points within the bore are in no part, at any height and crank angle that matters."""
    machine = machines[name]
    line = bore_line(machine)
    assert line is not None
    assert line.status == "pass"
    radius = 0.5e-3 * line.value - 3e-6
    angles = 2.0 * math.pi * (np.arange(12) + 0.5) / 12
    points = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.vstack([points, [[0.0, 0.0]]])
    for part in machine.parts:
        for instance in part.instances:
            pose = instance.pose(machine.design, 0.7)
            # Poses turn about the axis, and turn parts over: their planes stay planes.
            own = (points - pose[:2, 3]) @ pose[:2, :2]
            for layer in part.shape.layers:
                assert not covers(layer.shape, own @ np.array([1.0, 1j])).any(), part.name


def covers(shape: PlanarPart, points: np.ndarray) -> np.ndarray:
    """Which points (N,), complex, a planar part covers."""

    def within(outline: Circle | ArcContour) -> np.ndarray:
        return _enclosed(outline.sample(1e-6) @ np.array([1.0, 1j]), points)

    found = within(shape.outer)
    for hole in shape.holes:
        found &= ~within(hole)
    return found


@pytest.mark.parametrize("name", DRAWN)
def test_it_is_held_and_goes_together(machines: dict[str, Machine], name: str) -> None:
    machine = machines[name]
    assert not [row.name for row in machine.retention if row.free]
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    assert all(key.reaches for key in reaches(machine.design, steps))


@pytest.mark.parametrize("name", DRAWN)
def test_the_sensor_stands_beside_the_ring_at_half_its_height(
    machines: dict[str, Machine], name: str
) -> None:
    machine = machines[name]
    motor, shaft = end_of(machine), machine.layout.shaft
    stub = 0.5 * shaft.support.bearing.bore_diameter
    assert motor.magnet_bottom == pytest.approx(shaft.bottom)
    assert stub < motor.magnet_inner < stub + 0.05e-3
    assert motor.board_inner - motor.magnet_radius <= 0.5e-3 + 1e-12
    middle = motor.magnet_bottom + 0.5 * motor.magnet_height
    assert 0.5 * (motor.board_top + motor.sensor_top) == pytest.approx(middle)
    # It turns clear of the dish below it, whose hole is no narrower than the shaft's.
    assert motor.magnet_bottom - motor.seat_bottom >= 0.75e-3
    assert motor.way > shaft.bore_radius
    parts = {part.name: part for part in machine.parts}
    assert parts["encoder board"].designation == "MPS MA732"
    assert "ring magnet" in parts["encoder magnet"].designation
    notes = fitting_notes(machine)
    assert "half the magnet's height" in notes["encoder board"]
    assert substitutes(machine, parts["encoder board"])[0] == "MPS MA600"
    places = {one.name: one.place for one in encoder_sensors()}
    assert places["MPS MA732"] == "side"


@pytest.mark.parametrize("name", ["round the tube", "inrunner"])
def test_its_sheets_can_be_read(machines: dict[str, Machine], name: str) -> None:
    machine = machines[name]
    holes = {
        "motor cover": end_of(machine).way,
        "eccentric shaft": machine.layout.shaft.bore_radius,
    }
    for part in machine.parts:
        if part.name in holes:
            sheet = render(draw_part(PartFacts(part, machine.given)))
            assert_legible(sheet)
            # A shaft that just lets through what was asked for may not be bored any smaller.
            limits = " (+0.1/0)" if part.name == "eccentric shaft" else ""
            told = {label.text for label in sheet.labels}
            assert f"Ø{2e3 * holes[part.name]:g}{limits}" in told


@pytest.mark.deep
@pytest.mark.parametrize("name", DRAWN)
def test_it_runs_free(machines: dict[str, Machine], name: str) -> None:
    machine = machines[name]
    angles = output_revolution(machine.design, 1)
    motion = assembly_motion(machine.design, machine.parts, angles, DISPLAY)
    assert motion.collisions == ()


def test_without_a_bore_the_encoder_is_under_the_shaft(paper: Design) -> None:
    motor = end_of(resolve(paper))
    assert not motor.open
    assert motor.board_inner == motor.way == 0.0
    assert bore_line(resolve(paper)) is None


def test_a_hole_is_as_large_as_asked_while_a_wall_is_left(paper: Design) -> None:
    """On its 10 mm journals: 5 mm is drawn at least, 7.5 mm at the most."""
    found = {}
    for wanted in ("3 mm", "5.5 mm", "7.5 mm", "8 mm"):
        machine = resolve(paper.replacing({"requirements.bore": wanted}))
        line = bore_line(machine)
        assert line is not None
        found[wanted] = (line.value, line.status)
        weak = {one.id for one in weak_lines(machine)}
        assert ("BORE" in weak) == (line.status == "fail")
    assert found == {
        "3 mm": (pytest.approx(5.0), "pass"),
        "5.5 mm": (pytest.approx(5.5), "pass"),
        "7.5 mm": (pytest.approx(7.5), "pass"),
        "8 mm": (pytest.approx(7.5), "fail"),
    }


def test_a_bore_that_is_too_small_names_the_cam_bearing_that_leaves_it(paper: Design) -> None:
    """The smallest that does; and how wide the widest leaves it where none does."""
    line = bore_line(resolve(paper.replacing({"requirements.bore": "8 mm"})))
    assert line is not None
    named = re.search(
        r"cam_bearing\.designation to '(\w+)', which leaves .* of (\S+) mm", line.remedy
    )
    assert named
    wide = paper.replacing(
        {"requirements.bore": "8 mm", "reducer.cam_bearing.designation": named[1]}
    )
    found = bore_line(resolve(wide))
    assert found is not None
    assert (found.status, found.value) == ("pass", pytest.approx(float(named[2])))
    none = bore_line(resolve(paper.replacing({"requirements.bore": "13 mm"})))
    assert none is not None
    assert "no cam bearing that fits this disc leaves a hole of more than 12 mm" in none.remedy
    assert "as '6704' does" in none.remedy
    # What it says to ask for passes as it is.
    told = re.search(r"lower requirements\.bore to (\S+ mm), which this one leaves", none.remedy)
    assert told
    less = bore_line(resolve(paper.replacing({"requirements.bore": told[1]})))
    assert less is not None
    assert less.status == "pass"
    most = paper.replacing(
        {"requirements.bore": "12 mm", "reducer.cam_bearing.designation": "6704"}
    )
    reached = bore_line(resolve(most))
    assert reached is not None
    assert reached.status == "pass"


def test_a_wider_hole_is_judged_by_the_shafts_own_lines(paper: Design) -> None:
    """By the stress at its undercuts, which grows as the tube's second moment of area shrinks."""
    stress = {}
    for wanted in ("5 mm", "7 mm"):
        machine = resolve(paper.replacing({"requirements.bore": wanted}))
        (line,) = (one for one in shaft_lines(machine) if one.id == "SHAFT-FATIGUE")
        assert line.value is not None
        stress[wanted] = line.value
    solid, hollow = 10.0**4 - 5.0**4, 10.0**4 - 7.0**4
    assert 1.02 < stress["7 mm"] / stress["5 mm"] < 1.1 * solid / hollow


def field_at(stub: float, at: float) -> tuple[float, float]:
    """Along and across a ring magnet's own direction, T, by the charges of its faces.

    Of a ring of N35 magnetised across; shaft of no permeability. A permeable one changes nothing
    in the plane: with phi = 0 at r = a the field outside is that of (b^2 - a^2)/2 as without it.
    """
    outer = stub + RING_WALL
    angle = (np.arange(720) + 0.5) * 2.0 * math.pi / 720
    height = ((np.arange(80) + 0.5) / 80 - 0.5) * RING_HEIGHT
    angle, height = np.meshgrid(angle, height)
    found = []
    for point in ((at, 0.0), (0.0, at)):
        field = np.zeros(2)
        for radius, sign in ((outer, 1.0), (stub, -1.0)):
            charge = 1.17 * sign * np.cos(angle) * radius * 2 * math.pi / 720 * RING_HEIGHT / 80
            across = point[0] - radius * np.cos(angle), point[1] - radius * np.sin(angle)
            cubed = (across[0] ** 2 + across[1] ** 2 + height**2) ** 1.5
            field += [np.sum(charge * one / cubed) / (4.0 * math.pi) for one in across]
        found.append(math.hypot(*field))
    return found[0], found[1]


@pytest.mark.parametrize("stub", [2e-3, 4e-3, 5e-3, 7.5e-3, 10e-3, 12e-3])
def test_the_ring_magnet_is_read_on_every_usual_stub(stub: float) -> None:
    """Between the field that MagAlpha sensors ask for and the most that they bear, in any turn."""
    most, least = field_at(stub, stub + RING_WALL + BESIDE + FROM_EDGE + 0.5 * SENSOR_SIDE)
    assert most <= 0.150
    assert least >= 0.030


def test_the_field_is_that_of_a_dipole_far_away() -> None:
    """The integral of the test itself: m = Br V/mu0, twice the field along it as across."""
    ring = math.pi * ((5e-3 + RING_WALL) ** 2 - 5e-3**2) * RING_HEIGHT
    dipole = 1.17 * ring / (4.0 * math.pi * 0.5**3)
    assert field_at(5e-3, 0.5) == pytest.approx((2.0 * dipole, dipole), rel=1e-3)


@pytest.mark.deep
def test_sizing_finds_a_shaft_for_a_wide_bore() -> None:
    """A wider cam bearing where the lightest leaves no room for it."""
    asked = {
        "ratio": 10,
        "peak_torque": "25 N*m",
        "continuous_torque": "3 N*m",
        "continuous_speed": "300 rpm",
    }
    found = size_to_verdict(requirements_from_mapping(asked | {"bore": "9 mm"}))
    assert found.verdict.meets == "yes"
    machine = found.verdict.evidence.machine
    # What closed forms make of it without a bore: lighter, and with less of a way through.
    plain = size(requirements_from_mapping(asked))
    holes = [2e3 * one.layout.shaft.bore_radius for one in (plain.machine, machine)]
    assert holes[0] < 9.0 - 1e-6 <= holes[1]
    assert found.sizing.objective.mass >= plain.objective.mass * 0.99


def test_the_examples_keep_their_shafts() -> None:
    """What nobody asked to be hollow has a magnet on its axis."""
    for name in ("cqdd-10", "reference-s"):
        machine = resolve(design_of_text(example_text(name), Path(name)))
        assert dataclasses.asdict(end_of(machine))["way"] == 0.0


def test_a_refusal_names_the_bore_beside_torque_and_space() -> None:
    """Wide cam bearings alone are tried for a wide hole, and leave little of the discs."""
    asked = {"ratio": 10, "peak_torque": "30 N*m", "continuous_torque": "5 N*m"}
    for bore, named in (({}, False), ({"bore": "20 mm"}, True)):
        hunt = new_hunt(requirements_from_mapping(asked | bore), print, None, None, "mass")
        assert ("ask for a smaller bore" in nothing(hunt).message) == named
    for wide, told in (
        ("40 mm", "or ask for a smaller bore"),
        ("70 mm", "requirements.bore 70 mm"),
    ):
        with pytest.raises(InfeasibleError, match=told):
            size_to_verdict(requirements_from_mapping(asked | {"bore": wide}))


def test_an_encoder_s_magnet_is_of_what_its_designation_says(machines: dict[str, Machine]) -> None:
    for machine in (machines[name] for name in DRAWN):
        magnet, *_ = encoder_parts(machine.design, end_of(machine), "Alloy steel 12.9 (ISO 7379)")
        assert magnet.material == "NdFeB N35H"
        assert magnet.material in magnet.designation
