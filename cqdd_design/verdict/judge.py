"""The one judgement of a machine: every command that says whether a design will do says this."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.gearbox.checks.allowables import YIELD_SAMPLES
from cqdd_design.gearbox.checks.guide_row import GEOMETRY
from cqdd_design.machine import Machine
from cqdd_design.results import Check, worst_status
from cqdd_design.verdict.evidence import Evidence, Progress, gather
from cqdd_design.verdict.headline import Figure, headline, peak_torque
from cqdd_design.verdict.lines import lines_without_drawn, with_drawn

Meets = Literal["yes", "no", "unknown"]
_AT_LIMIT = 1.005
"""Margin up to which a size stands at its limit."""
_LIMITS = 6
"""Lines told as what binds, where none fails."""


@dataclass(frozen=True, eq=False, repr=False)
class Verdict:
    """Whether a machine meets its requirements.

    Attributes
    ----------
    name : str
        Of the design.
    lines : tuple of Check
        Every requirement and check.
    evidence : Evidence
        What they were made of.
    peak : Figure
        The first of the headline.

    Notes
    -----
    `cqdd_design.check` gives it: `meets` is "yes", "no" or "unknown", `headline` the seven figures,
    `sentence` the answer in words.
    """

    name: str
    lines: tuple[Check, ...]
    evidence: Evidence
    peak: Figure

    def __repr__(self) -> str:
        """The answer and the seven figures."""
        return "\n".join([f"Verdict: {self.sentence}", *(f"  {one.told}" for one in self.headline)])

    @cached_property
    def headline(self) -> tuple[Figure, ...]:
        """The seven figures a designer looks at first."""
        return headline(self.evidence, self.lines, self.peak)

    @property
    def meets(self) -> Meets:
        """``yes`` only where no line fails and none is unknown."""
        return meets(self.lines)

    @property
    def limits(self) -> tuple[Check, ...]:
        """What binds: failures by least margin, what is not known, warnings, then the closest.

        Of those that pass, sizes come after all that gives way: a search fills the space it has.
        """
        order = {"fail": 0, "unknown": 1, "warn": 2, "pass": 3}

        def place(line: Check) -> tuple[int, bool, float]:
            passes = line.status == "pass"
            size = passes and line.basis == GEOMETRY
            return order[line.status], size, line.margin if line.known else 0.0

        ranked = sorted(self.lines, key=place)
        broken = sum(line.status != "pass" for line in ranked)
        return tuple(ranked[: max(broken, _LIMITS)])

    @property
    def filled(self) -> tuple[Check, ...]:
        """Sizes that pass and stand at their limit."""
        return tuple(
            line
            for line in self.lines
            if line.status == "pass" and line.basis == GEOMETRY and line.margin < _AT_LIMIT
        )

    @property
    def sentence(self) -> str:
        """All of it in one."""
        return sentence(self.name, self.lines)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Why something could not be judged."""
        found = self.evidence
        reasons = (
            *found.machine.analysis.warnings,
            found.stress_missing,
            found.heat_missing,
            found.actuator_missing,
            found.drawn_missing,
        )
        return tuple(dict.fromkeys(one for one in reasons if one))

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``verdict``)."""
        return {
            "meets": self.meets,
            "headline": [figure.to_dict() for figure in self.headline],
            "limits": [
                {
                    "id": line.id,
                    "status": line.status,
                    "reserve": line.margin if line.known else None,
                    "remedy": line.remedy,
                }
                for line in self.limits
            ],
        }


def meets(lines: Iterable[Check]) -> Meets:
    """``yes`` only where no line fails and none is unknown; a warning does not hinder."""
    answers: dict[str, Meets] = {"fail": "no", "unknown": "unknown"}
    return answers.get(worst_status(lines), "yes")


def sentence(name: str, lines: Iterable[Check]) -> str:
    """Whether a design meets its requirements, with the number of lines that do not.

    Without `YIELD` among the lines nothing is said to meet them.
    """
    every = tuple(lines)
    counts = {status: sum(line.status == status for line in every) for status in _TOLD}
    told = [f"{counts[status]} {words}" for status, words in _TOLD.items() if counts[status]]
    if meets(every) == "yes" and all(line.id != "YIELD" for line in every):
        return (
            f"{name}: of {len(every)} lines {', '.join(told)}; YIELD is open, `check` draws its "
            "gearboxes"
        )
    answer = {
        "yes": "meets its requirements",
        "no": "does NOT meet its requirements",
        "unknown": "is not shown to meet its requirements",
    }[meets(every)]
    return f"{name} {answer}: of {len(every)} lines " + ", ".join(told)


_TOLD = {"pass": "pass", "warn": "warn", "fail": "FAIL", "unknown": "are UNKNOWN"}


def judge(
    machine: Machine,
    specimen: Specimen = AS_DRAWN,
    *,
    samples: int = YIELD_SAMPLES,
    sensitivity: bool = False,
    progress: Progress = lambda _: None,
) -> Verdict:
    """Judge a machine.

    Parameters
    ----------
    specimen : Specimen
        Whose motor and fitted values count; its gearbox is of perfect parts.
    samples : int
        Toleranced gearboxes drawn for the line ``YIELD``; with 0 it is unknown.
    sensitivity : bool
        Whether to rank the tolerances too.
    progress : callable
        Told in a few words what begins, twice.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    evidence, (lines, peak) = gather(
        machine,
        specimen,
        _without_drawn,
        samples=samples,
        sensitivity=sensitivity,
        progress=progress,
    )
    return Verdict(machine.given.name, with_drawn(evidence, lines), evidence, peak)


def _without_drawn(evidence: Evidence) -> tuple[tuple[Check, ...], Figure]:
    """What there is to tell while gearboxes are drawn."""
    lines = lines_without_drawn(evidence)
    return lines, peak_torque(evidence, lines)
