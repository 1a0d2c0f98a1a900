"""The machine's thermal network: balances, a second road by finite differences, checks."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from contact_designs import paper_design
from reference_design import DESIGN_S
from stack_conduction import stack_temperatures

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.catalog.motors import WINDING_MOST
from cqdd_design.design import load_design
from cqdd_design.design.duty_file import read_duty
from cqdd_design.errors import ContactError
from cqdd_design.gearbox.checks.allowables import BINDING_OVERLAP
from cqdd_design.gearbox.checks.heat import WarmPart, rise_check
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.heat.cycle import settled_cycle
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.gearbox.heat.network import Heat
from cqdd_design.gearbox.losses.swept import SWEEP_ANGLES
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.cooling import _enough, cooled_network, two_nodes
from cqdd_design.machine.duty_heat import DutyCase, DutyHeat, duty_cases, duty_heat
from cqdd_design.machine.heat_nodes import NODES, node_values
from cqdd_design.machine.settling import settle
from cqdd_design.machine.temperatures import (
    MachineTemperatures,
    heat_checks,
    judged_temperatures,
    machine_temperatures,
)
from cqdd_design.machine.thermal_parts import machine_network

W, H = NODES.index("winding"), NODES.index("housing")


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGN_S))


@pytest.fixture(scope="module")
def found(machine: Machine) -> MachineTemperatures:
    return machine_temperatures(machine)


def test_all_heat_leaves_to_the_air(found: MachineTemperatures) -> None:
    given = found.duty.heat.at(found.steady).sum()
    assert found.network.given_off(found.steady) == pytest.approx(given, rel=1e-9)
    assert found.as_drawn.gearbox == pytest.approx(
        found.machine.losses.at(
            found.machine.design.requirements.input_speed,
            found.machine.design.requirements.continuous_torque,
        ).total,
        rel=1e-12,
    )


def test_teeth_thicker_than_the_ring_conduct_through_its_wall(machine: Machine) -> None:
    """Their centres lie on the outside of the ring, or beyond it."""
    changes = {
        "requirements.ratio": 8,
        "reducer.ratio": 8,
        "reducer.eccentricity": 1.72e-3,
        "reducer.ring_pin_diameter": 14.1e-3,
        "reducer.disc_thickness": 8.9e-3,
        "reducer.cam_bearing.designation": "needle cage K8x11x8",
        "reducer.output_pins.count": 8,
        "reducer.output_pins.diameter": 5e-3,
        "reducer.output_pins.circle_radius": 14.8e-3,
        "reducer.output_pins.hole_clearance": 40e-6,
        "reducer.ring.outer_diameter": 55.5e-3,
    }
    values = []
    for radius in (27.7e-3, 27.75e-3, 27.8e-3):
        thick = resolve(
            machine.design.replacing(changes | {"reducer.ring_pitch_radius": radius}),
            machine.motor,
        )
        network = machine_network(thick)
        values.append(network.conductance[NODES.index("housing"), NODES.index("ring")])
    assert np.all(np.isfinite(values))
    assert min(values) > 0.0
    assert max(values) < 1.05 * min(values)


SHARES = {
    "ring_teeth": ("ring", "disc"),
    "output_pins": ("disc", "carrier"),
    "cam_bearings": ("disc", "shaft"),
    "support_bearings": ("shaft", "shaft", "housing", "carrier"),
    "output_bearing": ("housing", "carrier"),
    "grease": ("disc", "carrier"),
}
"""Parts that a loss warms alike."""


def lost_at(machine: Machine, at: np.ndarray) -> np.ndarray:
    """What every node loses with all parts at temperatures, W: one sweep, and the motor by hand."""
    told = dict(zip(NODES, at, strict=True))
    parts = {name: told[name] for name in ("ring", "disc", "carrier", "shaft")}
    warm = machine.at(PartTemperatures(**parts, pin=told["carrier"]))
    asked, row = machine.design.requirements, machine.motor
    torque, speed = asked.continuous_torque, asked.input_speed
    sweep = contact_sweep(
        warm.contact,
        torque,
        perfect_angles(warm.contact, SWEEP_ANGLES),
        friction=ContactFriction.of(warm.contact, "drive", speed),
    )
    work, drag = warm.friction.coulomb_work(sweep), warm.friction.drag(speed)
    lost, rubbed = dict.fromkeys(NODES, 0.0), 0.0
    for source, nodes in SHARES.items():
        taken = work[source] + float(drag[source])
        rubbed += taken
        for node in nodes:
            lost[node] += taken * speed / len(nodes)
    own = row.coulomb + row.viscous * speed
    flux = 1.0 - 0.0011 * (min(told["rotor"], WINDING_MOST) - 25.0)
    current = (torque / machine.design.reducer.ratio + rubbed + own) / (row.torque_constant * flux)
    winding = min(told["winding"], WINDING_MOST)
    lost["winding"] = row.line_resistance * (1.0 + 0.0039 * (winding - 25.0)) * current**2
    lost["stator"] = own * speed
    return np.array([lost[name] for name in NODES])


@pytest.mark.parametrize(
    ("ambient", "torque", "speed"), [("-20 degC", 4.0, 20.0), ("-20 degC", 6.0, 20.0)]
)
def test_losses_and_temperatures_are_each_others(
    machine: Machine, ambient: str, torque: float, speed: float
) -> None:
    """The steady state against a fixed-point iteration of its own, from warmer parts on."""
    mild = resolve(
        machine.given.replacing(
            {
                "environment.ambient": ambient,
                "environment.coldest": "-20 degC",
                "requirements.continuous_torque": torque,
                "requirements.input_speed": speed,
                "requirements.peak_torque": 30.0,
            }
        )
    )
    found = machine_temperatures(mild)
    network, now = found.network, np.full(len(NODES), 30.0)
    for _ in range(60):
        then = network.steady(Heat.constant(lost_at(mild, now)))
        moved, now = np.abs(then - now).max(), 0.3 * now + 0.7 * then
        if moved < 1e-8:
            break
    assert moved < 1e-8
    assert found.steady == pytest.approx(now, abs=1e-5)
    lost = lost_at(mild, found.steady)
    assert network.given_off(found.steady) == pytest.approx(lost.sum(), rel=1e-9)
    # What the feedback is worth here: far more than either bound.
    cold = network.steady(found.as_drawn.heat)
    assert np.abs(found.steady - cold).max() > 1.0
    assert abs(found.duty.gearbox / found.as_drawn.gearbox - 1.0) > 0.03


def test_flux_of_warm_magnets_asks_for_more_current(machine: Machine) -> None:
    cases = duty_cases(machine)
    cold, warm = duty_heat(machine, cases), duty_heat(machine, cases, 125.0)
    share = warm.current_squared / cold.current_squared
    assert share == pytest.approx(1.0 / (1.0 - 0.11) ** 2, rel=1e-12)


@pytest.mark.parametrize("gain", [-3.0, -0.9, 0.3, 0.9])
def test_settling_finds_the_state_whatever_comes_back(machine: Machine, gain: float) -> None:
    """Heat that grows or falls with the disc's temperature, in a network of constant slopes."""
    drawn = cooled_network(machine)
    network = replace(drawn, surfaces=(), to_ambient=np.full(len(NODES), 0.2))
    disc = NODES.index("disc")
    unit = network.resistances(disc, np.full(len(NODES), 50.0))

    def lost(warm: Machine, _: float) -> DutyHeat:
        watts = (35.0 + gain * (warm.temperatures.disc - 60.0)) / unit[disc]
        return DutyHeat(Heat.constant(watts * (np.arange(len(NODES)) == disc)), watts, 0.0)

    _, steady = settle(machine, network, lost)
    assert network.ambient == 25.0
    assert steady == pytest.approx(25.0 + 35.0 * unit / unit[disc], abs=1e-4)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_heat_and_current_close_the_balance_of_power(machine: Machine, sense: float) -> None:
    """What goes in at one end comes out at the other, or warms gearbox and stator."""
    torque, speed, n = 30.0, 100.0, machine.design.reducer.ratio
    found = duty_heat(machine, [DutyCase(torque, sense * speed, 1.0)])
    row = machine.motor
    assert row.torque_constant is not None
    assert row.line_resistance is not None
    drag = row.coulomb + row.viscous * speed
    stator = NODES.index("stator")
    assert drag > 0.05
    assert found.heat.fixed[stator] == pytest.approx(drag * speed, rel=1e-12)
    parts = np.delete(found.heat.fixed, [W, stator])
    assert parts.sum() == pytest.approx(found.gearbox, rel=1e-12)
    electrical = row.torque_constant * np.sqrt(found.current_squared) * speed
    mechanical = torque * speed / n
    warm = found.gearbox + drag * speed
    assert electrical == pytest.approx(mechanical + sense * warm, rel=1e-9)
    at = np.full(len(NODES), 80.0)
    copper = found.current_squared * row.line_resistance * (1.0 + 0.0039 * (80.0 - 25.0))
    assert found.heat.at(at)[W] == pytest.approx(copper, rel=1e-12)


