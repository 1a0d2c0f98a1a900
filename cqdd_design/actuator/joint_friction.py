"""What friction leaves of the motor's torque at the joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import motor_coulomb

if TYPE_CHECKING:
    from cqdd_design.actuator.joint_side import JointSide
    from cqdd_design.actuator.parameters import ActuatorParameters


def delivered_peak_torque(parameters: ActuatorParameters, side: JointSide) -> float:
    """Peak torque at the joint in slow motion, N m; 0 where friction holds the motor.

    Of the motor's torque at the current limit its Coulomb friction is taken off; of the rest the
    gear passes on T where T (1 + f) comes in, and the output side's Coulomb friction takes the
    last part.
    """
    friction = parameters.friction
    carried = side.peak_torque - side.reduction * motor_coulomb(parameters)
    carried /= 1.0 + friction.load_forward
    return max(carried - friction.output_coulomb, 0.0)


def held_back_torque(parameters: ActuatorParameters, side: JointSide) -> float:
    """Friction under load on a locked output at the current limit, N m at the joint.

    With the coefficient F at rest, which exceeds that in motion by the Stribeck share, T (1 + F)
    of the motor holds T at the output: F/(1 + F) of the peak torque is lost.
    """
    friction = parameters.friction
    load = friction.load_forward * (1.0 + friction.stribeck_extra)
    return side.peak_torque * load / (1.0 + load)
