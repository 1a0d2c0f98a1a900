"""Lines that a terminal of 80 columns breaks where nobody meant them to break."""

from __future__ import annotations

import re

WIDTH = 80


def too_wide(text: str) -> list[str]:
    """Lines over 80 columns, but those of one path or address that no fold makes shorter.

    In the last column of a table an address begins its line there, and may stand over the edge.
    """
    return [
        line
        for line in text.splitlines()
        if len(line) > WIDTH
        and not line.startswith("wrote ")
        and max(len(word) for word in line.split()) <= WIDTH - 8
        and not re.search(r"  /\S+/\S+$", line)
    ]
