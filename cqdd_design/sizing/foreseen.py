"""What a design falls clearly short of, told before a gearbox of it is drawn.

What friction takes hardly hangs on clearances, nor on whether discs and ring yield: a search that
has to go elsewhere for it need not learn first what part errors ask for.
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.machine.temperatures import judged_temperatures
from cqdd_design.results import Check
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.looks import HOT, hot_undisturbed, motor_far_short
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.asked import efficiency_line

_CLEARLY = 0.985
"""Margin of a line by rigid discs and ring below which it fails by elastic ones too, whose
temperatures are within a kelvin or two."""


@dataclass(frozen=True)
class Foreseen:
    """Lines that a verdict will say fail.

    Attributes
    ----------
    lines : tuple of Check
    """

    lines: tuple[Check, ...]


def foreseen(hunt: Hunt, found: Found) -> Foreseen | None:
    """Lines of the motor, of heat and of the efficiency that clearly fail; None where none does.

    Nothing where a torque was not stated: less of it comes first.
    """
    if hunt.requirements.derived:
        return None
    lines = list(motor_far_short(hunt, found.sized.machine, _CLEARLY))
    rigid = found.sized.machine.rigid
    warmth = [line for line in judged_temperatures(rigid)[1] if line.id == HOT and line.known]
    # Parts that press on each other are hot for that, which clearance helps.
    if not any(line.id == HOT for line in lines):
        both = (*warmth, *hot_undisturbed(rigid))
        lines += warmth if both and all(line.margin < _CLEARLY for line in both) else ()
    efficiency = efficiency_line(rigid)
    if efficiency is not None and efficiency.known and efficiency.margin < _CLEARLY:
        lines.append(efficiency)
    return Foreseen(tuple(lines)) if lines else None
