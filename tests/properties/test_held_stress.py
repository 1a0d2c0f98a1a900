"""What housing, covers and carrier hold for long: balance of its forces, scaling, known figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import load_design
from cqdd_design.gearbox import wall_stress as stress
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.output_bearing import OutputLoad
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.held_stress import (
    HeldLoads,
    HeldStress,
    PinEnds,
    held_loads,
    held_stresses,
    pin_ends,
)
from cqdd_design.machine.shaft_strength import support_loads
from cqdd_design.results import Check
from cqdd_design.verdict.creep_lines import creep_lines

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@pytest.fixture(scope="module")
def printed() -> Machine:
    return resolve(load_design(DESIGNS / "printed-13.toml"))


@pytest.fixture(scope="module")
def held(printed: Machine) -> HeldLoads:
    return held_loads(printed)


def by_place(every: tuple[HeldStress, ...]) -> dict[tuple[str, str], HeldStress]:
    found = {(one.part, one.place): one for one in every}
    assert len(found) == len(every)
    return found


def creep_of(machine: Machine) -> Check:
    return next(one for one in creep_lines(machine, []) if one.id == "HOUSING-CREEP")


def scaled(loads: HeldLoads, by: float) -> HeldLoads:
    """Every force and moment times a number."""
    pack, out = loads.pack, loads.output
    return HeldLoads(
        PackLoads(by * pack.on_shaft, by * pack.on_carrier, pack.centre),
        OutputLoad(by * out.radial, by * out.axial, by * out.moment),
        by * loads.lower,
        by * loads.upper,
        PinEnds(*(by * one for one in loads.pins)),
    )


@pytest.mark.parametrize("name", ["printed-13", "reference-s"])
def test_plate_takes_the_torque_and_the_cap_none(name: str) -> None:
    """Two joints without columns: what pins push onto the cap comes back through them."""
    machine = resolve(load_design(DESIGNS / f"{name}.toml"))
    model, torque = machine.contact, machine.design.requirements.continuous_torque
    sweep = contact_sweep(
        model, torque, np.linspace(0.0, 1.0, 5), friction=ContactFriction.of(model, "drive")
    )
    ends = pin_ends(sweep)
    middle = sweep.pin_point - model.pin_contact_radius * sweep.pin_normal
    at = (middle[..., 0] + 1j * middle[..., 1])[:, 0]
    turning = [np.imag(np.conj(at) * force).sum(axis=1) for force in (ends.plate, ends.cap)]
    # The discs hold the torque that acts on the carrier.
    assert turning[0] == pytest.approx(np.full(5, -torque), rel=0.02)
    assert np.abs(turning[1]).max() < 0.02 * torque
    # Without what holds it back the cap would have a share of all.
    assert model.pin is not None
    assert model.pin.at_cap.sum() > 0.1


def test_the_supports_are_those_of_the_shaft_lines(printed: Machine, held: HeldLoads) -> None:
    both = support_loads(printed, held.pack)
    assert np.abs(held.lower) == pytest.approx(both[..., 0])
    assert np.abs(held.upper) == pytest.approx(both[..., 1])
    seats = by_place(held_stresses(printed, held))
    bearing = printed.layout.shaft.support.bearing
    for part, force in (("housing", held.lower), ("carrier plate", held.upper)):
        pressed = np.abs(force).max() / (bearing.outer_diameter * bearing.width)
        assert seats[part, "seat of the shaft bearing"].stress == pytest.approx(pressed)


def test_stresses_grow_with_the_forces(printed: Machine, held: HeldLoads) -> None:
    """Twice all forces and torques: every stress doubles."""
    twice = printed.changed({"requirements.continuous_torque": "12 N*m"})
    vars(twice)["layout"] = printed.layout
    once, double = held_stresses(printed, held), held_stresses(twice, scaled(held, 2.0))
    assert [2.0 * one.stress for one in once] == pytest.approx([one.stress for one in double])
    assert min(one.stress for one in once) > 0.0


def test_thinner_bodies_are_stressed_more(printed: Machine, held: HeldLoads) -> None:
    layout = printed.layout
    housing, carrier = layout.housing, layout.carrier
    thin = printed.changed({})
    floor = 0.5 * (housing.floor_top + housing.bottom)
    vars(thin)["layout"] = replace(
        layout,
        housing=replace(
            housing,
            bottom=floor,
            cover_top=0.5 * (housing.cover_top + carrier.output_seat_top),
            register_radius=housing.register_radius - 0.2e-3,
        ),
        carrier=replace(carrier, cap_bottom=0.7 * carrier.cap_bottom),
    )
    before, after = (by_place(held_stresses(one, held)) for one in (printed, thin))
    for place in (
        ("housing", "floor about its boss"),
        ("housing", "wall round the ring"),
        ("output cover", "lip over the output bearing"),
        ("carrier cap", "ring between its pins"),
    ):
        assert after[place].stress > 1.05 * before[place].stress, place
    lip = ("output cover", "lip over the output bearing")
    assert after[lip].stress == pytest.approx(4.0 * before[lip].stress)


def test_external_loads_reach_cover_clamp_and_plate(printed: Machine) -> None:
    hung = printed.changed(
        {"requirements.external_moment": "5 N*m", "requirements.external_axial": "100 N"}
    )
    before, after = by_place(held_stresses(printed)), by_place(held_stresses(hung))
    for place in (
        ("output cover", "flange up to its screws"),
        ("output cover", "face of that lip"),
        ("ring clamp", "face under the output bearing"),
        ("carrier plate", "thread of the bearing's nut"),
        ("carrier plate", "between the holes of the output's face"),
    ):
        assert after[place].stress > before[place].stress, place
    same = ("carrier plate", "seat of the shaft bearing")
    assert after[same].stress == pytest.approx(before[same].stress)


def test_the_printed_actuator_is_held_back_by_its_pins(printed: Machine, held: HeldLoads) -> None:
    """4 GPa at once and no creep known: what its pins' seats in the cap bear is too much."""
    every = held_stresses(printed, held)
    worst = max(every, key=lambda one: one.stress)
    assert (worst.part, worst.place) == ("carrier cap", "bonded pin seats")
    assert worst.stress / 1e6 == pytest.approx(46.2, rel=0.02)
    ends, long = held.pins, 5e-3
    by_hand = (4.0 * np.abs(ends.cap) + 6.0 * ends.cap_moment / long) / (5e-3 * long)
    assert worst.stress == pytest.approx(by_hand.max())
    line = creep_of(printed)
    assert (line.status, line.unit) == ("fail", "%")
    assert line.value == pytest.approx(100.0 * worst.stress / 4e9)
    assert "carrier cap, bonded pin seats" in line.substituted
    assert "its creep is not known" in line.substituted
    # A little less torque, and what its plastic does later is what is missing.
    less = creep_of(printed.changed({"requirements.continuous_torque": "4.5 N*m"}))
    assert (less.status, less.value) == ("unknown", None)
    assert "creep is not known" in less.substituted


