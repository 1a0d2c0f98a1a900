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
from cqdd_design.sizing.eased import MUCH
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
from cqdd_design.sizing.plates import with_sound_plate
from cqdd_design.sizing.points import Points
from cqdd_design.sizing.refine import Starts, climb
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import with_sound_ends
from cqdd_design.sizing.spaces import Found, Space, closer, spaces
from cqdd_design.verdict import Verdict, judge

_TURNS = 8
"""Of closed forms against the equilibrium at the strongest design."""
_AS_STRONG = 0.97
"""Share of the most reserve that more output pins may cost."""
_NEARLY = 0.9
"""Share of the torques that enough of few gearboxes bear, from which all are asked."""
_CLOSE, _MOST = 0.9, 3
"""Reserve over what part errors ask for from which a design is judged, and of how many cam
bearings."""
_LOOKS, _STEP = 6, 1e-6
"""At designs of one kind, and clearance that has to grow at all, m: to the next fit."""


def strong_and_sound(hunt: Hunt) -> tuple[Found, Verdict] | None:
    """The first of the strongest designs whose verdict is yes, for torques that are stated.

    None where no design was nearly sound.
    """
    if PEAK in hunt.requirements.derived or max(hunt.nearly.values(), default=0.0) < MUCH:
        return None
    hunt.say("judging the strongest gearboxes")
    # By one measure for all, since what is asked of a bearing grows with each look at it; and
    # whatever has been asked of shafts since. Of a nearly sound one nothing may have been asked.
    nearest = max(hunt.nearly, key=hunt.nearly.__getitem__)
    measure = hunt.extra_of.get(nearest, hunt.extra_for(nearest))
    hunt = replace(hunt, least_bore=0.0, usual=measure, extra_of={})
    verdicts = (_sound(hunt, kind) for kind in _sturdiest(hunt))
    return next((one for one in verdicts if one is not None), None)


def _sound(hunt: Hunt, kind: Space) -> tuple[Found, Verdict] | None:
    """The strongest of a kind whose verdict is yes, with one clearance after another.

    With the kind's, then as much as the hunt came to ask for, and with more where heat or part
    errors ask for that. Few gearboxes turn away those alone that are far from sound: of designs
    that just pass, they would turn many away.
    """
    asked, hunt = hunt.fit, replace(hunt, fit=kind.fit)
    for _ in range(_LOOKS):
        strong = _strongest(hunt, kind._replace(fit=hunt.fit))
        if strong is None:
            break
        found = with_sound_plate(strong[1])
        can, step = look(hunt, found.sized.machine.rigid)
        if can is None and step is None:
            can, step = look(hunt, found.sized.machine)
        if can is None and step is None:
            step = last_look(hunt, found.sized.machine)
            if step is None or (step == 0.0 and min(hunt.borne or (1.0,)) >= _NEARLY):
                judged = judge(found.sized.machine)
                if judged.meets == "yes":
                    return found, judged
                step = _clearance(hunt, judged)
            if not step:
                if hunt.fit.hole_clearance >= asked.hole_clearance:
                    break
                step = _STEP
        try:
            take(hunt, can, step, found.cam)
        except NothingWiderError:
            break
    return None


def _clearance(hunt: Hunt, judged: Verdict) -> float:
    """How much more of it a design lacks that was judged, m; 0 where it lacks something else."""
    step = clearance_needed(judged.evidence.temperatures, judged.lines)
    machine, drawn = judged.evidence.machine, judged.evidence.drawn
    if step == 0.0 and drawn is not None:
        step = read_spread(hunt, machine, drawn, judged.lines) or 0.0
    return step


def _sturdiest(hunt: Hunt) -> list[Space]:
    """Spaces with the cam bearings whose strongest designs have most reserve, those first.

    Of what is asked for by now, with the next closer fit.
    """
    kinds = (
        kind
        for space in spaces(hunt.requirements, closer(hunt.fit), hunt.pins)
        for kind in strong_kinds(hunt, space, {})
    )
    every = [(one[0], kind) for kind in kinds if (one := _strongest(hunt, kind)) is not None]
    return [kind for _, kind in sorted(every, key=lambda one: -one[0])[:_MOST]]


def _strongest(hunt: Hunt, space: Space) -> tuple[float, Found] | None:
    """The strongest design of a space, and its reserve over what part errors ask for.

    By what is usual: of one design alone, looks may ask for far more. None where the reserve is too
    little, or the shaft is weak.
    """
    hunt = replace(hunt, extra_of={})
    strong = max(stronger(hunt, space), key=lambda one: one.reserve(hunt), default=None)
    if strong is None or (reserve := strong.reserve(hunt)) < _CLOSE:
        return None
    found = strong.found(replace(hunt, usual={}), space)
    if found is None or not found.rated:
        return None
    found = with_sound_ends(found)
    if found.weak:
        return None
    return reserve, found


def stronger(hunt: Hunt, space: Space) -> Iterator[Strongest]:
    """Designs that closed forms take for the strongest, as they learn what they lack there.

    Half way each time: what they lack hangs on the design. Slower than `agreement.strongest`, by
    which torques that nobody stated are lowered, and surer where part errors ask for much.
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
