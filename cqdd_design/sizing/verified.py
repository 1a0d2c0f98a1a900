"""Sizing to the verdict: searches that agree with the equilibrium, and the closest models to judge.

The verdict on one design takes some seconds. So toleranced gearboxes and temperatures are looked at
with few gearboxes first, and choose clearances and reserves; then the whole verdict decides.
"""

from __future__ import annotations

import math
import time
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.able import CONTINUOUS, PEAK, first_guess
from cqdd_design.sizing.bearable import or_weaker
from cqdd_design.sizing.eased import LITTLE, MUCH, eased, given
from cqdd_design.sizing.foreseen import Foreseen, foreseen
from cqdd_design.sizing.frame import Fit, Goal
from cqdd_design.sizing.hunt import Hunt, Progress
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.kinds import lightest, promising
from cqdd_design.sizing.looks import (
    NothingWiderError,
    last_look,
    learn,
    look,
    motor_far_short,
    take,
)
from cqdd_design.sizing.motor_reach import refuse_weak_motor
from cqdd_design.sizing.outcome import result_of
from cqdd_design.sizing.plates import with_sound_plate
from cqdd_design.sizing.refusals import (
    NO_SPACE,
    TRIALS,
    far_short,
    least_margin,
    nothing,
    refused,
    unsettled,
)
from cqdd_design.sizing.result import SizingResult
from cqdd_design.sizing.rings import finer
from cqdd_design.sizing.shafts import stronger_shaft, turn_to_less_throw
from cqdd_design.sizing.spaces import Found, closer
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.sizing.sturdiest import strong_and_sound
from cqdd_design.sizing.trial_gearboxes import drawing_ahead
from cqdd_design.sizing.turns import cooler_gearbox, next_step, turned, with_another_bearing
from cqdd_design.verdict import Verdict, judge

_CLOSER, _CLOSER_PINS = 0.96, 6
"""Of a pin circle without a rated carrier bearing, and how often one is tried."""
_PATIENCE = 6
"""Trials after which a gearbox that part errors leave short is eased, a sound one kept, and no cam
bearing tried that has not been looked at."""
_FEW = 8
"""Trials in which any design that meets stated torques has to be found: where it takes more, space
is so tight that a little more of it is the better advice."""
_WORTH_IT = 0.99
"""Objective over a sound design's from which another is looked at instead."""


@dataclass(frozen=True)
class VerifiedDesign:
    """A design with its verdict, and how it was found.

    Attributes
    ----------
    sizing : SizingResult
        The design, and alternatives that closed forms alone have judged.
    verdict : Verdict
        On the design: yes.
    derived : frozenset of str
        Requirements that were not stated and are what the motor can do.
    found : Found
        The design where the search had it.
    """

    sizing: SizingResult
    verdict: Verdict
    derived: frozenset[str]
    found: Found = field(compare=False, repr=False)


def size_to_verdict(
    requirements: Requirements,
    progress: Progress = lambda _: None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
    goal: Goal = "mass",
    best_alone: bool = False,
) -> VerifiedDesign:
    """Find the best design by a goal, among those tried, whose verdict is yes.

    Parameters
    ----------
    requirements : Requirements
        What of `disc_count`, `disc_material` and `ring_material` they state is kept.
    progress : callable
        Called with a sentence at every stage.
    motor : Motor, optional
        Default the catalogue's row of the motor that the requirements name.
    ambient : float, optional
        Of the air, deg C.
    goal : Goal
        What to make small: see :mod:`cqdd_design.sizing.goals`.
    best_alone : bool
        Whether it is known that any design would be searched for in vain, and so is not.

    Raises
    ------
    SizingInfeasibleError
        When no design was found whose verdict is yes; it names the lines that bind.
    """
    hunt = new_hunt(requirements, progress, motor, ambient, goal)
    hunt.best_alone = best_alone
    return searched(hunt, requirements)


def new_hunt(
    requirements: Requirements,
    progress: Progress,
    motor: Motor | None,
    ambient: float | None,
    goal: Goal,
) -> Hunt:
    """A hunt that has learnt nothing, with guesses in place of torques that were not stated."""
    guess, tables = first_guess(requirements, motor), stage_tables(requirements.ratio)
    return Hunt(guess, motor, ambient, progress, tables, goal)


