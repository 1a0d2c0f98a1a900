"""Chamfers on the edges of turned parts, found on their layers.

An edge is a circle in which a layer ends and beside which no other layer has material: turning
leaves it sharp, and every sharp edge is broken. How wide a chamfer is follows from the diameter,
and from the faces and holes beside it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cqdd_design.geometry.contours import Circle
from cqdd_design.solids.features.holes import Facing
from cqdd_design.solids.features.kinds import Chamfer, Seat
from cqdd_design.solids.layers import Layer, Stack

BROKEN_EDGE = 0.3e-3
"""What an edge without an indication of its own loses at most, m: the title block's ISO 13715."""
_SERIES = (1.0e-3, 0.8e-3, 0.5e-3, 0.3e-3, 0.2e-3, 0.1e-3)
_BY_DIAMETER = ((6e-3, 0.3e-3), (20e-3, 0.5e-3), (60e-3, 0.8e-3))
_LARGEST = 1.0e-3
"""Width of the chamfers of edges up to a diameter, and beyond, m."""
FACE_SHARE, _LENGTH_SHARE = 0.15, 0.25
"""Most of the face and of the cylinder beside an edge that its chamfer takes."""
_SAME = 1e-9
_HOLE_GAP = 0.05e-3
"""Least wall between a chamfer and a hole, m."""


@dataclass(frozen=True)
class _Round:
    """A circle, as plain numbers."""

    x: float
    y: float
    radius: float

    def apart(self, other: _Round) -> float:
        return math.hypot(self.x - other.x, self.y - other.y)

    def same_as(self, other: _Round | None) -> bool:
        return (
            other is not None
            and self.apart(other) < _SAME
            and abs(self.radius - other.radius) < _SAME
        )


@dataclass(frozen=True)
class _Turned:
    """A layer: what it is turned to outside and inside, and its other holes.

    `reach` is the circle that its outline stays within; `outer` is None where that is no circle.
    """

    bottom: float
    top: float
    outer: _Round | None
    reach: _Round
    bore: _Round | None
    holes: tuple[_Round, ...]


def edges(shape: Stack, seats: Sequence[Seat] = ()) -> tuple[Chamfer, ...]:
    """The chamfers of a part, from the lowest edge to the highest.

    Parameters
    ----------
    seats : sequence of Seat
        Of which some say how wide the chamfers of their ends may be.
    """
    every = [_turned(layer) for layer in shape.layers]
    leading = [one for one in seats if one.lead_in]
    found = [one for layer in every for one in _of_layer(layer, every, leading)]
    found.sort(key=lambda one: (one.height, one.radius, one.facing))
    return tuple(found)


def chamfer_width(diameter: float) -> float:
    """Width of the chamfer of an edge of a diameter (m) with room, m."""
    return next((width for most, width in _BY_DIAMETER if diameter <= most), _LARGEST)


def _turned(layer: Layer) -> _Turned:
    rounds = [_round(hole) for hole in layer.shape.holes if isinstance(hole, Circle)]
    plain = len(rounds) == len(layer.shape.holes)
    on_axis = [one for one in rounds if math.hypot(one.x, one.y) < _SAME]
    outline = layer.shape.outer
    outer: _Round | None = None
    if isinstance(outline, Circle):
        outer = reach = _round(outline)
    else:
        reach = _Round(0.0, 0.0, float((outline.points**2).sum(axis=1).max() ** 0.5))
    bore = on_axis[0] if on_axis and plain else None
    holes = tuple(one for one in rounds if one is not bore)
    return _Turned(layer.bottom, layer.top, outer, reach, bore, holes)


def _round(circle: Circle) -> _Round:
    return _Round(float(circle.centre[0]), float(circle.centre[1]), circle.radius)


