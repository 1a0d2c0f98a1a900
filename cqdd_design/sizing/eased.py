"""The gearbox that was found, for what is asked by now, or for what its part errors leave."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cqdd_design.sizing.able import CONTINUOUS, PEAK
from cqdd_design.sizing.bearable import weaker
from cqdd_design.sizing.finish import finish
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import with_sound_ends
from cqdd_design.sizing.spaces import Found

LITTLE, MUCH = 0.9, 0.7
"""Share of a torque that is left where a search for more reserve would only go from one design that
just fails to the next, and where such a search found none."""


def eased(hunt: Hunt, found: Found, least: float) -> Found | None:
    """Ask for what enough of the gearboxes that were looked at last bear, and the same gearbox.

    Nothing is changed where the torque was stated, or less than a share of either would be left;
    None then, and where the gearbox has no room for the clearance that is asked for since.
    """
    peak, lasting = hunt.borne or (0.0, 0.0)
    stated = {PEAK, CONTINUOUS} - hunt.requirements.derived
    if PEAK in stated or min(peak, lasting) < least or (stated and lasting < 1.0):
        return None
    hunt.requirements = weaker(hunt.requirements, peak, lasting)
    hunt.lowered, hunt.eased = hunt.lowered or lasting < 1.0, True
    return given(hunt, found)


def given(hunt: Hunt, found: Found) -> Found | None:
    """The same gearbox with the torques and the clearance that are asked for by now.

    None where it has no room for that clearance. Loads and part errors are to be looked at again.
    """
    space = found.space._replace(fit=hunt.fit)
    search = Search.of(replace(hunt, usual={}, extra_of={}).frame(space, {}), hunt.tables)
    point = search.evaluator.placed(found.point)
    sized = finish(search.evaluator, point, 0)
    if sized is None or not np.array_equal(point.steps, found.point.steps):
        return None
    # Bearings at the shaft's ends are chosen with its design, and not among what it is made of.
    return with_sound_ends(replace(found, space=space, search=search, sized=sized, point=point))
