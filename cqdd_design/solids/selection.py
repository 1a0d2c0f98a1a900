"""Bought parts that the layout chooses from the catalogue: bearings beside the cam, screws, pins.

Each chooser takes the room there is and returns the catalogue's best answer; where the catalogue
has none it returns a part to be made or ordered, and says so in its designation, so that a
machine far from the catalogue's sizes still gets solids.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from cqdd_design.catalog.bearings import BEARING_MATERIAL, Bearing, bearings
from cqdd_design.catalog.cap_screws import cap_screw_mass
from cqdd_design.catalog.screws import ShoulderScrew
from cqdd_design.design.reducer import OutputPins
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.output_pins import mean_pin_diameter, shoulder_screw

RING_SHARE = 0.3
"""Height of a bearing's ring as a share of its radial section, for shoulders and envelopes."""

OR_AUTO = 'or "auto" for the catalogue\'s best that fits'
"""What to name instead of a bearing that does not go there."""

BUSH_MATERIAL = "Bronze CuSn12"

# Head diameter, head height and socket of hexagon socket head cap screws, mm (ISO 4762:2004,
# table 1: dk max for plain heads, k max, s nominal).
_CAP_SCREWS = {
    1.6: (3.0, 1.6, 1.5),
    2.0: (3.8, 2.0, 1.5),
    2.5: (4.5, 2.5, 2.0),
    3.0: (5.5, 3.0, 2.5),
    4.0: (7.0, 4.0, 3.0),
    5.0: (8.5, 5.0, 4.0),
    6.0: (10.0, 6.0, 5.0),
    8.0: (13.0, 8.0, 6.0),
    10.0: (16.0, 10.0, 8.0),
    12.0: (18.0, 12.0, 10.0),
    16.0: (24.0, 16.0, 14.0),
}
# Counterbores for these heads, mm (DIN 974-1, series 1, H13).
_COUNTERBORES = {
    1.6: 3.5, 2.0: 4.4, 2.5: 5.5, 3.0: 6.5, 4.0: 8.0, 5.0: 10.0, 6.0: 11.0, 8.0: 15.0, 10.0: 18.0,
    12.0: 20.0, 16.0: 26.0,
}  # fmt: skip
# By how much they are deeper than a head, up to a thread, mm (DIN 974-1).
_BELOW_FACE = ((1.4, 0.2), (6.0, 0.4), (20.0, 0.6))
_CAP_SCREW_LENGTHS = (
    *(2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 80, 90, 100),
    *range(110, 161, 10),
)
# Shortest and longest of the commercial range of each, mm (ISO 4762:2004, table 1).
_CAP_SCREW_RANGES = {
    1.6: (2.5, 16), 2.0: (3, 20), 2.5: (4, 25), 3.0: (5, 30), 4.0: (6, 40), 5.0: (8, 50),
    6.0: (10, 60), 8.0: (12, 80), 10.0: (16, 100), 12.0: (20, 120), 16.0: (25, 160),
}  # fmt: skip

# ASME B18.3 and ISO 7379 shoulder screws share these proportions to the shoulder; used where a
# catalogue row leaves a dimension out.
_HEAD_HEIGHT, _HEAD_DIAMETER, _THREAD_LENGTH, _SOCKET = 0.75, 1.5, 1.5, 0.5


@dataclass(frozen=True)
class ChosenBearing:
    """A bearing of the layout.

    Attributes
    ----------
    bearing : Bearing
        A catalogue row, or one of the same form for a part to make or order.
    source : {"catalogue", "to order", "bush"}
        Where it comes from.
    """

    bearing: Bearing
    source: str = "catalogue"

    @property
    def section(self) -> float:
        """Radial section (D - d)/2, m."""
        return 0.5 * (self.bearing.outer_diameter - self.bearing.bore_diameter)

    @property
    def shoulder_radius(self) -> float:
        """Radius to which a shoulder on the shaft may reach on the inner ring, m."""
        return 0.5 * self.bearing.bore_diameter + RING_SHARE * self.section

    @property
    def lip_radius(self) -> float:
        """Radius to which a lip in the housing may reach down on the outer ring, m."""
        return 0.5 * self.bearing.outer_diameter - RING_SHARE * self.section

    @property
    def material(self) -> str:
        """Catalogue name of what it is mostly made of."""
        return BUSH_MATERIAL if self.source == "bush" else BEARING_MATERIAL


class Room(NamedTuple):
    """What bearings between carrier and housing have to go into, m.

    Attributes
    ----------
    least_bore : float
        What the pins in the carrier plate need.
    most_shoulder_radius : float
        Room for the shoulder on the carrier plate.
    most_outer_diameter : float
        Room in the housing.
    """

    least_bore: float
    most_shoulder_radius: float
    most_outer_diameter: float


