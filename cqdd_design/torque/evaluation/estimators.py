"""Networks and baselines behind one face, so that all are scored alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode
from cqdd_design.torque.evaluation.rollout import Stepper
from cqdd_design.torque.networks.artefact import Artefact, Mode

if TYPE_CHECKING:
    from cqdd_design.torque.networks.predict import Streaming

FloatArray = NDArray[np.float64]
Kind = Literal["network", "baseline"]

BATCH = 16_000
"""Samples of the throughput, as many as the paper's test set."""
_STEPS, _WINDOWS = 3000, 400


@dataclass(frozen=True, eq=False)
class Estimator:
    """Something that tells torque from a record.

    Attributes
    ----------
    name : str
        Unique among those compared.
    estimate : callable
        From an `Episode` to torque (N,), N m; the first ``history - 1`` may be nan.
    parameters : int
        Trained or fitted numbers.
    history : int
        Samples that one estimate sees.
    kind : {"network", "baseline"}
    model : str
        The name that several seeds share.
    needs : tuple of str
        Columns beyond the required ones.
    artefact : Artefact or None
    features : callable or None
        From an `Episode` to the network's raw inputs (N, F).
    remark : str
    """

    name: str
    estimate: Callable[[Episode], FloatArray]
    parameters: int
    history: int = 1
    kind: Kind = "baseline"
    model: str = ""
    needs: tuple[str, ...] = ()
    artefact: Artefact | None = None
    features: Callable[[Episode], FloatArray] | None = None
    remark: str = ""

    @property
    def knows_phase(self) -> bool:
        """Whether the homed output position is among the inputs."""
        names = () if self.artefact is None else self.artefact.inputs
        return any(name == "ripple" or name.startswith(("sin_", "cos_")) for name in names)

    @property
    def closes_loop(self) -> bool:
        """Whether motion alone is enough, so that it can drive a simulation."""
        return not set(self.needs) - {"position", "target", "velocity"}

    def stepper(self) -> Stepper:
        """One sample at a time, from a fresh state."""
        if self.artefact is not None and self.features is not None:
            return _NetworkStepper(streaming(self.artefact), self.features)
        return _BaselineStepper(self.estimate)


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
class _NetworkStepper:
    network: Streaming
    features: Callable[[Episode], FloatArray]

    def step(self, past: Episode) -> float:
        return float(self.network.step(self.features(past)[-1]))


@dataclass(frozen=True)
class _BaselineStepper:
    estimate: Callable[[Episode], FloatArray]

    def step(self, past: Episode) -> float:
        return float(self.estimate(past)[-1])


def streaming(artefact: Artefact, mode: Mode | None = None) -> Streaming:
    """A fresh run of a network, one sample at a time; default in its own mode."""
    from cqdd_design.torque.networks.predict import Streaming

    return Streaming(artefact, mode)


def kept_state(artefact: Artefact) -> Mode:
    """The mode in which a network runs for ever: with its state kept, where it has one."""
    return "streaming" if artefact.family == "gru" else "window"


def network_estimator(
    artefact: Artefact, *, name: str = "", actuator: ActuatorParameters | None = None
) -> Estimator:
    """A trained network.

    Parameters
    ----------
    artefact : Artefact
    name : str
        Default the artefact's.
    actuator : ActuatorParameters, optional
        For a network that corrects an actuator's balance and does not hold the one that it was
        trained with; its own, where it does, is the only one that fits.

    Raises
    ------
    UsageError
        For a network that corrects an actuator's balance, without the actuator.
    """
    from cqdd_design.torque.features.matrix import PHYSICAL, feature_matrix
    from cqdd_design.torque.features.physics import actuator_from_dict
    from cqdd_design.torque.networks.predict import predict

    stored = artefact.facts.get("actuator")
    if isinstance(stored, Mapping):
        actuator = actuator_from_dict(stored)

    physical = bool(set(PHYSICAL) & set(artefact.inputs))
    if physical and actuator is None:
        raise UsageError(
            f"{artefact.name} corrects what an actuator's parameters say, and none are known; "
            "give its design with --design."
        )

    def features(episode: Episode) -> FloatArray:
        physics = actuator if physical else None
        found = feature_matrix(
            episode, artefact.inputs, differentiator=artefact.differentiator, physics=physics
        )
        return np.asarray(found, np.float64)

    def estimate(episode: Episode) -> FloatArray:
        return np.asarray(predict(artefact, features(episode)), np.float64)

    return Estimator(
        name=name or artefact.name,
        estimate=estimate,
        parameters=artefact.parameters,
        history=artefact.history,
        kind="network",
        model=artefact.name,
        artefact=artefact,
        features=features,
        remark=f"{artefact.family.upper()}, {artefact.mode}",
    )


def without_phase(episode: Episode, seed: int, index: int) -> Episode:
    """The episode as a joint that was not homed would record it: all angles off by a constant.

    The constant is uniform over a turn and drawn for each episode by seed and index.
    """
    offset = np.random.default_rng([seed, index]).uniform(-np.pi, np.pi)
    turned = {
        name: values + offset if name in ("position", "target") else values
        for name, values in episode.columns.items()
    }
    return replace(episode, columns=turned)


def latency(estimator: Estimator, episode: Episode) -> Latency:
    """Time an estimator on this machine, with the features of one episode.

    Features are made beforehand: the times are those of the estimate alone, for a baseline those
    of its whole law.
    """
    artefact = estimator.artefact
    if artefact is None or estimator.features is None:
        count = len(episode)
        return Latency(None, None, None, 1e6 * _best(lambda: estimator.estimate(episode)) / count)
    from cqdd_design.torque.networks.predict import predict

    rows = estimator.features(episode)
    rows = np.ascontiguousarray(np.resize(rows, (BATCH, rows.shape[1])))
    forever = _steps(streaming(artefact, kept_state(artefact)), rows[:_STEPS])
    window = _steps(streaming(artefact, "window"), rows[: artefact.history + _WINDOWS])
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


@dataclass(frozen=True)
class Modes:
    """Streaming against windows of the same network, after the burn-in, N m."""

    difference_rms: float
    difference_most: float


def compare_modes(estimator: Estimator, episode: Episode) -> Modes | None:
    """How far the two ways to run a recurrent network lie apart; None for others."""
    artefact = estimator.artefact
    if artefact is None or estimator.features is None or artefact.family != "gru":
        return None
    from cqdd_design.torque.networks.predict import predict

    rows = estimator.features(episode)[: 20 * artefact.history]
    burn = min(2 * artefact.history, len(rows) - 1)
    apart = np.asarray(
        predict(artefact, rows, mode="streaming") - predict(artefact, rows, mode="window")
    )[burn:]
    return Modes(float(np.sqrt(np.mean(apart**2))), float(np.abs(apart).max()))
