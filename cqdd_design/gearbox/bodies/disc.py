"""A disc as an elastic body: its places, its loops, and its influence matrix."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.bodies.bore import OuterRing
from cqdd_design.gearbox.bodies.loops import Loop, circle, lobed
from cqdd_design.gearbox.bodies.point_load import Places, Plate
from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import first_hole_angle, hole_diameter

PER_LOBE = 16
PER_HOLE = 24
STATIONS = 48
"""Places on a lobe and on a hole's edge, and the fewest round the raceway."""
MOST_PLACES = 1500
"""Places of a disc up to which its matrix is computed: 80 MB of it, and 2 GB on the way."""


@dataclass(frozen=True)
class DiscShape:
    """Numbers that a disc's influence matrix depends on, SI.

    Attributes
    ----------
    outline : CycloidDisc
    hole_count : int
    hole_circle, hole_radius, first_hole : float
        m, m, rad.
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
        if PER_LOBE * lobes + PER_HOLE * holes > MOST_PLACES:
            raise GeometryError(
                f"a disc of {lobes} lobes and {holes} holes has more than the {MOST_PLACES} places "
                "up to which it is computed as an elastic body."
            )
        outline = CycloidDisc.from_design(design)
        return cls(
            outline,
            reducer.output_pins.count,
            reducer.output_pins.circle_radius,
            0.5 * hole_diameter(design),
            first_hole_angle(design, disc_index),
            OuterRing.of(find_bearing(reducer.cam_bearing.designation)),
            Plate(steel.youngs_modulus, steel.poisson_ratio, reducer.disc_thickness),
            outline.tip_distance / 20.0,
        )

    @property
    def holes(self) -> ComplexArray:
        """Centres of the holes, m."""
        turns = self.first_hole + 2.0 * np.pi * np.arange(self.hole_count) / self.hole_count
        return np.asarray(self.hole_circle * np.exp(1j * turns))

    def loops(self) -> tuple[Loop, ...]:
        """Outline, holes, and the bore with the bearing's ring in it; the last is the raceway."""
        # A vertex on every place: the half plane's field is sharp there, between vertices not.
        places, lobes = self.places(), PER_LOBE * self.outline.lobe_count
        outside = Loop(lobed(self.outline), 1, joints=self.lobe_places / (2.0 * np.pi))
        on_wall = (places.point[lobes:] - places.void[lobes:]).reshape(-1, PER_HOLE)
        turns = np.sort(np.mod(np.angle(on_wall) / (2.0 * np.pi), 1.0), axis=1)
        holes = tuple(
            Loop(circle(complex(c), self.hole_radius), -1, joints=u)
            for c, u in zip(self.holes, turns, strict=True)
        )
        ring = self.bearing
        # And on every station, where a tent's slope jumps.
        stations = self.stations / (2.0 * np.pi)
        if ring.raceway == ring.outer:
            return (outside, *holes, Loop(circle(0j, ring.outer), -1, joints=stations))
        factor = self.ring_factor
        seat = Loop(circle(0j, ring.outer), -1, 1.0 - factor, inner=True)
        raceway = Loop(circle(0j, ring.raceway), -1, factor, joints=stations)
        return (outside, *holes, seat, raceway)

    @property
    def ring_factor(self) -> float:
        """Stiffness of the bearing's ring over the disc's, by modulus and width."""
        ring = self.bearing
        return ring.modulus * ring.width / (self.plate.modulus * self.plate.thickness)

    @property
    def lobe_parameters(self) -> FloatArray:
        """Parameters (PER_LOBE,) of the first lobe's places, evenly by arc length, rad."""
        grid, length = lobe_length(self.outline)
        wanted = length[-1] * np.arange(PER_LOBE) / PER_LOBE
        return np.asarray(np.interp(wanted, length, grid))

    @property
    def lobe_places(self) -> FloatArray:
        """Parameters of the places on all lobes, rad."""
        lobes = self.outline.lobe_count
        first = 2.0 * np.pi * np.arange(lobes)[:, None] / lobes
        return np.asarray((first + self.lobe_parameters).ravel())

    def places(self) -> Places:
        """Lobes from the valley on +x, then holes from the direction of +x."""
        t = self.lobe_places
        point, normal = self.outline.profile(t)
        wall = np.exp(2j * np.pi * np.arange(PER_HOLE) / PER_HOLE)
        # Turned with its hole, so that a turn of the disc carries places into places.
        turned = (self.holes / np.abs(self.holes))[:, None] * wall
        centre = np.broadcast_to(self.holes[:, None], turned.shape)
        return Places(
            np.concatenate([point, (centre + self.hole_radius * turned).ravel()]),
            np.concatenate([-normal, turned.ravel()]),
            np.concatenate([np.full(len(t), np.nan + 0j), centre.ravel()]),
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

        Returns
        -------
        shape, turn, mirrored
            A point z of this disc is ``exp(1j * turn)`` times z, or times its conjugate, of that.
        """
        lobes, pitch = self.outline.lobe_count, 2.0 * np.pi / self.hole_count
        found = []
        for mirrored in (False, True):
            for lobe in range(lobes):
                turn = 2.0 * np.pi * lobe / lobes
                first = np.mod((-1 if mirrored else 1) * self.first_hole + turn, pitch)
                # Rounded, so that what differs by the last digit is one disc, and the last is none.
                rounded = round(float(first), 12)
                found.append((rounded % round(pitch, 12), mirrored, turn))
        first, mirrored, turn = min(found)
        return replace(self, first_hole=first), turn, mirrored

    def symmetries(self) -> list[tuple[NDArray[np.int64], FloatArray]]:
        """Where every load goes, and its sense there, when the disc is carried into itself."""
        lobes, pitch = self.outline.lobe_count, 2.0 * np.pi / self.hole_count
        found = []
        for mirrored in (False, True):
            first = (-1 if mirrored else 1) * self.first_hole
            for turn in 2.0 * np.pi * np.arange(lobes) / lobes:
                if (
                    abs(
                        np.remainder(first + turn - self.first_hole + 0.5 * pitch, pitch)
                        - 0.5 * pitch
                    )
                    < 1e-9
                ):
                    found.append(self.carried(self, float(turn), mirrored))
        return found

    def carried(
        self, other: DiscShape, turn: float, mirrored: bool
    ) -> tuple[NDArray[np.int64], FloatArray]:
        """Which load of another disc each load of this one is, and its sense.

        Parameters
        ----------
        other : DiscShape
            Whose places are ``exp(1j * turn)`` times those of this one, or of their mirror image.

        Returns
        -------
        array (L,), array (L,)
            Index, and 1 or -1: a mirror turns tangents round.
        """
        sense = np.array([1.0, -1.0 if mirrored else 1.0])
        found, first, senses = [], 0, []
        for own, its, each in (
            (self.places().point, other.places().point, 2),
            (np.exp(1j * self.stations), np.exp(1j * other.stations), 1),
        ):
            moved = np.exp(1j * turn) * (np.conj(own) if mirrored else own)
            apart = moved[:, None] - its
            near = (apart.real**2 + apart.imag**2).argmin(axis=1)
            found.append((first + each * near[:, None] + np.arange(each)).ravel())
            senses.append(np.tile(sense[:each], len(near)))
            first += each * len(near)
        return np.concatenate(found), np.concatenate(senses)


def lobe_length(outline: CycloidDisc) -> tuple[FloatArray, FloatArray]:
    """Parameters over one lobe and the arc length to each, rad and m."""
    grid = np.linspace(0.0, 2.0 * outline.half_pitch, 513)
    speed = outline.speed(0.5 * (grid[1:] + grid[:-1]))
    return grid, np.concatenate([[0.0], np.cumsum(speed * np.diff(grid))])
