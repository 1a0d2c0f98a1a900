"""The kinds of features of a part, each with the facts that make it.

A part is a turned or cut body and a list of features. Solid, mass, drawing, bill of materials,
assembly rules and checks read that one list: what a feature takes away from the body (holes,
chamfers, undercuts, the points of drills) is derived from it and stands nowhere else.

Lengths are in metres, angles in radians, in the part's own frame with the part's axis along z.
`facing` says which way a face looks, or from which side a hole is made: ``up`` is +z. Letters of
datums are those of the part's drawing: `datum` is the letter that a feature sets up, `refers` the
letters it is held to, in their order, such as ``AB``, or ``A-B`` of a datum that two features set
up together (ISO 5459), as the axis of two journals. Features are named as on a drawing, and no two
of a part share a name.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from cqdd_design.catalog.fits import FitLimits, fit_limits
from cqdd_design.solids.features.holes import Centre, Facing, FittedHole, Hole

ON_AXIS: Centre = (0.0, 0.0)


def datum_cells(refers: str) -> tuple[str, ...]:
    """Cells of a tolerance frame that name datums, a common one in one cell (ISO 1101, ISO 5459).

    Examples
    --------
    >>> datum_cells("AB"), datum_cells("A-BC"), datum_cells("")
    (('A', 'B'), ('A-B', 'C'), ())
    """
    return tuple(re.findall("[A-Z](?:-[A-Z])*", refers))


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
    position : float
        Diameter of the zone of an axis that stands off the part's, m; 0 of others, which run true.
    lead_in : float
        Widest chamfer of its ends, m; 0 where its diameter says how wide they are.
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
    position: float = 0.0
    lead_in: float = 0.0

    @property
    def limits(self) -> FitLimits:
        """Deviations from nominal; a `CatalogError` where the zone's table ends."""
        return fit_limits(self.zone, self.diameter)


@dataclass(frozen=True)
class TrueFace(Seat):
    """A cylinder on which nothing sits: it only runs true, in a gap seal or under an indicator."""


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
    along : float
        Of its height, to either side, m; 0 where the general tolerance holds.
    rim : float
        By how much its diameter may be smaller, and not larger, m; 0 where a seat of the same
        diameter or the general tolerance says it.
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
    along: float = 0.0
    rim: float = 0.0


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
    """The relief that ends a ground cylinder at its shoulder, so that the wheel clears it.

    Form E of DIN 509, which relieves the cylinder alone: the shoulders of small bearings are too
    low to lose the face that form F takes. Sizes in `undercuts.csv`.

    Attributes
    ----------
    seat : str
        Name of the seat that it ends.
    cylinder : float
        Radius of the seat, m.
    height : float
        Of the shoulder's face, m.
    facing : {"up", "down"}
        The way that face looks: the seat lies on that side.
    radius : float
        Of its fillets, r, m.
    depth : float
        Below the cylinder, t1, m.
    width : float
        Along the cylinder, f, m.
    centre : (float, float)
        Of the seat's axis.
    """

    name: str
    seat: str
    cylinder: float
    height: float
    facing: Facing
    radius: float
    depth: float
    width: float
    centre: Centre = ON_AXIS

    @property
    def designation(self) -> str:
        """As on a drawing: ``DIN 509 - E 0.6 x 0.3``."""
        return f"DIN 509 - E {self.radius * 1e3:g} x {self.depth * 1e3:g}"


@dataclass(frozen=True)
class CutProfile:
    """An outline cut by wire, which the layers have.

    Attributes
    ----------
    bottom, top : float
        m.
    zone : float
        Width of the zone that it lies in, m.
    refers : str
        Letters of its datums; see the module.
    inside : bool
        Whether it is that of an opening.
    """

    name: str
    bottom: float
    top: float
    zone: float
    refers: str = "A"
    inside: bool = False


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
    datum : str
        Letter that its axis sets up; see the module.
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
    datum: str = ""


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


Feature: TypeAlias = (
    Seat | Shoulder | Chamfer | Undercut | Hole | CutProfile | AxialThread | Groove | Joint
)


def fit_label(one: Seat | FittedHole) -> str:
    """As on a drawing: ``bore for the cam bearing 28 N7``."""
    return f"{one.name} {one.diameter * 1e3:.6g} {one.zone}"
