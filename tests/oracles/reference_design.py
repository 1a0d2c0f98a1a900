"""Reference design S of the project's notes: what the contact laws, the cam and the pins need."""

from __future__ import annotations

import math

from cqdd_design.design import Design
from cqdd_design.gearbox.contact.model import ContactModel


def reference_s(disc_count: int = 2) -> ContactModel:
    """n 10, R 32.75, e 1.97, r 3.3; two discs of 8 mm; ten 4 mm pins on R 23."""
    reducer = {
        "ratio": 10,
        "ring_pitch_radius": 32.75e-3,
        "eccentricity": 1.97e-3,
        "ring_pin_diameter": 6.6e-3,
        "disc_count": disc_count,
        "disc_thickness": 8e-3,
        "disc_spacing": 0.5e-3,
        "disc_material": "AISI 4140 Q&T 540C",
        "ring_material": "AISI 4140 Q&T 540C",
        "modification": {"equidistant": 6e-6},
        "output_pins": {
            "count": 10,
            "diameter": 4e-3,
            "circle_radius": 23e-3,
            "hole_clearance": 16e-6,
            "hole_clocking": math.radians(9.0),
            "support": "both",
            "material": "Alloy steel 12.9 (ISO 7379)",
        },
        "cam_bearing": {"designation": "16003", "radial_clearance": 5e-6},
        "ring": {"outer_diameter": 72e-3},
    }
    return ContactModel.from_design(Design.from_mapping({"reducer": reducer}, si=True))
