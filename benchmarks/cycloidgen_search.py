"""A quick search by cycloidgen, for `processes.py`; runs in cycloidgen's own environment.

The job is that of `cqdd-design size --ratio 10` as far as cycloidgen can state it: ratio, speed,
hardened 4140 discs, aluminium housing, wire EDM. At 5 N·m its quick search finds designs; at the
torque of our default it rejects every candidate early and ends sooner.
"""

import json
from importlib import metadata

from cycloidgen.design.optimize import Requirements, optimise

TORQUE = 5.0

found = optimise(
    Requirements(
        ratio=10,
        output_torque_Nm=TORQUE,
        input_rpm=1286,
        disc_material="Steel 4140 (hardened)",
        housing_material="Aluminium 7075-T6",
        process="Wire EDM / ground",
    ),
    effort="quick",
)
print(
    json.dumps(
        {
            "version": metadata.version("cycloidgen"),
            "torque_Nm": TORQUE,
            "evaluations": found.evaluations,
            "designs": len(found.best),
        }
    )
)
