"""Evaluation of torque estimators: identities, ripple of known signals, intervals, closed loop."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest

from cqdd_design.actuator.scenario import Wall
from cqdd_design.catalog import paper
from cqdd_design.errors import UsageError
from cqdd_design.report.torque.page import torque_page
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.evaluation import bootstrap, metrics
from cqdd_design.torque.evaluation.behaviour import Effort
from cqdd_design.torque.evaluation.documents import result_dict
from cqdd_design.torque.evaluation.estimator import Estimator, network_estimator, without_phase
from cqdd_design.torque.evaluation.evaluate import evaluate
from cqdd_design.torque.evaluation.lineup import split_of, trained_on
from cqdd_design.torque.evaluation.markdown import ends_shown, markdown, shown
from cqdd_design.torque.evaluation.ripple import (
    BAND,
    mean_amplitudes,
    order_spectrum,
    ripple,
    spectra,
    strokes,
)
from cqdd_design.torque.evaluation.rollout import Pendulum, drift, pendulum_of, rollout
from cqdd_design.torque.networks.artefact import Artefact, Validity

DT = 0.005
FACTS = {
    "pendulum": {
        "hanging_angle": math.pi,
        "gravity": 9.80665,
        "viscous": 0.0,
        "bar_inertia": 0.08,
        "bar_gravity_moment": 1.8,
        "wall": {"stiffness": 300.0, "exponent": 1.5, "damping": 0.3, "side": 1},
    }
}


def swing(k: int, samples: int = 1200, *, wall: bool = False) -> Episode:
    """A pendulum that swings as told, its torque by its own mechanics plus ripple of order 11."""
    rng = np.random.default_rng(k)
    t = DT * np.arange(samples)
    pulse, reach = 2.0 * np.pi * rng.uniform(0.8, 1.4), rng.uniform(0.9, 1.4)
    start, mass, arm = rng.uniform(0.0, 1.0), 1.14 * (1 + k % 2), rng.uniform(0.25, 0.6)
    position = start + reach * np.sin(pulse * t)
    velocity = reach * pulse * np.cos(pulse * t)
    place = start + 0.7 * reach
    depth = np.maximum(position - place, 0.0) * wall
    torque = -(mass * arm**2 + 0.08) * reach * pulse**2 * np.sin(pulse * t)
    torque += -(mass * arm * 9.80665 + 1.8) * np.sin(position) + 300.0 * depth**1.5
    torque += 0.4 * np.sin(11.0 * position) + 0.05 * rng.normal(size=samples)
    group = {"mass": mass, "arm": arm, "wall": int(wall), "gearbox": 0, "number": k}
    if wall:
        group["wall_angle"] = place
    columns = {
        "position": position,
        "target": position + (torque + 2.0 * velocity) / 60.0,
        "velocity": velocity,
        "torque": torque,
        "wall": (depth > 0.0).astype(float),
        "saturated": (np.abs(torque) > np.quantile(np.abs(torque), 0.93)).astype(float),
    }
    return Episode(f"e{k:02}", group, DT, columns)


@pytest.fixture(scope="module")
def data() -> DataSet:
    episodes = tuple(swing(k, wall=k % 3 == 0) for k in range(12))
    return DataSet(episodes, 60.0, 2.0, (-90.0, 90.0), FACTS)


def known(name: str, noise: float, bias: float = 0.0, model: str = "", history: int = 1):
    """An estimator whose errors are known: white noise and a bias."""

    def estimate(episode: Episode) -> np.ndarray:
        seed = [len(name), int(100 * noise), int(float(episode.group["number"]))]
        rng = np.random.default_rng(seed)
        return episode.columns["torque"] + bias + noise * rng.normal(size=len(episode))

    return Estimator(name, estimate, 7, history, "network", model, needs=("torque",))


def controller(episode: Episode) -> np.ndarray:
    columns = episode.columns
    return 60.0 * (columns["target"] - columns["position"]) - 2.0 * columns["velocity"]


def gru(inputs=("position_error", "velocity"), **changes) -> Artefact:
    """A network with drawn weights."""
    rng = np.random.default_rng(5)
    layers, hidden = 2, 8
    weights = {"head_weight": rng.normal(size=(1, hidden)), "head_bias": np.zeros(1)}
    for k in range(layers):
        inside = len(inputs) if k == 0 else hidden
        weights[f"weight_ih_l{k}"] = 0.3 * rng.normal(size=(3 * hidden, inside))
        weights[f"weight_hh_l{k}"] = 0.3 * rng.normal(size=(3 * hidden, hidden))
        weights[f"bias_ih_l{k}"] = weights[f"bias_hh_l{k}"] = np.zeros(3 * hidden)
    fields = {
        "name": "pv-gru",
        "family": "gru",
        "inputs": inputs,
        "history": 10,
        "mode": "window",
        "layers": layers,
        "hidden": hidden,
        "activation": "",
        "input_mean": (0.0,) * len(inputs),
        "input_std": (1.0,) * len(inputs),
        "torque_mean": 0.0,
        "torque_std": 5.0,
        "residual": False,
        "validity": Validity(DT, 60.0, 2.0, (-90.0, 90.0)),
        "differentiator": None,
        "weights": {key: value.astype(np.float32) for key, value in weights.items()},
    }
    return Artefact(**(fields | changes))


# Metrics ----------------------------------------------------------------------------------------


def test_square_of_rmse_is_bias_squared_plus_variance():
    rng = np.random.default_rng(0)
    for scale in (1e-6, 1.0, 1e6):
        label = scale * rng.normal(size=500)
        found = metrics.scores(label + scale * (0.3 + rng.standard_t(3, size=500)), label)
        assert found.rmse**2 == pytest.approx(found.bias**2 + found.variance, rel=1e-9)
        assert found.most >= found.p95 > found.rmse > 0.0
        assert found.r_squared == pytest.approx(1.0 - found.rmse**2 / np.var(label))


def test_sums_of_episodes_give_the_scores_of_all_samples(data):
    label = [one.columns["torque"] for one in data.episodes]
    error = [np.random.default_rng(k).normal(0.2, 1.0, len(y)) for k, y in enumerate(label)]
    every = np.ones(len(label[0]), bool)
    totals = sum(metrics.sums(e, y, every) for e, y in zip(error, label, strict=True))
    whole = metrics.scores(np.concatenate(label) + np.concatenate(error), np.concatenate(label))
    for name, value in metrics.scores_of_sums(totals).items():
        assert value == pytest.approx(getattr(whole, name), rel=1e-9)


def test_regimes_are_what_they_say():
    episode = swing(3, wall=True)
    found = metrics.regimes(episode)
    assert set(found) == set(metrics.REGIMES)
    assert found["all"].all()
    assert np.array_equal(found["wall"], episode.columns["wall"] > 0.5)
    assert found["saturation"].any()
    assert not (found["swing"] & (found["wall"] | found["saturation"])).any()
    velocity = episode.columns["velocity"]
    assert found["reversal"][np.abs(velocity) < metrics.REVERSAL_SPEED].all()
    turns = np.flatnonzero(np.diff(np.signbit(velocity)))
    assert len(turns) > 5
    assert all(found["reversal"][k - 1 : k + 3].all() for k in turns)
    assert 0.0 < found["reversal"].mean() < 0.3


def test_quantiles_of_histograms_are_quantiles():
    size = np.abs(np.random.default_rng(1).normal(size=20_000))
    counts, ends = metrics.size_histograms([size[:9000], size[9000:]])
    found = metrics.quantiles_of_histograms(np.ones((1, 2)) @ counts, ends, 0.95)[0]
    assert found == pytest.approx(np.quantile(size, 0.95), abs=2 * (ends[1] - ends[0]))


# Ripple -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("frequency", "gain", "delay"),
    [(17.2, 0.5, 0.006), (13.0, 1.3, -0.004), (20.0, 1.0, 0.02)],
)
def test_ripple_of_known_amplitude_frequency_and_delay(frequency, gain, delay):
    t = DT * np.arange(2000)
    rng = np.random.default_rng(2)
    labels, estimates = [], []
    for _ in range(6):
        phase, motion = rng.uniform(0.0, 6.28), 12.0 * np.sin(5.0 * t + rng.uniform(0.0, 6.28))
        labels.append(motion + 0.6 * np.sin(2 * np.pi * frequency * t + phase))
        moved = 2 * np.pi * frequency * (t - delay) + phase
        estimates.append(motion + 0.6 * gain * np.sin(moved))
    free = [np.ones(len(t), bool)] * 6
    found = ripple(spectra(labels, estimates, free, DT), bootstrap.draws(6, count=200))
    assert found.amplitude_label == pytest.approx(0.6, rel=1e-3)
    assert found.amplitude.value == pytest.approx(0.6 * gain, rel=1e-3)
    assert found.amplitude_error.value == pytest.approx(0.6 * (gain - 1.0), abs=1e-3)
    assert found.frequency.value == pytest.approx(frequency, abs=0.02)
    assert found.frequency_label == pytest.approx(frequency, abs=0.02)
    turn = (-360.0 * frequency * delay + 180.0) % 360.0 - 180.0
    assert found.phase.value == pytest.approx(turn, abs=0.5)
    assert found.coherence == pytest.approx(1.0, abs=1e-3)
    error = np.concatenate(estimates) - np.concatenate(labels)
    assert found.error_rms.value == pytest.approx(error.std(), rel=5e-3)
    assert found.share.value == pytest.approx(1.0, abs=5e-3)


def test_what_lies_outside_the_band_is_no_ripple():
    t = DT * np.arange(4000)
    label = 5.0 * np.sin(2 * np.pi * 1.0 * t) + 0.6 * np.sin(2 * np.pi * 17.0 * t)
    estimate = label + 1.0 * np.sin(2 * np.pi * 2.0 * t) + 0.5 * np.sin(2 * np.pi * 60.0 * t)
    free = [np.ones(len(t), bool)]
    found = ripple(spectra([label], [estimate], free, DT), bootstrap.draws(1, count=100))
    assert found.error_rms.value < 0.01
    assert found.share.value < 1e-3
    assert found.phase.value == pytest.approx(0.0, abs=1.0)
    flat = ripple(spectra([label], [np.zeros(len(t))], free, DT), bootstrap.draws(1, count=100))
    assert flat.amplitude_error.value == pytest.approx(-0.6, abs=2e-3)
    assert flat.frequency is None
    assert flat.phase is None


def test_the_density_of_white_noise_is_its_power_over_half_the_rate():
    noise = 0.7 * np.random.default_rng(8).normal(size=200_000)
    found = spectra([noise], [2.0 * noise], [np.ones(len(noise), bool)], DT)
    frequency, label, estimate = mean_amplitudes(found)
    inner = slice(4, -4)
    assert np.mean(label[inner] ** 2) == pytest.approx(0.49 * 2.0 * DT, rel=0.02)
    np.testing.assert_allclose(estimate, 2.0 * label)
    assert frequency[-1] == pytest.approx(0.5 / DT)


def test_noise_apart_from_the_label_costs_coherence():
    t = DT * np.arange(20_000)
    rng = np.random.default_rng(3)
    label = rng.normal(size=len(t))
    free = [np.ones(len(t), bool)]
    draws = bootstrap.draws(1, count=10)
    half = ripple(spectra([label], [label + rng.normal(size=len(t))], free, DT), draws)
    none = ripple(spectra([label], [rng.normal(size=len(t))], free, DT), draws)
    assert half.coherence == pytest.approx(0.5, abs=0.06)
    assert none.coherence < 0.06


def test_segments_that_touch_a_wall_do_not_count():
    t = DT * np.arange(2000)
    label = 0.6 * np.sin(2 * np.pi * 17.0 * t)
    blow = label.copy()
    blow[900:910] += 30.0
    free = np.ones(len(t), bool)
    free[895:915] = False
    draws = bootstrap.draws(1, count=10)
    kept = ripple(spectra([label], [blow], [free], DT), draws)
    struck = ripple(spectra([label], [blow], [np.ones(len(t), bool)], DT), draws)
    assert kept.share is None
    assert kept.error_rms.value < 1e-8 < 0.5 < struck.error_rms.value
    assert kept.segments < struck.segments
    assert ripple(spectra([label], [blow], [np.zeros(len(t), bool)], DT), draws) is None


def test_blows_of_the_backlash_do_not_hide_the_ripple_on_one_flank():
    t = DT * np.arange(4000)
    torque = 8.0 * np.sin(2 * np.pi * 0.3 * t) + 0.3 * np.sin(2 * np.pi * 17.0 * t)
    # A step at every change of sign, as of a gear that strikes.
    torque += 2.0 * np.sign(torque)
    columns = dict.fromkeys(("position", "target", "velocity"), np.zeros(len(t)))
    episode = Episode("a", {}, DT, columns | {"torque": torque})
    flank, free = metrics.on_one_flank(episode), metrics.regimes(episode)["swing"]
    assert flank.sum() < free.sum()
    for k in np.flatnonzero(np.diff(np.signbit(torque))):
        assert not flank[k - 7 : k + 8].any()
    draws = bootstrap.draws(1, count=10)
    smooth = 8.0 * np.sin(2 * np.pi * 0.3 * t)
    own = ripple(spectra([torque], [smooth], [flank], DT), draws)
    struck = ripple(spectra([torque], [smooth], [free], DT), draws)
    assert own.amplitude_label == pytest.approx(0.3, rel=0.02)
    assert own.frequency_label == pytest.approx(17.0, abs=0.1)
    assert struck.amplitude_label > 1.3 * own.amplitude_label


def test_orders_are_found_over_the_angle():
    t = DT * np.arange(4000)
    position = 1.5 * np.sin(2 * np.pi * 0.4 * t)
    velocity = np.gradient(position, DT)
    label = 3.0 * np.sin(position) + 0.5 * np.sin(22.0 * position + 0.3)
    estimate = 3.0 * np.sin(position) + 0.25 * np.sin(22.0 * (position + 0.02) + 0.3)
    columns = {"position": position, "target": position, "velocity": velocity, "torque": label}
    episode = Episode("a", {}, DT, columns)
    swings = strokes([episode], [np.ones(len(t), bool)])
    found = order_spectrum(swings, [label], [estimate])
    best = int(found.label.argmax())
    assert found.orders[best] == 22.0
    assert found.label[best] == pytest.approx(0.5, rel=0.02)
    assert found.estimate[best] == pytest.approx(0.25, rel=0.02)
    assert found.phase[best] == pytest.approx(np.degrees(22.0 * 0.02), abs=2.0)
    assert order_spectrum((), [label], [estimate]) is None


# Intervals --------------------------------------------------------------------------------------


def test_intervals_hold_the_truth_as_often_as_they_say():
    """Errors with an effect of the episode: by samples an interval would be far too narrow."""
    rng = np.random.default_rng(4)
    held, trials, episodes, samples = 0, 300, 40, 50
    draws = bootstrap.draws(episodes, count=400, seed=1)
    for _ in range(trials):
        error = rng.normal(size=(episodes, 1)) + 0.5 * rng.normal(size=(episodes, samples))
        totals = np.stack(
            [metrics.sums(e, np.zeros(samples), np.ones(samples, bool)) for e in error]
        )
        many = metrics.scores_of_sums(draws @ totals)["rmse"]
        found = bootstrap.interval(float(np.sqrt(np.mean(error**2))), many, episodes=episodes)
        held += found.low <= math.sqrt(1.25) <= found.high
    assert 0.87 <= held / trials <= 0.985


def test_intervals_repeat_by_seed_and_shrink_with_episodes():
    few, many = (
        bootstrap.draws(n, count=500, seed=3) @ np.random.default_rng(0).normal(size=n) / n
        for n in (10, 1000)
    )
    assert np.array_equal(bootstrap.draws(10, seed=3), bootstrap.draws(10, seed=3))
    assert not np.array_equal(bootstrap.draws(10, seed=3), bootstrap.draws(10, seed=4))
    assert np.all(bootstrap.draws(10).sum(axis=1) == 10)
    assert many.std() < 0.3 * few.std()
    assert bootstrap.interval(1.0, many, episodes=1).ends is None
    assert bootstrap.interval(1.0, np.r_[many, np.full(400, np.nan)], episodes=9).ends is None
    with pytest.raises(UsageError, match="1 or more"):
        bootstrap.draws(0)


def test_ninety_five_in_a_hundred_lie_within():
    found = bootstrap.interval(500.0, np.arange(1001.0), episodes=9)
    assert found.ends == pytest.approx([25.0, 975.0])
    # The value itself belongs to it.
    assert bootstrap.interval(990.0, np.arange(1001.0), episodes=9).high == 990.0


def test_angles_keep_their_interval_across_the_turn():
    near = np.array([178.0, 179.0, -179.0, -178.0] * 100)
    found = bootstrap.circular_interval(180.0, near, episodes=4)
    assert found.low == pytest.approx(178.0)
    assert found.high == pytest.approx(182.0)


def test_pairs_are_narrower_than_their_parts():
    """Two models whose errors share the episode's difficulty differ with certainty."""
    rng = np.random.default_rng(6)
    hard = np.exp(rng.normal(size=40))
    draws = bootstrap.draws(40, count=1000)
    values = {"a": hard.mean(), "b": 0.9 * hard.mean()}
    many = {"a": draws @ hard / 40, "b": draws @ (0.9 * hard) / 40}
    found = bootstrap.paired("b", "a", "rmse", values, many, episodes=40)
    assert found.ratio.value == pytest.approx(0.9)
    assert found.ratio.high - found.ratio.low < 1e-9
    assert found.difference.high < 0.0
    own = bootstrap.interval(values["a"], many["a"], episodes=40)
    assert own.high - own.low > 5.0 * (found.difference.high - found.difference.low)


