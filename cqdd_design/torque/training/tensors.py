"""Episodes as tensors on the device, from which windows and sequences are drawn by index."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.features.acceleration import Differentiator
from cqdd_design.torque.features.matrix import feature_matrix
from cqdd_design.torque.networks.modules import require_torch

IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Scaling:
    """Means and standard deviations over the training episodes; the last two of the torque."""

    input_mean: tuple[float, ...]
    input_std: tuple[float, ...]
    torque_mean: float
    torque_std: float


@dataclass(frozen=True, eq=False)
class Raw:
    """Features and torque of some episodes, side by side.

    Attributes
    ----------
    features : array (S, F)
    torque : array (S,)
        What the network is to tell: less the balance where it corrects that, N m.
    first, length : array (E,) of int
        Of each episode.
    """

    features: FloatArray
    torque: FloatArray
    first: IntArray
    length: IntArray


def raw(
    episodes: Sequence[Episode],
    inputs: tuple[str, ...],
    differentiator: Differentiator | None,
    actuator: ActuatorParameters | None,
    *,
    residual: bool,
) -> Raw:
    """Features of episodes by `feature_matrix`.

    Raises
    ------
    UsageError
        When a feature is not finite.
    """
    matrices, torques = [], []
    for episode in episodes:
        matrix = feature_matrix(episode, inputs, differentiator=differentiator, physics=actuator)
        torque = np.asarray(episode.columns["torque"], np.float64)
        if residual:
            torque = torque - matrix[:, inputs.index("balance")]
        if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(torque))):
            raise UsageError(f"episode {episode.name} has features that are not finite.")
        matrices.append(matrix)
        torques.append(torque)
    length = np.array([len(matrix) for matrix in matrices], np.int64)
    return Raw(
        features=np.concatenate(matrices),
        torque=np.concatenate(torques),
        first=np.cumsum(length) - length,
        length=length,
    )


def scaling(train: Raw, inputs: tuple[str, ...]) -> Scaling:
    """Scaling by the training episodes.

    Raises
    ------
    UsageError
        When an input or the torque stands still.
    """
    std, torque_std = train.features.std(axis=0), float(train.torque.std())
    names = [*inputs, "torque"]
    for name, value in zip(names, [*std, torque_std], strict=True):
        if not value > 1e-9:
            raise UsageError(
                f"{name} does not move in the training episodes; nothing can be learned from it."
            )
    return Scaling(
        input_mean=tuple(float(value) for value in train.features.mean(axis=0)),
        input_std=tuple(float(value) for value in std),
        torque_mean=float(train.torque.mean()),
        torque_std=torque_std,
    )


class Prepared:
    """Scaled features (S, F) and torque (S,) on a device, float32."""

    def __init__(self, data: Raw, scale: Scaling, device: str) -> None:
        torch = require_torch()
        features = (data.features - scale.input_mean) / scale.input_std
        torque = (data.torque - scale.torque_mean) / scale.torque_std
        self.features = torch.from_numpy(features.astype(np.float32)).to(device)
        self.torque = torch.from_numpy(torque.astype(np.float32)).to(device)
        self.first, self.length = data.first, data.length
        self.device = device

    def ends(self, history: int, stride: int = 1, offset: int = 0) -> IntArray:
        """Last samples of every stride-th window, as many whatever the offset below the stride."""
        found = []
        for first, length in zip(self.first, self.length, strict=True):
            count = (length - history + 1) // stride
            found.append(first + history - 1 + offset + stride * np.arange(max(count, 0)))
        return np.concatenate(found)

    def side_by_side(self, lanes: IntArray, place: IntArray) -> tuple[Any, Any]:
        """Features (B, T, F) and torque (B, T) of episodes (B,) at their samples (B, T).

        Samples past an episode's end are its last one.
        """
        torch = require_torch()
        last = self.length[lanes][:, None] - 1
        index = torch.from_numpy(self.first[lanes][:, None] + np.minimum(place, last))
        index = index.to(self.device)
        return self.features[index], self.torque[index]

    def windows(self, ends: Any, history: int) -> tuple[Any, Any]:
        """Windows (B, history, F), oldest sample first, and torque (B,) at their ends (B,)."""
        torch = require_torch()
        past = torch.arange(1 - history, 1, device=self.device)
        return self.features[ends[:, None] + past], self.torque[ends]
