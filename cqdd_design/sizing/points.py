"""Candidates on the grid of sizes a shop can make, evaluated by the same rules as the checks.

A point is four whole numbers of steps: eccentricity, tooth radius, wall spare (how many steps the
ring pitch radius stays below the largest the ring wall allows) and disc thickness. Two sizes need
no search: the pin circle is the largest the ligaments allow, which lowers every pin force and the
cam load, and the cam bearing is the lightest that carries what is wanted.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.cam_bearing import least_bore
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import ligament_hole_to_hole
from cqdd_design.geometry.trochoid import shortening_coefficient
from cqdd_design.sizing import masses, reserves
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.bought_parts import BearingTable
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.frame import THICKNESS_STEP, Frame
from cqdd_design.sizing.goals import Sizes, goal_value
from cqdd_design.sizing.shape_limits import RADIUS_STEP
from cqdd_design.sizing.stage_tables import StageTables

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]

_USUAL_RADIUS = 36e-3
"""Of a ring for which steps are chosen where a larger one is allowed, m."""
_SLACK = 1e-9
_PACKED = np.array([1 << 42, 1 << 21, 1], dtype=np.int64)
"""Makes one whole number of the three steps of a ring."""


@dataclass(frozen=True)
class Grid:
    """Steps of eccentricity and tooth radius (half a step of the tooth diameter), m."""

    throw: float
    tooth: float

    @property
    def steps(self) -> FloatArray:
        """Steps of the four variables of a point."""
        return np.array([self.throw, self.tooth, RADIUS_STEP, THICKNESS_STEP])


def manufacturing_grid(frame: Frame) -> Grid:
    """Steps that suit the ratio: about one per cent of a usual size, 10 um and 50 um at most.

    The eccentricity in a 72 mm ring is 1.6 mm at ratio 10 and 0.15 mm at ratio 100.
    """
    radius = 0.5 * min(frame.outer_radius, _USUAL_RADIUS)
    throw = radius / (frame.lobe_count + 1)
    tooth = radius * math.sin(math.pi / (frame.lobe_count + 1))
    return Grid(
        throw=next((step for step in (1e-5, 5e-6, 2e-6) if step <= 0.015 * throw), 1e-6),
        tooth=next((step for step in (5e-5, 2.5e-5, 1e-5) if step <= 0.03 * tooth), 5e-6),
    )


@dataclass(frozen=True)
class Points(Columns):
    """Grid points with what follows from them; every field (M,), SI.

    Attributes
    ----------
    steps : array of int (M, 4)
        Eccentricity, tooth radius, wall spare, thickness in steps of the grid.
    pin_count, pin_size, bearing : array of int
        N_w, row of ``frame.pin_sizes``, row of ``frame.bearings``.
    pitch_radius, pin_circle, outer_radius : array
        R, R_w, and the ring's outside.
    reserve : array
        Least torque reserve; zero where the shape is wrong or no bearing fits.
    mass, gearbox_inertia, reflected_inertia, objective : array
        From :mod:`cqdd_design.sizing.masses`; the objective is infinite where the reserve is zero.
    """

    steps: IntArray
    pin_count: IntArray
    pin_size: IntArray
    bearing: IntArray
    pitch_radius: FloatArray
    pin_circle: FloatArray
    outer_radius: FloatArray
    reserve: FloatArray
    mass: FloatArray
    gearbox_inertia: FloatArray
    reflected_inertia: FloatArray
    objective: FloatArray

    @property
    def count(self) -> int:
        """M."""
        return int(self.reserve.size)

    def replaced(self, which: IntArray, others: Points) -> Points:
        """These points with others in some places."""
        changed = {name: column.copy() for name, column in vars(self).items()}
        for name, column in vars(others).items():
            changed[name][which] = column
        return Points(**changed)


@dataclass(frozen=True)
class Pins(Columns):
    """Output pins of candidates, every field (M,)."""

    count: IntArray
    size: IntArray
    diameter: FloatArray
    sleeve: FloatArray
    running_radius: FloatArray
    play_radius: FloatArray
    offset: FloatArray
    peak_factor: FloatArray

    @classmethod
    def of(cls, frame: Frame, count: IntArray, size: IntArray) -> Pins:
        """Look up sizes and force factors for pin counts and rows of ``frame.pin_sizes``."""
        factor = {int(c): rigid.peak_pin_force_factor(int(c)) for c in np.unique(count)}
        offset = {int(c): shapes.valley_offset(frame, int(c)) for c in np.unique(count)}
        sizes = [frame.pin_sizes[row] for row in size]
        running = np.array([s.running_diameter for s in sizes])
        return cls(
            count=count,
            size=size,
            diameter=np.array([s.diameter for s in sizes]),
            sleeve=np.array([s.sleeve_diameter for s in sizes]),
            running_radius=0.5 * running,
            play_radius=0.5 * (running + np.array([s.hole_clearance for s in sizes])),
            offset=np.array([offset[int(c)] for c in count]),
            peak_factor=np.array([factor[int(c)] for c in count]),
        )


@dataclass(frozen=True)
class _Shapes(shapes.RingSizes):
    """Sizes of candidates (M,) that do not depend on thickness or bearing, m."""

    hole_radius: FloatArray
    pin_circle: FloatArray
    possible: BoolArray


@dataclass(frozen=True)
class Evaluator:
    """Evaluates points of one search.

    Attributes
    ----------
    frame, tables, grid
        What the requirements fix, the rigid law's pure numbers, and the steps.
    bearings : BearingTable
        All cam bearings of the frame.
    pin_sums : dict
        :meth:`StageTables.pin_sums` by pin count.
    """

    frame: Frame
    tables: StageTables
    grid: Grid
    bearings: BearingTable
    pin_sums: dict[int, FloatArray]

    @classmethod
    def of(cls, frame: Frame, tables: StageTables, pin_counts: Iterable[int]) -> Evaluator:
        """Prepare for some pin counts."""
        sums = {
            int(count): tables.pin_sums(int(count), frame.disc_count, frame.clocking)
            for count in sorted(set(pin_counts))
        }
        return cls(frame, tables, manufacturing_grid(frame), frame.bearing_table(), sums)

    def evaluate(
        self, ring_steps: IntArray, thickness: IntArray, pins: Pins, wanted: FloatArray
    ) -> Points:
        """Every thickness on every ring stage: (M, 3) and (M, T) steps to M x T points.

        Parameters
        ----------
        ring_steps : array of int (M, 3)
            Eccentricity, tooth radius, wall spare.
        thickness : array of int (M, T)
        pins : Pins (M,)
        wanted : array (M,)
            Torque reserve for which the cam bearing is chosen.
        """
        shape = self._shapes(ring_steps, pins)
        top = round(self.frame.most_thickness / THICKNESS_STEP)
        allowed = shape.possible[:, None] & (thickness > 0) & (thickness <= top)
        b = np.where(allowed, thickness, 1) * THICKNESS_STEP
        carried = self._carried(shape, b, self._cam_load(shape, pins))
        each = np.minimum(carried, self._stress_reserve(shape, b, pins)[..., None])
        weights = self._weights(shape, b, pins)
        objective = self._objective(weights, shape, b, pins)
        # Of the bearings that reach what is wanted the best, else the strongest.
        ranked = np.where(each >= wanted[:, None, None], objective, np.inf)
        bearing = ranked.argmin(axis=-1)
        bearing = np.where(np.isinf(ranked.min(axis=-1)), carried.argmax(axis=-1), bearing)

        def of_chosen(value: FloatArray) -> FloatArray:
            return np.take_along_axis(value, bearing[..., None], axis=-1).ravel()

        reserve = np.where(allowed.ravel(), of_chosen(each), 0.0)
        steps = np.empty((*b.shape, 4), dtype=np.intp)
        steps[..., :3], steps[..., 3] = ring_steps[:, None], thickness
        times = b.shape[1]
        return Points(
            steps=steps.reshape(-1, 4),
            pin_count=np.repeat(pins.count, times),
            pin_size=np.repeat(pins.size, times),
            bearing=bearing.ravel(),
            pitch_radius=np.repeat(shape.pitch_radius, times),
            pin_circle=np.repeat(shape.pin_circle, times),
            outer_radius=np.repeat(shapes.outer_radius(self.frame, shape), times),
            reserve=reserve,
            mass=of_chosen(weights.mass),
            gearbox_inertia=of_chosen(weights.gearbox_inertia),
            reflected_inertia=of_chosen(weights.reflected_inertia),
            objective=np.where(reserve > 0.0, of_chosen(objective), np.inf),
        )

    def _shapes(self, steps: IntArray, pins: Pins) -> _Shapes:
        """Sizes (M,) in metres, and which of them make a disc and a ring."""
        frame = self.frame
        possible = (steps[:, 0] > 0) & (steps[:, 1] > 0) & (steps[:, 2] >= 0)
        # Impossible points get harmless sizes, and a reserve of zero in the end.
        sound = np.where(possible[:, None], steps[:, :2], 1).astype(np.float64)
        e, r = sound[:, 0] * self.grid.throw, sound[:, 1] * self.grid.tooth
        room = np.floor(shapes.largest_pitch_for_wall(frame, e, r) / RADIUS_STEP + 1e-6)
        pitch = (room - steps[:, 2]) * RADIUS_STEP
        possible &= r + e < pitch
        R = np.where(possible, pitch, frame.outer_radius).astype(np.float64)
        ring = shapes.RingSizes(R, e, r)
        for met in shapes.profile_checks(frame, ring).values():
            possible &= met
        # Many pins stand in one ring: what only the ring decides is worked out once.
        sound_rings = np.flatnonzero(possible)
        _, first, place = np.unique(
            steps[sound_rings] @ _PACKED, return_index=True, return_inverse=True
        )
        passes = shapes.relief_passes_wire(frame, ring.rows(sound_rings[first]))
        possible[sound_rings] = passes[place]
        hole = pins.play_radius + e
        circle = shapes.largest_pin_circle(frame, ring, hole, pins.offset)
        circle = np.floor(circle / RADIUS_STEP) * RADIUS_STEP
        web = ligament_hole_to_hole(circle, pins.count, 2.0 * hole)
        possible &= (circle > hole) & (web >= allowables.LIGAMENT - _SLACK)
        possible &= hole >= frame.wire_radius
        circle = np.where(possible, circle, frame.outer_radius)
        return _Shapes(R, e, r, hole, circle, possible)

    def _stress_reserve(self, shape: _Shapes, b: FloatArray, pins: Pins) -> FloatArray:
        """Least reserve (M, T) of ring contact and output pins."""
        number = self.tables.pressure_at(
            self._shortening(shape),
            shape.tooth_radius / (shape.pitch_radius * self.tables.tooth_spacing),
        )
        found = reserves.ring_reserves(self.frame, number[:, None], shape.pitch_radius[:, None], b)
        per_radius = reserves.pin_reserves_per_radius(
            self.frame,
            pins.peak_factor[:, None],
            pins.count[:, None],
            pins.diameter[:, None],
            pins.running_radius[:, None],
            shape.hole_radius[:, None],
            b,
        )
        least = np.full(b.shape, np.inf)
        for value in found.values():
            least = np.minimum(least, value)
        needles = reserves.needle_reserves_per_radius(
            self.frame,
            pins.peak_factor[:, None],
            pins.count[:, None],
            self._cage_ratings(pins, b),
            pins.sleeve[:, None],
        )
        for value in (*per_radius.values(), *needles.values()):
            least = np.minimum(least, value * shape.pin_circle[:, None])
        return least

    def _cage_ratings(self, pins: Pins, b: FloatArray) -> tuple[FloatArray, FloatArray]:
        """C0 and C (M, T) of the needle cages inside the sleeves."""
        static, dynamic = np.empty(b.shape), np.empty(b.shape)
        for row in np.unique(pins.size):
            same = pins.size == row
            static[same], dynamic[same] = self.frame.pin_sizes[row].cage_ratings(b[same])
        return static, dynamic

    def _shortening(self, shape: _Shapes) -> FloatArray:
        return shortening_coefficient(self.frame.lobe_count, shape.pitch_radius, shape.eccentricity)

    def _cam_load(self, shape: _Shapes, pins: Pins) -> FloatArray:
        """Largest cam load (M,) at the peak torque, N."""
        radial = self.tables.radial_at(self._shortening(shape))
        ratio = shape.pitch_radius / shape.pin_circle
        number = np.empty(ratio.shape)
        for count in np.unique(pins.count):
            rows = np.flatnonzero(pins.count == count)
            number[rows] = self.tables.cam_radial_peak(
                radial[:, rows], self.pin_sums[int(count)], ratio[rows]
            )
        return reserves.cam_load(self.frame, shape.pitch_radius, shape.eccentricity, number)

    def _carried(self, shape: _Shapes, b: FloatArray, load: FloatArray) -> FloatArray:
        """Torque reserve (M, T, B) of every cam bearing; zero where it does not fit."""
        table = self.bearings
        valley = shapes.valley_distance(self.frame, shape)
        inside = np.minimum(shape.pin_circle - shape.hole_radius, valley)
        seat = inside - allowables.LIGAMENT + _SLACK
        bore = least_bore(shape.eccentricity) - _SLACK
        fits = (0.5 * table.outer <= seat[:, None]) & (table.bore >= bore[:, None])
        carried = np.where(fits, table.allowed_load / load[:, None], 0.0)
        return np.where(table.width <= b[..., None] + _SLACK, carried[:, None, :], 0.0)

    def _objective(
        self, weights: masses.Weights, shape: _Shapes, b: FloatArray, pins: Pins
    ) -> FloatArray:
        """What the search makes small, (M, T, B)."""
        own = (slice(None), None, None)
        share = shape.tooth_radius / (shape.pitch_radius * self.tables.tooth_spacing)
        sizes = Sizes(
            eccentricity=shape.eccentricity[own],
            thickness=b[..., None],
            pin_circle=shape.pin_circle[own],
            hole_clearance=2.0 * (pins.play_radius - pins.running_radius)[own],
            outer_radius=shapes.outer_radius(self.frame, shape)[own],
            friction=self.tables.friction_at(self._shortening(shape), share)[own],
        )
        return np.broadcast_to(goal_value(self.frame, weights, sizes), weights.mass.shape)

    def _weights(self, shape: _Shapes, b: FloatArray, pins: Pins) -> masses.Weights:
        """Mass and inertia (M, T, B) with every cam bearing."""
        table = self.bearings
        area, polar = shapes.profile_integrals(self.frame, shape)
        own = (slice(None), None, None)
        return masses.weigh(
            self.frame,
            profile_area=area[own],
            profile_polar=polar[own],
            ring_opening=shapes.ring_opening_area(self.frame, shape)[own],
            ring_outer=shapes.outer_radius(self.frame, shape)[own],
            eccentricity=shape.eccentricity[own],
            thickness=b[..., None],
            pin_count=pins.count[own],
            pin_diameter=pins.diameter[own],
            sleeve_diameter=pins.sleeve[own],
            hole_radius=shape.hole_radius[own],
            pin_circle=shape.pin_circle[own],
            bearing_outer=table.outer,
            bearing_bore=table.bore,
            bearing_mass=table.mass,
        )