# Closed loop and drift --------------------------------------------------------------------------


class Law:
    """A controller as a stepper."""

    def __init__(self, gain: float = 60.0, damping: float = 2.0):
        self.gain, self.damping = gain, damping

    def __call__(self, past: Episode) -> float:
        error = past.columns["target"][-1] - past.columns["position"][-1]
        return self.gain * error - self.damping * past.columns["velocity"][-1]


def energy(pendulum, angle, speed):
    """Of motion, weight and wall, J."""
    found = 0.5 * pendulum.inertia * speed**2
    found -= pendulum.gravity_moment * math.cos(angle - pendulum.hanging_angle)
    if pendulum.wall is not None:
        depth = max(pendulum.wall.side * (angle - pendulum.wall.angle), 0.0)
        more = pendulum.wall.exponent + 1.0
        found += pendulum.wall.stiffness * depth**more / more
    return found


def test_the_pendulum_keeps_its_energy_and_has_the_period_of_its_mechanics():
    pendulum = Pendulum(0.5, 6.0, wall=Wall(0.3, 300.0, damping=0.0))
    angle, speed = -0.2, 0.0
    begin = energy(pendulum, angle, speed)
    for _ in range(400):
        angle, speed, work = pendulum.advance(angle, speed, 0.0, DT)
        assert work == 0.0
        assert energy(pendulum, angle, speed) == pytest.approx(begin, abs=2e-4)
    free, t = Pendulum(0.5, 6.0), 0.0
    angle, speed, times = 0.02, 0.0, []
    while len(times) < 2:
        before = angle
        angle, speed, _ = free.advance(angle, speed, 0.0, DT)
        t += DT
        if before < 0.0 <= angle:
            times.append(t - DT * angle / (angle - before))
    assert times[1] - times[0] == pytest.approx(2 * np.pi * math.sqrt(0.5 / 6.0), rel=1e-3)


