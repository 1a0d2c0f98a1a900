"""Checks of how warm parts get and of what that leaves of their clearances."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cqdd_design.gearbox.checks.allowables import BINDING_OVERLAP
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.results import Check

BURNT = 300.0
"""Of a part, deg C: beyond it windings, grease and adhesives are no more, and what a network of
conductances says is a measure of the heat that is too much."""


class WarmPart(NamedTuple):
    """A part with its temperature and the most it bears, deg C."""

    name: str
    temperature: float
    most: float

    def share(self, ambient: float) -> float:
        """Of the rise above the air (deg C) that it bears."""
        return (self.temperature - ambient) / max(self.most - ambient, 1e-9)


class Tightness(NamedTuple):
    """Overlap that warmth adds in one state, m, and the state in words."""

    overlap: float
    state: str


def rise_check(parts: tuple[WarmPart, ...], ambient: float, heat: float, as_drawn: float) -> Check:
    """Check ``THERMAL-RISE``.

    Parameters
    ----------
    parts : tuple of WarmPart
        Those that have a limit.
    ambient, heat, as_drawn : float
        deg C; all that parts lose at these temperatures, and before they are warm, W.
    """
    worst = max(parts, key=lambda part: part.share(ambient))
    told = ", ".join(f"{one.name} {one.temperature:.0f} of {one.most:g} degC" for one in parts)
    burnt = ""
    if max(one.temperature for one in parts) > BURNT:
        burnt = f"; beyond {BURNT:g} degC that is how much heat is too much, not how warm parts get"
    return build_check(
        "THERMAL-RISE",
        worst.temperature,
        worst.most,
        f"{told} in air of {ambient:g} degC; {heat:.0f} W in all, {as_drawn:.0f} before parts "
        f"are warm{burnt}",
        cooling_remedy(),
    )


def cooling_remedy(enough: float | None = None, *, duty: bool = False) -> str:
    """What cools parts: a resistance (K/W) that is enough, where it is looked for, 0 where none is.

    Under a duty its torques and speeds are what heats.

    What warm parts lose is known only once they are, mostly less than as drawn.
    """
    told = "" if not enough else f": {rounded_down(enough):g} K/W from winding to air are enough"
    cool = f"cool it{told} (state what cooling reaches as drive.thermal_resistance), or "
    if enough == 0.0:
        cool = "no cooling is enough: "
    less = (
        "torques or speeds of the duty"
        if duty
        else "requirements.continuous_torque, or continuous_speed (input_speed where that is not "
        "stated)"
    )
    return f"{cool}lower {less}, or friction"


def clearance_check(states: tuple[Tightness, ...], remedy: Callable[[], str]) -> Check:
    """Check ``THERMAL-CLEARANCE`` over states of the parts.

    Parameters
    ----------
    remedy : callable
        What to do where they overlap; asked for then alone.
    """
    worst = max(states, key=lambda one: one.overlap)
    overlap = 1e6 * worst.overlap
    return build_check(
        "THERMAL-CLEARANCE",
        overlap,
        BINDING_OVERLAP,
        f"{overlap:.2f} um more than as drawn: {worst.state}",
        remedy() if overlap > BINDING_OVERLAP else "",
    )


def clearance_remedy(more: str) -> str:
    """What frees warm parts: more clearance in words, and what makes it needless."""
    return (
        f"{more}, make the carrier (carrier.material) of what the discs are made of, or cool the "
        "parts"
    )
