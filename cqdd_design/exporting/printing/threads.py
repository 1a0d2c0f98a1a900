"""Holes for heat-set inserts where a screw would be in plastic.

A plastic thread creeps and strips: what is drilled for a thread becomes the hole of the longest
insert that its depth takes and whose hole leaves a wall. A fitted bore over a thread, as of a
shouldered screw's neck, stays what it is: the insert goes in from the other side, and where that is
closed none does. Where none goes in, the hole stays as it is drawn, and a sentence says so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeGuard

import numpy as np

from cqdd_design.catalog.printing import Insert, insert_for
from cqdd_design.geometry.contours import Circle, Contour, PlanarPart
from cqdd_design.solids.features.holes import FittedHole, TappedHole
from cqdd_design.solids.layers import Layer, Stack

if TYPE_CHECKING:
    from cqdd_design.solids.part import Part

_SAME = 1e-7
_SEAT_LIMITS = 0.05e-3
"""By which a fitted bore may be drawn off its nominal radius at most, m."""
_MM = 1e3


@dataclass(frozen=True)
class ThreadedHoles:
    """Equal threads of a part.

    Attributes
    ----------
    thread, depth : float
        m.
    count : int
    room : float
        Radius of the largest hole in their places that leaves a wall, m.
    insert : Insert or None
        None where none goes in.
    angles : tuple of float
        About the axis, deg, of those without one among others that have; empty otherwise.
    """

    thread: float
    depth: float
    count: int
    room: float
    insert: Insert | None
    angles: tuple[float, ...] = ()

    def __str__(self) -> str:
        """As a line of the README."""
        what = f"{self.count} x M{_MM * self.thread:g}, {_MM * self.depth:.3g} mm deep"
        if self.insert is None:
            why = (
                f"there is room for holes of {2.0 * _MM * self.room:.3g} mm"
                if insert_for(self.thread, self.depth)
                else "it is too short"
            )
            if self.angles:
                what += f", at {' and '.join(f'{one:g}' for one in self.angles)} deg"
            return f"{what}: no insert goes in, {why}; drawn at its drill, to be tapped by hand"
        return f"{what}: {self.insert.name} in holes of {_MM * self.insert.hole:g} mm"


def with_inserts(part: Part, least_wall: float) -> tuple[Part, tuple[ThreadedHoles, ...]]:
    """A part with holes for inserts instead of its threads, and what they are.

    It keeps the chamfers and grooves that are turned about its axis; what a drill would leave,
    countersinks and points, it does not have.

    Parameters
    ----------
    least_wall : float
        That the part's material can have, m.
    """
    threads = [one for one in part.stated if isinstance(one, TappedHole)]
    tapped = {one.thread: one for one in threads}
    through = {_rounded(x, y) for one in threads if one.through for x, y in one.circle.centres}
    fitted = {
        _rounded(x, y): 0.5 * one.diameter
        for one in part.stated
        if isinstance(one, FittedHole)
        for x, y in one.circle.centres
    }
    found: list[ThreadedHoles] = []
    bores: dict[tuple[float, float], float] = {}
    for thread, drilled in sorted(tapped.items()):
        drill = drilled.drill
        depths, rooms = _depths(part.shape, drill), _rooms(part.shape, drill)
        fitting = {
            place: _fitting(thread, depth, rooms[place] - least_wall)
            if place not in fitted or place in through
            else None
            for place, depth in depths.items()
        }
        kinds = {(depths[place], insert) for place, insert in fitting.items()}
        for depth, insert in sorted(kinds, key=lambda one: (one[0], one[1] is None)):
            places = [k for k, one in fitting.items() if (depths[k], one) == (depth, insert)]
            room = min(rooms[place] for place in places) - least_wall
            mixed = sum(one == depth for one, _ in kinds) > 1
            bare = places if mixed and insert is None else []
            angles = tuple(
                sorted(round(math.degrees(math.atan2(y, x)) % 360.0, 2) for x, y in bare)
            )
            found.append(ThreadedHoles(thread, depth, len(places), room, insert, angles))
            if insert is not None:
                bores.update({place: 0.5 * insert.hole for place in places})

    def changed(hole: Contour) -> Contour:
        # A counterbore over the thread too, through which the insert has to go.
        radius = bores.get(_place(hole)) if isinstance(hole, Circle) else None
        if radius is None or not isinstance(hole, Circle) or hole.radius >= radius:
            return hole
        seat = fitted.get(_place(hole))
        if seat is not None and abs(hole.radius - seat) < _SEAT_LIMITS:
            return hole
        return Circle(hole.centre, radius)

    layers = tuple(
        Layer(
            PlanarPart(layer.shape.name, layer.shape.outer, tuple(map(changed, layer.shape.holes))),
            layer.bottom,
            layer.top,
        )
        for layer in part.shape.layers
    )
    bored = replace(part, shape=Stack(layers), stated=part.turned, edged=True)
    return bored, tuple(found)


def _fitting(thread: float, depth: float, room: float) -> Insert | None:
    """The insert of a thread that goes into a depth and a radius, m."""
    insert = insert_for(thread, depth)
    return None if insert is None or insert.hole > 2.0 * room + _SAME else insert


def _is_drilled(hole: Contour, drill: float) -> TypeGuard[Circle]:
    return isinstance(hole, Circle) and abs(2.0 * hole.radius - drill) < _SAME


def _place(hole: Circle) -> tuple[float, float]:
    return _rounded(float(hole.centre[0]), float(hole.centre[1]))


def _rounded(x: float, y: float) -> tuple[float, float]:
    return round(float(x), 7), round(float(y), 7)


def _depths(shape: Stack, drill: float) -> dict[tuple[float, float], float]:
    """Depth of the thread at every place that has one, m."""
    depths: dict[tuple[float, float], float] = {}
    for layer in shape.layers:
        for hole in layer.shape.holes:
            if _is_drilled(hole, drill):
                place = _place(hole)
                depths[place] = round(depths.get(place, 0.0) + layer.height, 7)
    return depths


def _rooms(shape: Stack, drill: float) -> dict[tuple[float, float], float]:
    """Distance from the axis of every thread to the nearest other contour beside it, m."""
    rooms: dict[tuple[float, float], float] = {}
    for layer in shape.layers:
        for hole in layer.shape.holes:
            if not _is_drilled(hole, drill):
                continue
            place = _place(hole)
            others = (one for one in (layer.shape.outer, *layer.shape.holes) if one is not hole)
            near = min(_distance(one, place) for one in others)
            rooms[place] = min(near, rooms.get(place, near))
    return rooms


def _distance(contour: Contour, place: tuple[float, float]) -> float:
    at = np.array(place)
    if isinstance(contour, Circle):
        return abs(float(np.hypot(*(at - contour.centre))) - contour.radius)
    return float(contour.distances(at[None, :])[0])
