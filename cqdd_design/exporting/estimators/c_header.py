"""An estimator as one C99 header without dependencies: weights, scaling, state and features.

Written to be vectorised by an ordinary compiler: sums run along memory over all outputs of a
layer, activations are polynomials, nothing is allocated. Every function is ``static inline``, so a
file may include several networks and use what it needs.
"""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators import c_physics
from cqdd_design.exporting.estimators.c_text import ACTIVATIONS, array, filled, template
from cqdd_design.exporting.estimators.options import Export
from cqdd_design.files import write_atomically
from cqdd_design.torque.evaluation.carried import carried
from cqdd_design.torque.networks.folded import folded_gru, folded_mlp
from cqdd_design.torque.networks.meaning import meaning

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.torque.networks.artefact import Artefact

_PER_LINE = 6
_POSITION_ERROR = ("float", "position_error", "rad, target less position")
_VELOCITY = ("float", "velocity", "rad/s")
_POSITION = ("double", "position", "rad, of the joint, homed as said below")
_HOMED = (
    " * Homed: position counts from the zero of the training's data, for the gearbox of a design",
    " * where the motor's angle is 0 in its record. Whole turns of the joint do not matter.",
)


def export_c(artefact: Artefact, path: Path) -> Export:
    """Write ``NAME.h``; the names in it begin with NAME as a C identifier."""
    text = header_text(artefact, c_name(path.name))
    return Export((write_atomically(path.with_name(f"{path.name}.h"), text, "c"),))


def c_name(text: str) -> str:
    """A C identifier in lower case.

    Examples
    --------
    >>> c_name("PVA-gru 1")
    'pva_gru_1'
    """
    name = re.sub(r"[^0-9a-z]+", "_", text.lower()).strip("_")
    return name if name[:1].isalpha() else f"net_{name}"


def header_text(artefact: Artefact, name: str) -> str:
    """The header as text; `name` begins every name in it.

    Raises
    ------
    UsageError
        For an input that cannot be made of what a joint measures.
    """
    actuator = c_physics.stored_actuator(artefact)
    if artefact.family == "gru":
        gru = folded_gru(artefact)
        arrays = [
            _array(f"{name}_{kind}_{layer}", getattr(one, kind))
            for layer, one in enumerate(gru.layers)
            for kind in ("input", "state", "bias")
        ]
        head, offset, body = gru.head, gru.head_bias, _gru_body(artefact)
    else:
        mlp = folded_mlp(artefact)
        arrays = [
            _array(f"{name}_{kind}_{layer}", values)
            for layer, both in enumerate(zip(mlp.weights, mlp.biases, strict=True))
            for kind, values in zip(("weight", "bias"), both, strict=True)
        ]
        head, offset, body = mlp.head, mlp.head_bias, _mlp_body(artefact)
    arrays += [_array(f"{name}_head", head)]
    text = "\n".join(
        [
            _comment(artefact, actuator),
            "#ifndef @NAME@_H",
            "#define @NAME@_H",
            "",
            "#include <stdint.h>",
            *(["#include <math.h>"] if _needs_math(artefact) else []),
            "",
            _sizes(artefact),
            *arrays,
            template("common"),
            body,
            *([c_physics.functions(artefact, actuator)] if actuator else []),
            _entry(artefact, actuator),
            "#endif",
            "",
        ]
    )
    correction = f" + newest[{artefact.inputs.index('balance')}]" if artefact.residual else ""
    words = {"OFFSET": _number(offset), "NAME": name.upper(), "name": name}
    return filled(text, words | {"CORRECTION": correction})


