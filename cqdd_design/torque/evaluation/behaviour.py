"""What an estimator does beyond single errors: times, both modes, closed loop and drift."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.torque.data.episodes import DataSet, Episode, FloatArray
from cqdd_design.torque.evaluation import bootstrap
from cqdd_design.torque.evaluation.bootstrap import Interval
from cqdd_design.torque.evaluation.estimator import Estimator
from cqdd_design.torque.evaluation.rollout import Drift, Rollout, drift, pendulum_of, rollout
from cqdd_design.torque.networks.artefact import Artefact
from cqdd_design.torque.networks.predict import Streaming, predict

BATCH = 16_000
"""Samples of the throughput, as many as the paper's test set."""
_STEPS, _WINDOWS = 3000, 400
_PERIOD = 200
"""Samples of one period of the drift test."""


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    Attributes
    ----------
    draws, seed : int
        Of the bootstrap.
    rollouts : int
        Episodes that each model drives in closed loop; 0 leaves them out.
    drift_steps : int
        Of long streaming; 0 leaves it out.
    timed : bool
        Whether latencies are measured.
    """

    draws: int = bootstrap.DRAWS
    seed: int = 0
    rollouts: int = 6
    drift_steps: int = 100_000
    timed: bool = True


@dataclass(frozen=True)
class Latency:
    """Times of one thread, us; None where a model has no such way to run.

    Attributes
    ----------
    streaming_p50, streaming_p99 : float or None
        One sample, state kept, called from Python.
    window_p50 : float or None
        One whole window from a zero state.
    throughput_per_sample : float
        A long record divided by its samples.
    """

    streaming_p50: float | None
    streaming_p99: float | None
    window_p50: float | None
    throughput_per_sample: float


@dataclass(frozen=True)
class Modes:
    """Streaming against windows of the same network, after the burn-in, N m."""

    difference_rms: float
    difference_most: float


@dataclass(frozen=True, eq=False)
class Behaviour:
    """What an estimator does beyond single errors.

    Attributes
    ----------
    name, model, kind, parameters, history
        Of the `Estimator`.
    position_rms : Interval or None
        Mean over the rollouts that did not run away, rad.
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
    latency: Latency | None
    rollouts: tuple[Rollout, ...]
    position_rms: Interval | None
    drift: Drift | None
    modes: Modes | None
    leaked_rmse: float | None
    missing: str = ""


def behaviour(
    one: Estimator, data: DataSet, episodes: Sequence[Episode], effort: Effort
) -> Behaviour:
    """Run an estimator on some episodes of a data set, and measure how it runs."""
    usable = [e for e in episodes if all(c in e.columns for c in one.needs)]
    runs, missing = _rollouts(one, data, usable, effort.rollouts)
    kept = np.array([run.position_rms for run in runs if run.position_rms is not None])
    mean = None
    if len(kept):
        weights = bootstrap.draws(len(kept), seed=effort.seed)
        mean = bootstrap.interval(
            float(kept.mean()), weights @ kept / len(kept), episodes=len(kept)
        )
    wandering = None
    if effort.drift_steps and one.artefact is not None and one.features is not None:
        rows = one.features(_periodic(episodes[0]))[-_PERIOD:]
        wandering = drift(_for_ever(one.artefact).step, rows, steps=effort.drift_steps)
    leaked = None if one.artefact is None else one.artefact.facts.get("leaked_rmse_Nm")
    return Behaviour(
        model=one.model or one.name,
        **{key: getattr(one, key) for key in ("name", "kind", "parameters", "history")},
        latency=latency(one, usable[0]) if effort.timed and usable else None,
        rollouts=runs,
        position_rms=mean,
        drift=wandering,
        modes=compare_modes(one, episodes[0]),
        leaked_rmse=None if leaked is None else float(leaked),
        missing=missing,
    )


