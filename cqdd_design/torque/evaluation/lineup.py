"""What is compared on a data set: networks from files, baselines beside them, test episodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.evaluation.baselines import current_estimate, fit_friction, pd_law
from cqdd_design.torque.evaluation.estimators import Estimator, FloatArray, network_estimator
from cqdd_design.torque.features.matrix import savitzky_golay
from cqdd_design.torque.features.physics import actuator_from_dict, physical_estimate, with_gains_of
from cqdd_design.torque.networks.artefact import Artefact, read_artefact

PROTOCOLS = ("trajectory", "mass", "wall", "gearbox")


@dataclass(frozen=True, eq=False)
class Lineup:
    """Estimators and the episodes to test them on.

    Attributes
    ----------
    estimators : tuple of Estimator
    sets : mapping of str to tuple of str
        Test episodes of each protocol.
    seen : mapping of str to frozenset of str
        Episodes that each estimator was trained, validated or fitted on.
    leaked : mapping of str to float
        Scores on random windows, N m, of models of which a network trained on such is given.
    warnings : tuple of str
    """

    estimators: tuple[Estimator, ...]
    sets: Mapping[str, tuple[str, ...]]
    seen: Mapping[str, frozenset[str]]
    leaked: Mapping[str, float]
    warnings: tuple[str, ...]


def read_networks(paths: Sequence[Path], data: DataSet) -> dict[str, Artefact]:
    """Networks by unique names; several of one model are told apart by seed or file.

    Raises
    ------
    UsageError
        For a file that is no network, one given twice, or one of other gains or sample time.
    """
    twice = next((path for k, path in enumerate(paths) if path in paths[:k]), None)
    if twice is not None:
        raise UsageError(f"{twice} is given twice; give each file once.")
    found = [(path, read_artefact(path)) for path in paths]
    honest = [artefact.name for _, artefact in found if not is_leaky(artefact)]
    named: dict[str, Artefact] = {}
    for path, artefact in found:
        artefact.require(data.dt, data.position_gain, data.velocity_gain)
        name = artefact.name
        if is_leaky(artefact):
            name = f"{name} (random windows)"
        elif honest.count(name) > 1:
            seed = artefact.facts.get("seed")
            name = f"{name} seed {seed}" if seed is not None else f"{name} ({path.stem})"
            if name in named:
                name = f"{artefact.name} ({path.stem})"
        if name in named:
            raise UsageError(f"{path} is the second network named {name}; give each file once.")
        named[name] = artefact
    return named


def is_leaky(artefact: Artefact) -> bool:
    """Whether a network was trained on random windows, to show what such a score is worth."""
    split = artefact.facts.get("split")
    return isinstance(split, Mapping) and split.get("protocol") == "random-window"


def trained_on(artefact: Artefact, data_sha256: str) -> frozenset[str]:
    """Episodes of a data set that a network's file says it was trained and validated on.

    A name is an episode's within its own data set only: of a network whose file names other data,
    none are known to be among these. A file that names no data is taken to mean these.
    """
    split = artefact.facts.get("split")
    if not isinstance(split, Mapping) or of_other_data(artefact, data_sha256):
        return frozenset()
    names = [*split.get("train", ()), *split.get("validation", ())]
    return frozenset(str(name) for name in names)


def of_other_data(artefact: Artefact, data_sha256: str) -> bool:
    """Whether a network's file says that it was trained on another data set."""
    return artefact.facts.get("data_sha256", data_sha256) != data_sha256


def actuator_of(artefacts: Sequence[Artefact]) -> ActuatorParameters | None:
    """The actuator whose parameters a network's file holds, None where none does."""
    for artefact in artefacts:
        content = artefact.facts.get("actuator")
        if isinstance(content, Mapping):
            return actuator_from_dict(content)
    return None


def split_of(artefacts: Sequence[Artefact], seed: int | None) -> tuple[str, int]:
    """Protocol and seed of the split that networks were trained with; trajectory and 0 at last.

    Raises
    ------
    UsageError
        When they were trained with splits of different seeds and none is chosen.
    """
    told = [a.facts["split"] for a in artefacts if isinstance(a.facts.get("split"), Mapping)]
    protocols = [str(one.get("protocol", "trajectory")) for one in told]
    seeds = sorted({int(one["seed"]) for one in told if "seed" in one})
    if seed is None and len(seeds) > 1:
        raise UsageError(
            f"these networks were trained with splits of seeds {', '.join(map(str, seeds))}; "
            "compare those of one split, or choose --split-seed."
        )
    chosen = seed if seed is not None else (seeds[0] if seeds else 0)
    return (protocols[0] if protocols else "trajectory"), chosen


