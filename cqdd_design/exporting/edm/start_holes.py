"""Where the wire is threaded: one start hole for every contour, clear of its wall.

::

        wall          distance from the contour's first joint, along its normal
       |  1 mm  __
    P0 +-------(  )   P0 first joint of the contour; the cut runs from here
       |        --
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.design.actuator import THINNEST_WIRE
from cqdd_design.errors import GeometryError
from cqdd_design.exporting.edm.begin import begun
from cqdd_design.exporting.edm.flat_parts import FlatPart, reach_of
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.geometry.contours import ArcContour, Circle, Contour, as_complex, as_points
from cqdd_design.units import LENGTH, parse_quantity

DIAMETER = 1.5e-3
"""Of a start hole where there is room, m: an everyday electrode of EDM drilling machines."""
WALL = 1.0e-3
"""From start hole to contour where there is room, m: a drilled hole wanders and burns."""
THREADING = 0.1e-3
"""A start hole is at least this much wider than the wire, m."""

_PLACES = 96


def start_holes(
    flat: FlatPart, wire_diameter: float, tab: float = DEFAULTS.tab_length
) -> tuple[Circle, ...]:
    """Start holes of a part: outside its outer contour, then inside each inner one, in order.

    Parameters
    ----------
    tab : float
        Length of the tab of a contour that is long enough, at whose end its cut begins, m.

    Raises
    ------
    GeometryError
        When a contour is too small for a hole that takes the wire.
    """
    holes = [_beside(flat, 0, tab, DIAMETER / 2.0, WALL)]
    for number, contour in enumerate(flat.shape.holes, start=1):
        room = _room_at_centre(contour)
        scale = min(1.0, room / (DIAMETER / 2.0 + WALL))
        radius = scale * DIAMETER / 2.0
        if 2.0 * radius < wire_diameter + THREADING:
            need = (wire_diameter + THREADING) * (1.0 + 2.0 * WALL / DIAMETER)
            most = 2.0 * radius - THREADING
            thinner = (
                f"choose a wire of at most {math.floor(most * 1e6) * 1e-3:.3f} mm"
                if most >= parse_quantity(THINNEST_WIRE, LENGTH)
                else f"no wire of {THINNEST_WIRE} or more fits it"
            )
            raise GeometryError(
                f"{flat.label}: inner contour {number} is {2e3 * room:.3g} mm across, too small "
                f"for a start hole that takes edm.wire_diameter {wire_diameter * 1e3:g} mm and is "
                f"clear of the wall; make it {need * 1e3:.3g} mm, or {thinner}."
            )
        holes.append(_beside(flat, number, tab, radius, scale * WALL))
    return tuple(holes)


def _room_at_centre(contour: Contour) -> float:
    """Radius of the circle about the contour's centre of area that just touches it, m."""
    if isinstance(contour, Circle):
        return contour.radius
    return float(contour.distances(contour.moments().centroid[None, :])[0])


def _first_joint(contour: ArcContour) -> tuple[complex, complex]:
    """Where the cut of a contour starts, and the unit normal to its left."""
    slope = complex(*contour.evaluate(np.zeros(1))[1][0, 0])
    return complex(*contour.points[0]), 1j * slope / abs(slope)


def _beside(flat: FlatPart, number: int, tab: float, radius: float, wall: float) -> Circle:
    """Find the nearest place to the first joint, straight off the contour, that is clear of it."""
    contour, side = flat.contours[number], 1.0 if number else -1.0
    joint, normal = _first_joint(begun(flat, number, tab))
    need = radius + wall
    centre = contour.centre if isinstance(contour, Circle) else contour.moments().centroid
    inward = abs(complex(*centre) - joint)
    # Inward to the centre, where there is room for it; outward until nothing is farther out.
    reach = inward if side > 0.0 else need + reach_of(contour) - inward
    offsets = np.linspace(min(need, reach), max(need, reach), _PLACES)
    places = joint + side * normal * offsets
    if isinstance(contour, Circle):
        distances = np.abs(np.abs(places - as_complex(contour.centre)) - contour.radius)
    else:
        distances = contour.distances(as_points(places))
    clear = distances >= need * (1.0 - 1e-9)
    return Circle(as_points(places[clear.argmax() if clear.any() else -1]), radius)
