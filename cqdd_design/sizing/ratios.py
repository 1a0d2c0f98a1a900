"""The nearest ratio that fits, where a motor falls short through any gearbox of the one asked."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from cqdd_design.design import Requirements
from cqdd_design.design.requirements import LEAST_RATIO, MOST_RATIO
from cqdd_design.sizing.able import EFFICIENCY
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.motor_reach import MotorShortError

TRIES = 2
"""Ratios that are tried where the rotor is felt too much."""


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


def other_ratio(hunt: Hunt, refusal: MotorShortError, search: _Search) -> OtherRatio:
    """The least larger ratio at which a motor is strong enough, or the greatest of a light rotor.

    Parameters
    ----------
    search : callable
        Whether a design is found at a ratio, and what it falls short of.
    """
    asked = hunt.requirements
    if refusal.needed:
        hunt.say("looking for the least ratio that fits")
        return _least(asked, refusal, search)
    if refusal.most_ratio is not None:
        hunt.say("looking for the greatest ratio that fits")
        return _greatest(refusal.most_ratio, search)
    return OtherRatio(None, asked.ratio, ())


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
