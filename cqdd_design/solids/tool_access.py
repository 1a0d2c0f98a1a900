"""Whether a key reaches the socket of every screw as the machine is put together.

At its step of the order of assembly (see `apart`) a screw is in place and what comes later is not.
The long arm of a key stands in the socket along the screw's axis: it has to pass what is there, and
to stand out of what is near by as far as a hand needs. Where it does not, the short arm stands in
the socket, and the long one turns by a sixth of a turn above what is near by.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog.hex_keys import HexKey, hex_key
from cqdd_design.geometry.contours import ArcContour, FloatArray
from cqdd_design.solids.apart import Step, material_of, posed_layers, taken_apart, unit_name
from cqdd_design.solids.layers import Layer
from cqdd_design.solids.part import Part
from cqdd_design.solids.stations import Station

if TYPE_CHECKING:
    from manifold3d import CrossSection

    from cqdd_design.design import Design

GRIP = 20e-3
"""Of a key that a hand takes hold of, m."""
_HAND = 10e-3
"""Radius about a key within which what stands there keeps the hand out, m."""
_CORNERS = 6
_SWING = math.pi / 3.0
"""By which a key turns before it is put into the hexagon anew, rad."""
_DIRECTIONS = 24
"""In which the swing of a bent key is tried to begin."""
_TOUCH = 0.01
"""Areas of overlap below this are rounding, mm^2."""
_SAG = 5e-6
"""Of the polygons that stand for contours, m."""
_LEVEL = 1e-7


@dataclass(frozen=True)
class ToolReach:
    """A key at the screws of one step.

    Attributes
    ----------
    screw : str
        Name of the part.
    size : float
        Of the socket, across flats, m.
    blocked_by : tuple of str
        Parts in the way of the key.
    spare : float
        Of its long arm beyond what stands near by and what a hand needs, m.
    bent : bool
        Whether it reaches with its short arm alone.
    """

    screw: str
    size: float
    blocked_by: tuple[str, ...]
    spare: float
    bent: bool = False

    @property
    def reaches(self) -> bool:
        """Whether the screw can be turned."""
        return not self.blocked_by and (self.bent or self.spare >= 0.0)

    @property
    def told(self) -> str:
        """In words."""
        key = f"key {1e3 * self.size:.3g} mm of the {self.screw}"
        if self.blocked_by:
            return f"{key} is blocked by the {', the '.join(self.blocked_by)}"
        if self.bent:
            return f"{key} turns by its long arm"
        return f"{key} stands out {1e3 * (self.spare + GRIP):.3g} mm"


def tool_access(design: Design, parts: Sequence[Part]) -> tuple[tuple[ToolReach, ...], bool]:
    """Keys at every step at which screws are put in, and whether there is an order at all."""
    steps, whole = taken_apart(design, parts)
    return tuple(reaches(design, steps)), whole


def reaches(design: Design, steps: Sequence[Step]) -> Iterator[ToolReach]:
    """Keys at the steps in which a machine comes apart.

    What is there at a screw leaves later, or on the bench is what is left of the unit.
    """
    benches = {unit_name(step): list(step.moved) for step in steps if step.is_unit}
    bench = [one for step in steps if not step.unit for one in step.moved]
    for step in steps:
        there = benches[step.unit] if step.unit else bench
        for one in step.moved:
            there.remove(one)
        found = None if step.is_unit else _socket(step.moved[0], step.way == "up", design)
        if found is not None:
            yield _reach(design, step, found, there)


@dataclass(frozen=True)
class _Socket:
    """Sockets of a step's screws: size, height of their floor, axes about the machine's; m."""

    size: float
    floor: float
    axes: tuple[tuple[float, float], ...]


def _socket(station: Station, upward: bool, design: Design) -> _Socket | None:
    """The hexagon in the outermost layer of a bought part on a circle; None of what has none."""
    if not station.off_axis or station.part.source != "buy":
        return None
    poses = [piece.pose(design) for piece in station.pieces]
    layers = posed_layers(station.part, poses[0])
    last = max(layers, key=_top) if upward else min(layers, key=_bottom)
    arcs = [hole.points for hole in last.shape.holes if isinstance(hole, ArcContour)]
    hexagons = [points for points in arcs if len(points) == _CORNERS]
    if not hexagons:
        return None
    corners = np.asarray(hexagons[0])
    across = math.sqrt(3.0) * float(np.hypot(*(corners - corners.mean(axis=0)).T).mean())
    axes = tuple((float(pose[0, 3]), float(pose[1, 3])) for pose in poses)
    return _Socket(across, last.bottom if upward else last.top, axes)


def _top(layer: Layer) -> float:
    return layer.top


def _bottom(layer: Layer) -> float:
    return layer.bottom


def _reach(design: Design, step: Step, socket: _Socket, there: Iterable[Station]) -> ToolReach:
    key, up = hex_key(socket.size), step.way == "up"
    arm, hand = (_circles(socket.axes, radius) for radius in (socket.size / math.sqrt(3.0), _HAND))
    blocked: dict[str, None] = {}
    deepest, under, high = 0.0, key.short_arm - key.size, []
    for station in there:
        for piece in station.pieces:
            for layer in posed_layers(station.part, piece.pose(design)):
                beyond = layer.top - socket.floor if up else socket.floor - layer.bottom
                if beyond <= _LEVEL:
                    continue
                flat = material_of(layer.shape, _SAG)
                if (flat ^ arm).area() > _TOUCH:
                    blocked[station.part.name] = None
                elif beyond > deepest and (flat ^ hand).area() > _TOUCH:
                    deepest = beyond
                if beyond > under:
                    high.append(flat)
    spare = key.long_arm - deepest - GRIP
    bent = not blocked and spare < 0.0 and _swings(key, socket.axes, high)
    return ToolReach(step.moved[0].part.name, socket.size, tuple(blocked), spare, bent)


def _swings(key: HexKey, axes: Iterable[tuple[float, float]], high: Sequence[CrossSection]) -> bool:
    """Whether the long arm, above all that is lower, turns far enough about every axis.

    Parameters
    ----------
    high : sequence of CrossSection
        What stands as high as the arm, mm.
    """
    from manifold3d import CrossSection, OpType

    everything = CrossSection.batch_boolean(list(high), OpType.Add)
    aside = 0.5 * key.size / key.long_arm
    edge = np.linspace(-aside, _SWING + aside, 9)
    fan = np.vstack(
        [[0.0, 0.0], 1e3 * key.long_arm * np.column_stack([np.cos(edge), np.sin(edge)])]
    )
    return all(
        any(
            (CrossSection([_turned(fan, turn) + at]) ^ everything).area() <= _TOUCH
            for turn in np.arange(_DIRECTIONS) * 2.0 * math.pi / _DIRECTIONS
        )
        for at in 1e3 * np.array(list(axes))
    )


def _turned(points: FloatArray, angle: float) -> FloatArray:
    """Points (n, 2) turned about the origin."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]))


def _circles(axes: Iterable[tuple[float, float]], radius: float) -> CrossSection:
    """Circles about axes as one shape, mm."""
    from manifold3d import CrossSection, OpType

    one = CrossSection.circle(1e3 * radius, 48)
    return CrossSection.batch_boolean(
        [one.translate((1e3 * x, 1e3 * y)) for x, y in axes], OpType.Add
    )
