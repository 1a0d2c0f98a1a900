"""Whether the parts of a design can exist at all: raises with the nearest fix."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from cqdd_design.catalog.screws import LEAST_COLUMN
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.columns import column_hole_diameter
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import Ligament, hole_diameter, ligaments
from cqdd_design.geometry.limits import at_most, millimetres, rounded_down, rounded_up
from cqdd_design.geometry.ring import ring_contour

if TYPE_CHECKING:
    from cqdd_design.design import Design

_FEWEST_PINS = 3


def validate_geometry(design: Design, *, bore_diameter: float) -> None:
    """Raise unless disc, ring and holes of a design can be cut.

    Parameters
    ----------
    bore_diameter : float
        Outside diameter of the cam bearing, m.

    Raises
    ------
    GeometryError
        Undercut, overlapping teeth, no ring wall, no relief, or holes that break out. Thin but
        existing material is a matter for the checks, not for this function.
    """
    CycloidDisc.from_design(design)
    ring_contour(design)
    hole = hole_diameter(design)
    if hole <= 0.0:
        raise GeometryError(
            f"output_pins.hole_clearance {millimetres(design.reducer.output_pins.hole_clearance)} "
            "leaves no output hole; raise it."
        )
    found = ligaments(design, bore_diameter=bore_diameter)
    broken = [one for one in found if one.thickness <= 0.0]
    if broken:
        # A bore outside the disc is the plainest of them, whatever else it cuts on the way.
        plainest = next((one for one in broken if one.kind == "bore to profile"), broken[0])
        if plainest.kind.startswith("column"):
            raise GeometryError(_column_breaks_out(design, plainest))
        raise GeometryError(_break_out(design, plainest, hole, bore_diameter))


def _column_breaks_out(design: Design, worst: Ligament) -> str:
    carrier = design.reducer.carrier
    room = {
        "column to hole": "run into the output holes beside them",
        "column to bore": "break out into the bore",
        "column to profile": "break out into the lobed profile",
    }
    # Material grows by half of what the diameter loses, and the screw's play never grows with it.
    most = carrier.column_diameter + 2.0 * worst.thickness
    fix = (
        f"lower it to {at_most(most)}"
        if most > LEAST_COLUMN
        else f"even the least column of {millimetres(LEAST_COLUMN)} has no room there: use fewer "
        'or thinner output_pins, or joint = "clamped"'
    )
    return (
        f"carrier.column_diameter {millimetres(carrier.column_diameter)} lets its holes of "
        f"{millimetres(column_hole_diameter(design.reducer))} in the discs {room[worst.kind]}; "
        f"{fix}."
    )


def _break_out(design: Design, worst: Ligament, hole: float, bore: float) -> str:
    pins = design.reducer.output_pins
    disc = CycloidDisc.from_design(design)
    valley = disc.valley_distance
    inner, outer = (bore + hole) / 2.0, valley - hole / 2.0
    if worst.kind == "bore to profile":
        return (
            f"the bore of {millimetres(bore)} for the cam bearing cuts through the valleys of the "
            f"disc, which stand {millimetres(valley)} from its centre; choose a "
            f"cam_bearing.designation below {rounded_down(2e3 * valley):.6g} mm outside diameter."
        )
    if worst.kind == "hole to hole":
        fixes = ["use thinner output_pins"]
        fewer = math.ceil(math.pi / math.asin(min(1.0, hole / (2.0 * pins.circle_radius)))) - 1
        if fewer >= _FEWEST_PINS:
            fixes.append(f"lower output_pins.count to {fewer}")
        wider = rounded_up(hole / (2.0 * math.sin(math.pi / pins.count)) * 1e3)
        if wider * 1e-3 < outer:
            fixes.append(f"raise output_pins.circle_radius to {wider:.6g} mm")
        fix = ", or ".join(fixes)
        return (
            f"output_pins.count {pins.count} lets neighbouring holes of {millimetres(hole)} run "
            f"into each other on circle_radius {millimetres(pins.circle_radius)}; {fix}."
        )
    low, high = rounded_up(inner * 1e3), rounded_down(outer * 1e3) if outer > 0.0 else 0.0
    if low < high:
        fix = f"choose it from {low:.6g} to {high:.6g} mm"
    else:
        fix = (
            f"no circle_radius is right between a bore of {millimetres(bore)} and valleys at "
            f"{millimetres(valley)}; use thinner output_pins or a smaller cam_bearing"
        )
    edge = "bore" if worst.kind == "hole to bore" else "lobed profile"
    return (
        f"output_pins.circle_radius {millimetres(pins.circle_radius)} lets the output holes of "
        f"{millimetres(hole)} break out into the {edge}; {fix}."
    )
