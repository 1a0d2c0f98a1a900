"""The sheet of a made part: section, view along the axis, table of holes, notes, title block.

::

    +----------------------------------------------+
    |   view along      section A-A         holes  |
    |   the axis        with sizes          1.1 .. |
    |                                       1.2 .. |
    |   notes              +----- title block -----|
    +----------------------+-----------------------+

Views stand at the largest scale of ISO 5455 at which all that is said of them has room on A3; what
would be smaller than 1 : 2 there is drawn on a larger sheet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

from cqdd_design.catalog.printing import made_how, printed_materials
from cqdd_design.exporting.printing.threads import with_inserts
from cqdd_design.exporting.sheets.blocks import Extent, distance_beside
from cqdd_design.exporting.sheets.drawing import SMALL, SheetDrawing, new_sheet
from cqdd_design.exporting.sheets.end_plan import EndPlan, EndShape
from cqdd_design.exporting.sheets.formats import BOTTOM, LEAST_SCALE, LEFT, PAPERS, Paper
from cqdd_design.exporting.sheets.lettering import text_width
from cqdd_design.exporting.sheets.part_facts import GENERAL_SURFACE, GENERAL_TOLERANCES
from cqdd_design.exporting.sheets.section_plan import SectionPlan, SectionShape
from cqdd_design.exporting.sheets.title_block import (
    INNER_EDGE,
    OUTER_EDGE,
    SCALES,
    Field,
    draw_border,
    draw_notes,
    draw_title_block,
    title_top,
)
from cqdd_design.exporting.sheets.wording import SIMULTANEOUS, joint_note

if TYPE_CHECKING:
    from cqdd_design.exporting.sheets.part_facts import PartFacts
    from cqdd_design.solids.part import Part

_HOLE, _PLACE, _PITCH = 10.2, 13.5, 4.0
"""Width of a block of the table of holes, and its rows, mm."""
_TITLE_ROWS = 4
_BETWEEN = 3.0


@dataclass(frozen=True, eq=False)
class Plan:
    """Views at one scale on a sheet, and the room there is for them, mm."""

    section: SectionPlan
    end: EndPlan | None
    paper: Paper
    room: Extent

    @property
    def scale(self) -> float:
        """Of all views."""
        return self.section.scale

    @cached_property
    def apart(self) -> float:
        """From the axis of the view along it to the middle of the section, mm; signed."""
        if self.end is None:
            return 0.0
        section, end = self.section.boxes, self.end.boxes
        # First angle: what is seen from the right stands on the left.
        if self.end.shape.from_above:
            return distance_beside(end, section, _BETWEEN)
        return -distance_beside(section, end, _BETWEEN)

    @cached_property
    def extent(self) -> Extent:
        """Of all views, about the axis and the middle of the section, mm."""
        boxes = list(self.section.boxes)
        if self.end is not None:
            shift = self.apart
            boxes += [(a - shift, b, c - shift, d) for a, b, c, d in self.end.boxes]
        return Extent.of(boxes)

    @property
    def fits(self) -> bool:
        """Whether the views have room."""
        return self.extent.width <= self.room.width and self.extent.height <= self.room.height

    def places(self) -> tuple[complex, complex]:
        """Middle of the section, and axis of the view along it, on the sheet."""
        extent, room = self.extent, self.room
        x = room.left - extent.left + 0.5 * (room.width - extent.width)
        y = room.bottom - extent.bottom + 0.5 * (room.height - extent.height)
        # Views move apart into what room is left.
        spare = max(room.width - extent.width, 0.0) / 6.0
        more = spare if self.apart > 0.0 else -spare if self.apart < 0.0 else 0.0
        return complex(x + more, y), complex(x - self.apart - more, y)


def plan_sheet(facts: PartFacts) -> Plan:
    """Lay a part's views out on the smallest sheet where they fit at 1 : 2 or larger.

    As large there as fits; smaller than 1 : 2 only where the largest sheet is too small.
    """
    section, end = SectionShape(facts), EndShape(facts)
    shown = [one for one in SCALES if one >= LEAST_SCALE]
    tried = [(paper, scale) for paper in PAPERS for scale in shown]
    tried += [(PAPERS[-1], scale) for scale in SCALES if scale < LEAST_SCALE]

    @cache
    def views(scale: float) -> tuple[SectionPlan, EndPlan | None]:
        along = EndPlan(end, scale, section.directions) if end.needed else None
        return SectionPlan(section, scale), along

    for paper, scale in tried:
        plan = Plan(*views(scale), paper, _room(facts, paper))
        if plan.fits:
            break
    return plan


def _room(facts: PartFacts, paper: Paper) -> Extent:
    """Of the views, beside the table of holes and above notes and title block."""
    blocks = _table_blocks(facts, paper)
    right = paper.right - 2.0 - (blocks * (_columns(facts)[-1] + 2.0) if blocks else 0.0)
    return Extent(LEFT + 2.0, title_top(_TITLE_ROWS) + 1.0, right, paper.top - 1.0)


def draw_part(facts: PartFacts) -> SheetDrawing:
    """Draw the sheet of a part."""
    plan = plan_sheet(facts)
    sheet = new_sheet(plan.scale, plan.paper)
    draw_border(sheet)
    section_at, end_at = plan.places()
    plan.section.draw(sheet, section_at, "A-A" if plan.end else "")
    if plan.end is not None:
        plan.end.draw(sheet, end_at, "A")
    _table_of_holes(sheet, facts)
    corner = complex(LEFT + 4.0, title_top(_TITLE_ROWS) - 5.0)
    draw_notes(
        sheet,
        corner,
        notes(facts, exact=plan.end is not None and plan.end.has_exact),
        width=plan.paper.title.real - corner.real - 4.0,
        height=corner.imag - BOTTOM - 2.0,
        columns=2,
    )
    _title(sheet, facts)
    return sheet


def notes(facts: PartFacts, *, exact: bool = True) -> list[str]:
    """Notes of a sheet, each a sentence or two; `exact` where it has dimensions in boxes."""
    from cqdd_design.solids.features.holes import FittedHole
    from cqdd_design.solids.features.kinds import AxialThread, Seat, Shoulder

    said = [f"{facts.part.designation[0].upper()}{facts.part.designation[1:]}."]
    features = facts.part.features
    for feature in features:
        if isinstance(feature, AxialThread | Seat | Shoulder) and feature.datum:
            what = "" if isinstance(feature, Shoulder) else "axis of the "
            said.append(f"Datum {feature.datum}: {what}{feature.name}.")
    said += [joint_note(joint) for joint in facts.joints]
    said += _insert_notes(facts.part)
    seams = any(isinstance(one, FittedHole) and one.seam for one in features)
    if seams and facts.part.material not in printed_materials():
        said.append(
            "Half grooves are drilled and reamed whole while the seat still has its stock; boring "
            "the seat to size opens them. Never across the seam, with the mate in place."
        )
    if facts.holes:
        said.append("X and Y of holes are theoretically exact; X points up in the view.")
    if facts.together:
        these = "circles of holes" if facts.holes else "lobes"
        said.append(
            f"{SIMULTANEOUS}: zones so marked hold at once (ISO 5458), so the {these} are clocked "
            "to each other."
        )
    if exact:
        said.append("Dimensions in boxes are theoretically exact (ISO 1101).")
    said.append("Lengths run from the face marked with a circle.")
    said.append("Sizes without limits of their own are rounded to 0.01 mm.")
    return said


def _insert_notes(part: Part) -> list[str]:
    """What goes into the threads of a part of plastic instead of a tap, and what is cut in it."""
    plastic = printed_materials().get(part.material)
    if plastic is None:
        return []
    how = "moulding" if plastic.process == "moulded" else "printing"
    return [
        *(f"Threads {one}." for one in with_inserts(part, plastic.least_wall)[1]),
        f"Limits, frames and roughness hold when the part is done: after {how} these surfaces are "
        "cut to size, and threads that no insert takes are cut.",
    ]


def _title(sheet: SheetDrawing, facts: PartFacts) -> None:
    part, material = facts.part, facts.material
    rows: list[list[Field]] = [
        [
            ("tolerances", GENERAL_TOLERANCES, 64.0),
            ("edges ISO 13715", f"outside {OUTER_EDGE}, inside {INNER_EDGE}", 44.0),
            ("surfaces", _surfaces(part.material), 72.0),
        ],
        [
            ("part", part.name, 52.0),
            ("quantity", str(part.count), 24.0),
            ("mass of one", f"{1e3 * part.mass:.4g} g", 36.0),
            ("hardness", material.drawn_hardness, 68.0),
        ],
        [
            ("material", part.material, 92.0),
            ("treatment", material.drawing_note or "as delivered", 88.0),
        ],
    ]
    words = f"{part.name}; {part.designation}"
    draw_title_block(sheet, facts.design, facts.number, words, rows)


def _surfaces(material: str) -> str:
    made = made_how(material, "")
    return f"as {made}, where not marked" if made else GENERAL_SURFACE


def hole_places(facts: PartFacts) -> list[tuple[str, str, str]]:
    """Number, X and Y (mm) of every hole."""
    rows = []
    for number, group in enumerate(facts.holes, start=1):
        for place, (x, y) in enumerate(group[0].circle.centres, start=1):
            rows.append((f"H{number}.{place}", _fixed(x), _fixed(y)))
    return rows


def _fixed(value: float) -> str:
    # First to a nanometre: halves of the last figure would fall to either side of it.
    return f"{round(round(1e3 * value, 6), 4) + 0.0:.4f}"


def _most_rows(paper: Paper) -> int:
    return int((paper.top - 12.0 - title_top(_TITLE_ROWS)) / _PITCH) - 2


def _table_blocks(facts: PartFacts, paper: Paper) -> int:
    return -(-len(hole_places(facts)) // _most_rows(paper))


def _columns(facts: PartFacts) -> tuple[float, float, float, float]:
    """Where the columns of the table of holes begin, and where the last one ends, mm."""
    widest = max((text_width(word, SMALL) for _, *both in hole_places(facts) for word in both))
    place = max(_PLACE, widest + 1.4)
    return 0.0, _HOLE, _HOLE + place, _HOLE + 2.0 * place + 0.8


def _table_of_holes(sheet: SheetDrawing, facts: PartFacts) -> None:
    rows, paper = hole_places(facts), sheet.paper
    blocks = _table_blocks(facts, paper)
    if not blocks:
        return
    *columns, wide = _columns(facts)
    left = paper.right - blocks * (wide + 2.0)
    sheet.text(complex(left, paper.top - 6.0), "HOLES, mm", 3.0)
    most = _most_rows(paper)
    for block in range(blocks):
        corner = complex(left + block * (wide + 2.0), paper.top - 8.0)
        some = [("hole", "X", "Y"), *rows[block * most : (block + 1) * most]]
        for place, row in enumerate(some, start=1):
            level = corner - 1j * place * _PITCH
            for x, words in zip(columns, row, strict=True):
                sheet.text(level + x + 0.8 + 0.9j, words, SMALL)
            sheet.line(level, level + wide)
        sheet.line(corner, corner + wide)
        for x in (*columns, wide):
            sheet.line(corner + x, corner + x - 1j * len(some) * _PITCH)
