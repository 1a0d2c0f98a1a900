"""Shims beside bearings: which rings, how thick a pack is drawn, and the play they leave.

A pack is chosen at assembly: the room between bearing and face is measured, and the thickest pack
goes in that leaves the least play. Packs go in steps, so that the play lies within one step above
the least. The pack that is drawn is thick enough to make up for lengths at their worst limits.
"""

from __future__ import annotations

from typing import NamedTuple

from cqdd_design.catalog.shims import SHIM_STEP, shim_ring
from cqdd_design.solids.layout import ShimLayout
from cqdd_design.solids.selection import ChosenBearing

SHIM_MATERIAL = "SAE 1045 CD"
"""Stands for the cold-rolled strip of DIN 988, which is of the same density."""
_BESIDE = 0.1e-3
"""Between a shim and the inner ring, radially, m."""


class ShimSet(NamedTuple):
    """Rings that are bought for one place, m.

    Attributes
    ----------
    thicknesses : tuple of float
        One ring of each; packs of them make every step up to their sum.
    drawn : float
        Pack with nominal lengths.
    least_play : float
        That a pack has to leave; below zero where the pack clamps the ring instead.
    step : float
        By which packs differ.
    """

    thicknesses: tuple[float, ...]
    drawn: float
    least_play: float
    step: float = SHIM_STEP

    @property
    def most(self) -> float:
        """The thickest pack."""
        return sum(self.thicknesses)

    @property
    def told(self) -> str:
        """What to buy, in words."""
        return f"one each of {', '.join(f'{1e3 * one:g} mm' for one in self.thicknesses)}"

    @property
    def clamps(self) -> bool:
        """Whether it leaves no play."""
        return self.least_play < 0.0

    @property
    def most_play(self) -> float:
        """That the next thicker pack would take away."""
        return self.least_play + self.step


SHAFT_SET = ShimSet((0.1e-3, 0.2e-3, 0.3e-3, 0.5e-3), 0.5e-3, 0.05e-3)
"""Of the shaft: a warm shaft is longer than what stands round it, so it keeps some play."""
OUTPUT_SET = ShimSet((0.1e-3, 0.2e-3, 0.3e-3), 0.3e-3, 0.02e-3)
"""Of the output bearing, whose cover grows more than it does."""
CLAMPING_SET = ShimSet(OUTPUT_SET.thicknesses, OUTPUT_SET.drawn, -0.01e-3, 0.01e-3)
"""Of crossed rollers, whose outer ring is split: a flange has to hold its halves together (THK,
Cross-Roller Ring, mounting). The pack is ground to the room."""


def shaft_shims(support: ChosenBearing) -> ShimLayout:
    """Over the outer ring of the shaft's upper bearing, in the carrier plate."""
    return _beside(support, SHAFT_SET)


def output_shims(output: ChosenBearing) -> ShimLayout:
    """Over the outer ring of the output bearing, under the cover's lip."""
    return _beside(output, output_set(output))


def output_set(output: ChosenBearing) -> ShimSet:
    """What sets or clamps the output bearing."""
    return CLAMPING_SET if output.bearing.kind == "crossed roller" else OUTPUT_SET


def _beside(chosen: ChosenBearing, kit: ShimSet) -> ShimLayout:
    """A ring of the standard where one bears on the outer ring alone, else one cut to its size."""
    outer = chosen.bearing.outer_diameter
    widest = 2.0 * chosen.lip_radius
    row = shim_ring(2.0 * (chosen.shoulder_radius + _BESIDE), widest, outer)
    inner = widest if row is None else row.inner
    size = f"{1e3 * inner:.4g} x {1e3 * outer:g}"
    return ShimLayout(
        f"shim rings {size}, cut from strip" if row is None else row.designation,
        0.5 * inner,
        0.5 * outer,
        kit.drawn,
        0.0 if kit.clamps else 0.5 * (kit.least_play + kit.most_play),
    )
