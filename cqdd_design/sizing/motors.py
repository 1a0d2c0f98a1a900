"""Any motor: bare motors of the catalogue screened, ranked, and tried until one fits.

A verdict takes some half a minute a motor and a screen by closed forms some seconds for all. So the
screen sets the order, and the first motor of that order that is borne out is taken: another one
further down may do better by the closest models, which nobody has asked.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from cqdd_design.catalog.motors import Motor, motors
from cqdd_design.design import Requirements
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.sizing.able import PEAK, first_guess
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.motor_ranks import RANKED, Ranked, screened
from cqdd_design.solids.motor_rules import undrawn_sizes
from cqdd_design.verdict.motor import missing_figures

T = TypeVar("T")
_TOLD = 3
"""Motors whose refusal an error tells; the first are the closest."""


def lacking(motor: Motor) -> tuple[str, ...]:
    """What a bare motor's row lacks of what the verdict needs, in words; empty where nothing.

    The lines of the motor want its figures and those of heat its sizes.
    """
    return tuple(dict.fromkeys((*missing_figures(motor), *undrawn_sizes(motor))))


@dataclass(frozen=True)
class TriedMotor:
    """A motor that was tried by more than the screen.

    Attributes
    ----------
    name : str
    why : str
        Why it was refused; empty of the one that was taken.
    """

    name: str
    why: str

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {"motor": self.name, "fits": not self.why, "why": self.why or None}


@dataclass(frozen=True)
class MotorChoice:
    """How a motor was chosen.

    Attributes
    ----------
    goal : Goal
        By which the screen ranked.
    to_verdict : bool
        Whether those tried were judged by the whole verdict; else by closed forms.
    geared : int
        Rows of the catalogue that are geared actuators.
    left_out : mapping of str to tuple of str
        Bare motors that cannot be judged, and the figures that their rows lack.
    ranked : tuple of Ranked
        All others: those that pass the screen, best first, then the rest, the closest first.
    tried : tuple of TriedMotor
        In that order; the last was taken unless it is refused too.
    """

    goal: Goal
    to_verdict: bool
    geared: int
    left_out: Mapping[str, tuple[str, ...]]
    ranked: tuple[Ranked, ...]
    tried: tuple[TriedMotor, ...] = ()

    @property
    def chosen(self) -> str:
        """Name of the motor that was taken; empty where none was."""
        return next((one.name for one in self.tried if not one.why), "")

    @property
    def untried(self) -> tuple[str, ...]:
        """Motors that pass the screen and were not tried, because one before them fits."""
        names = {one.name for one in self.tried}
        return tuple(
            one.motor.name for one in self.ranked if not one.why and one.motor.name not in names
        )

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was left out, screened and tried, for people."""
        by = "the whole verdict" if self.to_verdict else "the search by closed forms"
        bare = len(self.left_out) + len(self.ranked)
        passed = sum(not one.why for one in self.ranked)
        lack = Counter(words for missing in self.left_out.values() for words in missing)
        often = ", ".join(f"{words} {count}" for words, count in lack.most_common(_TOLD))
        found = (
            f"{self.geared} of {self.geared + bare} motors of the catalogue are geared actuators; "
            f"of {bare} bare ones {len(self.left_out)} lack figures that the verdict needs"
            f"{f' (most often {often})' if often else ''}; {passed} of the other "
            f"{len(self.ranked)} pass the screen, ranked by {RANKED[self.goal]}.",
        )
        if not self.chosen:
            return (*found, f"Tried by {by}: {len(self.tried)}, and none fits.")
        says = "whose verdict is yes" if self.to_verdict else "that closed forms bear out"
        return (
            *found,
            f"'{self.chosen}' is the first by the screen's order {says}: {len(self.tried)} tried "
            f"by {by}, {len(self.untried)} only screened.",
            *self._lent,
        )

    @property
    def _lent(self) -> tuple[str, ...]:
        """That figures of the motor that was taken are another's, where they are."""
        motor = next(one.motor for one in self.ranked if one.motor.name == self.chosen)
        lent = motor.taken_over.split()
        if not lent:
            return ()
        return (
            f"{len(lent)} of its figures are those of '{motor.taken_from}', which the catalogue "
            f"takes over until its own are known (`cqdd-design catalog motors {motor.name}`).",
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``motors``)."""
        return {
            "chosen": self.chosen or None,
            "ranked_by": RANKED[self.goal],
            "tried_by": "verdict" if self.to_verdict else "closed forms",
            "geared": self.geared,
            "left_out": [
                {"motor": name, "missing": list(words)} for name, words in self.left_out.items()
            ],
            "screened": [one.to_dict() for one in self.ranked],
            "tried": [one.to_dict() for one in self.tried],
            "only_screened": list(self.untried),
        }


@dataclass(frozen=True)
class WithMotor(Generic[T]):
    """What sizing with the chosen motor gave, and how that motor was found."""

    result: T
    choice: MotorChoice


class NoMotorError(SizingInfeasibleError):
    """No motor of the catalogue meets the requirements. Exit code 3.

    Attributes
    ----------
    choice : MotorChoice
        What was left out, screened and tried.
    """

    def __init__(
        self,
        message: str,
        choice: MotorChoice,
        *,
        binding: tuple[str, ...],
        most_torque: float | None,
    ) -> None:
        super().__init__(message, binding=binding, most_torque=most_torque)
        self.choice = choice

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return super().to_dict() | {"motors": self.choice.to_dict()}


def size_with_any(
    requirements: Requirements,
    attempt: Callable[[Requirements, Motor], T],
    *,
    to_verdict: bool,
    ambient: float | None = None,
    goal: Goal = "mass",
    rows: Iterable[Motor] | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> WithMotor[T]:
    """Size with the motors of the catalogue, in the order of a screen, until one fits.

    Parameters
    ----------
    requirements : Requirements
        Their motor is replaced; they state the peak torque.
    attempt : callable
        Sizes for requirements and a motor, and raises a `DesignError` where that motor does not do.
    to_verdict : bool
        Whether `attempt` ends in the verdict: then the screen looks at all discs and steels that
        sizing to the verdict tries.
    ambient : float, optional
        Of the air, deg C.
    goal : Goal
        What the screen ranks by, the motor counted, see :mod:`cqdd_design.sizing.motor_ranks`.
    rows : iterable of Motor, optional
        Default the catalogue.
    progress : callable
        Called with a sentence at every stage.

    Raises
    ------
    UsageError
        When no peak torque is stated.
    NoMotorError
        When none fits; it says for the closest motors what binds.
    """
    if PEAK in requirements.derived:
        raise UsageError(
            "--motor any needs a peak torque: without one the motor decides what can be asked, and "
            'the smallest would do; add --peak-torque, as in --peak-torque "30 N*m", or name a '
            "motor."
        )
    every = tuple(motors().values() if rows is None else rows)
    bare = [one for one in every if one.torque_at == "motor"]
    left_out = {one.name: missing for one in bare if (missing := lacking(one))}
    able = tuple(one for one in bare if one.name not in left_out)
    progress(f"screening {len(able)} motors of {len(every)} by closed forms")
    ranked = screened(
        # Guesses of a motor hang on the stated peak alone, whatever its figures are.
        first_guess(requirements, able[0]) if able else requirements,
        able,
        every_space=to_verdict,
        ambient=ambient,
        goal=goal,
    )
    choice = MotorChoice(goal, to_verdict, len(every) - len(bare), left_out, ranked)
    # Where no gearbox passes, the closest motor is tried all the same: that says what would do.
    order = [one.motor for one in ranked if not one.why] or [
        one.motor for one in ranked if one.explained
    ][:1]
    refused: dict[str, DesignError] = {}
    for number, motor in enumerate(order, 1):
        progress(f"motor {number} of {len(order)}: {motor.name}")
        asked = requirements.unchecked_copy({"motor": motor.name})
        try:
            result = attempt(asked, motor)
        except DesignError as error:
            refused[motor.name] = error
            continue
        tried = (*_refusals(refused), TriedMotor(motor.name, ""))
        return WithMotor(result, replace(choice, tried=tried))
    raise _none_fits(replace(choice, tried=_refusals(refused)), refused)


def _refusals(refused: Mapping[str, DesignError]) -> tuple[TriedMotor, ...]:
    return tuple(TriedMotor(name, error.message) for name, error in refused.items())


def _none_fits(choice: MotorChoice, refused: Mapping[str, DesignError]) -> NoMotorError:
    """What binds with the motors that came closest: those that were tried, then by their screen."""
    causes = [error for error in refused.values() if isinstance(error, SizingInfeasibleError)]
    screened_out = [one for one in choice.ranked if one.why and one.motor.name not in refused]
    told = [f"{name}: {error.message.rstrip('.')}" for name, error in refused.items()]
    told += [f"{one.motor.name}: {one.why}" for one in screened_out]
    binding = [causes[0].binding] if causes else [one.binding for one in screened_out[:1]]
    most = [one.most_torque for one in causes if one.most_torque is not None]
    text = f"no motor fits: {' '.join(choice.sentences)}"
    if told:
        more = len(told) - _TOLD
        text += " " + ". ".join(told[:_TOLD]) + (f". And {more} more." if more > 0 else ".")
    return NoMotorError(
        f"{text} Ask for less, or describe a motor of your own with --motor-file.",
        choice,
        binding=binding[0] if binding else (),
        most_torque=max(most, default=None),
    )
