"""Features of a part in the words and signs of a drawing."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from cqdd_design.errors import CatalogError
from cqdd_design.exporting.sheets.blocks import Boxed, Cell, DatumMark, Frame, Row, Surface, Words
from cqdd_design.exporting.sheets.lettering import short_number
from cqdd_design.solids.features.holes import (
    BoltCircle,
    ClearanceHole,
    Counterbore,
    FittedHole,
    Hole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import (
    AxialThread,
    Chamfer,
    Groove,
    Joint,
    Seat,
    Shoulder,
    Undercut,
    datum_cells,
)

if TYPE_CHECKING:
    from cqdd_design.catalog.fits import FitLimits

_MM, _UM = 1e3, 1e6
DIA, BY = "\u00d8", "\u00d7"
COMBINED, SIMULTANEOUS = "CZ", "SIM1"
"""Mark zones that keep their places among each other (ISO 5458): those of one frame, and those of
all frames so marked. Without them every zone may turn about the datum axis by itself.
"""
FREE_DECIMALS = 2
"""Of millimetres, of sizes under general tolerances: what is left out is 5 um at most."""


def mm(value: float) -> str:
    """A length in mm, to a tenth of a micrometre.

    Examples
    --------
    >>> mm(0.0275), mm(4.0e-3)
    ('27.5', '4')
    """
    return short_number(_MM * value, 4)


def free_mm(value: float) -> str:
    """A length in mm that has no limits of its own, to a tenth of the closest general ones (0.1).

    Examples
    --------
    >>> free_mm(118.98889e-3), free_mm(0.1e-3)
    ('118.99', '0.1')
    """
    return short_number(_MM * value, FREE_DECIMALS)


def degrees(angle: float) -> str:
    """An angle from 0 up to 360 degrees, from radians.

    Examples
    --------
    >>> degrees(math.pi / 3), degrees(-math.pi / 2)
    ('60\u00b0', '270\u00b0')
    """
    value = round(math.degrees(angle), 4) % 360.0
    return f"{short_number(value, 4)}\u00b0"


def roughness(value: float) -> str:
    """Ra in micrometres.

    Examples
    --------
    >>> roughness(0.8e-6)
    'Ra 0.8'
    """
    return f"Ra {short_number(_UM * value, 3)}"


def fit_text(diameter: float, zone: str, limits: FitLimits | None) -> str:
    """A diameter with its zone and limits; without them where the table of the zone ends."""
    said = f"{DIA}{mm(diameter)} {zone}"
    if limits is None:
        return said
    return f"{said} ({_deviation(limits.upper)}/{_deviation(limits.lower)})"


def _deviation(value: float) -> str:
    text = f"{_MM * value:+.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("+0", "-0") else text


def limits_of(feature: Seat | FittedHole) -> FitLimits | None:
    """Deviations of a feature, where its zone is tabulated."""
    try:
        return feature.limits
    except CatalogError:
        return None


def seat_text(seat: Seat) -> str:
    """Such as ``Ø15 k6 (+0.012/+0.001)``."""
    return fit_text(seat.diameter, seat.zone, limits_of(seat))


def seat_rows(seat: Seat, *, together: bool = False) -> tuple[Row, ...]:
    """Surface and tolerances of form and run-out; `together`: with other positions of the part."""
    sign: Row = (Surface(roughness(seat.roughness) + (" ground" if seat.ground else "")),)
    cells: list[Cell] = []
    if seat.cylindricity:
        cells.append(Frame("cylindricity", mm(seat.cylindricity)))
    if seat.position:
        cells += _position(seat.position, 1, seat.refers, together=together)
    elif seat.run_out and seat.refers:
        cells.append(Frame("total run-out", mm(seat.run_out), datum_cells(seat.refers)))
    return (sign, tuple(cells)) if len(cells) > 1 else ((*sign, *cells),)


def _position(zone: float, count: int, refers: str, *, together: bool) -> list[Cell]:
    """Frame of the places of so many axes, which are one pattern."""
    words = f"{DIA}{mm(zone)}" + (f" {COMBINED}" if count > 1 else "")
    cells: list[Cell] = [Frame("position", words, datum_cells(refers))]
    return [*cells, Words(SIMULTANEOUS)] if together else cells


def thread_text(thread: AxialThread) -> str:
    """Such as ``M24 x 1.5 - 6g``."""
    return f"{thread.designation.replace(' x ', f' {BY} ')}-{thread.tolerance}"


def shoulder_rows(shoulder: Shoulder) -> tuple[Row, ...]:
    """Surface, run-out, the fillet beside it and the datum that the face sets up."""
    cells: list[Cell] = [Surface(roughness(shoulder.roughness))]
    if shoulder.run_out and shoulder.refers:
        cells.append(Frame("run-out", mm(shoulder.run_out), datum_cells(shoulder.refers)))
    if shoulder.datum:
        cells.append(DatumMark(shoulder.datum))
    if shoulder.fillet:
        cells.append(Words(f"R{mm(shoulder.fillet)} max"))
    return (tuple(cells),)


def chamfer_text(count: int, chamfer: Chamfer) -> str:
    """Such as ``4 x 0.3 x 45°``."""
    size = f"{mm(chamfer.width)} {BY} {degrees(chamfer.angle)}"
    return f"{count} {BY} {size}" if count > 1 else size


def undercut_text(count: int, undercut: Undercut) -> str:
    """Such as ``2 x DIN 509 - E 0.6 x 0.3``."""
    said = undercut.designation.replace(" x ", f" {BY} ")
    return f"{count} {BY} {said}" if count > 1 else said


def groove_text(groove: Groove) -> str:
    """Such as ``DIN 76-B: Ø48.3 x 1.9, R0.4``."""
    size = f"{DIA}{mm(groove.diameter)} {BY} {mm(groove.top - groove.bottom)}"
    return f"{groove.standard}: {size}, R{mm(groove.fillet)}"


def hole_rows(hole: Hole, *, together: bool = False, below: bool = False) -> tuple[Row, ...]:
    """What a hole is, with its position.

    `together`: with other positions of the part; `below`: from the floor of another hole.
    """
    count = hole.circle.count
    lead = f"{count} {BY} " if count > 1 else ""
    rows: list[Row] = []
    if isinstance(hole, TappedHole):
        drill = f"{DIA}{mm(hole.drill)}"
        thread = f"{lead}{hole.designation}-{hole.tolerance}"
        if hole.through:
            said = f"{thread}, {drill} through"
        else:
            depth, drilled = free_mm(hole.thread_depth), free_mm(hole.drill_depth)
            said = f"{thread} {BY} {depth}/{drill} {BY} {drilled}"
            said += " from the floor" if below else ""
        rows.append((Words(said),))
        if hole.countersink:
            rows.append((Words(f"countersunk {DIA}{mm(hole.countersink)} {BY} 90\u00b0"),))
    elif isinstance(hole, ClearanceHole):
        said = f"{lead}{DIA}{mm(hole.diameter)} for M{mm(hole.thread)}, ISO 273 {hole.series}"
        rows.append((Words(said),))
    elif isinstance(hole, Counterbore):
        size = f"{DIA}{mm(hole.diameter)} {BY} {free_mm(hole.depth)}"
        rows.append((Words(f"{lead}counterbore {size}"),))
    elif isinstance(hole, FittedHole):
        size = fit_text(hole.diameter, hole.zone, limits_of(hole))
        deep = "through" if hole.through else f"{BY} {free_mm(hole.top - hole.bottom)} deep"
        rows.append((Words(f"{lead}{size} {deep}"),))
        if hole.seam:
            rows.append((Words("half grooves; its mate has the others"),))
    else:
        rows.append((Words(f"{lead}{DIA}{free_mm(hole.diameter)}"),))
    frame: list[Cell] = []
    if not isinstance(hole, PlainHole | Counterbore) and hole.position:
        frame += _position(hole.position, count, hole.refers, together=together)
    if isinstance(hole, FittedHole):
        frame.append(Surface(roughness(hole.roughness)))
    if frame:
        rows.append(tuple(frame))
    return tuple(rows)


def circle_row(circle: BoltCircle) -> Row:
    """Where the holes of a circle stand, in boxes: exact by theory."""
    cells: list[Cell] = [Words("on"), Boxed(f"{DIA}{mm(2.0 * circle.radius)}")]
    if not evenly(circle):
        return (*cells, Words("at X and Y of the table"))
    return (*cells, *round_row(circle.angles[0], circle.count))


def round_row(first: float, count: int) -> Row:
    """In which directions (rad) things stand that are evenly spaced round the axis, in boxes."""
    if count == 1:
        return (Words("at"), Boxed(degrees(first)))
    every = Boxed(degrees(2.0 * math.pi / count))
    return (Words("from"), Boxed(degrees(first)), Words("every"), every)


def evenly(circle: BoltCircle) -> bool:
    """Whether the holes of a circle are evenly spaced round it."""
    step = 2.0 * math.pi / circle.count
    return all(
        abs(math.remainder(angle - circle.angles[0] - step * i, 2.0 * math.pi)) < 1e-9
        for i, angle in enumerate(circle.angles)
    )


def joint_note(joint: Joint) -> str:
    """A note on what is held here, and how."""
    return f"{joint.to.capitalize()} {joint.kind} at the {joint.seat}: {joint.how}."


def grouped(features: Iterable[Chamfer]) -> list[tuple[int, Chamfer]]:
    """Edges that are broken alike, as one with their number."""
    groups: dict[tuple[float, float], list[Chamfer]] = {}
    for one in features:
        groups.setdefault((round(one.width, 9), round(one.angle, 9)), []).append(one)
    return [(sum(len(c.centres) for c in alike), alike[0]) for alike in groups.values()]


def undercut_groups(features: Iterable[Undercut]) -> list[tuple[int, Undercut]]:
    """Undercuts that are alike, as one with their number."""
    groups: dict[str, list[Undercut]] = {}
    for one in features:
        groups.setdefault(one.designation, []).append(one)
    return [(len(alike), alike[0]) for alike in groups.values()]


def holes_by_circle(holes: Sequence[Hole]) -> list[list[Hole]]:
    """Holes that share a circle, in the order of the features."""
    groups: dict[tuple[object, ...], list[Hole]] = {}
    for hole in holes:
        circle = hole.circle
        key = (round(circle.radius, 9), tuple(round(a, 9) for a in circle.angles))
        groups.setdefault(key, []).append(hole)
    return list(groups.values())