def _of_layer(
    layer: _Turned, every: Sequence[_Turned], leading: Sequence[Seat]
) -> Iterator[Chamfer]:
    for at, inside in ((layer.outer, False), (layer.bore, True)):
        # An eccentric's edges are only broken, as all others are: less would unbalance the crank.
        if at is None or math.hypot(at.x, at.y) > _SAME:
            continue
        facings: tuple[Facing, ...] = ("up", "down")
        for facing in facings:
            height = layer.top if facing == "up" else layer.bottom
            most = _lead_in(at.radius, height, inside, leading)
            width = _width(layer, at, inside, facing, every, most)
            if width is not None:
                where = "bore" if inside else "edge"
                name = f"{where} {2e3 * at.radius:.6g} at {1e3 * height:.6g}"
                yield Chamfer(name, at.radius, height, inside, facing, width)


def _lead_in(radius: float, height: float, inside: bool, leading: Sequence[Seat]) -> float:
    """Widest chamfer that a seat wants at an edge (radius and height, m), m."""
    return next(
        (
            seat.lead_in
            for seat in leading
            if seat.inside == inside
            and abs(0.5 * seat.diameter - radius) < _SAME
            and min(abs(seat.bottom - height), abs(seat.top - height)) < _SAME
        ),
        math.inf,
    )


def _width(
    layer: _Turned,
    at: _Round,
    inside: bool,
    facing: Facing,
    every: Sequence[_Turned],
    widest: float,
) -> float | None:
    """How wide the chamfer of an edge is, m; None where it is no edge or has no room."""
    height = layer.top if facing == "up" else layer.bottom
    beside = [
        other
        for other in every
        if other is not layer and other.bottom < height + _SAME and other.top > height - _SAME
    ]
    face = _face(layer, at, inside)
    for other in beside:
        room = _room(other, at, inside)
        if room is None:
            return None
        face = min(face, room)
    cylinder = _cylinder(layer, at, inside, facing, every)
    length = math.fsum(one.top - one.bottom for one in cylinder)
    most = min(chamfer_width(2.0 * at.radius), widest, FACE_SHARE * face, _LENGTH_SHARE * length)
    for one in cylinder:
        # At 45 degrees a chamfer is narrower by as much as a hole lies below its face.
        deep = height - one.top if facing == "up" else one.bottom - height
        for hole in one.holes:
            most = min(most, _gap_to_hole(hole, at, inside) + deep - _HOLE_GAP)
    return next((width for width in _SERIES if width <= most + 1e-12), None)


def _face(layer: _Turned, at: _Round, inside: bool) -> float:
    """Width of the layer's own face from the edge to its other side, m."""
    if inside:
        return layer.reach.radius - at.radius - at.apart(layer.reach)
    bore = layer.bore
    return at.radius if bore is None else at.radius - bore.radius - at.apart(bore)


def _room(other: _Turned, at: _Round, inside: bool) -> float | None:
    """Free width of the face beside another layer; None where that layer touches the edge."""
    off = at.apart(other.reach)
    within = at.radius - off - other.reach.radius
    around = -math.inf
    if other.bore is not None:
        around = other.bore.radius - at.radius - at.apart(other.bore)
    # Material on the side the face lies on shortens it; beyond the edge it is in nobody's way.
    towards, beyond = (around, within) if inside else (within, around)
    if towards > _SAME:
        return towards
    return math.inf if beyond > _SAME or off > other.reach.radius + at.radius else None


def _cylinder(
    layer: _Turned, at: _Round, inside: bool, facing: Facing, every: Sequence[_Turned]
) -> list[_Turned]:
    """Layers that share the cylinder that the edge ends, from the edge on."""
    found = [layer]
    while True:
        last = found[-1]
        end = last.bottom if facing == "up" else last.top
        more = next(
            (
                other
                for other in every
                if abs((other.top if facing == "up" else other.bottom) - end) < _SAME
                and at.same_as(other.bore if inside else other.outer)
            ),
            None,
        )
        if more is None:
            return found
        found.append(more)


def _gap_to_hole(hole: _Round, at: _Round, inside: bool) -> float:
    """From the edge to a hole beside it, m; negative where the hole breaks through the edge."""
    off = at.apart(hole)
    return off - hole.radius - at.radius if inside else at.radius - off - hole.radius
