"""Evaluate torque estimators: test sets, latency, closed loop and drift, beside the paper."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.evaluation import bootstrap
from cqdd_design.torque.evaluation.bootstrap import Interval
from cqdd_design.torque.evaluation.estimators import (
    Estimator,
    Latency,
    Modes,
    compare_modes,
    kept_state,
    latency,
    streaming,
)
from cqdd_design.torque.evaluation.rollout import Drift, Rollout, drift, pendulum_of, rollout
from cqdd_design.torque.evaluation.scoring import SetResult, score_set

FloatArray = NDArray[np.float64]

ROLLOUTS = 6
"""Episodes that each model drives in closed loop."""
DRIFT_STEPS = 100_000


@dataclass(frozen=True)
class PaperRow:
    """A model in the paper's Table II, measured on its hardware.

    Attributes
    ----------
    model : str
        By our name of it.
    title : str
    rmse : float
        N m.
    variance : float
        Printed there in N m; N^2 m^2 by its meaning.
    cycle_time : float
        us.
    """

    model: str
    title: str
    rmse: float
    variance: float
    cycle_time: float

    @property
    def bias(self) -> float | None:
        """Size of the bias that the other two imply, N m; None where they contradict."""
        square = self.rmse**2 - self.variance
        return square**0.5 if square >= 0.0 else None


PAPER_SOURCE = "C-QDD paper, Table II and section IV-A (hardware)"
PAPER: tuple[PaperRow, ...] = (
    PaperRow("pva-gru", "PVA-GRU", 0.97, 0.92, 1.49),
    PaperRow("pv-gru", "PV-GRU", 1.00, 0.85, 3.10),
    PaperRow("mlp", "MLP (tuned)", 1.71, 2.90, 0.72),
    PaperRow("mlp-baseline", "MLP (baseline)", 2.46, 3.62, 0.22),
)


@dataclass(frozen=True, eq=False)
class Behaviour:
    """What an estimator does beyond single errors.

    Attributes
    ----------
    name, model : str
    kind : str
    parameters, history : int
    remark : str
    latency : Latency or None
    rollouts : tuple of Rollout
    position_rms : Interval or None
        Mean over the rollouts that did not run away, rad.
    drift : Drift or None
    modes : Modes or None
    leaked_rmse : float or None
        Of the same model scored on random windows of its own training episodes, N m.
    missing : str
        Why there is no rollout.
    """

    name: str
    model: str
    kind: str
    parameters: int
    history: int
    remark: str
    latency: Latency | None
    rollouts: tuple[Rollout, ...]
    position_rms: Interval | None
    drift: Drift | None
    modes: Modes | None
    leaked_rmse: float | None
    missing: str = ""


@dataclass(frozen=True, eq=False)
class EvaluationResult:
    """Everything that was measured, test set by test set.

    Attributes
    ----------
    sets : tuple of SetResult
        The first is the headline.
    models : tuple of Behaviour
    dt, position_gain, velocity_gain : float
        Of the data, SI.
    draws, seed : int
    data_sha256 : str
    data_facts : mapping
    seconds : float
    warnings : tuple of str
    """

    sets: tuple[SetResult, ...]
    models: tuple[Behaviour, ...]
    dt: float
    position_gain: float
    velocity_gain: float
    draws: int
    seed: int
    data_sha256: str
    data_facts: Mapping[str, Any] = field(default_factory=dict)
    seconds: float = 0.0
    warnings: tuple[str, ...] = ()

    def behaviour(self, name: str) -> Behaviour:
        """By name."""
        return next(one for one in self.models if one.name == name)

    def to_dict(self) -> dict[str, Any]:
        """The JSON form; keys carry units."""
        from cqdd_design.torque.evaluation.documents import result_dict

        return result_dict(self)


def evaluate(
    data: DataSet,
    sets: Mapping[str, Sequence[str]],
    estimators: Sequence[Estimator],
    *,
    seen: Mapping[str, frozenset[str]] | None = None,
    leaked: Mapping[str, float] | None = None,
    draws: int = bootstrap.DRAWS,
    seed: int = 0,
    rollouts: int = ROLLOUTS,
    drift_steps: int = DRIFT_STEPS,
    timed: bool = True,
    progress: Callable[[str], None] | None = None,
) -> EvaluationResult:
    """Evaluate estimators on test sets of a data set.

    Parameters
    ----------
    data : DataSet
    sets : mapping of str to sequence of str
        Names of the test episodes of each set; the first set is the headline.
    estimators : sequence of Estimator
        Names must differ.
    seen : mapping of str to set of str, optional
        Episodes that each estimator was trained on; it is not scored on a set that holds one.
    leaked : mapping of str to float, optional
        The score on random windows of each estimator, to be shown beside the honest one, N m.
    draws, seed : int
        Of the bootstrap.
    rollouts, drift_steps : int
        0 leaves them out.
    timed : bool
        Whether to measure latencies.
    progress : callable, optional
        Told what begins.

    Raises
    ------
    UsageError
        For artefacts of other gains or sample time than the data's, no test episodes, unknown
        ones, names given twice, or estimates that are not finite.
    """
    begin = time.perf_counter()
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
                continue
            used.append(one)
        if not used:
            raise UsageError(
                f"every model was trained on episodes of set {name}; train one with that split "
                f"(--split {name}), or leave the set out."
            )
        found = score_set(
            name, data.named(tuple(members)), used, count=draws, seed=seed, progress=progress
        )
        warnings += found.warnings
        results.append(found)
    headline = data.named(results[0].episodes)
    models = []
    for one in estimators:
        if progress is not None:
            progress(f"{one.name} in closed loop")
        models.append(
            _behaviour(
                one,
                data,
                headline,
                rollouts=rollouts,
                drift_steps=drift_steps,
                timed=timed,
                leaked=(leaked or {}).get(one.name),
                seed=seed,
            )
        )
    return EvaluationResult(
        sets=tuple(results),
        models=tuple(models),
        dt=data.dt,
        position_gain=data.position_gain,
        velocity_gain=data.velocity_gain,
        draws=draws,
        seed=seed,
        data_sha256=data.sha256,
        data_facts=data.facts,
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


def _behaviour(
    one: Estimator,
    data: DataSet,
    episodes: Sequence[Episode],
    *,
    rollouts: int,
    drift_steps: int,
    timed: bool,
    leaked: float | None,
    seed: int,
) -> Behaviour:
    usable = [e for e in episodes if all(c in e.columns for c in one.needs)]
    runs: list[Rollout] = []
    missing = ""
    if rollouts and not one.closes_loop:
        missing = f"needs {', '.join(one.needs)}, which a simulation of the joint alone has not"
    elif rollouts:
        pendula = [(e, pendulum_of(e, data)) for e in usable if len(e) > one.history + 1]
        known = [(e, p) for e, p in pendula if p is not None]
        if not known:
            missing = "the data do not say what the joint carried"
        chosen = np.unique(np.linspace(0, len(known) - 1, min(rollouts, len(known))).astype(int))
        for k in chosen.tolist():
            episode, pendulum = known[k]
            runs.append(rollout(pendulum, episode, one.stepper(), begin=max(one.history, 8)))
    kept = np.array([run.position_rms for run in runs if run.position_rms is not None])
    mean = None
    if len(kept):
        weights = bootstrap.draws(len(kept), seed=seed)
        mean = bootstrap.interval(
            float(kept.mean()), weights @ kept / len(kept), episodes=len(kept)
        )
    wandering = None
    if drift_steps and one.artefact is not None and one.features is not None:
        run = streaming(one.artefact, kept_state(one.artefact))
        rows = one.features(_periodic(episodes[0]))[-_PERIOD:]
        wandering = drift(run.step, rows, steps=drift_steps)
    return Behaviour(
        name=one.name,
        model=one.model or one.name,
        kind=one.kind,
        parameters=one.parameters,
        history=one.history,
        remark=one.remark,
        latency=latency(one, usable[0]) if timed and usable else None,
        rollouts=tuple(runs),
        position_rms=mean,
        drift=wandering,
        modes=compare_modes(one, episodes[0]),
        leaked_rmse=leaked,
        missing=missing,
    )


_PERIOD = 200
"""Samples of one period of the drift test."""


def _periodic(episode: Episode) -> Episode:
    """Three equal periods of a swing as wide as an episode's, with its lag behind the target."""
    turn = 2.0 * np.pi * np.arange(3 * _PERIOD) / _PERIOD
    pulse = 2.0 * np.pi / (_PERIOD * episode.dt)
    position = np.asarray(episode.columns["position"], np.float64)
    error = np.asarray(episode.columns["target"], np.float64) - position
    middle, reach = float(position.mean()), float(np.sqrt(2.0) * position.std())
    lag = float(np.sqrt(2.0) * error.std())
    swing = middle + reach * np.sin(turn)
    return Episode(
        episode.name,
        episode.group,
        episode.dt,
        {
            "position": swing,
            "target": swing + float(error.mean()) + lag * np.sin(turn + 0.5),
            "velocity": reach * pulse * np.cos(turn),
            "torque": np.zeros(len(turn)),
        },
    )
