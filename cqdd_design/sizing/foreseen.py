"""An efficiency that a design clearly misses, told before a gearbox of it is drawn.

What friction takes hardly hangs on clearances, nor on whether discs and ring yield: a search that
has to go elsewhere for it need not learn first what part errors ask for.
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.results import Check
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.spaces import Found
from cqdd_design.verdict.asked import efficiency_line

_CLEARLY = 0.985
"""Margin of the line by rigid discs and ring below which it fails by elastic ones too."""


@dataclass(frozen=True)
class Foreseen:
    """Lines that a verdict will say fail.

    Attributes
    ----------
    lines : tuple of Check
    """

    lines: tuple[Check, ...]


def foreseen(hunt: Hunt, found: Found) -> Foreseen | None:
    """The line of an efficiency that is clearly missed; None where none is.

    Nothing where a torque was not stated, as less of it comes first, and in a search that goes on
    for what others have missed.
    """
    if hunt.requirements.derived or hunt.any_will_do:
        return None
    line = efficiency_line(found.sized.machine.rigid)
    if line is None or not line.known or line.margin >= _CLEARLY:
        return None
    return Foreseen((line,))
