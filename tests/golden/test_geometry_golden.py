"""Our own geometry numbers, held tightly, for the paper's disc and a fine-pitched one.

They are not published: they guard against unnoticed change. After a change that is meant to move
them, regenerate with::

    python tests/golden/test_geometry_golden.py
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from cqdd_design.design import Design
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import (
    disc_moments,
    hole_diameter,
    ligaments,
    profile_moments,
    profile_perimeter,
)
from cqdd_design.geometry.ring import (
    ring_min_concave_radius,
    ring_moments,
    ring_root_radius,
)

FILE = Path(__file__).with_suffix(".json")
BORE = 0.024
PAPER = {
    "ratio": 10,
    "ring_pitch_radius": "32 mm",
    "eccentricity": "1.6 mm",
    "ring_pin_diameter": "7 mm",
    "output_pins": {"count": 5, "circle_radius": "19.5 mm"},
    "ring": {"outer_diameter": "72 mm"},
}
FINE = {
    "ratio": 29,
    "ring_pitch_radius": "34 mm",
    "eccentricity": "0.7 mm",
    "ring_pin_diameter": "4.4 mm",
    "modification": {"equidistant": "4 um", "radial": "3 um", "rotation": "2 arcmin"},
    "output_pins": {"count": 8, "circle_radius": "21 mm"},
    "ring": {"outer_diameter": "76 mm"},
}
DESIGNS = {
    "paper": PAPER,
    "paper-conjugate": {**PAPER, "ring_type": "conjugate"},
    "paper-pinwheel": {**PAPER, "ring_type": "pinwheel"},
    "fine": FINE,
}


def measure(reducer: dict[str, object]) -> dict[str, float]:
    """Return the numbers of one design, in millimetres and powers of it."""
    design = Design.from_mapping({"reducer": reducer})
    disc = CycloidDisc.from_design(design)
    part = disc_moments(design, 1, bore_diameter=BORE)
    thin = ligaments(design, bore_diameter=BORE)
    return {
        "shortening_coefficient": disc.shortening_coefficient,
        "undercut_radius_limit_mm": 1e3 * disc.undercut_radius_limit,
        "disc_min_convex_radius_mm": 1e3 * disc.min_convex_radius,
        "disc_min_concave_radius_mm": 1e3 * disc.min_concave_radius,
        "disc_profile_area_mm2": 1e6 * profile_moments(disc).area,
        "disc_profile_polar_mm4": 1e12 * profile_moments(disc).polar,
        "disc_profile_perimeter_mm": 1e3 * profile_perimeter(disc),
        "disc_area_mm2": 1e6 * part.area,
        "disc_polar_mm4": 1e12 * part.polar,
        "hole_diameter_mm": 1e3 * hole_diameter(design),
        "thinnest_ligament_mm": 1e3 * thin[0].thickness,
        "ring_root_radius_mm": 1e3 * ring_root_radius(design),
        "ring_wall_thickness_mm": 1e3
        * (design.reducer.ring.outer_diameter / 2.0 - ring_root_radius(design)),
        "ring_min_concave_radius_mm": 1e3 * ring_min_concave_radius(design),
        "ring_area_mm2": 1e6 * ring_moments(design).area,
        "ring_polar_mm4": 1e12 * ring_moments(design).polar,
    }


@pytest.mark.parametrize("name", DESIGNS)
def test_numbers_have_not_moved(name: str) -> None:
    expected = json.loads(FILE.read_text(encoding="utf-8"))[name]
    found = measure(DESIGNS[name])
    assert found.keys() == expected.keys()
    for key, value in found.items():
        assert math.isfinite(value)
        assert value == pytest.approx(expected[key], rel=1e-9), key


if __name__ == "__main__":
    numbers = {name: measure(reducer) for name, reducer in DESIGNS.items()}
    FILE.write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
