"""One training of one network, epoch by epoch: windows or streams, validation, state.

Every draw follows from the seed and the epoch's number alone, so a training that is resumed from
its checkpoint goes on bit by bit as the one that was never interrupted, on the same CPU.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.features.acceleration import Differentiator
from cqdd_design.torque.networks.artefact import WeightArray
from cqdd_design.torque.networks.modules import Model, Network, require_torch
from cqdd_design.torque.training.checkpoint import Checkpoint
from cqdd_design.torque.training.recipe import Choice, EpochResult, Recipe
from cqdd_design.torque.training.schedule import OneCycle
from cqdd_design.torque.training.tensors import Prepared, Scaling

CHUNK = 50
"""Samples after which the gradient is cut when streaming."""
_VALIDATION_BATCH = 2048


@dataclass(frozen=True, eq=False)
class Task:
    """All that a training needs, ready on the device; inputs with the gearbox's phases."""

    model: Model
    inputs: tuple[str, ...]
    scale: Scaling
    train: Prepared
    validation: Prepared
    differentiator: Differentiator | None
    device: str


@dataclass
class Progression:
    """Where a training stands."""

    epoch: int = 0
    step: int = 0
    best: dict[str, WeightArray] = field(default_factory=dict)
    best_rmse: float | None = None
    log: list[Mapping[str, Any]] = field(default_factory=list)

    @property
    def since_best(self) -> int:
        """Epochs since the best one."""
        best = min((row["validation_rmse_Nm"] for row in self.log), default=0.0)
        rows = [k for k, row in enumerate(self.log) if row["validation_rmse_Nm"] == best]
        return len(self.log) - 1 - rows[0] if rows else 0


