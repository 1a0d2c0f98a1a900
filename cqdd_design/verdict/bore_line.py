"""The way through the middle of the machine, for cables or a shaft."""

from __future__ import annotations

from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
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
        "take a cam bearing and support bearings with a larger bore",
    )
