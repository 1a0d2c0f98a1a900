"""Where no design has the reserve that part errors ask for, and some were nearly sound.

What part errors ask for is read off a quantile of few gearboxes. It may be more than any design
has, and more than one needs that is stronger, or whose errors are shared by more pins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from cqdd_design.errors import ContactError, DesignError, InfeasibleError
from cqdd_design.machine import resolve
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.agreement import Strongest
from cqdd_design.sizing.bearable import strong_kinds
from cqdd_design.sizing.eased import MUCH, given
from cqdd_design.sizing.exact import shortfalls
from cqdd_design.sizing.finish import design_of
from cqdd_design.sizing.hunt import Hunt, Nearly
from cqdd_design.sizing.points import Points
from cqdd_design.sizing.refine import Starts, climb
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import weak_lines
from cqdd_design.sizing.spaces import Found, Space, closer, spaces

_PARTS = (0.5, 0.2)
"""Of the reserve that a design lacks, where no other has all of it."""
_TURNS = 8
"""Of closed forms against the equilibrium at the strongest design."""
_AS_STRONG = 0.97
"""Share of the most reserve that more output pins may cost."""
_CLOSE, _MOST = 0.85, 4
"""Reserve over what part errors ask for from which the strongest designs are tried, and of how many
cam bearings."""


def note_nearly(hunt: Hunt, found: Found) -> None:
    """Remember a design that was just looked at, where its gearboxes bear most of the torques.

    Not one of those that are the strongest: beside them is no reserve to ask for.
    """
    share = min(hunt.borne or (0.0,))
    if share >= MUCH and hunt.sturdy is None:
        hunt.nearly[found.cam] = Nearly(share, hunt.had)


def nearly_again(hunt: Hunt, search: Callable[[], Found | None]) -> Found | None:
    """Another design for torques that are stated, where one was nearly sound.

    The strongest with each cam bearing, one after another; then what the search finds with part of
    the reserve that the nearest lacked. What is asked for is left as it is where there is neither.
    """
    if PEAK in hunt.requirements.derived or not hunt.nearly:
        return None
    if hunt.sturdy is None:
        hunt.sturdy = _sturdiest(hunt)
    while hunt.sturdy:
        # It may do with less clearance than those before.
        hunt.fit = hunt.sturdy[0].space.fit
        found = given(hunt, hunt.sturdy.pop(0))
        if found is not None:
            return found
    for cam, one in sorted(hunt.nearly.items(), key=lambda each: -each[1].borne):
        asked = hunt.extra_of[cam]
        for part in _PARTS:
            hunt.extra_of[cam] = _with_part(asked, one.had, part)
            better = None if hunt.extra_of[cam] == asked else search()
            if better is not None:
                return better
        hunt.extra_of[cam] = asked
    return None


def _with_part(asked: dict[str, float], had: Mapping[str, float], part: float) -> dict[str, float]:
    """Reserves that are asked for, with part of what a design lacked of them."""
    return {
        check: had[check] * (more / had[check]) ** part if more > had.get(check, more) else more
        for check, more in asked.items()
    }


def _sturdiest(hunt: Hunt) -> list[Found]:
    """The strongest designs with each cam bearing, those first that have most reserve.

    None whose shaft is weak, whatever has been asked of shafts since.
    """
    # By one measure for all: what is asked of a bearing grows with each look at it.
    nearest = max(hunt.nearly, key=lambda one: hunt.nearly[one].borne)
    hunt = replace(hunt, least_bore=0.0, usual=hunt.extra_of[nearest], extra_of={})
    every: list[tuple[float, Found]] = []
    for space in spaces(hunt.requirements, closer(hunt.fit), hunt.pins):
        for kind in strong_kinds(hunt, space, {}):
            strong = max(_stronger(hunt, kind), key=lambda one: one.reserve(hunt), default=None)
            if strong is None or strong.reserve(hunt) < _CLOSE:
                continue
            found = strong.found(replace(hunt, usual={}), kind)
            if found is not None and found.rated and not weak_lines(found.sized.machine):
                every.append((-strong.reserve(hunt), found))
    return [found for _, found in sorted(every, key=lambda one: one[0])[:_MOST]]


def _stronger(hunt: Hunt, space: Space) -> Iterator[Strongest]:
    """Designs that closed forms take for the strongest, as they learn what they lack there.

    Half way each time: what they lack hangs on the design.
    """
    needs: dict[str, float] = {}
    point: Points | None = None
    for _ in range(_TURNS):
        try:
            search = Search.of(hunt.frame(space, needs), hunt.tables)
            point = _most_reserve(search, point)
            if point is None:
                return
            machine, checks = hunt.held_against(
                resolve(design_of(search.evaluator, point, 0), search.frame.motor)
            )
        except (ContactError, DesignError, InfeasibleError):
            return
        yield Strongest(search, point, machine, checks)
        lacking = shortfalls(machine, checks)
        needs = {one: (needs.get(one, 1.0) * more) ** 0.5 for one, more in lacking.items()}


def _most_reserve(search: Search, near: Points | None) -> Points | None:
    """The strongest point, also of those near another, with as many pins as leave most of it."""
    every = search.most_reserve()
    if near is not None:
        point = search.evaluator.placed(near)
        pins = [(count, int(point.pin_size[0])) for count in search.space.pin_counts]
        beside = climb(search.evaluator, Starts.other_pins(point, pins, np.inf))
        every = beside if every is None else beside.joined(every)
    if every is None or every.reserve.max() <= 0.0:
        return None
    strong = np.flatnonzero(every.reserve >= _AS_STRONG * every.reserve.max())
    return every.rows(strong[[every.pin_count[strong].argmax()]])
