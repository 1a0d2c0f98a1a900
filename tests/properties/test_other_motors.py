"""Motors of the catalogue beside the RO100: what cannot be drawn is said where it would show."""

from __future__ import annotations

import pytest

from cqdd_design.catalog import find_motor
from cqdd_design.design import load_design
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.machine import resolve
from cqdd_design.roads.export import left_out
from cqdd_design.solids.motor_rules import drawn_motor, undrawn_sizes
from cqdd_design.verdict.joint_lines import joint_lines

UNDRAWN = (
    "CubeMars RI100 KV105",
    "CubeMars RI50 KV100",
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
KEYS = {
    "stator bore": "bore_diameter",
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
    if "inrunner" in row.kind:
        assert "is an inrunner" in missing
    else:
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


def test_an_inrunner_is_not_drawn_as_an_outrunner_whatever_is_stated(paper):
    known = paper.replacing({"motor": {"name": "CubeMars RI100 KV105", **SIZES}})
    machine = resolve(known)
    assert undrawn_sizes(machine.motor) == ()
    assert drawn_motor(machine.motor)[0] is None
    assert machine.layout.motor is None
    assert "is an inrunner" in machine.layout.motor_missing
