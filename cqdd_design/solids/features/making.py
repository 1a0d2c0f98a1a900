"""Features with the sizes that follow from others: how deep to drill, how rough, how true.

Sources of the rules: form and run-out of bearing seats by SKF (table "Tolerances of form and
position": cylindricity and total run-out of a seat IT5/2, run-out of its abutment IT5, where the
seat itself is IT6 on shafts and IT7 in housings), so half of one grade finer than the seat, and
one grade finer for its shoulder. Position of screw holes by the rule of fixed fasteners (ASME
Y14.5, appendix B): half of the clearance in each part. Roughness by the grade: Ra 0.8 um of IT6,
1.6 um of IT7, half of it where ground (SKF, "Surface roughness of bearing seats").
"""

from __future__ import annotations

import math
from typing import Literal

from cqdd_design.catalog.fits import standard_tolerance
from cqdd_design.catalog.threads import Thread, tap_drill, thread_size_of
from cqdd_design.catalog.undercuts import undercut_for
from cqdd_design.errors import CatalogError
from cqdd_design.solids.features.holes import (
    BoltCircle,
    Centre,
    ClearanceHole,
    Facing,
    FittedHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import ON_AXIS, Seat, Shoulder, TrueFace, Undercut

POINT_ANGLE = math.radians(118.0)
"""Of twist drills (DIN 1412)."""
TURNED, FINE, GROUND, GENERAL = 1.6e-6, 0.8e-6, 0.4e-6, 3.2e-6
"""Ra of turned seats, of fine turned ones, of ground ones, and of what is to general limits, m."""
BEARING_FACE = 50e-6
"""Of the heights of faces between which bearings stand, to either side, m: what a lathe holds;
shims make up for the sum."""
SHAFT_RIM = 50e-6
"""By how much a shaft's shoulders may be smaller across, m: bearings stand on little of them."""
RING_FACE = 30e-6
"""The same of the two faces that leave the ring its play: the clamp's over it, and the housing's
under the clamp."""
THREAD_CLASS = "6H"
_RUN_OUT_TURNS = 3.0
"""Drilled beyond the full thread, in pitches: what a tap's lead of 2 to 3 threads leaves (DIN 2197
form C)."""
_POSITION_STEP = 0.01e-3
_SEAL_RUN_OUT = 50e-6
"""Of the cylinders of a gap seal, m."""
BAND_RUN_OUT = 5e-6
"""Of a cylinder for an indicator, turned in one setting with the seat that it tells of, m."""
_FLOOR = 0.3e-3
"""Least material beyond the point of a drill, m."""
_RELIEF_SHARE = 0.34
"""Most of a seat's length that an undercut takes."""


def grade_of(zone: str) -> int:
    """The tolerance grade of a zone: 6 of ``k6``."""
    return int(zone.lstrip("ABCDEFGHJKMNPRSTUVXYZabcdefghjkmnprstuvxyz"))


def seat(
    name: str,
    diameter: float,
    bottom: float,
    top: float,
    zone: str,
    *,
    inside: bool = False,
    ground: bool = False,
    datum: str = "",
    refers: str = "",
    centre: Centre = ON_AXIS,
    position: float = 0.0,
    lead_in: float = 0.0,
) -> Seat:
    """A seat whose form, run-out and roughness follow from the grade of its zone."""
    grade = grade_of(zone)
    form = _to_tenths(0.5 * standard_tolerance(grade - 1, diameter))
    rough = GROUND if ground else FINE if grade < 7 else TURNED
    return Seat(
        name, diameter, bottom, top, inside, zone, rough, ground,
        run_out=form if refers else 0.0,
        cylindricity=form,
        datum=datum, refers=refers, centre=centre, position=position, lead_in=lead_in,
    )  # fmt: skip


def seal_face(
    name: str, diameter: float, bottom: float, top: float, zone: str, *, inside: bool = False
) -> TrueFace:
    """A cylinder of a gap seal: a fifth of the narrowest gap of run-out, form by its zone."""
    return TrueFace(
        name, diameter, bottom, top, inside, zone, TURNED, ground=False,
        run_out=_SEAL_RUN_OUT, cylindricity=0.0, refers="A",
    )  # fmt: skip


def indicator_band(name: str, diameter: float, bottom: float, top: float, zone: str) -> TrueFace:
    """A cylinder outside a part by which an indicator finds the axis of datum A."""
    return TrueFace(
        name, diameter, bottom, top, False, zone, FINE, ground=False,
        run_out=BAND_RUN_OUT, cylindricity=0.0, refers="A",
    )  # fmt: skip


def shoulder(
    name: str,
    height: float,
    inner: float,
    outer: float,
    facing: Facing,
    seat: Seat | None,
    *,
    fillet: float = 0.0,
    datum: str = "",
    refers: str = "A",
    along: float = 0.0,
    rim: float = 0.0,
) -> Shoulder:
    """The face beside a seat, one grade truer than it; as beside H7 where there is none.

    Parameters
    ----------
    along : float
        Tolerance of its height, to either side, m; 0 where the general one holds.
    rim : float
        By how much its diameter may be smaller, m; 0 where the general tolerance holds.
    """
    grade, rough = (7, TURNED) if seat is None else (grade_of(seat.zone), seat.roughness)
    run_out = standard_tolerance(grade - 1, 2.0 * outer)
    return Shoulder(
        name, height, inner, outer, facing, rough, run_out, fillet, datum, refers, along, rim
    )


def metric(thread: Thread) -> str:
    """Designation of a coarse metric thread, such as ``M3``."""
    return f"M{thread.diameter * 1e3:g}"


def relief(
    name: str, seat: Seat, facing: Facing, corner: float, *, length: float
) -> Undercut | None:
    """The undercut that ends a ground seat at its shoulder; None where the seat is too short.

    Parameters
    ----------
    length : float
        Of the seat as far as something sits on it, m.
    facing : {"up", "down"}
        The way the shoulder's face looks.
    corner : float
        Least corner radius of what sits there, m.
    """
    row = undercut_for(seat.diameter, corner, _RELIEF_SHARE * length)
    if row is None:
        return None
    return Undercut(
        name, seat.name, 0.5 * seat.diameter,
        height=seat.bottom if facing == "up" else seat.top,
        facing=facing,
        radius=row.radius, depth=row.depth, width=row.width,
        centre=seat.centre,
    )  # fmt: skip


def tapped(
    name: str,
    thread: Thread,
    designation: str,
    circle: BoltCircle,
    *,
    mouth: float,
    facing: Facing,
    depth: float,
    room: float,
    countersunk: bool = True,
    refers: str = "A",
) -> TappedHole:
    """Tapped holes with their drill: right through where the room ends within the tap's lead.

    Parameters
    ----------
    mouth : float
        Height of the face it opens in, m.
    depth : float
        Of the full thread, m.
    room : float
        From the mouth to where the material ends, m.
    """
    drill = tap_drill(thread)
    deep = depth + _RUN_OUT_TURNS * thread.pitch
    through = deep + point_length(drill) > room - thread.pitch
    return TappedHole(
        name,
        thread.diameter,
        thread.pitch,
        designation,
        THREAD_CLASS,
        drill,
        mouth,
        facing,
        thread_depth=depth,
        drill_depth=room if through else deep,
        through=through,
        countersink=thread.diameter if countersunk else 0.0,
        circle=circle,
        position=screw_position(thread.diameter),
        refers=refers,
    )


def point_length(diameter: float) -> float:
    """Height of the cone that a drill leaves, m."""
    return 0.5 * diameter / math.tan(0.5 * POINT_ANGLE)


def screw_position(thread: float) -> float:
    """Zone of the axes of holes for a screw and its thread, m: half of the clearance for either."""
    try:
        free = thread_size_of(thread).medium - thread
    except CatalogError:
        free = 0.1 * thread
    return math.floor(0.5 * free / _POSITION_STEP + 1e-6) * _POSITION_STEP


def clearance(
    name: str,
    thread: float,
    bottom: float,
    top: float,
    circle: BoltCircle,
    *,
    series: Literal["medium", "fine"] = "medium",
    refers: str = "A",
) -> ClearanceHole:
    """Holes for a screw."""
    row = thread_size_of(thread)
    diameter = row.medium if series == "medium" else row.fine
    at = screw_position(thread)
    return ClearanceHole(name, thread, diameter, series, bottom, top, circle, at, refers)


def fitted(
    name: str,
    diameter: float,
    zone: str,
    circle: BoltCircle,
    *,
    bottom: float,
    top: float,
    facing: Facing,
    position: float,
    through: bool = False,
    room: float = 0.0,
    seam: bool = False,
    refers: str = "A",
) -> FittedHole:
    """Reamed holes; with room beyond their end they keep the point of their drill.

    Parameters
    ----------
    room : float
        Material beyond the end, m.
    """
    pointed = not through and room > point_length(diameter) + _FLOOR
    return FittedHole(
        name, diameter, zone, bottom, top, through, pointed, facing, TURNED, circle, position,
        refers, seam,
    )  # fmt: skip


def _to_tenths(value: float) -> float:
    """Rounded to half a micrometre, m."""
    return max(round(value * 2e6), 1) / 2e6
