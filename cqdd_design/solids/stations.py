"""Pieces of the machine where they stand, sized, and grouped into stations.

A *station* is what moves as one when the machine is taken apart: all pieces of one part that sit
at one height on one body, such as eight screws, or one of two discs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray, PlanarPart
from cqdd_design.solids.cad import MM, location
from cqdd_design.solids.mesh import closed_mesh, picture_quality
from cqdd_design.solids.part import Instance, Part
from cqdd_design.solids.poses import Body

if TYPE_CHECKING:
    from cadquery import Shape

_SAME_HEIGHT = 1e-6
"""Of pieces in one station, m."""


@dataclass(frozen=True, eq=False)
class Span:
    """One layer of a piece, as a ring about the axis of its body.

    Attributes
    ----------
    bottom, top : float
        Heights in the machine, m.
    inner, outer : float
        Radii between which there is material, m.
    shape : PlanarPart
        The layer's, in the part's own frame.
    """

    bottom: float
    top: float
    inner: float
    outer: float
    shape: PlanarPart


@dataclass(frozen=True, eq=False)
class Station:
    """Pieces that are taken off together.

    Attributes
    ----------
    number : int
        Of the part in the lists, from 1.
    """

    part: Part
    pieces: tuple[Instance, ...]
    number: int

    @property
    def name(self) -> str:
        """The piece's name, or the part's where there are several."""
        return self.pieces[0].name if len(self.pieces) == 1 else self.part.name

    @property
    def body(self) -> Body:
        """What it moves with."""
        return self.pieces[0].body

    @cached_property
    def axis_distance(self) -> float:
        """Of the pieces' own axes from the body's, m."""
        return float(np.hypot(*self.pieces[0].placement[:2, 3]))

    @property
    def off_axis(self) -> bool:
        """Whether the pieces stand on a circle about the axis."""
        return self.axis_distance > _SAME_HEIGHT

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """The layers from the bottom upward."""
        placement = self.pieces[0].placement
        flip, lift = float(placement[2, 2]), float(placement[2, 3])
        found = []
        for layer in self.part.shape.layers:
            ends = sorted((flip * layer.bottom + lift, flip * layer.top + lift))
            inner, outer = ring_of(layer.shape)
            if self.off_axis:
                inner, outer = self.axis_distance - outer, self.axis_distance + outer
            found.append(Span(ends[0], ends[1], max(0.0, inner), outer, layer.shape))
        return tuple(sorted(found, key=lambda span: (span.bottom, span.outer)))

    @property
    def bottom(self) -> float:
        """Lowest height, m."""
        return min(span.bottom for span in self.spans)

    @property
    def top(self) -> float:
        """Greatest height, m."""
        return max(span.top for span in self.spans)

    @property
    def outer(self) -> float:
        """Farthest reach from the axis, m."""
        return max(span.outer for span in self.spans)

    @cached_property
    def widest(self) -> Span:
        """Where it reaches farthest: a screw's head, a shaft's collar."""
        most = self.outer - 1e-9
        wide = [span for span in self.spans if span.outer >= most]
        return replace(wide[0], top=wide[-1].top)

    @property
    def middle(self) -> float:
        """Height of the middle of its widest place, m."""
        return 0.5 * (self.widest.bottom + self.widest.top)


def ring_of(shape: PlanarPart) -> tuple[float, float]:
    """Bore and reach of a plane shape about its own axis, m."""
    outer = np.hypot(*shape.outer.sample(1e-5).T).max()
    inner = 0.0
    for hole in shape.holes:
        points = hole.sample(1e-5)
        # A bore goes round the axis; other holes do not.
        if abs(_winding(points)) > 0.5:
            inner = max(inner, float(np.hypot(*points.T).min()))
    return inner, float(outer)


def _winding(points: FloatArray) -> float:
    """Turns of a closed polygon (m, 2) about the origin."""
    z = points[:, 0] + 1j * points[:, 1]
    return float(np.angle(np.roll(z, -1) / np.where(z == 0.0, 1.0, z)).sum() / (2.0 * np.pi))


def stations(parts: Sequence[Part]) -> tuple[Station, ...]:
    """All stations, part by part as the lists number them."""
    found = []
    for number, part in enumerate(parts, start=1):
        groups: dict[tuple[Body, int], list[Instance]] = {}
        for piece in part.instances:
            height = round(float(piece.placement[2, 3]) / _SAME_HEIGHT)
            groups.setdefault((piece.body, height), []).append(piece)
        found += [Station(part, tuple(group), number) for group in groups.values()]
    return tuple(found)


@dataclass(frozen=True, eq=False)
class Posed:
    """A piece where it stands.

    Attributes
    ----------
    pose : array (4, 4)
        From the part's frame to the machine's; m.
    """

    part: Part
    pose: FloatArray

    def moved(self, transform: FloatArray) -> Posed:
        """The piece after a further transform (4, 4)."""
        return Posed(self.part, transform @ self.pose)

    @property
    def solid(self) -> Shape:
        """The CAD kernel's shape, mm."""
        return self.part.solid.moved(location(self.pose))

    @property
    def vertices(self) -> FloatArray:
        """Of the part's closed mesh for pictures (v, 3), mm."""
        found = closed_mesh(self.part, picture_quality(self.part)).vertices
        return np.asarray(found @ self.pose[:3, :3].T + self.pose[:3, 3] * MM)


def posed(station: Station, design: Design, crank_angle: float) -> tuple[Posed, ...]:
    """A station's pieces at a crank angle (rad)."""
    return tuple(Posed(station.part, p.pose(design, crank_angle)) for p in station.pieces)
