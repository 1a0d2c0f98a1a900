"""Features of an inrunner's hub and cover, and of the housing's flange for them."""

from __future__ import annotations

from cqdd_design.catalog.threads import coarse_thread
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import BoltCircle, PlainHole
from cqdd_design.solids.features.housing import ear_circle
from cqdd_design.solids.features.kinds import Feature, Joint
from cqdd_design.solids.features.making import clearance, metric, seat, shoulder, tapped
from cqdd_design.solids.features.motor import board_cable, board_threads
from cqdd_design.solids.motor_layout import InrunnerLayout, MotorEnd
from cqdd_design.solids.registers import LEAD_IN

_CORNER = 0.3e-3
"""Largest corner radius under rotor and stator, m."""


def hub_features(motor: InrunnerLayout, stub_radius: float) -> tuple[Feature, ...]:
    """Of the rotor's carrier; its datum is its bore."""
    bore = seat(
        "bonded bore", 2.0 * stub_radius, motor.hub_bottom, motor.hub_top, zones.BELL_BORE,
        inside=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    ring = seat(
        "seat of the rotor", 2.0 * motor.rotor_inner, motor.ring_bottom, motor.ring_top,
        zones.REGISTER, refers="A",
    )  # fmt: skip
    return (
        bore,
        ring,
        shoulder("shoulder of the rotor", motor.ring_bottom, motor.rotor_inner, motor.lip_radius,
                 "up", ring, fillet=_CORNER),
        Joint("eccentric shaft", "bonded", bore.name, "eccentric shaft", "bond on the stub"),
        Joint("motor rotor", "bonded", ring.name, "motor rotor", "bond on the hub"),
    )  # fmt: skip


def can_features(motor: InrunnerLayout, unit: float) -> tuple[Feature, ...]:
    """Of the cover; its datum is the stator's seat, which the housing's rim centres too."""
    bore = seat(
        "stator seat", 2.0 * motor.cover_inner, motor.stack_bottom, motor.joint, zones.HOUSED,
        inside=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    found: list[Feature] = [
        bore,
        shoulder("shoulder of the stator", motor.stack_bottom, motor.ledge, motor.cover_inner, "up",
                 bore, fillet=_CORNER),
        shoulder("face on the housing", motor.joint, motor.cover_inner, motor.body, "up", bore,
                 datum="B"),
        board_threads(motor, unit, refers="A"),
        board_cable(motor, unit),
        clearance("holes of the cover's screws", motor.cover_screw.thread,
                  motor.joint - motor.ear_height, motor.joint, ear_circle(motor)),
        Joint("motor stator", "bonded", bore.name, "motor stator", "bond in its seat"),
    ]  # fmt: skip
    if motor.cable_radius:
        where = BoltCircle("phase leads", motor.cable_circle, (0.0,))
        bottom = motor.cover_floor - motor.cover_wall
        found.append(
            PlainHole("hole of the phase leads", 2.0 * motor.cable_radius, bottom,
                      motor.cover_floor, where)
        )  # fmt: skip
    return tuple(found)


def flange_features(motor: MotorEnd) -> tuple[Feature, ...]:
    """Of the flange at the end of the housing's tube."""
    thread = coarse_thread(motor.cover_screw.thread)
    return (
        seat("spigot of the motor's cover", 2.0 * motor.cover_inner, motor.joint - motor.spigot,
             motor.joint, zones.CAN_SPIGOT, refers="A", lead_in=LEAD_IN),
        tapped("threads of the motor cover's screws", thread, metric(thread), ear_circle(motor),
               mouth=motor.joint, facing="down", depth=motor.flange, room=motor.flange),
    )  # fmt: skip
