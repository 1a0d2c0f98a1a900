"""A disc as an elastic body: its places, its loops, and its influence matrix."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.bodies.bore import OuterRing
from cqdd_design.gearbox.bodies.loops import Loop, circle, lobed
from cqdd_design.gearbox.bodies.point_load import Places, Plate
from cqdd_design.geometry.columns import column_hole_diameter, column_offsets
from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import first_hole_angle, hole_diameter

STATIONS = 48
"""Fewest round the raceway."""
MOST_PLACES = 1500
"""Places at the finest grid up to which a disc's matrix is computed."""


class Grid(NamedTuple):
    """How finely a disc's edges are divided.

    Attributes
    ----------
    per_lobe, per_hole : int
        Places on a lobe and on a hole's edge.
    """

    per_lobe: int
    per_hole: int


GRIDS = (Grid(16, 24), Grid(12, 16))
"""From fine to coarse. A disc has the first within the limit below, or the last: time grows with
the third power of the places solved. Beside a grid of 24 and 36, the compliance of a disc of 29
lobes at a tooth is within 2.2 % and 3.8 %, on the mean over the flank 0.5 % and 0.8 %, and at an
output pin within 1.4 % and 6.2 %."""
_MOST_SOLVED = 650
"""Places, of those that turns of the disc carry into each other one."""


class Carried(NamedTuple):
    """Where loads and places of a disc come to stand on another, or on itself.

    Attributes
    ----------
    load : array (L,)
        Which load of the other each load is.
    sense : array (L,)
        1 or -1: a mirror turns tangents round.
    place : array (S,)
        Which place where stress is read each of them is.
    """

    load: NDArray[np.int64]
    sense: FloatArray
    place: NDArray[np.int64]


