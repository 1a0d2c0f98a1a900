"""Plain tables for terminals."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cqdd_design.results import Check
    from cqdd_design.verdict import Verdict


WIDTH = 80
"""Of a line, as far as what is told can be broken."""
_LEAST_WIDTH = 16
"""Of a last column that is folded."""


def table(
    rows: Sequence[Sequence[str]], *, head: Sequence[str] | None = None, right: Sequence[int] = ()
) -> str:
    """Columns as wide as their longest cell, two blanks apart; no trailing blanks.

    Words of the last column are folded where lines would be longer than 80.

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
    left = WIDTH - sum(width + 2 for width in widths[:-1])
    if len(widths) > 1 and _LEAST_WIDTH <= left < widths[-1] and len(widths) - 1 not in right:
        every = [piece for row in every for piece in _row_folded(row, left)]
        widths[-1] = max(len(row[-1]) for row in every)
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


def _row_folded(row: list[str], width: int) -> list[list[str]]:
    """A row, and the rows below it that go on with its last cell."""
    pieces = textwrap.wrap(row[-1], width, break_long_words=False, break_on_hyphens=False) or [""]
    blanks = [""] * (len(row) - 1)
    return [[*(row[:-1] if place == 0 else blanks), one] for place, one in enumerate(pieces)]


def number(value: float, digits: int = 4) -> str:
    """A number for people: four significant digits, no exponent in the usual range."""
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-3 <= abs(value) < 1e7:
        return f"{value:.0f}"
    return text


def checks_table(checks: Sequence[Check]) -> str:
    """One line a check: status, id, value, limit, margin; `explain` tells what each is."""
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
            ]
        )
    head = ["", "check", "value", "", "limit", "unit", "margin"]
    return table(rows, head=head, right=(2, 4, 6))


def _maybe(value: float | None) -> str:
    """A number, or that it is not known."""
    return "?" if value is None else number(value)


def headline_table(judged: Verdict) -> str:
    """The seven figures: status, what, value, what is asked, unit; then what they rest on."""
    rows = [
        [
            one.status.upper() if one.status != "pass" else "pass",
            one.title,
            _maybe(one.value),
            "-" if one.required is None else number(one.required),
            one.unit,
        ]
        for one in judged.headline
    ]
    bases: dict[str, list[str]] = {}
    for one in judged.headline:
        bases.setdefault(one.basis, []).append(one.title.partition(" of ")[0])
    figures = table(rows, head=["", "figure", "value", "asked", "unit"], right=(2, 3))
    return figures + "\n" + told([(", ".join(names), basis) for basis, names in bases.items()])


def costs_told(costs: Sequence[str]) -> list[str]:
    """What more would cost near a design, and an empty line; nothing where no search told."""
    if not costs:
        return []
    words = "what more would cost, near this design: " + "; ".join(costs)
    return [textwrap.fill(words, WIDTH, subsequent_indent="  "), ""]


def binding(judged: Verdict) -> str:
    """What limits a design, and what to change: what is not met, or else the closest lines."""
    short = [line for line in judged.limits if line.status != "pass"]
    if short:
        return "what is not met, and what would change that:\n" + told(
            [
                (
                    f"{line.id}, {line.title}",
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
        textwrap.fill(one, WIDTH, subsequent_indent="  ", break_on_hyphens=False)
        for one in sentences
    )


def remedies(checks: Sequence[Check]) -> str:
    """For each check that does not pass, what would make it pass."""
    return told(
        [(f"{check.id}, {check.title}", check.remedy) for check in checks if check.status != "pass"]
    )


def folded(sentence: str) -> list[str]:
    """A sentence in lines of 80 at most."""
    return textwrap.wrap(sentence, WIDTH, break_on_hyphens=False)


def told(sentences: Sequence[tuple[str, str]]) -> str:
    """A list of names with a sentence each."""
    return "\n".join(
        textwrap.fill(
            f"{name}: {sentence}", width=WIDTH, initial_indent="- ", subsequent_indent="  "
        )
        for name, sentence in sentences
    )
