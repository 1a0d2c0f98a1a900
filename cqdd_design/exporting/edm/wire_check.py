"""Paths of the wire measured against the contours of the same file.

A path that is at its distance from the contour everywhere cannot cross itself: beyond a crossing
it would be nearer to the other branch. Length and area say the same by another road: those of a
parallel curve follow from the contour's own (Steiner), and a loop too many changes both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.loops import ComplexArray, FloatArray, Loop
from cqdd_design.geometry.contours import Circle

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm

SLACK = 0.1e-6
"""A path keeps its distance within this, m."""
PERPENDICULAR = 1e-6
"""A lead-in meets its path square within this, rad."""
STEINER = 1e-9
"""Relative error of a path's length and area."""


def nearest_distances(path: Loop, contour: Loop) -> FloatArray:
    """Distance (k, m) of points on every segment of `path` to the nearest place of `contour`, m.

    Only segments that can be nearest are looked at: those whose surrounding circle is no farther
    than the surest of them can be.
    """
    points, _ = path.sampled()
    middle = 0.5 * (contour.start + contour.end)
    # A segment of a contour stays within its own length of the middle of its chord.
    reach = contour.lengths
    centre = points.mean(axis=1)
    spread = np.abs(points - centre[:, None]).max(axis=1)
    apart = np.abs(centre[:, None] - middle)
    surest = (apart + reach).min(axis=1) + spread
    which, near = np.nonzero(apart - reach <= (surest + spread)[:, None])
    found = np.full(points.shape, math.inf)
    count = points.shape[1]
    for begin in range(0, len(which), 50_000):
        rows, segments = which[begin : begin + 50_000], near[begin : begin + 50_000]
        every = contour.distances(points[rows].ravel(), np.repeat(segments, count))
        np.minimum.at(found, rows, every.reshape(-1, count))
    return found


def measure_path(label: str, path: Loop, contour: Loop, offset: float, *, outer: bool) -> None:
    """Measure one path against its contour.

    Raises
    ------
    ReadBackError
        When it leaves its distance, crosses itself, or has a kink.
    """
    distance = nearest_distances(path, contour)
    least, largest = float(distance.min()), float(distance.max())
    if not (largest - offset <= SLACK and offset - least <= SLACK):
        raise ReadBackError(
            f"{label}: the wire path runs {least * 1e3:.5f} to {largest * 1e3:.5f} mm from the "
            f"contour, not {offset * 1e3:.5f} mm."
        )
    sign = 1.0 if outer else -1.0
    # A corner of the material takes an arc: what the contour turns there, the path runs.
    length = contour.perimeter + sign * 2.0 * math.pi * offset
    area = contour.area + sign * contour.perimeter * offset + math.pi * offset**2
    if (
        abs(path.perimeter - length) > STEINER * contour.perimeter
        or abs(path.area - area) > STEINER * contour.area
    ):
        raise ReadBackError(
            f"{label}: the wire path is {path.perimeter * 1e3:.5f} mm long round "
            f"{path.area * 1e6:.5f} mm^2, not {length * 1e3:.5f} mm round {area * 1e6:.5f} mm^2: "
            "it crosses itself or leaves a stretch out."
        )


def measure_paths(
    label: str,
    paths: Sequence[Loop],
    leads: Sequence[tuple[complex, complex]],
    starts: Sequence[Circle],
    contours: tuple[Sequence[Loop], Sequence[Loop]],
    edm: Edm,
) -> None:
    """Measure all paths of a part, each with its lead-in from its start hole.

    Parameters
    ----------
    label : str
        Of the part.
    paths : sequence of Loop
        Of the wire's centre.
    leads : sequence of (start, end)
        m.
    starts : sequence of Circle
        Start holes.
    contours : outer loops, inner loops
        As read from the same file.
    edm : Edm
        Wire and gap.

    Raises
    ------
    ReadBackError
        When paths, lead-ins, start holes and contours do not belong together one by one.
    """
    offset = edm.wire_offset
    every = [(loop, True) for loop in contours[0]] + [(loop, False) for loop in contours[1]]
    if not len(paths) == len(leads) == len(starts) == len(every):
        raise ReadBackError(
            f"{label}: {len(paths)} wire paths and {len(leads)} lead-ins for {len(every)} "
            "contours; each has one."
        )
    left = list(every)
    for number, (path, lead, start) in enumerate(zip(paths, leads, starts, strict=True)):
        name = f"{label}, wire path {number + 1}"
        begin = path.start[:1]
        own = min(left, key=lambda one: _distance(one[0], begin))
        left.remove(own)
        measure_path(name, path, own[0], offset, outer=own[1])
        _refuse_bad_lead(name, path, lead, start, every, offset)


def _distance(loop: Loop, points: ComplexArray) -> float:
    """Least distance of points to a loop, m."""
    count = len(loop.bulge)
    repeated = np.repeat(points, count)
    return float(loop.distances(repeated, np.tile(np.arange(count), len(points))).min())


def _refuse_bad_lead(
    name: str,
    path: Loop,
    lead: tuple[complex, complex],
    start: Circle,
    contours: Sequence[tuple[Loop, bool]],
    offset: float,
) -> None:
    """From the start hole's centre to the path's first joint, square to it and clear of walls."""
    begin, end = lead
    if abs(begin - complex(*start.centre)) > SLACK or abs(end - path.start[0]) > SLACK:
        raise ReadBackError(f"{name}: the lead-in does not join start hole and path.")
    along = np.exp(-0.5j * path.sweep[0]) * (path.end[0] - path.start[0])
    square = abs(math.remainder(float(np.angle((end - begin) / along)), math.pi))
    if abs(square - math.pi / 2.0) > PERPENDICULAR:
        raise ReadBackError(
            f"{name}: the lead-in meets the path at {math.degrees(square):.4f} deg, not square."
        )
    places = np.asarray(begin + (end - begin) * np.linspace(0.0, 1.0, 200), dtype=complex)
    nearest = min(_distance(loop, places) for loop, _ in contours)
    if nearest < offset - SLACK:
        raise ReadBackError(
            f"{name}: the lead-in comes within {nearest * 1e3:.4f} mm of a contour, less than "
            f"wire and gap, {offset * 1e3:.4f} mm; it would cut into the part."
        )
