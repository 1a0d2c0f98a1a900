"""What keeps every piece of the machine from moving along the axis, read off the parts as drawn.

A station (see `stations`) is held in a direction by a face of another across a gap, the play, or it
is fastened: screwed, pressed or bonded. Faces that turn against each other hold only where they are
meant to, at bearings and discs. What holds has to be held itself: from stop to stop the
way must lead to the housing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.geometry.contours import Circle, ComplexArray, PlanarPart
from cqdd_design.solids.counterweights import NAMES as WEIGHTS
from cqdd_design.solids.features.zones import DISC_BORE, PRESSED_CAM
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.part import Instance, Part
from cqdd_design.solids.shoulder_room import sure_face
from cqdd_design.solids.stations import Span, Station, ring_of, stations

UP, DOWN = "up", "down"
_TOUCHING = 1e-6
"""Overlap of faces that counts as rounding, m."""
_LEAST_FACE = 0.05e-3
"""Width of a face that stops anything, m."""
_MOST_PLAY = 1.0
"""Of parts, in units of the layout, or the discs' spacing; what rolls on pins may float farther."""
_EDGE = 0.05e-3
"""Distance from edges at which points are looked at, m."""
_SAG = 5e-6
"""Of the polygons that stand for grooved bores, m."""
_RADII, _ANGLES = 3, 24
"""Of these points in a piece beside the axis."""
_ROLLING = ("sleeve", "roller", "needle")
_GUIDED = ("shaft bearing", "output bearing")

_FASTENED = (
    ("ring clamp", "housing", "cover screws"),
    ("output cover", "housing", "cover screws"),
    ("cover screw", "housing", "its thread"),
    ("motor cover", "housing", "its screws"),
    ("motor cover screw", "motor cover", "its thread"),
    ("encoder board", "motor cover", "its screws"),
    ("encoder screw", "motor cover", "its thread"),
    *((weight, "rotor bell", "bond on the bell") for weight in WEIGHTS),
    ("encoder magnet", "eccentric shaft", "bond"),
    ("eccentric cam", "eccentric shaft", f"press fit {PRESSED_CAM} and bond"),
    ("cam bearing", "disc", f"press fit {DISC_BORE}"),
    ("shaft shim", "carrier plate", "in its seat under the shoulder"),
    ("output shim", "output cover", "in its seat under the lip"),
    ("bearing nut", "carrier plate", "its thread"),
    ("shoulder screw", "carrier plate", "its thread"),
    ("dowel pin", "carrier plate", "bond in its seat"),
    ("column screw", "carrier plate", "its thread"),
)
"""Part, what it is fastened to, and how."""
_OUTRUNNER = (
    ("motor stator", "housing", "bond on the register"),
    ("rotor bell", "eccentric shaft", "bond on the stub"),
    ("motor rotor", "rotor bell", "bond in the bell"),
)
_INRUNNER = (
    ("motor stator", "motor cover", "bond in its seat"),
    ("rotor hub", "eccentric shaft", "bond on the stub"),
    ("motor rotor", "rotor hub", "bond on the hub"),
)
"""What holds a motor, of either kind."""


@dataclass(frozen=True)
class Stop:
    """What holds a piece in one direction.

    Attributes
    ----------
    by : str
        Name of the other piece, or how it is fastened.
    play : float or None
        Gap to it, m; 0 where fastened, None where nothing holds.
    face : float
        Width of the faces that meet, m; 0 where fastened or free.
    sure : float
        The same at the limits and with the broken edges of what holds, m; of bearings alone.
    """

    by: str
    play: float | None
    face: float = 0.0
    sure: float = 0.0


@dataclass(frozen=True)
class Retained:
    """A row of the table of retention.

    Attributes
    ----------
    bearing : Bearing or None
        What it is, of a rolling bearing on the axis.
    up, down : Stop
    """

    name: str
    bearing: Bearing | None
    up: Stop
    down: Stop

    @property
    def free(self) -> tuple[str, ...]:
        """Directions in which nothing holds it."""
        ways = ((UP, self.up), (DOWN, self.down))
        return tuple(way for way, stop in ways if stop.play is None)

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""

        def told(stop: Stop) -> dict[str, object]:
            return {
                "held_by": stop.by or None,
                "play_mm": None if stop.play is None else 1e3 * stop.play,
            }

        return {"part": self.name, "up": told(self.up), "down": told(self.down)}


