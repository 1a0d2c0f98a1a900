"""What more of a requirement would cost: the same search once more, near a design that was found.

By closed forms with the reserve that the contact equilibrium and part errors took at the design; a
smaller ring that they take for lighter is held against both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.agreement import settled
from cqdd_design.sizing.hunt import Found, Hunt, Space
from cqdd_design.sizing.looks import closer_look
from cqdd_design.sizing.points import Evaluator
from cqdd_design.sizing.result import Cost

_MORE, _TWICE, _LESS_ROOM = 1.1, 2.0, 0.95
_WIDER = 1.04


def costs(hunt: Hunt, found: Found) -> tuple[Cost, ...]:
    """What 10 % more of either torque, twice the life and a ring 5 % smaller cost."""
    # Whichever cam bearing it takes: what part errors ask for is known of this one.
    near = replace(hunt, extra=dict(hunt.extra_for(found.cam)), extra_of={})
    asked, space = hunt.requirements, found.space._replace(cam="")
    peak, lasting = asked.peak_torque, asked.continuous_torque
    changes = (
        ("peak_torque", "10 % more peak torque", _MORE * peak),
        ("continuous_torque", "10 % more continuous torque", min(_MORE * lasting, peak)),
        ("life", "twice the life", _TWICE * asked.life),
    )
    more = [
        Cost(key, words, value, _in_wider_rings(near, found, space, {key: value}))
        for key, words, value in changes
    ]
    ring = _LESS_ROOM * found.ring
    less = _in_smaller_ring(near, found, space._replace(ring_limit=ring))
    return (*more, Cost("outer_diameter", "a ring 5 % smaller", ring, less))


def _in_wider_rings(
    hunt: Hunt, found: Found, space: Space, changed: Mapping[str, float]
) -> float | None:
    """In the ring of the design, else in the next larger one that will do."""
    ring, most = found.ring, 2.0 * hunt.frame(space.anywhere, {}).outer_radius
    while True:
        more = _more_mass(hunt, found, space._replace(ring_limit=ring), changed)
        if more is not None or ring >= most:
            return more
        ring = min(_WIDER * ring, most)


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


def _in_smaller_ring(hunt: Hunt, found: Found, space: Space) -> float | None:
    """Where it is lighter, equilibrium and part errors bear it."""
    more = _more_mass(hunt, found, space, {})
    if more is None or more > 0.0:
        return more
    borne, _ = settled(hunt, space, None, found.needs, found.point)
    if borne is None or closer_look(hunt, borne, borne.sized.machine) is not None:
        return None
    return borne.sized.objective.mass - found.sized.objective.mass
