"""Friction and motor as a parameter file of BAM (Better Actuator Models, Rhoban): model m5.

BAM sees the joint alone. Motor torque ``m`` and outer torque ``x`` there, both positive with
the joint, give the budget of friction that may stop the motion::

    friction_base + friction_viscous |w|
        + friction_stribeck exp(-(|w|/dtheta_stribeck)^alpha)
        + |x load_friction_external - m load_friction_motor|
        + |x load_friction_external_stribeck - m load_friction_motor_stribeck|
          exp(-(|w|/dtheta_stribeck)^alpha)

Ours grows with the torque T that the gear carries to the output, by one coefficient when the motor
drives (T = -x, m = T (1 + F)) and by another when the output drives (T = x, m = -T (1 - B)), where
F and B exceed their values in motion, f and b, by the same share s at rest. Steady motion under
load fixes BAM's coefficients::

    load_friction_motor             = k = (f - b)/(f + b)
    load_friction_external          = f - (1 + f) k
    load_friction_external_stribeck = s f (1 - k)
    load_friction_motor_stribeck    = 0

They agree with ours exactly on these two lines at any speed; in between, with the joint
accelerating, BAM counts the motor's torque where ours counts the gear's. The first is negative
where f < b, outside of the range in which BAM's own fit searches but read by it like any other.

Names and budget: bam/model.py, bam/simulate.py and bam/erob/actuator.py of github.com/Rhoban/bam.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import joint_side
from cqdd_design.exporting.simulators.stated import (
    effort_limit,
    effort_overload,
    overload_remark,
    provenance,
)
from cqdd_design.files import WrittenFile, write_atomically

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine.overload import Overload

UNITS = {
    "kt": "N m/A = V s/rad",
    "R": "ohm",
    "armature": "kg m^2",
    "friction_base": "N m",
    "friction_stribeck": "N m",
    "friction_viscous": "N m s/rad",
    "load_friction_motor": "1",
    "load_friction_external": "1",
    "load_friction_motor_stribeck": "1",
    "load_friction_external_stribeck": "1",
    "dtheta_stribeck": "rad/s",
    "alpha": "1",
    "q_offset": "rad",
    "command_delay": "s",
}
"""Of every number that BAM reads, all at the joint."""


def export_bam(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-bam.json``."""
    document = bam_document(
        job.actuator,
        job.design.file_name,
        design_sha256=job.design.sha256,
        beyond=effort_overload(job),
    )
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    return (write_atomically(job.path("-bam.json"), text, "bam"),)


def load_coefficients(forward: float, backward: float, extra: float) -> dict[str, float]:
    """Return BAM's load coefficients for ours.

    Parameters
    ----------
    forward, backward : float
        Friction over carried torque when the motor drives and when the output drives.
    extra : float
        Share by which friction at rest exceeds that in motion.
    """
    whole = forward + backward
    motor = (forward - backward) / whole if whole > 0.0 else 0.0
    return {
        "load_friction_motor": motor,
        "load_friction_external": forward - (1.0 + forward) * motor,
        "load_friction_motor_stribeck": 0.0,
        "load_friction_external_stribeck": extra * forward * (1.0 - motor),
    }


def bam_document(
    parameters: ActuatorParameters,
    name: str,
    *,
    design_sha256: str = "not given",
    beyond: Overload | None = None,
) -> dict[str, object]:
    """Return the file's content; keys with an underscore are notes that BAM does not read."""
    side = joint_side(parameters)
    drive, friction = parameters.drive, parameters.friction
    return {
        "kt": side.torque_constant,
        "R": side.resistance,
        "armature": side.reflected_inertia,
        "q_offset": 0.0,
        "command_delay": drive.delay,
        "friction_base": side.coulomb,
        "friction_stribeck": side.breakaway - side.coulomb,
        **load_coefficients(friction.load_forward, friction.load_backward, friction.stribeck_extra),
        "dtheta_stribeck": side.stribeck_speed,
        "alpha": 2.0,
        "friction_viscous": side.viscous,
        "model": "m5",
        "actuator": name,
        "_provenance": provenance(design_sha256),
        "_units": dict(UNITS),
        "_limits": {
            "max_volts_V": drive.supply_voltage,
            "max_amps_A": drive.current_limit,
            "peak_torque_Nm": side.peak_torque,
            "effort_limit_Nm": effort_limit(parameters),
            "no_load_speed_rad_per_s": side.no_load_speed,
            **({"gearbox_carries_Nm": beyond.carried} if beyond else {}),
        },
        "_notes": [
            "All at the joint, positive command with positive motion; the gearbox has signed ratio "
            f"{parameters.gear.ratio:g}.",
            "BAM looks up 'actuator' in its own table: register a class there under this name that "
            "computes torque from current with the limits above, as its Erob does.",
            *([overload_remark(beyond)] if beyond else []),
            f"kt and R are those at {parameters.thermal.ambient:g} degC around the actuator.",
            "armature is the whole reflected inertia, that of the output side included.",
            "Not in this file, because BAM has no place for it: backlash, stiffness, ripple, "
            "cogging, inductance, heat; friction under load that grows faster above "
            f"{friction.load_knee:g} N m, by {friction.load_growth:.3g} of itself.",
        ],
    }
