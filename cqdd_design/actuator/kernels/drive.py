"""Compiled command, current and heat of the motor."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.laws import part

COPPER, MAGNET = 0.0039, 0.0011
"""Resistance gained and torque constant lost a kelvin, as in :mod:`cqdd_design.actuator.motor`."""
OPEN, VOLTAGE, CURRENT, IMPEDANCE = 0, 1, 2, 4
"""Places in `columns.MODES`."""


class Wanted(NamedTuple):
    """The command's signal in a step, its rate, and the torque fed forward."""

    value: float
    rate: float
    feedforward: float


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
def commanded(p: Any, control: Any, wanted: Any, h: float, angle: float, speed: float) -> Any:
    """Control with the command of a step; a position loop acts once a period of its own."""
    command, count, integral, elapsed = control
    if p.mode >= IMPEDANCE:
        first = elapsed < 0.0
        elapsed += h / p.control_step
        if elapsed >= 1.0 - 1e-9 or first:
            encoder = p.encoder_count
            seen = angle
            if encoder > 0.0:
                seen = math.floor(angle * encoder / (2.0 * math.pi) + 0.5)
                seen *= 2.0 * math.pi / encoder
            count_before, count = count, seen / p.ratio
            if first:
                count_before = count
            rate = speed / p.ratio
            if encoder > 0.0:
                rate = (count - count_before) / p.control_step
            behind = wanted.value - count
            if p.mode == IMPEDANCE:
                behind_rate = wanted.rate - rate
                command = p.position_gain * behind + p.velocity_gain * behind_rate
            else:
                integral += p.integral_gain * behind * p.control_step
                most = p.current_limit * p.torque_constant * abs(p.ratio)
                integral = min(max(integral, -most), most)
                command = p.position_gain * behind - p.velocity_gain * rate + integral
            command += wanted.feedforward
            elapsed = 0.0 if first else elapsed - 1.0
    else:
        command = wanted.value
    return Control(command, count, integral, elapsed)


@part
def asked_of_winding(p: Any, command: float) -> Any:
    """Voltage or current that a command stands for."""
    if p.mode <= CURRENT:
        return command
    return command / (p.ratio * p.torque_constant)


@part
def driven_current(
    p: Any,
    h: float,
    asked: float,
    current: float,
    winding: float,
    housing: float,
    guess: float,
) -> Any:
    """Current, voltage and torque of a step whose mean speed is guessed."""
    inductance, decay, mode = p.inductance, p.current_decay, p.mode
    resistance = p.resistance * (1.0 + COPPER * (winding - p.reference_temperature))
    constant = p.torque_constant * (1.0 - MAGNET * (housing - p.reference_temperature))
    limit = p.current_limit
    if winding > p.derating_begins:
        over = min((winding - p.derating_begins) / p.derating_span, 1.0)
        held = min(p.held_current, p.current_limit)
        limit = p.current_limit + over * (held - p.current_limit)
    back = constant * guess
    regulated, mean_current, voltage = False, 0.0, 0.0
    reluctance = 2.0 * inductance / h
    if mode == VOLTAGE:
        voltage = min(max(asked, -p.supply_voltage), p.supply_voltage)
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
        regulated = abs(voltage) <= p.supply_voltage
        if not regulated:
            voltage = math.copysign(p.supply_voltage, voltage)
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
def ended_current(p: Any, electric: Any, h: float, current: float, x: float) -> Any:
    """Current at the end of a step of mean speed x, its mean, and the mean voltage."""
    mean_current, voltage, new_current = electric.mean_current, electric.voltage, current
    if p.mode != OPEN:
        if not electric.regulated:
            mean_current = (
                electric.reluctance * current + electric.voltage - electric.constant * x
            ) / (electric.reluctance + electric.resistance)
        new_current = 2.0 * mean_current - current
        if p.inductance == 0.0 and not (electric.regulated and p.mode >= CURRENT):
            new_current = mean_current
        if electric.regulated:
            voltage = (
                p.inductance * (new_current - current) / h
                + electric.resistance * mean_current
                + electric.constant * x
            )
    return new_current, mean_current, voltage


@part
def warmed(p: Any, warmth: Any, heat_winding: float, heat_housing: float) -> Any:
    """Temperatures of winding and housing a step on, deg C; heats in W.

    Exact for heats that stay the same over the step: T' = exp(A h) T + (A^-1 (exp(A h) - 1)) q.
    """
    winding, housing = warmth
    heat_housing += p.cooling
    warmer = (
        p.winding_kept * winding
        + p.winding_from_housing * housing
        + p.winding_heated * heat_winding
        + p.winding_by_housing_heat * heat_housing
    )
    housing = (
        p.housing_from_winding * winding
        + p.housing_kept * housing
        + p.housing_by_winding_heat * heat_winding
        + p.housing_heated * heat_housing
    )
    return warmer, housing
