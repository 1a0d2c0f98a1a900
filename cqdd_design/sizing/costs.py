"""What more of a requirement would cost: the same search once more, near a design that was found.

By closed forms with the reserve that the contact equilibrium and part errors took at the design; a
smaller ring that they take for lighter is held against both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.agreement import Found, Hunt, Space, settled
from cqdd_design.sizing.looks import closer_look
from cqdd_design.sizing.points import Evaluator
from cqdd_design.sizing.result import Cost

_MORE, _TWICE, _LESS_ROOM = 1.1, 2.0, 0.95


def costs(hunt: Hunt, found: Found) -> tuple[Cost, ...]:
    """What 10 % more of either torque, twice the life and a ring 5 % smaller cost."""
    asked, space = hunt.requirements, found.space
    peak, lasting = asked.peak_torque, asked.continuous_torque
    ring = _LESS_ROOM * found.sized.design.reducer.ring.outer_diameter
    changes = (
        ("peak_torque", "10 % more peak torque", _MORE * peak),
        ("continuous_torque", "10 % more continuous torque", min(_MORE * lasting, peak)),
        ("life", "twice the life", _TWICE * asked.life),
    )
    more = [
        Cost(key, words, value, _more_mass(hunt, found, space, {key: value}))
        for key, words, value in changes
    ]
    return (*more, Cost("outer_diameter", "a ring 5 % smaller", ring, _in_ring(hunt, found, ring)))


def _more_mass(
    hunt: Hunt, found: Found, space: Space, changed: Mapping[str, float]
) -> float | None:
    """By closed forms; what asks for more takes no less."""
    asked = hunt.requirements.model_copy(update=dict(changed))
    try:
        frame = replace(hunt, requirements=asked).frame(space, found.needs)
    except InfeasibleError:
        return None
    evaluator = Evaluator.of(frame, hunt.tables, found.search.space.pin_counts)
    near = replace(found.search, evaluator=evaluator).lightest(found.point)
    if near is None:
        return None
    return max(near[0].objective.mass - found.sized.objective.mass, 0.0)


def _in_ring(hunt: Hunt, found: Found, ring: float) -> float | None:
    """In a ring of a diameter, m; where it is lighter, equilibrium and part errors bear it."""
    space = found.space._replace(ring_limit=ring)
    more = _more_mass(hunt, found, space, {})
    if more is None or more > 0.0:
        return more
    own = replace(hunt, extra=dict(hunt.extra))
    borne, _ = settled(own, space, None, found.needs, found.point)
    if borne is None or closer_look(own, borne, borne.sized.machine) is not None:
        return None
    return borne.sized.objective.mass - found.sized.objective.mass