def fitting_output_bearings(room: Room) -> tuple[ChosenBearing, ...]:
    """Those of the catalogue that go in, what a layout prefers first.

    Crossed rollers, because one of them takes the tilting moment of the output, before balls, those
    of least volume first; those whose ratings are known before all others.
    """
    fitting = [
        chosen
        for chosen in map(ChosenBearing, bearings().values())
        if chosen.bearing.kind in ("ball", "crossed roller")
        and chosen.bearing.bore_diameter >= room.least_bore - 1e-9
        and chosen.bearing.outer_diameter <= room.most_outer_diameter + 1e-9
        and chosen.shoulder_radius <= room.most_shoulder_radius + 1e-9
    ]

    def place(chosen: ChosenBearing) -> tuple[bool, bool, float, str]:
        row = chosen.bearing
        return row.static_rating is None, row.kind == "ball", *_bulk(row)

    return tuple(sorted(fitting, key=place))


def output_bearing(room: Room, unit: float) -> ChosenBearing:
    """The bearing between carrier and housing, where no load chooses it.

    Parameters
    ----------
    unit : float
        A millimetre at the scale of this machine, m.

    Returns
    -------
    ChosenBearing
        The first of :func:`fitting_output_bearings`; a thin-section bearing to order where none
        goes in.
    """
    fitting = fitting_output_bearings(room)
    if fitting:
        return fitting[0]
    bore = _rounded_up(room.least_bore, 0.5e-3 if room.least_bore < 0.05 else 1e-3)
    section = max(2.5 * unit, 0.055 * bore)
    outer, width = bore + 2.0 * section, 1.1 * section
    name = f"thin section {bore * 1e3:.4g} x {outer * 1e3:.4g} x {width * 1e3:.3g} mm, to order"
    return made_bearing(name, bore, outer, width, "to order")


def named_output_bearing(row: Bearing, room: Room) -> ChosenBearing:
    """The bearing between carrier and housing that a design names.

    Parameters
    ----------
    row : Bearing
        Of the catalogue.

    Raises
    ------
    GeometryError
        When it is no bearing for a carrier, or does not go between the pins and the housing.
    """
    chosen, key = ChosenBearing(row), f"carrier_bearing.designation '{row.designation}'"
    auto = OR_AUTO
    if row.kind not in ("ball", "crossed roller"):
        raise GeometryError(
            f"{key} is a {row.kind} bearing, which does not guide a carrier; choose a ball or "
            f"crossed-roller bearing, {auto}."
        )
    least_bore, most_shoulder_radius, most_outer_diameter = room
    bore, outside = row.bore_diameter, row.outer_diameter
    if bore < least_bore - 1e-9:
        raise GeometryError(
            f"{key} has a bore of {bore * 1e3:g} mm, and the pins in the carrier plate need "
            f"{least_bore * 1e3:.4g} mm; choose a larger one, {auto}."
        )
    if outside > most_outer_diameter + 1e-9 or chosen.shoulder_radius > most_shoulder_radius + 1e-9:
        raise GeometryError(
            f"{key} is {outside * 1e3:g} mm outside with a shoulder of "
            f"{2e3 * chosen.shoulder_radius:.4g} mm, and the housing has room for "
            f"{most_outer_diameter * 1e3:.4g} mm, the ring's clamp for a shoulder of "
            f"{2e3 * most_shoulder_radius:.4g} mm; choose a smaller one, {auto}."
        )
    return chosen


def made_bearing(name: str, bore: float, outer: float, width: float, source: str) -> ChosenBearing:
    """A bearing that the catalogue does not have; sizes in m."""
    said = "proportions of the layout"
    made = Bearing(
        name, "ball", bore, outer, width,
        dynamic_rating=None, static_rating=None, mass=None, source=said, raceway_diameter=None,
        chamfer=None,
    )  # fmt: skip
    return ChosenBearing(made, source)


def _bulk(row: Bearing) -> tuple[float, str]:
    area = row.outer_diameter**2 - row.bore_diameter**2
    return (round(area * row.width, 12), row.designation)


def _rounded_up(value: float, step: float) -> float:
    return round(math.ceil(round(value / step, 6)) * step, 9)


@dataclass(frozen=True)
class CapScrew:
    """A hexagon socket head cap screw (ISO 4762), m.

    Attributes
    ----------
    thread, length : float
        Nominal diameter, and length under the head.
    head_diameter, head_height, socket : float
        Of its head; the socket across flats.
    """

    thread: float
    length: float
    head_diameter: float
    head_height: float
    socket: float

    @property
    def designation(self) -> str:
        """Such as ``ISO 4762 M3 x 12 - 12.9``."""
        return f"ISO 4762 M{self.thread * 1e3:g} x {self.length * 1e3:g} - 12.9"

    @property
    def counterbore(self) -> tuple[float, float]:
        """Diameter and depth of the counterbore for its head (DIN 974-1, series 1), m.

        Examples
        --------
        >>> [round(1e3 * one, 1) for one in cap_screw(3e-3, 10e-3).counterbore]
        [6.5, 3.4]
        """
        size = round(self.thread * 1e3, 3)
        below = next(depth for most, depth in _BELOW_FACE if size <= most)
        return _COUNTERBORES[size] * 1e-3, self.head_height + below * 1e-3

    @property
    def mass(self) -> float | None:
        """As its chart has it, kg; None where it has no such size."""
        return cap_screw_mass(self.thread, self.length)

    @property
    def is_sold(self) -> bool:
        """Whether its length is in the commercial range of its thread."""
        return self.length in cap_screw_lengths(self.thread)


