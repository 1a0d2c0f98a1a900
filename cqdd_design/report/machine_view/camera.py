"""Parallel projection of the machine on the page, and the light that falls on it.

The machine stands in its own frame, z along the axis towards the output. A camera has three
directions in it: `right` and `up` on the page, and `towards` the viewer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.geometry.contours import FloatArray
from cqdd_design.solids.hidden_lines import VisibleLines, visible_lines
from cqdd_design.solids.part import Colour

if TYPE_CHECKING:
    from cadquery import Shape

_LIGHT = np.array([-0.42, 0.74, 0.53]) / np.linalg.norm([-0.42, 0.74, 0.53])
"""Direction to the light on the page: from the upper left, before the picture."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A direction of view.

    Attributes
    ----------
    right, up, towards : array (3,)
        Unit vectors in the machine's frame; `right` x `up` = `towards`.
    """

    right: FloatArray
    up: FloatArray
    towards: FloatArray

    @classmethod
    def oblique(cls, tilt: float, rise: float, azimuth: float = -0.5 * math.pi) -> Camera:
        """A view on the output side.

        Parameters
        ----------
        tilt : float
            Between the axis and the line of sight, rad: 0 looks along the axis, a quarter turn
            from the side.
        rise : float
            Of the drawn axis above the page's horizontal, rad.
        azimuth : float
            Side of the machine that is turned to the viewer, rad.
        """
        axis = np.array([0.0, 0.0, 1.0])
        side = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        towards = math.cos(tilt) * axis + math.sin(tilt) * side
        along = (axis - math.cos(tilt) * towards) / math.sin(tilt)
        across = np.cross(towards, along)
        c, s = math.cos(rise), math.sin(rise)
        return cls(c * along - s * across, s * along + c * across, towards)

    @cached_property
    def matrix(self) -> FloatArray:
        """From the machine's frame to page and depth (3, 3); depth grows towards the viewer."""
        return np.stack([self.right, self.up, self.towards])

    def page(self, points: FloatArray) -> FloatArray:
        """Points (..., 3) on the page (..., 2), in their own unit, y up."""
        return np.asarray(points @ self.matrix[:2].T)

    def lines(self, shapes: Sequence[Shape]) -> VisibleLines:
        """What can be seen of posed shapes (mm) that nothing hides."""
        return visible_lines(shapes, self.right, self.towards)

    def brightness(self, normals: FloatArray) -> FloatArray:
        """Light from 0 to 1 on surfaces with these outward unit normals (..., 3)."""
        return np.asarray(np.clip(0.5 + 0.5 * (normals @ self.matrix.T @ _LIGHT), 0.0, 1.0))


def tinted(colour: Colour, brightness: float) -> str:
    """A colour under a light from 0 to 1, as ``#rrggbb``: pale like a technical illustration."""
    paper = np.array([1.0, 1.0, 1.0])
    base = 0.74 * np.asarray(colour) + 0.26 * paper
    if brightness >= 0.6:
        shade = base + (paper - base) * 0.62 * (brightness - 0.6) / 0.4
    else:
        shade = base * (0.58 + 0.42 * brightness / 0.6)
    return "#" + "".join(f"{round(255 * float(value)):02x}" for value in shade)
