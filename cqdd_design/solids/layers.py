"""Parts as stacks of flat layers: the one form from which solids and closed-form masses both come.

Every part of the gearbox is a pile of prisms, each a `PlanarPart` between two heights. Discs and
rings are a single layer with the very arcs that the wire cuts; turned parts are annuli, stepped
and drilled::

          _______________
      ___|___|       |___|___      layer 3: annulus with bolt holes
     |       |       |       |     layer 2
     |_______|_______|_______|     layer 1: annulus with a smaller bore
              (axis)

Layers of one part touch and never overlap, so volume, centre of mass and inertia are sums of exact
plane integrals. Lengths are in metres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    Contour,
    Moments,
    PlanarPart,
    as_points,
)
from cqdd_design.results import MassProperties

_SAME_HEIGHT = 1e-12


@dataclass(frozen=True, eq=False)
class Layer:
    """A prism: a flat shape between two heights.

    Attributes
    ----------
    shape : PlanarPart
        In the part's frame, m.
    bottom, top : float
        Heights, m.
    """

    shape: PlanarPart
    bottom: float
    top: float

    @property
    def height(self) -> float:
        """From bottom to top, m."""
        return self.top - self.bottom


@dataclass(frozen=True, eq=False)
class Stack:
    """A part as touching, never overlapping layers."""

    layers: tuple[Layer, ...]

    @cached_property
    def volume(self) -> float:
        """Exact volume of the layers, m^3."""
        return math.fsum(layer.shape.area() * layer.height for layer in self.layers)

    @property
    def bottom(self) -> float:
        """Lowest height, m."""
        return min(layer.bottom for layer in self.layers)

    @property
    def top(self) -> float:
        """Greatest height, m."""
        return max(layer.top for layer in self.layers)

    @cached_property
    def outside_radius(self) -> float:
        """Farthest the part reaches from its axis, m."""
        return max(_reach(layer.shape.outer) for layer in self.layers)

    @cached_property
    def inside_radius(self) -> float:
        """Radius of the bore of a turned part, m; 0 without one."""
        bores = []
        for layer in self.layers:
            radii = [hole.radius for hole in layer.shape.holes if isinstance(hole, Circle)]
            bores.append(min(radii, default=0.0))
        return min(bores)

    def mass_properties(self, density: float) -> MassProperties:
        """Exact mass, centre of mass and inertia of the layers at `density` (kg/m^3)."""
        total = MassProperties(0.0)
        for layer in self.layers:
            total = total + prism_properties(
                layer.shape.moments(), layer.bottom, layer.top, density
            )
        return total


def _reach(contour: Contour) -> float:
    if isinstance(contour, Circle):
        return float(np.hypot(*contour.centre)) + contour.radius
    farthest = float(np.hypot(*contour.points.T).max())
    if not isinstance(contour, ArcContour):
        return farthest
    # An arc may bulge beyond its ends: where the ray from the axis through its centre leaves it.
    arcs = contour.arcs()
    centres = np.hypot(*np.asarray(arcs.centres).T)
    bulging = np.isfinite(arcs.radii) & (centres > 0.0)
    there, radii = np.asarray(arcs.centres)[bulging], np.asarray(arcs.radii)[bulging]
    tips = there * (1.0 + radii / centres[bulging])[:, None]
    on = contour.distances(tips) < 1e-9 if len(tips) else np.zeros(0, dtype=bool)
    return max(farthest, float(np.hypot(*tips[on].T).max(initial=0.0)))


def prism_properties(moments: Moments, bottom: float, top: float, density: float) -> MassProperties:
    """Mass properties of a prism over a plane region.

    Parameters
    ----------
    moments : Moments
        Of the region about the origin.
    bottom, top : float
        Heights, m.
    density : float
        kg/m^3.
    """
    own, height = moments.about_centroid(), top - bottom
    mass = density * moments.area * height
    slab = mass * height * height / 12.0
    x, y = moments.centroid
    line = density * height
    inertia = np.array(
        [
            [line * own.yy + slab, -line * own.xy, 0.0],
            [-line * own.xy, line * own.xx + slab, 0.0],
            [0.0, 0.0, line * own.polar],
        ]
    )
    return MassProperties(mass, np.array([x, y, 0.5 * (bottom + top)]), inertia)


@dataclass(frozen=True, eq=False)
class Annulus:
    """A turned ring about the axis, m; an inner radius of 0 makes it a full cylinder."""

    bottom: float
    top: float
    inner: float
    outer: float


@dataclass(frozen=True, eq=False)
class Drilling:
    """Equal axial holes.

    Attributes
    ----------
    centres : array (k, 2)
        m.
    radius : float
        m.
    bottom, top : float
        Heights between which the holes run, m.
    """

    centres: np.ndarray
    radius: float
    bottom: float
    top: float


def circle(radius: float, centre: ArrayLike = (0.0, 0.0)) -> Circle:
    """A circle of this radius (m), on the axis unless said otherwise."""
    return Circle(np.asarray(centre, dtype=float), radius)


def on_circle(count: int, radius: float, first_angle: float) -> np.ndarray:
    """Points (count, 2) evenly spaced on a circle about the axis, the first at `first_angle`."""
    angles = first_angle + 2.0 * math.pi * np.arange(count) / count
    return as_points(radius * np.exp(1j * angles))


def cylinder(radius: float, bottom: float, top: float, centre: ArrayLike = (0.0, 0.0)) -> Layer:
    """A full cylinder."""
    return Layer(PlanarPart("cylinder", circle(radius, centre)), bottom, top)


def prism(shape: PlanarPart, bottom: float, top: float) -> Stack:
    """A part of one layer."""
    return Stack((Layer(shape, bottom, top),))


def pierced(layer: Layer, holes: Iterable[Contour]) -> Layer:
    """The layer with more holes right through it."""
    shape = layer.shape
    return Layer(
        PlanarPart(shape.name, shape.outer, (*shape.holes, *holes)), layer.bottom, layer.top
    )


def turned(rings: Sequence[Annulus], drillings: Sequence[Drilling] = ()) -> Stack:
    """A turned and drilled part.

    Parameters
    ----------
    rings : sequence of Annulus
        Touching, never overlapping; rings of no height are left out.
    drillings : sequence of Drilling
        Each hole must lie inside one annulus at every height it passes.

    Returns
    -------
    Stack
        Split at the ends of the drillings.
    """
    layers = []
    for ring in rings:
        inside = [
            d for d in drillings if d.bottom < ring.top - _SAME_HEIGHT and d.top > ring.bottom
        ]
        for bottom, top in _slices(ring, [h for d in inside for h in (d.bottom, d.top)]):
            layers.append(_annulus_layer(ring, bottom, top, inside))
    return Stack(tuple(layers))


def _slices(whole: Annulus | Layer, heights: Sequence[float]) -> Iterable[tuple[float, float]]:
    """Bottom and top of the pieces into which something is cut at heights within it."""
    within = {height for height in heights if whole.bottom < height < whole.top}
    ends = sorted({whole.bottom, whole.top, *within})
    return pairwise(h for i, h in enumerate(ends) if i == 0 or h - ends[i - 1] > _SAME_HEIGHT)


def _annulus_layer(
    ring: Annulus, bottom: float, top: float, drillings: Sequence[Drilling]
) -> Layer:
    middle = 0.5 * (bottom + top)
    holes: list[Contour] = [circle(ring.inner)] if ring.inner > 0.0 else []
    for drilling in drillings:
        if drilling.bottom < middle < drilling.top:
            distance = np.linalg.norm(drilling.centres, axis=1)
            within = (distance < ring.outer) & (distance > ring.inner)
            holes.extend(circle(drilling.radius, centre) for centre in drilling.centres[within])
    return Layer(PlanarPart("annulus", circle(ring.outer), tuple(holes)), bottom, top)


def hexagon(across_flats: float) -> ArcContour:
    """A regular hexagon, such as a hexagon socket, by its width across flats (m)."""
    return ArcContour(on_circle(6, across_flats / math.sqrt(3.0), 0.0), np.zeros(6))


def notched_circle(radius: float, count: int, width: float, depth: float) -> ArcContour:
    """A circle with evenly spaced radial slots, as round a nut for a hook spanner.

    Parameters
    ----------
    radius : float
        m.
    count : int
        Slots; the first is on +x.
    width, depth : float
        Of a slot, m; `width` below the spacing of the slots.
    """
    half = math.asin(0.5 * width / radius)
    edge = radius * math.cos(half)
    slot = np.array(
        [
            complex(edge, -0.5 * width),
            complex(radius - depth, -0.5 * width),
            complex(radius - depth, 0.5 * width),
            complex(edge, 0.5 * width),
        ]
    )
    turns = np.exp(2j * math.pi * np.arange(count) / count)
    land = 2.0 * math.pi / count - 2.0 * half
    bulges = np.tile([0.0, 0.0, 0.0, math.tan(land / 4.0)], count)
    return ArcContour(as_points((turns[:, None] * slot).ravel()), bulges)


def scalloped_circle(
    radius: float, angles: ArrayLike, distance: float, scallop: float
) -> ArcContour:
    """A circle with round ears about points near its edge.

    Parameters
    ----------
    radius : float
        Of the circle, m.
    angles : array_like
        Directions of the small circles' centres, rising, rad.
    distance, scallop : float
        Distance of those centres from the axis, and the radius about them, m; each small circle
        must cut the large one, and not its neighbours.
    """
    at = np.asarray(angles, dtype=float)
    half = math.acos(
        (radius * radius + distance * distance - scallop * scallop) / (2.0 * radius * distance)
    )
    # Sweep about the small centre from one crossing to the other, outside the large circle.
    lean = math.atan2(radius * math.sin(half), radius * math.cos(half) - distance)
    points = radius * np.exp(1j * np.stack([at - half, at + half], axis=1))
    lands = np.diff(np.append(at, at[0] + 2.0 * math.pi)) - 2.0 * half
    bulges = np.stack([np.full(len(at), math.tan(0.5 * lean)), np.tan(lands / 4.0)], axis=1)
    return ArcContour(as_points(points.ravel()), bulges.ravel())


def reshaped(
    stack: Stack, bottom: float, top: float, change: Callable[[PlanarPart], PlanarPart]
) -> Stack:
    """The stack with the shape of every layer between two heights changed, split there."""
    layers = []
    for layer in stack.layers:
        for low, high in _slices(layer, (bottom, top)):
            inside = bottom < 0.5 * (low + high) < top
            layers.append(Layer(change(layer.shape) if inside else layer.shape, low, high))
    return Stack(tuple(layers))
