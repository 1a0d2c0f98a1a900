"""Simulators that the actuator card speaks to: their names for things, and what they cannot say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import JointSide

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters


@dataclass(frozen=True)
class Client:
    """A simulator.

    Attributes
    ----------
    key, title : str
        For programs and for people.
    version : str
        Whose names these are.
    checked : str
        How they were checked.
    missing : str
        What of the card it cannot express.
    """

    key: str
    title: str
    version: str
    checked: str
    missing: str


_MECHANICS = "friction that grows with load, backlash, stiffness, ripple, heat"
CLIENTS = (
    Client(
        "mujoco",
        "MuJoCo",
        "4.0.0",
        "names and effect checked by running the model; see the MJCF export",
        "friction that grows with load, bandwidth of the current loop, variation of stiffness but "
        "for its torque, damping of the transmission",
    ),
    Client(
        "isaac_lab",
        "Isaac Lab",
        "2.3.2",
        "names read in the package's source, not run; release 3.0 writes actuator_effort_limit "
        "for effort_limit; friction and dynamic_friction are N m with Isaac Sim 5.0 and later, "
        "coefficients without unit with 4.5, where these values must not be used",
        f"{_MECHANICS}, voltage and current",
    ),
    Client(
        "mjlab",
        "mjlab",
        "1.6.0",
        "names read in the package's source, not run",
        f"{_MECHANICS}, breakaway; a robot's MJCF can hold the dcmotor of the MJCF export instead",
    ),
    Client(
        "drake",
        "Drake",
        "1.51.1",
        "names and values checked by parsing the URDF export",
        f"{_MECHANICS}, Coulomb friction of a joint, torque over speed",
    ),
    Client(
        "pinocchio",
        "Pinocchio",
        "4.1.0",
        "names and values of the limits, friction and damping checked by parsing the URDF export; "
        "rotorInertia, rotorGearRatio and armature exist but are not read from a URDF: set them, "
        "either the first two or the last",
        f"{_MECHANICS}, torque over speed",
    ),
    Client(
        "genesis",
        "Genesis",
        "1.4.5",
        "names read in the package's source, not run",
        f"{_MECHANICS}, breakaway, torque over speed",
    ),
    Client(
        "bam",
        "BAM",
        "github.com/Rhoban/bam, 2026",
        "names read in its source; see the BAM export",
        "backlash, stiffness, ripple, cogging, inductance, heat",
    ),
)


def client_settings(
    parameters: ActuatorParameters, side: JointSide
) -> dict[str, dict[str, dict[str, object]]]:
    """Return client to configuration to setting to value, ready to be copied.

    Values stand at the joint, but for those of `mujoco`'s dcmotor and Drake's rotor inertia.
    """
    drive, motor = parameters.drive, parameters.motor
    gains: dict[str, object] = {
        "stiffness": drive.position_gain,
        "damping": drive.velocity_gain,
    }
    isaac = {
        **gains,
        "armature": side.motor_inertia,
        "friction": side.breakaway,
        "dynamic_friction": side.coulomb,
        "viscous_friction": side.viscous,
    }
    return {
        "mujoco": {
            "dcmotor": {
                "gear": side.reduction,
                "motorconst": motor.torque_constant,
                "resistance": motor.resistance,
                "armature": parameters.motor_side_inertia,
            },
            "motor and joint": {
                "motor.gear": 1.0,
                "motor.ctrlrange upper, lower its negative": side.peak_torque,
                "joint.armature": side.motor_inertia,
                "joint.damping": side.viscous,
                "joint.frictionloss": side.coulomb,
            },
        },
        "isaac_lab": {
            "DCMotorCfg": {
                "saturation_effort": side.stall_torque,
                "effort_limit": side.peak_torque,
                "velocity_limit": side.ideal_speed,
                **isaac,
            },
            "ImplicitActuatorCfg": {
                "effort_limit_sim": side.peak_torque,
                "velocity_limit_sim": side.no_load_speed,
                **isaac,
            },
        },
        "mjlab": {
            "DcMotorActuatorCfg": {
                "saturation_effort": side.stall_torque,
                "effort_limit": side.peak_torque,
                "velocity_limit": side.ideal_speed,
                **gains,
                "armature": side.motor_inertia,
                "frictionloss": side.coulomb,
                "viscous_damping": side.viscous,
            },
        },
        "drake": {
            "URDF": {
                "drake:rotor_inertia": parameters.motor_side_inertia,
                "drake:gear_ratio": side.reduction,
                "limit effort": side.peak_torque,
                "limit velocity": side.no_load_speed,
                "dynamics damping": side.viscous,
            },
        },
        "pinocchio": {
            "Model": {
                "rotorInertia": parameters.motor_side_inertia,
                "rotorGearRatio": side.reduction,
                "armature": side.motor_inertia,
                "upperEffortLimit": side.peak_torque,
                "upperVelocityLimit": side.no_load_speed,
                "upperDryFrictionLimit": side.coulomb,
                "damping": side.viscous,
            },
        },
        "genesis": {
            "RigidEntity": {
                "set_dofs_kp": drive.position_gain,
                "set_dofs_kv": drive.velocity_gain,
                "set_dofs_force_range upper, lower its negative": side.peak_torque,
                "set_dofs_armature": side.motor_inertia,
                "set_dofs_damping": side.viscous,
                "set_dofs_frictionloss": side.coulomb,
            },
        },
        "bam": {
            "m5": {
                "kt": side.torque_constant,
                "R": motor.resistance,
                "armature": side.reflected_inertia,
                "friction_base": side.coulomb,
                "friction_stribeck": side.breakaway - side.coulomb,
                "friction_viscous": side.viscous,
                "dtheta_stribeck": side.stribeck_speed,
            },
        },
    }