def _rollouts(
    one: Estimator, data: DataSet, episodes: Sequence[Episode], count: int
) -> tuple[tuple[Rollout, ...], str]:
    """Closed loops on some episodes, evenly chosen, or why there are none."""
    if not count:
        return (), ""
    if not one.closes_loop:
        return (), f"needs {', '.join(one.needs)}, which a simulation of the joint alone has not"
    pendula = [(e, pendulum_of(e, data)) for e in episodes if len(e) > one.history + 1]
    known = [(e, p) for e, p in pendula if p is not None]
    if not known:
        return (), "the data do not say what the joint carried"
    chosen = np.unique(np.linspace(0, len(known) - 1, min(count, len(known))).astype(int))
    begin = max(one.history, 8)
    return tuple(
        rollout(pendulum, episode, one.stepper(), begin=begin)
        for episode, pendulum in (known[k] for k in chosen.tolist())
    ), ""


def _for_ever(artefact: Artefact) -> Streaming:
    """A fresh run as a network runs for ever: with its state kept, where it has one."""
    return Streaming(artefact, "streaming" if artefact.family == "gru" else "window")


def latency(estimator: Estimator, episode: Episode) -> Latency:
    """Time an estimator on this machine, with the features of one episode.

    Features are made beforehand: the times are those of the estimate alone, for a baseline those
    of its whole law.
    """
    artefact = estimator.artefact
    if artefact is None or estimator.features is None:
        count = len(episode)
        return Latency(None, None, None, 1e6 * _best(lambda: estimator.estimate(episode)) / count)
    rows = estimator.features(episode)
    rows = np.ascontiguousarray(np.resize(rows, (BATCH, rows.shape[1])))
    forever = _steps(_for_ever(artefact), rows[:_STEPS])
    window = _steps(Streaming(artefact, "window"), rows[: artefact.history + _WINDOWS])
    batch = _best(lambda: predict(artefact, rows), times=1)
    return Latency(
        streaming_p50=float(np.quantile(forever, 0.5)),
        streaming_p99=float(np.quantile(forever, 0.99)),
        window_p50=float(np.quantile(window[artefact.history :], 0.5)),
        throughput_per_sample=1e6 * batch / len(rows),
    )


def _steps(run: Streaming, rows: FloatArray) -> FloatArray:
    """Time of each step but the first tenth, us."""
    found = []
    for row in rows:
        begin = time.perf_counter_ns()
        run.step(row)
        found.append(time.perf_counter_ns() - begin)
    return np.array(found[len(rows) // 10 :], np.float64) / 1e3


def _best(work: Callable[[], Any], times: int = 3) -> float:
    """Shortest of some runs, s."""
    found = []
    for _ in range(times):
        begin = time.perf_counter()
        work()
        found.append(time.perf_counter() - begin)
    return min(found)


def compare_modes(estimator: Estimator, episode: Episode) -> Modes | None:
    """How far the two ways to run a recurrent network lie apart; None for others."""
    artefact = estimator.artefact
    if artefact is None or estimator.features is None or artefact.family != "gru":
        return None
    rows = estimator.features(episode)[: 20 * artefact.history]
    burn = min(2 * artefact.history, len(rows) - 1)
    kept, fresh = (predict(artefact, rows, mode=mode) for mode in ("streaming", "window"))
    apart = (kept - fresh)[burn:]
    return Modes(float(np.sqrt(np.mean(apart**2))), float(np.abs(apart).max()))


def _periodic(episode: Episode) -> Episode:
    """Three equal periods of a swing as wide as an episode's, with its lag behind the target."""
    turn = 2.0 * np.pi * np.arange(3 * _PERIOD) / _PERIOD
    pulse = 2.0 * np.pi / (_PERIOD * episode.dt)
    position = np.asarray(episode.columns["position"], np.float64)
    error = np.asarray(episode.columns["target"], np.float64) - position
    middle, reach = float(position.mean()), float(np.sqrt(2.0) * position.std())
    lag = float(np.sqrt(2.0) * error.std())
    swing = middle + reach * np.sin(turn)
    columns = {
        "position": swing,
        "target": swing + float(error.mean()) + lag * np.sin(turn + 0.5),
        "velocity": reach * pulse * np.cos(turn),
        "torque": np.zeros(len(turn)),
    }
    return Episode(episode.name, episode.group, episode.dt, columns)
