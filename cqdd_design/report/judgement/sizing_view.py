"""How a design was found: alternatives, and what the screen rejected."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.design import Design
from cqdd_design.gearbox import CHECK_GUIDE
from cqdd_design.report.ink.numbers import TIMES, significant, with_unit

if TYPE_CHECKING:
    from cqdd_design.sizing.result import Objective, SizingResult


@dataclass(frozen=True)
class SizingView:
    """What the page shows of a search.

    Attributes
    ----------
    screened, survivors : str
        Numbers of candidates.
    headings : tuple of str
        This design, then its alternatives.
    rows : tuple of (quantity, one value a design)
    tally : tuple of (title, number, width of its bar in per cent)
    """

    screened: str
    survivors: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]
    tally: tuple[tuple[str, str, float], ...]


def sizing_view(sizing: SizingResult) -> SizingView:
    """Arrange a sizing result for the page."""
    designs = [(sizing.design, sizing.objective)]
    designs += [(one.design, one.objective) for one in sizing.alternatives]
    return SizingView(
        screened=grouped(sizing.candidates_screened),
        survivors=grouped(sizing.survivors),
        headings=("this design", *(one.design.name for one in sizing.alternatives)),
        rows=_rows(designs),
        tally=_tally(sizing.rejected),
    )


def _rows(designs: list[tuple[Design, Objective]]) -> tuple[tuple[str, tuple[str, ...]], ...]:
    def each(name: str, shown: list[str]) -> tuple[str, tuple[str, ...]]:
        return name, tuple(shown)

    def mm(length: float) -> str:
        return with_unit(1e3 * length, "mm", 5)

    reducers = [design.reducer for design, _ in designs]
    goals = [objective for _, objective in designs]
    return (
        each("mass of discs, ring, pins, bearings, cams", [_grams(g.mass) for g in goals]),
        each(
            "their inertia at the input, 10⁻⁶ kg·m²",
            [significant(1e6 * g.gearbox_inertia, 3) for g in goals],
        ),
        each("torque reserve", [significant(g.torque_reserve, 3) for g in goals]),
        each("binds first", [_title(g.binding) for g in goals]),
        each("ring pitch radius", [mm(r.ring_pitch_radius) for r in reducers]),
        each("eccentricity", [mm(r.eccentricity) for r in reducers]),
        each("diameter of ring teeth", [mm(r.ring_pin_diameter) for r in reducers]),
        each("disc thickness", [mm(r.disc_thickness) for r in reducers]),
        each(
            "output pins",
            [f"{r.output_pins.count} {TIMES} {mm(r.output_pins.diameter)}" for r in reducers],
        ),
        each("radius of the pin circle", [mm(r.output_pins.circle_radius) for r in reducers]),
        each("cam bearing", [r.cam_bearing.designation for r in reducers]),
    )


def _grams(mass: float) -> str:
    return with_unit(1e3 * mass, "g", 4)


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


def grouped(number: int) -> str:
    """A whole number with thin spaces between thousands.

    Examples
    --------
    >>> grouped(1234567)
    '1\u202f234\u202f567'
    """
    return f"{number:,}".replace(",", "\u202f")