def _comment(artefact: Artefact, actuator: ActuatorParameters | None) -> str:
    valid, told = artefact.validity, meaning(artefact)
    low, high = told.range
    arguments = [f" *   {name:15s} {meaning}" for _, name, meaning in _arguments(artefact)]
    held = "its state kept from call to call"
    if artefact.mode == "window":
        held = f"the last {artefact.history} samples run from a zero state at each call"
    lines = [
        f"/* Output torque of a joint, estimated by the network {_plain(artefact.name)}.",
        " *",
        " * Call @name@_init once, and @name@_step every",
        f" * {valid.dt:g} s, no faster and no slower, with",
        *arguments,
        " * It returns a torque in N m. Signs are those of the joint: a positive position error",
        " * asks for a positive torque.",
        " *",
        *_wrapped(told.joint_told),
        " *",
        *_wrapped(told.filter_told),
        " *",
        *([*_wrapped(_plain(kept)), " *"] if (kept := carried(artefact)) else []),
        f" * Mode: {artefact.mode}, {held}.",
        *(
            [" * Until there are so many, @name@_ready is 0 and the torque is 0."]
            if artefact.mode == "window"
            else []
        ),
        *(
            [
                " * Acceleration is made inside from the last velocities, causally, with a delay",
                f" * of {1e3 * artefact.differentiator.delay:g} ms; before there are enough, the",
                " * first stands for those before it.",
            ]
            if artefact.differentiator
            else []
        ),
        *(c_physics.comment_lines(artefact, _plain(actuator.name)) if actuator else []),
        *(_HOMED if _needs_position(artefact) else []),
        " *",
        " * Valid for the controller and sample time of its training only:",
        f" *   sample time    {valid.dt:g} s",
        f" *   position gain  {valid.position_gain:g} N m/rad",
        f" *   velocity gain  {valid.velocity_gain:g} N m s/rad",
        *_wrapped(f"{low:g} to {high:g} N m, {told.range_of}", "  torque         "),
        f" * {artefact.parameters} parameters; scaling is folded into the weights.",
        " *",
        f" * C99, {'link with -lm' if _needs_math(artefact) else 'no dependencies'}. Fast with: "
        "cc -O3 -march=native -ffp-contract=fast",
        " */",
    ]
    return "\n".join(lines)


def _wrapped(text: str, head: str = "") -> list[str]:
    """A sentence as lines of the comment, those after the first as deep as its head."""
    deep = " " * len(head)
    return textwrap.wrap(text, 96, initial_indent=f" * {head}", subsequent_indent=f" * {deep}")


def _plain(text: str) -> str:
    """A name that neither ends a comment nor begins another."""
    return re.sub(r"[^0-9A-Za-z_ .,:+()-]+", "-", text)


def _needs_position(artefact: Artefact) -> bool:
    return any(one == "ripple" or one.startswith(("sin_", "cos_")) for one in artefact.inputs)


def _needs_math(artefact: Artefact) -> bool:
    made = c_physics.made_inside(artefact)
    return "friction_sign" in made or _needs_position(artefact)


def _arguments(artefact: Artefact) -> list[tuple[str, str, str]]:
    """Type, name and meaning of the arguments of a step."""
    plain = {"position_error": _POSITION_ERROR, "velocity": _VELOCITY}
    found = [plain[feature] for feature in artefact.inputs if feature in plain]
    made = c_physics.made_inside(artefact)
    if "balance" in made and _POSITION_ERROR not in found:
        found.append(_POSITION_ERROR)
    if (artefact.differentiator or made) and _VELOCITY not in found:
        found.append(_VELOCITY)
    if _needs_position(artefact):
        found.append(_POSITION)
    return found


def _sizes(artefact: Artefact) -> str:
    taps = len(artefact.differentiator.taps) if artefact.differentiator else 1
    sizes = {
        "FEATURES": len(artefact.inputs),
        "HISTORY": artefact.history,
        "LAYERS": artefact.layers,
        "HIDDEN": artefact.hidden,
        "TAPS": taps,
    }
    lines = [f"#define @NAME@_{name} {value}" for name, value in sizes.items()]
    valid = artefact.validity
    low, high = meaning(artefact).range
    for name, value in {
        "DT": valid.dt,
        "POSITION_GAIN": valid.position_gain,
        "VELOCITY_GAIN": valid.velocity_gain,
        "TORQUE_LEAST": low,
        "TORQUE_MOST": high,
    }.items():
        lines.append(f"#define @NAME@_{name} ({_number(value)})")
    return "\n".join(lines) + "\n"


def _gru_body(artefact: Artefact) -> str:
    step, window, lanes = [], [], []
    for layer in range(artefact.layers):
        rows = "@NAME@_FEATURES" if layer == 0 else "@NAME@_HIDDEN"
        place = f"hidden + {layer} * @NAME@_HIDDEN"
        inside = "features" if layer == 0 else f"hidden + {layer - 1} * @NAME@_HIDDEN"
        weights = f"@name@_input_{layer}, @name@_state_{layer}, @name@_bias_{layer}"
        step.append(f"    @name@_layer({weights}, {inside}, {rows}, {place});")
        source = "samples" if layer == 0 else "values"
        window.append(f"    @name@_sequence({weights}, {source}, {rows}, values);")
        lanes.append(f"        @name@_lane_layer({weights}, {rows}, values);")
    pieces = {"STEP": step, "WINDOW": window, "LANE_LAYERS": lanes}
    return filled(template("gru"), {key: "\n".join(lines) for key, lines in pieces.items()})


