"""Atomic writing leaves whole files or none; mass properties add like rigid bodies."""

import errno
import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.errors import UsageError
from cqdd_design.files import refuse_overwrite, write_atomically, write_with
from cqdd_design.results import Check, MassProperties


def test_failed_writer_leaves_nothing(tmp_path):
    def broken(path):
        path.write_text("half")
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError):
        write_with(tmp_path / "part.dxf", "dxf", broken)
    assert list(tmp_path.iterdir()) == []


def test_full_disk_is_a_sentence_and_keeps_the_old_file(tmp_path):
    target = tmp_path / "part.dxf"
    target.write_text("old")

    def full(path):
        path.write_text("half")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(UsageError, match="disk is full"):
        write_with(target, "dxf", full)
    assert target.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["part.dxf"]


def test_file_in_place_of_a_folder(tmp_path):
    (tmp_path / "out").write_text("")
    with pytest.raises(UsageError, match="out"):
        write_atomically(tmp_path / "out" / "a.toml", "x", "design")


def test_overwrite_needs_force(tmp_path):
    written = write_atomically(tmp_path / "a.txt", "x", "text")
    assert written.bytes == 1
    with pytest.raises(UsageError, match="--force"):
        refuse_overwrite(written.path, force=False)
    refuse_overwrite(written.path, force=True)


def _check(value, limit, sense):
    return Check("X", "x", value, limit, "", sense, "", "", "", "", "")


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6), st.sampled_from(["max", "min"]))
def test_margin_below_one_is_exactly_a_failed_check(value, limit, sense):
    check = _check(value, limit, sense)
    if abs(value - limit) > 1e-8 * limit:
        assert (check.status == "pass") == (check.margin > 1.0)


def test_check_refuses_numbers_that_are_none():
    with pytest.raises(ValueError, match="finite"):
        _check(float("nan"), 1.0, "max")


def random_body(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(8, 3))
    masses = rng.uniform(0.1, 2.0, 8)
    return points, masses


def lump(points, masses):
    centre = masses @ points / masses.sum()
    inertia = np.zeros((3, 3))
    for point, mass in zip(points - centre, masses, strict=True):
        inertia += mass * (point @ point * np.eye(3) - np.outer(point, point))
    return MassProperties(float(masses.sum()), centre, inertia)


@given(st.integers(0, 10_000))
def test_sum_of_bodies_is_the_body_of_all_points(seed):
    points, masses = random_body(seed)
    whole = lump(points, masses)
    halves = lump(points[:3], masses[:3]) + lump(points[3:], masses[3:])
    assert halves.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(halves.centre, whole.centre, atol=1e-12)
    np.testing.assert_allclose(halves.inertia, whole.inertia, atol=1e-10)


@given(st.integers(0, 10_000), st.floats(-3.0, 3.0))
def test_moved_body_is_the_body_of_moved_points(seed, angle):
    points, masses = random_body(seed)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([0.3, -0.2, 0.7])
    moved = lump(points, masses).moved(shift, turn)
    direct = lump(points @ turn.T + shift, masses)
    np.testing.assert_allclose(moved.centre, direct.centre, atol=1e-12)
    np.testing.assert_allclose(moved.inertia, direct.inertia, atol=1e-10)
