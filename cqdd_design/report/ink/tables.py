"""What every table of a page has: heads that say what they head, and cells that tell their column.

A screen reader needs the scope of a head; a phone stacks the cells of a wide table, and each then
says the name of its column itself.
"""

from __future__ import annotations

import html
import re

_TABLE = re.compile(r"<table\b[^>]*>.*?</table>", re.S)
_HEAD = re.compile(r"<thead\b[^>]*>.*?</thead>", re.S)
_TH = re.compile(r"<th\b([^>]*)>(.*?)</th>", re.S)
_ROW = re.compile(r"<tr\b([^>]*)>(.*?)</tr>", re.S)
_CELL = re.compile(r"<td\b([^>]*)>(.*?)</td>", re.S)
_TAG = re.compile(r"<[^>]+>")
_SUNK = re.compile(r"<sub>(.*?)</sub>", re.S)
_FIGURE = re.compile(r"[-\u2212]?\d[\d.]*(?:,.*)?$")
_WIDE = 4
"""Tables of so many columns are stacked where the screen is narrow."""


def readable_tables(page: str) -> str:
    """A page whose tables have scopes and labels.

    Examples
    --------
    >>> readable_tables("<table><thead><tr><th>Part</th></tr></thead></table>")
    '<table><thead><tr><th scope="col">Part</th></tr></thead></table>'
    """
    return _TABLE.sub(lambda found: _table(found[0]), page)


def _table(table: str) -> str:
    head = _HEAD.search(table)
    if head is None:
        return table
    names = [_plain(content) for _, content in _TH.findall(head[0])]
    before, after = table[: head.start()], table[head.end() :]
    after = _TH.sub(lambda found: _scoped(found, "rowgroup"), after)
    if len(names) >= _WIDE:
        before = _classed(before)
        after = _ROW.sub(lambda row: _row(row, names), after)
    return before + _TH.sub(_heading, head[0]) + after


def _plain(content: str) -> str:
    return html.unescape(_TAG.sub("", _SUNK.sub(r"_\1", content))).strip()


def _heading(found: re.Match[str]) -> str:
    """A head of a column; one without words is no head."""
    if not _plain(found[2]):
        return f"<td{found[1]}></td>"
    return _scoped(found, "col")


def _scoped(found: re.Match[str], scope: str) -> str:
    kept = found[1] if "scope=" in found[1] else f' scope="{scope}"{found[1]}'
    return f"<th{kept}>{found[2]}</th>"


def _classed(before: str) -> str:
    if 'class="' in before:
        return before.replace('class="', 'class="stacked ', 1)
    return before.replace("<table", '<table class="stacked"', 1)


def _row(row: re.Match[str], names: list[str]) -> str:
    """A row whose cells tell their columns; what spans columns does not.

    The first cell is the head of a stacked row, and tells its column where it is a figure alone.
    """
    cells = _CELL.findall(row[2])
    if len(cells) != len(names):
        return row[0]
    told = iter(names)
    first = True

    def labelled(cell: re.Match[str]) -> str:
        nonlocal first
        name, kind, first = next(told), "head" if first else "label", False
        if not name or (kind == "head" and not _FIGURE.match(_plain(cell[2]))):
            return cell[0]
        return f'<td data-{kind}="{html.escape(name, quote=True)}"{cell[1]}>{cell[2]}</td>'

    return f"<tr{row[1]}>{_CELL.sub(labelled, row[2])}</tr>"
