"""The dimensioned front view: ring, discs and output pins with the symbols of the paper."""

from __future__ import annotations

import math

from cqdd_design.report.drawings.outlines import Machine
from cqdd_design.report.ink.dimensions import Leader, horizontal_dimension, leader_column
from cqdd_design.report.ink.numbers import THIN, significant
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    View,
    circle,
    contour_path,
    element,
    line,
    part_path,
)

_WIDTH, _HEIGHT = 900.0, 640.0
_RADIUS = 226.0  # px of the ring's outside
_CENTRE: Point = (450.0, 300.0)
_LEFT_EDGE, _RIGHT_EDGE = 172.0, 728.0


def millimetres(metres: float, digits: int = 5) -> str:
    """A length as on a drawing: ``7 mm``."""
    return f"{significant(1e3 * metres, digits)}{THIN}mm"


def front_view(machine: Machine) -> Figure:
    """Front view at crank angle 0: the crank of disc 1 points along +x."""
    reducer = machine.design.reducer
    view = View(_RADIUS / (0.5 * reducer.ring.outer_diameter), _CENTRE)
    body = [element("path", d=part_path(machine.ring, view), class_="ring")]
    body += [
        element("path", d=contour_path(pin, view), class_="ring-pin") for pin in machine.ring_pins
    ]
    body.append(element("path", d=part_path(machine.posed_disc(0, 0.0), view), class_="disc-body"))
    for index in range(1, reducer.disc_count):
        hidden = machine.posed_disc(index, 0.0)
        body.append(element("path", d=part_path(hidden, view), class_="hidden"))
    body.append(_middle(machine, view))
    for angle in machine.pin_angles(0.0):
        place = view.polar(reducer.output_pins.circle_radius, angle)
        body.append(circle(place, view.length(0.5 * machine.pin_diameter), "pin"))
    body.append(_centre_lines(machine, view))
    body += [_below(machine, view), _above(machine, view)]
    body += [_left(machine, view), _right(machine, view)]
    hidden_words = {1: "", 2: " Disc 2, behind, is dashed."}.get(
        reducer.disc_count, " The discs behind are dashed."
    )
    return Figure(
        "front-view",
        "Front view",
        f"Ring with {reducer.ring_tooth_count} teeth around a disc with {reducer.ratio} lobes and "
        f"{reducer.output_pins.count} output pins, with dimensions.",
        _WIDTH,
        _HEIGHT,
        "".join(body),
        f"Front view at crank angle 0, to scale, from the contours that are cut.{hidden_words}",
    )


def _middle(machine: Machine, view: View) -> str:
    """Cam bearing and eccentric of the first disc."""
    centre = view.point((machine.design.reducer.eccentricity, 0.0))
    bearing = machine.bearing
    inner = 0.5 * bearing.bore_diameter
    races = 0.25 * (bearing.outer_diameter - bearing.bore_diameter) * 0.42
    return "".join(
        [
            circle(centre, view.length(0.5 * bearing.outer_diameter), "bearing"),
            circle(centre, view.length(0.5 * bearing.outer_diameter - races), "race"),
            circle(centre, view.length(inner + races), "race"),
            circle(centre, view.length(inner), "cam"),
        ]
    )


def _centre_lines(machine: Machine, view: View) -> str:
    reducer = machine.design.reducer
    reach = _RADIUS + 14.0
    x, y = view.origin
    off = view.length(reducer.eccentricity)
    return "".join(
        [
            circle(view.origin, view.length(reducer.ring_pitch_radius), "centre-line"),
            circle(view.origin, view.length(reducer.output_pins.circle_radius), "centre-line"),
            line((x - reach, y), (x + reach, y), "centre-line"),
            line((x, y - reach), (x, y + reach), "centre-line"),
            line((x + off, y - 30.0), (x + off, y + 30.0), "centre-line"),
        ]
    )


def _below(machine: Machine, view: View) -> str:
    reducer = machine.design.reducer
    y = view.origin[1]
    half = 0.5 * reducer.ring.outer_diameter
    return horizontal_dimension(
        view.origin,
        view.point((reducer.ring_pitch_radius, 0.0)),
        y + _RADIUS + 38.0,
        f"Z_r = {millimetres(reducer.ring_pitch_radius)}",
        "ring pitch radius",
    ) + horizontal_dimension(
        view.point((-half, 0.0)),
        view.point((half, 0.0)),
        y + _RADIUS + 84.0,
        f"\u2300 {millimetres(reducer.ring.outer_diameter)}",
        "ring outside diameter",
    )


