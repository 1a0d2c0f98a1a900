"""Plain tables for terminals."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from cqdd_design.cli.fitting import INDENT, WIDTH, Columns, folded_columns, wrapped
from cqdd_design.terms import AMPLE, AMPLE_MARGIN, hardly

if TYPE_CHECKING:
    from cqdd_design.results import Check
    from cqdd_design.verdict import Verdict


def table(
    rows: Sequence[Sequence[str]], *, head: Sequence[str] | None = None, right: Sequence[int] = ()
) -> str:
    """Columns as wide as their longest cell, two blanks apart; no trailing blanks.

    Where lines would be longer than 80, titles and words are folded; where that does not help,
    the other columns stand below the first, and else each row is told by itself.

    Parameters
    ----------
    rows : sequence of sequence of str
        All of one length.
    head : sequence of str, optional
        Titles, underlined.
    right : sequence of int
        Columns aligned to the right.
    """
    if not rows:
        return ""
    columns = folded_columns(rows, head, right)
    if columns is not None:
        return "\n".join(_lines(columns, right))
    return "\n".join(_below_names(rows, head, right))


def _lines(columns: Columns, right: Sequence[int]) -> list[str]:
    body = [line for row in columns.rows for line in row]
    return [_line(cells, columns.widths, right) for cells in [*_titles(columns), *body]]


def _titles(columns: Columns) -> list[list[str]]:
    """The titles with a line under them; nothing without titles."""
    line = ["-" * width for width in columns.widths]
    return [*columns.head, line] if columns.head else []


def _below_names(
    rows: Sequence[Sequence[str]], head: Sequence[str] | None, right: Sequence[int]
) -> list[str]:
    """Each name on a line of its own, the other columns aligned below it; titles stand once."""
    others = [row[1:] for row in rows]
    moved = [place - 1 for place in right]
    columns = folded_columns(others, head and head[1:], moved, WIDTH - INDENT)
    if columns is None:
        return [line for row in rows for line in _by_itself(row, head)]

    def below(cells: Sequence[str]) -> str:
        return " " * INDENT + _line(cells, columns.widths, moved)

    lines = [head[0]] if head else []
    lines += [below(cells) for cells in _titles(columns)]
    for row, pieces in zip(rows, columns.rows, strict=True):
        lines += [row[0], *(below(cells) for cells in pieces)]
    return lines


def _by_itself(row: Sequence[str], head: Sequence[str] | None) -> list[str]:
    """A row that no columns fit: its name, and below it the other cells with their titles."""
    titles = head[1:] if head is not None else [""] * (len(row) - 1)
    cells = [f"{title} {cell}".strip() for title, cell in zip(titles, row[1:], strict=True)]
    indent = " " * INDENT
    return [row[0], *wrapped("; ".join(cells), WIDTH, indent, indent)]


def _line(cells: Sequence[str], widths: Sequence[int], right: Sequence[int]) -> str:
    told = (
        cell.rjust(width) if place in right else cell.ljust(width)
        for place, (cell, width) in enumerate(zip(cells, widths, strict=True))
    )
    line = "  ".join(told).rstrip()
    # An address that no column holds begins further left.
    further = len(line) > WIDTH and len(cells) > 1 and not any(cells[:-1])
    return " " * INDENT + cells[-1] if further else line


def listing(rows: Sequence[Sequence[str]], *, head: Sequence[str]) -> str:
    """A table whose columns of numbers are found and aligned to the right; "-" is no value."""
    right = [
        place
        for place in range(1, len(head))
        if all(_is_number(row[place]) for row in rows) and any(row[place] != "-" for row in rows)
    ]
    return table(rows, head=head, right=right)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return cell == "-"
    return True


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
        margin = f"{check.margin:.3g}" if abs(check.margin) < AMPLE_MARGIN else AMPLE
        margin = margin if check.known else "?"
        rows.append(
            [
                check.status.upper() if check.status != "pass" else "pass",
                check.id,
                _maybe(check.value, check.unit),
                relation,
                _maybe(check.limit),
                check.unit,
                margin,
            ]
        )
    head = ["", "check", "value", "", "limit", "unit", "margin"]
    return table(rows, head=head, right=(2, 4, 6))


def _maybe(value: float | None, unit: str = "") -> str:
    """A number, or that it is not known."""
    return "?" if value is None else hardly(value, unit) or number(value)


def headline_table(judged: Verdict) -> str:
    """The seven figures: status, what, value, what is asked, unit; then what they rest on."""
    rows = [
        [
            one.status.upper() if one.status != "pass" else "pass",
            one.title,
            _maybe(one.value, one.unit),
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
        known = [(f"{line.id}, {line.title}", line.remedy) for line in short if line.known]
        return "what is not met, and what would change that:\n" + told([*known, *_unknown(short)])
    closest = ", ".join(f"{line.id} {line.margin:.3g}" for line in judged.limits)
    sizes = ", ".join(line.id for line in judged.filled)
    sentences = [f"closest to their limits, by margin: {closest}"]
    sentences += [f"sizes at their limit: {sizes}"] if sizes else []
    return "\n".join(
        textwrap.fill(one, WIDTH, subsequent_indent="  ", break_on_hyphens=False)
        for one in sentences
    )


def _unknown(lines: Sequence[Check]) -> list[tuple[str, str]]:
    """Lines that are not known with the reason; those of one reason together, which tells it."""
    by_reason: dict[str, list[Check]] = {}
    for line in lines:
        if not line.known:
            by_reason.setdefault(line.substituted.removesuffix("."), []).append(line)
    found = []
    for reason, alike in by_reason.items():
        names = ", ".join(line.id for line in alike)
        what = alike[0].title if len(alike) == 1 else f"{len(alike)} lines that are not known"
        # What all of them name; other reasons say themselves what to do.
        cures = {line.remedy for line in alike}
        cure = cures.pop() if len(cures) == 1 else "see why"
        told_too = "" if cure.startswith("see why") else f": {cure}"
        found.append((f"{names}, {what}", f"{reason}{told_too}"))
    return found


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
            f"{name}: {sentence}",
            width=WIDTH,
            initial_indent="- ",
            subsequent_indent="  ",
            break_on_hyphens=False,
        )
        for name, sentence in sentences
    )
