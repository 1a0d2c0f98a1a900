"""Time left of unlike stages: what they took in earlier runs, and unknown where there was none."""

from __future__ import annotations

import json
import sys

import pytest
from test_cli_progress import Clock, Terminal
from test_cli_terminal import on_terminal

from cqdd_design.cli.progress import Bar
from cqdd_design.cli.session import Output
from cqdd_design.cli.stage_times import StageTimes
from cqdd_design.torque.training.recipe import EpochResult


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("CQDD_DESIGN_CACHE", str(tmp_path))
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


def run(seconds: dict[str, float], command: str = "report") -> list[float | None]:
    """What is told to be left at each stage of a run to the end."""
    clock = Clock()
    times = StageTimes(command, len(seconds), clock)
    told = []
    for text, took in seconds.items():
        told.append(times.left(text))
        clock.now += took
    times.keep()
    return told


def test_the_second_run_knows_what_the_first_took():
    assert run({"mass": 3.0, "backlash": 10.0, "life": 2.0}) == [None, None, None]
    assert run({"mass": 1.0, "backlash": 2.0, "life": 0.0}) == [15.0, 12.0, 2.0]
    # The same design again finds its results: half way to what it took.
    assert run({"mass": 1.0, "backlash": 2.0, "life": 0.0}) == [9.0, 7.0, 1.0]


def test_other_stages_or_another_command_are_other_work():
    run({"mass": 3.0, "backlash": 10.0})
    assert run({"mass": 3.0, "backlash": 10.0}, "bench") == [None, None]
    assert run({"mass": 3.0, "life": 1.0}) == [13.0, None]
    assert run({"mass": 3.0, "backlash": 1.0, "life": 1.0}) == [None, None, None]


def test_a_run_that_broke_off_teaches_nothing(cache):
    times = StageTimes("report", 3)
    times.left("mass")
    times.keep()
    assert not (cache / "stages").exists()


@pytest.mark.parametrize(
    "spoilt", ["", "{}", "[[1]]", '[["mass", "x"]]', '[["mass", NaN]]', '[["mass", -1]]', "[3]"]
)
def test_a_spoilt_file_counts_as_none(cache, spoilt):
    run({"mass": 3.0})
    (path,) = (cache / "stages").iterdir()
    assert json.loads(path.read_text()) == [["mass", 3.0]]
    path.write_text(spoilt)
    assert run({"mass": 4.0}) == [None]
    assert run({"mass": 4.0}) == [4.0]


def test_a_folder_that_cannot_be_written_is_no_harm(cache):
    (cache / "stages").write_text("a file")
    assert run({"mass": 3.0}) == [None]
    assert run({"mass": 3.0}) == [None]


def test_a_bar_tells_it():
    shown = Terminal()
    Bar(shown).stage(2, 3, "backlash", 11.2)
    assert shown.frames() == ["[######..............]  33 % 2 of 3: backlash (about 12 s left)"]


def test_who_knows_what_is_left_is_believed(cache, monkeypatch):
    """Epochs take alike long, and tell it themselves; nothing of them is kept."""
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    out = Output("train", as_json=False, quiet=False)
    tell = out.stages(2)
    tell("epoch 1 of 2", 7.0)
    tell("epoch 2 of 2", 0.0)
    out.end_progress(done=True)
    assert "epoch 1 of 2 (about 7 s left)" in shown.frames()[0]
    assert not (cache / "stages").exists()


@pytest.mark.parametrize(("epoch", "left"), [(1, 18.0), (3, 14.0), (10, 0.0)])
def test_epochs_take_as_long_as_the_last(epoch, left):
    assert EpochResult(epoch, 10, 1.0, 1.0, 1.0, seconds=2.0).left == left


@pytest.mark.deep
def test_a_command_knows_it_the_second_time(paper_design_file, tmp_path):
    words = ["export", str(paper_design_file), "--to", "dxf,bom", "--out", str(tmp_path / "files")]
    for last in (False, True):
        code, shown = on_terminal(*words, "--force")
        assert code == 0, shown
        assert ("s left)" in shown) == last, shown
