"""Atomic writing leaves whole files or none; mass properties add like rigid bodies."""

import errno
import os
import re
import socket
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.environment import source_date
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.files import (
    kind_by_ending,
    parse_json,
    parse_toml,
    read_regular_file,
    read_text_file,
    refuse_overwrite,
    write_atomically,
    write_with,
)
from cqdd_design.results import Check, MassProperties


def test_failed_writer_leaves_nothing(tmp_path):
    def broken(path):
        path.write_text("half")
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError):
        write_with(tmp_path / "part.dxf", "dxf", broken)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "kinds", "said"),
    [
        ("a/r.txt", ("html",), "a/r.txt does not end in .html; name it a/r.html."),
        ("r.txt", ("npz", "parquet"), "ends neither in .npz nor in .parquet; name it r.npz."),
        ("fit", ("json",), "fit does not end in .json; name it fit.json."),
        ("..", ("json",), "name it "),
    ],
)
def test_a_file_is_called_what_it_holds(name, kinds, said):
    with pytest.raises(UsageError, match=re.escape(said)):
        kind_by_ending(Path(name), kinds, "stem")


def test_endings_are_known_in_capitals():
    assert kind_by_ending(Path("R.HTML"), ("html", "pdf"), "report") == "html"


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


KINDS = ["folder", "pipe", "device", "socket", "dangling", "link to a folder", "missing"]


@pytest.fixture
def irregular(tmp_path):
    """A function that puts something other than a file in place."""

    def make(kind):
        path = tmp_path / "thing"
        if kind == "folder":
            path.mkdir()
        elif kind == "pipe":
            os.mkfifo(path)
        elif kind == "device":
            path.symlink_to("/dev/zero")
        elif kind == "socket":
            with socket.socket(socket.AF_UNIX) as made:
                made.bind(os.path.relpath(path))
        elif kind == "dangling":
            path.symlink_to(tmp_path / "nowhere")
        elif kind == "link to a folder":
            (tmp_path / "folder").mkdir()
            path.symlink_to(tmp_path / "folder")
        return path

    return make


@pytest.mark.skipif(os.name != "posix", reason="needs pipes and devices")
@pytest.mark.parametrize("kind", KINDS)
def test_only_files_are_read(irregular, kind):
    with pytest.raises(UsageError, match="cannot read"):
        read_regular_file(irregular(kind), 1000)


@pytest.mark.skipif(os.name != "posix", reason="needs pipes and devices")
@pytest.mark.parametrize("kind", KINDS[:-1])
def test_what_is_no_file_is_never_replaced(irregular, tmp_path, kind):
    path = irregular(kind)
    before = sorted(tmp_path.iterdir()), os.lstat(path)
    for act in (
        lambda: refuse_overwrite(path, force=True),
        lambda: write_atomically(path, "x", "text"),
        lambda: write_with(path, "text", lambda place: place.write_text("x")),
    ):
        with pytest.raises(UsageError, match="cannot write"):
            act()
    assert (sorted(tmp_path.iterdir()), os.lstat(path)) == before


def test_through_a_link_its_file_is_replaced(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    target = tmp_path / "elsewhere" / "a.txt"
    target.write_text("old")
    link = tmp_path / "link.txt"
    link.symlink_to(target)
    with pytest.raises(UsageError, match="--force"):
        refuse_overwrite(link, force=False)
    refuse_overwrite(link, force=True)
    write_atomically(link, "new", "text")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_a_file_is_read_up_to_its_limit_whatever_size_it_claims(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"x" * 1000)
    assert read_regular_file(path, 1000) == b"x" * 1000
    with pytest.raises(DesignError, match=r"larger than 0\.000999 MB"):
        read_regular_file(path, 999, wrong=DesignError)
    if os.path.exists("/proc/self/maps"):  # says that it has 0 bytes
        with pytest.raises(UsageError, match="larger"):
            read_regular_file(Path("/proc/self/maps"), 10)


def test_windows_marks_are_left_out_and_utf_16_is_named(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes("name = 'é'".encode("utf-8-sig"))
    assert read_text_file(path, 1000) == "name = 'é'"
    path.write_bytes("name = 'é'".encode("utf-16"))
    with pytest.raises(UsageError, match="UTF-16; save it as UTF-8"):
        read_text_file(path, 1000)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * 100_000, "nested too deeply"),
        ("[" * 100 + "]" * 100, "nested too deeply"),
        ('{"a": {"b": 1' + 400 * "0" + "}}", r"a\.b is a whole number of 401 digits"),
        ('{"a": 1' + 5000 * "0" + "}", "a has thousands of digits"),
        ('{"a": [1, NaN]}', r"a\.1 is nan"),
        ('{"a": 1e999}', "a is inf"),
        ("{", "is not JSON"),
    ],
)
def test_extreme_json_is_refused_by_its_field(text, said):
    with pytest.raises(UsageError, match=said):
        parse_json(text, Path("a.json"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a." * 50_000 + "a = 1", r"nested too deeply \(at line 1\)"),
        ("x = 1\n[" + "a . " * 50_000 + "a]", r"nested too deeply \(at line 2\)"),
        ('"a".' * 50_000 + "a = 1", "nested too deeply"),
        ("a = " + "{b = " * 100 + "1" + "}" * 100, "nested too deeply"),
        ("a = " + "[" * 100_000, "nested too deeply"),
        ("[a]\nb = 1" + 400 * "0", r"a\.b is a whole number of 401 digits"),
        ("[a]\nb = 0x" + 5000 * "f", r"a\.b is a whole number of 6021 digits"),
        ("[a]\nb = 1" + 5000 * "0", r"b has thousands of digits \(at line 2\)"),
        ("a" * 900_000, "is not valid TOML"),
        ('"' * 900_000, "is not valid TOML"),
    ],
)
def test_extreme_toml_is_refused_by_its_field(text, said):
    before = time.process_time()
    with pytest.raises(DesignError, match=said):
        parse_toml(text, Path("a.toml"), wrong=DesignError)
    assert time.process_time() - before < 20.0


def test_dots_in_values_are_no_depth():
    text = "b = [" + "1.5, " * 1000 + "1.5]\n" + "\n".join(f"a{k}.b = 1" for k in range(100))
    assert len(parse_toml(text, Path("a.toml"))) == 101


@pytest.mark.parametrize("told", ["abc", "-1", "1.5", "1e9", "9" * 30, "253402300800", "\u0661"])
def test_a_nonsense_date_is_a_sentence(monkeypatch, told):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", told)
    with pytest.raises(UsageError, match="SOURCE_DATE_EPOCH"):
        source_date()


@pytest.mark.parametrize(
    ("told", "year"), [("", None), ("0", 1970), ("1700000000", 2023), ("253402300799", 9999)]
)
def test_the_date_of_the_environment(monkeypatch, told, year):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", told)
    moment = source_date()
    assert (moment and moment.year) == year


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
