"""Lock nuts of the KM series (DIN 981, ISO 2982-2) and their tab washers."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records


@dataclass(frozen=True)
class LockNut:
    """A size, m and kg.

    Attributes
    ----------
    designation : str
        Such as ``KM 6``.
    thread_diameter, pitch_length : float
        Of its thread.
    outer_diameter, face_diameter : float
        Of the nut, and of the face that lies on a bearing's ring.
    width : float
        Along the axis.
    slot_width, slot_depth : float
        Of the slots for a hook spanner.
    washer_width : float
        Thickness of the tab washer (MB) that locks it.
    mass : float
        kg.
    source : str
        Where the row comes from.
    """

    designation: str = column("designation")
    thread_diameter: float = column("G_mm", 1e-3)
    pitch_length: float = column("P_mm", 1e-3)
    outer_diameter: float = column("d3_mm", 1e-3)
    width: float = column("B_mm", 1e-3)
    face_diameter: float = column("d1_mm", 1e-3)
    slot_width: float = column("b_mm", 1e-3)
    slot_depth: float = column("h_mm", 1e-3)
    washer_width: float = column("washer_mm", 1e-3)
    mass: float = column("mass_kg")
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def lock_nuts() -> dict[str, LockNut]:
    """All sizes by designation, by rising thread.

    Examples
    --------
    >>> round(1e3 * lock_nuts()["KM 10"].outer_diameter, 9)
    70.0
    """
    return {one.designation: one for one in read_records("lock_nuts.csv", LockNut)}
