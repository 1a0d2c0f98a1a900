"""Where a machine's motor stands, and why not in the other places."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.catalog.motors import Motor
from cqdd_design.geometry.scale import largest_ring, ring_within_rotor, smallest_ring
from cqdd_design.machine.machine import Machine

if TYPE_CHECKING:
    from cqdd_design.solids.layout import Layout

_MM = 1e3
_ON_OWN_SHAFT = {"open outrunner", "drone"}
"""Kinds of the catalogue that turn in bearings of their own."""
_ROUND_MOTOR = 1.6 + 1.0 + 2.0
"""Round a motor within a shaft: its can, the gap to the shaft, and the shaft's own wall, units."""


def motor_standing(machine: Machine) -> str:
    """Where the motor stands and why, in a sentence or two.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    layout = machine.layout
    if layout.motor_end is None:
        return f"{machine.motor.name} is not drawn: {layout.motor_missing}."
    return _place(layout, machine.motor.name) + _taken_off(machine.motor)


def _taken_off(motor: Motor) -> str:
    """What of a motor that is sold on its own shaft is not used; empty of frameless ones."""
    if motor.kind not in _ON_OWN_SHAFT:
        return ""
    return (
        " It is sold on a shaft of its own: stator and ring of magnets are used; shaft, bearings "
        "and bell are taken off."
    )


def _place(layout: Layout, name: str) -> str:
    if layout.inrunner is not None:
        return f"{name} stands behind the gearbox. {_not_inside(layout)} {_not_round(layout)}"
    bore, ring = layout.motor_row.bore_diameter or 0.0, 2.0 * layout.pack.ring_radius
    if layout.motor is not None and layout.motor.behind:
        return (
            f"{name} stands behind the gearbox: into its stator's bore of {_MM * bore:.4g} mm go "
            f"rings of {_MM * smallest_ring(bore):.4g} to {_MM * largest_ring(bore):.4g} mm with "
            f"their housing, and this one has {_MM * ring:.4g} mm."
        )
    return (
        f"{name} stands round the gearbox, whose housing fills its stator's bore of "
        f"{_MM * bore:.4g} mm."
    )


def room_round_motor(outside: float, eccentricity: float, unit: float) -> float:
    """Least bore of a cam bearing whose eccentric goes round a motor, m.

    Parameters
    ----------
    outside, eccentricity, unit : float
        Diameter of the motor, and of the machine, m.
    """
    return outside + 2.0 * (_ROUND_MOTOR * unit + eccentricity)


def _not_inside(layout: Layout) -> str:
    bore, ring = layout.motor_row.hollow_diameter or 0.0, 2.0 * layout.pack.ring_radius
    most = ring_within_rotor(bore)
    told = (
        f"Into its rotor's bore of {_MM * bore:.4g} mm goes a ring of {_MM * most:.3g} mm at most "
        "with its housing and the rotor's sleeve"
    )
    if ring <= most:
        return f"{told}: this one would, and the machine be shorter, but that is not drawn."
    return f"{told}, and this one has {_MM * ring:.4g} mm."


def _not_round(layout: Layout) -> str:
    pack, outside = layout.pack, layout.motor_row.outer_diameter or 0.0
    least, has = room_round_motor(outside, pack.eccentricity, layout.unit), pack.cam.bearing
    told = (
        f"To hold its {_MM * outside:.4g} mm inside, the eccentric shaft asks for a cam bearing "
        f"with a bore of {_MM * least:.4g} mm"
    )
    if has.bore_diameter >= least:
        return f"{told}: this one's would do, but that is not drawn."
    return f"{told}, and this one's has {_MM * has.bore_diameter:.4g} mm."