def retention(parts: Sequence[Part], layout: Layout) -> tuple[Retained, ...]:
    """What holds every station of a machine along its axis, upward and downward."""
    every = stations(parts)
    groups, ways = _fastened(every, layout)
    # Discs float in the spacing that the design states, however small the machine.
    most = max(_MOST_PLAY * layout.unit, layout.pack.gap + _TOUCHING)
    told: list[list[Stop]] = [[] for _ in every]
    for upward in (True, False):
        stops = [dict(_stops(i, every, upward=upward, most=most)) for i in range(len(every))]
        steps = _steps_to_ground(every, groups, stops)
        plays = _plays_to_ground(every, groups, stops)
        for i, found in enumerate(told):
            found.append(_stop(i, every, groups, ways[i], stops, steps, plays))
    return tuple(
        Retained(one.name, _bearing(one, layout), *found)
        for one, found in zip(every, told, strict=True)
    )


def _bearing(station: Station, layout: Layout) -> Bearing | None:
    seats = {"shaft bearing": layout.shaft.support, "output bearing": layout.carrier.output}
    chosen = None if station.off_axis else seats.get(station.part.name)
    # A bush is made with the edges that its seats need.
    return None if chosen is None or chosen.source == "bush" else chosen.bearing


def _fastened(every: Sequence[Station], layout: Layout) -> tuple[list[int], list[str]]:
    """The group of every station, and how it is fastened in it."""
    groups, ways = list(range(len(every))), [""] * len(every)
    pairs = [*_FASTENED, *(_OUTRUNNER if layout.inrunner is None else _INRUNNER)]
    carrier = layout.carrier
    if carrier.bonded_in_cap:
        pin = "dowel pin" if carrier.pin.screw is None else "shoulder screw"
        pairs.append(("carrier cap", pin, "bond on the pins"))
    if carrier.columns is not None:
        pairs.append(("carrier cap", "column screw", "the columns' screws"))
    for part, other, how in pairs:
        for i, one in enumerate(every):
            if not _is_called(one, part):
                continue
            for j, base in enumerate(every):
                if _is_called(base, other) and _are_mates(one, base):
                    ways[i] = f"{base.name}, {how}"
                    mine, its = groups[i], groups[j]
                    groups = [its if group == mine else group for group in groups]
    return groups, ways


def _are_mates(one: Station, base: Station) -> bool:
    """Whether a station is fastened to just this one of its kind.

    Shims are where they lie against their face: a bearing that pushes them meets that face.
    """
    if one.part.name == "cam bearing":
        return base.body == one.body
    if one.part.name.endswith("shim"):
        return any(
            abs(its.bottom - one.top) < _TOUCHING and its.inner < one.outer < its.outer + _TOUCHING
            for its in base.spans
        )
    return True


def _is_called(station: Station, name: str) -> bool:
    own = station.part.name
    return own == name or (name == "disc" and own.startswith("disc "))


def _stops(
    i: int, every: Sequence[Station], *, upward: bool, most: float
) -> Iterator[tuple[int, Stop]]:
    """Stations whose faces stop a station, with gap and width."""
    floats = any(word in every[i].part.name for word in _ROLLING)
    seats = every[i].part.name in _GUIDED and not every[i].off_axis
    bore = min(span.inner for span in every[i].spans)
    for j, other in enumerate(every):
        if i == j or not _may_touch(every[i], other):
            continue
        best: Stop | None = None
        for mine in every[i].spans:
            for its in other.spans:
                face = min(mine.outer, its.outer) - max(mine.inner, its.inner)
                gap = its.bottom - mine.top if upward else mine.bottom - its.top
                if face < _LEAST_FACE or gap < -_TOUCHING or not (floats or gap <= most):
                    continue
                if best is not None and gap >= (best.play or 0.0):
                    continue
                if _meet(every[i], mine, other, its):
                    sure = 0.0
                    if seats:
                        inside = mine.inner <= bore + _TOUCHING
                        sure = sure_face(
                            other.part, its, mine, facing_up=not upward, inner_ring=inside
                        )
                    best = Stop(other.name, max(gap, 0.0), face, sure)
        if best is not None:
            yield j, best


def _meet(one: Station, own: Span, other: Station, its: Span) -> bool:
    """Whether two layers, whose rings about the axis overlap, have material above each other.

    Round parts do; of pieces beside the axis points are looked at, which holes may swallow.
    """
    if one.off_axis:
        return bool(_material(its, other, _points(own, one.pieces[0])).any())
    if other.off_axis:
        return bool(_material(own, one, _points(its, other.pieces[0])).any())
    return True


def _points(span: Span, piece: Instance) -> ComplexArray:
    """Points in the material of a piece's layer, as they lie about the axis of its body, m."""
    own = Span(span.bottom, span.top, *ring_of(span.shape), span.shape)
    edge = min(_EDGE, 0.25 * (own.outer - own.inner))
    radii = np.linspace(own.inner + edge, own.outer - edge, _RADII)
    ring = np.exp(2j * np.pi * np.arange(_ANGLES) / _ANGLES)
    flat = (radii[:, None] * ring).ravel()
    inside = flat[_inside(span.shape, flat)]
    x, y = piece.placement[:2, :2] @ np.array([inside.real, inside.imag])
    return np.asarray(x + piece.placement[0, 3] + 1j * (y + piece.placement[1, 3]))


