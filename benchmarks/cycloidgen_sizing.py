"""The lightest of a quick search by cycloidgen, for `sizing_peer.py`; prints JSON.

Runs in cycloidgen's own environment: python cycloidgen_sizing.py RATIO TORQUE_NM INPUT_RPM.
"""

import json
import sys
import time

from cycloidgen.design.optimize import Objective, Requirements, optimise

began = time.perf_counter()
found = optimise(
    Requirements(
        ratio=int(sys.argv[1]),
        output_torque_Nm=float(sys.argv[2]),
        input_rpm=float(sys.argv[3]),
        max_outer_diameter_mm=120.0,
        max_length_mm=60.0,
        disc_material="Steel 4140 (hardened)",
        housing_material="Aluminium 7075-T6",
        process="Wire EDM / ground",
        objective=Objective.COMPACT,
    ),
    effort="quick",
)
lightest = min(found.best, key=lambda one: one.mass_g)
print(
    json.dumps(
        {
            "seconds": time.perf_counter() - began,
            "evaluations": found.evaluations,
            "mass_g": lightest.mass_g,
            "capacity_Nm": lightest.capacity_Nm,
            "outer_diameter_mm": lightest.outer_diameter_mm,
            "length_mm": lightest.length_mm,
        }
    )
)
