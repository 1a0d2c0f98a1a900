"""Other ways to a design that was found: what they lead to may be the better one.

What part errors and heat ask for hangs on the designs that are looked at, and one search keeps what
it has learnt of a cam bearing for the designs with it that come after. So where a search ends far
from what it began with, or with another goal, or has left out narrow cam bearings, others begin
anew: for the least play or the smallest pack, which lead to sturdy designs, or for the first that
is sound. What they find is held against the one that there is by what the whole verdict says of
both.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import assert_never

from cqdd_design.design import Requirements
from cqdd_design.errors import CqddError
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.eased import given
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.outcome import result_of
from cqdd_design.sizing.plates import with_sound_plate
from cqdd_design.sizing.spaces import Found
from cqdd_design.sizing.verified import VerifiedDesign, new_hunt, searched, verified
from cqdd_design.verdict import Verdict, judge

_FAR = 1.25
"""Objective over that of the first design of a search from which others are searched for."""
_NEAR = 1.05
"""The same where narrow cam bearings were left out."""
_STURDY: tuple[Goal, ...] = ("backlash", "size")
_BETTER = 0.995
"""Of the figure of the design that was found, from which another takes its place."""


def or_better(
    hunt: Hunt, first: VerifiedDesign, requirements: Requirements, goal: Goal
) -> VerifiedDesign:
    """The design of a search, or a better one that another way leads to.

    Parameters
    ----------
    hunt : Hunt
        That the search began with.
    requirements : Requirements
        That were stated. Where no peak torque was, there is nothing to hold designs against: each
        search would end with a torque of its own.
    goal : Goal
        What was to be made small.
    """
    ways = () if PEAK in first.derived else _ways(hunt, first, goal)
    if not ways:
        return first
    hunt.say("searching by other ways too, for what is better by the whole verdict")
    asked = requirements
    if CONTINUOUS in first.derived:
        # No rival is to hold less for ever than the first.
        lasting = first.sizing.design.requirements.continuous_torque
        asked = asked.unchecked_copy({CONTINUOUS: lasting}).deriving()
    best, began = first, time.perf_counter() - first.sizing.seconds
    for way in ways:
        other = _anew(hunt, asked, way, goal)
        if goal == "mass":
            other.lighter_than = best.sizing.objective.mass
        rival = _rival(other, asked, goal)
        if rival is None:
            continue
        own, found, verdict = rival
        if _figure(found, verdict, goal) < _BETTER * _figure(best.found, best.verdict, goal):
            best = verified(own, found, result_of(own, found, began), verdict, requirements)
    return best


def _ways(hunt: Hunt, first: VerifiedDesign, goal: Goal) -> tuple[Goal, ...]:
    """Goals of the hunts whose designs may be better than one.

    None where it is near what closed forms hoped for; where narrow cam bearings were left out for
    what one of them did, nearer.
    """
    objective = first.sizing.objective
    if goal != "mass":
        return tuple(one for one in _STURDY if one != goal)
    if objective.goal != goal or objective.mass > _FAR * hunt.hoped:
        return (_STURDY[0], goal)
    return (goal,) if hunt.loose and objective.mass > _NEAR * hunt.hoped else ()


def _anew(hunt: Hunt, asked: Requirements, way: Goal, goal: Goal) -> Hunt:
    """A hunt that begins anew, for any design that is sound."""
    own = new_hunt(asked, lambda _: None, hunt.motor, hunt.ambient, way)
    own.any_will_do = own.best_alone = True
    if way == goal:
        own.too_warm = set(hunt.loose)
    return own


def _rival(hunt: Hunt, asked: Requirements, goal: Goal) -> tuple[Hunt, Found, Verdict] | None:
    """What another hunt ends with, as a design of the goal that is asked for; None where nothing.

    There is a design already, so whatever else the hunt ends with is no matter.
    """
    try:
        done = searched(hunt, asked)
        own = replace(hunt, goal=goal, fit=done.found.space.fit)
        same = given(own, done.found)
        if same is None or same.weak:
            return None
        same = with_sound_plate(same)
        judged = done.verdict
        if same.sized.design != done.sizing.design:
            judged = judge(same.sized.machine)
    except CqddError:
        return None
    return (own, same, judged) if judged.meets == "yes" else None


def _figure(found: Found, verdict: Verdict, goal: Goal) -> float:
    """What a goal makes small, of a whole actuator where its verdict knows that.

    Never the score of a search, which may have turned to another goal.
    """
    told = {one.id: one.value for one in verdict.headline}
    if goal == "efficiency":
        return 1.0 - (told["efficiency"] or 0.0)
    if goal == "backlash":
        return told["backlash_p95"] or math.inf
    if goal == "mass":
        return told["mass"] or math.inf
    if goal == "inertia":
        # The rotor's share is the same, and would hide what the gearboxes differ by.
        return found.sized.machine.inertia.gearbox_reflected
    if goal == "size":
        reducer = found.sized.design.reducer
        return reducer.ring.outer_diameter**2 * reducer.pack_length
    assert_never(goal)
