"""The end of the report: symbols of the paper, errata, assumptions, sources used."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from cqdd_design.catalog.bearings import bearings, find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.screws import find_shoulder_screw
from cqdd_design.design import Design
from cqdd_design.errors import CatalogError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.balance import paper_disc_count
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.geometry import kinematics
from cqdd_design.report.ink.numbers import MINUS, with_unit
from cqdd_design.results import Check
from cqdd_design.solids.part import Part

#: Where the paper's own arithmetic or units do not hold: place, printed, correct, reason.
ERRATA = (
    (
        "eq. 1, section III-B",
        f"Z_R = {MINUS}Z_np/(Z_np {MINUS} Z_nt) = {MINUS}Z_nt",
        f"Z_R = {MINUS}Z_nt/(Z_np {MINUS} Z_nt) = {MINUS}Z_nt",
        f"With 11 ring teeth and 10 lobes the printed middle term is {MINUS}11, not {MINUS}10.",
    ),
    (
        "table III",
        "Variance (Nm)",
        "variance in N\u00b2\u00b7m\u00b2",
        "The variance of a torque error has the square of its unit.",
    ),
    (
        "table II, Lee et al.",
        "83.7 N\u00b7m/kg",
        "83.96 N\u00b7m/kg",
        "155.32 N\u00b7m over 1.85 kg.",
    ),
)


def paper_symbols(design: Design) -> tuple[tuple[str, str, str, str], ...]:
    """The paper's symbols: symbol, meaning there, name in design files, value of this design."""
    reducer = design.reducer
    n = reducer.ratio
    return (
        (
            "Z_r",
            "pitch radius of the ring",
            "reducer.ring_pitch_radius",
            with_unit(1e3 * reducer.ring_pitch_radius, "mm", 6),
        ),
        (
            "Z_e",
            "eccentricity",
            "reducer.eccentricity",
            with_unit(1e3 * reducer.eccentricity, "mm", 6),
        ),
        (
            "Z_p",
            "diameter of an outer pin, here of a ring tooth",
            "reducer.ring_pin_diameter",
            with_unit(1e3 * reducer.ring_pin_diameter, "mm", 6),
        ),
        (
            "Z_o",
            "diameter of an output pin",
            "reducer.output_pins.diameter",
            with_unit(1e3 * reducer.output_pins.diameter, "mm", 6),
        ),
        ("Z_{np}", "number of outer pins, ring teeth", "reducer.ratio + 1", str(n + 1)),
        ("Z_{nt}", "number of teeth on the disc, lobes", "reducer.ratio", str(n)),
        (
            "Z_R",
            "transmission ratio, ring held",
            f"{MINUS}reducer.ratio",
            f"{MINUS}{abs(kinematics.ratio_ring_fixed(n))}",
        ),
        (
            "N_Z",
            "number of discs",
            "reducer.disc_count",
            f"{reducer.disc_count} (rule of the paper: {paper_disc_count(n)})",
        ),
    )


def model_assumptions(design: Design) -> tuple[str, ...]:
    """What the numbers of this report take for granted."""
    reducer = design.reducer
    sharing = (
        "One disc carries the whole torque."
        if reducer.disc_count == 1
        else f"The {reducer.disc_count} discs share the torque equally, and the rigid law shares "
        "it among teeth and pins; checks of ring and pins multiply forces by "
        f"{UNEVEN_SHARING:g} for what is uneven."
    )
    pins = (
        "Output pins are simply supported by plates on both sides; the force is spread over the "
        "disc's thickness."
        if reducer.output_pins.support == "both"
        else "Output pins are cantilevers from one plate; the farthest disc bends them most."
    )
    found = [
        sharing,
        "Rigid load law: bodies are rigid, every tooth and pin is an equal spring without a gap, "
        "one side is loaded. Contact deflection, clearances and errors change the sharing.",
        "Contacts are Hertz line contacts over the whole thickness of a disc, without friction or "
        "edge stress.",
        "Maxima are taken over the whole period, all discs and both senses of torque.",
        pins,
        "The cam bearing carries ring and output-pin forces together, at its greatest load over "
        "the period.",
        "Basic rating life by ISO 281 without the factors for lubrication and cleanliness.",
        "The balance checks count the discs with their cam bearings, from exact areas.",
    ]
    return tuple(found)


@dataclass(frozen=True)
class Source:
    """A source and what this report took from it."""

    text: str
    used_for: str


def sources_used(
    checks: Sequence[Check],
    analysis: GearboxAnalysis,
    planetary: Iterable[str],
    parts: Sequence[Part] = (),
) -> tuple[tuple[Source, ...], tuple[Source, ...]]:
    """Literature behind the checks and the comparison, and catalogue rows, as used here.

    Parameters
    ----------
    checks : sequence of Check
    analysis : GearboxAnalysis
        Names materials, bearing, screws and motor.
    planetary : iterable of str
        Sources of the planetary comparison.
    parts : sequence of Part
        Of the machine, where they have been weighed.

    Returns
    -------
    tuple
        Literature and catalogue rows, each sorted by first use.
    """
    used: dict[str, list[str]] = {}
    for check in checks:
        literature = check.source.partition("; limit: ")[0]
        for part in _parts(literature):
            used.setdefault(part, []).append(check.id)
    for text in planetary:
        used.setdefault(text, []).append("planetary comparison")
    literature_rows = tuple(
        Source(text, ", ".join(dict.fromkeys(ids))) for text, ids in used.items()
    )
    return literature_rows, _catalogue(analysis, parts)


def _parts(source: str) -> list[str]:
    """Single sources of a line, without remarks in parentheses or before a colon."""
    plain = re.sub(r"\s*\([^()]*\)", "", source)
    parts = [re.sub(r"^[^:]+: ", "", part.strip()) for part in plain.split(";")]
    return [part for part in parts if part]


def _catalogue(analysis: GearboxAnalysis, parts: Sequence[Part]) -> tuple[Source, ...]:
    design = analysis.design
    reducer = design.reducer
    named: dict[str, list[str]] = {}
    for name, use in (
        (reducer.disc_material, "discs"),
        (reducer.ring_material, "ring"),
        (reducer.output_pins.material, "output pins"),
        (design.housing.material, "housing"),
    ):
        named.setdefault(name, []).append(use)
    for part in parts:
        named.setdefault(part.material, []).append(part.name)
    rows = [
        Source(f"{name}: {find_material(name).source}", ", ".join(dict.fromkeys(uses)))
        for name, uses in named.items()
    ]
    bearing = analysis.cam_bearing.bearing
    seats = {bearing.designation: ["cam bearing"]}
    for part in parts:
        if part.designation in bearings():
            seats.setdefault(part.designation, []).append(part.name)
    rows += [
        Source(f"bearing {name}: {find_bearing(name).source}", ", ".join(dict.fromkeys(uses)))
        for name, uses in seats.items()
    ]
    try:
        screw = find_shoulder_screw(reducer.output_pins.diameter)
        rows.append(Source(f"{screw.name}: {screw.source}", "output pins, limits of size"))
    except CatalogError:
        rows.append(Source("ISO 286-2, zone f9", "output pins, limits of size"))
    motor = analysis.motor
    rows.append(Source(f"{motor.name}: {motor.source}", "motor checks"))
    return tuple(rows)
