"""The nearest requirements that fit where some do not, each borne out by the whole verdict.

In each direction by itself. Torques are lowered as those are that nobody stated, and raised again
while more fits. A larger ring or longer discs are looked for by the equilibrium, with the reserve
that part errors were found to take. All is found by searches for any design, which end sooner than
one for the best: see :mod:`cqdd_design.sizing.no_nearer` for what that leaves.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.environment import give_memory_back
from cqdd_design.errors import DesignError, InfeasibleError
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.geometry.scale import largest_ring
from cqdd_design.sizing.able import CONTINUOUS, PEAK, TooHotError, first_guess
from cqdd_design.sizing.bearable import LEAST, both_bearable, weaker
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.hunt import Hunt, Progress
from cqdd_design.sizing.infeasible import WORDS, SizingInfeasibleError, listed
from cqdd_design.sizing.kinds import ranked
from cqdd_design.sizing.looser import looser_figures
from cqdd_design.sizing.motor_reach import PEAK_LINE, MotorShortError
from cqdd_design.sizing.motors import lacking
from cqdd_design.sizing.ratios import other_ratio
from cqdd_design.sizing.refusals import FIGURES, NO_SPACE, far_short
from cqdd_design.sizing.rivals import or_better
from cqdd_design.sizing.slower import less_speed
from cqdd_design.sizing.stage_tables import stage_tables
from cqdd_design.sizing.torque_steps import (
    ALONE,
    between,
    share_borne,
    short_alone,
    what_the_judged_has,
)
from cqdd_design.sizing.verified import VerifiedDesign, new_hunt, searched
from cqdd_design.sizing.ways import Torques, Ways

_MOST = 2.5
"""Of a length that is too small: so far a longer one, and a larger ring without a bore that limits
it, are looked for."""
_STEP = 5e-4
"""In which rings and lengths are told, m."""
_CLOSE = 0.02
"""Share of a length within which the least is found."""
_ROUNDS, _ON = 6, 1.02
"""Of lengths that the equilibrium bears out and that are searched to the verdict, and the least
step from one to the next."""
_NEARLY = 0.9
"""Share of both torques below which nothing is looked for that bears all: it is told roughly."""
_ROUNDING = 1e-6
_NO_LOADS = {"BACKLASH", "LOST-MOTION", "STIFFNESS", "SHOCK-STOP", "SURFACE-TEMPERATURE"}
"""Lines of which a search by loads alone does not know how much space they take."""
_RISES = 4
"""Torques between one that fits and one that does not that are tried."""


@dataclass(frozen=True)
class _Way:
    """A search with other requirements: its design, or why there is none, and what it learnt."""

    hunt: Hunt
    found: VerifiedDesign | None
    refusal: InfeasibleError | None

    @property
    def hopeless(self) -> bool:
        """Whether it failed for what no space helps, alone or by far."""
        if isinstance(self.refusal, SizingInfeasibleError):
            alone = all(line.startswith(NO_SPACE) for line in self.refusal.binding)
            return alone or bool(far_short(self.refusal))
        return isinstance(self.refusal, TooHotError)

    @property
    def short(self) -> tuple[str, ...]:
        """Lines that it fell short of."""
        return self.refusal.binding if isinstance(self.refusal, SizingInfeasibleError) else ()

    @property
    def beyond_space(self) -> tuple[str, ...]:
        """Lines that it fell short of and that space hardly helps."""
        return tuple(line for line in self.short if line.startswith(NO_SPACE))

    @property
    def doubtful(self) -> bool:
        """Whether it failed for what space may not help, among others."""
        other = isinstance(self.refusal, SizingInfeasibleError) and bool(
            _NO_LOADS & set(self.refusal.binding)
        )
        return self.hopeless or bool(self.beyond_space) or other


class _Need(NamedTuple):
    """The smallest length that fits, m; or one that does not and what it is still short of."""

    length: float | None
    tried: float | None = None
    beyond_space: tuple[str, ...] = ()


def size_or_nearest(
    requirements: Requirements,
    progress: Progress = lambda _: None,
    *,
    motor: Motor | None = None,
    ambient: float | None = None,
    goal: Goal = "mass",
) -> VerifiedDesign:
    """As :func:`.verified.size_to_verdict`; a refusal says which requirements would fit.

    That it is refused, and why, is told as a whole sentence before those are looked for.
    """
    hunt = new_hunt(requirements, progress, motor, ambient, goal)
    _refuse_unknown(hunt.motor_row)
    asked = hunt.requirements
    try:
        found = searched(hunt, requirements)
    except SizingInfeasibleError as refusal:
        _let_go(refusal)
        began = replace(hunt, requirements=asked, goal=goal)
        raise _with_ways(refusal, _without_designs(began)) from refusal
    return or_better(hunt, found, requirements, goal)


def _refuse_unknown(motor: Motor) -> None:
    """Refuse a motor of which too little is known for any verdict to be yes, before a search."""
    lacks = lacking(motor)
    if lacks:
        raise DesignError(
            f"no design with '{motor.name}' can be shown to meet anything: not known of it are "
            f"{listed([*lacks])}. Give them in [motor] or with --motor-file (`cqdd-design new "
            "motor` writes one), or take another motor (--motor any); --quick searches by closed "
            "forms, which is no verdict."
        )


def _with_ways(refusal: SizingInfeasibleError, hunt: Hunt) -> SizingInfeasibleError:
    """A refusal with the nearest requirements that fit, in each direction in which any do.

    Parameters
    ----------
    hunt : Hunt
        That was refused, with the requirements that it began with.
    """
    asked = hunt.requirements
    less = _Way(hunt, None, refusal)
    stated = PEAK not in asked.derived and not asked.load_cases
    looked_for = not less.hopeless or refusal.cool_ratio or set(refusal.binding) & FIGURES.keys()
    if stated or looked_for:
        # The ways out take minutes; whoever knows enough need not wait for them.
        # And an estimate of what is carried need not stand above what they find.
        told = refusal.message.replace(refusal.estimate, "") if stated else refusal.message
        hunt.say(f"{told.rstrip('.')}.")
        hunt.say("looking for what would fit, which may take minutes (Ctrl-C where that is enough)")
    if stated:
        hunt.say("looking for the torques that fit")
        less = _less_torque(hunt, refusal)
    space: dict[str, float] = {}
    still: dict[str, tuple[str, ...]] = {}
    torques = ratio = None
    if less.found is not None:
        hunt.say(f"What fits at least: {Torques.of(less.found).words}.")
        hunt.say("looking for more torque that still fits")
        torques = Torques.of(_more_again(hunt, less.found, refusal))
    slower = less_speed(hunt, refusal, lambda own: _tried(hunt, own).found)
    looser = looser_figures(hunt, refusal, partial(_answer, hunt))
    if looser.short:
        still[f"any {listed([*looser.keys])}"] = looser.short
    weak = isinstance(refusal, MotorShortError)
    if weak or refusal.cool_ratio:
        ratio, tried, short = other_ratio(hunt, refusal, partial(_at_ratio, hunt, asked))
        if short:
            still[f"ratio {tried}"] = short
    if not (weak or less.hopeless or far_short(refusal)):
        # What torque nobody stated has to fit is not known before a search.
        doubtful = PEAK in asked.derived or _Way(hunt, None, refusal).doubtful
        for key, limit in _limits(hunt):
            hunt.say(f"looking for the least {key} that fits, up to {1e3 * limit:g} mm")
            need = _least(less.hunt, asked, key, limit, doubtful=doubtful)
            if need.length is not None:
                space[key] = need.length
            if need.tried is not None and need.beyond_space:
                still[f"{key} {1e3 * need.tried:g} mm"] = need.beyond_space
    ways = Ways(refusal, asked, torques, slower, looser.figures, ratio, space)
    besides = ""
    if less.refusal not in (None, refusal) and (slower is not None or not ways.words):
        besides = f"Less torque does not help: {_why(less.refusal)}."
    elif not (ways.words or weak or less.hopeless):
        besides = "No larger ring and no longer discs were found that do, by the whole verdict."
    if still:
        words = _titles(line for lines in still.values() for line in lines)
        besides += f" With {' or '.join(still)} it is still short of {words}."
    return replace(ways, besides=besides.strip(), in_vain=tuple(hunt.in_vain)).told()


def _at_ratio(hunt: Hunt, asked: Requirements, ratio: int) -> tuple[bool, tuple[str, ...]]:
    """Whether a design is found at another ratio, and the lines that it falls short of."""
    changed = asked.unchecked_copy({"ratio": ratio})
    way = _tried(replace(hunt, tables=stage_tables(ratio)), changed)
    return way.found is not None, way.short


def _less_torque(hunt: Hunt, refusal: SizingInfeasibleError) -> _Way:
    """A search for torques that fit: less of that alone which is short, where that is enough."""
    asked, short = hunt.requirements, set(refusal.binding)
    if isinstance(refusal, MotorShortError):
        # A continuous torque that is stated stays where the motor holds it.
        for torques in dict.fromkeys(
            (frozenset({PEAK, *asked.derived}), frozenset({PEAK, CONTINUOUS}))
        ):
            way = _tried(hunt, first_guess(asked.deriving(*torques), hunt.motor))
            if way.found is not None:
                break
        return way
    for change in what_the_judged_has(asked, refusal):
        way = _tried(hunt, asked.unchecked_copy(change))
        if way.found is not None:
            return way
    for torque, lines in ALONE.items():
        if short <= lines:
            way = _tried(hunt, asked.deriving(torque))
            if way.found is not None:
                return way
    return _tried(hunt, asked.deriving(PEAK, CONTINUOUS))


def _more_again(
    hunt: Hunt, found: VerifiedDesign, refusal: SizingInfeasibleError
) -> VerifiedDesign:
    """A design for more than torques that were found to fit, by a few searches between.

    Torques that are lowered go down in strides, and a design that just fails is eased on and on;
    another may bear what lies between. Where a search that fails says about what is borne, no more
    than that is tried. What is told is no bound: close to it a search finds some torques and not
    others.
    """
    asked = hunt.requirements
    too_much = {key: getattr(asked, key) for key in (PEAK, CONTINUOUS) if key not in asked.derived}
    if isinstance(refusal, MotorShortError) and PEAK_LINE in refusal.binding:
        too_much[PEAK] = asked.ratio * refusal.torque
    held: set[str] = set()
    for _ in range(_RISES):
        fits = {key: getattr(found.sizing.design.requirements, key) for key in too_much}
        steps = {key: between(fits[key], most) for key, most in too_much.items()}
        raised = {key for key, torque in steps.items() if torque != fits[key]}
        if not raised:
            break
        # What the motor itself falls short of does not keep the other torque down.
        raised -= held if raised - held else set()
        more = asked.unchecked_copy(fits | {key: steps[key] for key in raised})
        way = _tried(hunt, more)
        if way.found is not None:
            found = way.found
            continue
        alone = short_alone(way.refusal) & raised
        if raised - alone:
            held |= alone
        share = share_borne(way.refusal, more)
        too_much |= {key: max(share * steps[key], fits[key]) for key in alone or raised}
    return found


def _why(refusal: InfeasibleError) -> str:
    """In words."""
    if isinstance(refusal, SizingInfeasibleError):
        return f"the nearest is short of {_titles(refusal.binding)}"
    return refusal.message.rstrip(".")


def _titles(lines: Iterable[str]) -> str:
    words = (WORDS.get(one, CHECK_GUIDE[one].title.lower()) for one in lines)
    return listed(list(dict.fromkeys(words)))


def _tried(hunt: Hunt, asked: Requirements) -> _Way:
    """A search of its own for other requirements, never for more than they ask, for any design."""
    own = _new(hunt, asked)
    own.lowered = own.any_will_do = True
    try:
        found = searched(own, asked)
    except InfeasibleError as refusal:
        _let_go(refusal)
        hunt.in_vain.append(asked)
        return _Way(_without_designs(own), None, refusal)
    finally:
        give_memory_back()
    return _Way(_without_designs(own), found, None)


def _let_go(refusal: InfeasibleError) -> None:
    """Of the frames of its search, which hold designs for as long as a refusal is kept."""
    refusal.__traceback__ = refusal.__context__ = refusal.__cause__ = None


def _without_designs(hunt: Hunt) -> Hunt:
    """What a hunt has learnt, without the designs that it has come by, which are large."""
    return replace(hunt, solved=[], known={}, answered={}, rigid=None, calm=None)


def _answer(
    hunt: Hunt, asked: Requirements
) -> tuple[VerifiedDesign | None, InfeasibleError | None]:
    way = _tried(hunt, asked)
    return way.found, way.refusal


def _new(hunt: Hunt, asked: Requirements) -> Hunt:
    """A hunt for other requirements that has learnt nothing and says nothing."""
    return Hunt(asked, hunt.motor, hunt.ambient, lambda _: None, hunt.tables, hunt.goal)


def _limits(hunt: Hunt) -> Iterator[tuple[str, float]]:
    """Keys of the space, and how large they may become, m."""
    asked = hunt.requirements
    bore = hunt.motor_row.bore_diameter
    ring = _MOST * asked.outer_diameter if bore is None else largest_ring(bore)
    for key, most in (("outer_diameter", ring), ("length", _MOST * asked.length)):
        limit = math.floor(most / _STEP + _ROUNDING) * _STEP
        if limit > getattr(asked, key) + 0.5 * _STEP:
            yield key, round(limit, 9)


def _bears(hunt: Hunt, asked: Requirements) -> bool:
    """Whether the equilibrium bears a design out, with what the hunt knows of part errors.

    For hardly any torque where none was stated: a search lowers it as far as it has to. The cam
    bearing that did last time is tried first, else the one that was looked at last: all others are
    in vain more often than not, and take most of the time.
    """
    any_torque = PEAK in asked.derived
    some = _new(hunt, weaker(asked, LEAST, LEAST) if any_torque else asked)
    some.extra_of, some.fit = hunt.extra_of, hunt.fit
    some.strongest = hunt.strongest or next(reversed(hunt.extra_of), "")
    try:
        if not any_torque and both_bearable(some) < _NEARLY:
            return False
        found = next(iter(ranked(some, thorough=False)), None)
    except InfeasibleError:
        return False
    if found is None or found.worth[0]:
        return False
    hunt.strongest = next((one.cam for one in some.known.values() if one is found), "")
    return True


def _least(hunt: Hunt, asked: Requirements, key: str, limit: float, *, doubtful: bool) -> _Need:
    """The smallest ring or length with which the verdict is yes, near enough.

    Parameters
    ----------
    doubtful : bool
        Whether the most is tried first: it may not help either, or for less torque than is asked.
    """
    stating = partial(with_length, asked, key)
    if doubtful and (most := _tried(hunt, stating(limit))).found is None:
        return _Need(None, limit, most.beyond_space)
    surely = limit if doubtful else None
    low, known = getattr(asked, key), hunt
    for _ in range(_ROUNDS):
        high = limit
        if not _bears(known, stating(high)):
            return _Need(surely)
        while high > (1.0 + _CLOSE) * low:
            middle = min(_up(math.sqrt(low * high)), round(high - _STEP, 9))
            if middle <= low:
                break
            low, high = (low, middle) if _bears(known, stating(middle)) else (middle, high)
        way = _tried(hunt, stating(high))
        if way.found is not None:
            return _Need(high)
        if way.doubtful and not doubtful:
            return _Need(None, high, way.beyond_space)
        if surely is None:
            # Each length costs a search: not where the most does not do either.
            most = way if high == limit else _tried(hunt, stating(limit))
            if most.found is None:
                return _Need(None, limit, most.beyond_space)
            surely = limit
        # It has learnt what part errors take there.
        low, known = _up(_ON * high) - _STEP, way.hunt
        if low >= limit:
            break
    return _Need(surely)


def with_length(asked: Requirements, key: str, length: float) -> Requirements:
    """The requirements with another ring or length, m, which are then stated."""
    changed = asked.unchecked_copy({key: length})
    changed.model_fields_set.add(key)
    return changed


def _up(length: float) -> float:
    return round(math.ceil(length / _STEP - _ROUNDING) * _STEP, 9)