class Trainer:
    """One training of one network, epoch by epoch."""

    def __init__(self, task: Task, recipe: Recipe, choice: Choice, seed: int) -> None:
        torch = require_torch()
        self.task, self.recipe, self.choice, self.seed = task, recipe, choice, seed
        self.network = Network(
            task.model, len(task.inputs), seed, activation=choice.activation, device=task.device
        )
        self.tensors = self.network.tensors
        # Without weight decay AdamW is Adam.
        self.optimiser = torch.optim.AdamW(
            list(self.tensors.values()),
            lr=choice.peak,
            weight_decay=choice.weight_decay,
            fused=True,
        )
        self.cycle = OneCycle(choice.peak, self.recipe.epochs * self._steps_in_epoch())
        self.state = Progression()

    def _sequences(self) -> int:
        return max(self.recipe.batch // 4, 1)

    def _steps_in_epoch(self) -> int:
        train, recipe = self.task.train, self.recipe
        if recipe.mode == "window":
            count = len(train.ends(self.task.model.history, recipe.stride))
            return math.ceil(count / recipe.batch)
        groups = math.ceil(len(train.first) / self._sequences())
        return groups * int(np.ceil(train.length.max() / CHUNK))

    def _generator(self, purpose: int) -> np.random.Generator:
        return np.random.default_rng([self.seed, self.state.epoch, purpose])

    def _step(self, loss: Any) -> None:
        rate, momentum = self.cycle.at(self.state.step)
        for group in self.optimiser.param_groups:
            group["lr"], group["betas"] = rate, (momentum, 0.999)
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        self.optimiser.step()
        self.state.step += 1

    def run_epoch(self) -> EpochResult:
        """Train one epoch and score it on the validation episodes."""
        begin = time.perf_counter()
        streaming = self.recipe.mode == "streaming"
        total = self._stream() if streaming else self._draw_windows()
        rmse = self.validate()
        state, scale = self.state, self.task.scale.torque_std
        state.epoch += 1
        training = scale * math.sqrt(total)
        if not (math.isfinite(rmse) and math.isfinite(training)):
            raise UsageError(
                f"{self.task.model.name} diverged in epoch {state.epoch}; train with the lower "
                "learning rate, --learning-rate-reading max."
            )
        if state.best_rmse is None or rmse < state.best_rmse:
            state.best_rmse, state.best = rmse, self.network.weights()
        seconds = time.perf_counter() - begin
        result = EpochResult(
            state.epoch, self.recipe.epochs, training, rmse, state.best_rmse, seconds
        )
        row = {
            "epoch": state.epoch,
            "training_rmse_Nm": training,
            "validation_rmse_Nm": rmse,
            "seconds": round(seconds, 3),
        }
        state.log.append(row)
        return result

    def _draw_windows(self) -> float:
        """Mean squared scaled error over an epoch of windows in random order."""
        torch = require_torch()
        task, recipe, state = self.task, self.recipe, self.state
        history = task.model.history
        ends = task.train.ends(history, recipe.stride, state.epoch % recipe.stride)
        order = torch.from_numpy(self._generator(0).permutation(ends)).to(task.device)
        total = torch.zeros((), device=task.device)
        for batch in order.split(recipe.batch):
            x, y = task.train.windows(batch, history)
            loss = torch.nn.functional.mse_loss(self.network.last(x), y)
            self._step(loss)
            total += loss.detach() * len(batch)
        return float(total) / len(ends)

    def _stream(self) -> float:
        """Mean squared scaled error over an epoch of whole episodes, side by side.

        Each starts at a random sample from a zero state, and a random number of samples from
        there, one to two histories, counts for nothing: the state has to form first.
        """
        torch = require_torch()
        task, state = self.task, self.state
        generator = self._generator(0)
        history = task.model.history
        order = generator.permutation(len(task.train.first))
        chunks = int(np.ceil(task.train.length.max() / CHUNK))
        total, samples = torch.zeros((), device=task.device), 0
        for begin in range(0, len(order), self._sequences()):
            lanes = order[begin : begin + self._sequences()]
            length = task.train.length[lanes]
            skip = generator.integers(0, np.minimum(CHUNK, length // 2) + 1)
            burn = generator.integers(history, 2 * history + 1, len(lanes))
            hidden = None
            for chunk in range(chunks):
                at = chunk * CHUNK + np.arange(CHUNK)
                place = skip[:, None] + at
                counts = (at >= burn[:, None]) & (place < length[:, None])
                x, y = task.train.side_by_side(lanes, place)
                output, hidden = self.network.every(x, hidden)
                hidden = hidden.detach()
                number = int(counts.sum())
                if not number:
                    # The cycle of the learning rate counts every chunk.
                    state.step += 1
                    continue
                mask = torch.from_numpy(counts).to(task.device)
                square = torch.where(mask, (output - y) ** 2, 0.0)
                self._step(square.sum() / number)
                total += square.detach().sum()
                samples += number
        return float(total) / max(samples, 1)

    def validate(self) -> float:
        """RMSE over the validation episodes in the network's own mode, N m.

        In windows every stride-th one; when streaming, all samples after twice the history.
        """
        torch = require_torch()
        task, data = self.task, self.task.validation
        history, total, count = task.model.history, 0.0, 0
        with torch.no_grad():
            if self.recipe.mode == "window":
                ends = torch.from_numpy(data.ends(history, self.recipe.stride)).to(task.device)
                for batch in ends.split(_VALIDATION_BATCH):
                    x, y = data.windows(batch, history)
                    total += float(((self.network.last(x) - y) ** 2).sum())
                count = len(ends)
            else:
                place = np.arange(data.length.max())[None]
                counts = place < data.length[:, None]
                counts[:, : 2 * history] = False
                x, y = data.side_by_side(np.arange(len(data.first)), place)
                output, _ = self.network.every(x, None)
                mask = torch.from_numpy(counts).to(task.device)
                error = torch.where(mask, (output - y) ** 2, 0.0)
                total, count = float(error.double().sum()), int(counts.sum())
        return task.scale.torque_std * math.sqrt(total / max(count, 1))

    @property
    def finished(self) -> bool:
        """Whether all epochs are done, or none got better for too long."""
        patience = self.recipe.patience
        tired = patience > 0 and self.state.since_best >= patience
        return self.state.epoch >= self.recipe.epochs or tired

    def checkpoint(self, identity: Mapping[str, Any], facts: Mapping[str, Any]) -> Checkpoint:
        """Where this training stands."""
        return Checkpoint(
            identity=identity,
            epoch=self.state.epoch,
            step=self.state.step,
            weights=self.network.weights(),
            first_moment=self._moment("exp_avg"),
            second_moment=self._moment("exp_avg_sq"),
            best=dict(self.state.best),
            best_rmse=self.state.best_rmse,
            log=tuple(self.state.log),
            random_state={"seed": self.seed, "epoch": self.state.epoch},
            facts={**facts, "updates": self._updates()},
        )

    def _moment(self, key: str) -> dict[str, WeightArray]:
        """A moment of every weight by the optimiser's name of it; zero before the first step."""
        state, found = self.optimiser.state, {}
        for name, tensor in self.tensors.items():
            value = state[tensor][key].cpu().numpy() if state.get(tensor) else 0.0
            found[name] = np.array(np.broadcast_to(value, tuple(tensor.shape)), np.float32)
        return found

    def _updates(self) -> int:
        """Steps that the optimiser has made, the same of every weight."""
        own = self.optimiser.state.get(next(iter(self.tensors.values())))
        return int(own["step"]) if own else 0

    def resume(self, checkpoint: Checkpoint) -> None:
        """Go on where a checkpoint stands."""
        torch = require_torch()
        self.network.load(checkpoint.weights)
        updates = float(checkpoint.facts["updates"])
        if updates:
            moments = {
                k: {
                    "step": torch.tensor(updates),
                    "exp_avg": torch.from_numpy(checkpoint.first_moment[name].copy()),
                    "exp_avg_sq": torch.from_numpy(checkpoint.second_moment[name].copy()),
                }
                for k, name in enumerate(self.tensors)
            }
            groups = self.optimiser.state_dict()["param_groups"]
            self.optimiser.load_state_dict({"state": moments, "param_groups": groups})
        self.state = Progression(
            checkpoint.epoch,
            checkpoint.step,
            dict(checkpoint.best),
            checkpoint.best_rmse,
            list(checkpoint.log),
        )
