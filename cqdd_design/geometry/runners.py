"""What turns on a pin: a sleeve on an output pin, a roller on a ring's pin, plain or on needles.

A drawn-cup needle bearing of the pin's and the sleeve's diameters is sleeve and needles in one; as
many stand side by side as the disc is thick.

needle cage between pin and sleeve
  __ _ ____
 |  |:|    |    Its wall is what stands outside the cage, or outside the pin where
 |  |:|    |    there is none.
 |__|:|____|
 pin   sleeve or roller
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.limits import millimetres
from cqdd_design.geometry.output_pins import RACEWAY, RUNNER_BORE, pin_limits

if TYPE_CHECKING:
    from cqdd_design.design import Design

LEAST_WALL = 0.5e-3
"""Least wall of what turns on a pin, m (thinnest drawn or ground bush commonly sold)."""

_CUP = "F6"
"""Zone of the circle inside the needles of a drawn cup, as pressed into a gauge (ISO 3245)."""
_SAME = 1e-9
"""Lengths nearer than this are equal, m."""


@dataclass(frozen=True)
class Runner:
    """A sleeve or roller that turns on a pin, m.

    Attributes
    ----------
    pin_diameter : float
        Nominal, of the pin inside.
    diameter, length : float
        Of the sleeve; of drawn cups, all of them together.
    play : float
        Of it on its pin, on the diameter.
    cage : Bearing or None
        The needle cage between the two, or the drawn cup that is sleeve and needles in one; None
        where the sleeve turns on the pin itself.
    rows : int
        Needle bearings side by side that share the load.
    """

    pin_diameter: float
    diameter: float
    length: float
    play: float
    cage: Bearing | None
    rows: int = 1

    @property
    def is_drawn_cup(self) -> bool:
        """Whether needle bearings with a cup of their own roll in the disc, without a sleeve."""
        return self.cage is not None and self.cage.kind == "needle"

    @property
    def bore(self) -> float:
        """Inside diameter of the sleeve: the pin's, or the cage's outside; of a cup its raceway."""
        if self.cage is None:
            return self.pin_diameter
        if self.cage.kind == "needle":
            inside = self.cage.needles
            return inside.pitch_diameter + inside.diameter
        return self.cage.outer_diameter

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
    pins = design.reducer.output_pins
    words = _Words("sleeve", "output_pins.sleeve", "output_pins.diameter")
    fit = _Fit(pins.sleeve_play, lambda: pin_limits(pins))
    return _runner(design, words, pins.diameter, pins.sleeve_diameter, fit)


def ring_runner(design: Design) -> Runner | None:
    """The rollers on the pins of a pinwheel ring, one a disc; None where there are none.

    Raises
    ------
    GeometryError
        When a roller does not go over its pin, or no needle cage of the catalogue fits inside it.
    """
    pin, ring = design.reducer.ring_pin_diameter, design.reducer.ring
    words = _Words("roller", "ring.roller", "ring_pin_diameter")
    fit = _Fit(ring.roller_play, lambda: _limits(RACEWAY, pin))
    return _runner(design, words, pin, ring.roller_diameter, fit)


class _Words(NamedTuple):
    """What a runner is called, the key of its kind (and, with _diameter, size), and its pin's."""

    name: str
    kind: str
    pin: str


def _limits(zone: str, size: float) -> tuple[float, float]:
    found = fit_limits(zone, size)
    return size + found.lower, size + found.upper


class _Fit(NamedTuple):
    """The play that is stated, and the limits of the pin's diameter, m."""

    stated: float | None
    pin: Callable[[], tuple[float, float]]

    def play(self, bore: float, needles: float, zone: str) -> float:
        """On the diameter, m: as stated, else the mean of what the drawn fit leaves.

        Parameters
        ----------
        bore, needles : float
            Nominal, of the sleeve, and what needles take of it, m.
        """
        if self.stated is not None:
            return self.stated
        return 0.5 * (sum(_limits(zone, bore)) - sum(self.pin())) - needles


