"""Torques up to which lines hold, looked for with the models that judge them.

Forces of the contact equilibrium are not in proportion to the torque: where it is less, fewer teeth
and pins share it. Shares of a torque are looked for in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import partial

from cqdd_design.errors import CatalogError, DesignError
from cqdd_design.results import Check

Checks = Iterable[Check]

_LOOKS = 14
"""Torques that are tried for a line; four to six do."""
_FEW_LOOKS = 8
"""The same where a look costs much."""
_NEAR = 1e-3
"""Of a limit, how much may be left of it."""
_CLOSE = 1.02
"""From one torque to another, up to which it is not looked on there."""
ROUGHLY = 5e-3
"""The same where a look costs much."""
SEARCHED_CASES = 8
"""Cases of a duty up to which a share of its torques is looked for."""
_A_LITTLE_LESS = 0.997
_FARTHEST = 8.0
"""By how much a torque is changed at once."""


def torques_that_hold(
    checks_at: Callable[[float], Checks],
    torque: float,
    now: Checks,
    *,
    every: bool = False,
    near: float = _NEAR,
) -> dict[str, float]:
    """The most torque at which every line that fails would hold, N m; 0 where none was found.

    Parameters
    ----------
    checks_at : callable
        Lines at a torque, N m.
    torque : float
        Where `now` was judged, N m.
    now : iterable of Check
        Lines, of which those that fail are looked at.
    every : bool
        Whether those that hold are looked at too.
    near : float
        Of a limit, how much may be left of it.
    """
    told = {
        check.id: check.margin for check in now if check.known and (every or check.status == "fail")
    }
    tried = {torque: told}

    def margin(check_id: str, at: float) -> float:
        if at not in tried:
            try:
                tried[at] = {check.id: check.margin for check in checks_at(at) if check.known}
            except (CatalogError, DesignError):
                tried[at] = {}
        return tried[at].get(check_id, 0.0)

    return {check_id: most_that_holds(partial(margin, check_id), tried, near) for check_id in told}


def most_that_holds(
    margin: Callable[[float], float], tried: Iterable[float], near: float = _NEAR
) -> float:
    """The most of a torque, or of what acts like one, whose margin is 1; 0 where none was found.

    Parameters
    ----------
    margin : callable
        At a value; 0 where it does not hold and nothing says by how much.
    tried : iterable of float
        Where to start from: values whose margins are known, or quickly told again.
    near : float
        Of the limit, how much may be left of it.
    """
    known = {at: margin(at) for at in tuple(tried)}
    in_a_row, few = 0, _LOOKS if near < ROUGHLY else _FEW_LOOKS
    for look in range(_LOOKS):
        above = min((at for at, value in known.items() if value < 1.0), default=math.inf)
        below = max((at for at, value in known.items() if value >= 1.0 and at < above), default=0.0)
        if below and (known[below] < 1.0 + near or above / below < 1.0 + near):
            return below
        if look >= few and (not below or above / below < _CLOSE):
            break
        if math.isinf(above):
            at = _higher(known, below, near)
        elif below and in_a_row > 1:
            # Where a margin jumps, as where other screws are drawn, a line leads nowhere.
            at = math.sqrt(below * above)
        else:
            at = _between(known, below, above, near) if below else _lower(known, above, near)
        known[at] = margin(at)
        in_a_row = in_a_row + 1 if known[at] >= 1.0 else 0
    return max((at for at, value in known.items() if value >= 1.0), default=0.0)


def borne_out(found: float, holds: Callable[[float], bool]) -> float:
    """A torque, or a share, that holds with all that a layout changes for it; 0 where none does.

    A search that leaves the layout as it is ends beside it: less torque has other screws.
    """
    for _ in range(_LOOKS):
        if not found or holds(found):
            return found
        found *= _A_LITTLE_LESS
    return 0.0


def _lower(known: dict[float, float], above: float, near: float) -> float:
    """A torque below one that is too much, by the slope from the next one above."""
    beyond = min((at for at in known if at > above and known[at] > 0.0), default=0.0)
    if known[above] <= 0.0:
        return above / _FARTHEST
    slope = 1.0
    if beyond and known[beyond] < known[above]:
        slope = math.log(known[above] / known[beyond]) / math.log(beyond / above)
    share = math.exp(math.log(known[above] * (1.0 - 0.5 * near)) / slope)
    return above * max(min(share, 0.999), 1.0 / _FARTHEST)


def _higher(known: dict[float, float], below: float, near: float) -> float:
    """A torque above one that holds, by the slope from the next one below."""
    beneath = max((at for at in known if at < below), default=0.0)
    slope = 1.0
    if beneath and known[below] < known[beneath]:
        slope = math.log(known[beneath] / known[below]) / math.log(below / beneath)
    share = math.exp(math.log(known[below] / (1.0 + 0.5 * near)) / slope)
    return below * max(min(share, _FARTHEST), 1.001)


def _between(known: dict[float, float], below: float, above: float, near: float) -> float:
    """A torque between one that holds and one that does not, where a line in logarithms hits 1."""
    wide = math.log(above / below)
    if known[above] <= 0.0:
        return math.sqrt(below * above)
    part = (math.log(known[below]) - 0.5 * near) / math.log(known[below] / known[above])
    return below * math.exp(wide * min(max(part, 0.02), 0.98))
