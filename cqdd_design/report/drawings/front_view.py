"""The dimensioned front view: ring, discs and output pins with the symbols of the paper."""

from __future__ import annotations

import math

from cqdd_design.geometry.columns import column_hole_diameter
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.ink.dimensions import Leader, horizontal_dimension, leader_column
from cqdd_design.report.ink.numbers import millimetres
from cqdd_design.report.ink.svg import Figure, Point, View, Words, circle, line, part_shape

_WIDTH, _HEIGHT = 900.0, 640.0
_RADIUS = 226.0  # px of the ring's outside
_CENTRE: Point = (450.0, 300.0)
_LEFT_EDGE, _RIGHT_EDGE = 172.0, 728.0


def front_view(outlines: Outlines) -> Figure:
    """Front view at crank angle 0: the crank of disc 1 points along +x."""
    reducer = outlines.design.reducer
    view = View(_RADIUS / (0.5 * reducer.ring.outer_diameter), _CENTRE)
    body = outlines.ring_shapes(view)
    for index in range(reducer.disc_count):
        class_ = "hidden" if index else "disc-body"
        body.append(part_shape(outlines.posed_disc(index, 0.0), view, class_))
    body += _middle(outlines, view)
    body += outlines.pin_shapes(view, 0.0)
    body += _centre_lines(outlines, view)
    body += _dimensions(outlines, view)
    body += [
        leader_column(_named_left(outlines, view), _LEFT_EDGE, "left", 90.0, 520.0),
        leader_column(_named_right(outlines, view), _RIGHT_EDGE, "right", 90.0, 520.0),
    ]
    hidden_words = {1: "", 2: " Disc 2, behind, is dashed."}.get(
        reducer.disc_count, " The discs behind are dashed."
    )
    words = Words(
        "front-view",
        "Front view",
        f"Ring with {reducer.ring_tooth_count} teeth around a disc with {reducer.ratio} lobes and "
        f"{reducer.output_pins.count} output pins, with dimensions.",
        f"Front view at crank angle 0, to scale, from the contours that are cut.{hidden_words}",
    )
    return words.figure(_WIDTH, _HEIGHT, body)


def _middle(outlines: Outlines, view: View) -> list[str]:
    """Cam bearing and eccentric of the first disc."""
    centre = view.point(outlines.disc_pose(0, 0.0)[1])
    bearing = outlines.bearing
    outer, inner = 0.5 * bearing.outer_diameter, 0.5 * bearing.bore_diameter
    races = 0.5 * (outer - inner) * 0.42
    return [
        circle(centre, view.length(radius), class_)
        for radius, class_ in (
            (outer, "bearing"),
            (outer - races, "race"),
            (inner + races, "race"),
            (inner, "cam"),
        )
    ]


def _centre_lines(outlines: Outlines, view: View) -> list[str]:
    reducer = outlines.design.reducer
    reach = _RADIUS + 14.0
    x, y = view.origin
    off = view.length(reducer.eccentricity)
    radii = (reducer.ring_pitch_radius, reducer.output_pins.circle_radius)
    ends = (
        ((x - reach, y), (x + reach, y)),
        ((x, y - reach), (x, y + reach)),
        ((x + off, y - 30.0), (x + off, y + 30.0)),
    )
    return [
        *(circle(view.origin, view.length(radius), "centre-line") for radius in radii),
        *(line(*pair, "centre-line") for pair in ends),
    ]


def _dimensions(outlines: Outlines, view: View) -> list[str]:
    """Ring pitch radius and outside diameter below, eccentricity above."""
    reducer, y = outlines.design.reducer, view.origin[1]
    pitch, e, outside = (
        reducer.ring_pitch_radius,
        reducer.eccentricity,
        reducer.ring.outer_diameter,
    )
    return [
        horizontal_dimension(
            view.point((start, 0.0)), view.point((end, 0.0)), y + level, value, name
        )
        for start, end, level, value, name in (
            (0.0, pitch, _RADIUS + 38.0, f"Z_r = {millimetres(pitch)}", "ring pitch radius"),
            (
                -0.5 * outside,
                0.5 * outside,
                _RADIUS + 84.0,
                f"\u2300 {millimetres(outside)}",
                "ring outside diameter",
            ),
            (0.0, e, -_RADIUS - 34.0, f"Z_e = {millimetres(e)}", "eccentricity"),
        )
    ]


