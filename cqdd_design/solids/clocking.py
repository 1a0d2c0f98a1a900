"""Which discs of a stack are one and the same part, and how each is put in.

In its own lobes' frame disc d has its first hole at ``clocking + p_d/n``. A disc may be turned by
whole lobes, and turned over about a lobe axis, because its outline has both symmetries; where such
a turn carries the holes of one disc onto those of another, the two are one part. Two discs at 180
degrees are one part, the second turned over, whenever the clocking is a quarter lobe pitch
pi/(2n), for every n and every number of holes. Holes for columns must be carried onto each other
too; with one between every two pins they always are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.design import Design
from cqdd_design.geometry.columns import column_offsets
from cqdd_design.geometry.disc import first_hole_angle

_SAME_HOLE = 1e-9
"""Holes within this of each other on the pin circle are the same hole, m."""


@dataclass(frozen=True)
class PlacedDisc:
    """How the part of a group becomes one disc of the stack.

    Attributes
    ----------
    disc : int
        Which disc, from 0.
    angle : float
        Turn about the axis in the frame of that disc's lobes, a whole number of lobes, rad.
    turned_over : bool
        Whether it is first turned over about the x axis, which carries a valley.
    """

    disc: int
    angle: float = 0.0
    turned_over: bool = False


@dataclass(frozen=True)
class DiscGroup:
    """Discs that are one part, drawn as the first of them."""

    placements: tuple[PlacedDisc, ...]


def disc_groups(design: Design) -> tuple[DiscGroup, ...]:
    """Group the discs of a design into as few parts as will do."""
    groups: list[list[PlacedDisc]] = []
    for disc in range(design.reducer.disc_count):
        for group in groups:
            placed = _placed(design, group[0].disc, disc)
            if placed is not None:
                group.append(placed)
                break
        else:
            groups.append([PlacedDisc(disc)])
    return tuple(DiscGroup(tuple(group)) for group in groups)


def _placed(design: Design, drawn: int, disc: int) -> PlacedDisc | None:
    """How disc `drawn` becomes disc `disc`, or None where it cannot."""
    pins = design.reducer.output_pins
    spacing = 2.0 * math.pi / pins.count
    wanted = first_hole_angle(design, disc)
    for turned_over in (False, True):
        start = first_hole_angle(design, drawn) * (-1.0 if turned_over else 1.0)
        for lobes in range(design.reducer.ratio):
            angle = 2.0 * math.pi * lobes / design.reducer.ratio
            off = math.remainder(start + angle - wanted, spacing)
            if abs(off) * pins.circle_radius > _SAME_HOLE:
                continue
            if _same_columns(design, start + angle - wanted, turned_over):
                return PlacedDisc(disc, angle, turned_over)
    return None


def _same_columns(design: Design, turn: float, turned_over: bool) -> bool:
    """Whether the holes for columns of two discs agree that stand `turn` (rad) apart."""
    offsets = column_offsets(design.reducer)
    if len(offsets) == 0:
        return True
    start = turn + (-offsets[0] if turned_over else offsets[0])
    off = math.remainder(start - offsets[0], 2.0 * math.pi / len(offsets))
    return abs(off) * design.reducer.output_pins.circle_radius <= _SAME_HOLE
