"""Bill of materials as CSV: every part, how many, make or buy, what of, what it weighs, and why.

Masses are closed forms or the catalogue's, so no CAD kernel is needed; the notes say which.
"""

from __future__ import annotations

import csv
import io
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING

from cqdd_design.catalog import bearings, find_material
from cqdd_design.files import WrittenFile, write_atomically
from cqdd_design.solids.inertia import ROTOR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cqdd_design.catalog import Motor
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.solids.part import Part


@dataclass(frozen=True)
class BomRow:
    """One line of the bill; the field names are the columns.

    Attributes
    ----------
    item : int
        From 1.
    part : str
        Name in the machine.
    quantity : int
        Pieces.
    make_or_buy : str
        ``make`` or ``buy``.
    material : str
        Catalogue name; empty where it is not known.
    mass_each_kg, mass_total_kg : float or None
        Of one piece and of all; None where the catalogue gives none.
    designation : str
        What to order, or how it is made.
    notes : str
        Where mass and material come from.
    """

    item: int
    part: str
    quantity: int
    make_or_buy: str
    material: str
    mass_each_kg: float | None
    mass_total_kg: float | None
    designation: str
    notes: str


def export_bom(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-bom.csv``."""
    text = bom_csv(bill_of_materials(job.machine.motor, job.parts))
    return (write_atomically(job.path("-bom.csv"), text, "bom"),)


def bill_of_materials(motor: Motor, parts: Sequence[Part]) -> tuple[BomRow, ...]:
    """Return the bill of a machine; a motor that is not among its parts is its last line.

    Parameters
    ----------
    parts : sequence of Part
        From `solids.build_parts`.
    """
    rows = tuple(_part_row(item, part, motor) for item, part in enumerate(parts, start=1))
    if any(part.name == ROTOR for part in parts):
        return rows
    return (*rows, _motor_row(len(rows) + 1, motor))


def bom_csv(rows: Sequence[BomRow]) -> str:
    """Return the bill as CSV with a heading; masses to 0.01 g, unknown ones empty."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([field.name for field in fields(BomRow)])
    for row in rows:
        values = asdict(row).values()
        writer.writerow([f"{v:.5f}" if isinstance(v, float) else v for v in values])
    return stream.getvalue()


def _part_row(item: int, part: Part, motor: Motor) -> BomRow:
    return BomRow(
        item=item,
        part=part.name,
        quantity=part.count,
        make_or_buy=part.source,
        material=part.material,
        mass_each_kg=part.mass,
        mass_total_kg=part.count * part.mass,
        designation=part.designation,
        notes=_mass_note(part, motor),
    )


def _mass_note(part: Part, motor: Motor) -> str:
    if part.catalogue_mass is not None:
        of_motor = part.designation.startswith(f"{motor.name}, ")
        row = motor if of_motor else bearings().get(part.designation)
        return "mass: catalogue" + (f" ({row.source})" if row is not None else "")
    density = find_material(part.material).density
    form = "exact profile" if part.exact_section is not None else "closed form"
    return f"mass: {form} x {density:g} kg/m3 ({find_material(part.material).source})"


def _motor_row(item: int, motor: Motor) -> BomRow:
    return BomRow(
        item=item,
        part="motor",
        quantity=1,
        make_or_buy="buy",
        material="",
        mass_each_kg=motor.mass,
        mass_total_kg=motor.mass,
        designation=motor.name,
        notes=f"mass: {'not in the catalogue' if motor.mass is None else 'catalogue'} "
        f"({motor.source})",
    )
