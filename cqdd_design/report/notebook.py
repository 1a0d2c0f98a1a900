"""A result on one short page, for notebooks: verdict, figures, front view, and chapters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from cqdd_design.machine import resolve
from cqdd_design.report.drawings.front_view import front_view
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.ink.page import Values, environment
from cqdd_design.report.judgement.check_rows import printed
from cqdd_design.report.judgement.verdict import verdict

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.machine import Machine
    from cqdd_design.verdict import Verdict


class Section(NamedTuple):
    """What follows below the drawing.

    Attributes
    ----------
    template : str
        Of the report, such as ``planetary.html``; `TABLE` for rows under headings.
    values : Values
        What it takes.
    """

    template: str
    values: Values


TABLE = "rows.html"


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> Section:
    """A table; a ``#`` before a column's name aligns its numbers."""
    return Section(TABLE, {"rows": {"title": title, "columns": columns, "rows": rows}})


def outlines_of(machine: Machine) -> Outlines:
    """The shapes that drawings show."""
    return Outlines.from_design(machine.design, machine.cam)


def notebook_page(
    design: Design, judged: Verdict | None, told: str, sections: Sequence[Section]
) -> str:
    """A page of HTML about one result.

    Parameters
    ----------
    design : Design
        Whose front view is drawn.
    judged : Verdict, optional
        Its figures and what is in the way of a yes come first.
    told : str
        The result in a line.
    sections : sequence of Section
        Further tables and pictures, in order.
    """
    context: Values = {
        "design": design,
        "told": printed(told.replace("`", "")),
        "verdict": None if judged is None else verdict(judged, ()),
        "front_view": front_view(outlines_of(resolve(design))),
        "sections": tuple(one.template for one in sections),
    }
    every = environment()
    # Each with its own values: two tables are of one template.
    chapters = [
        Markup(every.get_template(one.template).render(context | one.values)) for one in sections
    ]
    return every.get_template("notebook.html").render(context | {"chapters": chapters})
