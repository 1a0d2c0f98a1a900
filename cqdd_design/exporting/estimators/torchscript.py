"""Estimators as torch modules of the shapes that simulators load, scaling inside.

Three shapes, all taking the joint's position error and velocity and nothing else:

- history: (N, 2 k), k position errors newest first, then k velocities newest first, to (N, 1). Any
  estimator of windows; an acceleration is made from the velocities, for which k is longer than the
  window by the differentiator's taps less one.
- lstm: x (N, 1, 2), (h, c) to torque (N, 1), (h, c): a GRU in the place of an LSTM. The cell state,
  which a GRU has not, carries the last velocities for the acceleration.
- gru: x (N, 1, 2), h to torque (N, 1), h. With acceleration one spare layer, of zero weights,
  carries the velocities.

In both stateful shapes a state of zeros is a reset: the first velocity then stands for those before
it, and the acceleration begins at zero.
"""

from __future__ import annotations

import io
import json
import warnings
from typing import TYPE_CHECKING, Any, Literal

from cqdd_design.exporting.estimators.options import metadata, require

if TYPE_CHECKING:
    from cqdd_design.torque.networks.artefact import Artefact, Mode

Shape = Literal["history", "lstm", "gru"]
_BATCH = 3


def client_history(artefact: Artefact) -> int:
    """Samples that a client with a history must keep."""
    taps = artefact.differentiator
    return artefact.history + (len(taps.taps) - 1 if taps else 0)


def torchscript(artefact: Artefact, shape: Shape) -> bytes:
    """The TorchScript file, with ``metadata.json`` in it."""
    torch = require("torch")
    with warnings.catch_warnings(), torch.no_grad():
        # TorchScript is what the clients load, deprecated in torch or not.
        warnings.simplefilter("ignore")
        module = _module(torch, artefact, shape).eval()
        width, layers = artefact.hidden, artefact.layers
        if shape == "history":
            example: Any = (torch.zeros(_BATCH, 2 * client_history(artefact)),)
        else:
            spare = 1 if shape == "gru" and artefact.differentiator else 0
            state = torch.zeros(layers + spare, _BATCH, width)
            pair = (state, torch.zeros_like(state)) if shape == "lstm" else state
            example = (torch.zeros(_BATCH, 1, 2), pair)
        traced = torch.jit.trace(module, example, check_trace=False)
        buffer = io.BytesIO()
        mode: Mode = "window" if shape == "history" else "streaming"
        told = json.dumps(metadata(artefact, mode), allow_nan=False)
        torch.jit.save(traced, buffer, _extra_files={"metadata.json": told})
        return _without_sources(torch, buffer)


def _without_sources(torch: Any, file: io.BytesIO) -> bytes:
    """The file without its debug entries, which hold places of source files on this machine.

    By torch's own archive, which puts tensors where they can be mapped; it writes what it needs of
    itself, version and identity, anew.
    """
    file.seek(0)
    found, reader = io.BytesIO(), torch._C.PyTorchFileReader(file)
    writer = torch._C.PyTorchFileWriter(found)
    for name in reader.get_all_records():
        if not name.endswith(".debug_pkl") and name not in ("version", ".data/serialization_id"):
            content = reader.get_record(name)
            writer.write_record(name, content, len(content))
    writer.write_end_of_file()
    return found.getvalue()


def _module(torch: Any, artefact: Artefact, shape: Shape) -> Any:
    forward = {"history": _history, "lstm": _lstm, "gru": _gru}[shape](torch, artefact)
    # Built by type(): a class statement would need torch at import.
    module = type("Estimator", (torch.nn.Module,), {"forward": forward})()
    for name, values in (
        ("mean", artefact.input_mean),
        ("std", artefact.input_std),
        ("torque_scale", (artefact.torque_mean, artefact.torque_std)),
        ("taps", artefact.differentiator.taps if artefact.differentiator else ()),
    ):
        module.register_buffer(name, torch.tensor(values, dtype=torch.float32))
    if artefact.family == "mlp":
        module.layers = _dense(torch, artefact)
        return module
    spare = 1 if shape == "gru" and artefact.differentiator else 0
    recurrent = torch.nn.GRU(
        len(artefact.inputs), artefact.hidden, artefact.layers + spare, batch_first=True
    )
    for name, parameter in recurrent.named_parameters():
        own = artefact.weights.get(name)
        parameter.copy_(torch.zeros_like(parameter) if own is None else torch.tensor(own))
    setattr(module, "recurrent" if shape == "history" else shape, recurrent)
    module.head = torch.nn.Linear(artefact.hidden, 1)
    module.head.weight.copy_(torch.tensor(artefact.weights["head_weight"]))
    module.head.bias.copy_(torch.tensor(artefact.weights["head_bias"]))
    return module


