"""Features of the housing: tube, ring clamp, output cover."""

from __future__ import annotations

import math

from cqdd_design.catalog.threads import coarse_thread, thread_size_of
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import (
    BoltCircle,
    ClearanceHole,
    Counterbore,
    FittedHole,
    PlainHole,
)
from cqdd_design.solids.features.kinds import Feature, Joint, TrueFace
from cqdd_design.solids.features.making import (
    BEARING_FACE,
    RING_FACE,
    clearance,
    fitted,
    indicator_band,
    metric,
    seal_face,
    seat,
    shoulder,
    tapped,
)
from cqdd_design.solids.layout import (
    DowelLayout,
    GapSeal,
    HousingLayout,
    Layout,
    PackLayout,
)
from cqdd_design.solids.motor_layout import MotorEnd, MotorLayout
from cqdd_design.solids.registers import LEAD_IN

SEAM_POSITION = 10e-6
"""Of the half grooves of the ring's dowels, in ring and housing, m: where both lie at the ends of
their zones they miss each other by as much, which `zones.SEAM_GROOVE` leaves round a dowel."""
_SPIGOT_CORNER = 0.5 * LEAD_IN
"""Largest corner radius beside a spigot, m: what goes over it has a chamfer of the lead-in."""
_RING_PIN_POSITION = 10e-6
"""Of the ends of a ring's pins, which gear with the discs, m."""


def screw_circle(housing: HousingLayout) -> BoltCircle:
    """Of the screws through cover and clamp into the housing."""
    return BoltCircle.even("cover screws", housing.screw_count, housing.bolt_circle_radius)


def _mounting_circle(housing: HousingLayout) -> BoltCircle:
    """Of the screws by which the actuator is fixed, between those of the cover."""
    first = math.pi / housing.screw_count
    return BoltCircle.even("mounting", housing.screw_count, housing.bolt_circle_radius, first)


def _mounting(
    housing: HousingLayout, bottom: float, top: float, refers: str = "A"
) -> ClearanceHole:
    """The holes of these screws, which come from the output's side."""
    circle = _mounting_circle(housing)
    return clearance("mounting holes", housing.mount_thread, bottom, top, circle, refers=refers)


