"""Plastics that are printed or moulded: what they shrink, and how thin a wall may be; inserts."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, read_records


@dataclass(frozen=True)
class PrintedMaterial:
    """How a plastic becomes a part.

    Attributes
    ----------
    material : str
        Catalogue name.
    process : str
        ``FDM``, ``SLS``, ``SLA`` or ``moulded``.
    shrinkage : float
        From file to part, as a share of every length.
    line_width : float
        Of one line or spot, m; 0 where moulded.
    least_wall : float
        m.
    least_error, error_share : float or None
        To either side of a length, m, and as a share of it: the greater counts. None where moulded,
        since the tool decides.
    source : str
        Where the row comes from.
    """

    material: str = column("material")
    process: str = column("process")
    shrinkage: float = column("shrinkage_percent", 1e-2)
    line_width: float = column("line_width_mm", 1e-3)
    least_wall: float = column("least_wall_mm", 1e-3)
    least_error: float | None = column("accuracy_mm", 1e-3)
    error_share: float | None = column("accuracy_percent", 1e-2)
    source: str = column("source")

    def accuracy(self, length: float) -> float | None:
        """To either side of a length (m) as it comes off the machine, m; None where moulded.

        Examples
        --------
        >>> round(1e3 * printed_materials()["PA12 SLS"].accuracy(25e-3), 9)
        0.13
        >>> printed_materials()["PA66"].accuracy(25e-3) is None
        True
        """
        if self.least_error is None or self.error_share is None:
            return None
        return max(self.least_error, self.error_share * length)


@dataclass(frozen=True)
class Insert:
    """A heat-set insert, m.

    Attributes
    ----------
    thread, length : float
        Metric thread it holds; its own length.
    hole : float
        Diameter of the hole that it is melted into, as the part is.
    """

    name: str = column("name")
    thread: float = column("thread_mm", 1e-3)
    hole: float = column("hole_mm", 1e-3)
    length: float = column("length_mm", 1e-3)
    source: str = column("source")


@functools.lru_cache(maxsize=1)
def printed_materials() -> dict[str, PrintedMaterial]:
    """All of them by the name of the material, in file order."""
    return {one.material: one for one in read_records("printing.csv", PrintedMaterial)}


def made_how(material: str, otherwise: str) -> str:
    """How a part of a material is made: printed or moulded, or as it otherwise is.

    Examples
    --------
    >>> made_how("PLA", "turned"), made_how("7075-T6", "turned"), made_how("PA66", "turned")
    ('printed, FDM', 'turned', 'moulded')
    """
    found = printed_materials().get(material)
    if found is None:
        return otherwise
    return found.process if found.process == "moulded" else f"printed, {found.process}"


@functools.lru_cache(maxsize=1)
def inserts() -> tuple[Insert, ...]:
    """All heat-set inserts, the smallest first."""
    return tuple(read_records("inserts.csv", Insert))


def insert_for(thread: float, depth: float) -> Insert | None:
    """The longest insert of a thread that goes into a hole of a depth (m).

    Examples
    --------
    >>> insert_for(3e-3, 5e-3).name, insert_for(3e-3, 2e-3)
    ('heat-set insert M3 x 4', None)
    """
    fitting = [
        one for one in inserts() if abs(one.thread - thread) < 1e-6 and one.length <= depth + 1e-9
    ]
    return max(fitting, key=lambda one: one.length, default=None)
