"""Films of cycloidgen under forces and sliding speeds that are given: run by `films.py`.

Run with the Python of an environment that has cycloidgen; reads a list of cases as JSON from
standard input and prints one list of contacts, ring first.
"""

from __future__ import annotations

import json
import sys

from cycloidgen.analysis.lubrication import analyse_lubrication
from cycloidgen.core.spec import GearSpec


def films(case: dict[str, float]) -> list[dict[str, float]]:
    """Film (um), lambda and friction at ring and output pins."""
    spec = GearSpec(
        pin_circle_radius=case["R"],
        pin_radius=case["r"],
        eccentricity=case["e"],
        lobes=int(case["n"]),
        disc_thickness=case["b"],
        output_pin_count=int(case["pins"]),
        output_pin_diameter=case["pin_diameter"],
        output_bolt_circle_radius=case["pin_circle"],
        profile_clearance=0.006,
        hole_clearance=case["hole_clearance"],
        disc_material="Steel 1045",
        pin_material="Steel 1045",
        lubricant="Grease NLGI 2 (lithium/mineral)",
        surface_roughness_um=case["roughness"],
    )
    found = analyse_lubrication(
        spec,
        ring_load_N=case["ring_force"],
        output_load_N=case["pin_force"],
        cam_load_N=1.0,
        ring_sliding_m_s=case["ring_sliding"],
        output_sliding_m_s=case["pin_sliding"],
        cam_sliding_m_s=1.0,
        temperature_C=case["temperature"],
    )
    return [
        {"film": one.film_um, "lambda": one.lambda_ratio, "friction": one.mu}
        for one in found.contacts[:2]
    ]


print(json.dumps([films(case) for case in json.load(sys.stdin)]))
