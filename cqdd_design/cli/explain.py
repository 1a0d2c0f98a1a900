"""``cqdd-design explain``."""

from __future__ import annotations

import textwrap
from typing import Annotated

import typer

from cqdd_design.cli.completion import checks
from cqdd_design.cli.fitting import WIDTH
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import table


def explain(
    out: Output,
    check: Annotated[
        str | None,
        typer.Argument(
            metavar="CHECK", help="Id of a check; without it, all ids.", autocompletion=checks
        ),
    ] = None,
) -> None:
    """Tell what a check means: its rule, why it matters, where it comes from."""
    from cqdd_design.gearbox.checks.guide import CHECK_GUIDE, check_guide

    if check is None:
        out.say(table([[g.id, g.title] for g in CHECK_GUIDE.values()], head=["check", "what"]))
        out.document({"checks": {g.id: g.title for g in CHECK_GUIDE.values()}})
        return
    guide = check_guide(check)
    effect = "exit code 4 from `check`" if guide.severity == "fail" else "a warning"
    if guide.exception:
        effect += f"; {guide.exception}"
    out.say(
        f"{guide.id}: {guide.title}",
        "",
        _paragraph("rule", guide.formula),
        _paragraph("unit", guide.unit or "none"),
        _paragraph("why", guide.why),
        _paragraph("source", guide.source),
        _paragraph("violated", effect),
    )
    out.document({**vars(guide)})


def _paragraph(title: str, text: str) -> str:
    return textwrap.fill(
        text, width=WIDTH, initial_indent=f"{title:<10}", subsequent_indent=" " * 10
    )
