"""Evaluate torque estimators: scores on test sets, and how each estimator behaves."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet
from cqdd_design.torque.evaluation.behaviour import Behaviour, Effort, behaviour
from cqdd_design.torque.evaluation.estimator import Estimator
from cqdd_design.torque.evaluation.scoring import SetResult, score_set


@dataclass(frozen=True, eq=False)
class EvaluationResult:
    """Everything that was measured, test set by test set.

    Attributes
    ----------
    sets : tuple of SetResult
        The first is the headline.
    """

    data: DataSet
    sets: tuple[SetResult, ...]
    models: tuple[Behaviour, ...]
    effort: Effort
    seconds: float
    warnings: tuple[str, ...]

    def behaviour(self, name: str) -> Behaviour:
        """By name."""
        return next(one for one in self.models if one.name == name)


def evaluate(
    data: DataSet,
    sets: Mapping[str, Sequence[str]],
    estimators: Sequence[Estimator],
    *,
    seen: Mapping[str, frozenset[str]] | None = None,
    effort: Effort | None = None,
    progress: Callable[[str], None] | None = None,
) -> EvaluationResult:
    """Evaluate estimators on test sets of a data set.

    Parameters
    ----------
    sets : mapping of str to sequence of str
        Names of the test episodes of each set; the first set is the headline.
    estimators : sequence of Estimator
        Names must differ.
    seen : mapping of str to set of str, optional
        Episodes that each estimator was trained on; it is not scored on a set that holds one.
    progress : callable, optional
        Told what begins.

    Raises
    ------
    UsageError
        For artefacts of other gains or sample time than the data's, no test episodes, unknown
        ones, names given twice, or estimates that are not finite.
    """
    begin = time.perf_counter()
    asked = effort or Effort()
    _check(data, sets, estimators)
    warnings: list[str] = []
    results = []
    for name, members in sets.items():
        used = []
        for one in estimators:
            known = (seen or {}).get(one.name, frozenset()) & set(members)
            if known:
                warnings.append(
                    f"{one.name} was trained on {len(known)} of the {len(members)} episodes of "
                    f"set {name} and is not scored on it; train it with that split."
                )
            else:
                used.append(one)
        if not used:
            raise UsageError(
                f"every model was trained on episodes of set {name}; train one with that split "
                f"(--split {name}), or leave the set out."
            )
        episodes = data.named(tuple(members))
        found = score_set(
            name, episodes, used, count=asked.draws, seed=asked.seed, progress=progress
        )
        warnings += found.warnings
        results.append(found)
    headline = data.named(results[0].episodes)
    models = []
    for one in estimators:
        if progress is not None:
            progress(f"{one.name} in closed loop")
        models.append(behaviour(one, data, headline, asked))
    return EvaluationResult(
        data=data,
        sets=tuple(results),
        models=tuple(models),
        effort=asked,
        seconds=time.perf_counter() - begin,
        warnings=tuple(dict.fromkeys(warnings)),
    )


def _check(
    data: DataSet, sets: Mapping[str, Sequence[str]], estimators: Sequence[Estimator]
) -> None:
    names = [one.name for one in estimators]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise UsageError(f"two models are named {twice[0]}; their scores could not be told apart.")
    if not estimators:
        raise UsageError("there is no model to evaluate; give one with --model.")
    for one in estimators:
        if one.artefact is not None:
            one.artefact.require(data.dt, data.position_gain, data.velocity_gain)
    if not sets:
        raise UsageError("there is no test set; choose one with --set.")
    known = {one.name for one in data.episodes}
    for name, members in sets.items():
        if not members:
            raise UsageError(
                f"set {name} has no test episodes in these data; choose another --set, or generate "
                "such episodes."
            )
        missing = [member for member in members if member not in known]
        if missing:
            raise UsageError(f"set {name} names episode {missing[0]}, which the data do not hold.")
