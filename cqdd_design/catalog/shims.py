"""Shim rings (DIN 988), and which packs a set of them makes."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records

SHIM_STEP = 0.1e-3
"""Thinnest ring that the trade keeps, and the step of packs, m."""
_SAME = 1e-6


@dataclass(frozen=True)
class ShimRing:
    """A size of ring, m; it is sold 0.1, 0.2, 0.3, 0.5 and 1 mm thick.

    Attributes
    ----------
    inner, outer : float
        Diameters.
    source : str
        Where the row comes from.
    """

    inner: float = column("d_mm", 1e-3)
    outer: float = column("D_mm", 1e-3)
    source: str = column("source")

    @property
    def designation(self) -> str:
        """Of one ring without its thickness, such as ``DIN 988 - 16 x 22``."""
        return f"DIN 988 - {1e3 * self.inner:g} x {1e3 * self.outer:g}"


@functools.lru_cache(maxsize=1)
def shim_rings() -> tuple[ShimRing, ...]:
    """Sizes of the standard by rising diameter."""
    return tuple(read_records("shims.csv", ShimRing))


def shim_ring(least_inner: float, most_inner: float, outer: float) -> ShimRing | None:
    """The ring that fills a bore and clears what turns inside it; None where there is none.

    Parameters
    ----------
    least_inner, most_inner : float
        Between which its hole may lie, m.
    outer : float
        Diameter of the bore, m.

    Examples
    --------
    >>> shim_ring(14e-3, 20e-3, 22e-3).inner
    0.016
    >>> shim_ring(53e-3, 60e-3, 65e-3) is None
    True
    """
    fitting = [
        row
        for row in shim_rings()
        if abs(row.outer - outer) < _SAME and least_inner - _SAME <= row.inner <= most_inner + _SAME
    ]
    return max(fitting, key=lambda row: row.inner, default=None)
