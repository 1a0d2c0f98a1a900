"""Motors of the catalogue beside the RO100: what cannot be drawn is said where it would show."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from legible import assert_legible

from cqdd_design.catalog import find_motor
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import load_design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.canvas import render
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import draw_part
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.machine import resolve
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.inrunner_heat import inrunner_pairs, surfaces_behind
from cqdd_design.machine.screws import screw_joints
from cqdd_design.machine.thermal_parts import machine_network
from cqdd_design.roads.export import left_out
from cqdd_design.solids.apart import taken_apart
from cqdd_design.solids.clearances import assembly_motion, output_revolution
from cqdd_design.solids.mesh import DISPLAY
from cqdd_design.solids.motor_rules import bell_torque, drawn_motor, light_rotor, undrawn_sizes
from cqdd_design.solids.tool_access import reaches
from cqdd_design.verdict.joint_lines import joint_lines

UNDRAWN = (
    "CubeMars RI50 KV100",
    "CubeMars RI70 KV95",
    "maxon EC-i 40 100 W",
    "CubeMars RO80 KV105",
    "CubeMars RO60 KV115",
    "CubeMars R100 KV90",
    "CubeMars GL100 KV10",
    "CubeMars GL60 KV25",
    "mjbots mj5208 KV330",
    "DJI GM6020",
)
"""Three inrunners, three frameless outrunners, two open ones on their own shafts, and others."""
DRAWN = ("CubeMars RI100 KV105", "CubeMars RI80 V2.0 KV75", "CubeMars RI50 KV100")
"""Inrunners: wider than the ring's tube, about as wide, and slimmer (with a stated length)."""
KEYS = {
    "stator bore": "bore_diameter",
    "bore of the rotor": "hollow_diameter",
    "length over the coils": "length",
    "outside diameter": "outer_diameter",
    "diameter of the air gap": "gap_diameter",
    "length of the stack": "stack_length",
    "length of the magnets": "rotor_length",
    "depth of the slots": "slot_depth",
    "mass": "mass",
}
SIZES = {
    "bore_diameter": "74 mm", "outer_diameter": "108 mm", "gap_diameter": "100 mm",
    "stack_length": "18 mm", "rotor_length": "22 mm", "slot_depth": "9 mm", "mass": "0.6 kg",
}  # fmt: skip


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.mark.parametrize("name", UNDRAWN)
def test_a_motor_without_its_sizes_is_left_out_by_a_sentence_everywhere(paper, name):
    machine = resolve(paper.replacing({"motor.name": name}))
    row, missing = find_motor(name), machine.layout.motor_missing
    assert machine.layout.motor is None
    assert name in missing
    for words in undrawn_sizes(row):
        assert words in missing
        assert KEYS[words] in missing
    # The bill, the masses, the files and the verdict.
    (line,) = (one for one in bill_of_materials(machine, machine.parts) if one.part == "motor")
    assert line.designation == name
    assert missing in line.fitting
    warned = next(one for one in machine.inertia.warnings if "is not drawn" in one)
    assert warned.removeprefix("the motor is not drawn: ").partition(". Mass")[0] in missing
    (told,) = left_out(machine.given, "step,dxf,bom")
    assert missing in told
    assert "step, bom" in told
    assert left_out(machine.given, "dxf,gcode") == ()
    (joint,) = (one for one in joint_lines(machine, None) if one.id == "BELL-JOINT")
    assert joint.status == "unknown"
    assert missing in joint.substituted


def test_an_outrunner_whose_sizes_are_stated_is_drawn(paper):
    """By the keys that the sentence names."""
    known = paper.replacing({"motor": {"name": "CubeMars GL100 KV10", **SIZES}})
    machine = resolve(known)
    names = {part.name for part in machine.parts}
    assert machine.layout.motor_missing == ""
    assert {"motor stator", "motor rotor", "rotor bell", "motor cover", "encoder board"} <= names
    assert left_out(known, "step") == ()
    mass = {part.name: part.mass for part in machine.parts}
    whole = mass["motor stator"] + mass["motor rotor"] + mass["rotor bell"]
    assert whole == pytest.approx(0.6, rel=1e-9)