def counterbore_of(head_diameter: float) -> float:
    """Diameter of the counterbore for a cylindrical head of a diameter; m.

    That of the cap screw with the next head that is no smaller (DIN 974-1, series 1): heads of ISO
    7379 are those of ISO 4762. Beyond the largest, as much wider as that is.

    Examples
    --------
    >>> [round(1e3 * counterbore_of(one * 1e-3), 1) for one in (7.0, 9.0, 13.0, 30.0)]
    [8.0, 11.0, 15.0, 32.0]
    """
    mm, largest = round(head_diameter * 1e3, 3), max(_CAP_SCREWS)
    beyond = mm + _COUNTERBORES[largest] - _CAP_SCREWS[largest][0]
    fitting = (_COUNTERBORES[size] for size, (head, *_) in _CAP_SCREWS.items() if head >= mm)
    return next(fitting, beyond) * 1e-3


def thread_size(wanted: float) -> float:
    """The metric thread (m) nearest to `wanted` (m), from M1.6 to M16."""
    return min(_CAP_SCREWS, key=lambda size: abs(size - wanted * 1e3)) * 1e-3


def thread_sizes() -> tuple[float, ...]:
    """Metric threads of the cap screws that are known, m."""
    return tuple(mm * 1e-3 for mm in _CAP_SCREWS)


def cap_screw_lengths(thread: float) -> tuple[float, ...]:
    """Lengths under the head in the commercial range of a thread from `thread_size`, m.

    Examples
    --------
    >>> [round(1e3 * one, 1) for one in cap_screw_lengths(1.6e-3)]
    [2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0]
    """
    shortest, longest = _CAP_SCREW_RANGES[round(thread * 1e3, 3)]
    return tuple(mm * 1e-3 for mm in _CAP_SCREW_LENGTHS if shortest <= mm <= longest)


def cap_screw(thread: float, least_length: float) -> CapScrew:
    """The cap screw of a thread from `thread_size` at least `least_length` (m) long.

    Of the commercial range; beyond its longest, one to the next five millimetres, to order.
    """
    head, height, socket = _CAP_SCREWS[round(thread * 1e3, 3)]
    special = _rounded_up(least_length, 5e-3)
    sold = cap_screw_lengths(thread)
    length = next((one for one in sold if one >= least_length - 1e-9), special)
    return CapScrew(thread, length, head * 1e-3, height * 1e-3, socket * 1e-3)


@dataclass(frozen=True)
class OutputPin:
    """The pin between carrier and discs, m.

    Attributes
    ----------
    nominal_diameter, mean_diameter : float
        Of the ground part: the nominal size, and the mean of its limits.
    screw : ShoulderScrew or None
        The catalogue row; None for a ground dowel.
    head_diameter, head_height, socket, thread_diameter, thread_length : float
        Of a shoulder screw; 0 for a dowel.
    """

    nominal_diameter: float
    mean_diameter: float
    screw: ShoulderScrew | None
    head_diameter: float = 0.0
    head_height: float = 0.0
    socket: float = 0.0
    thread_diameter: float = 0.0
    thread_length: float = 0.0

    def as_dowel(self) -> OutputPin:
        """The same pin without head and thread."""
        return OutputPin(self.nominal_diameter, self.mean_diameter, None)

    def shoulder_length(self, least: float) -> float:
        """Shortest standard shoulder at least `least` (m) long.

        Where there is none, a special one to the next half millimetre.
        """
        special = _rounded_up(least, 0.5e-3)
        sold = () if self.screw is None else self.screw.lengths
        return next((length for length in sold if length >= least - 1e-9), special)


def output_pin(pins: OutputPins) -> OutputPin:
    """The shoulder screw, or the ground dowel, that output pins of a design are."""
    screw, diameter, mean = shoulder_screw(pins), pins.diameter, mean_pin_diameter(pins)
    if screw is None:
        return OutputPin(diameter, mean, None)
    return OutputPin(
        nominal_diameter=diameter,
        mean_diameter=mean,
        screw=screw,
        head_diameter=screw.head_diameter or _HEAD_DIAMETER * diameter,
        head_height=screw.head_height or _HEAD_HEIGHT * diameter,
        socket=screw.socket_size or _SOCKET * diameter,
        thread_diameter=thread_major_diameter(screw.thread),
        thread_length=screw.thread_length or _THREAD_LENGTH * diameter,
    )


def thread_major_diameter(thread: str) -> float:
    """Major diameter (m) of a thread written ``M3``, ``10-24`` or ``5/16-18``.

    Numbered sizes are 0.060 in + 0.013 in for each number (ASME B1.1).

    Examples
    --------
    >>> print(round(thread_major_diameter("10-24") * 1e3, 3), thread_major_diameter("M3"))
    4.826 0.003
    """
    if thread.startswith("M"):
        return float(thread[1:]) * 1e-3
    size = thread.split("-")[0]
    if "/" in size:
        top, bottom = size.split("/")
        return 25.4e-3 * float(top) / float(bottom)
    return 25.4e-3 * (0.060 + 0.013 * float(size))
