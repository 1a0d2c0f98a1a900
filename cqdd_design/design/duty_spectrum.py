"""A logged duty as a few load cases that do at least the same damage.

Every row of the log is shared out between the two torques of the spectrum next to its own, in
proportion to how near it is. That keeps time, way and energy exactly, and since every power above
one curves upwards, no sum of torques to a power ever gets smaller. Driving and driven, and either
sense of torque, stand apart. Each torque has the mean of the speeds that
came with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from cqdd_design.design.duty_log import DutyLog, FloatArray

EXPONENTS = (3.0, 10.0 / 3.0, 6.6, 9.0)
"""Powers of the torque whose damage is kept: ball and roller bearings (ISO 281), pitting by
ISO 6336-2 (slope 6.6 of the torque) and by AGMA 2101-D04 up to 1e7 cycles (1/(2 x 0.056))."""
CLOSE = 0.01
"""By which damage and mean square of the torque may grow."""
_FINE = 512
_MOST_CASES = 64
_AIM = 0.5
"""Share of `CLOSE` within which torques are left out, before there are too many of them."""


class LoadCase(NamedTuple):
    """Torque, N m, and speed, rad/s, at the output with their signs, and share of the time."""

    torque: float
    speed: float
    share: float


class _Nodes(NamedTuple):
    """Torques of one group of rows, rising sizes, and what is shared out to each."""

    size: FloatArray
    sums: FloatArray
    """(K, 2): time and way, weight times speed."""


@lru_cache(maxsize=4)
def load_cases(log: DutyLog) -> tuple[LoadCase, ...]:
    """The load cases of a log, at most 64; what their shares leave out is rest.

    Way, and work delivered and taken back, are those of the log; the mean square of the torque and
    damage with every one of `EXPONENTS` are those of the log or up to `CLOSE` more. In logs whose
    torques spread evenly over both senses and both ways of power they may be more than that.

    Returns
    -------
    tuple of LoadCase
        By sense of torque, driving before driven, sizes falling.
    """
    weight = log.weights / log.cycle_time
    fast = np.abs(log.speed)
    driven = log.torque * log.speed < 0.0
    groups = []
    for sign in (1.0, -1.0):
        for back in (False, True):
            chosen = (np.sign(log.torque) == sign) & (driven == back)
            if sign > 0.0 and not back:
                chosen |= log.torque == 0.0
            if np.any(chosen):
                rows = np.abs(log.torque[chosen]), fast[chosen], weight[chosen]
                groups.append(((sign, back), _fine(*rows)))
    kept = _thinned([nodes for _, nodes in groups])
    cases = []
    for ((sign, back), _), nodes in zip(groups, kept, strict=True):
        turning = -sign if back else sign
        for size, sums in zip(nodes.size[::-1].tolist(), nodes.sums[::-1], strict=True):
            share, way = sums.tolist()
            speed = way / share
            if size or speed:
                cases.append(LoadCase(sign * size, turning * speed if speed else 0.0, share))
    return tuple(cases)


def _fine(size: FloatArray, speed: FloatArray, weight: FloatArray) -> _Nodes:
    """Rows shared out to many even torques from zero to the greatest."""
    top = float(size.max())
    count = _FINE if top > 0.0 else 1
    place = size * (count / top) if top > 0.0 else size
    below = np.minimum(place.astype(np.int64), count - 1)
    up = place - below
    sums = np.empty((count + 1, 2))
    for power in range(2):
        each = weight * speed**power
        sums[:, power] = np.bincount(below, each * (1.0 - up), count + 1)
        sums[:, power] += np.bincount(below + 1, each * up, count + 1)
    there = sums[:, 0] > 0.0
    return _Nodes(np.linspace(0.0, top, count + 1)[there], sums[there])


def _measures(size: FloatArray, sums: FloatArray) -> FloatArray:
    """Mean square of the torque and the damages of every node, (K, M)."""
    return np.stack(
        [sums[:, 0] * size**2, *(sums[:, 1] * size**power for power in EXPONENTS)], axis=1
    )


def _thinned(groups: Sequence[_Nodes]) -> list[_Nodes]:
    """Fewer torques: again and again the one whose going adds least, shared out to its neighbours.

    What each adds is a share of the whole spectrum's mean square and damages, the largest of them.
    """
    group = np.concatenate([np.full(len(g.size), k) for k, g in enumerate(groups)])
    size = np.concatenate([g.size for g in groups])
    sums = np.concatenate([g.sums for g in groups])
    whole = _measures(size, sums).sum(axis=0)
    whole[whole == 0.0] = 1.0
    added = np.zeros(len(whole))
    while len(size) > len(groups):
        costs = _costs(group, size, sums) / whole
        with np.errstate(invalid="ignore"):
            greatest = np.max(added + costs, axis=1)
        k = int(greatest.argmin())
        if not np.isfinite(greatest[k]):
            break
        if len(size) <= _MOST_CASES and greatest[k] > _AIM * CLOSE:
            break
        added = added + costs[k]
        low, high = size[k - 1], size[k + 1]
        up = (size[k] - low) / (high - low)
        sums[k - 1] += (1.0 - up) * sums[k]
        sums[k + 1] += up * sums[k]
        group, size, sums = (np.delete(one, k, axis=0) for one in (group, size, sums))
    return [_Nodes(size[group == k], sums[group == k]) for k in range(len(groups))]


def _costs(group: FloatArray, size: FloatArray, sums: FloatArray) -> FloatArray:
    """What every measure grows by as a node goes, (K, M); inf at the ends of a group."""
    found = np.full((len(size), 1 + len(EXPONENTS)), np.inf)
    inner = np.flatnonzero((group[:-2] == group[1:-1]) & (group[2:] == group[1:-1])) + 1
    low, here, high = size[inner - 1], size[inner], size[inner + 1]
    up = (here - low) / (high - low)
    for column, power in enumerate((2.0, *EXPONENTS)):
        grown = (1.0 - up) * low**power + up * high**power - here**power
        found[inner, column] = sums[inner, min(column, 1)] * grown
    return found
