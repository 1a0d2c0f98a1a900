"""Training of a torque estimator, from data and split to an artefact."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet
from cqdd_design.torque.data.splits import LEAD, Split, random_window_split
from cqdd_design.torque.features.acceleration import differentiator_error, savitzky_golay
from cqdd_design.torque.features.matrix import phase_inputs, strongest_orders
from cqdd_design.torque.features.physics import actuator_to_dict, with_gains_of
from cqdd_design.torque.networks.artefact import Artefact, Validity
from cqdd_design.torque.networks.meaning import label_facts
from cqdd_design.torque.networks.modules import find_model, network_of, require_torch
from cqdd_design.torque.training.checkpoint import read_checkpoint, require_same, write_checkpoint
from cqdd_design.torque.training.epochs import CHUNK, Task, Trainer
from cqdd_design.torque.training.recipe import Choice, Order, Progress
from cqdd_design.torque.training.schedule import peak_rate
from cqdd_design.torque.training.search import search
from cqdd_design.torque.training.tensors import Prepared, Scaling, raw, scaling
from cqdd_design.version import __version__

_OF_MODEL = ("name", "family", "history", "layers", "hidden", "residual")
"""What a trained network takes from its model as it is."""
RIPPLE_FREQUENCY = 17.0
"""Of the paper's ripple, Hz, at which the differentiator's gain and delay are reported."""


def find_device(name: str) -> str:
    """``cpu`` or ``cuda``; ``auto`` is CUDA where there is one.

    Raises
    ------
    UsageError
        For another name, or CUDA where there is none.
    """
    torch = require_torch()
    if name not in ("auto", "cpu", "cuda"):
        raise UsageError(f"there is no device '{name}'; there are auto, cpu and cuda.")
    present = bool(torch.cuda.is_available())
    if name == "cuda" and not present:
        raise UsageError("torch finds no CUDA device; use --device cpu, or auto.")
    return "cuda" if present and name != "cpu" else "cpu"


@contextlib.contextmanager
def threads(count: int) -> Iterator[None]:
    """Torch on some threads of the CPU, for a while."""
    torch = require_torch()
    former = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(former)


def prepare(data: DataSet, split: Split, order: Order) -> Task:
    """Features and scaling of a training.

    Raises
    ------
    UsageError
        For too few or too short episodes, or a model that needs an actuator, without one.
    """
    model, recipe, actuator = find_model(order.model), order.recipe, order.actuator
    if model.needs_actuator and actuator is None:
        what = "the gearbox's orders" if model.phase else "an actuator's parameters"
        raise UsageError(f"{model.name} needs {what}; name the design with --design.")
    for side in ("train", "validation"):
        names = getattr(split, side)
        if not names:
            raise UsageError(f"no episode to {side} on; record more, or choose another split.")
        longest = max(len(episode) for episode in data.named(names))
        least = model.history + recipe.stride if recipe.mode == "window" else 2 * CHUNK
        if longest < least:
            raise UsageError(
                f"the longest episode for {side} has {longest} samples, and {model.name} needs "
                f"{least} or more; record longer ones."
            )
    inputs = model.inputs
    if model.phase and actuator is not None:
        inputs = (*inputs, *phase_inputs(strongest_orders(actuator.gear, recipe.orders)))
    slope = savitzky_golay(data.dt, recipe.points, recipe.order)
    differentiator = slope if "acceleration" in inputs else None
    sides = [
        raw(data.named(names), inputs, differentiator, actuator, residual=model.residual)
        for names in (split.train, split.validation)
    ]
    scale = scaling(sides[0], inputs)
    train, validation = (Prepared(side, scale, order.device) for side in sides)
    return Task(model, inputs, scale, train, validation, differentiator, order.device)


def train(
    data: DataSet,
    split: Split,
    order: Order,
    *,
    dt: float | None = None,
    checkpoint: Path | None = None,
    resume: bool = False,
    command: str = "",
    progress: Progress | None = None,
) -> Artefact:
    """Train a model and return the weights that were best on the validation episodes.

    Parameters
    ----------
    split : Split
        Its test episodes are never looked at.
    order : Order
        What is trained, and how.
    dt : float, optional
        Sample time that the data must have, s.
    checkpoint : Path, optional
        Where the training's state is kept after every epoch.
    resume : bool
        Go on from it.
    command : str
        Stored.
    progress : callable, optional
        Told after every epoch.

    Raises
    ------
    UsageError
        For an unknown model, data that cannot be learned from, or a checkpoint that is missing or
        of another training.
    DependencyError
        Without torch.
    """
    chosen, recipe, choice = find_model(order.model), order.recipe, order.choice
    torch = require_torch()
    if dt is not None and not math.isclose(dt, data.dt, rel_tol=1e-6):
        raise UsageError(
            f"the data are sampled every {data.dt:g} s, not {dt:g} s; resample them, or train for "
            "their own sample time."
        )
    if recipe.mode == "streaming" and chosen.family != "gru":
        raise UsageError(f"{chosen.name} keeps no state; train it with --mode window.")
    if resume and checkpoint is None:
        raise UsageError("nothing to resume from; give the checkpoint's place.")
    known = None if order.actuator is None else with_gains_of(order.actuator, data)
    order = replace(order, actuator=known, device=find_device(order.device))
    with threads(recipe.threads):
        task = prepare(data, split, order)
        identity = _identity(data, split, order, task)
        former = None
        facts: dict[str, Any] = {}
        if resume and checkpoint is not None:
            former = read_checkpoint(checkpoint)
            require_same(former, identity, checkpoint)
            facts = {key: value for key, value in former.facts.items() if key != "updates"}
        elif chosen.searched and choice is None:
            choice, facts["search"] = search(task, recipe)
        if "choice" not in facts:
            own = Choice(chosen.activation, peak_rate(recipe.reading))
            facts["choice"] = asdict(choice or own)
        choice = Choice(**facts["choice"])
        trainer = Trainer(task, recipe, choice, order.seed)
        if former is not None:
            trainer.resume(former)
        elif checkpoint is not None:
            write_checkpoint(trainer.checkpoint(identity, facts), checkpoint)
        while not trainer.finished:
            result = trainer.run_epoch()
            if checkpoint is not None:
                write_checkpoint(trainer.checkpoint(identity, facts), checkpoint)
            if progress is not None:
                progress(result)
    state = trainer.state
    best = min(state.log, key=lambda row: float(row["validation_rmse_Nm"]))
    facts |= {
        "command": command,
        "seed": order.seed,
        "data_sha256": data.sha256,
        "data": {k: v for k, v in data.facts.items() if isinstance(v, str | int | float)},
        **label_facts(data, data.named(split.train)),
        "split": split.to_dict(),
        "recipe": asdict(recipe),
        "epochs": state.epoch,
        "best_epoch": best["epoch"],
        "validation_rmse_Nm": best["validation_rmse_Nm"],
        "training_rmse_Nm": best["training_rmse_Nm"],
        "log": state.log,
        "seconds": round(sum(float(row["seconds"]) for row in state.log), 1),
        "device": order.device,
        "versions": {
            "cqdd_design": __version__,
            "torch": str(torch.__version__),
            "numpy": np.__version__,
        },
    }
    if task.differentiator is not None and data.dt * RIPPLE_FREQUENCY < 0.5:
        slope = task.differentiator
        facts["differentiator"] = differentiator_error(slope, data.dt, RIPPLE_FREQUENCY)
    if known is not None:
        facts["actuator"] = actuator_to_dict(known)
    model = task.model
    return Artefact(
        **{key: getattr(model, key) for key in _OF_MODEL},
        inputs=task.inputs,
        mode=recipe.mode,
        activation=choice.activation,
        **asdict(task.scale),
        validity=Validity(data.dt, data.position_gain, data.velocity_gain, data.torque_range),
        differentiator=task.differentiator,
        weights=state.best,
        facts=facts,
    )


def leaked_rmse(data: DataSet, order: Order) -> float:
    """Test RMSE (N m) of a model on random windows, as it should NOT be done.

    Nearly every test window has its twin in training; the score only shows by how much such a
    split flatters. See `splits.random_window_split`.
    """
    torch = require_torch()
    drawn, parts = random_window_split(data, order.seed, history=find_model(order.model).history)
    # Windows are drawn already: a longer stride than what they have beside leaves none of one.
    stride = min(order.recipe.stride, LEAD)
    order = replace(order, recipe=replace(order.recipe, mode="window", stride=stride))
    artefact = train(drawn, parts, order)
    known = None if order.actuator is None else with_gains_of(order.actuator, data)
    test = raw(
        drawn.named(parts.test),
        artefact.inputs,
        artefact.differentiator,
        known,
        residual=artefact.residual,
    )
    scale = Scaling(
        artefact.input_mean, artefact.input_std, artefact.torque_mean, artefact.torque_std
    )
    prepared, network = Prepared(test, scale, "cpu"), network_of(artefact)
    ends = torch.from_numpy(test.first + test.length - 1)
    with threads(order.recipe.threads), torch.no_grad():
        x, y = prepared.windows(ends, artefact.history)
        mean = float(((network.last(x) - y).double() ** 2).mean())
    return artefact.torque_std * math.sqrt(mean)


def _identity(data: DataSet, split: Split, order: Order, task: Task) -> dict[str, Any]:
    """All that the result depends on."""
    return {
        "version": __version__,
        "torch": str(require_torch().__version__),
        "model": order.model,
        "seed": order.seed,
        "data": data.sha256,
        "split": split.to_dict(),
        "inputs": list(task.inputs),
        "actuator": order.actuator and actuator_to_dict(order.actuator),
        "choice": order.choice and asdict(order.choice),
        "device": task.device,
        **asdict(order.recipe),
    }
