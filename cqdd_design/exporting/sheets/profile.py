"""What of a turned part is measured on its sheet: cylinders, faces, and the face that is cut.

Cylinders and faces are those of the body. A feature speaks for the cylinder that it lies on, so
each is dimensioned once: by its feature where there is one, by the body otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.errors import CatalogError
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    Contour,
    FloatArray,
    as_complex,
)
from cqdd_design.solids.axial_view import Rectangle
from cqdd_design.solids.features.kinds import AxialThread, Feature, Seat
from cqdd_design.solids.features.revolved import Revolved
from cqdd_design.solids.layers import Layer, Stack
from cqdd_design.solids.slabs import SAME

_MM = 1e3


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
        for contour, inside in _walls(layer):
            if not isinstance(contour, Circle) or not _round_axis(contour):
                continue
            centre = complex(*contour.centre)
            for bottom, top in _bare(shape, layer, contour, inside):
                one = Cylinder(contour.radius, bottom, top, inside, centre)
                for i, known in enumerate(found):
                    if _continues(known, one):
                        found[i] = replace(known, top=top)
                        break
                else:
                    found.append(one)
    return tuple(found)


def _bare(
    shape: Stack, layer: Layer, contour: Circle, inside: bool
) -> Iterator[tuple[float, float]]:
    """Heights between which a wall of a layer is no seam with a layer beside it, rising, m."""
    low = layer.bottom
    for other in sorted(shape.layers, key=lambda one: one.bottom):
        if not _beside(layer, other):
            continue
        if any(bore is not inside and _same(contour, mate) for mate, bore in _walls(other)):
            if other.bottom - low > SAME:
                yield low, other.bottom
            low = max(low, other.top)
    if layer.top - low > SAME:
        yield low, layer.top


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


def _continues(known: Cylinder, one: Cylinder) -> bool:
    return (
        known.inside == one.inside
        and abs(known.radius - one.radius) < SAME
        and abs(known.centre - one.centre) < SAME
        and abs(known.top - one.bottom) < SAME
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


@dataclass(frozen=True)
class Sector:
    """A part that is a piece of a ring round the axis, with radial ends, m and rad.

    Attributes
    ----------
    inner : float
        Its lesser radius.
    angle : float
        Between its ends.
    spot : complex
        A place on its inner edge, off the middle.
    """

    inner: float
    angle: float
    spot: complex


def sector(shape: Stack) -> Sector | None:
    """The piece of a ring that a part is; None of any other."""
    contour = shape.layers[0].shape.outer
    if len(shape.layers) > 1 or not isinstance(contour, ArcContour) or len(contour.points) != 4:
        return None
    arcs = contour.arcs()
    curved = np.isfinite(arcs.radii)
    if curved.sum() != 2 or np.hypot(*arcs.centres[curved].T).max() > 1e-9:
        return None
    inner = float(arcs.radii[curved].min())
    corners = as_complex(contour.points)
    ends = corners[np.abs(np.abs(corners) - inner) < SAME]
    middle = complex(ends.sum())
    angle = 2.0 * abs(float(np.angle(ends[0] / middle)))
    return Sector(inner, angle, inner * middle / abs(middle) * complex(np.exp(0.25j * angle)))


def spoken_for(cylinder: Cylinder, features: Iterable[Feature]) -> bool:
    """Whether a feature gives the diameter of a cylinder of the body."""
    return any(
        isinstance(feature, Seat | AxialThread) and _lies_on(feature, cylinder)
        for feature in features
    )


def _lies_on(feature: Seat | AxialThread, cylinder: Cylinder) -> bool:
    centre = complex(*feature.centre) if isinstance(feature, Seat) else 0j
    return (
        feature.inside == cylinder.inside
        and _is_size_of(feature, 2.0 * cylinder.radius)
        and abs(centre - cylinder.centre) < 1e-6
        and feature.bottom < cylinder.top + SAME
        and feature.top > cylinder.bottom - SAME
    )


def _is_size_of(feature: Seat | AxialThread, diameter: float) -> bool:
    """Whether a body has a feature's diameter, or one of its zone, as pins drawn at their mean."""
    if isinstance(feature, AxialThread):
        return abs(diameter - feature.core) < 2e-6
    if abs(diameter - feature.diameter) < 2e-6:
        return True
    try:
        limits = feature.limits
    except CatalogError:
        return False
    return limits.lower <= diameter - feature.diameter <= limits.upper


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
    cuts: Sequence[Revolved],
    directions: tuple[float, float],
) -> list[FloatArray]:
    """Outlines (k, 2) of the face that the section cuts, mm: along the axis and across it.

    Parameters
    ----------
    upper, lower : sequence of Rectangle
        Of the two half planes.
    cuts : sequence of Revolved
        What features take away besides.
    directions : (float, float)
        Of the half planes, rad.
    """
    from manifold3d import CrossSection, FillRule, OpType

    halves = []
    for pieces, direction, side in zip((upper, lower), directions, (1.0, -1.0), strict=True):
        face = CrossSection([_box(piece, side) for piece in pieces], FillRule.NonZero)
        gone = [loop * (1.0, side) for loop in removed(cuts, direction)]
        gone = [loop if _area(loop) > 0.0 else loop[::-1] for loop in gone]
        if gone:
            face = face - CrossSection(gone, FillRule.NonZero)
        halves.append(face)
    joined = CrossSection.batch_boolean(halves, OpType.Add).simplify(1e-5)
    return [np.asarray(loop) for loop in joined.to_polygons()]


def removed(cuts: Iterable[Revolved], direction: float) -> list[FloatArray]:
    """Outlines of what is cut away in a half plane, mm: along the axis and across it."""
    loops = []
    for cut in cuts:
        corners = np.array(cut.chorded.outline)
        for centre in cut.centres:
            along = complex(*centre) * np.exp(-1j * direction)
            if abs(along.imag) > 1e-6:
                continue
            for side in (1.0, -1.0):
                across = along.real + side * corners[:, 0]
                if across.max() > 0.0:
                    loops.append(_MM * np.column_stack([corners[:, 1], across]))
    return loops


def _area(loop: FloatArray) -> float:
    x, y = loop.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _box(piece: Rectangle, side: float) -> FloatArray:
    low, high = sorted((side * piece.inner, side * piece.outer))
    a, b = round(_MM * piece.bottom, 7), round(_MM * piece.top, 7)
    c, d = round(_MM * low, 7), round(_MM * high, 7)
    return np.array([(a, c), (b, c), (b, d), (a, d)])