def searched(hunt: Hunt, requirements: Requirements) -> VerifiedDesign:
    """The search of `size_to_verdict`; `requirements` are those that were stated.

    Where the search for the best ends without a design, the first that meets everything is searched
    for, and then one of the strongest: that is what refusals name as the nearest, so whoever asks
    for it has to find it. But a stronger one warms a motor as much, and is no lighter; and where
    losses leave the nearest far short, they would any.
    """
    goal, began = hunt.goal, time.perf_counter()
    refuse_weak_motor(hunt.requirements, hunt.motor_row, hunt.ambient)
    try:
        return _searched(hunt, requirements)
    except SizingInfeasibleError as refusal:
        if hunt.best_alone or far_short(refusal):
            raise
        if not hunt.any_will_do and (hunt.left or hunt.calm is not None):
            hunt.say("searching for any design that meets everything")
            hunt = new_hunt(requirements, hunt.say, hunt.motor, hunt.ambient, goal)
            hunt.any_will_do = True
            try:
                return _searched(hunt, requirements)
            except InfeasibleError:
                pass
        helpless = any(line.startswith(NO_SPACE) for line in refusal.binding)
        strong = None if helpless else strong_and_sound(hunt)
        if strong is None:
            raise
        found, verdict = strong
        return verified(hunt, found, result_of(hunt, found, began), verdict, requirements)


def _searched(hunt: Hunt, requirements: Requirements) -> VerifiedDesign:
    began, goal, progress = time.perf_counter(), hunt.goal, hunt.say
    if goal == "efficiency" and hunt.may_roll:
        hunt.pins = False, True
    progress("searching by closed forms, held against the contact equilibrium")
    found = or_weaker(hunt, lambda: promising(hunt))
    hunt.hoped = hunt.hoped or (math.inf if found is None else found.sized.objective.score)
    if found is not None and (far := motor_far_short(hunt, found.sized.machine)):
        found = cooler_gearbox(hunt, far, found.sized.machine)
    nearest: Verdict | None = None
    thorough = hunt.any_will_do
    sound: _Sound | None = None
    for trial in range(_FEW if hunt.any_will_do and not requirements.derived else TRIALS):
        hunt.settling = trial >= _PATIENCE
        found = None if found is None else _with_rated_bearing(hunt, found)
        if found is None or _too_heavy(hunt, found):
            break
        try:
            if found.weak:
                # What part errors ask for may have led to a shaft that is too thin.
                if hunt.requirements.derived or not hunt.relent():
                    stronger_shaft(hunt, found, found.weak)
                found = _better(hunt, found, sound, trial)
                continue
            if (short := foreseen(hunt, found)) is not None:
                moved, other = _elsewhere(hunt, found, short)
                if moved and other is None:
                    # A refusal names all that binds.
                    nearest = judge(found.sized.machine)
                if moved:
                    hunt.left, sound, found = True, None, other
                    continue
            asks = (sound is None or sound.found is not found) and learn(hunt, found)
            if not asks:
                sound = _Sound(found, hunt.requirements, hunt.fit)
            if asks or not thorough:
                less = None if _may_go_back(hunt, sound) else _less_of_it(hunt, found, trial)
                if less is not None:
                    found = less
                    continue
                if not asks:
                    # The best may do with less clearance than the first.
                    hunt.fit = closer(hunt.fit)
                thorough = True
                found = _better(hunt, found, sound, trial)
                continue
            if not (hunt.fine or hunt.any_will_do):
                hunt.fine = True
                found = finer(hunt, found)
                continue
            # With elastic discs and ring, of which the looks before knew nothing.
            sound, plain = None, found
            found = with_sound_plate(plain)
            if found is not plain:
                progress("taking a carrier of steel: aluminium would press its bearing, or yield")
            with drawing_ahead(found.sized.machine):
                can, step = look(hunt, found.sized.machine)
            if can is None and step is None:
                step = last_look(hunt, found.sized.machine)
                if (less := eased(hunt, found, _least_left(hunt, trial))) is not None:
                    found = less
                    continue
            if can is None and step is None:
                progress("judging a design by the whole verdict")
                # Nearly every design that comes so far is the answer.
                with ThreadPoolExecutor(1) as beside:
                    result = beside.submit(result_of, _aside(hunt), found, began)
                    judged = judge(found.sized.machine)
                if judged.meets == "yes":
                    return verified(hunt, found, result.result(), judged, requirements)
                nearest = judged if nearest is None else max(nearest, judged, key=least_margin)
                moved, other = _elsewhere(hunt, found, judged)
                if moved:
                    found = other
                    continue
                step = next_step(hunt, found, judged)
                if step is None:
                    break
                if (less := eased(hunt, found, _least_left(hunt, trial))) is not None:
                    found = less
                    continue
            take(hunt, can, step, found.cam)
        except NothingWiderError:
            break
        # More clearance or less torque is given to the same gearbox, reserve to another.
        same = given(hunt, found) if can is not None or step else None
        found = _again(hunt, found) if same is None else same
    if nearest is not None:
        raise refused(nearest)
    raise nothing(hunt) if found is None else unsettled(found)


def _elsewhere(hunt: Hunt, found: Found, judged: Verdict | Foreseen) -> tuple[bool, Found | None]:
    """Whether the hunt goes for other cam bearings, pins or another goal, and what it finds then.

    For what a design is short of by what friction takes, or by what is asked for beyond torques.
    """
    other = with_another_bearing(hunt, found, judged)
    if other is not None:
        return True, other
    if turned(hunt, found, judged):
        return True, _after_turn(hunt, found, judged)
    return False, None


