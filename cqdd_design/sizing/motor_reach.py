"""What a motor reaches through any gearbox at all, by its own figures."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cqdd_design.catalog.motors import COPPER_REFERENCE, MAGNET_COEFFICIENT, Motor
from cqdd_design.design import Requirements
from cqdd_design.design.actuator import Environment
from cqdd_design.design.motor import MotorTable
from cqdd_design.sizing.able import PEAK
from cqdd_design.sizing.infeasible import SizingInfeasibleError

PEAK_LINE, _DUTY_LINE = "MOTOR-PEAK", "DUTY-ENVELOPE"
_RPM = 30.0 / math.pi


class Reach(NamedTuple):
    """The most that a motor's figures, its driver and the supply allow.

    Attributes
    ----------
    torque : float
        At the shaft, N m; infinite where neither its constant nor its peak torque is known.
    current : float
        That makes it, A, unless the motor's own peak torque is less.
    speed : float
        Without load, rad/s; infinite where its constant is not known.
    voltage : float
        Of the supply, V.
    """

    torque: float
    current: float
    speed: float
    voltage: float


def reach(requirements: Requirements, motor: Motor, ambient: float | None) -> Reach:
    """The most torque and speed of a motor.

    So that no motor is lost which a closer model would pass, its magnets are as cold as the air for
    the torque where that is colder than its figures were taken at, and as warm as the winding may
    be for the speed: warm magnets turn faster.

    Parameters
    ----------
    ambient : float or None
        Of the air, deg C; None for that of a design that says nothing.
    """
    usual, constant = MotorTable(), motor.torque_constant
    voltage = requirements.voltage or usual.voltage
    limit = requirements.current or usual.current_limit
    if motor.line_resistance:
        limit = min(limit, voltage / motor.line_resistance)
    own = math.inf if motor.peak_torque is None else motor.peak_torque
    if constant is None:
        return Reach(own, limit, math.inf, voltage)
    air = Environment().ambient if ambient is None else ambient
    cold = 1.0 + MAGNET_COEFFICIENT * max(COPPER_REFERENCE - air, 0.0)
    warm = 1.0 - MAGNET_COEFFICIENT * (motor.winding_most - COPPER_REFERENCE)
    return Reach(min(own, cold * constant * limit), limit, voltage / (constant * warm), voltage)


class MotorShortError(SizingInfeasibleError):
    """The motor falls short of what is stated whatever the gearbox is.

    Attributes
    ----------
    torque : float
        Of the motor's shaft at most, N m.
    needed : float
        Torque at the output that this is too little for, N m; 0 where it is enough.
    most_ratio : int or None
        At which its rotor alone is light enough; None where it is.
    """

    def __init__(
        self,
        message: str,
        binding: tuple[str, ...],
        torque: float,
        needed: float,
        most_ratio: int | None,
    ) -> None:
        super().__init__(message, binding=binding, most_torque=None)
        self.torque, self.needed, self.most_ratio = torque, needed, most_ratio


def refuse_weak_motor(requirements: Requirements, motor: Motor, ambient: float | None) -> None:
    """Raise where a motor cannot do what is stated even through a gearbox without losses or mass.

    Raises
    ------
    MotorShortError
    """
    most, ratio = reach(requirements, motor, ambient), requirements.ratio
    peak, fast = requirements.peak_torque, requirements.input_speed
    told, binding, needed = [], [], 0.0
    why = "its own peak torque"
    if motor.peak_torque is None or most.torque < motor.peak_torque:
        why = f"{most.current:.4g} A"

    def weak(torque: float, of: str) -> str:
        return (
            f"{most.torque:.4g} N*m at the shaft ({why}) are {ratio * most.torque:.4g} of {of}"
            f"{torque:g} N*m at ratio {ratio} without any loss in the gearbox"
        )

    def slow(speed: float, of: str) -> str:
        return (
            f"{most.voltage:g} V turn it at {most.speed * _RPM:.0f} of {of}{speed * _RPM:.0f} rpm "
            "at most, warm and without load"
        )

    if PEAK not in requirements.derived and ratio * most.torque < peak:
        binding.append(PEAK_LINE)
        needed = peak
        told.append(weak(peak, ""))
    if most.speed < fast:
        binding.append("MOTOR-SPEED")
        told.append(slow(fast, ""))
    driven, fastest = _driven(requirements)
    beyond = []
    if ratio * most.torque < driven:
        needed = max(needed, driven)
        beyond.append(weak(driven, "the duty's "))
    if most.speed < ratio * fastest:
        beyond.append(slow(ratio * fastest, "the duty's "))
    if beyond:
        binding.append(_DUTY_LINE)
        told += beyond
    heavy, light_at = _heavier(requirements, motor)
    told += heavy.values()
    binding += heavy
    if told:
        raise MotorShortError(
            f"no gearbox makes motor '{motor.name}' do what is asked: {'; '.join(told)}. "
            f"{_ways(binding, weak=needed > 0.0)}, or take another motor (--motor any tries all of "
            "the catalogue).",
            tuple(binding),
            most.torque,
            needed,
            light_at,
        )


def _driven(requirements: Requirements) -> tuple[float, float]:
    """Greatest torque (N m) and speed (rad/s) at the output of a duty that the motor has to drive.

    What brakes is held by friction as well, and may turn faster than a supply turns a motor.
    """
    log, steps = requirements.duty_log, requirements.duty
    if log is None:
        torque, speed = np.array([(one.torque, one.speed) for one in steps]).reshape(-1, 2).T
    else:
        torque, speed = log.torque, log.speed
    driving = torque * speed >= 0.0
    return (
        float(np.abs(torque[driving]).max(initial=0.0)),
        float(np.abs(speed[driving]).max(initial=0.0)),
    )


def _heavier(requirements: Requirements, motor: Motor) -> tuple[dict[str, str], int | None]:
    """By line, what of a motor alone is more than the whole actuator may have.

    And the greatest ratio at which its rotor is not.
    """
    told, light_at, ratio = {}, None, requirements.ratio
    inertia, rotor = requirements.reflected_inertia, motor.rotor_inertia
    if inertia is not None and rotor and ratio**2 * rotor > inertia:
        light_at = math.isqrt(math.floor(inertia / rotor))
        told["REFLECTED-INERTIA"] = (
            f"its rotor of {rotor:.4g} kg*m^2 alone is felt as {ratio**2 * rotor:.4g} of "
            f"{inertia:g} kg*m^2 at ratio {ratio}"
        )
    if requirements.mass is not None and motor.mass and motor.mass > requirements.mass:
        told["MASS"] = f"it weighs {motor.mass:.4g} of {requirements.mass:g} kg itself"
    return told, light_at


def _ways(binding: list[str], *, weak: bool) -> str:
    ways = []
    if weak:
        ways += ["ask for less torque", "raise the ratio"]
    elif _DUTY_LINE in binding:
        ways += ["ask for a slower duty", "lower the ratio"]
    elif "MOTOR-SPEED" in binding:
        ways += ["ask for less"]
    if "REFLECTED-INERTIA" in binding:
        ways += ["allow more inertia"]
        if not {"ask for less torque", "lower the ratio"} & set(ways):
            ways.append("lower the ratio")
    if "MASS" in binding:
        ways += ["allow more mass"]
    return ", ".join(ways).capitalize()
