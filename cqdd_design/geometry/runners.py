"""What turns on an output pin: a plain sleeve, or a sleeve on needles.

needle cage between pin and sleeve
  __ _ ____
 |  |:|    |    The sleeve's wall is what stands outside the cage, or outside the pin where
 |  |:|    |    there is none.
 |__|:|____|
 pin   sleeve
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.limits import millimetres

if TYPE_CHECKING:
    from cqdd_design.design import Design

LEAST_WALL = 0.5e-3
"""Least wall of what turns on a pin, m (thinnest drawn or ground bush commonly sold)."""

_SAME = 1e-9
"""Lengths nearer than this are equal, m."""


@dataclass(frozen=True)
class Runner:
    """A sleeve that turns on a pin, m.

    Attributes
    ----------
    pin_diameter : float
        Nominal, of the pin inside.
    diameter, length : float
        Of the sleeve.
    play : float
        Of the sleeve on its pin, on the diameter.
    cage : Bearing or None
        The needle cage between the two; None where the sleeve turns on the pin itself.
    """

    pin_diameter: float
    diameter: float
    length: float
    play: float
    cage: Bearing | None

    @property
    def bore(self) -> float:
        """Inside diameter of the sleeve: the pin's, or the cage's outside."""
        return self.pin_diameter if self.cage is None else self.cage.outer_diameter

    @property
    def wall(self) -> float:
        """Of the sleeve."""
        return 0.5 * (self.diameter - self.bore)


def pin_runner(design: Design) -> Runner | None:
    """The sleeves on the output pins of a design; None where the pins are bare.

    Raises
    ------
    GeometryError
        When a sleeve does not go over its pin, or no needle cage of the catalogue fits inside it.
    """
    pins, thickness = design.reducer.output_pins, design.reducer.disc_thickness
    if pins.sleeve_diameter <= 0.0:
        return None
    if pins.sleeve_diameter <= pins.diameter:
        raise GeometryError(
            f"output_pins.sleeve_diameter {pins.sleeve_diameter * 1e3:g} mm does not go over the "
            f"{pins.diameter * 1e3:g} mm pin; make it at least "
            f"{(pins.diameter + 2.0 * LEAST_WALL) * 1e3:g} mm, or 0 mm for no sleeve."
        )
    cage = None
    if pins.sleeve == "needle":
        cage = _needle_cage(pins.diameter, pins.sleeve_diameter, thickness)
    return Runner(pins.diameter, pins.sleeve_diameter, thickness, pins.sleeve_play, cage)


def _needle_cage(pin: float, sleeve: float, length: float) -> Bearing:
    """The cage of the highest rating that runs on the pin inside the sleeve.

    Raises
    ------
    GeometryError
        With the nearest pin, sleeve or disc that one fits.
    """
    cages = [
        one
        for one in bearings().values()
        if one.kind == "needle cage" and one.dynamic_rating is not None
    ]
    key = 'output_pins.sleeve = "needle"'
    on_pin = [one for one in cages if abs(one.bore_diameter - pin) < _SAME]
    if not on_pin:
        raise GeometryError(
            f"{key}: the catalogue has no needle cage for pins of {millimetres(pin)}; make "
            f"output_pins.diameter {_nearest(pin, [one.bore_diameter for one in cages])}, or "
            'sleeve "plain".'
        )
    inside = [one for one in on_pin if one.outer_diameter + 2.0 * LEAST_WALL <= sleeve + _SAME]
    if not inside:
        least = min(one.outer_diameter for one in on_pin) + 2.0 * LEAST_WALL
        raise GeometryError(
            f"{key}: no needle cage for pins of {millimetres(pin)} fits inside a sleeve of "
            f"{millimetres(sleeve)} with its wall of {millimetres(LEAST_WALL)}; raise "
            f'output_pins.sleeve_diameter to {millimetres(least)}, or make sleeve "plain".'
        )
    fitting = [one for one in inside if one.width <= length + _SAME]
    if not fitting:
        least = min(one.width for one in inside)
        raise GeometryError(
            f"{key}: the needle cages that fit are wider than disc_thickness "
            f'{millimetres(length)}; raise it to {millimetres(least)}, or make sleeve "plain".'
        )
    return max(fitting, key=lambda one: one.dynamic_rating or 0.0)


def _nearest(wanted: float, sizes: Sequence[float]) -> str:
    """The sizes next to `wanted`, in words."""
    below = max((one for one in sizes if one < wanted), default=None)
    above = min((one for one in sizes if one > wanted), default=None)
    return " or ".join(millimetres(one) for one in (below, above) if one is not None)
