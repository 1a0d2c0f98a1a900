"""GRU and MLP in plain numpy, double precision, from the weights as trained: judge of the kernels.

Equations: Cho et al. 2014 in torch's form (``torch.nn.GRU``), where the reset gate multiplies the
state's product with its bias.
"""

from __future__ import annotations

import numpy as np

from cqdd_design.torque.data.episodes import FloatArray
from cqdd_design.torque.networks.artefact import Artefact


def scaled(artefact: Artefact, features: FloatArray) -> FloatArray:
    """Features (..., F) as the network sees them."""
    return np.asarray((features - artefact.input_mean) / artefact.input_std, np.float64)


def gru_step(artefact: Artefact, features: FloatArray, state: FloatArray) -> FloatArray:
    """Torque (N,) of one raw sample (N, F); `state` (L, N, H) goes on to the next."""
    inside = scaled(artefact, features)
    for layer in range(artefact.layers):
        from_input = _product(artefact, "ih", layer, inside)
        from_state = _product(artefact, "hh", layer, state[layer])
        reset, update = (_sigmoid(from_input[gate] + from_state[gate]) for gate in (0, 1))
        new = np.tanh(from_input[2] + reset * from_state[2])
        inside = state[layer] = (1.0 - update) * new + update * state[layer]
    weights = artefact.weights
    found = inside @ weights["head_weight"][0].astype(np.float64) + float(weights["head_bias"][0])
    return _torque(artefact, found, features)


def zero_state(artefact: Artefact, count: int) -> FloatArray:
    """State (L, count, H) at the start of a window, or after a reset."""
    return np.zeros((artefact.layers, count, artefact.hidden))


def gru_windows(artefact: Artefact, windows: FloatArray) -> FloatArray:
    """Torque (W,) at the end of each raw window (W, history, F), oldest sample first."""
    state = zero_state(artefact, len(windows))
    found = np.zeros(len(windows))
    for sample in range(windows.shape[1]):
        found = gru_step(artefact, windows[:, sample], state)
    return found


def mlp_windows(artefact: Artefact, windows: FloatArray) -> FloatArray:
    """Torque (W,) at the end of each raw window (W, history, F), oldest sample first."""
    found = scaled(artefact, windows)[:, ::-1].reshape(len(windows), -1)
    for layer in range(artefact.layers + 1):
        weight = artefact.weights[f"weight_{layer}"].astype(np.float64)
        found = found @ weight.T + artefact.weights[f"bias_{layer}"].astype(np.float64)
        if layer < artefact.layers:
            found = activated(artefact.activation, found)
    return _torque(artefact, found[:, 0], windows[:, -1])


def activated(name: str, values: FloatArray) -> FloatArray:
    """The activation function of an MLP."""
    if name == "relu":
        return np.maximum(values, 0.0)
    if name == "tanh":
        return np.tanh(values)
    if name == "softsign":
        return np.asarray(values / (1.0 + np.abs(values)))
    return np.where(values > 0.0, values, np.expm1(np.minimum(values, 0.0)))


def _product(artefact: Artefact, kind: str, layer: int, values: FloatArray) -> FloatArray:
    """Sums (3, N, H) of the gates."""
    weight = artefact.weights[f"weight_{kind}_l{layer}"].astype(np.float64)
    bias = artefact.weights[f"bias_{kind}_l{layer}"].astype(np.float64)
    found = values @ weight.T + bias
    return np.stack(np.split(found, 3, axis=-1))


def _sigmoid(values: FloatArray) -> FloatArray:
    return np.asarray(0.5 + 0.5 * np.tanh(0.5 * values))


def _torque(artefact: Artefact, found: FloatArray, features: FloatArray) -> FloatArray:
    torque = artefact.torque_std * found + artefact.torque_mean
    if artefact.residual:
        torque = torque + features[..., artefact.inputs.index("balance")]
    return np.asarray(torque)