@pytest.mark.parametrize("side", [1, -1])
def test_the_wall_only_pushes_and_takes_energy(side):
    """Hunt and Crossley: k d^n (1 + c d') outwards from the wall, and never inwards."""
    pendulum = Pendulum(0.5, 0.0, wall=Wall(0.3 * side, 300.0, 1.5, 0.4, side))
    held = 300.0 * 0.1**1.5
    assert pendulum.load(0.4 * side, 0.0) == pytest.approx(side * held)
    assert pendulum.load(0.4 * side, 0.5 * side) == pytest.approx(side * held * 1.2)
    assert pendulum.load(0.4 * side, -0.5 * side) == pytest.approx(side * held * 0.8)
    assert pendulum.load(0.4 * side, -9.0 * side) == 0.0
    assert pendulum.load(0.2 * side, 5.0 * side) == 0.0
    assert energy(pendulum, 0.4 * side, 0.0) == pytest.approx(300.0 * 0.1**2.5 / 2.5)
    before = energy(pendulum, 0.25 * side, 2.0 * side)
    angle, speed, _ = pendulum.advance(0.25 * side, 2.0 * side, 0.0, 0.5)
    assert side * speed < 0.0
    assert 0.3 * before < energy(pendulum, angle, speed) < 0.95 * before


