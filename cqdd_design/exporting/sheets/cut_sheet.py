"""The cut sheet: one page a part, from which a shop can quote and cut; A3 for up to 30 cuts.

::

    +----------------------------------------------+
    |   front view            section A-A   notes  |
    |   with callouts         with sizes           |
    |   cuts and start holes                       |
    |                          +-- title block ----|
    +--------------------------+-------------------+
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.exporting.edm.cut_facts import (
    FACE_FINISH,
    GROUND_FLATNESS,
    GROUND_PARALLELISM,
    CutFacts,
    zone_text,
)
from cqdd_design.exporting.edm.flat_parts import reach_of
from cqdd_design.exporting.edm.wire_path import segmented
from cqdd_design.exporting.sheets.behind import edges_behind
from cqdd_design.exporting.sheets.blocks import Row, Words
from cqdd_design.exporting.sheets.canvas import Canvas, render
from cqdd_design.exporting.sheets.drawing import AXIS, OUTLINE, SMALL, TEXT, SheetDrawing, new_sheet
from cqdd_design.exporting.sheets.frame import draw_frame, paper_for
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.sizes import clear_stem
from cqdd_design.exporting.sheets.title_block import SCALES
from cqdd_design.exporting.sheets.wording import COMBINED, SIMULTANEOUS, circle_row
from cqdd_design.geometry.contours import Circle, as_complex
from cqdd_design.solids.features.holes import BoltCircle

if TYPE_CHECKING:
    from cqdd_design.exporting.edm.seats import Seat

FRONT = complex(122.0, 174.0)
"""Centre of the front view, mm of paper."""
SECTION = complex(246.0, 174.0)
"""Centre of the section."""
MOST_REACH, MOST_THICKNESS = 72.5, 34.0

_MM = 1e3
_APART = 0.7
"""Edges behind a cut that are nearer to another than two wide lines are drawn once, mm of paper."""
_WITHIN = 0.75
"""Share of the way to the wall of a ring up to which a note within begins."""


def draw_sheet(facts: CutFacts) -> Canvas:
    """Draw the sheet of a part and render it."""
    return render(draw_cut_sheet(facts))


def draw_cut_sheet(facts: CutFacts) -> SheetDrawing:
    """Draw the sheet of a part."""
    sheet = new_sheet(sheet_scale(facts), paper_for(facts))
    _front_view(sheet, facts)
    _section(sheet, facts)
    draw_frame(sheet, facts)
    return sheet


def sheet_scale(facts: CutFacts) -> float:
    """Largest standard scale at which the views have room."""
    reach = _MM * reach_of(facts.flat.shape.outer)
    thickness = _MM * facts.flat.thickness
    for scale in SCALES:
        if scale * reach <= MOST_REACH and scale * thickness <= MOST_THICKNESS:
            return scale
    return SCALES[-1]


def _front_view(sheet: SheetDrawing, facts: CutFacts) -> None:
    flat, factor = facts.flat, _MM * sheet.scale
    reach = factor * reach_of(flat.shape.outer)
    for contour in flat.contours:
        sheet.contour(contour, FRONT)
    arm = reach + 5.0
    sheet.line(FRONT - arm, FRONT + arm, AXIS)
    sheet.line(FRONT - 1j * arm, FRONT + 1j * arm, AXIS)
    sheet.text(FRONT + complex(reach + 2.4, 0.8), "X", SMALL)
    sheet.text(FRONT + complex(0.8, reach + 1.4), "Y", SMALL)
    sheet.circle(FRONT, factor * flat.reference_radius, AXIS)
    # The section lies right of the view with +X up and the lower face left: seen from +Y.
    for side in (-1.0, 1.0):
        begin = FRONT + side * (arm + 9.5)
        end = begin + side * 5.0
        sheet.line(begin, end, OUTLINE)
        sheet.line(end, end - 5.0j)
        sheet.triangle(end - 5.0j, -1j)
        sheet.text(end - 1.2 + 1.5j, "A", 3.5)
    rounds = _output_holes(facts)
    if rounds:
        _holes(sheet, facts, rounds)
        if flat.turned_over:
            _mark(sheet, facts, rounds)
    _profile_callout(sheet, facts)
    _concave_radius(sheet, facts, reach)


def _output_holes(facts: CutFacts) -> list[Circle]:
    """Round holes away from the axis: output holes, then those for columns."""
    holes = [hole for hole in facts.flat.shape.holes if isinstance(hole, Circle)]
    return [hole for hole in holes if abs(complex(*hole.centre)) > hole.radius]


def _holes(sheet: SheetDrawing, facts: CutFacts, holes: list[Circle]) -> None:
    """Centre marks, size and position of the holes, and where they stand, in boxes."""
    factor, zones = _MM * sheet.scale, facts.zones
    for hole in holes:
        centre, arm = FRONT + factor * complex(*hole.centre), factor * hole.radius + 1.5
        along = cmath.exp(1j * cmath.phase(complex(*hole.centre)))
        sheet.line(centre - arm * along, centre + arm * along, AXIS)
    output, columns = _by_use(facts, holes)
    # As high as the frame lets them: the lower row passes over a disc that fills the view.
    left = complex(FRONT.real - 98.0, FRONT.imag + MOST_REACH + 32.0)
    for alike, toward, corner in ((output, 125.0, left), (columns, 160.0, left - 24.0j)):
        if not alike:
            continue
        places = np.angle(as_complex([hole.centre for hole in alike]))
        named = int(np.abs(np.angle(np.exp(1j * (places - math.radians(toward))))).argmin())
        hole = alike[named]
        words = f"{2.0 * _MM * hole.radius:.4g} \u00b1{zone_text(zones.hole_diameter)}"
        words = f"{len(alike)} \u00d7 \u00d8{words}"
        angles = tuple(places.tolist())
        row = circle_row(BoltCircle("holes", facts.flat.reference_radius, angles))
        # The shelf is as long as what stands under it, so that the leader runs past that.
        under = sum(cell.size[0] + 1.6 for cell in row)
        elbow = corner + max(text_width(words, TEXT) + 3.0, 46.0, under)
        centre = FRONT + factor * complex(*hole.centre)
        target = centre + factor * hole.radius * (elbow - centre) / abs(elbow - centre)
        sheet.callout(target, elbow, words, (corner - elbow).real)
        zone = f"\u00d8{zone_text(zones.hole_position)} {COMBINED}"
        _simultaneous(sheet, corner - 7.0j, "position", zone)
        _row(sheet, corner - 12.0j, row)


def _row(sheet: SheetDrawing, corner: complex, cells: Row) -> None:
    """Draw cells beside each other."""
    for cell in cells:
        cell.draw(sheet, corner)
        corner += cell.size[0] + 1.6


def _by_use(facts: CutFacts, holes: list[Circle]) -> tuple[list[Circle], list[Circle]]:
    """Output holes and those for columns, which follow them."""
    count = facts.design.reducer.output_pins.count
    return holes[:count], holes[count:]


def _mark(sheet: SheetDrawing, facts: CutFacts, holes: list[Circle]) -> None:
    """Say where the upper face is marked: between two holes, in the lower left."""
    output, columns = _by_use(facts, holes)
    angles = np.angle(as_complex([hole.centre for hole in output]))
    gap = math.pi / len(angles)
    if columns:
        # In the middle of the web between an output hole and the place of a column's.
        wider = output[0].radius - columns[0].radius
        gap = 0.5 * (gap + wider / facts.flat.reference_radius)
    between = angles + gap
    off = np.abs(np.angle(np.exp(1j * (between + math.radians(135.0)))))
    spot = FRONT + cmath.rect(
        _MM * sheet.scale * facts.flat.reference_radius, float(between[off.argmin()])
    )
    sheet.circle(spot, 1.0, OUTLINE)
    elbow = complex(FRONT.real - 58.0, FRONT.imag - MOST_REACH - 8.0)
    target = spot + (elbow - spot) / abs(elbow - spot)
    sheet.callout(target, elbow, "mark upper face", -28.0)


def _profile_callout(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Tolerance of the fitted contour, all round, and the squareness of its walls."""
    points = as_complex(facts.flat.fitted.sample(1e-4)) * _MM * sheet.scale
    elbow = complex(FRONT.real + 38.0, FRONT.imag + MOST_REACH + 20.0)
    # What stands under the shelf begins at the elbow: the leader runs down on its other side.
    points = points[points.real < (elbow - FRONT).real - 1.0]
    spot = points[np.abs(np.angle(points * np.exp(-1j * math.radians(52.0)))).argmin()]
    words, zones = "exact curve, all round", facts.zones
    sheet.callout(FRONT + complex(spot), elbow, words, text_width(words, TEXT) + 3.0)
    sheet.circle(elbow, 1.2)
    frame = elbow - 7.0j
    zone = f"{zone_text(zones.profile)} {COMBINED}"
    if _output_holes(facts):
        wide = _simultaneous(sheet, frame, "profile of a line", zone)
    else:
        wide = sheet.tolerance(frame, "profile of a line", zone, ["A"])
    if not _output_holes(facts):
        teeth = facts.design.reducer.ring_tooth_count
        angles = tuple(2.0 * math.pi * i / teeth for i in range(teeth))
        on = BoltCircle("teeth", facts.flat.reference_radius, angles)
        _row(sheet, frame - 5.0j, (Words("teeth"), *circle_row(on)))
    sheet.tolerance(frame + wide + 2.0, "perpendicularity", zone_text(facts.squareness), ["B"])


