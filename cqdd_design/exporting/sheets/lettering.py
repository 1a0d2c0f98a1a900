"""Helvetica by its published widths: text of drawings is text, in the PDF and in the SVG.

Every PDF reader has Helvetica, so nothing is embedded and no font need be installed where a sheet
is written: the same design gives the same bytes everywhere.

Source of the widths and of the height of capitals: Adobe Font Metrics, Core 14 fonts, Helvetica.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from types import MappingProxyType

CAP_HEIGHT = 0.718
"""Height of capitals in ems."""
DESCENDER = 0.207
"""Depth of descenders in ems."""

_LOWER = """
    556 556 500 556 556 278 556 556 222 222 500 222 833 556 556 556 556 333 500 278 556 500 722
    500 500 500
"""
_UPPER = """
    667 667 722 722 667 611 778 722 278 500 667 556 833 722 778 667 778 722 667 611 722 667 944
    667 667 611
"""
_SIGNS = {
    **dict.fromkeys(" !,./:;[\\]I\u00b7", 278),
    **dict.fromkeys('"', 355),
    **dict.fromkeys("#$?_\u00b5", 556),
    **dict.fromkeys("()-`\u00b2\u00b3", 333),
    **dict.fromkeys("+<=>~\u00b1\u00d7", 584),
    **dict.fromkeys("{}", 334),
    "%": 889,
    "&": 667,
    "'": 191,
    "*": 389,
    "@": 1015,
    "^": 469,
    "|": 260,
    "\u00b0": 400,
    "\u00d8": 778,
}
WIDTHS: Mapping[str, int] = MappingProxyType(
    dict(zip(string.ascii_letters, map(int, (_LOWER + _UPPER).split()), strict=True))
    | dict.fromkeys(string.digits, 556)
    | _SIGNS
)
"""Thousandths of an em; among the signs are diameter, degree, plus-minus, times and micro."""


def text_width(text: str, cap_height: float) -> float:
    """Width of a line whose capitals are `cap_height` high, in the same unit.

    Examples
    --------
    >>> round(text_width("0", 0.718), 3)
    0.556
    """
    return sum(WIDTHS.get(sign, 556) for sign in printable(text)) * 1e-3 * cap_height / CAP_HEIGHT


def printable(text: str) -> str:
    """Return the text with every sign that the font does not have replaced by ``?``."""
    plain = text.replace("\u00a0", " ")
    return "".join(sign if sign in WIDTHS else "?" for sign in plain)


def fitting_height(text: str, height: float, room: float) -> float:
    """Cap height at which `text` is no wider than `room`, at most `height`."""
    return min(height, height * room / max(text_width(text, height), 1e-9))


def short_number(value: float, decimals: int) -> str:
    """`value` to so many decimals, without the zeros at its end; never ``-0``."""
    return f"{round(float(value), decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".")