def test_a_motor_pushes_what_its_gearbox_holds(machine: Machine) -> None:
    """A light load does not turn gearbox and motor: the motor has to, against their friction."""
    light = duty_heat(machine, [DutyCase(0.5, -100.0, 1.0)])
    none = duty_heat(machine, [DutyCase(0.0, 100.0, 1.0)])
    assert 0.0 < light.current_squared < none.current_squared


def test_warming_stores_what_does_not_leave(found: MachineTemperatures) -> None:
    """Energy over a start: what is put in is stored or given off."""
    network = found.network
    heat = Heat.constant(found.duty.heat.at(found.steady))
    times = np.linspace(0.0, 600.0, 1201)[1:]
    warm = network.history(heat, times)
    stored = float(network.capacity @ (warm[-1] - network.ambient))
    rates = [network.given_off(one) for one in warm]
    left = float(np.trapezoid([0.0, *rates], [0.0, *times]))
    assert stored + left == pytest.approx(600.0 * heat.fixed.sum(), rel=1e-3)


def test_a_warm_start_ends_where_a_cold_one_does(found: MachineTemperatures) -> None:
    assert found.history[-1] == pytest.approx(found.steady, abs=0.01 * found.steady.max())
    assert np.all(np.diff(found.history, axis=0) > -1e-6)


