"""Columns that take a line at most: heads over several lines first, then words of cells below.

Numbers are never folded, and no word is cut: an address longer than a line stays whole.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TextIO

WIDTH = 80
"""Of a line, as far as what is told can be broken."""
_GAP = 2
_LEAST_WIDTH, _LEAST_NAME = 10, 20
"""Columns of words and of names are not folded narrower, unless they are narrower by themselves."""
INDENT = 4
"""Of what stands below a name."""


@dataclass(frozen=True)
class Columns:
    """Lines of a table that fit.

    Attributes
    ----------
    head : list of list of str
        Cells of each line of the titles; none without titles.
    rows : list of list of list of str
        For each row its lines, of which a folded one has several.
    widths : list of int
    """

    head: list[list[str]]
    rows: list[list[list[str]]]
    widths: list[int]


def folded_columns(
    rows: Sequence[Sequence[str]],
    head: Sequence[str] | None,
    right: Sequence[int],
    width: int = WIDTH,
) -> Columns | None:
    """The columns, folded as little as makes them fit a line; None where nothing does.

    Parameters
    ----------
    rows : sequence of sequence of str
        All of one length, one at least.
    head : sequence of str, optional
        Titles.
    right : sequence of int
        Columns of numbers, which are not folded.
    width : int
        Of a line.
    """
    natural = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    least = [
        most if i in right else min(most, max(_least(i), _longest_word(rows, i)))
        for i, most in enumerate(natural)
    ]
    titles = list(head) if head is not None else [""] * len(natural)
    most_lines = max(len(title.split()) for title in titles) or 1
    # Names stay on one line as long as taller heads and folded words make room for them.
    for bounds in ([natural[0], *least[1:]], least):
        for lines in range(1, most_lines + 1):
            heads = [_width_in(title, lines) for title in titles]
            room = width - _GAP * (len(titles) - 1)
            fitting = _narrowed(_each_most(natural, heads), _each_most(bounds, heads), room)
            if fitting is not None:
                told = [] if head is None else _pieces(titles, fitting, set())
                body = [_pieces(row, fitting, set(right)) for row in rows]
                return Columns(told, body, fitting)
    return None


def _least(place: int) -> int:
    return _LEAST_WIDTH if place else _LEAST_NAME


def _each_most(first: Sequence[int], second: Sequence[int]) -> list[int]:
    return [max(pair) for pair in zip(first, second, strict=True)]


def _narrowed(widths: list[int], bounds: list[int], room: int) -> list[int] | None:
    """Widths that fill the room at most, the widest column narrowed first."""
    widths = list(widths)
    while sum(widths) > room:
        spare = [i for i, width in enumerate(widths) if width > bounds[i]]
        if not spare:
            return None
        widest = max(spare, key=lambda i: widths[i])
        widths[widest] -= 1
    return widths


def _pieces(row: Sequence[str], widths: Sequence[int], whole: set[int]) -> list[list[str]]:
    """The lines of a row; the first column goes on indented, so that a name reads as one."""
    columns = []
    for place, (cell, width) in enumerate(zip(row, widths, strict=True)):
        if place in whole or len(cell) <= width:
            columns.append([cell])
            continue
        indent = cell[: len(cell) - len(cell.lstrip())]
        after = indent + "  " if place == 0 else ""
        lines = wrapped(cell.strip(), width, indent, after) or [""]
        alone = place == len(row) - 1 and len(lines[0]) > width
        columns.append(["", *lines] if alone else lines)
    count = max(len(column) for column in columns)
    return [
        [column[line] if line < len(column) else "" for column in columns] for line in range(count)
    ]


def _width_in(title: str, lines: int) -> int:
    """The least width at which a title takes so many lines."""
    words = title.split()
    if not words or lines == 1:
        return len(title)
    for width in range(max(len(word) for word in words), len(title)):
        if len(wrapped(title, width, "", "")) <= lines:
            return width
    return len(title)


def _longest_word(rows: Sequence[Sequence[str]], place: int) -> int:
    """Of what a column holds; in names with the indent of lines that go on.

    Addresses of the last column are left out: where they are longer, they get a line of their own.
    """
    last = place == len(rows[0]) - 1
    words = (word for row in rows for word in row[place].split() if not (last and _address(word)))
    longest = max((len(word) for word in words), default=0)
    return longest if place else longest + 2


def _address(word: str) -> bool:
    """Whether a word is a folder, a file or a page."""
    return word.count("/") + word.count("\\") > 1


def wrapped(text: str, width: int, first: str, after: str) -> list[str]:
    """Lines between words, as `textwrap.wrap` does it, with no word cut."""
    return textwrap.wrap(
        text,
        width,
        initial_indent=first,
        subsequent_indent=after,
        break_long_words=False,
        break_on_hyphens=False,
    )


def on_screen(text: str, stream: TextIO | None) -> str:
    """Sentences in lines of 80 on a terminal; whole where they are piped, to be searched.

    A stream may be none at all: a process can be started with its standard output closed.
    """
    if stream is None or not stream.isatty():
        return text
    lines = [wrapped(line, WIDTH, "", "  ") or [""] for line in text.split("\n")]
    return "\n".join(part for line in lines for part in line)
