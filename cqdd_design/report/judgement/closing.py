"""The end of the report: symbols of the paper, errata, assumptions, sources used."""

from __future__ import annotations

import re
from collections.abc import Sequence

from cqdd_design.catalog.bearings import bearings, find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.balance import paper_disc_count
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.output_pins import pin_zone, shoulder_screw
from cqdd_design.report.ink.numbers import MINUS, millimetres
from cqdd_design.results import Check
from cqdd_design.solids.part import Part

_JOINTS = {
    "clamped": "Output pins are beams clamped in plate and cap; the cap hangs on them and turns.",
    "hinged": "Output pins are beams clamped in the plate and pinned in the cap, which hangs on "
    "them and turns.",
    "columns": "Output pins are beams clamped in the plate and pinned in the cap, which columns "
    "tie to the plate.",
}

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
    (
        "table II, BEAR",
        "47.7 N\u00b7m/kg",
        "47.76 N\u00b7m/kg",
        "32 N\u00b7m over 0.670 kg.",
    ),
)


PLANETARY_SOURCES = (
    "ISO 6336-1, -2 and -3:2019, load capacity of spur gears",
    "ISO 6336-5:2016, strength of gear materials",
    "ISO 1328-1:2013, flank tolerances",
    "ISO 21771:2007, geometry of cylindrical gears",
)


def paper_symbols(design: Design) -> tuple[tuple[str, str, str, str], ...]:
    """The paper's symbols: symbol, meaning there, name in design files, value of this design."""
    reducer, pins = design.reducer, design.reducer.output_pins
    n = reducer.ratio
    lengths = (
        ("Z_r", "pitch radius of the ring", "ring_pitch_radius", reducer.ring_pitch_radius),
        ("Z_e", "eccentricity", "eccentricity", reducer.eccentricity),
        (
            "Z_p",
            "diameter of an outer pin, here of a ring tooth",
            reducer.tooth_key,
            reducer.tooth_diameter,
        ),
        ("Z_o", "diameter of an output pin", "output_pins.diameter", pins.diameter),
    )
    ratio = f"{MINUS}{abs(kinematics.ratio_ring_fixed(n))}"
    discs = f"{reducer.disc_count} (rule of the paper: {paper_disc_count(n)})"
    return (
        *(
            (symbol, meaning, f"reducer.{key}", millimetres(length, 6))
            for symbol, meaning, key, length in lengths
        ),
        ("Z_{np}", "number of outer pins, ring teeth", "reducer.ratio + 1", str(n + 1)),
        ("Z_{nt}", "number of teeth on the disc, lobes", "reducer.ratio", str(n)),
        ("Z_R", "transmission ratio, ring held", f"{MINUS}reducer.ratio", ratio),
        ("N_Z", "number of discs", "reducer.disc_count", discs),
    )


def model_assumptions(design: Design) -> tuple[str, ...]:
    """What the numbers of this report take for granted."""
    reducer = design.reducer
    sharing = (
        "One disc carries the whole torque."
        if reducer.disc_count == 1
        else f"The {reducer.disc_count} discs share the torque equally, and the rigid law shares "
        "it among teeth and pins; the first screen of a search multiplies these forces by "
        f"{UNEVEN_SHARING:g} for what is uneven. The verdict's own are those of the contact "
        "equilibrium."
    )
    pins = (
        _JOINTS[reducer.carrier.joint]
        if reducer.output_pins.support == "both"
        else "Output pins are cantilevers from one plate; the farthest disc bends them most."
    )
    return (
        sharing,
        "Rigid load law: bodies are rigid, every tooth and pin is an equal spring without a gap, "
        "one side is loaded. Contact deflection, clearances and errors change the sharing.",
        "Contacts are Hertz line contacts over the whole thickness of a disc, without edge stress. "
        "The rigid law knows no friction; contact equilibrium, life and losses have it at teeth "
        "and holes, the motor driving.",
        "Maxima are taken over the whole period, all discs and both senses of torque.",
        pins,
        "The cam bearing carries ring and output-pin forces together, at its greatest load over "
        "the period.",
        "Basic rating life by ISO 281 without the factors for lubrication and cleanliness.",
        "Balance counts the discs with their cam bearings and eccentrics, and balance weights as "
        "drawn, in closed form.",
    )


Source = tuple[str, str]
"""A source, and what this report took from it."""


def sources_used(
    analysis: GearboxAnalysis,
    parts: Sequence[Part] = (),
    checks: Sequence[Check] = (),
    *,
    planetary: bool = False,
) -> tuple[tuple[Source, ...], tuple[Source, ...]]:
    """Literature behind the checks and the comparison, and catalogue rows, as used here.

    Parameters
    ----------
    analysis : GearboxAnalysis
        Its checks tell their sources, and it names materials, bearing, screws and motor.
    parts : sequence of Part
        Of the machine, where they have been weighed.
    checks : sequence of Check
        Besides those of the analysis.
    planetary : bool
        Whether the report compares with one.

    Returns
    -------
    tuple
        Literature and catalogue rows, each sorted by first use.
    """
    used: dict[str, list[str]] = {}
    for check in (*analysis.checks, *checks):
        literature = check.source.partition("; limit: ")[0]
        for part in _parts(literature):
            used.setdefault(part, []).append(check.id)
    for text in PLANETARY_SOURCES if planetary else ():
        used.setdefault(text, []).append("planetary comparison")
    literature_rows = tuple((text, _listed(ids)) for text, ids in used.items())
    return literature_rows, _catalogue(analysis, parts)


def _listed(uses: Sequence[str]) -> str:
    return ", ".join(dict.fromkeys(uses))


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
        (f"{name}: {find_material(name).source}", _listed(uses)) for name, uses in named.items()
    ]
    bearing = analysis.cam_bearing.bearing
    seats = {bearing.designation: ["cam bearing"]}
    for part in parts:
        if part.designation in bearings():
            seats.setdefault(part.designation, []).append(part.name)
    rows += [
        (f"bearing {name}: {find_bearing(name).source}", _listed(uses))
        for name, uses in seats.items()
    ]
    screw = shoulder_screw(reducer.output_pins)
    zone = f"ISO 286-2, zone {pin_zone(reducer.output_pins)}"
    source = zone if screw is None else f"{screw.name}: {screw.source}"
    rows.append((source, "output pins, limits of size"))
    motor = analysis.motor
    rows.append((f"{motor.name}: {motor.source}", "motor checks"))
    return tuple(rows)