@pytest.mark.parametrize("name", DRAWN)
def test_a_rotor_that_is_listed_lighter_than_its_ring_is_told_of(paper, name):
    """All three listed inertias are a third to a half of what magnets on iron would have."""
    row = find_motor(name)
    told = light_rotor(row)
    assert name in told
    outer, inner = 0.5 * row.gap_diameter - 0.25e-3, 0.5 * row.hollow_diameter
    long = row.rotor_length or row.stack_length
    mass = 7500.0 * math.pi * (outer**2 - inner**2) * long
    heavy = 0.5 * mass * (outer**2 + inner**2)
    assert f"({heavy:.2g} kg*m^2)" in told
    assert light_rotor(dataclasses.replace(row, rotor_inertia=0.601 * heavy)) == ""
    assert light_rotor(dataclasses.replace(row, rotor_inertia=0.59 * heavy)) != ""
    assert f"{told}." in resolve(paper.replacing({"motor.name": name})).inertia.warnings
    # Where nothing is known to be wrong, nothing is said.
    assert light_rotor(dataclasses.replace(row, rotor_inertia=None)) == ""
    assert light_rotor(find_motor("CubeMars RO100 KV55")) == ""


def build(design):
    return resolve(design).parts


def inrunner(paper, name):
    changed = {"motor.name": name}
    if name == "CubeMars RI50 KV100":
        changed = {"motor": {"name": name, "rotor_length": "18 mm"}}
    return resolve(paper.replacing(changed))


@pytest.mark.parametrize("name", DRAWN)
def test_an_inrunner_stands_behind_the_gearbox_with_its_own_sizes(paper, name):
    machine = inrunner(paper, name)
    layout, row = machine.layout, machine.motor
    assert (layout.motor, layout.motor_missing) == (None, "")
    parts = {part.name: part for part in machine.parts}
    wanted = {"motor stator", "motor rotor", "rotor hub", "motor cover", "encoder board"}
    assert wanted <= set(parts)
    assert "rotor bell" not in parts
    # What the catalogue says of it is what is drawn.
    stator, rotor = parts["motor stator"].shape, parts["motor rotor"].shape
    assert 2.0 * stator.outside_radius == pytest.approx(row.outer_diameter)
    assert stator.top - stator.bottom == pytest.approx(row.length)
    assert 2.0 * rotor.inside_radius == pytest.approx(row.hollow_diameter)
    assert rotor.top - rotor.bottom == pytest.approx(row.rotor_length)
    gap = rotor.outside_radius + stator.inside_radius
    assert gap == pytest.approx(row.gap_diameter, abs=0.6e-3)
    mass = parts["motor stator"].mass + parts["motor rotor"].mass
    assert mass == pytest.approx(row.mass, rel=1e-9)
    # The hub is ours: it comes on top of the catalogue's inertia of the rotor.
    found = {one.name: one.reflected for one in machine.inertia.parts}
    assert found["motor rotor"] == pytest.approx(row.rotor_inertia, rel=0.02)
    assert machine.inertia.gearbox_reflected > found["rotor hub"] > 0.0
    assert "with the rotor's hub" in machine.inertia.crank_scope
    # All of it behind the gearbox's floor, and none of it left out in the files.
    assert max(one.shape.top for one in (parts["motor stator"], parts["motor rotor"])) < (
        layout.housing.bottom
    )
    assert left_out(machine.given, "step,bom") == ()


@pytest.mark.parametrize("name", DRAWN)
def test_an_inrunner_is_held_and_goes_together(paper, name):
    machine = inrunner(paper, name)
    assert not [row.name for row in machine.retention if row.free]
    ways = {row.name: (row.up.by, row.down.by) for row in machine.retention}
    assert ways["motor stator"] == ("motor cover, bond in its seat",) * 2
    assert ways["motor rotor"] == ("rotor hub, bond on the hub",) * 2
    steps, whole = taken_apart(machine.design, machine.parts)
    assert whole
    # What is bonded on the bench comes with what it is bonded in.
    said = AssemblyFacts(machine).order()
    for bonded, unit in (("motor rotor", "rotor hub"), ("motor stator", "motor cover")):
        assert any(one.startswith(f"unit of the {unit}: {bonded},") for one in said)
        assert not any(one.startswith(f"{bonded},") for one in said)
        assert f"the unit of the {unit}, from the motor side" in said
    assert all(key.reaches for key in reaches(machine.design, steps))


