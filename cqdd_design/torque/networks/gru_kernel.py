"""Compiled GRU, float32: one step with its state, one window, many windows side by side.

Weights come in one row (`folded.FoldedGru.flat`), so that a call from Python passes few arrays. The
sums of a layer run along memory and vectorise; many windows run with one window in each lane.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.files.kernel_cache import numba

FAST = {"contract", "arcp", "nsz"}
LANES = 64
"""Windows side by side: their sums stay in the first cache."""

part = numba.njit(cache=True, error_model="numpy", fastmath=FAST, inline="always")
kernel = numba.njit(cache=True, error_model="numpy", fastmath=FAST, nogil=True)

_ONE, _HALF, _MOST = np.float32(1.0), np.float32(0.5), np.float32(7.9)
# Odd over even polynomial in x, fitted for the least greatest error on -7.9 to 7.9 (5e-9; Lawson
# weights): within 4e-7 of tanh in single precision.
_P0, _P2, _P4, _P6, _P8 = (
    np.float32(value)
    for value in (
        9.999999735524e-01,
        1.344445238474e-01,
        3.571696820808e-03,
        2.190343166127e-05,
        1.525970469056e-08,
    )
)
_Q2, _Q4, _Q6, _Q8 = (
    np.float32(value)
    for value in (4.677777456271e-01, 2.616441584427e-02, 3.411743444418e-04, 8.530556767722e-07)
)


@part
def tanh32(x: Any) -> Any:
    """Hyperbolic tangent in single precision."""
    x = _MOST if x > _MOST else x
    x = -_MOST if x < -_MOST else x
    y = x * x
    p = ((((_P8 * y + _P6) * y + _P4) * y + _P2) * y + _P0) * x
    return p / ((((_Q8 * y + _Q6) * y + _Q4) * y + _Q2) * y + _ONE)


@part
def add_products(weights: Any, values: Any, sums: Any, rows: int, columns: int) -> None:
    """Add values (rows,) times weights (rows times columns, in one row) to sums (columns,)."""
    row = 0
    while row + 4 <= rows:
        a, b, c, d = values[row], values[row + 1], values[row + 2], values[row + 3]
        w0 = weights[row * columns : (row + 1) * columns]
        w1 = weights[(row + 1) * columns : (row + 2) * columns]
        w2 = weights[(row + 2) * columns : (row + 3) * columns]
        w3 = weights[(row + 3) * columns : (row + 4) * columns]
        for j in range(columns):
            sums[j] = sums[j] + w0[j] * a + w1[j] * b + w2[j] * c + w3[j] * d
        row += 4
    while row < rows:
        a = values[row]
        w0 = weights[row * columns : (row + 1) * columns]
        for j in range(columns):
            sums[j] = sums[j] + w0[j] * a
        row += 1


@part
def layer_step(
    weights: Any, start: int, values: Any, rows: int, state: Any, sums: Any, width: int
) -> None:
    """One layer, one step: `state` (H,) from `values` (rows,) and itself."""
    across = start + 3 * width * rows
    bias = across + 3 * width * width
    for j in range(4 * width):
        sums[j] = weights[bias + j]
    add_products(weights[start:across], values, sums[: 3 * width], rows, 3 * width)
    add_products(weights[across:bias], state, sums[width : 4 * width], width, 3 * width)
    for j in range(width):
        reset = _HALF + _HALF * tanh32(sums[width + j])
        update = _HALF + _HALF * tanh32(sums[2 * width + j])
        new = tanh32(sums[j] + reset * sums[3 * width + j])
        state[j] = new + update * (state[j] - new)


@part
def head(weights: Any, start: int, values: Any, width: int) -> Any:
    """The last layer's sum, N m."""
    found = weights[start + width]
    for j in range(width):
        found += weights[start + j] * values[j]
    return found


@kernel
def step(weights: Any, features: Any, state: Any, sums: Any) -> Any:
    """Torque (N m) of one raw sample (F,); `state` (L, H) goes on; `sums` (4H,) is scratch."""
    layers, width = state.shape
    rows, start = features.shape[0], 0
    layer_step(weights, 0, features, rows, state[0], sums, width)
    start = 3 * width * (rows + width) + 4 * width
    for layer in range(1, layers):
        layer_step(weights, start, state[layer - 1], width, state[layer], sums, width)
        start += 6 * width * width + 4 * width
    return head(weights, start, state[layers - 1], width)


@kernel
def steps(weights: Any, features: Any, state: Any, torque: Any) -> None:
    """Torque (N,) of samples (N, F) one after the other, the state (L, H) kept."""
    sums = np.zeros(4 * state.shape[1], np.float32)
    for sample in range(features.shape[0]):
        torque[sample] = step(weights, features[sample], state, sums)


