"""A part, or a machine, cut along its axis: the faces that are cut, and the lines behind them.

The axis lies along the page, +z to the right, and a radius points up. Each half of the view has its
own half plane, so that a section may be bent at the axis to run through holes (ISO 128-3): what
lies behind each half is seen square to its plane. All of it is closed form; see `slabs`.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from cqdd_design.solids.layers import Layer
from cqdd_design.solids.slabs import AIR, CUT, SAME, Key, Slab, Walls, slabs, spans_along

Line = tuple[complex, complex]
"""Ends of a straight line on the page, m: z + 1j r."""


@dataclass(frozen=True)
class Rectangle:
    """A piece of a cut face: heights along the axis, radii on one side of it, m."""

    bottom: float
    top: float
    inner: float
    outer: float


def cut_rectangles(found: Sequence[Slab], direction: float) -> tuple[Rectangle, ...]:
    """What the half plane of a direction (rad) cuts."""
    return tuple(
        Rectangle(slab.bottom, slab.top, inner, outer)
        for slab in found
        for inner, outer in spans_along(slab.contours, direction)
    )


def lines_behind(layers: Iterable[Layer], direction: float, *, upper: bool) -> tuple[Line, ...]:
    """Visible edges behind the half plane of a direction (rad), on one side of the axis.

    Parameters
    ----------
    layers : iterable of Layer
        Touching, never overlapping.
    upper : bool
        Whether the half plane is drawn above the axis. Either way the viewer looks along
        decreasing y of a frame whose x is up the page.
    """
    turned = -direction if upper else math.pi - direction
    found = slabs(layers)
    columns = [_Column(Walls.of(slab.contours, turned), upper) for slab in found]
    lines: list[Line] = []
    for slab, column in zip(found, columns, strict=True):
        lines += column.upright(slab.bottom, slab.top)
    empty = _Column(Walls.of(()), upper)
    for height, below, above in _joints(found, columns, empty):
        lines += below.across(above, height)
    return tuple(_joined(lines))


def _joints(
    found: Sequence[Slab], columns: Sequence[_Column], empty: _Column
) -> Iterable[tuple[float, _Column, _Column]]:
    for i, slab in enumerate(found):
        touches = i > 0 and slab.bottom - found[i - 1].top < SAME
        if not touches:
            yield slab.bottom, empty, columns[i]
        follows = i + 1 < len(found) and found[i + 1].bottom - slab.top < SAME
        yield slab.top, columns[i], columns[i + 1] if follows else empty


class _Column:
    """Sights of one slab over one half of the page."""

    def __init__(self, walls: Walls, upper: bool) -> None:
        self.walls, self.upper = walls, upper
        self.breaks = [x for x in walls.breaks().tolist() if x and (x > 0.0) == upper]
        bisect.insort(self.breaks, 0.0)
        self.sights = [walls.sight(0.5 * (one + two))[0] for one, two in pairwise(self.breaks)]

    def key(self, x: float) -> Key:
        """What is met at a place."""
        i = bisect.bisect_right(self.breaks, x) - 1
        return self.sights[i] if 0 <= i < len(self.sights) else AIR

    def upright(self, bottom: float, top: float) -> list[Line]:
        """Edges along the axis: where the wall that is met changes."""
        keys = [*self.sights, AIR] if self.upper else [AIR, *self.sights]
        places = self.breaks[1:] if self.upper else self.breaks[:-1]
        return [
            (complex(bottom, x), complex(top, x))
            for x, (one, two) in zip(places, pairwise(keys), strict=True)
            if one != two and CUT not in (one, two)
        ]

    def across(self, other: _Column, height: float) -> list[Line]:
        """Edges across the axis, where this slab gives way to the next one."""
        lines = []
        for one, two in pairwise(sorted({*self.breaks, *other.breaks})):
            if two - one < SAME:
                continue
            middle = 0.5 * (one + two)
            keys = self.key(middle), other.key(middle)
            if keys[0] != keys[1] and CUT not in keys:
                lines.append((complex(height, one), complex(height, two)))
        return lines


def _joined(lines: Sequence[Line]) -> list[Line]:
    """Lines end to end as one, each once."""
    rows: dict[tuple[bool, float], list[tuple[float, float]]] = {}
    for one, two in lines:
        along = abs(two.real - one.real) > abs(two.imag - one.imag)
        level = round(one.imag if along else one.real, 9)
        ends = sorted((one.real, two.real) if along else (one.imag, two.imag))
        rows.setdefault((along, level), []).append((ends[0], ends[1]))
    joined: list[Line] = []
    for (along, level), spans in sorted(rows.items()):
        merged: list[list[float]] = []
        for low, high in sorted(spans):
            if merged and low - merged[-1][1] < SAME:
                merged[-1][1] = max(merged[-1][1], high)
            else:
                merged.append([low, high])
        for low, high in merged:
            one, two = (
                (complex(low, level), complex(high, level))
                if along
                else (complex(level, low), complex(level, high))
            )
            joined.append((one, two))
    return joined
