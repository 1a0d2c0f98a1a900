"""Rule, reason and source of what toleranced gearboxes are judged by."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import DRAWN, HOUSE, CheckGuide

ROWS = (
    CheckGuide(
        "YIELD",
        "Toleranced gearboxes that meet every line and do not bind",
        "%",
        "min",
        f"share of {limits.YIELD_SAMPLES} gearboxes >= requirements.yield",
        "Parts are as good as their tolerances. A gearbox drawn from them counts where it turns "
        f"without load at less than {limits.BINDING_SHARE:.0%} of the continuous torque, at 20 "
        "degC and in the state of warmth or cold that leaves least clearance, where its "
        "greatest pressure at the ring and cam load at the peak torque stay within the limits of "
        "perfect parts, and where at the continuous torque they exceed those of perfect parts by "
        "no more than these have in reserve over the life. Pins in their holes are judged with "
        "perfect parts alone.",
        f"{DRAWN}; {HOUSE}",
        basis=DRAWN,
    ),
)
