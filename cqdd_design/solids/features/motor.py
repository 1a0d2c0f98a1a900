"""Features of the motor's bell and cover."""

from __future__ import annotations

import math

from cqdd_design.catalog.threads import coarse_thread
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import BoltCircle, PlainHole, TappedHole
from cqdd_design.solids.features.housing import ear_circle
from cqdd_design.solids.features.kinds import Feature, Joint
from cqdd_design.solids.features.making import clearance, metric, seat, shoulder, tapped
from cqdd_design.solids.motor_layout import MotorEnd, MotorLayout
from cqdd_design.solids.registers import LEAD_IN

_BOARD_SCREWS = 3
_BOARD_GAP = 0.4e-3
"""Between the heads of the board's screws and its edge, m."""
_CABLE, _CABLE_RIM, _CABLE_AT = 5.0e-3, 1.0e-3, math.pi / 3.0
"""Hole for the cable of the encoder's board, which has six to eight thin wires, and how far inside
the board's edge, m; its direction, between two of the board's screws and away from a sensor beside
the shaft, rad."""
_THIN = 1.2
"""Thickness of the dish under a ring magnet, units."""


def bell_features(motor: MotorLayout, stub_radius: float) -> tuple[Feature, ...]:
    """Of the rotor's carrier; its datum is its bore."""
    bore = seat(
        "bonded bore", 2.0 * stub_radius, motor.hub_bottom, motor.hub_top, zones.BELL_BORE,
        inside=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    ring = seat(
        "seat of the ring of magnets", 2.0 * motor.rotor_outer, motor.ring_bottom, motor.ring_top,
        zones.MAGNETS, inside=True, refers="A",
    )  # fmt: skip
    return (
        bore,
        ring,
        shoulder("shoulder of the ring of magnets", motor.ring_bottom, motor.rotor_inner,
                 motor.rotor_outer, "up", ring, fillet=_MAGNET_CORNER),
        Joint("eccentric shaft", "bonded", bore.name, "eccentric shaft", "bond on the stub"),
        Joint("motor rotor", "bonded", ring.name, "motor rotor", "bond in the bell"),
        *_lightening(motor),
    )  # fmt: skip


_MAGNET_CORNER = 0.3e-3
"""Largest corner radius under the ring of magnets, m."""


def _lightening(motor: MotorLayout) -> tuple[PlainHole, ...]:
    """Holes in the web, where there are any."""
    count, circle, radius = motor.lightening
    if not count:
        return ()
    holes = BoltCircle.even("lightening", count, circle, math.pi / count)
    return (PlainHole("lightening holes", 2.0 * radius, motor.web_bottom, motor.web_top, holes),)


def board_circle(motor: MotorEnd) -> BoltCircle:
    """Of the screws of the encoder's board."""
    radius = motor.board_radius - 0.5 * motor.board_screw.head_diameter - _BOARD_GAP
    return BoltCircle.even("encoder screws", _BOARD_SCREWS, radius)


def dish_bottom(motor: MotorEnd, unit: float) -> float:
    """Height of the underside of the dish that carries the board, m.

    The board's screws need a plate they do not come through; under a ring magnet it is thinner.
    """
    under = motor.board_bottom - max(2.0 * unit, _board_thread(motor) + 0.5e-3)
    return min(under, motor.seat_bottom - _THIN * unit) if motor.open else under


def _board_thread(motor: MotorEnd) -> float:
    """How deep the board's screws reach into the dish, with some play, m."""
    return motor.board_screw.length - (motor.board_top - motor.board_bottom) + 0.3e-3


def cover_features(motor: MotorLayout, flange_bottom: float, unit: float) -> tuple[Feature, ...]:
    """Of the can over the bell."""
    large = coarse_thread(motor.cover_screw.thread)
    bores, to = [], "B"
    if motor.spigot:
        to = "BA"
        bores.append(
            seat("bore on the flange's spigot", 2.0 * motor.cover_inner,
                 flange_bottom - motor.spigot, flange_bottom, zones.CAN_BORE, inside=True,
                 datum="A", lead_in=LEAD_IN)
        )  # fmt: skip
    return (
        *bores,
        board_threads(motor, unit, refers=to),
        board_cable(motor, unit),
        tapped("threads of the cover's screws", large, metric(large), ear_circle(motor),
               mouth=flange_bottom, facing="up", depth=motor.ear_height, room=motor.ear_height,
               countersunk=False, refers=to),
        shoulder("face on the housing", flange_bottom, motor.cover_inner, motor.cover_outer, "up",
                 None, datum="B", refers=""),
    )  # fmt: skip


def flanged_cover_features(motor: MotorLayout, unit: float) -> tuple[Feature, ...]:
    """Of the can over the bell of a motor behind the gearbox; its datum is the rim's bore."""
    bore = seat(
        "bore on the flange's spigot", 2.0 * motor.cover_inner, motor.joint - motor.spigot,
        motor.joint, zones.CAN_BORE, inside=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    return (
        bore,
        shoulder("face on the housing", motor.joint, motor.cover_inner, motor.body, "up", bore,
                 datum="B"),
        board_threads(motor, unit, refers="A"),
        board_cable(motor, unit),
        clearance("holes of the cover's screws", motor.cover_screw.thread,
                  motor.joint - motor.ear_height, motor.joint, ear_circle(motor)),
    )  # fmt: skip


def board_threads(motor: MotorEnd, unit: float, *, refers: str) -> TappedHole:
    """For the screws of the encoder's board, in the cover's dish."""
    small = coarse_thread(motor.board_screw.thread)
    return tapped(
        "threads of the board's screws", small, metric(small), board_circle(motor),
        mouth=motor.board_bottom, facing="up", depth=_board_thread(motor),
        room=motor.board_bottom - dish_bottom(motor, unit), refers=refers,
    )  # fmt: skip


def board_cable(motor: MotorEnd, unit: float) -> PlainHole:
    """Through the cover's dish under the board: the way of the encoder's cable."""
    radius = motor.board_radius - _CABLE_RIM - 0.5 * _CABLE
    where = BoltCircle("encoder cable", radius, (_CABLE_AT,))
    bottom = dish_bottom(motor, unit)
    return PlainHole("hole of the encoder's cable", _CABLE, bottom, motor.board_bottom, where)


def board_features(motor: MotorEnd) -> tuple[Feature, ...]:
    """Of the encoder's board."""
    return (
        clearance("holes of the screws", motor.board_screw.thread, motor.board_bottom,
                  motor.board_top, board_circle(motor), refers=""),
    )  # fmt: skip
