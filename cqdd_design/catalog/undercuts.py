"""Undercuts of ground cylinders (DIN 509, form E)."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records


@dataclass(frozen=True)
class UndercutSize:
    """An undercut as the standard sizes it, m.

    Attributes
    ----------
    over : float
        Diameters of cylinders above which it is the usual one.
    radius : float
        r, of its fillets.
    depth : float
        t1, below the cylinder.
    width : float
        f, along the cylinder.
    source : str
        Where the row comes from.
    """

    over: float = column("over_mm", 1e-3)
    radius: float = column("r_mm", 1e-3)
    depth: float = column("t1_mm", 1e-3)
    width: float = column("f_mm", 1e-3)
    source: str = column("source")

    @property
    def reach(self) -> float:
        """How far its fillet stands out over the cylinder at the shoulder, m."""
        return max(self.radius - self.depth, 0.0)


@functools.lru_cache(maxsize=1)
def undercuts() -> tuple[UndercutSize, ...]:
    """Undercuts by rising diameter."""
    return tuple(read_records("undercuts.csv", UndercutSize))


def undercut_for(diameter: float, corner: float, most_width: float) -> UndercutSize | None:
    """The largest undercut of a cylinder whose fillet a bearing's corner clears; None without room.

    Parameters
    ----------
    diameter : float
        Of the cylinder, m: no row of a larger one is taken.
    corner : float
        Least corner radius of the bearing, m.
    most_width : float
        Of the cylinder that it may take, m.

    Examples
    --------
    >>> undercut_for(10e-3, 0.3e-3, 3e-3).radius
    0.0004
    >>> undercut_for(10e-3, 0.3e-3, 0.4e-3) is None
    True
    """
    fitting = [
        row
        for row in undercuts()
        if row.over < diameter and row.reach <= corner + 1e-12 and row.width <= most_width + 1e-12
    ]
    return fitting[-1] if fitting else None
