"""What each client calls the rows of the actuator card."""

from __future__ import annotations

_LINK = "inertia of the link"
_LOAD = "load_friction_external, load_friction_motor"


NAMES: dict[str, dict[str, str]] = {
    "reduction": {
        "mujoco": "gear",
        "drake": "drake:gear_ratio",
        "pinocchio": "rotorGearRatio",
    },
    "torque_constant": {"mujoco": "motorconst (motor)", "bam": "kt (joint)"},
    "resistance": {"mujoco": "resistance", "bam": "R"},
    "inductance": {"mujoco": "inductance"},
    "supply_voltage": {
        "mujoco": "ctrlrange, controller Vmax",
        "bam": "max_volts of the actuator class",
    },
    "current_limit": {"mujoco": "saturation current", "bam": "max_amps of the actuator class"},
    "stall_torque": {
        "isaac_lab": "DCMotorCfg.saturation_effort",
        "mjlab": "saturation_effort",
        "mujoco": "nominal stall_torque (motor)",
    },
    "peak_torque": {
        "isaac_lab": "effort_limit, effort_limit_sim",
        "mjlab": "effort_limit",
        "mujoco": "saturation torque (motor)",
        "drake": "limit effort",
        "pinocchio": "upperEffortLimit",
        "genesis": "set_dofs_force_range",
    },
    "ideal_speed": {
        "isaac_lab": "DCMotorCfg.velocity_limit",
        "mjlab": "velocity_limit",
        "mujoco": "nominal no_load_speed (motor)",
    },
    "no_load_speed": {
        "isaac_lab": "velocity_limit_sim",
        "drake": "limit velocity",
        "pinocchio": "upperVelocityLimit",
    },
    "cogging": {"mujoco": "cogging (motor)"},
    "motor_side_inertia": {
        "isaac_lab": "armature (joint)",
        "mjlab": "armature (joint)",
        "mujoco": "armature (motor)",
        "drake": "drake:rotor_inertia (motor)",
        "pinocchio": "rotorInertia (motor), armature (joint)",
        "genesis": "set_dofs_armature (joint)",
    },
    "output_inertia": dict.fromkeys(
        ("isaac_lab", "mjlab", "mujoco", "drake", "pinocchio", "genesis"), _LINK
    ),
    "reflected_inertia": {"bam": "armature (joint)"},
    "motor_coulomb": {"mujoco": "lugre coulomb (motor)"},
    "motor_breakaway": {"mujoco": "lugre static (motor)"},
    "output_coulomb": {"mujoco": "lugre coulomb of a second dcmotor (joint)"},
    "coulomb": {
        "isaac_lab": "dynamic_friction",
        "mjlab": "frictionloss",
        "mujoco": "frictionloss of a joint",
        "pinocchio": "upperDryFrictionLimit",
        "genesis": "set_dofs_frictionloss",
        "bam": "friction_base",
    },
    "breakaway": {"isaac_lab": "friction", "bam": "friction_base + friction_stribeck"},
    "stribeck_speed": {"mujoco": "lugre stribeck (motor)", "bam": "dtheta_stribeck (joint)"},
    "bristle_deflection": {"mujoco": "lugre static/stiffness (motor)"},
    "bristle_damping": {"mujoco": "lugre damping (motor)"},
    "motor_viscous": {"mujoco": "damping (motor)"},
    "output_viscous": {"mujoco": "damping of a second dcmotor (joint)"},
    "viscous": {
        "isaac_lab": "viscous_friction",
        "mjlab": "viscous_damping",
        "mujoco": "damping of a joint",
        "drake": "dynamics damping",
        "pinocchio": "damping",
        "genesis": "set_dofs_damping",
        "bam": "friction_viscous",
    },
    "load_forward": {"bam": _LOAD},
    "load_backward": {"bam": _LOAD},
    "backlash": {"mujoco": "range of a second hinge"},
    "stiffness": {"mujoco": "solreflimit of the second hinge"},
    "ripple": {"mujoco": "cogging of passive dcmotors (joint)"},
    "position_gain": {
        "isaac_lab": "stiffness",
        "mjlab": "stiffness",
        "mujoco": "controller kp (motor)",
        "genesis": "set_dofs_kp",
    },
    "velocity_gain": {
        "isaac_lab": "damping",
        "mjlab": "damping",
        "mujoco": "controller kd (motor)",
        "genesis": "set_dofs_kv",
    },
    "delay": {
        "isaac_lab": "DelayedPDActuatorCfg.max_delay (steps)",
        "mjlab": "delay_max_lag (steps)",
        "mujoco": "delay, nsample",
        "bam": "command_delay",
    },
    "winding_to_housing": {"mujoco": "thermal resistance (sum)"},
    "housing_to_ambient": {"mujoco": "thermal resistance (sum)"},
    "winding_capacity": {"mujoco": "thermal timeconst (slower of two)"},
    "housing_capacity": {"mujoco": "thermal timeconst (slower of two)"},
    "reference_temperature": {"mujoco": "thermal reftemp"},
    "ambient": {"mujoco": "thermal ambient"},
}
"""Key of a row to client to name, with the side in brackets where the client is not plain."""
