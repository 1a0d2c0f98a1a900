"""Progress on a terminal: time left from work done, 100 % at the end, nothing else elsewhere."""

from __future__ import annotations

import io
import re
import sys

import pytest
from test_cli_terminal import on_terminal

from cqdd_design.cli.progress import Bar, duration
from cqdd_design.cli.session import Output


@pytest.fixture(autouse=True)
def eighty_columns(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True

    def frames(self) -> list[str]:
        """What a line showed, one after the other."""
        return [one for one in self.getvalue().replace("\x1b[K", "").split("\r") if one]


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_time_left_follows_the_pace_of_what_is_done():
    shown, clock = Terminal(), Clock()
    bar = Bar(shown, clock)
    for done, now in ((100, 110.0), (300, 130.0), (400, 140.0)):
        clock.now = now
        bar.counted(done, 400, "gearboxes")
    bar.finish()
    assert shown.frames() == [
        "[#####...............]  25 % 100 of 400 gearboxes, 30 s left",
        "[###############.....]  75 % 300 of 400 gearboxes, 10 s left",
        "[####################] 100 % 400 of 400 gearboxes",
        "[####################] 100 % done in 40 s\n",
    ]


def test_time_before_the_first_of_them_is_not_theirs():
    """Crank angles are counted after the solids were built, which took a minute."""
    shown, clock = Terminal(), Clock()
    bar = Bar(shown, clock)
    clock.now = 160.0
    bar.stage(2, 2, "turning the solids")
    clock.now = 161.0
    bar.counted(1, 5, "crank angles")
    assert "1 of 5 crank angles, 4 s left" in shown.frames()[-1]


def test_time_left_of_unlike_stages_is_said_to_be_unknown():
    shown, clock = Terminal(), Clock()
    bar = Bar(shown, clock)
    bar.stage(1, 3, "mass")
    clock.now = 105.0
    bar.stage(2, 3, "backlash")
    clock.now = 112.0
    bar.round("judging sized-10")
    bar.counted(1, 4, "kernels compiled", alike=False)
    told = shown.frames()
    assert told[0].endswith("  0 % 1 of 3: mass")
    assert told[1].endswith(" 33 % 2 of 3: backlash (5 s so far, time left unknown)")
    assert told[2].endswith("judging sized-10 (12 s so far, time left unknown)")
    assert "%" not in told[2]
    assert told[3].endswith("1 of 4 kernels co (12 s so far, time left unknown)"), "79 columns"


def test_what_broke_off_never_shows_a_hundred_percent():
    shown = Terminal()
    bar = Bar(shown)
    bar.counted(3, 10, "gearboxes")
    bar.finish()
    assert "100 %" not in shown.getvalue()
    assert shown.getvalue().endswith("\r\x1b[K")
    bar.stage(1, 2, "mass")
    bar.wipe()
    assert "100 %" not in shown.getvalue()


def test_no_line_is_longer_than_the_terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    shown = Terminal()
    Bar(shown).stage(1, 3, "a stage of many words " * 5)
    assert len(shown.frames()[0]) == 39


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.2, "1 s"), (59.1, "1 min"), (61.0, "1 min 1 s"), (3600.0, "1 h"), (7260.0, "2 h 1 min")],
)
def test_times_are_told_in_two_units(seconds, words):
    assert duration(seconds) == words


def test_quiet_shows_no_bar(monkeypatch):
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    out = Output("tolerance", as_json=False, quiet=True)
    out.counting("gearboxes")(5, 10)
    out.stages(3)("mass")
    out.end_progress(done=True)
    assert shown.getvalue() == ""


def test_what_a_search_has_found_out_stays(monkeypatch):
    """A sentence has a line of its own, whole; the bar is drawn anew below it."""
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    tell = Output("size", as_json=False, quiet=False).rounds()
    sentence = "20 N*m " * 20 + "do not fit."
    tell("searching")
    tell(sentence)
    tell("looking for the torques that fit")
    before, _, after = shown.getvalue().partition(f"{sentence}\n")
    assert before.endswith("\r\x1b[K")
    assert after.startswith("\r\x1b[K[")
    assert "looking for the torques" in after


def test_elsewhere_there_are_plain_lines(monkeypatch):
    told = io.StringIO()
    monkeypatch.setattr(sys, "stderr", told)
    out = Output("tolerance", as_json=True, quiet=False)
    progress, tell = out.counting("gearboxes"), out.stages(2)
    for done in range(1, 101):
        progress(done, 100)
    tell("weighing")
    out.rounds()("searching")
    out.end_progress(done=True)
    lines = told.getvalue().splitlines()
    assert lines[0] == "[1/10] 10 of 100 gearboxes"
    assert lines[9:] == ["[10/10] 100 of 100 gearboxes", "[1/2] weighing", "searching"]
    assert "\r" not in told.getvalue()


@pytest.mark.deep
def test_commands_end_at_a_hundred_percent(paper_design_file, tmp_path):
    """Stages, a count, and a search."""
    design = str(paper_design_file)
    for words in (
        ["export", design, "--to", "dxf", "--out", str(tmp_path / "files")],
        ["tolerance", design, "--samples", "8", "--angles", "44"],
        ["size", "--ratio", "10", "--quick", "--out", str(tmp_path / "s.toml")],
    ):
        code, shown = on_terminal(*words)
        assert code == 0, shown
        assert len(re.findall(r"\[#{20}\] 100 % done in .* s\n", shown)) == 1, words
