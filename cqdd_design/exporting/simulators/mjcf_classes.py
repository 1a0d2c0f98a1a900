"""Default classes of an actuator in MJCF, and the remarks in the head of its files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import (
    JointSide,
    RippleHarmonic,
    held_back_torque,
    joint_side,
    motor_breakaway,
    motor_coulomb,
    motor_viscous,
    ripple_harmonics,
    ripple_rms,
)
from cqdd_design.actuator.thermal import single_node
from cqdd_design.catalog.motors import COPPER_COEFFICIENT
from cqdd_design.exporting.simulators.stated import (
    effort_limit,
    overload_remark,
    peak_limit,
    provenance,
)
from cqdd_design.exporting.simulators.xml_text import element, identifier, number, numbers

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters, FrictionParameters
    from cqdd_design.machine.overload import Overload

LEAST_RIPPLE = 0.01
"""Harmonics below this share of the largest are left out: each is an actuator to be stepped."""
HOST_STEP = 2e-3
"""MuJoCo's own time step, s, which a robot that includes the classes is taken to use."""
LONGEST_STEP = 5e-4
"""s."""
STEP_FRACTION = 0.5
"""Most that the fastest oscillation of a model may turn in a step, rad."""
DAMPING_INERTIA = 1e-3
"""Most that the bristles' damping may add to the inertia that they hold, as a share."""


@dataclass(frozen=True, eq=False)
class MjcfActuator:
    """An actuator with all that its files need.

    Attributes
    ----------
    name : str
        As given, made fit for an attribute.
    backlash : bool
        Whether a second hinge stands for it; without it the joint is rigid.
    beyond : Overload or None
        What the gearbox does not carry of the effort limit.
    """

    parameters: ActuatorParameters
    name: str
    design_sha256: str = "not given"
    backlash: bool = True
    beyond: Overload | None = None

    def __post_init__(self) -> None:
        """Make the name fit for an attribute."""
        object.__setattr__(self, "name", identifier(self.name))

    @cached_property
    def side(self) -> JointSide:
        """The actuator seen from its joint."""
        return joint_side(self.parameters)

    @cached_property
    def _ripple(self) -> tuple[tuple[RippleHarmonic, ...], float]:
        """All harmonics, and the least amplitude to be written."""
        found = ripple_harmonics(self.parameters)
        return found, LEAST_RIPPLE * max((one.amplitude for one in found), default=0.0)

    @property
    def harmonics(self) -> tuple[RippleHarmonic, ...]:
        """Those that are written."""
        found, least = self._ripple
        return tuple(one for one in found if one.amplitude >= least)

    @property
    def left_out(self) -> tuple[RippleHarmonic, ...]:
        """Those that are too small to be."""
        found, least = self._ripple
        return tuple(one for one in found if one.amplitude < least)

    @property
    def play(self) -> bool:
        """Whether the model has a hinge for the backlash."""
        return self.backlash and self.parameters.gear.backlash > 0.0

    @property
    def output_friction(self) -> bool:
        """Whether there is friction at the output side."""
        friction = self.parameters.friction
        return friction.output_coulomb > 0.0 or friction.output_viscous > 0.0


def time_step(parameters: ActuatorParameters) -> float:
    """Step that a model of the actuator alone bears with ease, s: 1, 2 or 5 of some decade.

    The fastest oscillation is that of the motor, or of the output within the play, on the bristles
    of its friction.
    """
    side, friction = joint_side(parameters), parameters.friction
    bristles = motor_breakaway(parameters) / friction.bristle_deflection
    outer = friction.output_coulomb * (1.0 + friction.stribeck_extra)
    outer *= side.reduction / friction.bristle_deflection
    fastest = math.sqrt(max(bristles / parameters.motor_side_inertia, outer / side.output_inertia))
    most = min(LONGEST_STEP, STEP_FRACTION / fastest) if fastest > 0.0 else LONGEST_STEP
    decade = 10.0 ** math.floor(math.log10(most * (1.0 + 1e-12)))
    return max(one * decade for one in (1.0, 2.0, 5.0) if one * decade <= most * (1.0 + 1e-12))