@pytest.mark.parametrize("name", ["reference-s", "cqdd-10"])
def test_finite_differences_of_the_drawn_stack_agree(name: str, found: MachineTemperatures) -> None:
    if name == "cqdd-10":
        found = machine_temperatures(resolve(paper_design()))
    fields = stack_temperatures(found)
    ambient = found.network.ambient
    for node, value in fields.items():
        rise = found.steady[NODES.index(node)] - ambient
        assert rise == pytest.approx(value - ambient, rel=0.15), node


def test_two_nodes_are_the_network(machine: Machine) -> None:
    """Winding and housing of the actuator are as warm as in the whole, at the winding's limit."""
    network = cooled_network(machine)
    few, whole = two_nodes(network), actuator_parameters(machine)
    assert whole.thermal.winding_to_housing == few.winding_to_housing
    assert whole.origins["thermal.housing_to_ambient"].startswith("computed: thermal network")
    total = few.winding_to_housing + few.housing_to_ambient
    watts = (WINDING_MOST - network.ambient) / total
    steady = network.steady(Heat.constant(node_values({"winding": watts})))
    assert steady[W] == pytest.approx(WINDING_MOST, abs=1e-6)
    assert steady[H] - network.ambient == pytest.approx(watts * few.housing_to_ambient, rel=1e-6)
    held = few.winding_capacity * (steady[W] - network.ambient)
    held += few.housing_capacity * (steady[H] - network.ambient)
    assert held == pytest.approx(network.capacity @ (steady - network.ambient), rel=1e-6)
    assert continuous_current(whole.motor, whole.thermal) ** 2 * whole.motor.resistance * (
        1.0 + 0.0039 * (WINDING_MOST - 25.0)
    ) == pytest.approx(watts, rel=1e-9)


@pytest.mark.parametrize("stated", [0.3, 0.8, 1.2, 6.0])
def test_a_stated_resistance_holds_from_winding_to_air(machine: Machine, stated: float) -> None:
    cooled = resolve(machine.given.replacing({"drive.thermal_resistance": stated}))
    assert sum(two_nodes(cooled_network(cooled))[:2]) == pytest.approx(stated, rel=1e-6)


def test_a_duty_heats_as_its_mean(machine: Machine) -> None:
    asked = machine.design.requirements
    n, torque = machine.design.reducer.ratio, asked.continuous_torque
    speed = asked.input_speed / n
    half = [
        {"torque": torque, "speed": speed, "share": 0.5},
        {"torque": 0.0, "speed": 0.0, "share": 0.5},
    ]
    other = resolve(machine.given.replacing({"requirements.duty": half}))
    assert [case.share for case in duty_cases(other)] == [0.5, 0.5]
    rest, whole = machine_temperatures(other), machine_temperatures(machine)
    assert rest.as_drawn.gearbox == pytest.approx(0.5 * whole.as_drawn.gearbox, rel=1e-9)
    assert rest.as_drawn.current_squared < 0.55 * whole.as_drawn.current_squared
    alone = machine_temperatures(other, duty=False)
    assert alone.steady == pytest.approx(whole.steady, rel=1e-12)


