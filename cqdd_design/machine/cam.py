"""The catalogue's answer to a cam bearing of "auto": asked here and nowhere else."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.cam_bearing import (
    choose,
    continuous_load,
    fitting_bearings,
    largest_outer_diameter,
    least_bore,
    relative_speed,
)
from cqdd_design.gearbox.loads import rigid_maxima
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry.cycloid import CycloidDisc


def named_bearing(design: Design) -> Design:
    """The design with its cam bearing replaced by the catalogue's answer.

    Raises
    ------
    GeometryError
        When the disc or its holes cannot exist, which no bearing would change.
    InfeasibleError
        When no catalogue bearing fits the disc at all.
    """
    reducer = design.reducer
    # Before the loads, which have no answer for a disc that cannot exist.
    valley = CycloidDisc.from_design(design).valley_distance
    stages = Stages.from_design(design)
    peak = rigid_maxima(stages, design.requirements.peak_torque).cam_bearing_load
    most = largest_outer_diameter(design, 2.0 * stages.hole_radius, valley)
    chosen = choose(
        fitting_bearings(design, most),
        peak,
        continuous_load(design, peak),
        relative_speed(design),
        design.requirements.life_hours,
    )
    if chosen is None:
        raise InfeasibleError(
            f"no catalogue bearing fits the disc: at most {max(most, 0.0) * 1e3:.2f} mm outside, "
            f"{reducer.disc_thickness * 1e3:g} mm wide and at least "
            f"{least_bore(reducer.eccentricity) * 1e3:.2f} mm inside; raise "
            "output_pins.circle_radius or disc_thickness, or lower eccentricity."
        )
    return design.replacing({"reducer.cam_bearing.designation": chosen.bearing.designation})
