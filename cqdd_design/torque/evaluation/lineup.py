"""What is compared on a data set: networks from files, baselines beside them, test episodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.torque.data.episodes import DataSet
from cqdd_design.torque.data.splits import PROTOCOLS, split
from cqdd_design.torque.evaluation.baselines import current_estimate, fit_friction, pd_law
from cqdd_design.torque.evaluation.carried import (
    DesignVersion,
    actuator_of,
    moved_on,
    version_in,
)
from cqdd_design.torque.evaluation.estimator import Estimator, network_estimator
from cqdd_design.torque.features.acceleration import savitzky_golay
from cqdd_design.torque.features.physics import physical_estimate, with_gains_of
from cqdd_design.torque.networks.artefact import Artefact, read_artefact


@dataclass(frozen=True, eq=False)
class Lineup:
    """Estimators and the episodes to test them on.

    Attributes
    ----------
    sets : mapping of str to tuple of str
        Test episodes of each protocol.
    seen : mapping of str to frozenset of str
        Episodes that each estimator was trained, validated or fitted on.
    """

    estimators: tuple[Estimator, ...]
    sets: Mapping[str, tuple[str, ...]]
    seen: Mapping[str, frozenset[str]]
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
    models = [artefact.name for _, artefact in found]
    named: dict[str, Artefact] = {}
    for path, artefact in found:
        artefact.require(data.dt, data.position_gain, data.velocity_gain)
        name = artefact.name
        if models.count(name) > 1:
            seed = artefact.facts.get("seed")
            name = f"{name} seed {seed}" if seed is not None else f"{name} ({path.stem})"
            if name in named:
                name = f"{artefact.name} ({path.stem})"
        if name in named:
            raise UsageError(f"{path} is the second network named {name}; give each file once.")
        named[name] = artefact
    return named


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
    return bool(artefact.facts.get("data_sha256", data_sha256) != data_sha256)


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
    design: DesignVersion | None = None,
) -> Lineup:
    """Networks and baselines, and the test sets of some of `splits.PROTOCOLS`.

    Protocol and seed of the split are by default those of the networks, the actuator of the
    physical baselines the one in a network's file; its gains become those of the data. Where they
    were trained on another version of the design, by default that of the data, a warning says so.

    Raises
    ------
    UsageError
        For an unknown protocol, or a network that needs an actuator where none is known.
    """
    own, seed = split_of(list(networks.values()), split_seed)
    chosen = tuple(dict.fromkeys(protocols)) or (own,)
    unknown = next((name for name in chosen if name not in PROTOCOLS), None)
    if unknown is not None:
        raise UsageError(
            f"there is no test set '{unknown}'{did_you_mean(unknown, PROTOCOLS)}; there are "
            f"{', '.join(PROTOCOLS)}."
        )
    splits = {name: split(data, name, seed) for name in chosen}
    warnings = [*moved_on(networks, design or version_in(data.facts), actuator)]
    known = actuator or actuator_of(list(networks.values()))
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
        warnings=tuple(warnings),
    )


def baselines(
    data: DataSet, fitted: tuple[str, ...], actuator: ActuatorParameters | None
) -> list[Estimator]:
    """Estimates that no network makes; friction is fitted on the episodes named.

    ``pd-law`` is what the controller asks for, ``friction-fit`` that less fitted friction and
    inertia, ``physics`` the actuator's known parameters with nothing fitted, and ``current`` the
    current times constant, ratio and efficiency.
    """
    slope = savitzky_golay(data.dt)
    span = len(slope.taps)
    found = [Estimator("pd-law", partial(pd_law, data), 0)]
    if fitted:
        fit = fit_friction(data, fitted, slope)
        found.append(Estimator("friction-fit", fit.estimate, fit.parameters, history=span))
    if actuator is not None:
        physics = partial(physical_estimate, actuator, differentiator=slope)
        current = partial(current_estimate, actuator)
        found.append(Estimator("physics", physics, 0, history=span))
        found.append(Estimator("current", current, 0, needs=("current",)))
    return found
