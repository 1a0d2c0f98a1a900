"""What limits of size and broken edges may take off the face that a part offers to another."""

from __future__ import annotations

from cqdd_design.catalog.fits import general_tolerance
from cqdd_design.solids.features.edges import BROKEN_EDGE
from cqdd_design.solids.features.kinds import Chamfer, Seat, Shoulder
from cqdd_design.solids.part import Part
from cqdd_design.solids.stations import Span

_SAME = 1e-7


def sure_face(part: Part, own: Span, ring: Span, *, facing_up: bool, inner_ring: bool) -> float:
    """Width of the face that a part is sure to offer to a bearing's ring, from its corner on, m.

    Where the part ends under the ring, its diameter is taken at the limit of its drawing, and its
    edge as broken as that says.

    Parameters
    ----------
    part : Part
        Whose layer `own` is.
    facing_up : bool
        Whether its face looks up.
    inner_ring : bool
        Whether the ring sits on a shaft, with its corner inside.
    """
    height = own.top if facing_up else own.bottom
    if inner_ring:
        reach = own.outer - _lost(part, own.outer, height, inside=False)
        return min(reach, ring.outer) - max(own.inner, ring.inner)
    reach = own.inner + _lost(part, own.inner, height, inside=True)
    return min(own.outer, ring.outer) - max(reach, ring.inner)


def _lost(part: Part, radius: float, height: float, *, inside: bool) -> float:
    """By how much less far a face may reach at an edge (radius and height, m), m."""
    # A shim or washer is as thin as an edge that is broken.
    unsaid = 0.0 if part.source == "buy" else BROKEN_EDGE
    chamfer = next(
        (
            one.depth
            for one in part.features
            if isinstance(one, Chamfer)
            and one.inside == inside
            and abs(one.radius - radius) < _SAME
            and abs(one.height - height) < _SAME
        ),
        unsaid,
    )
    return chamfer + _off(part, radius, inside=inside)


def _off(part: Part, radius: float, *, inside: bool) -> float:
    """By how much a radius may be off its nominal size to the side that shortens the face, m."""
    for one in part.stated:
        if isinstance(one, Shoulder) and one.rim and not inside and _same(one.outer, radius):
            return 0.5 * one.rim
    for one in part.stated:
        if isinstance(one, Seat) and one.inside == inside and _same(0.5 * one.diameter, radius):
            limits = one.limits
            return 0.5 * max(limits.upper if inside else -limits.lower, 0.0)
    return 0.5 * general_tolerance(2.0 * radius)


def _same(one: float, other: float) -> bool:
    return abs(one - other) < _SAME
