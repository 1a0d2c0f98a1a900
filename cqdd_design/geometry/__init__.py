"""Plane geometry in closed form: disc, ring, holes, arcs and area integrals. numpy only."""

from cqdd_design.geometry.biarc import ArcChain, fit_biarcs, mirrored_contour
from cqdd_design.geometry.conjugate import SecondEnvelope, active_angle, swept_radius
from cqdd_design.geometry.contours import ArcContour, Arcs, Circle, Contour, Moments, PlanarPart
from cqdd_design.geometry.cycloid import (
    CycloidDisc,
    locus_curvature,
    locus_valley_radius,
    shortening_coefficient,
    undercut_radius_limit,
)
from cqdd_design.geometry.disc import (
    Ligament,
    crank_phase,
    disc_contour,
    disc_moments,
    hole_centres,
    hole_diameter,
    ligament_hole_to_bore,
    ligament_hole_to_hole,
    ligament_hole_to_valley,
    ligaments,
    lobed_outline,
    profile_moments,
    profile_perimeter,
)
from cqdd_design.geometry.kinematics import disc_pose
from cqdd_design.geometry.limits import largest_eccentricity, smallest_pitch_radius
from cqdd_design.geometry.meshing import (
    Projection,
    ToothGaps,
    project,
    tooth_centres,
    tooth_gaps,
)
from cqdd_design.geometry.relief import Relief, solid_relief
from cqdd_design.geometry.ring import (
    ring_contour,
    ring_min_concave_radius,
    ring_moments,
    ring_pins,
    ring_root_radius,
    ring_wall_thickness,
)
from cqdd_design.geometry.validate import validate_geometry

__all__ = [
    "ArcChain",
    "ArcContour",
    "Arcs",
    "Circle",
    "Contour",
    "CycloidDisc",
    "Ligament",
    "Moments",
    "PlanarPart",
    "Projection",
    "Relief",
    "SecondEnvelope",
    "ToothGaps",
    "active_angle",
    "crank_phase",
    "disc_contour",
    "disc_moments",
    "disc_pose",
    "fit_biarcs",
    "hole_centres",
    "hole_diameter",
    "largest_eccentricity",
    "ligament_hole_to_bore",
    "ligament_hole_to_hole",
    "ligament_hole_to_valley",
    "ligaments",
    "lobed_outline",
    "locus_curvature",
    "locus_valley_radius",
    "mirrored_contour",
    "profile_moments",
    "profile_perimeter",
    "project",
    "ring_contour",
    "ring_min_concave_radius",
    "ring_moments",
    "ring_pins",
    "ring_root_radius",
    "ring_wall_thickness",
    "shortening_coefficient",
    "smallest_pitch_radius",
    "solid_relief",
    "swept_radius",
    "tooth_centres",
    "tooth_gaps",
    "undercut_radius_limit",
    "validate_geometry",
]
