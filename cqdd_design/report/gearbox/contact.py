"""The contact equilibrium in the report: heat maps of load, the worst angle, the rigid law."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.ink.axes import Axis
from cqdd_design.report.ink.heat import heat_map
from cqdd_design.report.ink.numbers import decimals, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    View,
    Words,
    arrow_head,
    line,
    part_shape,
    text,
)
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.solved import ContactSweep
    from cqdd_design.machine.contact_analysis import ContactAnalysis

_ROUNDING = 1e-12
"""Lengths below are what rounding leaves, m."""
_TURN = Axis(0.0, 360.0, (0.0, 90.0, 180.0, 270.0, 360.0), "crank angle, \u00b0")


def contact_view(analysis: ContactAnalysis, outlines: Outlines, law: RigidMaxima) -> Values:
    """Heat maps of each disc, the worst angle, and rows of (name, rigid law, contact).

    `law` holds the greatest values of the rigid law at its torque.
    """
    turn = analysis.crank_turn
    return {
        "heat_maps": tuple(_heat_map(turn, disc) for disc in range(turn.model.disc_count)),
        "worst": force_picture(turn, outlines),
        "rows": _rows(analysis, law),
        "torque": with_unit(analysis.sweep.torque, "N*m"),
        "friction": _friction(analysis.sweep),
        "preload": _preload(analysis),
        "bending": _bending(analysis),
    }


def _friction(sweep: ContactSweep) -> str:
    """The friction of a sweep, as a sentence goes on."""
    if sweep.friction is None:
        return ", without friction"
    driver = "motor" if sweep.friction.sense == "drive" else "output"
    tooth, pin = (f"{one:.3g}" for one in sweep.mean_friction)
    each = (
        f"a friction of {tooth}"
        if tooth == pin
        else f"friction of {tooth} at teeth and {pin} at holes"
    )
    return f", the {driver} driving against {each}"


def _heat_map(turn: ContactSweep, disc: int) -> Figure:
    force = turn.ring_force[:, disc, :].T
    most = int(turn.teeth_in_contact[:, disc].max())
    greatest = decimals(float(force.max()), 0)
    words = Words(
        f"tooth-load-{disc + 1}",
        f"Load of every ring tooth, disc {disc + 1}",
        f"Force of each ring tooth on disc {disc + 1} over one crank turn; at most {greatest} N, "
        f"on up to {most} teeth together.",
        f"Greatest {greatest} N; up to {most} teeth carry together.",
    )
    names = [str(k + 1) for k in range(len(force))]
    return heat_map(words, force, names, "ring tooth", _TURN, "N")


def force_picture(turn: ContactSweep, outlines: Outlines) -> Figure:
    """Contact forces on the disc and at the angle of the greatest ring force, true to direction."""
    at, disc, tooth = map(int, np.unravel_index(turn.ring_force.argmax(), turn.ring_force.shape))
    angle = float(turn.crank_angle[at])
    width, centre = 560.0, 280.0
    view = View(212.0 / (0.5 * outlines.design.reducer.ring.outer_diameter), (centre, centre))
    body = [
        part_shape(outlines.ring, view, "ring"),
        part_shape(outlines.posed_disc(disc, angle), view, "disc-body"),
        *outlines.pin_shapes(view, angle),
    ]
    cam = turn.cam_force[at, disc]
    load = float(np.hypot(*cam))
    greatest = max(float(turn.ring_force[at, disc].max()), load, 1e-12)
    scale = 95.0 / greatest
    for kind, loads, points in (
        ("ring", turn.ring_load, turn.ring_point),
        ("pin", turn.pin_load, turn.pin_point),
    ):
        sizes = np.hypot(loads[at, disc, :, 0], loads[at, disc, :, 1])
        for k, size in enumerate(sizes.tolist()):
            if size > 0.0:
                tip = view.point(points[at, disc, k])
                body += _arrow(tip, loads[at, disc, k] / size, size, scale, f"force-{kind}")
    if load > 0.0:
        tip = view.point(turn.disc_centre[at, disc])
        body += _arrow(tip, cam / load, load, scale, "force-cam")
    degrees = math.degrees(angle)
    shown = greatest if greatest > load else turn.ring_force.max()
    words = Words(
        "contact-forces",
        "Contact forces at the worst angle",
        f"Forces on disc {disc + 1} at crank angle {degrees:.0f} degrees, where tooth "
        f"{tooth + 1} carries {shown:.0f} N.",
        f"Disc {disc + 1} at crank angle {decimals(degrees, 0)}\u00b0, where tooth {tooth + 1} "
        "carries the greatest force. Arrows are forces on the disc, friction included, in N: ring "
        "teeth red, output pins green, cam bearing violet.",
    )
    return words.figure(width, width, body)


def _arrow(tip: Point, direction: FloatArray, force: float, scale: float, class_: str) -> list[str]:
    """An arrow that ends where its force acts, with the force in newtons at its tail."""
    ux, uy = float(direction[0]), -float(direction[1])
    length = max(scale * force, 9.0)
    tail = (tip[0] - length * ux, tip[1] - length * uy)
    label = (tail[0] - 11.0 * ux, tail[1] - 11.0 * uy + 4.0)
    shaft = (tip[0] - 6.0 * ux, tip[1] - 6.0 * uy)
    return [
        line(tail, shaft, f"force-line {class_}-line"),
        arrow_head(tip, (ux, uy), f"force {class_}", 10.0),
        text(label, decimals(force, 0), "force-label", "middle"),
    ]


def _rows(analysis: ContactAnalysis, law: RigidMaxima) -> tuple[tuple[str, str, str], ...]:
    sweep, back = analysis.sweep, analysis.reversed
    teeth = sweep.teeth_in_contact

    def row(key: str, rigid: float, attribute: str) -> tuple[str, str, str]:
        words, unit = term(key)
        scale = 1e-6 if unit == "MPa" else 1.0
        found = max(float(getattr(one, attribute).max()) for one in (sweep, back))
        return words, with_unit(scale * rigid, unit), with_unit(scale * found, unit)

    return (
        row("ring_force_max_N", law.ring_force, "ring_force"),
        row("ring_pressure_max_MPa", law.ring_pressure, "ring_pressure"),
        row("output_pin_force_max_N", law.output_pin_force, "pin_force"),
        row("output_pressure_max_MPa", law.output_pressure, "pin_pressure"),
        row("cam_bearing_load_max_N", law.cam_bearing_load, "cam_load"),
        (term("uneven_sharing").words, "1", decimals(sweep.uneven_sharing, 3)),
        (
            term("teeth_in_contact").words,
            "half of them",
            f"{int(teeth.min())} to {int(teeth.max())}",
        ),
    )


def _preload(analysis: ContactAnalysis) -> str:
    if analysis.preload is None:
        return ""
    force = decimals(float(analysis.preload.ring_force.max()), 0)
    return (
        "The fits are of interference: without any torque the teeth already press with up to "
        f"{force}\u202fN."
    )


def _bending(analysis: ContactAnalysis) -> str:
    """What the plane problem leaves out, in two sentences."""
    bound = analysis.bending
    if bound is None:
        return f"No bound on bending and tilt: {analysis.bending_missing}"

    def um(value: float) -> str:
        # Of bodies that stay straight only rounding is left.
        return with_unit(1e6 * value if abs(value) > _ROUNDING else 0.0, "\u00b5m", 3)

    moment = with_unit(bound.carrier_moment, "N*m", 3)
    supports, edge = "", ""
    if bound.support_deflection is not None:
        supports = f", and its two bearings let it move by {um(bound.support_deflection)}"
    if bound.edge_closing is not None:
        edge = (
            f"; if the discs followed its slope, the teeth would close by {um(bound.edge_closing)} "
            f"more at one face than at the other, where the busiest tooth approaches by "
            f"{um(bound.ring_approach)}"
        )
    return (
        "Left out of this plane problem, and bounded from its forces: at a disc the shaft bends by "
        f"{um(bound.deflection)}{supports}{edge}. A moment of {moment} tilts the carrier in its "
        "output bearing, by an angle that no catalogue value tells."
    )
