"""The C of a network's physical features: what `torque.features.physics` makes of a motion.

Constants of the actuator that the network was trained with stand in the text as literals. All of it
is in double precision: it is a small part of a step, and the balance goes straight into the torque.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.actuator.packing import table_points
from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.c_text import array, filled, template
from cqdd_design.torque.features.matrix import PHYSICAL
from cqdd_design.torque.features.physics import SMOOTHING, actuator_from_dict, dry_friction

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
    from cqdd_design.torque.networks.artefact import Artefact

_PER_LINE = 4


def made_inside(artefact: Artefact) -> tuple[str, ...]:
    """Features that the header makes with an actuator's parameters, each after what it needs."""
    wanted = set(artefact.inputs) & set(PHYSICAL)
    if "ripple" in wanted:
        wanted = set(PHYSICAL)
    return tuple(name for name in PHYSICAL if name in wanted)


def stored_actuator(artefact: Artefact) -> ActuatorParameters | None:
    """The actuator of the training, under its gains; none where no input is made with one.

    Raises
    ------
    UsageError
        For a network that needs an actuator, or a differentiator, and holds none.
    """
    names = [name for name in artefact.inputs if name in PHYSICAL]
    if not names:
        return None
    advice = "export to onnx, where the caller makes the features"
    stored = artefact.facts.get("actuator")
    if not isinstance(stored, Mapping):
        raise UsageError(
            f"{artefact.name} has the input '{names[0]}', which is made with an actuator's "
            f"parameters, and holds none; {advice}."
        )
    if "balance" in made_inside(artefact) and artefact.differentiator is None:
        raise UsageError(
            f"{artefact.name} has the input '{names[0]}', which needs the acceleration, but no "
            f"input 'acceleration' and so no differentiator; {advice}."
        )
    return actuator_from_dict(stored)


def functions(artefact: Artefact, actuator: ActuatorParameters) -> str:
    """C functions and tables of the features that are made inside."""
    motor, drive, friction = actuator.motor, actuator.drive, actuator.friction
    gear, ratio = actuator.gear, abs(actuator.gear.ratio)
    drag = ratio**2 * (friction.motor_viscous + motor.drag_slope) + friction.output_viscous
    points = table_points(gear)
    names = made_inside(artefact)
    texts = [template(name) for name in names]
    if "ripple" in names:
        texts.insert(names.index("ripple"), _tables(gear))
    values = {
        "BACK": literal(ratio * motor.torque_constant),
        "SUPPLY": literal(drive.supply_voltage),
        "RESISTANCE": literal(motor.resistance),
        "STIFFNESS_GAIN": literal(drive.position_gain),
        "DAMPING_GAIN": literal(drive.velocity_gain),
        "LIMIT": literal(drive.current_limit),
        "INERTIA": literal(actuator.reflected_inertia),
        "DRAG": literal(drag),
        "SIGN_RATE": literal(ratio / (SMOOTHING * friction.stribeck_speed)),
        "POINTS": str(points),
        "STEP_ANGLE": literal(2.0 * np.pi / points),
        "WAY": literal(np.sign(gear.ratio)),
        "WINDUP": literal(gear.error_torque / gear.stiffness),
        "ERROR_TORQUE": literal(gear.error_torque),
        "SOFTENING": literal(1.0 / gear.stiffening),
        "STIFFENING_MORE": literal(gear.stiffening + 1.0),
    }
    return filled("\n".join(texts), values)


def step_lines(artefact: Artefact, actuator: ActuatorParameters) -> list[str]:
    """Lines of a step that make the features, each a `double` of its own name."""
    dry = literal(dry_friction(actuator))
    made = {
        "balance": "@name@_balance(position_error, velocity, acceleration)",
        "friction_sign": "@name@_friction_sign(velocity)",
        "ripple": f"@name@_ripple(position, balance - {dry} * friction_sign)",
    }
    return [f"    const double {name} = {made[name]};" for name in made_inside(artefact)]


def comment_lines(artefact: Artefact, name: str) -> list[str]:
    """What the head of the header says of the features, of an actuator of that name."""
    told = {
        "balance": "torque of the drive within its limits, less inertia and viscous drag",
        "friction_sign": "smooth sign of the velocity",
        "ripple": "what the gearbox's errors add at the position",
    }
    return [
        f" * Made inside for the actuator {name} and its gains below, no other:",
        *(f" *   {one:15s} {told[one]}" for one in made_inside(artefact)),
    ]


def literal(value: float) -> str:
    """A double literal that reads back as the same number; a negative one in brackets."""
    text = repr(float(value))
    return f"({text})" if text.startswith("-") else text


def _tables(gear: GearParameters) -> str:
    """Harmonics of the gearbox in ascending order, without those that are zero."""
    orders = np.asarray(gear.error_orders)
    series: dict[str, NDArray[Any]] = {
        "error_cosine": np.asarray(gear.error_cosine),
        "error_sine": np.asarray(gear.error_sine),
        "share_cosine": np.asarray(gear.stiffness_cosine),
        "share_sine": np.asarray(gear.stiffness_sine),
    }
    order = np.argsort(orders, kind="stable")
    kept = order[np.any([values[order] != 0.0 for values in series.values()], axis=0)]
    # C has no empty array; a gearbox without harmonics keeps one of them at zero.
    numbers = [str(int(one)) for one in orders[kept]] or ["1"]
    texts = [
        f"#define @NAME@_ORDERS {len(numbers)}\n",
        array("int @name@_order[@NAME@_ORDERS]", numbers, _PER_LINE),
    ]
    for name, values in series.items():
        numbers = [repr(float(one)) for one in values[kept]] or ["0.0"]
        texts.append(array(f"double @name@_{name}[@NAME@_ORDERS]", numbers, _PER_LINE))
    return "".join(texts)
