"""What files for simulators state beside numbers: who wrote them, and where values come from."""

from __future__ import annotations

from cqdd_design import __version__
from cqdd_design.actuator.parameters import ActuatorParameters

DEAD_MASS = 1e-3
"""kg for the output body of a model, as clients refuse zero; its mass is in the housing's. Without
effect, since its centre lies on the axis."""


def value_of(parameters: ActuatorParameters, name: str) -> float:
    """Value of a dotted name such as ``motor.resistance``."""
    found: object = parameters
    for part in name.split("."):
        found = getattr(found, part)
    return float(found)  # type: ignore[arg-type]


def origin_of(parameters: ActuatorParameters, *names: str) -> str:
    """Where the named values come from, each with its name when there are several."""
    told = [(name, parameters.origins.get(name, "not stated")) for name in names]
    if len({origin for _, origin in told}) == 1:
        return told[0][1]
    return "; ".join(f"{name}: {origin}" for name, origin in told)


def provenance(design_sha256: str) -> str:
    """Which version of this package wrote a file, and for which design."""
    return f"cqdd-design {__version__}, design sha256 {design_sha256}"
