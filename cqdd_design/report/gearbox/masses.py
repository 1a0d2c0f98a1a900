"""Bill of materials, masses, reflected inertia and balance, from the parts of the machine."""

from __future__ import annotations

import math
from collections.abc import Container

from cqdd_design.catalog.paper import METRICS, is_papers_actuator
from cqdd_design.design import Design
from cqdd_design.errors import CatalogError
from cqdd_design.exporting.bill.substitutes import ordered
from cqdd_design.exporting.solids.bom import BomRow, part_rows
from cqdd_design.gearbox.balance import paper_disc_count
from cqdd_design.machine.weighing import DISC_COUNTS, Bodies
from cqdd_design.report.ink.numbers import MINUS, decimals, millimetres, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Figure, Words, line, rectangle, text
from cqdd_design.report.judgement.check_rows import printed
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import Seat
from cqdd_design.solids.inertia import ROTOR_PARTS, GearboxInertia, PartInertia, rotor_scope

Row = tuple[str, ...]


def bodies_view(design: Design, bodies: Bodies) -> Values:
    """Parts, mass properties, balance and seats of a design.

    Rows of the bill are (part, pieces, designation, material, source, g each, g in all, at the
    input), of groups (group, mass, share, inertia at the input, share).
    """
    inertia = bodies.inertia
    by_name = {part.name: part for part in inertia.parts}
    beside = is_papers_actuator(design) and not inertia.motor_missing
    return {
        "rows": tuple(
            _part_row(row, by_name.get(row.part), inertia)
            for row in part_rows(bodies.inertia.motor, bodies.parts)
        ),
        "total_mass": "not known"
        if inertia.whole_mass is None
        else with_unit(inertia.whole_mass, "kg", 4),
        "total_of": printed(inertia.mass_scope),
        "groups": _groups(inertia),
        "paper": _beside_the_paper(design, inertia) if beside else (),
        "reflected": _reflected(inertia, beside=beside),
        "balance": _balance(design, bodies),
        "rule": _rule(design, bodies.balance),
        "chart": _chart(inertia),
        "notes": inertia.warnings,
        "seats": tuple(_seat(part.name, fit) for part in bodies.parts for fit in part.fits),
    }


def _seat(part: str, fit: Seat | FittedHole) -> Row:
    try:
        limits = fit.limits
    except CatalogError:
        upper = lower = "beyond the table"
    else:
        upper, lower = (_deviation(1e6 * value) for value in (limits.upper, limits.lower))
    return part, fit.name, millimetres(fit.diameter, 4), fit.zone, upper, lower


def _deviation(value: float) -> str:
    """A limit of size with its sign, none before nought."""
    shown = significant(value)
    return f"+{shown}" if value > 0.0 and shown != "0" else shown


def _part_row(row: BomRow, part: PartInertia | None, inertia: GearboxInertia) -> Row:
    """A line of the bill; a motor that is not drawn has no part, but its rotor has inertia."""
    reflected = inertia.rotor_inertia if part is None else part.reflected
    each, whole = row.mass_each_kg, row.mass_total_kg
    catalogue = row.notes.startswith("mass: catalogue")
    return (
        row.part,
        str(row.quantity),
        # The hyphen of a standard's name is no minus.
        printed(ordered(row.designation)).replace(MINUS, "-"),
        row.material,
        row.make_or_buy,
        "not known" if each is None else decimals(1e3 * each, 1) + ("*" if catalogue else ""),
        "" if whole is None else decimals(1e3 * whole, 1),
        _told(reflected),
    )


def _groups(inertia: GearboxInertia) -> tuple[Row, ...]:
    def share(value: float | None, whole: float | None) -> str:
        if value is None or whole is None:
            return "not known"
        return f"{decimals(100.0 * value / whole, 1)}\u202f%"

    shares = inertia.group_inertias
    return tuple(
        (
            name,
            with_unit(1e3 * mass, "g", 4),
            share(mass, inertia.mass),
            _told(shares[name]),
            share(shares[name], inertia.reflected_input),
        )
        for name, mass in inertia.group_masses.items()
    )


def _beside_the_paper(design: Design, inertia: GearboxInertia) -> tuple[Row, ...]:
    """Mass and inertia beside what the paper prints, with what makes the difference."""
    paper = {name: figure.value for name, figure in METRICS.items()}
    groups = inertia.group_masses
    mass, whole = inertia.mass, inertia.reflected_input or 0.0
    rotor = inertia.rotor_inertia or 0.0
    peak, dense = design.requirements.peak_torque, "\u202fN\u00b7m/kg"

    def inertial(value: float, digits: int = 3) -> str:
        return significant(1e4 * value, digits)

    fourth = "\u202f\u00d7\u202f10\u207b\u2074\u202fkg\u00b7m\u00b2"
    return (
        (
            "mass",
            with_unit(mass, "kg", 4),
            with_unit(paper["mass"], "kg", 3),
            f"{1e3 * (mass - paper['mass']):+.0f} g. The motor is the catalogue's "
            f"{1e3 * groups['motor']:.0f} g, {rotor_scope(inertia.motor)}. Housing and cover, "
            "whose walls the paper does not print and which are proportioned here, weigh "
            f"{1e3 * (groups['housing'] + groups['cover and encoder']):.0f} g. Discs and "
            f"ring of steel ({1e3 * groups['discs and ring']:.0f} g) and the bearings are as the "
            "paper describes them.",
        ),
        (
            "inertia at the input",
            f"{inertial(whole)}{fourth}",
            f"{inertial(paper['actuator_inertia'])}{fourth}",
            f"{1e4 * (whole - paper['actuator_inertia']):+.3g}{fourth}. The catalogue's rotor has "
            f"{inertial(rotor)}{fourth}, {rotor_scope(inertia.motor)}; the gearbox adds "
            f"{inertial(inertia.gearbox_reflected, 2)}{fourth}.",
        ),
        (
            f"torque density, at the paper's {paper['peak_torque']:g}\u202fN\u00b7m",
            f"{significant(paper['peak_torque'] / mass, 3)}{dense}",
            f"{significant(paper['torque_density'], 3)}{dense}",
            f"follows from the mass; {significant(peak / mass, 3)}{dense} at this design's "
            f"{significant(peak)}\u202fN\u00b7m.",
        ),
    )


