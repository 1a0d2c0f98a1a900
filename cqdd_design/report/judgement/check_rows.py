"""Checks as the report shows them: grouped, with drawn formulas and margin bars."""

from __future__ import annotations

import re
from collections.abc import Iterable

from cqdd_design.report.ink.charts import margin_bar
from cqdd_design.report.ink.mathml import mathml
from cqdd_design.report.ink.numbers import MINUS, TIMES, significant, superscript, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.results import Check, Status, worst_status
from cqdd_design.terms import AMPLE, AMPLE_MARGIN

#: Headings by the first part of a check's identifier, in the order of the report.
_HEADINGS = {
    "CONTACT": "Contact pressure",
    "PIN": "Output pins",
    "LIGAMENT": "Discs and ring",
    "ROOT": "Discs and ring",
    "RING": "Discs and ring",
    "BEARING": "Bearings",
    "SUPPORT": "Bearings",
    "THERMAL": "Heat",
    "MOTOR": "Motor",
    "SPACE": "Space",
    "GEO": "Shape",
    "FIT": "Fits",
    "BALANCE": "Balance and number of discs",
    "DISC": "Balance and number of discs",
    "EDM": "Wire EDM",
    "YIELD": "Toleranced gearboxes",
    "SLEEVE": "Sleeves and rollers",
    "ROLLER": "Sleeves and rollers",
    "DUTY": "Motor",
}
WORDS: dict[Status, str] = {
    "pass": "passes",
    "warn": "warning",
    "fail": "fails",
    "unknown": "not known",
}


def check_row(check: Check) -> Values:
    """One check as shown: `limit` with its sense, `formula` and `bar` as markup."""
    sign = "≤" if check.sense == "max" else "≥"
    return {
        "check": check,
        "value": _told(check.value, check),
        "limit": "not known" if check.limit is None else f"{sign} {_told(check.limit, check)}",
        "margin": margin_text(check),
        "formula": mathml(check.formula),
        "bar": margin_bar(check) if check.known else "",
        "substituted": printed(check.substituted),
        "why_not_known": sentence(printed(check.substituted)) if check.status == "unknown" else "",
        "remedy": "" if check.satisfied else sentence(printed(check.remedy)),
        "why": printed(check.why),
        "basis": printed(check.basis),
        "source": printed(check.source).rstrip("."),
        "word": WORDS[check.status],
    }


def _told(value: float | None, check: Check) -> str:
    """A value with its unit; zero where it is rounding beside its limit."""
    if value is None:
        return "not known"
    quiet = 1e-12 * abs(check.limit or 0.0)
    return with_unit(0.0 if abs(value) < quiet else value, check.unit)


def margin_text(check: Check) -> str:
    """Margin to three digits; beyond a thousand only that it is ample.

    A margin that rounds to one although the check fails gets the digits that tell.
    """
    if not check.known:
        return "not known"
    if abs(check.margin) >= AMPLE_MARGIN:
        return AMPLE
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
        ("sqrt(", "√("),
        ("<=", "≤"),
        (">=", "≥"),
    ):
        text = text.replace(plain, sign)
    text = re.sub(r"(?<=[A-Za-z])\*(?=[A-Za-z])", "·", text)
    text = re.sub(r"(?<![^\s(])-(?=\d)", MINUS, text)
    text = re.sub(r"\b1e(\d)\b", lambda found: "10" + superscript(int(found[1])), text)
    text = re.sub(
        r"\b(\d(?:\.\d+)?)e([+-]\d+)\b",
        lambda found: f"{found[1]} {TIMES} 10{superscript(int(found[2]))}",
        text,
    )
    text = re.sub(r"(?<=\d)%", "\u202f%", text)
    text = re.sub(r"(?<=\d) degC\b", " °C", text)
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
    order = {"fail": 0, "unknown": 1, "warn": 2, "pass": 3}[check.status]
    return order, check.margin if check.known else 0.0
