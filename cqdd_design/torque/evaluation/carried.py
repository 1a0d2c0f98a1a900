"""The actuator that a network keeps: which design it was trained on, and whether that moved on."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.torque.features.physics import actuator_from_dict
from cqdd_design.torque.networks.artefact import Artefact

_DIGITS = 8
"""Of a digest, for people."""


class DesignVersion(NamedTuple):
    """A design by name and digest of its content."""

    name: str
    sha256: str

    def __str__(self) -> str:
        """For a sentence."""
        return f"{self.name} (sha256 {self.sha256[:_DIGITS]})"


def version_in(facts: Mapping[str, object]) -> DesignVersion | None:
    """The design that facts of data name; None where they do not, as those of logs."""
    name, digest = facts.get("design"), facts.get("design_sha256")
    if not (isinstance(name, str) and isinstance(digest, str)):
        return None
    return DesignVersion(name, digest)


def trained_on_design(artefact: Artefact) -> DesignVersion | None:
    """The design whose data a network was trained on; None where its file does not say."""
    data = artefact.facts.get("data")
    return version_in(data) if isinstance(data, Mapping) else None


def actuator_of(artefacts: Sequence[Artefact]) -> ActuatorParameters | None:
    """The actuator whose parameters a network's file holds, None where none does."""
    for artefact in artefacts:
        content = artefact.facts.get("actuator")
        if isinstance(content, Mapping):
            return actuator_from_dict(content)
    return None


def carried(artefact: Artefact) -> str:
    """A sentence on the actuator that a network keeps; empty where its file tells of none."""
    then, kept = trained_on_design(artefact), actuator_of([artefact])
    which = str(then) if then else kept.name if kept else ""
    if not which:
        return ""
    return (
        f"{artefact.name} keeps the actuator that it was trained on, that of {which}; another one, "
        "or a design that has moved on, is not in it."
    )


def moved_on(
    networks: Mapping[str, Artefact],
    now: DesignVersion | None,
    actuator: ActuatorParameters | None = None,
) -> tuple[str, ...]:
    """Sentences on networks, by their names, that were not trained on the design of today.

    Parameters
    ----------
    now : DesignVersion, optional
        Of the design, or of the data that they are tested on; a file that names no design tells
        nothing.
    actuator : ActuatorParameters, optional
        What that design makes; sentences then tell in what the actuator differs whose parameters
        a network's file holds.
    """
    alike: dict[tuple[DesignVersion | None, tuple[str, ...]], list[str]] = {}
    for name, artefact in networks.items():
        then = trained_on_design(artefact)
        if then is None or now is None or then.sha256 == now.sha256:
            then = None
        differing = _differing(artefact, actuator)
        if then is not None or differing:
            alike.setdefault((then, differing), []).append(name)
    return tuple(
        _moved(", ".join(names), len(names) > 1, then, now, differing)
        for (then, differing), names in alike.items()
    )


def _moved(
    names: str,
    several: bool,
    then: DesignVersion | None,
    now: DesignVersion | None,
    differing: tuple[str, ...],
) -> str:
    keep, they, were = ("keep", "they", "were") if several else ("keeps", "it", "was")
    head = f"{names} {keep} the actuator that {they} {were} trained on"
    told = f": {', '.join(differing)} differ" if differing else ""
    if then is None:
        return f"{head}, not the one of this design{told}."
    return (
        f"{head}, that of {then} and not of {now}: the design has moved on{told and ';'}{told[1:]}."
    )


def _differing(artefact: Artefact, now: ActuatorParameters | None) -> tuple[str, ...]:
    """Dotted names of what a network's own actuator has otherwise, by more than a per cent."""
    kept = actuator_of([artefact])
    if kept is None or now is None:
        return ()
    return tuple(
        f"{part}.{name}"
        for part in ("motor", "friction", "gear")
        for name, value in vars(getattr(kept, part)).items()
        if isinstance(value, float)
        and not math.isclose(value, getattr(getattr(now, part), name), rel_tol=0.01)
        and not (math.isnan(value) and math.isnan(getattr(getattr(now, part), name)))
    )
