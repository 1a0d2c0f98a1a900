"""Compiled accounts of a run: what a step turns into heat, sums of energy, records."""

from __future__ import annotations

from typing import Any, NamedTuple

from cqdd_design.actuator.columns import Ledger
from cqdd_design.actuator.kernels.laws import part
from cqdd_design.actuator.kernels.loads import stored_energy


class Outcome(NamedTuple):
    """Mean values of a step, solved: friction, torque from outside, current and voltage."""

    friction: float
    output_friction: float
    external: float
    mean_current: float
    voltage: float


class Heat(NamedTuple):
    """Power lost in copper, W; energy lost in iron and by friction of motor and output, J."""

    copper: float
    iron: float
    rubbed: float
    output_rubbed: float


@part
def heated(p: Any, h: float, begin: Any, found: Any, out: Any) -> Any:
    """Where the energy of a step turns into heat."""
    x, y, level = found.x, found.y, begin.rub.level
    copper = begin.electric.resistance * out.mean_current * out.mean_current
    rubbed_dry = out.friction * x * h
    share_iron = 0.0
    if level > 0.0:
        share_iron = p.hysteresis / level
    iron = p.iron_viscous * x * x * h + share_iron * rubbed_dry
    own_viscous = p.motor_viscous + p.iron_viscous - p.iron_viscous
    rubbed_now = own_viscous * x * x * h + (1.0 - share_iron) * rubbed_dry
    out_rubbed = p.output_viscous * y * y * h + out.output_friction * y * h
    return Heat(copper, iron, rubbed_now, out_rubbed)


@part
def tallied(
    p: Any, h: float, sums: Any, begin: Any, found: Any, out: Any, heat: Any, damped: float
) -> Any:
    """Sums of a run with those of a step; `damped` is the whole loss in the mesh by now, J."""
    y, power_in = found.y, out.voltage * out.mean_current
    on_load = (p.sensor_damping + p.load_viscous) * y * y * h
    return Ledger(
        sums.electrical + power_in * h,
        sums.copper + heat.copper * h,
        sums.iron + heat.iron,
        sums.motor_friction + heat.rubbed,
        sums.output_friction + heat.output_rubbed,
        damped,
        sums.load_damping + (on_load + found.wall_rub * p.wall_side * y * h),
        sums.external + out.external * y * h,
        sums.throughput + (abs(power_in) + abs(out.external * y)) * h,
        sums.stored_before,
        0.0,
        sums.unsettled + (0.0 if found.last.settled else 1.0),
    )


@part
def recorded(
    p: Any, h: float, state: Any, begin: Any, found: Any, out: Any, traces: Any, i: int, record: int
) -> None:
    """Write one record of actuator `i`: the state at the step's end, and the step's means."""
    motion = state.motion
    flange = found.torque - out.output_friction - p.output_viscous * found.y
    flange -= p.output_inertia * (motion.out_speed - begin.motion.out_speed) / h
    own_viscous = p.motor_viscous + p.iron_viscous - p.iron_viscous
    traces.motor_angle[i, record] = motion.angle
    traces.motor_speed[i, record] = motion.speed
    traces.output_angle[i, record] = motion.out_angle
    traces.output_speed[i, record] = motion.out_speed
    traces.current[i, record] = state.current
    traces.voltage[i, record] = out.voltage
    traces.deflection[i, record] = state.mesh.closing
    traces.gear_torque[i, record] = found.torque
    traces.output_torque[i, record] = flange
    traces.motor_friction[i, record] = out.friction + own_viscous * found.x
    traces.output_friction[i, record] = out.output_friction + p.output_viscous * found.y
    traces.winding_temperature[i, record], traces.housing_temperature[i, record] = state.warmth


@part
def closed(p: Any, state: Any, sums: Any, ledger: Any, i: int) -> None:
    """Write the sums of a run; what its bristles still hold is stored, not lost."""
    z, output_z = state.bristles
    kept = 0.5 * p.motor_bristle * z * z
    output_kept = 0.5 * p.output_bristle * output_z * output_z
    ledger.electrical[i] = sums.electrical
    ledger.copper[i] = sums.copper
    ledger.iron[i] = sums.iron
    ledger.motor_friction[i] = sums.motor_friction - kept
    ledger.output_friction[i] = sums.output_friction - output_kept
    ledger.gear_damping[i] = sums.gear_damping
    ledger.load_damping[i] = sums.load_damping
    ledger.external[i] = sums.external
    ledger.throughput[i] = sums.throughput
    ledger.stored_before[i] = sums.stored_before
    ledger.stored_after[i] = stored_energy(
        p, state.motion, state.current, state.mesh, state.wall.energy, kept + output_kept
    )
    ledger.unsettled[i] = sums.unsettled
