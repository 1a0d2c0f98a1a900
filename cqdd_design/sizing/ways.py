"""The requirements that fit where some do not, in each direction, as a refusal tells them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from cqdd_design.design import Requirements
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.looser import Figures, in_words
from cqdd_design.sizing.verified import VerifiedDesign


class Torques(NamedTuple):
    """A peak torque and the continuous torque that goes with it, N m."""

    peak: float
    lasting: float

    @classmethod
    def of(cls, found: VerifiedDesign) -> Torques:
        """Those of a design."""
        fits = found.sizing.design.requirements
        return cls(fits.peak_torque, fits.continuous_torque)

    @property
    def words(self) -> str:
        """As keys of a file and their values."""
        return f"peak_torque {self.peak:g} N*m with continuous_torque {self.lasting:g} N*m"


@dataclass(frozen=True)
class Ways:
    """Requirements for each of which by itself, all else as asked, a design was found.

    Attributes
    ----------
    refusal : SizingInfeasibleError
        Of what was asked.
    asked : Requirements
        With guesses in place of torques that were not stated.
    torques : Torques, optional
    speed : float, optional
        Of the input with the continuous torque, rpm.
    figures : dict of str to float
        In the units of their fields, by key.
    ratio : int, optional
    space : mapping of str to float
        Ring and length, each by itself, m.
    besides : str
        What does not help, in sentences.
    in_vain : tuple of Requirements
        For which any design was searched for, and none found.
    """

    refusal: SizingInfeasibleError
    asked: Requirements
    torques: Torques | None
    speed: float | None
    figures: Figures
    ratio: int | None
    space: Mapping[str, float]
    besides: str = ""
    in_vain: tuple[Requirements, ...] = ()

    @property
    def words(self) -> tuple[str, ...]:
        """Of each direction in which anything fits."""
        figures = in_words(self.figures).items()
        return (
            *(() if self.torques is None else (self.torques.words,)),
            *(() if self.speed is None else (f"continuous_speed {self.speed:g} rpm",)),
            *((" with ".join(f"{key} {value}" for key, value in figures),) if figures else ()),
            *(() if self.ratio is None else (f"ratio {self.ratio}",)),
            *(f"{key} {1e3 * length:g} mm" for key, length in self.space.items()),
        )

    def told(self) -> WaysOutError:
        """The refusal that names them."""
        words = ", or ".join(self.words)
        fits = f"What fits, by the whole verdict: {words}." if words else ""
        message = f"{self._message}."
        sentences = message, fits, self.besides
        # After a list, on a line of its own.
        apart = "\n" if "\n" in message else " "
        return WaysOutError(apart.join(one for one in sentences if one), self)

    @property
    def _message(self) -> str:
        """Of the refusal, without an estimate of both torques that a search has overtaken."""
        refusal, asked = self.refusal, self.asked
        message = refusal.message.rstrip(".")
        if self.torques is None or not refusal.most_torque:
            return message
        peak, lasting = self.torques
        share = min(peak / asked.peak_torque, lasting / asked.continuous_torque)
        overtaken = share > refusal.most_torque / asked.peak_torque
        return message.replace(refusal.estimate, "") if overtaken else message


class WaysOutError(SizingInfeasibleError):
    """No design meets the requirements, and these would fit. Exit code 3.

    Attributes
    ----------
    ways : Ways
    """

    def __init__(self, message: str, ways: Ways) -> None:
        super().__init__(
            message,
            binding=ways.refusal.binding,
            most_torque=None if ways.torques is None else ways.torques.peak,
            most_lasting_torque=None if ways.torques is None else ways.torques.lasting,
            outer_diameter_needed=ways.space.get("outer_diameter"),
            length_needed=ways.space.get("length"),
            ratio_needed=ways.ratio,
            most_speed=ways.speed,
            figures=in_words(ways.figures),
        )
        self.ways = ways
