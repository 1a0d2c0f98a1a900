"""Bought parts that may stand in for those of the bill and pass the same checks.

Checks and layout read of a bearing its sizes and ratings, of a screw its thread, length and class:
what is equal in these, or no weaker, changes no line of the verdict. Bearings and lubricants that
are so chosen are put in the machine and run through its closed-form checks all the same; one with
which a line fails that passes without it is not offered. A designation of an older standard for the
same part counts too.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.catalog.encoders import magnets_of, sensors_with
from cqdd_design.catalog.lubricants import find_lubricant, lubricants
from cqdd_design.errors import DesignError
from cqdd_design.solids.selection import CapScrew, cap_screw_lengths

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.solids.part import Part

_SAME = 1e-6
"""Difference of sizes that counts as rounding, m."""
_KEYS = {
    "cam bearing": "reducer.cam_bearing.designation",
    "shaft bearing": "reducer.support_bearing.designation",
    "output bearing": "reducer.carrier_bearing.designation",
}
"""Parts that a design may name, with its key."""
_OLDER_STANDARDS = (
    ("ISO 4762 ", "DIN 912 "),
    ("ISO 8734 ", "DIN 6325 "),
    ("ISO 7379 ", "DIN 9841 "),
)
"""Of the same parts."""


def substitutes(machine: Machine, part: Part) -> tuple[str, ...]:
    """Designations that may be bought instead of a part's, the nearest first."""
    named = part.designation
    found = [
        older + named.removeprefix(newer)
        for newer, older in _OLDER_STANDARDS
        if named.startswith(newer)
    ]
    row = bearings().get(named)
    if row is not None:
        key = _KEYS.get(part.name)
        found += [
            ordered_as(other)
            for other in equal_bearings(row)
            if key is None or passes(machine, {key: other.designation})
        ]
        found += equal_makes(row)
    motor = machine.layout.motor_end
    if part.name == "encoder board" and motor is not None:
        bits = machine.design.drive.encoder_bits
        sensors = sensors_with(bits, beside=motor.open)
        found += [one.name for one in sensors if one.name != named]
    if part.name == "encoder magnet" and motor is not None and not motor.open:
        sizes = magnets_of(2.0 * motor.magnet_radius, motor.magnet_height)
        found += [one.name for one in sizes if one.name != named]
    longer = longer_screw(machine, part.name)
    if longer is not None:
        found.append(longer.designation)
    return tuple(found)


def by_newer_standard(designation: str) -> str:
    """A designation with the standard that bills name instead of an older one of the same part.

    Examples
    --------
    >>> by_newer_standard("DIN 912 M3 x 8 - 12.9")
    'ISO 4762 M3 x 8 - 12.9'
    """
    plain = designation.upper()
    for newer, older in _OLDER_STANDARDS:
        if plain.startswith(older):
            return newer + designation[len(older) :]
    return designation


def passes(machine: Machine, change: Mapping[str, Any]) -> bool:
    """Whether a machine with a change fails no closed-form check that it passes as it is."""
    from cqdd_design.machine import resolve

    try:
        other = resolve(machine.given.replacing(change)).analysis.checks
    except DesignError:
        return False
    before = {one.id for one in machine.analysis.checks if one.status == "fail"}
    return {one.id for one in other if one.status == "fail"} <= before


def ordered_as(row: Bearing) -> str:
    """What to write in an order, without the words that sort the catalogue.

    Examples
    --------
    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> ordered_as(find_bearing("needle HK1522 on IR12x15x22.5"))
    'HK1522 with inner ring IR12x15x22.5'
    >>> ordered_as(find_bearing("SKF 61900"))
    'SKF 61900'
    """
    plain = row.designation.removeprefix("needle cage ").removeprefix("needle ")
    return plain.replace(" on ", " with inner ring ").replace("SKF * ", "SKF ")


def bought_of(part: Part) -> str:
    """Material as a bill says it: of what is bought without the standard that a row is named by.

    Screws of ISO 4762 are counted with the steel that the catalogue has of ISO 7379's.
    """
    return part.material if part.source == "make" else part.material.partition(" (")[0]


def ordered(designation: str) -> str:
    """What to order by a name of the catalogue, or how a part is made."""
    bearing = bearings().get(designation)
    return designation if bearing is None else ordered_as(bearing)


def equal_bearings(row: Bearing) -> tuple[Bearing, ...]:
    """Others of the catalogue of the same kind and sizes whose ratings are no lower."""
    if row.dynamic_rating is None or row.static_rating is None:
        return ()
    return tuple(
        other
        for other in bearings().values()
        if other.designation != row.designation
        and other.kind == row.kind
        and _equal(other.bore_diameter, row.bore_diameter)
        and _equal(other.outer_diameter, row.outer_diameter)
        and _equal(other.width, row.width)
        and _equal(other.raceway_diameter or 0.0, row.raceway_diameter or 0.0)
        and (other.dynamic_rating or 0.0) >= row.dynamic_rating
        and (other.static_rating or 0.0) >= row.static_rating
    )


def equal_makes(row: Bearing) -> tuple[str, ...]:
    """What another maker's bearing has to be, in words; nothing where ratings are not known.

    Examples
    --------
    >>> from cqdd_design.catalog.bearings import find_bearing
    >>> equal_makes(find_bearing("6902"))[0]
    'ball bearing 15 x 28 x 7 mm of any maker, C 4.3 kN and C0 2.25 kN or more'
    """
    if row.dynamic_rating is None or row.static_rating is None:
        return ()
    sizes = (row.bore_diameter, row.outer_diameter, row.width)
    inner = f" on a raceway of {1e3 * row.raceway_diameter:g} mm" if row.raceway_diameter else ""
    return (
        f"{row.kind}{'' if row.kind == 'needle cage' else ' bearing'} "
        f"{' x '.join(f'{1e3 * size:g}' for size in sizes)} mm{inner} of any maker, "
        f"C {1e-3 * row.dynamic_rating:g} kN and C0 {1e-3 * row.static_rating:g} kN or more",
    )


def longer_screw(machine: Machine, part: str) -> CapScrew | None:
    """The next longer cap screw, where it ends within the thread that is drawn for it."""
    layout = machine.layout
    housing, motor = layout.housing, layout.motor_end
    if part == "cover screw":
        screw, room = housing.screw, housing.cover_flange_top - housing.flange_bottom
    elif part == "motor cover screw" and motor is not None:
        screw = motor.cover_screw
        room = motor.cover_grip + motor.cover_engaged
    else:
        return None
    lengths = (one for one in cap_screw_lengths(screw.thread) if one > screw.length + _SAME)
    length = next(lengths, None)
    if length is None or length > room + _SAME:
        return None
    return CapScrew(screw.thread, length, screw.head_diameter, screw.head_height, screw.socket)


def other_lubricants(machine: Machine) -> tuple[str, ...]:
    """Lubricants of the catalogue that are no thinner, rub no more and bear what its own bears."""
    own = find_lubricant(machine.design.reducer.friction.lubricant)
    return tuple(
        one.name
        for one in lubricants().values()
        if one.name != own.name
        and (one.kind, one.grade) == (own.kind, own.grade)
        and one.viscosity >= own.viscosity
        and one.hot_viscosity >= own.hot_viscosity
        and one.film_friction <= own.film_friction
        and one.coldest <= own.coldest
        and one.hottest >= own.hottest
        and passes(machine, {"reducer.friction.lubricant": one.name})
    )


def _equal(one: float, other: float) -> bool:
    return abs(one - other) < _SAME