def _mlp_body(artefact: Artefact) -> str:
    lines = []
    for layer in range(artefact.layers):
        now, before = ("even", "odd") if layer % 2 == 0 else ("odd", "even")
        inside, rows = ("flat", "@NAME@_FEATURES * @NAME@_HISTORY")
        if layer:
            inside, rows = before, "@NAME@_HIDDEN"
        lines.append(
            f"    @name@_dense(@name@_weight_{layer}, @name@_bias_{layer}, {inside}, {rows},"
            f" {now});"
        )
    last = "even" if artefact.layers % 2 else "odd"
    words = {"ACTIVATION": ACTIVATIONS[artefact.activation], "LAST": last}
    return filled(template("mlp"), words | {"DENSE": "\n".join(lines)})


def _entry(artefact: Artefact, actuator: ActuatorParameters | None) -> str:
    """State, init, reset and step: from what a joint measures to the network's features."""
    lines = []
    made = c_physics.made_inside(artefact)
    # The balance goes straight into the torque, with the acceleration times the inertia in it.
    kind = "double" if "balance" in made else "float"
    if artefact.differentiator:
        written = c_physics.literal if kind == "double" else _number
        taps = [written(value) for value in artefact.differentiator.taps]
        lines += [
            "    if (!state->moved)",
            "        for (i = 0; i < @NAME@_TAPS; i++)",
            "            state->velocity[i] = velocity;",
            "    state->moved = 1;",
            "    for (i = @NAME@_TAPS - 1; i > 0; i--)",
            "        state->velocity[i] = state->velocity[i - 1];",
            "    state->velocity[0] = velocity;",
            "    acceleration = 0.0f;" if kind == "float" else "    acceleration = 0.0;",
            *(f"    acceleration += {tap} * state->velocity[{i}];" for i, tap in enumerate(taps)),
        ]
    if actuator:
        lines += c_physics.step_lines(artefact, actuator)
    for place, feature in enumerate(artefact.inputs):
        value = feature
        phase = re.fullmatch(r"(sin|cos)_(\d+)", feature)
        if phase:
            value = f"(float){phase[1]}({phase[2]}.0 * position)"
        elif feature in made or (feature == "acceleration" and kind == "double"):
            value = f"(float){feature}"
        elif feature not in ("position_error", "velocity", "acceleration"):
            raise UsageError(
                f"{artefact.name} has the input '{feature}', which a C header cannot make; export "
                "to onnx, where the caller makes the features."
            )
        lines.append(f"    features[{place}] = {value};")
    lines.append(template(f"run_{artefact.mode}").removesuffix("\n"))
    arguments = ", ".join(f"{what} {name}" for what, name, _ in _arguments(artefact))
    window = artefact.mode == "window"
    needs_index = window or artefact.differentiator
    declared = (
        (["    int i;"] if needs_index else [])
        + ([f"    {kind} acceleration;"] if artefact.differentiator else [])
        + ["    float features[@NAME@_FEATURES];"]
    )
    keeps = "past" if window else "hidden"
    size = "@NAME@_HISTORY * @NAME@_FEATURES" if window else "@NAME@_LAYERS * @NAME@_HIDDEN"
    words = {"KEPT": keeps, "KEPT_SIZE": size, "ARGUMENTS": arguments}
    words |= {"NEEDED": "@NAME@_HISTORY" if window else "1"}
    return filled(
        template("entry"), words | {"DECLARED": "\n".join(declared), "BODY": "\n".join(lines)}
    )


def _array(name: str, values: NDArray[np.float32]) -> str:
    return array(
        f"float {name}[{values.size}]", [_number(one) for one in values.ravel()], _PER_LINE
    )


def _number(value: float | np.float32) -> str:
    """A float literal that reads back as the same single-precision number."""
    text = format(float(np.float32(value)), ".9g")
    return text + ("f" if re.search(r"[.e]", text) else ".0f")
