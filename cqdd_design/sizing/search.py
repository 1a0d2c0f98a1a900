"""One search in one space: screen, refine, finish."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.sizing.choose import lightest, strongest
from cqdd_design.sizing.finish import finish
from cqdd_design.sizing.frame import Frame
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.refine import Starts, climb
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.screen import Screened, screen
from cqdd_design.sizing.space import SearchSpace, search_space
from cqdd_design.sizing.stage_tables import StageTables, stage_tables

_STRONG_STARTS, _LIGHT_STARTS = 3, 3
FEWER_PINS_WORTH = 0.01
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
    """A frame with its tables and the outcome of its screen.

    Attributes
    ----------
    evaluator : Evaluator
        Holds the frame and the tables.
    """

    evaluator: Evaluator
    space: SearchSpace
    found: Screened

    @classmethod
    def of(cls, frame: Frame, tables: StageTables | None = None) -> Search:
        """Screen the space of a frame; tables of the same ratio may be handed in."""
        tables = stage_tables(frame.lobe_count) if tables is None else tables
        space = search_space(frame, tables)
        found = screen(frame, tables, space)
        return cls(Evaluator.of(frame, tables, space.pin_counts), space, found)

    @property
    def frame(self) -> Frame:
        """What the requirements fix."""
        return self.evaluator.frame

    def most_reserve(self) -> Points | None:
        """The point with the most torque reserve; None where no shape fits."""
        picks = strongest(self.space, self.found, _STRONG_STARTS)
        if picks.count == 0:
            return None
        reached = climb(self.evaluator, Starts.of(self.evaluator, picks, np.inf))
        return reached.rows(np.array([reached.reserve.argmax()]))

    def lightest(
        self, starts: Points, wanted: float = 1.0, suffix: str = ""
    ) -> tuple[SizedDesign, Points] | None:
        """The design with the least objective that meets every check, and its point.

        Parameters
        ----------
        starts : Points
            Where to begin besides the lightest survivors of the screen; never empty, since a tight
            space may leave no survivor although its best point refines to one.
        wanted : float
            Torque reserve to have.
        suffix : str
            Of the design's name.
        """
        begin = Starts.at(starts, wanted)
        picks = lightest(self.frame, self.space, self.found, _LIGHT_STARTS, wanted)
        if picks.count:
            begin = Starts.of(self.evaluator, picks, wanted).joined(begin)
        for aim in _AIMS:
            reached = climb(self.evaluator, begin.wanting(aim * wanted))
            ready = np.flatnonzero(reached.reserve >= aim * wanted)
            if ready.size == 0:
                break
            point = reached.rows(_preferred(reached.rows(ready), ready))
            design = finish(self.evaluator, point, 0, suffix)
            if design is not None:
                return design, point
            begin = Starts.at(reached, wanted)
        return None

    def offered(self, most: Points) -> tuple[SizedDesign, Points] | None:
        """The lightest design with some reserve where the space allows it, else on the limit."""
        with_reserve = self.lightest(most, min(OFFERED_RESERVE, _within_reach(most)))
        return with_reserve or self.lightest(most)

    def alternatives(
        self, design: SizedDesign, main: Points, most: Points
    ) -> tuple[SizedDesign, ...]:
        """Up to three different designs: the lightest of all, and two with more reserve.

        The reserves of these two are the most there is (or twice the torque) and half way to it
        from the main design's; each is as light as that allows. The search goes from the strongest
        down, so that a weaker one is never the heavier.
        """
        own = float(main.reserve[0])
        top = max(min(_within_reach(most), USEFUL_RESERVE), 1.0)
        found: list[SizedDesign] = []
        starts = main.joined(most)
        for wanted, suffix in ((top, "-d"), (max(0.5 * (own + top), 1.0), "-c"), (1.0, "-b")):
            other = self.lightest(starts, wanted, suffix)
            if other is None:
                continue
            starts = main.joined(other[1])
            # Where a wide bearing decides the thickness, several aims end in one design.
            known = [design.design.reducer, *(one.design.reducer for one in found)]
            if other[0].design.reducer not in known:
                found.append(other[0])
        return tuple(reversed(found))


def _within_reach(most: Points) -> float:
    """The largest reserve whose first aim in `lightest` stays below what can be reached at all."""
    return max(float(most.reserve[0]) / _AIMS[0] * 0.999, 1.0)


def _preferred(points: Points, rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Row of the least objective; among those within one per cent, of the fewest pins."""
    close = points.objective <= points.objective.min() * (1.0 + FEWER_PINS_WORTH)
    order = np.lexsort((points.objective, np.where(close, points.pin_count, 1 << 20)))
    return np.asarray(rows[order[:1]])
