"""An estimator's weights made ready to run: scaling folded in, columns in the order of the sums.

Scaling is folded in double precision: (x - mean)/std into the first layer, std times y plus mean
into the head. Weights stand input-major ("k-major"), so that one input adds to all sums of a layer
along memory.

A GRU's four sums of a layer stand as new (from the input), reset, update, new (from the state): the
input adds to the first three, the state to the last three. Reset and update are halved, because
sigmoid(x) = 1/2 + tanh(x/2)/2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.torque.networks.artefact import Artefact

Float32Array = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class FoldedLayer:
    """One GRU layer: input (I, 3H) for new, reset, update, state (H, 3H) for reset, update, new.

    The bias (4H,) is that of the four sums.
    """

    input: Float32Array
    state: Float32Array
    bias: Float32Array


@dataclass(frozen=True, eq=False)
class FoldedGru:
    """A GRU of raw features to N m."""

    layers: tuple[FoldedLayer, ...]
    head: Float32Array
    head_bias: float

    @property
    def flat(self) -> Float32Array:
        """All numbers in one row: of each layer input, state and bias; then the head."""
        parts = (part for one in self.layers for part in (one.input, one.state, one.bias))
        return _row(*parts, self.head, np.float32(self.head_bias))


@dataclass(frozen=True, eq=False)
class FoldedMlp:
    """An MLP of raw features to N m: weights (in, out) and biases (out,) of the hidden layers.

    The first takes the window newest sample first.
    """

    weights: tuple[Float32Array, ...]
    biases: tuple[Float32Array, ...]
    head: Float32Array
    head_bias: float

    @property
    def flat(self) -> Float32Array:
        """All numbers in one row: of each layer weights and bias; then the head."""
        parts = (part for pair in zip(self.weights, self.biases, strict=True) for part in pair)
        return _row(*parts, self.head, np.float32(self.head_bias))


def _row(*parts: NDArray[np.float32] | np.float32) -> Float32Array:
    return np.concatenate([np.ravel(part) for part in parts])


def folded_gru(artefact: Artefact) -> FoldedGru:
    """Weights of a GRU, ready to run."""
    width = artefact.hidden
    mean, std = np.array(artefact.input_mean), np.array(artefact.input_std)
    layers = []
    for layer in range(artefact.layers):
        inside, across, bias_in, bias_across = (
            artefact.weights[f"{name}_l{layer}"].astype(np.float64)
            for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
        )
        if layer == 0:
            bias_in = bias_in - inside @ (mean / std)
            inside = inside / std
        reset, update, new = (slice(gate * width, (gate + 1) * width) for gate in range(3))
        both = 0.5 * (bias_in + bias_across)
        layers.append(
            FoldedLayer(
                _single(np.vstack([inside[new], 0.5 * inside[reset], 0.5 * inside[update]]).T),
                _single(np.vstack([0.5 * across[reset], 0.5 * across[update], across[new]]).T),
                _single(
                    np.concatenate([bias_in[new], both[reset], both[update], bias_across[new]])
                ),
            )
        )
    return FoldedGru(tuple(layers), *_folded_head(artefact, "head_weight", "head_bias"))


def folded_mlp(artefact: Artefact) -> FoldedMlp:
    """Weights of an MLP, ready to run."""
    mean = np.tile(artefact.input_mean, artefact.history)
    std = np.tile(artefact.input_std, artefact.history)
    weights, biases = [], []
    for layer in range(artefact.layers):
        weight = artefact.weights[f"weight_{layer}"].astype(np.float64)
        bias = artefact.weights[f"bias_{layer}"].astype(np.float64)
        if layer == 0:
            bias = bias - weight @ (mean / std)
            weight = weight / std
        weights.append(_single(weight.T))
        biases.append(_single(bias))
    last = artefact.layers
    head = _folded_head(artefact, f"weight_{last}", f"bias_{last}")
    return FoldedMlp(tuple(weights), tuple(biases), *head)


def _folded_head(artefact: Artefact, weight: str, bias: str) -> tuple[Float32Array, float]:
    head = artefact.torque_std * artefact.weights[weight][0].astype(np.float64)
    offset = artefact.torque_std * float(artefact.weights[bias][0]) + artefact.torque_mean
    return _single(head), float(np.float32(offset))


def _single(values: NDArray[np.float64]) -> Float32Array:
    return np.ascontiguousarray(values, np.float32)
