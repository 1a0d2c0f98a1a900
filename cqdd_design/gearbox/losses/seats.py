"""Support and output bearings of a design that does not name them, from the catalogue.

The design file names the cam bearing only. Where the caller has a layout of the machine it passes
its bearings; here are the rules for when it has none. They follow from the room there is, as in
any layout, and are reported by name.
"""

from __future__ import annotations

from cqdd_design.catalog.bearings import Bearing, bearings
from cqdd_design.design import Design
from cqdd_design.gearbox.losses.rolling import BearingFriction

_CORE_WALL = 0.02
"""Step between cam lobe and shaft core, as a share of the cam's bore radius."""
_JOURNAL_STEP = 0.08
"""Step between core and journal, as a share of the core's diameter."""
_PIN_SEAT = 1.125
"""Room beside the pin circle that heads and walls of the pins take, in pin diameters."""
_HEAD_ROOM = 2.5 / 72.0
"""Further room there, as a share of the ring's outside diameter."""
_BUSH_WIDTH = 0.6
"""Width of a bush in shaft diameters, where no bearing fits."""
_THIN_SECTION = 0.055
"""Radial section of a thin-section bearing to order, as a share of its bore."""


def support_seat(design: Design, cam: Bearing) -> BearingFriction:
    """Bearing at both ends of the eccentric shaft.

    Of the catalogue's ball bearings that go on the shaft's core and inside the circle of pins, the
    one with the largest bore and, among those, the highest static rating; a greased bush where
    none fits.

    Parameters
    ----------
    design : Design
    cam : Bearing
        The cam bearing, "auto" resolved.
    """
    reducer, pins = design.reducer, design.reducer.output_pins
    radius = 0.5 * cam.bore_diameter
    core = 2.0 * max(radius * (1.0 - _CORE_WALL) - reducer.eccentricity, 0.2 * radius)
    journal = core * (1.0 - _JOURNAL_STEP)
    room = 2.0 * (
        pins.circle_radius - _PIN_SEAT * pins.diameter - _HEAD_ROOM * reducer.ring.outer_diameter
    )
    fitting = [
        row
        for row in bearings().values()
        if row.kind == "ball"
        and row.static_rating is not None
        and row.bore_diameter <= journal + 1e-9
        and row.outer_diameter <= room + 1e-9
        and row.width <= 0.9 * row.bore_diameter
    ]
    if not fitting:
        return BearingFriction.bush(journal, _BUSH_WIDTH * journal, reducer.friction.pin)
    best = min(
        fitting, key=lambda row: (-row.bore_diameter, -(row.static_rating or 0.0), row.designation)
    )
    return BearingFriction.of(best)


def output_seat(design: Design) -> BearingFriction:
    """Bearing between carrier and housing.

    The smallest crossed roller bearing of the catalogue around the pins that is not much larger
    than the ring, else the smallest such ball bearing, else a thin-section ball bearing to order.
    """
    pins, ring = design.reducer.output_pins, design.reducer.ring.outer_diameter
    least = 2.0 * pins.circle_radius + 1.375 * pins.diameter
    fitting = [
        row
        for row in bearings().values()
        if row.kind in ("ball", "crossed roller")
        and row.bore_diameter >= least - 1e-9
        and row.outer_diameter <= 1.1 * ring + 1e-9
    ]
    if fitting:
        best = min(fitting, key=lambda row: (row.kind == "ball", _bulk(row), row.designation))
        return BearingFriction.of(best)
    section = _THIN_SECTION * least
    ordered = Bearing(
        f"thin section {least * 1e3:.3g} mm, to order",
        "ball",
        least,
        least + 2.0 * section,
        1.1 * section,
        None,
        None,
        None,
        "proportions",
    )
    return BearingFriction.of(ordered)


def _bulk(row: Bearing) -> float:
    return round((row.outer_diameter**2 - row.bore_diameter**2) * row.width, 12)
