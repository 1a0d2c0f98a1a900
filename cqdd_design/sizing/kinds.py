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
from cqdd_design.sizing.agreement import settled, tightest
from cqdd_design.sizing.choose import by_bearing
from cqdd_design.sizing.hunt import CAM, FITS, Answer, Found, Hunt, Space, spaces
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import ENDS, THICKNESS, weak_lines

_SLACK = 1.08
"""A screen's objective over the best so far beyond which a bearing cannot win: screens are
coarse."""
_UNSCREENED = 1.15
"""Objective over that of a screen without needs, of a bearing that a screen with needs leaves
out."""
_STEPS = (0.01, 0.005)
"""By how much of its diameter the next ring is smaller or larger: finer ones from the best."""
_ROOMIER = 1.004
"""Of a ring in which closed forms and equilibrium agreed, where a ring held fast is too tight."""
_NO_STEP = 1e-3
"""By how much, as a share, a ring has to differ from those that have been tried."""
_ROUNDS = 4
"""Of closed forms against the equilibrium: beside a design that both agree on they agree at once,
or not at all."""
_FIRST_ROUNDS = 6
_MAY_WIN = 1.06
"""Objective by closed forms over the best so far, up to which a ring may hold a better design."""
_FINE = 1.025
"""Objective over the best so far up to which finer steps of the ring may make up for it."""
_NOT_FAR, _WIDER, _LESS_THROW, _SPARE = 0.4, (1.01, 1.02, 1.04), (0.97, 0.9), 1.01
"""From which margin of the shaft's lines wider rings and less eccentricity are tried, how much
wider and less, and how much less load on the cam bearing than the margin says."""
_HOPELESS = 0.85
"""Margin of a shaft below which thinner ones are too weak as well."""
_NO_HOPE = 6
"""Cam bearings that have been looked at after which none is hoped to need far less than they."""
_FAR_SHORT, _ALIKE = 0.7, 1.15
"""Margin of bearings at a shaft's ends below which wider rings and less eccentricity hardly help,
nor cam bearings of the same kind whose bores are wider or narrower by less than a factor."""


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
        if _shaft_margin(strong) < _NOT_FAR:
            hunt.short_of = strong.weak
            return None
    if best is None or best.weak:
        best = _hoped_for(hunt) or best
    if best is None:
        hunt.trusting = not hunt.has_extra
        best = tightest(hunt)
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
        for kind in _kinds(hunt, space, _near(hunt, space))
        if not hunt.settling or kind.space.cam in hunt.extra_of
    ]
    found: list[Found] = []
    best: Found | None = None
    screened = {space for space in tried if _own(hunt, space)}
    while kinds:
        kind = min(kinds, key=lambda one: _turn(hunt, one))
        kinds.remove(kind)
        if best is not None and kind.objective > _SLACK * best.worth[1]:
            break
        place = kind.space.anywhere
        if _is_too_weak(hunt, kind):
            continue
        known, one = _answered(hunt, kind.space)
        if not known:
            if best is not None and _least(hunt, kind.space) > best.worth[1]:
                continue
            rings = _Rings(hunt, kind.space, best)
            one = rings.any()
            if thorough:
                _note(hunt, kind.space, one, rings.least(one))
        if one is None:
            continue
        found.append(one)
        if one.weak:
            hunt.too_weak[kind.space.disc_count, kind.bore] = _bears(hunt, one)
            _note_ends(hunt, kind, one)
            continue
        hunt.known[_key(kind.space)] = one
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

    Torques that nobody stated are lowered instead, then to what the best of them bears.
    """
    best = next(iter(every), None)
    hopeless = best is not None and _shaft_margin(best) < _HOPELESS
    hunt.shaft_bears = max(map(_shaft_margin, every)) / _HOPELESS if hopeless else 1.0
    return None if hopeless else best


def _shaft_margin(found: Found) -> float:
    """The least margin of what is too weak of a design's shaft."""
    return min((line.margin if line.known else 0.0 for line in found.weak), default=math.inf)


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

    Or one much like it far too small bearings at the shaft's ends.
    """
    peak, own = hunt.requirements.peak_torque, kind.space.disc_count
    return any(
        count == own and kind.bore <= bore and peak > most
        for (count, bore), most in hunt.too_weak.items()
    ) or any(
        (count, family) == (own, kind.family)
        and 1.0 / _ALIKE < kind.bore / bore < _ALIKE
        and _FAR_SHORT * peak > most
        for (count, family, bore), most in hunt.ends_bear.items()
    )


def _note_ends(hunt: Hunt, kind: _Kind, found: Found) -> None:
    """What the bearings at the ends of a weak design's shaft bear, where they tell of others."""
    ends = [line for line in found.weak if line.id == ENDS and line.known]
    if ends and ends[0].margin < _FAR_SHORT:
        place = kind.space.disc_count, kind.family, kind.bore
        hunt.ends_bear[place] = ends[0].margin * hunt.requirements.peak_torque