def _after_turn(hunt: Hunt, found: Found, judged: Verdict | Foreseen) -> Found | None:
    """The design of a hunt that has turned; without any on needles, of bare pins by other ways.

    Cam bearings that were too warm for one goal may do for another.
    """
    hunt.too_warm.clear()
    other = or_weaker(hunt, lambda: lightest(hunt))
    if other is None and hunt.pins == (True,):
        hunt.pins = False, True
        if turned(hunt, found, judged):
            other = or_weaker(hunt, lambda: lightest(hunt))
    return other


def _less_of_it(hunt: Hunt, found: Found, trial: int) -> Found | None:
    """The gearbox for less torque, where part errors leave it a little short at first looks.

    Once: lighter ones that are found for less would be eased on and on. In the end one gearbox is
    held on to, or each that is found would ask for something else.
    """
    if hunt.eased and trial < _PATIENCE:
        return None
    return eased(hunt, found, _least_left(hunt, trial))


def _least_left(hunt: Hunt, trial: int) -> float:
    """Share of a torque that is left at least where a gearbox is eased."""
    return MUCH if hunt.any_will_do or trial >= _PATIENCE else LITTLE


class _Sound(NamedTuple):
    """A design at which looks asked for nothing more, and what was asked of it then."""

    found: Found
    requirements: Requirements
    fit: Fit


def _too_heavy(hunt: Hunt, found: Found) -> bool:
    """Whether another design, which is there, is no heavier."""
    known = math.isfinite(hunt.lighter_than)
    return known and found.sized.objective.mass >= hunt.lighter_than


def _may_go_back(hunt: Hunt, sound: _Sound | None) -> bool:
    """Whether a sound design is one for what is asked now: no less torque, the same goal."""
    if sound is None or sound.found.sized.objective.goal != hunt.goal:
        return False
    then, now = sound.requirements, hunt.requirements
    same = then.unchecked_copy({key: getattr(now, key) for key in (PEAK, CONTINUOUS)}) == now
    return same and all(getattr(then, key) >= getattr(now, key) for key in (PEAK, CONTINUOUS))


def _better(hunt: Hunt, found: Found, sound: _Sound | None, trial: int) -> Found | None:
    """The search repeated, or the sound design where that promises little more.

    What a search promises with a cam bearing that has not been looked at is seldom all kept; and
    what part errors ask of a design by a finer search may be too much for both, though not for the
    sound one.
    """
    if not _may_go_back(hunt, sound):
        return _again(hunt, found)
    assert sound is not None
    again = None if hunt.fine or trial >= _PATIENCE else lightest(hunt)
    if again is not None and again.worth < (False, _WORTH_IT * sound.found.worth[1]):
        return again
    hunt.requirements, hunt.fit = sound.requirements, sound.fit
    return sound.found


def _again(hunt: Hunt, found: Found) -> Found | None:
    """The search repeated with what has been learnt since.

    Where that leaves nothing, for less torque if none was stated: what the same gearbox bears, or
    the strongest.
    """
    better = lightest(hunt)
    if better is None and turn_to_less_throw(hunt):
        better = lightest(hunt)
    if better is None and not hunt.requirements.derived and hunt.relent():
        better = lightest(hunt)
    if better is None:
        better = eased(hunt, found, MUCH)
    return or_weaker(hunt, lambda: lightest(hunt), found) if better is None else better


def _with_rated_bearing(hunt: Hunt, found: Found) -> Found:
    """The design, or one on a pin circle round which a carrier bearing with ratings fits.

    What a bearing that is made to order carries would stay unknown.
    """
    wanted, widest = hunt.requirements, hunt.most_pin_circle
    for _ in range(_CLOSER_PINS):
        if found.rated or found.weak:
            return found
        hunt.most_pin_circle = _CLOSER * found.sized.design.reducer.output_pins.circle_radius
        near = _again(hunt, found)
        if near is None:
            break
        found = near
    if not found.rated:
        hunt.requirements, hunt.most_pin_circle = wanted, widest
    return found


def verified(
    hunt: Hunt, found: Found, sizing: SizingResult, verdict: Verdict, asked: Requirements
) -> VerifiedDesign:
    """A design whose verdict is yes, for the requirements that were stated."""
    added = hunt.requirements.model_fields_set - asked.model_fields_set
    return VerifiedDesign(sizing, verdict, asked.derived | added, found)


def _aside(hunt: Hunt) -> Hunt:
    """A hunt that knows as much, and teaches this one nothing."""
    changing = [name for name, one in vars(hunt).items() if isinstance(one, dict | list | set)]
    return replace(hunt, **{name: copy(getattr(hunt, name)) for name in changing})