def _material(span: Span, station: Station, points: ComplexArray) -> np.ndarray:
    """Which points about the axis lie in the material of a layer of any piece of a station."""
    found = np.zeros(points.shape, dtype=bool)
    for piece in station.pieces:
        at = points - (piece.placement[0, 3] + 1j * piece.placement[1, 3])
        x, y = piece.placement[:2, :2].T @ np.array([at.real, at.imag])
        found |= _inside(span.shape, np.asarray(x + 1j * y))
    return found


def _inside(shape: PlanarPart, points: ComplexArray) -> np.ndarray:
    """Which points are in a shape; outlines that are no circles count as round about the axis.

    Bores with grooves do not: what stands in a groove passes.
    """
    inner, outer = ring_of(shape)
    found = np.asarray((np.abs(points) < outer) & (np.abs(points) > inner))
    for hole in shape.holes:
        if isinstance(hole, Circle):
            found &= np.abs(points - complex(*hole.centre)) > hole.radius
        elif found.any():
            found &= ~_enclosed(hole.sample(_SAG) @ np.array([1.0, 1.0j]), points)
    return found


def _enclosed(corners: ComplexArray, points: ComplexArray) -> np.ndarray:
    """Which points a closed polygon goes round: crossings of a ray along x."""
    begin, end = corners[:, None], np.roll(corners, -1)[:, None]
    at = points.ravel()
    spans = (begin.imag > at.imag) != (end.imag > at.imag)
    rise = np.where(spans, end.imag - begin.imag, 1.0)
    cross = begin.real + (at.imag - begin.imag) / rise * (end.real - begin.real)
    return np.asarray((spans & (at.real < cross)).sum(axis=0) % 2 == 1).reshape(points.shape)


def _may_touch(one: Station, other: Station) -> bool:
    """Whether two stations may hold each other by faces: what turns on its own must be guided."""
    if one.body == other.body:
        return True
    names = one.part.name, other.part.name
    if any(word in name for name in names for word in _GUIDED):
        return True
    kinds = {one.body.kind, other.body.kind}
    return "disc" in kinds and "housing" not in kinds


def _steps_to_ground(
    every: Sequence[Station], groups: Sequence[int], stops: Sequence[dict[int, Stop]]
) -> dict[int, int]:
    """Groups from which a way of stops leads to the housing, with the number of its steps."""
    steps = {groups[i]: 0 for i, one in enumerate(every) if one.part.name == "housing"}
    for step in range(1, len(every)):
        more = {
            groups[i]
            for i, found in enumerate(stops)
            if groups[i] not in steps and any(groups[j] in steps for j in found)
        }
        if not more:
            break
        steps |= dict.fromkeys(more, step)
    return steps


def _plays_to_ground(
    every: Sequence[Station], groups: Sequence[int], stops: Sequence[dict[int, Stop]]
) -> dict[int, float]:
    """Groups from which stops lead to the housing, with the least sum of gaps on the way, m."""
    plays = {groups[i]: 0.0 for i, one in enumerate(every) if one.part.name == "housing"}
    for _ in range(len(every)):
        before = dict(plays)
        for i, found in enumerate(stops):
            for j, stop in found.items():
                if groups[j] in before:
                    way = before[groups[j]] + (stop.play or 0.0)
                    plays[groups[i]] = min(way, plays.get(groups[i], way))
        if plays == before:
            break
    return plays


def _stop(
    i: int,
    every: Sequence[Station],
    groups: Sequence[int],
    how: str,
    stops: Sequence[dict[int, Stop]],
    steps: dict[int, int],
    plays: dict[int, float],
) -> Stop:
    """What holds a station: how it is fastened, else the nearest face on the way to the housing.

    That may be of its like before the same stop, as of the next sleeve on a pin.
    """
    if every[i].part.name == "housing":
        return Stop("what it is fixed to", 0.0)
    own = steps.get(groups[i])
    if own is None:
        return Stop("", None)
    if how:
        return Stop(how, 0.0)
    members = [k for k in range(len(every)) if groups[k] == groups[i]]
    found = [
        stop
        for k in members
        for j, stop in stops[k].items()
        if steps.get(groups[j], own) < own
        or (
            every[j].part.name == every[k].part.name
            and (stop.play or 0.0) + plays.get(groups[j], math.inf) <= plays[groups[i]] + _TOUCHING
        )
    ]
    return min(found, key=lambda stop: (round(stop.play or 0.0, 9), -stop.face))
