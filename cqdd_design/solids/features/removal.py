"""What features take away from the body of a part.

Holes run straight through layers; chamfers, countersinks, undercuts, grooves and the points of
drills are bodies of revolution, each wholly within the material that the layers leave.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from cqdd_design.solids.features.holes import (
    ClearanceHole,
    Counterbore,
    FittedHole,
    PlainHole,
    TappedHole,
)
from cqdd_design.solids.features.kinds import (
    ON_AXIS,
    AxialThread,
    Chamfer,
    Feature,
    Groove,
    Undercut,
)
from cqdd_design.solids.features.making import point_length
from cqdd_design.solids.features.revolved import Point, Revolved
from cqdd_design.solids.layers import Drilling

_RUN_IN = math.radians(15.0)
"""Between the run-out of an undercut and its cylinder (DIN 509)."""
_QUARTER = math.tan(math.pi / 8.0)
"""Bulge of a quarter of a circle."""


def drillings(features: Iterable[Feature]) -> list[Drilling]:
    """The cylinders of all holes."""
    return [one for feature in features for one in _drillings(feature)]


def _drillings(feature: Feature) -> Iterator[Drilling]:
    if isinstance(feature, FittedHole) and feature.seam:
        return
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


def threads(features: Iterable[Feature]) -> list[Drilling]:
    """The cylinders that threads reach out to, from their drills or bores."""
    found = []
    for feature in features:
        if isinstance(feature, TappedHole):
            bottom, top = _from_mouth(feature, feature.thread_depth)
            centres = feature.circle.centres
        elif isinstance(feature, AxialThread) and feature.inside:
            bottom, top, centres = feature.bottom, feature.top, (ON_AXIS,)
        else:
            continue
        found.append(Drilling(np.array(centres), 0.5 * feature.thread, bottom, top))
    return found


def cuts(features: Iterable[Feature]) -> tuple[Revolved, ...]:
    """The bodies of revolution of all features."""
    return tuple(one for feature in features for one in _cuts(feature))


def _cuts(feature: Feature) -> Iterator[Revolved]:
    if isinstance(feature, Chamfer):
        yield _edge(
            feature.radius,
            feature.height,
            feature.depth if feature.inside else -feature.depth,
            -feature.width if feature.facing == "up" else feature.width,
            feature.centres,
        )
    elif isinstance(feature, Undercut):
        yield _undercut(feature)
    elif isinstance(feature, Groove):
        yield _groove(feature)
    elif isinstance(feature, TappedHole):
        into = -1.0 if feature.facing == "up" else 1.0
        radius, centres = 0.5 * feature.drill, feature.circle.centres
        sunk = 0.5 * feature.countersink - radius
        if sunk > 0.0:
            yield _edge(radius, feature.mouth, sunk, into * sunk, centres)
        if not feature.through:
            end = feature.mouth + into * feature.drill_depth
            yield _edge(0.0, end, radius, into * point_length(feature.drill), centres)
    elif isinstance(feature, FittedHole) and feature.pointed:
        end, into = (feature.bottom, -1.0) if feature.facing == "up" else (feature.top, 1.0)
        height = into * point_length(feature.diameter)
        yield _edge(0.0, end, 0.5 * feature.diameter, height, feature.circle.centres)


def _edge(
    radius: float, height: float, across: float, along: float, centres: tuple[Point, ...]
) -> Revolved:
    """The triangle at an edge: from it across the axis, and along it, both with their signs."""
    corners = ((radius, height), (radius + across, height), (radius, height + along))
    return Revolved(_counter_clockwise(corners, across * along > 0.0), centres)


def _counter_clockwise(corners: tuple[Point, ...], is_so: bool) -> tuple[Point, ...]:
    return corners if is_so else corners[::-1]


def _undercut(feature: Undercut) -> Revolved:
    """Fillet at the shoulder, floor, and the flat run-out to the cylinder.

    What the fillet leaves on the shoulder outside the cylinder, r - t1 wide, is not drawn: the
    fillet ends where it meets the cylinder.
    """
    top, floor = feature.cylinder, feature.cylinder - feature.depth
    r, lift = feature.radius, max(feature.radius - feature.depth, 0.0)
    # Where the fillet meets the cylinder: at the shoulder's face unless it is deeper than t1.
    start = r - math.sqrt(r * r - lift * lift)
    sweep = math.acos(lift / r)
    run_out = feature.depth / math.tan(_RUN_IN)
    eased = r * math.tan(0.5 * _RUN_IN)
    corner = feature.width - run_out
    outline = [
        (top, start),
        (top, feature.width),
        (floor + eased * math.sin(_RUN_IN), corner + eased * math.cos(_RUN_IN)),
        (floor, corner - eased),
        (floor, r),
    ]
    arc, ease = math.tan(0.25 * sweep), math.tan(0.25 * _RUN_IN)
    bulges = [0.0, 0.0, ease, 0.0, arc]
    if lift == 0.0 and r < feature.depth:
        outline.append((floor + r, 0.0))
        outline[0] = (top, 0.0)
        bulges = [0.0, 0.0, ease, 0.0, arc, 0.0]
    return _placed(outline, bulges, feature.height, feature.facing == "up", (feature.centre,))


def _placed(
    outline: list[Point], bulges: list[float], height: float, up: bool, centres: tuple[Point, ...]
) -> Revolved:
    """An outline drawn from z = 0 upward, counter-clockwise, set on a height or hung under it."""
    if up:
        return Revolved(tuple((r, height + z) for r, z in outline), centres, tuple(bulges))
    turned = tuple((r, height - z) for r, z in reversed(outline))
    # The segment that ran to a corner now runs from it; its arc keeps its sense.
    return Revolved(turned, centres, (*bulges[-2::-1], bulges[-1]))


def _groove(feature: Groove) -> Revolved:
    floor, cylinder = 0.5 * feature.diameter, feature.cylinder
    low, high = feature.bottom, feature.top
    depth = abs(cylinder - floor)
    r = min(feature.fillet, 0.5 * depth, 0.25 * (high - low))
    out = math.copysign(r, cylinder - floor)
    outline = (
        (cylinder, low),
        (cylinder, high),
        (floor + out, high),
        (floor, high - r),
        (floor, low + r),
        (floor + out, low),
    )
    bulges = (0.0, 0.0, _QUARTER, 0.0, _QUARTER, 0.0)
    if not feature.inside:
        return Revolved(outline, bulges=bulges)
    return Revolved(outline[::-1], bulges=(*bulges[-2::-1], bulges[-1]))
