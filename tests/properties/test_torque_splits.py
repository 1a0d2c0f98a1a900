"""Splits by configuration, and an audit that finds every leak planted here."""

from __future__ import annotations

import dataclasses
import zlib

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.data.splits import (
    PROTOCOLS,
    Split,
    audit,
    configuration,
    random_window_split,
    split,
)

HISTORY = 30


def episode(name, samples=80, wall=0, seed=None, **group):
    g = np.random.default_rng(zlib.crc32(name.encode()) if seed is None else seed)
    columns = {key: g.normal(size=samples) for key in ("position", "target", "velocity", "torque")}
    columns["wall"] = np.full(samples, float(wall))
    return Episode(name, {"wall": wall, **group}, 0.005, columns)


def simulated(count=20, held=4, others=4, **facts):
    """A pool on gearbox 1, a held mass, another gearbox; every third episode has a wall."""
    pool = [
        episode(f"swing-{i}", wall=int(i % 3 == 0), frequency=0.3 + i / 50, mass=1.14, gearbox=1)
        for i in range(count)
    ]
    pool += [episode(f"mass-{i}", frequency=0.3 + i / 7, mass=1.71, gearbox=1) for i in range(held)]
    pool += [
        episode(f"unit-{i}", frequency=0.4 + i / 9, mass=1.14, gearbox=2) for i in range(others)
    ]
    known = {"training_gearbox": 1, "held_mass_kg": 1.71, **facts}
    return DataSet(tuple(pool), 60.0, 2.0, (-90.0, 90.0), known)


# Splits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_every_protocol_passes_its_own_audit_and_holds_back_what_it_says(protocol):
    data = simulated()
    found = split(data, protocol, 3)
    audit(data, found, HISTORY)
    assert found.protocol == protocol
    known = {one.name: one for one in data.episodes}
    taught = [known[name] for name in (*found.train, *found.validation)]
    tested = [known[name] for name in found.test]
    assert all(one.group["mass"] != 1.71 and one.group["gearbox"] == 1 for one in taught)
    held = {
        "trajectory": lambda one: one.group["mass"] == 1.14 and one.group["gearbox"] == 1,
        "mass": lambda one: one.group["mass"] == 1.71,
        "wall": lambda one: one.group["wall"] == 1,
        "gearbox": lambda one: one.group["gearbox"] == 2,
    }[protocol]
    assert tested
    assert all(held(one) for one in tested)
    if protocol == "wall":
        assert not any(one.group["wall"] for one in taught)
        assert len(tested) == 7


def test_the_default_size_leaves_sixty_tests_and_a_seventh_to_stop_by():
    found = split(simulated(count=320), "trajectory", 0)
    assert len(found.test) >= 60
    assert len(found.validation) == pytest.approx(0.15 * 320, abs=1)
    assert len(found.train) + len(found.validation) + len(found.test) == 320


@settings(max_examples=examples(10), deadline=None)
@given(st.integers(5, 60), st.integers(1, 4), st.integers(0, 1000))
def test_episodes_of_one_configuration_stay_together(count, repeats, seed):
    episodes = [
        episode(f"e{i}-{k}", samples=40, frequency=float(i))
        for i in range(count)
        for k in range(repeats)
    ]
    data = DataSet(tuple(episodes), 1.0, 1.0, (-1.0, 1.0))
    found = split(data, "trajectory", seed)
    audit(data, found, HISTORY)
    assert found == split(data, "trajectory", seed)
    assert sum(map(len, found.sides().values())) == len(episodes)
    side_of = {name: side for side, names in found.sides().items() for name in names}
    for i in range(count):
        assert len({side_of[f"e{i}-{k}"] for k in range(repeats)}) == 1


def test_another_seed_draws_another_test_set():
    data = simulated(count=40)
    assert split(data, "trajectory", 0).test != split(data, "trajectory", 1).test


def test_place_in_a_record_is_no_configuration():
    first, second = episode("a", record="r", first=0), episode("b", record="r", first=500)
    assert configuration(first) == configuration(second)


