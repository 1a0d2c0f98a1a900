"""The speed at which a motor holds the continuous torque that heats it too much as asked."""

from __future__ import annotations

import math
from collections.abc import Callable

from cqdd_design.design import Requirements
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.looks import BY_HEAT
from cqdd_design.sizing.verified import VerifiedDesign
from cqdd_design.verdict.motor import held_up_to

TRIES = 4
"""Speeds that are tried above one that fits."""
_SHARES = (1.0, 0.9)
"""Of the speed that the nearest design's motor stands with the continuous torque."""
_UP, _NEAR = 1.05, 1.02
"""Factor from a speed that fits to the next, and within which none is tried."""
_DIGITS = 2
RPM = 30.0 / math.pi

_Search = Callable[[Requirements], VerifiedDesign | None]


def less_speed(hunt: Hunt, refusal: SizingInfeasibleError, search: _Search) -> float | None:
    """The input speed (rpm) at which the continuous torque is held for ever, where that is short.

    Tried first is that up to which the motor of the design that came nearest holds it, a little
    less where that does not do, and then up to which that of the design that was found does.

    Parameters
    ----------
    hunt : Hunt
        That was refused.
    search : callable
        For a design of other requirements.
    """
    asked, first = hunt.requirements, refusal.most_speed
    if first is None or not set(refusal.binding) <= BY_HEAT:
        return None
    hunt.say("looking for the speed at which that fits")
    too_much = RPM * asked.held_speed
    for share in _SHARES:
        speed = rounded_down(share * first, _DIGITS)
        found = search(at_speed(asked, speed))
        if found is not None:
            return _faster(asked, found, speed, too_much, search)
        too_much = speed
    return None


def _faster(
    asked: Requirements, found: VerifiedDesign, speed: float, too_much: float, search: _Search
) -> float:
    """A speed (rpm) at which a design is found, and at little more none, in a few searches.

    Parameters
    ----------
    found : VerifiedDesign
        At `speed`; what its motor stands, or a little more, is tried next.
    """
    for _ in range(TRIES):
        if too_much <= _NEAR * speed:
            break
        actuator = found.verdict.evidence.actuator
        holds = 0.0 if actuator is None else held_up_to(actuator, asked)
        ahead = rounded_down(min(max(holds, _UP * speed), math.sqrt(speed * too_much)))
        more = search(at_speed(asked, ahead)) if ahead > speed else None
        if more is None:
            too_much = ahead
        else:
            found, speed = more, ahead
    return speed


def at_speed(asked: Requirements, speed: float) -> Requirements:
    """The requirements with the continuous torque at an input speed, rpm."""
    slower = asked.unchecked_copy({"continuous_speed": speed / RPM})
    slower.model_fields_set.add("continuous_speed")
    return slower
