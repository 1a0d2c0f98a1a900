"""Estimators for Isaac Lab: files for ``ActuatorNetMLP``, ``ActuatorNetLSTM`` and the `.gru` form.

``NAME-isaaclab-mlp.pt`` for ``ActuatorNetMLPCfg``: an MLP, or a GRU that was trained on windows and
runs each of them from a zero state. ``NAME-isaaclab-lstm.pt`` for ``ActuatorNetLSTMCfg``: a GRU in
the place of the LSTM, its state kept by the client. ``NAME-isaaclab-gru.pt``: the form of the
proposed ``ActuatorNetGRU`` (IsaacLab pull request 6083, closed unmerged). Beside each a JSON file
with the fields of the configuration. Both released classes clip the torque with the DC motor's
envelope afterwards, whose limits are wanted: those written leave what the training's labels reach
alone, at every speed of the training. (isaaclab 2.3.2, ``actuators/actuator_net.py``)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.options import (
    Export,
    joint_settings,
    metadata,
    probe,
    require,
    require_close,
    require_inputs,
    streaming_warning,
    write_settings,
)
from cqdd_design.exporting.estimators.torchscript import Shape, client_history, torchscript
from cqdd_design.files import WrittenFile, write_atomically
from cqdd_design.torque.networks.meaning import meaning
from cqdd_design.torque.networks.predict import predict

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from cqdd_design.torque.networks.artefact import Artefact, Mode

_FORMS = {
    "history": ("mlp", "ActuatorNetMLPCfg"),
    "lstm": ("lstm", "ActuatorNetLSTMCfg"),
    "gru": ("gru", "ActuatorNetGRUCfg"),
}
"""Ending of the file and class of the client, by shape."""
OF_HISTORY = {"pos_scale": 1.0, "vel_scale": 1.0, "torque_scale": 1.0, "input_order": "pos_vel"}
"""Fields that every client with a history wants: scaling is inside, positions come first."""

_JOINT = {
    "armature": "armature",
    "friction": "friction",
    "dynamic_friction": "friction",
    "viscous_friction": "damping",
}
"""Fields of the simulated joint, which are those of its asset where none is given. Its `damping` is
a gain of the controller, which no network's class reads."""


def export_isaaclab(artefact: Artefact, path: Path) -> Export:
    """Write every form that the estimator has.

    Raises
    ------
    UsageError
        When it needs inputs that Isaac Lab does not give.
    """
    require_inputs(artefact, "Isaac Lab", made=("acceleration",))
    shapes: tuple[Shape, ...] = ("history",)
    if artefact.family == "gru":
        shapes = ("lstm", "gru") if artefact.mode == "streaming" else ("history", "lstm", "gru")
    files: list[WrittenFile] = []
    for shape in shapes:
        _require_room(artefact, shape)
        name = f"{path.name}-isaaclab-{_FORMS[shape][0]}"
        place = path.with_name(f"{name}.pt")
        files += write_shape(artefact, place, shape, _settings(artefact, shape, place.name))
    warnings = streaming_warning(artefact, "Isaac Lab's LSTM or GRU class")
    return Export(tuple(files), warnings if artefact.family == "gru" else ())


def write_shape(
    artefact: Artefact, place: Path, shape: Shape, settings: dict[str, Any]
) -> tuple[WrittenFile, WrittenFile]:
    """Write a TorchScript file, read it back, and write its settings beside it."""
    content = torchscript(artefact, shape)
    _read_back(artefact, place, content, shape)
    return (
        write_atomically(place, content, "torchscript"),
        write_settings(place.with_suffix(".json"), settings),
    )


def _settings(artefact: Artefact, shape: Shape, file: str) -> dict[str, Any]:
    configuration: dict[str, Any] = {"network_file": file}
    configuration |= meaning(artefact).envelope | joint_settings(artefact, _JOINT)
    if shape == "history":
        configuration |= {**OF_HISTORY, "input_idx": list(range(client_history(artefact)))}
    return {
        **metadata(artefact, "window" if shape == "history" else "streaming"),
        "client": "isaaclab 2.3.2" if shape != "gru" else "isaaclab, pull request 6083",
        "class": _FORMS[shape][1],
        "configuration": configuration,
    }


def _require_room(artefact: Artefact, shape: Shape) -> None:
    taps = artefact.differentiator
    if shape != "history" and taps and len(taps.taps) > artefact.hidden:
        raise UsageError(
            f"{artefact.name}: a state of {artefact.hidden} has no room for the "
            f"{len(taps.taps)} velocities of its acceleration; train it with a hidden size of "
            f"{len(taps.taps)} or more, or pv-gru."
        )


def _read_back(artefact: Artefact, place: Path, content: bytes, shape: Shape) -> None:
    """Run the file on two joints at once, each with another motion, against `predict`."""
    import io

    torch = require("torch")
    network = torch.jit.load(io.BytesIO(content))
    length = client_history(artefact) + 5
    motions = [probe(artefact, length, seed) for seed in (0, 1)]
    pairs = np.zeros((2, length, 2))
    for column, name in enumerate(("position_error", "velocity")):
        if name in artefact.inputs:
            pairs[..., column] = [motion[:, artefact.inputs.index(name)] for motion in motions]
    wanted = [_expected(artefact, pair, shape) for pair in pairs]
    inputs = torch.tensor(pairs, dtype=torch.float32)
    with torch.no_grad():
        if shape == "history":
            newest = inputs.flip(1)[:, : client_history(artefact)]
            torque = network(torch.cat([newest[..., 0], newest[..., 1]], 1))
        else:
            spare = 1 if shape == "gru" and artefact.differentiator else 0
            state = torch.zeros(artefact.layers + spare, 2, artefact.hidden)
            kept = (state, torch.zeros_like(state)) if shape == "lstm" else state
            for sample in range(length):
                torque, kept = network(inputs[:, sample : sample + 1], kept)
    require_close(artefact, place, torque.numpy(), np.array([one[-1] for one in wanted]))


def _expected(artefact: Artefact, pair: NDArray[np.float64], shape: Shape) -> NDArray[np.float64]:
    """Torque of one joint's position error and velocity (N, 2), by the plain engine."""
    columns = {"position_error": pair[:, 0], "velocity": pair[:, 1]}
    if artefact.differentiator:
        taps = np.array(artefact.differentiator.taps)
        before = np.concatenate([np.full(len(taps) - 1, pair[0, 1]), pair[:, 1]])
        columns["acceleration"] = np.convolve(before, taps, mode="valid")
    features = np.column_stack([columns[name] for name in artefact.inputs])
    mode: Mode = "window" if shape == "history" else "streaming"
    return predict(artefact, features, engine="plain", mode=mode)
