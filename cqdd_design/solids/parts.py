"""The parts of the gearbox: shape, material, colour, where each piece stands, make or buy.

`build_parts` needs no CAD kernel; the first use of `Part.solid` does.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import disc_contour, disc_moments
from cqdd_design.geometry.ring import ring_contour, ring_moments, ring_pins
from cqdd_design.solids import carrier as carrier_shapes
from cqdd_design.solids import housing as housing_shapes
from cqdd_design.solids import rotating
from cqdd_design.solids.clocking import DiscGroup, disc_groups
from cqdd_design.solids.counterweights import balance_weights
from cqdd_design.solids.fits import seat_fits
from cqdd_design.solids.layers import Stack, on_circle, prism
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.motor_parts import dowel_part, motor_parts
from cqdd_design.solids.motor_shapes import (
    with_dowel_grooves,
    with_dowel_notches,
    with_magnet_pocket,
    with_motor_flange,
)
from cqdd_design.solids.part import Colour, Instance, Part
from cqdd_design.solids.poses import CARRIER, HOUSING, SHAFT, Body, transform
from cqdd_design.solids.selection import ChosenBearing

__all__ = ["Colour", "Instance", "Part", "build_parts", "total_mass"]

SHAFT_MATERIAL = "AISI 4140 Q&T 540C"
RACEWAY_MATERIAL = "SCM415/16MnCr5 case hardened"
"""Shaft whose lobes are raceways of a needle cage: they must be hard."""
NUT_MATERIAL = "AISI 4140 Q&T 540C"
FASTENER_MATERIAL = "Alloy steel 12.9 (ISO 7379)"

_ALUMINIUM: Colour = (0.72, 0.74, 0.77)
_HOUSING: Colour = (0.36, 0.40, 0.46)
_COVER: Colour = (0.45, 0.49, 0.55)
_RING: Colour = (0.20, 0.45, 0.70)
_DISCS: tuple[Colour, ...] = ((0.93, 0.69, 0.13), (0.85, 0.45, 0.16), (0.62, 0.72, 0.25))
_SHAFT: Colour = (0.72, 0.20, 0.22)
_BEARING: Colour = (0.86, 0.87, 0.88)
_SCREW: Colour = (0.16, 0.17, 0.19)


def build_parts(design: Design, layout: Layout) -> tuple[Part, ...]:
    """Every part of a gearbox.

    Parameters
    ----------
    design : Design
    layout : Layout
        Of the same design, from `lay_out`.

    Returns
    -------
    tuple of Part
        Discs, ring, rotating parts, carrier, housing.

    Raises
    ------
    GeometryError
        When the parts cannot exist or cannot be put together.
    """
    parts = [
        *_disc_parts(design, layout),
        *_ring_parts(design, layout),
        *_shaft_parts(layout),
        *_carrier_parts(design, layout),
        *_housing_parts(design, layout),
        *motor_parts(design, layout, FASTENER_MATERIAL),
    ]
    if design.reducer.balance.counterweights:
        parts += balance_weights(design, layout, parts, _SHAFT)
    fits = seat_fits(layout)
    return tuple(
        dataclasses.replace(part, fits=tuple(fit for fit in fits if fit.belongs_to(part.name)))
        for part in parts
    )


def _once(name: str, body: Body) -> tuple[Instance, ...]:
    return (Instance(name, body, transform()),)


def _disc_parts(design: Design, layout: Layout) -> list[Part]:
    groups = disc_groups(design)
    return [_disc_part(design, layout, group, alone=len(groups) == 1) for group in groups]


def _disc_part(design: Design, layout: Layout, group: DiscGroup, *, alone: bool) -> Part:
    bore = layout.pack.cam.bearing.outer_diameter
    pin_diameter = layout.carrier.pin.mean_diameter
    thickness = layout.pack.disc_thickness
    drawn = group.placements[0].disc
    contour = disc_contour(design, drawn, bore_diameter=bore, pin_mean_diameter=pin_diameter)
    instances = tuple(
        Instance(
            f"disc {placed.disc + 1}",
            Body("disc", placed.disc),
            transform(
                placed.angle,
                z=layout.pack.disc_bottom(placed.disc) + (thickness if placed.turned_over else 0.0),
                turned_over=placed.turned_over,
            ),
        )
        for placed in group.placements
    )
    return Part(
        name="disc" if alone else f"disc {drawn + 1}",
        shape=prism(contour, 0.0, thickness),
        material=design.reducer.disc_material,
        colour=_DISCS[drawn % len(_DISCS)],
        source="make",
        designation=f"wire EDM, {thickness * 1e3:g} mm plate",
        instances=instances,
        exact_section=disc_moments(
            design, drawn, bore_diameter=bore, pin_mean_diameter=pin_diameter
        ),
        fitted_section=contour.moments(),
    )


def _ring_parts(design: Design, layout: Layout) -> list[Part]:
    height, dowels = layout.pack.top, layout.dowels
    contour = ring_contour(design)
    plain = prism(contour, 0.0, height)
    shape = with_dowel_notches(plain, layout.pack, dowels) if dowels.radius else plain
    ring = Part(
        name="ring",
        shape=shape,
        material=design.reducer.ring_material,
        colour=_RING,
        source="make",
        designation=f"wire EDM, {height * 1e3:g} mm plate",
        instances=_once("ring", HOUSING),
        exact_section=ring_moments(design),
        fitted_section=contour.moments(),
    )
    pins = ring_pins(design)
    if not pins:
        return [ring, *dowel_part(layout)]
    diameter = 2.0 * pins[0].radius
    instances = tuple(
        Instance(f"ring pin {i + 1}", HOUSING, transform(x=pin.centre[0], y=pin.centre[1]))
        for i, pin in enumerate(pins)
    )
    loose = Part(
        name="ring pin",
        shape=rotating.plain_pin(diameter, 0.0, height),
        material=design.reducer.ring_material,
        colour=_BEARING,
        source="make",
        designation=f"ground pin {diameter * 1e3:g} x {height * 1e3:g} mm",
        instances=instances,
    )
    return [ring, loose, *dowel_part(layout)]


def _shaft_parts(layout: Layout) -> list[Part]:
    pack, shaft, motor = layout.pack, layout.shaft, layout.motor
    turned = rotating.eccentric_shaft(pack, shaft)
    material = RACEWAY_MATERIAL if pack.cam.bearing.kind == "needle cage" else SHAFT_MATERIAL
    parts = [
        Part(
            name="eccentric shaft",
            shape=turned if motor is None else with_magnet_pocket(turned, motor),
            material=material,
            colour=_SHAFT,
            source="make",
            designation="turned and ground",
            instances=_once("eccentric shaft", SHAFT),
        )
    ]
    if pack.disc_count > 2:
        parts.append(
            Part(
                name="eccentric cam",
                shape=rotating.loose_cam(pack, shaft),
                material=material,
                colour=_SHAFT,
                source="make",
                designation="turned and ground, pressed on the shaft",
                instances=_once("eccentric cam", SHAFT),
            )
        )
    cams = tuple(
        Instance(f"cam bearing {disc + 1}", Body("disc", disc), transform(z=pack.cam_bottom(disc)))
        for disc in range(pack.disc_count)
    )
    parts.append(_bearing_part("cam bearing", pack.cam, cams, SHAFT))
    width = shaft.support.bearing.width
    lower = Instance(
        "shaft bearing, housing end", HOUSING, transform(z=shaft.lower_seat_top - width)
    )
    upper = Instance("shaft bearing, output end", CARRIER, transform(z=shaft.upper_seat_bottom))
    parts.append(_bearing_part("shaft bearing", shaft.support, (lower, upper), SHAFT))
    return parts


def _bearing_part(
    name: str, chosen: ChosenBearing, instances: Sequence[Instance], inner: Body
) -> Part:
    row = chosen.bearing
    return Part(
        name=name,
        shape=rotating.bearing_envelope(chosen),
        material=chosen.material,
        colour=_BEARING,
        source="make" if chosen.source == "bush" else "buy",
        designation=row.designation,
        instances=tuple(instances),
        catalogue_mass=row.mass,
        inner_body=inner,
    )


def _carrier_parts(design: Design, layout: Layout) -> list[Part]:
    carrier, pack = layout.carrier, layout.pack
    metal = design.housing.material
    parts = [
        Part(
            name="carrier plate",
            shape=carrier_shapes.carrier_plate(carrier, layout.shaft, layout.unit),
            material=metal,
            colour=_ALUMINIUM,
            source="make",
            designation="turned and drilled",
            instances=_once("carrier plate", CARRIER),
        )
    ]
    if carrier.cap:
        parts.append(
            Part(
                name="carrier cap",
                shape=carrier_shapes.carrier_cap(carrier, pack.gap),
                material=metal,
                colour=_ALUMINIUM,
                source="make",
                designation="turned and drilled",
                instances=_once("carrier cap", CARRIER),
            )
        )
    parts.append(
        Part(
            name="bearing nut",
            shape=carrier_shapes.bearing_nut(carrier),
            material=NUT_MATERIAL,
            colour=_SCREW,
            source="make",
            designation=f"slotted nut, thread {2e3 * carrier.nut_radius:g} mm",
            instances=_once("bearing nut", CARRIER),
        )
    )
    parts.append(_pin_part(design, layout))
    if design.reducer.output_pins.sleeve_diameter > 0.0:
        parts.append(_sleeve_part(design, layout))
    seat = Instance("output bearing", HOUSING, transform(z=carrier.bearing_bottom))
    parts.append(_bearing_part("output bearing", carrier.output, [seat], CARRIER))
    return parts


def _pin_positions(layout: Layout) -> FloatArray:
    carrier = layout.carrier
    return on_circle(carrier.pin_count, carrier.pin_circle_radius, carrier.clocking)


def _pin_part(design: Design, layout: Layout) -> Part:
    carrier = layout.carrier
    pin, length = carrier.pin, carrier.shoulder_top - carrier.shoulder_bottom
    name = "dowel pin" if pin.screw is None else "shoulder screw"
    size = f"{pin.nominal_diameter * 1e3:g} f9 x {length * 1e3:.4g}"
    if pin.screw is None:
        designation = f"ground dowel {size}"
    elif pin.screw.name.startswith("metric"):
        designation = f"ISO 7379 {size} {pin.screw.thread}"
    else:
        designation = f"shoulder screw {size} mm {pin.screw.thread}"
    instances = tuple(
        Instance(f"{name} {i + 1}", CARRIER, transform(x=x, y=y))
        for i, (x, y) in enumerate(_pin_positions(layout))
    )
    return Part(
        name=name,
        shape=carrier_shapes.pin_shape(carrier),
        material=design.reducer.output_pins.material,
        colour=_SCREW,
        source="make" if pin.screw is None else "buy",
        designation=designation,
        instances=instances,
    )


def _sleeve_part(design: Design, layout: Layout) -> Part:
    pins, pack = design.reducer.output_pins, layout.pack
    instances = tuple(
        Instance(
            f"pin sleeve {disc * pins.count + i + 1}",
            CARRIER,
            transform(x=x, y=y, z=pack.disc_bottom(disc)),
        )
        for disc in range(pack.disc_count)
        for i, (x, y) in enumerate(_pin_positions(layout))
    )
    outer, inner = pins.sleeve_diameter, pins.diameter
    return Part(
        name="pin sleeve",
        shape=rotating.sleeve(inner, outer, pack.disc_thickness),
        material=pins.material,
        colour=_BEARING,
        source="make",
        designation=(
            f"ground sleeve {inner * 1e3:g} x {outer * 1e3:g} x {pack.disc_thickness * 1e3:g} mm"
        ),
        instances=instances,
    )


def _housing_parts(design: Design, layout: Layout) -> list[Part]:
    housing = layout.housing
    metal = design.housing.material

    def made(name: str, shape: Stack, colour: Colour) -> Part:
        return Part(name, shape, metal, colour, "make", "turned and drilled", _once(name, HOUSING))

    screws = tuple(
        Instance(f"cover screw {i + 1}", HOUSING, transform(x=x, y=y, z=housing.cover_flange_top))
        for i, (x, y) in enumerate(on_circle(housing.screw_count, housing.bolt_circle_radius, 0.0))
    )
    return [
        made("housing", _housing_shape(layout), _HOUSING),
        made("ring clamp", housing_shapes.ring_clamp(layout), _COVER),
        made("output cover", housing_shapes.output_cover(layout), _HOUSING),
        Part(
            name="cover screw",
            shape=carrier_shapes.cap_screw_shape(housing.screw),
            material=FASTENER_MATERIAL,
            colour=_SCREW,
            source="buy",
            designation=housing.screw.designation,
            instances=screws,
        ),
    ]


def _housing_shape(layout: Layout) -> Stack:
    shape = housing_shapes.housing_body(layout)
    if layout.motor is not None:
        shape = with_motor_flange(shape, layout, layout.motor)
    if layout.dowels.radius:
        shape = with_dowel_grooves(shape, layout.pack, layout.dowels)
    return shape


def total_mass(parts: Sequence[Part]) -> float:
    """Closed-form mass of all pieces, kg."""
    return math.fsum(part.mass * part.count for part in parts)
