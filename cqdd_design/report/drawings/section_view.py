"""The dimensioned axial half section: ring, discs, cam bearings, eccentric, pins, carrier plates.

The plane of the section holds the axis and the crank of disc 1 at crank angle 0; one output pin is
turned into it, as drawings do. Plates and shaft end in break lines: their length is not a value of
the design. The axis lies at the bottom, z runs to the right.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.gearbox.output_pins import disc_positions, pin_span
from cqdd_design.geometry.contours import Circle, Contour
from cqdd_design.report.drawings.front_view import millimetres
from cqdd_design.report.drawings.outlines import Machine
from cqdd_design.report.ink.dimensions import (
    Leader,
    horizontal_dimension,
    leader_column,
    vertical_dimension,
)
from cqdd_design.report.ink.numbers import THIN, significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
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
_SAMPLING = 2e-6
_LONG_DESIGNATION = 10  # characters


def section_view(machine: Machine) -> Figure:
    """Half section along the crank at crank angle 0."""
    drawing = _Section(machine)
    reducer = machine.design.reducer
    body = "".join(
        [
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
    )
    plates = "both plates" if reducer.output_pins.support == "both" else "its plate"
    return Figure(
        "section-view",
        "Axial section",
        f"Half section along the axis: ring, {reducer.disc_count} discs on their eccentrics and "
        f"cam bearings, an output pin in {plates}, with dimensions.",
        _WIDTH,
        616.0,
        body,
        "Half section along the crank at crank angle 0, to scale, one output pin turned into the "
        "plane. Carrier plates and shaft are broken off: their length is not part of the design.",
    )


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

    def __init__(self, machine: Machine) -> None:
        reducer = machine.design.reducer
        self.machine, self.reducer = machine, reducer
        self.outer = 0.5 * reducer.ring.outer_diameter
        self.span = float(
            pin_span(reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing)
        )
        self.plate = max(0.3 * self.span, 2.0e-3)
        by_height = (_AXIS - _TOP) / self.outer
        by_width = (_RIGHT_EDGE - _LEFT_EDGE - 120.0) / (self.span + 2.4 * self.plate)
        self.scale = min(by_height, by_width)
        self.middles = [
            float(z) - 0.5 * self.span
            for z in disc_positions(
                reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing
            )
        ]

    def at(self, z: float, x: float) -> Point:
        """A place on the axis (z) and above it (x), m, as px."""
        return (_MIDDLE + self.scale * z, _AXIS - self.scale * x)

    def box(self, z: tuple[float, float], x: tuple[float, float], class_: str) -> str:
        left, top = self.at(z[0], max(x))
        return rectangle(
            left, top, self.scale * (z[1] - z[0]), self.scale * (max(x) - min(x)), class_
        )

    def throw(self, disc: int) -> tuple[float, float]:
        """Offset of a disc's axis in the plane and out of it, m."""
        angle, e = self.machine.phase(disc), self.reducer.eccentricity
        return e * math.cos(angle), e * math.sin(angle)

    def disc_extent(self, disc: int) -> tuple[float, float]:
        half = 0.5 * self.reducer.disc_thickness
        return self.middles[disc] - half, self.middles[disc] + half

    @property
    def pack(self) -> tuple[float, float]:
        half = 0.5 * self.reducer.pack_length
        return -half, half

    def ring(self) -> str:
        inner = reach_along_x(self.machine.ring.holes[0])
        pieces = [self._cut(self.pack, (inner, self.outer), "ring")]
        if self.machine.ring_pins:
            # Tooth 0 stands on +x: its pin lies in the plane of the section.
            tooth, radius = self.reducer.ring_pitch_radius, 0.5 * self.reducer.ring_pin_diameter
            pieces.append(self.box(self.pack, (tooth - radius, tooth + radius), "ring-pin"))
        return group(pieces)

    def _cut(self, z: tuple[float, float], x: tuple[float, float], kind: str) -> str:
        return self.box(z, x, f"cut-{kind}") + self.box(z, x, f"hatched hatch-{kind}")

    def discs(self) -> str:
        pieces = []
        circle_radius = self.reducer.output_pins.circle_radius
        for disc in range(self.reducer.disc_count):
            offset, out = self.throw(disc)
            tip = reach_along_x(self.machine.posed_disc(disc, 0.0).outer)
            bore = offset + _chord(0.5 * self.machine.bearing.outer_diameter, out)
            half = _chord(0.5 * self.machine.hole_diameter, out)
            hole = (circle_radius + offset - half, circle_radius + offset + half)
            extent = self.disc_extent(disc)
            pieces.append(self._cut(extent, (bore, hole[0]), "disc"))
            pieces.append(self._cut(extent, (hole[1], tip), "disc"))
            edges = [self.at(extent[0], hole[0]), self.at(extent[1], hole[0])]
            pieces.append(line(edges[0], edges[1], "outline"))
        return group(pieces)

    def plates(self) -> str:
        pins = self.reducer.output_pins
        half, thick = 0.5 * self.span, self.plate
        inner = 0.5 * self.machine.bearing.bore_diameter + 1.5e-3
        outer = pins.circle_radius + max(1.4 * pins.diameter, 3e-3)
        pieces = [self._cut((-half - thick, -half), (inner, outer), "plate")]
        pieces.append(self._break(-half - thick, inner, outer))
        if pins.support == "both":
            pieces.append(self._cut((half, half + thick), (inner, outer), "plate"))
            pieces.append(self._break(half + thick, inner, outer))
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
        radius = 0.5 * self.machine.bearing.bore_diameter
        core = max(radius - self.reducer.eccentricity, 0.2 * radius)
        end = 0.5 * self.span + 1.15 * self.plate
        pieces = [self.box((-end, end), (0.0, core), "shaft")]
        for disc in range(self.reducer.disc_count):
            offset, out = self.throw(disc)
            top = offset + _chord(radius, out)
            pieces.append(self.box(self.disc_extent(disc), (0.0, top), "shaft"))
        return group([*pieces, self._break(-end, 0.0, core), self._break(end, 0.0, core)])

    def bearings(self) -> str:
        bearing = self.machine.bearing
        inner, outer = 0.5 * bearing.bore_diameter, 0.5 * bearing.outer_diameter
        race = 0.24 * (outer - inner)
        pieces = []
        for disc in range(self.reducer.disc_count):
            offset, out = self.throw(disc)
            z = self.middles[disc]
            across = (z - 0.5 * bearing.width, z + 0.5 * bearing.width)
            low, high = offset + _chord(inner, out), offset + _chord(outer, out)
            pieces.append(self.box(across, (low, high), "bearing"))
            pieces.append(self.box(across, (low, low + race), "race-cut"))
            pieces.append(self.box(across, (high - race, high), "race-cut"))
            centre = self.at(z, 0.5 * (low + high))
            size = self.scale * (high - low - 2.0 * race)
            if bearing.kind == "ball":
                pieces.append(circle(centre, 0.62 * size, "roller"))
            else:
                length = 0.7 * self.scale * bearing.width
                pieces.append(
                    rectangle(
                        centre[0] - 0.5 * length, centre[1] - 0.5 * size, length, size, "roller"
                    )
                )
        return group(pieces)

    def pin(self) -> str:
        pins = self.reducer.output_pins
        radius, middle = 0.5 * pins.diameter, pins.circle_radius
        half = 0.5 * self.span
        into = 0.72 * self.plate
        right = half + into if pins.support == "both" else self.pack[1] + 0.5e-3
        pieces = []
        if pins.sleeve_diameter > 0.0:
            sleeve = 0.5 * pins.sleeve_diameter
            pieces.append(self.box((-half, half), (middle - sleeve, middle + sleeve), "sleeve"))
        pieces.append(self.box((-half - into, right), (middle - radius, middle + radius), "pin"))
        ends = (self.at(-half - into - 1.2e-3, middle), self.at(right + 1.2e-3, middle))
        pieces.append(line(ends[0], ends[1], "centre-line"))
        return group(pieces)

    def axis(self) -> str:
        end = 0.5 * self.span + 1.35 * self.plate
        pieces = [line(self.at(-end, 0.0), self.at(end, 0.0), "centre-line")]
        for disc in range(self.reducer.disc_count):
            offset, _ = self.throw(disc)
            if offset <= 0.0:
                continue
            z = self.disc_extent(disc)
            pieces.append(line(self.at(z[0], offset), self.at(z[1], offset), "centre-line"))
        return group(pieces)

    def dimensions(self) -> str:
        reducer = self.reducer
        circle_radius = reducer.output_pins.circle_radius
        first, last = self.disc_extent(0), self.disc_extent(reducer.disc_count - 1)
        pieces = [
            horizontal_dimension(
                self.at(self.pack[0], 0.0),
                self.at(self.pack[1], 0.0),
                _AXIS + 86.0,
                millimetres(reducer.pack_length),
                "ring and disc pack",
            ),
            horizontal_dimension(
                self.at(-0.5 * self.span, circle_radius),
                self.at(0.5 * self.span, circle_radius),
                self.at(0.0, self.outer)[1] - 34.0,
                f"L = {millimetres(self.span)}",
                "between the plates",
            ),
            horizontal_dimension(
                self.at(last[0], 0.0),
                self.at(last[1], 0.0),
                _AXIS + 34.0,
                f"b = {millimetres(reducer.disc_thickness)}",
                "disc thickness",
            ),
        ]
        if reducer.disc_count > 1:
            pieces.append(
                horizontal_dimension(
                    self.at(first[1], 0.0),
                    self.at(self.disc_extent(1)[0], 0.0),
                    _AXIS + 34.0,
                    f"s = {millimetres(reducer.disc_spacing)}",
                    "gap between discs",
                    side=-1,
                )
            )
        edge = -0.5 * self.span - self.plate
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
        reducer, bearing = self.reducer, self.machine.bearing
        pins = reducer.output_pins
        last = reducer.disc_count - 1
        offset, out = self.throw(last)
        edge = self.disc_extent(last)[1]
        tip = reach_along_x(self.machine.posed_disc(last, 0.0).outer)
        hole = pins.circle_radius + offset + _chord(0.5 * self.machine.hole_diameter, out)
        middle = 0.25 * (bearing.bore_diameter + bearing.outer_diameter)
        sizes = f"{THIN}\u00d7{THIN}".join(
            significant(1e3 * size)
            for size in (bearing.bore_diameter, bearing.outer_diameter, bearing.width)
        )
        runs_in = _short(pins.material)
        if pins.sleeve_diameter > 0.0:
            runs_in = f"in sleeves of {millimetres(pins.sleeve_diameter)}"
        long_name = len(bearing.designation) > _LONG_DESIGNATION
        right = [
            Leader(self.at(0.8 * self.pack[1], 0.97 * self.outer), "ring", reducer.ring_material),
            Leader(
                self.at(edge - 0.12 * reducer.disc_thickness, 0.5 * (hole + tip)),
                f"disc {last + 1}",
                reducer.disc_material,
            ),
            Leader(
                self.at(0.5 * self.span + 0.35 * self.plate, pins.circle_radius)
                if pins.support == "both"
                else self.at(self.pack[1], pins.circle_radius),
                f"output pin \u2300 {millimetres(pins.diameter)}",
                runs_in,
            ),
            Leader(
                self.at(self.middles[last] + 0.3 * bearing.width, offset + middle),
                bearing.designation if long_name else f"cam bearing {bearing.designation}",
                f"cam bearing, {sizes}{THIN}mm" if long_name else f"{sizes}{THIN}mm",
            ),
            Leader(
                self.at(0.5 * self.span + 0.6 * self.plate, 0.6 * self._core()),
                "eccentric shaft",
                f"throw Z_e = {millimetres(reducer.eccentricity)}",
            ),
        ]
        left = [
            Leader(
                self.at(
                    -0.5 * self.span - 0.5 * self.plate,
                    pins.circle_radius + max(1.1 * pins.diameter, 2.2e-3),
                ),
                "carrier plate",
                "holds the output pins",
            )
        ]
        top, bottom = self.at(0.0, self.outer)[1] + 6.0, _AXIS - 24.0
        return leader_column(right, _RIGHT_EDGE, "right", top, bottom) + leader_column(
            left, _LEFT_EDGE, "left", top, bottom
        )

    def _core(self) -> float:
        radius = 0.5 * self.machine.bearing.bore_diameter
        return max(radius - self.reducer.eccentricity, 0.2 * radius)


def _chord(radius: float, off_plane: float) -> float:
    """Half the chord of a circle whose centre lies off the plane of the section, m."""
    return math.sqrt(max(radius * radius - off_plane * off_plane, 0.0))


def reach_along_x(contour: Contour) -> float:
    """How far a closed contour around the axis reaches along +x, m."""
    if isinstance(contour, Circle):
        return float(contour.centre[0]) + _chord(contour.radius, float(contour.centre[1]))
    points = contour.sample(_SAMPLING)
    x, y = points[:, 0], points[:, 1]
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    crossing = (y <= 0.0) & (next_y > 0.0) & ((x > 0.0) | (next_x > 0.0))
    share = -y[crossing] / (next_y[crossing] - y[crossing])
    return float(np.max(x[crossing] + share * (next_x[crossing] - x[crossing])))


def _short(material: str) -> str:
    """A material's name without the remark in parentheses."""
    return material.partition(" (")[0]
