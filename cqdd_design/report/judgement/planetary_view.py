"""The comparison with the compound planetary: its table, what limits the cycloid, the claims."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cqdd_design.planetary.assembly import MOST_PLANETS, assembles
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.planetary.kinematics import ratio_ring_fixed
from cqdd_design.planetary.rating import MeshRating
from cqdd_design.report.ink.numbers import decimals, significant, with_unit
from cqdd_design.report.judgement.check_rows import printed

#: Every number of planets up to this has a row; past it, those that some answer names.
_ROWS = 8
_MESH = {"sun_planet": "sun and planet", "planet_ring": "planet and ring"}


@dataclass(frozen=True)
class PlanetaryRow:
    """One number of planets: whether it fits and assembles, and its least safeties."""

    planets: int
    fits: bool
    assembles: bool
    cells: tuple[tuple[str, bool], ...]


@dataclass(frozen=True)
class PlanetaryView:
    """What the page shows of a comparison.

    Attributes
    ----------
    summary : tuple of (str, str)
        Name and value.
    headings : tuple of str
        Columns of `rows` after the first three.
    rows : tuple of PlanetaryRow
    cycloid : tuple of (load, part, title, value and limit, torque capacity, holds)
    claims : tuple of (claim, paper, ours, holds, under)
    warnings : tuple of str
    """

    summary: tuple[tuple[str, str], ...]
    headings: tuple[str, ...]
    rows: tuple[PlanetaryRow, ...]
    cycloid: tuple[tuple[str, str, str, str, str, bool], ...]
    claims: tuple[tuple[str, str, str, bool | None, str], ...]
    warnings: tuple[str, ...]


def planetary_view(comparison: PlanetaryComparison) -> PlanetaryView:
    """Arrange a comparison for the page."""
    gears = comparison.gears
    settings = gears.settings
    headings = (
        f"contact, peak (S_H ≥ {settings.least_contact_safety:g})",
        f"bending, peak (S_F ≥ {settings.least_bending_safety:g})",
        f"contact, continuous (S_H ≥ {settings.least_contact_safety:g})",
    )
    rows = []
    needed = {
        comparison.planets,
        comparison.needed_peak_bending,
        comparison.needed_peak_contact,
        comparison.needed_continuous_contact,
    }
    for planets, found in comparison.ratings:
        if planets > _ROWS and planets not in needed:
            continue
        least = (settings.least_contact_safety, settings.least_bending_safety)
        peak = [rating for rating in found if rating.load.name == "peak"]
        steady = [rating for rating in found if rating.load.name == "continuous"]
        rows.append(
            PlanetaryRow(
                planets,
                gears.fits(planets),
                assembles(gears.teeth, planets),
                (
                    _contact(peak, least[0]),
                    _bending(peak, least[1]),
                    _contact(steady, least[0]),
                ),
            )
        )
    return PlanetaryView(
        summary=_summary(comparison),
        headings=headings,
        rows=tuple(rows),
        cycloid=tuple(
            (
                limit.load,
                limit.part,
                limit.title,
                f"{significant(limit.value)} of {with_unit(limit.limit, limit.unit)}",
                with_unit(limit.torque_capacity, "N*m", 3),
                limit.torque_capacity >= limit.torque,
            )
            for limit in sorted(
                comparison.cycloid, key=lambda one: (one.load != "peak", one.torque_capacity)
            )
        ),
        claims=tuple(
            (
                printed(claim.claim),
                printed(claim.paper),
                printed(claim.ours),
                claim.holds,
                printed(claim.under),
            )
            for claim in comparison.claims
        ),
        warnings=tuple(printed(warning) for warning in comparison.warnings),
    )


def _contact(found: Iterable[MeshRating], least: float) -> tuple[str, bool]:
    worst = min(found, key=lambda rating: rating.contact_safety)
    stress = decimals(worst.contact_stress / 1e6, 0)
    text = f"{decimals(worst.contact_safety, 2)} ({stress} MPa, {_MESH[worst.mesh]})"
    return text, worst.contact_safety >= least


def _bending(found: Iterable[MeshRating], least: float) -> tuple[str, bool]:
    worst = min(found, key=lambda rating: rating.bending_safety)
    stress = decimals(worst.root_stress / 1e6, 0)
    text = f"{decimals(worst.bending_safety, 2)} ({stress} MPa, {_MESH[worst.mesh]})"
    return text, worst.bending_safety >= least


def _summary(comparison: PlanetaryComparison) -> tuple[tuple[str, str], ...]:
    gears = comparison.gears
    teeth = gears.teeth

    def needed(number: int | None) -> str:
        if number is None:
            return f"more than {MOST_PLANETS} planets"
        return "1 planet" if number == 1 else f"{number} planets"

    assembling = [str(n) for n in comparison.planets_that_assemble if n <= 12]
    found = [
        ("teeth, sun / planet / planet / ring", str(teeth).replace("/", " / ")),
        ("ratio", significant(ratio_ring_fixed(teeth), 6)),
        (
            "module and face width",
            f"{with_unit(1e3 * gears.module, 'mm')}, {with_unit(1e3 * gears.face_width, 'mm')}",
        ),
        ("centre distance", with_unit(1e3 * gears.centre_distance, "mm")),
        ("material", comparison.material.label),
        ("load factors", printed(gears.settings.label)),
        ("planets that fit side by side", f"at most {comparison.planets_that_fit}"),
        ("planets that assemble, up to 12", ", ".join(assembling)),
        ("needed for bending at peak torque", needed(comparison.needed_peak_bending)),
        ("needed for contact at peak torque", needed(comparison.needed_peak_contact)),
        (
            "needed for contact at continuous torque",
            needed(comparison.needed_continuous_contact),
        ),
    ]
    outer = with_unit(1e3 * gears.envelope.outer_diameter, "mm")
    bore = comparison.bore
    if bore is not None:
        word = "fits" if gears.envelope.fits(bore) else "does not fit"
        found.append(
            (
                "gear set, outside diameter",
                f"{outer}, {word} the {with_unit(1e3 * bore, 'mm')} bore",
            )
        )
    else:
        found.append(("gear set, outside diameter", outer))
    return tuple(found)
