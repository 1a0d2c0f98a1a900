"""The output bearing in its seats: what fits and heat take of its clearance, and what is done."""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.catalog.bearings import SHAFT_MATERIAL, bearings, find_bearing
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.internal_clearance import Clearance, clearances, most_preload
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.design import load_design
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.expansion import part_materials
from cqdd_design.gearbox.seated import Wall, raceway_share, seated_clearance
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.dowels import loaded_dowels
from cqdd_design.machine.output_seat import ordered_clearance, seated_states
from cqdd_design.machine.screws import screw_joints
from cqdd_design.machine.temperatures import MachineTemperatures, machine_temperatures
from cqdd_design.sizing.plates import with_sound_plate
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.creep_lines import creep_lines
from cqdd_design.verdict.output_seat_line import output_seat_line, steel_helps

ROOT = Path(__file__).resolve().parents[2]
STEEL, ALUMINIUM = find_material(SHAFT_MATERIAL), find_material("7075-T6")
RINGS = find_material("AISI 52100 / 100Cr6 hardened")


def tube(material: Material, radius: float) -> np.ndarray:
    """Radial displacement and stress of a tube, u = A r + B/r in plane stress, by A and B."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    return np.array(
        [
            [radius, 1.0 / radius],
            [e / (1.0 - nu), -e / ((1.0 + nu) * radius**2)],
        ]
    )


def moved_by_equations(seat, raceway, side, ring: Material, wall: Material) -> float:
    """What the raceway moves where ring and wall overlap by one, as four equations."""
    lhs, rhs = np.zeros((4, 4)), np.zeros(4)
    lhs[0, :2] = tube(ring, raceway)[1]
    lhs[1, 2:] = tube(wall, side)[1] if side else [0.0, 1.0]
    lhs[2] = np.r_[tube(ring, seat)[1], -tube(wall, seat)[1]]
    lhs[3] = np.r_[tube(ring, seat)[0], -tube(wall, seat)[0]]
    rhs[3] = 1.0 if raceway > seat else -1.0
    solved = np.linalg.solve(lhs, rhs)
    return abs(float(tube(ring, raceway)[0] @ solved[:2]))


@pytest.mark.parametrize(
    ("seat", "raceway", "side"),
    [(25e-3, 27.4e-3, 12e-3), (25e-3, 27.4e-3, 0.0), (33e-3, 30.6e-3, 40e-3), (8e-3, 10e-3, 5e-3)],
)
@pytest.mark.parametrize("wall", [STEEL, ALUMINIUM])
def test_a_raceway_moves_as_two_tubes_say(seat, raceway, side, wall) -> None:
    expected = moved_by_equations(seat, raceway, side, RINGS, wall)
    assert raceway_share(seat, raceway, side, RINGS, wall) == pytest.approx(expected, rel=1e-9)


def test_what_is_left_is_that_of_a_calculation_by_hand() -> None:
    """50 h5 is -11/0, the bore -12/0: half a micrometre; 66 H7 is 30/0 round 0/-13: loose."""
    row, hot = find_bearing("THK RA5008"), 80.0
    on = Wall("h5", 12e-3, ALUMINIUM, hot)
    within = Wall("H7", 45e-3, ALUMINIUM, hot - 10.0)
    grown = (ALUMINIUM.expansion - RINGS.expansion) * 50e-3 * 60.0
    share = moved_by_equations(25e-3, 27.4e-3, 12e-3, RINGS, ALUMINIUM)
    warmer = RINGS.expansion * 58e-3 * 10.0
    found = seated_clearance(row, Clearance("C0", 0.0, 15e-6), on, within)
    assert found.mean == pytest.approx(7.5e-6 - share * (0.5e-6 + grown) - warmer, rel=1e-9)
    spread = math.hypot(7.5e-6, share * 5.5e-6, share * 6e-6)
    assert found.spread == pytest.approx(spread, rel=1e-9)
    # Cold, the cover shrinks round the ring and the plate lets go of it.
    cold = seated_clearance(
        row, Clearance("C0", 0.0, 15e-6), on._replace(temperature=-40.0),
        within._replace(temperature=-40.0),
    )  # fmt: skip
    shrunk = (ALUMINIUM.expansion - RINGS.expansion) * 66e-3 * 60.0 - 21.5e-6
    share = moved_by_equations(33e-3, 30.6e-3, 45e-3, RINGS, ALUMINIUM)
    assert shrunk > 0.0
    assert cold.mean == pytest.approx(7.5e-6 - share * shrunk, rel=1e-9)


@given(
    st.sampled_from(
        [
            one
            for one in bearings().values()
            if clearances(one) and one.bore_diameter >= 20e-3 and one.outer_diameter <= 0.25
        ]
    ),
    st.floats(-40.0, 120.0),
    st.floats(1.0, 40.0),
)
def test_a_warmer_plate_of_aluminium_never_leaves_more(row, temperature, more) -> None:
    clearance = clearances(row)[-1]
    within = Wall("H7", row.outer_diameter, ALUMINIUM, 20.0)

    def left(material: Material, at: float) -> float:
        on = Wall("h5", 0.25 * row.bore_diameter, material, at)
        return seated_clearance(row, clearance, on, within).mean

    assert left(ALUMINIUM, temperature + more) < left(ALUMINIUM, temperature)
    # Beyond what its own ring takes by being warmer than the other, steel takes next to nothing.
    own = RINGS.expansion * 0.5 * (row.bore_diameter + row.outer_diameter) * more
    took = left(STEEL, temperature) - left(STEEL, temperature + more)
    assert abs(took - own) < 0.05 * own


def test_classes_of_clearance_follow_each_other() -> None:
    for row in bearings().values():
        every = clearances(row)
        if row.kind in ("ball", "crossed roller") and row.outer_diameter <= 0.25:
            assert every, row.designation
            assert (most_preload(row) or 0.0) > 0.0
        assert all(one.least < one.most for one in every)
        assert all(a.least < b.least and a.most < b.most for a, b in itertools.pairwise(every))


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(ROOT / "docs" / "gallery" / "plain-10.toml"))


@pytest.fixture(scope="module")
def of_aluminium(machine: Machine) -> Machine:
    return machine.changed({"reducer.carrier.material": "auto"})


@pytest.fixture(scope="module")
def warm(of_aluminium: Machine) -> MachineTemperatures:
    return machine_temperatures(replace(of_aluminium, stiff=True))


def test_a_warm_plate_of_aluminium_fails_and_its_cure_holds(of_aluminium, warm) -> None:
    line = output_seat_line(of_aluminium, warm)
    assert line.status == "fail"
    assert line.value > 2.0 * line.limit
    assert f"set carrier.material to '{SHAFT_MATERIAL}'" in line.remedy
    cured = of_aluminium.changed({"reducer.carrier.material": SHAFT_MATERIAL})
    settled = machine_temperatures(replace(cured, stiff=True))
    assert output_seat_line(cured, settled).status == "pass"


def test_temperatures_that_are_not_known_leave_it_unknown(of_aluminium, warm) -> None:
    assert output_seat_line(of_aluminium, None).status == "unknown"
    assert "temperatures are not known" in output_seat_line(of_aluminium, None).substituted
    # What is too much as fitted, or cold, is so without them.
    arctic = of_aluminium.changed({"environment.coldest": -55.0, "environment.ambient": -50.0})
    line = output_seat_line(arctic, None)
    assert line.status == "fail"
    assert "housing.material" in line.remedy
    assert "warmer environment.coldest" in line.remedy
    # A start may not be warmer than the air.
    still = of_aluminium.changed({"environment.coldest": -50.0, "environment.ambient": -50.0})
    assert "warmer environment.ambient" in output_seat_line(still, None).remedy
    of_steel = {"housing.material": SHAFT_MATERIAL}
    assert output_seat_line(arctic.changed(of_steel), None).status == "unknown"
    assert "at -55 degC (carrier plate)" in line.substituted
    # No losses are known of parts that press on each other: what passes is not known then.
    steel = of_aluminium.changed({"reducer.carrier.material": SHAFT_MATERIAL})
    cold = replace(warm, cold="no losses")
    assert output_seat_line(steel, cold).status == "unknown"
    assert output_seat_line(of_aluminium, cold).status == "fail"


def test_the_seat_that_is_judged_is_the_one_that_is_drawn(machine: Machine) -> None:
    (plate,) = (one for one in machine.parts if one.name == "carrier plate")
    bore = machine.layout.carrier.output.bearing.bore_diameter
    (seat,) = (one for one in plate.fits if abs(one.diameter - bore) < 1e-9)
    assert seat.zone == "h5"
    fitted = seated_states(machine, None)[0]
    assert (fitted.carrier, fitted.housing) == (20.0, 20.0)
    row = machine.layout.carrier.output.bearing
    limits = fit_limits("h5", bore)
    most = ordered_clearance(row, machine.design.carrier_material)
    mean = 0.5 * (most.least + most.most)
    assert fitted.seated.mean == pytest.approx(mean, abs=limits.upper - limits.lower)


def test_a_carrier_of_steel_is_one_everywhere(of_aluminium: Machine) -> None:
    steel = of_aluminium.changed({"reducer.carrier.material": SHAFT_MATERIAL})

    def of(machine: Machine, name: str):
        return next(part for part in machine.parts if part.name == name)

    for name in ("carrier plate", "carrier cap"):
        assert of(steel, name).material == SHAFT_MATERIAL
        share = of(steel, name).mass / of(of_aluminium, name).mass
        assert share == pytest.approx(STEEL.density / ALUMINIUM.density, rel=1e-9)
    assert of(steel, "housing").material == of(of_aluminium, "housing").material == "7075-T6"
    # Seats in steel hold the pins more stiffly, threads in it hold more.
    soft, stiff = (one.contact.pin_series.max() for one in (of_aluminium, steel))
    assert stiff < soft
    threads = [
        {one.place: one.clamping.tapped.name for one in screw_joints(machine)}
        for machine in (of_aluminium, steel)
    ]
    assert set(threads[0].values()) == {"7075-T6"}
    of_steel = {place for place, metal in threads[1].items() if metal == SHAFT_MATERIAL}
    assert of_steel == {"output's face", "output pins in the carrier plate"}
    dowels = [{one.place: one.seat.value for one in loaded_dowels(machine)} for machine in
              (of_aluminium, steel)]  # fmt: skip
    assert dowels[1]["output's face"] > dowels[0]["output's face"]
    assert dowels[1]["ring in its seat"] == dowels[0]["ring in its seat"]
    grown = [part_materials(machine.design)["carrier"] for machine in (of_aluminium, steel)]
    assert grown == ["7075-T6", SHAFT_MATERIAL]
    with pytest.raises(DesignError, match="of which a carrier is made where the housing is"):
        steel.design.replacing({"reducer.carrier.material": "PC-CF FDM along layers"})


def test_pins_of_a_ring_are_held_by_the_housing() -> None:
    """Whatever the carrier is of."""
    pinwheel = {
        "reducer.ring_type": "pinwheel", "reducer.ring_pin_diameter": "4 mm",
        "reducer.ring.roller_diameter": "8 mm", "reducer.ring.roller": "needle",
    }  # fmt: skip
    paper = load_design(ROOT / "designs" / "cqdd-10.toml").replacing(pinwheel)
    plain = resolve(paper).contact.ring_pin_series
    steel = resolve(paper.replacing({"reducer.carrier.material": SHAFT_MATERIAL}))
    assert np.array_equal(steel.contact.ring_pin_series, plain)
    housing = resolve(paper.replacing({"housing.material": SHAFT_MATERIAL}))
    assert housing.contact.ring_pin_series.max() < plain.max()


def test_a_carrier_of_metal_does_not_creep_in_a_printed_housing() -> None:
    printed = load_design(ROOT / "designs" / "printed-13.toml")
    told = []
    for material in ("auto", SHAFT_MATERIAL):
        machine = resolve(printed.replacing({"reducer.carrier.material": material}))
        (line,) = (one for one in creep_lines(machine, ()) if one.id == "HOUSING-CREEP")
        told.append(int(re.search(r"(\d+) places looked at", line.substituted)[1]))
    assert told[1] < told[0]


def test_a_search_ends_in_steel_where_aluminium_presses(of_aluminium, warm, monkeypatch) -> None:
    """Of the same gearbox in all else; what is cool stays as it was found."""
    seen: list[bool] = []

    def judged(one: Machine):
        seen.append(one.stiff)
        return warm

    known = "cqdd_design.sizing.plates.known_temperatures"
    monkeypatch.setattr(known, judged)
    monkeypatch.setattr("cqdd_design.sizing.plates.pins_press", lambda _: pressed)
    pressed = 0.9
    assert steel_helps(of_aluminium, warm)
    sized = SizedDesign(of_aluminium.design, (), (), None, of_aluminium)
    found = Found(None, None, {}, sized, None, True)
    steel = with_sound_plate(found)
    assert steel.sized.design.carrier_material == SHAFT_MATERIAL
    assert steel.sized.machine.design == steel.sized.design == steel.sized.machine.given
    as_it_was = steel.sized.design.replacing({"reducer.carrier.material": "auto"})
    assert as_it_was == of_aluminium.design
    assert steel.sized.checks == steel.sized.machine.analysis.checks
    assert with_sound_plate(steel) is steel
    assert seen == [True]
    cool = replace(warm, steady=np.full_like(warm.steady, 20.0))
    monkeypatch.setattr(known, lambda _: cool)
    assert with_sound_plate(found) is found
    monkeypatch.setattr(known, lambda _: None)
    assert with_sound_plate(found) is found
    # Or where seats of its pins would yield, whatever its warmth.
    pressed = 0.92
    assert with_sound_plate(found).sized.design.carrier_material == SHAFT_MATERIAL
