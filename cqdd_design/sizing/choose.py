"""The best of a screen, each of another kind, as starts for the refinement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing import masses
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.frame import Frame
from cqdd_design.sizing.goals import Sizes, goal_value
from cqdd_design.sizing.screen import Screened
from cqdd_design.sizing.space import SearchSpace

IntArray = NDArray[np.intp]

_MUCH_THICKER = 1.6
"""Thickness over the thinnest that carries the load, beyond which no candidate is weighed."""


@dataclass(frozen=True)
class Picks:
    """Candidates as arrays (M,), best first; SI.

    Attributes
    ----------
    pitch_radius, eccentricity, tooth_radius, thickness : array
        R, e, r, b.
    pin_count, pin_size : array of int
        N_w and row of ``frame.pin_sizes``.
    merit : array
        What they were ranked by.
    """

    pitch_radius: FloatArray
    eccentricity: FloatArray
    tooth_radius: FloatArray
    thickness: FloatArray
    pin_count: IntArray
    pin_size: IntArray
    merit: FloatArray

    @property
    def count(self) -> int:
        """M."""
        return int(self.merit.size)


def strongest(space: SearchSpace, found: Screened, most: int) -> Picks:
    """Candidates with the most torque reserve among those whose shape is right, ready or not.

    Up to `most` with different pins, and the strongest of every thickness: a wide bearing needs
    thick discs, which leave it other sizes than a narrow one.
    """
    load = np.where(found.cam_load > 0.0, found.cam_load, np.inf)[:, None]
    carried = np.where(found.fits, found.bearings.allowed_load / load, 0.0)
    cam = np.zeros(found.reserve.shape)
    for place in range(space.thickness.size):
        fitting = found.pairs[:, place]
        if fitting.any():
            cam[:, place] = carried[:, fitting].max(axis=1)
    reserve = np.minimum(cam, found.reserve)
    thickness = reserve.argmax(axis=1)
    merit = reserve.max(axis=1, initial=0.0)
    kept = np.flatnonzero(merit > 0.0)
    groups = found.rows.count[kept] * space.pin_sizes.size + found.rows.size[kept]
    best = kept[_best_of_groups(groups, -merit[kept], most)]
    if best.size == 0:
        return _picks(space, found, best, best, merit[best])
    rows = np.concatenate([best, reserve.argmax(axis=0)])
    columns = np.concatenate([thickness[best], np.arange(space.thickness.size)])
    sound = np.flatnonzero(reserve[rows, columns] > 0.0)
    rows, columns = rows[sound], columns[sound]
    return _picks(space, found, rows, columns, reserve[rows, columns])


class Bound(NamedTuple):
    """The best survivor of a screen with one cam bearing.

    Attributes
    ----------
    objective : float
        What the search makes small.
    bearing : Bearing
    """

    objective: float
    bearing: Bearing


class _Ready(NamedTuple):
    """Survivors of a screen, each in the thinnest discs that carry the load, (M,).

    `row`, `bearing` and `thickness` are places in what was screened.
    """

    row: IntArray
    bearing: IntArray
    thickness: IntArray
    objective: FloatArray


def strong_bearings(frame: Frame, space: SearchSpace, found: Screened) -> list[str]:
    """Designations of the cam bearings with something right in shape, those that bear most first.

    As far as screened candidates have torque reserve, ready or not.
    """
    load = np.where(found.cam_load > 0.0, found.cam_load, np.inf)[:, None]
    cam = np.where(found.fits, found.bearings.allowed_load / load, 0.0)
    most = np.zeros(space.bearings.size)
    for place in range(space.thickness.size):
        both = np.minimum(cam, found.reserve[:, place, None]) * found.pairs[:, place]
        most = np.maximum(most, both.max(axis=0, initial=0.0))
    order = [row for row in np.argsort(-most, kind="stable") if most[row] > 0.0]
    return [frame.bearings[space.bearings[row]].designation for row in order]


def lightest(
    frame: Frame, space: SearchSpace, found: Screened, most: int, wanted: float = 1.0
) -> Picks:
    """Survivors with the least objective, each in the thinnest discs that carry the load.

    Parameters
    ----------
    frame, space, found
        Of the screen.
    most : int
        Up to so many with different pins, with different bearings, and of different thickness.
    wanted : float
        Torque reserve they must have, at least 1.
    """
    ready = _ready(frame, space, found, wanted)
    row, thickness, objective = ready.row, ready.thickness, ready.objective
    pins = found.rows.count[row] * space.pin_sizes.size + found.rows.size[row]
    best = np.concatenate(
        [_best_of_groups(groups, objective, most) for groups in (pins, ready.bearing, thickness)]
    )
    best = np.unique(best)
    best = best[np.argsort(objective[best], kind="stable")]
    return _picks(space, found, row[best], thickness[best], objective[best])


def by_bearing(frame: Frame, space: SearchSpace, found: Screened) -> tuple[Bound, ...]:
    """The best survivor with each cam bearing, best first."""
    ready = _ready(frame, space, found, 1.0)
    best = _best_of_groups(ready.bearing, ready.objective, space.bearings.size)
    return tuple(
        Bound(
            float(ready.objective[one]),
            frame.bearings[space.bearings[ready.bearing[one]]],
        )
        for one in best
    )


def _ready(frame: Frame, space: SearchSpace, found: Screened, wanted: float) -> _Ready:
    rows = found.rows
    carried = found.fits & (found.bearings.allowed_load >= wanted * found.cam_load[:, None])
    enough = found.reserve >= wanted
    thinnest = np.full(carried.shape, -1, dtype=np.intp)
    for place in reversed(range(space.thickness.size)):
        thinnest[enough[:, place, None] & found.pairs[:, place]] = place
    ready = carried & (thinnest >= 0)
    if ready.any():
        # Ring and discs weigh in proportion to the thickness; much thicker ones cannot win.
        least = space.thickness[thinnest[ready].min()]
        ready &= space.thickness[thinnest] <= _MUCH_THICKER * least
    row, bearing = np.nonzero(ready)
    thickness = thinnest[row, bearing]
    area, polar = shapes.profile_integrals(frame, found.rings)
    opening = shapes.ring_opening_area(frame, found.rings)
    outer = shapes.outer_radius(frame, found.rings)
    ring = rows.ring[row]
    sizes = [frame.pin_sizes[size] for size in space.pin_sizes]
    diameters = np.array([one.diameter for one in sizes])
    sleeves = np.array([one.sleeve_diameter for one in sizes])
    plays = np.array([one.hole_clearance for one in sizes])
    weights = masses.weigh(
        frame,
        profile_area=area[ring],
        profile_polar=polar[ring],
        ring_opening=opening[ring],
        ring_outer=outer[ring],
        eccentricity=found.rings.eccentricity[ring],
        thickness=space.thickness[thickness],
        pin_count=np.array(space.pin_counts)[rows.count[row]],
        pin_diameter=diameters[rows.size[row]],
        sleeve_diameter=sleeves[rows.size[row]],
        hole_radius=rows.hole_radius[row],
        pin_circle=rows.circle[row],
        bearing_outer=found.bearings.outer[bearing],
        bearing_bore=found.bearings.bore[bearing],
        bearing_mass=found.bearings.mass[bearing],
    )
    objective = goal_value(
        frame,
        weights,
        Sizes(
            eccentricity=found.rings.eccentricity[ring],
            thickness=space.thickness[thickness],
            pin_count=np.array(space.pin_counts)[rows.count[row]],
            pin_circle=rows.circle[row],
            hole_clearance=plays[rows.size[row]],
            outer_radius=outer[ring],
            friction=found.rings.friction_number[ring],
        ),
    )
    return _Ready(row, bearing, thickness, objective)


def _best_of_groups(groups: IntArray, rank: FloatArray, most: int) -> IntArray:
    """Places of the lowest rank in each group, and of those the `most` lowest."""
    least = np.full(int(groups.max(initial=-1)) + 1, np.inf)
    np.minimum.at(least, groups, rank)
    reached = np.flatnonzero(rank == least[groups])
    best = reached[np.unique(groups[reached], return_index=True)[1]]
    return np.asarray(best[np.argsort(rank[best], kind="stable")[:most]])


def _picks(
    space: SearchSpace, found: Screened, row: IntArray, thickness: IntArray, merit: FloatArray
) -> Picks:
    rings, ring = found.rings, found.rows.ring[row]
    return Picks(
        pitch_radius=rings.pitch_radius[ring],
        eccentricity=rings.eccentricity[ring],
        tooth_radius=rings.tooth_radius[ring],
        thickness=space.thickness[thickness],
        pin_count=np.array(space.pin_counts, dtype=np.intp)[found.rows.count[row]],
        pin_size=space.pin_sizes[found.rows.size[row]],
        merit=merit,
    )
