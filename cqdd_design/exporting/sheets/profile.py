"""What of a turned part is measured on its sheet: cylinders, faces, and the face that is cut.

Cylinders and faces are those of the body. A feature speaks for the cylinder that it lies on, so
each is dimensioned once: by its feature where there is one, by the body otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    Contour,
    FloatArray,
    as_complex,
)
from cqdd_design.solids.axial_view import Rectangle
from cqdd_design.solids.features.kinds import (
    AxialThread,
    Chamfer,
    Feature,
    Groove,
    Seat,
    TappedHole,
    Undercut,
)
from cqdd_design.solids.layers import Layer, Stack
from cqdd_design.solids.slabs import SAME

_MM = 1e3
_POINT = math.tan(math.radians(59.0))
"""Radius over height of the cone that a drill of 118 degrees leaves (DIN 1412)."""


@dataclass(frozen=True)
class Cylinder:
    """A cylinder of the body, m.

    Attributes
    ----------
    centre : complex
        Of its axis.
    inside : bool
        Whether it is a bore.
    """

    radius: float
    bottom: float
    top: float
    inside: bool
    centre: complex = 0j


def cylinders(shape: Stack) -> tuple[Cylinder, ...]:
    """Cylinders round the axis, upward, each as long as it is; contours that are none leave out."""
    found: list[Cylinder] = []
    for layer in sorted(shape.layers, key=lambda one: one.bottom):
        mates = [c for other in shape.layers if _beside(layer, other) for c in _walls(other)]
        for contour, inside in _walls(layer):
            if not isinstance(contour, Circle) or not _round_axis(contour):
                continue
            if any(other is not inside and _same(contour, mate) for mate, other in mates):
                continue
            centre = complex(*contour.centre)
            for i, known in enumerate(found):
                if _continues(known, contour, inside, layer):
                    found[i] = replace(known, top=max(known.top, layer.top))
                    break
            else:
                found.append(Cylinder(contour.radius, layer.bottom, layer.top, inside, centre))
    return tuple(found)


def _walls(layer: Layer) -> list[tuple[Contour, bool]]:
    """Contours with whether each is a bore; one with ears or notches counts as its circle."""
    walls = [(layer.shape.outer, False), *((hole, True) for hole in layer.shape.holes)]
    return [(_circle_of(contour), inside) for contour, inside in walls]


def _circle_of(contour: Contour) -> Contour:
    if isinstance(contour, Circle):
        return contour
    arcs = contour.arcs()
    round_axis = (np.hypot(*arcs.centres.T) < 1e-9) & np.isfinite(arcs.radii)
    if not round_axis.any():
        return contour
    return Circle(np.zeros(2), float(arcs.radii[round_axis].max()))


def _beside(one: Layer, other: Layer) -> bool:
    """Whether two layers of a part lie at one height, one around the other."""
    return other is not one and other.bottom < one.top - SAME and other.top > one.bottom + SAME


def _same(one: Circle, other: Contour) -> bool:
    return (
        isinstance(other, Circle)
        and abs(one.radius - other.radius) < SAME
        and bool(np.abs(one.centre - other.centre).max() < SAME)
    )


def _round_axis(contour: Circle) -> bool:
    return abs(complex(*contour.centre)) < contour.radius


def _continues(known: Cylinder, contour: Circle, inside: bool, layer: Layer) -> bool:
    return (
        known.inside == inside
        and abs(known.radius - contour.radius) < SAME
        and abs(known.centre - complex(*contour.centre)) < SAME
        and abs(known.top - layer.bottom) < SAME
    )


def outside(shape: Stack) -> float:
    """Farthest that a part reaches from its axis, m, to 1 um."""
    return max(float(np.hypot(*layer.shape.outer.sample(1e-6).T).max()) for layer in shape.layers)


@dataclass(frozen=True)
class Slots:
    """Equal radial slots in the edge of a part, m.

    Attributes
    ----------
    floor : complex
        Middle of the first one's floor.
    """

    count: int
    width: float
    depth: float
    floor: complex


def slots(shape: Stack) -> Slots | None:
    """The slots of a part whose outside is a circle but for these."""
    floors: list[complex] = []
    width, radius = 0.0, 0.0
    for layer in shape.layers:
        contour = layer.shape.outer
        if not isinstance(contour, ArcContour):
            continue
        radius = float(np.hypot(*contour.points.T).max())
        ends = as_complex(contour.points)
        for start, end, bulge in zip(ends, np.roll(ends, -1), contour.bulges, strict=True):
            middle = 0.5 * complex(start + end)
            square = abs(((end - start) * np.conj(middle)).real) < 1e-9 * abs(middle)
            known = any(abs(middle - floor) < 1e-9 for floor in floors)
            if bulge == 0.0 and square and not known:
                floors.append(middle)
                width = abs(complex(end - start))
    if not floors:
        return None
    return Slots(len(floors), width, radius - abs(floors[0]), floors[0])


def spoken_for(cylinder: Cylinder, features: Iterable[Feature]) -> bool:
    """Whether a feature gives the diameter of a cylinder of the body."""
    return any(
        isinstance(feature, Seat | AxialThread) and _lies_on(feature, cylinder)
        for feature in features
    )


def _lies_on(feature: Seat | AxialThread, cylinder: Cylinder) -> bool:
    size = feature.diameter if isinstance(feature, Seat) else feature.core
    centre = complex(*feature.centre) if isinstance(feature, Seat) else 0j
    return (
        feature.inside == cylinder.inside
        and abs(0.5 * size - cylinder.radius) < 1e-6
        and abs(centre - cylinder.centre) < 1e-6
        and feature.bottom < cylinder.top + SAME
        and feature.top > cylinder.bottom - SAME
    )


def levels(shape: Stack) -> tuple[float, ...]:
    """Heights of the faces across the axis, rising, m; the bottoms of drilled holes are none."""
    ends = {round(end, 9) for one in cylinders(shape) for end in (one.bottom, one.top)}
    ends |= {round(end, 9) for layer in shape.layers for end in _of_contours(layer)}
    found: list[float] = []
    for height in sorted(ends):
        if not found or height - found[-1] > 1e-7:
            found.append(height)
    return tuple(found)


def _of_contours(layer: Layer) -> tuple[float, ...]:
    """Ends of a layer that no circle bounds outside, such as a flange with ears."""
    return (layer.bottom, layer.top) if isinstance(layer.shape.outer, ArcContour) else ()


def cut_face(
    upper: Sequence[Rectangle],
    lower: Sequence[Rectangle],
    features: Sequence[Feature],
    directions: tuple[float, float],
) -> list[FloatArray]:
    """Outlines (k, 2) of the face that the section cuts, mm: along the axis and across it.

    Parameters
    ----------
    upper, lower : sequence of Rectangle
        Of the two half planes.
    features : sequence of Feature
        Chamfers, undercuts and grooves are taken away, and the points of drills.
    directions : (float, float)
        Of the half planes, rad.
    """  # fmt: skip
    from manifold3d import CrossSection, FillRule, OpType

    halves = []
    for pieces, direction, side in zip((upper, lower), directions, (1.0, -1.0), strict=True):
        boxes = [_box(piece, side) for piece in pieces]
        face = CrossSection(boxes, FillRule.NonZero)
        gone = [loop * (1.0, side) for loop in removed(features, direction)]
        gone = [loop if _area(loop) > 0.0 else loop[::-1] for loop in gone]
        if gone:
            face = face - CrossSection(gone, FillRule.NonZero)
        halves.append(face)
    joined = CrossSection.batch_boolean(halves, OpType.Add).simplify(1e-5)
    return [np.asarray(loop) for loop in joined.to_polygons()]


def _area(loop: FloatArray) -> float:
    x, y = loop.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _box(piece: Rectangle, side: float) -> FloatArray:
    low, high = sorted((side * piece.inner, side * piece.outer))
    a, b = round(_MM * piece.bottom, 7), round(_MM * piece.top, 7)
    c, d = round(_MM * low, 7), round(_MM * high, 7)
    return np.array([(a, c), (b, c), (b, d), (a, d)])


def removed(features: Iterable[Feature], direction: float) -> list[FloatArray]:
    """What features take from a half plane besides the body's own holes, mm: z, r."""
    loops: list[FloatArray] = []
    for feature in features:
        if isinstance(feature, Chamfer):
            loops += _chamfers(feature, direction)
        elif isinstance(feature, Groove):
            loops.append(_groove(feature))
        elif isinstance(feature, Undercut):
            loops.append(_undercut(feature, direction))
        elif isinstance(feature, TappedHole):
            loops += _drill_points(feature, direction)
    return loops