def test_logs_without_facts_split_by_trajectory():
    data = DataSet(tuple(episode(f"l{i}", log=f"l{i}") for i in range(6)), 1.0, 1.0, (-1.0, 1.0))
    audit(data, split(data, "trajectory", 0), HISTORY)
    with pytest.raises(UsageError, match="needs 'mass'"):
        split(data, "mass", 0)


@pytest.mark.parametrize("count", [1, 4])
def test_too_few_configurations_are_refused_with_the_least_number(count):
    data = simulated(count=count)
    with pytest.raises(UsageError, match="needs 5 configurations"):
        split(data, "trajectory", 0)


def test_many_episodes_of_one_configuration_are_too_few():
    data = DataSet(tuple(episode(f"e{i}", frequency=1.0) for i in range(30)), 1.0, 1.0, (-1.0, 1.0))
    with pytest.raises(UsageError, match="30 episodes of 1 configurations"):
        split(data, "trajectory", 0)


@pytest.mark.parametrize(
    ("data", "protocol", "told"),
    [
        (simulated(), "trajectories", "did you mean 'trajectory'"),
        (simulated(held=0), "mass", "no episode"),
        (simulated(others=0), "gearbox", "no episode"),
        (simulated(held_mass_kg=None), "mass", "held_mass_kg"),
        (simulated(training_gearbox=None), "gearbox", "training_gearbox"),
    ],
)
def test_a_split_that_the_data_cannot_give_is_refused(data, protocol, told):
    with pytest.raises(UsageError, match=told):
        split(data, protocol, 0)


# Planted leaks ----------------------------------------------------------------------------------


def moved(found: Split, name: str, *, keep: bool) -> Split:
    """A test episode put into training, or into both."""
    test = found.test if keep else tuple(one for one in found.test if one != name)
    return dataclasses.replace(found, train=(*found.train, name), test=test)


def test_an_episode_on_two_sides_is_found():
    data = simulated()
    good = split(data, "trajectory", 0)
    with pytest.raises(UsageError, match=f"leak: episode {good.test[0]} is in"):
        audit(data, moved(good, good.test[0], keep=True), HISTORY)


def test_a_configuration_on_two_sides_is_found():
    data = simulated()
    good = split(data, "trajectory", 0)
    known = {one.name: one for one in data.episodes}
    twin = dataclasses.replace(
        episode("twin", seed=1), group=dict(known[good.test[0]].group), name="twin"
    )
    more = dataclasses.replace(data, episodes=(*data.episodes, twin))
    with pytest.raises(UsageError, match=r"leak: .*twin.* one configuration|leak: .*one config"):
        audit(more, dataclasses.replace(good, train=(*good.train, "twin")), HISTORY)


@pytest.mark.parametrize(("protocol", "kind"), [("trajectory", "mass-0"), ("mass", "mass-1")])
def test_the_held_mass_in_training_is_found(protocol, kind):
    data = simulated()
    with pytest.raises(UsageError, match=r"leak: .*held mass"):
        audit(data, moved(split(data, protocol, 0), kind, keep=False), HISTORY)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_another_gearbox_in_training_is_found(protocol):
    data = simulated()
    with pytest.raises(UsageError, match=r"leak: unit-1 .*gearbox 2"):
        audit(data, moved(split(data, protocol, 0), "unit-1", keep=False), HISTORY)


def test_a_wall_in_training_is_found():
    data = simulated()
    good = split(data, "wall", 0)
    with pytest.raises(UsageError, match=r"leak: .*a wall"):
        audit(data, moved(good, good.test[0], keep=False), HISTORY)


def test_a_copy_under_another_name_and_configuration_is_found():
    data = simulated()
    good = split(data, "trajectory", 0)
    known = {one.name: one for one in data.episodes}
    source = known[good.test[0]]
    part = {name: values[10:70] for name, values in source.columns.items()}
    copy = Episode("copy", {**source.group, "frequency": 99.0}, source.dt, part)
    more = dataclasses.replace(data, episodes=(*data.episodes, copy))
    with pytest.raises(UsageError, match="share 60 readings"):
        audit(more, dataclasses.replace(good, train=(*good.train, "copy")), HISTORY)


