"""A part of plastic: as drawn, as made, and what goes into it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog.printing import PrintedMaterial
from cqdd_design.exporting.printing.compensate import Compensation
from cqdd_design.exporting.printing.threads import ThreadedHoles
from cqdd_design.solids.walls import Wall

if TYPE_CHECKING:
    from cqdd_design.solids.part import Part


@dataclass(frozen=True, eq=False)
class PrintedPart:
    """A part of plastic.

    Attributes
    ----------
    drawn, made : Part
        As it should become, and as its file has it.
    by : Compensation
        What lies between them.
    material : PrintedMaterial
    threads : tuple of ThreadedHoles
        And what goes into them.
    wall : Wall or None
        The thinnest between its holes, inserts' among them; None where it has no round holes.
    """

    drawn: Part
    made: Part
    by: Compensation
    material: PrintedMaterial
    threads: tuple[ThreadedHoles, ...]
    wall: Wall | None
