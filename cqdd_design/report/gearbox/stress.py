"""Stress of discs and ring in the report: a disc with its stressed edges, and the greatest."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.ink.numbers import decimals, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import (
    Figure,
    View,
    Words,
    arrow_head,
    line,
    part_shape,
    polyline,
    rectangle,
    text,
)
from cqdd_design.results import Check

if TYPE_CHECKING:
    from cqdd_design.gearbox.bodies.strength import BodyStrength, EdgePicture

SHADES = 5
"""Classes of either sign, ``pull-1`` to ``pull-5`` and ``press-1`` to ``press-5``."""

_WIDTH, _HEIGHT, _ARROW = 560.0, 612.0, 62.0
_PARTS = (
    ("LIGAMENT", "round the holes of a disc"),
    ("ROOT", "along the lobes of a disc"),
    ("RING", "along the teeth of the ring"),
)


def stress_view(strength: BodyStrength, checks: Iterable[Check], outlines: Outlines) -> Values:
    """The picture, and rows of (where, greatest, allowed, reversed over a turn, allowed)."""
    by_id = {check.id: check for check in checks}
    rows = tuple(
        (
            where,
            *(shown for kind in ("STRESS", "FATIGUE") for shown in _told(by_id[f"{part}-{kind}"])),
        )
        for part, where in _PARTS
    )
    asked = outlines.design.requirements
    give, free, held = strength.give, strength.give_free, strength.give_round
    return {
        "figure": stress_picture(strength.picture, outlines),
        "rows": rows,
        "peak": with_unit(asked.peak_torque, "N*m"),
        "lasting": with_unit(asked.lasting_torque, "N*m"),
        "whose": ", the greatest torque of the duty," if asked.load_cases else "",
        "give": significant(1e9 * give.mean, 2),
        "give_range": " to ".join(significant(1e9 * one, 2) for one in (give.least, give.greatest)),
        "give_free": significant(1e9 * free.mean, 2),
        "give_round": significant(1e9 * held.mean, 2),
    }


def _told(check: Check) -> tuple[str, str]:
    """Value and limit; plastics have no fatigue limit."""
    value, limit = (
        "not known" if one is None else with_unit(one, "MPa", 3)
        for one in (check.value, check.limit)
    )
    return value, limit


def stress_picture(picture: EdgePicture, outlines: Outlines) -> Figure:
    """A disc in the ring with the stress along its edges, and the forces that make it."""
    turn, (x, y) = outlines.disc_pose(picture.disc, picture.crank_angle)
    view = View(
        212.0 / (0.5 * outlines.design.reducer.ring.outer_diameter), (0.5 * _WIDTH, 0.5 * _WIDTH)
    )
    greatest = max(float(np.nanmax(np.abs(stress), initial=0.0)) for _, stress in picture.edges)
    body = [
        *outlines.ring_shapes(view),
        part_shape(outlines.posed_disc(picture.disc, picture.crank_angle), view, "disc-body"),
        *outlines.pin_shapes(view, picture.crank_angle),
    ]
    for places, stress in picture.edges:
        body += _band(np.exp(1j * turn) * places + complex(x, y), stress, greatest, view)
    most = float(np.hypot(*picture.loads.T).max())
    for point, load in zip(picture.points, picture.loads, strict=True):
        size = float(np.hypot(*load))
        if size > 0.0:
            body += _arrow(view.point(point), load / size, _ARROW * size / most)
    body += _scale(greatest / 1e6)
    degrees = math.degrees(picture.crank_angle)
    shown = significant(greatest / 1e6, 3)
    words = Words(
        "disc-stress",
        "Stress along the edges of a disc",
        f"Stress along the edges of disc {picture.disc + 1} at crank angle {degrees:.0f} degrees, "
        f"at most {shown} MPa.",
        f"Disc {picture.disc + 1} at crank angle {decimals(degrees, 0)}\u00b0 and "
        f"{with_unit(picture.torque, 'N*m')}, where its stress is greatest ({shown}\u202fMPa): "
        "tension red, compression blue. Arrows are the forces of teeth, pins and cam. Next to a "
        "loaded contact the edge is left bare: there the contact\u2019s pressure counts.",
    )
    return words.figure(_WIDTH, _HEIGHT, body)


def _band(places: ComplexArray, stress: FloatArray, most: float, view: View) -> list[str]:
    """A closed edge in its colours; neighbours of one colour are one line."""
    ring = np.append(places, places[0])
    values = 0.5 * (stress + np.roll(stress, -1))
    grades = [_grade(float(value), most) for value in values]
    parts = []
    for name, run in itertools.groupby(range(len(grades)), key=lambda k: grades[k]):
        if name:
            steps = list(run)
            chain = ring[steps[0] : steps[-1] + 2]
            points = [view.point((z.real, z.imag)) for z in chain.tolist()]
            parts.append(polyline(points, f"stressed {name}"))
    return parts


def _grade(value: float, most: float) -> str:
    """Class of a stress; none where it is not known.

    Examples
    --------
    >>> _grade(10.0, 10.0), _grade(-3.0, 10.0), _grade(float("nan"), 10.0)
    ('pull-5', 'press-2', '')
    """
    if math.isnan(value) or most <= 0.0:
        return ""
    step = min(1 + int(SHADES * abs(value) / most), SHADES)
    return f"{'pull' if value > 0.0 else 'press'}-{step}"


def _arrow(tip: tuple[float, float], direction: FloatArray, length: float) -> list[str]:
    ux, uy = float(direction[0]), -float(direction[1])
    long = max(length, 9.0)
    tail = (tip[0] - long * ux, tip[1] - long * uy)
    shaft = (tip[0] - 6.0 * ux, tip[1] - 6.0 * uy)
    return [
        line(tail, shaft, "force-line stress-line"),
        arrow_head(tip, (ux, uy), "force stress-head", 9.0),
    ]


def _scale(most: float) -> list[str]:
    """The colours from the greatest compression to the greatest tension, MPa."""
    size, y = 34.0, _WIDTH + 8.0
    begin = 0.5 * _WIDTH - size * SHADES
    names = [f"press-{k}" for k in range(SHADES, 0, -1)] + [
        f"pull-{k}" for k in range(1, SHADES + 1)
    ]
    parts = [
        rectangle(begin + size * k, y, size, 12.0, f"scale-{name}") for k, name in enumerate(names)
    ]
    for share in (-1.0, -0.6, -0.2, 0.2, 0.6, 1.0):
        at = 0.5 * _WIDTH + share * size * SHADES
        parts.append(line((at, y + 12.0), (at, y + 16.0), "axis"))
        parts.append(text((at, y + 29.0), significant(share * most, 3), "tick", "middle"))
    parts.append(text((begin + 2.0 * size * SHADES + 12.0, y + 11.0), "MPa", "tick"))
    return parts
