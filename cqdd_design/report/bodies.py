"""Bill of materials, masses, reflected inertia and balance, from the parts of the machine."""

from __future__ import annotations

import math
from collections.abc import Container
from dataclasses import dataclass

from cqdd_design.catalog.motors import find_motor
from cqdd_design.design import Design
from cqdd_design.exporting.bom import BomRow, bill_of_materials
from cqdd_design.gearbox.balance import paper_disc_count
from cqdd_design.report.check_rows import printed
from cqdd_design.report.numbers import decimals, significant, with_unit
from cqdd_design.report.svg import Figure, line, rectangle, text
from cqdd_design.report.weighing import DISC_COUNTS, Bodies
from cqdd_design.solids.inertia import GearboxInertia, PartInertia

#: Inertia of the whole actuator that the paper prints (table II), at the motor, kg m^2.
PAPER_INERTIA = 5.01e-4


@dataclass(frozen=True)
class PartRow:
    """One line of the bill of materials, with what the part weighs and adds at the input."""

    name: str
    count: str
    designation: str
    material: str
    source: str
    mass_each: str
    mass_all: str
    reflected: str


@dataclass(frozen=True)
class BodiesView:
    """What the page shows of parts and inertia.

    Attributes
    ----------
    rows : tuple of PartRow
    total_mass : str
    reflected : tuple of (name, at the input, remark)
    balance : tuple of (discs, static, couple, force, moment, is this design)
    rule : str
        What the paper's rule would ask for.
    chart : Figure
        Shares of the reflected inertia.
    notes : tuple of str
    """

    rows: tuple[PartRow, ...]
    total_mass: str
    reflected: tuple[tuple[str, str, str], ...]
    balance: tuple[tuple[str, str, str, str, str, bool], ...]
    rule: str
    chart: Figure
    notes: tuple[str, ...]


def bodies_view(design: Design, bodies: Bodies) -> BodiesView:
    """Arrange parts, mass properties and balance of a design for the page."""
    inertia = bodies.inertia
    by_name = {part.name: part for part in inertia.parts}
    return BodiesView(
        rows=tuple(
            _part_row(row, by_name.get(row.part), inertia)
            for row in bill_of_materials(design, bodies.parts)
        ),
        total_mass=with_unit(inertia.total.mass, "kg", 4),
        reflected=_reflected(inertia),
        balance=_balance(design, bodies),
        rule=_rule(design, bodies.balance),
        chart=_chart(inertia),
        notes=inertia.warnings,
    )


def _part_row(row: BomRow, part: PartInertia | None, inertia: GearboxInertia) -> PartRow:
    """A line of the bill; the motor has no part, but its rotor has inertia."""
    reflected = inertia.rotor_inertia if part is None else part.reflected
    each, whole = row.mass_each_kg, row.mass_total_kg
    catalogue = row.notes.startswith("mass: catalogue")
    return PartRow(
        row.part,
        str(row.quantity),
        printed(row.designation),
        row.material,
        row.make_or_buy,
        "not known" if each is None else decimals(1e3 * each, 1) + ("*" if catalogue else ""),
        "" if whole is None else decimals(1e3 * whole, 1),
        "not known" if reflected is None else _scaled(reflected),
    )


def _scaled(inertia: float) -> str:
    """An inertia in 1e-6 kg m^2, the unit of the table's column."""
    return "0" if inertia == 0.0 else significant(1e6 * inertia, 3)


def _reflected(inertia: GearboxInertia) -> tuple[tuple[str, str, str], ...]:
    def shown(value: float | None) -> str:
        return "not known" if value is None else significant(1e4 * value, 4)

    estimated = "rotor inertia estimated" in find_motor(inertia.motor).note
    return (
        ("gearbox, at the input", shown(inertia.gearbox_reflected), "all parts but the rotor"),
        (
            "rotor of the motor",
            shown(inertia.rotor_inertia),
            f"{inertia.motor}{', an estimate' if estimated else ''}",
        ),
        (
            "together, at the input",
            shown(inertia.reflected_input),
            f"the paper prints {shown(PAPER_INERTIA)} for its actuator, at the motor",
        ),
        (
            "together, at the output",
            shown(inertia.reflected_output),
            f"{inertia.ratio}² times that at the input",
        ),
    )


def _balance(design: Design, bodies: Bodies) -> tuple[tuple[str, str, str, str, str, bool], ...]:
    reducer = design.reducer
    # What cancels on paper leaves rounding of the sums, which is shown as nothing.
    throw = bodies.inertia.orbiting_mass * reducer.eccentricity

    def shown(value: float, scale: float, least: float, digits: int) -> str:
        return "0" if value < 1e-9 * least else significant(scale * value, digits)

    speed = design.requirements.input_speed
    arm = reducer.disc_thickness
    return tuple(
        (
            str(count),
            shown(found.static_unbalance, 1e6, throw, 4),
            shown(found.couple_unbalance, 1e9, throw * arm, 4),
            shown(found.shaking_force, 1.0, throw * speed**2, 3),
            shown(found.shaking_moment, 1.0, throw * arm * speed**2, 3),
            count == reducer.disc_count,
        )
        for count, found in bodies.balance.items()
    )


def _rule(design: Design, counts: Container[int]) -> str:
    ratio, count = design.reducer.ratio, design.reducer.disc_count
    wanted = paper_disc_count(ratio)
    parity = "even" if ratio % 2 == 0 else "odd"
    verdict = "as here" if wanted == count else f"this design has {count}"
    missing = [str(number) for number in DISC_COUNTS if number not in counts]
    without = (
        f" With {' or '.join(missing)} of these discs the machine cannot be built."
        if missing
        else ""
    )
    return (
        f"By the paper's rule an {parity} ratio takes {wanted} discs ({verdict}). It is reported, "
        "not imposed: two discs balance statically at any ratio, and three leave a couple, too."
        f"{without}"
    )


_WIDTH, _LEFT, _BAR_END, _PITCH = 860.0, 170.0, 700.0, 25.0


def _chart(inertia: GearboxInertia) -> Figure:
    """Horizontal bars: what each moving part of the gearbox adds at the input."""
    found = sorted((p for p in inertia.parts if p.reflected > 0.0), key=lambda p: -p.reflected)
    longest = found[0].reflected
    height = 14.0 + _PITCH * len(found)
    body = []
    for index, part in enumerate(found):
        y = 8.0 + _PITCH * index
        width = max((_BAR_END - _LEFT) * part.reflected / longest, 1.0)
        share = part.reflected / inertia.gearbox_reflected
        pieces = f", {part.count} pieces" if part.count > 1 else ""
        body.append(text((_LEFT - 10.0, y + 14.0), part.name, "name-dark", "end"))
        body.append(rectangle(_LEFT, y + 2.0, width, 16.0, "share-bar"))
        label = f"{_scaled(part.reflected)} ({decimals(100.0 * share, 1)} %{pieces})"
        body.append(text((_LEFT + width + 8.0, y + 14.0), label, "legend"))
    body.append(line((_LEFT, 4.0), (_LEFT, height - 4.0), "axis"))
    total = significant(1e6 * inertia.gearbox_reflected, 4)
    return Figure(
        "inertia-chart",
        "What the gearbox adds at the input",
        f"Bars of the inertia each part adds at the input; {found[0].name} adds most.",
        _WIDTH,
        math.ceil(height),
        "".join(body),
        f"In 10⁻⁶ kg·m², of {total} in all; the rotor of the motor is not among them.",
    )
