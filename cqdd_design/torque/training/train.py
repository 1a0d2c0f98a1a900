"""Training of a torque estimator, from data and split to an artefact."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design import __version__
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet
from cqdd_design.torque.features.matrix import (
    differentiator_error,
    phase_inputs,
    savitzky_golay,
    strongest_orders,
)
from cqdd_design.torque.features.physics import actuator_to_dict, with_gains_of
from cqdd_design.torque.networks.artefact import Artefact, Validity, WeightArray
from cqdd_design.torque.networks.modules import Model, find_model, network_of, require_torch
from cqdd_design.torque.training.checkpoint import read_checkpoint, require_same, write_checkpoint
from cqdd_design.torque.training.prepared import Prepared, Scaling, raw, scaling
from cqdd_design.torque.training.recipe import Choice, Progress, Recipe
from cqdd_design.torque.training.schedule import peak_rate
from cqdd_design.torque.training.search import search
from cqdd_design.torque.training.trainer import CHUNK, Task, Trainer

if TYPE_CHECKING:
    from cqdd_design.torque.data.splits import Split

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


def prepare(
    data: DataSet,
    split: Split,
    model: Model,
    recipe: Recipe,
    device: str,
    actuator: ActuatorParameters | None,
) -> Task:
    """Features and scaling of a training.

    Raises
    ------
    UsageError
        For too few or too short episodes, or a model that needs an actuator, without one.
    """
    if model.needs_actuator and actuator is None:
        what = "the gearbox's orders" if model.phase else "an actuator's parameters"
        raise UsageError(f"{model.name} needs {what}; name the design with --design.")
    for side in ("train", "validation"):
        names = getattr(split, side)
        if not names:
            raise UsageError(f"no episode to {side} on; record more, or choose another split.")
        lengths = [len(episode) for episode in data.named(names)]
        least = model.history + recipe.stride if recipe.mode == "window" else 2 * CHUNK
        if max(lengths) < least:
            raise UsageError(
                f"the longest episode for {side} has {max(lengths)} samples, and {model.name} "
                f"needs {least} or more; record longer ones."
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
    train, validation = (Prepared(side, scale, device) for side in sides)
    return Task(model, inputs, scale, train, validation, differentiator, device)


def default_choice(model: Model, recipe: Recipe) -> Choice:
    """What a model that is not searched is trained with."""
    return Choice(model.activation, peak_rate(recipe.reading))


def train(
    data: DataSet,
    split: Split,
    model: str,
    seed: int,
    *,
    recipe: Recipe | None = None,
    actuator: ActuatorParameters | None = None,
    choice: Choice | None = None,
    device: str = "auto",
    dt: float | None = None,
    checkpoint: Path | None = None,
    resume: bool = False,
    command: str = "",
    progress: Progress | None = None,
) -> Artefact:
    """Train a model and return the weights that were best on the validation episodes.

    Parameters
    ----------
    data : DataSet
    split : Split
        Its test episodes are never looked at.
    model : str
        Of `networks.MODELS`.
    seed : int
        Of weights and order; on one CPU with one number of threads the result is the same to the
        last bit.
    recipe : Recipe, optional
    actuator : ActuatorParameters, optional
        For models that need one; stored in the artefact's facts under the data's gains.
    choice : Choice, optional
        For a searched model, instead of the search; see `search`.
    device : str
        ``auto``, ``cpu`` or ``cuda``.
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

    Returns
    -------
    Artefact

    Raises
    ------
    UsageError
        For an unknown model, data that cannot be learned from, or a checkpoint that is missing or
        of another training.
    DependencyError
        Without torch.
    """
    chosen, recipe = find_model(model), recipe or Recipe()
    torch = require_torch()
    place = find_device(device)
    if not 0 <= seed < 2**63:
        raise UsageError(f"seed {seed} is not within 0 to 2^63 - 1.")
    if dt is not None and not math.isclose(dt, data.dt, rel_tol=1e-6):
        raise UsageError(
            f"the data are sampled every {data.dt:g} s, not {dt:g} s; resample them, or train for "
            "their own sample time."
        )
    if recipe.mode == "streaming" and chosen.family != "gru":
        raise UsageError(f"{chosen.name} keeps no state; train it with --mode window.")
    if resume and checkpoint is None:
        raise UsageError("nothing to resume from; give the checkpoint's place.")
    known = None if actuator is None else with_gains_of(actuator, data)
    with threads(recipe.threads):
        task = prepare(data, split, chosen, recipe, place, known)
        identity = _identity(data, split, chosen, seed, recipe, task, known, choice)
        former = None
        facts: dict[str, Any] = {}
        if resume and checkpoint is not None:
            former = read_checkpoint(checkpoint)
            require_same(former, identity, checkpoint)
            facts = {key: value for key, value in former.facts.items() if key != "updates"}
        elif chosen.searched and choice is None:
            found = search(task, recipe)
            facts["search"] = found.to_dict()
            choice = found.choice
        if "choice" not in facts:
            facts["choice"] = asdict(choice or default_choice(chosen, recipe))
        choice = Choice(**facts["choice"])
        trainer = Trainer(task, recipe, choice, seed)
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
        "seed": seed,
        "data_sha256": data.sha256,
        "data": {k: v for k, v in data.facts.items() if isinstance(v, str | int | float)},
        "split": split.to_dict(),
        "recipe": asdict(recipe),
        "epochs": state.epoch,
        "best_epoch": best["epoch"],
        "validation_rmse_Nm": best["validation_rmse_Nm"],
        "training_rmse_Nm": best["training_rmse_Nm"],
        "log": state.log,
        "seconds": round(sum(float(row["seconds"]) for row in state.log), 1),
        "device": place,
        "versions": {
            "cqdd_design": __version__,
            "torch": str(torch.__version__),
            "numpy": np.__version__,
        },
    }
    if task.differentiator is not None and data.dt * RIPPLE_FREQUENCY < 0.5:
        told = differentiator_error(task.differentiator, data.dt, RIPPLE_FREQUENCY)
        facts["differentiator"] = asdict(told)
    if known is not None:
        facts["actuator"] = actuator_to_dict(known)
    return _artefact(data, task, recipe, choice, state.best, facts)


def leaked_rmse(
    data: DataSet,
    model: str,
    seed: int,
    *,
    recipe: Recipe | None = None,
    actuator: ActuatorParameters | None = None,
    choice: Choice | None = None,
    device: str = "auto",
    progress: Progress | None = None,
) -> float:
    """Test RMSE (N m) of a model on random windows, as it should NOT be done.

    Nearly every test window has its twin in training; the score only shows by how much such a
    split flatters. See `splits.random_window_split`.
    """
    from cqdd_design.torque.data.splits import random_window_split

    torch = require_torch()
    chosen, recipe = find_model(model), recipe or Recipe()
    drawn, parts = random_window_split(data, seed, history=chosen.history)
    artefact = train(
        drawn,
        parts,
        model,
        seed,
        recipe=replace(recipe, mode="window"),
        actuator=actuator,
        choice=choice,
        device=device,
        progress=progress,
    )
    known = None if actuator is None else with_gains_of(actuator, data)
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
    with threads(recipe.threads), torch.no_grad():
        x, y = prepared.windows(ends, chosen.history)
        mean = float(((network.last(x) - y).double() ** 2).mean())
    return artefact.torque_std * math.sqrt(mean)


def _artefact(
    data: DataSet,
    task: Task,
    recipe: Recipe,
    choice: Choice,
    weights: Mapping[str, WeightArray],
    facts: Mapping[str, Any],
) -> Artefact:
    model = task.model
    return Artefact(
        name=model.name,
        family=model.family,
        inputs=task.inputs,
        history=model.history,
        mode=recipe.mode,
        layers=model.layers,
        hidden=model.hidden,
        activation=choice.activation,
        **asdict(task.scale),
        residual=model.residual,
        validity=Validity(data.dt, data.position_gain, data.velocity_gain, data.torque_range),
        differentiator=task.differentiator,
        weights=weights,
        facts=facts,
    )


def _identity(
    data: DataSet,
    split: Split,
    model: Model,
    seed: int,
    recipe: Recipe,
    task: Task,
    actuator: ActuatorParameters | None,
    choice: Choice | None,
) -> dict[str, Any]:
    """All that the result depends on."""
    torch = require_torch()
    return {
        "version": __version__,
        "torch": str(torch.__version__),
        "model": model.name,
        "seed": seed,
        "data": data.sha256,
        "split": split.to_dict(),
        "inputs": list(task.inputs),
        "actuator": actuator and actuator_to_dict(actuator),
        "choice": choice and asdict(choice),
        "device": task.device,
        **asdict(recipe),
    }