def test_known_creep_passes_and_fails(printed: Machine) -> None:
    modulus = find_material("POM (acetal)").creep_modulus
    assert modulus is not None
    moulded = printed.changed({"housing.material": "POM (acetal)"})
    failed = creep_of(moulded)
    assert failed.status == "fail"
    light = creep_of(moulded.changed({"requirements.continuous_torque": "1 N*m"}))
    assert light.status == "pass"
    assert light.value is not None
    most = max(
        one.stress
        for one in held_stresses(moulded.changed({"requirements.continuous_torque": "1 N*m"}))
    )
    assert light.value == pytest.approx(100.0 * most / modulus)
    hung = creep_of(moulded.changed({"requirements.external_axial": "50 N"}))
    assert "lower the continuous torque to" in hung.remedy
    # So heavy that no torque is low enough beside it.
    heavy = creep_of(moulded.changed({"requirements.external_axial": "3 kN"}))
    assert heavy.remedy.endswith("lower the continuous torque and the external loads")
    assert "external loads" not in failed.remedy


def test_the_wall_is_bent_by_floor_and_ring(printed: Machine, held: HeldLoads) -> None:
    """The tube's moment at its flange is that of all that pushes it below."""
    layout = printed.layout
    wall = by_place(held_stresses(printed, held))["housing", "wall round the ring"]
    root = layout.housing.flange_bottom
    middle = layout.shaft.lower_seat_top - 0.5 * layout.shaft.support.bearing.width
    disc = 0.5 * layout.pack.disc_thickness
    ring = -(held.pack.on_shaft + held.pack.on_carrier)[..., 0]
    moment = np.abs(held.lower * (root - middle) + ring * max(root - disc, 0.0)).max()
    twisted = stress.tube_stress(
        layout.housing.register_radius, layout.pack.ring_radius, moment, held.crank_torque
    )
    assert layout.dowels.bottom >= root
    assert wall.stress == pytest.approx(twisted)


def test_floor_lip_and_neck_by_hand(printed: Machine, held: HeldLoads) -> None:
    """Arms and sections from the drawing; behind the gearbox the stator turns back on its neck."""
    behind = printed.changed({"reducer.ring.outer_diameter": "80 mm"})
    layout = behind.layout
    housing, motor = layout.housing, layout.motor
    assert motor is not None
    assert motor.behind
    found = by_place(held_stresses(behind, held))
    support = layout.shaft.support.bearing
    middle = layout.shaft.lower_seat_top - 0.5 * support.width
    push, floor = np.abs(held.lower).max(), 0.5 * (housing.floor_top + housing.bottom)
    thick = housing.floor_top - housing.bottom
    bent = stress.tilted_plate_stress(
        housing.boss_radius, layout.pack.ledge_radius, thick, push * abs(middle - floor)
    )
    assert middle > floor
    assert found["housing", "floor about its boss"].stress == pytest.approx(bent)
    # 2 t_cr/(pi (r^4 - r_i^4)) r in shear, and sqrt(3) of it.
    shear = 2.0 * held.crank_torque * motor.stack_inner / np.pi
    shear /= motor.stack_inner**4 - motor.neck_inner**4
    neck = found["housing", "neck under the stator"].stress
    assert neck == pytest.approx(np.sqrt(3.0) * shear)
    output = layout.carrier.output
    outside, lip = output.bearing.outer_diameter, housing.cover_top - layout.carrier.output_seat_top
    wide = 0.5 * outside - output.lip_radius
    load = 4.0 * held.output.moment.max() / (np.pi * outside**2)
    assert found["output cover", "face of that lip"].stress == pytest.approx(load / wide)
    root = 6.0 * load * 0.5 * wide / lip**2
    assert found["output cover", "lip over the output bearing"].stress == pytest.approx(root)
    dowels = layout.dowels
    torque = 6.0 + held.crank_torque
    force = torque / (0.75 * len(dowels.angles) * layout.pack.ring_radius)
    pressed = 2.0 * force / (2.0 * dowels.radius * dowels.bearing_length)
    assert found["housing", "half holes of the ring's dowels"].stress == pytest.approx(pressed)
