"""The dimensioned axial half section: ring, discs, cam bearings, eccentric, pins, carrier plates.

The plane of the section holds the axis and the crank of disc 1 at crank angle 0; one output pin is
turned into it, as drawings do. Plates and shaft end in break lines: their length is not a value of
the design. The axis lies at the bottom, z runs to the right.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.gearbox.output_pins import disc_positions, pin_span
from cqdd_design.geometry.contours import Circle, Contour
from cqdd_design.geometry.runners import pin_runner, ring_runner
from cqdd_design.report.drawings.outlines import DRAWING_TOLERANCE, Outlines
from cqdd_design.report.ink.dimensions import (
    Leader,
    horizontal_dimension,
    leader_column,
    vertical_dimension,
)
from cqdd_design.report.ink.numbers import THIN, TIMES, millimetres, significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    Words,
    circle,
    element,
    fixed,
    group,
    line,
    polyline,
    rectangle,
)

_WIDTH = 900.0
_TOP, _AXIS = 84.0, 476.0
_MIDDLE = 440.0
_LEFT_EDGE, _RIGHT_EDGE = 178.0, 704.0
_LONG_DESIGNATION = 10  # characters

Extent = tuple[float, float]


def half_section(outlines: Outlines) -> Figure:
    """Half section along the crank at crank angle 0."""
    drawing = _Section(outlines)
    reducer = outlines.design.reducer
    body = [
        _patterns(),
        drawing.ring(),
        drawing.discs(),
        drawing.plates(),
        drawing.shaft(),
        drawing.bearings(),
        drawing.pin(),
        drawing.axis(),
        drawing.dimensions(),
        drawing.names(),
    ]
    plates = "both plates" if reducer.output_pins.support == "both" else "its plate"
    words = Words(
        "section-view",
        "Axial section",
        f"Half section along the axis: ring, {reducer.disc_count} discs on their eccentrics and "
        f"cam bearings, an output pin in {plates}, with dimensions.",
        "Half section along the crank at crank angle 0, to scale, one output pin turned into the "
        "plane. Carrier plates and shaft are broken off: their length is not part of the design.",
    )
    return words.figure(_WIDTH, 616.0, body)


def _patterns() -> str:
    def hatch(name: str, angle: float) -> str:
        return element(
            "pattern",
            line((0.0, 0.0), (0.0, 9.0), "hatch-line"),
            id=name,
            width=7.0,
            height=9.0,
            patternUnits="userSpaceOnUse",
            patternTransform=f"rotate({fixed(angle)})",
        )

    return element(
        "defs", hatch("hatch-ring", 45.0), hatch("hatch-disc", -45.0), hatch("hatch-plate", 30.0)
    )


class _Section:
    """Positions of one section; every method returns elements."""

    def __init__(self, outlines: Outlines) -> None:
        reducer = outlines.design.reducer
        pack = (reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing)
        self.outlines, self.reducer, self.bearing = outlines, reducer, outlines.bearing
        self.pins = reducer.output_pins
        runner = pin_runner(outlines.design)
        self.cage = None if runner is None else runner.cage
        self.rollers = ring_runner(outlines.design)
        self.both = self.pins.support == "both"
        self.outer = 0.5 * reducer.ring.outer_diameter
        self.half = 0.5 * float(pin_span(*pack))
        self.plate = max(0.6 * self.half, 2.0e-3)
        by_height = (_AXIS - _TOP) / self.outer
        by_width = (_RIGHT_EDGE - _LEFT_EDGE - 120.0) / (2.0 * self.half + 2.4 * self.plate)
        self.scale = min(by_height, by_width)
        self.middles = [float(z) - self.half for z in disc_positions(*pack)]
        self.throws = [outlines.disc_pose(k, 0.0)[1] for k in range(reducer.disc_count)]
        shaft = 0.5 * self.bearing.bore_diameter
        self.core = max(shaft - reducer.eccentricity, 0.2 * shaft)

    def at(self, z: float, x: float) -> Point:
        """A place on the axis (z) and above it (x), m, as px."""
        return (_MIDDLE + self.scale * z, _AXIS - self.scale * x)

    def box(self, z: Extent, x: Extent, class_: str) -> str:
        """A rectangle along the axis (z) and above it (x, whichever end is first), m."""
        low, high = sorted(x)
        size = (self.scale * (z[1] - z[0]), self.scale * (high - low))
        return rectangle(*self.at(z[0], high), *size, class_)

    def disc_extent(self, disc: int) -> Extent:
        """Where a disc begins and ends on the axis, m."""
        half = 0.5 * self.reducer.disc_thickness
        return self.middles[disc] - half, self.middles[disc] + half

    @property
    def pack(self) -> Extent:
        half = 0.5 * self.reducer.pack_length
        return -half, half

    def chord(self, disc: int, radius: float, middle: float = 0.0) -> Extent:
        """Where the plane cuts a circle about a point of a disc, `middle` above its axis, m."""
        offset, out = self.throws[disc]
        reach = _chord(radius, out)
        return middle + offset - reach, middle + offset + reach

    def hole(self, disc: int) -> Extent:
        return self.chord(disc, self.outlines.stages.hole_radius, self.pins.circle_radius)

    def tip(self, disc: int) -> float:
        return reach_along_x(self.outlines.posed_disc(disc, 0.0).outer)

    def ring(self) -> str:
        inner = reach_along_x(self.outlines.ring.holes[0])
        pieces = [self._cut(self.pack, (inner, self.outer), "ring")]
        if self.outlines.ring_pins:
            # Tooth 0 stands on +x: its pin lies in the plane of the section.
            pieces += self._ring_pin()
        return group(pieces)

    def _cut(self, z: Extent, x: Extent, kind: str) -> str:
        return self.box(z, x, f"cut-{kind}") + self.box(z, x, f"hatched hatch-{kind}")

    def discs(self) -> str:
        pieces = []
        for disc in range(self.reducer.disc_count):
            bore = self.chord(disc, 0.5 * self.bearing.outer_diameter)[1]
            hole, extent = self.hole(disc), self.disc_extent(disc)
            pieces.append(self._cut(extent, (bore, hole[0]), "disc"))
            pieces.append(self._cut(extent, (hole[1], self.tip(disc)), "disc"))
            edge = (self.at(extent[0], hole[0]), self.at(extent[1], hole[0]))
            pieces.append(line(*edge, "outline"))
        return group(pieces)

    def plates(self) -> str:
        inner = 0.5 * self.bearing.bore_diameter + 1.5e-3
        outer = self.pins.circle_radius + max(1.4 * self.pins.diameter, 3e-3)
        far, pieces = self.half + self.plate, []
        for ends in ((-far, -self.half), (self.half, far))[: 2 if self.both else 1]:
            pieces.append(self._cut(ends, (inner, outer), "plate"))
            pieces.append(self._break(max(ends, key=abs), inner, outer))
        return group(pieces)

    def _break(self, z: float, low: float, high: float) -> str:
        """A wavy line over a plate's far side, and white beyond it."""
        x, top = self.at(z, high)
        _, bottom = self.at(z, low)
        steps = np.linspace(0.0, 1.0, 25)
        wave = [
            (x + 2.6 * math.sin(6.0 * math.pi * float(s)), top + float(s) * (bottom - top))
            for s in steps
        ]
        away = 5.0 if z > 0.0 else -5.0
        blank = [*wave, (x + away, bottom + 1.0), (x + away, top - 1.0)]
        return polyline(blank, "blank", closed=True) + polyline(wave, "break-line")

    def shaft(self) -> str:
        """Eccentrics under the discs, the core between them, journals to both sides."""
        end = self.half + 1.15 * self.plate
        pieces = [self.box((-end, end), (0.0, self.core), "shaft")]
        for disc in range(self.reducer.disc_count):
            top = self.chord(disc, 0.5 * self.bearing.bore_diameter)[1]
            pieces.append(self.box(self.disc_extent(disc), (0.0, top), "shaft"))
        return group([*pieces, *(self._break(z, 0.0, self.core) for z in (-end, end))])

    def bearings(self) -> str:
        bearing = self.bearing
        inner, outer = 0.5 * bearing.bore_diameter, 0.5 * bearing.outer_diameter
        race = 0.24 * (outer - inner)
        pieces = []
        for disc, z in enumerate(self.middles):
            across = (z - 0.5 * bearing.width, z + 0.5 * bearing.width)
            low, high = self.chord(disc, inner)[1], self.chord(disc, outer)[1]
            pieces.append(self.box(across, (low, high), "bearing"))
            pieces.append(self.box(across, (low, low + race), "race-cut"))
            pieces.append(self.box(across, (high - race, high), "race-cut"))
            x, y = self.at(z, 0.5 * (low + high))
            size = self.scale * (high - low - 2.0 * race)
            if bearing.kind == "ball":
                pieces.append(circle((x, y), 0.62 * size, "roller"))
            else:
                long = 0.7 * self.scale * bearing.width
                pieces.append(rectangle(x - 0.5 * long, y - 0.5 * size, long, size, "roller"))
        return group(pieces)

    def _ring_pin(self) -> list[str]:
        """A pin of the ring, with the rollers on it and their needles where it has them."""
        middle, radius = self.reducer.ring_pitch_radius, 0.5 * self.reducer.ring_pin_diameter
        pin = self.box(self.pack, (middle - radius, middle + radius), "ring-pin")
        if self.rollers is None:
            return [pin]
        pieces, outside = [], 0.5 * self.rollers.diameter
        for disc, z in enumerate(self.middles):
            length = self.disc_extent(disc)
            pieces.append(self.box(length, (middle - outside, middle + outside), "sleeve"))
            pieces += self._needles(self.rollers.cage, z, middle)
        return [*pieces, pin]

    def _needles(self, cage: Bearing | None, z: float, middle: float) -> list[str]:
        """A needle cage about a pin at one disc, where there is one."""
        if cage is None:
            return []
        around = 0.5 * cage.outer_diameter
        across = (z - 0.5 * cage.width, z + 0.5 * cage.width)
        return [self.box(across, (middle - around, middle + around), "roller")]

    def pin(self) -> str:
        pins, half = self.pins, self.half
        radius, sleeve, middle = 0.5 * pins.diameter, 0.5 * pins.sleeve_diameter, pins.circle_radius
        into = 0.72 * self.plate
        right = half + into if self.both else self.pack[1] + 0.5e-3
        pieces = []
        if sleeve > 0.0:
            pieces.append(self.box((-half, half), (middle - sleeve, middle + sleeve), "sleeve"))
        for z in self.middles:
            pieces += self._needles(self.cage, z, middle)
        pieces.append(self.box((-half - into, right), (middle - radius, middle + radius), "pin"))
        ends = (self.at(-half - into - 1.2e-3, middle), self.at(right + 1.2e-3, middle))
        return group([*pieces, line(*ends, "centre-line")])

    def axis(self) -> str:
        end = self.half + 1.35 * self.plate
        pieces = [line(self.at(-end, 0.0), self.at(end, 0.0), "centre-line")]
        for disc, (offset, _) in enumerate(self.throws):
            if offset > 0.0:
                begin, stop = self.disc_extent(disc)
                ends = (self.at(begin, offset), self.at(stop, offset))
                pieces.append(line(*ends, "centre-line"))
        return group(pieces)

    def dimensions(self) -> str:
        reducer, half, circle_radius = self.reducer, self.half, self.pins.circle_radius
        pack, thick = millimetres(reducer.pack_length), millimetres(reducer.disc_thickness)
        above = self.at(0.0, self.outer)[1] - 34.0
        wanted = [
            (self.pack, 0.0, _AXIS + 86.0, pack, "ring and disc pack"),
            (
                (-half, half),
                circle_radius,
                above,
                f"L = {millimetres(2.0 * half)}",
                "between the plates",
            ),
            (
                self.disc_extent(reducer.disc_count - 1),
                0.0,
                _AXIS + 34.0,
                f"b = {thick}",
                "disc thickness",
            ),
        ]
        pieces = [
            horizontal_dimension(self.at(z[0], x), self.at(z[1], x), level, value, name)
            for z, x, level, value, name in wanted
        ]
        if reducer.disc_count > 1:
            gap = (self.at(self.disc_extent(0)[1], 0.0), self.at(self.disc_extent(1)[0], 0.0))
            value = f"s = {millimetres(reducer.disc_spacing)}"
            named = (value, "gap between discs")
            pieces.append(horizontal_dimension(*gap, _AXIS + 34.0, *named, side=-1))
        edge = -half - self.plate
        pieces.append(
            vertical_dimension(
                self.at(edge - 0.4e-3, circle_radius),
                self.at(edge - 0.4e-3, 0.0),
                self.at(edge, 0.0)[0] - 44.0,
                f"R_w = {millimetres(circle_radius)}",
                "circle of the output pins",
            )
        )
        return group(pieces)

    def names(self) -> str:
        reducer, bearing, pins = self.reducer, self.bearing, self.pins
        last = reducer.disc_count - 1
        middle = 0.25 * (bearing.bore_diameter + bearing.outer_diameter)
        sizes = f"{THIN}{TIMES}{THIN}".join(
            significant(1e3 * size)
            for size in (bearing.bore_diameter, bearing.outer_diameter, bearing.width)
        )
        runs_in = _short(pins.material)
        if pins.sleeve_diameter > 0.0:
            runs_in = f"in sleeves of {millimetres(pins.sleeve_diameter)}"
            runs_in += "" if pins.sleeve == "plain" else " on needles"
        cam = f"cam bearing {bearing.designation}", f"{sizes}{THIN}mm"
        if len(bearing.designation) > _LONG_DESIGNATION:
            cam = bearing.designation, f"cam bearing, {sizes}{THIN}mm"
        on = bearing.designation.partition(" on ")
        if on[1]:
            # A needle bearing with its inner ring has a name too long for a line.
            cam = on[0], f"on {on[2]}, cam bearing"
        in_disc = 0.5 * (self.hole(last)[1] + self.tip(last))
        right = [
            Leader(self.at(0.8 * self.pack[1], 0.97 * self.outer), "ring", reducer.ring_material),
            Leader(
                self.at(self.disc_extent(last)[1] - 0.12 * reducer.disc_thickness, in_disc),
                f"disc {last + 1}",
                reducer.disc_material,
            ),
            Leader(
                self.at(
                    self.half + 0.35 * self.plate if self.both else self.pack[1],
                    pins.circle_radius,
                ),
                f"output pin \u2300 {millimetres(pins.diameter)}",
                runs_in,
            ),
            Leader(
                self.at(self.middles[last] + 0.3 * bearing.width, self.throws[last][0] + middle),
                *cam,
            ),
            Leader(
                self.at(self.half + 0.6 * self.plate, 0.6 * self.core),
                "eccentric shaft",
                f"throw Z_e = {millimetres(reducer.eccentricity)}",
            ),
        ]
        on_plate = (
            -self.half - 0.5 * self.plate,
            pins.circle_radius + max(1.1 * pins.diameter, 2.2e-3),
        )
        left = [Leader(self.at(*on_plate), "carrier plate", "holds the output pins")]
        top, bottom = self.at(0.0, self.outer)[1] + 6.0, _AXIS - 24.0
        return leader_column(right, _RIGHT_EDGE, "right", top, bottom) + leader_column(
            left, _LEFT_EDGE, "left", top, bottom
        )


def _chord(radius: float, off_plane: float) -> float:
    """Half the chord of a circle whose centre lies off the plane of the section, m."""
    return math.sqrt(max(radius * radius - off_plane * off_plane, 0.0))


def reach_along_x(contour: Contour) -> float:
    """How far a closed contour around the axis reaches along +x, m."""
    if isinstance(contour, Circle):
        return float(contour.centre[0]) + _chord(contour.radius, float(contour.centre[1]))
    points = contour.sample(DRAWING_TOLERANCE)
    x, y = points[:, 0], points[:, 1]
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    crossing = (y <= 0.0) & (next_y > 0.0) & ((x > 0.0) | (next_x > 0.0))
    share = -y[crossing] / (next_y[crossing] - y[crossing])
    return float(np.max(x[crossing] + share * (next_x[crossing] - x[crossing])))


def _short(material: str) -> str:
    """A material's name without the remark in parentheses."""
    return material.partition(" (")[0]
