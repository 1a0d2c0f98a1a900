"""Small pieces of XML as text: attributes with nine digits, comments that cannot end early."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping
from xml.sax.saxutils import quoteattr


def number(value: float) -> str:
    """Shortest text of `value` at nine digits; whole numbers without a point."""
    text = f"{value:.9g}"
    return "0" if text in ("-0", "0") else text


def identifier(name: str) -> str:
    """`name` as it may stand in attributes and comments: no slash, no two hyphens in a row."""
    return re.sub(r"-{2,}", "-", name.replace("/", "-"))


def numbers(*values: float) -> str:
    """Numbers with spaces between."""
    return " ".join(map(number, values))


def element(name: str, attributes: Mapping[str, object], *children: str) -> str:
    """An element on one line, or with its children on lines of their own, two spaces deeper.

    Attributes that are None are left out, floats written by `number`.
    """
    written = "".join(
        f" {key}={quoteattr(number(value) if isinstance(value, float) else str(value))}"
        for key, value in attributes.items()
        if value is not None
    )
    if not children:
        return f"<{name}{written}/>"
    inner = "\n".join(textwrap.indent(child, "  ") for child in children)
    return f"<{name}{written}>\n{inner}\n</{name}>"


def comment(paragraphs: Iterable[str]) -> str:
    """Paragraphs as one comment; a line that begins with a space is kept as it is."""
    lines: list[str] = []
    for paragraph in paragraphs:
        if paragraph.startswith(" ") or not paragraph:
            lines.append(paragraph)
        else:
            lines += textwrap.wrap(paragraph, 96, break_long_words=False)
    body = "\n".join(f"  {line}".rstrip() for line in lines)
    # Two hyphens end a comment in XML.
    while "--" in body:
        body = body.replace("--", "- -")
    return f"<!--\n{body}\n-->"
