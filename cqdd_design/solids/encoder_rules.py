"""Where the motor's encoder goes: a magnet in the end of the shaft, or a ring round a hollow one.

A shaft that has to stay open takes a ring magnet, magnetised across, and a sensor beside it at half
its height, as makers of such sensors ask. Bore and section, output upward::

     on the axis                 round a hollow shaft
      hub | shaft | hub           hub |s|   |s| hub
          |[mag]  |              [ring]s|   |s[ring]
     ______ sensor ______       __[ ]_              _____
     [____ board _______]       [board]            [board]
     [____ dish ________]       [dish____         ______]
"""

from __future__ import annotations

import math

from cqdd_design.solids.motor_layout import EncoderPlace
from cqdd_design.solids.selection import cap_screw

_SENSOR_GAP = 1.0e-3
"""From magnet to sensor; makers of magnetic encoders ask for 0.5 to 2 mm."""
_SENSOR_HEIGHT, _BOARD_THICKNESS = 0.9e-3, 1.6e-3
_MAGNETS = (3.0, 4.0, 5.0, 6.0)
"""Diameters of diametric encoder magnets, mm; they are half as high, 2.5 mm at the most. Sensors on
the axis are made for 6 x 2.5 mm (`encoders.csv`); a shaft too thin for it takes a smaller one."""
RING_WALL, RING_HEIGHT = 3.5e-3, 4.0e-3
"""Section of a ring magnet of NdFeB N35H: on stubs up to 24 mm it puts 30 to 150 mT on the sensor
beside it, what MagAlpha sensors ask for (MPS, MA700 data sheet, 2014)."""
_BOND = 25e-6
"""Radial gap of its bond on the stub, m."""
BESIDE, FROM_EDGE = 0.5e-3, 0.9e-3
"""From a ring magnet to the board's edge, no more than this (mjbots, off-axis MA600, 2025), and on
to the sensor's package, m."""
_BOARD_WIDTH = 8.0e-3
"""Of a board round a ring magnet, beside the sensor's 3 mm room for its plug."""
_UNDER = 0.8e-3
"""From a ring magnet down to the dish."""
_WAY = 0.3e-3
"""Of the way through the dish round the shaft's hole."""
SENSOR_SIDE = 3.0e-3
"""Of the sensor's package."""


def lay_out_encoder(journal: float, end: float, hollow: float | None = None) -> EncoderPlace:
    """The encoder at the end of a shaft.

    Parameters
    ----------
    journal : float
        Radius of the shaft's stub, m.
    end : float
        Height at which the stub is free of the hub, m.
    hollow : float or None
        Radius of the shaft's hole where that has to stay open, m.
    """
    if hollow is not None:
        return _round_the_shaft(journal, end, hollow)
    screw = cap_screw(2e-3, _BOARD_THICKNESS + 2.0e-3)
    magnet = next((d for d in reversed(_MAGNETS) if d <= 1.3e3 * journal), _MAGNETS[0]) * 1e-3
    height = min(0.5 * magnet, 2.5e-3)
    # In a pocket of the shaft; on the end of a shaft too thin for one.
    magnet_bottom = end if magnet <= 1.3 * journal + 1e-9 else end - height
    sensor_top = magnet_bottom - _SENSOR_GAP
    board_top = sensor_top - _SENSOR_HEIGHT
    return EncoderPlace(
        magnet_inner=0.0,
        magnet_radius=0.5 * magnet,
        magnet_height=height,
        magnet_bottom=magnet_bottom,
        shaft_end=end,
        board_inner=0.0,
        # Its screws' heads are higher than the gap to the shaft's end: they stand beside it.
        board_radius=max(0.5 * magnet + 9e-3, journal + screw.head_diameter + 0.9e-3),
        board_bottom=board_top - _BOARD_THICKNESS,
        board_top=board_top,
        sensor_top=sensor_top,
        board_screw=screw,
        seat_bottom=board_top - _BOARD_THICKNESS,
        way=0.0,
    )


def _round_the_shaft(journal: float, end: float, hollow: float) -> EncoderPlace:
    """A ring magnet on the stub, and a board round it with the sensor at half its height."""
    bottom, outer = end - RING_HEIGHT, journal + RING_WALL
    board_top = bottom + 0.5 * (RING_HEIGHT - _SENSOR_HEIGHT)
    inner = outer + BESIDE
    return EncoderPlace(
        magnet_inner=journal + _BOND,
        magnet_radius=outer,
        magnet_height=RING_HEIGHT,
        magnet_bottom=bottom,
        shaft_end=bottom,
        board_inner=inner,
        board_radius=inner + _BOARD_WIDTH,
        board_bottom=board_top - _BOARD_THICKNESS,
        board_top=board_top,
        sensor_top=board_top + _SENSOR_HEIGHT,
        board_screw=cap_screw(2e-3, _BOARD_THICKNESS + 2.0e-3),
        seat_bottom=min(board_top - _BOARD_THICKNESS, bottom - _UNDER),
        # In half millimetres of the diameter.
        way=0.25e-3 * math.ceil((hollow + _WAY) / 0.25e-3 - 1e-6),
    )
