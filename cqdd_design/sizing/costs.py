"""What more of a requirement would cost: the same search once more, near a design that was found.

By closed forms with the reserve that the contact equilibrium and part errors took at the design.
"""

from __future__ import annotations

from dataclasses import replace

from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.agreement import Found, Hunt
from cqdd_design.sizing.points import Evaluator
from cqdd_design.sizing.result import Cost

_MORE, _TWICE, _LESS_ROOM = 1.1, 2.0, 0.95


def costs(hunt: Hunt, found: Found) -> tuple[Cost, ...]:
    """What 10 % more of either torque, twice the life and a ring 5 % smaller cost."""
    asked, ring = hunt.requirements, found.sized.design.reducer.ring.outer_diameter
    peak, lasting = asked.peak_torque, asked.continuous_torque
    changes = (
        ("peak_torque", "10 % more peak torque", _MORE * peak),
        ("continuous_torque", "10 % more continuous torque", min(_MORE * lasting, peak)),
        ("life", "twice the life", _TWICE * asked.life),
        ("outer_diameter", "a ring 5 % smaller", _LESS_ROOM * ring),
    )
    return tuple(
        Cost(key, words, value, _more_mass(hunt, found, asked.model_copy(update={key: value})))
        for key, words, value in changes
    )


def _more_mass(hunt: Hunt, found: Found, asked: Requirements) -> float | None:
    try:
        frame = replace(hunt, requirements=asked).frame(found.space, found.needs)
    except InfeasibleError:
        return None
    evaluator = Evaluator.of(frame, hunt.tables, found.search.space.pin_counts)
    near = replace(found.search, evaluator=evaluator).lightest(found.point)
    if near is None:
        return None
    return near[0].objective.mass - found.sized.objective.mass
