"""Lines that a terminal of 80 columns breaks where nobody meant them to break."""

from __future__ import annotations

WIDTH = 80


def too_wide(text: str) -> list[str]:
    """Lines over 80 columns, but those of one path or address that no fold makes shorter."""
    return [
        line
        for line in text.splitlines()
        if len(line) > WIDTH
        and not line.startswith("wrote ")
        and max(len(word) for word in line.split()) <= WIDTH - 8
    ]