def _offset(centre: tuple[float, float], direction: float) -> float | None:
    """Where the half plane runs through an axis, m; None where it passes beside it."""
    along = complex(*centre) * np.exp(-1j * direction)
    return float(along.real) if abs(along.imag) < 1e-6 else None


def _chamfers(feature: Chamfer, direction: float) -> list[FloatArray]:
    up = 1.0 if feature.facing == "up" else -1.0
    out = -1.0 if feature.inside else 1.0
    z, width, depth = feature.height, feature.width, feature.depth
    over = 0.05 * width
    found = []
    for centre in feature.centres:
        middle = _offset(centre, direction)
        if middle is None:
            continue
        for side in (1.0, -1.0):
            r, away = middle + side * feature.radius, side * out
            loop = [
                (z - up * width, r),
                (z, r - away * depth),
                (z + up * over, r - away * depth),
                (z + up * over, r + away * over),
                (z - up * width, r + away * over),
            ]
            if r > 0.0:
                found.append(_MM * np.array(loop))
    return found


def _groove(feature: Groove) -> FloatArray:
    floor, wall = 0.5 * feature.diameter, feature.cylinder
    far = wall + 1e-3 if not feature.inside else wall - 1e-4
    a, b = feature.bottom, feature.top
    return _MM * np.array([(a, floor), (b, floor), (b, far), (a, far)])


