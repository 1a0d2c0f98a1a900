"""Bill of materials as CSV: every part, how many, make or buy, what of, what it weighs, and why.

Bought lines have a designation to order by, notes for fitting, what else may be bought, and the
user's prices where there are any. Masses are closed forms or the catalogue's, so no CAD kernel is
needed; the notes say which.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import asdict, dataclass, fields, replace
from typing import TYPE_CHECKING

from cqdd_design.catalog import bearings, find_material
from cqdd_design.files import WrittenFile, write_atomically
from cqdd_design.solids.inertia import ROTOR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cqdd_design.catalog import Motor
    from cqdd_design.exporting.bill.prices import PriceList
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine import Machine
    from cqdd_design.solids.part import Part

TOTAL = "total per machine"
"""Name of the lines below the parts, one a currency."""
_STATOR = "motor stator"


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
        Pieces; packs of what is no part.
    make_or_buy : str
        ``make`` or ``buy``.
    material : str
        Catalogue name; empty where it is not known.
    mass_each_kg, mass_total_kg : float or None
        Of one piece and of all; None where the catalogue gives none.
    designation : str
        What to order, or how it is made.
    fitting : str
        How a bought part is put in, and how much of a consumable.
    substitutes : str
        What may be bought instead and passes the same checks, apart by semicolons.
    price_each, price_total : float or None
        The user's; None where the list has none.
    currency, vendor : str
        Likewise.
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
    fitting: str = ""
    substitutes: str = ""
    price_each: float | None = None
    price_total: float | None = None
    currency: str = ""
    vendor: str = ""
    notes: str = ""

    @property
    def priced_by(self) -> str:
        """What a price list calls it; empty where it comes with another line."""
        if self.part == ROTOR:
            return ""
        return self.designation if self.make_or_buy == "buy" else self.part


_MASSES = ("mass_each_kg", "mass_total_kg")


def export_bom(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-bom.csv``."""
    rows = bill_of_materials(job.machine, job.parts)
    prices = job.options.prices
    if prices is not None:
        rows = priced(rows, prices)
    return (
        write_atomically(job.path("-bom.csv"), bom_csv(rows, totals=prices is not None), "bom"),
    )


def bill_of_materials(machine: Machine, parts: Sequence[Part]) -> tuple[BomRow, ...]:
    """Return the whole bill of a machine: its parts, and what it takes beside them.

    Parameters
    ----------
    parts : sequence of Part
        Of the machine.
    """
    from cqdd_design.exporting.bill.consumables import consumables
    from cqdd_design.exporting.bill.fitting import fitting_notes
    from cqdd_design.exporting.bill.substitutes import bought_of, ordered, substitutes

    named = {part.name: part for part in parts}
    notes = fitting_notes(machine)
    rows = []
    for row in part_rows(machine.motor, parts):
        part = named.get(row.part)
        if part is None:
            # The motor, which is not among the parts.
            told = f"not drawn: {machine.layout.motor_missing}; bell, cover and encoder are missing"
            rows.append(replace(row, fitting=f"{told} in this bill"))
            continue
        if row.make_or_buy == "make":
            rows.append(row)
            continue
        rows.append(
            replace(
                row,
                material=bought_of(part),
                designation=machine.motor.name if row.part == _STATOR else ordered(row.designation),
                fitting=notes.get(row.part, ""),
                substitutes="; ".join(substitutes(machine, part)),
            )
        )
    beside = (
        BomRow(
            len(rows) + number, one.name, one.quantity, "buy", "", None, None, one.designation,
            fitting=one.fitting, substitutes=one.substitutes,
            notes=f"mass: not part of the machine's ({one.source})",
        )
        for number, one in enumerate(consumables(machine), start=1)
    )  # fmt: skip
    return (*rows, *beside)


def part_rows(motor: Motor, parts: Sequence[Part]) -> tuple[BomRow, ...]:
    """Return the lines of the parts alone; a motor that is not among them is the last.

    Parameters
    ----------
    parts : sequence of Part
        From `solids.build_parts`.
    """
    rows = tuple(_part_row(item, part, motor) for item, part in enumerate(parts, start=1))
    if any(part.name == ROTOR for part in parts):
        return rows
    return (*rows, _motor_row(len(rows) + 1, motor))


def priced(rows: Sequence[BomRow], prices: PriceList) -> tuple[BomRow, ...]:
    """Return the bill with the prices of a list.

    Raises
    ------
    UsageError
        When the list has a row that names no part.
    """
    prices.refuse_unknown(row.priced_by for row in rows if row.priced_by)
    found = []
    for row in rows:
        price = prices.of(row.priced_by) if row.priced_by else None
        if price is None:
            found.append(row)
            continue
        found.append(
            replace(
                row,
                price_each=price.amount,
                price_total=row.quantity * price.amount,
                currency=price.currency,
                vendor=price.vendor,
            )
        )
    return tuple(found)


def bom_csv(rows: Sequence[BomRow], *, totals: bool = False) -> str:
    """Return the bill as CSV with a heading; masses to 0.01 g, unknown ones empty.

    Parameters
    ----------
    totals : bool
        Whether what all priced lines cost, and how many have no price, stand below them.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([field.name for field in fields(BomRow)])
    for row in (*rows, *(total_rows(rows) if totals else ())):
        cells = asdict(row).items()
        writer.writerow([_cell(name, value) for name, value in cells])
    return stream.getvalue()


def total_rows(rows: Sequence[BomRow]) -> tuple[BomRow, ...]:
    """Return what the priced lines cost together, a line for every currency."""
    ordered = [row for row in rows if row.priced_by]
    missing = sum(row.price_total is None for row in ordered)
    told = f"{missing} of {len(ordered)} lines have no price" if missing else "every line is priced"
    masses = math.fsum(row.mass_total_kg or 0.0 for row in rows)
    currencies = dict.fromkeys(row.currency for row in ordered if row.currency)
    sums: dict[str, float | None] = {
        currency: math.fsum(row.price_total or 0.0 for row in ordered if row.currency == currency)
        for currency in currencies
    }
    return tuple(
        BomRow(
            len(rows) + number, TOTAL, 1, "", "", None, masses, "",
            price_total=value, currency=currency, notes=told,
        )
        for number, (currency, value) in enumerate(
            (sums or {"": None}).items(), start=1
        )
    )  # fmt: skip


def _cell(name: str, value: object) -> object:
    if not isinstance(value, float):
        return value
    return f"{value:.5f}" if name in _MASSES else f"{value:.2f}"


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