@dataclass(frozen=True)
class DiscShape:
    """Numbers that a disc's influence matrix depends on, SI.

    Attributes
    ----------
    outline : CycloidDisc
    hole_count : int
    hole_circle, hole_radius, first_hole : float
        m, m, rad.
    column_count : int
        Of the holes that columns pass through, on the holes' circle; nothing pushes on them.
    column_radius, first_column : float
        m, rad; 0 without columns.
    bearing : OuterRing
    plate : Plate
    side : float
        Longest side of a triangle, m.
    """

    outline: CycloidDisc
    hole_count: int
    hole_circle: float
    hole_radius: float
    first_hole: float
    column_count: int
    column_radius: float
    first_column: float
    bearing: OuterRing
    plate: Plate
    side: float

    @classmethod
    def from_design(cls, design: Design, disc_index: int) -> DiscShape:
        """Disc `disc_index` of a design that names its cam bearing.

        Raises
        ------
        GeometryError
            Where it has too many lobes and holes to be computed.
        """
        reducer = design.reducer
        steel = find_material(reducer.disc_material)
        lobes, holes = reducer.ratio, reducer.output_pins.count
        offsets = column_offsets(reducer)
        columns, first = len(offsets), first_hole_angle(design, disc_index)
        if GRIDS[0].per_lobe * lobes + GRIDS[0].per_hole * (holes + columns) > MOST_PLACES:
            beside = f", {columns} of them for columns," if columns else ""
            raise GeometryError(
                f"a disc of {lobes} lobes and {holes + columns} holes{beside} has more than the "
                f"{MOST_PLACES} places up to which it is computed as an elastic body."
            )
        outline = CycloidDisc.from_design(design)
        return cls(
            outline,
            reducer.output_pins.count,
            reducer.output_pins.circle_radius,
            0.5 * hole_diameter(design),
            first,
            columns,
            0.5 * column_hole_diameter(reducer),
            first + float(offsets[0]) if columns else 0.0,
            OuterRing.of(find_bearing(reducer.cam_bearing.designation)),
            Plate(steel.youngs_modulus, steel.poisson_ratio, reducer.disc_thickness),
            outline.tip_distance / 20.0,
        )

    @property
    def grid(self) -> Grid:
        """How finely it is divided."""
        lobes, holes = self.outline.lobe_count, self.hole_count
        for grid in GRIDS:
            places = grid.per_lobe * lobes + grid.per_hole * holes
            if places <= _MOST_SOLVED * self.turns:
                return grid
        return GRIDS[-1]

    @property
    def holes(self) -> ComplexArray:
        """Centres of the output pins' holes, m."""
        return self._evenly(self.first_hole, self.hole_count)

    @property
    def columns(self) -> ComplexArray:
        """Centres of the columns' holes, m."""
        return self._evenly(self.first_column, self.column_count)

    def _evenly(self, first: float, count: int) -> ComplexArray:
        turns = first + 2.0 * np.pi * np.arange(count) / max(count, 1)
        return np.asarray(self.hole_circle * np.exp(1j * turns))

    def loops(self) -> tuple[Loop, ...]:
        """Outline, holes, columns' holes, and the bore with the bearing's ring in it.

        The last is the raceway.
        """
        # A vertex on every place: the half plane's field is sharp there, between vertices not.
        grid, places = self.grid, self.places()
        lobes = grid.per_lobe * self.outline.lobe_count
        outside = Loop(lobed(self.outline), 1, joints=self.lobe_places / (2.0 * np.pi))
        on_wall = (places.point[lobes:] - places.void[lobes:]).reshape(-1, grid.per_hole)
        turns = np.sort(np.mod(np.angle(on_wall) / (2.0 * np.pi), 1.0), axis=1)
        holes = tuple(
            Loop(circle(complex(c), self.hole_radius), -1, joints=u)
            for c, u in zip(self.holes, turns, strict=True)
        )
        # Twice as many beside a column, where no half plane's field carries what is sharp.
        even = np.arange(2 * grid.per_hole) / (2 * grid.per_hole)
        columns = tuple(
            Loop(
                circle(complex(c), self.column_radius),
                -1,
                joints=np.sort(np.mod(np.angle(c) / (2.0 * np.pi) + even, 1.0)),
                loaded=False,
            )
            for c in self.columns
        )
        ring = self.bearing
        # And on every station, where a tent's slope jumps.
        stations = self.stations / (2.0 * np.pi)
        bare = ring.raceway == ring.outer
        factor = 1.0 if bare else self.ring_factor
        raceway = Loop(circle(0j, ring.raceway), -1, factor, joints=stations, loaded=False)
        if bare:
            return (outside, *holes, *columns, raceway)
        seat = Loop(circle(0j, ring.outer), -1, 1.0 - factor, inner=True, loaded=False)
        return (outside, *holes, *columns, seat, raceway)

    @property
    def ring_factor(self) -> float:
        """Stiffness of the bearing's ring over the disc's, by modulus and width."""
        ring = self.bearing
        return ring.modulus * ring.width / (self.plate.modulus * self.plate.thickness)

    @property
    def lobe_parameters(self) -> FloatArray:
        """Parameters of the first lobe's places, evenly by arc length, rad."""
        along, length = lobe_length(self.outline)
        count = self.grid.per_lobe
        wanted = length[-1] * np.arange(count) / count
        return np.asarray(np.interp(wanted, length, along))

    @property
    def lobe_places(self) -> FloatArray:
        """Parameters of the places on all lobes, rad."""
        lobes = self.outline.lobe_count
        first = 2.0 * np.pi * np.arange(lobes)[:, None] / lobes
        return np.asarray((first + self.lobe_parameters).ravel())

    def places(self) -> Places:
        """Places of loads: lobes from the valley on +x, then holes from the direction outward."""
        t = self.lobe_places
        point, normal = self.outline.profile(t)
        walls = _walls(self.holes, self.hole_radius, self.grid.per_hole)
        return Places(
            np.concatenate([point, walls.point]),
            np.concatenate([-normal, walls.inward]),
            np.concatenate([np.full(len(t), np.nan + 0j), walls.void]),
        )

    def seen(self) -> Places:
        """Places where stress is read: those of loads, then round the columns' holes."""
        loaded = self.places()
        more = _walls(self.columns, self.column_radius, self.grid.per_hole)
        return Places(
            np.concatenate([loaded.point, more.point]),
            np.concatenate([loaded.inward, more.inward]),
            np.concatenate([loaded.void, more.void]),
        )

    @property
    def stations(self) -> FloatArray:
        """Angles of the stations round the raceway, a whole number for each lobe, rad."""
        lobes = self.outline.lobe_count
        count = lobes * math.ceil(STATIONS / lobes)
        return 2.0 * np.pi * np.arange(count) / count

    def tents(self, point: ComplexArray) -> ComplexArray:
        """Outward tractions (Q, B) of unit loads on stations, N/m; `point` on the raceway."""
        width = 2.0 * np.pi / len(self.stations)
        away = np.angle(point[:, None] * np.exp(-1j * self.stations))
        tent = np.clip(1.0 - np.abs(away) / width, 0.0, None) / (width * self.bearing.raceway)
        return np.asarray(tent * (point / np.abs(point))[:, None])

    def standard(self) -> tuple[DiscShape, float, bool]:
        """The disc of its kind with the least angle to its first hole, and how it comes from this.

        With columns the least to its first column's too.

        Returns
        -------
        shape, turn, mirrored
            A point z of this disc is ``exp(1j * turn)`` times z, or times its conjugate, of that.
        """
        lobes = self.outline.lobe_count
        found = []
        for mirrored in (False, True):
            for lobe in range(lobes):
                turn = 2.0 * np.pi * lobe / lobes
                hole, column = (_first(first, count, turn, mirrored) for first, count in self._rows)
                found.append((hole, column, mirrored, turn))
        hole, column, mirrored, turn = min(found)
        return replace(self, first_hole=hole, first_column=column), turn, mirrored

    @property
    def _rows(self) -> tuple[tuple[float, int], ...]:
        """Angle of the first and number, of output pins' holes and of columns'."""
        return (self.first_hole, self.hole_count), (self.first_column, self.column_count)

    @property
    def turns(self) -> int:
        """How often a full turn carries the disc into itself."""
        return math.gcd(self.outline.lobe_count, self.hole_count, self.column_count)

    def symmetries(self) -> list[Carried]:
        """Where loads and places go by each of these turns."""
        return [
            self.carried(self, float(turn), mirrored=False)
            for turn in 2.0 * np.pi * np.arange(self.turns) / self.turns
        ]

    def carried(self, other: DiscShape, turn: float, mirrored: bool) -> Carried:
        """Which load and place of another disc each one of this is.

        Parameters
        ----------
        other : DiscShape
            Whose places are ``exp(1j * turn)`` times those of this one, or of their mirror image.
        """
        place, station = (
            _nearest(np.exp(1j * turn) * (np.conj(own) if mirrored else own), its)
            for own, its in (
                (self.seen().point, other.seen().point),
                (np.exp(1j * self.stations), np.exp(1j * other.stations)),
            )
        )
        loaded = place[: len(self.places())]
        point = (2 * loaded[:, None] + np.arange(2)).ravel()
        sense = np.tile([1.0, -1.0 if mirrored else 1.0], len(loaded))
        return Carried(
            np.concatenate([point, len(point) + station]),
            np.concatenate([sense, np.ones(len(station))]),
            place,
        )


