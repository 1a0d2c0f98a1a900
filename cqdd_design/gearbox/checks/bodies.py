"""Checks of the stress in discs and ring, for those who have had it computed."""

from __future__ import annotations

from typing import NamedTuple

from cqdd_design.catalog.materials import DESIGN_STRAIN, Material, find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.bodies.strength import LIGAMENTS, BodyStrength, Swing
from cqdd_design.gearbox.bodies.stress import Region
from cqdd_design.gearbox.checks.allowables import Allowable, edge_limit_fatigue, edge_limit_peak
from cqdd_design.gearbox.checks.equilibrium import NO_CURES, Cures
from cqdd_design.gearbox.checks.remedies import lower_peak, lower_shares, lower_to
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.results import Check

_MEGA = 1e6


class _Part(NamedTuple):
    """What a pair of checks is of, its regions, and the first thing to do where it is too weak."""

    name: str
    regions: tuple[Region, ...]
    first: str


_PARTS = (
    _Part("LIGAMENT", LIGAMENTS, "widen the ligament, or "),
    _Part("ROOT", ("root",), ""),
    _Part("RING", ("ring",), "raise ring.outer_diameter, or "),
)


def body_checks(
    design: Design, strength: BodyStrength, cures: Cures = NO_CURES
) -> tuple[Check, ...]:
    """Stress against yield at the peak torque, and over a turn against fatigue; creep of plastics.

    Parameters
    ----------
    strength : BodyStrength
        At the torques of the requirements.
    cures : mapping
        What makes lines that fail hold, by check: peak torques, N m, for ``-STRESS``, else shares
        of the continuous torque or the duty's. Remedies of others name none.
    """
    found = [
        check
        for part in _PARTS
        for check in (
            _static(part, design, strength, cures),
            _fatigue(part, design, strength, cures),
        )
    ]
    return (*found, *_creep(design, strength, cures))


def _creep(design: Design, strength: BodyStrength, cures: Cures) -> tuple[Check, ...]:
    """Strain of discs and ring of plastic that the continuous torque holds; none of metal.

    Without a modulus of creep the strain that the load makes at once still tells what is too much.
    """
    rows = []
    for part, regions in (("disc", (*LIGAMENTS, "root")), ("ring", ("ring",))):
        material = _material("RING" if part == "ring" else "ROOT", design)
        cycles = [one for one in strength.swings if one.region in regions]
        if material.is_plastic and cycles:
            stress = max(max(abs(one.low), abs(one.high)) for one in cycles)
            modulus = material.creep_modulus or material.youngs_modulus
            rows.append((stress / modulus, stress, material, part))
    if not rows:
        return ()
    # What is not known decides, unless something is known to be too much.
    strain, stress, material, part = max(
        rows, key=lambda row: (row[0] > DESIGN_STRAIN, row[2].creep_modulus is None, row[0])
    )
    known = material.creep_modulus is not None or strain > DESIGN_STRAIN
    held = "after 1000 h at 23 degC" if material.creep_modulus else "at once"
    told = (
        f"{stress / _MEGA:.1f} MPa in the {part} of {material.name} {_lasting(design)}: "
        f"{100.0 * strain:.2g} % {held}"
    )
    if material.creep_modulus is None:
        told += "; its creep is not known, of printed plastics least of all"
    less = ""
    # Of a plastic whose creep is not known a lower torque leaves that unknown.
    if material.creep_modulus is not None:
        less = f"{_lower_lasting('PLASTIC-CREEP', design, cures)}, "
    return (
        build_check(
            "PLASTIC-CREEP",
            100.0 * strain if known else None,
            100.0 * DESIGN_STRAIN,
            told,
            f"hold no torque for long, {less}or choose a plastic whose creep the catalogue has "
            "(see cqdd-design catalog materials), or a metal",
            basis=material.creep_source or f"modulus of {material.name}, without its creep",
        ),
    )


def _static(part: _Part, design: Design, strength: BodyStrength, cures: Cures) -> Check:
    peak, material = strength.peak(*part.regions), _material(part.name, design)
    allowed, stress = edge_limit_peak(material), abs(peak.stress)
    first = _at_columns(peak.region) or part.first
    kind = "tension" if peak.stress > 0.0 else "compression"
    where = "" if part.name in {"ROOT", "RING"} else f" ({peak.region})"
    return build_check(
        f"{part.name}-STRESS",
        stress / _MEGA,
        _known(allowed),
        f"{stress / _MEGA:.1f} MPa in {kind} at disc {peak.disc + 1}{where}, "
        f"b {design.reducer.disc_thickness * 1e3:g} mm, at {peak.torque:g} N*m",
        _remedy(first, allowed, _lower_peak(f"{part.name}-STRESS", design, cures)),
        basis=allowed.basis,
    )


def _fatigue(part: _Part, design: Design, strength: BodyStrength, cures: Cures) -> Check:
    swing, material = strength.swing(*part.regions), _material(part.name, design)
    allowed, stress = edge_limit_fatigue(material), swing.reversed_amplitude
    first = _at_columns(swing.region) or part.first
    return build_check(
        f"{part.name}-FATIGUE",
        stress / _MEGA,
        _known(allowed),
        _cycle_words(swing, material, _lasting(design)),
        _remedy(first, allowed, _lower_lasting(f"{part.name}-FATIGUE", design, cures)),
        basis=allowed.basis,
    )


def _known(allowed: Allowable) -> float | None:
    """A limit in MPa; None where the catalogue supports none."""
    return allowed.value / _MEGA if allowed.value > 0.0 else None


def _cycle_words(swing: Swing, material: Material, at: str) -> str:
    ultimate = material.ultimate_strength
    strength = "" if ultimate is None else f", S_u {ultimate / _MEGA:.0f} MPa"
    where = f" ({swing.region})" if _at_columns(swing.region) else ""
    return (
        f"{swing.low / _MEGA:.1f} to {swing.high / _MEGA:.1f} MPa a turn{where}{strength}: "
        f"{swing.reversed_amplitude / _MEGA:.1f} MPa reversed, {at}"
    )


def _at_columns(region: Region) -> str:
    """What lowers a stress beside the columns' holes; nothing elsewhere."""
    return "lower carrier.column_diameter, or " if region.startswith("column") else ""


def _material(part: str, design: Design) -> Material:
    reducer = design.reducer
    return find_material(reducer.ring_material if part == "RING" else reducer.disc_material)


def _remedy(first: str, allowed: Allowable, lower: str) -> str:
    """What lowers a stress; how thick a disc, which shares otherwise, would have to be is open."""
    if allowed.value <= 0.0:
        return "choose a material whose strength the catalogue has"
    return f"{first}raise disc_thickness, or {lower}"


def _lasting(design: Design) -> str:
    """The torque of cycles, in words."""
    asked = design.requirements
    whose = ", the greatest of the duty" if asked.load_cases else ""
    return f"at {asked.lasting_torque:g} N*m{whose}"


def _lower_peak(check_id: str, design: Design, cures: Cures) -> str:
    """How far to lower the peak torque, in words."""
    if check_id not in cures:
        return "lower the peak torque"
    return lower_peak(cures[check_id], design.requirements.continuous_torque, "peak torque")


def _lower_lasting(check_id: str, design: Design, cures: Cures) -> str:
    """How far to lower the torques that last, in words."""
    asked, share = design.requirements, cures.get(check_id)
    if asked.load_cases:
        return lower_shares(share)
    if share is None:
        return "lower the continuous torque"
    return lower_to(share * asked.continuous_torque, "continuous torque")
