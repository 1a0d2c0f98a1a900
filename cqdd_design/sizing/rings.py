"""Designs of one kind in rings of several diameters: the best of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.agreement import settled
from cqdd_design.sizing.hunt import CAM, Hunt
from cqdd_design.sizing.known import key_of, near_by, note
from cqdd_design.sizing.shafts import with_sound_ends
from cqdd_design.sizing.spaces import Found, Space

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
NOT_FAR, _WIDER, _LESS_THROW, _SPARE = 0.4, (1.01, 1.02, 1.04), (0.97, 0.9), 1.01
"""From which margin of the shaft's lines wider rings and less eccentricity are tried, how much
wider and less, and how much less load on the cam bearing than the margin says."""
_NOT_FAR_STATED = 0.3
"""That margin where a peak torque was stated, and is not lowered instead."""
FAR_SHORT = 0.6
"""Margin of bearings at a shaft's ends below which rings that are a little wider do not help."""


class Rings:
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
        own = hunt.known.get(key_of(space))
        near = own or near_by(hunt, space)
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
        lowered = PEAK in self._hunt.requirements.derived
        if margin < (NOT_FAR if lowered else _NOT_FAR_STATED):
            return found
        return min(self._stronger(found, margin), key=lambda one: one.worth, default=found)

    def _stronger(self, weak: Found, margin: float) -> Iterator[Found]:
        """Designs beside one whose shaft is weak that has what it lacks."""
        for factor in _WIDER if margin >= FAR_SHORT else ():
            wider = self.at(min(factor * weak.ring, self._most))
            if wider is not None and not wider.weak:
                yield wider
                break
        throw, space = weak.sized.design.reducer.eccentricity, self._space
        (cam,) = [one for one in self._hunt.held_against(weak.sized.machine)[1] if one.id == CAM]
        bears = cam.margin / self._hunt.extra_for(weak.cam).get(CAM, 1.0)
        for changed in (
            *(space._replace(throw=less * throw) for less in _LESS_THROW),
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
        held = self.at(found.ring)
        if held is not None and held.weak:
            # Held fast, what is lighter won; what was free may leave the shaft's ends more room.
            space = self._space._replace(ring_limit=found.ring)
            free = with_sound_ends(replace(found, space=space))
            if not free.weak:
                self._tried[found.ring] = held = free
        return held or self.at(min(_ROOMIER * found.ring, self._most))

    def at(self, ring: float) -> Found | None:
        """The best in a ring of a diameter, m, that the equilibrium bears out."""
        for other, found in self._tried.items():
            if abs(ring - other) < _NO_STEP * other:
                return found
        rounds = _FIRST_ROUNDS if self._point is None else _ROUNDS
        found = self._settled(self._space._replace(ring_limit=ring), rounds)
        if found is not None:
            found = with_sound_ends(found)
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
    rings = Rings(hunt, found.space._replace(ring_limit=math.inf), None)
    for step in _STEPS:
        smaller = rings.walked(found, 1.0 - step)
        found = smaller or rings.walked(found, 1.0 / (1.0 - step)) or found
    hunt.known[key_of(found.space)] = found
    note(hunt, found.space.kind, found, found.worth[1], fine=True)
    return found
