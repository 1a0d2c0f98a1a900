"""One search in one space: screen, refine, finish."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from cqdd_design.sizing.choose import Picks, lightest, strongest
from cqdd_design.sizing.finish import finish
from cqdd_design.sizing.frame import Frame
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.refine import Starts, climb, rank
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.ring_stages import Pins
from cqdd_design.sizing.screen import Screened, screen
from cqdd_design.sizing.space import SearchSpace, search_space
from cqdd_design.sizing.stage_tables import StageTables, stage_tables

_STRONG_STARTS, _LIGHT_STARTS, _WIDE_STARTS = 12, 3, 16
_EXCHANGES, _EXCHANGED = 4, 3
"""Times that other pins are tried, and at how many points with different bearings."""
FEWER_PINS_WORTH = 0.005
"""Share of the objective that is given up for fewer output pins."""
_AIMS = (1.0005, 1.003, 1.015)
"""Factors on a wanted reserve, tried until the full analysis confirms the design: the tables are
good to about 1e-3."""
OFFERED_RESERVE = 1.05
"""Torque reserve of the design that is offered, where the space allows it: one that stands on its
limits leaves nothing for what the formulas leave out."""
USEFUL_RESERVE = 2.0
"""Torque reserve beyond which no alternative is offered."""


@dataclass(frozen=True)
class Search:
    """A frame with its tables, its search space and the outcome of its screen.

    Attributes
    ----------
    evaluator : Evaluator
        Holds the frame and the tables.
    tables : StageTables
    """

    evaluator: Evaluator
    tables: StageTables
    space: SearchSpace

    @classmethod
    def of(cls, frame: Frame, tables: StageTables | None = None) -> Search:
        """Search the space of a frame; tables of the same ratio may be handed in."""
        tables = stage_tables(frame.lobe_count) if tables is None else tables
        space = search_space(frame, tables)
        return cls(Evaluator.of(frame, tables, space.pin_counts), tables, space)

    @cached_property
    def found(self) -> Screened:
        """The outcome of the screen, when it is first asked for."""
        return screen(self.frame, self.tables, self.space)

    @property
    def frame(self) -> Frame:
        """What the requirements fix."""
        return self.evaluator.frame

    def at(self, point: Points) -> Points:
        """A point (1,) of another search with its own ring and discs, and the bearing of this one.

        The best that carries as much as the point does, else the strongest.
        """
        pins = Pins.of(self.frame, point.pin_count, point.pin_size)
        thickness = point.steps[:, 3, None]
        return self.evaluator.evaluate(point.steps[:, :3], thickness, pins, 0.999 * point.reserve)

    def most_reserve(self) -> Points | None:
        """The point with the most torque reserve; None where no shape fits."""
        picks = strongest(self.space, self.found, _STRONG_STARTS)
        if picks.count == 0:
            return None
        reached = climb(self.evaluator, Starts.of(self.evaluator, picks, np.inf))
        return reached.rows(np.array([reached.reserve.argmax()]))

    def lightest(
        self, starts: Points, wanted: float = 1.0, suffix: str = "", *, wide: bool = False
    ) -> tuple[SizedDesign, Points] | None:
        """The design with the least objective that meets every check, and its point.

        Parameters
        ----------
        starts : Points
            Where to begin besides the best survivors of the screen; never empty, since a tight
            space may leave no survivor although its best point refines to one.
        wanted : float
            Torque reserve to have.
        suffix : str
            Of the design's name.
        wide : bool
            Whether to begin at many places and to try other pins at what they lead to, which takes
            ten times as long.
        """
        begin = self.beginning(starts, wanted, wide=wide)
        return self.lightest_from(begin, wanted, suffix, wide=wide)[0]

    def beginning(self, starts: Points, wanted: float = 1.0, *, wide: bool = False) -> Starts:
        """Where `lightest` begins: at these points, and at the best survivors of the screen."""
        begin = Starts.at(starts, wanted)
        for picks in self._picks(wanted, wide=wide):
            if picks.count:
                begin = Starts.of(self.evaluator, picks, wanted).joined(begin)
        return begin

    def lightest_from(
        self, begin: Starts, wanted: float = 1.0, suffix: str = "", *, wide: bool = False
    ) -> tuple[tuple[SizedDesign, Points] | None, Points]:
        """As `lightest` finds it from these starts alone, and the points that all of them reach."""
        reached: Points | None = None
        for aim in _AIMS:
            begin = begin if reached is None else Starts.at(reached, wanted)
            reached = climb(self.evaluator, begin.wanting(aim * wanted))
            if wide:
                reached = reached.joined(self._with_other_pins(reached, aim * wanted))
            ready = np.flatnonzero(reached.reserve >= aim * wanted)
            if ready.size == 0:
                break
            point = reached.rows(_preferred(reached.rows(ready), ready))
            design = finish(self.evaluator, point, 0, suffix)
            if design is not None:
                return (design, point), reached
        assert reached is not None
        return None, reached

    def _picks(self, wanted: float, *, wide: bool) -> Iterator[Picks]:
        """Where to begin."""
        if wide:
            yield strongest(self.space, self.found, _STRONG_STARTS)
        most = _WIDE_STARTS if wide else _LIGHT_STARTS
        yield lightest(self.frame, self.space, self.found, most, wanted)

    def _with_other_pins(self, reached: Points, wanted: float) -> Points:
        """The best of some points with different bearings, each with the pins that suit it best."""
        best = _best(reached, wanted, _EXCHANGED)
        for _ in range(_EXCHANGES):
            starts = [self._other_pins(best.rows(np.array([k])), wanted) for k in range(best.count)]
            tried = climb(self.evaluator, reduce(Starts.joined, starts))
            better = _best(best.joined(tried), wanted, _EXCHANGED)
            if np.array_equal(better.objective, best.objective) and np.array_equal(
                better.reserve, best.reserve
            ):
                break
            best = better
        return best

    def _other_pins(self, point: Points, wanted: float) -> Starts:
        pins = self._pins_beside(int(point.pin_count[0]), int(point.pin_size[0]))
        return Starts.other_pins(point, pins, wanted)

    def _pins_beside(self, count: int, size: int) -> list[tuple[int, int]]:
        """Counts up to two steps away with sizes up to one step away, of those that are tried."""
        counts, sizes = self.space.pin_counts, range(len(self.frame.pin_sizes))
        place = counts.index(count)
        return [
            (other, step)
            for other in counts[max(place - 2, 0) : place + 3]
            for step in sizes[max(size - 1, 0) : size + 2]
        ]

    def offered(self, most: Points) -> tuple[SizedDesign, Points] | None:
        """The lightest design with some reserve where the space allows it, else on the limit."""
        with_reserve = self.lightest(most, min(OFFERED_RESERVE, _within_reach(most)), wide=True)
        return with_reserve or self.lightest(most, wide=True)

    def offers(self, most: Points) -> tuple[SizedDesign, ...]:
        """The design that is offered, and up to three different ones; none where nothing fits.

        The others are the best of all, and two with more reserve: the most there is (or twice the
        torque) and half way to it from the first, each as light as that allows. Whatever any of
        these searches finds counts for all of them, so that none is worse in both respects than
        another.
        """
        first = self.offered(most)
        if first is None:
            return ()
        aims, points = self._others(first[1], most)
        main = _least(points, min(float(first[1].reserve[0]), OFFERED_RESERVE))
        kinds = [_least(points, aim) for aim in aims]
        return self._different((main, *reversed(kinds)), ("", "-b", "-c", "-d"), [])

    def alternatives(
        self, design: SizedDesign, main: Points, most: Points
    ) -> tuple[SizedDesign, ...]:
        """The other designs of `offers`, for a design that was chosen, at its point."""
        aims, points = self._others(main, most)
        kinds = [_least(points, aim) for aim in aims]
        return self._different(tuple(reversed(kinds)), ("-b", "-c", "-d"), [design])

    def _others(self, first: Points, most: Points) -> tuple[tuple[float, ...], Points]:
        """Reserves to offer, largest first, and the points that searches for them find."""
        own, top = float(first.reserve[0]), min(_within_reach(most), USEFUL_RESERVE)
        aims = (max(top, 1.0), max(0.5 * (own + top), 1.0), 1.0)
        points = first.joined(most)
        for aim in (*aims, own):
            other = self.lightest(points, aim, wide=aim == 1.0)
            points = points if other is None else other[1].joined(points)
        return aims, points

    def _different(
        self, points: Sequence[Points | None], suffixes: Sequence[str], known: list[SizedDesign]
    ) -> tuple[SizedDesign, ...]:
        """Designs of points; where several aims end in one design, the first."""
        found: list[SizedDesign] = []
        for point, suffix in zip(points, suffixes, strict=True):
            sized = None if point is None else finish(self.evaluator, point, 0, suffix)
            if sized is not None and all(
                sized.design.reducer != one.design.reducer for one in (*known, *found)
            ):
                found.append(sized)
        return tuple(found)


def _best(points: Points, wanted: float, most: int) -> Points:
    """Up to `most` points with different bearings, those with the least rank, best first."""
    ranks = rank(points, np.full(points.count, wanted))
    order = np.argsort(ranks, kind="stable")
    _, first = np.unique(points.bearing[order], return_index=True)
    return points.rows(order[np.sort(first)[:most]])


def _least(points: Points, wanted: float) -> Points | None:
    """The point with the least objective of those with a reserve; None where none has it."""
    ready = np.flatnonzero(points.reserve >= wanted)
    if ready.size == 0:
        return None
    return points.rows(ready[[points.objective[ready].argmin()]])


def _within_reach(most: Points) -> float:
    """The largest reserve whose first aim in `lightest` stays below what can be reached at all."""
    return max(float(most.reserve[0]) / _AIMS[0] * 0.999, 1.0)


def _preferred(points: Points, rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Row of the least objective; among those within one per cent, of the fewest pins."""
    close = points.objective <= points.objective.min() * (1.0 + FEWER_PINS_WORTH)
    order = np.lexsort((points.objective, np.where(close, points.pin_count, 1 << 20)))
    return np.asarray(rows[order[:1]])
