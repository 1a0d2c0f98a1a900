"""Torques to try where those that were asked for do not fit."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.looks import BY_HEAT

ALONE = {PEAK: {"MOTOR-PEAK"}, CONTINUOUS: BY_HEAT}
"""Lines that less of one torque alone helps."""
_NEAR = 1.02
"""Factor between a torque that fits and one that does not within which none is tried."""
_DIGITS, _HELD = 2, 0.97
"""Of torques that are told; share of what a motor was found to hold for ever that is tried."""


def short_alone(refusal: InfeasibleError | None) -> set[str]:
    """The torque of which less by itself would be enough, if there is one."""
    if not isinstance(refusal, SizingInfeasibleError) or not refusal.binding:
        return set()
    return {torque for torque, lines in ALONE.items() if set(refusal.binding) <= lines}


def share_borne(refusal: InfeasibleError | None, tried: Requirements) -> float:
    """About what share of torques that were tried is borne, by a refusal's estimate; else 1."""
    if not isinstance(refusal, SizingInfeasibleError) or not refusal.estimate:
        return 1.0
    return (refusal.most_torque or tried.peak_torque) / tried.peak_torque


def between(fits: float, too_much: float) -> float:
    """A torque between one that fits and one that is too much; the former where they are close."""
    if too_much <= _NEAR * fits:
        return fits
    return max(rounded_down(math.sqrt(fits * too_much)), fits)


def what_the_judged_has(
    asked: Requirements, refusal: SizingInfeasibleError
) -> Iterator[dict[str, float]]:
    """Torques that the motor was found to reach or hold in the design that was judged.

    With any other gearbox it may do less.
    """
    most, lasting = refusal.most_torque, refusal.most_lasting_torque
    if most is not None and set(refusal.binding) == {"MOTOR-PEAK"}:
        peak = rounded_down(most, _DIGITS)
        if asked.continuous_torque <= peak < asked.peak_torque:
            yield {PEAK: peak}
    if lasting is not None and set(refusal.binding) <= ALONE[CONTINUOUS]:
        held = rounded_down(_HELD * lasting, _DIGITS)
        if held < asked.continuous_torque:
            yield {CONTINUOUS: held}
