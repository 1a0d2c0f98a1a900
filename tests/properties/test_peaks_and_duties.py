"""At which friction, temperature and torque a verdict judges peaks, speeds and duties."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.operating import needed
from cqdd_design.actuator.shock import peak_current, simulated_torque
from cqdd_design.design import Design, load_design
from cqdd_design.design.duty_log import DutyLog
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.run import run_ensemble
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.body_analysis import analyse_bodies
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.machine.dowels import loaded_dowels
from cqdd_design.results import Check
from cqdd_design.sizing.bearable import weaker
from cqdd_design.verdict.drawn import drawn_gearboxes
from cqdd_design.verdict.motor import motor_lines

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def design() -> Design:
    return load_design(ROOT / "docs" / "gallery" / "plain-10.toml")


@pytest.fixture(scope="module")
def machine(design: Design) -> Machine:
    return resolve(design)


def _motor(design: Design, check: str) -> Check:
    machine = replace(resolve(design), stiff=True)
    lines = motor_lines(machine, actuator_parameters(machine), "")
    return next(line for line in lines if line.id == check)


def test_the_peak_torque_loads_a_gearbox_that_stands(machine: Machine) -> None:
    """Without films teeth and pins rub by the boundary coefficient, and press the cam by more."""
    torque, model = 50.0, machine.contact
    rest = ContactFriction.of(model, "drive", 0.0)
    assert rest is not None
    sweeps = [
        contact_sweep(model, one, perfect_angles(model, 120), friction=rest)
        for one in (torque, -torque)
    ]
    loads = machine.loaded_contacts.greatest(torque, 120)
    assert loads["cam_bearing_load_max_N"] == pytest.approx(
        max(float(one.cam_load.max()) for one in sweeps), rel=1e-9
    )
    running = ContactFriction.of(model, "drive")
    film = contact_sweep(model, torque, perfect_angles(model, 120), friction=running)
    assert loads["cam_bearing_load_max_N"] > 1.01 * film.cam_load.max()


def test_shaft_and_bodies_are_loaded_at_rest(machine: Machine) -> None:
    """What the shaft carries, and what stresses discs and ring, at the peak torque."""
    torque, model = machine.design.requirements.peak_torque, machine.contact
    angles, rest = perfect_angles(model, 120), ContactFriction.of(model, "drive", 0.0)
    sweeps = [contact_sweep(model, one, angles, friction=rest) for one in (torque, -torque)]
    assert machine.peak_pack.on_shaft == pytest.approx(PackLoads.of(sweeps).on_shaft, rel=1e-9)
    rubbed = {"reducer.friction.tooth": 0.1, "reducer.friction.pin": 0.1}
    other = machine.changed(rubbed)
    own, given = (analyse_bodies(one) for one in (machine, other))
    assert [one.stress for one in own.peaks] == pytest.approx([one.stress for one in given.peaks])
    shown, as_given = (analyse_contact(one, angles=24) for one in (machine, other))
    assert shown.sweep.cam_load == pytest.approx(as_given.sweep.cam_load, rel=1e-9)


def test_a_verdict_draws_its_gearboxes_at_rest_and_running(machine: Machine) -> None:
    drawn = drawn_gearboxes(machine, 2, sensitivity=False, rigid=True)
    assert drawn.peak.ensemble.at_rest
    assert not drawn.continuous.ensemble.at_rest
    asked = machine.design.requirements
    assert drawn.peak.ensemble.torque == asked.peak_torque
    assert drawn.continuous.ensemble.torque == asked.continuous_torque


def test_toleranced_gearboxes_rub_at_rest_too(design: Design) -> None:
    """Friction as given is that of films nowhere: at rest an ensemble is the one of mu = 0.1."""
    few = {"angles": 88, "torque": 40.0, "rigid": True}
    rubbed = design.replacing({"reducer.friction.tooth": 0.1, "reducer.friction.pin": 0.1})
    values = [
        run_ensemble(make_ensemble(one, at_rest=rest, **few), 2, sensitivity=False).values
        for one, rest in ((design, True), (rubbed, False), (design, False))
    ]
    assert values[0] == pytest.approx(values[1], rel=1e-9)
    assert not np.allclose(values[0], values[2], rtol=1e-3)


def test_a_duty_is_drawn_at_the_torque_that_stands_for_it(design: Design) -> None:
    """Mean by cubes over turns: (0.3 1 20^3 + 0.5 2 8^3)/(0.3 1 + 0.5 2), its root."""
    duty = [
        {"torque": "20 N*m", "speed": "1 rad/s", "share": 0.3},
        {"torque": "-8 N*m", "speed": "2 rad/s", "share": 0.5},
    ]
    asked = design.replacing({"requirements.duty": duty})
    mean = ((0.3 * 20.0**3 + 1.0 * 8.0**3) / 1.3) ** (1.0 / 3.0)
    assert asked.requirements.equal_torque == pytest.approx(mean)
    assert make_ensemble(asked, rigid=True).torque == pytest.approx(mean)
    assert design.requirements.equal_torque == design.requirements.continuous_torque
    still = [{"torque": "20 N*m", "speed": "0 rad/s", "share": 0.3}]
    held = design.replacing({"requirements.duty": still})
    assert held.requirements.equal_torque == 20.0
    idle = [{"torque": "0 N*m", "speed": "2 rad/s", "share": 0.3}]
    spun = design.replacing({"requirements.duty": idle}).requirements
    assert spun.equal_torque == spun.continuous_torque


def test_a_duty_beyond_the_peak_torque_is_outside(design: Design) -> None:
    """Parts are judged up to the peak torque, whatever the motor could do."""
    duty = [
        {"torque": "55 N*m", "speed": "0 rad/s", "share": 0.001},
        {"torque": "2 N*m", "speed": "0.5 rad/s", "share": 0.9},
    ]
    line = _motor(design.replacing({"requirements.duty": duty}), "DUTY-ENVELOPE")
    assert (line.status, line.value) == ("fail", 1.0)
    assert "55 N*m at 0 rad/s" in line.substituted
    assert "55 N*m at 0 rad/s, peak torque that is asked for" in line.substituted
    assert "raise requirements.peak_torque" in line.remedy
    duty[0]["torque"] = "50 N*m"
    inside = _motor(design.replacing({"requirements.duty": duty}), "DUTY-ENVELOPE")
    assert inside.status == "pass"


def test_what_turns_fast_is_judged_at_the_fastest_of_the_duty(design: Design) -> None:
    duty = [{"torque": "2 N*m", "speed": "26 rad/s", "share": 0.9}]
    asked = design.replacing({"requirements.duty": duty})
    assert asked.requirements.fastest_speed == pytest.approx(260.0)
    fast, usual = resolve(asked).balance, resolve(design).balance
    ratio = (260.0 / design.requirements.input_speed) ** 2
    assert fast.shaking_moment == pytest.approx(ratio * usual.shaking_moment)


def test_a_cold_motor_is_the_slower_one(design: Design) -> None:
    """KV 55 on 48 V turns 2640 rpm without load and drag, with magnets at 20 degC."""
    line = _motor(design.replacing({"motor.voltage": "48 V"}), "MOTOR-SPEED")
    assert line.value is not None
    assert 2500.0 < line.value < 2640.0
    assert "motor cold" in line.substituted
    machine = resolve(design)
    actuator = actuator_parameters(replace(machine, stiff=True))
    speed = line.value * math.pi / 30.0 / design.reducer.ratio
    cold, hot = (
        needed(actuator, 0.0, speed, at).voltage
        for at in (actuator.thermal.ambient, actuator.thermal.most)
    )
    assert hot < cold <= 48.0 * (1.0 + 1e-6)


def test_a_step_that_only_a_cold_motor_misses_is_outside(design: Design) -> None:
    """1 N m at 29.5 rad/s takes some 46 V of hot magnets, and 51 V of cold ones."""
    duty = [
        {"torque": "1 N*m", "speed": "29.5 rad/s", "share": 0.05},
        {"torque": "1 N*m", "speed": "0.5 rad/s", "share": 0.5},
    ]
    changes = {"requirements.duty": duty, "motor.voltage": "48 V"}
    line = _motor(design.replacing(changes), "DUTY-ENVELOPE")
    assert (line.status, line.value) == ("fail", 1.0)
    assert "voltage" in line.substituted


def test_a_peak_says_what_is_left_of_it_when_hot(design: Design) -> None:
    line = _motor(design, "MOTOR-PEAK")
    assert "motor cold" in line.substituted
    hot = float(line.substituted.split("motor cold; ")[1].split(" N*m")[0])
    assert line.value is not None
    assert 0.85 < hot / line.value < 0.93


def test_a_stop_says_what_a_motor_does_that_drives_on(design: Design) -> None:
    actuator = actuator_parameters(replace(resolve(design), stiff=True))
    off = simulated_torque(actuator, 1.0)
    driven = simulated_torque(actuator, 1.0, peak_current(actuator))
    assert driven > off


def test_dowels_of_the_output_hold_what_pushes_across(design: Design) -> None:
    """By hand: T/(0.75 n R) of the torque, F/(0.75 n) of the force, where both have one way."""
    pushed = design.replacing({"requirements.external_radial": "900 N"})
    before, after = (loaded_dowels(resolve(one))[-1] for one in (design, pushed))
    circle = resolve(design).layout.carrier.bolt_circle_radius
    torque = design.requirements.peak_torque
    assert after.stress.shear / before.stress.shear == pytest.approx(1.0 + 900.0 * circle / torque)
    assert after.across == 900.0


def test_a_peak_that_nobody_stated_is_not_lowered_below_the_duty(design: Design) -> None:
    """What a duty asks for parts have to bear: less would be outside."""
    duty = [{"torque": "45 N*m", "speed": "0.5 rad/s", "share": 0.1}]
    changes = {"requirements.duty": duty, "requirements.peak_torque": 60.0}
    free = design.replacing(changes).requirements.deriving("peak_torque")
    assert weaker(free, 0.5, 1.0).peak_torque == 45.0
    assert 52.0 < weaker(free, 0.9, 1.0).peak_torque <= 54.0


@pytest.mark.parametrize(
    ("torque", "speed", "why"),
    [(1.0, 29.5, "voltage"), (55.0, 0.0, "55 N*m at 0 rad/s, peak torque that is asked for")],
)
def test_rows_of_a_log_are_judged_cold_and_up_to_the_peak(
    design: Design, torque: float, speed: float, why: str
) -> None:
    """As steps: 29.5 rad/s takes 46 V hot and 51 V cold; 55 N m the motor does, but no part is
    judged for it.
    """
    made = np.array([2.0, 2.0, torque, 2.0, 2.0]), np.array([0.5, 0.5, speed, 0.5, 0.5])
    log = DutyLog("made", f"{torque} {speed}", 2, np.linspace(0.0, 4.0, 5), *made)
    plain = design.replacing({"motor.voltage": "48 V", "requirements.duty_file": "made.csv"})
    asked = plain.requirements.with_duty_log(log)
    machine = replace(resolve(plain.model_copy(update={"requirements": asked})), stiff=True)
    lines = motor_lines(machine, actuator_parameters(machine), "")
    (line,) = (one for one in lines if one.id == "DUTY-ENVELOPE")
    assert (line.status, line.value) == ("fail", 1.0)
    assert why in line.substituted
    assert ("raise requirements.peak_torque" in line.remedy) == (torque > 50.0)
