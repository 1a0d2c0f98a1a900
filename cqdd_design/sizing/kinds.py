"""The best design with each cam bearing, and so the best of all.

One bearing after another, those first that a screen by closed forms makes lightest. A bearing that
is held fast leaves closed forms and equilibrium little to disagree about, so that their loop
settles with rings of any size; a shaft that is too weak, or whose ends no bearing fits, is told
before anything dearer is asked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.agreement import tightest
from cqdd_design.sizing.choose import by_bearing
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.known import answered, key_of, least_of, near_by, note, own_of
from cqdd_design.sizing.rings import FAR_SHORT, NOT_FAR, Rings, finer
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import ANY_TORQUE, ENDS, THICKNESS, with_sound_ends
from cqdd_design.sizing.spaces import Found, Space, spaces

_SLACK = 1.08
"""A screen's objective over the best so far beyond which a bearing cannot win: screens are
coarse."""
_UNSCREENED = 1.15
"""Objective over that of a screen without needs, of a bearing that a screen with needs leaves
out."""
_FINE = 1.025
"""Objective over the best so far up to which finer steps of the ring may make up for it."""
_HOPELESS = 0.85
"""Margin of a shaft below which thinner ones are too weak as well."""
_NO_HOPE = 6
"""Cam bearings that have been looked at after which none is hoped to need far less than they."""
_ALIKE = 1.15
"""Ratio of the bores of cam bearings of the same kind, up to which the narrower leaves no more room
at a shaft's ends. A wider one may leave it for the next larger bearing."""


@dataclass
class _Kind:
    """A space with one cam bearing, and what a search in it may lead to.

    Attributes
    ----------
    space : Space
    bore : float
        Of the bearing, m.
    family : str
        Whether it is a ball bearing, a needle bearing, or a cage.
    objective : float
        As far as is known.
    """

    space: Space
    bore: float
    family: str
    objective: float


def lightest(hunt: Hunt) -> Found | None:
    """The best design of all spaces, cam bearings and rings at the hunt's fit; see `ranked`.

    One whose shaft is too weak where there is no other. Where any will do, `promising`.
    """
    if hunt.any_will_do:
        return promising(hunt)
    if hunt.settling:
        known = next(iter(ranked(hunt)), None)
        if known is not None and not known.worth[0]:
            return known
        hunt.settling = False
    return _best(hunt, ranked(hunt))


def _hoped_for(hunt: Hunt) -> Found | None:
    """The best design with a cam bearing that has not been looked at.

    What part errors ask for with others, or usually, may be too much for it: it is asked for less,
    and has to be looked at. Where many have been, there is no hope left.
    """
    if len(hunt.extra_of) >= _NO_HOPE:
        return None
    hunt.trusting = True
    every = ranked(hunt)
    hunt.trusting = False
    new = [one for one in every if one.cam not in hunt.extra_of and not one.worth[0]]
    return min(new, key=lambda one: one.worth, default=None)


def promising(hunt: Hunt) -> Found | None:
    """A design that will be near the best: enough to learn from it what heat and errors ask for.

    With the cam bearing that a screen makes lightest of those that are borne out; where torques
    were lowered to what the strongest design bears, with that one's.
    """
    return _best(hunt, ranked(hunt, thorough=False))


def _best(hunt: Hunt, every: Sequence[Found]) -> Found | None:
    """The first of some designs, else one that is hoped for, else the tightest.

    Of perfect parts, where no toleranced ones have been looked at; where torques were not stated,
    they are lowered instead.
    """
    if PEAK in hunt.requirements.derived:
        return _with_a_shaft(hunt, every)
    best = next(iter(every), None)
    hunt.short_of = ()
    if best is not None and best.weak:
        strong = max(every, key=_shaft_margin)
        if _shaft_margin(strong) < NOT_FAR:
            hunt.short_of = strong.weak
            return None
    if best is None or best.weak:
        best = _hoped_for(hunt) or best
    if best is None:
        hunt.trusting = not hunt.has_extra
        tight = tightest(hunt)
        best = None if tight is None else with_sound_ends(tight)
        hunt.trusting = False
    return best


def ranked(hunt: Hunt, *, thorough: bool = True) -> list[Found]:
    """The best design with each cam bearing that the equilibrium bears out, the best of all first.

    Parameters
    ----------
    thorough : bool
        Whether every bearing is tried with which a design can be the best, so far as closed forms
        can tell; else the first with which one is sound. Finer rings are tried round the best where
        the hunt is fine.
    """
    tried = list(spaces(hunt.requirements, hunt.fit, hunt.pins))
    kinds = [
        kind
        for space in tried
        for kind in _kinds(hunt, space, near_by(hunt, space))
        if not hunt.settling or kind.space.cam in hunt.extra_of
    ]
    found: list[Found] = []
    best: Found | None = None
    screened = {space for space in tried if own_of(hunt, space)}
    while kinds:
        kind = min(kinds, key=lambda one: _turn(hunt, one))
        kinds.remove(kind)
        if best is not None and kind.objective > _SLACK * best.worth[1]:
            break
        place = kind.space.anywhere
        if _is_too_weak(hunt, kind):
            continue
        known, one = answered(hunt, kind.space)
        if not known:
            if best is not None and least_of(hunt, kind.space) > best.worth[1]:
                continue
            rings = Rings(hunt, kind.space, best)
            one = rings.any()
            if thorough:
                note(hunt, kind.space, one, rings.least(one))
        if one is None:
            continue
        found.append(one)
        if one.weak:
            hunt.too_weak[kind.space.disc_count, kind.bore] = _bears(hunt, one)
            _note_ends(hunt, kind, one)
            continue
        hunt.known[key_of(kind.space)] = one
        if not one.worth[0] and (best is None or one.worth < best.worth):
            best = one
            if not thorough:
                break
        if place not in screened:
            screened.add(place)
            better = {each.space.cam: each for each in _kinds(hunt, place, one)}
            kinds = [
                _screened_anew(each, better) if each.space.anywhere == place else each
                for each in kinds
            ]
    if thorough and hunt.fine and best is not None:
        most = _FINE * best.worth[1]
        found = [one if one.weak or one.worth[1] > most else finer(hunt, one) for one in found]
    return sorted(found, key=lambda one: one.worth)


