"""The contact equilibrium in the report: heat maps of load, the worst angle, the rigid law."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.report.drawings.outlines import Machine
from cqdd_design.report.ink.heat import heat_map
from cqdd_design.report.ink.numbers import decimals, with_unit
from cqdd_design.report.ink.svg import (
    Figure,
    Point,
    View,
    arrow_head,
    circle,
    element,
    line,
    part_path,
    text,
)

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.sweep import ContactSweep
    from cqdd_design.machine.contact_analysis import ContactAnalysis

FloatArray = NDArray[np.float64]

_TURN = (0.0, 90.0, 180.0, 270.0, 360.0)


@dataclass(frozen=True)
class ContactView:
    """What the section shows.

    Attributes
    ----------
    heat_maps : tuple of Figure
        One a disc.
    worst : Figure
    rows : tuple of (name, rigid law, contact)
    torque : str
    preload : str
        A sentence; empty without interference.
    """

    heat_maps: tuple[Figure, ...]
    worst: Figure
    rows: tuple[tuple[str, str, str], ...]
    torque: str
    preload: str


def contact_view(analysis: ContactAnalysis, machine: Machine, law: RigidMaxima) -> ContactView:
    """Values of the section.

    Parameters
    ----------
    analysis : ContactAnalysis
        At the torque of `law`.
    machine : Machine
    law : RigidMaxima
        Greatest values of the rigid law at the same torque.
    """
    turn = analysis.crank_turn
    return ContactView(
        heat_maps=tuple(_heat_map(turn, disc) for disc in range(turn.model.disc_count)),
        worst=force_picture(turn, machine),
        rows=_rows(analysis, law),
        torque=with_unit(analysis.sweep.torque, "N*m"),
        preload=_preload(analysis),
    )


def _heat_map(turn: ContactSweep, disc: int) -> Figure:
    force = turn.ring_force[:, disc, :].T
    most = int(turn.teeth_in_contact[:, disc].max())
    return heat_map(
        f"tooth-load-{disc + 1}",
        f"Load of every ring tooth, disc {disc + 1}",
        f"Force of each ring tooth on disc {disc + 1} over one crank turn; at most "
        f"{decimals(float(force.max()), 0)} N, on up to {most} teeth together.",
        values=force,
        rows=[str(k + 1) for k in range(len(force))],
        row_label="ring tooth",
        x=(0.0, 360.0),
        x_ticks=_TURN,
        x_label="crank angle, \u00b0",
        unit="N",
        caption=f"Greatest {decimals(float(force.max()), 0)} N; up to {most} teeth carry together.",
    )


def force_picture(turn: ContactSweep, machine: Machine) -> Figure:
    """Contact forces on the disc and at the angle of the greatest ring force, true to direction."""
    at, disc, tooth = np.unravel_index(int(turn.ring_force.argmax()), turn.ring_force.shape)
    angle = float(turn.crank_angle[at])
    width, centre = 560.0, 280.0
    view = View(212.0 / (0.5 * machine.design.reducer.ring.outer_diameter), (centre, centre))
    body = [
        element("path", d=part_path(machine.ring, view), class_="ring"),
        element(
            "path", d=part_path(machine.posed_disc(int(disc), angle), view), class_="disc-body"
        ),
    ]
    for place in machine.pin_angles(angle):
        at_pin = view.polar(machine.design.reducer.output_pins.circle_radius, place)
        body.append(circle(at_pin, view.length(0.5 * machine.pin_diameter), "pin"))
    cam = turn.cam_force[at, disc]
    load = float(np.hypot(*cam))
    greatest = max(float(turn.ring_force[at, disc].max()), load, 1e-12)
    scale = 95.0 / greatest
    for kind, forces, normals, points in (
        ("ring", turn.ring_force, turn.ring_normal, turn.ring_point),
        ("pin", turn.pin_force, turn.pin_normal, turn.pin_point),
    ):
        for k in range(forces.shape[2]):
            force = float(forces[at, disc, k])
            if force > 0.0:
                tip = view.point(points[at, disc, k])
                body.append(_arrow(tip, normals[at, disc, k], force, scale, f"force-{kind}"))
    if load > 0.0:
        tip = view.point(turn.disc_centre[at, disc])
        body.append(_arrow(tip, cam / load, load, scale, "force-cam"))
    degrees = math.degrees(angle)
    return Figure(
        "contact-forces",
        "Contact forces at the worst angle",
        f"Forces on disc {int(disc) + 1} at crank angle {degrees:.0f} degrees, where tooth "
        f"{int(tooth) + 1} carries {greatest if greatest > load else turn.ring_force.max():.0f} N.",
        width,
        width,
        "".join(body),
        f"Disc {int(disc) + 1} at crank angle {decimals(degrees, 0)}\u00b0, where tooth "
        f"{int(tooth) + 1} carries the greatest force. Arrows are forces on the disc, in N: "
        "ring teeth red, output pins green, cam bearing violet.",
    )


def _arrow(tip: Point, direction: FloatArray, force: float, scale: float, class_: str) -> str:
    """An arrow that ends where its force acts, with the force in newtons at its tail."""
    ux, uy = float(direction[0]), -float(direction[1])
    length = max(scale * force, 9.0)
    tail = (tip[0] - length * ux, tip[1] - length * uy)
    label = (tail[0] - 11.0 * ux, tail[1] - 11.0 * uy + 4.0)
    shaft = (tip[0] - 6.0 * ux, tip[1] - 6.0 * uy)
    return (
        line(tail, shaft, f"force-line {class_}-line")
        + arrow_head(tip, (ux, uy), f"force {class_}", 10.0)
        + text(label, decimals(force, 0), "force-label", "middle")
    )


def _rows(analysis: ContactAnalysis, law: RigidMaxima) -> tuple[tuple[str, str, str], ...]:
    sweep, back = analysis.sweep, analysis.reversed
    share = np.abs(sweep.disc_torque)
    uneven = float((share.max(axis=1) / share.mean(axis=1)).max())

    def most(name: str) -> float:
        return max(float(getattr(one, name).max()) for one in (sweep, back))

    return (
        _row("greatest force at a ring tooth", law.ring_force, most("ring_force"), "N"),
        _row("greatest Hertz pressure at a ring tooth", law.ring_pressure / 1e6,
             most("ring_pressure") / 1e6, "MPa"),
        _row("greatest force at an output pin", law.output_pin_force, most("pin_force"), "N"),
        _row("greatest Hertz pressure at an output pin", law.output_pressure / 1e6,
             most("pin_pressure") / 1e6, "MPa"),
        _row("greatest load of a cam bearing", law.cam_bearing_load, most("cam_load"), "N"),
        ("most loaded disc over the mean", "1", decimals(uneven, 3)),
        (
            "ring teeth that carry together",
            "half of them",
            f"{int(sweep.teeth_in_contact.min())} to {int(sweep.teeth_in_contact.max())}",
        ),
    )  # fmt: skip


def _row(name: str, law: float, found: float, unit: str) -> tuple[str, str, str]:
    return name, with_unit(law, unit), with_unit(found, unit)


def _preload(analysis: ContactAnalysis) -> str:
    if analysis.preload is None:
        return ""
    force = decimals(float(analysis.preload.ring_force.max()), 0)
    return (
        "The fits are of interference: without any torque the teeth already press with up to "
        f"{force}\u202fN."
    )
