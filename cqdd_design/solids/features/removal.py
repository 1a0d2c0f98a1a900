"""What features take away from the body of a part: holes straight through layers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from cqdd_design.solids.features.kinds import (
    ClearanceHole,
    Counterbore,
    Feature,
    FittedHole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.layers import Drilling


def drillings(features: Iterable[Feature]) -> list[Drilling]:
    """The cylinders of all holes."""
    return [one for feature in features for one in _drillings(feature)]


def _drillings(feature: Feature) -> Iterator[Drilling]:
    if isinstance(feature, ClearanceHole | FittedHole | PlainHole):
        bottom, top, diameter = feature.bottom, feature.top, feature.diameter
    elif isinstance(feature, TappedHole):
        bottom, top = _from_mouth(feature, feature.drill_depth)
        diameter = feature.drill
    elif isinstance(feature, Counterbore):
        bottom, top = _from_mouth(feature, feature.depth)
        diameter = feature.diameter
    else:
        return
    yield Drilling(np.array(feature.circle.centres), 0.5 * diameter, bottom, top)


def _from_mouth(feature: TappedHole | Counterbore, depth: float) -> tuple[float, float]:
    """Bottom and top of a hole of a depth, m."""
    if feature.facing == "up":
        return feature.mouth - depth, feature.mouth
    return feature.mouth, feature.mouth + depth
