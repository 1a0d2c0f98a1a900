"""Command, current and heat of the motor in plain numpy."""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.actuator.columns import Constants
from cqdd_design.actuator.motor import MAGNET_COEFFICIENT
from cqdd_design.actuator.parameters import FloatArray
from cqdd_design.catalog.motors import COPPER_COEFFICIENT


class PositionLoop:
    """The loop of impedance and position control, acting once a period of its own."""

    def __init__(self, p: Constants, mode: str) -> None:
        self.p, self.mode = p, mode
        self.command = self.integral = self.count = 0.0
        self.elapsed, self.first = 1.0, True

    def act(
        self, h: float, angle: float, speed: float, wanted: tuple[float, float, float]
    ) -> float:
        """Torque at the output, N m; wanted angle, speed and torque besides."""
        p = self.p
        self.elapsed += h / p.control_step
        if self.elapsed < 1.0 - 1e-9 and not self.first:
            return self.command
        seen, rate = angle, speed / p.ratio
        if p.encoder_count:
            mark = 2.0 * math.pi / p.encoder_count
            seen = math.floor(seen / mark + 0.5) * mark
        former, self.count = self.count, seen / p.ratio
        if p.encoder_count:
            rate = 0.0 if self.first else (self.count - former) / p.control_step
        behind = wanted[0] - self.count
        command = p.position_gain * behind + wanted[2]
        if self.mode == "impedance":
            command += p.velocity_gain * (wanted[1] - rate)
        else:
            most = p.current_limit * p.torque_constant * abs(p.ratio)
            self.integral += p.integral_gain * behind * p.control_step
            self.integral = float(np.clip(self.integral, -most, most))
            command += self.integral - p.velocity_gain * rate
        self.elapsed = 0.0 if self.first else self.elapsed - 1.0
        self.first, self.command = False, command
        return command


def asked_of_winding(p: Constants, mode: str, command: float) -> float:
    """Voltage or current that a command stands for."""
    if mode in ("open", "voltage", "current"):
        return command
    return command / (p.ratio * p.torque_constant)


def driven_current(
    p: Constants,
    h: float,
    current: float,
    heat: FloatArray,
    guess: float,
    asked: float,
    mode: str,
) -> dict[str, float]:
    """Torque of the motor over its mean speed, and how the current is set."""
    over = np.clip((heat[0] - p.derating_begins) / p.derating_span, 0.0, 1.0)
    held_current = min(p.held_current, p.current_limit)
    limit = float(p.current_limit + over * (held_current - p.current_limit))
    resistance = p.resistance * (
        1.0 + COPPER_COEFFICIENT * (float(heat[0]) - p.reference_temperature)
    )
    constant = p.torque_constant * (
        1.0 - MAGNET_COEFFICIENT * (float(heat[1]) - p.reference_temperature)
    )
    reluctance = 2.0 * p.inductance / h
    back = constant * guess
    electric = {"resistance": resistance, "constant": constant, "reluctance": reluctance}
    mean, voltage, regulated = 0.0, 0.0, False
    if mode == "voltage":
        voltage = float(np.clip(asked, -p.supply_voltage, p.supply_voltage))
        mean = (reluctance * current + voltage - back) / (reluctance + resistance)
        if abs(mean) > limit:
            bounded, regulated = math.copysign(limit, mean), True
            ending = current + (bounded - current) * (1.0 - p.current_decay)
            mean = 0.5 * (current + ending) if p.inductance else bounded
    elif mode != "open":
        asked = float(np.clip(asked, -limit, limit))
        ending = asked + (current - asked) * p.current_decay
        mean = 0.5 * (current + ending)
        voltage = p.inductance * (ending - current) / h + resistance * mean + back
        regulated = abs(voltage) <= p.supply_voltage
        if not regulated:
            voltage = math.copysign(p.supply_voltage, voltage)
    whole = reluctance + resistance
    drive, slope = constant * mean, 0.0
    if mode != "open" and not regulated:
        drive = constant * (reluctance * current + voltage) / whole
        slope = constant**2 / whole
    electric |= {"mean": mean, "voltage": voltage, "regulated": float(regulated)}
    return electric | {"drive": drive, "drive_slope": slope}


def ended_current(
    p: Constants, electric: dict[str, float], h: float, current: float, x: float
) -> tuple[float, float, float]:
    """Current at the end of a step of mean speed x, its mean, and the mean voltage."""
    mean, voltage = electric["mean"], electric["voltage"]
    if not p.mode:
        return current, mean, voltage
    whole = electric["reluctance"] + electric["resistance"]
    if not electric["regulated"]:
        mean = electric["reluctance"] * current + voltage - electric["constant"] * x
        mean /= whole
    new = 2.0 * mean - current
    if p.inductance == 0.0 and not (electric["regulated"] and p.mode >= 2):
        new = mean
    if electric["regulated"]:
        voltage = p.inductance * (new - current) / h + electric["resistance"] * mean
        voltage += electric["constant"] * x
    return new, mean, voltage


def warmed(p: Constants, heat: FloatArray, heat_winding: float, heat_housing: float) -> FloatArray:
    """Temperatures of winding and housing a step on, deg C; heats in W."""
    heats = np.array([heat_winding, heat_housing + p.cooling])
    kept = np.array(
        [
            [p.winding_kept, p.winding_from_housing],
            [p.housing_from_winding, p.housing_kept],
        ]
    )
    heated = np.array(
        [
            [p.winding_heated, p.winding_by_housing_heat],
            [p.housing_by_winding_heat, p.housing_heated],
        ]
    )
    return np.asarray(kept @ heat + heated @ heats)
