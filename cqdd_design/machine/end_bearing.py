"""Other bearings for the ends of the eccentric shaft, where those of a layout bear too little."""

from __future__ import annotations

from collections.abc import Iterator

from cqdd_design.errors import GeometryError
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.proportions import shaft_bearings

END_KEY = "reducer.support_bearing.designation"


def on_stronger_ends(machine: Machine) -> Iterator[Machine]:
    """The machine on other bearings of the catalogue at its shaft's ends, of higher rating.

    In the order in which a layout prefers them; none where nothing else goes there. What discs and
    pins put on the shaft is the same, and not worked out again.
    """
    now = machine.seats[0]
    try:
        every = shaft_bearings(machine.design, machine.cam)
    except GeometryError:
        return
    least = 0.0 if now.source == "bush" else now.bearing.static_rating or 0.0
    for one in every:
        if one.bearing.designation == now.bearing.designation:
            continue
        if (one.bearing.static_rating or 0.0) <= least:
            continue
        other = machine.changed({END_KEY: one.bearing.designation})
        vars(other).update(
            contact=machine.contact,
            bodies=machine.bodies,
            peak_pack=machine.peak_pack,
            life=machine.life,
        )
        yield other
