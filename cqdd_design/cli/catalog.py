"""``cqdd-design catalog``."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from cqdd_design.cli.completion import catalogued
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import table


def catalog(
    out: Output,
    what: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[[list|show] NAME]",
            help="A catalogue to list (materials, motors, bearings, screws, fits, "
            "lubricants, finishes, rubbing) or a row to show; without a name, what there is.",
            shell_complete=catalogued,
        ),
    ] = None,
) -> None:
    """List and show materials, motors, bearings, screws, fits, lubricants and finishes."""
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
        out.say(name, table([[f"  {key}", _shown(value)] for key, value in row.items()]))
        if kind == "motors" and row["missing"] and row["torque_at"] == "motor":
            out.say(
                "",
                f"What hangs on {row['missing']} stays unknown, unless [motor] of the design or",
                "--motor-file gives it; `cqdd-design new motor` writes all keys.",
            )
    else:
        columns = browse.COLUMNS[kind]
        rows = [[name, *(_shown(row[c]) for c in columns)] for name, row in found.items()]
        out.say(table(rows, head=["name", *columns]))
    out.document({"kind": kind, "rows": {name: dict(row) for name, row in found.items()}})


def _shown(value: Any) -> str:
    if value is None or value == "":
        return "-"
    return f"{value:g}" if isinstance(value, float) else str(value)
