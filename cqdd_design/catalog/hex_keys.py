"""Hexagon socket screw keys (ISO 2936)."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records

_SAME = 1e-6


@dataclass(frozen=True)
class HexKey:
    """A key, m.

    Attributes
    ----------
    size : float
        Across flats.
    long_arm : float
        Of the standard series; long and extra long keys reach further.
    short_arm : float
        To the outside of the long one.
    source : str
        Where the row comes from.
    """

    size: float = column("s_mm", 1e-3)
    long_arm: float = column("long_arm_mm", 1e-3)
    short_arm: float = column("short_arm_mm", 1e-3)
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def hex_keys() -> tuple[HexKey, ...]:
    """Keys by rising size."""
    return tuple(read_records("hex_keys.csv", HexKey))


def hex_key(socket: float) -> HexKey:
    """The key of a socket (m across flats), or the nearest thinner one: inch keys are as long.

    Examples
    --------
    >>> round(1e3 * hex_key(3e-3).long_arm, 1), round(1e3 * hex_key(2.38e-3).size, 1)
    (66.0, 2.0)
    """
    fitting = [row for row in hex_keys() if row.size <= socket + _SAME]
    return fitting[-1] if fitting else hex_keys()[0]