def line_up(
    data: DataSet,
    networks: Mapping[str, Artefact],
    protocols: Sequence[str] = (),
    *,
    split_seed: int | None = None,
    actuator: ActuatorParameters | None = None,
) -> Lineup:
    """Networks and baselines, and the test sets of some protocols.

    Parameters
    ----------
    data : DataSet
    networks : mapping of str to Artefact
    protocols : sequence of str
        Of `PROTOCOLS`; default that of the first network.
    split_seed : int, optional
        Default that of the networks.
    actuator : ActuatorParameters, optional
        For the physical baselines; default the one in a network's file. Its gains become those of
        the data.

    Raises
    ------
    UsageError
        For an unknown protocol, or a network that needs an actuator where none is known.
    """
    from cqdd_design.torque.data.splits import split

    leaky = [artefact for artefact in networks.values() if is_leaky(artefact)]
    networks = {name: one for name, one in networks.items() if not is_leaky(one)}
    own, seed = split_of(list(networks.values()), split_seed)
    chosen = tuple(dict.fromkeys(protocols)) or (own,)
    for name in chosen:
        if name not in PROTOCOLS:
            raise UsageError(
                f"there is no test set '{name}'{did_you_mean(name, PROTOCOLS)}; there are "
                f"{', '.join(PROTOCOLS)}."
            )
    splits = {name: split(data, name, seed) for name in chosen}
    warnings: list[str] = []
    known = actuator or actuator_of([*networks.values(), *leaky])
    if known is not None:
        known = with_gains_of(known, data)
    estimators = [
        network_estimator(artefact, name=name, actuator=known)
        for name, artefact in networks.items()
    ]
    identity = data.sha256
    seen = {name: trained_on(artefact, identity) for name, artefact in networks.items()}
    strange = [name for name, one in networks.items() if of_other_data(one, identity)]
    without = ", ".join(name for name, own in seen.items() if not own and name not in strange)
    if without:
        warnings.append(
            f"{without}: the file does not say which episodes it was trained on, so a test on them "
            "cannot be ruled out."
        )
    warnings += [
        f"{name} was trained on other data than these; that no test episode was among them cannot "
        "be told by names."
        for name in strange
    ]
    first = splits[chosen[0]]
    fitted = tuple(name for name in first.train if all(name not in s.test for s in splits.values()))
    estimators += baselines(data, fitted, known)
    if known is None:
        warnings.append(
            "no actuator is known, so the estimates from current and from physics are left out; "
            "give the design with --design."
        )
    seen["friction-fit"] = frozenset(fitted)
    return Lineup(
        estimators=tuple(estimators),
        sets={name: one.test for name, one in splits.items()},
        seen=seen,
        leaked=_leaked(data, networks, leaky, known, warnings),
        warnings=tuple(warnings),
    )


def baselines(
    data: DataSet, fitted: tuple[str, ...], actuator: ActuatorParameters | None
) -> list[Estimator]:
    """Estimates that no network makes; friction is fitted on the episodes named."""
    differentiator = savitzky_golay(data.dt)
    span = len(differentiator.taps)

    def law(episode: Episode) -> FloatArray:
        return pd_law(episode, data.position_gain, data.velocity_gain, data.torque_range)

    found = [Estimator("pd-law", law, 0, remark="what the controller asks for")]
    if fitted:
        fit = fit_friction(data, fitted, differentiator)
        found.append(
            Estimator(
                "friction-fit",
                fit.estimate,
                fit.parameters,
                history=span,
                remark="controller less fitted friction and inertia",
            )
        )
    if actuator is not None:
        found.append(
            Estimator(
                "physics",
                partial(_physics, actuator, differentiator),
                0,
                history=span,
                remark="the actuator's known parameters, nothing fitted",
            )
        )
        found.append(
            Estimator(
                "current",
                partial(current_estimate, actuator),
                0,
                needs=("current",),
                remark="current times constant, ratio and efficiency",
            )
        )
    return found


def _physics(actuator: ActuatorParameters, differentiator: Any, episode: Episode) -> FloatArray:
    return physical_estimate(actuator, episode, differentiator)


def _leaked(
    data: DataSet,
    networks: Mapping[str, Artefact],
    leaky: Sequence[Artefact],
    actuator: ActuatorParameters | None,
    warnings: list[str],
) -> dict[str, float]:
    """Scores on random windows of the models compared, by the networks trained on such."""
    found: dict[str, float] = {}
    for artefact in leaky:
        names = [name for name, one in networks.items() if one.name == artefact.name]
        if not names:
            warnings.append(
                f"{artefact.name} trained on random windows has no honest twin among the models; "
                "its score says nothing alone and is left out."
            )
            continue
        score = leaked_rmse(artefact, data, actuator)
        found |= dict.fromkeys(names, score)
    return found


def leaked_rmse(
    artefact: Artefact, data: DataSet, actuator: ActuatorParameters | None = None
) -> float:
    """RMSE (N m) of a network trained on random windows, on the windows that it was not shown.

    Raises
    ------
    UsageError
        When the windows drawn from these data are not those of its training.
    """
    from cqdd_design.torque.data.splits import random_window_split

    split = artefact.facts["split"]
    drawn, windows = random_window_split(data, int(split["seed"]))
    if artefact.facts.get("data_sha256") != drawn.sha256:
        raise UsageError(
            f"{artefact.name} was trained on random windows of other data, or drawn otherwise; "
            "train it anew, or leave it out."
        )
    estimator = network_estimator(artefact, actuator=actuator)
    errors = [
        float(estimator.estimate(one)[-1] - one.columns["torque"][-1])
        for one in drawn.named(windows.test)
    ]
    return float(np.sqrt(np.mean(np.square(errors))))
