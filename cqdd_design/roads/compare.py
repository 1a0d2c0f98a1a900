"""The loads of a design on a compound planetary."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.machine import resolve
from cqdd_design.planetary.compare import PlanetaryComparison
from cqdd_design.planetary.kinematics import PlanetaryTeeth
from cqdd_design.sizing.comparison import compare_with_planetary


def compare(
    design: Design,
    *,
    teeth: PlanetaryTeeth | None = None,
    module: float | None = None,
    face_width: float | None = None,
    material: str | None = None,
    planets: int | None = None,
) -> PlanetaryComparison:
    """A compound planetary for the loads of a design; see `compare_with_planetary`."""
    return compare_with_planetary(
        resolve(design),
        teeth=teeth,
        module=module,
        face_width=face_width,
        material=material,
        planets=planets,
    )