def housing_features(layout: Layout) -> tuple[Feature, ...]:
    """Of the tube with floor and flange."""
    housing, pack = layout.housing, layout.pack
    support, seat_top = layout.shaft.support, layout.shaft.lower_seat_top
    seat_bottom = seat_top - support.bearing.width
    ring = seat(
        "ring seat", 2.0 * pack.ring_radius, 0.0, housing.face, zones.RING_SEAT, inside=True,
        datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    bore = seat(
        "seat of the shaft bearing", support.bearing.outer_diameter, seat_bottom, seat_top,
        zones.HOUSED, inside=True, refers="A",
    )  # fmt: skip
    thread = coarse_thread(housing.screw.thread)
    deep = pack.top - housing.flange_bottom
    mount, held = coarse_thread(housing.mount_thread), housing.face - housing.flange_bottom
    found: list[Feature] = [
        ring,
        shoulder("ledge of the ring", 0.0, pack.ledge_radius, pack.ring_radius, "up", ring,
                 fillet=RING_CORNER, datum="B"),
        bore,
        shoulder("shoulder of the shaft bearing", seat_bottom, support.lip_radius,
                 0.5 * support.bearing.outer_diameter, "up", bore,
                 fillet=support.bearing.largest_fillet, refers="A",
                 along=BEARING_FACE),
        shoulder("face under the clamp", housing.face, pack.ring_radius, housing.flange_radius,
                 "up", ring, refers="A", along=RING_FACE),
        tapped("threads of the cover's screws", thread, metric(thread), screw_circle(housing),
               mouth=pack.top, facing="up", depth=deep, room=deep),
        Counterbore("counterbores over these threads", thread_size_of(thread.diameter).medium,
                    housing.face, "up", housing.face - pack.top, screw_circle(housing)),
        tapped("threads of the mounting", mount, metric(mount), _mounting_circle(housing),
               mouth=housing.face, facing="up", depth=held, room=held, countersunk=False),
        *_ring_pin_seats(pack, -pack.relief, downward=True),
        *ring_dowel_holes(pack, layout.dowels, layout.dowels.bottom, housing.face),
        _seal_bore(housing.shaft_seal, "bore about the shaft"),
        indicator_band(INDICATOR_BAND, 2.0 * housing.flange_radius, _band_bottom(layout),
                       housing.face, zones.BAND),
    ]  # fmt: skip
    if layout.motor is not None:
        motor = layout.motor
        found += _neck(motor) if motor.behind else _motor_flange(housing, motor)
    return tuple(found)


INDICATOR_BAND = "band for the indicator"
"""Outside of the flange, by which the output is centred on the ring."""


def _band_bottom(layout: Layout) -> float:
    """Where the flange ends, or the ears for the motor's cover on it, m."""
    end = layout.housing.flange_bottom
    return end if layout.motor is None else max(end, layout.motor.flange_top)


RING_CORNER = 0.2e-3
"""Largest corner radius in the ring's seat, m: the ring's outer edges are broken by more."""


def _seal_bore(seal: GapSeal, name: str) -> TrueFace:
    return seal_face(name, 2.0 * seal.outer, seal.bottom, seal.top, zones.SEAL_OUTSIDE, inside=True)


def _motor_flange(housing: HousingLayout, motor: MotorLayout) -> list[Feature]:
    """Register, lip and ears for stator and cover, and the hole of the phase leads."""
    register = seat(
        "stator register", 2.0 * housing.register_radius,
        min(housing.bottom, motor.stack_bottom), motor.stack_top, zones.REGISTER, refers="A",
    )  # fmt: skip
    found: list[Feature] = [
        register,
        Joint("motor stator", "bonded", register.name, "motor stator", "bond on the register"),
        clearance("holes of the motor cover's screws", motor.cover_screw.thread,
                  housing.flange_bottom, motor.flange_top, ear_circle(motor)),
    ]  # fmt: skip
    if motor.spigot:
        bottom = housing.flange_bottom - motor.spigot
        found.append(
            seat("spigot of the motor's cover", 2.0 * motor.cover_inner, bottom,
                 housing.flange_bottom, zones.CAN_SPIGOT, refers="A", lead_in=LEAD_IN)
        )  # fmt: skip
    if motor.cable_radius:
        # Between two ears, whose screws stand half a pitch off +x.
        where = BoltCircle("phase leads", motor.cable_circle, (0.0,))
        found.append(
            PlainHole("hole of the phase leads", 2.0 * motor.cable_radius, housing.flange_bottom,
                      motor.flange_top, where)
        )  # fmt: skip
    return found


def _neck(motor: MotorLayout) -> list[Feature]:
    """Register and shoulder of a stator behind the gearbox, and the hole of the phase leads.

    What holds the cover is on the flange (`flange_features`).
    """
    register = seat(
        "stator register", 2.0 * motor.stack_inner, motor.stack_bottom, motor.stack_top,
        zones.REGISTER, refers="A", lead_in=LEAD_IN,
    )  # fmt: skip
    # Between two ears, whose screws stand half a pitch off +x.
    where = BoltCircle("phase leads", motor.cable_circle, (0.0,))
    return [
        register,
        shoulder("shoulder of the stator", motor.stack_top, motor.stack_inner, motor.lip, "down",
                 register, fillet=_STATOR_CORNER, refers="A"),
        Joint("motor stator", "bonded", register.name, "motor stator", "bond on the register"),
        PlainHole("hole of the phase leads", 2.0 * motor.cable_radius, motor.joint,
                  motor.joint + motor.flange, where),
    ]  # fmt: skip


_STATOR_CORNER = 0.3e-3
"""Largest corner radius under a stator, m."""


def ear_circle(motor: MotorEnd) -> BoltCircle:
    """Of the ears' screws, on housing and cover."""
    return BoltCircle("motor cover screws", motor.ear_circle, tuple(motor.ear_angles.tolist()))


def ring_dowel_holes(
    pack: PackLayout, dowels: DowelLayout, bottom: float, top: float, refers: str = "AB"
) -> tuple[FittedHole, ...]:
    """Of the dowels between ring and housing, of which each has one half, between heights (m).

    Parameters
    ----------
    refers : str
        Letters of the datums; the ring has but its outside.
    """
    if not dowels.radius:
        return ()
    circle = BoltCircle("ring dowels", pack.ring_radius, dowels.angles)
    return (
        fitted("holes of the ring dowels", 2.0 * dowels.radius, zones.SEAM_GROOVE, circle,
               bottom=bottom, top=top, facing="up", position=SEAM_POSITION,
               seam=True, refers=refers),
    )  # fmt: skip


def _ring_pin_seats(pack: PackLayout, mouth: float, *, downward: bool) -> tuple[FittedHole, ...]:
    """Seats of the ends of ring pins that rollers leave free along the discs."""
    pins = pack.held_pins
    if pins is None:
        return ()
    bottom, top = (mouth - pins.depth, mouth) if downward else (mouth, mouth + pins.depth)
    circle = BoltCircle.even("ring pins", pins.count, pins.circle_radius)
    return (
        fitted("seats of the ring pins", pins.diameter, zones.RING_PIN_SEAT, circle,
               bottom=bottom, top=top, facing="up" if downward else "down",
               position=_RING_PIN_POSITION, refers="AB"),
    )  # fmt: skip


def clamp_features(layout: Layout) -> tuple[Feature, ...]:
    """Of the plate between flange and cover."""
    housing, pack, output = layout.housing, layout.pack, layout.carrier.output.bearing
    bottom, top = pack.top + pack.ring_play, layout.carrier.bearing_bottom
    lower = seat(
        "spigot in the housing", 2.0 * pack.ring_radius, bottom, housing.face, zones.SPIGOT,
        datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    upper = seat(
        "spigot in the cover", output.outer_diameter, housing.cover_bottom, top, zones.SPIGOT,
        refers="A", lead_in=LEAD_IN,
    )  # fmt: skip
    return (
        lower,
        upper,
        clearance("holes of the cover's screws", housing.screw.thread, housing.face,
                  housing.cover_bottom, screw_circle(housing), refers="BA"),
        _mounting(housing, housing.face, housing.cover_bottom, refers="BA"),
        shoulder("face on the ring", bottom, max(pack.ledge_radius, housing.clamp_inner),
                 pack.ring_radius, "down", None, refers="A", along=RING_FACE),
        shoulder("face on the housing", housing.face, pack.ring_radius, housing.flange_radius,
                 "down", lower, fillet=_SPIGOT_CORNER, datum="B", refers="A"),
        shoulder("face under the cover", housing.cover_bottom, 0.5 * output.outer_diameter,
                 housing.flange_radius, "up", upper, fillet=_SPIGOT_CORNER, refers="A",
                 along=BEARING_FACE),
        shoulder("face under the output bearing", top, housing.clamp_inner,
                 0.5 * output.outer_diameter, "up", None, refers="A", along=BEARING_FACE),
        *_ring_pin_seats(pack, max(pack.top + pack.relief, bottom), downward=False),
    )  # fmt: skip


def cover_features(layout: Layout) -> tuple[Feature, ...]:
    """Of the cover that carries the output bearing."""
    housing, carrier = layout.housing, layout.carrier
    output, bottom = carrier.output.bearing, housing.cover_bottom
    top = carrier.output_seat_top
    bore = seat(
        "seat of the output bearing", output.outer_diameter, bottom, top,
        zones.HOUSED, inside=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    return (
        bore,
        _seal_bore(housing.output_seal, "bore about the nut"),
        shoulder("lip over the output bearing", top, carrier.output.lip_radius,
                 0.5 * output.outer_diameter, "down", bore,
                 fillet=output.largest_fillet, along=BEARING_FACE),
        shoulder("face on the ring clamp", bottom, 0.5 * output.outer_diameter,
                 housing.flange_radius, "down", bore, datum="B"),
        clearance("holes of the cover's screws", housing.screw.thread, bottom,
                  housing.cover_flange_top, screw_circle(housing)),
        _mounting(housing, bottom, housing.cover_flange_top),
    )  # fmt: skip