def _simultaneous(sheet: SheetDrawing, corner: complex, symbol: str, zone: str) -> float:
    """Draw a frame of the one pattern that contour and holes are (ISO 5458); its width."""
    wide = sheet.tolerance(corner, symbol, zone, ["A"])
    return wide + 1.2 + sheet.text(corner + wide + 1.2 + 1.5j, SIMULTANEOUS, TEXT)


def _concave_radius(sheet: SheetDrawing, facts: CutFacts, reach: float) -> None:
    """Dimension the tightest arc that the wire must follow, in the lower right of the view.

    Of a ring's pockets, which are seats of its pins, it is their diameter with its zone.
    It is read from the side of its centre, where nothing else stands: past the lobes of a disc,
    within the opening of a ring; from outside where that is too narrow.
    """
    outer = facts.flat.fitted is facts.flat.shape.outer
    contour = segmented(facts.flat.fitted)
    arcs = contour.arcs()
    concave = (contour.bulges < 0.0) == outer
    concave &= contour.bulges != 0.0
    if not concave.any():
        return
    middle = as_complex(contour.evaluate(np.array([0.5]))[0][:, 0])
    tightest = concave & (arcs.radii <= arcs.radii[concave].min() * (1.0 + 1e-6))
    off = np.abs(np.angle(middle * np.exp(1j * math.radians(50.0))))
    chosen = int(np.where(tightest, off, np.inf).argmin())
    wall = _MM * sheet.scale * complex(middle[chosen])
    words, pockets = f"R{_MM * float(arcs.radii[chosen]):.4g}", facts.pockets
    if pockets is not None:
        size = f"\u00d8{_MM * pockets.diameter:.6g} {pockets.limits.zone}"
        words = f"{facts.design.reducer.ring_tooth_count} \u00d7 {size}"
    width = text_width(words, TEXT) + 3.0
    # Within a ring it stands clear of the upright axis, and of the teeth.
    share = max(0.35, (width + 2.0) / wall.real)
    outside = outer or share > _WITHIN
    elbow = wall * ((reach + 9.0) / abs(wall) if outside else share)
    sheet.callout(FRONT + wall, FRONT + elbow, words, width if outside else -width)