def _answered(hunt: Hunt, space: Space) -> tuple[bool, Found | None]:
    """Whether a kind's best is known from before, and that: what is asked of it has not changed.

    Where nothing was found, nothing will be for more, nor with more clearance.
    """
    now = hunt.extra_for(space.cam)
    for fit in FITS[: FITS.index(space.fit) + 1]:
        known = hunt.answered.get(space._replace(fit=fit))
        # What lost to another may be the best where that one turns out to be none.
        if known is None or known.fixed != hunt.fixed or known.gave_up:
            continue
        if known.found is None:
            if all(now.get(one, 1.0) >= less for one, less in known.extra.items()):
                return True, None
        elif fit == space.fit:
            return known.extra == now, known.found
    return False, None


def _least(hunt: Hunt, space: Space) -> float:
    """Objective below which nothing of a kind was found, for no more than is asked now."""
    now = hunt.extra_for(space.cam)
    known = (
        hunt.answered.get(space._replace(fit=fit)) for fit in FITS[: FITS.index(space.fit) + 1]
    )
    return max(
        (
            one.least
            for one in known
            if one is not None
            and one.fixed == hunt.fixed
            and all(now.get(each, 1.0) >= less for each, less in one.extra.items())
        ),
        default=0.0,
    )


def _note(
    hunt: Hunt, space: Space, found: Found | None, least: float, *, fine: bool = False
) -> None:
    hunt.answered[space] = Answer(hunt.fixed, hunt.extra_for(space.cam), found, fine, least)


def _key(space: Space) -> Space:
    """A space whatever its rings and its fit."""
    return space.kind._replace(fit=FITS[0])


def _own(hunt: Hunt, space: Space) -> list[Found]:
    """What was found before in a space, the best with each cam bearing."""
    return [one for key, one in hunt.known.items() if key.anywhere == _key(space.anywhere)]


def _near(hunt: Hunt, space: Space) -> Found | None:
    """The best that was found before with any cam bearing: of the space, else of any."""
    every = _own(hunt, space) or hunt.known.values()
    return min(every, key=lambda one: one.worth, default=None)


def _kinds(hunt: Hunt, space: Space, near: Found | None) -> Iterator[_Kind]:
    """Every cam bearing with which something survives a screen, with the needs of one near by."""
    try:
        frame = hunt.frame(space._replace(free=True), {} if near is None else near.needs)
        search = Search.of(frame, hunt.tables)
    except InfeasibleError:
        return
    for one in by_bearing(frame, search.space, search.found):
        own = space._replace(cam=one.bearing.designation)
        known, objective = hunt.known.get(_key(own)), one.objective
        if known is not None and known.sized.objective.goal == hunt.goal:
            # What is asked may have grown since.
            objective = max(known.worth[1], one.objective / _SLACK)
        yield _Kind(own, one.bearing.bore_diameter, one.bearing.kind, objective)


def _screened_anew(kind: _Kind, better: Mapping[str, _Kind]) -> _Kind:
    """What a screen with needs says of a kind."""
    other = better.get(kind.space.cam)
    return replace(kind, objective=_UNSCREENED * kind.objective) if other is None else other