@kernel
def window(weights: Any, samples: Any, state: Any) -> Any:
    """Torque at the end of one raw window (T, F) from a zero state; a layer at a time.

    A layer's weights then stay in the first cache over all its steps.
    """
    layers, width = state.shape
    length, rows = samples.shape
    sums = np.zeros(4 * width, np.float32)
    values = np.zeros((length, width), np.float32)
    start = 0
    for layer in range(layers):
        now = state[layer]
        now[:] = np.float32(0.0)
        for sample in range(length):
            if layer == 0:
                layer_step(weights, start, samples[sample], rows, now, sums, width)
            else:
                layer_step(weights, start, values[sample], width, now, sums, width)
            values[sample] = now
        start += 3 * width * ((rows if layer == 0 else width) + width) + 4 * width
    return head(weights, start, values[length - 1], width)


@part
def add_lanes(
    weights: Any, place: int, gap: int, values: Any, rows: int, a: Any, b: Any, c: Any
) -> None:
    """Add, in every lane, values (rows, LANES) times three columns of weights to three sums.

    The first column begins at `place`; the next two stand `gap`, the layer's width, apart.
    """
    row, stride = 0, 3 * gap
    while row + 4 <= rows:
        p0, p1 = place + row * stride, place + (row + 1) * stride
        p2, p3 = place + (row + 2) * stride, place + (row + 3) * stride
        a0, a1, a2, a3 = weights[p0], weights[p1], weights[p2], weights[p3]
        b0, b1, b2, b3 = weights[p0 + gap], weights[p1 + gap], weights[p2 + gap], weights[p3 + gap]
        c0, c1 = weights[p0 + 2 * gap], weights[p1 + 2 * gap]
        c2, c3 = weights[p2 + 2 * gap], weights[p3 + 2 * gap]
        for s in range(LANES):
            v0, v1, v2, v3 = (
                values[row, s],
                values[row + 1, s],
                values[row + 2, s],
                values[row + 3, s],
            )
            a[s] = a[s] + a0 * v0 + a1 * v1 + a2 * v2 + a3 * v3
            b[s] = b[s] + b0 * v0 + b1 * v1 + b2 * v2 + b3 * v3
            c[s] = c[s] + c0 * v0 + c1 * v1 + c2 * v2 + c3 * v3
        row += 4
    while row < rows:
        p0 = place + row * stride
        a0, b0, c0 = weights[p0], weights[p0 + gap], weights[p0 + 2 * gap]
        for s in range(LANES):
            v0 = values[row, s]
            a[s] = a[s] + a0 * v0
            b[s] = b[s] + b0 * v0
            c[s] = c[s] + c0 * v0
        row += 1


@kernel
def windows(weights: Any, samples: Any, layers: int, width: int, torque: Any) -> None:
    """Torque (W,) at the end of raw windows (W, T, F), each from a zero state."""
    count, length, features = samples.shape
    wide = max(width, features)
    values = np.zeros((length, wide, LANES), np.float32)
    following = np.zeros((width, LANES), np.float32)
    zero = np.zeros((width, LANES), np.float32)
    n, r = np.zeros(LANES, np.float32), np.zeros(LANES, np.float32)
    z, m = np.zeros(LANES, np.float32), np.zeros(LANES, np.float32)
    for first in range(0, count, LANES):
        lanes = min(LANES, count - first)
        for s in range(lanes):
            for sample in range(length):
                for row in range(features):
                    values[sample, row, s] = samples[first + s, sample, row]
        start = 0
        for layer in range(layers):
            rows = features if layer == 0 else width
            across = start + 3 * width * rows
            bias = across + 3 * width * width
            for sample in range(length):
                before = zero if sample == 0 else values[sample - 1]
                for j in range(width):
                    n[:], r[:] = weights[bias + j], weights[bias + width + j]
                    z[:], m[:] = weights[bias + 2 * width + j], weights[bias + 3 * width + j]
                    add_lanes(weights, start + j, width, values[sample], rows, n, r, z)
                    add_lanes(weights, across + j, width, before, width, r, z, m)
                    for s in range(LANES):
                        reset = _HALF + _HALF * tanh32(r[s])
                        update = _HALF + _HALF * tanh32(z[s])
                        new = tanh32(n[s] + reset * m[s])
                        following[j, s] = new + update * (before[j, s] - new)
                for j in range(width):
                    for s in range(LANES):
                        values[sample, j, s] = following[j, s]
            start = bias + 4 * width
        for s in range(lanes):
            found = weights[start + width]
            for j in range(width):
                found += weights[start + j] * values[length - 1, j, s]
            torque[first + s] = found