@pytest.mark.deep
def test_an_inrunner_runs_free(paper):
    machine = inrunner(paper, DRAWN[2])
    angles = output_revolution(machine.design, 1)
    motion = assembly_motion(machine.design, machine.parts, angles, DISPLAY)
    assert motion.collisions == ()
    gaps = {frozenset((one.first, one.second)): one.gap for one in motion.clearances}
    assert gaps[frozenset(("motor stator", "motor rotor"))] == pytest.approx(0.5e-3, abs=0.1e-3)


def test_sheets_of_an_inrunner_can_be_read(paper):
    machine = inrunner(paper, DRAWN[2])
    for part in machine.parts:
        if part.name in ("motor cover", "rotor hub", "housing"):
            svg = render(draw_part(PartFacts(part, machine.given)))
            assert_legible(svg)
    said = " ".join(AssemblyFacts(machine).notes())
    assert "Motor stator bonded at the stator seat" in said


def test_a_rotor_too_narrow_for_the_shaft_is_told(paper):
    known = {"name": "CubeMars RI50 KV100", "rotor_length": "18 mm", "hollow_diameter": "11 mm"}
    machine = resolve(paper.replacing({"motor": known}))
    assert machine.layout.inrunner is None
    told = machine.layout.motor_missing
    assert "has a bore of 11 mm, and with a hub it needs 12 mm on a shaft of 10 mm" in told
    assert "or a shaft of at most 9 mm" in told
    (line,) = (one for one in joint_lines(machine, None) if one.id == "BELL-JOINT")
    assert line.status == "unknown"


def test_an_inrunner_has_no_bell_for_balance_weights(paper):
    with pytest.raises(GeometryError, match="is an inrunner, which has none"):
        build(paper.replacing({"motor.name": DRAWN[0], "reducer.balance.counterweights": True}))


def test_sizes_of_an_outrunner_do_not_make_one_of_an_inrunner(paper):
    own = SIZES | {"slot_depth": "3.5 mm"}
    known = paper.replacing({"motor": {"name": "CubeMars RI70 KV95", **own}})
    machine = resolve(known)
    assert drawn_motor(machine.motor)[0] is not None
    assert machine.layout.motor is None
    assert "rotor bell" not in {part.name for part in machine.parts}


def test_temperatures_of_an_inrunner_ask_for_its_slots(paper):
    """Without the slots nothing is known; with them all heat leaves through the cover."""
    with pytest.raises(DesignError, match="state slot_depth"):
        machine_network(inrunner(paper, DRAWN[0]))
    machine = resolve(paper.replacing({"motor": {"name": DRAWN[0], "slot_depth": "14 mm"}}))
    network = machine_network(machine)
    assert (network.conductance == network.conductance.T).all()
    at = {name: NODES.index(name) for name in NODES}
    # The stator hands its heat to the cover, not to the housing.
    assert network.conductance[at["stator"], at["cover"]] > 1.0
    assert network.conductance[at["stator"], at["housing"]] == 0.0
    # Nothing is cut off: one watt in the winding leaves through the air.
    area = sum(surface.area for surface in network.surfaces)
    can, body = machine.layout.inrunner, machine.layout.housing
    least = 2.0 * math.pi * can.cover_outer * (can.joint - can.cover_floor)
    assert least < area < 8.0 * math.pi * body.flange_radius * (body.cover_top - can.board_bottom)
    laplacian = np.diag(network.conductance.sum(axis=1)) - network.conductance
    assert np.linalg.matrix_rank(laplacian) == len(NODES) - 1


