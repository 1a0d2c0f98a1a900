"""What a refusal names, moved as near to what was asked as whoever asks for that is served.

The ways out are found by searches for any design. Whoever asks is searched for the best first,
which goes by other designs and may come by one for a little more.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Generic, NamedTuple, TypeVar

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.environment import give_memory_back
from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.hunt import Progress
from cqdd_design.sizing.looser import Figures, unit_of
from cqdd_design.sizing.nearest import size_or_nearest, with_length
from cqdd_design.sizing.slower import RPM, at_speed
from cqdd_design.sizing.verified import VerifiedDesign, size_to_verdict
from cqdd_design.sizing.ways import Torques, Ways, WaysOutError

NEARER = 0.02
"""Share of a requirement by which it is moved."""
STEPS = 5
"""Of it at most: each costs a search."""
_ALIKE = 1e-3
"""Share of a torque or a length within which a search is the same: for 4 % more than was in vain a
design was found once, and for 0.3 % less."""
_DIGITS = 6

Design = TypeVar("Design")
Told = Mapping[str, float]
"""Requirements by key, each in the unit that it is told in."""
_Search = Callable[[Requirements], VerifiedDesign | None]
_MM = 1e-3
_SPACE = ("outer_diameter", "length")


class Nearest(NamedTuple, Generic[Design]):
    """The last requirements that fit, and the design that was found for them by moving there."""

    told: Told
    found: Design | None


def size_or_refuse(
    requirements: Requirements,
    progress: Progress = lambda _: None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
    goal: Goal = "mass",
) -> VerifiedDesign:
    """As :func:`.nearest.size_or_nearest`; with what is 2 % nearer than told, nothing is found.

    Unless that goes on for longer than is worth while.
    """
    try:
        return size_or_nearest(requirements, progress, motor=motor, ambient=ambient, goal=goal)
    except WaysOutError as refusal:
        ways = refusal.ways
    to_verdict = partial(size_to_verdict, motor=motor, ambient=ambient, goal=goal)

    def search(asked: Requirements) -> VerifiedDesign | None:
        in_vain = any(_alike(asked, other) for other in ways.in_vain)
        try:
            return to_verdict(asked, best_alone=True) if in_vain else to_verdict(asked)
        except InfeasibleError:
            return None
        finally:
            give_memory_back()

    if ways.words:
        progress(f"What fits at least: {', or '.join(ways.words)}.")
        progress("looking whether anything a little nearer fits")
    raise no_nearer(ways, search).told()


def _alike(asked: Requirements, other: Requirements) -> bool:
    """Whether torques and space are those of others, next to nothing aside, and all else equal."""
    keys = (PEAK, CONTINUOUS, *_SPACE)
    near = all(
        math.isclose(getattr(asked, key), getattr(other, key), rel_tol=_ALIKE) for key in keys
    )
    return near and asked.unchecked_copy({key: getattr(other, key) for key in keys}) == other


def no_nearer(ways: Ways, search: _Search) -> Ways:
    """Requirements that fit, so near to what was asked that none 2 % nearer is found to.

    Parameters
    ----------
    search : callable
        For the best design of other requirements.
    """
    return replace(
        ways,
        torques=_torques(ways, search),
        speed=_speed(ways, search),
        figures=_figures(ways, search),
        ratio=_ratio(ways, search),
        space={key: _length(ways, key, search) for key in ways.space},
    )


def moved(told: Told, asked: Told, search: Callable[[Told], Design | None]) -> Nearest[Design]:
    """Requirements that fit, moved towards what was asked, together and never beyond.

    Parameters
    ----------
    told, asked : mapping of str to float
        That fit, and that did not, in the same units.
    search : callable
        For a design of such requirements.

    Examples
    --------
    >>> moved({"length": 20.0}, {"length": 18.0}, lambda own: own["length"] > 19.5 or None)
    Nearest(told={'length': 19.6}, found=True)
    """
    found = None
    for _ in range(STEPS):
        ahead = {key: _nearer(value, asked[key]) for key, value in told.items()}
        if all(ahead[key] == asked[key] for key in ahead):
            break
        more = search(ahead)
        if more is None:
            break
        told, found = ahead, more
    return Nearest(told, found)


def _nearer(value: float, asked: float) -> float:
    """With as many digits as are told: what is told is what was searched for."""
    if value < asked:
        return min(float(f"{value * (1.0 + NEARER):.{_DIGITS}g}"), asked)
    return max(float(f"{value * (1.0 - NEARER):.{_DIGITS}g}"), asked)


def _torques(ways: Ways, search: _Search) -> Torques | None:
    """Those that were stated; what goes with them is what is found."""
    asked, fits = ways.asked, ways.torques
    if fits is None:
        return None
    both = {PEAK: fits.peak, CONTINUOUS: fits.lasting}
    told = {key: both[key] for key in both if key not in asked.derived}
    limits = {key: getattr(asked, key) for key in told}
    found = moved(told, limits, lambda own: search(asked.unchecked_copy(own))).found
    return fits if found is None else Torques.of(found)


def _speed(ways: Ways, search: _Search) -> float | None:
    if ways.speed is None:
        return None
    told, limit = {"rpm": ways.speed}, {"rpm": RPM * ways.asked.held_speed}
    return moved(told, limit, lambda own: search(at_speed(ways.asked, own["rpm"]))).told["rpm"]


def _figures(ways: Ways, search: _Search) -> Figures:
    asked, units = ways.asked, {key: unit_of(key) for key in ways.figures}
    told = {key: value / units[key] for key, value in ways.figures.items()}
    limits = {key: getattr(asked, key) / units[key] for key in told}

    def stated(own: Told) -> Figures:
        return {key: value * units[key] for key, value in own.items()}

    return stated(moved(told, limits, lambda own: search(asked.unchecked_copy(stated(own)))).told)


def _ratio(ways: Ways, search: _Search) -> int | None:
    fits, asked = ways.ratio, ways.asked.ratio
    if fits is None:
        return None
    step = 1 if fits < asked else -1
    for ratio in range(fits + step, asked, step):
        if search(ways.asked.unchecked_copy({"ratio": ratio})) is None:
            break
        fits = ratio
    return fits


def _length(ways: Ways, key: str, search: _Search) -> float:
    asked = ways.asked
    told, limit = {key: ways.space[key] / _MM}, {key: getattr(asked, key) / _MM}
    nearest = moved(told, limit, lambda own: search(with_length(asked, key, own[key] * _MM)))
    return nearest.told[key] * _MM
