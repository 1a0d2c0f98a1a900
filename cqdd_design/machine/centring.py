"""How the output is centred on the ring, and how far off it then stands.

Fits alone leave its bearing's seat some hundredths of a millimetre off the ring's axis. So its
cover is set by an indicator on the output, which turns about the very axis that is sought, against
a band of the housing that runs true to the ring's seat. What the indicator may read is the zone of
``tolerances.output_position``, from which gearboxes are drawn, less what the band itself may run
out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.design.actuator import ZONE_OF_CIRCLE
from cqdd_design.errors import CatalogError
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.housing import INDICATOR_BAND
from cqdd_design.solids.features.kinds import Seat

if TYPE_CHECKING:
    from cqdd_design.machine.machine import Machine

_FITS = (
    ("housing", "ring seat", "spigot in the housing"),
    ("output cover", "seat of the output bearing", "spigot in the cover"),
)
"""Parts with the bores that the spigots of the ring clamp go into."""
LEAST_READING = 2e-6
"""What a lever-type dial test indicator tells, m: one graduation."""
_NOTHING = 1e-12
"""Difference of lengths that is none, m."""


def most_off_centre(machine: Machine) -> float | None:
    """From the axis of the ring's seat to that of the output bearing's at the worst limits, m.

    Half of the greatest play of either spigot, and half of the run-out between both. None where the
    tables of the zones end.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    seats = _seats(machine)
    off = 0.0
    for part, bore, spigot in _FITS:
        outer, inner = seats[part, bore], seats["ring clamp", spigot]
        try:
            off += 0.5 * (outer.limits.upper - inner.limits.lower + inner.run_out)
        except CatalogError:
            return None
    return off


def most_reading(machine: Machine) -> float:
    """What the indicator may read over a turn of the output, m; below 0 where nothing would do.

    From lowest to highest it reads twice what the axis of the output stands off that of the band,
    which in turn stands off the ring's by half of its run-out at most.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    band = _seats(machine)["housing", INDICATOR_BAND]
    return machine.given.tolerances.output_zone - band.run_out


def centring(machine: Machine) -> str:
    """How clamp, cover and output are centred; GeometryError as :func:`most_off_centre`."""
    off, seats = most_off_centre(machine), _seats(machine)
    into = (seats["ring clamp", spigot] for _, _, spigot in _FITS)
    depths = " and ".join(f"{1e3 * (one.top - one.bottom):.2g} mm" for one in into)
    fit = (
        f"Spigots of the ring clamp, {depths} deep and {zones.SPIGOT} in {zones.HOUSED}, "
        "centre it in the housing and the output cover on it"
    )
    zone, reading = machine.given.tolerances.output_zone, most_reading(machine)
    within = f"within a zone of \u00d8{_mm(zone)} mm about the ring's"
    stated = "tolerances.output_position, from which gearboxes are drawn"
    if off is not None and 2.0 * off <= zone:
        return f"{fit}, which alone leaves the output's axis {within} ({stated})."
    far = "" if off is None else f", which alone leaves the output's axis {_mm(off)} mm off at most"
    if reading < LEAST_READING - _NOTHING:
        least = _seats(machine)["housing", INDICATOR_BAND].run_out + LEAST_READING
        return (
            f"{fit}{far}. The output's axis is to lie {within} ({stated}), which no indicator "
            f"shows: state a deviation of {1e6 * least / ZONE_OF_CIRCLE:.3g} um or more."
        )
    band = _seats(machine)["housing", INDICATOR_BAND]
    return (
        f"{fit}{far}. So set it: cover screws just snug, a dial test indicator fixed to the "
        f"output's face, its stylus on the {band.name} of the housing (\u00d8"
        f"{1e3 * band.diameter:.5g} mm, {_mm(band.run_out)} mm true to the ring's seat). Turn the "
        f"output by hand and tap the cover until a whole turn reads {_mm(reading)} mm or less from "
        "lowest to highest; tighten crosswise and read again. The output's axis then lies "
        f"{within} ({stated})."
    )


def _seats(machine: Machine) -> dict[tuple[str, str], Seat]:
    """Cylinders of the parts by the names of both."""
    return {
        (part.name, one.name): one
        for part in machine.parts
        for one in part.features
        if isinstance(one, Seat)
    }


def _mm(length: float) -> str:
    """A length (m) in mm, to the micron."""
    return f"{1e3 * length:.3f}".rstrip("0")
