"""Run an estimator: over an episode, or one sample at a time with its state kept; without torch.

Two engines: ``compiled`` (numba, float32) and ``plain`` (numpy, double precision), which a test
compares.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import FloatArray
from cqdd_design.torque.networks import plain
from cqdd_design.torque.networks.artefact import ACTIVATIONS, Artefact, Mode
from cqdd_design.torque.networks.folded import folded_gru, folded_mlp

Engine = Literal["compiled", "plain"]


def predict(
    artefact: Artefact,
    features: ArrayLike,
    *,
    engine: Engine = "compiled",
    mode: Mode | None = None,
) -> FloatArray:
    """Torque at each sample of one episode.

    Parameters
    ----------
    features : array (N, F)
        Raw, unscaled features in the order of ``artefact.inputs``.
    engine : {"compiled", "plain"}
    mode : {"window", "streaming"}, optional
        Default the one the network was trained for. An MLP knows windows only.

    Returns
    -------
    array (N,)
        N m. In window mode the first ``history - 1`` samples have no window and are nan.

    Raises
    ------
    UsageError
        When the features do not fit the network or are not finite.
    """
    raw = _checked(artefact, features)
    if _mode(artefact, mode) == "streaming":
        return _streamed(artefact, raw, engine)
    found = np.full(len(raw), math.nan)
    if len(raw) >= artefact.history:
        view = np.lib.stride_tricks.sliding_window_view(raw, artefact.history, axis=0)
        found[artefact.history - 1 :] = predict_windows(
            artefact, np.swapaxes(view, 1, 2), engine=engine
        )
    return found


def predict_windows(
    artefact: Artefact, windows: NDArray[Any], *, engine: Engine = "compiled"
) -> FloatArray:
    """Torque (W,), N m, at the end of raw windows (W, history, F), oldest sample first."""
    if windows.ndim != 3 or windows.shape[1:] != (artefact.history, len(artefact.inputs)):
        raise UsageError(
            f"{artefact.name} takes windows (W, {artefact.history}, {len(artefact.inputs)}), not "
            f"{windows.shape}."
        )
    if engine == "plain":
        judge = plain.gru_windows if artefact.family == "gru" else plain.mlp_windows
        return judge(artefact, np.asarray(windows, np.float64))
    single = np.asarray(windows, np.float32)
    torque = np.zeros(len(single), np.float32)
    if artefact.family == "gru":
        from cqdd_design.torque.networks import gru_kernel

        weights = folded_gru(artefact).flat
        gru_kernel.windows(weights, single, artefact.layers, artefact.hidden, torque)
    else:
        from cqdd_design.torque.networks import mlp_kernel

        kind = ACTIVATIONS.index(artefact.activation)
        weights = folded_mlp(artefact).flat
        mlp_kernel.windows(weights, single, artefact.layers, artefact.hidden, kind, torque)
    return _corrected(artefact, torque, windows[:, -1])


class Streaming:
    """An estimator that takes one sample at a time.

    In window mode the last ``history`` samples are kept and run from a zero state; before there
    are as many the torque is nan.

    The mode is by default the one the network was trained for; an MLP knows windows only.
    """

    def __init__(self, artefact: Artefact, mode: Mode | None = None) -> None:
        self.artefact, self.mode = artefact, _mode(artefact, mode)
        self._base = artefact.inputs.index("balance") if artefact.residual else -1
        layers, width = artefact.layers, artefact.hidden
        self._rows = artefact.history if self.mode == "window" else 1
        past = np.zeros((self._rows, len(artefact.inputs)), np.float32)
        self._state = np.zeros((layers, width), np.float32)
        self._past, self._seen = past, 0
        self._torque: Callable[[], Any]
        if artefact.family == "gru":
            from cqdd_design.torque.networks import gru_kernel

            weights, sums = folded_gru(artefact).flat, np.zeros(4 * width, np.float32)
            self._torque = partial(gru_kernel.window, weights, past, self._state)
            if self.mode == "streaming":
                self._torque = partial(gru_kernel.step, weights, past[0], self._state, sums)
        else:
            from cqdd_design.torque.networks import mlp_kernel

            # An MLP takes its window flattened, newest sample first.
            self._past, flat = past[::-1], past.ravel()
            kind, scratch = ACTIVATIONS.index(artefact.activation), np.zeros((2, width), np.float32)
            weights = folded_mlp(artefact).flat
            self._torque = partial(mlp_kernel.window, weights, flat, layers, width, kind, scratch)

    def step(self, features: Sequence[float] | NDArray[Any]) -> float:
        """Torque at this sample, N m; `features` (F,) raw, in the order of ``artefact.inputs``."""
        if self._rows > 1:
            self._past[:-1] = self._past[1:]
        self._past[-1] = features
        self._seen = min(self._seen + 1, self._rows)
        if self._seen < self._rows:
            return math.nan
        torque = float(self._torque())
        return torque if self._base < 0 else torque + float(features[self._base])


def _streamed(artefact: Artefact, raw: FloatArray, engine: Engine) -> FloatArray:
    if engine == "plain":
        state = plain.zero_state(artefact, 1)
        rows = [plain.gru_step(artefact, row[None], state)[0] for row in raw]
        return np.array(rows, np.float64)
    from cqdd_design.torque.networks import gru_kernel

    torque = np.zeros(len(raw), np.float32)
    single = np.ascontiguousarray(raw, np.float32)
    state = np.zeros((artefact.layers, artefact.hidden), np.float32)
    gru_kernel.steps(folded_gru(artefact).flat, single, state, torque)
    return _corrected(artefact, torque, raw)


def _corrected(artefact: Artefact, torque: NDArray[np.float32], newest: NDArray[Any]) -> FloatArray:
    found = torque.astype(np.float64)
    if artefact.residual:
        found += newest[:, artefact.inputs.index("balance")]
    return found


def _mode(artefact: Artefact, mode: Mode | None) -> Mode:
    chosen = mode or artefact.mode
    if chosen == "streaming" and artefact.family == "mlp":
        raise UsageError(f"{artefact.name} is an MLP: it keeps no state; run it in window mode.")
    return chosen


def _checked(artefact: Artefact, features: ArrayLike) -> FloatArray:
    raw = np.asarray(features, np.float64)
    if raw.ndim != 2 or raw.shape[1] != len(artefact.inputs):
        raise UsageError(
            f"{artefact.name} takes features (N, {len(artefact.inputs)}): "
            f"{', '.join(artefact.inputs)}; not {raw.shape}."
        )
    wrong = np.argwhere(~np.isfinite(raw))
    if len(wrong):
        row, column = wrong[0]
        raise UsageError(
            f"{artefact.inputs[column]} is {raw[row, column]} at sample {row}; a network that "
            "keeps its state would never recover; split the record there."
        )
    return raw
