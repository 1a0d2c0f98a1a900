"""The kinds of holes of a part, and the circles they stand on.

Lengths are in metres, angles in radians; datums and directions as in `kinds`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

from cqdd_design.catalog.fits import FitLimits, fit_limits

Facing = Literal["up", "down"]
Centre: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class BoltCircle:
    """Where the holes of a pattern stand; holes that share one are made in one setting.

    Attributes
    ----------
    name : str
        Such as ``output bolts``; the same on parts that are put together by it.
    radius : float
        About the part's axis, m.
    angles : tuple of float
        Directions of the holes from +x, rad.
    """

    name: str
    radius: float
    angles: tuple[float, ...]

    @classmethod
    def even(cls, name: str, count: int, radius: float, first: float = 0.0) -> BoltCircle:
        """Holes evenly spaced, the first in a direction (rad)."""
        step = 2.0 * math.pi / count
        return cls(name, radius, tuple(first + step * i for i in range(count)))

    @property
    def count(self) -> int:
        """Number of holes."""
        return len(self.angles)

    @property
    def centres(self) -> tuple[Centre, ...]:
        """Axes of the holes, m."""
        return tuple((self.radius * math.cos(a), self.radius * math.sin(a)) for a in self.angles)


@dataclass(frozen=True)
class TappedHole:
    """Tapped holes: drilled, countersunk and cut with a tap.

    Attributes
    ----------
    thread, pitch : float
        Nominal diameter and pitch of the thread, m.
    designation : str
        Such as ``M4`` or ``10-24 UNC``.
    tolerance : str
        Class of the thread, such as ``6H``.
    drill : float
        Diameter of the tap drill, m.
    mouth : float
        Height of the face the hole opens in, m.
    facing : {"up", "down"}
        The way that face looks.
    thread_depth, drill_depth : float
        Of the full thread, and of the drill's cylinder without its point, m; of a hole right
        through both are the thickness.
    through : bool
    countersink : float
        Diameter of the 90 degree countersink at the mouth, m; 0 where the mouth lies in a bore.
    circle : BoltCircle
    position : float
        Diameter of the zone of its axis, m.
    refers : str
        Letters of the datums of the position.
    """

    name: str
    thread: float
    pitch: float
    designation: str
    tolerance: str
    drill: float
    mouth: float
    facing: Facing
    thread_depth: float
    drill_depth: float
    through: bool
    countersink: float
    circle: BoltCircle
    position: float
    refers: str = "A"


@dataclass(frozen=True)
class ClearanceHole:
    """Holes that a screw passes freely.

    Attributes
    ----------
    thread : float
        Nominal diameter of the screw, m.
    diameter : float
        By ISO 273, m.
    series : {"medium", "fine"}
        Of ISO 273.
    bottom, top : float
        m.
    circle, position, refers
        As of `TappedHole`.
    """

    name: str
    thread: float
    diameter: float
    series: Literal["medium", "fine"]
    bottom: float
    top: float
    circle: BoltCircle
    position: float
    refers: str = "A"


@dataclass(frozen=True)
class Counterbore:
    """Flat recesses for the heads of screws (DIN 974-1), or over threads that begin below a face.

    Attributes
    ----------
    diameter : float
        m.
    mouth : float
        Height of the face it opens in, m.
    facing : {"up", "down"}
        The way that face looks.
    depth : float
        m.
    circle, refers
        As of `TappedHole`.
    """

    name: str
    diameter: float
    mouth: float
    facing: Facing
    depth: float
    circle: BoltCircle
    refers: str = "A"


@dataclass(frozen=True)
class FittedHole:
    """Reamed or bored holes for pins and dowels.

    Attributes
    ----------
    diameter : float
        Nominal, m.
    zone : str
        ISO 286, such as ``H7``.
    bottom, top : float
        m.
    through : bool
    facing : {"up", "down"}
        The way the face looks in which it is entered.
    pointed : bool
        Whether it ends in the point of its drill, beyond `bottom` and `top`; else it is flat.
    roughness : float
        Ra, m.
    circle, position, refers
        As of `TappedHole`.
    seam : bool
        Whether it lies across the seam with another part, which has the other half; the outline of
        the part's layers has this one.
    """

    name: str
    diameter: float
    zone: str
    bottom: float
    top: float
    through: bool
    pointed: bool
    facing: Facing
    roughness: float
    circle: BoltCircle
    position: float
    refers: str = "A"
    seam: bool = False

    @property
    def limits(self) -> FitLimits:
        """Deviations from nominal; a `CatalogError` where the zone's table ends."""
        return fit_limits(self.zone, self.diameter)


@dataclass(frozen=True)
class PlainHole:
    """Holes to general tolerances: for cables, to save weight, for a tool.

    Attributes
    ----------
    diameter, bottom, top : float
        m.
    circle : BoltCircle
    """

    name: str
    diameter: float
    bottom: float
    top: float
    circle: BoltCircle


@dataclass(frozen=True)
class CutHole:
    """Round holes cut by wire in one setting with a profile; the outline of the layers has them.

    Attributes
    ----------
    diameter, bottom, top : float
        m.
    circle, position, refers
        As of `TappedHole`.
    datum : str
        Letter; see the module.
    """

    name: str
    diameter: float
    bottom: float
    top: float
    circle: BoltCircle
    position: float
    datum: str = ""
    refers: str = "A"


Hole: TypeAlias = TappedHole | ClearanceHole | Counterbore | FittedHole | PlainHole | CutHole