def _scaled(inertia: float) -> str:
    """An inertia in 1e-6 kg m^2, the unit of the table's column."""
    return significant(1e6 * inertia, 3)


def _told(inertia: float | None) -> str:
    return "not known" if inertia is None else _scaled(inertia)


def _reflected(inertia: GearboxInertia, *, beside: bool) -> tuple[Row, ...]:
    def shown(value: float | None) -> str:
        return "not known" if value is None else significant(1e4 * value, 4)

    printed_there = shown(METRICS["actuator_inertia"].value)
    there = f"; the paper prints {printed_there} for its actuator, at the motor" if beside else ""
    return (
        (
            "gearbox, at the input",
            shown(inertia.gearbox_reflected),
            printed(inertia.crank_scope),
        ),
        (
            "rotor of the motor",
            shown(inertia.rotor_inertia),
            f"{inertia.motor.name}, {rotor_scope(inertia.motor)}",
        ),
        (
            "together, at the input",
            shown(inertia.reflected_input),
            printed(inertia.inertia_scope) + there,
        ),
        (
            "together, at the output",
            shown(inertia.reflected_output),
            f"{inertia.ratio}² times that at the input",
        ),
    )


def _balance(design: Design, bodies: Bodies) -> tuple[tuple[Row, bool], ...]:
    def shown(value: float, digits: int) -> str:
        return "0" if value == 0.0 else significant(value, digits)

    return tuple(
        (
            (
                str(count),
                shown(1e6 * found.static_unbalance, 4),
                shown(1e9 * found.couple_unbalance, 4),
                shown(found.shaking_force, 3),
                shown(found.shaking_moment, 3),
            ),
            count == design.reducer.disc_count,
        )
        for count, found in bodies.balance.items()
    )


def _rule(design: Design, counts: Container[int]) -> str:
    ratio, count = design.reducer.ratio, design.reducer.disc_count
    wanted = paper_disc_count(ratio)
    parity = "even" if ratio % 2 == 0 else "odd"
    verdict = "as here" if wanted == count else f"this design has {count}"
    missing = " or ".join(str(number) for number in DISC_COUNTS if number not in counts)
    without = f" With {missing} of these discs the machine cannot be built." if missing else ""
    return (
        f"By the paper's rule an {parity} ratio takes {wanted} discs ({verdict}). It is reported, "
        "not imposed: two discs balance statically at any ratio, and three leave a couple, too."
        f"{without}"
    )


_WIDTH, _LEFT, _BAR_END, _PITCH = 860.0, 170.0, 700.0, 25.0


def _chart(inertia: GearboxInertia) -> Figure:
    """Horizontal bars: what each moving part of the gearbox adds at the input."""
    found = sorted(
        (p for p in inertia.parts if p.reflected > 0.0 and p.name not in ROTOR_PARTS),
        key=lambda p: -p.reflected,
    )
    height = 14.0 + _PITCH * len(found)
    body = []
    for index, part in enumerate(found):
        y = 8.0 + _PITCH * index
        width = max((_BAR_END - _LEFT) * part.reflected / found[0].reflected, 1.0)
        share = part.reflected / inertia.gearbox_reflected
        pieces = f", {part.count} pieces" if part.count > 1 else ""
        label = f"{_scaled(part.reflected)} ({decimals(100.0 * share, 1)} %{pieces})"
        body.append(text((_LEFT - 10.0, y + 14.0), part.name, "name-dark", "end"))
        body.append(rectangle(_LEFT, y + 2.0, width, 16.0, "share-bar"))
        body.append(text((_LEFT + width + 8.0, y + 14.0), label, "legend"))
    body.append(line((_LEFT, 4.0), (_LEFT, height - 4.0), "axis"))
    total = significant(1e6 * inertia.gearbox_reflected, 4)
    words = Words(
        "inertia-chart",
        "What the gearbox adds at the input",
        f"Bars of the inertia each part adds at the input; {found[0].name} adds most.",
        f"In 10⁻⁶ kg·m², of {total} in all; the motor's rotor and bell are not among them.",
    )
    return words.figure(_WIDTH, math.ceil(height), body)
