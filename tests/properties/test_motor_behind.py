"""Outrunners whose stator the gearbox does not fill: behind it, on a neck, whole and held."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from legible import assert_legible

from cqdd_design.catalog.motors import motors
from cqdd_design.design import Design, load_design
from cqdd_design.exporting.bill.consumables import bonds
from cqdd_design.exporting.edm.cut_facts import facts_of
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.job import ExportJob
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.canvas import pdf_bytes, render, svg_text
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import draw_part
from cqdd_design.exporting.sheets.sheet_files import export_sheets
from cqdd_design.geometry.contours import Circle
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.screws import screw_joints
from cqdd_design.machine.thermal_parts import machine_network
from cqdd_design.roads.export import left_out
from cqdd_design.solids.apart import taken_apart
from cqdd_design.solids.clearances import assembly_motion, output_revolution
from cqdd_design.solids.features.kinds import Seat
from cqdd_design.solids.interference import overlap_of, posed_manifold
from cqdd_design.solids.mesh import DISPLAY, FINE, surface_slack
from cqdd_design.solids.motor_layout import MotorLayout
from cqdd_design.solids.motor_rules import bonded_length, undrawn_sizes
from cqdd_design.solids.tool_access import reaches
from cqdd_design.verdict.joint_lines import joint_lines
from cqdd_design.verdict.motor import _bore as bore_lines
from cqdd_design.verdict.retention_lines import retention_lines

MOTOR = ("motor stator", "motor rotor", "rotor bell", "motor cover", "encoder magnet",
         "encoder board", "motor cover screw")  # fmt: skip
RINGS = ("76 mm", "110 mm", "150 mm")


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def large(paper: Design) -> Machine:
    return resolve(paper.replacing({"reducer.ring.outer_diameter": "110 mm"}))


@pytest.fixture(scope="module")
def small(paper: Design) -> Machine:
    """A stator of half as much again round the gearbox of the paper."""
    sizes = {
        "name": "CubeMars GL100 KV10", "bore_diameter": "110 mm", "gap_diameter": "130 mm",
        "outer_diameter": "140 mm", "stack_length": "18 mm", "rotor_length": "22 mm",
        "slot_depth": "8 mm", "mass": "0.9 kg", "rotor_inertia": "0.0016 kg*m^2",
    }  # fmt: skip
    return resolve(paper.replacing({"motor": sizes}))


def behind(machine: Machine) -> MotorLayout:
    motor = machine.layout.motor
    assert motor is not None
    assert motor.behind
    return motor


@pytest.mark.parametrize("outer", RINGS)
def test_no_outrunner_with_its_sizes_is_left_out(paper: Design, outer: str) -> None:
    known = [
        one for one in motors().values()
        if one.torque_at == "motor" and not undrawn_sizes(one)
    ]  # fmt: skip
    assert len(known) >= 4
    for row in known:
        design = paper.replacing({"reducer.ring.outer_diameter": outer, "motor.name": row.name})
        machine = resolve(design)
        assert machine.layout.motor_missing == "", row.name
        assert set(MOTOR) - {"rotor bell"} <= {part.name for part in machine.parts}
        assert left_out(design, "step,dxf,bom") == ()


def test_a_ring_that_goes_in_stays_in(paper: Design) -> None:
    for outer, inside in (("72 mm", True), ("72.1 mm", False)):
        motor = resolve(paper.replacing({"reducer.ring.outer_diameter": outer})).layout.motor
        assert motor is not None
        assert motor.behind is not inside


@pytest.mark.parametrize("which", ["large", "small"])
def test_it_has_its_own_sizes_and_mass(which: str, request: pytest.FixtureRequest) -> None:
    machine = request.getfixturevalue(which)
    motor, row, housing = behind(machine), machine.motor, machine.layout.housing
    parts = {part.name: part for part in machine.parts}
    stator, rotor, bell = (parts[name] for name in MOTOR[:3])
    assert 2.0 * stator.shape.inside_radius == pytest.approx(row.bore_diameter)
    assert 2.0 * bell.shape.outside_radius == pytest.approx(row.outer_diameter)
    assert rotor.shape.top - rotor.shape.bottom == pytest.approx(row.rotor_length)
    assert rotor.shape.inside_radius - stator.shape.outside_radius == pytest.approx(0.5e-3)
    assert stator.mass + rotor.mass + bell.mass == pytest.approx(row.mass)
    turning = sum(part.exact_properties.inertia[2, 2] for part in (rotor, bell))
    assert turning == pytest.approx(row.rotor_inertia)
    # All of it below the floor; the tube is the ring's own.
    assert max(one.shape.top for one in (stator, rotor, bell)) < housing.bottom
    assert not housing.seated_motor
    own = machine.layout.pack.ring_radius + 2.0 * machine.layout.unit
    assert housing.register_radius == pytest.approx(own)
    assert motor.joint == housing.bottom
    # Masses add up.
    whole = sum(part.mass * part.count for part in machine.parts)
    assert machine.inertia.total.mass == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize("which", ["large", "small"])
def test_the_neck_is_drawn_as_its_features_say(which: str, request: pytest.FixtureRequest) -> None:
    machine = request.getfixturevalue(which)
    motor, housing = behind(machine), next(p for p in machine.parts if p.name == "housing")
    features = {one.name: one for one in housing.features}
    register = features["stator register"]
    assert isinstance(register, Seat)
    assert register.diameter == pytest.approx(machine.motor.bore_diameter)
    assert register.top - register.bottom == pytest.approx(machine.motor.stack_length)
    assert "threads of the motor cover's screws" in features
    below = [one for one in housing.shape.layers if one.top <= motor.joint + 1e-9]
    volume = sum(one.shape.moments().area * one.height for one in below)
    rings = (
        (motor.stack_inner, motor.neck_inner, motor.stack_top - motor.stack_bottom),
        (motor.lip, motor.neck_inner, motor.joint - motor.stack_top),
        (motor.cover_inner, motor.spigot_inner, motor.spigot),
    )
    assert volume == pytest.approx(sum(math.pi * (a**2 - b**2) * h for a, b, h in rings), rel=2e-3)
    # The leads pass through the flange beside tube and bell, inside the cover's rim.
    leads = features["hole of the phase leads"]
    assert leads.bottom == motor.joint
    assert motor.cable_circle - motor.cable_radius > machine.layout.housing.register_radius
    assert motor.cable_circle + motor.cable_radius < motor.spigot_inner
    drilled = [
        hole
        for layer in housing.shape.layers
        if layer.bottom >= motor.joint - 1e-9 and layer.top <= motor.flange_top + 1e-9
        for hole in layer.shape.holes
        if isinstance(hole, Circle) and abs(hole.radius - motor.cable_radius) < 1e-9
    ]
    assert drilled
    assert all(one.centre == pytest.approx((motor.cable_circle, 0.0)) for one in drilled)


@pytest.mark.parametrize("which", ["large", "small"])
def test_it_is_held_and_goes_together(which: str, request: pytest.FixtureRequest) -> None:
    machine = request.getfixturevalue(which)
    assert not [row.name for row in machine.retention if row.free]
    ways = {row.name: (row.up.by, row.down.by) for row in machine.retention}
    assert ways["motor stator"] == ("housing, bond on the register",) * 2
    assert ways["motor cover"] == ("housing, its screws",) * 2
    assert not [line.id for line in retention_lines(machine) if line.status == "fail"]
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    assert all(key.reaches for key in reaches(machine.design, steps))
    said = AssemblyFacts(machine).order()
    order = [next(i for i, one in enumerate(said) if word in one) for word in (
        "motor stator, from the motor side", "the unit of the rotor bell, from the motor side",
        "the unit of the motor cover, from the motor side")]  # fmt: skip
    assert order == sorted(order)


def test_its_joints_are_judged(large: Machine) -> None:
    motor = behind(large)
    (bell,) = (one for one in joint_lines(large, None) if one.id == "BELL-JOINT")
    assert bell.value is not None
    assert f"over {1e3 * bonded_length(motor):.3g} mm" in bell.substituted
    cover = {one.place: one for one in screw_joints(large)}["motor's cover, which carries nothing"]
    assert (cover.count, cover.across) == (6, 0.0)
    (on_stub, in_bell, seat) = bonds(large)[:3]
    assert seat.place == "stator on the housing"
    assert seat.diameter == pytest.approx(2.0 * motor.stack_inner)
    assert seat.length == pytest.approx(motor.stack_top - motor.stack_bottom)
    assert on_stub.length == pytest.approx(motor.hub_top - motor.hub_bottom)
    assert in_bell.place == "magnets in the bell"
    # It stands where it need not go in, and where it would it is asked whether it does.
    assert bore_lines(large) == ()


def test_the_hub_stands_square_on_thick_stubs(large: Machine) -> None:
    motor, stub = behind(large), large.layout.shaft.support.bearing.bore_diameter
    assert motor.hub_top - motor.hub_bottom >= 0.6 * stub - 1e-12
    assert motor.hub_top < motor.joint
    assert motor.hub_radius < motor.neck_inner


def test_heat_of_the_stator_goes_up_its_neck(large: Machine, paper: Design) -> None:
    network, motor = machine_network(large), behind(large)
    at = {name: NODES.index(name) for name in NODES}
    through = network.conductance[at["stator"], at["housing"]]
    around = machine_network(resolve(paper)).conductance[at["stator"], at["housing"]]
    metal = 130.0
    neck = metal * math.pi * (motor.stack_inner**2 - motor.neck_inner**2)
    neck /= motor.joint - 0.5 * (motor.stack_top + motor.stack_bottom)
    # The same seat and iron as round the tube, and the neck behind them.
    assert 1.0 / through - 1.0 / around == pytest.approx(1.0 / neck, rel=1e-6)
    assert network.conductance[at["stator"], at["cover"]] == 0.0
    laplacian = np.diag(network.conductance.sum(axis=1)) - network.conductance
    assert np.linalg.matrix_rank(laplacian) == len(NODES) - 1


def test_weights_find_room_on_the_bell(paper: Design) -> None:
    asked = {"reducer.balance.counterweights": True, "reducer.ring.outer_diameter": "110 mm"}
    machine = resolve(paper.replacing(asked | {"reducer.disc_count": 1}))
    motor = behind(machine)
    weights = [part for part in machine.parts if part.name.startswith("balance weight")]
    assert len(weights) == 2
    top = max(part.shape.top for part in weights)
    assert motor.ring_top < top < motor.joint
    assert min(part.shape.bottom for part in weights) > motor.cover_floor


def test_a_stator_too_narrow_for_a_neck_is_told_everywhere(paper: Design) -> None:
    narrow = {"name": "CubeMars RO100 Lite KV55", "bore_diameter": "20 mm"}
    machine = resolve(paper.replacing({"motor": narrow}))
    told = machine.layout.motor_missing
    assert machine.layout.motor is None
    assert "stands behind the gearbox on a neck in its 20 mm stator bore" in told
    assert "on a shaft of 10 mm, or a shaft of at most 6.4 mm" in told
    (line,) = bore_lines(machine)
    assert (line.status, line.substituted) == ("unknown", told)
    assert told in left_out(machine.given, "step")[0]
    hopeless = {**narrow, "bore_diameter": "12 mm"}
    assert "or a shaft" not in resolve(paper.replacing({"motor": hopeless})).layout.motor_missing


@pytest.mark.parametrize("which", ["large", "small"])
def test_its_sheets_can_be_read(which: str, request: pytest.FixtureRequest) -> None:
    machine = request.getfixturevalue(which)
    for part in machine.parts:
        if part.name in ("motor cover", "rotor bell", "housing"):
            svg = render(draw_part(PartFacts(part, machine.given)))
            assert_legible(svg)


@pytest.fixture(scope="module")
def pinned(paper: Design) -> Machine:
    """Pins that a housing holds, before a motor of its own: much is said of that housing."""
    changes = {
        "reducer.ring_type": "pinwheel", "reducer.ring.outer_diameter": "135 mm",
        "reducer.ring_pitch_radius": "58 mm", "reducer.ring_pin_diameter": "9 mm",
    }  # fmt: skip
    return resolve(paper.replacing(changes))


def test_what_would_be_small_stands_on_a_larger_sheet(pinned: Machine) -> None:
    housing = next(part for part in pinned.parts if part.name == "housing")
    sheet = draw_part(PartFacts(housing, pinned.given))
    assert (sheet.paper.name, sheet.scale) == ("A2", 1.0)
    canvas = render(sheet)
    assert_legible(canvas)
    assert (canvas.width, canvas.height) == (594.0, 420.0)
    assert {"1 : 1", "1 / 1, A2"} <= {label.text for label in canvas.labels}
    assert 'width="594mm" height="420mm"' in svg_text(canvas, "")
    box = re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", pdf_bytes(canvas, ""))
    assert box is not None
    points = [float(one) for one in box.groups()]
    assert points == pytest.approx([594.0 / 25.4 * 72.0, 420.0 / 25.4 * 72.0], abs=0.01)


def test_fits_of_large_parts_have_their_limits(pinned: Machine) -> None:
    """ISO 286 beyond 120 mm: n6 is +27 to +52 um, H7 to +40."""
    texts = [
        label.text
        for part in pinned.parts
        if part.name in ("housing", "ring clamp", "motor cover")
        for label in render(draw_part(PartFacts(part, pinned.given))).labels
    ]
    assert "\u00d8135 H7 (+0.04/0)" in texts
    fits = [one for one in texts if re.match(r"\u00d8[\d.]+ [a-zA-Z]{1,2}\d", one)]
    assert len(fits) > 8
    assert all("(" in one for one in fits if "deep" not in one), fits
    flat = next(one for one in flat_parts(pinned) if one.label == "ring")
    cut = facts_of(flat, pinned, DEFAULTS).seats
    assert str(cut[0]) == "135 n6 (+0.052/+0.027)"


def test_the_export_tells_of_a_larger_sheet(pinned: Machine, tmp_path: Path) -> None:
    told: list[str] = []
    export_sheets(ExportJob(pinned, tmp_path, told.append))
    assert "cqdd-10-housing stands on A2 at 1 : 1" in told


def test_a_ring_in_its_seat_is_no_collision(paper: Design) -> None:
    """Meshes lie off the arcs between the half grooves by more than the kernel is asked for."""
    machine = resolve(paper.replacing({"reducer.ring.outer_diameter": "88 mm"}))
    meshed = [
        (part, quality)
        for name, quality in (("ring", FINE), ("housing", DISPLAY))
        for part in machine.parts
        if part.name == name
    ]
    posed = [
        posed_manifold(part, part.instances[0].pose(machine.design, 0.6), quality)
        for part, quality in meshed
    ]
    found = overlap_of(*posed)
    assert found is not None
    assert found[1] < sum(surface_slack(part, quality) for part, quality in meshed)


def test_it_runs_free(large: Machine) -> None:
    """Of its own parts and those that it hangs on, over a turn of the output."""
    own = (*MOTOR, "housing", "eccentric shaft", "shaft bearing", "encoder screw")
    moving = [part for part in large.parts if part.name in own]
    angles = output_revolution(large.design, 1)
    motion = assembly_motion(large.design, moving, angles, DISPLAY)
    assert motion.collisions == ()
    gaps = {frozenset((one.first, one.second)): one.gap for one in motion.clearances}
    assert gaps[frozenset(("motor stator", "motor rotor"))] == pytest.approx(0.5e-3, abs=0.1e-3)
