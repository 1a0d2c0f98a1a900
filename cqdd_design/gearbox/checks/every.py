"""All checks of a gearbox, chapter by chapter."""

from __future__ import annotations

from cqdd_design.gearbox.checks.allowables import HARDENED_HRC
from cqdd_design.gearbox.checks.drive import drive_checks
from cqdd_design.gearbox.checks.loads import load_checks
from cqdd_design.gearbox.checks.shape import shape_checks
from cqdd_design.gearbox.checks.state import GearboxState
from cqdd_design.results import Check


def gearbox_checks(state: GearboxState) -> tuple[tuple[Check, ...], tuple[str, ...]]:
    """Every check of the design in `state`, and sentences about those that could not be made.

    Returns
    -------
    tuple
        Checks in the order shape, loads, drive; warnings.
    """
    drive, warnings = drive_checks(state)
    return (
        (*shape_checks(state), *load_checks(state), *drive),
        (*_valley_warning(state), *_raceway_warning(state), *warnings),
    )


def _valley_warning(state: GearboxState) -> tuple[str, ...]:
    if state.geometry.has_concave_valleys:
        return ()
    return (
        "the disc has no concave valley (eccentricity too small for its lobes), so it has no "
        "least concave radius and its wire was not checked.",
    )


def _raceway_warning(state: GearboxState) -> tuple[str, ...]:
    """Needles run on the eccentric itself, whose material the design file does not name."""
    bearing = state.cam_bearing.bearing
    if bearing.kind not in {"needle", "needle cage"}:
        return ()
    return (
        f"cam bearing '{bearing.designation}' runs on the eccentric itself: harden the shaft to "
        f"{HARDENED_HRC:g} HRC and grind it, or the ratings do not hold.",
    )
