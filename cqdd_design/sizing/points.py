"""Candidates on the grid of sizes a shop can make, evaluated by the same rules as the checks.

A point is four whole numbers of steps: eccentricity, tooth radius, wall spare (how many steps the
ring pitch radius stays below the largest the ring wall allows) and disc thickness. Two sizes need
no search: the pin circle is the largest the ligaments allow, which lowers every pin force and the
cam load, and the cam bearing is the lightest that carries what is wanted.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.cam_bearing import least_bore
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing import masses, reserves
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.bought_parts import BearingTable
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.frame import THICKNESS_STEP, Frame
from cqdd_design.sizing.goals import Sizes, goal_value
from cqdd_design.sizing.ring_stages import (
    SLACK,
    Grid,
    Pins,
    RingStages,
    StageWork,
    manufacturing_grid,
)
from cqdd_design.sizing.shape_limits import RADIUS_STEP
from cqdd_design.sizing.stage_tables import StageTables

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]


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

    def different(self) -> Points:
        """Each point once."""
        places = np.column_stack([self.steps, self.pin_count, self.pin_size])
        return self.rows(np.sort(np.unique(places, axis=0, return_index=True)[1]))

    def replaced(self, which: IntArray, others: Points) -> Points:
        """These points with others in some places."""
        changed = {name: column.copy() for name, column in vars(self).items()}
        for name, column in vars(others).items():
            changed[name][which] = column
        return Points(**changed)


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

    def placed(self, points: Points) -> Points:
        """Points of another search, with the wall spare of the same pitch circles in these rings.

        Their steps alone are right; the largest pitch circle or eccentricity where the same does
        not go in.
        """
        steps = points.steps.copy()
        most = self.frame.throw_limit / self.grid.throw
        steps[:, 0] = np.minimum(steps[:, 0], most).astype(np.intp)
        sizes = steps.astype(np.float64)
        throw, tooth = sizes[:, 0] * self.grid.throw, sizes[:, 1] * self.grid.tooth
        room = shapes.largest_pitch_for_wall(self.frame, throw, tooth)
        spare = np.floor(room / RADIUS_STEP + 1e-6) - np.round(points.pitch_radius / RADIUS_STEP)
        steps[:, 2] = np.maximum(spare, 0).astype(np.intp)
        return replace(points, steps=steps)

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
        work = StageWork(self.frame, self.tables, self.grid, self.pin_sums)
        stage = work.known().stages(work, ring_steps, pins)
        top = round(self.frame.most_thickness / THICKNESS_STEP)
        allowed = (stage.possible > 0.0)[:, None] & (thickness > 0) & (thickness <= top)
        b = np.where(allowed, thickness, 1) * THICKNESS_STEP
        fits = self._fits(stage)
        tried = np.flatnonzero(fits[stage.possible > 0.0].any(axis=0))
        tried = tried if tried.size else np.zeros(1, dtype=np.intp)
        table = self.bearings.rows(tried)
        carried = self._carried(stage, b, table, fits[:, tried])
        each = np.minimum(carried, self._stress_reserve(stage, b, pins)[..., None])
        weights = self._weights(stage, b, pins, table)
        objective = self._objective(weights, stage, b, pins)
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
            bearing=tried[bearing].ravel(),
            pitch_radius=np.repeat(stage.pitch_radius, times),
            pin_circle=np.repeat(stage.pin_circle, times),
            outer_radius=np.repeat(stage.outer_radius, times),
            reserve=reserve,
            mass=of_chosen(weights.mass),
            gearbox_inertia=of_chosen(weights.gearbox_inertia),
            reflected_inertia=of_chosen(weights.reflected_inertia),
            objective=np.where(reserve > 0.0, of_chosen(objective), np.inf),
        )

    def _stress_reserve(self, stage: RingStages, b: FloatArray, pins: Pins) -> FloatArray:
        """Least reserve (M, T) of ring contact and output pins."""
        found = reserves.ring_reserves(
            self.frame, stage.pressure_number[:, None], stage.pitch_radius[:, None], b
        )
        per_radius = reserves.pin_reserves_per_radius(
            self.frame,
            pins.peak_factor[:, None],
            pins.count[:, None],
            pins.diameter[:, None],
            pins.running_radius[:, None],
            stage.hole_radius[:, None],
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
            least = np.minimum(least, value * stage.pin_circle[:, None])
        return least

    def _cage_ratings(self, pins: Pins, b: FloatArray) -> tuple[FloatArray, FloatArray]:
        """C0 and C (M, T) of the needle cages inside the sleeves."""
        static, dynamic = np.empty(b.shape), np.empty(b.shape)
        for row in np.unique(pins.size):
            same = pins.size == row
            static[same], dynamic[same] = self.frame.pin_sizes[row].cage_ratings(b[same])
        return static, dynamic

    def _fits(self, stage: RingStages) -> BoolArray:
        """Whether every cam bearing goes between eccentric and holes, (M, B)."""
        seat = stage.bearing_room - allowables.LIGAMENT + SLACK
        bore = least_bore(stage.eccentricity) - SLACK
        table = self.bearings
        return (0.5 * table.outer <= seat[:, None]) & (table.bore >= bore[:, None])

    def _carried(
        self, stage: RingStages, b: FloatArray, table: BearingTable, fits: BoolArray
    ) -> FloatArray:
        """Torque reserve (M, T, B) of some cam bearings; zero where one does not fit."""
        load = reserves.cam_load(
            self.frame, stage.pitch_radius, stage.eccentricity, stage.cam_number
        )
        carried = np.where(fits, table.allowed_load / load[:, None], 0.0)
        return np.where(table.width <= b[..., None] + SLACK, carried[:, None, :], 0.0)

    def _objective(
        self, weights: masses.Weights, stage: RingStages, b: FloatArray, pins: Pins
    ) -> FloatArray:
        """What the search makes small, (M, T, B)."""
        own = (slice(None), None, None)
        sizes = Sizes(
            eccentricity=stage.eccentricity[own],
            thickness=b[..., None],
            pin_count=pins.count[own],
            pin_circle=stage.pin_circle[own],
            hole_clearance=2.0 * (pins.play_radius - pins.running_radius)[own],
            outer_radius=stage.outer_radius[own],
            friction=stage.friction_number[own],
        )
        return np.broadcast_to(goal_value(self.frame, weights, sizes), weights.mass.shape)

    def _weights(
        self, stage: RingStages, b: FloatArray, pins: Pins, table: BearingTable
    ) -> masses.Weights:
        """Mass and inertia (M, T, B) with some cam bearings."""
        own = (slice(None), None, None)
        return masses.weigh(
            self.frame,
            profile_area=stage.profile_area[own],
            profile_polar=stage.profile_polar[own],
            ring_opening=stage.ring_opening[own],
            ring_outer=stage.outer_radius[own],
            eccentricity=stage.eccentricity[own],
            thickness=b[..., None],
            pin_count=pins.count[own],
            pin_diameter=pins.diameter[own],
            sleeve_diameter=pins.sleeve[own],
            hole_radius=stage.hole_radius[own],
            pin_circle=stage.pin_circle[own],
            bearing_outer=table.outer,
            bearing_bore=table.bore,
            bearing_mass=table.mass,
        )
