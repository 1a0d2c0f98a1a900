"""Names that options take, for the shell's completion: their own rooms take numpy to read.

A test holds each against its room; a new name is added here too.
"""

MEASUREMENTS = (
    "continuous_torque",
    "peak_torque",
    "stall_torque",
    "no_load_speed",
    "rated_power",
    "output_resolution",
    "efficiency_peak",
    "torque_density",
    "actuator_inertia",
    "mass",
    "backlash",
    "backdrive_static",
    "backdrive_dynamic",
    "torque_ripple",
    "torque_bandwidth",
    "position_bandwidth_45deg",
    "position_bandwidth_5deg",
)
"""Rows of the bench's data sheet."""

UNKNOWNS = (
    "thermal_resistance",
    "motor_cogging",
    "motor_coulomb",
    "motor_viscous",
    "friction_load",
    "current_loop",
    "rig_stiffness",
    "tolerance_scale",
)
"""What `calibrate` fits."""

ESTIMATED = (
    "pva-gru",
    "pv-gru",
    "mlp",
    "mlp-baseline",
    "mlp-acceleration",
    "physics-gru",
    "phase-gru",
    "physics-phase-gru",
)
"""Networks that `torque train` knows."""

SETS = ("trajectory", "mass", "wall", "gearbox")
"""What may be held out of training."""

LOADS_BY_PLANETS = (
    "iso",
    "abs",
    "agma level 1",
    "agma level 2",
    "agma level 3",
    "agma level 4",
    "equal",
)
"""Tables of K_gamma of the planetary."""