def _walls(centres: ComplexArray, radius: float, count: int) -> Places:
    """Places round holes, `count` of each from the direction away from the disc's middle."""
    wall = np.exp(2j * np.pi * np.arange(count) / count)
    # Turned with its hole, so that a turn of the disc carries places into places.
    turned = (centres / np.abs(centres))[:, None] * wall
    centre = np.broadcast_to(centres[:, None], turned.shape)
    return Places((centre + radius * turned).ravel(), turned.ravel(), centre.ravel())


def _nearest(own: ComplexArray, its: ComplexArray) -> NDArray[np.int64]:
    """Which of other points each point is."""
    apart = own[:, None] - its
    return np.asarray((apart.real**2 + apart.imag**2).argmin(axis=1))


def _first(first: float, count: int, turn: float, mirrored: bool) -> float:
    """Angle of the first of `count` holes evenly round after a turn; 0 where there are none."""
    if count == 0:
        return 0.0
    pitch = 2.0 * np.pi / count
    # Rounded, so that what differs by the last digit is one disc, and the last is none.
    rounded = round(float(np.mod((-1 if mirrored else 1) * first + turn, pitch)), 12)
    return rounded % round(pitch, 12)


def lobe_length(outline: CycloidDisc) -> tuple[FloatArray, FloatArray]:
    """Parameters over one lobe and the arc length to each, rad and m."""
    grid = np.linspace(0.0, 2.0 * outline.half_pitch, 513)
    speed = outline.speed(0.5 * (grid[1:] + grid[:-1]))
    return grid, np.concatenate([[0.0], np.cumsum(speed * np.diff(grid))])
