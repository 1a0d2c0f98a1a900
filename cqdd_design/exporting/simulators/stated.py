"""What files for simulators state beside numbers: who wrote them, and where values come from."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.machine.overload import Overload, overload
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.exporting.job import ExportJob

DEAD_MASS = 1e-3
"""kg for the output body of a model, as clients refuse zero; its mass is in the housing's. Without
effect, since its centre lies on the axis."""


@lru_cache(maxsize=16)
def effort_limit(parameters: ActuatorParameters) -> float:
    """What the output gives at most, N m: the bench's stall torque, after friction.

    K I n promises a policy torque that friction under load keeps in the gearbox.
    """
    # Here because the simulation's kernels load with it.
    from cqdd_design.actuator.bench.steady import stall_torque

    return stall_torque(parameters).value


def mass_remark(parameters: ActuatorParameters) -> str:
    """Where the mass of an actuator's own model stands, in a sentence."""
    return (
        f"Mass: {DEAD_MASS:g} kg of the output is a placeholder, since clients refuse none. All of "
        f"the actuator, {parameters.mass:.4g} kg, is in the housing, what turns with the output "
        "included; the mass of what is driven belongs into the output's link."
    )


def peak_limit(parameters: ActuatorParameters) -> str:
    """Where the peak torque ends, for a sentence."""
    if parameters.peak_current < parameters.drive.current_limit:
        amperes = f"{parameters.peak_current:.4g} of the drive's {parameters.drive.current_limit:g}"
        return f"the motor's own peak torque, {amperes} A"
    return "the drive's current limit"


def effort_overload(job: ExportJob) -> Overload | None:
    """What the gearbox does not carry of the effort that a job's files allow."""
    return overload(job.machine, effort_limit(job.actuator))


def overload_remark(beyond: Overload | None) -> str:
    """What the gearbox does not carry of the effort limit, in sentences; empty where it does."""
    if beyond is None:
        return ""
    return (
        f"Motor and drive give up to {beyond.torque:.3g} N*m, the effort limit in these "
        f"files; {beyond.told}. Keep commands and shocks below what it carries, in training too."
    )


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