def _turn(hunt: Hunt, kind: _Kind) -> tuple[bool, float]:
    """What makes a kind's turn come early is less.

    Where torques were lowered to what one cam bearing bears, hardly another bears them; its needs
    tell of the others.
    """
    return kind.space.cam != hunt.strongest, kind.objective


def _with_a_shaft(hunt: Hunt, every: Sequence[Found]) -> Found | None:
    """The first design; None where all shafts are so weak that nothing near by will do.

    Torques that nobody stated are lowered instead, then to what the best of them bears; but not
    where all are short of what no less torque helps.
    """
    best = next(iter(every), None)
    hunt.short_of = ()
    hopeless = best is not None and _shaft_margin(best) < _HOPELESS
    hunt.shaft_bears = max(map(_shaft_margin, every)) / _HOPELESS if hopeless else 1.0
    if hopeless and all(_margin_of_any_torque(one) < _HOPELESS for one in every):
        hunt.short_of = max(every, key=_shaft_margin).weak
    return None if hopeless else best


def _shaft_margin(found: Found) -> float:
    """The least margin of what is too weak of a design's shaft."""
    return min((line.margin if line.known else 0.0 for line in found.weak), default=math.inf)


def _margin_of_any_torque(found: Found) -> float:
    """The least margin of what a weak design is short of whatever its torque.

    Of its rotor's pull, of the way through it, and of ends that no bearing fits.
    """
    lines = (line for line in found.weak if line.id in ANY_TORQUE or not line.known)
    return min((line.margin if line.known else 0.0 for line in lines), default=math.inf)


def _bears(hunt: Hunt, found: Found) -> float:
    """Peak torque beyond which a weak design's shaft is too thin by far, N m.

    Of its bearings nothing is said: beside a wide bore there may be room for thin ones alone.
    """
    thin = [line for line in found.weak if line.id in THICKNESS]
    if not all(line.known for line in thin):
        return 0.0
    margin = min((line.margin for line in thin), default=math.inf)
    return hunt.requirements.peak_torque * margin / _HOPELESS


def _is_too_weak(hunt: Hunt, kind: _Kind) -> bool:
    """Whether a bearing as wide at least was found to leave far too thin a shaft.

    Or one like it and a little wider, far too small bearings at the shaft's ends. But not where a
    design of the kind was found whose shaft is sound.
    """
    if key_of(kind.space) in hunt.known:
        return False
    peak, own = hunt.requirements.peak_torque, kind.space.disc_count
    return any(
        count == own and kind.bore <= bore and peak > most
        for (count, bore), most in hunt.too_weak.items()
    ) or any(
        (count, family) == (own, kind.family)
        and 1.0 / _ALIKE < kind.bore / bore <= 1.0
        and FAR_SHORT * peak > most
        for (count, family, bore), most in hunt.ends_bear.items()
    )


def _note_ends(hunt: Hunt, kind: _Kind, found: Found) -> None:
    """What the bearings at the ends of a weak design's shaft bear, where they tell of others."""
    ends = [line for line in found.weak if line.id == ENDS and line.known]
    if ends and ends[0].margin < FAR_SHORT:
        place = kind.space.disc_count, kind.family, kind.bore
        hunt.ends_bear[place] = ends[0].margin * hunt.requirements.peak_torque


def _kinds(hunt: Hunt, space: Space, near: Found | None) -> Iterator[_Kind]:
    """Every cam bearing with which something survives a screen, with the needs of one near by."""
    try:
        frame = hunt.frame(space._replace(free=True), {} if near is None else near.needs)
        search = Search.of(frame, hunt.tables)
    except InfeasibleError:
        return
    for one in by_bearing(frame, search.space, search.found):
        own = space._replace(cam=one.bearing.designation)
        known, objective = hunt.known.get(key_of(own)), one.objective
        if known is not None and known.sized.objective.goal == hunt.goal:
            # What is asked may have grown since.
            objective = max(known.worth[1], one.objective / _SLACK)
        yield _Kind(own, one.bearing.bore_diameter, one.bearing.kind, objective)


def _screened_anew(kind: _Kind, better: Mapping[str, _Kind]) -> _Kind:
    """What a screen with needs says of a kind."""
    other = better.get(kind.space.cam)
    return replace(kind, objective=_UNSCREENED * kind.objective) if other is None else other
