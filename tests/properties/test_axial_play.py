"""Axial play: stacks are those of the parts as drawn, and what no shim can set is seen."""

from __future__ import annotations

import dataclasses
import itertools
import math
from pathlib import Path

import pytest

from cqdd_design.catalog.internal_clearance import clearance_group
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import load_design
from cqdd_design.exporting.bill.consumables import consumables
from cqdd_design.exporting.bill.fitting import fitting_notes
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.centring import centring
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.ring_seating import ring_seating
from cqdd_design.machine.sealing import sealing
from cqdd_design.machine.temperatures import machine_temperatures
from cqdd_design.solids.axial import AxialStack, ring_stack
from cqdd_design.solids.features.holes import Counterbore
from cqdd_design.solids.shims import CLAMPING_SET, OUTPUT_SET, SHAFT_SET
from cqdd_design.verdict.retention_lines import axial_growth, retention_lines

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
COLUMNS = {
    "reducer.carrier.joint": "columns",
    "reducer.carrier.column_count": 5,
    "reducer.carrier.column_diameter": "6 mm",
}
CASES = [
    ("cqdd-10", {}),
    ("cqdd-10", COLUMNS),
    ("cqdd-10", {"reducer.disc_count": 1}),
    ("cqdd-10", {"reducer.disc_count": 3}),
    ("reference-s", {}),
    ("printed-13", {}),
]


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGNS / "cqdd-10.toml"))


def drawn_room(machine: Machine, shim: str, bearing: str) -> float:
    """Between a bearing's upper face and the face over its shims, from the pieces as placed."""
    parts = {part.name: part for part in machine.parts}
    top = float(parts[shim].instances[0].placement[2, 3]) + parts[shim].shape.top
    piece = parts[bearing].instances[-1]
    return top - float(piece.placement[2, 3]) - parts[bearing].shape.top


@pytest.mark.parametrize(("name", "change"), CASES)
def test_stacks_add_up_to_what_is_drawn(name: str, change: dict[str, object]) -> None:
    """Sizes of the features along the loop, added up, are the gap between the placed pieces."""
    machine = resolve(load_design(DESIGNS / f"{name}.toml").replacing(change))
    shaft, output, discs = machine.axial_stacks
    assert shaft.nominal == pytest.approx(drawn_room(machine, "shaft shim", "shaft bearing"))
    assert output.nominal == pytest.approx(drawn_room(machine, "output shim", "output bearing"))
    assert discs.nominal == pytest.approx(2.0 * machine.layout.pack.gap)
    carried = CLAMPING_SET if name != "printed-13" else OUTPUT_SET
    for stack, kit in ((shaft, SHAFT_SET), (output, carried)):
        assert stack.shims is not None
        assert stack.kit is kit
        assert stack.nominal == pytest.approx(stack.shims.room)
        if stack.clamped:
            # Crossed rollers: no play is drawn, none is left.
            assert (stack.shims.play, stack.reserve) == (0.0, math.inf)
            assert stack.play == pytest.approx((-0.01e-3, 0.0), abs=1e-12)
            continue
        assert kit.least_play < stack.shims.play < kit.most_play
        assert stack.reserve == pytest.approx(kit.least_play)
    carrier, support = machine.layout.carrier, machine.layout.shaft.support
    # A shim bears on the outer ring and touches nothing that turns against it.
    assert carrier.shaft_shim.inner > support.shoulder_radius
    assert carrier.shaft_shim.inner <= support.lip_radius + 1e-9
    assert {row.name for row in machine.retention if row.free} == set()