def test_work_of_a_held_torque_is_what_the_energy_gains():
    pendulum = Pendulum(0.4, 5.0)
    angle, speed, work = pendulum.advance(0.1, 0.3, 3.0, 0.5)
    gained = energy(pendulum, angle, speed) - energy(pendulum, 0.1, 0.3)
    assert work == pytest.approx(gained, rel=2e-3)
    damped = replace(pendulum, viscous=1.0)
    angle, speed, work = damped.advance(0.1, 0.3, 3.0, 0.5)
    assert work > energy(damped, angle, speed) - energy(damped, 0.1, 0.3) + 0.01


def plant(pendulum: Pendulum, law: Law, samples: int = 600) -> Episode:
    """The motion of a joint that is driven by the law itself."""
    target = 0.8 * np.sin(2 * np.pi * 0.7 * DT * np.arange(samples))
    position, velocity, torque = np.zeros((3, samples))
    for k in range(samples):
        torque[k] = law.gain * (target[k] - position[k]) - law.damping * velocity[k]
        if k + 1 < samples:
            position[k + 1], velocity[k + 1], _ = pendulum.advance(
                position[k], velocity[k], torque[k], DT
            )
    columns = {"position": position, "target": target, "velocity": velocity, "torque": torque}
    return Episode("plant", {"mass": 1.0, "arm": 0.5}, DT, columns)


