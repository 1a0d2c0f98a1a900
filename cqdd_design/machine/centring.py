"""How far the output bearing's seat may stand off the ring's axis, by the fits that centre it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.errors import CatalogError
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.kinds import Seat

if TYPE_CHECKING:
    from cqdd_design.machine.machine import Machine

_FITS = (
    ("housing", "ring seat", "spigot in the housing"),
    ("output cover", "seat of the output bearing", "spigot in the cover"),
)
"""Parts with the bores that the spigots of the ring clamp go into."""


def most_off_centre(machine: Machine) -> float | None:
    """From the axis of the ring's seat to that of the output bearing's at the worst limits, m.

    Half of the greatest play of either spigot, and half of the run-out between both. None where the
    tables of the zones end.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    seats = {
        (part.name, one.name): one
        for part in machine.parts
        for one in part.features
        if isinstance(one, Seat)
    }
    off = 0.0
    for part, bore, spigot in _FITS:
        outer, inner = seats[part, bore], seats["ring clamp", spigot]
        try:
            off += 0.5 * (outer.limits.upper - inner.limits.lower + inner.run_out)
        except CatalogError:
            return None
    return off


def centring(machine: Machine) -> str:
    """A sentence on what centres clamp and cover; GeometryError as :func:`most_off_centre`."""
    off, depth = most_off_centre(machine), 1e3 * machine.layout.housing.spigot
    far = "" if off is None else f"; its axis stands off the ring's by {1e3 * off:.2f} mm at most"
    return (
        f"Spigots of the ring clamp, {depth:.2g} mm deep and {zones.SPIGOT} in {zones.HOUSED}, "
        f"centre it in the housing and the output cover on it{far}. Turn the crank while the "
        "cover screws are tightened crosswise: the discs push the cover to where they run free."
    )
