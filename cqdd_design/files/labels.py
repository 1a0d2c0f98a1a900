"""Names of things as parts of file names."""

from __future__ import annotations

import re


def file_label(name: str) -> str:
    """A part's name as the end of a file name.

    Examples
    --------
    >>> file_label("shaft bearing, housing end")
    'shaft-bearing-housing-end'
    """
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
