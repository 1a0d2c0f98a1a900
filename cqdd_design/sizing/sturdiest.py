"""The strongest gearboxes, where a search finds none that is sound and some nearly were.

What part errors ask for is read off a quantile of few gearboxes. It may be more than any design
has, and more than one needs that is stronger, or whose errors are shared by more pins.
"""

from __future__ import annotations

from collections.abc import Iterator
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
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.looks import (
    NothingWiderError,
    clearance_needed,
    last_look,
    look,
    read_spread,
    take,
)
from cqdd_design.sizing.points import Points
from cqdd_design.sizing.refine import Starts, climb
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import weak_lines
from cqdd_design.sizing.spaces import FITS, Found, Space, closer, spaces
from cqdd_design.verdict import Verdict, judge

_TURNS = 8
"""Of closed forms against the equilibrium at the strongest design."""
_AS_STRONG = 0.97
"""Share of the most reserve that more output pins may cost."""
_NEARLY = 0.9
"""Share of the torques that enough of few gearboxes bear, from which all are asked."""
_CLOSE, _MOST = 0.9, 4
"""Reserve over what part errors ask for from which a design is judged, and how many are."""


def strong_and_sound(hunt: Hunt) -> tuple[Found, Verdict] | None:
    """The first of the strongest designs whose verdict is yes, for torques that are stated.

    None where no design was nearly sound.
    """
    if PEAK in hunt.requirements.derived or max(hunt.nearly.values(), default=0.0) < MUCH:
        return None
    hunt.say("judging the strongest gearboxes")
    # By one measure for all, since what is asked of a bearing grows with each look at it; and
    # whatever has been asked of shafts since.
    nearest = max(hunt.nearly, key=hunt.nearly.__getitem__)
    hunt = replace(hunt, least_bore=0.0, usual=hunt.extra_of[nearest], extra_of={})
    verdicts = (_with_clearance(hunt, strong) for strong in _sturdiest(hunt))
    return next((one for one in verdicts if one is not None), None)


def _with_clearance(hunt: Hunt, strong: Found) -> tuple[Found, Verdict] | None:
    """The same gearbox with the clearance that heat and part errors ask for, where that is a yes.

    Or the strongest with that clearance, where it has no room for it. Few gearboxes turn away those
    alone that are far from sound: of designs that just pass, they would turn many away.
    """
    hunt = replace(hunt, fit=strong.space.fit, extra_of={})
    found: Found | None = strong
    for _ in FITS:
        if found is None:
            break
        can, step = look(hunt, found.sized.machine)
        if can is None and step is None:
            step = last_look(hunt, found.sized.machine)
            if step == 0.0 and min(hunt.borne or (1.0,)) < _NEARLY:
                break
        if can is None and not step:
            judged = judge(found.sized.machine)
            if judged.meets == "yes":
                return found, judged
            step = _clearance(hunt, judged)
            if not step:
                break
        try:
            take(hunt, can, step, found.cam)
        except NothingWiderError:
            break
        same = given(hunt, found)
        again = None if same is not None else _strongest(hunt, found.space._replace(fit=hunt.fit))
        found = again[1] if again is not None else same
    return None


def _clearance(hunt: Hunt, judged: Verdict) -> float:
    """How much more of it a design lacks that was judged, m; 0 where it lacks something else."""
    step = clearance_needed(judged.evidence.temperatures, judged.lines)
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    if step == 0.0 and drawn is not None:
        step = read_spread(hunt, machine, drawn, judged.lines) or 0.0
    return step


def _sturdiest(hunt: Hunt) -> list[Found]:
    """The strongest designs with each cam bearing, those first that have most reserve.

    Of what is asked for by now, with the next closer fit.
    """
    kinds = (
        kind
        for space in spaces(hunt.requirements, closer(hunt.fit), hunt.pins)
        for kind in strong_kinds(hunt, space, {})
    )
    every = [one for kind in kinds if (one := _strongest(hunt, kind)) is not None]
    return [found for _, found in sorted(every, key=lambda one: -one[0])[:_MOST]]


def _strongest(hunt: Hunt, space: Space) -> tuple[float, Found] | None:
    """The strongest design of a space, and its reserve over what part errors ask for.

    None where that is too little, or the shaft is weak.
    """
    strong = max(_stronger(hunt, space), key=lambda one: one.reserve(hunt), default=None)
    if strong is None or (reserve := strong.reserve(hunt)) < _CLOSE:
        return None
    found = strong.found(replace(hunt, usual={}), space)
    if found is None or not found.rated or weak_lines(found.sized.machine):
        return None
    return reserve, found


def _stronger(hunt: Hunt, space: Space) -> Iterator[Strongest]:
    """Designs that closed forms take for the strongest, as they learn what they lack there.

    Half way each time: what they lack hangs on the design.
    """
    needs: dict[str, float] = {}
    point: Points | None = None
    for _ in range(_TURNS):
        try:
            search = Search.of(hunt.frame(space, needs), hunt.tables)
            point = most_reserve(search, point)
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


def most_reserve(search: Search, near: Points | None) -> Points | None:
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
