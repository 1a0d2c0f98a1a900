"""Figures of theory.md: the symbols of the profile, and the rigid law on one disc."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from cqdd_design.gearbox.disc_forces import DiscForces, disc_forces
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.report.ink.dimensions import Leader, leader_column
from cqdd_design.report.ink.numbers import decimals
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    View,
    Words,
    arrow_head,
    circle,
    line,
    polyline,
    text,
)

# Few lobes and a large eccentricity, so that every length can be seen.
_DISC = CycloidDisc(6, 40e-3, 3.4e-3, 7e-3)
_CRANK = math.radians(52.0)
_PINS, _PIN_CIRCLE, _PIN_RADIUS, _BORE = 6, 18e-3, 3e-3, 8e-3
_TORQUE = 20.0
_WIDTH, _HEIGHT = 900.0, 560.0
_VIEW = View(5000.0, (450.0, 280.0))
_RING_OUTSIDE = 50e-3


def profile() -> Figure:
    """Disc in its ring at one crank angle, with every symbol of the page's equations."""
    n, radius, e = _DISC.lobe_count, _DISC.ring_pitch_radius, _DISC.eccentricity
    teeth = [2.0 * math.pi * k / (n + 1) for k in range(n + 1)]
    centre, pitch = kinematics.disc_centre(e, _CRANK), kinematics.pitch_point(n, e, _CRANK)
    origin, at, instant = _VIEW.origin, _VIEW.point(centre), _VIEW.point(pitch)
    t = np.linspace(0.0, 2.0 * math.pi, 721)
    body = [*_ring(), _posed(_DISC.flank(t), "disc-body")]
    body.append(_posed(_DISC.locus(t), "construction"))
    body += [line(_VIEW.polar(radius, angle), instant, "normal") for angle in teeth]
    body.append(circle(origin, _VIEW.length(radius), "centre-line"))
    body += _angle(origin, 0.0, _CRANK, 46.0, "φ")
    turned = float(kinematics.lobe_pattern_rotation(n, _CRANK))
    body.append(line((at[0], at[1]), (at[0] + 122.0, at[1]), "extension"))
    ray = (at[0] + 122.0 * math.cos(turned), at[1] - 122.0 * math.sin(turned))
    body.append(line(at, ray, "angle"))
    body += _angle(at, 0.0, turned, 92.0, "\u2212φ/n", after=True)
    body.append(line(origin, (origin[0] + 70.0, origin[1]), "extension"))
    body.append(line(origin, instant, "outline"))
    body += [circle(place, 3.6, "axis-dot") for place in (origin, at, instant)]
    low = teeth[5]
    far = _VIEW.polar(radius, low)
    body.append(line(origin, far, "dimension"))
    body.append(arrow_head(far, (far[0] - origin[0], far[1] - origin[1])))
    name = _VIEW.polar(0.66 * radius, low)
    body.append(text((name[0] + 9.0, name[1] + 4.0), "R", "value"))
    tooth = _VIEW.polar(radius, teeth[2])
    rim = (tooth[0], tooth[1] - _VIEW.length(_DISC.tooth_radius))
    body += [line(tooth, rim, "dimension"), arrow_head(rim, (0.0, -1.0))]
    body.append(text((tooth[0] + 6.0, tooth[1] - 12.0), "r", "value"))
    contact = _contacts()
    locus = _place(_DISC.locus(np.array([math.radians(203.0)])))[0]
    body.append(
        leader_column(
            [
                Leader(locus, "locus", "path of a tooth's centre"),
                Leader(contact[3], "contact", "on the normal through P"),
                Leader(at, "C", "centre of the disc, turned by \u2212φ/n"),
            ],
            190.0,
            "left",
            90.0,
            480.0,
        )
    )
    half = (0.5 * (origin[0] + at[0]), 0.5 * (origin[1] + at[1]))
    body.append(
        leader_column(
            [
                Leader(instant, "P", "pitch point, (n + 1) e from O"),
                Leader(half, "e", "eccentricity, O to C"),
                Leader(origin, "O", "centre of the ring"),
            ],
            712.0,
            "right",
            110.0,
            460.0,
        )
    )
    words = Words(
        "theory-profile",
        "Symbols of the profile",
        f"A disc of {n} lobes in a ring of {n + 1} teeth at one crank angle: ring pitch radius R, "
        "eccentricity e, tooth radius r, crank angle phi, the locus of a tooth's centre, and the "
        "normals at all teeth, which meet in the pitch point.",
    )
    return words.figure(_WIDTH, _HEIGHT, body)


