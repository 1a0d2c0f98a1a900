"""Features of the output carrier: plate, cap, nut, columns."""

from __future__ import annotations

import math

from cqdd_design.catalog.threads import (
    Thread,
    ThreadGroove,
    coarse_thread,
    groove_of,
    thread_named,
)
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import BoltCircle, Counterbore, Facing
from cqdd_design.solids.features.kinds import AxialThread, Feature, Groove, Joint
from cqdd_design.solids.features.making import (
    BEARING_FACE,
    THREAD_CLASS,
    clearance,
    fitted,
    metric,
    seal_face,
    seat,
    shoulder,
    tapped,
)
from cqdd_design.solids.layout import CarrierLayout, ColumnLayout, ShaftLayout

OUTPUT_BOLTS = 6
"""In the output's face."""
OUTPUT_REGISTER = "centring bore of the output"
"""In the plate, open to the output's face: for a spigot of what is driven."""
_SPARE_TURNS = 2.0
"""Of a blind thread beyond its screw's end: a 25 mm screw may be 0.42 mm longer (ISO 4762), and the
part under its head and the depth of the head's counterbore have limits too."""
_NUT_TURNS = 4.0
"""Least turns of the nut's thread in its height."""
_FLANGE_POSITION = 20e-6
"""Of the output's dowels, which another part must meet, m."""


def pin_circle(carrier: CarrierLayout) -> BoltCircle:
    """Where the output pins stand in plate and cap."""
    return BoltCircle.even(
        "output pins", carrier.pin_count, carrier.pin_circle_radius, carrier.clocking
    )


def column_circle(carrier: CarrierLayout, columns: ColumnLayout) -> BoltCircle:
    """Where the columns stand between plate and cap."""
    return BoltCircle.even("columns", columns.count, carrier.pin_circle_radius, columns.angle)


def plate_features(
    carrier: CarrierLayout, shaft: ShaftLayout, pin_position: float
) -> tuple[Feature, ...]:
    """Of the output plate.

    Parameters
    ----------
    pin_position : float
        Diameter of the zone of the pins' axes, m.
    """
    return (
        *_plate_seats(carrier, shaft),
        *_plate_pins(carrier, pin_position),
        *_plate_columns(carrier),
        *_output_face(carrier),
    )


def _plate_seats(carrier: CarrierLayout, shaft: ShaftLayout) -> list[Feature]:
    output, support = carrier.output.bearing, shaft.support.bearing
    groove = _nut_groove(carrier)
    outside = seat(
        "seat of the output bearing", output.bore_diameter,
        carrier.bearing_bottom, carrier.bearing_top - groove.width, zones.OUTPUT_JOURNAL,
        datum="A",
    )  # fmt: skip
    seat_top = carrier.shaft_seat_top
    bore = seat(
        "seat of the shaft bearing", support.outer_diameter,
        carrier.plate_bottom, seat_top, zones.HOUSED, inside=True, refers="A",
    )  # fmt: skip
    thread = 2.0 * carrier.nut_radius
    return [
        outside,
        shoulder(
            "shoulder of the output bearing", carrier.bearing_bottom,
            0.5 * output.bore_diameter, carrier.shoulder_radius, "up", outside,
            fillet=output.largest_fillet, datum="B",
        ),
        bore,
        shoulder(
            "shoulder of the shaft bearing", seat_top,
            shaft.support.lip_radius, 0.5 * support.outer_diameter, "down", bore,
            fillet=support.largest_fillet, refers="AB", along=BEARING_FACE,
        ),
        seat(
            OUTPUT_REGISTER, 2.0 * shaft.support.lip_radius, seat_top, carrier.plate_top,
            zones.OUTPUT_REGISTER, inside=True, refers="A",
        ),
        AxialThread(
            "thread of the nut", thread, groove.pitch, _axial(thread, groove.pitch), "6g",
            inside=False, bottom=carrier.bearing_top, top=carrier.plate_top, core=thread,
        ),
        Groove(
            "run-out of the nut's thread", "DIN 76-B", thread - groove.below,
            carrier.bearing_top - groove.width, carrier.bearing_top,
            0.5 * output.bore_diameter, inside=False, fillet=groove.fillet,
        ),
    ]  # fmt: skip


def _nut_groove(carrier: CarrierLayout) -> ThreadGroove:
    """The groove of the nut's thread, whose pitch gives the nut its turns."""
    return groove_of((carrier.nut_top - carrier.bearing_top) / _NUT_TURNS)


def _axial(thread: float, pitch: float) -> str:
    return f"M{thread * 1e3:.6g} x {pitch * 1e3:g}"


def nut_features(carrier: CarrierLayout) -> tuple[Feature, ...]:
    """Of the slotted nut on the plate."""
    thread = Thread(2.0 * carrier.nut_radius, _nut_groove(carrier).pitch)
    bottom, top = carrier.bearing_top, carrier.nut_top
    return (
        AxialThread(
            "thread", thread.diameter, thread.pitch, _axial(thread.diameter, thread.pitch),
            THREAD_CLASS, inside=True, bottom=bottom, top=top, core=thread.core_diameter,
            datum="A",
        ),
        shoulder("face on the output bearing", bottom, carrier.nut_radius,
                 carrier.output.shoulder_radius, "down", None, datum="B", refers="A"),
        seal_face("outside in the cover's bore", 2.0 * carrier.output.shoulder_radius, bottom,
                  carrier.nut_slots_bottom, zones.SEAL_INSIDE),
    )  # fmt: skip