def default_classes(model: MjcfActuator, *, alone: bool) -> tuple[str, ...]:
    """Default classes, for a model of the actuator alone or to be included.

    Alone the output's inertia is in a body and the step is the model's own; included, the rigid
    joint carries that inertia, and a link is taken to be as inert as the actuator.
    """
    side = model.side
    step = time_step(model.parameters) if alone else HOST_STEP
    turning = side.output_inertia if alone else side.reflected_inertia
    name = model.name
    joint = {"axis": "0 0 1", "armature": None if alone else side.output_inertia}
    found = [
        element(
            "default",
            {"class": name},
            element("joint", joint),
            element("dcmotor", _motor_attributes(model, step)),
            _class(f"{name}-torque", "dcmotor", _torque(model)),
            _class(f"{name}-impedance", "dcmotor", _impedance(model)),
        )
    ]
    if model.output_friction:
        friction = {**_PASSIVE, **_output_friction(model, step, turning)}
        found.append(_class(f"{name}-output-friction", "dcmotor", friction))
    for one in model.harmonics:
        cogging = numbers(one.amplitude, one.order, one.phase)
        found.append(
            _class(f"{name}-ripple-{one.order}", "dcmotor", {**_PASSIVE, "cogging": cogging})
        )
    if model.parameters.gear.backlash > 0.0:
        half = 0.5 * model.parameters.gear.backlash
        for ending, unit in (("play", 1.0), ("play-degree", 180.0 / math.pi)):
            limits = {"limited": "true", "range": numbers(-half * unit, half * unit)}
            attributes = {"axis": "0 0 1", **limits, **_play_ends(model.parameters, step)}
            found.append(_class(f"{name}-{ending}", "joint", attributes))
    return tuple(found)


def _class(name: str, kind: str, attributes: Mapping[str, object]) -> str:
    """A default class of one element."""
    return element("default", {"class": name}, element(kind, attributes))


_PASSIVE: dict[str, object] = {"input": "none", "motorconst": "0", "resistance": "1", "gear": "1"}


def _motor_attributes(model: MjcfActuator, step: float) -> dict[str, object]:
    """The motor, commanded in volts; side of the motor but for `gear`."""
    parameters, motor = model.parameters, model.parameters.motor
    drive, thermal = parameters.drive, parameters.thermal
    resistance, time_constant = single_node(thermal)
    attributes: dict[str, object] = {
        "gear": model.side.reduction,
        "resistance": motor.resistance,
        "motorconst": numbers(model.side.motor_constant, model.side.motor_constant),
        "saturation": numbers(_own_peak(model), drive.current_limit, 0.0),
        "thermal": numbers(
            resistance,
            0.0,
            time_constant,
            COPPER_COEFFICIENT,
            motor.reference_temperature,
            thermal.ambient,
        ),
        "armature": parameters.motor_side_inertia,
        "damping": motor_viscous(parameters),
        "input": "voltage",
        "ctrlrange": numbers(-drive.supply_voltage, drive.supply_voltage),
    }
    if motor.inductance > 0.0:
        attributes["inductance"] = numbers(motor.inductance, 0.0)
    if motor.cogging_amplitude > 0.0:
        # Phase pi: a rest position of the rotor is stable.
        attributes["cogging"] = numbers(motor.cogging_amplitude, motor.cogging_order, math.pi)
    coulomb = motor_coulomb(parameters)
    if coulomb > 0.0:
        attributes["lugre"] = _lugre(
            parameters.friction,
            coulomb,
            motor_breakaway(parameters),
            motor_viscous(parameters),
            parameters.motor_side_inertia,
            step,
        )
    return attributes


def _own_peak(model: MjcfActuator) -> float:
    """The motor's own peak torque where the drive gives more, N m; 0, no limit, where not."""
    most = model.parameters.peak_current
    return model.side.motor_constant * most if most < model.parameters.drive.current_limit else 0.0


def _torque(model: MjcfActuator) -> dict[str, object]:
    """Commanded in torque, up to what leaves the bench's stall torque after MuJoCo's friction."""
    parameters = model.parameters
    most = model.side.motor_constant * parameters.peak_current
    stalled = effort_limit(parameters) / model.side.reduction + motor_breakaway(parameters)
    most = min(most, stalled)
    return {
        "input": "ff",
        "controller": numbers(0.0, 0.0, 0.0, 0.0, 0.0, model.parameters.drive.supply_voltage),
        "ctrlrange": numbers(-most, most),
    }