def _above(machine: Machine, view: View) -> str:
    e = machine.design.reducer.eccentricity
    return horizontal_dimension(
        view.origin,
        view.point((e, 0.0)),
        view.origin[1] - _RADIUS - 34.0,
        f"Z_e = {millimetres(e)}",
        "eccentricity",
    )


def _nearest(angles: list[float], wanted: float) -> float:
    return min(angles, key=lambda a: abs(math.remainder(a - wanted, 2.0 * math.pi)))


def _left(machine: Machine, view: View) -> str:
    """Ring and profile, named on the left."""
    reducer, profile = machine.design.reducer, machine.profile
    radius = 0.5 * reducer.ring_pin_diameter
    teeth = [2.0 * math.pi * i / reducer.ring_tooth_count for i in range(reducer.ring_tooth_count)]
    tooth = _nearest(teeth, math.radians(140.0))
    # The tooth's flank, seen from the middle of the gearbox.
    flank_x = reducer.ring_pitch_radius * math.cos(tooth) - radius * math.cos(tooth - 0.5)
    flank_y = reducer.ring_pitch_radius * math.sin(tooth) - radius * math.sin(tooth - 0.5)
    lobes = [math.pi * (2 * k + 1) / reducer.ratio for k in range(reducer.ratio)]
    lobe = _nearest(lobes, math.radians(180.0))
    off = reducer.eccentricity
    tip = (
        off + profile.tip_distance * math.cos(lobe),
        profile.tip_distance * math.sin(lobe),
    )
    valleys = [2.0 * math.pi * k / reducer.ratio for k in range(reducer.ratio)]
    valley = _nearest(valleys, math.radians(222.0))
    low = (
        off + profile.valley_distance * math.cos(valley),
        profile.valley_distance * math.sin(valley),
    )
    leaders = [
        Leader(
            view.point((flank_x, flank_y)),
            f"Z_p = \u2300 {millimetres(reducer.ring_pin_diameter)}",
            f"ring teeth, {reducer.ring_tooth_count} of them",
        ),
        Leader(
            view.point(tip),
            f"\u2300 {millimetres(2.0 * profile.tip_distance)}",
            f"disc over its {reducer.ratio} lobes",
        ),
        Leader(
            view.point(low),
            f"\u2300 {millimetres(2.0 * profile.valley_distance)}",
            "disc in its valleys",
        ),
    ]
    return leader_column(leaders, _LEFT_EDGE, "left", 90.0, 520.0)


def _right(machine: Machine, view: View) -> str:
    """Output pins and bore, named on the right."""
    reducer, bearing = machine.design.reducer, machine.bearing
    pins = reducer.output_pins
    angles = machine.pin_angles(0.0)
    e = reducer.eccentricity

    def on_circle(radius: float, centre: float, toward: float) -> Point:
        return view.point(
            (
                pins.circle_radius * math.cos(centre) + radius * math.cos(toward),
                pins.circle_radius * math.sin(centre) + radius * math.sin(toward),
            )
        )

    first = _nearest(angles, math.radians(38.0))
    second = _nearest([a for a in angles if a != first], math.radians(-32.0))
    hole = (
        pins.circle_radius * math.cos(second) + e + 0.5 * machine.hole_diameter,
        pins.circle_radius * math.sin(second),
    )
    words = "sleeves" if pins.sleeve_diameter > 0.0 else "screws"
    shown = pins.sleeve_diameter if pins.sleeve_diameter > 0.0 else pins.diameter
    bore_at = math.radians(20.0)
    # Between two pins, where nothing else lies on the circle.
    half = math.pi / pins.count
    circle_at = _nearest([angle + half for angle in angles], math.radians(62.0))
    leaders = [
        Leader(
            view.polar(pins.circle_radius, circle_at),
            f"R {millimetres(pins.circle_radius)}",
            "circle of the output pins",
        ),
        Leader(
            on_circle(0.5 * machine.pin_diameter, first, 0.3),
            f"Z_o = \u2300 {millimetres(shown)}",
            f"output pins, {pins.count} {words}",
        ),
        Leader(
            view.point(
                (
                    e + 0.5 * bearing.outer_diameter * math.cos(bore_at),
                    0.5 * bearing.outer_diameter * math.sin(bore_at),
                )
            ),
            f"\u2300 {millimetres(bearing.outer_diameter)}",
            "bore for the cam bearing",
        ),
        Leader(
            view.point(hole),
            f"\u2300 {millimetres(machine.hole_diameter)}",
            "output holes",
        ),
    ]
    return leader_column(leaders, _RIGHT_EDGE, "right", 90.0, 520.0)