class _Rings:
    """Designs of one kind in rings of several diameters.

    Attributes
    ----------
    gave_up : bool
        Whether something was not looked for because another kind is far better.
    """

    def __init__(self, hunt: Hunt, space: Space, best: Found | None) -> None:
        self._hunt, self._space = hunt, space
        self._rival = None if best is None else (False, _MAY_WIN * best.worth[1])
        frame = hunt.frame(space, {})
        self._most, self._least = 2.0 * frame.outer_radius, 2.0 * frame.least_outer_radius
        self.gave_up = False
        self._tried: dict[float, Found | None] = {}
        own = hunt.known.get(_key(space))
        near = own or _near(hunt, space)
        self._needs = None if near is None else near.needs
        self._point = None if own is None else own.point

    def least(self, found: Found | None) -> float:
        """Objective below which nothing was found."""
        if found is not None:
            return found.worth[1]
        return self._rival[1] if self.gave_up and self._rival is not None else math.inf

    def any(self) -> Found | None:
        """The best in a ring of any size, near enough, else in the largest.

        Where its shaft is weak, but not by far, the best of some in wider rings or with less
        eccentricity, which leaves room for larger bearings at its ends, or with less load on the
        cam bearing.
        """
        found = self._any()
        if found is None or not found.weak:
            return found
        margin = min(line.margin if line.known else 0.0 for line in found.weak)
        if margin < _NOT_FAR:
            return found
        return min(self._stronger(found, margin), key=lambda one: one.worth, default=found)

    def _stronger(self, weak: Found, margin: float) -> Iterator[Found]:
        """Designs beside one whose shaft is weak that has what it lacks."""
        near = margin >= _FAR_SHORT
        for factor in _WIDER if near else ():
            wider = self.at(min(factor * weak.ring, self._most))
            if wider is not None and not wider.weak:
                yield wider
                break
        throw, space = weak.sized.design.reducer.eccentricity, self._space
        (cam,) = [one for one in self._hunt.held_against(weak.sized.machine)[1] if one.id == CAM]
        bears = cam.margin / self._hunt.extra_for(weak.cam).get(CAM, 1.0)
        for changed in (
            *(space._replace(throw=less * throw) for less in _LESS_THROW if near),
            space._replace(quieter=_SPARE * bears / margin),
        ):
            self._space, self._tried = changed, {}
            other = self._free()
            if other is not None and not other.weak:
                yield other
        self._space, self._tried = space, {}

    def _any(self) -> Found | None:
        found = self._free()
        # Where space is so tight that hardly a point is left, a ring held fast finds it.
        tight = found is None and not self.gave_up and self._rival is None
        return self.at(self._most) if tight else found

    def _free(self) -> Found | None:
        found = self._settled(self._space._replace(free=True), _FIRST_ROUNDS)
        if found is None:
            return None
        return self.at(found.ring) or self.at(min(_ROOMIER * found.ring, self._most))

    def at(self, ring: float) -> Found | None:
        """The best in a ring of a diameter, m, that the equilibrium bears out."""
        for other, found in self._tried.items():
            if abs(ring - other) < _NO_STEP * other:
                return found
        rounds = _FIRST_ROUNDS if self._point is None else _ROUNDS
        found = self._settled(self._space._replace(ring_limit=ring), rounds)
        if found is not None:
            found = replace(found, weak=weak_lines(found.sized.machine))
        self._tried[ring] = found
        return found

    def walked(self, found: Found, factor: float) -> Found | None:
        """The last of better and better designs in rings by a factor after one, if there is one."""
        best: Found | None = None
        while True:
            ring = factor * (best or found).ring
            if not self._least * (1.0 - _NO_STEP) <= ring <= self._most * (1.0 + _NO_STEP):
                return best
            one = self.at(min(max(ring, self._least), self._most))
            if one is None or one.weak or one.worth >= (best or found).worth:
                return best
            best = one

    def _settled(self, space: Space, rounds: int) -> Found | None:
        beside = self._point is not None and not space.free
        try:
            found, beaten = settled(
                self._hunt, space, self._rival, self._needs, self._point, rounds, beside=beside
            )
        except InfeasibleError:
            return None
        self.gave_up |= beaten
        if found is not None:
            self._needs, self._point = found.needs, found.point
        return found


def finer(hunt: Hunt, found: Found) -> Found:
    """The best in rings round that of a design, in finer and finer steps."""
    known = hunt.answered.get(found.space.kind)
    if known is not None and known.fine and known.found is found:
        return found
    rings = _Rings(hunt, found.space._replace(ring_limit=math.inf), None)
    for step in _STEPS:
        smaller = rings.walked(found, 1.0 - step)
        found = smaller or rings.walked(found, 1.0 / (1.0 - step)) or found
    hunt.known[_key(found.space)] = found
    _note(hunt, found.space.kind, found, found.worth[1], fine=True)
    return found
