"""The actuator in time: energy, passivity, analytic limits, scipy, the plain twin, bad input."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from actuator_machines import COLD, NO_FRICTION, machine, smooth
from actuator_twin import in_plain_numpy
from examples import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cqdd_design.actuator.columns import TRACES
from cqdd_design.actuator.operating import output_torque
from cqdd_design.actuator.packing import largest_step
from cqdd_design.actuator.parameters import (
    FrictionParameters,
)
from cqdd_design.actuator.scenario import (
    Chirp,
    Command,
    Constant,
    Load,
    Ramp,
    Sampled,
    Scenario,
    Signal,
    Sine,
    Start,
    Wall,
)
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.errors import DesignError, UsageError

SAMPLE = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
LOSSES = ("copper", "iron", "motor_friction", "output_friction", "gear_damping", "load_damping")
SCENES = {
    "locked": Scenario(Command("torque", Sine(20.0, 20.0)), Load.locked(5e4, 1.0)),
    "free": Scenario(Command("voltage", Constant(24.0)), Load.free()),
    "current": Scenario(Command("current", Sine(60.0, 30.0)), Load.flywheel(0.05, 0.1)),
    "wall": Scenario(
        Command("impedance", Sine(0.5, 4.0)),
        Load.pendulum(2.0, 0.5, viscous=0.02, wall=Wall(0.05, 3000.0)),
    ),
    "position": Scenario(
        Command("position", Constant(-0.3), integral_gain=20.0), Load.pendulum(1.0, 0.3)
    ),
    "driven": Scenario(Command("open"), Load.driven(Sine(1.0, 3.0))),
    "pushed": Scenario(Command("voltage"), Load.flywheel(0.01, torque=Sine(5.0, 3.0))),
}


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_motors_own_drag_brakes_in_both_senses_and_is_heat(sense: float, friction: str) -> None:
    """Coulomb and viscous drag of the motor alone: a torque against the motion, kept in the books.

    It is counted with the friction of the motor and not with the iron, and cogging, fine enough to
    pass several periods a step, takes and gives.
    """
    bare = machine(hysteresis=0.0, iron_loss=0.0, cogging_amplitude=0.0)
    drag = {"coulomb": 0.05, "viscous": 4e-4, "cogging_amplitude": 0.05, "cogging_order": 252}
    own = replace(bare, motor=replace(bare.motor, **drag))
    scene = Scenario(
        Command("open"), Load.driven(Constant(sense * 8.0)), Start(output_speed=sense * 8.0),
        friction=friction,
    )  # fmt: skip
    runs = simulate([bare, own], scene, 2.0, 5e-5, every=20)
    late = runs.time > 0.5
    n = abs(own.gear.ratio)
    braked = -sense * (runs.output_torque[1, late].mean() - runs.output_torque[0, late].mean())
    wanted = (0.05 + 4e-4 * n * 8.0) * n / (1.0 - own.friction.load_backward)
    assert braked == pytest.approx(wanted, rel=0.03)
    assert np.all(runs.ledger.residual_share < 1e-9)
    assert np.all(runs.ledger.iron == 0.0)
    assert runs.ledger.motor_friction[1] > runs.ledger.motor_friction[0]


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("name", list(SCENES))
def test_energy_is_kept_over_ten_seconds(name: str, friction: str) -> None:
    scene = replace(SCENES[name], friction=friction)
    found = simulate(machine(), scene, 10.0, 2e-5, every=1000)
    assert found.ledger.throughput[0] > 1e-3
    assert found.ledger.residual_share[0] < 1e-6
    assert not found.warnings
    assert all(getattr(found.ledger, loss)[0] >= 0.0 for loss in LOSSES)


@pytest.mark.parametrize("friction", ["clip", "lugre"])
@pytest.mark.parametrize("name", list(SCENES))
def test_kernel_and_plain_twin_agree(name: str, friction: str) -> None:
    scene = replace(SCENES[name], friction=friction)
    # Nearly all that is carried is above the knee.
    own = machine(friction=replace(machine().friction, load_knee=0.1, load_growth=0.4))
    fast = simulate(own, scene, 0.008, 2e-5)
    with in_plain_numpy():
        slow = simulate(own, scene, 0.008, 2e-5)
    assert slow.ledger.residual_share[0] < 1e-12
    scale = {"output_torque": 1.0, "motor_friction": 1.0, "output_friction": 1.0}
    for trace in TRACES:
        ours, theirs = getattr(fast, trace), getattr(slow, trace)
        size = max(float(np.abs(theirs).max()), scale.get(trace, 1e-4))
        np.testing.assert_allclose(ours, theirs, atol=1e-6 * size, rtol=0, err_msg=trace)


@pytest.mark.parametrize("sense", [1.0, -1.0], ids=["driving", "driven"])
def test_friction_beyond_the_knee_is_that_of_the_operating_points(sense: float) -> None:
    """Slow steady motion under a current, on a law of its own in plain numpy."""
    friction = FrictionParameters(0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.3, 0.25)
    speed, torques = 2.0, []
    for knee, growth in ((0.0, 0.0), (8.0, 0.5)):
        own = smooth(friction=replace(friction, load_knee=knee, load_growth=growth))
        way = sense * math.copysign(1.0, own.gear.ratio)
        current = 20.0 / (abs(own.gear.ratio) * own.motor.torque_constant)
        # Brought up slowly: a jump would leave the motor swinging on the gearbox's stiffness.
        slowly = Sampled(np.array([0.0, 1.0]), np.array([0.0, way * current]))
        load, start = Load.driven(Constant(speed)), Start(output_speed=speed)
        run = simulate(own, Scenario(Command("current", slowly), load, start), 2.0, 5e-5, every=20)
        found = float(run.output_torque[0][run.time > 1.5].mean())
        # What comes in as 20 N m is G (1 + mu), and mu/2 more for each N m above the knee; driven,
        # G (1 - mu) is left.
        share = sense * (0.3 if sense > 0.0 else 0.25)
        wanted = (20.0 + share * growth * knee) / (1.0 + share * (1.0 + growth))
        assert found == pytest.approx(sense * wanted, rel=2e-3)
        torques.append(wanted)
        if sense > 0.0:
            told = output_torque(own, 20.0 / abs(own.gear.ratio), speed)
            assert float(told) == pytest.approx(wanted)
    assert (torques[1] < torques[0]) == (sense > 0.0)


CONTACTS = {
    "friction": st.builds(
        FrictionParameters,
        motor_coulomb=st.floats(0.0, 0.3),
        output_coulomb=st.floats(0.0, 2.0),
        motor_viscous=st.floats(0.0, 1e-2),
        output_viscous=st.floats(0.0, 0.1),
        stribeck_extra=st.floats(0.0, 1.0),
        stribeck_speed=st.floats(0.5, 20.0),
        load_forward=st.floats(0.0, 1.5),
        load_backward=st.floats(0.0, 1.5),
        bristle_deflection=st.floats(1e-4, 1e-2),
        bristle_damping=st.floats(0.0, 0.1),
    ),
    "backlash": st.just(0.0) | st.floats(1e-5, 5e-3),
    "damping": st.floats(0.0, 5.0),
    "stiffening": st.floats(1.0, 2.0),
    "speed": st.floats(-10.0, 10.0),
    "motor_speed": st.floats(-100.0, 100.0),
    "wound": st.floats(-0.03, 0.03),
    "step": st.floats(2e-6, 3e-5),
    "model": st.sampled_from(["clip", "lugre"]),
}
"""A free machine that begins wound up and moving, down to gaps that a step crosses whole."""


def bounced(
    damping: float,
    stiffening: float,
    speed: float,
    motor_speed: float,
    wound: float,
    step: float,
    backlash: float = 1e-5,
) -> Any:
    """Contacts without friction that once pulled, or whose equations had no solution."""
    return example(NO_FRICTION, backlash, damping, stiffening, speed, motor_speed, wound, step,
                   "clip")  # fmt: skip


@pytest.mark.deep
@settings(max_examples=3000, deadline=None)
@given(**CONTACTS)
def test_no_machine_is_given_energy(**contact: Any) -> None:
    keeps_energy(**contact)


@settings(max_examples=examples(25), deadline=None)
@given(**CONTACTS)
@bounced(2.875, 1.0, 6.5, 37.0, 0.015625, 2.665e-5)
@bounced(1.0, 1.0, 6.5, 36.0, 0.0234375, 2.665e-5)
@bounced(5.0, 1.25, 7.09359268627194, -25.875680519488895, 0.02113827797477149, 2.09808349609375e-5)
@bounced(1.25, 1.0, -10.0, 100.0, -0.013859719914839707, 2.808741913868685e-05, 1.13431802463e-05)
def test_friction_and_backlash_never_give_energy(
    friction: FrictionParameters,
    backlash: float,
    damping: float,
    stiffening: float,
    speed: float,
    motor_speed: float,
    wound: float,
    step: float,
    model: Any,
) -> None:
    keeps_energy(friction, backlash, damping, stiffening, speed, motor_speed, wound, step, model)


def keeps_energy(
    friction: FrictionParameters,
    backlash: float,
    damping: float,
    stiffening: float,
    speed: float,
    motor_speed: float,
    wound: float,
    step: float,
    model: Any,
) -> None:
    one = machine(friction, backlash=backlash, damping=damping, stiffening=stiffening)
    start = Start(motor_angle=wound, motor_speed=motor_speed, output_speed=speed)
    scene = Scenario(Command("open"), Load.free(), start, model)
    found = simulate(one, scene, 2000 * step, step)
    ledger = found.ledger
    scale = float(ledger.stored_before[0]) + 1e-3
    assert not found.warnings
    assert abs(ledger.residual[0]) < 1e-7 * scale
    for loss in LOSSES:
        assert getattr(ledger, loss)[0] >= -1e-12 * scale
    if backlash > 0.0:
        apart = np.sign(found.deflection) * np.maximum(
            np.abs(found.deflection) - 0.5 * backlash, 0.0
        )
        # Contact pushes only: within a step the sides do not change but at its ends.
        inside = (np.abs(apart[0, 1:]) > 0.0) & (apart[0, 1:] * apart[0, :-1] > 0.0)
        assert np.all(found.gear_torque[0, 1:][inside] * apart[0, 1:][inside] >= -1e-9)
    if model == "clip":
        mean = np.diff(found.motor_angle[0]) / step
        viscous = friction.motor_viscous * mean
        dry = found.motor_friction[0, 1:] - viscous
        assert np.all(dry * mean >= -1e-7 * (np.abs(dry).max() + 1e-3))


@pytest.mark.parametrize("damping", [2.0, 5.0])
@pytest.mark.parametrize("friction", ["clip", "lugre"])
def test_kernel_and_plain_twin_agree_across_a_gap_of_one_step(
    friction: Any, damping: float
) -> None:
    one = machine(NO_FRICTION, backlash=1e-5, damping=damping, stiffening=1.25)
    start = Start(motor_angle=0.021, motor_speed=-26.0, output_speed=7.0)
    scene = Scenario(Command("open"), Load.free(), start, friction)
    fast = simulate(one, scene, 0.01, 2e-5)
    with in_plain_numpy():
        slow = simulate(one, scene, 0.01, 2e-5)
    passed = fast.deflection[0, 1:] * fast.deflection[0, :-1] < 0.0
    assert passed.any()
    assert not fast.warnings
    for run in (fast, slow):
        assert abs(run.ledger.residual[0]) < 1e-9 * run.ledger.stored_before[0]
    np.testing.assert_allclose(fast.gear_torque, slow.gear_torque, atol=1e-5)
    np.testing.assert_allclose(fast.ledger.gear_damping, slow.ledger.gear_damping, rtol=1e-8)


def test_dry_friction_holds_a_pendulum_for_good() -> None:
    one = machine(replace(machine().friction, motor_coulomb=1.0), cogging_amplitude=0.0)
    scene = Scenario(Command("open"), Load.pendulum(2.0, 0.25), Start(output_angle=0.8))
    found = simulate(one, scene, 3.0, 2e-5, every=500)
    last = found.output_angle[0, -60:]
    assert np.ptp(found.motor_angle[0, -60:]) == 0.0
    assert np.ptp(last) < 1e-12
    assert last[0] > 0.7


def test_friction_of_both_realisations_agrees_while_sliding() -> None:
    scene = Scenario(Command("open"), Load.driven(Constant(1.0)))
    both = [
        simulate(machine(), replace(scene, friction=kind), 0.5, 2e-5, every=10)
        for kind in ("clip", "lugre")
    ]
    mean = [float(run.motor_friction[0, -1000:].mean()) for run in both]
    assert mean[0] == pytest.approx(mean[1], rel=0.01)


@pytest.mark.parametrize("forward", [True, False])
def test_load_friction_gives_its_efficiency(forward: bool) -> None:
    friction = replace(NO_FRICTION, load_forward=0.3, load_backward=0.25)
    one = machine(friction, cogging_amplitude=0.0, hysteresis=0.0, iron_loss=0.0, thermal=COLD)
    load = Load.flywheel(0.1, torque=Constant(-10.0 if forward else 10.0))
    # The motor gives, or holds back, what the efficiency leaves of 10 N m at the output.
    torque = 1.3 if forward else -0.75
    current = -torque / one.motor.torque_constant
    start = Start(output_speed=1.0, current=current)
    found = simulate(one, Scenario(Command("current", Constant(current)), load, start), 1.0, 2e-5,
                     every=10)  # fmt: skip
    # Balanced by the efficiency, the machine neither gains nor loses speed.
    speed = found.output_speed[0]
    assert abs(float(speed[-2000:].mean()) - float(speed[3000:5000].mean())) < 0.02


@pytest.mark.parametrize("mode", ["torque", "impedance", "position"])
def test_a_positive_command_moves_the_output_positively(mode: Any) -> None:
    scene = Scenario(Command(mode, Constant(0.5)), Load.flywheel(0.02))
    for ratio in (-10.0, 11.0):
        found = simulate(machine(ratio=ratio), scene, 0.1, 2e-5)
        assert found.output_angle[0, -1] > 0.005
        assert found.gear_torque[0].max() > 0.0


def test_derating_leaves_the_current_that_can_be_held() -> None:
    one = machine()
    hot = Start(winding_temperature=130.0, housing_temperature=90.0)
    scene = Scenario(Command("torque", Constant(50.0)), Load.locked(2e4, 10.0), hot)
    found = simulate(one, scene, 0.05, 2e-5)
    held = continuous_current(one.motor, one.thermal)
    assert abs(found.current[0, -1]) == pytest.approx(held, rel=1e-6)


def test_numbers_do_not_depend_on_threads_or_company() -> None:
    sets = [machine(stiffness=1e4 + 500.0 * i, backlash=1e-4 * i) for i in range(7)]
    scenes = [replace(SCENES["wall"], command=Command("impedance", Sine(0.1 * i, 3.0)))
              for i in range(1, 8)]  # fmt: skip
    one, three = (simulate(sets, scenes, 0.1, 2e-5, threads=k) for k in (1, 3))
    alone = simulate(sets[4], scenes[4], 0.1, 2e-5)
    for trace in TRACES:
        assert np.array_equal(getattr(one, trace), getattr(three, trace))
        assert np.array_equal(getattr(one, trace)[4], getattr(alone, trace)[0])


@pytest.mark.parametrize(
    "signal",
    [
        Sine(2.0, 3.0, 0.5, 0.7),
        Chirp(1.5, 0.5, 20.0, 2.0, 0.1),
        Ramp(1.0, -2.0),
        Sampled(np.array([0.0, 0.5, 3.0]), np.array([1.0, 3.0, -2.0])),
        Constant(4.0),
    ],
)
def test_rates_are_the_derivatives_of_signals(signal: Signal) -> None:
    t = np.linspace(0.013, 1.9, 101)
    numeric = (signal.values(t + 1e-6) - signal.values(t - 1e-6)) / 2e-6
    np.testing.assert_allclose(signal.rates(t), numeric, atol=1e-4)


@pytest.mark.parametrize("name", ["free", "locked", "wall", "position"])
def test_a_step_too_large_names_one_that_works(name: str) -> None:
    one = machine()
    limit, cause = largest_step(one, SCENES[name])
    with pytest.raises(UsageError, match=cause) as told:
        simulate(one, SCENES[name], 1.0, 1.2 * limit)
    works = float(str(told.value).split("use ")[1].split(" s")[0])
    assert works <= limit
    assert simulate(one, SCENES[name], 100 * works, works).ledger.residual_share[0] < 1e-6


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"resistance": 0.0}, "motor.resistance"),
        ({"rotor_inertia": -1e-4}, "motor.rotor_inertia"),
        ({"supply_voltage": 0.0}, "drive.supply_voltage"),
        ({"torque_constant": math.nan}, "motor.torque_constant"),
        ({"backlash": -1e-3}, "gear.backlash"),
        ({"output_inertia": 0.0}, "gear.output_inertia"),
        ({"ratio": 0.5}, "gear.ratio"),
        ({"encoder_bits": 40}, "drive.encoder_bits"),
        ({"error_sine": np.array([math.nan, 0.0, 0.0])}, "gear.error_sine"),
        ({"stiffness_sine": np.array([0.9, 0.9, 0.9])}, "gear.stiffness_cosine"),
        ({"rotor_inertia": 0.0, "input_inertia": 0.0}, "rotor_inertia"),
    ],
)
def test_impossible_machines_are_refused(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(DesignError, match=word):
        machine(**changes)


@pytest.mark.parametrize(
    ("duration", "step", "every"),
    [
        (0.0, 1e-5, 1),
        (-1.0, 1e-5, 1),
        (math.inf, 1e-5, 1),
        (math.nan, 1e-5, 1),
        (1.0, 0.0, 1),
        (1.0, -1e-5, 1),
        (1.0, math.nan, 1),
        (1e-4, 1e-5, 20),
        (1.0, 1e-5, 0),
    ],
)
def test_senseless_times_are_refused(duration: float, step: float, every: int) -> None:
    times_are_sound = duration > 0.0 and step > 0.0 and math.isfinite(duration)
    word = "every|record" if times_are_sound else "duration|step"
    with pytest.raises(UsageError, match=word):
        simulate(machine(), SCENES["free"], duration, step, every=every)


@dataclass(frozen=True)
class Gap:
    """A signal that is missing after half a second."""

    def values(self, times: np.ndarray) -> np.ndarray:
        return np.where(times < 0.5, 1.0, np.nan)

    def rates(self, times: np.ndarray) -> np.ndarray:
        return np.zeros_like(times)


@pytest.mark.parametrize(
    ("scenario", "word"),
    [
        (Scenario(Command("torque", Gap())), "0.50001 s"),
        (Scenario(Command("impedance", feedforward=Gap())), "finite"),
        (Scenario(Command("open"), Load.driven(Gap())), "finite"),
        (Scenario(Command("impedance", position_gain=math.nan)), "position_gain nan"),
        (Scenario(Command("position", integral_gain=math.inf)), "integral_gain inf"),
        (Scenario(start=Start(output_angle=math.nan)), "output_angle nan"),
        (Scenario(Command("torqe")), "command.mode 'torqe'.*impedance"),  # type: ignore[arg-type]
        (Scenario(friction="dahl"), "friction 'dahl'.*lugre"),  # type: ignore[arg-type]
    ],
)
def test_what_is_not_a_number_or_not_known_is_named(scenario: Scenario, word: str) -> None:
    with pytest.raises(UsageError, match=word):
        simulate(machine(), scenario, 1.0, 2e-5)


def test_a_simulation_of_nothing_is_refused() -> None:
    for sets, scenes in (([], SCENES["free"]), (machine(), [])):
        with pytest.raises(UsageError, match="there is none"):
            simulate(sets, scenes, 0.01, 1e-5)
    with pytest.raises(UsageError, match="threads -1"):
        simulate(machine(), SCENES["free"], 0.01, 1e-5, threads=-1)


def test_senseless_loads_and_signals_are_refused() -> None:
    with pytest.raises(UsageError, match="finite"):
        Sine(math.nan, 1.0)
    with pytest.raises(UsageError, match="rise"):
        Sampled(np.array([0.0, 0.0]), np.array([1.0, 1.0]))
    with pytest.raises(UsageError, match="mass"):
        Load.pendulum(0.0, 1.0)
    with pytest.raises(UsageError, match="inertia"):
        Load.flywheel(-1.0)
    with pytest.raises(UsageError, match="pair"):
        simulate([machine()] * 3, [SCENES["free"]] * 2, 0.01, 1e-5)
