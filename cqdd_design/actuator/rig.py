"""What holds the output on a test bench, and is no part of the actuator."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.errors import DesignError

SENSOR_TWIST = 4e-3
"""Of a torque sensor at its rated torque, rad: a shaft of two diameters' length whose surface
shears by 1e-3, as strain gauges for 2 mV/V want."""


@dataclass(frozen=True)
class RigParameters:
    """A rig.

    Attributes
    ----------
    stiffness : float
        N m/rad; 0 for that of a torque sensor rated for what the driver's limit gives.
    """

    stiffness: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a stiffness that is none."""
        if not (math.isfinite(self.stiffness) and self.stiffness >= 0.0):
            raise DesignError(
                f"rig.stiffness {self.stiffness:g} is not finite and 0 or more; 0 is a torque "
                "sensor's."
            )
