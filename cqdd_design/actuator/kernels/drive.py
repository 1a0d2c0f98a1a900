"""Compiled command, current and heat of the motor; :mod:`..twin.drive` is the same in numpy."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.laws import at, part

COPPER, MAGNET = 0.0039, 0.0011
"""Resistance gained and torque constant lost a kelvin, as in :mod:`cqdd_design.actuator.motor`."""
OPEN, VOLTAGE, CURRENT, IMPEDANCE = 0, 1, 2, 4
"""Places in `columns.MODES`."""


class Drive(NamedTuple):
    """Winding and electronics; names as in `columns.PARAMETERS`."""

    ratio: float
    torque_constant: float
    resistance: float
    inductance: float
    reference_temperature: float
    supply_voltage: float
    current_limit: float
    current_decay: float
    control_step: float
    encoder_count: float
    position_gain: float
    velocity_gain: float
    integral_gain: float
    held_current: float
    derating_begins: float
    derating_span: float
    mode: int


class Control(NamedTuple):
    """State of the position loop; `elapsed` counts its periods and is below 0 before the first."""

    command: float
    counted: float
    integral: float
    elapsed: float


class Electric(NamedTuple):
    """The winding in a step: torque over the mean speed is ``torque - slope x``."""

    resistance: float
    constant: float
    reluctance: float
    mean_current: float
    voltage: float
    regulated: bool
    torque: float
    slope: float


@part
def drive_of(p: Any) -> Any:
    """Drive from a row of parameters."""
    return Drive(
        p[0],
        p[1],
        p[2],
        p[3],
        p[9],
        p[10],
        p[11],
        p[12],
        p[13],
        p[14],
        p[15],
        p[16],
        p[17],
        p[18],
        p[19],
        p[20],
        int(p[58]),
    )


@part
def commanded(
    drive: Any,
    control: Any,
    h: float,
    angle: float,
    speed: float,
    reference: Any,
    reference_rate: Any,
    feedforward: Any,
    k: int,
) -> Any:
    """Control with the command of step k; a position loop acts once a period of its own."""
    command, count, integral, elapsed = control
    wanted = at(reference, k)
    if drive.mode >= IMPEDANCE:
        first = elapsed < 0.0
        elapsed += h / drive.control_step
        if elapsed >= 1.0 - 1e-9 or first:
            encoder = drive.encoder_count
            seen = angle
            if encoder > 0.0:
                seen = math.floor(angle * encoder / (2.0 * math.pi) + 0.5)
                seen *= 2.0 * math.pi / encoder
            count_before, count = count, seen / drive.ratio
            if first:
                count_before = count
            rate = speed / drive.ratio
            if encoder > 0.0:
                rate = (count - count_before) / drive.control_step
            behind = wanted - count
            if drive.mode == IMPEDANCE:
                behind_rate = at(reference_rate, k) - rate
                command = drive.position_gain * behind + drive.velocity_gain * behind_rate
            else:
                integral += drive.integral_gain * behind * drive.control_step
                most = drive.current_limit * drive.torque_constant * abs(drive.ratio)
                integral = min(max(integral, -most), most)
                command = drive.position_gain * behind - drive.velocity_gain * rate + integral
            command += at(feedforward, k)
            elapsed = 0.0 if first else elapsed - 1.0
    else:
        command = wanted
    return Control(command, count, integral, elapsed)


@part
def asked_of_winding(drive: Any, command: float) -> Any:
    """Voltage or current that a command stands for."""
    if drive.mode <= CURRENT:
        return command
    return command / (drive.ratio * drive.torque_constant)


@part
def driven_current(
    drive: Any,
    h: float,
    asked: float,
    current: float,
    winding: float,
    housing: float,
    guess: float,
) -> Any:
    """Current, voltage and torque of a step whose mean speed is guessed."""
    inductance, decay, mode = drive.inductance, drive.current_decay, drive.mode
    resistance = drive.resistance * (1.0 + COPPER * (winding - drive.reference_temperature))
    constant = drive.torque_constant * (1.0 - MAGNET * (housing - drive.reference_temperature))
    limit = drive.current_limit
    if winding > drive.derating_begins:
        over = min((winding - drive.derating_begins) / drive.derating_span, 1.0)
        held = min(drive.held_current, drive.current_limit)
        limit = drive.current_limit + over * (held - drive.current_limit)
    back = constant * guess
    regulated, mean_current, voltage = False, 0.0, 0.0
    reluctance = 2.0 * inductance / h
    if mode == VOLTAGE:
        voltage = min(max(asked, -drive.supply_voltage), drive.supply_voltage)
        mean_current = (reluctance * current + voltage - back) / (reluctance + resistance)
        if abs(mean_current) > limit:
            bounded = math.copysign(limit, mean_current)
            mean_current = bounded
            if inductance != 0.0:
                ending = current + (bounded - current) * (1.0 - decay)
                mean_current = 0.5 * (current + ending)
            regulated = True
    elif mode >= CURRENT:
        bounded = min(max(asked, -limit), limit)
        ending = bounded + (current - bounded) * decay
        mean_current = 0.5 * (current + ending)
        voltage = inductance * (ending - current) / h + resistance * mean_current + back
        regulated = abs(voltage) <= drive.supply_voltage
        if not regulated:
            voltage = math.copysign(drive.supply_voltage, voltage)
    if mode == OPEN:
        torque, slope = 0.0, 0.0
    elif regulated:
        torque, slope = constant * mean_current, 0.0
    else:
        torque = constant * (reluctance * current + voltage) / (reluctance + resistance)
        slope = constant * constant / (reluctance + resistance)
    return Electric(
        resistance, constant, reluctance, mean_current, voltage, regulated, torque, slope
    )


@part
def ended_current(drive: Any, electric: Any, h: float, current: float, x: float) -> Any:
    """Current at the end of a step of mean speed x, its mean, and the mean voltage."""
    mean_current, voltage, new_current = electric.mean_current, electric.voltage, current
    if drive.mode != OPEN:
        if not electric.regulated:
            mean_current = (
                electric.reluctance * current + electric.voltage - electric.constant * x
            ) / (electric.reluctance + electric.resistance)
        new_current = 2.0 * mean_current - current
        if drive.inductance == 0.0 and not (electric.regulated and drive.mode >= CURRENT):
            new_current = mean_current
        if electric.regulated:
            voltage = (
                drive.inductance * (new_current - current) / h
                + electric.resistance * mean_current
                + electric.constant * x
            )
    return new_current, mean_current, voltage


@part
def warmed(p: Any, winding: float, housing: float, heat_winding: float, heat_housing: float) -> Any:
    """Temperatures of winding and housing a step on, deg C; heats in W."""
    heat_housing += p[56]
    warmer = p[48] * winding + p[49] * housing + p[52] * heat_winding + p[53] * heat_housing
    housing = p[50] * winding + p[51] * housing + p[54] * heat_winding + p[55] * heat_housing
    return warmer, housing