def test_the_true_law_in_closed_loop_repeats_the_plant():
    pendulum, law = Pendulum(0.6, 5.0, wall=Wall(0.5, 300.0)), Law()
    episode = plant(pendulum, law)
    own = rollout(pendulum, episode, law, begin=10)
    assert own.position_rms < 1e-12
    columns = episode.columns
    held = float(np.sum(columns["torque"][10:-1] * np.diff(columns["position"][10:])))
    assert own.work == pytest.approx(held, rel=5e-3)
    assert own.plant_work == pytest.approx(held, rel=0.2)
    assert not own.injects
    assert not own.diverged
    weak = rollout(pendulum, episode, Law(30.0, 2.0), begin=10)
    assert weak.position_rms > 0.01


def test_a_law_that_feeds_energy_in_is_told():
    pendulum = Pendulum(0.6, 5.0)
    episode = plant(pendulum, Law())
    assert rollout(pendulum, episode, Law(60.0, -0.3), begin=10).injects
    away = rollout(pendulum, episode, Law(-400.0, 0.0), begin=10, hold=20.0)
    assert away.diverged
    assert away.position_rms is None
    with pytest.raises(UsageError, match="600 samples"):
        rollout(pendulum, episode, Law(), begin=600)


def test_pendula_come_from_the_data(data):
    wall, free = data.episodes[0], data.episodes[1]
    found = pendulum_of(wall, data)
    mass, arm = wall.group["mass"], wall.group["arm"]
    assert found.inertia == pytest.approx(mass * arm**2 + 0.08)
    assert found.wall.angle == wall.group["wall_angle"]
    # Upright at 0: gravity pushes over, as the recorded torque must hold against.
    assert found.load(0.1, 0.0) == pytest.approx(-(mass * arm * 9.80665 + 1.8) * math.sin(0.1))
    assert pendulum_of(free, data).wall is None
    assert pendulum_of(free, replace(data, facts={})) is None
    assert pendulum_of(replace(free, group={}), data) is None


