"""Closed curves that bound a plane body: lobed outline, circles, and contours of arcs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import ArcContour, ComplexArray, FloatArray, as_complex
from cqdd_design.geometry.cycloid import CycloidDisc

Curve = Callable[[FloatArray], tuple[ComplexArray, ComplexArray]]
"""Point and derivative at parameters from 0 to 1, once round counter-clockwise, m."""


@dataclass(frozen=True, eq=False)
class Loop:
    """A closed curve of a body, counter-clockwise whatever it bounds.

    Attributes
    ----------
    curve : Curve
    side : {1, -1}
        1 where the material (of the disc or ring itself) lies inside, -1 where it lies outside.
    weight : float
        What a stress of the body's own stiffness counts for on this curve: 1 on a free edge of the
        body; 1 - f on an interface to material f times as stiff, f on that material's free edge.
    joints : array
        Parameters at which a vertex has to stand.
    inner : bool
        Whether it only parts two materials.
    loaded : bool
        Whether point loads stand on it. From those of other loops it is two sides and more away.
    """

    curve: Curve
    side: int
    weight: float = 1.0
    joints: FloatArray | None = None
    inner: bool = False
    loaded: bool = True

    def normal(self, u: FloatArray) -> ComplexArray:
        """Unit normal out of the body's own material."""
        slope = self.curve(u)[1]
        return np.asarray(-1j * self.side * slope / np.abs(slope))

    def parameter(self, points: ComplexArray) -> FloatArray:
        """Parameters of points on the curve: nearest of many, then by Newton's method."""
        grid = np.arange(4096) / 4096
        near = self.curve(grid)[0]
        u = np.array([grid[np.abs(near - z).argmin()] for z in points])
        for _ in range(5):
            at, slope = self.curve(u)
            u = u + ((points - at) / slope).real
        return np.asarray(u)


def circle(centre: complex, radius: float) -> Curve:
    """A circle from its point in the direction of +x."""

    def curve(u: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        turn = radius * np.exp(2j * np.pi * u)
        return centre + turn, 2j * np.pi * turn

    return curve


def lobed(disc: CycloidDisc) -> Curve:
    """The finished outline of a disc from its valley on +x."""

    def curve(u: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        t = 2.0 * np.pi * np.asarray(u)
        point, normal = disc.profile(t)
        return point, 2j * np.pi * normal * disc.speed(t)

    return curve


def arcs(contour: ArcContour) -> tuple[Curve, FloatArray]:
    """A contour of lines and arcs by its length, and the parameters of its joints."""
    chord = np.roll(as_complex(contour.points), -1) - as_complex(contour.points)
    lengths = np.abs(chord) / np.sinc(contour.sweeps / (2.0 * np.pi))
    ends = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    arc = contour.arcs()
    centre = as_complex(arc.centres)
    start = as_complex(contour.points)

    def curve(u: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        around = np.mod(u, 1.0)
        row = np.clip(np.searchsorted(ends, around, side="right") - 1, 0, len(lengths) - 1)
        part = (around - ends[row]) / (ends[row + 1] - ends[row])
        swept = arc.sweeps[row]
        turn = np.exp(1j * swept * part)
        straight = contour.bulges[row] == 0.0
        with np.errstate(invalid="ignore"):
            bent = centre[row] + (start[row] - centre[row]) * turn
            bent_slope = 1j * swept * (start[row] - centre[row]) * turn
        point = np.where(straight, start[row] + part * chord[row], bent)
        slope = np.where(straight, chord[row], bent_slope)
        return point, slope / (ends[row + 1] - ends[row])

    return curve, ends[:-1]