def test_worst_play_is_that_of_every_pair_of_limits(machine: Machine) -> None:
    for stack in machine.axial_stacks:
        corners = itertools.product(*((one.lower, one.upper) for one in stack.lengths))
        rooms = [stack.nominal + sum(corner) for corner in corners]
        assert stack.worst == pytest.approx((min(rooms), max(rooms)))
        variance = sum(((one.upper - one.lower) / 6.0) ** 2 for one in stack.lengths)
        low, high = stack.likely
        assert high - low == pytest.approx(6.0 * math.sqrt(variance))
        assert stack.worst[0] <= low < high <= stack.worst[1]
        if stack.kit is None or stack.clamped:
            continue
        # Packs in steps, from every room a shop may measure.
        for room in rooms:
            pack = math.floor(round((room - stack.kit.least_play) * 1e4, 6)) * 1e-4
            assert 0.0 <= pack <= stack.kit.most + 1e-9
            assert stack.play[0] - 1e-9 <= room - pack <= stack.play[1] + 1e-9


def test_heat_opens_the_housing_and_a_warm_shaft_fills_it(machine: Machine) -> None:
    shaft = machine.axial_stacks[0]
    at = dict.fromkeys(NODES, 20.0)
    assert shaft.growth(at) == 0.0
    alpha = {name: find_material(name).expansion or 0.0 for name in ("7075-T6", shaft_steel(shaft))}
    # Housing and clamp, 25.5 mm of them, against 17.5 mm of shaft and two bearings.
    warm = shaft.growth(at | {"housing": 60.0})
    assert warm == pytest.approx(alpha["7075-T6"] * 25.5e-3 * 40.0)
    bearing = find_material("AISI 52100 / 100Cr6 hardened").expansion or 0.0
    full = shaft.growth(at | {"shaft": 60.0})
    assert full == pytest.approx(-40.0 * (alpha[shaft_steel(shaft)] * 17.5e-3 + bearing * 12e-3))


def shaft_steel(stack: AxialStack) -> str:
    return next(one.material for one in stack.lengths if one.part == "eccentric shaft")


def test_what_no_pack_can_set_fails(machine: Machine) -> None:
    shaft = machine.axial_stacks[0]

    def other(lower: float, upper: float) -> AxialStack:
        first = dataclasses.replace(shaft.lengths[0], lower=1e-3 * lower, upper=1e-3 * upper)
        return dataclasses.replace(shaft, lengths=(first, *shaft.lengths[1:]))

    assert other(-0.05, 0.05).reserve == pytest.approx(SHAFT_SET.least_play)
    # Room of 0.6 less 0.20 and 0.40 mm is no play; 0.6 with 0.44 and 0.38 is 0.17 too much.
    assert other(-0.40, 0.05).reserve == pytest.approx(0.0, abs=1e-9)
    assert other(-0.42, 0.05).reserve == pytest.approx(-0.02e-3)
    assert other(-0.05, 0.21).reserve == pytest.approx(SHAFT_SET.least_play)
    assert other(-0.05, 0.38).reserve == pytest.approx(-0.17e-3)


def test_discs_without_spacing_have_no_play() -> None:
    design = load_design(DESIGNS / "cqdd-10.toml")
    tight = resolve(design.replacing({"reducer.disc_spacing": "0.1 mm"}))
    line = next(one for one in retention_lines(tight) if one.id == "RETENTION-AXIAL-PLAY")
    assert line.status == "fail"
    assert line.value == pytest.approx(-0.2)
    assert "raise disc_spacing to 0.3 mm" in line.remedy
    held = resolve(design.replacing({"reducer.disc_spacing": "0.3 mm"}))
    assert min(one.reserve for one in held.axial_stacks) > 0.0