def test_two_joints_at_rest_are_no_copies_of_each_other():
    still = {key: np.zeros(80) for key in ("position", "target", "velocity", "torque")}
    rest = tuple(Episode(f"r{i}", {"n": i}, 0.005, still) for i in range(6))
    data = DataSet(rest, 1.0, 1.0, (-1.0, 1.0))
    audit(data, split(data, "trajectory", 0), HISTORY)


def pieces(distance):
    """Six pieces of 100 samples of one record, so far apart."""
    made = tuple(
        episode(f"p{i}", samples=100, record="log", first=i * (100 + distance), piece=f"p{i}")
        for i in range(6)
    )
    return DataSet(made, 1.0, 1.0, (-1.0, 1.0))


@pytest.mark.parametrize("distance", [-50, 0, HISTORY - 1])
def test_pieces_of_a_record_nearer_than_the_history_are_found(distance):
    data = pieces(distance)
    with pytest.raises(UsageError, match=f"{distance} samples apart"):
        audit(data, split(data, "trajectory", 0), HISTORY)


def test_pieces_of_a_record_far_enough_apart_pass():
    data = pieces(HISTORY)
    audit(data, split(data, "trajectory", 0), HISTORY)


def test_a_long_piece_that_reaches_past_another_is_found():
    long = episode("long", samples=1000, record="log", first=0, piece=0)
    inner = episode("inner", samples=100, record="log", first=200, piece=1)
    outer = episode("outer", samples=100, record="log", first=850, piece=2)
    data = DataSet((long, inner, outer), 1.0, 1.0, (-1.0, 1.0))
    with pytest.raises(UsageError, match="samples apart"):
        audit(data, Split(("long",), ("inner",), ("outer",), "trajectory", 0), HISTORY)
    other = Split(("long", "inner"), ("x",), ("outer",), "trajectory", 0)
    apart = dataclasses.replace(
        data, episodes=(*data.episodes, episode("x", piece=3, record="else", first=0))
    )
    with pytest.raises(UsageError, match=r"long .*outer"):
        audit(apart, other, HISTORY)


@pytest.mark.parametrize("side", ["train", "validation", "test"])
def test_an_empty_side_and_an_unknown_episode_are_found(side):
    data = simulated()
    good = split(data, "trajectory", 0)
    with pytest.raises(UsageError, match=f"{side} side is empty"):
        audit(data, dataclasses.replace(good, **{side: ()}), HISTORY)
    with pytest.raises(UsageError, match="'ghost'"):
        audit(data, dataclasses.replace(good, **{side: ("ghost",)}), HISTORY)
    with pytest.raises(UsageError, match="history"):
        audit(data, good, 0)


# The split that should not be made --------------------------------------------------------------


def test_random_windows_leak_and_the_audit_says_so():
    data = simulated()
    windows, found = random_window_split(data, 0, history=HISTORY, lead=4, most=400)
    assert len(windows.episodes) == 400
    assert sum(map(len, found.sides().values())) == 400
    with pytest.raises(UsageError, match="leak"):
        audit(windows, found, HISTORY)
    known = {one.name: one for one in data.episodes}
    cut = {one.name: one for one in windows.episodes}
    one = cut[found.test[0]]
    source, first = known[str(one.group["record"])], int(one.group["first"])
    np.testing.assert_array_equal(
        one.columns["torque"], source.columns["torque"][first : first + HISTORY + 4]
    )
    assert all(one.group["mass"] == 1.14 and one.group["gearbox"] == 1 for one in cut.values())
    ranges = {(str(one.group["record"]), int(one.group["first"])) for one in cut.values()}
    assert len(ranges) == 400
    # Most test windows overlap with a window of training.
    taught = {
        (str(one.group["record"]), int(one.group["first"]))
        for one in (cut[name] for name in found.train)
    }
    near = [
        any(record == other and abs(first - place) < HISTORY for other, place in taught)
        for record, first in (
            (str(cut[name].group["record"]), int(cut[name].group["first"])) for name in found.test
        )
    ]
    assert np.mean(near) > 0.9


def test_windows_longer_than_any_episode_are_refused():
    with pytest.raises(UsageError, match="episodes of 508 samples"):
        random_window_split(simulated(), 0, history=500)
    with pytest.raises(UsageError, match="cannot be drawn"):
        random_window_split(simulated(), 0, history=0)
