"""What more of a requirement would cost: the same search once more, near a design that was found.

By closed forms with the reserve that the contact equilibrium and part errors took at the design; a
smaller ring that they take for lighter is held against both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from cqdd_design.errors import InfeasibleError
from cqdd_design.results import Check
from cqdd_design.sizing.agreement import settled
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.looks import closer_look
from cqdd_design.sizing.result import Cost
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import Found, Space

_MOTOR = {"peak_torque": "MOTOR-PEAK", "continuous_torque": "MOTOR-CONTINUOUS"}
"""Requirements that a motor has to meet, and the lines that say what it does."""
_MORE, _TWICE, _LESS_ROOM = 1.1, 2.0, 0.95


def costs(hunt: Hunt, found: Found) -> tuple[Cost, ...]:
    """What 10 % more of either torque, twice the life and a ring 5 % smaller cost."""
    # Whichever cam bearing it takes: what part errors ask for is known of this one.
    near = replace(hunt, usual=dict(hunt.extra_for(found.cam)), extra_of={}, sturdier=1.0)
    asked, space = hunt.requirements, found.space._replace(cam="")
    wide = space.anywhere._replace(free=True)
    peak, lasting = asked.peak_torque, asked.continuous_torque
    changes = [
        ("peak_torque", "10 % more peak torque", _MORE * peak),
        ("continuous_torque", "10 % more continuous torque", min(_MORE * lasting, peak)),
        ("life", "twice the life", _TWICE * asked.life),
    ]
    if asked.load_cases:
        # The duty says what lasts.
        changes = [one for one in changes if one[0] != "continuous_torque"]
    more = [
        Cost(key, words, value, _more_mass(near, found, wide, {key: value}))
        for key, words, value in changes
    ]
    ring = _LESS_ROOM * found.ring
    less = _in_smaller_ring(near, found, space._replace(ring_limit=ring))
    return (*more, Cost("outer_diameter", "a ring 5 % smaller", ring, less))


def held_to_motor(told: tuple[Cost, ...], lines: Iterable[Check]) -> tuple[Cost, ...]:
    """Costs, marked where more is asked than the motor gives by lines of the design's verdict."""
    most = {line.id: line.value for line in lines if line.id in _MOTOR.values()}

    def beyond(one: Cost) -> bool:
        value = most.get(_MOTOR.get(one.key, ""))
        return value is not None and value < one.asked

    return tuple(replace(one, beyond_motor=beyond(one)) for one in told)


def _more_mass(
    hunt: Hunt, found: Found, space: Space, changed: Mapping[str, float]
) -> float | None:
    """By closed forms; what asks for more takes no less.

    With the design's own cam bearing, else with any: then over what closed forms make of what is
    asked now, because they may think too well of another one.
    """
    own = _mass(hunt, found, space._replace(cam=found.cam), changed)
    if own is not None:
        return max(own - found.sized.objective.mass, 0.0)
    more, now = (_mass(hunt, found, space, one) for one in (changed, {}))
    return None if more is None or now is None else max(more - now, 0.0)


def _mass(hunt: Hunt, found: Found, space: Space, changed: Mapping[str, float]) -> float | None:
    asked = hunt.requirements.unchecked_copy(dict(changed))
    try:
        search = Search.of(replace(hunt, requirements=asked).frame(space, found.needs), hunt.tables)
    except InfeasibleError:
        return None
    near = search.lightest(search.evaluator.placed(found.point))
    return None if near is None else near[0].objective.mass


def _in_smaller_ring(hunt: Hunt, found: Found, space: Space) -> float | None:
    """Where it is lighter, equilibrium and part errors bear it."""
    more = _more_mass(hunt, found, space, {})
    if more is None or more > 0.0:
        return more
    borne, _ = settled(hunt, space, None, found.needs, found.point)
    if borne is None or closer_look(hunt, borne, borne.sized.machine) is not None:
        return None
    return borne.sized.objective.mass - found.sized.objective.mass
