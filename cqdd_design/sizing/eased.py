"""The design that was found, for as much less torque as its part errors take."""

from __future__ import annotations

from dataclasses import replace

from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.bearable import weaker
from cqdd_design.sizing.finish import finish
from cqdd_design.sizing.hunt import Found, Hunt
from cqdd_design.sizing.search import Search

LITTLE, MUCH = 0.9, 0.7
"""Share of a torque that is left where a search for more reserve would only go from one design that
just fails to the next, and where such a search found none."""


def eased(hunt: Hunt, found: Found, least: float = LITTLE) -> Found | None:
    """The same gearbox for what enough of those that were looked at last bear.

    None where the torque was stated, or less than a share of either would be left.
    """
    peak, lasting = hunt.borne or (0.0, 0.0)
    stated = {PEAK, CONTINUOUS} - hunt.requirements.derived
    if PEAK in stated or min(peak, lasting) < least or (stated and lasting < 1.0):
        return None
    asked = weaker(hunt.requirements, peak, lasting)
    search = Search.of(
        replace(hunt, requirements=asked, usual={}, extra_of={}).frame(found.space, {}), hunt.tables
    )
    point = search.evaluator.placed(found.point)
    sized = finish(search.evaluator, point, 0)
    if sized is None or sized.design.reducer != found.sized.design.reducer:
        return None
    hunt.requirements, hunt.lowered = asked, hunt.lowered or lasting < 1.0
    return replace(found, search=search, sized=sized, point=point)
