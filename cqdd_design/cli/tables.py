"""Plain tables for terminals."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cqdd_design.results import Check
    from cqdd_design.verdict import Verdict


def table(
    rows: Sequence[Sequence[str]], *, head: Sequence[str] | None = None, right: Sequence[int] = ()
) -> str:
    """Columns as wide as their longest cell, two blanks apart; no trailing blanks.

    Parameters
    ----------
    rows : sequence of sequence of str
        All of one length.
    head : sequence of str, optional
        Titles, underlined.
    right : sequence of int
        Columns aligned to the right.
    """
    every = [list(head)] if head is not None else []
    every += [list(row) for row in rows]
    if not every:
        return ""
    widths = [max(len(row[i]) for row in every) for i in range(len(every[0]))]
    if head is not None:
        every.insert(1, ["-" * width for width in widths])
    lines = []
    for row in every:
        cells = [
            cell.rjust(width) if i in right else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)


def number(value: float, digits: int = 4) -> str:
    """A number for people: four significant digits, no exponent in the usual range."""
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-3 <= abs(value) < 1e7:
        return f"{value:.0f}"
    return text


def checks_table(checks: Sequence[Check]) -> str:
    """One line a check: status, id, value, limit, margin, title."""
    rows = []
    for check in checks:
        relation = "<=" if check.sense == "max" else ">="
        margin = f"{check.margin:.3g}" if abs(check.margin) < 100.0 else "large"
        margin = margin if check.known else "?"
        rows.append(
            [
                check.status.upper() if check.status != "pass" else "pass",
                check.id,
                _maybe(check.value),
                relation,
                _maybe(check.limit),
                check.unit,
                margin,
                check.title,
            ]
        )
    head = ["", "check", "value", "", "limit", "unit", "margin", "what"]
    return table(rows, head=head, right=(2, 4, 6))


def _maybe(value: float | None) -> str:
    """A number, or that it is not known."""
    return "?" if value is None else number(value)


def headline_table(judged: Verdict) -> str:
    """The seven figures: status, what, value, what is asked, unit, and what it rests on."""
    rows = [
        [
            one.status.upper() if one.status != "pass" else "pass",
            one.title,
            _maybe(one.value),
            "-" if one.required is None else number(one.required),
            one.unit,
            one.basis,
        ]
        for one in judged.headline
    ]
    return table(rows, head=["", "figure", "value", "asked", "unit", "by"], right=(2, 3))


def binding(judged: Verdict) -> str:
    """What limits a design, and what to change: what is not met, or else the closest lines."""
    short = [line for line in judged.limits if line.status != "pass"]
    if short:
        return "what is not met, and what would change that:\n" + told(
            [
                (
                    line.id,
                    f"{line.substituted}: {line.remedy}" if not line.known else line.remedy,
                )
                for line in short
            ]
        )
    closest = ", ".join(f"{line.id} {line.margin:.3g}" for line in judged.limits)
    sizes = ", ".join(line.id for line in judged.filled)
    sentences = [f"closest to their limits, by margin: {closest}"]
    sentences += [f"sizes at their limit: {sizes}"] if sizes else []
    return "\n".join(
        textwrap.fill(one, 96, subsequent_indent="  ", break_on_hyphens=False) for one in sentences
    )


def remedies(checks: Sequence[Check]) -> str:
    """For each check that does not pass, what would make it pass."""
    return told([(check.id, check.remedy) for check in checks if check.status != "pass"])


def told(sentences: Sequence[tuple[str, str]]) -> str:
    """A list of names with a sentence each."""
    return "\n".join(
        textwrap.fill(f"{name}: {sentence}", width=96, initial_indent="- ", subsequent_indent="  ")
        for name, sentence in sentences
    )
