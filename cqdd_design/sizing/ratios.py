"""The nearest ratio that fits, where a motor falls short or gets too hot with the one asked."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from cqdd_design.design import Requirements
from cqdd_design.design.requirements import LEAST_RATIO, MOST_RATIO
from cqdd_design.machine import Machine
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.temperatures import undisturbed_temperatures
from cqdd_design.sizing.able import EFFICIENCY
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.looks import BY_HEAT
from cqdd_design.sizing.motor_reach import MotorShortError

TRIES = 2
"""Ratios that are tried where the rotor is felt too much, or the winding gets too hot."""
_FARTHEST, _FARTHER = 2.0, 1.2
"""Over the ratio that is asked for, of those that are tried for heat's sake; and from one to the
next."""


class OtherRatio(NamedTuple):
    """The nearest ratio that fits, if any was found.

    Attributes
    ----------
    tried : int
        The first.
    short : tuple of str
        Lines that it falls short of, where none fits.
    """

    ratio: int | None
    tried: int
    short: tuple[str, ...]


_Search = Callable[[int], tuple[bool, tuple[str, ...]]]


def cool_ratio(machine: Machine) -> int:
    """About the least ratio at which parts stay cool enough, by less current in the winding alone.

    At the same torque of the output that heats it by the inverse square of the ratio, while the
    gearbox loses about as much. 0 where other heat alone is too much, or none is known.
    """
    found = undisturbed_temperatures(machine.rigid)
    if found is None:
        return 0
    heat = found.duty.heat.at(found.steady)
    winding = float(heat[NODES.index("winding")] / heat.sum())
    left = 1.0 / found.heat_share - (1.0 - winding)
    return math.ceil(machine.design.reducer.ratio * math.sqrt(winding / left)) if left > 0.0 else 0


def other_ratio(hunt: Hunt, refusal: SizingInfeasibleError, search: _Search) -> OtherRatio:
    """A larger ratio that fits, or the greatest of a light rotor.

    The least at which a motor is strong enough; where it gets too hot, one of those at which its
    winding alone would not.

    Parameters
    ----------
    search : callable
        Whether a design is found at a ratio, and what it falls short of.
    """
    asked = hunt.requirements
    if not isinstance(refusal, MotorShortError):
        return _cooler(hunt, refusal.cool_ratio, search)
    if refusal.needed:
        hunt.say("looking for the least ratio that fits")
        return _least(asked, refusal, search)
    if refusal.most_ratio is not None:
        hunt.say("looking for the greatest ratio that fits")
        return _greatest(refusal.most_ratio, search)
    return OtherRatio(None, asked.ratio, ())


def _cooler(hunt: Hunt, ratio: int, search: _Search) -> OtherRatio:
    """Up from where the winding would be cool enough by itself, while heat is what is short."""
    asked = hunt.requirements.ratio
    most = min(_FARTHEST * asked, MOST_RATIO)
    first = max(ratio, asked + 1)
    short: tuple[str, ...] = ()
    if not ratio or first > most:
        return OtherRatio(None, asked, ())
    hunt.say("looking for a ratio that fits")
    tried = first
    for _ in range(TRIES):
        fits, short = search(tried)
        if fits:
            return OtherRatio(tried, first, ())
        tried = math.ceil(_FARTHER * tried)
        if tried > most or not BY_HEAT & set(short):
            break
    return OtherRatio(None, first, short)


def _least(asked: Requirements, refusal: MotorShortError, search: _Search) -> OtherRatio:
    """Of a motor that is too weak: down from where it surely is strong enough."""
    usual = math.ceil(refusal.needed / (EFFICIENCY * refusal.torque))
    first = min(max(usual, asked.ratio + 1), MOST_RATIO)
    found = None
    for ratio in range(first, asked.ratio, -1):
        fits, short = search(ratio)
        if not fits:
            return OtherRatio(found, first, () if found else short)
        found = ratio
    return OtherRatio(found, first, ())


def _greatest(most: int, search: _Search) -> OtherRatio:
    """Down from where the rotor by itself is light enough; the gearbox may take the rest."""
    first: tuple[str, ...] = ()
    for ratio in range(most, max(most - TRIES, LEAST_RATIO - 1), -1):
        fits, short = search(ratio)
        if fits:
            return OtherRatio(ratio, most, ())
        first = first or short
    return OtherRatio(None, most, first)
