"""Check of plastics that rub at output pins."""

from __future__ import annotations

from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.film.plastics import RubbingPlastic
from cqdd_design.results import Check

_MEGA = 1e6


_NEEDLES = 'or put needles on the pins (output_pins.sleeve = "needle", in a sleeve_diameter)'


def rubbing_check(
    found: tuple[RubbingPlastic, ...], torque: float, lower: str = "lower the torque or the speed"
) -> Check:
    """Check ``PIN-RUBBING`` of one plastic or more at a torque (N m).

    One that exceeds its limit is told before one whose limit is not known.

    Parameters
    ----------
    lower : str
        How far to lower the torque, in words.
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
            f"name a plastic that has one (`cqdd-design catalog rubbing`), {_NEEDLES}",
        )
    return build_check(
        "PIN-RUBBING",
        worst.value / _MEGA,
        worst.limit / _MEGA,
        f"{told}; dry on steel",
        f"{lower}; make discs thicker or pins more; {_NEEDLES}",
        basis=worst.source,
    )


def _used(one: RubbingPlastic) -> float:
    """Share of the limit; that of an unknown one between what passes and what fails."""
    return 1.0 if one.limit is None else one.value / one.limit
