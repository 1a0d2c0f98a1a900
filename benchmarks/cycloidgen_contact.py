"""Time cycloidgen's stiffness and transmission error, and count the equations it solves for them.

Run by `contact_solves.py` with the Python of an environment that has cycloidgen; prints JSON.

One of its solves finds the rotation of one stage at one angle by bisection on its torque: one
unknown, the disc's centre held. They are counted by wrapping `_solve_rotation` in a call that is
not timed.
"""

from __future__ import annotations

import json
import time

from cycloidgen.analysis import stiffness
from cycloidgen.core.spec import GearSpec

SPEC = GearSpec(
    pin_circle_radius=40.0,
    pin_radius=3.0,
    eccentricity=1.5,
    lobes=10,
    disc_thickness=8.0,
    disc_count=2,
    output_pin_count=6,
    output_pin_diameter=8.0,
    output_bolt_circle_radius=23.0,
    profile_clearance=0.006,
    hole_clearance=0.016,
    position_tolerance=0.002,
    disc_material="Steel 1045",
    pin_material="Steel 1045",
    output_torque_Nm=60.0,
)


def measured(function) -> dict[str, float]:
    """Best of five timed calls, and the solves of one that is not timed."""
    original, counted = stiffness._solve_rotation, [0]

    def counting(*arguments, **named):
        counted[0] += 1
        return original(*arguments, **named)

    stiffness._solve_rotation = counting
    function(SPEC)
    stiffness._solve_rotation = original
    best = float("inf")
    for _ in range(5):
        began = time.perf_counter()
        function(SPEC)
        best = min(best, time.perf_counter() - began)
    return {"seconds": best, "solves": counted[0]}


print(
    json.dumps(
        {
            "analyse_stiffness": measured(stiffness.analyse_stiffness),
            "analyse_transmission_error": measured(stiffness.analyse_transmission_error),
        }
    )
)