def test_drift_is_seen_where_there_is_some():
    rows = np.stack([np.sin(np.linspace(0.0, 2 * np.pi, 50, endpoint=False))], axis=1)
    steady = drift(lambda row: float(2.0 * row[0]), rows, steps=1000)
    assert steady.growth == pytest.approx(0.0, abs=1e-12)
    assert steady.wander == 0.0
    assert steady.steps == 1000
    past: list[float] = []

    def windowed(row: np.ndarray) -> float:
        past.append(float(row[0]))
        return math.nan if len(past) < 24 else sum(past[-24:])

    assert drift(windowed, rows, steps=1000).finite
    total = [0.0]

    def leaking(row: np.ndarray) -> float:
        total[0] += 1e-3
        return float(row[0]) + total[0]

    found = drift(leaking, rows, steps=1000)
    assert found.growth > 0.1
    assert found.wander == pytest.approx(1e-3 * 50 * 16, rel=1e-6)
    assert not drift(lambda row: math.nan, rows, steps=1000).finite
    with pytest.raises(UsageError, match="six periods"):
        drift(lambda row: 0.0, rows, steps=100)


# The whole --------------------------------------------------------------------------------------


def names(data: DataSet) -> tuple[str, ...]:
    return tuple(one.name for one in data.episodes)


def run(data, estimators, **options):
    seen, sets = options.pop("seen", None), options.pop("sets", {"trajectory": names(data)})
    chosen = {"draws": 300, "rollouts": 0, "drift_steps": 0, "timed": False} | options
    return evaluate(data, sets, estimators, seen=seen, effort=Effort(**chosen))


def test_known_errors_are_measured(data):
    models = [known("pva-gru", 0.5), known("mlp", 1.0, 0.3), known("mlp-baseline", 2.0)]
    result = run(data, models)
    found = {one.name: one for one in result.sets[0].models}
    for name, noise, bias in (("pva-gru", 0.5, 0.0), ("mlp", 1.0, 0.3), ("mlp-baseline", 2.0, 0)):
        whole = found[name].overall
        assert whole.rmse.value == pytest.approx(math.hypot(noise, bias), rel=0.03)
        assert whole.bias.value == pytest.approx(bias, abs=0.05)
        assert whole.rmse.low < whole.rmse.value < whole.rmse.high
        assert whole.rmse.value**2 == pytest.approx(
            whole.bias.value**2 + whole.variance.value, rel=1e-9
        )
        # White noise up to 100 Hz has 15 % of its power in 15 Hz.
        share = (BAND[1] - BAND[0]) * 2.0 * DT
        assert found[name].ripple.share.value == pytest.approx(share, rel=0.2)
    pair = next(
        p
        for p in result.sets[0].paired
        if (p.model, p.reference, p.metric) == ("pva-gru", "mlp", "variance")
    )
    assert pair.ratio.value == pytest.approx(0.25, rel=0.08)
    assert pair.ratio.high < 0.35
    again = run(data, models)
    assert markdown(again) == markdown(result)
    assert run(data, models, seed=1).sets[0].models[0].overall.rmse.ends != (
        result.sets[0].models[0].overall.rmse.ends
    )


def test_every_model_is_scored_on_the_same_samples(data):
    result = run(data, [known("a", 1.0), known("b", 1.0, history=30)])
    assert {one.overall.scores.samples for one in result.sets[0].models} == {12 * (1200 - 29)}


def test_seeds_of_a_model_are_averaged(data):
    models = [known("g 0", 1.0, model="pva-gru"), known("gg 1", 2.0, model="pva-gru")]
    result = run(data, [*models, known("mlp", 3.0)])
    summary = next(one for one in result.sets[0].seeds if one.model == "pva-gru")
    assert summary.seeds == 2
    assert summary.rmse.value == pytest.approx(1.5, rel=0.03)
    assert summary.rmse_std == pytest.approx(1.0 / math.sqrt(2.0), rel=0.05)
    pair = next(p for p in result.sets[0].paired if p.reference == "mlp" and p.metric == "rmse")
    assert pair.ratio.value == pytest.approx(0.5, rel=0.03)


