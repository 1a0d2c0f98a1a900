"""Colour on a terminal: what is met, what fails, what is a heading; plain text everywhere else."""

from __future__ import annotations

import os
import re
import sys
from typing import TextIO

_STYLES = {"pass": "32", "WARN": "33", "FAIL": "31", "UNKNOWN": "35"}
WARNING, ERROR = "warning:", "cqdd-design:"
"""What sentences on standard error begin with."""
_STATUS = re.compile(rf"^({'|'.join(_STYLES)})(?=\s)", re.M)
_HEAD = re.compile(r"^(?!-)(.*\S)\n(-+(?:  -+)*)$", re.M)
_COMMAND = re.compile(r"^( +)(cqdd-design .*)$", re.M)
_SENTENCES = (
    (re.compile(r"does NOT meet its requirements"), "1;31"),
    (re.compile(r"is not shown to meet its requirements"), "1;35"),
    (re.compile(r"\bmeets its requirements"), "1;32"),
)


def is_coloured(stream: TextIO) -> bool:
    """Whether to colour what goes to a stream: a terminal that can, and no ``NO_COLOR``.

    Any text in the environment's ``NO_COLOR`` (no-color.org) or ``TERM=dumb`` asks for plain text.
    """
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    if sys.platform == "win32" and not (os.environ.get("WT_SESSION") or os.environ.get("TERM")):
        return False  # the old console shows escape codes as they are
    return stream.isatty()


def coloured(text: str) -> str:
    """Finished lines with colour: columns keep their width, since codes take none."""
    text = _HEAD.sub(lambda found: f"{_in('1', found[1])}\n{_in('2', found[2])}", text)
    text = _STATUS.sub(lambda found: _in(_STYLES[found[1]], found[1]), text)
    text = _COMMAND.sub(lambda found: found[1] + _in("36", found[2]), text)
    for pattern, style in _SENTENCES:
        text = pattern.sub(_in(style, r"\g<0>"), text)
    return text


def with_coloured_start(text: str, start: str, stream: TextIO) -> str:
    """A sentence on standard error, its start in colour: of a warning or an error."""
    if not (text.startswith(start) and is_coloured(stream)):
        return text
    style = _STYLES["WARN" if start == WARNING else "FAIL"]
    return _in(style, start) + text.removeprefix(start)


def _in(style: str, text: str) -> str:
    return f"\x1b[{style}m{text}\x1b[0m"
