"""How a design was found: alternatives, and what the screen rejected."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from cqdd_design.design import Design
from cqdd_design.design.reducer import Reducer
from cqdd_design.gearbox import CHECK_GUIDE
from cqdd_design.report.ink.numbers import TIMES, grouped, millimetres, significant, with_unit
from cqdd_design.report.ink.page import Values

if TYPE_CHECKING:
    from cqdd_design.sizing.result import Objective, SizingResult


def sizing_view(sizing: SizingResult) -> Values:
    """A design and its alternatives, and the tally as (title, number, width of its bar, %)."""
    designs = [(sizing.design, sizing.objective)]
    designs += [(one.design, one.objective) for one in sizing.alternatives]
    return {
        "screened": grouped(sizing.candidates_screened),
        "survivors": grouped(sizing.survivors),
        "headings": ("this design", *(one.design.name for one in sizing.alternatives)),
        "rows": _rows(designs),
        "tally": _tally(sizing.rejected),
    }


def _rows(designs: list[tuple[Design, Objective]]) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Quantity, and its value in every design."""
    return tuple(
        (quantity, tuple(cell(design.reducer, objective) for design, objective in designs))
        for quantity, cell in _QUANTITIES
    )


_QUANTITIES: tuple[tuple[str, Callable[[Reducer, Objective], str]], ...] = (
    (
        "mass of discs, ring, pins, bearings, cams",
        lambda _, goal: with_unit(1e3 * goal.mass, "g", 4),
    ),
    (
        "their inertia at the input, 10⁻⁶ kg·m²",
        lambda _, goal: significant(1e6 * goal.gearbox_inertia, 3),
    ),
    ("torque reserve", lambda _, goal: significant(goal.torque_reserve, 3)),
    ("binds first", lambda _, goal: _title(goal.binding)),
    ("ring pitch radius", lambda r, _: millimetres(r.ring_pitch_radius)),
    ("eccentricity", lambda r, _: millimetres(r.eccentricity)),
    ("diameter of ring teeth", lambda r, _: millimetres(r.ring_pin_diameter)),
    ("disc thickness", lambda r, _: millimetres(r.disc_thickness)),
    (
        "output pins",
        lambda r, _: f"{r.output_pins.count} {TIMES} {millimetres(r.output_pins.diameter)}",
    ),
    ("radius of the pin circle", lambda r, _: millimetres(r.output_pins.circle_radius)),
    ("cam bearing", lambda r, _: r.cam_bearing.designation),
)


def _title(check_id: str) -> str:
    guide = CHECK_GUIDE.get(check_id)
    return check_id if guide is None else guide.title


def _tally(rejected: dict[str, int]) -> tuple[tuple[str, str, float], ...]:
    """Rejections in the order of the screen; bars on a logarithmic scale, for they span decades."""
    most = max(rejected.values(), default=0)
    if most == 0:
        return ()
    return tuple(
        (
            _title(name),
            grouped(count),
            100.0 * math.log1p(count) / math.log1p(most),
        )
        for name, count in rejected.items()
        if count > 0
    )