def column_features(columns: ColumnLayout, bottom: float, top: float) -> tuple[Feature, ...]:
    """Of a column: its faces, ground to one length as a set."""
    faces: tuple[tuple[str, float, Facing, str, str], ...] = (
        ("lower face", bottom, "down", "A", ""), ("upper face", top, "up", "", "A"),
    )  # fmt: skip
    return tuple(
        shoulder(name, height, columns.bore_radius, columns.radius, facing, None, datum=datum,
                 refers=refers)
        for name, height, facing, datum, refers in faces
    )  # fmt: skip


def _plate_pins(carrier: CarrierLayout, position: float) -> list[Feature]:
    pin, circle = carrier.pin, pin_circle(carrier)
    bonded = "bonded " if pin.screw is None else ""
    holes: list[Feature] = [
        fitted(
            f"{bonded}pin seats", pin.nominal_diameter, zones.PIN_HOLE, circle,
            bottom=carrier.plate_bottom, top=carrier.shoulder_top, facing="down",
            position=position, refers="AB",
        )
    ]  # fmt: skip
    if pin.screw is None:
        joint = Joint("pins", "bonded", "bonded pin seats", "dowel pin", "bond in its seat")
        return [*holes, joint]
    thread = thread_named(pin.screw.thread, pin.thread_diameter)
    holes.append(
        tapped(
            "threads of the pins", thread, pin.screw.thread, circle,
            mouth=carrier.shoulder_top, facing="down", depth=pin.thread_length,
            room=carrier.plate_top - carrier.shoulder_top, countersunk=False,
        )
    )  # fmt: skip
    holes.append(Joint("pins", "screwed", "threads of the pins", "shoulder screw", "its thread"))
    return holes


def _plate_columns(carrier: CarrierLayout) -> list[Feature]:
    columns = carrier.columns
    if columns is None:
        return []
    circle = column_circle(carrier, columns)
    thread = coarse_thread(columns.screw.thread)
    return [
        tapped(
            "threads of the columns' screws", thread, metric(thread), circle,
            mouth=carrier.plate_bottom, facing="down",
            # The screw may be longer than its size says, and what it holds thinner.
            depth=columns.thread_top - carrier.plate_bottom + _SPARE_TURNS * thread.pitch,
            room=carrier.plate_top - carrier.plate_bottom,
        ),
        Joint("columns", "screwed", "threads of the columns' screws", "column screw", "its thread"),
    ]  # fmt: skip


def _output_face(carrier: CarrierLayout) -> list[Feature]:
    found: list[Feature] = []
    top, dowels = carrier.plate_top, carrier.flange_dowels
    if carrier.bolt_thread:
        circle = BoltCircle.even("output bolts", OUTPUT_BOLTS, carrier.bolt_circle_radius)
        thread = coarse_thread(carrier.bolt_thread)
        found.append(
            tapped(
                "threads of the output", thread, metric(thread), circle,
                mouth=top, facing="up", depth=carrier.bolt_depth, room=carrier.bolt_room,
            )
        )  # fmt: skip
    if dowels.count:
        first = math.pi / OUTPUT_BOLTS
        circle = BoltCircle.even("output dowels", dowels.count, carrier.bolt_circle_radius, first)
        found.append(
            fitted(
                "dowel holes of the output", dowels.diameter, zones.PIN_HOLE, circle,
                bottom=top - dowels.depth, top=top, facing="up", position=_FLANGE_POSITION,
                room=carrier.bolt_room - dowels.depth, refers="AB",
            )
        )  # fmt: skip
    return found


def cap_features(carrier: CarrierLayout, gap: float, pin_position: float) -> tuple[Feature, ...]:
    """Of the ring that holds the far ends of pins and columns.

    Parameters
    ----------
    gap : float
        From the pack of discs to the cap, m.
    pin_position : float
        Diameter of the zone of the pins' axes, m.
    """
    circle, columns = pin_circle(carrier), carrier.columns
    found: list[Feature] = [
        # The pins alone centre the cap: its holes stand to each other and to its face.
        shoulder("face on the discs", -gap, carrier.cap_inner, carrier.cap_outer, "up", None,
                 datum="B", refers=""),
        fitted(
            "bonded pin seats" if carrier.bonded_in_cap else "pin holes",
            carrier.pin.nominal_diameter, zones.PIN_HOLE, circle,
            bottom=carrier.shoulder_bottom, top=-gap, facing="up", position=pin_position,
            through=True, refers="B",
        )
    ]  # fmt: skip
    if carrier.counterbore_radius:
        found.append(
            Counterbore(
                "counterbores of the pins' heads", 2.0 * carrier.counterbore_radius,
                carrier.cap_bottom, "down", carrier.shoulder_bottom - carrier.cap_bottom, circle,
                refers="B",
            )
        )  # fmt: skip
    if columns is not None:
        on_columns = column_circle(carrier, columns)
        found += [
            clearance("holes of the columns' screws", columns.screw.thread, columns.seat, -gap,
                      on_columns, series="fine", refers="B"),
            Counterbore(
                "counterbores of the columns' screws", 2.0 * columns.counterbore_radius,
                carrier.cap_bottom, "down", columns.seat - carrier.cap_bottom, on_columns,
                refers="B",
            ),
        ]  # fmt: skip
    return tuple(found)
