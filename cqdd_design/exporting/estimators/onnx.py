"""An estimator as plain ONNX, for onnxruntime and its kin: one step with its state, or a window.

``NAME-streaming.onnx``: features (N, F), hidden (L, N, H) to torque (N,), hidden_out (L, N, H).
``NAME-window.onnx``: window (N, history, F), oldest sample first, to torque (N,).

Features are raw, in the order of the metadata's ``inputs``: scaling is folded into the weights (in
double precision), the balance that a residual corrects is added. An acceleration is a feature like
others, made by the caller with the metadata's taps. Operators: ONNX opset 17, GRU with
``linear_before_reset = 1``, gates update, reset, new.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.exporting.estimators.options import (
    Export,
    metadata,
    probe,
    require,
    require_close,
)
from cqdd_design.files import write_atomically
from cqdd_design.torque.networks import plain
from cqdd_design.torque.networks.predict import predict, predict_windows

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from cqdd_design.torque.networks.artefact import Artefact, Mode

OPSET, IR_VERSION = 17, 8
_ACTIVATIONS = {"relu": "Relu", "tanh": "Tanh", "softsign": "Softsign", "elu": "Elu"}


class Graph:
    """Nodes and constants of a graph that grows from its inputs to its output."""

    def __init__(self) -> None:
        self.onnx = require("onnx")
        self.nodes: list[Any] = []
        self.constants: list[Any] = []

    def constant(self, name: str, values: Any, kind: Any = np.float32) -> str:
        """Keep a constant; returns its name."""
        array = np.array(values, kind, order="C")
        self.constants.append(self.onnx.numpy_helper.from_array(array, name))
        return name

    def node(self, kind: str, inputs: list[str], outputs: list[str], **attributes: Any) -> str:
        """Add a node; returns its first output."""
        self.nodes.append(self.onnx.helper.make_node(kind, inputs, outputs, **attributes))
        return next(name for name in outputs if name)

    def value(self, name: str, shape: list[int | str]) -> Any:
        """Declare a float32 input or output."""
        return self.onnx.helper.make_tensor_value_info(name, self.onnx.TensorProto.FLOAT, shape)

    def serialised(self, name: str, inputs: list[Any], outputs: list[Any], told: Any) -> bytes:
        """The checked model, with its metadata as JSON under the key ``metadata``."""
        helper = self.onnx.helper
        graph = helper.make_graph(self.nodes, name, inputs, outputs, self.constants)
        model = helper.make_model(
            graph,
            opset_imports=[helper.make_opsetid("", OPSET)],
            ir_version=IR_VERSION,
            producer_name="cqdd-design",
        )
        helper.set_model_props(model, {"metadata": json.dumps(told, allow_nan=False)})
        self.onnx.checker.check_model(model, full_check=True)
        return bytes(model.SerializeToString(deterministic=True))


def export_onnx(artefact: Artefact, path: Path) -> Export:
    """Write the forms that the family knows, and read them back with onnxruntime."""
    files = []
    forms: tuple[Mode, ...] = ("streaming", "window") if artefact.family == "gru" else ("window",)
    for mode in forms:
        place = path.with_name(f"{path.name}-{mode}.onnx")
        text = streaming_model(artefact) if mode == "streaming" else window_model(artefact)
        _read_back(artefact, place, text, mode)
        files.append(write_atomically(place, text, "onnx"))
    return Export(tuple(files))


def gru_node(
    graph: Graph, artefact: Artefact, layer: int, inside: str, state: str, *, fold: bool
) -> str:
    """Add one GRU layer; returns its sequence (T, 1, N, H); the last state is ``state_L``."""
    weights = artefact.weights
    width = artefact.hidden
    from_input, from_state, bias_input, bias_state = (
        weights[f"{name}_l{layer}"].astype(np.float64)
        for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
    )
    if fold and layer == 0:
        mean, std = np.array(artefact.input_mean), np.array(artefact.input_std)
        bias_input = bias_input - from_input @ (mean / std)
        from_input = from_input / std
    both = np.concatenate([_update_first(bias_input, width), _update_first(bias_state, width)])
    return graph.node(
        "GRU",
        [
            inside,
            graph.constant(f"input_weights_{layer}", _update_first(from_input, width)[None]),
            graph.constant(f"state_weights_{layer}", _update_first(from_state, width)[None]),
            graph.constant(f"biases_{layer}", both[None]),
            "",
            state,
        ],
        [f"sequence_{layer}", f"state_{layer}"],
        hidden_size=width,
        linear_before_reset=1,
    )


def _update_first(values: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    """Gates reset, update, new in ONNX's order: update, reset, new."""
    return np.concatenate([values[width : 2 * width], values[:width], values[2 * width :]])


