"""Compiled MLP, float32: weights in one row (`folded.FoldedMlp.flat`)."""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.torque.networks.gru_kernel import add_products, kernel, part, tanh32

_ZERO, _ONE, _HALF, _TWO = np.float32(0.0), np.float32(1.0), np.float32(0.5), np.float32(2.0)
_ELU_LEAST = np.float32(-15.0)


@part
def activate(kind: int, values: Any, count: int) -> None:
    """Apply one of `artefact.ACTIVATIONS` in place, by its number."""
    if kind == 0:
        for j in range(count):
            values[j] = values[j] if values[j] > _ZERO else _ZERO
    elif kind == 1:
        for j in range(count):
            values[j] = tanh32(values[j])
    elif kind == 2:
        for j in range(count):
            values[j] = values[j] / (_ONE + abs(values[j]))
    else:
        for j in range(count):
            # exp(x) - 1 by the tangent of half of it, without loss near zero.
            t = tanh32(_HALF * max(values[j], _ELU_LEAST))
            values[j] = values[j] if values[j] > _ZERO else _TWO * t / (_ONE - t)


@kernel
def window(
    weights: Any, newest_first: Any, layers: int, width: int, kind: int, scratch: Any
) -> Any:
    """Torque of one flattened raw window (T F,), newest sample first; `scratch` (2, H)."""
    rows, start = newest_first.shape[0], 0
    for layer in range(layers):
        now, before = scratch[layer % 2], scratch[(layer + 1) % 2]
        bias = start + rows * width
        for j in range(width):
            now[j] = weights[bias + j]
        if layer == 0:
            add_products(weights[start:bias], newest_first, now, rows, width)
        else:
            add_products(weights[start:bias], before, now, width, width)
        activate(kind, now, width)
        start, rows = bias + width, width
    last = scratch[(layers + 1) % 2]
    found = weights[start + width]
    for j in range(width):
        found += weights[start + j] * last[j]
    return found


@kernel
def windows(weights: Any, samples: Any, layers: int, width: int, kind: int, torque: Any) -> None:
    """Torque (W,) at the end of raw windows (W, T, F), oldest sample first."""
    count, length, features = samples.shape
    flat = np.zeros(length * features, np.float32)
    scratch = np.zeros((2, width), np.float32)
    for number in range(count):
        for lag in range(length):
            for row in range(features):
                flat[lag * features + row] = samples[number, length - 1 - lag, row]
        torque[number] = window(weights, flat, layers, width, kind, scratch)