def _impedance(model: MjcfActuator) -> dict[str, object]:
    drive, square = model.parameters.drive, model.side.reduction**2
    gains = (drive.position_gain / square, 0.0, drive.velocity_gain / square)
    return {
        "input": "pos vel ff",
        "controller": numbers(*gains, 0.0, 0.0, drive.supply_voltage),
        "ctrllimited": "false",
    }


def _output_friction(model: MjcfActuator, step: float, inertia: float) -> dict[str, object]:
    friction = model.parameters.friction
    attributes: dict[str, object] = {"damping": friction.output_viscous}
    if friction.output_coulomb > 0.0:
        attributes["lugre"] = _lugre(
            friction,
            friction.output_coulomb,
            friction.output_coulomb * (1.0 + friction.stribeck_extra),
            friction.output_viscous,
            inertia,
            step,
            model.side.reduction,
        )
    return attributes


def _lugre(
    friction: FrictionParameters,
    coulomb: float,
    breakaway: float,
    viscous: float,
    inertia: float,
    step: float,
    reduction: float = 1.0,
) -> str:
    """``sigma0 sigma1 coulomb static stribeck`` of a side that turns `reduction` times slower.

    Breakaway is reached at the bristles' deflection, or later where `inertia` would swing on them
    too fast for `step`. Their damping is the one given, else critical, in either case no more than
    passive: LuGre generates no energy where sigma2 >= sigma1 (static - coulomb)/coulomb (Barabanov
    and Ortega 2000; MuJoCo's note, 1.4). MuJoCo takes sigma1 for damping also where the bristles
    slide and it is not felt, and its implicit steps then carry `step` times sigma1 as inertia.
    """
    stiffness = breakaway * reduction / friction.bristle_deflection
    stiffness = min(stiffness, inertia * (STEP_FRACTION / step) ** 2)
    damping = friction.bristle_damping * reduction**2 or 2.0 * math.sqrt(stiffness * inertia)
    if breakaway > coulomb:
        damping = min(damping, viscous * coulomb / (breakaway - coulomb))
    damping = min(damping, DAMPING_INERTIA * inertia / step)
    return numbers(stiffness, damping, coulomb, breakaway, friction.stribeck_speed / reduction)


def _play_ends(parameters: ActuatorParameters, step: float) -> dict[str, object]:
    """Stiffness of the limits that end the play, as that of the transmission.

    At rest a limit of time constant t, damping ratio 1 and constant impedance d bears f for a
    depth r with f/r = 1/(t^2 (1 - d) a), a the inverse inertia of output against motor (MuJoCo,
    Computation, Solver parameters). Stable steps want t of two steps or more; d follows.
    """
    constant = _end_time(parameters, step)
    impedance = 1.0 - 1.0 / (_swing_square(parameters) * constant**2)
    return {
        "solreflimit": numbers(constant, 1.0),
        "solimplimit": numbers(impedance, impedance, 1e-3),
    }


def _swing_square(parameters: ActuatorParameters) -> float:
    """Of the output's swing against the motor on the transmission, squared, rad^2/s^2."""
    side = joint_side(parameters)
    return parameters.gear.stiffness * (1.0 / side.output_inertia + 1.0 / side.motor_inertia)


def _end_time(parameters: ActuatorParameters, step: float) -> float:
    """Time constant of the limits that end the play, s."""
    return max(2.0 * step, 3.0 / math.sqrt(_swing_square(parameters)))


def play_damping(parameters: ActuatorParameters, *, alone: bool) -> float:
    """Damping of the play's ends, N m s/rad: f = -(k r + 2 t k r') with a limit's time t."""
    step = time_step(parameters) if alone else HOST_STEP
    return 2.0 * _end_time(parameters, step) * parameters.gear.stiffness


