"""Less torque where none was stated and no gearbox bears what the motor could do."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple

from cqdd_design.design import Requirements
from cqdd_design.design.requirements import LEAST_LASTING, LEAST_TORQUE
from cqdd_design.errors import InfeasibleError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.agreement import strongest
from cqdd_design.sizing.choose import strong_bearings
from cqdd_design.sizing.finish import torque_reserve
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import Found, Space, spaces

_LESS, _HALF, _TURNS = 0.95, 0.5, 16
"""Share of both torques that is tried next where the strongest design would bear them, the least
where shafts would not, and how often."""
_MUCH_LESS, _AGAIN = 0.8, 1.05
"""Share that is tried next below which torques between are tried again, and the least step up."""
_SHARES = (1.0, 0.6, 0.35, 0.2)
"""Of both torques at which something is looked for that bears more, or less, than them."""
_STRONG = 5
"""Cam bearings of a space that are asked what they bear."""
JUST, _WELL = 0.98, 0.96
"""Of what the strongest design bears, without and with reserve for part errors."""
_CERTAIN = 0.97
"""Share that the strongest design bears below which a first search would find nothing: what closed
forms take for the strongest is that within a few per cent."""
_CLOSE = 1.1
"""Likewise, below which it is the strongest design that is promising."""
LEAST = 0.1
"""Share of a torque that is tried at least."""
_DIGITS = 2
LASTING = ("-CONTINUOUS", "-LIFE")
"""Ends of the lines at the continuous torque."""


def or_weaker(
    hunt: Hunt, search: Callable[[], Found | None], near: Found | None = None
) -> Found | None:
    """A search, repeated for less torque where none was stated and none is carried.

    Parameters
    ----------
    near : Found, optional
        A design near by, whose space and needs count.
    """
    if PEAK not in hunt.requirements.derived:
        return search()
    lowered: tuple[bool, bool] = (False, False)
    looked = False
    first = bearable(hunt, None) if near is None else Borne(math.inf, math.inf)
    if first.least < _CLOSE:
        hunt.strongest = first.cam
    if near is None and first.lasting < _CERTAIN and (least := _of_the_duty(hunt.requirements)):
        most, hunt.requirements = hunt.requirements, least
        found = search()
        return None if found is None else _more_again(hunt, search, found, most)
    too_much: Requirements | None = None
    for turn in range(_TURNS):
        hopeless = turn == 0 and first.least < _CERTAIN
        found = None if hopeless else search()
        if found is not None:
            return found if too_much is None else _more_again(hunt, search, found, too_much)
        if hunt.short_of and not looked:
            looked = True
            if _in_vain(hunt, search):
                break
        peak, lasting, hunt.strongest = first if hopeless else bearable(hunt, near)
        too_much = None
        if min(peak, lasting) < 1.0:
            lowered = lowered[0] or peak < 1.0, lowered[1] or lasting < 1.0
            # What errors ask for differs from design to design.
            part = _WELL if hunt.has_extra else JUST
            peak, lasting = (part * one if one < 1.0 else one for one in (peak, lasting))
        else:
            # Of what has been too much so far, and in the end of both.
            both = not any(lowered) or turn >= _TURNS // 2
            less = max(min(_LESS, hunt.shaft_bears), _HALF)
            too_much = hunt.requirements if less < _MUCH_LESS else None
            peak, lasting = (less if both or one else 1.0 for one in lowered)
        # What was lowered for part errors is not raised to what the motor holds.
        if hunt.has_extra and lasting < 1.0:
            hunt.lowered, hunt.lowered_by = True, ""
        hunt.requirements = weaker(hunt.requirements, peak, lasting)
    return None


def _of_the_duty(asked: Requirements) -> Requirements | None:
    """With no more peak torque than the duty has: that is stated, and is not to be lowered."""
    greatest = max((abs(one.torque) for one in asked.load_cases), default=math.inf)
    if greatest >= asked.peak_torque:
        return None
    lasting = min(asked.continuous_torque, greatest)
    return asked.unchecked_copy({PEAK: greatest, CONTINUOUS: lasting})


def _more_again(
    hunt: Hunt, search: Callable[[], Found | None], found: Found, too_much: Requirements
) -> Found:
    """A design for more torque than was found, but less than what shafts were far too weak for.

    Shafts of other cam bearings than those that were the best for that may bear nearly all of it.
    """
    while too_much.peak_torque > _AGAIN * hunt.requirements.peak_torque:
        least = hunt.requirements
        share = math.sqrt(least.peak_torque / too_much.peak_torque)
        hunt.requirements = weaker(too_much, share, share)
        if hunt.requirements.peak_torque in {least.peak_torque, too_much.peak_torque}:
            hunt.requirements = least
            break
        more = search()
        if more is None:
            too_much, hunt.requirements = hunt.requirements, least
        else:
            found = more
    return found


def _in_vain(hunt: Hunt, search: Callable[[], Found | None]) -> bool:
    """Whether all designs are short of what no less torque helps with hardly any torque, too."""
    asked = hunt.requirements
    hunt.requirements = weaker(asked, LEAST, LEAST)
    found = search()
    hunt.requirements = asked
    return found is None and bool(hunt.short_of)


def weaker(requirements: Requirements, peak: float, lasting: float) -> Requirements:
    """The requirements with shares of the torques that were not stated.

    Parameters
    ----------
    peak, lasting : float
        Of the peak and of the continuous torque; this is never left above that, nor that below the
        greatest torque of a duty.
    """
    most = requirements.peak_torque
    if PEAK in requirements.derived and peak < 1.0:
        greatest = max((abs(one.torque) for one in requirements.load_cases), default=LEAST_TORQUE)
        most = max(rounded_down(peak * most, _DIGITS), min(greatest, most))
    least = requirements.continuous_torque
    if CONTINUOUS in requirements.derived:
        least = min(rounded_down(lasting * least, _DIGITS) if lasting < 1.0 else least, most)
        least = max(least, LEAST_LASTING)
    return requirements.unchecked_copy({PEAK: most, CONTINUOUS: least})


class Borne(NamedTuple):
    """Shares of the peak and of the continuous torque that a design bears, and its cam bearing.

    Over those that are asked for; the designation is empty where there is no design.
    """

    peak: float
    lasting: float
    cam: str = ""

    def of(self, peak: float, lasting: float) -> Borne:
        """Shares of torques of which so much was asked for."""
        return Borne(max(peak * self.peak, LEAST), max(lasting * self.lasting, LEAST), self.cam)

    @property
    def least(self) -> float:
        """The lesser share."""
        return min(self.peak, self.lasting)

    @property
    def both(self) -> float:
        """Product of the shares, each of 1 at most."""
        return min(self.peak, 1.0) * min(self.lasting, 1.0)


def bearable(hunt: Hunt, near: Found | None) -> Borne:
    """Shares of the peak and of the continuous torque that the strongest design bears.

    The strongest is no stronger at one torque than it has to be for the other; where it is short
    of both, one that has to bear less of what it is shortest of may bear more of the other.
    """
    asked = hunt.requirements
    for share in _SHARES:
        found = _strongest(replace(hunt, requirements=weaker(asked, share, share)), near)
        if found is not None:
            break
    else:
        return Borne(_SHARES[-1], _SHARES[-1])
    first = found.of(share, share)
    if max(first.peak, first.lasting) >= 1.0:
        return first
    peak, lasting = (
        (JUST * first.peak, 1.0) if first.peak < first.lasting else (1.0, JUST * first.lasting)
    )
    second = _strongest(replace(hunt, requirements=weaker(asked, peak, lasting)), near)
    if second is None:
        return first
    return max(first, second.of(peak, lasting), key=lambda one: one.both)


def both_bearable(hunt: Hunt) -> float:
    """About what share of both torques, stated or not, the strongest design bears."""
    for share in _SHARES:
        found = _strongest(replace(hunt, requirements=times(hunt.requirements, share)), None)
        if found is not None:
            return share * found.least
    return _SHARES[-1]


def times(requirements: Requirements, share: float) -> Requirements:
    """The requirements with a share of both torques, stated or not."""
    changed = {key: share * getattr(requirements, key) for key in (PEAK, CONTINUOUS)}
    return requirements.unchecked_copy(changed)


def _strongest(hunt: Hunt, near: Found | None) -> Borne | None:
    """Reserves of both torques with whichever of the strong cam bearings bears most.

    Of the spaces that are tried, or of one near by; None where nothing survives a screen.
    """
    if near is None:
        every: Iterable[Space] = spaces(hunt.requirements, hunt.fit, hunt.pins)
    else:
        every = (near.space.anywhere._replace(fit=hunt.fit),)
    needs = {} if near is None else near.needs
    kinds = [kind for space in every for kind in strong_kinds(hunt, space, needs)]
    found = (_in_space(hunt, kind, needs) for kind in kinds)
    return max((one for one in found if one is not None), key=lambda one: one.least, default=None)


def strong_kinds(hunt: Hunt, space: Space, needs: Mapping[str, float]) -> list[Space]:
    """A space with each of the cam bearings that bear most by a screen."""
    try:
        search = Search.of(hunt.frame(space, needs), hunt.tables)
    except InfeasibleError:
        return []
    strong = strong_bearings(search.frame, search.space, search.found)
    return [space._replace(cam=one) for one in strong[:_STRONG]]


def _in_space(hunt: Hunt, space: Space, needs: Mapping[str, float]) -> Borne | None:
    try:
        strong = strongest(hunt, space, needs)
    except InfeasibleError:
        strong = None
    if strong is None:
        return None
    design = strong.machine.design
    extra = hunt.extra_for(design.reducer.cam_bearing.designation)
    reserves = {
        line.id: torque_reserve(line, design) / extra.get(line.id, 1.0)
        for line in strong.checks
        if line.known
    }
    lasting = [one for name, one in reserves.items() if name.endswith(LASTING)]
    peak = [one for name, one in reserves.items() if not name.endswith(LASTING)]
    return Borne(min(peak, default=1.0), min(lasting, default=1.0), space.cam)
