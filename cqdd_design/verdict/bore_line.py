"""The way through the middle of the machine, for cables or a shaft."""

from __future__ import annotations

from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.gearbox.cam_bearing import fitting_bearings, largest_outer_diameter
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine, resolve
from cqdd_design.results import Check


def bore_line(machine: Machine) -> Check | None:
    """Of the way through the middle, where one is asked for."""
    wanted = machine.design.requirements.bore
    if wanted is None:
        return None
    try:
        layout = machine.layout
    except GeometryError as error:
        return build_check("BORE", None, 1e3 * wanted, error.message, "see why nothing is drawn")
    hole, journal = 2e3 * layout.shaft.bore_radius, layout.shaft.support.bearing.bore_diameter
    beside = "" if layout.motor_end is None else ", whose encoder stands beside it"
    return build_check(
        "BORE",
        # In drawings' digits: a hole of just the bore is one.
        round(hole, 6),
        1e3 * wanted,
        f"{hole:.3g} mm through a shaft of {1e3 * journal:g} mm{beside}",
        "" if round(hole, 6) >= 1e3 * wanted else _wider(machine, hole),
    )


def _wider(machine: Machine, hole: float) -> str:
    """The cam bearing with the least bore that leaves hole enough, or the most (mm) that any does.

    Support bearings follow from what the eccentrics leave of the shaft within it.
    """
    design, wanted = machine.design, 1e3 * (machine.design.requirements.bore or 0.0)
    now = machine.layout.pack.cam.bearing.bore_diameter
    valley = CycloidDisc.from_design(design).valley_distance
    room = largest_outer_diameter(design, 2.0 * Stages.from_design(design).hole_radius, valley)
    most, by = hole, ""
    for one in sorted(fitting_bearings(design, room), key=lambda one: one.bore_diameter):
        if one.bore_diameter <= now:
            continue
        named = {"reducer.cam_bearing.designation": one.designation}
        try:
            left = 2e3 * resolve(design.replacing(named)).layout.shaft.bore_radius
        except DesignError:
            continue
        if round(left, 6) >= wanted:
            return (
                f"set cam_bearing.designation to '{one.designation}', which leaves a hole of "
                f"{left:.3g} mm; its own lines are then judged"
            )
        if left > most:
            most, by = left, f", as '{one.designation}' does"
    less = "leave out requirements.bore"
    if hole > 0.0:
        less = f"lower requirements.bore to {rounded_down(hole):g} mm, which this one leaves"
    return (
        f"no cam bearing that fits this disc leaves a hole of more than {most:.3g} mm{by}: {less}, "
        "or raise ring.outer_diameter and output_pins.circle_radius"
    )
