"""Check of plastics that rub at output pins."""

from __future__ import annotations

from cqdd_design.gearbox.checks.remedies import torque_words
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.film.plastics import RubbingPlastic
from cqdd_design.results import Check

_MEGA = 1e6


def rubbing_check(found: tuple[RubbingPlastic, ...], torque: float) -> Check:
    """Check ``PIN-RUBBING`` of one plastic or more at a torque (N m).

    One that exceeds its limit is told before one whose limit is not known.
    """
    worst = max(found, key=_used)
    told = (
        f"{worst.material}: {worst.pressure / _MEGA:.3g} MPa x {worst.speed:.3g} m/s at "
        f"{torque:g} N*m"
    )
    if worst.limit is None:
        return build_check(
            "PIN-RUBBING",
            worst.value / _MEGA,
            None,
            f"{told}; the catalogue has no limit of it",
            "name a plastic that has one (`cqdd-design catalog rubbing`), or put needles on the "
            'pins (output_pins.sleeve = "needle")',
        )
    share = worst.limit / max(worst.value, 1e-12)
    return build_check(
        "PIN-RUBBING",
        worst.value / _MEGA,
        worst.limit / _MEGA,
        f"{told}; dry on steel",
        f"lower requirements.continuous_torque to {torque_words(torque * share)}, or the speed as "
        "much; make discs thicker or pins more; or put needles on the pins "
        '(output_pins.sleeve = "needle")',
        basis=worst.source,
    )


def _used(one: RubbingPlastic) -> float:
    """Share of the limit; that of an unknown one between what passes and what fails."""
    return 1.0 if one.limit is None else one.value / one.limit