def _undercut(feature: Undercut, direction: float) -> FloatArray:
    """The relief of DIN 509: a fillet from the shoulder, a floor, and a slope of 15 degrees."""
    up = 1.0 if feature.facing == "up" else -1.0
    inward = 1.0 if feature.inside else -1.0
    middle = _offset(feature.centre, direction) or 0.0
    r0, z0 = middle + feature.cylinder, feature.height
    depth, r = feature.depth, feature.radius
    run = depth / math.tan(math.radians(15.0))
    first = math.acos(max(1.0 - depth / r, -1.0))
    turns = np.linspace(first, 0.0, 7)
    fillet = [(r * (1.0 - math.sin(t)), depth - r * (1.0 - math.cos(t))) for t in turns]
    path = [*fillet, (max(feature.width - run, r), depth), (feature.width, 0.0)]
    over = -0.2 * depth
    path += [(feature.width, over), (fillet[0][0], over)]
    return _MM * np.array([(z0 + up * x, r0 + inward * d) for x, d in path])


def _drill_points(feature: TappedHole, direction: float) -> list[FloatArray]:
    if feature.through:
        return []
    up = 1.0 if feature.facing == "up" else -1.0
    radius = 0.5 * feature.drill
    bottom = feature.mouth - up * feature.drill_depth
    found = []
    for centre in feature.circle.centres:
        middle = _offset(centre, direction)
        if middle is not None and middle > 0.0:
            tip = bottom - up * radius / _POINT
            found.append(
                _MM
                * np.array([(bottom, middle - radius), (tip, middle), (bottom, middle + radius)])
            )
    return found
