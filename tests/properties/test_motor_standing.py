"""Where the motor stands is told with the room that the other places lack."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cqdd_design.catalog import bearings, motors
from cqdd_design.design import Design, load_design
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.gearbox.checks.allowables import LIGAMENT, RING_WALL
from cqdd_design.geometry.contours import Circle
from cqdd_design.geometry.scale import largest_ring, millimetre_unit, ring_within_rotor
from cqdd_design.machine import resolve
from cqdd_design.machine.motor_standing import motor_standing, room_round_motor
from cqdd_design.machine.set_heights import set_heights
from cqdd_design.solids.features.holes import PlainHole
from cqdd_design.solids.motor_rules import undrawn_sizes
from cqdd_design.solids.stations import stations

LEAST_RING, MOST_RING = 45e-3, 150e-3


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


def test_no_inrunner_that_is_drawn_has_room_for_a_gearbox_or_goes_into_one() -> None:
    """Rings of 45 to 150 mm: the rotor's bore is too narrow, the motor too wide for a cam."""
    drawn = [one for one in motors().values() if one.is_inrunner and not undrawn_sizes(one)]
    assert len(drawn) >= 2
    unit, eccentricity = millimetre_unit(MOST_RING), 1e-3
    balls = [one for one in bearings().values() if one.kind == "ball"]
    # Outside the cam bearing: ligament, hole of a 3 mm pin, ligament, lobes' swing, ring.
    outside = LIGAMENT + 3e-3 + 2.0 * eccentricity + LIGAMENT + 2.0 * eccentricity + RING_WALL
    for motor in drawn:
        assert ring_within_rotor(motor.hollow_diameter) < LEAST_RING, motor.name
        bore = room_round_motor(motor.outer_diameter, eccentricity, unit)
        cam = min(one.outer_diameter for one in balls if one.bore_diameter >= bore)
        assert cam + 2.0 * outside > MOST_RING, motor.name
    # A little more would do: the test can fail.
    assert ring_within_rotor(51e-3) > LEAST_RING
    assert ring_within_rotor(51e-3) < largest_ring(51e-3)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({}, "stands round the gearbox, whose housing fills its stator's bore of 74 mm."),
        (
            {"reducer.ring.outer_diameter": "110 mm"},
            "into its stator's bore of 74 mm go rings of 55.5 to 72 mm with their housing, and "
            "this one has 110 mm.",
        ),
        (
            {"motor": {"name": "CubeMars RI100 KV105"}},
            "stands behind the gearbox. Into its rotor's bore of 45 mm goes a ring of 40.5 mm at "
            "most with its housing and the rotor's sleeve, and this one has 72 mm. To hold its "
            "104 mm inside, the eccentric shaft asks for a cam bearing with a bore of 116.4 mm, "
            "and this one's has 15 mm.",
        ),
        ({"motor": {"name": "CubeMars R100 KV90"}}, "is not drawn: the stator bore"),
    ],
)
def test_every_machine_says_where_its_motor_stands(
    paper: Design, change: dict[str, object], expected: str
) -> None:
    machine = resolve(paper.replacing(change))
    told = motor_standing(machine)
    assert expected in told
    assert told.startswith(machine.motor.name)
    assert told in AssemblyFacts(machine).notes()


def test_room_that_is_not_used_is_told(paper: Design) -> None:
    """Of a motor of the user's own, wide enough to take the gearbox in."""
    own = {
        "name": "CubeMars RI100 KV105", "hollow_diameter": "90 mm", "gap_diameter": "100 mm",
        "outer_diameter": "130 mm",
    }  # fmt: skip
    machine = resolve(paper.replacing({"motor": own}))
    assert machine.layout.inrunner is not None
    assert "this one would, and the machine be shorter, but that is not drawn." in motor_standing(
        machine
    )