def through_rings(conductivity, inner, outer, length):
    """Resistance of a ring, K/W: that of many thin ones, one behind the other."""
    edges = np.linspace(inner, outer, 20_001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    return np.sum(np.diff(edges) / (conductivity * 2.0 * math.pi * middle * length))


def test_heat_of_an_inrunner_passes_rings_and_gaps_one_behind_the_other(paper):
    """Lengths of the drawn parts; iron, aluminium, and the air of seat and gaps by handbooks."""
    machine = resolve(paper.replacing({"motor": {"name": DRAWN[0], "slot_depth": "14 mm"}}))
    motor, housing, pack = machine.layout.inrunner, machine.layout.housing, machine.layout.pack
    metal = find_material(machine.design.housing.material).conductivity
    iron = find_material("Electrical steel M400-50A").conductivity
    long = motor.stack_top - motor.stack_bottom
    seat = 37e-6 / (0.027 * 2.0 * math.pi * motor.stack_outer * long)
    yoke = through_rings(iron, motor.stack_inner + 14e-3, motor.stack_outer, long)
    # From the middle of the tube down, out through both flanges, and half down the cover.
    down = (
        0.5
        * (housing.flange_bottom - motor.joint)
        / (metal * math.pi * (housing.register_radius**2 - pack.ring_radius**2))
    )
    out = through_rings(
        metal, housing.register_radius, motor.cover_outer, motor.flange + motor.ear_height
    )
    along = (
        0.5
        * (motor.joint - motor.cover_floor)
        / (metal * math.pi * (motor.cover_outer**2 - motor.cover_inner**2))
    )
    web = through_rings(
        metal, motor.hub_radius, motor.rotor_inner, motor.web_top - motor.lip_bottom
    )
    gap = motor.stack_inner - motor.rotor_outer
    below = motor.lip_bottom - motor.cover_floor
    wanted = {
        ("stator", "cover"): 1.0 / (yoke + seat),
        ("stator", "rotor"): 0.028 * 2.0 * math.pi * motor.rotor_outer * long / gap,
        ("rotor", "shaft"): 1.0 / web,
        ("rotor", "cover"): 0.028 * math.pi * motor.lip_radius**2 / below,
        ("housing", "cover"): 1.0 / (down + out + along),
    }
    found = inrunner_pairs(machine, machine.layout, motor, metal)
    for pair, value in wanted.items():
        assert found[pair] == pytest.approx(value, rel=1e-6), pair
    # In the air: all of the can but its joint, the tube above it, and the flange's and cover's rim.
    areas = [
        one.area
        for one in surfaces_behind(
            machine.layout, motor, find_material(machine.design.housing.material)
        )
    ]
    can = 2.0 * math.pi * motor.cover_outer * (motor.joint - motor.cover_floor + motor.cover_wall)
    rim = housing.cover_flange_top - housing.flange_bottom
    tube = (
        2.0
        * math.pi
        * (
            housing.register_radius * (housing.flange_bottom - motor.joint)
            + housing.flange_radius * rim
        )
    )
    nut = math.pi * machine.layout.carrier.nut_radius**2
    faces = math.pi * (2.0 * housing.flange_radius**2 - housing.register_radius**2) - nut
    bottom = math.pi * motor.cover_outer**2
    assert areas == pytest.approx([can, bottom, tube, faces, nut])


def test_screws_of_the_cover_hold_the_stators_torque(paper):
    """Six of them on a circle: the motor's peak torque, which an outrunner's cover never feels."""
    machine = inrunner(paper, DRAWN[0])
    joints = {one.place: one for one in screw_joints(machine)}
    cover = joints["motor's cover, which carries the stator"]
    radius = machine.layout.inrunner.ear_circle
    assert cover.across * cover.count * radius == pytest.approx(
        bell_torque(machine.design, machine.motor)
    )
    assert 1.2 < cover.slip_safety < math.inf
    outside = {one.place: one for one in screw_joints(resolve(paper))}
    assert outside["motor's cover, which carries nothing"].across == 0.0
