"""Shapes of the output carrier: plate, cap, nut, shoulder screws, columns with their screws.

Drawn in the carrier's frame, where the first pin stands at the hole clocking.
"""

from __future__ import annotations

from collections.abc import Sequence

from cqdd_design.geometry.contours import PlanarPart
from cqdd_design.solids.features.kinds import Feature
from cqdd_design.solids.features.removal import drillings
from cqdd_design.solids.layers import (
    Annulus,
    Layer,
    Stack,
    circle,
    cylinder,
    hexagon,
    notched_circle,
    pierced,
    turned,
)
from cqdd_design.solids.layout import CarrierLayout, ColumnLayout, ShaftLayout
from cqdd_design.solids.rotating import plain_pin
from cqdd_design.solids.selection import CapScrew, OutputPin

_NUT_SLOTS = 4


def carrier_plate(carrier: CarrierLayout, shaft: ShaftLayout, features: Sequence[Feature]) -> Stack:
    """The output plate, turned, with the holes of its features."""
    output = carrier.output
    support = shaft.support
    seat_top = carrier.shaft_seat_top
    seat, way = 0.5 * support.bearing.outer_diameter, support.lip_radius
    outside = [
        (carrier.plate_bottom, carrier.bearing_bottom, carrier.shoulder_radius),
        (carrier.bearing_bottom, carrier.bearing_top, 0.5 * output.bearing.bore_diameter),
        (carrier.bearing_top, carrier.plate_top, carrier.nut_radius),
    ]
    rings = []
    for bottom, top, radius in outside:
        split = min(max(seat_top, bottom), top)
        rings.append(Annulus(bottom, split, seat, radius))
        rings.append(Annulus(split, top, way, radius))
    return turned([ring for ring in rings if ring.top - ring.bottom > 1e-9], drillings(features))


def carrier_cap(carrier: CarrierLayout, gap: float, features: Sequence[Feature]) -> Stack:
    """The ring that holds the far ends of pins and columns, with the holes of its features."""
    ring = Annulus(carrier.cap_bottom, -gap, carrier.cap_inner, carrier.cap_outer)
    return turned([ring], drillings(features))


def column_shape(columns: ColumnLayout, bottom: float, top: float) -> Stack:
    """The tube of a column on the z axis, from cap to plate."""
    return turned([Annulus(bottom, top, columns.bore_radius, columns.radius)])


def bearing_nut(carrier: CarrierLayout, core: float) -> Stack:
    """The nut that holds the output bearing on the plate, bored to a diameter (m).

    Its slots open upward, so that it is round where the cover's lip stands about it.
    """
    radius = carrier.output.shoulder_radius
    width = radius - carrier.nut_radius
    outer = notched_circle(radius, _NUT_SLOTS, 1.5 * width, 0.45 * width)
    bore = (circle(0.5 * core),)
    slotted = carrier.nut_slots_bottom
    return Stack(
        (
            Layer(PlanarPart("nut", circle(radius), bore), carrier.bearing_top, slotted),
            Layer(PlanarPart("slotted nut", outer, bore), slotted, carrier.nut_top),
        )
    )


def pin_shape(carrier: CarrierLayout) -> Stack:
    """A shoulder screw in its true shape, or a dowel, on the z axis at its height in the machine.

    From the bottom: head with hexagon socket, ground shoulder at its mean diameter, thread at its
    major diameter.
    """
    pin = carrier.pin
    if pin.screw is None:
        return plain_pin(pin.mean_diameter, carrier.shoulder_bottom, carrier.shoulder_top)
    thread = cylinder(
        0.5 * pin.thread_diameter,
        carrier.shoulder_top,
        carrier.shoulder_top + pin.thread_length,
    )
    shoulder = cylinder(0.5 * pin.mean_diameter, carrier.shoulder_bottom, carrier.shoulder_top)
    return Stack((*_socket_head(pin, carrier.shoulder_bottom), shoulder, thread))


def cap_screw_shape(screw: CapScrew) -> Stack:
    """A hexagon socket head cap screw, head upward, bearing face on z = 0."""
    head = PlanarPart("head", circle(0.5 * screw.head_diameter))
    middle, top = 0.5 * screw.head_height, screw.head_height
    socketed = pierced(Layer(head, middle, top), [hexagon(screw.socket)])
    return Stack(
        (cylinder(0.5 * screw.thread, -screw.length, 0.0), Layer(head, 0.0, middle), socketed)
    )


def _socket_head(pin: OutputPin, top: float) -> tuple[Layer, Layer]:
    """Two layers of a head whose socket opens downward, half the head deep."""
    bottom, middle = top - pin.head_height, top - 0.5 * pin.head_height
    full = PlanarPart("head", circle(0.5 * pin.head_diameter))
    return pierced(Layer(full, bottom, middle), [hexagon(pin.socket)]), Layer(full, middle, top)
