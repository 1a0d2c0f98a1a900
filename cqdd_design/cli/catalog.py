"""``cqdd-design catalog``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cqdd_design.cli.completion import catalogued
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import folded, listing, number, table
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.catalog.browse import Row


def catalog(
    out: Output,
    what: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[[list|show] NAME]",
            help="A catalogue to list (materials, motors, bearings, screws, fits, "
            "lubricants, finishes, rubbing, circlips, nuts) or a row to show; without a name, what "
            "there is.",
            autocompletion=catalogued,
        ),
    ] = None,
) -> None:
    """List and show materials, motors, bearings, screws, fits, lubricants and more."""
    from cqdd_design.catalog import browse

    words = list(what or [])
    if words[:1] in (["list"], ["show"]):
        words.pop(0)
    if not words:
        every = browse.catalogues()
        rows = [
            [kind, str(len(found)), ", ".join(list(found)[:3])] for kind, found in every.items()
        ]
        out.say(table(rows, head=["catalogue", "rows", "such as"], right=(1,)))
        out.say("", "`cqdd-design catalog NAME` lists a catalogue or shows a row.")
        out.document({"catalogues": {kind: list(found) for kind, found in every.items()}})
        return
    kind, found = browse.look_up(" ".join(words))
    if len(found) == 1:
        ((name, row),) = found.items()
        out.say(name, table([[f"  {words}", told] for words, told in _row(row)]))
        if kind == "motors" and row["missing"] and row["torque_at"] == "motor":
            out.say(
                "",
                f"What hangs on {row['missing']} stays unknown, unless [motor] of the design or",
                "--motor-file gives it; `cqdd-design new motor` writes all keys.",
            )
    else:
        out.say(*_listed(kind, found))
    out.document({"kind": kind, "rows": {name: dict(row) for name, row in found.items()}})


def _row(row: Row) -> list[tuple[str, str]]:
    """Every column of a row in words, its value with the unit."""
    told = []
    for key, value in row.items():
        words, unit = term(key)
        told.append((words, _shown(value) + (f" {unit}" if unit and value is not None else "")))
    return told


def _listed(kind: str, found: Mapping[str, Row]) -> list[str]:
    """A catalogue: motors and geared actuators apart, since their torques stand at two places."""
    from cqdd_design.catalog import browse

    columns = browse.COLUMNS[kind]
    if kind != "motors":
        return [_columns(found, columns)]
    lines = []
    motors = {name: row for name, row in found.items() if row["torque_at"] == "motor"}
    geared = {name: row for name, row in found.items() if row["torque_at"] != "motor"}
    if motors:
        letters = _letters(motors)
        lines.append(_columns(motors, columns, letters))
        legend = ", ".join(f"{letter} {what}" for what, letter in letters.items())
        lines += folded(f"missing: {legend}") if letters else []
    if geared:
        head = [] if not motors else [""]
        lines += [*head, "geared actuators, torque and speed at their output:"]
        lines.append(_columns(geared, [name for name in columns if name != "missing"]))
    return lines


def _columns(
    found: Mapping[str, Row], columns: Sequence[str], letters: Mapping[str, str] | None = None
) -> str:
    titles = [" ".join(part for part in term(column) if part) for column in columns]
    rows = []
    for name, row in found.items():
        cells = [_short(row[column]) for column in columns]
        if letters is not None and row["missing"]:
            cells[-1] = "".join(letters[what] for what in row["missing"].split(", "))
        rows.append([name, *cells])
    return listing(rows, head=["name", *titles])


def _letters(motors: Mapping[str, Row]) -> dict[str, str]:
    """A letter for each thing that some motor lacks: the first of its own that is free."""
    letters: dict[str, str] = {}
    for row in motors.values():
        for what in row["missing"].split(", ") if row["missing"] else ():
            if what not in letters:
                used = letters.values()
                letters[what] = next(x for x in what + what.upper() if x != " " and x not in used)
    return letters


def _shown(value: Any) -> str:
    if value is None or value == "":
        return "-"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _short(value: Any) -> str:
    return number(value) if isinstance(value, float) else _shown(value)