def _nearest(first: float, count: int, wanted: float) -> float:
    """Of `count` angles evenly round a turn, the one nearest to a wanted one (degrees), rad."""
    angles = [first + 2.0 * math.pi * k / count for k in range(count)]
    return _closest(angles, wanted)


def _closest(angles: list[float], wanted: float) -> float:
    aim = math.radians(wanted)
    return min(angles, key=lambda a: abs(math.remainder(a - aim, 2.0 * math.pi)))


def _named_left(outlines: Outlines, view: View) -> list[Leader]:
    """Columns, ring and profile."""
    reducer, profile = outlines.design.reducer, outlines.profile
    centre = outlines.disc_pose(0, 0.0)[1]
    pitch, radius = reducer.ring_pitch_radius, 0.5 * reducer.tooth_diameter
    tooth = _nearest(0.0, reducer.ring_tooth_count, 140.0)
    # The tooth's flank, seen from the middle of the gearbox.
    at_tooth = (pitch * math.cos(tooth), pitch * math.sin(tooth))
    lobe = _closest([math.pi * (2 * k + 1) / reducer.ratio for k in range(reducer.ratio)], 180.0)
    valley = _nearest(0.0, reducer.ratio, 222.0)
    return [
        *_named_columns(outlines, view),
        Leader(
            view.polar(-radius, tooth - 0.5, at_tooth),
            f"Z_p = \u2300 {millimetres(reducer.tooth_diameter)}",
            f"ring {'rollers' if reducer.ring.roller_diameter else 'teeth'}, "
            f"{reducer.ring_tooth_count} of them",
        ),
        Leader(
            view.polar(profile.tip_distance, lobe, centre),
            f"\u2300 {millimetres(2.0 * profile.tip_distance)}",
            f"disc over its {reducer.ratio} lobes",
        ),
        Leader(
            view.polar(profile.valley_distance, valley, centre),
            f"\u2300 {millimetres(2.0 * profile.valley_distance)}",
            "disc in its valleys",
        ),
    ]


def _named_columns(outlines: Outlines, view: View) -> list[Leader]:
    """The columns and their holes, where there are any."""
    angles, reducer = outlines.column_angles(0.0), outlines.design.reducer
    if not angles:
        return []
    radius, angle = reducer.output_pins.circle_radius, _closest(angles, 150.0)
    at = (radius * math.cos(angle), radius * math.sin(angle))
    return [
        Leader(
            view.polar(0.4 * reducer.carrier.column_diameter, 2.6, at),
            f"\u2300 {millimetres(reducer.carrier.column_diameter)}",
            f"{len(angles)} columns, holes {millimetres(column_hole_diameter(reducer))}",
        )
    ]


def _named_right(outlines: Outlines, view: View) -> list[Leader]:
    """Output pins and bore."""
    pins, stages = outlines.design.reducer.output_pins, outlines.stages
    centre = outlines.disc_pose(0, 0.0)[1]
    circle_radius, bore = pins.circle_radius, outlines.bearing.outer_diameter
    angles = outlines.pin_angles(0.0)
    first = _closest(angles, 38.0)
    second = _closest([a for a in angles if a != first], -32.0)
    at_first = (circle_radius * math.cos(first), circle_radius * math.sin(first))
    at_second = (
        circle_radius * math.cos(second) + centre[0],
        circle_radius * math.sin(second),
    )
    sleeved = pins.sleeve_diameter > 0.0
    shown = pins.sleeve_diameter if sleeved else pins.diameter
    # Between two pins, where nothing else lies on the circle.
    share = 0.5 if outlines.design.reducer.carrier.column_count else 1.0
    between = _closest([angle + share * math.pi / pins.count for angle in angles], 62.0)
    return [
        Leader(
            view.polar(circle_radius, between),
            f"R {millimetres(circle_radius)}",
            "circle of the output pins",
        ),
        Leader(
            view.polar(stages.pin_contact_radius, 0.3, at_first),
            f"Z_o = \u2300 {millimetres(shown)}",
            f"output pins, {pins.count} {'sleeves' if sleeved else 'screws'}",
        ),
        Leader(
            view.polar(0.5 * bore, math.radians(20.0), centre),
            f"\u2300 {millimetres(bore)}",
            "bore for the cam bearing",
        ),
        Leader(
            view.polar(stages.hole_radius, 0.0, at_second),
            f"\u2300 {millimetres(2.0 * stages.hole_radius)}",
            "output holes",
        ),
    ]
