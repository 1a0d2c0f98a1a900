"""Search of the tuned MLP's hyperparameters on the validation episodes.

All 32 of `ACTIVATIONS`, `RATES` and `DECAYS` are trained briefly on an eighth of the windows, and
the four best for three times as long; the least validation RMSE wins. Width, depth and history
stay those of the model. The seed is always 0, so that trainings of several seeds share the choice.
"""

from __future__ import annotations

from dataclasses import asdict, replace
from itertools import product
from typing import Any

from cqdd_design.torque.networks.artefact import ACTIVATIONS
from cqdd_design.torque.training.epochs import Task, Trainer
from cqdd_design.torque.training.recipe import Choice, Recipe

RATES = (1e-3, 2.5e-3, 6e-3, 1.5e-2)
DECAYS = (0.0, 1e-2)
FIRST_EPOCHS, FINALISTS = 2, 4
STRIDE_FACTOR = 4


def search(task: Task, recipe: Recipe) -> tuple[Choice, dict[str, Any]]:
    """The choice with the least validation RMSE of an MLP; see the module.

    Batch, stride and threads are the recipe's, but its stride counts `STRIDE_FACTOR` times. All
    trials go with the choice, for the artefact's facts.
    """
    choices = [Choice(a, r, d) for a, r, d in product(ACTIVATIONS, RATES, DECAYS)]
    brief = replace(recipe, epochs=FIRST_EPOCHS, stride=recipe.stride * STRIDE_FACTOR, patience=0)
    trials = [(choice, brief, _rmse(task, brief, choice)) for choice in choices]
    order = sorted(trials, key=lambda one: one[2])
    longer = replace(brief, epochs=3 * FIRST_EPOCHS)
    finals = [(one, longer, _rmse(task, longer, one)) for one, _, _ in order[:FINALISTS]]
    best, _, _ = min(finals, key=lambda one: one[2])
    told = [
        asdict(choice) | {"epochs": run.epochs, "validation_rmse_Nm": rmse}
        for choice, run, rmse in (*trials, *finals)
    ]
    return best, {"choice": asdict(best), "trials": told}


def _rmse(task: Task, recipe: Recipe, choice: Choice) -> float:
    """Least validation RMSE of a choice, N m."""
    trainer = Trainer(task, recipe, choice, 0)
    while not trainer.finished:
        trainer.run_epoch()
    return float(trainer.state.best_rmse or 0.0)
