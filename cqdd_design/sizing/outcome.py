"""What a search to the verdict returns of a design: its alternatives and what more would cost."""

from __future__ import annotations

import time
from dataclasses import replace

from cqdd_design.machine import Machine
from cqdd_design.sizing.costs import costs
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.result import SizingResult
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.bore_line import bore_line


def lets_through(machine: Machine) -> bool:
    """Whether the bore that is asked for goes through, where one is."""
    line = bore_line(machine.rigid)
    return line is None or line.status == "pass"


def result_of(hunt: Hunt, found: Found, began: float) -> SizingResult:
    """With alternatives in the same ring with any cam bearing, by closed forms and its needs."""
    frame = hunt.frame(found.space._replace(cam=""), found.needs)
    stated = found.sized.design.reducer.carrier.material
    search = Search.of(replace(frame, carrier_material=stated), hunt.tables)
    screen, most = search.found, search.most_reserve()
    others = () if most is None else search.alternatives(found.sized, search.at(found.point), most)
    # Of any cam bearing many leave no way through.
    others = tuple(one for one in others if lets_through(one.machine))
    return SizingResult(
        **vars(found.sized),
        alternatives=others,
        candidates_screened=screen.screened,
        survivors=screen.survivors,
        rejected=screen.rejected,
        costs=costs(hunt, found),
        seconds=time.perf_counter() - began,
    )
