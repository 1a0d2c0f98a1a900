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
from cqdd_design.torque.features.matrix import PHYSICAL
from cqdd_design.torque.features.physics import SMOOTHING, actuator_from_dict, dry_friction

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
    from cqdd_design.torque.networks.artefact import Artefact

_PER_LINE = 4

BALANCE = """\
/* Torque of the drive (N m at the joint): impedance law within supply voltage and current limit. */
static inline double @name@_driven(double position_error, double velocity)
{
    const double back = @BACK@ * velocity;
    const double least = (-@SUPPLY@ - back) / @RESISTANCE@;
    const double most = (@SUPPLY@ - back) / @RESISTANCE@;
    double current = (@STIFFNESS_GAIN@ * position_error - @DAMPING_GAIN@ * velocity) / @BACK@;
    current = current < least ? least : current > most ? most : current;
    current = current < -@LIMIT@ ? -@LIMIT@ : current > @LIMIT@ ? @LIMIT@ : current;
    return @BACK@ * current;
}

/* What inertia and viscous drag leave of it (N m): the output torque but for dry friction. */
static inline double @name@_balance(double position_error, double velocity, double acceleration)
{
    return @name@_driven(position_error, velocity) - @INERTIA@ * acceleration
           - @DRAG@ * velocity;
}
"""

FRICTION = """\
/* Smooth sign of dry friction, -1 to 1. */
static inline double @name@_friction_sign(double velocity)
{
    return tanh(@SIGN_RATE@ * velocity);
}
"""

RIPPLE = """\
/* What the gearbox's errors add to a torque of the motor (N m at the joint), between two of
   @POINTS@ places in a turn. Sine and cosine of each order follow from those of the one before. */
static inline double @name@_ripple(double position, double torque)
{
    const double step = @STEP_ANGLE@;
    const double place = floor(@WAY@ * position / step);
    const double after = @WAY@ * position / step - place;
    const double part[2] = {1.0 - after, after};
    double slope = 0.0, share = 1.0, share_slope = 0.0, size, windup, energy;
    double c[2] = {1.0, 1.0}, s[2] = {0.0, 0.0}, first_c[2], first_s[2];
    int i, j, order = 0;
    for (j = 0; j < 2; j++) {
        const double angle = step * fmod(place + j, @POINTS@.0);
        first_c[j] = cos(angle);
        first_s[j] = sin(angle);
    }
    for (i = 0; i < @NAME@_ORDERS; i++) {
        double here_c, here_s;
        for (; order < @name@_order[i]; order++)
            for (j = 0; j < 2; j++) {
                const double turned = c[j] * first_c[j] - s[j] * first_s[j];
                s[j] = s[j] * first_c[j] + c[j] * first_s[j];
                c[j] = turned;
            }
        here_c = part[0] * c[0] + part[1] * c[1];
        here_s = part[0] * s[0] + part[1] * s[1];
        slope += order * (@name@_error_sine[i] * here_c - @name@_error_cosine[i] * here_s);
        share += @name@_share_cosine[i] * here_c + @name@_share_sine[i] * here_s;
        share_slope += order * (@name@_share_sine[i] * here_c - @name@_share_cosine[i] * here_s);
    }
    size = torque < 0.0 ? -torque : torque;
    windup = @WINDUP@ * pow(size / (share * @ERROR_TORQUE@), @SOFTENING@);
    energy = size * windup / (@STIFFENING_MORE@ * share);
    return (torque - @WAY@ * energy * share_slope) / (1.0 + @WAY@ * slope) - torque;
}
"""


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
    drag = ratio**2 * (friction.motor_viscous + motor.iron_loss) + friction.output_viscous
    points = table_points(gear)
    names = made_inside(artefact)
    text = ""
    if "balance" in names:
        text += BALANCE + "\n"
    if "friction_sign" in names:
        text += FRICTION + "\n"
    if "ripple" in names:
        text += _tables(gear) + "\n" + RIPPLE + "\n"
    for token, value in {
        "@BACK@": literal(ratio * motor.torque_constant),
        "@SUPPLY@": literal(drive.supply_voltage),
        "@RESISTANCE@": literal(motor.resistance),
        "@STIFFNESS_GAIN@": literal(drive.position_gain),
        "@DAMPING_GAIN@": literal(drive.velocity_gain),
        "@LIMIT@": literal(drive.current_limit),
        "@INERTIA@": literal(actuator.reflected_inertia),
        "@DRAG@": literal(drag),
        "@SIGN_RATE@": literal(ratio / (SMOOTHING * friction.stribeck_speed)),
        "@POINTS@": str(points),
        "@STEP_ANGLE@": literal(2.0 * np.pi / points),
        "@WAY@": literal(np.sign(gear.ratio)),
        "@WINDUP@": literal(gear.error_torque / gear.stiffness),
        "@ERROR_TORQUE@": literal(gear.error_torque),
        "@SOFTENING@": literal(1.0 / gear.stiffening),
        "@STIFFENING_MORE@": literal(gear.stiffening + 1.0),
    }.items():
        text = text.replace(token, value)
    return text.rstrip("\n") + "\n"


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
    chosen = [
        ("int", "order", [str(int(one)) for one in orders[kept]] or ["1"]),
        *(
            ("double", name, [repr(float(one)) for one in values[kept]] or ["0.0"])
            for name, values in series.items()
        ),
    ]
    texts = [f"#define @NAME@_ORDERS {len(chosen[0][2])}"]
    for kind, name, numbers in chosen:
        rows = [
            "    " + ", ".join(numbers[i : i + _PER_LINE])
            for i in range(0, len(numbers), _PER_LINE)
        ]
        size = "@NAME@_ORDERS"
        texts.append(
            f"static const {kind} @name@_{name}[{size}] = {{\n" + ",\n".join(rows) + "\n};"
        )
    return "\n".join(texts) + "\n"