def test_a_network_is_run_timed_streamed_and_rolled_out(data):
    own = network_estimator(gru(("position_error", "velocity", "sin_11", "cos_11")))
    law = Estimator("pd-law", controller, 0)
    result = run(data, [own, law], draws=200, rollouts=2, drift_steps=5000, timed=True)
    told = result.behaviour("pv-gru")
    assert len(told.rollouts) == 2
    assert told.drift.finite
    assert abs(told.drift.growth) < 1e-3
    assert 0.0 < told.latency.streaming_p50 <= told.latency.streaming_p99
    assert told.latency.window_p50 > told.latency.streaming_p50
    assert told.modes.difference_rms >= 0.0
    score = result.sets[0].model("pv-gru")
    assert score.unknown_phase.rmse.value != score.overall.rmse.value
    assert result.behaviour("pd-law").rollouts[0].position_rms < 1.0
    assert result.behaviour("pd-law").latency.streaming_p50 is None
    document = result_dict(result)
    text = json.dumps(document, allow_nan=False)
    assert "NaN" not in text
    first = document["models"]["pv-gru"]
    for key in (
        "rmse_Nm",
        "bias_Nm",
        "variance_N2m2",
        "ripple_amplitude_error_Nm",
        "ripple_frequency_Hz",
        "ripple_phase_deg",
    ):
        assert first[key] is not None
        low, high = first["intervals_95"][key]
        assert low <= first[key] <= high
    assert first["parameters"] == gru(own.artefact.inputs).parameters
    assert set(first["latency_us"]) == {
        "streaming_p50",
        "streaming_p99",
        "window_p50",
        "throughput_per_sample",
    }
    page = torque_page(result)
    assert page.count("<svg") >= 8
    assert "Paper (hardware)" in page
    assert "Ours (simulated twin)" in page
    assert "http://" not in page
    assert "https://" not in page


def test_unknown_phase_moves_angles_and_nothing_else(data):
    episode = data.episodes[0]
    moved, other = without_phase(episode, 0, 0), without_phase(episode, 0, 1)
    offset = moved.columns["position"] - episode.columns["position"]
    assert np.ptp(offset) < 1e-12
    assert abs(offset[0]) > 1e-3
    assert moved.columns["target"] - moved.columns["position"] == pytest.approx(
        episode.columns["target"] - episode.columns["position"]
    )
    for name in ("velocity", "torque"):
        assert np.array_equal(moved.columns[name], episode.columns[name])
    assert other.columns["position"][0] != moved.columns["position"][0]


def test_what_a_model_was_trained_on_does_not_count(data):
    sets = {"trajectory": names(data)[:6], "wall": names(data)[6:]}
    seen = {"mlp": frozenset(names(data)[6:8])}
    result = run(data, [known("mlp", 1.0), known("pva-gru", 1.0)], sets=sets, seen=seen)
    assert result.sets[0].model("mlp") is not None
    assert result.sets[1].model("mlp") is None
    assert any("trained on 2 of the 6" in sentence for sentence in result.warnings)
    assert result_dict(result)["sets"]["wall"]["models"].keys() == {"pva-gru"}
    with pytest.raises(UsageError, match="every model was trained"):
        run(data, [known("mlp", 1.0)], sets={"wall": names(data)}, seen=seen)


def test_the_leaked_score_stands_beside_the_honest_one(data):
    told = network_estimator(gru(facts={"leaked_rmse_Nm": 0.4}))
    result = run(data, [told, known("mlp", 1.0)], timed=True)
    models = result_dict(result)["models"]
    assert models["pv-gru"]["leaked_rmse_Nm"] == 0.4
    assert models["mlp"]["leaked_rmse_Nm"] is None
    assert "0.400" in torque_page(result)


def test_baselines_of_a_figure_are_told_apart(data):
    """They share one grey, so each has a line of its own."""
    factors = {"friction-fit": 1.0, "pd-law": 0.5, "physics": 0.8}
    models = [replace(known(*one), kind="baseline") for one in factors.items()]
    result = run(data, models)
    page = torque_page(result)
    trace = page[page.index('id="torque-trace"') :]
    legend = trace[trace.index('class="legend-row"') :]
    lines = re.findall(r'class="(curve [^"]+)"', legend[: legend.index("</g>")])
    assert len(lines) == 4
    assert len(set(lines)) == 4
    dashed = dict(re.findall(r"\.curve\.(t-base-\d)\s*\{\s*stroke-dasharray:\s*([^;}]+)", page))
    patterns = [dashed.get(line.split()[-1]) for line in lines[1:]]
    assert len(set(patterns)) == 3


