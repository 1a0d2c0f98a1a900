"""Checks as the report shows them: grouped, with drawn formulas and margin bars."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from cqdd_design.report.ink.charts import margin_bar
from cqdd_design.report.ink.mathml import mathml
from cqdd_design.report.ink.numbers import MINUS, TIMES, significant, superscript, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.results import Check, Status, worst_status

#: Headings by the first part of a check's identifier, in the order of the report.
_HEADINGS = {
    "CONTACT": "Contact pressure",
    "PIN": "Output pins",
    "LIGAMENT": "Discs and ring",
    "ROOT": "Discs and ring",
    "RING": "Discs and ring",
    "BEARING": "Cam bearing",
    "THERMAL": "Heat",
    "MOTOR": "Motor",
    "SPACE": "Space",
    "GEO": "Shape",
    "FIT": "Fits",
    "BALANCE": "Balance and number of discs",
    "DISC": "Balance and number of discs",
    "EDM": "Wire EDM",
}
WORDS: dict[Status, str] = {"pass": "passes", "warn": "warning", "fail": "fails"}
_MANY = 1000.0


def check_row(check: Check) -> Values:
    """One check as shown: `limit` with its sense, `formula` and `bar` as markup."""
    sign = "≤" if check.sense == "max" else "≥"
    return {
        "check": check,
        "value": with_unit(_quiet(check.value, check.limit), check.unit),
        "limit": f"{sign} {with_unit(check.limit, check.unit)}",
        "margin": margin_text(check),
        "formula": mathml(check.formula),
        "bar": margin_bar(check),
        "substituted": printed(check.substituted),
        "remedy": "" if check.satisfied else sentence(printed(check.remedy)),
        "source": printed(check.source).rstrip("."),
        "word": WORDS[check.status],
    }


def _quiet(value: float, limit: float) -> float:
    """Zero where a value is rounding beside its limit."""
    return 0.0 if abs(value) < 1e-12 * abs(limit) else value


def margin_text(check: Check) -> str:
    """Margin to three digits; beyond a thousand only that it is ample.

    A margin that rounds to one although the check fails gets the digits that tell.
    """
    if abs(check.margin) >= _MANY:
        return "ample"
    for digits in (3, 4, 5, 6):
        shown = significant(check.margin, digits)
        if check.satisfied or shown != "1":
            return shown
    return "below 1"


def printed(text: str) -> str:
    """Plain text of a check with print signs: multiplication, degrees, units.

    Examples
    --------
    >>> printed("sqrt(1.15) 80 N*m <= 5 um")
    '√(1.15) 80 N·m ≤ 5 µm'
    """
    for plain, sign in (
        (" x ", f" {TIMES} "),
        (" - ", f" {MINUS} "),
        ("+-", "±"),
        ("N*m", "N·m"),
        ("g*mm", "g·mm"),
        ("sqrt(", "√("),
        ("<=", "≤"),
        (">=", "≥"),
    ):
        text = text.replace(plain, sign)
    text = re.sub(r"(?<![^\s(])-(?=\d)", MINUS, text)
    text = re.sub(r"\b1e(\d)\b", lambda found: "10" + superscript(int(found[1])), text)
    text = re.sub(r"(?<=\d) deg\b", "°", text)
    text = re.sub(r"\^3\b", "³", re.sub(r"\^2\b", "²", text))
    return re.sub(r"(?<=\d) um\b", " µm", text)


def sentence(text: str) -> str:
    """The text with a capital first letter and a full stop."""
    text = text.strip()
    if not text:
        return ""
    # Keys of the design file keep their case.
    head = text.split(" ", 1)[0]
    if "_" not in head and "." not in head:
        text = text[0].upper() + text[1:]
    return text if text.endswith((".", "!", "?")) else f"{text}."


def check_groups(checks: Iterable[Check]) -> tuple[tuple[str, Status, tuple[Values, ...]], ...]:
    """All checks under headings, with the worst status of each; within one, worst margin first."""
    grouped: dict[str, list[Check]] = {name: [] for name in _HEADINGS.values()}
    for check in checks:
        name = _HEADINGS.get(check.id.partition("-")[0], "Other checks")
        grouped.setdefault(name, []).append(check)
    return tuple(
        (
            name,
            worst_status(found),
            tuple(check_row(check) for check in sorted(found, key=_severity)),
        )
        for name, found in grouped.items()
        if found
    )


def _severity(check: Check) -> tuple[int, float]:
    return ({"fail": 0, "warn": 1, "pass": 2}[check.status], check.margin)


def failing(checks: Sequence[Check]) -> tuple[Values, ...]:
    """Failures, then warnings, each by least margin."""
    found = sorted((c for c in checks if not c.satisfied), key=_severity)
    return tuple(check_row(check) for check in found)


def closest(checks: Sequence[Check], number: int) -> tuple[Values, ...]:
    """The checks that are met with the least margins, least first."""
    met = sorted((c for c in checks if c.satisfied), key=lambda check: check.margin)
    return tuple(check_row(check) for check in met[:number])
