"""Pendulum data: physics at rest, the sensor chain, determinism, and what is flagged."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.actuator.bench.steady import no_load_speed
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.packing import largest_step
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.actuator.thermal import continuous_current
from cqdd_design.design import load_design
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.machine import resolve
from cqdd_design.torque.data import pendulum
from cqdd_design.torque.data.generate import Request, describe, generate
from cqdd_design.torque.data.pendulum import Configuration
from cqdd_design.torque.data.sensing import Filter, SensorChain, Truth, encoded, lagged, measured
from cqdd_design.torque.evaluation.rollout import pendulum_of

DESIGN = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
SMALL = Request(episodes=3, seconds=1.5, unit_gearboxes=0, held_mass=1.71)


@pytest.fixture(scope="module")
def gearbox():
    return actuator_parameters(resolve(DESIGN), Specimen(seed=1))


@pytest.fixture(scope="module")
def small():
    return generate(resolve(DESIGN), SMALL)


def test_a_stiff_gearbox_is_stepped_at_half_of_what_it_stands_or_less(gearbox):
    """Its fastest mode sets the step, and no more than what makes records whole is lost."""
    stiff = dataclasses.replace(
        gearbox, gear=dataclasses.replace(gearbox.gear, stiffness=1e3 * gearbox.gear.stiffness)
    )
    swing = Configuration(0.5, 0.8, 0.2, 1.14, 0.3, None, 1)
    _, facts = recorded(stiff, swing, seconds=0.1)
    largest, cause = largest_step(stiff, pendulum._scenario(swing))
    assert "stiffness" in cause
    assert 0.4 * largest < facts["physics_step_s"] <= 0.5 * largest


def recorded(gearbox, configuration, seconds=3.0, chain=None):
    episodes, facts = pendulum.record(
        [configuration],
        ["one"],
        {1: gearbox},
        seconds=seconds,
        chain=chain or SensorChain(),
        seed=0,
    )
    return episodes[0], facts


# Physics ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("start", [0.7, -0.7])
def test_at_rest_the_torque_carries_the_weight_and_a_position_error_asks_for_it(gearbox, start):
    """Upright is angle 0 and gravity pushes over: the joint sags outwards, the torque is inward."""
    still = Configuration(0.5, 0.0, start, mass=2.0, arm=0.5, wall_angle=None, gearbox=1)
    damped = dataclasses.replace(
        gearbox, drive=dataclasses.replace(gearbox.drive, velocity_gain=10.0)
    )
    episode, _ = recorded(damped, still, seconds=4.0)
    last = {name: values[-100:].mean() for name, values in episode.columns.items()}
    assert abs(last["velocity"]) < 1e-3
    bar = 0.5 * pendulum.bar_mass() * pendulum.BAR_LENGTH
    weight = (2.0 * 0.5 + bar) * pendulum.GRAVITY * math.sin(last["position"])
    assert last["torque"] == pytest.approx(-weight, rel=0.01)
    error = last["target"] - last["position"]
    assert math.copysign(1.0, error) == math.copysign(1.0, last["torque"]) == -np.sign(start)
    # Dry friction carries a part.
    assert 0.4 < damped.drive.position_gain * error / last["torque"] < 1.6
    drive = abs(damped.gear.ratio) * damped.motor.torque_constant * last["current"]
    assert 0.4 < drive / last["torque"] < 1.6


def test_a_moving_joint_obeys_its_equation_of_motion(gearbox):
    """Inertia times acceleration is torque and weight, with ideal sensors on a free swing.

    Over a tenth of a second: the motor, where the encoder sits, rings against the output at 70 Hz.
    """
    chain = SensorChain(torque_noise=0.0)
    ideal = dataclasses.replace(gearbox, drive=dataclasses.replace(gearbox.drive, encoder_bits=0))
    swing = Configuration(0.6, 0.8, 0.3, mass=1.14, arm=0.5, wall_angle=None, gearbox=1)
    episode, _ = recorded(ideal, swing, 4.0, chain)
    columns, load = episode.columns, pendulum.pendulum_load(swing.group())
    acceleration = np.gradient(columns["velocity"], episode.dt)
    model = load.inertia * acceleration + load.gravity_moment * np.sin(columns["position"])
    mean = np.full(20, 0.05)
    torque = np.convolve(columns["torque"], mean, "valid")[200:]
    missing = torque - np.convolve(model, mean, "valid")[200:]
    assert np.sqrt(np.mean(missing**2)) < 0.03 * np.std(torque)


def test_the_wall_pushes_back_and_is_flagged_where_it_is_touched(gearbox):
    free = Configuration(0.7, 1.0, 0.2, mass=1.14, arm=0.4, wall_angle=None, gearbox=1)
    before = dataclasses.replace(free, wall_angle=0.7)
    alone, _ = recorded(gearbox, free)
    stopped, _ = recorded(gearbox, before)
    assert not alone.flag("wall").any()
    touched = stopped.flag("wall")
    assert 0.1 < touched.mean() < 0.9
    assert stopped.columns["position"].max() < alone.columns["position"].max() - 0.2
    assert stopped.columns["position"][~touched].max() < 0.7 + 0.05
    assert stopped.group["wall"] == 1
    assert stopped.group["wall_angle"] == 0.7
    deep = pendulum.pendulum_load(stopped.group).wall
    assert (deep.angle, deep.side) == (0.7, 1)


def test_limits_that_bind_are_flagged_and_counted_not_dropped(small):
    data, _ = generate(resolve(DESIGN), dataclasses.replace(SMALL, voltage=12.0))
    assert len(data.episodes) == 3 + 4
    shares = data.facts["saturated_share"]
    assert set(shares) == {one.name for one in data.episodes}
    for one in data.episodes:
        assert shares[one.name] == pytest.approx(one.flag("saturated").mean(), abs=1e-6)
    infeasible = data.facts["infeasible"]
    assert any("no-load speed" in cause for causes in infeasible.values() for cause in causes)
    fast = [name for name in infeasible if shares[name] > 0.0]
    assert fast
    told = describe(data)
    assert told["episodes_infeasible"] == len(infeasible)
    assert told["episodes_saturated"] == sum(share > 0.0 for share in shares.values())
    assert describe(small[0])["saturated_share"] < told["saturated_share"]


def test_a_torque_need_above_the_limit_is_named(gearbox):
    heavy = Configuration(1.5, 1.5, 0.0, mass=2.28, arm=0.6, wall_angle=None, gearbox=1)
    light = Configuration(0.3, 0.5, 0.0, mass=1.14, arm=0.25, wall_angle=None, gearbox=1)
    assert any("drive's limit" in cause for cause in pendulum.shortfalls(heavy, gearbox))
    assert pendulum.shortfalls(light, gearbox) == ()
    # The greatest of J a + m g r sin q over the swing: at its end here, where both push outwards.
    (told,) = pendulum.shortfalls(dataclasses.replace(heavy, frequency=1.3, amplitude=1.5), gearbox)
    bar = pendulum.BAR_LENGTH * pendulum.BAR_WIDTH * pendulum.BAR_THICKNESS * 2700.0
    inertia = 2.28 * 0.6**2 + bar * (0.65**2 / 3.0 + 0.04**2 / 12.0) + gearbox.reflected_inertia
    moment = (2.28 * 0.6 + bar * 0.65 / 2.0) * 9.80665
    most = 1.5 * inertia * (2.0 * math.pi * 1.3) ** 2 + moment * math.sin(1.5)
    assert told == f"torque {most:.3g} N*m above the drive's limit of {told.split()[-2]} N*m"


def test_a_speed_beyond_what_the_free_actuator_reaches_is_named(gearbox):
    """The limit is that of the simulated actuator, all its drag included."""
    drive = dataclasses.replace(gearbox.drive, supply_voltage=12.0)
    friction = dataclasses.replace(gearbox.friction, motor_coulomb=0.06, motor_viscous=2e-4)
    slow = dataclasses.replace(gearbox, drive=drive, friction=friction)
    reached = no_load_speed(slow, 12.0).value * math.pi / 30.0
    for share, told in ((0.98, False), (1.02, True)):
        swing = Configuration(
            share * reached / (2.0 * math.pi * 1.4), 1.4, 0.0, 1.14, 0.25, None, gearbox=1
        )
        causes = pendulum.shortfalls(swing, slow)
        assert any("no-load speed" in cause for cause in causes) == told


def test_the_bar_is_a_flat_plate_about_its_end():
    along = np.linspace(0.0, pendulum.BAR_LENGTH, 2001)
    across = np.linspace(-0.5, 0.5, 201) * pendulum.BAR_WIDTH
    square = np.mean((along[:-1] + np.diff(along) / 2) ** 2)
    square += np.mean((across[:-1] + np.diff(across) / 2) ** 2)
    assert pendulum.bar_inertia() == pytest.approx(pendulum.bar_mass() * square, rel=1e-5)
    assert pendulum.bar_mass() == pytest.approx(0.5616)


def test_the_manifest_tells_the_pendulum_that_was_simulated(small):
    """Whoever reads the data set gets back inertia, weight and wall of every episode."""
    data, _ = small
    assert {one.group["wall"] for one in data.episodes} == {0, 1}
    for one in data.episodes:
        told, load = pendulum_of(one, data), pendulum.pendulum_load(one.group)
        assert told.inertia == pytest.approx(load.inertia, rel=1e-12)
        assert told.wall == load.wall
        held = dataclasses.replace(told, wall=None).load(0.4, 0.0)
        assert held == pytest.approx(load.gravity_moment * math.sin(0.4), rel=1e-12)


def test_a_warm_winding_lowers_the_current_that_counts_as_a_limit(gearbox):
    thermal = dataclasses.replace(gearbox.thermal, derating_begins=30.0, most=80.0)
    held = continuous_current(gearbox.motor, thermal)
    drive = dataclasses.replace(gearbox.drive, current_limit=2.0 * held, supply_voltage=1e3)
    parameters = dataclasses.replace(gearbox, thermal=thermal, drive=drive)
    for warmth, share in ((20.0, 0.0), (55.0, 0.5), (90.0, 1.0)):
        limit = (2.0 - share) * held
        run = SimpleNamespace(
            winding_temperature=np.full((1, 2), warmth),
            current=np.array([[0.99 * limit, -1.001 * limit]]),
            voltage=np.zeros((1, 2)),
            **dict.fromkeys(("output_angle", "motor_angle", "output_torque"), np.zeros((1, 2))),
            time=np.zeros(2),
        )
        one = Configuration(0.5, 0.5, 0.0, 1.14, 0.3, None, gearbox=1)
        scene = pendulum._scenario(one)
        truth = pendulum._truth(run, 0, parameters, one, scene, 1e4)
        assert truth.saturated.tolist() == [False, True]


# Sensors ----------------------------------------------------------------------------------------


def wave(frequency, rate=10_000.0, seconds=2.0):
    times = np.arange(1, round(rate * seconds) + 1) / rate
    return times, np.sin(2.0 * math.pi * frequency * times)


def seen(values, rate=10_000.0, chain=None, bits=0, ratio=1.0):
    none = np.zeros(len(values), bool)
    truth = Truth(rate, ratio * values, values, values, values, none, none)
    return measured(
        truth,
        chain or SensorChain(torque_noise=0.0, torque_lag=1e6),
        ratio=ratio,
        encoder_bits=bits,
        control_rate=1000.0,
        generator=np.random.default_rng(0),
    )


def test_label_and_inputs_have_the_same_delay_and_it_is_the_stated_one():
    _, values = wave(17.0)
    columns = seen(values)
    np.testing.assert_allclose(columns["torque"], columns["position"], atol=1e-9)
    np.testing.assert_allclose(columns["target"], columns["position"], atol=1e-9)
    kept = np.arange(1, 401) / 200.0
    turning = np.exp(-2j * math.pi * 17.0 * kept)[200:]
    phase = -np.angle(2j * np.mean(columns["torque"][200:] * turning))
    stated = SensorChain().to_dict(1000.0, 14, -10.0)["filter_lag_at_17_Hz_deg"]
    assert math.degrees(phase) == pytest.approx(stated, abs=0.7)
    assert 23.0 < stated < 26.0


def test_the_filter_looks_only_back_and_stands_at_its_first_value():
    _, values = wave(3.0)
    before = seen(values)
    late = values.copy()
    late[12_000:] += 5.0
    after = seen(late)
    for name in ("position", "velocity", "torque"):
        np.testing.assert_array_equal(after[name][:239], before[name][:239])
        assert not np.allclose(after[name][245:], before[name][245:])
    np.testing.assert_allclose(seen(np.full(4000, 3.0))["torque"], 3.0, rtol=1e-12)


@given(st.floats(40.0, 120.0), st.floats(0.5, 1.5), st.floats(1.0, 60.0))
def test_the_digital_filter_is_the_analogue_one_below_half_its_frequency(own, damping, frequency):
    from scipy.signal import freqz

    chosen = Filter(own, damping)
    if frequency > 0.5 * own:
        return
    top, bottom = chosen.coefficients(1000.0)
    _, gain = freqz(top, bottom, worN=[frequency], fs=1000.0)
    assert -np.angle(gain[0]) == pytest.approx(chosen.phase_lag(frequency), abs=0.06)


def test_the_velocity_comes_late_by_the_stated_half_period_and_one_count_is_as_stated():
    """A constant acceleration tells time by velocity: v = a t, so a delay is a deficit of speed."""
    times = np.arange(1, 20_001) / 10_000.0
    columns = seen(5.0 * 0.5 * times**2)
    kept = slice(200, None)
    at = np.arange(1, 401)[kept] / 200.0
    told = SensorChain().to_dict(1000.0, 14, -10.0)
    # What the torque sensor says of a ramp tells the filter's own delay, which they share.
    shared = at - seen(times)["torque"][kept]
    late = at - columns["velocity"][kept] / 5.0 - shared
    np.testing.assert_allclose(late, told["velocity_delay_s"], rtol=1e-3)
    assert told["velocity_delay_s"] == pytest.approx(0.5e-3)
    count = 2.0 * math.pi / 2**14 / 10.0
    assert told["position_count_rad"] == pytest.approx(count)
    steps = np.zeros(20_000)
    steps[10_000:] = count * 1.01
    jump = measured(
        Truth(1e4, -10.0 * steps, steps, steps, steps, steps > 9.0, steps > 9.0),
        SensorChain(rate=1000.0, filter=Filter(249.0), torque_noise=0.0),
        ratio=-10.0,
        encoder_bits=14,
        control_rate=1000.0,
        generator=np.random.default_rng(0),
    )
    # The filter keeps the sum of one reading's jump.
    assert jump["velocity"].sum() == pytest.approx(told["velocity_count_rad_per_s"], rel=1e-6)


def test_the_torque_sensor_s_corner_is_where_half_of_the_power_is_left():
    for corner in (17.0, 50.0):
        times, values = wave(corner, seconds=4.0)
        found = lagged(values, corner, 10_000.0)[20_000:]
        turning = np.exp(-2j * math.pi * corner * times[20_000:])
        ratio = np.mean(found * turning) / np.mean(values[20_000:] * turning)
        assert abs(ratio) == pytest.approx(math.sqrt(0.5), rel=0.02)
        assert math.degrees(np.angle(ratio)) == pytest.approx(-45.0, abs=1.5)
    stated = SensorChain(torque_lag=17.0).to_dict(1000.0, 14, -10.0)
    assert stated["torque_lag_at_17_Hz_deg"] == pytest.approx(45.0)


def test_the_encoder_counts_and_a_reversed_ratio_keeps_the_joint_s_sign():
    angles = np.linspace(-3.0, 3.0, 1001)
    count = 2.0 * math.pi / 2**10
    read = encoded(angles, 10)
    np.testing.assert_allclose(read / count, np.round(read / count), atol=1e-9)
    assert np.abs(read - angles).max() <= 0.5 * count * (1 + 1e-9)
    _, values = wave(1.0)
    columns = seen(values, ratio=-10.0, bits=14)
    straight = seen(values)
    assert np.abs(columns["position"] - straight["position"]).max() < 2.0 * math.pi / 2**14 / 10.0
    assert np.abs(columns["velocity"] - straight["velocity"]).max() < 0.05
    np.testing.assert_allclose(columns["current"], -straight["current"])


def test_noise_bias_and_lag_of_the_torque_sensor_do_what_they_say():
    still = np.zeros(200_000)
    noisy = seen(still, chain=SensorChain(torque_noise=1.0, torque_bias=2.0))["torque"]
    assert noisy.mean() == pytest.approx(2.0, abs=0.05)
    # White noise through a critically damped filter of 80 Hz at 1 kHz keeps pi/4 80/500 of power.
    assert np.std(noisy) == pytest.approx(math.sqrt(math.pi / 4.0 * 80.0 / 500.0), rel=0.1)
    _, values = wave(17.0)
    slow = seen(values, chain=SensorChain(torque_noise=0.0, torque_lag=50.0))
    assert np.std(slow["torque"]) < 0.97 * np.std(slow["target"])


@given(st.floats(50.0, 50_000.0), st.sampled_from([100.0, 200.0, 250.0, 500.0]))
def test_readings_are_a_whole_multiple_of_samples_and_fast_enough(control, rate):
    chain = SensorChain(rate=rate)
    acquisition, each = chain.acquisition(control)
    assert acquisition == rate * each
    chain.filter.coefficients(acquisition)


# The whole set ----------------------------------------------------------------------------------


def test_another_seed_gives_other_experiments():
    other = pendulum.draw(5, 1, 0, gearbox=1)
    assert not set(other) & set(pendulum.draw(5, 0, 0, gearbox=1))


def test_more_episodes_leave_the_first_ones_as_they_are():
    few = pendulum.draw(3, 5, 0, gearbox=1)
    many = pendulum.draw(30, 5, 0, gearbox=1)
    assert many[:3] == few
    assert len(set(many)) == 30
    for one in many:
        assert pendulum.FREQUENCIES[0] <= one.frequency <= pendulum.FREQUENCIES[1]
        assert pendulum.ARMS[0] <= one.arm <= pendulum.ARMS[1]
        assert one.mass in pendulum.MASSES
        if one.wall_angle is not None:
            assert one.start < one.wall_angle < one.start + one.amplitude


@pytest.mark.deep
def test_held_mass_and_other_gearboxes_stand_apart_and_answer_differently():
    few = dataclasses.replace(SMALL, episodes=1, unit_gearboxes=2, seconds=0.6)
    data, _ = generate(resolve(DESIGN), few)
    pool = [one for one in data.episodes if one.name.startswith("swing")]
    held = [one for one in data.episodes if one.name.startswith("mass")]
    others = [one for one in data.episodes if one.name.startswith("gearbox")]
    assert len(pool) + len(held) + len(others) == len(data.episodes)
    assert {one.group["mass"] for one in held} == {1.71}
    assert all(one.group["mass"] in pendulum.MASSES for one in pool + others)
    assert {one.group["gearbox"] for one in others} == {2, 3}
    assert {one.group["gearbox"] for one in pool + held} == {1}
    first, second = (
        next(one for one in data.episodes if one.name == f"gearbox{seed}-0000") for seed in (2, 3)
    )
    same = {key: value for key, value in first.group.items() if key != "gearbox"}
    assert same == {key: value for key, value in second.group.items() if key != "gearbox"}
    difference = first.columns["torque"] - second.columns["torque"]
    assert 0.01 < np.std(difference) < 0.5 * np.std(first.columns["torque"])


@pytest.mark.deep
def test_the_same_seed_gives_the_same_data_and_the_ripple_is_never_adjusted(small):
    data, warnings = generate(
        resolve(DESIGN), SMALL, specimen=Specimen(factors={"tolerance_scale": 7.0})
    )
    assert data.sha256 == small[0].sha256
    # Swings of the paper's pendulum are more than its pins' holes carry, and nothing else is said.
    (beyond,) = small[1]
    assert "the gearbox does not carry it" in beyond
    assert any("tolerance_scale" in sentence for sentence in warnings)
    few = dataclasses.replace(SMALL, episodes=1)
    stiff, _ = generate(resolve(DESIGN), few, specimen=Specimen(factors={"motor_coulomb": 0.3}))
    pair = (stiff.episodes[0].columns["torque"], data.episodes[0].columns["torque"])
    assert np.std(pair[0] - pair[1]) > 0.1
    assert stiff.facts["calibration"] == {"motor_coulomb": 0.3}


def test_the_gearbox_s_ripple_is_told_from_all_else_in_its_band(small):
    """It is none for perfect parts, and follows the size of the errors."""
    from cqdd_design.torque.data.generate import _gearbox_ripple

    data, _ = small
    drawn = actuator_parameters(resolve(DESIGN), Specimen(seed=1))
    free = [Configuration(0.5, 0.8, 0.2, 1.14, 0.3, None, 1)]
    found = []
    for scale in (0.0, 1.0, 3.0):
        names = ("error_cosine", "error_sine", "stiffness_cosine", "stiffness_sine")
        scaled = {name: scale * getattr(drawn.gear, name) for name in names}
        other = dataclasses.replace(drawn, gear=dataclasses.replace(drawn.gear, **scaled))
        found.append(_gearbox_ripple(free, other, 4.0, SensorChain()))
    assert found[0] == 0.0
    assert 0.01 < found[1] < 1.0
    assert 2.0 * found[1] < found[2] < 5.0 * found[1]
    assert data.facts["gearbox_ripple_Nm"] > 0.0
    walled = [dataclasses.replace(free[0], wall_angle=0.5)]
    assert _gearbox_ripple(walled, drawn, 4.0, SensorChain()) is None


def test_the_manifest_says_what_made_the_data(small):
    data, _ = small
    facts = data.facts
    assert data.position_gain == DESIGN.drive.position_gain
    assert data.dt == pytest.approx(0.005)
    assert facts["physics_step_s"] <= 1e-4
    assert facts["training_gearbox"] == 1
    assert facts["held_mass_kg"] == 1.71
    assert facts["design_sha256"] == DESIGN.sha256
    assert facts["sensors"]["filter_frequency_Hz"] == 80.0
    limit = DESIGN.motor.current_limit * facts["torque_constant_Nm_per_A"] * 10.0
    assert data.torque_range == pytest.approx((-limit, limit))
    assert all(len(one) == 300 for one in data.episodes)


def test_a_set_on_disk_is_the_set(small, tmp_path):
    pytest.importorskip("pyarrow")
    from cqdd_design.torque.data.episodes import read_data, write_data

    data, _ = small
    write_data(data, tmp_path)
    again = read_data(tmp_path)
    assert again.sha256 == data.sha256
    assert again.facts == data.facts
    assert dict(again.episodes[0].group) == dict(data.episodes[0].group)


def test_the_ripple_band_measures_the_ripple_put_in(small):
    data, _ = small
    one = data.episodes[0]
    times = one.dt * np.arange(len(one))
    columns = {name: np.zeros(len(one)) for name in one.columns}
    columns["torque"] = 5.0 * np.sin(2 * math.pi * times) + 0.6 * np.sin(2 * math.pi * 17.0 * times)
    group = {**one.group, "wall": 0}
    alone = dataclasses.replace(
        data, episodes=(dataclasses.replace(one, group=group, columns=columns),)
    )
    assert describe(alone)["torque_in_band_Nm"] == pytest.approx(0.6, rel=0.03)


# What is refused --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"episodes": 0}, "episodes"),
        ({"unit_gearboxes": -1}, "unit gearboxes"),
        ({"seed": -1}, "seed"),
        ({"gearbox": -3}, "gearbox"),
        ({"held_mass": 1.14}, "hold"),
        ({"held_mass": -1.0}, "held mass"),
        ({"position_gain": -60.0}, "position gain"),
        ({"velocity_gain": math.nan}, "velocity gain"),
        ({"position_gain": 0.0}, "follows no target"),
    ],
)
def test_requests_that_make_no_sense_are_refused(wrong, told):
    with pytest.raises(UsageError, match=told):
        Request(**wrong)


@pytest.mark.parametrize("seconds", [0.0, -1.0, math.nan, 1e-4])
def test_an_episode_without_samples_is_refused(gearbox, seconds):
    one = Configuration(0.5, 0.5, 0.0, 1.14, 0.3, None, 1)
    with pytest.raises(UsageError, match="no sample"):
        recorded(gearbox, one, seconds)


def test_an_episode_beyond_memory_is_refused_with_what_fits(gearbox):
    one = Configuration(0.5, 0.5, 0.0, 1.14, 0.3, None, 1)
    with pytest.raises(UsageError, match="use --seconds"):
        recorded(gearbox, one, 1e5)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"rate": 0.0}, "sample rate"),
        ({"torque_noise": -1.0}, "noise"),
        ({"torque_bias": math.inf}, "bias"),
        ({"torque_lag": 0.0}, "corner"),
    ],
)
def test_a_sensor_chain_that_cannot_be_is_refused(wrong, told):
    with pytest.raises(UsageError, match=told):
        SensorChain(**wrong)


def test_a_filter_needs_readings_enough():
    with pytest.raises(UsageError, match="320 Hz"):
        Filter(80.0).coefficients(200.0)
    with pytest.raises(UsageError, match="damping"):
        Filter(80.0, 0.0)


def test_a_design_without_a_position_gain_is_told_what_to_give():
    loose = DESIGN.model_copy(
        update={"drive": DESIGN.drive.model_copy(update={"position_gain": 0.0})}
    )
    with pytest.raises(DesignError, match="position_gain"):
        generate(resolve(loose), SMALL)
