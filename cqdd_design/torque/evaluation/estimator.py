"""Networks and baselines behind one face, so that all are scored alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.data.episodes import Episode, FloatArray
from cqdd_design.torque.evaluation.rollout import Stepper
from cqdd_design.torque.features.matrix import PHYSICAL, feature_matrix
from cqdd_design.torque.features.physics import actuator_from_dict
from cqdd_design.torque.networks.artefact import Artefact
from cqdd_design.torque.networks.predict import Streaming, predict

Kind = Literal["network", "baseline"]


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
    features : callable or None
        From an `Episode` to the network's raw inputs (N, F).
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
        if self.artefact is None or self.features is None:
            return lambda past: float(self.estimate(past)[-1])
        network, features = Streaming(self.artefact), self.features
        return lambda past: float(network.step(features(past)[-1]))


def network_estimator(
    artefact: Artefact, *, name: str = "", actuator: ActuatorParameters | None = None
) -> Estimator:
    """A trained network.

    Parameters
    ----------
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
    stored = artefact.facts.get("actuator")
    known = actuator_from_dict(stored) if isinstance(stored, Mapping) else actuator
    physics = known if set(PHYSICAL) & set(artefact.inputs) else None
    if physics is None and set(PHYSICAL) & set(artefact.inputs):
        raise UsageError(
            f"{artefact.name} corrects what an actuator's parameters say, and none are known; "
            "give its design with --design."
        )

    def features(episode: Episode) -> FloatArray:
        return feature_matrix(
            episode, artefact.inputs, differentiator=artefact.differentiator, physics=physics
        )

    return Estimator(
        name=name or artefact.name,
        estimate=lambda episode: predict(artefact, features(episode)),
        parameters=artefact.parameters,
        history=artefact.history,
        kind="network",
        model=artefact.name,
        artefact=artefact,
        features=features,
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
