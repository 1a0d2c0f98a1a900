"""How much grease a machine takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.lubricants import Lubricant, find_lubricant
from cqdd_design.geometry.contours import Contour
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.apart import posed_layers

GREASE_SHARE = 1.0 / 3.0
"""Of the free space round the discs that is filled: 30 to 50 % by the makers of rolling bearings
(SKF 2013, Rolling bearings, initial grease fill), the lower end for what turns fast."""


@dataclass(frozen=True)
class GreaseFill:
    """Lubricant, and the space that it fills a third of.

    Attributes
    ----------
    free : float
        Within the ring, beside all that stands or turns in it, m^3.
    """

    lubricant: Lubricant
    free: float

    @property
    def volume(self) -> float:
        """Of the lubricant, m^3."""
        return GREASE_SHARE * self.free

    @property
    def mass(self) -> float:
        """Of the lubricant, kg."""
        return self.volume * self.lubricant.density


def grease_fill(machine: Machine) -> GreaseFill:
    """What a machine is filled with before it is closed.

    Raises
    ------
    GeometryError
        When the parts cannot be put together.
    """
    lubricant = find_lubricant(machine.design.reducer.friction.lubricant)
    return GreaseFill(lubricant, _free_space(machine))


def _free_space(machine: Machine) -> float:
    ring = next(part for part in machine.parts if part.name == "ring")
    bottom, top = ring.shape.bottom, ring.shape.top
    hole = ring.shape.layers[0].shape.holes[0]
    free, reach = hole.moments().area * (top - bottom), _reach(hole)
    for part in machine.parts:
        for piece in part.instances:
            for layer in posed_layers(part, piece.pose(machine.design)):
                height = min(layer.top, top) - max(layer.bottom, bottom)
                if height > 0.0 and _reach(layer.shape.outer) <= reach + 1e-6:
                    free -= layer.shape.area() * height
    return free


def _reach(contour: Contour) -> float:
    return float(np.hypot(*contour.sample(1e-5).T).max())