def _runner(design: Design, words: _Words, pin: float, diameter: float, fit: _Fit) -> Runner | None:
    if diameter <= 0.0:
        return None
    if diameter <= pin:
        raise GeometryError(
            f"{words.kind}_diameter {diameter * 1e3:g} mm does not go over the {pin * 1e3:g} mm "
            f"pin; make it at least {(pin + 2.0 * LEAST_WALL) * 1e3:g} mm, or 0 mm for no "
            f"{words.name}."
        )
    reducer = design.reducer
    kind = reducer.output_pins.sleeve if words.name == "sleeve" else reducer.ring.roller
    length = reducer.disc_thickness
    if kind == "drawn cup":
        cup = _drawn_cup(words, pin, diameter, length)
        rows = int((length + _SAME) / cup.width)
        return Runner(pin, diameter, rows * cup.width, fit.play(pin, 0.0, _CUP), cup, rows)
    cage = _needle_cage(words, pin, diameter, length) if kind == "needle" else None
    bore = pin if cage is None else cage.outer_diameter
    return Runner(pin, diameter, length, fit.play(bore, bore - pin, RUNNER_BORE), cage)


def _drawn_cup(words: _Words, pin: float, outside: float, length: float) -> Bearing:
    """The drawn cup of both diameters that fills most of the disc's thickness.

    Raises
    ------
    GeometryError
        With the nearest there is.
    """
    cups = [
        one
        for one in bearings().values()
        if one.kind == "needle" and one.raceway_diameter is None and one.dynamic_rating is not None
    ]

    def off(one: Bearing) -> float:
        wide = max(one.width - length, 0.0)
        return abs(one.bore_diameter - pin) + abs(one.outer_diameter - outside) + wide

    fitting = [one for one in cups if off(one) < _SAME]
    if fitting:
        return max(fitting, key=lambda one: one.width * int((length + _SAME) / one.width))
    near = min(cups, key=off)
    size = (near.bore_diameter, near.outer_diameter, near.width)
    raise GeometryError(
        f'{words.kind} = "drawn cup": the catalogue has no drawn cup of {millimetres(pin)} inside '
        f"and {millimetres(outside)} outside, at most {millimetres(length)} wide; the nearest is "
        f"'{near.designation}' of {' x '.join(millimetres(one) for one in size)}."
    )


def _needle_cage(words: _Words, pin: float, outside: float, length: float) -> Bearing:
    """The cage of the highest rating that runs on the pin inside sleeve or roller.

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
    name, plain = words.name, f'make {words.name} "plain"'
    on_pin = [one for one in cages if abs(one.bore_diameter - pin) < _SAME]
    if not on_pin:
        raise GeometryError(
            f'{words.kind} = "needle": the catalogue has no needle cage for pins of '
            f"{millimetres(pin)}; make {words.pin} "
            f"{_nearest(pin, [one.bore_diameter for one in cages])}, or {plain}."
        )
    inside = [one for one in on_pin if one.outer_diameter + 2.0 * LEAST_WALL <= outside + _SAME]
    if not inside:
        least = min(one.outer_diameter for one in on_pin) + 2.0 * LEAST_WALL
        raise GeometryError(
            f'{words.kind} = "needle": no needle cage for pins of {millimetres(pin)} fits inside '
            f"a {name} of {millimetres(outside)} with its wall of {millimetres(LEAST_WALL)}; raise "
            f"{words.kind}_diameter to {millimetres(least)}, or {plain}."
        )
    fitting = [one for one in inside if one.width <= length + _SAME]
    if not fitting:
        least = min(one.width for one in inside)
        raise GeometryError(
            f'{words.kind} = "needle": the needle cages that fit are wider than disc_thickness '
            f"{millimetres(length)}; raise it to {millimetres(least)}, or {plain}."
        )
    return max(fitting, key=lambda one: one.dynamic_rating or 0.0)


def _nearest(wanted: float, sizes: Sequence[float]) -> str:
    """The sizes next to `wanted`, in words."""
    below = max((one for one in sizes if one < wanted), default=None)
    above = min((one for one in sizes if one > wanted), default=None)
    return " or ".join(millimetres(one) for one in (below, above) if one is not None)
