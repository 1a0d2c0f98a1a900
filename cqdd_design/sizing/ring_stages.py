"""Ring stages of candidates with their output holes: all that hangs on neither load nor thickness.

A search meets the same stages again and again, from other starts, for other materials and other
needs. What is worked out of one is kept and looked up.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from itertools import repeat
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import ligament_hole_to_hole
from cqdd_design.geometry.trochoid import shortening_coefficient
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.frame import THICKNESS_STEP, Frame
from cqdd_design.sizing.shape_limits import RADIUS_STEP
from cqdd_design.sizing.stage_tables import StageTables

IntArray = NDArray[np.intp]

_USUAL_RADIUS = 36e-3
"""Of a ring for which steps are chosen where a larger one is allowed, m."""
SLACK = 1e-9
_RING = np.array([1 << 42, 1 << 21, 1], dtype=np.int64)
"""Makes one whole number of the three steps of a ring."""
_KEY = np.array([1 << 46, 1 << 31, 1 << 16, 1 << 8, 1], dtype=np.int64)
"""Makes one of these steps, pin count and row of pin sizes."""
_OFFSET = 1 << 12
"""Added to steps, some of which lie below zero."""
_SPACES, _MOST_KEPT = 32, 200_000


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
class RingStages(shapes.RingSizes):
    """Stages (M,), lengths in m.

    Attributes
    ----------
    hole_radius, pin_circle, outer_radius : array
        Of the output holes, R_w, and the ring's outside.
    bearing_room : array
        Radius inside holes and valleys.
    pressure_number, friction_number, cam_number : array
        Of :class:`~cqdd_design.sizing.stage_tables.StageTables`.
    profile_area, profile_polar, ring_opening : array
        m^2, m^4 and m^2.
    possible : array
        1 where disc and ring can be made, else 0, and sizes mean nothing.
    """

    hole_radius: FloatArray
    pin_circle: FloatArray
    outer_radius: FloatArray
    bearing_room: FloatArray
    pressure_number: FloatArray
    friction_number: FloatArray
    cam_number: FloatArray
    profile_area: FloatArray
    profile_polar: FloatArray
    ring_opening: FloatArray
    possible: FloatArray


_FIELDS = tuple(one.name for one in fields(RingStages))


class StageWork(NamedTuple):
    """What stages are worked out of.

    Attributes
    ----------
    pin_sums : mapping
        :meth:`StageTables.pin_sums` by pin count.
    """

    frame: Frame
    tables: StageTables
    grid: Grid
    pin_sums: Mapping[int, FloatArray]

    def stages(self, steps: IntArray, pins: Pins) -> RingStages:
        """Stages of steps (M, 3) of eccentricity, tooth radius and wall spare; every time anew."""
        frame, tables = self.frame, self.tables
        possible = (steps[:, 0] > 0) & (steps[:, 1] > 0) & (steps[:, 2] >= 0)
        # Impossible points get harmless sizes, and a reserve of zero in the end.
        sound = np.where(possible[:, None], steps[:, :2], 1).astype(np.float64)
        e, r = sound[:, 0] * self.grid.throw, sound[:, 1] * self.grid.tooth
        room = np.floor(shapes.largest_pitch_for_wall(frame, e, r) / RADIUS_STEP + 1e-6)
        pitch = (room - steps[:, 2]) * RADIUS_STEP
        possible &= (r + e < pitch) & (e <= frame.throw_limit)
        R = np.where(possible, pitch, frame.outer_radius).astype(np.float64)
        ring = shapes.RingSizes(R, e, r)
        for met in shapes.profile_checks(frame, ring).values():
            possible &= met
        # Many pins stand in one ring: what only the ring decides is worked out once.
        sound_rings = np.flatnonzero(possible)
        _, first, place = np.unique(
            steps[sound_rings] @ _RING, return_index=True, return_inverse=True
        )
        passes = shapes.relief_passes_wire(frame, ring.rows(sound_rings[first]))
        possible[sound_rings] = passes[place]
        # Nor is there a shape of sizes beyond the limits: at K1 of 1 the flank has no normal.
        e = np.where(possible, e, self.grid.throw)
        r = np.where(possible, r, self.grid.tooth)
        R = np.where(possible, R, frame.outer_radius)
        ring = shapes.RingSizes(R, e, r)
        hole = pins.play_radius + e
        circle = shapes.largest_pin_circle(frame, ring, hole, pins.offset)
        circle = np.floor(circle / RADIUS_STEP) * RADIUS_STEP
        web = ligament_hole_to_hole(circle, pins.count, 2.0 * hole)
        possible &= (circle > hole) & (web >= allowables.LIGAMENT - SLACK)
        possible &= hole >= frame.wire_radius
        circle = np.where(possible, circle, frame.outer_radius)
        shortening = shortening_coefficient(frame.lobe_count, R, e)
        share = r / (R * tables.tooth_spacing)
        area, polar = shapes.profile_integrals(frame, ring)
        return RingStages(
            R,
            e,
            r,
            hole_radius=hole,
            pin_circle=circle,
            outer_radius=shapes.outer_radius(frame, ring),
            bearing_room=np.minimum(circle - hole, shapes.valley_distance(frame, ring)),
            pressure_number=tables.pressure_at(shortening, share),
            friction_number=tables.friction_at(shortening, share),
            cam_number=self._cam_number(shortening, R / circle, pins),
            profile_area=area,
            profile_polar=polar,
            ring_opening=shapes.ring_opening_area(frame, ring),
            possible=possible.astype(np.float64),
        )

    def _cam_number(
        self, shortening: FloatArray, radius_ratio: FloatArray, pins: Pins
    ) -> FloatArray:
        """Largest radial part of the cam load over T/R, (M,)."""
        radial = self.tables.radial_at(shortening)
        number = np.empty(radius_ratio.shape)
        for count in np.unique(pins.count):
            rows = np.flatnonzero(pins.count == count)
            number[rows] = self.tables.cam_radial_peak(
                radial[:, rows], self.pin_sums[int(count)], radius_ratio[rows]
            )
        return number

    def known(self) -> KnownStages:
        """What is kept of stages that hang on the same facts as these."""
        return _known(_Facts.of(self.frame))


class _Facts(NamedTuple):
    """All of a frame that stages hang on."""

    lobe_count: int
    disc_count: int
    clocking: float
    outer_radius: float
    least_outer_radius: float
    smaller_rings: bool
    equidistant: float
    radial: float
    relief_clearance: float
    wire_radius: float
    pin_circle_limit: float
    throw_limit: float
    pins: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, frame: Frame) -> _Facts:
        return cls(
            frame.lobe_count,
            frame.disc_count,
            frame.clocking,
            frame.outer_radius,
            frame.least_outer_radius,
            frame.smaller_rings,
            frame.equidistant,
            frame.radial,
            frame.relief_clearance,
            frame.wire_radius,
            frame.pin_circle_limit,
            frame.throw_limit,
            tuple((one.running_diameter, one.hole_clearance) for one in frame.pin_sizes),
        )


class KnownStages:
    """Stages that have been worked out, by their steps and pins; may be shared by threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._forget()

    def _forget(self) -> None:
        self._row: dict[int, int] = {}
        self._values = np.empty((0, len(_FIELDS)))

    def stages(self, work: StageWork, steps: IntArray, pins: Pins) -> RingStages:
        """As :meth:`StageWork.stages`; only what is not known is worked out."""
        keys = np.column_stack([steps + _OFFSET, pins.count, pins.size]) @ _KEY
        with self._lock:
            rows = self._rows_of(keys)
            missing = np.flatnonzero(rows < 0)
            if missing.size:
                if len(self._row) + missing.size > _MOST_KEPT:
                    self._forget()
                    missing = np.arange(keys.size)
                new, first = np.unique(keys[missing], return_index=True)
                which = missing[first]
                found = work.stages(steps[which], pins.rows(which))
                begin = len(self._row)
                self._row.update(zip(new.tolist(), range(begin, begin + new.size), strict=True))
                self._keep(np.column_stack([getattr(found, name) for name in _FIELDS]), begin)
                rows = self._rows_of(keys)
            values = self._values[rows].T
        return RingStages(*values)

    def _rows_of(self, keys: NDArray[np.int64]) -> IntArray:
        return np.fromiter(map(self._row.get, keys.tolist(), repeat(-1)), np.intp, keys.size)

    def _keep(self, values: FloatArray, begin: int) -> None:
        end = begin + len(values)
        if end > len(self._values):
            room = np.empty((max(2 * end, 1024), len(_FIELDS)))
            room[:begin] = self._values[:begin]
            self._values = room
        self._values[begin:end] = values


@lru_cache(maxsize=_SPACES)
def _known(facts: _Facts) -> KnownStages:
    return KnownStages()