@pytest.mark.parametrize(
    ("name", "change"),
    [
        *CASES,
        ("cqdd-10", {"housing.material": "AISI 4140 Q&T 540C"}),
        (
            "cqdd-10",
            {"reducer.ring_material": "7075-T6", "housing.material": "304 / 18-8 annealed"},
        ),
        ("cqdd-10", {"reducer.disc_thickness": "20 mm"}),
    ],
)
def test_the_clamp_rests_on_the_housing_and_never_on_the_ring(
    name: str, change: dict[str, object]
) -> None:
    """At all limits, from -40 to 120 deg C, and the play that is left is a few hundredths more."""
    machine = resolve(load_design(DESIGNS / f"{name}.toml").replacing(change))
    stack = ring_stack(machine.parts)
    ring = next(one for one in machine.retention if one.name == "ring")
    assert (ring.up.by, ring.down.by) == ("ring clamp", "housing")
    assert stack.nominal == pytest.approx(ring.up.play)
    least = stack.play[0] + min(
        stack.growth(dict.fromkeys(NODES, degrees)) for degrees in (-40.0, 120.0)
    )
    assert 9e-6 < least < 21e-6
    # A play of its own beside the limits of three lengths.
    assert stack.play[1] - stack.play[0] == pytest.approx(
        sum(one.upper - one.lower for one in stack.lengths)
    )
    # As deep in the housing as its sheet says, less than in the cover by the play.
    lower, upper = (1e3 * one for one in _spigots(machine))
    assert f"Spigots of the ring clamp, {lower:.2g} mm and {upper:.2g} mm deep" in centring(machine)
    assert upper - lower == pytest.approx(1e3 * stack.nominal)
    said = next(one for one in AssemblyFacts(machine).notes() if one.startswith("Ring: "))
    assert f"leaves it {1e3 * stack.play[0]:.2f} to {1e3 * stack.play[1]:.2f} mm" in said


def _spigots(machine: Machine) -> tuple[float, float]:
    """How deep the clamp reaches into housing and cover, from its shape."""
    clamp = next(part for part in machine.parts if part.name == "ring clamp")
    housing = machine.layout.housing
    return housing.face - clamp.shape.bottom, clamp.shape.top - housing.cover_bottom


def test_a_warm_housing_takes_the_ring_without_force(machine: Machine) -> None:
    """7075 of 72 mm grows by 1.7 um for each kelvin; n6 is 39 um larger than H7 at most."""
    said = ring_seating(machine)
    assert "(\u00d872 H7/n6) with the housing at 60 degC" in said
    growth = find_material("7075-T6").expansion or 0.0
    assert growth * 72e-3 * (60.0 - 20.0) > 39e-6 + 20e-6 > growth * 72e-3 * (50.0 - 20.0)
    assert "LOCTITE 641 round it" in said
    steel = machine.changed({"housing.material": "AISI 4140 Q&T 540C"})
    assert "LOCTITE 641" not in ring_seating(steel)
    rows = {one.name for one in consumables(machine)} - {one.name for one in consumables(steel)}
    assert rows == {"ring's compound"}


def test_a_split_ring_that_no_pack_clamps_fails(machine: Machine) -> None:
    output = machine.axial_stacks[1]
    first = dataclasses.replace(output.lengths[0], upper=0.4e-3)
    wide = dataclasses.replace(output, lengths=(first, *output.lengths[1:]))
    short = wide.worst[1] - CLAMPING_SET.most
    assert short > 0.0
    assert wide.reserve == pytest.approx(-short)


def test_bearings_are_ordered_with_the_clearance_that_their_seats_leave(machine: Machine) -> None:
    """N7 takes 10 um of a 6902 in the mean: CN would leave none of the 5 that are counted with."""
    notes = fitting_notes(machine)
    assert "radial clearance C3, 11 to 25 \u00b5m: its seats leave 8" in notes["cam bearing"]
    assert "(the design counts with 5)" in notes["cam bearing"]
    assert "radial clearance C0, 0 to 15 \u00b5m: its seats leave 7" in notes["output bearing"]
    found = clearance_group(15e-3, 28e-3, "h6", "N7", 5e-6)
    assert found is not None
    # By hand: 28 N7 is -28/-7 um, the ring 0/-9, which leaves 13 of interference, 0.8 of it taken.
    assert found.left == pytest.approx(18e-6 - 0.8 * 13e-6)
    assert found.spread == pytest.approx(math.hypot(7e-6, 0.4 * 21e-6, 0.4 * 9e-6))
    # Loose in its seats it keeps what it has; on k6 it does not.
    loose = clearance_group(15e-3, 28e-3, "h6", "H7")
    assert loose is not None
    assert (loose.name, loose.left) == ("CN", pytest.approx(10.5e-6))
    tight = clearance_group(10e-3, 22e-3, "k6", "H7")
    assert tight is not None
    assert (tight.name, tight.left) == ("C3", pytest.approx(15.5e-6 - 0.8 * 9.5e-6))
    assert clearance_group(300e-3, 380e-3, "k6", "H7") is None


