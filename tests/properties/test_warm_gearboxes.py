"""What warmth does to gearboxes with part errors, to their seats and screws, and over a duty."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.lubricants import find_lubricant
from cqdd_design.design import Design, load_design
from cqdd_design.design.duty_log import DutyLog
from cqdd_design.gearbox.heat.expansion import AS_DRAWN
from cqdd_design.gearbox.output_bearing import OutputLoad, axial_share, static_load, static_safety
from cqdd_design.gearbox.tolerance.evaluate import FREEDOM
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.capacity import LoadedContacts
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.output_seat import seated_states
from cqdd_design.machine.temperatures import (
    MachineTemperatures,
    heat_checks,
    known_temperatures,
    machine_temperatures,
)
from cqdd_design.machine.warm_cycle import WarmCycle
from cqdd_design.sizing.exact import yielding_checks
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.sizing.trial_gearboxes import drawn_alike
from cqdd_design.verdict.drawn import TIGHT, drawn_cam_hours, drawn_gearboxes, good_gearboxes
from cqdd_design.verdict.retention_lines import axial_growth

ROOT = Path(__file__).resolve().parents[2]
NONE = np.zeros(1)


@pytest.fixture(scope="module")
def light() -> Machine:
    """A gearbox whose pins stand in aluminium."""
    design = load_design(ROOT / "docs" / "gallery" / "wrist-15.toml")
    machine = resolve(design)
    assert design.carrier_material == "7075-T6"
    return machine


@pytest.fixture(scope="module")
def warm(light: Machine) -> MachineTemperatures:
    found = known_temperatures(light)
    assert found is not None
    return found


def test_warm_aluminium_takes_clearance_of_gearboxes_with_part_errors(
    light: Machine, warm: MachineTemperatures
) -> None:
    """Pins go outward on their circle, holes of steel discs do not: backlash and stiffness fall."""
    asked = light.changed({"requirements.stiffness": "1 N*m/arcmin"})
    drawn = drawn_gearboxes(asked, 32, sensitivity=False, warm=lambda: warm)
    assert drawn.warm is not None
    cold, tight = drawn.continuous.columns, drawn.warm.columns
    assert drawn.warm.ensemble.temperatures.carrier == round(warm.hot.temperatures.carrier)
    assert tight["backlash_arcmin"].mean() < 0.99 * cold["backlash_arcmin"].mean()
    # What is left: pins of the carrier's circle against the discs', both ways round a hole.
    assert np.percentile(tight["stiffness_Nm_per_arcmin"], 5) < np.percentile(
        cold["stiffness_Nm_per_arcmin"], 5
    )
    # Where no stiffness is asked for, none is looked for there.
    free = drawn_gearboxes(light, 32, sensitivity=False, warm=lambda: warm).warm
    assert free is not None
    for name in FREEDOM:
        assert np.array_equal(free.columns[name], tight[name])


def test_a_carrier_of_steel_is_not_drawn_warm(light: Machine) -> None:
    steel = light.changed({"reducer.carrier.material": "AISI 4140 Q&T 540C"})
    found = known_temperatures(steel)
    assert found is not None
    assert found.least_free == AS_DRAWN
    assert drawn_gearboxes(steel, 8, sensitivity=False, warm=lambda: found).warm is None


def test_what_binds_warm_is_no_sound_gearbox(light: Machine, warm: MachineTemperatures) -> None:
    closer = light.changed({"reducer.output_pins.hole_clearance": "30 um"})
    found = known_temperatures(closer)
    drawn = drawn_gearboxes(closer, 32, sensitivity=False, warm=lambda: found)
    assert drawn.warm is not None
    lines = yielding_checks(closer)
    numbers, fails = good_gearboxes(closer, drawn, lines) or (np.array([]), {})
    assert fails[TIGHT] > fails["bind"]
    alone, _ = good_gearboxes(closer, drawn._replace(warm=None), lines) or (np.array([]), {})
    bad = drawn.warm.numbers[
        drawn.warm.columns["unloaded_torque_Nm"]
        > 0.05 * closer.design.requirements.continuous_torque
    ]
    lost = np.setdiff1d(alone, drawn.warm.numbers)
    assert set(numbers) == set(alone) - set(bad) - set(lost)


def test_the_life_of_most_gearboxes_is_by_the_cube_of_their_greatest_load(light: Machine) -> None:
    lines = yielding_checks(light)
    drawn = drawn_gearboxes(light, 32, sensitivity=False)
    hours = drawn_cam_hours(light, drawn, lines)
    perfect = next(line for line in lines if line.id == "BEARING-LIFE").value
    loads = drawn.continuous.columns["cam_bearing_load_max_N"]
    most = np.quantile(loads, light.design.requirements.yield_share)
    own = LoadedContacts(light.contact, light.contact.film_speed).greatest(
        light.design.requirements.continuous_torque
    )["cam_bearing_load_max_N"]
    exponent = light.analysis.cam_bearing.exponent
    assert hours == pytest.approx(perfect * (own / most) ** exponent, rel=1e-6)
    assert hours < perfect
    assert drawn_cam_hours(light, None, lines) is None


# ------------------------------------------------------------------ a duty with long phases


@pytest.fixture(scope="module")
def shifts() -> Machine:
    """Four hours of work and eight of rest, again and again."""
    design = load_design(ROOT / "docs" / "gallery" / "plain-10.toml")
    hours = np.array([0.0, 4.0, 4.001, 12.0]) * 3600.0
    log = DutyLog(
        "shifts.csv",
        "4 of 12",
        2,
        hours,
        np.array([7.9, 7.9, 0.0, 0.0]),
        np.array([math.pi, math.pi, 0.0, 0.0]),
    )
    named = design.replacing({"requirements.duty_file": "shifts.csv"})
    return resolve(named.with_duty_log(log))


def test_parts_are_judged_at_their_hottest_of_a_duty(shifts: Machine) -> None:
    found = machine_temperatures(shifts)
    assert found.cycle is not None
    rise, clearance = heat_checks(found)
    for node in ("disc", "carrier", "housing"):
        mean = float(found.steady[NODES.index(node)])
        assert found.hottest(node) > mean + 15.0
    assert f"{found.hottest('housing'):.0f}" in rise.substituted
    assert len(found.states) > 1
    greatest = max(float(state[NODES.index("carrier")]) for state in found.states)
    assert greatest == pytest.approx(found.hottest("carrier"), abs=0.6)
    seats = seated_states(shifts, found)
    assert max(one.carrier for one in seats) == pytest.approx(greatest)
    # So for the room of the shims, as far as heat takes any.
    for stack in shifts.axial_stacks:
        growths = [stack.growth(dict(zip(NODES, state, strict=True))) for state in found.states]
        assert axial_growth(stack, found)[1] == min(growths)
    assert clearance.known


def test_grease_bears_what_its_lubricant_does(light: Machine) -> None:
    for lubricant, most in (("SKF LGLT 2", 110.0), ("NLGI 2 grease", 120.0)):
        machine = light.changed({"reducer.friction.lubricant": lubricant})
        told = heat_checks(machine_temperatures(machine))[0].substituted
        assert f" of {most:g}" in told.partition("grease at")[2].partition(",")[0]


def test_a_start_colder_than_the_lubricant_works_is_warned_of(light: Machine) -> None:
    cold = light.changed({"environment.coldest": "-40 degC"})
    (told,) = (one for one in cold.analysis.warnings if "environment.coldest" in one)
    assert "-40 degC is below the -30 degC down to which NLGI 2 grease works" in told
    assert not any("environment.coldest" in one for one in light.analysis.warnings)


def test_cold_air_in_which_grease_drags_is_warned_of(light: Machine) -> None:
    """A cold ambient only helped: more torque of the magnets, and grease at 40 degC."""
    cold = light.changed({"environment.ambient": "-20 degC", "environment.coldest": "-25 degC"})
    (told,) = (one for one in cold.analysis.warnings if "environment.ambient" in one)
    grease = find_lubricant("NLGI 2 grease")
    thick = grease.viscosity_at(-20.0) / grease.viscosity_at(40.0)
    assert thick > 100.0
    assert f"is {thick:.0f} times as thick as at 40 degC" in told
    assert "analyse --temperature '-20 degC'" in told
    mild = light.changed({"environment.ambient": "10 degC"})
    assert not any("environment.ambient" in one for one in mild.analysis.warnings)


def test_a_quick_cycle_has_no_state_of_its_own(warm: MachineTemperatures) -> None:
    swing = np.array([[0.0], [0.1], [0.2]])
    quick = WarmCycle(np.arange(3.0), warm.steady + swing)
    assert len(replace(warm, cycle=quick).states) == 1
    slow = WarmCycle(np.arange(3.0), warm.steady + 100.0 * swing)
    assert len(replace(warm, cycle=slow).states) == 2


def test_extremes_are_where_parts_are_hottest_or_most_unlike() -> None:
    count = len(NODES)
    rows = np.full((5, count), 20.0)
    rows[1, NODES.index("disc")] = 60.0
    rows[2] = 50.0
    rows[3, NODES.index("carrier")] = 5.0
    found = WarmCycle(np.arange(5.0), rows).extremes
    assert {tuple(row) for row in rows[1:4]} <= {tuple(row) for row in found}


# ------------------------------------------------------------------ balls along their axis


def test_thin_balls_take_a_quarter_of_their_rating_along_the_axis() -> None:
    row = find_bearing("6811")
    rating = row.static_rating or 0.0
    alone = OutputLoad(NONE, NONE + 0.25 * rating, NONE)
    assert static_safety(row, alone) == pytest.approx(1.0)
    assert axial_share(replace(find_bearing("6008"), designation="6208")) == 0.5
    assert axial_share(find_bearing("6008")) == 0.25
    # Series 2, and small.
    assert axial_share(find_bearing("SKF * 6200")) == 0.25
    # A moment counts by the axial force of its most loaded ball.
    pitch = 0.5 * (row.bore_diameter + row.outer_diameter)
    tilted = OutputLoad(NONE, NONE, NONE + 0.25 * rating * pitch / 4.37)
    assert static_safety(row, tilted) == pytest.approx(1.0)
    across = OutputLoad(NONE + 1000.0, NONE, NONE)
    assert static_safety(row, across) == pytest.approx(rating / 1000.0)
    crossed = find_bearing("THK RA5008")
    load = OutputLoad(NONE + 10.0, NONE + 3000.0, NONE + 5.0)
    assert static_safety(crossed, load) == pytest.approx(
        (crossed.static_rating or 0.0) / float(static_load(crossed, load).max())
    )


def test_a_push_that_balls_do_not_take_chooses_crossed_rollers(design_8: Design) -> None:
    pushed = resolve(design_8.replacing({"requirements.external_axial": "5000 N"}))
    assert pushed.seats[1].bearing.kind != "ball"


@pytest.fixture(scope="module")
def design_8() -> Design:
    design = load_design(ROOT / "docs" / "gallery" / "knee-8.toml")
    return design.leaving("reducer.carrier_bearing.designation")


def test_a_search_scales_warm_gearboxes_by_what_yielding_made_of_others(light: Machine) -> None:
    """Of their outputs alone, which are fewer where no stiffness is asked for."""
    asked = light.design.requirements
    hunt = Hunt(asked, None, None, lambda _: None, stage_tables(asked.ratio), "mass", usual={})
    drawn_alike(hunt, light)
    again = drawn_alike(hunt, light)
    direct = drawn_gearboxes(light, 32, sensitivity=False, warm=lambda: known_temperatures(light))
    assert again.warm is not None
    assert direct.warm is not None
    assert tuple(again.warm.columns) == FREEDOM
    found, wanted = (
        np.quantile(one.columns["unloaded_torque_Nm"], 0.95) for one in (again.warm, direct.warm)
    )
    # No gearbox is tight while it is cold, which says nothing of how tight warm ones are: rigid
    # parts press harder.
    assert wanted <= found < 2.0 * wanted
