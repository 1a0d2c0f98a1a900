"""Designs in smaller rings than the space leaves, where they are better."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.agreement import Found, Hunt, settled
from cqdd_design.sizing.points import Points

_RING_STEP, _FINER_STEPS = 0.04, (0.02, 0.01, 0.005)
"""By how much of its diameter the next ring is smaller, and the finer steps from there."""
_GAP = 2
"""Rings in a row in which nothing is borne out, after which none that is smaller is tried: a ring
may be too small for one cam bearing and too large for the next."""
_NO_STEP = 1e-3
"""By how much, as a share, a ring has to differ from those that have been tried."""
_TEETH = (1.6, 2.5)
"""Ring teeth over those of a point, with which a search near it begins too: thick ones take less
wall, so that holes and bearing have more room."""
_ROUNDS = 4
"""Of closed forms against the equilibrium: beside a design that both agree on they agree at once,
or not at all."""
_MAY_WIN = 1.1
"""Objective over the best so far, up to which finer steps may make a design the best."""


def in_smaller_rings(hunt: Hunt, best: Found) -> list[Found]:
    """Better designs in smaller rings, the best first.

    All the way down to the least ring first: with one cam bearing a smaller ring is lighter, down
    to where its discs need a wider bearing, so that there is more than one least mass. Then from
    each of them that may win in finer steps.
    """
    least = 2.0 * best.search.frame.least_outer_radius
    ladder, ring = [best], best.sized.design.reducer.ring.outer_diameter
    tried: list[float] = []
    missed = 0
    while ring > least and missed < _GAP:
        ring = max((1.0 - _RING_STEP) * ring, least)
        tried.append(ring)
        found, heavier = _in_ring(hunt, ladder[-1], ring, min(ladder, key=_worth))
        missed = 0 if found is not None or heavier else missed + 1
        if found is not None:
            ladder.append(found)
    ends = [one for one, below in pairwise(ladder) if one.worth < below.worth] + ladder[-1:]
    lightest = min(ladder, key=_worth).sized.objective.score
    others = [one for one in ends if one.sized.objective.score <= _MAY_WIN * lightest]
    # Beside the first too: part errors may ask more of the others than they have.
    for start in (*(one for one in others if one is not best), best):
        ladder.append(_finer(hunt, start, least, tried))
    return sorted((one for one in ladder if one.worth < best.worth), key=_worth)


def in_its_ring(hunt: Hunt, found: Found) -> Found | None:
    """The best design in the same ring with what the hunt has learnt since, if there is one."""
    try:
        return settled(hunt, found.space, None, found.needs, found.point, _ROUNDS)[0]
    except InfeasibleError:
        return None


def _finer(hunt: Hunt, best: Found, least: float, tried: list[float]) -> Found:
    """The last design in smaller and smaller rings that is better than the one before.

    Parameters
    ----------
    least : float
        Diameter, m, below which no ring is tried.
    tried : list of float
        Diameters, m, that have been; those that are tried here are added.
    """
    for step in _FINER_STEPS:
        while (now := best.sized.design.reducer.ring.outer_diameter) > least:
            ring = max((1.0 - step) * now, least)
            if any(abs(ring - one) < _NO_STEP * one for one in tried):
                break
            tried.append(ring)
            found, _ = _in_ring(hunt, best, ring, best)
            if found is None or found.worth >= best.worth:
                break
            best = found
    return best


def _in_ring(hunt: Hunt, beside: Found, ring: float, other: Found) -> tuple[Found | None, bool]:
    """The best design in a ring of a diameter, m, beside one; or whether another is lighter.

    What it weighs by closed forms is good to the needs of the one beside.
    """
    unrated, score = other.worth
    space = beside.space._replace(ring_limit=ring)
    near = _with_other_teeth(beside.point)
    try:
        rival = unrated, _MAY_WIN * score
        return settled(hunt, space, rival, beside.needs, near, _ROUNDS)
    except InfeasibleError:
        return None, False


def _worth(found: Found) -> tuple[bool, float]:
    return found.worth


def _with_other_teeth(point: Points) -> Points:
    """A point, and places to begin at beside it that have thicker ring teeth."""
    many = point.rows(np.zeros(1 + len(_TEETH), dtype=np.intp))
    steps = many.steps.copy()
    steps[1:, 1] = np.rint(np.array(_TEETH) * steps[1:, 1])
    return replace(many, steps=steps)