def forces() -> Figure:
    """The rigid law on the same disc: ring teeth, output pins and cam bearing in balance."""
    found = _loaded()
    stages = _stages()
    t = np.linspace(0.0, 2.0 * math.pi, 721)
    body = [*_ring(), _posed(_DISC.flank(t), "disc-body")]
    centre = kinematics.disc_centre(_DISC.eccentricity, _CRANK)
    angles = kinematics.output_pin_angles(_DISC.lobe_count, _PINS, 0.0, [_CRANK])[0]
    for angle in angles.tolist():
        pin = (_PIN_CIRCLE * math.cos(angle), _PIN_CIRCLE * math.sin(angle))
        hole = (pin[0] + float(centre[0]), pin[1] + float(centre[1]))
        body.append(circle(_VIEW.point(hole), _VIEW.length(stages.hole_radius), "bearing"))
        body.append(circle(_VIEW.point(pin), _VIEW.length(_PIN_RADIUS), "pin"))
    at = _VIEW.point(centre)
    body.append(circle(at, _VIEW.length(_BORE), "bearing"))
    instant = _VIEW.point(kinematics.pitch_point(_DISC.lobe_count, _DISC.eccentricity, _CRANK))
    load = float(np.hypot(*found.cam_force))
    scale = 120.0 / load
    for force, push, place in zip(
        found.ring_force.tolist(), found.ring_normal, found.ring_point, strict=True
    ):
        if force > 0.0:
            body.append(line(_VIEW.point(place), instant, "normal"))
            body += _arrow(_VIEW.point(place), push, force, scale, "force-ring")
    for force, place in zip(found.pin_force.tolist(), found.pin_point, strict=True):
        if force > 0.0:
            body += _arrow(_VIEW.point(place), found.pin_direction, force, scale, "force-pin")
    body += _arrow(at, found.cam_force / load, load, scale, "force-cam")
    body.append(circle(instant, 3.6, "axis-dot"))
    body.append(text((instant[0] + 8.0, instant[1] - 6.0), "P", "value"))
    for k, (class_, words) in enumerate(
        (
            ("force-ring", "ring teeth, through P"),
            ("force-pin", "output pins, along the crank"),
            ("force-cam", "cam bearing, what is left"),
        )
    ):
        y = 40.0 + 24.0 * k
        body.append(line((24.0, y), (54.0, y), f"force-line {class_}-line"))
        body.append(text((62.0, y + 4.0), words, "legend"))
    body.append(text((24.0, 116.0), f"forces in N at {_TORQUE:g} N·m", "legend"))
    told = Words(
        "theory-forces",
        "Forces on a disc by the rigid law",
        f"Forces on one disc under {_TORQUE:g} newton metres: ring teeth along normals that meet "
        "in the pitch point, output pins against the crank, and the cam bearing.",
    )
    return told.figure(_WIDTH, _HEIGHT, body)


@cache
def _stages() -> Stages:
    return Stages(
        lobe_count=_DISC.lobe_count,
        disc_count=1,
        pin_count=_PINS,
        ring_pitch_radius=_DISC.ring_pitch_radius,
        eccentricity=_DISC.eccentricity,
        tooth_radius=_DISC.tooth_radius,
        pin_circle_radius=_PIN_CIRCLE,
        hole_clocking=0.0,
        pin_contact_radius=_PIN_RADIUS,
        hole_radius=_PIN_RADIUS + _DISC.eccentricity,
        contact_length=8e-3,
        ring_modulus=112e9,
        pin_modulus=112e9,
    )


def _loaded() -> DiscForces:
    return disc_forces(_stages(), _TORQUE, _CRANK)


def _contacts() -> list[Point]:
    return [_VIEW.point(place) for place in _loaded().ring_point]


def _place(points: FloatArray) -> list[Point]:
    """Points of the disc, (N, 2) in m, in the figure at the pose."""
    turn, shift = kinematics.disc_pose(_DISC, _CRANK)
    posed = (points @ np.array([1.0, 1j])) * turn + shift
    return [_VIEW.point((one.real, one.imag)) for one in posed]


def _posed(points: FloatArray, class_: str) -> str:
    return polyline(_place(points[:-1]), class_, closed=True)


def _ring() -> list[str]:
    radius, n = _DISC.ring_pitch_radius, _DISC.lobe_count
    teeth = [_VIEW.polar(radius, 2.0 * math.pi * k / (n + 1)) for k in range(n + 1)]
    return [
        circle(_VIEW.origin, _VIEW.length(_RING_OUTSIDE), "outline"),
        *(circle(tooth, _VIEW.length(_DISC.tooth_radius), "ring") for tooth in teeth),
    ]


def _angle(
    at: Point, begin: float, end: float, radius: float, name: str, *, after: bool = False
) -> list[str]:
    """An arc with an arrow from one angle to another, named at its middle, or `after` its end."""
    turns = np.linspace(begin, end, 25).tolist()
    arc = [(at[0] + radius * math.cos(a), at[1] - radius * math.sin(a)) for a in turns]
    way = math.copysign(1.0, end - begin)
    head = (-way * math.sin(end), -way * math.cos(end))
    middle = end + 0.1 * way if after else 0.5 * (begin + end)
    place = (at[0] + (radius + 9.0) * math.cos(middle), at[1] - (radius + 9.0) * math.sin(middle))
    return [
        polyline(arc[:-1], "angle"),
        arrow_head(arc[-1], head, "arrow-angle"),
        text((place[0], place[1] + 4.0), name, "angle-name"),
    ]


def _arrow(tip: Point, direction: FloatArray, force: float, scale: float, class_: str) -> list[str]:
    """An arrow that ends where its force acts, with the force in newtons at its tail."""
    ux, uy = float(direction[0]), -float(direction[1])
    length = max(scale * force, 9.0)
    tail = (tip[0] - length * ux, tip[1] - length * uy)
    label = (tail[0] - 13.0 * ux, tail[1] - 13.0 * uy + 4.0)
    return [
        line(tail, (tip[0] - 6.0 * ux, tip[1] - 6.0 * uy), f"force-line {class_}-line"),
        arrow_head(tip, (ux, uy), f"force {class_}", 10.0),
        text(label, decimals(force, 0), "force-label", "middle"),
    ]
