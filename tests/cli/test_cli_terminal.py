"""Colour: on a terminal, and nowhere else."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

from cqdd_design.cli.colour import coloured

CODES = re.compile(r"\x1b\[[0-9;]*m")

TABLE = """\
      check         value      limit  unit  margin
----  ------------  -----  --  -----  ----  ------
pass  GAP-DISCS       0.5  >=    0.3  mm      1.67
WARN  LIFE-CAM       1002  >=   1000  h          1
FAIL  RING-STRESS     120  <=    100  MPa    0.833
UNKNOWN  TORQUE         ?  >=     12  N*m        ?

cqdd-10 does NOT meet its requirements: of 3 lines 1 pass, 1 FAIL
next:
  cqdd-design check cqdd-10.toml"""


def test_codes_alone_are_added_and_only_where_they_say_something() -> None:
    told = coloured(TABLE)
    assert CODES.sub("", told) == TABLE
    assert "\x1b[32mpass\x1b[0m  GAP" in told
    assert "\x1b[33mWARN\x1b[0m  LIFE" in told
    assert "\x1b[31mFAIL\x1b[0m  RING" in told
    assert "\x1b[35mUNKNOWN\x1b[0m  TORQUE" in told
    assert told.startswith("\x1b[1m      check "), "a heading is bold"
    assert "\x1b[1;31mdoes NOT meet its requirements\x1b[0m" in told
    assert "  \x1b[36mcqdd-design check cqdd-10.toml\x1b[0m" in told
    assert "1 pass, 1 FAIL" in told, "counts are no statuses"
    assert coloured("passes of the wire: 3") == "passes of the wire: 3"


def on_terminal(*arguments: str, **environment: str) -> tuple[int, str]:
    """A command as it runs on a terminal: exit code, and what it shows there."""
    pty = pytest.importorskip("pty", reason="no pseudo-terminal here")
    ours, theirs = pty.openpty()
    kept = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "TERM")}
    process = subprocess.Popen(
        [sys.executable, "-m", "cqdd_design", *arguments],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        env=kept | {"TERM": "xterm"} | environment,
    )
    os.close(theirs)
    shown = b""
    while True:
        try:
            piece = os.read(ours, 65536)
        except OSError:  # the last writer has gone
            break
        if not piece:
            break
        shown += piece
    os.close(ours)
    return process.wait(), shown.decode().replace("\r\n", "\n")


def test_a_terminal_has_colour_and_the_same_words() -> None:
    code, shown = on_terminal("catalog", "fits")
    piped = subprocess.run(
        [sys.executable, "-m", "cqdd_design", "catalog", "fits"], capture_output=True, text=True
    )
    assert code == piped.returncode == 0
    assert CODES.search(shown)
    assert not CODES.search(piped.stdout)
    assert CODES.sub("", shown) == piped.stdout


@pytest.mark.parametrize("asked", [{"NO_COLOR": "1"}, {"TERM": "dumb"}])
def test_plain_text_can_be_asked_for(asked: dict[str, str]) -> None:
    _, shown = on_terminal("catalog", "fits", **asked)
    assert shown
    assert not CODES.search(shown)


def test_errors_begin_in_colour_and_documents_have_none() -> None:
    code, shown = on_terminal("check", "nowhere.toml")
    assert code == 2
    assert shown.startswith("\x1b[31mcqdd-design:\x1b[0m ")
    _, shown = on_terminal("check", "nowhere.toml", NO_COLOR="1")
    assert shown.startswith("cqdd-design: ")
    _, document = on_terminal("catalog", "fits", "--json")
    assert not CODES.search(document)


def test_sentences_keep_to_80_columns_on_a_terminal_and_stay_whole_in_a_pipe() -> None:
    missing = "-".join(["a", *["long"] * 12, "name"]) + ".toml"
    code, shown = on_terminal("check", missing)
    assert code == 2
    lines = CODES.sub("", shown).rstrip().split("\n")
    assert len(lines) > 1
    assert max(map(len, lines)) <= 80
    assert all(line.startswith("  ") for line in lines[1:])
    piped = subprocess.run(
        [sys.executable, "-m", "cqdd_design", "check", missing], capture_output=True, text=True
    )
    (whole,) = piped.stderr.rstrip().split("\n")
    assert len(whole) > 80
    assert " ".join(line.strip() for line in lines) == whole