@pytest.mark.parametrize("watts", [10.0, 1000.0])
def test_a_cycle_settles_however_hot_it_is(machine: Machine, watts: float) -> None:
    """Its mean is that of its mean heat; surfaces of 1700 deg C went to and fro in whole steps."""
    network, steps = cooled_network(machine), np.array([1.0, 2.0, 1.0])
    fixed, none = np.zeros((3, len(NODES))), np.zeros((3, len(NODES)))
    fixed[:, NODES.index("winding")] = watts * np.array([2.0, 0.5, 1.0])
    most = np.full(len(NODES), np.inf)
    found = settled_cycle(network, steps, Heat(fixed, none, most))
    mean = steps @ (0.5 * (found + np.roll(found, 1, axis=0))) / steps.sum()
    steady = network.steady(Heat(steps @ fixed / steps.sum(), none[0], most))
    # Within a step it is no straight line.
    assert mean == pytest.approx(steady, rel=2e-3)
    assert np.ptp(found[:, NODES.index("winding")]) > 0.02 * watts


def test_a_cycle_of_parts_that_do_not_press_is_their_own(machine: Machine, tmp_path: Path) -> None:
    """Where parts run away from what they lose as drawn, its winding is not that of burnt ones."""
    (tmp_path / "steady.csv").write_text("t [s],torque [N*m],speed [rad/s]\n0,8,2\n1,8,2\n2,8,2\n")
    log = read_duty(tmp_path / "steady.csv")
    given = machine.given
    logged = given.replacing({"requirements.duty_file": "steady.csv"}).with_duty_log(log)
    steady = {"requirements.duty": [{"torque": 8.0, "speed": 2.0, "share": 1.0}]}
    found = machine_temperatures(replace(resolve(logged), stiff=True))
    assert found.cycle is not None
    assert found.hottest("winding") > 500.0
    same = machine_temperatures(replace(resolve(given.replacing(steady)), stiff=True))
    assert found.undisturbed.hottest("winding") == pytest.approx(
        same.undisturbed.hottest("winding"), rel=1e-3
    )
    assert found.undisturbed.hottest("winding") < 100.0


def test_reference_s_is_too_hot_and_binds(found: MachineTemperatures) -> None:
    rise, clearance = heat_checks(found)
    assert (rise.id, rise.status) == ("THERMAL-RISE", "fail")
    assert (clearance.id, clearance.status) == ("THERMAL-CLEARANCE", "fail")
    assert clearance.value > 10.0
    assert found.warnings


@pytest.mark.parametrize(("winding", "said"), [(299.0, False), (301.0, True)])
def test_what_no_part_stands_is_told_as_a_measure_of_heat(winding: float, said: bool) -> None:
    parts = (WarmPart("winding", winding, 120.0), WarmPart("housing", 90.0, 80.0))
    line = rise_check(parts, 25.0, 400.0, 390.0)
    assert (line.value, line.status) == (winding, "fail")
    assert ("beyond 300 degC" in line.substituted) is said
    assert f"winding {winding:.0f} of 120 degC, housing 90 of 80 degC in air" in line.substituted


@pytest.mark.deep
def test_parts_that_press_on_each_other_heat_themselves(machine: Machine) -> None:
    """A load that S bears as drawn: its carrier grows, warm parts rub more, and heat runs away."""
    warm = resolve(
        machine.given.replacing(
            {"requirements.continuous_torque": 8.0, "requirements.input_speed": 15.0}
        )
    )
    found, checks, told = judged_temperatures(warm)
    assert found is not None
    assert found.undisturbed.steady.max() < 100.0
    assert found.steady.max() > 200.0
    assert "heat runs away" in told[0]
    # What is lacking is what warmth takes before parts press, not what they do once they burn.
    (clearance,) = (one for one in checks if one.id == "THERMAL-CLEARANCE")
    assert 0.0 < found.lacking_clearance < 0.4e-6 * clearance.value
    wider = {"reducer.output_pins.hole_clearance": 16e-6 + 8.0 * found.lacking_clearance}
    free = machine_temperatures(resolve(warm.given.replacing(wider)))
    assert free.steady.max() < 100.0
    assert [one.status for one in heat_checks(free)] == ["pass", "pass"]


