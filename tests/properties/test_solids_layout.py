"""The machine on paper fits together, whatever the design: no CAD kernel needed."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from solids_designs import CHANGES, PAPER_FILE, known_design, known_parts, machines, part_named

from cqdd_design.catalog import find_bearing
from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.motors import find_motor
from cqdd_design.catalog.screws import column_screw
from cqdd_design.design import Design, load_design
from cqdd_design.errors import CatalogError, GeometryError
from cqdd_design.gearbox.output_pins import pin_span
from cqdd_design.geometry.contours import Circle
from cqdd_design.geometry.disc import disc_contour
from cqdd_design.machine import resolve
from cqdd_design.solids.clocking import disc_groups
from cqdd_design.solids.features.kinds import AxialThread
from cqdd_design.solids.inertia import group_of
from cqdd_design.solids.layers import Annulus, Drilling, notched_circle, on_circle, turned
from cqdd_design.solids.part import Part
from cqdd_design.solids.parts import build_parts
from cqdd_design.solids.poses import CARRIER, HOUSING, body_pose
from cqdd_design.solids.proportions import lay_out

TOUCH = 1e-9


def rings(part: Part) -> list[tuple[float, float, float, float]]:
    """Bottom, top, bore and outside of every layer of a part that goes round the axis."""
    found = []
    for layer in part.shape.layers:
        outer = layer.shape.outer
        if isinstance(outer, Circle) and np.hypot(*outer.centre) > 0.0:
            continue
        outside = outer.radius if isinstance(outer, Circle) else np.hypot(*outer.points.T).max()
        bores = [0.0]
        for hole in layer.shape.holes:
            if not isinstance(hole, Circle):
                # The ring's teeth reach inward to joints of their arcs.
                bores.append(float(np.hypot(*hole.points.T).min()))
            elif np.hypot(*hole.centre) < 1e-12:
                bores.append(hole.radius)
        # A nut is bored to the core of its thread.
        nuts = [one for one in part.features if isinstance(one, AxialThread) and one.inside]
        bores += [0.5 * one.thread for one in nuts]
        found.append((layer.bottom, layer.top, max(bores), float(outside)))
    return found


def assert_turned_parts_apart(design: Design, parts: tuple[Part, ...]) -> None:
    """No two coaxial parts share a ring of space (bores and outsides, height by height)."""
    coaxial = []
    for part in parts:
        for piece in part.instances:
            pose = body_pose(design, piece.body, 0.0) @ piece.placement
            if np.hypot(*pose[:2, 3]) < 1e-12:
                coaxial.append((piece.name, pose[2, 3], rings(part)))
    for (one, at, mine), (other, there, theirs) in itertools.combinations(coaxial, 2):
        for (b, t, i, o), (b2, t2, i2, o2) in itertools.product(mine, theirs):
            high = min(t + at, t2 + there) - max(b + at, b2 + there)
            wide = min(o, o2) - max(i, i2)
            assert high < TOUCH or wide < TOUCH, f"{one} and {other} overlap by {wide} x {high} m"


@given(machines())
@settings(
    max_examples=examples(60),
    deadline=None,
    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow],
)
def test_any_machine_fits_together_or_says_why(machine: tuple[Design, Bearing]) -> None:
    design, bearing = machine
    try:
        parts = build_parts(design, lay_out(design, bearing, find_motor(design.motor.name)))
    except (GeometryError, CatalogError):
        return
    assert_turned_parts_apart(design, parts)
    for part in parts:
        assert part.mass > 0.0
        assert part.shape.volume > 0.0
        for layer in part.shape.layers:
            assert layer.height > 0.0
            assert_holes_inside(layer.shape.outer, layer.shape.holes)


def assert_holes_inside(outer: object, holes: tuple[object, ...]) -> None:
    circles = [hole for hole in holes if isinstance(hole, Circle)]
    if isinstance(outer, Circle):
        for hole in circles:
            assert np.hypot(*(hole.centre - outer.centre)) + hole.radius < outer.radius
    for one, other in itertools.combinations(circles, 2):
        assert np.hypot(*(one.centre - other.centre)) > one.radius + other.radius


@pytest.mark.parametrize("name", CHANGES)
def test_known_machines_have_their_parts(name: str) -> None:
    parts = known_parts(name)
    names = [part.name for part in parts]
    assert len(set(names)) == len(names)
    pieces = [piece.name for part in parts for piece in part.instances]
    assert len(set(pieces)) == len(pieces)
    assert_turned_parts_apart(known_design(name), parts)
    expected = {
        "paper": {"disc", "carrier cap", "shoulder screw"},
        "three discs": {"disc 1", "disc 2", "disc 3", "eccentric cam"},
        "pinwheel": {"ring pin", "pin sleeve", "shoulder screw"},
        "conjugate": {"ring", "shoulder screw"},
        "one disc": {"disc", "dowel pin", "carrier cap"},
        "columns": {"disc", "shoulder screw", "carrier cap", "carrier column", "column screw"},
        "clamped": {"disc", "shoulder screw", "carrier cap"},
    }[name]
    assert expected <= set(names)
    assert ("carrier cap" in names) == (known_design(name).reducer.output_pins.support == "both")
    assert ("eccentric cam" in names) == (name == "three discs")
    assert ("carrier column" in names) == (name == "columns")


def test_a_clamped_pin_has_a_bonded_seat_of_its_diameter_in_the_cap() -> None:
    for name, bonded in (("paper", False), ("clamped", True), ("columns", False)):
        design = known_design(name)
        carrier = resolve(design).layout.carrier
        seat = -resolve(design).layout.pack.gap - carrier.shoulder_bottom
        assert (seat >= 4e-3 - 1e-12) == bonded
        cap = part_named(known_parts(name), "carrier cap")
        told = "turned and drilled"
        if bonded:
            told += ", seats 4 H7 bonded on the f9 pins and drawn against their heads"
        assert cap.designation == told
        assert [fit.name for fit in cap.fits] == ["bonded pin seats" if bonded else "pin holes"]
    # A dowel has no thread that would hold it in the plate.
    dowel = part_named(known_parts("one disc"), "dowel pin")
    assert dowel.designation.endswith("bonded in the plate")
    plate = part_named(known_parts("one disc"), "carrier plate")
    bonded_seats = next(fit for fit in plate.fits if fit.name == "bonded pin seats")
    assert (bonded_seats.diameter, bonded_seats.zone) == (4.5e-3, "H7")


def test_columns_stand_between_plate_and_cap_each_drawn_by_its_screw() -> None:
    design, parts = known_design("columns"), known_parts("columns")
    layout = resolve(design).layout
    carrier, columns = layout.carrier, layout.carrier.columns
    assert columns is not None
    tube = part_named(parts, "carrier column")
    reducer = design.reducer
    length = float(pin_span(reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing))
    assert tube.shape.top - tube.shape.bottom == pytest.approx(length)
    assert tube.shape.top == carrier.plate_bottom
    assert tube.shape.bottom == part_named(parts, "carrier cap").shape.top
    # What the stiffness takes: diameter, bore, place.
    tube_layer = tube.shape.layers[0].shape
    assert isinstance(tube_layer.outer, Circle)
    assert 2.0 * tube_layer.outer.radius == pytest.approx(6e-3)
    assert 2.0 * tube_layer.holes[0].radius == pytest.approx(column_screw(6e-3).bore)  # type: ignore[union-attr]
    turned_in = [complex(*piece.placement[:2, 3]) for piece in tube.instances]
    pins = part_named(parts, "shoulder screw")
    between = [complex(*piece.placement[:2, 3]) for piece in pins.instances]
    assert np.abs(turned_in) == pytest.approx(np.full(5, 0.0215))
    assert np.angle(np.array(turned_in) / between) == pytest.approx(np.full(5, math.pi / 5))
    screw = part_named(parts, "column screw")
    assert screw.designation == columns.screw.designation == "ISO 4762 M3 x 25 - 12.9"
    ends = [piece.placement @ [0.0, 0.0, -columns.screw.length, 1.0] for piece in screw.instances]
    assert [end[2] for end in ends] == pytest.approx([columns.thread_top] * 5)
    assert columns.thread_top - carrier.plate_bottom >= 1.3 * columns.screw.thread
    assert columns.thread_top < carrier.plate_top
    # The heads lie 0.4 mm below the cap's face (DIN 974-1), with material under them.
    top = [0.0, 0.0, columns.screw.head_height, 1.0]
    heads = [(piece.placement @ top)[2] for piece in screw.instances]
    assert heads == pytest.approx([carrier.cap_bottom + 0.4e-3] * 5)
    assert -layout.pack.gap - columns.seat >= 0.8 * columns.screw.thread
    # All of it turns with the carrier and counts there.
    assert {piece.body for part in (tube, screw) for piece in part.instances} == {CARRIER}
    assert {group_of("carrier column"), group_of("column screw")} == {"carrier"}


def test_shoulder_screws_are_catalogue_screws_that_span_the_pack() -> None:
    design = known_design("paper")
    layout = resolve(design).layout
    carrier, pack = layout.carrier, layout.pack
    length = carrier.shoulder_top - carrier.shoulder_bottom
    assert length == pytest.approx(0.025)  # a standard length of ISO 7379
    assert carrier.shoulder_bottom < -pack.gap
    assert carrier.shoulder_top > pack.top + pack.gap
    screw = part_named(known_parts("paper"), "shoulder screw")
    assert screw.designation == "shoulder screw 4 f9 x 25 M3"
    assert screw.count == design.reducer.output_pins.count
    widest = max(layer.shape.outer.radius for layer in screw.shape.layers)  # type: ignore[union-attr]
    assert widest == pytest.approx(0.0035)  # head of the catalogue's 4 mm screw


def test_stator_bore_is_the_register_where_it_suits_the_ring() -> None:
    paper = resolve(known_design("paper")).layout
    assert paper.housing.seated_motor
    assert paper.housing.register_radius == pytest.approx(0.037)  # half of the Lite's 74 mm
    wide = resolve(known_design("pinwheel")).layout
    assert not wide.housing.seated_motor
    assert wide.housing.register_radius > 0.039


def test_cam_bearings_must_not_run_into_each_other() -> None:
    design = known_design("paper").replacing({"reducer.disc_thickness": 0.006})
    with pytest.raises(GeometryError, match=r"7 mm wide, more than the 6\.5 mm"):
        build_parts(design, resolve(design).layout)


def test_eccentrics_must_leave_a_shaft() -> None:
    design = known_design("paper")
    with pytest.raises(GeometryError, match="leaves no eccentric shaft"):
        build_parts(
            design, lay_out(design, find_bearing("SKF 618/4"), find_motor(design.motor.name))
        )


def test_a_sleeve_must_go_over_its_pin() -> None:
    design = known_design("paper").replacing({"reducer.output_pins.sleeve_diameter": 0.003})
    with pytest.raises(GeometryError, match="does not go over"):
        build_parts(design, resolve(design).layout)


@pytest.mark.parametrize("ratio", [5, 6, 10, 11, 24])
@pytest.mark.parametrize("pins", [3, 4, 5, 6, 7])
def test_quarter_lobe_pitch_makes_two_discs_one_part(ratio: int, pins: int) -> None:
    design = known_design("paper").replacing(
        {
            "reducer.ratio": ratio,
            "requirements.ratio": ratio,
            "reducer.output_pins.count": pins,
            "reducer.output_pins.hole_clocking": math.pi / (2 * ratio),
        }
    )
    (group,) = disc_groups(design)
    assert [placed.disc for placed in group.placements] == [0, 1]


def test_any_other_clocking_needs_two_parts() -> None:
    design = known_design("paper").replacing({"reducer.output_pins.hole_clocking": 0.1})
    assert len(disc_groups(design)) == 2


@pytest.mark.parametrize("name", CHANGES)
def test_placed_discs_are_the_discs_of_the_drawing(name: str) -> None:
    """Turning a part over and round gives the outline and the holes of the disc it stands for."""
    design = known_design(name)
    bore = find_bearing(design.reducer.cam_bearing.designation).outer_diameter
    for part in known_parts(name):
        for piece in part.instances:
            if piece.body.kind != "disc" or not part.name.startswith("disc"):
                continue
            wanted = disc_contour(design, piece.body.disc, bore_diameter=bore)
            shape = part.shape.layers[0].shape
            turn = piece.placement[:2, :2]
            assert wanted.outer.distances(shape.outer.points @ turn.T).max() < 2e-12
            ours = np.array([hole.centre for hole in shape.holes]) @ turn.T
            theirs = np.array([hole.centre for hole in wanted.holes])
            off = np.abs(ours[:, None] - theirs[None]).max(axis=2).min(axis=1)
            assert off.max() < 1e-9
            ends = piece.placement[2, 2] * np.array([0.0, 1.0]) * design.reducer.disc_thickness
            heights = sorted(ends + piece.placement[2, 3])
            pitch = design.reducer.disc_thickness + design.reducer.disc_spacing
            assert heights[0] == pytest.approx(piece.body.disc * pitch, abs=1e-12)


def test_closed_forms_of_turned_parts() -> None:
    drilled = turned(
        [Annulus(0.0, 0.01, 0.01, 0.03), Annulus(0.01, 0.02, 0.015, 0.02)],
        [Drilling(on_circle(6, 0.025, 0.3), 0.002, 0.004, 0.02)],
    )
    # The holes pass the wide ring only: 6 mm of it.
    expected = math.pi * (
        (0.03**2 - 0.01**2) * 0.01 + (0.02**2 - 0.015**2) * 0.01 - 6 * 0.002**2 * 0.006
    )
    assert drilled.volume == pytest.approx(expected, rel=1e-12)
    own = drilled.mass_properties(1000.0)
    assert own.mass == pytest.approx(1000.0 * expected, rel=1e-12)
    assert np.abs(own.centre[:2]).max() < 1e-12
    solid = turned([Annulus(0.0, 0.05, 0.0, 0.02)]).mass_properties(7850.0)
    assert solid.inertia[2, 2] == pytest.approx(solid.mass * 0.02**2 / 2.0)
    assert solid.inertia[0, 0] == pytest.approx(solid.mass * (3 * 0.02**2 + 0.05**2) / 12.0)


def test_notches_take_their_area_from_the_circle() -> None:
    radius, width, depth = 0.03, 0.004, 0.002
    outline = notched_circle(radius, 4, width, depth)
    half = math.asin(0.5 * width / radius)
    edge = radius * math.cos(half)
    segment = 0.5 * radius**2 * (2.0 * half - math.sin(2.0 * half))
    slot = width * (edge - (radius - depth))
    assert outline.moments().area == pytest.approx(
        math.pi * radius**2 - 4.0 * (segment + slot), rel=1e-12
    )


@pytest.mark.parametrize("name", ["cqdd-10", "reference-s"])
def test_no_floor_is_thicker_than_it_has_to_be(name: str) -> None:
    """Inside the carrier's cap or below it, the shaft's bearing sits in a boss on a thin floor."""
    layout = resolve(load_design(PAPER_FILE.parent / f"{name}.toml")).layout
    housing, seat_top = layout.housing, layout.shaft.lower_seat_top
    inside = seat_top > layout.carrier.lowest
    assert inside == (name == "cqdd-10")
    assert housing.floor_top - housing.bottom < 0.6 * layout.shaft.support.bearing.width
    assert housing.floor_top < layout.carrier.lowest
    under = seat_top - layout.shaft.support.bearing.width
    assert housing.bottom < under < housing.floor_top or inside


def test_fits_are_named_and_have_limits() -> None:
    parts = known_parts("three discs")
    disc = part_named(parts, "disc 2")
    (bore,) = disc.fits
    assert (bore.name, bore.diameter, bore.zone) == ("bore for the cam bearing", 24e-3, "N7")
    housing = part_named(parts, "housing")
    seat = next(fit for fit in housing.fits if fit.name == "ring seat")
    assert (seat.zone, seat.limits.lower, seat.limits.upper) == ("H7", 0.0, pytest.approx(30e-6))
    made = [part for part in parts if part.source == "make"]
    assert {part.name for part in made if not part.fits} == {"bearing nut"}


def test_density_of_the_housing_shows_in_the_mass() -> None:
    design = known_design("paper")
    steel = design.replacing({"housing.material": "AISI 4140 Q&T 540C"})
    thin = {part.name: part.mass / part.volume for part in resolve(design).parts}
    dense = {part.name: part.mass / part.volume for part in resolve(steel).parts}
    for name in ("housing", "carrier plate", "carrier cap", "ring clamp", "output cover"):
        assert dense[name] / thin[name] == pytest.approx(7850.0 / 2810.0, rel=1e-9)
    light = {part.name: part.mass for part in resolve(design).parts}
    heavy = {part.name: part.mass for part in resolve(steel).parts}
    # The ring has fewer dowels in steel, which bears more pressure.
    assert light["ring"] < heavy["ring"] < 1.002 * light["ring"]


def test_fixed_parts_stay_where_they_are() -> None:
    design = known_design("paper")
    assert np.array_equal(body_pose(design, HOUSING, 1.234), np.eye(4))
    weights = {part.name: part.mass * part.count for part in known_parts("paper")}
    # The catalogue's motor, once: its rotor is magnets and the bell that carries them.
    motor = weights["motor stator"] + weights["motor rotor"] + weights["rotor bell"]
    assert motor == pytest.approx(0.525, rel=1e-9)
    assert sum(weights.values()) == pytest.approx(1.4915, abs=1e-4)


@pytest.mark.parametrize(
    ("throw", "count", "circle", "pin"),
    [
        # Counterbores of 8 mm need 8.4 mm from pin to pin: 15 have 8.73 mm, 16 have 8.19.
        ("0.8 mm", 15, "21 mm", "shoulder screw"),
        ("0.8 mm", 16, "21 mm", "dowel pin"),
        # Near the ring the heads have no wall outside them any more.
        ("0.4 mm", 6, "28 mm", "shoulder screw"),
        ("0.4 mm", 6, "28.25 mm", "dowel pin"),
    ],
)
def test_where_heads_have_no_room_pins_are_dowels(
    throw: str, count: int, circle: str, pin: str
) -> None:
    reducer = {
        "ratio": 20,
        "ring_pitch_radius": "34 mm",
        "eccentricity": throw,
        "ring_pin_diameter": "4 mm",
        "output_pins": {"count": count, "diameter": "4 mm", "circle_radius": circle},
    }
    names = {part.name for part in resolve(Design.from_mapping({"reducer": reducer})).parts}
    assert names & {"shoulder screw", "dowel pin"} == {pin}