def test_bad_input_is_refused(data):
    own = network_estimator(gru())
    with pytest.raises(UsageError, match="sample time"):
        run(data, [network_estimator(gru(validity=Validity(0.01, 60.0, 2.0, (-9.0, 9.0))))])
    with pytest.raises(UsageError, match="position gain"):
        run(data, [network_estimator(gru(validity=Validity(DT, 50.0, 2.0, (-9.0, 9.0))))])
    with pytest.raises(UsageError, match="no test episodes"):
        run(data, [own], sets={"wall": ()})
    with pytest.raises(UsageError, match="which the data do not hold"):
        run(data, [own], sets={"wall": ("nobody",)})
    with pytest.raises(UsageError, match="no test set"):
        run(data, [own], sets={})
    with pytest.raises(UsageError, match="two models"):
        run(data, [own, own])
    with pytest.raises(UsageError, match="no model"):
        run(data, [])
    with pytest.raises(UsageError, match="no episode of more than"):
        run(data, [known("a", 1.0, history=5000)])

    def broken(episode: Episode) -> np.ndarray:
        return np.where(np.arange(len(episode)) == 77, np.nan, 0.0)

    with pytest.raises(UsageError, match="nan at sample 77 of episode e00"):
        run(data, [Estimator("broken", broken, 0)])
    with pytest.raises(UsageError, match="give its design"):
        network_estimator(gru(("balance", "velocity")))


def test_a_column_that_is_not_recorded_leaves_the_model_out(data):
    current = Estimator("current", controller, 0, needs=("current",))
    result = run(data, [known("a", 1.0), current], rollouts=1)
    assert result.sets[0].model("current") is None
    assert any("current, which is not recorded" in sentence for sentence in result.warnings)
    assert "current" in torque_page(result)


def test_slow_samples_show_no_ripple(data):
    slow = DataSet(
        tuple(
            Episode(e.name, e.group, 0.05, {k: v[::10] for k, v in e.columns.items()})
            for e in data.episodes
        ),
        60.0,
        2.0,
        (-90.0, 90.0),
        FACTS,
    )
    result = run(slow, [known("a", 1.0)])
    assert result.sets[0].models[0].ripple is None
    assert any("does not show the ripple band" in sentence for sentence in result.warnings)
    json.dumps(result_dict(result), allow_nan=False)
    assert "torque-rmse-all" in torque_page(result)


def test_the_papers_own_numbers_hold_together():
    """RMSE^2 - variance = bias^2 recomputed from Table III (arXiv:2410.16591): hardware."""
    rows = {row.model: row for row in paper.NETWORKS}
    assert rows["pva-gru"].bias == pytest.approx(0.145, abs=0.005)
    assert rows["mlp-baseline"].bias == pytest.approx(1.56, abs=0.005)
    assert 1.0 - rows["pva-gru"].rmse / rows["mlp"].rmse == pytest.approx(0.433, abs=0.001)
    assert 1.0 - rows["pva-gru"].variance / rows["mlp"].variance == pytest.approx(0.683, abs=0.001)


def test_tables_keep_the_paper_apart(data):
    text = markdown(run(data, [known("pva-gru", 0.5), known("mlp", 1.0)]))
    ours, paper = text.split("### Paper (hardware)")
    assert "ours (simulated twin)" in ours
    assert "1.71" in paper
    assert "1.71" not in ours
    assert shown(bootstrap.Interval(0.9712, 0.91, 1.04)) == "0.97 [0.91, 1.04]"
    assert shown(bootstrap.Interval(0.9712)) == "0.971"
    assert ends_shown(bootstrap.Interval(0.9712, 0.91, 1.04), 100.0) == ("97", "91 to 104")
    whole = run(data, [known("mlp", 1.0), known("pva-gru", 0.5)])
    pair = next(p for p in whole.sets[0].paired if (p.model, p.metric) == ("mlp", "rmse"))
    change = 100.0 * (pair.ratio.value - 1.0)
    assert f"| mlp | pva-gru | {change:+.1f} [" in markdown(whole)
    widths = {line.count("|") for line in paper.splitlines() if line.startswith("|")}
    assert len(widths) == 1


def test_files_tell_their_split():
    split = {"protocol": "wall", "seed": 3, "train": ["a"], "validation": ["b"], "test": ["c"]}
    own, other = gru(facts={"split": split}), gru(facts={"split": split | {"seed": 4}})
    assert trained_on(own, "0" * 64) == {"a", "b"}
    assert trained_on(gru(), "0" * 64) == frozenset()
    # A name says which episode only within the data set that the file names.
    named = gru(facts={"split": split, "data_sha256": "1" * 64})
    assert trained_on(named, "1" * 64) == {"a", "b"}
    assert trained_on(named, "0" * 64) == frozenset()
    assert split_of([own], None) == ("wall", 3)
    assert split_of([gru()], None) == ("trajectory", 0)
    assert split_of([own, other], 5) == ("wall", 5)
    with pytest.raises(UsageError, match="seeds 3, 4"):
        split_of([own, other], None)
