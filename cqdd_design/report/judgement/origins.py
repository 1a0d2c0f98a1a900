"""Where every value of a design comes from: its file's own comments, defaults, derivations."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from cqdd_design.design import LARGEST_FILE, Design
from cqdd_design.design.model import supply_taken_over
from cqdd_design.design.reducer import PIN_CIRCLE_SHARE, RING_WALL
from cqdd_design.design.requirements import (
    DEFAULT_CONTINUOUS_SHARE,
    DEFAULT_PEAK_MOST,
    DEFAULT_PEAK_PER_RATIO,
)
from cqdd_design.files import read_text_file
from cqdd_design.report.ink.numbers import quantity_text
from cqdd_design.report.judgement.check_rows import printed
from cqdd_design.report.judgement.labels import GROUPS, Label, label_of

#: First words of a comment that name an origin.
_NAMED = re.compile(
    r"^(paper|derived|assumed|given|sized|chosen|catalogue)\b\s*(?:\(Z_\w\))?[:,;]?\s*(.*)$", re.S
)

#: Keys whose defaults follow from other values of the same file, and how.
_FOLLOWS = {
    "requirements.ratio": "the reducer's",
    "requirements.peak_torque": printed(
        f"min({DEFAULT_PEAK_PER_RATIO:g} N*m x ratio, {DEFAULT_PEAK_MOST:g} N*m)"
    ),
    "requirements.continuous_torque": f"{DEFAULT_CONTINUOUS_SHARE:g} of the peak torque",
    "reducer.output_pins.hole_clocking": "a quarter lobe pitch: two discs are one part",
    "reducer.output_pins.circle_radius": f"{PIN_CIRCLE_SHARE:g} of the ring pitch radius",
    "reducer.carrier.column_count": "with columns one between every two pins, else none",
    "reducer.ring.outer_diameter": f"root of the ring and a wall of {1e3 * RING_WALL:g} mm",
}


#: Values that read better in words.
_WORDS: dict[tuple[str, object], str] = {
    ("reducer.output_pins.support", "both"): "both ends",
    ("reducer.output_pins.support", "cantilever"): "one end",
    ("reducer.carrier.joint", "clamped"): "pins held tight in both",
    ("reducer.carrier.joint", "hinged"): "pins that turn in the cap",
}


@dataclass(frozen=True)
class Value:
    """One row of the table of values.

    Attributes
    ----------
    key : str
        Dotted key of the design file.
    shown : str
        Value and unit.
    origin : str
        ``paper``, ``derived``, ``assumed``, ``given``, ``default``, ...
    note : str
        Why this value, where anything is known.
    """

    key: str
    label: Label
    shown: str
    origin: str
    note: str


Group = tuple[str, tuple[Value, ...]]
"""A heading and its rows."""


def read_comments(path: Path) -> dict[str, str]:
    """The comments at the ends of lines of a design file, by dotted key.

    Parameters
    ----------
    path : Path
        A TOML file that has already been read as a design.
    """
    import tomlkit

    values = _flat(tomlkit.parse(read_text_file(path, LARGEST_FILE)), "")
    comments = {key: getattr(getattr(item, "trivia", None), "comment", "") for key, item in values}
    return {key: comment.lstrip("# ").strip() for key, comment in comments.items() if comment}


def values_by_group(design: Design, comments: Mapping[str, str]) -> tuple[Group, ...]:
    """All values of a design with their origins, grouped under headings in file order.

    Parameters
    ----------
    design : Design
        As the user gave it, so that `assumed` is complete.
    comments : mapping
        Dotted key to comment, from :func:`read_comments`.
    """
    assumed = set(design.assumed)
    derived = supply_taken_over(design)
    groups: dict[str, list[Value]] = {}
    for key, raw in _flat(design.to_mapping(), ""):
        table = key.rpartition(".")[0]
        if not table:
            continue
        origin, note = _origin(key, assumed, comments)
        if origin == "default" and key in derived:
            origin, note = "derived", derived[key]
        value = Value(key, label_of(key), _shown(key, raw), origin, note)
        groups.setdefault(GROUPS.get(table, table), []).append(value)
    return tuple((name, tuple(rows)) for name, rows in groups.items())


def _origin(key: str, assumed: set[str], comments: Mapping[str, str]) -> tuple[str, str]:
    if key in assumed:
        return ("derived", _FOLLOWS[key]) if key in _FOLLOWS else ("default", "")
    comment = comments.get(key, "")
    named = _NAMED.match(comment)
    if named:
        return named.group(1), printed(named.group(2))
    return "given", printed(comment)


def _flat(table: Mapping[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _shown(key: str, raw: object) -> str:
    if isinstance(raw, str) and (key, raw) in _WORDS:
        return _WORDS[key, raw]
    if isinstance(raw, bool):
        return "yes" if raw else "no"
    if isinstance(raw, str):
        return quantity_text(raw)
    if isinstance(raw, list):
        return "; ".join(
            f"{quantity_text(step['torque'])} at {quantity_text(step['speed'])} for "
            f"{100.0 * step['share']:g} %"
            for step in raw
        )
    return f"{raw:g}" if isinstance(raw, float) else str(raw)


class Folded(NamedTuple):
    """Groups of values: those that somebody chose or that follow, and those left to the program.

    Attributes
    ----------
    given, defaults : tuple of (str, tuple of Value)
        Headings and rows.
    left : int
        Number of the defaults.
    """

    given: tuple[Group, ...]
    defaults: tuple[Group, ...]
    left: int


def folded(groups: Sequence[Group], *, headings: bool = True) -> Folded:
    """Groups of values, apart by whether they are defaults; without `headings` these are empty."""

    def those(default: bool) -> tuple[Group, ...]:
        chosen = (
            (name, tuple(row for row in rows if (row.origin == "default") is default))
            for name, rows in groups
        )
        return tuple((name if headings else "", rows) for name, rows in chosen if rows)

    defaults = those(default=True)
    return Folded(those(default=False), defaults, sum(len(rows) for _, rows in defaults))
