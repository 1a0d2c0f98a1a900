"""Metric threads as they are drilled, passed and ended: pitches, tap drills, clearance, grooves."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records
from cqdd_design.errors import CatalogError

_INCH = 25.4e-3


@dataclass(frozen=True)
class Thread:
    """A thread of 60 degrees, m."""

    diameter: float
    pitch: float

    @property
    def pitch_diameter(self) -> float:
        """d_2, and D_2 of the nut."""
        return self.diameter - 0.64952 * self.pitch

    @property
    def root_diameter(self) -> float:
        """d_3."""
        return self.diameter - 1.22687 * self.pitch

    @property
    def core_diameter(self) -> float:
        """D_1 of the nut (ISO 724)."""
        return self.diameter - 1.08253 * self.pitch

    @property
    def stress_diameter(self) -> float:
        """d_0, the mean of both (ISO 898-1)."""
        return 0.5 * (self.pitch_diameter + self.root_diameter)

    @property
    def stress_area(self) -> float:
        """A_S, m^2.

        Examples
        --------
        >>> round(coarse_thread(10e-3).stress_area * 1e6, 1)
        58.0
        """
        return 0.25 * math.pi * self.stress_diameter**2


@dataclass(frozen=True)
class ThreadSize:
    """A coarse metric thread and the holes that belong to it, m.

    Attributes
    ----------
    drill : float
        Tap drill (ISO 2306).
    fine, medium : float
        Clearance holes (ISO 273).
    source : str
        Where the row comes from.
    """

    diameter: float = column("thread_mm", 1e-3)
    pitch: float = column("pitch_mm", 1e-3)
    drill: float = column("drill_mm", 1e-3)
    fine: float = column("fine_mm", 1e-3)
    medium: float = column("medium_mm", 1e-3)
    source: str = column("source")


@dataclass(frozen=True)
class ThreadGroove:
    """The groove in which an outside thread of a pitch ends (DIN 76-1, form B), m.

    Attributes
    ----------
    below : float
        By which its floor's diameter is less than the thread's.
    width, fillet : float
    source : str
        Where the row comes from.
    """

    pitch: float = column("pitch_mm", 1e-3)
    below: float = column("below_mm", 1e-3)
    width: float = column("short_mm", 1e-3)
    fillet: float = column("r_mm", 1e-3)
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def thread_sizes() -> dict[float, ThreadSize]:
    """Coarse metric threads by nominal diameter in mm, in file order."""
    rows = read_records("threads.csv", ThreadSize)
    return {round(one.diameter * 1e3, 3): one for one in rows}


def coarse_thread(diameter: float) -> Thread:
    """The coarse metric thread of a nominal diameter, m."""
    row = thread_size_of(diameter)
    return Thread(row.diameter, row.pitch)


def thread_size_of(diameter: float) -> ThreadSize:
    """The row of a coarse metric thread of a nominal diameter (m).

    Raises
    ------
    CatalogError
        With the nearest size, when there is none.

    Examples
    --------
    >>> thread_size_of(3e-3).drill, thread_size_of(3e-3).medium
    (0.0025, 0.0034)
    """
    table, wanted = thread_sizes(), round(diameter * 1e3, 3)
    if wanted not in table:
        near = min(table, key=lambda one: abs(one - wanted))
        raise CatalogError(
            f"no coarse metric thread has a diameter of {wanted:g} mm; the nearest is M{near:g}."
        )
    return table[wanted]


def thread_named(name: str, diameter: float) -> Thread:
    """A thread written ``M3``, ``10-24`` or ``5/16-18``, whose major diameter (m) is known.

    Examples
    --------
    >>> print(round(thread_named("10-24", 4.826e-3).pitch * 1e3, 3))
    1.058
    """
    if name.startswith("M"):
        return coarse_thread(diameter)
    return Thread(diameter, _INCH / float(name.rpartition("-")[2]))


def tap_drill(thread: Thread) -> float:
    """Diameter of the drill before the tap, m.

    The table's, else the diameter less the pitch, to the next tenth of a millimetre.

    Examples
    --------
    >>> tap_drill(coarse_thread(4e-3)), tap_drill(thread_named("10-24", 4.826e-3))
    (0.0033, 0.0038)
    """
    row = thread_sizes().get(round(thread.diameter * 1e3, 3))
    if row is not None and math.isclose(row.pitch, thread.pitch):
        return row.drill
    return math.ceil((thread.diameter - thread.pitch) * 1e4 - 1e-6) / 1e4


@functools.lru_cache(maxsize=1)
def thread_grooves() -> tuple[ThreadGroove, ...]:
    """Grooves of outside threads, by rising pitch."""
    return tuple(read_records("thread_grooves.csv", ThreadGroove))


def groove_of(most_pitch: float) -> ThreadGroove:
    """The groove of the coarsest tabulated pitch up to `most_pitch` (m), or of the finest.

    Examples
    --------
    >>> groove_of(0.8e-3).pitch
    0.00075
    """
    rows = thread_grooves()
    return next((row for row in reversed(rows) if row.pitch <= most_pitch + 1e-12), rows[0])
