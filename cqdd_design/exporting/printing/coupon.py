"""A test coupon: bores and pins of the design's own fits at several offsets, with marks.

::

     _______________________________________
    | 21   (  )   (  )   (  )   (  )   (  ) |   bores of 21 mm, drawn -0.10 to +0.30 mm
    |      -10     0     +10    +20    +30  |   offsets in hundredths of a millimetre
    | 21    o      o      o ...             |   pins of 21 mm, drawn -0.20 to +0.20 mm
    |_______________________________________|   as long as its README says: shrinkage

It is drawn as it is measured: nothing in it is compensated.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cqdd_design.exporting.printing.marks import mark_width, marks
from cqdd_design.geometry.contours import ArcContour, Circle, PlanarPart
from cqdd_design.solids.features.carrier import OUTPUT_REGISTER
from cqdd_design.solids.layers import Layer, Stack, cylinder
from cqdd_design.solids.part import Colour, Part, on_axis
from cqdd_design.solids.poses import HOUSING

HOLE_OFFSETS = (-0.10e-3, 0.0, 0.10e-3, 0.20e-3, 0.30e-3)
PIN_OFFSETS = (-0.20e-3, -0.10e-3, 0.0, 0.10e-3, 0.20e-3)
"""By which bores and pins are drawn larger than the fit's nominal diameter, m."""
LEAST, GREATEST = 3e-3, 32e-3
"""Diameters that stand on a coupon, m: smaller ones are drilled, larger ones fill the bed."""
MOST_SIZES = 4
_PLATE, _PIN, _MARK = 4e-3, 8e-3, 0.6e-3
"""Thickness of the plate, height of pins and marks above it, m."""
_WALL, _ROW, _LABEL = 4e-3, 8e-3, 22e-3
"""Between bores, for marks below a row, and for the diameter at its left, m."""
_COLOUR: Colour = (0.85, 0.85, 0.70)


@dataclass(frozen=True, eq=False)
class Coupon:
    """A coupon.

    Attributes
    ----------
    part : Part
    label : str
        At the end of its files' names.
    length : float
        Of the plate along x, m: measured, it gives the shrinkage.
    sizes : tuple of float
        Diameters on it, m.
    left_out : tuple of float
        Fits of the design that are too small, too large or too many, m.
    """

    part: Part
    label: str
    length: float
    sizes: tuple[float, ...]
    left_out: tuple[float, ...]

    @property
    def mean_hole(self) -> float:
        """Of the diameters of all bores as drawn, m."""
        return float(np.mean(self.sizes) + np.mean(HOLE_OFFSETS))

    @property
    def mean_pin(self) -> float:
        """Of the diameters of all pins as drawn, m."""
        return float(np.mean(self.sizes) + np.mean(PIN_OFFSETS))


def coupon_sizes(parts: Iterable[Part]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Diameters of the fits of printed parts that go on a coupon, and those that do not, m."""
    # What is driven by the output is printed elsewhere, or not at all.
    own = (fit for part in parts for fit in part.fits if fit.name != OUTPUT_REGISTER)
    every = sorted({round(fit.diameter, 7) for fit in own})
    fitting = [one for one in every if LEAST <= one <= GREATEST]
    # Evenly over what there is, the least and the greatest among them.
    places = np.unique(np.linspace(0, len(fitting) - 1, MOST_SIZES).round().astype(int))
    chosen = tuple(fitting[place] for place in places) if fitting else ()
    return chosen, tuple(one for one in every if one not in chosen)


def coupon(parts: Iterable[Part], material: str, label: str = "coupon") -> Coupon | None:
    """The coupon of printed parts of one material; None where they have no fit that goes on one."""
    sizes, left_out = coupon_sizes(parts)
    if not sizes:
        return None
    pitch = [size + HOLE_OFFSETS[-1] + _WALL for size in sizes]
    apart = [max(step, mark_width("+30") + 2e-3) for step in pitch]
    length = _LABEL + len(HOLE_OFFSETS) * max(apart) + _WALL
    holes: list[Circle] = []
    raised: list[Layer] = []
    top = 0.0
    for size, step, wide in zip(sizes, pitch, apart, strict=True):
        for offsets, is_hole in ((HOLE_OFFSETS, True), (PIN_OFFSETS, False)):
            middle = top + _ROW + 0.5 * step
            raised += marks(f"{1e3 * size:g}", _WALL, middle - 2.8e-3, _PLATE, _PLATE + _MARK)
            for place, offset in enumerate(offsets):
                x = _LABEL + (place + 0.5) * wide
                if is_hole:
                    holes.append(Circle(np.array([x, middle]), 0.5 * (size + offset)))
                else:
                    radius = 0.5 * (size + offset)
                    raised.append(cylinder(radius, _PLATE, _PLATE + _PIN, (x, middle)))
                text = f"{round(1e5 * offset):+d}" if offset else "0"
                left = x - 0.5 * mark_width(text)
                raised += marks(text, left, top + 1.2e-3, _PLATE, _PLATE + _MARK)
            top += _ROW + step
    high = top + 0.5 * _WALL
    corners = np.array([[0.0, 0.0], [length, 0.0], [length, high], [0.0, high]])
    plate = PlanarPart("coupon", ArcContour(corners, np.zeros(4)), tuple(holes))
    part = Part(
        "test coupon",
        Stack((Layer(plate, 0.0, _PLATE), *raised)),
        material,
        _COLOUR,
        "make",
        "printed, to be measured",
        on_axis("test coupon", HOUSING),
    )
    return Coupon(part, label, length, sizes, left_out)
