"""Search of the tuned MLP's hyperparameters on the validation episodes.

All 32 of `ACTIVATIONS`, `RATES` and `DECAYS` are trained briefly on an eighth of the windows, and
the four best for three times as long; the least validation RMSE wins. Width, depth and history
stay those of the model. The seed is always 0, so that trainings of several seeds share the choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from typing import Any

from cqdd_design.torque.networks.artefact import ACTIVATIONS
from cqdd_design.torque.training.epochs import Task, Trainer
from cqdd_design.torque.training.recipe import Choice, Recipe

RATES = (1e-3, 2.5e-3, 6e-3, 1.5e-2)
DECAYS = (0.0, 1e-2)
FIRST_EPOCHS, FINALISTS = 2, 4
STRIDE_FACTOR = 4


@dataclass(frozen=True)
class Trial:
    """A choice and how it did; RMSE in N m."""

    choice: Choice
    epochs: int
    validation_rmse: float


@dataclass(frozen=True)
class Search:
    """What was searched, and what was found."""

    choice: Choice
    trials: tuple[Trial, ...]

    def to_dict(self) -> dict[str, Any]:
        """For the artefact's facts."""
        return {
            "choice": asdict(self.choice),
            "trials": [
                {
                    **asdict(one.choice),
                    "epochs": one.epochs,
                    "validation_rmse_Nm": one.validation_rmse,
                }
                for one in self.trials
            ],
        }


def search(task: Task, recipe: Recipe, choices: Sequence[Choice] = ()) -> Search:
    """The choice with the least validation RMSE; see the module.

    Parameters
    ----------
    task : Task
        Of an MLP.
    recipe : Recipe
        Batch, stride and threads; its stride times `STRIDE_FACTOR` is the search's.
    choices : sequence of Choice, optional
        Instead of all.
    """
    choices = choices or [Choice(a, r, d) for a, r, d in product(ACTIVATIONS, RATES, DECAYS)]
    brief = replace(recipe, epochs=FIRST_EPOCHS, stride=recipe.stride * STRIDE_FACTOR, patience=0)
    trials = [_try(task, brief, choice) for choice in choices]
    order = sorted(trials, key=lambda one: one.validation_rmse)
    longer = replace(brief, epochs=3 * FIRST_EPOCHS)
    finals = [_try(task, longer, one.choice) for one in order[:FINALISTS]]
    best = min(finals, key=lambda one: one.validation_rmse)
    return Search(best.choice, (*trials, *finals))


def _try(task: Task, recipe: Recipe, choice: Choice) -> Trial:
    trainer = Trainer(task, recipe, choice, 0)
    while not trainer.finished:
        trainer.run_epoch()
    return Trial(choice, recipe.epochs, float(trainer.state.best_rmse or 0.0))