def test_heat_that_is_not_known_takes_no_figure(machine: Machine) -> None:
    line = next(one for one in retention_lines(machine) if one.id == "RETENTION-AXIAL-PLAY")
    assert line.status == "unknown"
    words = f"{line.formula} {line.substituted} {line.remedy}"
    assert "temperatures are not known" in words
    assert "heat takes" not in words
    assert "lacking" not in words
    assert line.remedy.startswith("see THERMAL-RISE")


def test_heat_and_cold_take_from_the_play_that_is_judged(machine: Machine) -> None:
    """In the cold a housing of aluminium is shorter than the steel in it."""
    warm = machine_temperatures(machine)
    line = next(one for one in retention_lines(machine, warm) if one.id == "RETENTION-AXIAL-PLAY")
    least = min(machine.axial_stacks, key=lambda one: one.reserve)
    cold, hot = axial_growth(least, warm)
    taken = min(cold, hot)
    assert -50e-6 < taken < -1e-6
    assert line.value is not None
    assert line.value <= 1e3 * (least.reserve + taken) + 1e-9
    assert line.value < 1e3 * least.reserve


def test_counterbores_of_columns_are_those_of_din_974() -> None:
    """M3 heads, 3 mm high: 6.5 mm wide and 3.4 mm deep at least, as features of the cap."""
    machine = resolve(load_design(DESIGNS / "cqdd-10.toml").replacing(COLUMNS))
    cap = next(part for part in machine.parts if part.name == "carrier cap")
    name = "counterbores of the columns' screws"
    found = next(one for one in cap.features if one.name == name)
    assert isinstance(found, Counterbore)
    assert found.diameter == pytest.approx(6.5e-3)
    assert found.depth >= 3.4e-3 - 1e-9


def test_what_is_not_sealed_is_said(machine: Machine) -> None:
    """Gaps of 0.5 and 0.25 mm; only sealed bearings keep out more than coarse dust."""
    assert sealing(machine).startswith("Gap seals, without friction: a gap of 0.5 mm, 1.5 mm long,")
    assert "one of 0.25 mm, 3.8 mm long, between shaft and housing" in sealing(machine)
    assert "Nothing keeps fine dust and water out" in sealing(machine)
    assert fitting_notes(machine)["output bearing"].endswith("open, not sealed")
    assert sealing(machine) in AssemblyFacts(machine).notes()
    closed = machine.changed({"reducer.friction.seals": "contact"})
    assert sealing(closed).startswith("Sealed by its bearings: ")
    assert "contact seals" in fitting_notes(closed)["shaft bearing"]


def test_bill_and_sheet_tell_the_shims(machine: Machine) -> None:
    rows = {row.part: row for row in bill_of_materials(machine, machine.parts)}
    assert rows["shaft shim"].designation == "DIN 988 - 16 x 22"
    assert rows["shaft shim"].fitting.startswith("one each of 0.1 mm, 0.2 mm, 0.3 mm, 0.5 mm")
    assert "play is then 0.05 to 0.15 mm" in rows["shaft shim"].fitting
    clamped = fitting_notes(machine)["output shim"]
    assert "grind a pack to it, or up to 0.01 mm more: it clamps the split outer ring" in clamped
    printed = resolve(load_design(DESIGNS / "printed-13.toml"))
    assert "play is then 0.02 to 0.12 mm" in fitting_notes(printed)["output shim"]
    plays = AssemblyFacts(machine).plays()
    assert plays[0] == (
        "eccentric shaft in its bearings",
        "0.32 to 1.12",
        "0.55 to 0.89",
        "0.17 to 0.97",
        "0.05 to 0.15",
    )