def remarks(model: MjcfActuator, *, alone: bool) -> list[str]:
    """What the head of both files says about sense, origin and what is missing."""
    parameters, side = model.parameters, model.side
    gear, friction = parameters.gear, parameters.friction
    sense = "against" if side.crank_sense < 0 else "with"
    held_back = held_back_torque(parameters, side)
    lines = [
        f"Written by {provenance(model.design_sha256)}. SI units, angles in rad.",
        "",
        f"Sense: a positive command turns the joint positive. The gear is written as "
        f"{number(side.reduction)}; the gearbox's own signed ratio is {number(gear.ratio)}, so the "
        f"crank turns {sense} the joint, and the drive's wiring makes up for it. MuJoCo's "
        "actuator_length is the motor's angle in the drive's sense.",
        "",
        "Constants: K in N m/A = V s/rad of the equivalent DC machine, resistance and inductance "
        f"line to line. K is that at the {number(parameters.thermal.ambient)} degC around the "
        "actuator and stays when the motor warms; resistance is stated at "
        f"{number(parameters.motor.reference_temperature)} degC, and MuJoCo warms it.",
        "",
        f"At full voltage: stall torque {number(side.stall_torque)} N m without and "
        f"{number(side.peak_torque)} N m with {peak_limit(parameters)}, both before friction, "
        f"no-load speed {number(side.no_load_speed)} rad/s; reflected inertia "
        f"{number(side.reflected_inertia)} kg m^2, all at the joint. On a locked output the "
        f"gearbox's friction under load holds back up to {number(held_back)} N m of the torque "
        "with the limit, which this file does not: the range of a commanded torque ends where the "
        f"output gives {number(effort_limit(parameters))} N m, what it gives stalled.",
        "",
        *([overload_remark(model.beyond), ""] if model.beyond else []),
        _ripple_remark(model),
        "",
        "Not in this file, because MuJoCo has no place for it:",
        f"- friction that grows with load ({number(friction.load_forward)} of the torque when the "
        f"motor drives, {number(friction.load_backward)} when the output drives, "
        f"{number(friction.load_growth)} of itself more above {number(friction.load_knee)} N m), "
        "so neither efficiency; a step callback that writes dof_frictionloss can add it;",
        "- the kinematic error in the joint's position: only its torque is here;",
        f"- variation of stiffness over angle beyond its torque, and its exponent "
        f"{number(gear.stiffening)}; without backlash the joint is rigid;",
        _damping_remark(model, alone),
        "- bandwidth and delay of the current loop (delay: attributes delay and nsample of an "
        "actuator), quantisation of the encoder;",
        "- the winding as a node apart from the housing: one node has the same steady temperature "
        "and the slower time constant; derating with temperature; heat from anything but copper. "
        "MuJoCo heats by (V - K w)/R even where the current limit clips the torque, so at "
        "standstill under full voltage it is too hot: command torque there.",
    ]
    if model.harmonics and parameters.gear.backlash > 0.0:
        lines.append("- ripple stays while the play is open, when no torque is carried.")
    return lines


def _ripple_remark(model: MjcfActuator) -> str:
    gear, lost = model.parameters.gear, ripple_rms(model.left_out)
    return (
        f"Ripple: {len(model.harmonics)} harmonics of the torque that kinematic error and varying "
        f"stiffness add at a steady {number(gear.error_torque)} N m. The part of the error scales "
        "with the torque and changes sign with it, that of the stiffness keeps its sign and grows "
        "as power "
        f"{number(1.0 + 1.0 / gear.stiffening)} of the torque; a passive motor can follow neither. "
        "The gearbox's friction under load, which is not here, divides it by "
        f"{number(1.0 + model.parameters.friction.load_forward)} where the motor drives. "
        f"Left out as small: {len(model.left_out)} harmonics, {number(lost)} N m r.m.s. together."
    )


def _damping_remark(model: MjcfActuator, alone: bool) -> str:
    gear = model.parameters.gear
    if gear.backlash == 0.0 or (alone and not model.play):
        return f"- damping of the transmission, {number(gear.damping)} N m s/rad;"
    damped = play_damping(model.parameters, alone=alone)
    return (
        f"- damping of the transmission, {number(gear.damping)} N m s/rad: the ends of the play "
        f"are damped critically for stable steps, which is {number(damped)} N m s/rad;"
    )
