"""The numbers of a design's geometry that results and checks quote."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.design import Design
from cqdd_design.gearbox.cam_bearing import largest_outer_diameter
from cqdd_design.geometry.columns import column_hole_diameter
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import (
    Ligament,
    disc_moments,
    hole_diameter,
    ligaments,
    profile_moments,
    profile_perimeter,
)
from cqdd_design.geometry.kinematics import ratio_ring_fixed
from cqdd_design.geometry.ring import ring_min_concave_radius, ring_root_radius


@dataclass(frozen=True)
class GeometrySummary:
    """Geometry of a design, SI.

    Attributes
    ----------
    lobe_count, ring_tooth_count, ratio : int
        n, n + 1, and the signed ratio with the ring fixed, -n.
    shortening_coefficient : float
        K1.
    undercut_radius_limit : float
        Least convex radius of the nominal tooth-centre locus, m.
    disc_min_convex_radius, disc_min_concave_radius : float
        Of the finished disc, m; the second is infinite where (n+1) K1 <= 1 leaves no concave
        valley.
    ring_min_concave_radius, ring_root_radius : float
        m.
    profile_area, profile_perimeter : float
        Of the lobed outline without holes, m^2 and m.
    disc_area : float
        Of disc 0 with bore and holes, m^2.
    hole_diameter, column_hole_diameter : float
        Of the output holes, and of those for columns (0 without columns), m.
    ligaments : tuple of Ligament
        Thinnest first.
    largest_cam_bearing : float
        Largest outside diameter of a cam bearing that leaves the least ligament, m.
    """

    lobe_count: int
    ring_tooth_count: int
    ratio: int
    shortening_coefficient: float
    undercut_radius_limit: float
    disc_min_convex_radius: float
    disc_min_concave_radius: float
    ring_min_concave_radius: float
    ring_root_radius: float
    profile_area: float
    profile_perimeter: float
    disc_area: float
    hole_diameter: float
    column_hole_diameter: float
    ligaments: tuple[Ligament, ...]
    largest_cam_bearing: float

    @property
    def has_concave_valleys(self) -> bool:
        """Whether the disc curves inward anywhere."""
        return math.isfinite(self.disc_min_concave_radius)

    def ligament(self, kind: str) -> Ligament:
        """Return the ligament of one kind, such as ``"hole to hole"``."""
        return next(one for one in self.ligaments if one.kind == kind)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``geometry``)."""
        thinnest = self.ligaments[0]
        column = {"column_hole_diameter_mm": self.column_hole_diameter * 1e3}
        return {
            "lobe_count": self.lobe_count,
            "ring_tooth_count": self.ring_tooth_count,
            "ratio": self.ratio,
            "shortening_coefficient": self.shortening_coefficient,
            "undercut_radius_limit_mm": self.undercut_radius_limit * 1e3,
            "disc_min_convex_radius_mm": self.disc_min_convex_radius * 1e3,
            "disc_min_concave_radius_mm": (
                self.disc_min_concave_radius * 1e3 if self.has_concave_valleys else None
            ),
            "ring_min_concave_radius_mm": self.ring_min_concave_radius * 1e3,
            "ring_root_radius_mm": self.ring_root_radius * 1e3,
            "disc_profile_area_mm2": self.profile_area * 1e6,
            "disc_profile_perimeter_mm": self.profile_perimeter * 1e3,
            "disc_area_mm2": self.disc_area * 1e6,
            "hole_diameter_mm": self.hole_diameter * 1e3,
            **(column if self.column_hole_diameter else {}),
            "thinnest_ligament_mm": thinnest.thickness * 1e3,
            "thinnest_ligament_where": thinnest.where,
        }


def summarise_geometry(design: Design, cam_bearing: Bearing) -> GeometrySummary:
    """Collect the geometry of a design that is known to exist.

    Parameters
    ----------
    cam_bearing : Bearing
        Its outside diameter is the bore of the disc.
    """
    disc = CycloidDisc.from_design(design)
    bore, hole = cam_bearing.outer_diameter, hole_diameter(design)
    return GeometrySummary(
        lobe_count=disc.lobe_count,
        ring_tooth_count=disc.ring_tooth_count,
        ratio=ratio_ring_fixed(disc.lobe_count),
        shortening_coefficient=disc.shortening_coefficient,
        undercut_radius_limit=disc.unmodified.undercut_radius_limit,
        disc_min_convex_radius=disc.min_convex_radius,
        disc_min_concave_radius=disc.min_concave_radius,
        ring_min_concave_radius=ring_min_concave_radius(design),
        ring_root_radius=ring_root_radius(design),
        profile_area=profile_moments(disc).area,
        profile_perimeter=profile_perimeter(disc),
        disc_area=disc_moments(design, 0, bore_diameter=bore).area,
        hole_diameter=hole,
        column_hole_diameter=column_hole_diameter(design.reducer),
        ligaments=ligaments(design, bore_diameter=bore),
        largest_cam_bearing=largest_outer_diameter(design, hole, disc.valley_distance),
    )