@pytest.mark.parametrize(
    ("hole", "torque"),
    [(10e-6, 1.0), pytest.param(16e-6, 8.0, marks=pytest.mark.deep)],
)
def test_the_clearance_that_is_advised_frees_warm_parts(
    machine: Machine, hole: float, torque: float
) -> None:
    asked = {
        "requirements.continuous_torque": torque,
        "requirements.input_speed": 15.0,
        "reducer.output_pins.hole_clearance": hole,
    }
    tight = machine.given.replacing(asked)
    _, checks, _ = judged_temperatures(resolve(tight))
    (line,) = (one for one in checks if one.id == "THERMAL-CLEARANCE")
    assert line.status == "fail"
    told = re.search(r"give hole_clearance ([\d.]+) um more", line.remedy)
    assert told is not None
    wider = {"reducer.output_pins.hole_clearance": hole + 1e-6 * float(told[1])}
    _, checks, _ = judged_temperatures(resolve(tight.replacing(wider)))
    assert [one.status for one in checks] == ["pass", "pass"]


def test_parts_too_warm_as_drawn_are_cooled_first() -> None:
    """Of cqdd-10, far beyond its limits, no clearance is advised that would not do."""
    _, checks, _ = judged_temperatures(resolve(paper_design()))
    (line,) = (one for one in checks if one.id == "THERMAL-CLEARANCE")
    assert line.status == "fail"
    assert "cool the parts first (see THERMAL-RISE)" in line.remedy


def test_where_warm_parts_have_no_losses_nothing_passes(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none(*_: object) -> None:
        raise ContactError("no equilibrium")

    monkeypatch.setattr("cqdd_design.machine.temperatures.settle", none)
    cool = {"requirements.continuous_torque": 2.0, "requirements.input_speed": 10.0}
    steel = {"housing.material": "AISI 4140 Q&T 540C"}
    light = machine_temperatures(resolve(machine.given.replacing(cool | steel)))
    assert np.array_equal(light.steady, light.undisturbed.steady)
    assert [one.status for one in heat_checks(light)] == ["unknown", "unknown"]
    assert "losses are those at 20 degC" in light.warnings[0]
    hot = machine_temperatures(machine)
    assert [one.status for one in heat_checks(hot)] == ["fail", "fail"]


def test_a_printed_part_gives_way_before_its_grease(machine: Machine) -> None:
    """Ring and discs of PC with carbon fibre bear 110 deg C, where the grease bears 120."""
    printed = load_design(DESIGN_S.with_name("printed-13.toml"))
    found = machine_temperatures(resolve(printed))
    ring = found.steady[NODES.index("ring")]
    assert 110.0 < ring < 120.0
    rise = heat_checks(found)[0]
    assert (rise.status, rise.limit) == ("fail", 110.0)
    assert rise.value == pytest.approx(ring)
    assert f"ring {ring:.0f} of 110" in rise.substituted


def test_a_little_torque_of_a_steel_machine_passes_both(machine: Machine) -> None:
    light = resolve(
        machine.given.replacing(
            {
                "requirements.continuous_torque": 2.0,
                "requirements.input_speed": 10.0,
                "housing.material": "AISI 4140 Q&T 540C",
            }
        )
    )
    _, checks, told = judged_temperatures(light)
    assert [check.status for check in checks] == ["pass", "pass"]
    assert checks[1].value <= BINDING_OVERLAP
    assert not told


def test_what_is_not_known_is_said(machine: Machine) -> None:
    carbon = resolve(machine.given.replacing({"housing.material": "PA6-CF 15% FDM"}))
    found, checks, told = judged_temperatures(carbon)
    assert found is None
    assert checks == ()
    assert "no temperatures of parts: the catalogue has no" in told[0]
    assert "PA6-CF" in told[0]
    origin = actuator_parameters(carbon).origins["thermal.winding_to_housing"]
    assert origin.startswith("assumed: 1.2 K/W split 1 to 2")


def test_a_limit_at_the_end_of_what_is_tried_is_found() -> None:
    """Met at 100 W to the last digit, and by that not at the power of 100's logarithm."""

    def surplus(x: float) -> float:
        return 1e-13 if x == 100.0 else x - 100.0 - 1e-12

    assert math.exp(math.log(100.0)) != 100.0
    assert _enough(surplus, 1e-3, 1e5) == pytest.approx(100.0, rel=1e-9)