@pytest.mark.parametrize(
    ("change", "carrier"),
    [({}, "rotor bell"), ({"motor": {"name": "CubeMars RI100 KV105"}}, "rotor hub")],
)
def test_rotor_and_magnet_are_set_from_a_face_that_both_sheets_have(
    paper: Design, change: dict[str, object], carrier: str
) -> None:
    machine = resolve(paper.replacing(change))
    motor, parts = machine.layout.motor_end, {one.name: one for one in machine.parts}
    assert motor is not None
    # The face between the two, as the parts that meet there are drawn.
    face = parts["motor cover"].shape.top
    assert motor.joint == pytest.approx(face)
    rotor, encoder = set_heights(machine)
    hub = 1e3 * (face - parts[carrier].shape.bottom)
    assert f"No shoulder places the {carrier} on the shaft." in rotor
    assert f"its hub's lower face {hub:.4g} \u00b10.1 mm from" in rotor
    numbers = [float(one) for one in re.findall(r"([0-9.]+) mm as drawn", encoder)]
    spans = {one.name: one.spans for one in stations(machine.parts)}
    sensor = max(span.top for span in spans["encoder board"])
    magnet = min(span.bottom for span in spans["encoder magnet"])
    ways = [1e3 * (face - sensor), 1e3 * (face - magnet)]
    assert numbers == pytest.approx([*ways, ways[0] - ways[1]], abs=0.01)
    assert "has to leave 0.5 to 1.8 mm for the ams AS5047P, 1 mm as drawn." in encoder
    notes = AssemblyFacts(machine).notes()
    assert rotor in notes
    assert encoder in notes


def test_a_motor_that_is_not_drawn_has_nothing_to_set(paper: Design) -> None:
    assert set_heights(resolve(paper.replacing({"motor": {"name": "CubeMars R100 KV90"}}))) == []


def test_a_gap_that_is_stated_for_another_magnet_is_said_to_be(paper: Design) -> None:
    """6 x 2.5 mm is what the sensor is made for; a thinner stub takes 4 x 2."""
    assert "That gap is for a magnet" not in set_heights(resolve(paper))[1]
    path = Path(__file__).resolve().parents[2] / "designs" / "printed-13.toml"
    said = set_heights(resolve(load_design(path)))[1]
    assert "for a magnet of 6 mm x 2.5 mm, this one is 4 mm x 2 mm: let the field" in said


def test_the_bearing_nut_is_tightened_and_locked(paper: Design) -> None:
    machine = resolve(paper)
    (said,) = (one for one in AssemblyFacts(machine).notes() if one.startswith("Bearing nut"))
    assert "M49.5 x 0.75" in said
    assert "threadlocker" in said


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"reducer.ring.outer_diameter": "110 mm"},
        {"motor": {"name": "CubeMars RI100 KV105"}},
        {"requirements.bore": "4 mm"},
    ],
    ids=["round the gearbox", "behind it", "inrunner", "hollow shaft"],
)
def test_the_encoders_cable_has_a_way_out_under_its_board(
    paper: Design, change: dict[str, object]
) -> None:
    parts = {one.name: one for one in resolve(paper.replacing(change)).parts}
    cover, board = parts["motor cover"], parts["encoder board"]
    (hole,) = (one for one in cover.features if one.name == "hole of the encoder's cable")
    assert isinstance(hole, PlainHole)
    # From the board's underside through all of the plate that it stands on.
    assert hole.top == pytest.approx(min(layer.bottom for layer in board.shape.layers))
    assert hole.bottom == pytest.approx(cover.shape.bottom)
    x, y = hole.circle.centres[0]
    middle, radius = complex(x, y), 0.5 * hole.diameter
    ring = board.shape.layers[0].shape
    assert isinstance(ring.outer, Circle)
    assert abs(middle) + radius < ring.outer.radius
    for layer in cover.shape.layers:
        if layer.bottom < hole.top - 1e-9:
            bores = [one for one in layer.shape.holes if isinstance(one, Circle)]
            assert any(
                abs(complex(*one.centre) - middle) < 1e-9 and one.radius == pytest.approx(radius)
                for one in bores
            )
    # Clear of the board's screws, and of a hole round the shaft.
    (threads,) = (one for one in cover.features if one.name == "threads of the board's screws")
    walls = [
        abs(complex(*centre) - middle) - radius - 0.5 * threads.thread
        for centre in threads.circle.centres
    ]
    walls += [
        abs(complex(*one.centre) - middle) - radius - one.radius
        for one in ring.holes
        if isinstance(one, Circle) and abs(complex(*one.centre)) < 1e-9
    ]
    assert min(walls) > 1e-3
