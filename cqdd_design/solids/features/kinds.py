"""The kinds of features of a part, each with the facts that make it.

A part is a turned or cut body and a list of features. Solid, mass, drawing, bill of materials,
assembly rules and checks read that one list: what a feature takes away from the body (holes,
chamfers, undercuts, the points of drills) is derived from it and stands nowhere else.

Lengths are in metres, angles in radians, in the part's own frame with the part's axis along z.
`facing` says which way a face looks, or from which side a hole is made: ``up`` is +z. Letters of
datums are those of the part's drawing: `datum` is the letter that a feature sets up, `refers` the
letters it is held to, in their order, such as ``AB``. Features are named as on a drawing, and no
two of a part share a name.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

from cqdd_design.catalog.fits import FitLimits, fit_limits

Facing = Literal["up", "down"]
Centre: TypeAlias = tuple[float, float]
ON_AXIS: Centre = (0.0, 0.0)


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
class Seat:
    """A cylinder on which another part sits.

    Attributes
    ----------
    diameter : float
        Nominal, m.
    bottom, top : float
        Heights between which it runs, m.
    inside : bool
        Whether it is a bore.
    zone : str
        ISO 286, such as ``k6``.
    roughness : float
        Ra, m.
    ground : bool
        Whether it is ground after turning.
    run_out : float
        Total run-out to the datums it refers to, m; 0 of a seat that is a datum itself.
    cylindricity : float
        m.
    datum, refers : str
        Letters; see the module.
    centre : (float, float)
        Of its axis; lobes of an eccentric shaft stand off the part's.
    """

    name: str
    diameter: float
    bottom: float
    top: float
    inside: bool
    zone: str
    roughness: float
    ground: bool
    run_out: float
    cylindricity: float
    datum: str = ""
    refers: str = ""
    centre: Centre = ON_AXIS

    @property
    def limits(self) -> FitLimits:
        """Deviations from nominal; a `CatalogError` where the zone's table ends."""
        return fit_limits(self.zone, self.diameter)


@dataclass(frozen=True)
class Shoulder:
    """A flat ring face against which another part sits.

    Attributes
    ----------
    height : float
        m.
    inner, outer : float
        Radii of the face, edges and undercuts not taken off, m.
    facing : {"up", "down"}
    roughness : float
        Ra, m.
    run_out : float
        Axial run-out to the datums it refers to, m.
    fillet : float
        Largest radius that is allowed in the corner with its seat, m; 0 where an undercut ends it.
    datum, refers : str
        Letters; see the module.
    """

    name: str
    height: float
    inner: float
    outer: float
    facing: Facing
    roughness: float
    run_out: float
    fillet: float = 0.0
    datum: str = ""
    refers: str = ""


@dataclass(frozen=True)
class Chamfer:
    """A broken edge, turned: the same all round.

    Attributes
    ----------
    radius, height : float
        Of the edge before it is broken, m.
    inside : bool
        Whether it is the edge of a bore, whose material is outside `radius`.
    facing : {"up", "down"}
        The way the face beside it looks.
    width : float
        Along the axis, m.
    angle : float
        Between its cone and the axis, rad.
    centres : tuple of (float, float)
        Axes of the edges; one on the part's axis, or one for every hole of a pattern.
    """

    name: str
    radius: float
    height: float
    inside: bool
    facing: Facing
    width: float
    angle: float = math.pi / 4.0
    centres: tuple[Centre, ...] = (ON_AXIS,)

    @property
    def depth(self) -> float:
        """Across the axis, m."""
        return self.width * math.tan(self.angle)


@dataclass(frozen=True)
class Undercut:
    """The relief beside a ground cylinder, so that the wheel clears and a sharp corner sits.

    DIN 509: form E relieves the cylinder alone, form F its shoulder too. Sizes in `undercuts.csv`.

    Attributes
    ----------
    form : {"E", "F"}
    seat : str
        Name of the seat that it ends.
    cylinder : float
        Radius of the seat, m.
    height : float
        Of the shoulder's face, m.
    facing : {"up", "down"}
        The way that face looks: the seat lies on that side.
    inside : bool
        Whether the seat is a bore.
    radius : float
        Of its fillets, r, m.
    depth : float
        Below the cylinder, t1, m.
    width : float
        Along the cylinder, f, m.
    face_depth : float
        Into the shoulder, t2, m; 0 of form E.
    centre : (float, float)
        Of the seat's axis.
    """

    name: str
    form: Literal["E", "F"]
    seat: str
    cylinder: float
    height: float
    facing: Facing
    inside: bool
    radius: float
    depth: float
    width: float
    face_depth: float
    centre: Centre = ON_AXIS

    @property
    def designation(self) -> str:
        """As on a drawing: ``DIN 509 - F 0.6 x 0.3``."""
        return f"DIN 509 - {self.form} {self.radius * 1e3:g} x {self.depth * 1e3:g}"


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
    """Flat recesses for the heads of screws (DIN 974-1).

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
    roughness : float
        Ra, m.
    circle, position, refers
        As of `TappedHole`.
    """

    name: str
    diameter: float
    zone: str
    bottom: float
    top: float
    through: bool
    facing: Facing
    roughness: float
    circle: BoltCircle
    position: float
    refers: str = "A"

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
class AxialThread:
    """A thread about the part's own axis, outside or inside.

    Attributes
    ----------
    thread, pitch : float
        Nominal diameter and pitch, m.
    designation : str
        Such as ``M24 x 1.5``.
    tolerance : str
        Class, ``6g`` outside and ``6H`` inside.
    inside : bool
        Whether it is a nut's.
    bottom, top : float
        Between which the thread is full, m.
    core : float
        Diameter of the turned or bored blank: the nominal one outside, D_1 inside, m.
    """

    name: str
    thread: float
    pitch: float
    designation: str
    tolerance: str
    inside: bool
    bottom: float
    top: float
    core: float


@dataclass(frozen=True)
class Groove:
    """A turned groove with square walls, such as the run-out of a thread (DIN 76-1).

    Attributes
    ----------
    standard : str
        Such as ``DIN 76-B``.
    diameter : float
        At its floor, m.
    bottom, top : float
        m.
    cylinder : float
        Radius of the cylinder it is cut in, m.
    inside : bool
        Whether that is a bore.
    fillet : float
        Radius in its corners, m.
    """

    name: str
    standard: str
    diameter: float
    bottom: float
    top: float
    cylinder: float
    inside: bool
    fillet: float


@dataclass(frozen=True)
class Joint:
    """How another part is held on this one.

    Attributes
    ----------
    kind : {"pressed", "bonded", "clamped", "screwed", "keyed"}
    seat : str
        Name of the feature of this part at which it is held.
    to : str
        Name of the other part.
    how : str
        In words, such as ``retaining compound on the stub``.
    """

    name: str
    kind: Literal["pressed", "bonded", "clamped", "screwed", "keyed"]
    seat: str
    to: str
    how: str


Hole: TypeAlias = TappedHole | ClearanceHole | Counterbore | FittedHole | PlainHole
Feature: TypeAlias = Seat | Shoulder | Chamfer | Undercut | Hole | AxialThread | Groove | Joint
