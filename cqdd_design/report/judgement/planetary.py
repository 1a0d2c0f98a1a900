"""The comparison with the compound planetary: its table, what limits the cycloid, the claims."""

from __future__ import annotations

from collections.abc import Iterable

from cqdd_design.planetary.assembly import MOST_PLANETS, assembles
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.planetary.cycloid import CycloidLimit
from cqdd_design.planetary.kinematics import ratio_ring_fixed
from cqdd_design.planetary.rating import MeshRating
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.report.ink.numbers import decimals, millimetres, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.judgement.check_rows import printed
from cqdd_design.terms import term

#: Every number of planets up to this has a row; past it, those that some answer names.
_ROWS = 8
_ASSEMBLING = 12
"""Numbers of planets up to which those that assemble are listed."""
_MESH = {"sun_planet": "sun and planet", "planet_ring": "planet and ring"}


def planetary_view(comparison: PlanetaryComparison, *, limits: bool = True) -> Values:
    """Answers, ratings by number of planets, what limits the cycloid, and the paper's claims.

    Without `limits` the cycloid's are left out, where they stand elsewhere on the page.
    """
    settings = comparison.gears.settings
    contact, bending = settings.least_contact_safety, settings.least_bending_safety
    return {
        "summary": _summary(comparison),
        "headings": (
            f"contact, peak (S_H ≥ {contact:g})",
            f"bending, peak (S_F ≥ {bending:g})",
            f"contact, continuous (S_H ≥ {contact:g})",
        ),
        "rows": _rows(comparison),
        "cycloid": limit_rows(comparison.cycloid) if limits else (),
        "cycloid_models": limit_models(comparison.cycloid),
        "claims": tuple(
            (
                printed(claim.claim),
                printed(claim.paper),
                printed(claim.ours),
                claim.holds,
                claim.verdict,
                printed(claim.under),
            )
            for claim in comparison.claims
        ),
        "warnings": tuple(printed(warning) for warning in comparison.warnings),
    }


def limit_rows(limits: Iterable[CycloidLimit]) -> tuple[tuple[object, ...], ...]:
    """Load, part, what is compared, how far it is reached, and the torque at its limit."""
    return tuple(
        (
            limit.load,
            limit.part,
            limit.title,
            f"{significant(limit.value)} of {with_unit(limit.limit, limit.unit)}",
            (_capacity(limit), limit.holds),
        )
        for limit in sorted(limits, key=lambda one: (one.load != "peak", one.torque_capacity))
    )


def _capacity(limit: CycloidLimit) -> str:
    told = with_unit(limit.torque_capacity, "N*m", 3)
    return told if limit.reached else f"{told}, where contact ends: not reached"


def limit_models(limits: Iterable[CycloidLimit]) -> str:
    """What those torques rest on."""
    ranked = sorted(limits, key=lambda one: (one.load != "peak", one.torque_capacity))
    return " and ".join(dict.fromkeys(limit.model for limit in ranked))


def _other_settings(settings: RatingSettings) -> str:
    """What `label`, shifts and tip do not say."""
    said = {"shifts", "ring_tip_diameter", "crowned", "accuracy_class", "application_factor"}
    said |= {"mesh_load_table", "dynamic_factor", "face_load_factor", "transverse_load_factor"}
    rows = [(name, value) for name, value, _ in settings.rows() if name not in said]
    return ", ".join(f"{term(name).words} {value}" for name, value in rows)


def _rows(comparison: PlanetaryComparison) -> tuple[Values, ...]:
    gears, settings = comparison.gears, comparison.gears.settings
    contact, bending = settings.least_contact_safety, settings.least_bending_safety
    needed = {
        comparison.planets,
        comparison.needed_peak_bending,
        comparison.needed_peak_contact,
        comparison.needed_continuous_contact,
    }
    rows = []
    for planets, found in comparison.ratings:
        if planets > _ROWS and planets not in needed:
            continue
        peak = [rating for rating in found if rating.load.name == "peak"]
        steady = [rating for rating in found if rating.load.name == "continuous"]
        cells = (_contact(peak, contact), _bending(peak, bending), _contact(steady, contact))
        row = {"planets": planets, "fits": gears.fits(planets), "cells": cells}
        rows.append(row | {"assembles": assembles(gears.teeth, planets)})
    return tuple(rows)


def _contact(found: Iterable[MeshRating], least: float) -> tuple[str, bool]:
    worst = min(found, key=lambda rating: rating.contact_safety)
    return _cell(worst, worst.contact_safety, worst.contact_stress, least)


def _bending(found: Iterable[MeshRating], least: float) -> tuple[str, bool]:
    worst = min(found, key=lambda rating: rating.bending_safety)
    return _cell(worst, worst.bending_safety, worst.root_stress, least)


def _cell(worst: MeshRating, safety: float, stress: float, least: float) -> tuple[str, bool]:
    shown = f"{decimals(stress / 1e6, 0)} MPa, {_MESH[worst.mesh]}"
    return f"{decimals(safety, 2)} ({shown})", safety >= least


def _summary(comparison: PlanetaryComparison) -> tuple[tuple[str, str], ...]:
    gears, teeth, bore = comparison.gears, comparison.gears.teeth, comparison.bore
    envelope = gears.envelope

    def needed(number: int | None) -> str:
        if number is None:
            return f"more than {MOST_PLANETS} planets"
        return "1 planet" if number == 1 else f"{number} planets"

    assembling = [str(n) for n in comparison.planets_that_assemble if n <= _ASSEMBLING]
    outside = millimetres(envelope.outer_diameter, 4)
    if bore is not None:
        word = "fits" if envelope.fits(bore) else "does not fit"
        outside += f", {word} the {millimetres(bore, 4)} bore"
    size = f"{millimetres(gears.module, 4)}, {millimetres(gears.face_width, 4)}"
    steady = needed(comparison.needed_continuous_contact)
    return (
        ("teeth, sun / planet / planet / ring", str(teeth).replace("/", " / ")),
        ("ratio", significant(ratio_ring_fixed(teeth), 6)),
        ("module and face width", size),
        ("centre distance", millimetres(gears.centre_distance, 4)),
        ("material", comparison.material.label),
        ("load factors", printed(gears.settings.label)),
        ("profile shifts", printed(gears.shifts_text)),
        ("tip diameter of the ring", millimetres(gears.ring_tip_diameter, 5)),
        ("other settings", printed(_other_settings(gears.settings))),
        ("planets that fit side by side", f"at most {comparison.planets_that_fit}"),
        (f"planets that assemble, up to {_ASSEMBLING}", ", ".join(assembling)),
        ("needed for bending at peak torque", needed(comparison.needed_peak_bending)),
        ("needed for contact at peak torque", needed(comparison.needed_peak_contact)),
        ("needed for contact at continuous torque", steady),
        ("gear set, outside diameter", outside),
    )