def _dense(torch: Any, artefact: Artefact) -> Any:
    kinds = {
        "relu": torch.nn.ReLU,
        "tanh": torch.nn.Tanh,
        "softsign": torch.nn.Softsign,
        "elu": torch.nn.ELU,
    }
    layers = []
    for layer in range(artefact.layers + 1):
        weight = torch.tensor(artefact.weights[f"weight_{layer}"])
        linear = torch.nn.Linear(weight.shape[1], weight.shape[0])
        linear.weight.copy_(weight)
        linear.bias.copy_(torch.tensor(artefact.weights[f"bias_{layer}"]))
        layers += [linear, kinds[artefact.activation]()]
    return torch.nn.Sequential(*layers[:-1])


def _history(torch: Any, artefact: Artefact) -> Any:
    kept, length, gru = client_history(artefact), artefact.history, artefact.family == "gru"

    def forward(self: Any, x: Any) -> Any:
        error, velocity = x[:, :kept], x[:, kept:]
        columns = {"position_error": error[:, :length], "velocity": velocity[:, :length]}
        if artefact.differentiator:
            spans = velocity.unfold(1, len(artefact.differentiator.taps), 1)
            columns["acceleration"] = (spans * self.taps).sum(-1)
        features = torch.stack([columns[name] for name in artefact.inputs], -1)
        scaled = (features - self.mean) / self.std
        if gru:
            sequence, _ = self.recurrent(scaled.flip(1))
            found = self.head(sequence[:, -1])
        else:
            found = self.layers(scaled.flatten(1))
        return found * self.torque_scale[1] + self.torque_scale[0]

    return forward


def _features(torch: Any, artefact: Artefact, module: Any, x: Any, carried: Any) -> tuple[Any, Any]:
    """Scaled sample (N, 1, F), and what to carry (N, H), from what was carried (N, H)."""
    columns = {"position_error": x[:, 0, 0], "velocity": x[:, 0, 1]}
    following = carried
    if artefact.differentiator:
        before = len(artefact.differentiator.taps) - 1
        now = columns["velocity"].unsqueeze(1)
        past, seen = carried[:, :before], carried[:, before : before + 1]
        past = past * seen + now * (1.0 - seen)
        span = torch.cat([now, past], 1)
        columns["acceleration"] = (span * module.taps).sum(1)
        following = torch.cat([span[:, :before], torch.ones_like(now), carried[:, before + 1 :]], 1)
    features = torch.stack([columns[name] for name in artefact.inputs], -1)
    return ((features - module.mean) / module.std).unsqueeze(1), following


def _lstm(torch: Any, artefact: Artefact) -> Any:
    def forward(self: Any, x: Any, state: tuple[Any, Any]) -> Any:
        hidden, cell = state
        sample, carried = _features(torch, artefact, self, x, cell[0])
        sequence, hidden = self.lstm(sample, hidden)
        found = self.head(sequence[:, 0]) * self.torque_scale[1] + self.torque_scale[0]
        return found, (hidden, torch.cat([carried.unsqueeze(0), cell[1:]], 0))

    return forward


def _gru(torch: Any, artefact: Artefact) -> Any:
    layers = artefact.layers

    def forward(self: Any, x: Any, hidden: Any) -> Any:
        sample, carried = _features(torch, artefact, self, x, hidden[-1])
        _, following = self.gru(sample, hidden)
        found = self.head(following[layers - 1]) * self.torque_scale[1] + self.torque_scale[0]
        if artefact.differentiator:
            following = torch.cat([following[:layers], carried.unsqueeze(0)], 0)
        return found, following

    return forward