def _section(sheet: SheetDrawing, facts: CutFacts) -> None:
    """Cut through the horizontal axis, turned upright: thickness, bores and outside."""
    flat, factor = facts.flat, _MM * sheet.scale
    wide = factor * flat.thickness
    left = SECTION - 0.5 * wide
    walls = _crossings(facts)
    for one, two in zip(walls[::2], walls[1::2], strict=True):
        corner, height = left + 1j * factor * one, factor * (two - one)
        sheet.hatch(corner, wide, height)
        sheet.box(corner, wide, height, OUTLINE)
    for one, two in zip(walls[1:-1:2], walls[2:-1:2], strict=True):
        for x in (0.0, wide):
            sheet.line(left + x + 1j * factor * one, left + x + 1j * factor * two, OUTLINE)
    high = _edges_behind(sheet, facts, left, walls)
    sheet.line(left - 4.0, left + wide + 4.0, AXIS)
    title = "A-A"
    sheet.text(SECTION - 0.5 * text_width(title, 3.5) + 1j * (MOST_REACH + 24.0), title, 3.5)
    words = f"<> {facts.thickness_text}"
    # Above the extension line of the largest diameter, which a lobe has that stands above the cut.
    above = max(high + 8.0, factor * reach_of(flat.shape.outer) + 3.0)
    sheet.linear(left + 1j * above, left + 1j * high, left + wide + 1j * high, 0.0, words)
    _diameters(sheet, facts, left, wide)
    datum = left + 0.5j * factor * (walls[-1] + walls[-2])
    _faces(sheet, left, datum, ground=not facts.moulded)


