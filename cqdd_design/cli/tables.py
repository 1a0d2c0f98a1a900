"""Plain tables for terminals."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cqdd_design.results import Check


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
        rows.append(
            [
                check.status.upper() if check.status != "pass" else "pass",
                check.id,
                number(check.value),
                relation,
                number(check.limit),
                check.unit,
                margin,
                check.title,
            ]
        )
    head = ["", "check", "value", "", "limit", "unit", "margin", "what"]
    return table(rows, head=head, right=(2, 4, 6))


def verdict(checks: Sequence[Check]) -> str:
    """One sentence over all checks."""
    failed = sum(check.status == "fail" for check in checks)
    warned = sum(check.status == "warn" for check in checks)
    parts = [f"{len(checks) - failed - warned} of {len(checks)} checks pass"]
    if failed:
        parts.append(f"{failed} FAIL")
    if warned:
        parts.append(f"{warned} warn")
    return ", ".join(parts)


def remedies(checks: Sequence[Check]) -> str:
    """For each check that does not pass, what would make it pass."""
    return told([(check.id, check.remedy) for check in checks if check.status != "pass"])


def told(sentences: Sequence[tuple[str, str]]) -> str:
    """A list of names with a sentence each."""
    return "\n".join(
        textwrap.fill(f"{name}: {sentence}", width=96, initial_indent="- ", subsequent_indent="  ")
        for name, sentence in sentences
    )
