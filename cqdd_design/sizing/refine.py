"""Local search over grid points, many starts at once.

Every start moves to the best of its 81 neighbours until none is better, with steps that halve
down to the grid. Nothing is random, and ties go to the first neighbour, so the same requirements
always give the same design.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.choose import Picks
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.ring_stages import Pins

IntArray = NDArray[np.intp]

_MOST_ROUNDS = 60
_FIRST_STEP = 0.03
"""First steps, as a share of the sizes themselves."""
_SPARE_STEP = 4
_MOVES = np.array(
    [(i, j, k) for i in (0, 1, -1) for j in (0, 1, -1) for k in (0, 1, -1)], dtype=np.intp
)
_THICKER = np.array([0, 1, -1], dtype=np.intp)
_SHORT = 1e9
"""Rank of a point that misses the wanted reserve; above any objective."""


@dataclass(frozen=True)
class Starts(Columns):
    """Where local searches begin, and what each has to reach.

    Attributes
    ----------
    steps : array of int (S, 4)
    pin_count, pin_size : array of int (S,)
    wanted : array (S,)
        Torque reserve; infinite to make it as large as can be.
    """

    steps: IntArray
    pin_count: IntArray
    pin_size: IntArray
    wanted: FloatArray

    @classmethod
    def of(cls, evaluator: Evaluator, picks: Picks, wanted: float) -> Starts:
        """Grid points nearest to picked sizes."""
        room = shapes.largest_pitch_for_wall(
            evaluator.frame, picks.eccentricity, picks.tooth_radius
        )
        sizes = [
            picks.eccentricity,
            picks.tooth_radius,
            np.maximum(room - picks.pitch_radius, 0.0),
            picks.thickness,
        ]
        steps = np.round(np.stack(sizes, axis=1) / evaluator.grid.steps)
        return cls(
            np.maximum(steps, [1, 1, 0, 1]).astype(np.intp),
            picks.pin_count,
            picks.pin_size,
            np.full(picks.count, wanted),
        )

    @classmethod
    def at(cls, points: Points, wanted: float) -> Starts:
        """Points that were found before."""
        return cls(
            points.steps,
            points.pin_count,
            points.pin_size,
            np.full(points.reserve.size, wanted),
        )

    @classmethod
    def other_pins(cls, point: Points, pins: list[tuple[int, int]], wanted: float) -> Starts:
        """One point (1,) with each of some pin counts and rows of ``frame.pin_sizes``."""
        times = len(pins)
        counts, sizes = np.array(pins, dtype=np.intp).T
        return cls(np.repeat(point.steps, times, axis=0), counts, sizes, np.full(times, wanted))

    def wanting(self, wanted: float) -> Starts:
        """The same starts with another aim."""
        return replace(self, wanted=np.full(self.wanted.size, wanted))


def climb(evaluator: Evaluator, starts: Starts) -> Points:
    """The best point each start reaches.

    Below the wanted reserve more reserve is better; from there on less of the objective.

    Returns
    -------
    Points (S,)
    """
    pins = Pins.of(evaluator.frame, starts.pin_count, starts.pin_size)
    first = np.maximum(_FIRST_STEP * starts.steps, 1.0)
    first[:, 2] = _SPARE_STEP
    stride = (2.0 ** np.round(np.log2(first))).astype(np.intp)
    best = _best_neighbours(evaluator, starts.steps, 0 * stride, pins, starts.wanted)[0]
    moving = np.arange(starts.wanted.size)
    for _ in range(_MOST_ROUNDS):
        found, stays = _best_neighbours(
            evaluator,
            best.steps[moving],
            stride[moving],
            pins.rows(moving),
            starts.wanted[moving],
        )
        best = best.replaced(moving, found)
        # Staying calls for finer steps, and on the grid itself it is the end.
        settled = stays & (stride[moving] == 1).all(axis=1)
        stride[moving[stays]] = np.maximum(stride[moving[stays]] // 2, 1)
        moving = moving[~settled]
        if moving.size == 0:
            break
    return best


def _best_neighbours(
    evaluator: Evaluator, steps: IntArray, stride: IntArray, pins: Pins, wanted: FloatArray
) -> tuple[Points, NDArray[np.bool_]]:
    """Best of each point's neighbours and itself, and whether it is the point itself."""
    count = wanted.size
    ring = steps[:, None, :3] + _MOVES * stride[:, None, :3]
    thickness = steps[:, 3, None] + _THICKER * stride[:, 3, None]
    aims = np.repeat(wanted, len(_MOVES))
    tried = evaluator.evaluate(
        ring.reshape(-1, 3),
        np.repeat(thickness, len(_MOVES), axis=0),
        pins.rows(np.repeat(np.arange(count), len(_MOVES))),
        aims,
    )
    ranks = rank(tried, np.repeat(aims, _THICKER.size)).reshape(count, -1)
    chosen = ranks.argmin(axis=1)
    # The first neighbour is the point itself.
    return tried.rows(np.arange(count) * ranks.shape[1] + chosen), chosen == 0


def best_rows(points: Points, most: int) -> Points:
    """Up to so many different points, those that are nearest to a reserve of one or best."""
    apart = points.different()
    order = np.argsort(rank(apart, np.ones(apart.count)), kind="stable")
    return apart.rows(order[:most])


def rank(points: Points, wanted: FloatArray) -> FloatArray:
    """What `climb` makes small."""
    short = np.where(points.reserve > 0.0, _SHORT - points.reserve, np.inf)
    return np.where(points.reserve >= wanted, points.objective, short)
