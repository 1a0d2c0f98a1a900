"""Where dowels go that carry a torque: round the ring in its seat, and in the output's face."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.catalog.dowels import (
    SHEAR_STRENGTH,
    Dowel,
    DowelStress,
    across_a_joint,
    along_a_seam,
    dowels_within,
)
from cqdd_design.catalog.materials import find_material
from cqdd_design.solids.layout import DowelLayout, FlangeDowels

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.solids.layout import HousingLayout, PackLayout

_RING_COUNTS = (4, 6, 8, 10, 12)
_FLANGE_COUNTS = (2, 3, 6)
"""Between six bolts."""
_SEAT_SHARE = 0.6
"""Of the weaker seat's yield strength that a layout lets a dowel press on it; checks allow more."""
_SHEAR_SHARE = 0.5
"""Likewise of what breaks a dowel."""
_END_PLAY = 0.3
"""Of a ring's dowel in its hole, units."""
_LEAST_WALL = 0.5e-3
"""Between dowels and bolts, m."""
_LEAST_EFFICIENCY = 0.6
"""Of a gearbox whose ring takes the crank's torque too."""


class _Try(NamedTuple):
    """Some dowels, and their number."""

    dowel: Dowel
    number: int


def ring_dowels(
    design: Design, pack: PackLayout, housing: HousingLayout, unit: float
) -> DowelLayout:
    """Dowels across the seam between the ring and the flange's part of its seat.

    As many of the thickest that the walls take as the peak torque asks for, behind teeth, where
    the ring's wall is thickest; behind the pocket of a pin it is thinnest.
    """
    reducer, asked = design.reducer, design.requirements
    tooth_count = reducer.ring_tooth_count
    most = min(
        0.8 * (pack.ring_radius - pack.ledge_radius),
        housing.bolt_circle_radius - 0.55 * housing.mount_thread - pack.ring_radius - 0.3 * unit,
        3.0 * unit,
    )
    bottom = max(housing.flange_bottom + 0.5 * unit, 0.0)
    torque = asked.peak_torque * (1.0 + 1.0 / (_LEAST_EFFICIENCY * reducer.ratio))

    def stress(one: _Try) -> DowelStress:
        size = one.dowel
        return along_a_seam(
            torque, one.number, pack.ring_radius, size.diameter, size.bearing_length
        )

    counts = sorted({min(count, tooth_count) for count in _RING_COUNTS})
    found = _enough(
        dowels_within(most, pack.top - bottom),
        counts,
        stress,
        _seat_strength(design.housing.material, reducer.ring_material),
    )
    if found is None:
        return DowelLayout(0.0, (), bottom, 0.0, 0.0)
    pitch = 2.0 * math.pi / tooth_count
    first = 0.5 * pitch if reducer.ring_type == "pinwheel" else 0.0
    teeth = [round(i * tooth_count / found.number) for i in range(found.number)]
    return DowelLayout(
        radius=0.5 * found.dowel.diameter,
        angles=tuple(first + pitch * tooth for tooth in teeth),
        # No deeper than that the clamp keeps them where they are.
        bottom=max(bottom, pack.top - found.dowel.length - _END_PLAY * unit),
        length=found.dowel.length,
        bearing_length=found.dowel.bearing_length,
    )


def flange_dowels(
    design: Design, circle: float, bolt: float, wide: float, depth: float, unit: float
) -> FlangeDowels:
    """Dowel holes halfway between the six bolts of the output, as many as the peak torque asks for.

    Parameters
    ----------
    circle : float
        Radius of the bolts' circle, m.
    bolt : float
        Thread of the bolts, m.
    wide : float
        Room across the circle, m.
    depth : float
        Of the holes, at most, m.
    """
    between = 2.0 * circle * math.sin(math.pi / 12.0)
    wall = max(0.6 * unit, _LEAST_WALL)
    most = min(2.0 * (between - 0.5 * bolt - wall), wide, 6.0 * unit)
    torque = design.requirements.peak_torque

    def stress(one: _Try) -> DowelStress:
        length = _seat(one.dowel.diameter, depth)
        return across_a_joint(torque, one.number, circle, one.dowel.diameter, length)

    # A dowel stands in the face and in what is bolted to it, as deep in both.
    fitting = dowels_within(most, 2.0 * depth)
    metal = design.carrier_material
    found = _enough(fitting, _FLANGE_COUNTS, stress, _seat_strength(metal, metal))
    if found is None:
        return FlangeDowels(0.0, 0.0, 0)
    return FlangeDowels(found.dowel.diameter, _seat(found.dowel.diameter, depth), found.number)


def _seat(diameter: float, depth: float) -> float:
    return min(2.0 * diameter, depth)


def _seat_strength(*names: str) -> float:
    """Least yield strength of some materials, Pa; 0 where one is not known."""
    return min(find_material(name).yield_strength or 0.0 for name in names)


def _enough(
    sizes: Iterable[Dowel],
    counts: Iterable[int],
    stress: Callable[[_Try], DowelStress],
    strength: float,
) -> _Try | None:
    """The fewest dowels, of these the thickest, that are stressed little; the best where none are.

    None where no dowel fits.
    """
    tried = [_Try(size, count) for count in counts for size in sizes]
    if not tried:
        return None
    least_pressed = min(tried, key=lambda one: stress(one).pressure)
    good = (
        one
        for one, found in ((one, stress(one)) for one in tried)
        if found.pressure <= _SEAT_SHARE * strength and found.shear <= _SHEAR_SHARE * SHEAR_STRENGTH
    )
    return next(good, least_pressed)