def _edges_behind(sheet: SheetDrawing, facts: CutFacts, left: complex, walls: list[float]) -> float:
    """Edges seen behind the cut, and the faces out to them; how high they reach, mm of paper."""
    factor, wide = _MM * sheet.scale, _MM * sheet.scale * facts.flat.thickness
    drawn = [factor * one for one in walls]
    lowest, highest = drawn[0], drawn[-1]
    for edge in (factor * one for one in edges_behind(facts.flat.contours)):
        if min(abs(edge - one) for one in drawn) < _APART:
            continue
        drawn.append(edge)
        sheet.line(left + 1j * edge, left + wide + 1j * edge, OUTLINE)
    for end, reach in ((lowest, min(drawn)), (highest, max(drawn))):
        if reach != end:
            for x in (0.0, wide):
                sheet.line(left + x + 1j * end, left + x + 1j * reach, OUTLINE)
    return max(drawn)


def _crossings(facts: CutFacts) -> list[float]:
    """Ascending places where the walls of the part cross the horizontal axis, m."""
    found: list[float] = []
    for contour in facts.flat.contours:
        if isinstance(contour, Circle):
            x, y = contour.centre
            if abs(y) < contour.radius:
                half = math.sqrt(contour.radius**2 - y * y)
                found += [float(x - half), float(x + half)]
            continue
        points = as_complex(contour.sample(1e-7))
        ahead = np.roll(points, -1)
        crossing = (points.imag >= 0.0) != (ahead.imag >= 0.0)
        one, two = points[crossing], ahead[crossing]
        found += (one.real - one.imag * (two - one).real / (two - one).imag).tolist()
    return sorted(found)


def _diameters(sheet: SheetDrawing, facts: CutFacts, left: complex, wide: float) -> None:
    """Diameters beside the section, the smallest nearest.

    One whose words are longer than itself stands alone on the other side, where no line of a larger
    one runs through them.
    """
    factor, seats = _MM * sheet.scale, facts.seat_by_contour
    rows: list[tuple[float, str]] = []
    for number, contour in enumerate(facts.flat.contours):
        if isinstance(contour, Circle):
            if abs(complex(*contour.centre)) < contour.radius:
                rows.append((2.0 * contour.radius, _seat_words(seats.get(number))))
            continue
        radii = np.abs(as_complex(contour.sample(1e-7)))
        if contour is not facts.flat.fitted:
            rows.append((2.0 * float(radii.max()), _seat_words(seats.get(number))))
            continue
        rows += [(2.0 * float(radii.min()), "(%%c<>)"), (2.0 * float(radii.max()), "(%%c<>)")]
    right, place = left + wide, 0
    rows.sort()
    for number, (diameter, words) in enumerate(rows):
        half = 0.5 * factor * diameter
        said = text_width(words.replace("%%c<>", f"\u00d8{_MM * diameter:.6g}"), TEXT)
        if said > 2.0 * half and number == 0:
            edge, base = left, left - 9.0
        else:
            edge, base = right, right + 9.0 + 8.0 * place
            place += 1
        sheet.linear(base, edge - 1j * half, edge + 1j * half, 90.0, words)
        if (number == 0 and "N7" in words) or (
            facts.flat.label == "ring" and diameter == rows[-1][0]
        ):
            # The letter's box stands below the words too, and clear of the lines of larger ones.
            low = -max(half + 2.0, 0.5 * said - 3.5)
            passing = [-0.5 * factor * larger for larger, _ in rows[number + 1 :]]
            stem = clear_stem(low, passing if edge is right else [])
            sheet.datum(base + 1j * low, -1j, "A", stem)


def _seat_words(seat: Seat | None) -> str:
    if seat is None:
        return "%%c<>"
    limits = seat.limits
    return f"%%c<> {limits.zone} ({_MM * limits.upper:+.3f}/{_MM * limits.lower:+.3f})"


def _faces(sheet: SheetDrawing, left: complex, face: complex, *, ground: bool) -> None:
    """Datum B on the lower face; flatness, parallelism and finish of the faces, if ground."""
    sheet.datum(face, -1.0 + 0j, "B")
    if not ground:
        return
    corner = complex(left.real - 14.0, SECTION.imag - MOST_REACH - 18.0)
    sheet.text(corner + 7.4j, "both faces ground", SMALL)
    across = sheet.tolerance(corner, "flatness", zone_text(GROUND_FLATNESS), [])
    sheet.tolerance(corner + across + 2.0, "parallelism", zone_text(GROUND_PARALLELISM), ["B"])
    sheet.finish(corner + 46.0 + 0.5j, FACE_FINISH)
