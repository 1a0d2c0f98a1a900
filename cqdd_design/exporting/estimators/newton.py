"""A GRU for Newton 1.8's ``DriveNeuralGRU``: ONNX with the metadata that its loader asks for.

The loader reads the weights from the graph and runs them itself, so it accepts one shape of graph
only: GRU nodes with ``linear_before_reset = 1`` and layout 0, each with a state of its own as a
graph input [1, N, H], nothing but squeezes between them, and one Gemm with bias. Scaling stands in
the metadata, not in the weights. The drive checks the simulation's time step against
``sample_dt_s`` and refuses another. Acceleration is the one custom input it allows: the application
writes it into the control array of that name, made with ``acceleration_taps_per_s``.
(newton 1.8.0, ``newton/_src/actuators/drives/drive_neural_gru.py``)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.onnx import Graph, gru_node
from cqdd_design.exporting.estimators.options import (
    Export,
    metadata,
    require_inputs,
    streaming_warning,
)
from cqdd_design.files import write_atomically

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.torque.networks.artefact import Artefact


def export_newton(artefact: Artefact, path: Path) -> Export:
    """Write ``NAME-newton.onnx``."""
    place = path.with_name(f"{path.name}-newton.onnx")
    warnings = streaming_warning(artefact, "Newton") if artefact.family == "gru" else ()
    if "acceleration" in artefact.inputs:
        warnings += (
            "Newton computes no acceleration: the application writes it into the control array "
            "'acceleration' every step, from the last velocities with the metadata's "
            "'acceleration_taps_per_s'.",
        )
    return Export((write_atomically(place, newton_model(artefact), "newton"),), warnings)


def newton_model(artefact: Artefact) -> bytes:
    """The ONNX file.

    Raises
    ------
    UsageError
        For an MLP, or inputs that Newton cannot feed.
    """
    if artefact.family != "gru":
        raise UsageError(
            f"{artefact.name} is an MLP, and newton's DriveNeuralGRU takes a GRU; export it --to "
            "onnx or torchscript-isaaclab, or train pv-gru or pva-gru."
        )
    require_inputs(artefact, "Newton", made=("acceleration",))
    graph = Graph()
    width, count = artefact.hidden, len(artefact.inputs)
    direction = graph.constant("direction_axis", [1], np.int64)
    time = graph.constant("time_axis", [0], np.int64)
    values, states = "features", [f"initial_h_{layer}" for layer in range(artefact.layers)]
    for layer, state in enumerate(states):
        sequence = gru_node(graph, artefact, layer, values, state, fold=False)
        values = graph.node("Squeeze", [sequence, direction], [f"values_{layer}"])
    last = graph.node("Squeeze", [values, time], ["last"])
    head = graph.constant("head", artefact.weights["head_weight"])
    bias = graph.constant("head_bias", artefact.weights["head_bias"])
    graph.node("Gemm", [last, head, bias], ["torque"], transB=1)
    means = dict(zip(artefact.inputs, artefact.input_mean, strict=True))
    stds = dict(zip(artefact.inputs, artefact.input_std, strict=True))
    told = metadata(artefact, "streaming") | {
        "input_columns": list(artefact.inputs),
        "custom_inputs": ["acceleration"] if "acceleration" in artefact.inputs else [],
        "normalization": {
            "inputs": {"mean": means, "std": stds},
            "targets": {
                "mean": {"torque": artefact.torque_mean},
                "std": {"torque": artefact.torque_std},
            },
        },
    }
    return graph.serialised(
        "drive",
        [
            graph.value("features", [1, "N", count]),
            *(graph.value(state, [1, "N", width]) for state in states),
        ],
        [
            graph.value("torque", ["N", 1]),
            *(graph.value(f"state_{layer}", [1, "N", width]) for layer in range(artefact.layers)),
        ],
        told,
    )
