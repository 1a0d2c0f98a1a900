"""TOML and JSON from elsewhere: what is wrong is a sentence, whatever stands in the file."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from cqdd_design.errors import CqddError, UsageError, shown

#: Past what any table here is nested; a key with more dots takes its reader very long.
_DEEPEST = 40
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DOTTED = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{_DEEPEST}}}")
_MANY_DIGITS = re.compile(r"\d[\d_]{4000}")
_KEY_BEFORE = re.compile(r"""([\w.-]+)["']?\s*[=:]\s*[+-]?$""")


def parse_toml(text: str, path: Path, *, wrong: type[CqddError] = UsageError) -> dict[str, Any]:
    """The content of a TOML text, whose place is `path` in the error `wrong`."""
    deep = _DOTTED.search(text)
    if deep:
        line = text.count("\n", 0, deep.start()) + 1
        raise wrong(f"{path} has tables nested too deeply (at line {line}).")
    content: dict[str, Any] = _parsed(tomllib.loads, text, path, wrong)
    refuse_extremes(content, str(path), wrong=wrong)
    return content


def parse_json(text: str, path: Path, *, wrong: type[CqddError] = UsageError) -> Any:
    """The content of a JSON text, whose place is `path` in the error `wrong`."""
    content = _parsed(json.loads, text, path, wrong)
    refuse_extremes(content, str(path), finite=True, wrong=wrong)
    return content


def _parsed(read: Callable[[str], Any], text: str, path: Path, wrong: type[CqddError]) -> Any:
    """What tomllib or json make of a text."""
    try:
        return read(text)
    except tomllib.TOMLDecodeError as error:
        raise wrong(f"{path} is not valid TOML: {str(error)[:200]}.") from None
    except json.JSONDecodeError as error:
        raise wrong(f"{path} is not JSON (line {error.lineno}: {error.msg}).") from None
    except RecursionError:
        told = "JSON that can be read: it is" if read is json.loads else "valid TOML: tables"
        raise wrong(f"{path} is not {told} nested too deeply.") from None
    except ValueError:
        # A number too long for Python to read.
        long = _MANY_DIGITS.search(text)
        start = long.start() if long else 0
        key = _KEY_BEFORE.search(text[max(0, start - 200) : start])
        line = text.count("\n", 0, start) + 1
        raise wrong(
            f"{path}: {key[1] if key else 'a number'} has thousands of digits (at line {line}); "
            "no value here is that large."
        ) from None


def refuse_extremes(
    content: object, source: str, *, finite: bool = False, wrong: type[CqddError] = UsageError
) -> None:
    """Refuse numbers past 64 bits and deep nesting, which no file of ours has.

    Parameters
    ----------
    content : object
        Nested tables and lists.
    source : str
        What to call them in the message, which names the field.
    finite : bool
        Refuse floats that are not finite too.
    wrong : type
        The error.
    """
    waiting: list[tuple[tuple[str, ...], object]] = [((), content)]
    while waiting:
        place, value = waiting.pop()
        if isinstance(value, (Mapping, list, tuple)):
            if len(place) >= _DEEPEST:
                raise wrong(f"{source}: {'.'.join(place[:3])}... is nested too deeply.")
            inner = value.items() if isinstance(value, Mapping) else enumerate(value)
            waiting.extend(((*place, str(key)[:40]), one) for key, one in inner)
        elif isinstance(value, int) and value.bit_length() > 63:
            raise wrong(
                f"{source}: {'.'.join(place)} is {shown(value, 80)}; no value here is that large."
            )
        elif finite and isinstance(value, float) and not math.isfinite(value):
            raise wrong(f"{source}: {'.'.join(place)} is {value}; it must be a finite number.")