def _head(graph: Graph, artefact: Artefact, values: str, newest: str) -> None:
    """From (N, H) to the output ``torque`` (N,)."""
    weight, bias = "head_weight", "head_bias"
    if artefact.family != "gru":
        weight, bias = f"weight_{artefact.layers}", f"bias_{artefact.layers}"
    scaled = artefact.torque_std * artefact.weights[weight].astype(np.float64)
    offset = artefact.torque_std * artefact.weights[bias].astype(np.float64) + artefact.torque_mean
    column = graph.node(
        "Gemm",
        [values, graph.constant("head", scaled), graph.constant("head_bias", offset)],
        ["column"],
        transB=1,
    )
    axis = graph.constant("last_axis", [1], np.int64)
    if not artefact.residual:
        graph.node("Squeeze", [column, axis], ["torque"])
        return
    bare = graph.node("Squeeze", [column, axis], ["uncorrected"])
    place = graph.constant("balance_at", artefact.inputs.index("balance"), np.int64)
    balance = graph.node("Gather", [newest, place], ["balance"], axis=1)
    graph.node("Add", [bare, balance], ["torque"])


def streaming_model(artefact: Artefact) -> bytes:
    """One step of a GRU with its state."""
    graph = Graph()
    layers, width, count = artefact.layers, artefact.hidden, len(artefact.inputs)
    time = graph.constant("time_axis", [0], np.int64)
    direction = graph.constant("direction_axis", [1], np.int64)
    states = [f"hidden_{layer}" for layer in range(layers)]
    if layers > 1:
        sizes = graph.constant("one_each", [1] * layers, np.int64)
        graph.node("Split", ["hidden", sizes], states, axis=0)
    else:
        states = ["hidden"]
    values = graph.node("Unsqueeze", ["features", time], ["sample"])
    for layer in range(layers):
        sequence = gru_node(graph, artefact, layer, values, states[layer], fold=True)
        values = graph.node("Squeeze", [sequence, direction], [f"values_{layer}"])
    following = [f"state_{layer}" for layer in range(layers)]
    graph.node("Concat", following, ["hidden_out"], axis=0)
    last = graph.node("Squeeze", [values, time], ["last"])
    _head(graph, artefact, last, "features")
    return graph.serialised(
        "streaming",
        [graph.value("features", ["N", count]), graph.value("hidden", [layers, "N", width])],
        [graph.value("torque", ["N"]), graph.value("hidden_out", [layers, "N", width])],
        metadata(artefact, "streaming"),
    )


def window_model(artefact: Artefact) -> bytes:
    """A whole window from a zero state, or an MLP."""
    graph = Graph()
    count, history = len(artefact.inputs), artefact.history
    newest = ""
    if artefact.residual:
        at = graph.constant("newest_at", history - 1, np.int64)
        newest = graph.node("Gather", ["window", at], ["newest"], axis=1)
    if artefact.family == "gru":
        direction = graph.constant("direction_axis", [1], np.int64)
        time = graph.constant("time_axis", [0], np.int64)
        values = graph.node("Transpose", ["window"], ["samples"], perm=[1, 0, 2])
        for layer in range(artefact.layers):
            sequence = gru_node(graph, artefact, layer, values, "", fold=True)
            values = graph.node("Squeeze", [sequence, direction], [f"values_{layer}"])
        last = graph.node("Squeeze", [f"state_{artefact.layers - 1}", time], ["last"])
    else:
        backwards = graph.constant("backwards", range(history - 1, -1, -1), np.int64)
        newest_first = graph.node("Gather", ["window", backwards], ["newest_first"], axis=1)
        last = graph.node("Flatten", [newest_first], ["flat"], axis=1)
        mean = np.tile(artefact.input_mean, history)
        std = np.tile(artefact.input_std, history)
        for layer in range(artefact.layers):
            weight = artefact.weights[f"weight_{layer}"].astype(np.float64)
            bias = artefact.weights[f"bias_{layer}"].astype(np.float64)
            if layer == 0:
                bias, weight = bias - weight @ (mean / std), weight / std
            sums = graph.node(
                "Gemm",
                [
                    last,
                    graph.constant(f"weight_{layer}", weight),
                    graph.constant(f"bias_{layer}", bias),
                ],
                [f"sums_{layer}"],
                transB=1,
            )
            last = graph.node(_ACTIVATIONS[artefact.activation], [sums], [f"values_{layer}"])
    _head(graph, artefact, last, newest)
    return graph.serialised(
        "window",
        [graph.value("window", ["N", history, count])],
        [graph.value("torque", ["N"])],
        metadata(artefact, "window"),
    )


def _read_back(artefact: Artefact, path: Path, model: bytes, mode: Mode) -> None:
    runtime = require("onnxruntime")
    options = runtime.SessionOptions()
    options.intra_op_num_threads = 1
    session = runtime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
    if mode == "window":
        windows = probe(artefact, 3 * artefact.history).reshape(3, artefact.history, -1)
        (found,) = session.run(None, {"window": windows.astype(np.float32)})
        wanted = predict_windows(artefact, windows, engine="plain")
    else:
        features = probe(artefact, 8)
        hidden = plain.zero_state(artefact, 1).astype(np.float32)
        torques = []
        for row in features.astype(np.float32):
            torque, hidden = session.run(None, {"features": row[None], "hidden": hidden})
            torques.append(torque[0])
        found = np.array(torques)
        wanted = predict(artefact, features, engine="plain", mode="streaming")
    require_close(artefact, path, found, wanted)
